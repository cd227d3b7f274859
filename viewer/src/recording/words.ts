/** What a scenario calls its things: a warehouse has items and no rescuees. */

import type { World } from './types';

/** A text in the words of a world: `120 rescued` is `120 items`. */
export function inWords({ words }: World, text: string): string {
  if (!words) return text;
  const own: Record<string, string> = { ...words, rescued: words.rescuees, HP: words.hp };
  if (words.rescuees === 'rescuees') own.rescued = 'rescued';
  if (words.hp === 'hp') own.HP = 'HP';
  return text.replace(/[A-Za-z]+/g, (word) => own[word] ?? word);
}
