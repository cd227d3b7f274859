/** The trials of a page that holds many: seeds in rows, policies in columns, with what each trial rescued. */

import type { Recording } from '../recording/recording';
import { deliveries } from './curves';
import { element } from './dom';
import { linkTo, readLink } from './link';

/** So many trials stand side by side when no others were chosen. */
const MOST = 4;

const seedOf = (name: string): string => name.slice(name.lastIndexOf('-') + 1);
const policyOf = (name: string): string => name.slice(0, name.lastIndexOf('-'));

/** The trials to show: those of the address, or those with the first seed. Names end in `-SEED`. */
export function chosenOf(names: readonly string[], hash: string): string[] {
  const { trials } = readLink(hash);
  const known = trials.filter((name) => names.includes(name));
  return known.length > 0 ? known : withSeed(names, seedOf(names[0]));
}

const withSeed = (names: readonly string[], seed: string): string[] =>
  names.filter((name) => seedOf(name) === seed).slice(0, MOST);

export class TrialList {
  readonly root = element('section', { class: 'panel trials' });
  private readonly links = new Map<string, HTMLAnchorElement>();
  private readonly heads = new Map<string, HTMLElement>();

  constructor(
    names: readonly string[],
    private readonly chosen: readonly string[],
  ) {
    const seeds = [...new Set(names.map(seedOf))];
    for (const policy of new Set(names.map(policyOf))) this.heads.set(policy, element('th', {}, policy));
    const table = element(
      'table',
      { class: 'facts' },
      element('tr', {}, element('th'), ...this.heads.values()),
    );
    for (const seed of seeds) table.append(this.row(names, seed));
    this.root.append(element('h2', {}, `${names.length} trials, and how many each rescued`), table);
  }

  private row(names: readonly string[], seed: string): HTMLElement {
    const all = link(`seed ${seed}`, 'Show the trials with this seed side by side', withSeed(names, seed));
    const row = element('tr', {}, element('th', { scope: 'row' }, all));
    for (const policy of this.heads.keys()) {
      const name = `${policy}-${seed}`;
      const cell = element('td');
      row.append(cell);
      if (!names.includes(name)) continue;
      const made = link('…', `Show ${policy}, seed ${seed}`, [name]);
      if (this.chosen.includes(name)) made.setAttribute('aria-current', 'true');
      this.links.set(name, made);
      cell.append(made);
    }
    return row;
  }

  /** Says what a trial rescued. */
  tell(recording: Recording): void {
    const { name, header } = recording;
    const hasRescuees = header.world.rescuees.length > 0;
    const text = hasRescuees ? String(deliveries(recording).flat().length) : '▶';
    this.links.get(name)?.replaceChildren(text);
    this.heads.get(policyOf(name))?.replaceChildren(header.policy);
  }
}

/** A link to trials, at the moment that is shown. */
function link(text: string, title: string, trials: string[]): HTMLAnchorElement {
  const made = element('a', { title, href: linkTo({ time: null, robot: null, trials }) }, text);
  made.addEventListener('click', () => {
    made.href = linkTo({ ...readLink(location.hash), trials });
  });
  return made;
}
