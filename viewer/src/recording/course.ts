/** What became of one robot in a trial: when it stood, why and for whom, and what it had on board. */

/** A time in which a robot did not move on. */
export interface Delay {
  from: number;
  to: number;
  /** Seconds of it in which the robot stood: it may have moved for moments in between. */
  stood: number;
  cause: string;
  waitsFor: number | null;
}

/** A robot's state as far as its course has it. */
export type Doing = Pick<Delay, 'cause' | 'waitsFor'> & { load: number };

/** A robot that moves for less than this goes on with the delay before, in seconds. */
const BREAK = 1;

/** The cause of a delay of a robot that has none. */
const UNDER_WAY = 'under_way';

export class Course {
  readonly delays: Delay[] = [];
  /** From when on how many were on board. */
  readonly loads: { time: number; load: number }[] = [];
  private now: (Doing & { time: number }) | null = null;

  /** From this time on, the robot does this. */
  add(time: number, doing: Doing): void {
    this.end(time);
    this.now = { time, ...doing };
    if (this.loads.at(-1)?.load !== doing.load) this.loads.push({ time, load: doing.load });
  }

  /** The course ends at this time, as far as it is known. */
  end(time: number): void {
    if (!this.now || this.now.cause === UNDER_WAY) return;
    const { time: from, cause, waitsFor } = this.now;
    const last = this.delays.at(-1);
    const goesOn = last?.cause === cause && last.waitsFor === waitsFor && from - last.to < BREAK;
    if (last && goesOn) [last.to, last.stood] = [time, last.stood + time - from];
    else this.delays.push({ from, to: time, stood: time - from, cause, waitsFor });
    this.now.time = time;
  }
}

/** For each cause, the longest first: how long the robot stood, and for which robots how long. */
export function totals(
  delays: readonly Delay[],
): { cause: string; stood: number; robots: [robot: number, stood: number][] }[] {
  const causes = new Map<string, { stood: number; robots: Map<number, number> }>();
  for (const { cause, waitsFor, stood } of delays) {
    const total = causes.get(cause) ?? { stood: 0, robots: new Map<number, number>() };
    causes.set(cause, total);
    total.stood += stood;
    if (waitsFor !== null) total.robots.set(waitsFor, (total.robots.get(waitsFor) ?? 0) + stood);
  }
  const sorted = [...causes].sort(([, a], [, b]) => b.stood - a.stood);
  return sorted.map(([cause, { stood, robots }]) => ({
    cause,
    stood,
    robots: [...robots].sort(([, a], [, b]) => b - a),
  }));
}
