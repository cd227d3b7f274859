/** Where the arena is on the screen. The y axis of the arena points up. */

import type { Point } from '../recording/types';

/** How far the arena is from the edges of the view, in pixels. */
export const marginOf = (width: number, height: number): number => (Math.min(width, height) < 500 ? 10 : 22);

export class Camera {
  /** Pixels of a metre. */
  scale = 1;
  /** The place in the middle of the view, in metres. */
  center: Point;
  width = 1;
  height = 1;
  isFitted = true;

  constructor(private readonly arena: Point) {
    this.center = [arena[0] / 2, arena[1] / 2];
  }

  resize(width: number, height: number): void {
    [this.width, this.height] = [Math.max(width, 1), Math.max(height, 1)];
    if (this.isFitted) this.fit();
  }

  /** Shows the whole arena. */
  fit(): void {
    const margin = marginOf(this.width, this.height);
    const [width, height] = this.arena;
    this.scale = Math.min((this.width - 2 * margin) / width, (this.height - 2 * margin) / height);
    this.scale = Math.max(this.scale, 0.05);
    this.center = [width / 2, height / 2];
    this.isFitted = true;
  }

  toScreen([x, y]: Point): Point {
    return [
      (x - this.center[0]) * this.scale + this.width / 2,
      (this.center[1] - y) * this.scale + this.height / 2,
    ];
  }

  toWorld([x, y]: Point): Point {
    return [
      (x - this.width / 2) / this.scale + this.center[0],
      this.center[1] - (y - this.height / 2) / this.scale,
    ];
  }

  pan(dx: number, dy: number): void {
    this.isFitted = false;
    this.center = [this.center[0] - dx / this.scale, this.center[1] + dy / this.scale];
  }

  /** Zooms; what is at a place of the screen stays there. */
  zoom(factor: number, at: Point): void {
    const before = this.toWorld(at);
    const least = 0.3 * Math.min(this.width / this.arena[0], this.height / this.arena[1]);
    this.scale = Math.min(Math.max(this.scale * factor, least), 400);
    const after = this.toWorld(at);
    this.center = [this.center[0] + before[0] - after[0], this.center[1] + before[1] - after[1]];
    this.isFitted = false;
  }

  /** Makes a context draw in metres. */
  apply(context: CanvasRenderingContext2D, ratio: number): void {
    const scale = this.scale * ratio;
    const x = (this.width / 2) * ratio - this.center[0] * scale;
    const y = (this.height / 2) * ratio + this.center[1] * scale;
    context.setTransform(scale, 0, 0, -scale, x, y);
  }
}
