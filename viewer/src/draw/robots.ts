/** Draws robots: where they were, where they go, what they are like, and who waits for whom. */

import type { Moment } from '../recording/recording';
import { type MotionField, Stream } from '../recording/segment';
import { Robot, bodyOf, numberOf, routeAt, taskOf } from '../recording/state';
import type { Point } from '../recording/types';
import { addShape, shapesOf } from './shapes';
import { LARGE_TEAM, type Sheet } from './sheet';
import { type Theme, groupColour } from './theme';

/** How long a trail is, in frames. */
const TRAIL = 40;

/** Robots are drawn at least this large, in pixels. */
const LEAST_RADIUS = 5.5;

export function drawTrails({ context, camera, recording, moment }: Sheet, places: Point[]): void {
  const { segment, frame } = moment;
  const before = recording.segmentOf(segment.firstFrame - 1);
  context.lineWidth = 2;
  context.lineCap = 'round';
  places.forEach((place, robot) => {
    context.strokeStyle = groupColour(taskOf(moment, robot));
    let last = place;
    for (let back = 0; back < TRAIL; back += 4) {
      const isBefore = back > frame;
      const from = isBefore ? before : segment;
      const at = isBefore ? (before?.frames ?? 0) + frame - back : frame - back;
      if (!from || at < 0) break;
      const next = camera.toScreen([
        from.motion(robot, 'x_mm', at) / 1000,
        from.motion(robot, 'y_mm', at) / 1000,
      ]);
      context.globalAlpha = 0.38 * (1 - back / TRAIL);
      context.beginPath();
      context.moveTo(...last);
      context.lineTo(...next);
      context.stroke();
      last = next;
    }
  });
  context.globalAlpha = 1;
  context.lineCap = 'butt';
}

export function drawRoutes(sheet: Sheet, places: Point[]): void {
  const { context, camera, moment, looks } = sheet;
  const paths = new Map<string, Path2D>();
  const add = (robot: number): void => {
    const { ahead } = routeAt(moment, robot);
    if (ahead.length === 0) return;
    const colour = groupColour(taskOf(moment, robot));
    const path = paths.get(colour) ?? new Path2D();
    paths.set(colour, path);
    path.moveTo(...places[robot]);
    for (const point of ahead) path.lineTo(...camera.toScreen(point));
  };
  const stroke = (width: number, alpha: number): void => {
    context.lineWidth = width;
    context.globalAlpha = alpha;
    for (const [colour, path] of paths) {
      context.strokeStyle = colour;
      context.stroke(path);
    }
    paths.clear();
    context.globalAlpha = 1;
  };
  if (looks.routes)
    places.forEach((_, robot) => {
      add(robot);
    });
  stroke(1, 0.32);
  if (looks.selected === null || looks.selected >= places.length) return;
  add(looks.selected);
  stroke(2, 0.95);
  drawGoal(sheet, looks.selected);
}

function drawGoal({ context, camera, moment, colours }: Sheet, robot: number): void {
  const { goal } = routeAt(moment, robot);
  if (!goal) return;
  const [x, y] = camera.toScreen(goal);
  context.strokeStyle = colours.ink;
  context.lineWidth = 2;
  context.beginPath();
  context.moveTo(x - 5, y);
  context.lineTo(x + 5, y);
  context.moveTo(x, y - 5);
  context.lineTo(x, y + 5);
  context.stroke();
}

export function drawRobots(
  { context, camera, recording, moment, looks, colours }: Sheet,
  places: Point[],
): void {
  const { world, codes } = recording.header;
  const shapes = shapesOf(world.roles);
  const isLarge = places.length > LARGE_TEAM;
  const radiusOf = (robot: number): number => {
    const radius = bodyOf(world, robot).radius_m * camera.scale;
    return isLarge ? Math.max(radius, 2.2) : Math.max(radius, LEAST_RADIUS);
  };
  const paths = new Map<string, Path2D>();
  const lost = new Path2D();
  places.forEach(([x, y], robot) => {
    const colour = groupColour(taskOf(moment, robot));
    if (!paths.has(colour)) paths.set(colour, new Path2D());
    const radius = radiusOf(robot);
    addShape(paths.get(colour)!, shapes[world.robots[robot].role], x, y, radius);
    if (codes.conditions[numberOf(moment, robot, Robot.Condition)] !== 'able') {
      lost.moveTo(x - radius, y - radius);
      lost.lineTo(x + radius, y + radius);
      lost.moveTo(x + radius, y - radius);
      lost.lineTo(x - radius, y + radius);
    }
  });
  for (const [colour, path] of paths) {
    context.fillStyle = colour;
    context.fill(path);
    if (isLarge) continue;
    context.strokeStyle = colours.halo;
    context.lineWidth = 1.25;
    context.stroke(path);
  }
  context.strokeStyle = colours.ink;
  context.lineWidth = 2;
  context.stroke(lost);
  if (!isLarge && camera.scale > 4.5)
    places.forEach((place, robot) => {
      drawBars(context, place, radiusOf(robot), moment, robot, colours);
    });
  if (!isLarge && camera.scale > 15) {
    context.font = '11px system-ui, sans-serif';
    context.textAlign = 'left';
    context.textBaseline = 'middle';
    context.fillStyle = colours.ink;
    places.forEach(([x, y], robot) => {
      context.fillText(String(robot), x + radiusOf(robot) + 4, y);
    });
  }
  if (looks.selected !== null && looks.selected < places.length) {
    const [x, y] = places[looks.selected];
    context.beginPath();
    context.arc(x, y, radiusOf(looks.selected) + 5, 0, 2 * Math.PI);
    context.lineWidth = 2;
    context.strokeStyle = colours.ink;
    context.stroke();
  }
}

/** Energy and HP as two bars below a robot, and the rescuees on board as dots above it. */
function drawBars(
  context: CanvasRenderingContext2D,
  [x, y]: Point,
  radius: number,
  moment: Moment,
  robot: number,
  colours: Theme,
): void {
  const width = Math.max(14, 2 * radius);
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
  const load = Math.min(numberOf(moment, robot, Robot.Load), 12);
  if (load === 0) return;
  context.fillStyle = colours.rescuee;
  context.beginPath();
  for (let i = 0; i < load; i++) {
    const cx = x + (i - (load - 1) / 2) * 4;
    context.moveTo(cx + 1.5, y - radius - 4);
    context.arc(cx, y - radius - 4, 1.5, 0, 2 * Math.PI);
  }
  context.fill();
}

/** The members of conflict sets in rings; that of the one with the right of way is whole. */
export function drawConflicts({ context, moment, colours }: Sheet, places: Point[]): void {
  const row = moment.segment.row(Stream.Conflicts, 0, moment.frame);
  context.strokeStyle = colours.wait;
  context.lineWidth = 1.25;
  for (let at = 0; at < row.length; at += row[at] + 1) {
    row.slice(at + 1, at + 1 + row[at]).forEach((robot, rank) => {
      if (robot >= places.length) return;
      const [x, y] = places[robot];
      context.setLineDash(rank === 0 ? [] : [2, 2.5]);
      context.beginPath();
      context.arc(x, y, LEAST_RADIUS + 3.5, 0, 2 * Math.PI);
      context.stroke();
    });
  }
  context.setLineDash([]);
}

/** From each robot that waits to the robot that it waits for. */
export function drawLinks({ context, moment, colours }: Sheet, places: Point[]): void {
  context.strokeStyle = context.fillStyle = colours.wait;
  context.lineWidth = 1.5;
  places.forEach(([x, y], robot) => {
    const other = numberOf(moment, robot, Robot.WaitsFor) - 1;
    if (other < 0 || other >= places.length) return;
    const [toX, toY] = places[other];
    const length = Math.hypot(toX - x, toY - y);
    if (length < 1) return;
    const [dx, dy] = [(toX - x) / length, (toY - y) / length];
    const [endX, endY] = [toX - dx * 8, toY - dy * 8];
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(endX, endY);
    context.stroke();
    context.beginPath();
    context.moveTo(endX + dx * 5, endY + dy * 5);
    context.lineTo(endX - dy * 3.5, endY + dx * 3.5);
    context.lineTo(endX + dy * 3.5, endY - dx * 3.5);
    context.fill();
  });
}
