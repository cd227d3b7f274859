/** Chips that choose whose knowledge is shown. */

import { groupColour } from '../draw/theme';
import type { TaskPlace } from '../recording/types';
import { button, element, swatch } from './dom';

/** A chip for the world, for each group, and for the robots at home; `shown` is the one that is pressed. */
export function viewpointChips(
  tasks: readonly TaskPlace[],
  shown: number | null,
  choose: (viewpoint: number | null) => void,
): HTMLElement[] {
  const of = (text: string, viewpoint: number | null, colour: string | null): HTMLElement => {
    const title = viewpoint === null ? 'Show the world as it is' : `Show what is known to ${text}`;
    const act = (): void => choose(viewpoint);
    const chip = button('', title, act, 'chip');
    if (colour) chip.append(swatch(colour));
    chip.append(element('span', {}, text));
    chip.setAttribute('aria-pressed', String(shown === viewpoint));
    return chip;
  };
  const groups = tasks.map((task, number) => of(task.name, number, groupColour(number)));
  const home = tasks.length > 0 ? [of('home', tasks.length, groupColour(null))] : [];
  return [of('the world', null, null), ...groups, ...home];
}
