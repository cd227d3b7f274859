/** Places for labels, so that none covers another or a robot. */

import type { Point } from '../recording/types';

export interface Box {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** Where a label can stand around a robot: to the right, left, above, below, then between these. */
const SIDES: readonly Point[] = [
  [1, 0],
  [-1, 0],
  [0, -1],
  [0, 1],
  [1, -1],
  [-1, -1],
  [1, 1],
  [-1, 1],
];

/** How far from a robot labels stand, in pixels: beside it, or at the end of a line. */
const DISTANCES = [3, 14, 26, 38];

export const boxAt = ([x, y]: Point, [width, height]: Point): Box => ({
  left: x - width / 2,
  right: x + width / 2,
  top: y - height / 2,
  bottom: y + height / 2,
});

/** A place for a label: its middle, and whether it needs a line to its robot. */
export interface Place {
  middle: Point;
  isFar: boolean;
}

export class Labels {
  private taken: Box[] = [];
  private room: Point = [0, 0];
  /** Where the label of each robot stood last: it stays there as long as it can. */
  private readonly last = new Map<number, number>();

  /** Begins a drawing in a view of this size. */
  begin(room: Point): void {
    [this.taken, this.room] = [[], room];
  }

  take(box: Box): void {
    this.taken.push(box);
  }

  isFree({ left, top, right, bottom }: Box): boolean {
    if (left < 0 || top < 0 || right > this.room[0] || bottom > this.room[1]) return false;
    return !this.taken.some(
      (other) => left < other.right && other.left < right && top < other.bottom && other.top < bottom,
    );
  }

  /** Takes the nearest free place for a robot's label; null if there is none. */
  place(robot: number, [x, y]: Point, radius: number, size: Point): Place | null {
    for (const candidate of this.candidates(robot)) {
      const [dx, dy] = SIDES[candidate % SIDES.length];
      const ring = Math.floor(candidate / SIDES.length);
      const away = radius + DISTANCES[ring];
      const middle: Point = [x + dx * (away + size[0] / 2), y + dy * (away + size[1] / 2)];
      if (!this.isFree(boxAt(middle, size))) continue;
      this.take(boxAt(middle, size));
      this.last.set(robot, candidate);
      return { middle, isFar: ring > 0 };
    }
    return null;
  }

  /** The nearest places first; at the same distance, the last one first. */
  private candidates(robot: number): number[] {
    const all = Array.from({ length: SIDES.length * DISTANCES.length }, (_, i) => i);
    const last = this.last.get(robot);
    if (last === undefined) return all;
    const ring = last - (last % SIDES.length);
    return [...all.slice(0, ring), last, ...all.slice(ring)];
  }
}
