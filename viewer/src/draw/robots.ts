/** Draws robots: where they were, where they go, what they are like, and who waits for whom. */

import { Stream } from '../recording/segment';
import { Robot } from '../recording/robotRow';
import { bodyOf, numberOf, routeAt, taskOf } from '../recording/state';
import type { Point } from '../recording/types';
import { drawLine } from './marks';
import { addShape, shapesOf } from './shapes';
import { LARGE_TEAM, type Sheet } from './sheet';
import { groupColour } from './theme';

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
      drawLine(context, last, next);
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
  if (looks.routes) places.forEach((_, robot) => add(robot));
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
  drawLine(context, [x - 5, y], [x + 5, y]);
  drawLine(context, [x, y - 5], [x, y + 5]);
}

/** How large robots are drawn, in pixels. */
export function radiiOf({ camera, recording }: Sheet): number[] {
  const { world } = recording.header;
  const least = world.robots.length > LARGE_TEAM ? 2.2 : LEAST_RADIUS;
  return world.robots.map((_, robot) => Math.max(bodyOf(world, robot).radius_m * camera.scale, least));
}

export function drawRobots(sheet: Sheet, places: Point[], radii: number[]): void {
  const { context, recording, moment, looks, colours } = sheet;
  const { world, codes } = recording.header;
  const shapes = shapesOf(world.roles);
  const paths = new Map<string, Path2D>();
  const lost = new Path2D();
  places.forEach(([x, y], robot) => {
    const colour = groupColour(taskOf(moment, robot));
    if (!paths.has(colour)) paths.set(colour, new Path2D());
    const radius = radii[robot];
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
    if (places.length > LARGE_TEAM) continue;
    context.strokeStyle = colours.halo;
    context.lineWidth = 1.25;
    context.stroke(path);
  }
  context.strokeStyle = colours.ink;
  context.lineWidth = 2;
  context.stroke(lost);
  if (looks.selected === null || looks.selected >= places.length) return;
  context.beginPath();
  context.arc(...places[looks.selected], radii[looks.selected] + 5, 0, 2 * Math.PI);
  context.stroke();
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
    drawLine(context, [x, y], [endX, endY]);
    context.beginPath();
    context.moveTo(endX + dx * 5, endY + dy * 5);
    context.lineTo(endX - dy * 3.5, endY + dx * 3.5);
    context.lineTo(endX + dy * 3.5, endY - dx * 3.5);
    context.fill();
  });
}
