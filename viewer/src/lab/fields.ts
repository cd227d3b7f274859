/** The fields of a scenario that are worth turning, and how far. */

import { type Leaf, Scanner } from './ron';

/** A number in the text that a slider turns. */
export interface Field {
  path: string;
  /** What it is called: `team[0].count (carrier)`. */
  label: string;
  /** What it is called among others of its group: `carrier: count`. */
  short: string;
  group: string;
  value: number;
  least: number;
  most: number;
  step: number;
}

/** Fields by the end of their paths: the least and the greatest value, and the step. */
const RANGES: [pattern: RegExp, least: number, most: number, step: number][] = [
  [/^duration_s$/, 60, 1800, 30],
  [/^team\.\d+\.count$/, 1, 20, 1],
  [/^mission\.(energy|hp)_threshold$/, 0, 90, 1],
  [/^mission\.rest_reserve$/, 1, 5, 0.1],
  [/^mission\.rest_s$/, 0, 120, 1],
  [/^mission\.loading_s$/, 0, 20, 0.5],
  [/^mission\.(reach|area_margin)_m$/, 0.5, 10, 0.5],
  [/^mission\.\w+_speed_loss$/, 0, 0.9, 0.05],
  [/^mission\.health_floor$/, 0, 1, 0.05],
  [/^mission\.cut_off_s$/, 10, 300, 5],
  [/^initial_levels\.\w+\.mean$/, 1, 100, 1],
  [/^initial_levels\.\w+\.sd$/, 0, 50, 1],
  [/^roles\.\d+\.speed_mps$/, 0.25, 5, 0.05],
  [/^roles\.\d+\.(capacity|resources)$/, 0, 20, 1],
  [/^roles\.\d+\.sensing_m$/, 0.5, 40, 0.5],
  [/^roles\.\d+\.(hp|energy)$/, 10, 300, 5],
  [/^tasks\.\d+\.sampled\.(debris|radiation)$/, 0, 30, 1],
  [/^scatter\.\d+\.count$/, 0, 30, 1],
  [/^radiation\.\d+\.radius_m$/, 0.5, 12, 0.5],
  [/^needs\.\d+\.weight$/, 0, 10, 0.1],
  [/^costs\.energy\.per_step$/, 0, 0.02, 0.0005],
  [/^costs\.hp\.per_step$/, 0, 0.005, 0.0001],
  [/^costs\.\w+\.per_(metre|second)$/, 0, 2, 0.01],
  [/^costs\.work\.\w+_per_second$/, 0, 2, 0.01],
  [/^planning\.clearance_m$/, 0, 1, 0.05],
  [/^planning\.exposure_price_m$/, 0, 50, 0.5],
];

/** What the groups of sliders are called, by the first field of a path. */
const GROUPS: Record<string, string> = {
  duration_s: 'Trial',
  mission: 'Mission',
  team: 'Team',
  initial_levels: 'Initial levels',
  values: 'Values',
  roles: 'Roles',
  needs: 'Needs',
  tasks: 'Tasks',
  scatter: 'Scatter',
  radiation: 'Radiation',
  costs: 'Costs',
  planning: 'Planning',
};

/** Named values have no range of their own: they go from nothing to twice what they are. */
function rangeOf(path: string, value: number): [least: number, most: number, step: number] | null {
  const range = RANGES.find(([pattern]) => pattern.test(path));
  if (range) return [Math.min(range[1], value), Math.max(range[2], value), range[3]];
  if (!/^values\.\w+$/.test(path) || value === 0) return null;
  const most = 2 * Math.abs(value);
  return [Math.min(0, 2 * value), Math.max(0, 2 * value), 10 ** Math.floor(Math.log10(most) - 1.5)];
}

/** What a list's entry calls itself: its `role` or its `name`. */
function nameOf(leaves: readonly Leaf[], path: string): string | undefined {
  const entry = /^\w+\.\d+\./.exec(path)?.[0];
  if (entry === undefined) return undefined;
  return leaves.find((leaf) => [`${entry}role`, `${entry}name`].includes(leaf.path))?.text;
}

function fieldOf(leaf: Leaf, leaves: readonly Leaf[]): Field | null {
  const value = Number(leaf.text.replaceAll('_', ''));
  const range = Number.isFinite(value) ? rangeOf(leaf.path, value) : null;
  if (!range) return null;
  const [least, most, step] = range;
  const [first] = leaf.path.split('.', 1);
  const name = nameOf(leaves, leaf.path);
  const path = leaf.path.replace(/\.(\d+)/g, '[$1]');
  const label = name === undefined ? path : `${path} (${name})`;
  const rest = leaf.path.replace(/^\w+\./, '');
  const [place, ...inner] = rest.split('.');
  const isEntry = /^\d+$/.test(place);
  const short = isEntry ? `${name ?? `${first}[${place}]`}: ${inner.join('.')}` : rest;
  return { path: leaf.path, label, short, group: GROUPS[first] ?? first, value, least, most, step };
}

/** The numbers of a text that sliders turn, by groups in a fixed order. */
export function fieldsOf(text: string): Field[] {
  const leaves = Scanner.scan(text);
  const numbers = leaves.filter(({ kind }) => kind === 'number');
  const fields = numbers.map((leaf) => fieldOf(leaf, leaves)).filter((field) => field !== null);
  const order = Object.values(GROUPS);
  return fields.sort((a, b) => order.indexOf(a.group) - order.indexOf(b.group));
}

/** A number as it is written in place of another: with a point if that had one. */
export function written(value: number, before: string, step: number): string {
  const places = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9));
  const text = String(Number(value.toFixed(places)));
  return before.includes('.') && !/[.e]/.test(text) ? `${text}.0` : text;
}

/** The change of the text that gives a field another value; null if the field is not there any more. */
export function changeOf(
  text: string,
  { path, step }: Pick<Field, 'path' | 'step'>,
  value: number,
): { from: number; to: number; insert: string } | null {
  const leaf = Scanner.scan(text).find((other) => other.path === path && other.kind === 'number');
  return leaf ? { from: leaf.from, to: leaf.to, insert: written(value, leaf.text, step) } : null;
}
