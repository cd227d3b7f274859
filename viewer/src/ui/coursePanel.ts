/** A robot's own timeline: when it stood, why, for whom and how long, and what it had on board. */

import { theme } from '../draw/theme';
import { type Course, type Delay, totals } from '../recording/course';
import type { Recording } from '../recording/recording';
import { bodyOf } from '../recording/state';
import type { Clock } from './clock';
import { Sheet, clockTime, element, swatch, words } from './dom';

/** Delays that are shorter are drawn but not listed, in seconds. */
const LISTED = 1;

/** Heights of the rows of delays and of rescuees on board, in pixels. */
const [DELAYS, LOADS] = [14, 26];

/** The colour of each cause of a delay. */
function causeColour(cause: string): string {
  const { wait, hp, soft, faint, ink, rescuee, groups } = theme();
  const colours: Record<string, string> = {
    right_of_way: wait,
    making_room: groups[3],
    blocked: groups[4],
    backing_off: groups[4],
    no_route: groups[6],
    resting: hp,
    loading: rescuee,
    nothing_to_do: faint,
    stranded: ink,
    disabled: ink,
  };
  return colours[cause] ?? soft;
}

const seconds = (stood: number): string => `${stood.toFixed(1)} s`;

export class CoursePanel {
  readonly root = element('div', { class: 'course' });
  private readonly sheet: Sheet;
  private readonly lists = element('div');
  private shown = '';
  private rows: { delay: Delay; row: HTMLElement }[] = [];

  constructor(
    private readonly clock: Clock,
    private readonly seek: (time: number) => void,
    changed: () => void,
  ) {
    const label = 'When the robot stood, and what it had on board';
    this.sheet = new Sheet({ class: 'course-canvas', role: 'img', 'aria-label': label }, changed);
    this.sheet.canvas.addEventListener('pointerdown', ({ offsetX }) => {
      const part = offsetX / Math.max(this.sheet.width, 1);
      this.seek(clock.start + part * (clock.end - clock.start));
    });
    this.root.append(element('h3', {}, 'Timeline'), this.sheet.canvas, this.lists);
  }

  draw(recording: Recording, robot: number): void {
    const course = recording.courses[robot];
    const key = [recording.name, recording.header.policy, robot, course.delays.length, theme().isDark].join();
    if (key !== this.shown) this.list(course);
    this.shown = key;
    this.drawSheet(course, bodyOf(recording.header.world, robot).capacity);
    const { time } = this.clock;
    for (const { delay, row } of this.rows) row.classList.toggle('on', delay.from <= time && time < delay.to);
  }

  private list({ delays }: Course): void {
    const sums = element('table', { class: 'facts' });
    for (const { cause, stood, robots } of totals(delays)) {
      const whom = robots.map(([robot, part]) => `${seconds(part)} for robot ${robot}`).join(', ');
      const name = element('th', { scope: 'row' }, swatch(causeColour(cause)), words(cause));
      sums.append(element('tr', {}, name, element('td', {}, seconds(stood), whom && `: ${whom}`)));
    }
    const listed = delays.filter(({ stood }) => stood >= LISTED);
    this.rows = listed.map((delay) => ({ delay, row: this.row(delay) }));
    const table = element('table', { class: 'facts' }, ...this.rows.map(({ row }) => row));
    this.lists.replaceChildren(sums, element('div', { class: 'delays' }, table));
  }

  private row({ from, cause, waitsFor, stood }: Delay): HTMLElement {
    const whom = waitsFor === null ? '' : ` for robot ${waitsFor}`;
    const what = element('td', {}, words(cause) + whom);
    const row = element('tr', {}, element('th', { scope: 'row' }, clockTime(from)), what);
    row.append(element('td', { class: 'value' }, seconds(stood)));
    row.addEventListener('click', () => this.seek(from));
    return row;
  }

  private drawSheet({ delays, loads }: Course, capacity: number): void {
    const context = this.sheet.begin();
    const { start, end, time } = this.clock;
    const x = (at: number): number => ((at - start) / Math.max(end - start, 1e-9)) * this.sheet.width;
    context.fillStyle = theme().ground;
    context.fillRect(0, 0, this.sheet.width, DELAYS);
    for (const { from, to, cause } of delays) {
      context.fillStyle = causeColour(cause);
      context.fillRect(x(from), 0, Math.max(x(to) - x(from), 1), DELAYS);
    }
    context.fillStyle = theme().soft;
    loads.forEach(({ time: from, load }, i) => {
      const height = (LOADS * load) / Math.max(capacity, 1);
      const to = loads.at(i + 1)?.time ?? end;
      context.fillRect(x(from), DELAYS + 4 + LOADS - height, x(to) - x(from), height);
    });
    context.fillStyle = theme().faint;
    context.fillRect(0, DELAYS + 4 + LOADS, this.sheet.width, 1);
    context.fillStyle = theme().ink;
    context.fillRect(x(time) - 0.75, 0, 1.5, this.sheet.height);
  }
}
