import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { ReadError, chunksOf, crc32 } from '../src/recording/chunks';
import { NotNumbers, Numbers } from '../src/recording/numbers';
import { Recording } from '../src/recording/recording';
import { Stream } from '../src/recording/segment';
import { knownBy, needOf, positionOf, robotAt, routeAt } from '../src/recording/state';

/** A recording, and what `usar view --at 12.3` says of it. */
const file = new Uint8Array(readFileSync(new URL('small.usrec', import.meta.url)));
const said = JSON.parse(readFileSync(new URL('small.at.json', import.meta.url), 'utf8')) as {
  time_s: number;
  robots: {
    role: string;
    task: string | null;
    activity: string;
    delay: string;
    energy: number;
    needs: [string, number][];
  }[];
  rescuees: [string, number][];
  state: {
    robots: {
      motion: { position_mm: number[] };
      route: { ahead_mm: number[][] };
      state: { waits_for: number | null };
    }[];
    groups: { debris: [number, number][]; zones: number[] }[];
  };
};

async function settled(recording: Recording): Promise<void> {
  await recording.survey();
}

describe('numbers', () => {
  it('are read as they are written', () => {
    const numbers = new Numbers(Uint8Array.of(0, 1, 2, 0xac, 0x02, 0x80));
    expect([numbers.signed(), numbers.signed(), numbers.signed(), numbers.unsigned()]).toEqual([
      0, -1, 1, 300,
    ]);
    expect(() => numbers.unsigned()).toThrow(NotNumbers);
    expect(() => new Numbers(new Uint8Array(20).fill(0xff)).unsigned()).toThrow(NotNumbers);
    expect(() => new Numbers(Uint8Array.of(9, 0)).count()).toThrow(NotNumbers);
  });
});

describe('a recording', () => {
  it('has the checksum that all the world has', () =>
    expect(crc32(new TextEncoder().encode('123456789'))).toBe(0xcbf43926));

  it('is read as the program reads it', async () => {
    const recording = await Recording.read('small', file);
    expect(recording.cut).toBeNull();
    await settled(recording);
    const moment = recording.at(said.time_s, () => undefined)!;
    said.robots.forEach((expected, id) => {
      const robot = robotAt(recording, moment, id);
      const { motion, route, state } = said.state.robots[id];
      expect(positionOf(recording, moment, id).map((metres) => Math.round(metres * 1000))).toEqual(
        motion.position_mm,
      );
      expect(routeAt(moment, id).ahead.map((point) => point.map((m) => Math.round(m * 1000)))).toEqual(
        route.ahead_mm,
      );
      expect([robot.role.name, robot.activity, robot.delay, robot.waitsFor]).toEqual([
        expected.role,
        expected.activity,
        expected.delay,
        state.waits_for,
      ]);
      expect(robot.energy).toBe(expected.energy);
      const { needs, health_floor } = recording.header.world;
      needs.forEach((need, i) => {
        expect(need.name).toBe(expected.needs[i][0]);
        expect(needOf(need, robot, health_floor)).toBeCloseTo(expected.needs[i][1], 9);
      });
    });
    said.state.groups.forEach((group, number) => {
      const known = knownBy(moment, number);
      expect([...known.debris]).toEqual(group.debris);
      expect([...known.zones]).toEqual(group.zones);
    });
    said.rescuees.forEach(([, count], state) => {
      const states = recording.header.world.rescuees.map(
        (_, i) => moment.segment.row(Stream.Rescuees, i, moment.frame)[0],
      );
      expect(states.filter((other) => other === state).length).toBe(count);
    });
    expect(recording.decisions[0].trust!.members.length).toBe(said.robots.length);
  });

  it('gives its whole chunks when it was cut', async () => {
    const whole = await Recording.read('small', file);
    let most = 0;
    for (let length = 0; length < file.length; length += 211) {
      try {
        const cut = await Recording.read('cut', file.subarray(0, length));
        expect(cut.cut).not.toBeNull();
        most = Math.max(most, cut.frames);
      } catch (error) {
        expect(error).toBeInstanceOf(ReadError);
      }
    }
    expect(most).toBeGreaterThan(whole.frames / 2);
  });

  it('grows by bytes that are added to it', async () => {
    const whole = await Recording.read('whole', file);
    await whole.survey();
    const { chunks } = chunksOf(file);
    const first = chunks.findIndex(({ kind }) => kind === 'SEGM');
    const begin = chunks[first + 1].at;
    const growing = await Recording.read('growing', file.subarray(0, begin));
    await growing.survey();
    expect(growing.end).toBeLessThan(whole.end);
    expect(growing.summary).toBeNull();
    for (let at = begin; at < file.length; at += 997) {
      await growing.append(file.subarray(at, at + 997));
      await growing.survey();
    }
    expect([growing.frames, growing.end, growing.cut]).toEqual([whole.frames, whole.end, null]);
    expect(growing.happenings).toEqual(whole.happenings);
    expect(growing.decisions).toEqual(whole.decisions);
    expect(growing.summary).toEqual(whole.summary);
    expect(growing.courses).toEqual(whole.courses);
  });

  it('tells which chunk is damaged when a damaged one is added', async () => {
    const { chunks } = chunksOf(file);
    const first = chunks.findIndex(({ kind }) => kind === 'SEGM');
    const { at } = chunks[first + 1];
    const growing = await Recording.read('growing', file.subarray(0, at));
    const damaged = file.slice(at);
    damaged[5] ^= 1;
    await expect(growing.append(damaged)).rejects.toThrow(`chunk ${first + 1},`);
  });

  it('is refused when a byte of it was flipped', () => {
    for (let at = 0; at < file.length; at += 97) {
      const flipped = file.slice();
      flipped[at] ^= 1 << (at % 8);
      expect(() => chunksOf(flipped), `byte ${at}`).toThrow(ReadError);
    }
  });
});
