/** The state at a moment, in words and metres. */

import type { Moment, Recording } from './recording';
import { type MotionField, Stream } from './segment';
import { Robot, id } from './robotRow';
import type { Need, Point, Role, World } from './types';

export interface RobotState {
  id: number;
  role: Role;
  activity: string;
  rescuee: number | null;
  until: number | null;
  delay: string;
  waitsFor: number | null;
  task: number | null;
  condition: string;
  resources: number;
  load: number;
  energy: number;
  hp: number;
  /** Metres per second. */
  velocity: Point;
}

/** A number of a robot's row. */
export const numberOf = ({ segment, frame }: Moment, robot: number, number: Robot): number =>
  segment.row(Stream.Robots, robot, frame)[number];

/** The task of a robot's group. */
export const taskOf = (moment: Moment, robot: number): number | null =>
  id(numberOf(moment, robot, Robot.Task));

/** Where a robot is, in metres, between two frames too. */
export function positionOf(recording: Recording, { segment, frame, part }: Moment, robot: number): Point {
  const [x, y] = [segment.motion(robot, 'x_mm', frame), segment.motion(robot, 'y_mm', frame)];
  if (part === 0) return [x / 1000, y / 1000];
  let [next, at] = [segment as typeof segment | null, frame + 1];
  if (at >= segment.frames) {
    next = recording.segmentOf(segment.firstFrame + at);
    at = 0;
  }
  if (!next || next.frames <= at) return [x / 1000, y / 1000];
  const between = (a: number, b: number): number => (a + (b - a) * part) / 1000;
  return [between(x, next.motion(robot, 'x_mm', at)), between(y, next.motion(robot, 'y_mm', at))];
}

/** What a robot is and can do: its row's own body, or that of its role. */
export function bodyOf(world: World, robot: number): Role {
  const { role, body } = world.robots[robot];
  return body ?? world.roles[role];
}

export function robotAt(recording: Recording, { segment, frame }: Moment, robot: number): RobotState {
  const { world, codes, dt_s } = recording.header;
  const row = segment.row(Stream.Robots, robot, frame);
  const until = id(row[Robot.Until]);
  const motion = (field: MotionField): number => segment.motion(robot, field, frame) / 1000;
  return {
    id: robot,
    role: bodyOf(world, robot),
    activity: codes.activities[row[Robot.Activity]],
    rescuee: id(row[Robot.Rescuee]),
    until: until === null ? null : until * dt_s,
    delay: codes.delays[row[Robot.Delay]],
    waitsFor: id(row[Robot.WaitsFor]),
    task: id(row[Robot.Task]),
    condition: codes.conditions[row[Robot.Condition]],
    resources: row[Robot.Resources],
    load: row[Robot.Load],
    energy: motion('energy_millipercent'),
    hp: motion('hp_millipercent'),
    velocity: [motion('vx_mm_s'), motion('vy_mm_s')],
  };
}

/** A robot's goal and the waypoints ahead, in metres. */
export function routeAt({ segment, frame }: Moment, robot: number): { goal: Point | null; ahead: Point[] } {
  const row = segment.row(Stream.Routes, robot, frame);
  const points: Point[] = [];
  for (let at = 1; at + 1 < row.length; at += 2) points.push([row[at] / 1000, row[at + 1] / 1000]);
  const goal = row[0] === 1 ? (points.shift() ?? null) : null;
  return { goal, ahead: points };
}

/** What a group knows: places of debris, and zones. The last group is the team at home. */
export function knownBy(moment: Moment, group: number): { debris: Map<number, number>; zones: Set<number> } {
  const row = moment.segment.row(Stream.Groups, group, moment.frame);
  const debris = new Map<number, number>();
  const end = 2 + 2 * row[1];
  for (let at = 2; at < end; at += 2) debris.set(row[at], row[at + 1]);
  return { debris, zones: new Set(row.slice(end)) };
}

/** Numbers of the radiation zones that are on: events switch them. */
export function zonesOn(recording: Recording, { segment, frame }: Moment): Set<number> {
  const { world, first_step: first, steps_per_frame: steps, dt_s: dt } = recording.header;
  const on = new Set(world.zones.keys());
  world.zones_later?.forEach((zone) => on.delete(zone));
  const time = (first + (segment.firstFrame + frame) * steps) * dt + 1e-9;
  for (const { kind, fields, time: at } of recording.happenings) {
    if (at > time) break;
    if (kind === 'SourceAppeared') on.add(Number(fields.zone));
    if (kind === 'SourceDied') on.delete(Number(fields.zone));
  }
  return on;
}

/** What a need measures of a robot. */
export function needOf(need: Need, robot: RobotState, healthFloor: number): number {
  const { role, hp, energy } = robot;
  const factor = healthFloor + (1 - healthFloor) * Math.min(Math.max(hp / 100, 0), 1);
  switch (need.measures) {
    case 'Health':
      return (role.hp * hp) / 100;
    case 'Speed':
      return role.speed_mps * factor;
    case 'Sensing':
      return role.sensing_m * factor;
    case 'Energy':
      return (role.energy * energy) / 100;
    case 'Resources':
      return robot.resources;
    case 'Capacity':
      return role.capacity - robot.load;
    case 'Observing':
      return role.observing_m * factor;
    case 'Constant':
      return role.constants[need.name] ?? 0;
  }
}

/** Most that a need can be for a role, to draw it as a share; null where that is not known. */
export function mostOf(need: Need, role: Role): number {
  const full = { role, hp: 100, energy: 100, resources: role.resources, load: 0 } as RobotState;
  return needOf(need, full, 1);
}
