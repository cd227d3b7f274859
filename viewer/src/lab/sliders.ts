/** Sliders for the numbers of a scenario: each turns exactly one number of the text. */

import { element } from '../ui/dom';
import { type Field, changeOf, fieldsOf, written } from './fields';

/** Groups that are open at first. */
const OPEN = ['Trial', 'Mission', 'Team', 'Values'];

/** What a slider does to the text: the change, and whether it goes on with the one before. */
type Turn = (change: { from: number; to: number; insert: string }, goesOn: boolean) => void;

interface Row {
  field: Field;
  input: HTMLInputElement;
  output: HTMLOutputElement;
}

export class Sliders {
  readonly root = element('div', { class: 'sliders' });
  private rows: Row[] = [];
  private readonly open = new Set(OPEN);
  private isTurning = false;

  constructor(
    private readonly textNow: () => string,
    private readonly turn: Turn,
  ) {}

  /** Shows the numbers of a text. */
  show(text: string): void {
    const fields = fieldsOf(text);
    const isSame =
      fields.length === this.rows.length &&
      fields.every(({ label }, i) => label === this.rows[i].field.label);
    if (!isSame) this.rebuild(fields);
    fields.forEach((field, i) => this.set(this.rows[i], field));
  }

  private set(row: Row, field: Field): void {
    // While it is turned, a slider keeps its range: the range may depend on the value.
    if (!this.isTurning) {
      row.field = field;
      const { least, most, step } = field;
      Object.assign(row.input, { min: String(least), max: String(most), step: String(step) });
      row.input.value = String(field.value);
    }
    row.output.textContent = String(field.value);
  }

  private rebuild(fields: readonly Field[]): void {
    this.rows = fields.map((field) => this.row(field));
    const groups = new Map<string, HTMLElement[]>();
    for (const { field, input, output } of this.rows) {
      const label = element(
        'label',
        { class: 'slider', title: field.label },
        element('span', {}, field.short),
        output,
        input,
      );
      groups.set(field.group, [...(groups.get(field.group) ?? []), label]);
    }
    const parts = [...groups].map(([name, labels]) => this.group(name, labels));
    const none = element('p', { class: 'hint' }, 'This text has no numbers that a slider could turn.');
    this.root.replaceChildren(...(parts.length > 0 ? parts : [none]));
  }

  private group(name: string, labels: HTMLElement[]): HTMLElement {
    const details = element('details', {}, element('summary', {}, `${name} (${labels.length})`), ...labels);
    details.open = this.open.has(name);
    details.addEventListener('toggle', () => {
      if (details.open) this.open.add(name);
      else this.open.delete(name);
    });
    return details;
  }

  private row(field: Field): Row {
    const input = element('input', { type: 'range', 'aria-label': field.label });
    const row: Row = { field, input, output: element('output') };
    input.addEventListener('input', () => {
      const value = Number(input.value);
      const change = changeOf(this.textNow(), row.field, value);
      if (!change) return;
      const goesOn = this.isTurning;
      this.isTurning = true;
      row.output.textContent = written(value, '', row.field.step);
      this.turn(change, goesOn);
    });
    input.addEventListener('change', () => {
      this.isTurning = false;
    });
    return row;
  }
}
