import { describe, expect, it } from 'vitest';
import { Labels, boxAt } from '../src/draw/labels';
import type { Point } from '../src/recording/types';
import { arrange } from '../src/ui/layout';

const LABEL: Point = [14, 11];

describe('labels', () => {
  it('do not overlap for a crowd of 40', () => {
    const labels = new Labels();
    labels.begin([900, 700]);
    const places = Array.from({ length: 40 }, (_, i): Point => [
      400 + 14 * (i % 8),
      300 + 14 * Math.floor(i / 8),
    ]);
    for (const place of places) labels.take(boxAt(place, [11, 11]));
    const boxes = places.flatMap((place, robot) => {
      const found = labels.place(robot, place, 5.5, LABEL);
      return found ? [boxAt(found.middle, LABEL)] : [];
    });
    expect(boxes.length).toBeGreaterThan(20);
    boxes.forEach((a, i) => {
      for (const b of boxes.slice(0, i)) {
        const isApart = a.left >= b.right || b.left >= a.right || a.top >= b.bottom || b.top >= a.bottom;
        expect(isApart).toBe(true);
      }
    });
  });

  it('stay where they were, and go back beside the robot', () => {
    const labels = new Labels();
    const place = (x: number, isBlocked: boolean) => {
      labels.begin([900, 700]);
      if (isBlocked) labels.take({ left: x + 5, top: 0, right: x + 60, bottom: 700 });
      return labels.place(1, [x, 300], 5, LABEL)?.middle.map((at, axis) => at - [x, 300][axis]);
    };
    expect(place(300, false)).toEqual([15, 0]);
    expect(place(300, true)).toEqual([-15, 0]);
    expect(place(310, false)).toEqual([-15, 0]);
  });
});

describe('stages', () => {
  it('are no higher than their arenas', () => {
    const { columns, height } = arrange(2, [1040, 690], [89.5, 71.5], 2);
    expect([columns, Math.round(height)]).toEqual([2, 449]);
  });

  it('use a wide and a narrow window', () => {
    expect(arrange(1, [1040, 690], [89.5, 71.5], 1).height).toBe(690);
    expect(arrange(2, [500, 1200], [89.5, 71.5], 2).columns).toBe(1);
    expect(arrange(2, [374, 1000], [89.5, 71.5], 1).columns).toBe(1);
    expect(arrange(3, [2000, 600], [50, 50], 3).columns).toBe(3);
  });
});
