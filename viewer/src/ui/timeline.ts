/** The time from beginning to end, with what happened on it: rounds, decisions, deadlocks, rests, losses. */

import { drawLine, fillDisc } from '../draw/marks';
import { theme } from '../draw/theme';
import type { Happening, Recording } from '../recording/recording';
import type { Clock } from './clock';
import { Sheet, clockTime, element } from './dom';

const LEFT = 10;

interface Band {
  number: number;
  from: number;
  to: number;
}

/** The rounds of a recording, as far as they were begun. */
export function rounds(recording: Recording): Band[] {
  const begins = recording.happenings.filter(({ kind }) => kind === 'RoundStarted');
  return begins.map(({ time, fields }, i) => ({
    number: Number(fields.round),
    from: time,
    to: begins[i + 1]?.time ?? recording.end,
  }));
}

const LOSSES = ['Stranded', 'Disabled'];

/** What the timeline of a scenario asks for. */
const ASKED_FOR = [
  'DebrisFell',
  'WayClosed',
  'WayOpened',
  'CalledOff',
  'SourceAppeared',
  'SourceDied',
  'Damaged',
  'RescueesAppeared',
  'TaskBegan',
  'TaskEnded',
  'BeganToLie',
  'BecameHonest',
  'Slowed',
  'Faded',
  'Muted',
];

export class Timeline {
  readonly root: HTMLElement;
  private readonly sheet: Sheet;

  constructor(
    private readonly clock: Clock,
    private readonly recordings: readonly Recording[],
    private readonly changed: () => void,
  ) {
    this.sheet = new Sheet(
      { class: 'timeline-canvas', role: 'slider', tabindex: '0', 'aria-label': 'Time' },
      changed,
    );
    this.sheet.canvas.style.height = `${22 + 24 * recordings.length}px`;
    const legend = element('div', { class: 'timeline-legend' });
    for (const [sign, text] of [
      ['▏', 'round and decision'],
      ['◆', 'deadlock'],
      ['●', 'rest'],
      ['✕', 'loss'],
      ['▼', 'event of the scenario'],
    ]) {
      legend.append(
        element('span', {}, element('i', { class: `sign-${text.split(' ')[0]}` }, sign), ` ${text}`),
      );
    }
    this.root = element('div', { class: 'timeline' }, this.sheet.canvas, legend);
    this.sheet.onDrag((event) => this.seek(event));
  }

  private x(time: number): number {
    const { start, end } = this.clock;
    return LEFT + ((time - start) / Math.max(end - start, 1e-9)) * (this.sheet.width - 2 * LEFT);
  }

  private seek(event: PointerEvent): void {
    const { left } = this.sheet.canvas.getBoundingClientRect();
    const part = (event.clientX - left - LEFT) / Math.max(this.sheet.width - 2 * LEFT, 1);
    this.clock.seek(this.clock.start + part * (this.clock.end - this.clock.start));
    this.changed();
  }

  draw(): void {
    const context = this.sheet.begin();
    const colours = theme();
    const { canvas, height } = this.sheet;
    canvas.setAttribute('aria-valuemin', this.clock.start.toFixed(0));
    canvas.setAttribute('aria-valuemax', this.clock.end.toFixed(0));
    canvas.setAttribute('aria-valuenow', this.clock.time.toFixed(1));
    canvas.setAttribute('aria-valuetext', clockTime(this.clock.time));
    context.font = '11px system-ui, sans-serif';
    context.textBaseline = 'middle';
    this.recordings.forEach((recording, lane) => this.drawLane(context, recording, 2 + 24 * lane));
    context.fillStyle = colours.soft;
    const labels = Math.min(Math.max(this.sheet.width / 64, 2), 12);
    const length = this.clock.end - this.clock.start;
    const step = [1, 2, 5, 10, 30, 60, 120, 300, 600, 1200].find((s) => length / s <= labels) ?? 3600;
    context.textAlign = 'center';
    for (let time = Math.ceil(this.clock.start / step) * step; time <= this.clock.end; time += step) {
      const label = clockTime(time).slice(0, -2);
      context.fillText(
        label,
        Math.min(Math.max(this.x(time), LEFT + 6), this.sheet.width - LEFT - 10),
        height - 8,
      );
    }
    const x = this.x(this.clock.time);
    context.fillStyle = colours.ink;
    context.fillRect(x - 1, 0, 2, height - 17);
    fillDisc(context, x, height - 17, 4.5);
  }

  private drawLane(context: CanvasRenderingContext2D, recording: Recording, top: number): void {
    const colours = theme();
    const middle = top + 10;
    for (const { number, from, to } of rounds(recording)) {
      const [left, width] = [this.x(from), this.x(to) - this.x(from)];
      context.fillStyle = colours.faint;
      context.globalAlpha = number % 2 ? 0.9 : 0.45;
      context.fillRect(left, top, width, 20);
      context.globalAlpha = 1;
      context.fillStyle = colours.ink;
      context.fillRect(left, top, 1.5, 20);
      context.textAlign = 'left';
      context.fillStyle = colours.soft;
      if (width > 24) context.fillText(String(number), left + 5, middle);
    }
    const marks = (kinds: string[], mark: (x: number, happening: Happening) => void): void => {
      for (const happening of recording.happenings) {
        if (kinds.includes(happening.kind)) mark(this.x(happening.time), happening);
      }
    };
    context.globalAlpha = 0.85;
    context.fillStyle = colours.hp;
    marks(['RestStarted'], (x) => fillDisc(context, x, middle + 5, 2.5));
    context.fillStyle = colours.groups[4];
    marks(['Deadlocked'], (x) => {
      context.beginPath();
      context.moveTo(x, top + 1);
      context.lineTo(x + 3, top + 4.5);
      context.lineTo(x, top + 8);
      context.lineTo(x - 3, top + 4.5);
      context.fill();
    });
    context.globalAlpha = 1;
    context.fillStyle = colours.ink;
    marks(ASKED_FOR, (x) => {
      context.beginPath();
      context.moveTo(x - 3.5, top);
      context.lineTo(x + 3.5, top);
      context.lineTo(x, top + 6);
      context.fill();
    });
    context.strokeStyle = colours.ink;
    context.lineWidth = 1.75;
    marks(LOSSES, (x) => {
      drawLine(context, [x - 3.5, middle - 3.5], [x + 3.5, middle + 3.5]);
      drawLine(context, [x + 3.5, middle - 3.5], [x - 3.5, middle + 3.5]);
    });
  }
}
