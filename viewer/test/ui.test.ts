import { describe, expect, it, vi } from 'vitest';

vi.stubGlobal('window', { matchMedia: () => ({ matches: false }) });

const { Clock } = await import('../src/ui/clock');
const { countUntil } = await import('../src/ui/curves');
const { clockTime, words } = await import('../src/ui/dom');
const { heat, matrixOrder, scoreText } = await import('../src/ui/roundPanel');
const { concerns, eventText } = await import('../src/ui/eventPanel');
const { linkTo, parseTime, readLink } = await import('../src/ui/link');
const { Camera } = await import('../src/draw/camera');
const { messagesAt } = await import('../src/draw/messages');

describe('the clock', () => {
  it('plays to the end, and then begins again', () => {
    const clock = new Clock(10, 20);
    expect(clock.advance(1)).toBe(false);
    clock.toggle();
    clock.advance(1);
    expect(clock.time).toBe(15); // five times as fast
    clock.advance(9);
    expect([clock.time, clock.isPlaying]).toEqual([20, false]);
    clock.toggle();
    expect([clock.time, clock.isPlaying]).toEqual([10, true]);
  });

  it('goes from 1 to 100 times as fast', () => {
    const clock = new Clock(0, 1);
    for (let i = 0; i < 20; i++) clock.faster(1);
    expect(clock.speed).toBe(100);
    for (let i = 0; i < 20; i++) clock.faster(-1);
    expect(clock.speed).toBe(1);
  });
});

describe('texts', () => {
  it('are times, scores and words', () => {
    expect([clockTime(0), clockTime(59.97), clockTime(600)]).toEqual(['0:00.0', '0:59.9', '10:00.0']);
    expect([scoreText(null), scoreText('Infinite'), scoreText({ Finite: 0.012345 })]).toEqual([
      'none',
      'infinite',
      '0.01235 nats',
    ]);
    expect(words('right_of_way')).toBe('right of way');
  });
});

describe('messages', () => {
  it('are shown for a second', () => {
    const at = (time: number, kind: string) => ({ time, kind, fields: {} });
    const all = [at(1, 'Heard'), at(1.5, 'Loaded'), at(1.6, 'Lost'), at(2.2, 'Heard'), at(3, 'Heard')];
    const times = (now: number): number[] => messagesAt(all, now).map(({ time }) => time);
    expect([times(0.9), times(1.6), times(2.2), times(2.7), times(9)]).toEqual([
      [],
      [1, 1.6],
      [1.6, 2.2],
      [2.2],
      [],
    ]);
  });
});

describe('links', () => {
  it('say the time, the robot and the trials', () => {
    const link = { time: 128.25, robot: 4, trials: ['RNE-3', 'x,y=é-1'] };
    expect(linkTo(link)).toBe('#trials=RNE-3,x%2Cy%3D%C3%A9-1&t=128.3&robot=4');
    expect(readLink(linkTo(link))).toEqual({ ...link, time: 128.3 });
    expect(readLink('#t=128&robot=4')).toEqual({ time: 128, robot: 4, trials: [] });
    expect(readLink('')).toEqual({ time: null, robot: null, trials: [] });
    expect(readLink('#t=x&robot=1.5&trials=%')).toEqual({ time: null, robot: null, trials: ['%'] });
  });

  it('and fields have times as seconds or as minutes', () => {
    expect(['128', ' 2:08', '2:08.5', '0:00.0'].map(parseTime)).toEqual([128, 128, 128.5, 0]);
    expect(['', 'x', '-1', '1:2:3', '1.5:00', ':30', '1e3'].map(parseTime)).toEqual(Array(7).fill(null));
  });
});

describe('events', () => {
  it('are told in words, and are about robots', () => {
    const loaded = { time: 3, kind: 'Loaded', fields: { robot: 3, rescuee: 37, resource_of: 5 } };
    expect(eventText(loaded)).toBe('loaded, robot 3, rescuee 37, resource of 5');
    expect(eventText({ time: 0, kind: 'Finished', fields: {} })).toBe('finished');
    expect([3, 5, 37].map((robot) => concerns(loaded, robot))).toEqual([true, true, false]);
    expect(concerns({ time: 0, kind: 'Deadlocked', fields: { robots: [1, 2] } }, 2)).toBe(true);
  });
});

describe('numbers', () => {
  it('are counted up to a time', () =>
    expect([0, 1, 2.5, 9].map((time) => countUntil([1, 2, 3], time))).toEqual([0, 1, 2, 3]));

  it('have colours from light to strong', () => {
    expect(heat(0, false)).toBe('rgb(243, 246, 248)');
    expect(heat(2, false)).toBe('rgb(20, 42, 82)');
  });

  it('stand in the matrix group by group', () => {
    const decided = {
      trust: { members: [0, 1, 5] },
      decision: { assignment: { groups: [[1], [0, 5]] } },
    } as unknown as Parameters<typeof matrixOrder>[0];
    expect(matrixOrder(decided)).toEqual([
      { id: 1, at: 1, task: 0 },
      { id: 0, at: 0, task: 1 },
      { id: 5, at: 2, task: 1 },
    ]);
  });
});

describe('the camera', () => {
  it('finds places again, and keeps the place under the pointer when it zooms', () => {
    const camera = new Camera([80, 40]);
    camera.resize(800, 600);
    const [x, y] = camera.toScreen([10, 30]);
    expect(camera.toWorld([x, y]).map((m) => m.toFixed(6))).toEqual(['10.000000', '30.000000']);
    camera.zoom(3, [x, y]);
    expect(camera.toScreen([10, 30]).map((p) => p.toFixed(6))).toEqual([x, y].map((p) => p.toFixed(6)));
    expect(camera.toScreen([0, 40])[1]).toBeLessThan(camera.toScreen([0, 0])[1]);
  });
});
