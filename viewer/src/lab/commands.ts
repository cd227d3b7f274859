/** What can be said outside of the page: command lines and tables. */

import { MINE, policyName } from './contract';
import { type Experiment, type Plan, type Trial, energyOf } from './experiment';

/** A word as a shell takes it. */
const quoted = (word: string): string =>
  /^[\w./-]+$/.test(word) ? word : `'${word.replaceAll("'", "'\\''")}'`;

/** The last part of a path. */
export const fileName = (path: string): string => path.slice(path.lastIndexOf('/') + 1);

/** The command line of a trial; null for the own policy, which runs in this page alone. */
export function commandOf({ source, isOriginal }: Plan, { policy, seed }: Trial): string | null {
  if (policyName(policy) === MINE) return null;
  const file = isOriginal ? `scenarios/${source.name}` : fileName(source.name);
  return `usar run ${quoted(file)} --policy ${quoted(policy)} --seed ${seed} --json`;
}

/** The name of a trial's recording. */
export const recordingName = ({ source }: Plan, { policy, seed }: Trial): string =>
  `${fileName(source.name).replace(/\.ron$/, '')}-${policy.replace(/[^\w-]+/g, '_')}-${seed}.usrec`;

const cell = (value: string | number): string => {
  const text = String(value);
  return /[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
};

/** What a table says of a trial that has no record. */
function failure({ state }: Trial): string {
  if (state.kind === 'failed') return state.sentence;
  return state.kind === 'done' ? '' : state.kind;
}

/** The table as CSV: a row for each pair. */
export function toCsv({ plan, pairs }: Pick<Experiment, 'plan' | 'pairs'>): string {
  const { tasks } = plan;
  const of = (side: string): string[] => [
    `policy_${side}`,
    `rescuees_${side}`,
    ...tasks.map((task) => `rescuees_${side}_${task}`),
    `energy_${side}`,
    `state_hash_${side}`,
    `failure_${side}`,
  ];
  const rows: (string | number)[][] = [['scenario', 'seed', ...of('a'), ...of('b'), 'difference']];
  const valuesOf = (trial: Trial): (string | number)[] => {
    const { state, policy } = trial;
    if (state.kind !== 'done') return [policy, '', ...tasks.map(() => ''), '', '', failure(trial)];
    const { record } = state;
    const rescued = tasks.map((name) => record.tasks.find(({ task }) => task === name)?.rescued ?? '');
    return [policy, record.rescuees, ...rescued, energyOf(record), record.state_hash, ''];
  };
  for (const { seed, a, b } of pairs) {
    const isPair = a.state.kind === 'done' && b.state.kind === 'done';
    const difference = isPair ? rescuedBy(a) - rescuedBy(b) : '';
    rows.push([plan.source.name, seed, ...valuesOf(a), ...valuesOf(b), difference]);
  }
  return rows.map((row) => `${row.map(cell).join(',')}\r\n`).join('');
}

const rescuedBy = ({ state }: Trial): number => (state.kind === 'done' ? state.record.rescuees : 0);
