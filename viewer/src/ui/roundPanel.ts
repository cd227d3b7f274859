/** How the team was grouped in a round: the groups, who would trust whom, and the runner-up. */

import { inWords } from '../recording/words';
import { drawLine } from '../draw/marks';
import { groupColour, theme } from '../draw/theme';
import type { Recording } from '../recording/recording';
import type { Point, Score, TimedDecision } from '../recording/types';
import { Sheet, button, element, swatch } from './dom';

/** The members of a group; of a large one, how many they are. */
function listed(group: readonly number[]): string {
  if (group.length === 0) return 'nobody';
  return group.length > 40 ? `${group.length} robots` : group.join(' ');
}

export function scoreText(score: Score): string {
  if (score === null) return 'none';
  if (score === 'Infinite') return 'infinite';
  return `${Number(score.Finite.toPrecision(4))} nats`;
}

/** Rows and columns of the matrix: the members of one group after the other. */
export function matrixOrder(decided: TimedDecision): { id: number; at: number; task: number }[] {
  const { trust, decision } = decided;
  if (!trust) return [];
  const places = new Map(trust.members.map((id, at) => [id, at]));
  return decision.assignment.groups.flatMap((group, task) =>
    group.flatMap((id) => {
      const at = places.get(id);
      return at === undefined ? [] : [{ id, at, task }];
    }),
  );
}

/** The decision that holds at a time: the last one before it. */
export function decisionAt(recording: Recording, time: number): number {
  const { decisions, header } = recording;
  let at = 0;
  while (at + 1 < decisions.length && decisions[at + 1].step * header.dt_s <= time + 1e-9) at++;
  return at;
}

export class RoundPanel {
  readonly root = element('section', { class: 'panel round-panel' });
  private readonly sheet: Sheet;
  private readonly told = element('p', { class: 'told' });
  private shown: { recording: Recording; number: number } | null = null;
  private pointed: [row: number, column: number] | null = null;

  constructor(private readonly seek: (time: number) => void) {
    this.sheet = new Sheet({ class: 'matrix', role: 'img', 'aria-label': 'Relative Needs Entropy' }, () =>
      this.drawMatrix(),
    );
    const point = (event: PointerEvent): void => {
      const { left, top } = this.sheet.canvas.getBoundingClientRect();
      this.pointed = this.cellAt(event.clientX - left, event.clientY - top);
      this.drawMatrix();
    };
    this.sheet.canvas.addEventListener('pointermove', point);
    this.sheet.canvas.addEventListener('pointerdown', point);
  }

  /** Draws the round of a time, if it is not drawn already. */
  draw(recording: Recording, time: number, afresh: boolean): void {
    const number = decisionAt(recording, time);
    if (!afresh && this.shown?.recording === recording && this.shown.number === number) return;
    this.shown = { recording, number };
    this.pointed = null;
    const decided = recording.decisions[number] as TimedDecision | undefined;
    if (!decided) {
      this.root.replaceChildren(
        element('h2', {}, 'Rounds'),
        element('p', { class: 'hint' }, 'No group was formed.'),
      );
      return;
    }
    this.root.replaceChildren(
      this.head(recording, number),
      this.groups(recording, decided),
      ...this.scores(decided),
    );
    if (decided.trust && decided.trust.members.length > 1) {
      this.root.append(
        element('h3', {}, 'Relative Needs Entropy, from row to column'),
        this.sheet.canvas,
        this.told,
      );
      this.drawMatrix();
    }
  }

  private head(recording: Recording, number: number): HTMLElement {
    const { decisions, header } = recording;
    const go = (to: number): void => this.seek(decisions[to].step * header.dt_s);
    const before = button('‹', 'The round before', () => go(number - 1));
    const after = button('›', 'The next round', () => go(number + 1));
    before.disabled = number === 0;
    after.disabled = number + 1 >= decisions.length;
    const title = element('h2', {}, `Round ${decisions[number].question.round}`);
    return element('div', { class: 'round-head' }, title, element('span', { class: 'tools' }, before, after));
  }

  private groups(recording: Recording, { question, decision }: TimedDecision): HTMLElement {
    const table = element('table', { class: 'facts groups' });
    decision.assignment.groups.forEach((group, task) => {
      const name = question.tasks[task]?.name ?? String(task);
      const result = recording.summary?.rounds.find((r) => r.round === question.round && r.task === task);
      const row = element('tr', {}, element('th', { scope: 'row' }, swatch(groupColour(task)), name));
      row.append(element('td', { class: 'members' }, listed(group)));
      row.append(
        element(
          'td',
          { class: 'value' },
          result ? inWords(recording.header.world, `${result.rescued} rescued`) : '',
        ),
      );
      table.append(row);
    });
    return table;
  }

  private scores(decided: TimedDecision): HTMLElement[] {
    const { decision } = decided;
    const lines: [string, string][] = [];
    if (decision.score !== null) {
      lines.push([
        'score',
        scoreText(decision.score) + (decision.proven_optimal ? '' : ', not proven the best'),
      ]);
    }
    const [second] = decision.alternatives as ((typeof decision.alternatives)[number] | undefined)[];
    if (second) {
      const groups = second.assignment.groups.map(listed).join('  |  ');
      lines.push(['runner-up', `${scoreText(second.score)}: ${groups}`]);
    }
    const { trust, question } = decided;
    const between = (trust?.groups ?? []).flatMap((row, from) =>
      row.flatMap((nats, to) => {
        if (from === to || row.length > 4) return [];
        const [a, b] = [question.tasks[from].name, question.tasks[to].name];
        return [`${a} → ${b} ${nats === null ? 'infinite' : Number(nats.toPrecision(3))}`];
      }),
    );
    if (between.length > 0) lines.push(['between groups', `${between.join(', ')} nats`]);
    return lines.map(([name, text]) =>
      element('p', { class: 'decision' }, element('b', {}, name), ` ${text}`),
    );
  }

  private decided(): TimedDecision | null {
    return this.shown ? this.shown.recording.decisions[this.shown.number] : null;
  }

  private layout(count: number): { cell: number; left: number; top: number } {
    const left = 26;
    return {
      cell: Math.max((Math.min(this.sheet.width, 420) - left) / Math.max(count, 1), 2),
      left,
      top: 20,
    };
  }

  private cellAt(x: number, y: number): [number, number] | null {
    const decided = this.decided();
    const count = decided ? matrixOrder(decided).length : 0;
    const { cell, left, top } = this.layout(count);
    const [row, column] = [Math.floor((y - top) / cell), Math.floor((x - left) / cell)];
    return row >= 0 && column >= 0 && row < count && column < count ? [row, column] : null;
  }

  private drawMatrix(): void {
    const decided = this.decided();
    if (!decided?.trust) return;
    const order = matrixOrder(decided);
    const { robots } = decided.trust;
    const { cell, left, top } = this.layout(order.length);
    this.sheet.canvas.style.height = `${Math.ceil(top + cell * order.length + 22)}px`;
    const context = this.sheet.begin();
    const colours = theme();
    const values = order.flatMap(({ at }) => order.map((column) => robots[at][column.at] ?? 0));
    const most = Math.max(...values, 1e-12);
    this.drawIds(order);
    order.forEach((row, i) => {
      order.forEach((column, j) => {
        const nats = robots[row.at][column.at];
        context.fillStyle = nats === null ? colours.faint : heat(Math.sqrt(nats / most), colours.isDark);
        context.fillRect(left + j * cell, top + i * cell, cell - 0.75, cell - 0.75);
        if (nats === null) {
          context.strokeStyle = colours.soft;
          context.lineWidth = 1;
          const at = (x: number, y: number): Point => [left + (j + x) * cell, top + (i + y) * cell];
          drawLine(context, at(0.25, 0.75), at(0.75, 0.25));
        }
      });
    });
    context.lineWidth = 2;
    let first = 0;
    for (let i = 1; i <= order.length; i++) {
      if (i < order.length && order[i].task === order[first].task) continue;
      context.strokeStyle = groupColour(order[first].task);
      const size = (i - first) * cell;
      context.strokeRect(left + first * cell, top + first * cell, size - 1, size - 1);
      first = i;
    }
    if (this.pointed) {
      context.strokeStyle = colours.ink;
      context.strokeRect(left + this.pointed[1] * cell, top + this.pointed[0] * cell, cell - 1, cell - 1);
    }
    const end = top + cell * order.length + 10;
    for (let step = 0; step < 60; step++) {
      context.fillStyle = heat(step / 59, colours.isDark);
      context.fillRect(left + 2 * step, end, 2, 8);
    }
    context.fillStyle = colours.soft;
    context.font = '11px system-ui, sans-serif';
    context.textAlign = 'left';
    context.fillText(`0 to ${Number(most.toPrecision(2))} nats, ⁄ infinite`, left + 128, end + 4);
    this.told.textContent = this.tell(order, robots);
  }

  /** The ids of rows and columns: upright above narrow columns, and no more than there is room for. */
  private drawIds(order: { id: number; task: number }[]): void {
    const { context } = this.sheet;
    const { cell, left, top } = this.layout(order.length);
    const size = Math.min(11, Math.max(cell, 8));
    const every = Math.ceil((size - 1) / cell);
    context.font = `${size}px system-ui, sans-serif`;
    context.textBaseline = 'middle';
    order.forEach(({ id, task }, i) => {
      if (i % every > 0) return;
      const middle = (i + 0.5) * cell;
      context.fillStyle = groupColour(task);
      context.textAlign = 'right';
      context.fillText(String(id), left - 5, top + middle);
      context.save();
      context.translate(left + middle, top - 5);
      if (cell < 16) context.rotate(-Math.PI / 2);
      else context.translate(0, -3);
      context.textAlign = cell < 16 ? 'left' : 'center';
      context.fillText(String(id), 0, 0);
      context.restore();
    });
  }

  private tell(order: { id: number; at: number }[], robots: (number | null)[][]): string {
    if (!this.pointed) return 'A faint cell is trust. Point at one for its value.';
    const [from, to] = this.pointed.map((place) => order[place]);
    const nats = robots[from.at][to.at];
    if (nats === null) return `Robot ${from.id} towards ${to.id}: infinite, no trust.`;
    const trust = `trust ${Math.exp(-nats).toFixed(4)}`;
    return `Robot ${from.id} towards ${to.id}: ${Number(nats.toPrecision(4))} nats, ${trust}.`;
  }
}

/** A colour from light (0, trust) to strong (1); strong stands out from the page in light and in dark. */
export function heat(part: number, isDark: boolean): string {
  const stops = isDark
    ? [
        [38, 46, 56],
        [46, 100, 140],
        [120, 180, 200],
        [250, 236, 170],
      ]
    : [
        [243, 246, 248],
        [150, 190, 214],
        [50, 115, 165],
        [20, 42, 82],
      ];
  const at = Math.min(Math.max(part, 0), 1) * (stops.length - 1);
  const low = Math.min(Math.floor(at), stops.length - 2);
  const mixed = stops[low].map((value, i) => Math.round(value + (stops[low + 1][i] - value) * (at - low)));
  return `rgb(${mixed.join(', ')})`;
}
