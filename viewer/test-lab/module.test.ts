/** The module of the page against the command: every trial is the same, bit for bit. */

import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { beforeAll, describe, expect, it } from 'vitest';
import { Module } from '../src/lab/module';
import { command, compiled, hashOf, run, text, withFolder } from './support';

const MINUTE = 60_000;
const POLICIES = ['RNE', 'DIS', 'ENG', 'HP_DIS', 'RANDOM'];
const GALLERY = ['chance', 'collapse', 'corridors', 'failures', 'one-task', 'stepping-stones'];
const NAVIGATION = [
  'bay_1v1',
  'bottleneck_10',
  'circle_16',
  'crossing_8',
  'doorway_5v5',
  'hallway_2',
  'intersection_4',
  'room_20',
  'swap_42',
  'two_lanes_5v5',
];

let module: Module;

beforeAll(async () => {
  module = await Module.make(compiled);
});

const printed = (path: string, policy: string, seed: string): string =>
  command('run', path, '--policy', policy, '--seed', seed, '--json', '--quiet').trimEnd();

describe('the module', () => {
  it('imports nothing', () => expect(WebAssembly.Module.imports(compiled)).toEqual([]));

  it('tells what it cannot do in a sentence', () => {
    expect(() => module.json('advance', '1')).toThrow('no trial is running');
    expect(() => module.json('check', '{}')).toThrow('missing field `name`');
    const begin = (changes: object): unknown =>
      module.json(
        'begin',
        JSON.stringify({ name: 'a.ron', text: '()', policy: 'RNE', seed: '1', ...changes }),
      );
    expect(() => begin({ seed: '-1' })).toThrow(
      'the seed must be a whole number from 0 to 18446744073709551615',
    );
    expect(() => begin({ text: '' })).toThrow('a.ron: is empty');
    const paper = text('scenarios/paper.ron');
    expect(() => begin({ text: paper, policy: 'RNE(luck: 3)' })).toThrow('luck');
    expect(() => begin({ text: '(base: "b.ron")' })).toThrow(
      'b.ron: cannot be read: the page has no such file',
    );
  });
});

describe('a check', () => {
  it('names the file and the line of a mistake, in a base too', () => {
    const over = '(base: "../paper.ron", name: "over",\n mission: (rest: 1))';
    const paper = text('scenarios/paper.ron');
    const problem = (texts: Record<string, string>, own = over): unknown => {
      const asked = JSON.stringify({ name: 'gallery/over.ron', text: own, texts });
      return (module.json('check', asked) as { problems: unknown[] }).problems[0];
    };
    expect(problem({ 'paper.ron': paper })).toMatchObject({ file: null, line: 2, field: 'mission.rest' });
    const low = paper.replace('rest_s: 30.0', 'rest_s: -1.0');
    expect(problem({ 'paper.ron': low })).toMatchObject({ file: 'paper.ron', field: 'mission.rest_s' });
    expect(problem({ 'paper.ron': '(\n name: ' })).toMatchObject({ file: 'paper.ron', line: 2 });
    const itself = '(base: "over.ron", name: "over")';
    expect(problem({}, itself)).toMatchObject({ rule: 'must be a scenario without a base of its own' });
    expect(problem({})).toMatchObject({ sentence: 'paper.ron: cannot be read: the page has no such file' });
  });
});

describe('every trial is the one of the command', () => {
  it('the small worlds have their golden hashes', () => {
    const lines = text('tests/golden.txt').trim().split('\n').slice(1, 13);
    expect(lines.length).toBe(12);
    for (const line of lines) {
      const [world, hash] = line.split(' ');
      const path = `scenarios/minimal/${world}.ron`;
      expect(hashOf(run(module, { path, policy: 'RNE', check: true }).line), world).toBe(hash);
    }
  });

  it.each(['paper', 'leak'])(
    'whole records of %s.ron are equal, for five policies and three seeds',
    (name) => {
      const path = `scenarios/${name}.ron`;
      for (const policy of POLICIES) {
        for (const seed of ['1', '2', '3']) {
          expect(run(module, { path, policy, seed }).line, `${policy} ${seed}`).toBe(
            printed(path, policy, seed),
          );
        }
      }
    },
    2 * MINUTE,
  );

  it(
    'whole records of the gallery, of bases and of the problems of navigation are equal',
    () => {
      const gallery = GALLERY.map((name) => `scenarios/gallery/${name}.ron`);
      const navigation = NAVIGATION.map((name) => `scenarios/navigation/${name}.ron`);
      for (const path of [...gallery, ...navigation, 'scenarios/paper-calibrated.ron']) {
        expect(run(module, { path, policy: 'RNE', seed: '2' }).line, path).toBe(printed(path, 'RNE', '2'));
      }
    },
    3 * MINUTE,
  );

  it(
    'recordings are equal, byte for byte',
    () => {
      withFolder((folder) => {
        for (const [number, path] of ['scenarios/paper.ron', 'scenarios/gallery/collapse.ron'].entries()) {
          const file = join(folder, `${number}.usrec`);
          command('run', path, '--policy', 'RNE', '--seed', '3', '--quiet', '--record', file);
          const { recording } = run(module, { path, policy: 'RNE', seed: '3', record: true });
          expect(Buffer.compare(recording, readFileSync(file)), path).toBe(0);
        }
      });
    },
    MINUTE,
  );

  it(
    'slices of 1, 7 and 500 steps end alike',
    () => {
      const of = (slice: number): string =>
        run(module, { path: 'scenarios/gallery/one-task.ron', policy: 'RNE', slice }).line;
      expect(of(1)).toBe(of(500));
      expect(of(7)).toBe(of(500));
    },
    MINUTE,
  );
});

describe('what goes wrong', () => {
  it(
    'damaged texts are refused or run, and never trap',
    () => {
      const paper = text('scenarios/paper.ron');
      let seed = 1;
      const draw = (below: number): number => {
        seed = (seed * 48_271) % 2_147_483_647;
        return seed % below;
      };
      let refused = 0;
      for (let number = 0; number < 200; number++) {
        let damaged = paper;
        for (let times = 1 + draw(4); times > 0; times--) {
          const at = draw(damaged.length);
          const piece = ['', '(', ')', '9', '-', '"', ',', 'x', '1e9', '\u00e9', damaged.slice(at, at + 40)][
            draw(11)
          ];
          damaged = damaged.slice(0, at) + piece + damaged.slice(at + draw(12));
        }
        const asked = JSON.stringify({ name: 'damaged.ron', text: damaged });
        const { problems } = module.json('check', asked) as { problems: unknown[] };
        if (problems.length > 0) refused += 1;
        else {
          const begin = { name: 'damaged.ron', text: damaged, policy: 'RNE', seed: '1' };
          const begun = new TextDecoder().decode(module.bytes('begin', JSON.stringify(begin)));
          if (!begun.includes('"error"')) module.json('advance', '50');
        }
      }
      expect(refused).toBeGreaterThan(100);
      expect(refused).toBeLessThan(200);
    },
    2 * MINUTE,
  );

  it('answers of a page that do not fit are told', () => {
    const begin = { name: 'paper.ron', text: text('scenarios/paper.ron'), policy: 'MINE', seed: '1' };
    for (const [answer, told] of [
      ['[[0, 1], [2]]', 'robot 3 must be in exactly one group, found it in none'],
      ['[[0]]', '2'],
      ['"hard"', 'one list of robots'],
      ['[[0.5]]', 'one list of robots'],
      ['null', 'one list of robots'],
    ]) {
      module.json('begin', JSON.stringify(begin));
      expect(module.json('advance', '10')).toMatchObject({ state: 'asks' });
      expect(() => module.json('answer', answer), answer).toThrow(told);
      expect(module.json('advance', '10')).toMatchObject({ state: 'over', status: 'failed' });
      expect(() => module.json('finish')).toThrow('trial of MINE with seed 1 failed: the policy failed: ');
    }
  });
});

describe('comparisons', () => {
  it(
    'say the same as the command, to the last digit',
    () => {
      withFolder((folder) => {
        const [file, out] = ['paper.ron', 'results'].map((name) => join(folder, name));
        writeFileSync(file, text('scenarios/paper.ron')); // alone: no sweep file beside it names a margin
        command('sweep', file, '--trials', '12', '--policies', 'RNE,DIS', '--quiet', '--out', out);
        const told = JSON.parse(command('compare', out, '--metric', 'rescuees.total', '--json')) as {
          tables: { comparisons: { metric: string; a: string; b: string }[] };
        };
        const [theirs] = told.tables.comparisons;
        const { metric, a, b } = theirs;
        const value = (policy: string, seed: number): [number, string] => {
          const { line } = run(module, { path: 'scenarios/paper.ron', policy, seed: String(seed) });
          const record = JSON.parse(line) as { rescuees: number; state_hash: string };
          return [record.rescuees, record.state_hash];
        };
        const pairs = Array.from({ length: 12 }, (_, i) => {
          const [x, y] = [a, b].map((policy) => value(policy, i + 1));
          return [x[0], y[0], x[1], y[1]];
        });
        const ours = module.json('compare', JSON.stringify({ metric, a, b, pairs }));
        expect(ours).toEqual(theirs);
      });
    },
    MINUTE,
  );
});
