/** The row of a robot at a frame. */

import type { Doing } from './course';
import type { Header } from './types';

/** The numbers of a row of the stream of robots; ids that may be missing are one higher. */
export const enum Robot {
  Activity,
  Rescuee,
  Until,
  Delay,
  WaitsFor,
  Task,
  Condition,
  Resources,
  Load,
}

/** An id that may be missing. */
export const id = (number: number): number | null => (number > 0 ? number - 1 : null);

/** What a robot's row says for its course. */
export const doingOf = ({ codes }: Header, row: readonly number[]): Doing => ({
  cause: codes.delays[row[Robot.Delay]],
  waitsFor: id(row[Robot.WaitsFor]),
  load: row[Robot.Load],
});
