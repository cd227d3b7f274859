/** The texts of the page: the scenario, those that it builds on, and the own policy, each in a tab. */

import { button, element } from '../ui/dom';
import type { Problem, Source } from './contract';
import { Editor } from './editor';
import { FIRST, SCENARIOS, basesOf } from './scenarios';
import type { Session } from './session';

/** The name of the text of the own policy. */
const OWN = 'own-policy.js';

/** A policy that works at once. */
export const TEMPLATE = `// Deals each role over the tasks by ids. A quota says how many each task gets.
function decide(question) {
  const groups = question.tasks.map(() => []);
  question.roles.forEach((_, role) => {
    const ids = question.members.filter((robot) => robot.role === role).map((robot) => robot.id);
    question.quotas[role].members.forEach((count, task) => groups[task].push(...ids.splice(0, count)));
  });
  return groups;
}
`;

const OWN_HINT =
  "Run it as the policy MINE. It is asked before each round, and returns the ids of each task's group. " +
  'console.log(question) shows the question in the console of the browser.';

export class Texts {
  readonly root = element('section', { class: 'panel texts', 'aria-label': 'Texts' });
  /** The tabs; there is room for a button beside them. */
  readonly bar = element('div', { class: 'strip' });
  private readonly tabs = element('div', { class: 'tabs', role: 'group', 'aria-label': 'Text' });
  private readonly editor: Editor;
  private readonly hint = element('p', { class: 'hint own' }, OWN_HINT);
  private problems: readonly Problem[] = [];
  private ownProblems: Problem[] = [];
  private tabNames: string[] = [];
  /** The path of the scenario. */
  file = '';

  /** `changed` is called when a text has changed or another one is shown. */
  constructor(private readonly changed: () => void) {
    const place = element('div', { class: 'editor' });
    this.bar.append(this.tabs);
    this.root.append(this.bar, place, this.hint);
    this.editor = new Editor(place, () => {
      this.showTabs();
      changed();
    });
    this.editor.add(OWN, TEMPLATE);
    this.choose(FIRST);
  }

  /** A text, whether it was edited or not. */
  private textOf(path: string): string | undefined {
    return this.editor.text(path) ?? SCENARIOS.get(path);
  }

  /** Shows a scenario. */
  choose(path: string): void {
    const text = this.textOf(path);
    if (text === undefined) return;
    this.file = path;
    this.show(path);
  }

  private show(name: string): void {
    const text = this.textOf(name);
    if (text !== undefined) this.editor.add(name, text);
    this.editor.show(name);
    this.editor.mark(name, this.problemsOf(name));
    this.showTabs();
    this.changed();
  }

  private showTabs(): void {
    this.hint.hidden = this.editor.shown !== OWN;
    const names = [this.file, ...this.bases(), OWN];
    const key = [...names, this.editor.shown];
    if (key.join('\n') === this.tabNames.join('\n')) return;
    this.tabNames = key;
    const tabs = names.map((name) => {
      const text = name === OWN ? 'Own policy' : name;
      const tab = button(text, `Edit ${name === OWN ? 'your own policy' : name}`, () => this.show(name));
      tab.setAttribute('aria-pressed', String(name === this.editor.shown));
      return tab;
    });
    this.tabs.replaceChildren(...tabs);
  }

  private bases(): string[] {
    return basesOf(this.file, (path) => this.textOf(path));
  }

  /** The scenario as it is now. */
  source(): Source {
    const bases = this.bases().map((path) => [path, this.textOf(path) ?? ''] as const);
    return { name: this.file, text: this.textOf(this.file) ?? '', texts: Object.fromEntries(bases) };
  }

  get isOriginal(): boolean {
    return [this.file, ...this.bases()].every((path) => this.textOf(path) === SCENARIOS.get(path));
  }

  /** The code of the own policy. */
  get code(): string {
    return this.editor.text(OWN) ?? '';
  }

  /** The text of a scenario that is shown; null while the own policy is shown. */
  get shown(): string | null {
    return this.editor.shown === OWN ? null : (this.editor.text(this.editor.shown) ?? '');
  }

  /** The name and the text of the scenario, or of its base while that is shown. */
  get scenario(): [name: string, text: string] {
    const name = this.editor.shown === OWN ? this.file : this.editor.shown;
    return [name, this.textOf(name) ?? ''];
  }

  /** Puts the text back that the program carries; this can be undone. */
  reset(): void {
    const { shown } = this.editor;
    const original = shown === OWN ? TEMPLATE : SCENARIOS.get(shown);
    if (original !== undefined) this.editor.replaceAll(shown, original);
  }

  change(change: { from: number; to: number; insert: string }, goesOn: boolean): void {
    this.editor.change(change, goesOn);
  }

  /** Marks the mistakes of the scenario and of its bases. */
  mark(problems: readonly Problem[]): void {
    this.problems = problems;
    for (const name of [this.file, ...this.bases()]) this.editor.mark(name, this.problemsOf(name));
  }

  /** Marks the line of the own policy that an error names; null takes the mark away. */
  markOwn(sentence: string | null): void {
    const line = /^Own policy, line (\d+):/.exec(sentence ?? '')?.[1];
    if (sentence !== null && line === undefined) return;
    if (sentence !== null && this.ownProblems[0]?.sentence === sentence) return;
    const nothing = { file: null, column: null, field: null, rule: null, found: null, hint: null };
    const problems = sentence === null ? [] : [{ ...nothing, line: Number(line), sentence }];
    this.ownProblems = problems;
    this.editor.mark(OWN, problems);
  }

  private problemsOf(name: string): Problem[] {
    if (name === OWN) return this.ownProblems;
    return this.problems.filter((problem) => this.nameOf(problem) === name);
  }

  /** The text that a problem is about. */
  private nameOf({ file }: Problem): string {
    return file ?? this.file;
  }

  goTo(problem: Problem): void {
    const name = this.nameOf(problem);
    if (name !== this.editor.shown) this.show(name);
    this.editor.goTo(problem);
  }

  /** The texts that are to be saved or shared. */
  session(): Pick<Session, 'file' | 'texts' | 'code'> {
    const names = [this.file, ...this.bases()].filter((path) => this.textOf(path) !== SCENARIOS.get(path));
    const texts = Object.fromEntries(names.map((path) => [path, this.textOf(path) ?? '']));
    return this.code === TEMPLATE ? { file: this.file, texts } : { file: this.file, texts, code: this.code };
  }

  /** Takes texts that were saved or shared. */
  restore({ file, texts, code }: Session): void {
    for (const [path, text] of Object.entries(texts)) {
      this.editor.add(path, SCENARIOS.get(path) ?? text);
      this.editor.replaceAll(path, text);
    }
    if (code !== undefined) this.editor.replaceAll(OWN, code);
    this.choose(file);
  }
}
