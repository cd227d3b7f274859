/** A segment: some seconds of frames, readable without those before it. */

import { NotNumbers, Numbers } from './numbers';

/** A number of each robot in every frame, by its name in the header. */
export type MotionField = 'x_mm' | 'y_mm' | 'vx_mm_s' | 'vy_mm_s' | 'energy_millipercent' | 'hp_millipercent';

/** Streams of rows that stand only where they change. */
export const enum Stream {
  Robots,
  Routes,
  Rescuees,
  Debris,
  Groups,
  Conflicts,
}

/** A row, and the frames of the segment from which on it was so. */
interface ChangingRow {
  from: number[];
  rows: number[][];
}

function readColumn(numbers: Numbers, frames: number, isPosition: boolean): Int32Array {
  const values = new Int32Array(frames);
  let [last, before] = [0, 0];
  for (let frame = 0; frame < frames; frame++) {
    const expected = isPosition && frame > 1 ? 2 * last - before : last;
    const value = numbers.signed() + expected;
    values[frame] = value;
    [before, last] = [last, value];
  }
  return values;
}

function readRow(numbers: Numbers, frames: number): ChangingRow {
  const entries = numbers.count();
  const row: ChangingRow = { from: [], rows: [] };
  let at = 0;
  for (let entry = 0; entry < entries; entry++) {
    at += numbers.unsigned();
    if (at >= frames) throw new NotNumbers('a change lies beyond the segment');
    const length = numbers.count();
    row.from.push(at);
    row.rows.push(Array.from({ length }, () => numbers.signed()));
  }
  if (row.from[0] !== 0) throw new NotNumbers('a row has no beginning');
  return row;
}

export class Segment {
  readonly firstFrame: number;
  readonly frames: number;
  private readonly columns: Int32Array[];
  private readonly streams: ChangingRow[][];

  constructor(
    bytes: Uint8Array,
    robots: number,
    private readonly fields: readonly string[],
    rows: readonly number[],
  ) {
    const numbers = new Numbers(bytes);
    this.firstFrame = numbers.unsigned();
    this.frames = numbers.count();
    if (this.frames === 0 || robots * fields.length * this.frames > numbers.left) {
      throw new NotNumbers('a segment has too few numbers');
    }
    this.columns = Array.from({ length: robots * fields.length }, (_, i) =>
      readColumn(numbers, this.frames, ['x_mm', 'y_mm'].includes(fields[i % fields.length])),
    );
    this.streams = rows.map((count) => Array.from({ length: count }, () => readRow(numbers, this.frames)));
    if (numbers.left > 0) throw new NotNumbers('a segment has too many numbers');
  }

  /** A number of a robot's motion at a frame of this segment. */
  motion(robot: number, field: MotionField, frame: number): number {
    return this.columns[robot * this.fields.length + this.fields.indexOf(field)][frame];
  }

  /** A row of a stream at a frame of this segment. */
  row(stream: Stream, number: number, frame: number): readonly number[] {
    const { from, rows } = this.streams[stream][number];
    let at = from.length - 1;
    while (from[at] > frame) at--;
    return rows[at];
  }

  /** The rows of a stream, each with the frame of this segment from which on it was so. */
  changes(stream: Stream, number: number): [frame: number, row: readonly number[]][] {
    const { from, rows } = this.streams[stream][number];
    return from.map((frame, i) => [frame, rows[i]]);
  }

  /** Numbers that it keeps in memory, roughly. */
  get size(): number {
    return this.columns.length * this.frames;
  }
}
