/** The keys, and what the signs mean. */

import { button, element } from './dom';

const KEYS: [string, string][] = [
  ['space', 'play, pause'],
  ['← →', 'one second back, on; with shift ten'],
  ['+ −', 'faster, slower'],
  ['g', 'go to a time: a field asks for it'],
  ['c', 'copy a link to this moment and robot'],
  ['f', 'follow the selected robot, or show the whole arena'],
  ['[ ]', 'the round before, the next round'],
  ['r', 'routes on, off'],
  ['w', 'links from waiting robots and conflict sets on, off'],
  ['m', 'messages of the last second on, off: lines that fade; lost ones are dashed and end halfway'],
  ['Escape', 'show the whole team'],
  ['?', 'this help'],
];

const SIGNS: [string, string][] = [
  ['●  ■  ▲', 'robots: the shape is the role, the colour the group; triangles fly'],
  ['▂', 'below a robot, where there is room: energy, then HP; dots above it: rescuees on board'],
  ['→', 'a robot waits for another; rings are conflict sets, whole around the one with the right of way'],
  ['•', 'rescuees: dots wait, ringed ones are claimed, empty ones are on board, faint ones are delivered'],
  ['◌', 'debris and radiation that the chosen group does not know are dashed'],
  ['⊙', 'debris with a dot can be pushed'],
];

function table(rows: [string, string][]): HTMLElement {
  const made = element('table', { class: 'facts' });
  for (const [sign, text] of rows)
    made.append(element('tr', {}, element('th', {}, sign), element('td', {}, text)));
  return made;
}

export class Help {
  readonly root = element('dialog', { class: 'help', 'aria-label': 'Help' });

  /** Help of a viewer; links are only for one that has a page of its own. */
  constructor(hasLinks: boolean) {
    const keys = KEYS.filter(([key]) => hasLinks || key !== 'c');
    const close = button('Close', 'Close the help', () => this.root.close());
    this.root.append(element('h2', {}, 'Keys'), table(keys), element('h2', {}, 'Signs'), table(SIGNS), close);
    const touch = 'Drag to move the arena, pinch or turn the wheel to zoom, click twice to show all of it.';
    this.root.insertBefore(element('p', { class: 'hint' }, touch), close);
    this.root.addEventListener('click', (event) => {
      if (event.target === this.root) this.root.close();
    });
  }

  toggle(): void {
    if (this.root.open) this.root.close();
    else this.root.showModal();
  }
}
