/** The messages of the last second: those that were heard late, and those that were lost. */

import type { Happening } from '../recording/recording';
import type { Point } from '../recording/types';
import { drawLine } from './marks';
import type { Sheet } from './sheet';

/** How long a message is shown, in seconds. */
const SHOWN = 1;

/** The messages that became known within the last second before a time, the first one first. */
export function messagesAt(happenings: readonly Happening[], now: number): Happening[] {
  let [low, high] = [0, happenings.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (happenings[middle].time <= now) low = middle + 1;
    else high = middle;
  }
  const found: Happening[] = [];
  for (let i = low - 1; i >= 0 && happenings[i].time > now - SHOWN; i--)
    if (happenings[i].kind === 'Heard' || happenings[i].kind === 'Lost') found.unshift(happenings[i]);
  return found;
}

/** Draws messages as lines that fade; lost ones are dashed and end halfway. The base is amid the homes. */
export function drawMessages(sheet: Sheet, places: Point[]): void {
  const { context, recording, moment, camera, colours } = sheet;
  const now = recording.timeOf(moment.segment.firstFrame + moment.frame + moment.part);
  const homes = recording.header.world.robots.map(({ home }) => home);
  const mean = (axis: 0 | 1): number => homes.reduce((sum, home) => sum + home[axis], 0) / homes.length;
  const base = camera.toScreen([mean(0), mean(1)]);
  context.lineWidth = 1.5;
  for (const { time, kind, fields } of messagesAt(recording.happenings, now)) {
    const [x, y] = places[Number(fields.robot)];
    const [toX, toY] = typeof fields.to === 'number' ? places[fields.to] : base;
    const isLost = kind === 'Lost';
    const part = isLost ? 0.5 : 1;
    context.globalAlpha = 1 - (now - time) / SHOWN;
    context.strokeStyle = isLost ? colours.wait : colours.energy;
    context.setLineDash(isLost ? [4, 4] : []);
    drawLine(context, [x, y], [x + part * (toX - x), y + part * (toY - y)]);
  }
  context.globalAlpha = 1;
  context.setLineDash([]);
}
