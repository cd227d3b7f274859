import { expect, test } from 'vitest';

import type { World } from '../src/recording/types';
import { inWords } from '../src/recording/words';

const worldOf = (words?: World['words']): World => ({ words }) as World;

test('texts are in the words of the scenario', () => {
  const words = { rescuee: 'item', rescuees: 'items', hp: 'condition', radiation: 'hazard' };
  expect(inWords(worldOf(words), '120 rescued, HP 9 %')).toBe('120 items, condition 9 %');
  const standard = { rescuee: 'rescuee', rescuees: 'rescuees', hp: 'hp', radiation: 'radiation' };
  for (const world of [worldOf(), worldOf(standard)])
    expect(inWords(world, '3 rescued, HP')).toBe('3 rescued, HP');
});
