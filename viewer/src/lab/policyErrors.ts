/** Where an error of the page's own policy happened. */

/** The line of the function's text at which an error was thrown, as far as its stack says so. */
export function lineOf(error: unknown): number | null {
  const stack = error instanceof Error ? error.stack : undefined;
  const line = /:(\d+):\d+\)?\s*$/m.exec(stack ?? '')?.[1];
  return line === undefined ? null : Number(line);
}
