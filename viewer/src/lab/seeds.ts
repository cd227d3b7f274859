/** Seeds as they are written: `1..20`, `1,2,5`, or both: `1..3, 7`. */

/** So many pairs may be asked for at once: the page keeps all recordings in memory. */
export const MOST_PAIRS = 500;

/** Seeds are whole numbers of 64 bits; they stay texts, for JavaScript's numbers have 53. */
const LARGEST = 2n ** 64n - 1n;

/** The seeds of a text, each once; or a sentence of what is wrong with it. */
export function parseSeeds(text: string): { seeds: string[] } | { error: string } {
  const seeds = new Set<string>();
  for (const part of text.split(/[,\s]+/)) {
    if (part === '') continue;
    const range = /^(\d+)(?:\.\.=?(\d+))?$/.exec(part) as (string | undefined)[] | null;
    if (!range) return { error: `"${part}" is not a seed. Write 1..20 or 1,2,5.` };
    const [first, last] = [BigInt(range[1]!), BigInt(range[2] ?? range[1]!)];
    if (last > LARGEST) return { error: `The seed ${last} is too large.` };
    if (last < first) return { error: `The seeds ${part} run backwards.` };
    if (last - first >= BigInt(MOST_PAIRS)) return { error: tooMany };
    for (let seed = first; seed <= last; seed++) seeds.add(String(seed));
    if (seeds.size > MOST_PAIRS) return { error: tooMany };
  }
  return seeds.size === 0 ? { error: 'Give at least one seed, for example 1..20.' } : { seeds: [...seeds] };
}

const tooMany = `This page runs at most ${MOST_PAIRS} seeds at once. The command line has no such limit.`;
