/** The course of trials: rescuees delivered and levels over time, with a cursor. */

import { inWords } from '../recording/words';
import { drawLine } from '../draw/marks';
import { groupColour, theme } from '../draw/theme';
import type { Recording } from '../recording/recording';
import type { Clock } from './clock';
import { Sheet, element, swatch } from './dom';

const [LEFT, RIGHT, TOP, BOTTOM] = [38, 8, 8, 6];

/** Lines of the recordings one after the other. */
const DASHES = [[], [6, 3], [2, 2], [8, 3, 2, 3]];

/** For each task, the times of its deliveries. */
export function deliveries({ header, happenings }: Recording): number[][] {
  const { tasks } = header.world;
  const times: number[][] = tasks.map(() => []);
  for (const { kind, time, fields } of happenings) {
    if (kind !== 'Delivered') continue;
    const rescuee = Number(fields.rescuee);
    const task = tasks.findIndex((t) => rescuee >= t.first_rescuee && rescuee < t.first_rescuee + t.rescuees);
    if (task >= 0) times[task].push(time);
  }
  return times;
}

/** How many of these sorted times are not after a time. */
export function countUntil(times: readonly number[], time: number): number {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= time) low = middle + 1;
    else high = middle;
  }
  return low;
}

export class Curves {
  readonly root: HTMLElement;
  private readonly rescued: Sheet;
  private readonly levels: Sheet;
  private delivered: number[][][];
  private readonly rescuedTold = element('span', { class: 'reading' });
  private readonly levelsTold = element('span', { class: 'reading' });

  constructor(
    private readonly clock: Clock,
    private readonly recordings: readonly Recording[],
    changed: () => void,
  ) {
    this.delivered = recordings.map(deliveries);
    this.rescued = new Sheet(
      { class: 'curve', role: 'img', 'aria-label': 'Rescuees delivered over time' },
      changed,
    );
    this.levels = new Sheet(
      { class: 'curve', role: 'img', 'aria-label': 'Levels of the team over time' },
      changed,
    );
    for (const sheet of [this.rescued, this.levels]) {
      sheet.onDrag(({ offsetX }) => {
        const part = (offsetX - LEFT) / Math.max(sheet.width - LEFT - RIGHT, 1);
        clock.seek(clock.start + part * (clock.end - clock.start));
        changed();
      });
    }
    this.root = element('section', { class: 'panel curves' });
    if (recordings.some(({ header }) => header.world.rescuees.length > 0)) {
      const text = inWords(recordings[0].header.world, 'rescued');
      const title = element('h2', {}, text[0].toUpperCase() + text.slice(1), this.rescuedTold);
      this.root.append(element('div', {}, title, this.rescued.canvas));
    }
    const title = element('h2', {}, 'Levels', this.levelsTold);
    this.root.append(element('div', {}, title, this.levels.canvas));
  }

  /** Takes account of what was added to the recordings. */
  grew(): void {
    this.delivered = this.recordings.map(deliveries);
  }

  draw(focus: number): void {
    this.drawRescued(focus);
    this.drawLevels(focus);
  }

  private x(sheet: Sheet, time: number): number {
    const part = (time - this.clock.start) / Math.max(this.clock.end - this.clock.start, 1e-9);
    return LEFT + part * (sheet.width - LEFT - RIGHT);
  }

  private frame(
    sheet: Sheet,
    most: number,
    unit: string,
  ): { context: CanvasRenderingContext2D; y: (v: number) => number } {
    const context = sheet.begin();
    const colours = theme();
    const y = (value: number): number => TOP + (1 - value / most) * (sheet.height - TOP - BOTTOM);
    context.font = '10px system-ui, sans-serif';
    context.textAlign = 'right';
    context.textBaseline = 'middle';
    context.lineWidth = 1;
    for (const value of [0, most / 2, most]) {
      context.strokeStyle = colours.faint;
      drawLine(context, [LEFT, y(value)], [sheet.width - RIGHT, y(value)]);
      context.fillStyle = colours.soft;
      context.fillText(`${Number(value.toFixed(0))}${unit}`, LEFT - 5, y(value));
    }
    return { context, y };
  }

  private cursor(sheet: Sheet, context: CanvasRenderingContext2D): void {
    context.fillStyle = theme().ink;
    context.fillRect(this.x(sheet, this.clock.time) - 0.5, TOP - 4, 1, sheet.height - TOP - BOTTOM + 8);
  }

  private drawRescued(focus: number): void {
    const sheet = this.rescued;
    const longest = Math.max(1, ...this.delivered.flat().map((times) => times.length));
    const nice =
      [5, 10, 20, 40, 60, 80, 100, 150, 200, 300, 400, 600, 1000].find((n) => n >= longest) ?? longest;
    const { context, y } = this.frame(sheet, nice, '');
    const now: (Node | string)[] = [];
    this.delivered.forEach((tasks, number) => {
      tasks.forEach((times, task) => {
        context.strokeStyle = groupColour(task);
        context.globalAlpha = number === focus ? 1 : 0.7;
        context.lineWidth = number === focus ? 2 : 1.5;
        context.setLineDash(DASHES[number % DASHES.length]);
        context.beginPath();
        context.moveTo(this.x(sheet, this.recordings[number].start), y(0));
        times.forEach((time, i) => {
          context.lineTo(this.x(sheet, time), y(i));
          context.lineTo(this.x(sheet, time), y(i + 1));
        });
        context.lineTo(this.x(sheet, this.recordings[number].end), y(times.length));
        context.stroke();
      });
      context.setLineDash([]);
      context.globalAlpha = 1;
      if (number !== focus) return;
      tasks.forEach((times, task) =>
        now.push(swatch(groupColour(task)), `${countUntil(times, this.clock.time)} `),
      );
    });
    this.cursor(sheet, context);
    this.rescuedTold.replaceChildren(...now);
  }

  private drawLevels(focus: number): void {
    const sheet = this.levels;
    const { context, y } = this.frame(sheet, 100, ' %');
    const colours = theme();
    const now: (Node | string)[] = [];
    this.recordings.forEach(({ levels }, number) => {
      if (levels.length === 0) return;
      const draw = (of: 'energy' | 'hp', colour: string): void => {
        context.strokeStyle = context.fillStyle = colour;
        if (number === focus) {
          context.globalAlpha = 0.15;
          context.beginPath();
          levels.forEach((level) => context.lineTo(this.x(sheet, level.time), y(level[of][0])));
          [...levels]
            .reverse()
            .forEach((level) => context.lineTo(this.x(sheet, level.time), y(level[of][2])));
          context.fill();
        }
        context.globalAlpha = 1;
        context.lineWidth = number === focus ? 2 : 1.25;
        context.setLineDash(DASHES[number % DASHES.length]);
        context.beginPath();
        levels.forEach((level) => context.lineTo(this.x(sheet, level.time), y(level[of][1])));
        context.stroke();
        context.setLineDash([]);
      };
      draw('energy', colours.energy);
      draw('hp', colours.hp);
      if (number !== focus) return;
      const times = levels.map(({ time }) => time);
      const level = levels[Math.max(countUntil(times, this.clock.time) - 1, 0)];
      now.push(swatch(colours.energy), `energy ${level.energy[1].toFixed(0)} % `);
      now.push(
        swatch(colours.hp),
        `${inWords(this.recordings[number].header.world, 'HP')} ${level.hp[1].toFixed(0)} %`,
      );
    });
    this.cursor(sheet, context);
    this.levelsTold.replaceChildren(...now);
  }
}
