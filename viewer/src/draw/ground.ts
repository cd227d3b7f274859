/** Draws what robots move among: the floor, places, radiation, debris, rescuees. */

import { Stream } from '../recording/segment';
import { knownBy, taskOf, zonesOn } from '../recording/state';
import type { Point } from '../recording/types';
import { boxAt } from './labels';
import { addDisc, writeRimmed } from './marks';
import { addDebris } from './shapes';
import type { Sheet } from './sheet';
import { groupColour } from './theme';

function roundedBox(context: CanvasRenderingContext2D, center: Point, size: Point, radius: number): void {
  context.beginPath();
  context.roundRect(center[0] - size[0] / 2, center[1] - size[1] / 2, size[0], size[1], radius);
}

/** The floor with its grid of 10 m, the walls, the places of the tasks. In metres. */
export function drawGround({ context, ratio, camera, recording, colours }: Sheet): void {
  const { world } = recording.header;
  const [width, height] = world.arena_m;
  const pixel = 1 / camera.scale;
  camera.apply(context, ratio);
  context.fillStyle = colours.ground;
  context.fillRect(0, 0, width, height);
  context.strokeStyle = colours.faint;
  context.lineWidth = 0.5 * pixel;
  context.globalAlpha = 0.8;
  context.beginPath();
  for (let x = 10; x < width; x += 10) {
    context.moveTo(x, 0);
    context.lineTo(x, height);
  }
  for (let y = 10; y < height; y += 10) {
    context.moveTo(0, y);
    context.lineTo(width, y);
  }
  context.stroke();
  context.globalAlpha = 1;
  world.tasks.forEach((task, number) => {
    const colour = groupColour(number);
    roundedBox(context, task.center, [task.size_m[0] + 3, task.size_m[1] + 3], 1.5);
    context.fillStyle = colour;
    context.globalAlpha = 0.07;
    context.fill();
    context.globalAlpha = 0.55;
    context.strokeStyle = colour;
    context.lineWidth = pixel;
    context.stroke();
    const slots = world.robots.map((robot) => robot.rest[number]);
    const extent = (axis: 0 | 1): number =>
      Math.max(...slots.map((slot) => Math.abs(slot[axis] - task.rest[axis])));
    if (slots.length > 0) {
      roundedBox(context, task.rest, [2 * extent(0) + 2, 2 * extent(1) + 2], 1);
      context.setLineDash([4 * pixel, 3 * pixel]);
      context.stroke();
      context.setLineDash([]);
    }
    context.globalAlpha = 1;
  });
  context.fillStyle = colours.faint;
  const homes = new Path2D();
  for (const { home } of world.robots) addDisc(homes, ...home, 0.5);
  context.fill(homes);
  const wall = Math.max(3 * pixel, 0.3);
  context.strokeStyle = colours.wall;
  context.lineWidth = wall;
  context.strokeRect(-wall / 2, -wall / 2, width + wall, height + wall);
}

/** What the places are for. In pixels. */
export function drawNames({ context, camera, recording, colours, labels }: Sheet): void {
  const { world } = recording.header;
  context.font = '12px system-ui, sans-serif';
  context.textAlign = 'center';
  context.textBaseline = 'middle';
  context.lineJoin = 'round';
  const write = (text: string, [x, y]: Point, colour: string): void => {
    const [left, top] = camera.toScreen([x, y]);
    const box = boxAt([left, top - 9], [context.measureText(text).width, 13]);
    if (!labels.isFree(box)) return;
    labels.take(box);
    writeRimmed(context, text, [left, top - 9], [colour, colours.ground]);
  };
  world.tasks.forEach((task, number) => {
    const top = task.center[1] + task.size_m[1] / 2 + 1.5;
    const isAtWall = (world.arena_m[1] - top) * camera.scale < 18;
    // At the wall, the name stands beside the area: robots come from below.
    const aside = task.size_m[0] / 2 + 1.5 + (context.measureText(task.name).width / 2 + 5) / camera.scale;
    const toRight = task.center[0] < world.arena_m[0] / 2 ? aside : -aside;
    const at: Point = isAtWall
      ? [task.center[0] + toRight, task.center[1] - 9 / camera.scale]
      : [task.center[0], top];
    write(task.name, at, groupColour(number));
    const restTop = Math.max(...world.robots.map((robot) => robot.rest[number][1]), task.rest[1]);
    if (camera.scale > 5) write('rest', [task.rest[0], restTop + 1], colours.soft);
  });
  if (camera.scale > 5 && world.robots.length > 0 && world.tasks.length > 0) {
    const homes = world.robots.map(({ home }) => home);
    // Below, where robots that leave do not cover it.
    const bottom = Math.min(...homes.map(([, y]) => y)) - 1 - 18 / camera.scale;
    const middle = homes.reduce((sum, [x]) => sum + x, 0) / homes.length;
    write('home', [middle, bottom], colours.soft);
  }
}

let glow: { of: string; picture: HTMLCanvasElement } | null = null;

/** A soft disc, drawn once. */
function glowPicture(colour: string): HTMLCanvasElement {
  if (glow?.of === colour) return glow.picture;
  const picture = document.createElement('canvas');
  picture.width = picture.height = 256;
  const context = picture.getContext('2d')!;
  const gradient = context.createRadialGradient(128, 128, 0, 128, 128, 128);
  for (const [at, alpha] of [
    [0, 0.5],
    [0.35, 0.34],
    [0.7, 0.16],
    [0.96, 0.08],
    [1, 0],
  ]) {
    gradient.addColorStop(at, `rgba(${colour}, ${alpha})`);
  }
  context.fillStyle = gradient;
  context.fillRect(0, 0, 256, 256);
  glow = { of: colour, picture };
  return picture;
}

/** Radiation and debris: as they are, or as a group knows them. In metres. */
export function drawGroundObjects({ context, camera, recording, moment, looks, colours }: Sheet): void {
  const { world } = recording.header;
  const pixel = 1 / camera.scale;
  const known = looks.viewpoint === null ? null : knownBy(moment, looks.viewpoint);
  const picture = glowPicture(colours.radiation);
  const on = zonesOn(recording, moment);
  world.zones.forEach(({ at: [x, y], radius_m: radius }, number) => {
    if (!on.has(number)) return;
    const isKnown = known?.zones.has(number) ?? true;
    if (isKnown) context.drawImage(picture, x - radius, y - radius, 2 * radius, 2 * radius);
    context.beginPath();
    context.arc(x, y, radius, 0, 2 * Math.PI);
    context.strokeStyle = colours.radiationEdge;
    context.globalAlpha = isKnown ? 0.5 : 0.35;
    context.lineWidth = pixel;
    context.setLineDash(isKnown ? [] : [2 * pixel, 4 * pixel]);
    context.stroke();
    context.setLineDash([]);
    context.globalAlpha = 1;
  });
  const [fixed, movable, unknown, handles] = [new Path2D(), new Path2D(), new Path2D(), new Path2D()];
  world.debris.forEach((piece, number) => {
    const row = moment.segment.row(Stream.Debris, number, moment.frame);
    const [x, y, angle] = [row[0] / 1000, row[1] / 1000, row[2] / 10000];
    const isKnown = known?.debris.has(number) ?? true;
    addDebris(isKnown ? (piece.movable ? movable : fixed) : unknown, piece, x, y, angle);
    if (piece.movable && isKnown) addDisc(handles, x, y, 0.16);
  });
  context.lineWidth = pixel;
  context.fillStyle = colours.debris;
  context.fill(fixed);
  context.fillStyle = colours.movable;
  context.fill(movable);
  context.strokeStyle = colours.wall;
  context.stroke(movable);
  context.globalAlpha = 0.6;
  context.stroke(fixed);
  context.globalAlpha = 1;
  context.fillStyle = colours.wall;
  context.fill(handles);
  context.setLineDash([2 * pixel, 3 * pixel]);
  context.strokeStyle = colours.soft;
  context.stroke(unknown);
  context.setLineDash([]);
}

/** Rescuees: waiting, claimed, gone on board (an empty place), delivered (a faint place). */
export function drawRescuees({ context, camera, recording, moment, colours }: Sheet): void {
  const { world } = recording.header;
  const least = world.rescuees.length > 1000 ? 0.6 : 1.25;
  const radius = Math.min(Math.max(0.16 * camera.scale, least), 6);
  const [waiting, gone, delivered] = [new Path2D(), new Path2D(), new Path2D()];
  const claimed = new Map<number | null, Path2D>();
  world.rescuees.forEach((at, number) => {
    const [state, robot] = moment.segment.row(Stream.Rescuees, number, moment.frame);
    const [x, y] = camera.toScreen(at);
    const add = (path: Path2D, r: number): void => {
      // A square looks the same where it is small, and is faster where there are thousands.
      if (r < 2) path.rect(x - r, y - r, 2 * r, 2 * r);
      else addDisc(path, x, y, r);
    };
    if (state <= 1) add(waiting, radius);
    if (state === 1) {
      const key = taskOf(moment, robot - 1);
      if (!claimed.has(key)) claimed.set(key, new Path2D());
      add(claimed.get(key)!, radius + 2.5);
    }
    if (state === 2) add(gone, radius);
    if (state === 3) add(delivered, Math.max(radius * 0.55, 0.8));
  });
  context.fillStyle = colours.rescuee;
  context.fill(waiting);
  context.lineWidth = 1.5;
  for (const [task, path] of claimed) {
    context.strokeStyle = groupColour(task);
    context.stroke(path);
  }
  context.lineWidth = 1;
  context.strokeStyle = colours.soft;
  context.stroke(gone);
  context.globalAlpha = 0.45;
  context.fillStyle = colours.soft;
  context.fill(delivered);
  context.globalAlpha = 1;
}
