/** What a recording says of its scenario. */

import type { Recording } from '../recording/recording';
import { element } from './dom';

/** A panel with the description of the scenario, the program and the scenario's hash. */
export function about({ header, cut, isGrowing }: Recording): HTMLElement {
  const panel = element('section', { class: 'panel about' });
  panel.append(element('p', {}, header.scenario.description));
  if (cut !== null && !isGrowing) {
    panel.append(element('p', {}, 'The recording was cut short: this is what was whole of it.'));
  }
  panel.append(element('p', { class: 'hint' }, `${header.program}, scenario ${header.scenario.xxh3_128}`));
  return panel;
}
