/** The scenarios that the program carries, and paths between them. */

import { baseOf } from './ron';

const found = import.meta.glob<string>(
  ['../../../scenarios/*.ron', '../../../scenarios/gallery/*.ron', '!**/*.sweep.ron'],
  { query: '?raw', import: 'default', eager: true },
);

/** Texts by their paths from the folder of scenarios. */
export const SCENARIOS: ReadonlyMap<string, string> = new Map(
  Object.entries(found).map(([path, text]) => [path.replace(/^.*\/scenarios\//, ''), text]),
);

/** The scenario that the page begins with. */
export const FIRST = 'paper.ron';

/** A path that a file names, from the folder of scenarios. */
export function resolved(file: string, path: string): string {
  const parts = file.split('/').slice(0, -1);
  for (const part of path.split('/')) {
    if (part === '..' && parts.length > 0 && parts.at(-1) !== '..') parts.pop();
    else if (part !== '.' && part !== '') parts.push(part);
  }
  return parts.join('/');
}

/** The files over which a file says what differs, the nearest first. */
export function basesOf(file: string, textOf: (path: string) => string | undefined): string[] {
  const bases: string[] = [];
  let [at, text] = [file, textOf(file)];
  while (text !== undefined) {
    const base = baseOf(text);
    if (base === null) break;
    at = resolved(at, base);
    text = textOf(at);
    if (text === undefined || at === file || bases.includes(at)) break;
    bases.push(at);
  }
  return bases;
}
