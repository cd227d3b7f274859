/** Draws what stands around robots: their numbers, levels, and rescuees on board. Where there is no room for
 * a number or for levels, they are left out. */

import type { MotionField } from '../recording/segment';
import { Robot } from '../recording/robotRow';
import { numberOf } from '../recording/state';
import type { Point } from '../recording/types';
import { boxAt } from './labels';
import { addDisc, drawLine, writeRimmed } from './marks';
import { LARGE_TEAM, type Sheet } from './sheet';

/** Height of a number, in pixels. */
const LINE = 11;

/** Levels are drawn from this scale on, in pixels of a metre. */
const LEVELS_SCALE = 4.5;

/** Draws what stands around the robots in view, that of the selected robot first. */
export function drawAround(sheet: Sheet, places: Point[], radii: number[]): void {
  const { camera, looks, labels } = sheet;
  const isInView = ([x, y]: Point): boolean => x >= 0 && y >= 0 && x <= camera.width && y <= camera.height;
  const robots = [...places.keys()].filter((robot) => isInView(places[robot]));
  if (looks.selected !== null)
    robots.sort((a, b) => Number(b === looks.selected) - Number(a === looks.selected));
  if (robots.length > LARGE_TEAM) robots.length = robots[0] === looks.selected ? 1 : 0;
  const isDetailed = camera.scale > LEVELS_SCALE;
  for (const robot of robots) {
    const size = 2 * radii[robot] + (robot === looks.selected ? 10 : 0);
    labels.take(boxAt(places[robot], [size, size]));
    if (isDetailed) drawLoad(sheet, places[robot], radii[robot], robot);
  }
  drawNumbers(sheet, robots, places, radii);
  if (!isDetailed) return;
  for (const robot of robots) drawLevels(sheet, places[robot], radii[robot], robot);
}

function drawNumbers(
  { context, looks, colours, labels }: Sheet,
  robots: number[],
  places: Point[],
  radii: number[],
): void {
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.lineJoin = 'round';
  for (const robot of robots) {
    context.font = `${robot === looks.selected ? 'bold ' : ''}11px system-ui, sans-serif`;
    const text = String(robot);
    const place = labels.place(robot, places[robot], radii[robot], [
      context.measureText(text).width + 5,
      LINE,
    ]);
    if (!place) continue;
    if (place.isFar) drawLead(context, colours.soft, places[robot], place.middle);
    writeRimmed(context, text, place.middle, [colours.ink, colours.ground]);
  }
}

/** From a robot to its number that stands apart. */
function drawLead(context: CanvasRenderingContext2D, colour: string, from: Point, to: Point): void {
  context.strokeStyle = colour;
  context.lineWidth = 0.75;
  drawLine(context, from, to);
}

/** Energy and HP as two bars below a robot. */
function drawLevels(
  { context, moment, colours, labels }: Sheet,
  [x, y]: Point,
  radius: number,
  robot: number,
): void {
  const width = Math.max(14, 2 * radius);
  const box = boxAt([x, y + radius + 5.5], [width + 1, 6]);
  if (!labels.isFree(box)) return;
  labels.take(box);
  const bar = (field: MotionField, row: number, colour: string): void => {
    const level = Math.min(Math.max(moment.segment.motion(robot, field, moment.frame) / 100_000, 0), 1);
    const top = y + radius + 3 + 3 * row;
    context.fillStyle = colours.halo;
    context.fillRect(x - width / 2 - 0.5, top - 0.5, width + 1, 3);
    context.fillStyle = colours.faint;
    context.fillRect(x - width / 2, top, width, 2);
    context.fillStyle = colour;
    context.fillRect(x - width / 2, top, width * level, 2);
  };
  bar('energy_millipercent', 0, colours.energy);
  bar('hp_millipercent', 1, colours.hp);
}

/** The rescuees on board as dots above a robot. */
function drawLoad(
  { context, moment, colours, labels }: Sheet,
  [x, y]: Point,
  radius: number,
  robot: number,
): void {
  const load = Math.min(numberOf(moment, robot, Robot.Load), 12);
  if (load === 0) return;
  labels.take(boxAt([x, y - radius - 4], [4 * load, 4]));
  context.fillStyle = colours.rescuee;
  context.beginPath();
  for (let i = 0; i < load; i++) {
    addDisc(context, x + (i - (load - 1) / 2) * 4, y - radius - 4, 1.5);
  }
  context.fill();
}
