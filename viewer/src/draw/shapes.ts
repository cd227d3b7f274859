/** Shapes of roles, and outlines of debris. */

import type { DebrisPiece, Role } from '../recording/types';
import { addDisc } from './marks';

/** Corners of a role's shape on the unit circle; none for a disc. */
type Shape = readonly (readonly [number, number])[];

const regular = (corners: number, turn: number): Shape =>
  Array.from({ length: corners }, (_, i) => {
    const angle = (2 * Math.PI * i) / corners + turn;
    return [Math.cos(angle), Math.sin(angle)] as const;
  });

const GROUND: Shape[] = [[], regular(4, Math.PI / 4), regular(6, 0), regular(4, 0)];
const AERIAL: Shape[] = [regular(3, -Math.PI / 2), regular(5, -Math.PI / 2), regular(3, Math.PI / 2)];

/** The shape of each role: discs and squares drive, triangles fly. */
export function shapesOf(roles: readonly Role[]): Shape[] {
  let [ground, aerial] = [0, 0];
  return roles.map((role) =>
    role.kind === 'Ground' ? GROUND[ground++ % GROUND.length] : AERIAL[aerial++ % AERIAL.length],
  );
}

/** Adds a shape to a path, about as large as a disc of that radius. */
export function addShape(path: Path2D, shape: Shape, x: number, y: number, radius: number): void {
  if (shape.length === 0) {
    addDisc(path, x, y, radius);
    return;
  }
  const size = radius * (shape.length === 3 ? 1.35 : shape.length === 4 ? 1.18 : 1.1);
  // A line to the first corner, because closing a path costs time where it has thousands of shapes.
  const [lastX, lastY] = shape[shape.length - 1];
  path.moveTo(x + size * lastX, y + size * lastY);
  for (const [dx, dy] of shape) path.lineTo(x + size * dx, y + size * dy);
}

/** Adds the outline of a piece of debris at a place to a path. */
export function addDebris(path: Path2D, piece: DebrisPiece, x: number, y: number, angle: number): void {
  const { shape } = piece;
  if ('Disc' in shape) {
    addDisc(path, x, y, shape.Disc);
    return;
  }
  let corners;
  if ('Box' in shape) {
    const [w, h] = [shape.Box[0] / 2, shape.Box[1] / 2];
    corners = [
      [-w, -h],
      [w, -h],
      [w, h],
      [-w, h],
    ];
  } else {
    corners = shape.Polygon;
  }
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  corners.forEach(([px, py], i) => {
    const [cx, cy] = [x + px * cos - py * sin, y + px * sin + py * cos];
    if (i === 0) path.moveTo(cx, cy);
    else path.lineTo(cx, cy);
  });
  path.closePath();
}
