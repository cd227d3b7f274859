/** Where stages stand: as large as the room allows, and no higher than their arenas are. */

import { marginOf } from '../draw/camera';
import type { Point } from '../recording/types';

/** Height of the line above an arena with the borders of its stage, in pixels. */
const CAPTION = 34;

/** Between stages, in pixels. */
const GAP = 8;

/** The curves stand below the stages where there is at least this room, in pixels. */
export const LEAST_BELOW = 150;

export interface Layout {
  columns: number;
  /** Height of all stages, in pixels. */
  height: number;
}

/** Height of a stage of a width that its arena fills, in pixels. */
function fullHeight(width: number, [arenaWidth, arenaHeight]: Point): number {
  const at = (margin: number): number => ((width - 2 - 2 * margin) * arenaHeight) / arenaWidth + 2 * margin;
  const [narrow, wide] = [at(10), at(22)];
  return CAPTION + (marginOf(width - 2, wide) === 22 ? wide : narrow);
}

/** With this many columns: the height of the stages, and how large their arenas are. */
function inColumns(count: number, columns: number, [width, height]: Point, arena: Point): [number, number] {
  const rows = Math.ceil(count / columns);
  const share = (height - GAP * (rows - 1)) / rows;
  const stage = (width - GAP * (columns - 1)) / columns;
  const used = Math.min(fullHeight(stage, arena), share);
  const scale = Math.min(stage / arena[0], (used - CAPTION) / arena[1]);
  return [rows * used + GAP * (rows - 1), scale];
}

/** Puts as many stages side by side, but not more than `most`, as shows the arena the largest. */
export function arrange(count: number, room: Point, arena: Point, most: number): Layout {
  const layouts = Array.from({ length: most }, (_, i) => {
    const [height, scale] = inColumns(count, i + 1, room, arena);
    return { columns: i + 1, height, scale };
  });
  return layouts.reduce((best, layout) => (layout.scale > best.scale ? layout : best));
}
