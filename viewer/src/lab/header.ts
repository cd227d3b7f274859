/** The head of the page: which scenario, and what can be saved. */

import { button, element } from '../ui/dom';
import { SCENARIOS } from './scenarios';

/** What the buttons do. */
interface Actions {
  choose: (path: string) => void;
  saveScenario: () => void;
  saveTable: () => void;
  savePage: () => void;
  copyLink: () => void;
}

/** Scenarios to choose from, those of the gallery apart. */
function options(): HTMLElement[] {
  const paths = [...SCENARIOS.keys()].sort();
  const group = (label: string, of: string[]): HTMLElement => {
    const made = of.map((path) => element('option', { value: path }, path.replace(/^gallery\//, '')));
    return element('optgroup', { label }, ...made);
  };
  return [
    group(
      'scenarios',
      paths.filter((path) => !path.includes('/')),
    ),
    group(
      'gallery',
      paths.filter((path) => path.includes('/')),
    ),
  ];
}

export class Header {
  readonly root = element('header', { class: 'head' });
  private readonly select = element('select', { 'aria-label': 'Scenario' }, ...options());
  private readonly status = element('span', { class: 'hint said', role: 'status' });

  constructor(actions: Actions) {
    this.select.addEventListener('change', () => actions.choose(this.select.value));
    const saves = element('div', { class: 'saves', role: 'group', 'aria-label': 'Save' });
    saves.append(
      element('span', { class: 'hint' }, 'Save'),
      button('Scenario', 'Save the scenario as a file (.ron)', actions.saveScenario),
      button('Table', 'Save the table as a file (.csv)', actions.saveTable),
      button('Page', 'Save this page with the present texts in it', actions.savePage),
      button('Copy a link', 'Copy a link to this scenario and these policies', actions.copyLink),
    );
    const chooser = element('label', { class: 'chooser' }, 'Scenario', this.select);
    this.root.append(element('h1', {}, 'usar lab'), chooser, this.status, saves);
  }

  /** Shows which scenario is edited. */
  showFile(path: string): void {
    if (![...this.select.options].some(({ value }) => value === path)) {
      this.select.prepend(element('option', { value: path }, path));
    }
    this.select.value = path;
  }

  say(sentence: string): void {
    this.status.textContent = sentence;
  }
}
