import { readFileSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import { commandOf, toCsv } from '../src/lab/commands';
import type { Experiment, Trial } from '../src/lab/experiment';
import { changeOf, fieldsOf, written } from '../src/lab/fields';
import { withSaved } from '../src/lab/page';
import { lineOf } from '../src/lab/policyErrors';
import { Scanner, baseOf } from '../src/lab/ron';
import { basesOf, resolved } from '../src/lab/scenarios';
import { parseSeeds } from '../src/lab/seeds';
import { type Session, fromHash, sessionOf, toHash } from '../src/lab/session';

const paper = readFileSync(new URL('../../scenarios/paper.ron', import.meta.url), 'utf8');

describe('values of a RON text', () => {
  const valueOf = (text: string, path: string): string | undefined =>
    Scanner.scan(text).find((leaf) => leaf.path === path)?.text;

  it('are found by their paths', () => {
    expect(valueOf(paper, 'duration_s')).toBe('600.0');
    expect(valueOf(paper, 'mission.rest_s')).toBe('30.0');
    expect(valueOf(paper, 'team.1.count')).toBe('4');
    expect(valueOf(paper, 'roles.2.speed_mps')).toBe('1.5');
    expect(valueOf(paper, 'initial_levels.energy.mean')).toBe('80.0');
    expect(valueOf(paper, 'conflicts.resolver.margin_m')).toBe('0.15');
    expect(valueOf(paper, 'tasks.1.grid.0')).toBe('20');
  });

  it('stand where they are said to stand', () => {
    for (const { text, from, to, kind } of Scanner.scan(paper)) {
      expect(paper.slice(from, to)).toBe(kind === 'string' ? `"${text}"` : text);
    }
  });

  it('are not those of comments and strings', () => {
    const text =
      '(a: 1, // b: 2\n /* c: 3 /* d: 4 */ e: 5 */ f: "g: 6, \\" h: 7", i: r#"x" y: 8"#, j: -9.5e3)';
    expect(Scanner.scan(text).map(({ path, text: value }) => [path, value])).toEqual([
      ['a', '1'],
      ['f', 'g: 6, \\" h: 7'],
      ['i', 'x" y: 8'],
      ['j', '-9.5e3'],
    ]);
  });

  it('are found in broken texts, too', () => {
    expect(valueOf('(duration_s: 5, mission: (rest_s: 3', 'mission.rest_s')).toBe('3');
    expect(Scanner.scan(')]}"').length).toBe(0);
  });
});

describe('sliders', () => {
  it('have the numbers that are in the text', () => {
    const fields = fieldsOf(paper);
    expect(fields[0]).toMatchObject({ path: 'duration_s', group: 'Trial', value: 600 });
    expect(fields.find(({ path }) => path === 'team.0.count')?.label).toBe('team[0].count (carrier)');
    expect(fields.some(({ path }) => path.startsWith('arena_m'))).toBe(false);
    for (const { value, least, most } of fields) expect(value >= least && value <= most).toBe(true);
    expect(fieldsOf('(values: (leak_m: 4.5), duration_s: Uniform(2, 5))').map(({ path }) => path)).toEqual([
      'values.leak_m',
    ]);
  });

  it('replace exactly one number', () => {
    const change = changeOf(paper, { path: 'mission.rest_s', step: 1 }, 45)!;
    const text = paper.slice(0, change.from) + change.insert + paper.slice(change.to);
    expect(text).toBe(paper.replace('rest_s: 30.0', 'rest_s: 45.0'));
    expect(changeOf(paper, { path: 'mission.nothing', step: 1 }, 45)).toBeNull();
  });

  it('write numbers as they were written', () => {
    expect([written(7, '6', 1), written(7, '6.0', 1), written(0.30000000000000004, '0.5', 0.05)]).toEqual([
      '7',
      '7.0',
      '0.3',
    ]);
  });
});

describe('bases', () => {
  it('are found from the folder of the file', () => {
    expect(resolved('gallery/collapse.ron', '../paper.ron')).toBe('paper.ron');
    expect(resolved('a.ron', './gallery/b.ron')).toBe('gallery/b.ron');
    expect(baseOf('(format: 2, base: "../paper.ron", // base: "x"\n name: "y")')).toBe('../paper.ron');
    expect(baseOf(paper)).toBeNull();
  });

  it('end where a file is missing or comes again', () => {
    const texts = new Map([
      ['gallery/a.ron', '(base: "../b.ron")'],
      ['b.ron', '(base: "gallery/c.ron")'],
      ['gallery/c.ron', '(base: "a.ron")'],
    ]);
    expect(basesOf('gallery/a.ron', (path) => texts.get(path))).toEqual(['b.ron', 'gallery/c.ron']);
    expect(basesOf('x.ron', () => undefined)).toEqual([]);
  });
});

describe('seeds', () => {
  it('are single ones and ranges', () => {
    expect(parseSeeds('1..4')).toEqual({ seeds: ['1', '2', '3', '4'] });
    expect(parseSeeds(' 1, 2,5..6 2')).toEqual({ seeds: ['1', '2', '5', '6'] });
    expect(parseSeeds('18446744073709551615')).toEqual({ seeds: ['18446744073709551615'] });
  });

  it('are refused in a sentence', () => {
    for (const text of ['', 'x', '5..1', '-1', '1..2000', '18446744073709551616', '1..1e3']) {
      expect(parseSeeds(text), text).toHaveProperty('error');
    }
  });
});

describe('errors of the own policy', () => {
  it('have the line of their stack', () => {
    const error = new Error('no');
    error.stack = 'Error: no\n    at decide (blob:null/1f:3:11)\n    at trial (blob:null/1f:20:5)';
    expect(lineOf(error)).toBe(3);
    error.stack = 'decide@blob:null/1f:4:7\n';
    expect(lineOf(error)).toBe(4);
    expect(lineOf('no')).toBeNull();
  });
});

const session: Session = { file: 'a.ron', texts: { 'a.ron': '(é: "<")' }, a: 'RNE', b: 'DIS', seeds: '1..3' };

describe('links', () => {
  it('hold what was made, but never code', async () => {
    const hash = await toHash({ ...session, code: 'function decide() {}' });
    expect(hash).toMatch(/^#lab=[\w-]+$/);
    expect(await fromHash(hash!)).toEqual(session);
    expect(await fromHash('')).toBeNull();
    expect(await fromHash('#t=12')).toBeNull();
    await expect(fromHash('#lab=%%')).rejects.toThrow();
  });

  it('are refused where they would be long or hold much', async () => {
    const noise = Array.from({ length: 20_000 }, (_, i) => Math.imul(i + 1, 2654435761) >>> 0).join();
    expect(await toHash({ ...session, texts: { 'a.ron': noise } })).toBeNull();
    const much = await toHash({ ...session, texts: { 'a.ron': ' '.repeat(3e6) } });
    await expect(fromHash(much!)).rejects.toThrow('too much');
  });
});

describe('saved sessions', () => {
  it('are taken only if they are sessions', () => {
    expect(sessionOf({ ...session, code: 'x', more: 1 })).toEqual({ ...session, code: 'x' });
    for (const other of [null, 3, {}, { ...session, texts: { a: 1 } }, { ...session, seeds: 1 }]) {
      expect(sessionOf(other)).toBeNull();
    }
  });

  it('stand in the page as data, whatever they hold', () => {
    const page = '<script type="application/json" id="saved">null</script><p>id="saved"</p>';
    const saved = { text: '</script><!-- $& $1' };
    const [, block] = /id="saved">(.*?)<\/script>/.exec(withSaved(page, saved))!;
    expect(JSON.parse(block)).toEqual(saved);
    expect(withSaved(withSaved(page, saved), null)).toBe(page);
  });
});

describe('what is said outside of the page', () => {
  const record = {
    ...{
      scenario: 'a',
      policy: 'RNE',
      seed: 1,
      rescuees: 9,
      status: 'Completed',
      time_s: 60,
      state_hash: 'ab',
    },
    ...{ tasks: [{ task: 'x', rescued: 9, energy: 2.5 }], ungrouped_energy: 0.5 },
  };
  const a: Trial = {
    policy: 'RNE(hard_rule: MeanEnergy)',
    seed: '1',
    state: { kind: 'done', record },
    parts: [],
  };
  const b: Trial = {
    policy: 'MINE',
    seed: '1',
    state: { kind: 'failed', sentence: 'no "x", or y' },
    parts: [],
  };
  const plan = {
    ...{ source: { name: 'gallery/a.ron', text: '', texts: {} }, isOriginal: true, tasks: ['x'] },
    ...{ a: a.policy, b: b.policy, seeds: ['1'], code: '' },
  };

  it('are commands', () => {
    const command = "--policy 'RNE(hard_rule: MeanEnergy)' --seed 1 --json";
    expect(commandOf(plan, a)).toBe(`usar run scenarios/gallery/a.ron ${command}`);
    expect(commandOf({ ...plan, isOriginal: false }, a)).toBe(`usar run a.ron ${command}`);
    expect(commandOf(plan, b)).toBeNull();
  });

  it('are tables', () => {
    const experiment: Pick<Experiment, 'plan' | 'pairs'> = { plan, pairs: [{ seed: '1', a, b }] };
    expect(toCsv(experiment).split('\r\n').slice(1)).toEqual([
      'gallery/a.ron,1,RNE(hard_rule: MeanEnergy),9,9,3,ab,,MINE,,,,,"no ""x"", or y",',
      '',
    ]);
  });
});
