import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { Course, totals } from '../src/recording/course';
import { Recording } from '../src/recording/recording';

const waits = (waitsFor: number | null, load = 0) => ({ cause: 'right_of_way', waitsFor, load });
const moves = (load = 0) => ({ cause: 'under_way', waitsFor: null, load });

describe('the course of a robot', () => {
  it('has its delays, and moments between two of the same kind do not end one', () => {
    const course = new Course();
    course.add(0, moves());
    course.add(2, waits(4));
    course.add(3, moves());
    course.add(3.5, waits(4));
    course.add(5, waits(7));
    course.add(6, moves());
    course.end(9);
    const of = { cause: 'right_of_way' };
    expect(course.delays).toEqual([
      { ...of, from: 2, to: 5, stood: 2.5, waitsFor: 4 },
      { ...of, from: 5, to: 6, stood: 1, waitsFor: 7 },
    ]);
    expect(totals(course.delays)).toEqual([
      {
        cause: 'right_of_way',
        stood: 3.5,
        robots: [
          [4, 2.5],
          [7, 1],
        ],
      },
    ]);
  });

  it('goes on from one segment to the next, and has what was on board', () => {
    const course = new Course();
    course.add(0, waits(null, 1));
    course.end(1);
    course.add(1.1, waits(null, 1));
    course.add(2, moves(2));
    expect(course.delays.map(({ from, to }) => [from, to])).toEqual([[0, 2]]);
    expect(course.loads).toEqual([
      { time: 0, load: 1 },
      { time: 2, load: 2 },
    ]);
  });

  it('is read from a recording', async () => {
    const file = new Uint8Array(readFileSync(new URL('small.usrec', import.meta.url)));
    const recording = await Recording.read('small', file);
    await recording.survey();
    expect(recording.courses.length).toBe(recording.header.world.robots.length);
    for (const { delays, loads } of recording.courses) {
      expect(loads[0].time).toBe(recording.start);
      for (const { from, to, stood } of delays) {
        expect(recording.start <= from && from <= to && to <= recording.end).toBe(true);
        expect(stood).toBeLessThanOrEqual(to - from + 1e-9);
      }
    }
    expect(recording.courses.some(({ delays }) => delays.length > 0)).toBe(true);
  });
});
