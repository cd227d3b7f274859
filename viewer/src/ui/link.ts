/** The moment in the address: `#t=128&robot=4`. It works from disk too. */

/** What an address says of what is shown. */
export interface Link {
  /** Seconds of simulated time. */
  time: number | null;
  robot: number | null;
  /** The trials that are shown, of a page that lists its trials. */
  trials: string[];
}

const number = (text: string | undefined): number | null =>
  text !== undefined && /^\d+(\.\d+)?$/.test(text) ? Number(text) : null;

export function readLink(hash: string): Link {
  const pairs = hash.replace(/^#/, '').split('&');
  const parts = new Map(pairs.map((pair) => pair.split('=', 2) as [string, string | undefined]));
  const trials = (parts.get('trials') ?? '').split(',').filter((name) => name !== '');
  const robot = number(parts.get('robot'));
  return {
    time: parseTime(parts.get('t') ?? ''),
    robot: Number.isInteger(robot) ? robot : null,
    trials: trials.map(decoded),
  };
}

/** A text as it was before it was put into an address, or as it is if it was never meant for one. */
function decoded(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

export function linkTo({ time, robot, trials }: Link): string {
  const parts = trials.length > 0 ? [`trials=${trials.map(encodeURIComponent).join(',')}`] : [];
  if (time !== null) parts.push(`t=${Number(time.toFixed(1))}`);
  if (robot !== null) parts.push(`robot=${robot}`);
  return `#${parts.join('&')}`;
}

/** A time in seconds: `128`, `128.5` or `2:08`; null if it is none. */
export function parseTime(text: string): number | null {
  const parts = text.trim().split(':');
  const [seconds, minutes] = [number(parts.pop()), parts.pop() ?? '0'];
  if (seconds === null || parts.length > 0 || !/^\d+$/.test(minutes)) return null;
  return 60 * Number(minutes) + seconds;
}

/** Puts a link into the address, without a step in the browser's history. */
export function showLink(link: string): void {
  if (location.hash === link) return;
  try {
    history.replaceState(null, '', link);
  } catch {
    // A page in a frame without an address of its own, or too many changes: the next one is shown.
  }
}

/** Copies the address; where the browser refuses, shows it to be copied. */
export async function copyLink(): Promise<void> {
  try {
    await navigator.clipboard.writeText(location.href);
  } catch {
    window.prompt('Link to this moment', location.href);
  }
}
