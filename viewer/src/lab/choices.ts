/** The fields for what to run: two policies and the seeds. */

import { button, element } from '../ui/dom';
import { MINE, type PolicyFacts, policyName } from './contract';
import { parseSeeds } from './seeds';

/** What can be said of the own policy. */
const OWN: PolicyFacts = { name: MINE, about: 'the function in the tab "Own policy"' };

/** What is to be run. */
export interface Choice {
  a: string;
  b: string;
  seeds: string[];
}

class PolicyField {
  readonly input = element('input', { list: 'policies', autocomplete: 'off', spellcheck: 'false' });
  readonly root: HTMLElement;
  private readonly about = element('span', { class: 'hint' });

  constructor(name: string) {
    this.input.setAttribute('aria-label', `Policy ${name}`);
    this.root = element('label', { class: 'field' }, `Policy ${name}`, this.input, this.about);
  }

  /** Says what the policy is. */
  tell(policies: readonly PolicyFacts[]): void {
    const known = policies.find(({ name }) => name === policyName(this.input.value));
    const options = known?.options ? ` Options: ${known.options}` : '';
    this.about.textContent = known ? `${known.about}.${options}` : '';
  }
}

export class Choices {
  readonly root = element('section', { class: 'panel choices' });
  private readonly fields = { a: new PolicyField('A'), b: new PolicyField('B') };
  private readonly seedInput = element('input', { autocomplete: 'off', 'aria-label': 'Seeds' });
  private readonly seedsTold = element('span', { class: 'hint' });
  private readonly list = element('datalist', { id: 'policies' });
  private readonly runButton: HTMLButtonElement;
  private readonly cancelButton: HTMLButtonElement;
  private readonly bar = element('progress', { max: '1', value: '0', 'aria-label': 'Trials that are over' });
  private readonly status = element('p', { class: 'status', role: 'status' });
  private policies: readonly PolicyFacts[] = [OWN];

  constructor(run: () => void, cancel: () => void, changed: () => void) {
    this.runButton = button('Run', 'Run all trials (Ctrl+Enter)', run, 'play');
    this.cancelButton = button('Cancel', 'Stop all trials', cancel);
    const { a, b } = this.fields;
    const seeds = element('label', { class: 'field' }, 'Seeds', this.seedInput, this.seedsTold);
    const tools = element('div', { class: 'tools' }, this.runButton, this.cancelButton, this.bar);
    this.root.append(element('h2', {}, 'Two policies, the same seeds'), this.list);
    this.root.append(element('div', { class: 'fields' }, a.root, b.root, seeds), tools, this.status);
    for (const { input } of [a, b, { input: this.seedInput }]) {
      input.addEventListener('input', () => {
        this.tell();
        changed();
      });
    }
    this.setPolicies([]);
    this.setRunning(false);
  }

  setPolicies(policies: readonly PolicyFacts[]): void {
    this.policies = [...policies, OWN];
    const options = this.policies.map(({ name, about }) =>
      element('option', { value: name, label: `${name}: ${about}` }),
    );
    this.list.replaceChildren(...options);
    this.tell();
  }

  get values(): { a: string; b: string; seeds: string } {
    const { a, b } = this.fields;
    return { a: a.input.value.trim(), b: b.input.value.trim(), seeds: this.seedInput.value.trim() };
  }

  set values({ a, b, seeds }: { a: string; b: string; seeds: string }) {
    this.fields.a.input.value = a;
    this.fields.b.input.value = b;
    this.seedInput.value = seeds;
    this.tell();
  }

  private tell(): void {
    this.fields.a.tell(this.policies);
    this.fields.b.tell(this.policies);
    const parsed = parseSeeds(this.seedInput.value);
    const pairs = (count: number): string => (count === 1 ? '1 pair' : `${count} pairs`);
    this.seedsTold.textContent =
      'error' in parsed ? parsed.error : `${pairs(parsed.seeds.length)} of trials.`;
  }

  /** What the fields say; null, and a sentence below them, if they do not say enough. */
  choice(): Choice | null {
    const { a, b, seeds } = this.values;
    const parsed = parseSeeds(seeds);
    if (a === '' || b === '') this.say('Give two policies.');
    else if (a === b) this.say('A and B are the same policy: give two that differ.');
    else if ('error' in parsed) this.say(parsed.error);
    else return { a, b, seeds: parsed.seeds };
    return null;
  }

  say(sentence: string): void {
    this.status.textContent = sentence;
  }

  /** Takes back a sentence, if it still stands there. */
  unsay(sentence: string): void {
    if (this.status.textContent === sentence) this.say('');
  }

  get isRunning(): boolean {
    return this.runButton.disabled;
  }

  setRunning(isRunning: boolean): void {
    this.runButton.disabled = isRunning;
    this.cancelButton.disabled = !isRunning;
    this.bar.hidden = !isRunning;
  }

  progress(part: number, sentence: string): void {
    this.bar.value = part;
    this.say(sentence);
  }
}
