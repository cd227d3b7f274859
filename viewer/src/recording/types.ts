/** What stands in a recording as JSON: a mirror of the types of the crate `recording`. */

export type Point = [number, number];

export interface Role {
  name: string;
  kind: 'Ground' | 'Aerial';
  radius_m: number;
  hp: number;
  energy: number;
  speed_mps: number;
  sensing_m: number;
  observing_m: number;
  capacity: number;
  resources: number;
  guides: boolean;
  constants: Record<string, number>;
}

export type Measure =
  'Health' | 'Speed' | 'Sensing' | 'Energy' | 'Resources' | 'Capacity' | 'Observing' | 'Constant';

export interface Need {
  name: string;
  level: string;
  measures: Measure;
  weight: number;
}

export interface TaskPlace {
  name: string;
  difficulty: number;
  center: Point;
  size_m: Point;
  rest: Point;
  first_rescuee: number;
  rescuees: number;
}

export interface DebrisPiece {
  shape: { Disc: number } | { Box: Point } | { Polygon: Point[] };
  at: Point;
  rotation_deg: number;
  movable: { mass_kg: number; friction: number } | null;
}

/** What a scenario calls its things. */
export interface Words {
  rescuee: string;
  rescuees: string;
  hp: string;
  radiation: string;
}

export interface World {
  arena_m: Point;
  roles: Role[];
  needs: Need[];
  health_floor: number;
  tasks: TaskPlace[];
  robots: { role: number; home: Point; rest: Point[]; body?: Role }[];
  rescuees: Point[];
  debris: DebrisPiece[];
  zones: { at: Point; radius_m: number }[];
  /** Numbers of the radiation zones that are not there at the start. */
  zones_later?: number[];
  /** What the scenario calls its things; missing in older recordings. */
  words?: Words;
}

export interface Header {
  version: number;
  program: string;
  scenario: { name: string; description: string; resolved: string; xxh3_128: string };
  policy: string;
  seed: string;
  dt_s: number;
  duration_s: number;
  first_step: number;
  steps_per_frame: number;
  frames_per_segment: number;
  motion_fields: string[];
  streams: [string, number][];
  codes: { activities: string[]; delays: string[]; conditions: string[]; rescuees: string[] };
  world: World;
}

/** An event: its kind alone, or its kind with its fields. */
export type EventJson = string | Record<string, Record<string, unknown>>;

export type Score = { Finite: number } | 'Infinite' | null;

export interface TimedDecision {
  step: number;
  question: {
    round: number;
    roles: string[];
    tasks: { name: string; difficulty: number }[];
    needs: { name: string; weight: number }[];
    members: { id: number; role: number; needs: number[] }[];
  };
  decision: {
    assignment: { groups: number[][] };
    score: Score;
    proven_optimal: boolean;
    alternatives: { assignment: { groups: number[][] }; score: Score }[];
  };
  trust: {
    weights: number[];
    members: number[];
    robots: (number | null)[][];
    groups: (number | null)[][];
  } | null;
}

export interface RoundRecord {
  round: number;
  task: number;
  start_s: number;
  end_s: number | null;
  rescued: number;
  energy: number;
  hp: number;
}

export interface Summary {
  status: string | Record<string, string>;
  time_s: number;
  rounds: RoundRecord[];
}
