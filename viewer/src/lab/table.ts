/** The table of pairs: a row for each seed, and below it what they say together. */

import { button, element } from '../ui/dom';
import { commandOf } from './commands';
import type { Compared } from './contract';
import { copyText } from './page';
import { type Experiment, type Pair, type Trial, energyOf } from './experiment';

/** Fewer pairs than this settle little. */
const FEW = 10;

/** So long a button says that it has copied, in milliseconds. */
const SAID = 1200;

/** How much of a hash is shown. */
const HASH = 8;

interface Row {
  root: HTMLTableRowElement;
  open: HTMLButtonElement;
}

const td = (kind: string, ...children: (Node | string)[]): HTMLTableCellElement =>
  element('td', { class: kind }, ...children);

/** What a trial is that has no record. */
function stateText({ state }: Trial): string {
  if (state.kind === 'running') return `${Math.floor(100 * state.part)} %`;
  return state.kind === 'failed' ? state.sentence : state.kind;
}

export class PairTable {
  readonly root = element('section', { class: 'panel results', 'aria-label': 'Results' });
  private readonly rows = new Map<Pair, Row>();
  private readonly answer = element('div', { class: 'answer', role: 'status' });
  private readonly old = element('p', { class: 'few' }, 'The texts have changed since this run.');
  private experiment: Experiment | null = null;

  constructor(private readonly openPair: (pair: Pair) => void) {
    this.sayNothing();
  }

  private sayNothing(): void {
    const hint =
      'Run two policies, and each pair of trials gets a row here. A row opens both trials side by side.';
    this.root.replaceChildren(element('h2', {}, 'Results'), element('p', { class: 'hint' }, hint));
  }

  /** Shows the pairs of another experiment. */
  begin(experiment: Experiment): void {
    this.experiment = experiment;
    this.rows.clear();
    const { a, b, source, tasks, isOriginal } = experiment.plan;
    const each = tasks.length > 1 ? ` (${tasks.join(' + ')})` : '';
    const head = [
      'Seed',
      `Rescued by A: ${a}${each}`,
      `Rescued by B: ${b}${each}`,
      'A - B',
      'Energy A',
      'Energy B',
    ];
    const heads = [...head, 'State hash A', 'State hash B', 'Command line'].map((text) =>
      element('th', { scope: 'col' }, text),
    );
    const body = element('tbody');
    for (const pair of experiment.pairs) {
      const open = button(
        `${pair.seed} ▸`,
        `Show both trials with seed ${pair.seed}`,
        () => undefined,
        'open',
      );
      const row: Row = { root: element('tr'), open };
      row.root.addEventListener('click', (event) => {
        const inner = (event.target as Element).closest('button');
        if (!row.open.disabled && (inner === null || inner === row.open)) this.openPair(pair);
      });
      this.rows.set(pair, row);
      this.draw(pair);
      body.append(row.root);
    }
    const table = element(
      'table',
      { class: 'pairs' },
      element('thead', {}, element('tr', {}, ...heads)),
      body,
    );
    const title = element('h2', {}, `Results of ${source.name}: A is ${a}, B is ${b}`);
    this.answer.replaceChildren();
    const scroller = element(
      'div',
      { class: 'scroller', tabindex: '0', role: 'region', 'aria-label': 'Pairs' },
      table,
    );
    const hint = `The command lines read the file ${source.name}: save the changed text first.`;
    const notes = isOriginal ? [] : [element('p', { class: 'hint' }, hint)];
    this.old.hidden = true;
    this.root.replaceChildren(title, this.old, scroller, this.answer, ...notes);
  }

  /** Draws a row anew. */
  draw(pair: Pair): void {
    const row = this.rows.get(pair);
    if (!row || !this.experiment) return;
    const { a, b } = pair;
    row.open.disabled = a.parts.length === 0 || b.parts.length === 0;
    const records = [a, b].map(({ state }) => (state.kind === 'done' ? state.record : null));
    const [recordA, recordB] = records;
    const rescued = [a, b].map((trial, i) => this.rescued(trial, records[i]));
    const energy = records.map((record) => td('number', record ? energyOf(record).toFixed(1) : ''));
    const hashes = records.map((record) => {
      const cell = td('hash', record ? record.state_hash.slice(0, HASH) : '');
      if (record) cell.title = record.state_hash;
      return cell;
    });
    const difference = recordA && recordB ? recordA.rescuees - recordB.rescuees : null;
    const sign = difference !== null && difference > 0 ? '+' : '';
    const told = td('number difference', difference === null ? '' : `${sign}${difference}`);
    const commands = td('commands', this.command('A', a), this.command('B', b));
    row.root.replaceChildren(
      element('th', { scope: 'row' }, row.open),
      ...rescued,
      told,
      ...energy,
      ...hashes,
      commands,
    );
  }

  private rescued(
    trial: Trial,
    record: { rescuees: number; tasks: { rescued: number }[] } | null,
  ): HTMLElement {
    if (!record) {
      return td(`state ${trial.state.kind}`, stateText(trial));
    }
    const each = record.tasks.map(({ rescued }) => rescued).join(' + ');
    const cell = td('number', element('b', {}, String(record.rescuees)));
    if (record.tasks.length > 1) cell.append(element('small', {}, each));
    return cell;
  }

  private command(side: string, trial: Trial): HTMLElement {
    const command = this.experiment && commandOf(this.experiment.plan, trial);
    if (!command) {
      return element(
        'button',
        { type: 'button', disabled: '', title: 'This policy runs only in this page' },
        side,
      );
    }
    const copied = async (): Promise<void> => {
      if (!(await copyText(command))) window.prompt('The command line of this trial', command);
      copy.textContent = '✓';
      setTimeout(() => (copy.textContent = side), SAID);
    };
    const copy = button(side, `Copy: ${command}`, () => void copied());
    return copy;
  }

  /** Says what the pairs say together, in the words of the program. */
  tell(compared: Compared): void {
    const { n, mean_a, mean_b, difference, interval, in_words } = compared;
    const number = (value: number): string => String(Number(value.toPrecision(4)));
    const from = interval && `95 % interval ${interval.map(number).join(' to ')}`;
    const facts = [`n = ${n}`, `mean of A ${number(mean_a)}`, `mean of B ${number(mean_b)}`];
    facts.push(`mean difference A - B ${number(difference)}`, from ?? 'no interval of so few pairs');
    const words = element('p', { class: 'in-words' }, in_words);
    this.answer.replaceChildren(words, element('p', { class: 'hint' }, `${facts.join(', ')}.`));
    if (n < FEW)
      this.answer.append(element('p', { class: 'few' }, `So few pairs settle little: run at least ${FEW}.`));
  }

  /** Says whether the table is of the texts as they are now. */
  setCurrent(isCurrent: boolean): void {
    this.old.hidden = isCurrent;
  }

  /** Says something below the table in place of a comparison. */
  say(sentence: string): void {
    this.answer.replaceChildren(element('p', { class: 'hint' }, sentence));
  }

  /** Adds a sentence below what the pairs say together. */
  add(sentence: string): void {
    this.answer.append(element('p', { class: 'few' }, sentence));
  }
}
