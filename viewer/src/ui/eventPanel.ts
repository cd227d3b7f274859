/** What happened last: to the whole team, or to one robot. */

import type { Happening, Recording } from '../recording/recording';
import { clockTime, element } from './dom';

/** So many events are listed. */
const LISTED = 8;

/** Events of single robots that are so frequent that they are not listed for the team. */
const FREQUENT = ['ConflictStarted', 'Sighted', 'Restocked', 'DebrisDiscovered', 'ZoneDiscovered'];

/** A kind of event in words: `RestStarted` is "rest started". */
const spoken = (name: string): string =>
  name
    .replace(/([a-z])([A-Z])/g, '$1 $2')
    .replaceAll('_', ' ')
    .toLowerCase();

function valueText(value: unknown): string {
  if (Array.isArray(value)) return value.map(valueText).join(' ');
  if (typeof value === 'number') return String(Number(value.toFixed(2)));
  return typeof value === 'string' ? spoken(value) : '';
}

/** An event in words. */
export function eventText({ kind, fields }: Happening): string {
  const parts = Object.entries(fields)
    .filter(([name]) => name !== 'groups')
    .map(([name, value]) => `${spoken(name)} ${valueText(value)}`);
  return [spoken(kind), ...parts].join(', ');
}

/** Whether an event is about a robot. */
export function concerns({ fields }: Happening, robot: number): boolean {
  const { robot: one, robots: some, room_for: other, resource_of: giver } = fields;
  return [one, other, giver].includes(robot) || (Array.isArray(some) && some.includes(robot));
}

export class EventPanel {
  readonly root = element('section', { class: 'panel events' });
  private shown = '';

  constructor(private readonly seek: (time: number) => void) {}

  draw(recording: Recording, time: number, robot: number | null): void {
    const { happenings } = recording;
    const last: Happening[] = [];
    for (let at = happenings.length - 1; at >= 0 && last.length < LISTED; at--) {
      const happening = happenings[at];
      if (happening.time > time + 1e-9) continue;
      const isListed = robot === null ? !FREQUENT.includes(happening.kind) : concerns(happening, robot);
      if (isListed) last.push(happening);
    }
    const lines = last.map((happening) => [clockTime(happening.time), eventText(happening)]);
    const key = JSON.stringify([robot, lines]);
    if (key === this.shown) return;
    this.shown = key;
    const table = element('table', { class: 'facts' });
    lines.forEach(([when, text], i) => {
      const row = element('tr', {}, element('th', { scope: 'row' }, when), element('td', {}, text));
      row.addEventListener('click', () => this.seek(last[i].time));
      table.append(row);
    });
    const title = robot === null ? 'Events' : `Events of robot ${robot}`;
    this.root.replaceChildren(element('h2', {}, title), table);
  }
}
