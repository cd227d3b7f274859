/** Draws the state at a moment from above. */

import type { Moment, Recording } from '../recording/recording';
import { Stream } from '../recording/segment';
import { knownBy, positionOf, routeAt } from '../recording/state';
import type { Point } from '../recording/types';
import type { Camera } from './camera';
import { addDebris, addShape, shapesOf } from './shapes';
import { type Theme, groupColour, theme } from './theme';

/** What is shown besides the state. */
export interface Looks {
  /** Whose knowledge is shown: a task's number, that of tasks for the team at home, null for the truth. */
  viewpoint: number | null;
  routes: boolean;
  links: boolean;
  selected: number | null;
}

/** Teams that are larger than this are drawn without bars and trails. */
const LARGE_TEAM = 150;

/** How long a trail is, in frames. */
const TRAIL = 40;

const LEAST_RADIUS = 5.5;

/** What a drawing needs all along. */
interface Sheet {
  context: CanvasRenderingContext2D;
  ratio: number;
  camera: Camera;
  recording: Recording;
  moment: Moment;
  looks: Looks;
  colours: Theme;
}

export function drawScene(
  context: CanvasRenderingContext2D,
  ratio: number,
  camera: Camera,
  recording: Recording,
  moment: Moment,
  looks: Looks,
): void {
  const sheet: Sheet = { context, ratio, camera, recording, moment, looks, colours: theme() };
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, camera.width, camera.height);
  drawGround(sheet);
  drawGroundObjects(sheet);
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  drawRescuees(sheet);
  const robots = recording.header.world.robots.length;
  const places = Array.from({ length: robots }, (_, i) => camera.toScreen(positionOf(recording, moment, i)));
  if (robots <= LARGE_TEAM) drawTrails(sheet, places);
  drawRoutes(sheet, places);
  drawRobots(sheet, places);
  if (looks.links) drawLinks(sheet, places);
}

function roundedBox(context: CanvasRenderingContext2D, center: Point, size: Point, radius: number): void {
  context.beginPath();
  context.roundRect(center[0] - size[0] / 2, center[1] - size[1] / 2, size[0], size[1], radius);
}

/** The floor with its grid of 10 m, the walls, the places of the tasks. In metres. */
function drawGround({ context, ratio, camera, recording, colours }: Sheet): void {
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
    const extent = (axis: 0 | 1): number => Math.max(...slots.map((slot) => Math.abs(slot[axis] - task.rest[axis])));
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
  for (const { home } of world.robots) {
    homes.moveTo(home[0] + 0.5, home[1]);
    homes.arc(home[0], home[1], 0.5, 0, 2 * Math.PI);
  }
  context.fill(homes);
  const wall = Math.max(3 * pixel, 0.3);
  context.strokeStyle = colours.wall;
  context.lineWidth = wall;
  context.strokeRect(-wall / 2, -wall / 2, width + wall, height + wall);
}

let glow: { of: string; picture: HTMLCanvasElement } | null = null;

/** A soft disc, drawn once. */
function glowPicture(colour: string): HTMLCanvasElement {
  if (glow?.of === colour) return glow.picture;
  const picture = document.createElement('canvas');
  picture.width = picture.height = 256;
  const context = picture.getContext('2d')!;
  const gradient = context.createRadialGradient(128, 128, 0, 128, 128, 128);
  for (const [at, alpha] of [[0, 0.5], [0.35, 0.34], [0.7, 0.16], [0.96, 0.08], [1, 0]]) {
    gradient.addColorStop(at, `rgba(${colour}, ${alpha})`);
  }
  context.fillStyle = gradient;
  context.fillRect(0, 0, 256, 256);
  glow = { of: colour, picture };
  return picture;
}

/** Radiation and debris: as they are, or as a group knows them. In metres. */
function drawGroundObjects({ context, camera, recording, moment, looks, colours }: Sheet): void {
  const { world } = recording.header;
  const pixel = 1 / camera.scale;
  const known = looks.viewpoint === null ? null : knownBy(moment, looks.viewpoint);
  const picture = glowPicture(colours.radiation);
  world.zones.forEach(({ at: [x, y], radius_m: radius }, number) => {
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
    if (piece.movable && isKnown) {
      handles.moveTo(x + 0.16, y);
      handles.arc(x, y, 0.16, 0, 2 * Math.PI);
    }
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
function drawRescuees({ context, camera, recording, moment, colours }: Sheet): void {
  const { world } = recording.header;
  const radius = Math.min(Math.max(0.16 * camera.scale, 1.25), 6);
  const [waiting, gone, delivered] = [new Path2D(), new Path2D(), new Path2D()];
  const claimed = new Map<number | null, Path2D>();
  world.rescuees.forEach((at, number) => {
    const [state, robot] = moment.segment.row(Stream.Rescuees, number, moment.frame);
    const [x, y] = camera.toScreen(at);
    const add = (path: Path2D, r: number): void => {
      path.moveTo(x + r, y);
      path.arc(x, y, r, 0, 2 * Math.PI);
    };
    if (state <= 1) add(waiting, radius);
    if (state === 1) {
      const task = moment.segment.row(Stream.Robots, robot - 1, moment.frame)[5];
      const key = task > 0 ? task - 1 : null;
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

function drawTrails({ context, camera, moment }: Sheet, places: Point[]): void {
  const { segment, frame } = moment;
  context.lineWidth = 2;
  context.lineCap = 'round';
  places.forEach((place, robot) => {
    const task = segment.row(Stream.Robots, robot, frame)[5];
    context.strokeStyle = groupColour(task > 0 ? task - 1 : null);
    let last = place;
    for (let back = 0; back < Math.min(TRAIL, frame); back += 4) {
      const at = frame - back;
      const next = camera.toScreen([segment.motion(robot, 0, at) / 1000, segment.motion(robot, 1, at) / 1000]);
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

function drawRoutes({ context, camera, moment, looks, colours }: Sheet, places: Point[]): void {
  places.forEach((place, robot) => {
    const isSelected = looks.selected === robot;
    if (!looks.routes && !isSelected) return;
    const { goal, ahead } = routeAt(moment, robot);
    if (ahead.length === 0) return;
    const task = moment.segment.row(Stream.Robots, robot, moment.frame)[5];
    context.strokeStyle = groupColour(task > 0 ? task - 1 : null);
    context.globalAlpha = isSelected ? 0.95 : 0.3;
    context.lineWidth = isSelected ? 2 : 1;
    context.beginPath();
    context.moveTo(...place);
    for (const point of ahead) context.lineTo(...camera.toScreen(point));
    context.stroke();
    if (isSelected && goal) {
      const [x, y] = camera.toScreen(goal);
      context.strokeStyle = colours.ink;
      context.beginPath();
      context.moveTo(x - 5, y);
      context.lineTo(x + 5, y);
      context.moveTo(x, y - 5);
      context.lineTo(x, y + 5);
      context.stroke();
    }
  });
  context.globalAlpha = 1;
}

function drawRobots({ context, camera, recording, moment, looks, colours }: Sheet, places: Point[]): void {
  const { world, codes } = recording.header;
  const { segment, frame } = moment;
  const shapes = shapesOf(world.roles);
  const isLarge = places.length > LARGE_TEAM;
  const radiusOf = (robot: number): number => {
    const radius = world.roles[world.robots[robot].role].radius_m * camera.scale;
    return isLarge ? Math.max(radius, 2.2) : Math.max(radius, LEAST_RADIUS);
  };
  const paths = new Map<string, Path2D>();
  const lost = new Path2D();
  places.forEach(([x, y], robot) => {
    const row = segment.row(Stream.Robots, robot, frame);
    const colour = groupColour(row[5] > 0 ? row[5] - 1 : null);
    if (!paths.has(colour)) paths.set(colour, new Path2D());
    const radius = radiusOf(robot);
    addShape(paths.get(colour)!, shapes[world.robots[robot].role], x, y, radius);
    if (codes.conditions[row[6]] !== 'able') {
      lost.moveTo(x - radius, y - radius);
      lost.lineTo(x + radius, y + radius);
      lost.moveTo(x + radius, y - radius);
      lost.lineTo(x - radius, y + radius);
    }
  });
  for (const [colour, path] of paths) {
    context.fillStyle = colour;
    context.fill(path);
    context.strokeStyle = colours.halo;
    context.lineWidth = isLarge ? 0.5 : 1.25;
    context.stroke(path);
  }
  context.strokeStyle = colours.ink;
  context.lineWidth = 2;
  context.stroke(lost);
  if (!isLarge) places.forEach((place, robot) => { drawBars(context, place, radiusOf(robot), moment, robot, colours); });
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
  { segment, frame }: Moment,
  robot: number,
  colours: Theme,
): void {
  const width = Math.max(14, 2 * radius);
  const bar = (field: number, row: number, colour: string): void => {
    const level = Math.min(Math.max(segment.motion(robot, field, frame) / 100_000, 0), 1);
    const top = y + radius + 3 + 3 * row;
    context.fillStyle = colours.halo;
    context.fillRect(x - width / 2 - 0.5, top - 0.5, width + 1, 3);
    context.fillStyle = colours.faint;
    context.fillRect(x - width / 2, top, width, 2);
    context.fillStyle = colour;
    context.fillRect(x - width / 2, top, width * level, 2);
  };
  bar(4, 0, colours.energy);
  bar(5, 1, colours.hp);
  const load = Math.min(segment.row(Stream.Robots, robot, frame)[8], 12);
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

/** From each robot that waits to the robot that it waits for. */
function drawLinks({ context, moment, colours }: Sheet, places: Point[]): void {
  context.strokeStyle = context.fillStyle = colours.wait;
  context.lineWidth = 1.5;
  places.forEach(([x, y], robot) => {
    const other = moment.segment.row(Stream.Robots, robot, moment.frame)[4] - 1;
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
