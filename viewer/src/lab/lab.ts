/** The laboratory: a scenario, two policies, and what they do with it. */

import { button, element } from '../ui/dom';
import { Checker } from './checker';
import { Choices } from './choices';
import { fileName, toCsv } from './commands';
import { type Checked, type CompareQuestion, type Compared, MINE, type PolicyFacts } from './contract';
import { Experiment, type Pair } from './experiment';
import { Header } from './header';
import { copyText, download, withSaved } from './page';
import { Problems } from './problems';
import { type Session, toHash } from './session';
import { Simulator } from './simulator';
import { Sliders } from './sliders';
import { PairTable } from './table';
import { Texts } from './texts';
import { Viewing } from './viewing';

/** What is run at first. */
const BEGIN = { a: 'RNE', b: 'DIS', seeds: '1..10' };

const MISTAKES = 'The scenario has mistakes: they are listed below the text.';

export class Lab {
  private readonly texts: Texts;
  private readonly checker: Checker;
  private readonly sliders: Sliders;
  private readonly choices: Choices;
  private readonly problems: Problems;
  private readonly header: Header;
  private readonly table: PairTable;
  readonly viewing: Viewing;
  private readonly body = element('div', { class: 'lab' });
  private simulator: Simulator | null = null;
  private experiment: Experiment | null = null;
  private scrolled = 0;
  /** The texts as they were begun, restored or saved last. */
  private kept = '';

  /** `page` is the page as it was delivered. */
  constructor(
    root: HTMLElement,
    private readonly page: string,
  ) {
    // The order matters: what is made later tells what was made before.
    this.problems = new Problems((problem) => this.texts.goTo(problem));
    this.checker = new Checker(
      () => this.texts.source(),
      (checked) => this.checked(checked),
      (sentence) => this.problems.say(sentence),
    );
    this.sliders = new Sliders(
      () => this.texts.shown ?? '',
      (change, goesOn) => this.texts.change(change, goesOn),
    );
    this.header = this.makeHeader();
    this.choices = new Choices(
      () => void this.run(),
      () => this.experiment?.cancel(),
      () => undefined,
    );
    this.choices.values = BEGIN;
    this.table = new PairTable((pair) => void this.openPair(pair));
    this.viewing = new Viewing(() => {
      this.body.hidden = false;
      window.scrollTo(0, this.scrolled);
    });
    // The texts tell at once that they are there.
    this.texts = new Texts(() => this.changed());
    this.changed();
    this.kept = this.fingerprint();
    this.layout(root);
  }

  private makeHeader(): Header {
    return new Header({
      choose: (path) => this.texts.choose(path),
      saveScenario: () => {
        const [name, text] = this.texts.scenario;
        download(fileName(name), text, 'text/plain');
      },
      saveTable: () => this.saveTable(),
      savePage: () => {
        download('usar-lab.html', withSaved(this.page, this.session()), 'text/html');
        this.kept = this.fingerprint();
      },
      copyLink: () => void this.copyLink(),
    });
  }

  private layout(root: HTMLElement): void {
    const reset = button('Original', 'Put the original text back (it can be undone)', () =>
      this.texts.reset(),
    );
    this.texts.bar.append(reset);
    this.texts.root.append(this.problems.root);
    const sliders = element(
      'section',
      { class: 'panel' },
      element('h2', {}, 'Numbers of the text'),
      this.sliders.root,
    );
    const side = element('div', { class: 'column' }, this.choices.root, sliders);
    this.body.append(
      this.header.root,
      element('div', { class: 'columns' }, this.texts.root, side),
      this.table.root,
    );
    root.replaceChildren(this.body, this.viewing.root);
    const key = (event: KeyboardEvent): void => {
      if (event.key !== 'Enter' || !(event.ctrlKey || event.metaKey) || this.body.hidden) return;
      event.preventDefault();
      event.stopPropagation();
      void this.run();
    };
    window.addEventListener('keydown', key, { capture: true });
  }

  /** Loads the simulator, and checks the text that is there. */
  async load(): Promise<void> {
    this.simulator = await Simulator.load();
    this.checker.simulator = this.simulator;
    this.choices.setPolicies(await this.simulator.call<PolicyFacts[]>('policies'));
    await this.checker.now();
  }

  private changed(): void {
    // While it is made, the texts are there before this knows of them.
    const texts = this.texts as Texts | undefined;
    if (!texts) return;
    this.header.showFile(texts.file);
    this.sliders.show(texts.shown ?? '');
    this.checker.later();
    this.table.setCurrent(this.isOfExperiment());
  }

  /** Whether the texts are those that were run last. */
  private isOfExperiment(): boolean {
    const plan = this.experiment?.plan;
    return !plan || JSON.stringify(plan.source) === JSON.stringify(this.texts.source());
  }

  /** Whether something was written that leaving the page would lose. */
  get isEdited(): boolean {
    return this.kept !== this.fingerprint();
  }

  private fingerprint(): string {
    const { texts, code } = this.texts.session();
    return JSON.stringify({ texts, code });
  }

  private checked(checked: Checked): void {
    this.texts.mark(checked.problems);
    this.problems.show(checked);
    if (checked.scenario) this.choices.unsay(MISTAKES);
  }

  private session(): Session {
    return { ...this.texts.session(), ...this.choices.values };
  }

  /** Says something in the head of the page. */
  say(sentence: string): void {
    this.header.say(sentence);
  }

  /** Shows texts and choices that were saved or shared. */
  restore(session: Session): void {
    this.texts.restore(session);
    this.choices.values = session;
    this.kept = this.fingerprint();
  }

  private async copyLink(): Promise<void> {
    const { a, b, seeds } = this.choices.values;
    const hash = await toHash({ ...this.session(), a, b, seeds });
    if (hash === null) {
      this.header.say(
        'This scenario is too long for an address (8 kB). Save the page or the scenario instead.',
      );
      return;
    }
    history.replaceState(null, '', hash);
    const ownPolicy = [a, b].some((policy) => policy.startsWith(MINE))
      ? ' The own policy is not part of it.'
      : '';
    const isCopied = await copyText(location.href);
    const where = isCopied ? 'The link is copied.' : 'The link is in the address line, to be copied there.';
    this.header.say(where + ownPolicy);
  }

  private saveTable(): void {
    if (!this.experiment) {
      this.header.say('There is no table yet: run two policies first.');
      return;
    }
    const name = fileName(this.experiment.plan.source.name).replace(/\.ron$/, '');
    download(`${name}.csv`, toCsv(this.experiment), 'text/csv');
  }

  private async openPair(pair: Pair): Promise<void> {
    if (!this.experiment) return;
    this.scrolled = window.scrollY;
    this.body.hidden = true;
    await this.viewing.open(this.experiment, pair);
  }

  /** Runs what the fields say, unless there are mistakes in the scenario. */
  async run(): Promise<void> {
    const choice = this.choices.choice();
    if (!choice || !this.simulator || this.isRunning) return;
    this.choices.setRunning(true);
    this.choices.progress(0, 'Checking the scenario ...');
    const checked = await this.checker.now();
    if (!checked?.scenario) {
      this.choices.say(MISTAKES);
      this.choices.setRunning(false);
      return;
    }
    const { texts } = this;
    const { tasks } = checked.scenario;
    const plan = { source: texts.source(), isOriginal: texts.isOriginal, tasks, code: texts.code, ...choice };
    texts.markOwn(null);
    const experiment = new Experiment(plan, (pair) => this.progress(experiment, pair));
    this.experiment = experiment;
    this.table.begin(experiment);
    await experiment.run(this.simulator);
    await this.compare(experiment);
    this.sayOver(experiment);
    this.choices.setRunning(false);
  }

  private get isRunning(): boolean {
    return this.choices.isRunning;
  }

  private progress(experiment: Experiment, pair: Pair): void {
    if (experiment !== this.experiment) return;
    for (const { state } of [pair.a, pair.b]) {
      if (state.kind === 'failed') this.texts.markOwn(state.sentence);
    }
    this.table.draw(pair);
    this.viewing.grew(pair);
    const { trials, over } = experiment;
    const parts = trials.map(({ state }) => (state.kind === 'running' ? state.part : 0));
    const part = (over + parts.reduce((sum, value) => sum + value, 0)) / trials.length;
    this.choices.progress(part, `${over} of ${trials.length} trials are over.`);
  }

  private sayOver({ pairs, wasCancelled }: Experiment): void {
    const whole = pairs.filter(({ a, b }) => a.state.kind === 'done' && b.state.kind === 'done');
    const how = wasCancelled ? 'Cancelled' : 'Done';
    this.choices.say(`${how}: ${whole.length} of ${pairs.length} pairs are complete.`);
  }

  /** Asks the module what the pairs say together. */
  private async compare(experiment: Experiment): Promise<void> {
    const pairs: CompareQuestion['pairs'] = [];
    for (const { a, b } of experiment.pairs) {
      if (a.state.kind !== 'done' || b.state.kind !== 'done') continue;
      const [x, y] = [a.state.record, b.state.record];
      pairs.push([x.rescuees, y.rescuees, x.state_hash, y.state_hash]);
    }
    const missing = experiment.pairs.length - pairs.length;
    const { a, b } = experiment.plan;
    if (pairs.length === 0) {
      this.table.say('No pair is complete, so there is nothing to compare.');
      return;
    }
    try {
      const question: CompareQuestion = { a, b, pairs, metric: 'rescuees.total' };
      this.table.tell(await this.simulator!.call<Compared>('compare', question));
      if (missing > 0)
        this.table.add(`${missing} of ${experiment.pairs.length} pairs are not complete, and not counted.`);
    } catch (error) {
      this.table.say(error instanceof Error ? error.message : String(error));
    }
  }
}
