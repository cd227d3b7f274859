/** Marks that many drawings have. */

import type { Point } from '../recording/types';

/** Adds a disc to a path. */
export function addDisc(path: CanvasPath, x: number, y: number, radius: number): void {
  path.moveTo(x + radius, y);
  path.arc(x, y, radius, 0, 2 * Math.PI);
}

/** Fills a disc. */
export function fillDisc(context: CanvasRenderingContext2D, x: number, y: number, radius: number): void {
  context.beginPath();
  addDisc(context, x, y, radius);
  context.fill();
}

/** Draws a line. */
export function drawLine(context: CanvasRenderingContext2D, from: Point, to: Point): void {
  context.beginPath();
  context.moveTo(...from);
  context.lineTo(...to);
  context.stroke();
}

/** Writes a text that a rim sets off from what is below it. */
export function writeRimmed(
  context: CanvasRenderingContext2D,
  text: string,
  at: Point,
  [colour, rim]: [string, string],
): void {
  context.lineWidth = 3;
  context.strokeStyle = rim;
  context.strokeText(text, ...at);
  context.fillStyle = colour;
  context.fillText(text, ...at);
}
