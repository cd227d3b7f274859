/** The list of mistakes below the editor. */

import { element } from '../ui/dom';
import type { Checked, Problem, ScenarioFacts } from './contract';
import { fileName } from './commands';

/** What a scenario without mistakes is. */
function facts({ robots, tasks, duration_s }: ScenarioFacts): string {
  const some = tasks.length === 1 ? `the task ${tasks[0]}` : `${tasks.length} tasks (${tasks.join(', ')})`;
  const work = tasks.length === 0 ? 'no tasks' : some;
  const time = `${duration_s} s a trial`;
  return `The scenario has no mistakes: ${robots} robots, ${work}, ${time}.`;
}

export class Problems {
  readonly root = element('section', { class: 'problems', 'aria-label': 'Mistakes' });
  private readonly summary = element('p', { class: 'summary', role: 'status' }, 'The simulator is loading.');
  private readonly list = element('ul');

  constructor(private readonly goTo: (problem: Problem) => void) {
    this.root.append(this.summary, this.list);
  }

  /** Says something in place of the result of a check. */
  say(sentence: string): void {
    this.summary.textContent = sentence;
    this.root.classList.remove('bad');
    this.list.replaceChildren();
  }

  show({ problems, warnings, scenario }: Checked): void {
    const isOne = problems.length === 1;
    const count = isOne ? '1 mistake. Click it' : `${problems.length} mistakes. Click one`;
    const fine = scenario ? facts(scenario) : 'The scenario has no mistakes.';
    this.root.classList.toggle('bad', problems.length > 0);
    this.summary.textContent = problems.length > 0 ? `${count} to go to its line.` : fine;
    const rows = problems.map((problem) => element('li', {}, this.button(problem)));
    const more = warnings.map((warning) => element('li', { class: 'warning' }, `Warning: ${warning}`));
    this.list.replaceChildren(...rows, ...more);
  }

  private button(problem: Problem): HTMLElement {
    const file = problem.file === null ? '' : `${fileName(problem.file)}, `;
    const place = problem.line === null ? file : `${file}line ${problem.line}`;
    const hint = problem.hint && !problem.sentence.includes(problem.hint) ? ` ${problem.hint}` : '';
    const button = element('button', { type: 'button', class: 'problem' });
    if (place !== '') button.append(element('b', {}, place.replace(/, $/, '')), ' ');
    button.append(problem.sentence + hint);
    button.addEventListener('click', () => this.goTo(problem));
    return button;
  }
}
