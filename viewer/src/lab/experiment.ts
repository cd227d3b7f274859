/** An experiment: two policies over pairs of trials with the same seeds, run by workers. */

import { MINE, type Source, type TrialRecord, policyName } from './contract';
import type { Helper } from './helper';
import type { Simulator } from './simulator';

export type TrialState =
  | { kind: 'waiting' | 'cancelled' }
  | { kind: 'running'; part: number }
  | { kind: 'done'; record: TrialRecord }
  | { kind: 'failed'; sentence: string };

/** A trial, with the bytes of its recording as far as it has come. */
export interface Trial {
  policy: string;
  seed: string;
  state: TrialState;
  parts: Uint8Array<ArrayBuffer>[];
}

/** Two trials with the same seed. */
export interface Pair {
  seed: string;
  a: Trial;
  b: Trial;
}

/** What an experiment is about. */
export interface Plan {
  source: Source;
  /** Whether all texts are those that the program carries. */
  isOriginal: boolean;
  /** The tasks of the scenario. */
  tasks: string[];
  a: string;
  b: string;
  seeds: string[];
  /** The code of the own policy. */
  code: string;
}

/** At most so many workers run at a time. */
const MOST_WORKERS = 8;

const workersFor = (trials: number): number =>
  Math.min(MOST_WORKERS, Math.max(navigator.hardwareConcurrency - 1, 1), trials);

/** A worker for each kind of policy: an own one that cannot even be read must not stop the others. */
class Lane {
  private readonly helpers = new Map<string, Helper>();

  constructor(
    private readonly simulator: Simulator,
    private readonly code: string,
  ) {}

  helper(policy: string): Helper {
    const code = policyName(policy) === MINE ? this.code : '';
    let helper = this.helpers.get(code);
    if (!helper || helper.isBroken) {
      helper = this.simulator.worker(code);
      this.helpers.set(code, helper);
    }
    return helper;
  }

  end(): void {
    for (const helper of this.helpers.values()) helper.end();
  }
}

export class Experiment {
  readonly pairs: Pair[];
  private lanes: Lane[] = [];
  private isCancelled = false;

  constructor(
    readonly plan: Plan,
    /** Called whenever a trial of a pair has come on. */
    private readonly changed: (pair: Pair) => void,
  ) {
    const trial = (policy: string, seed: string): Trial => {
      return { policy, seed, state: { kind: 'waiting' }, parts: [] };
    };
    this.pairs = plan.seeds.map((seed) => ({ seed, a: trial(plan.a, seed), b: trial(plan.b, seed) }));
  }

  get trials(): Trial[] {
    return this.pairs.flatMap(({ a, b }) => [a, b]);
  }

  /** Trials that are over, however they ended. */
  get over(): number {
    return this.trials.filter(({ state }) => state.kind === 'done' || state.kind === 'failed').length;
  }

  /** Runs all trials; ends when the last is over, or when they are cancelled. */
  async run(simulator: Simulator): Promise<void> {
    const jobs = this.pairs.flatMap((pair) => [
      { pair, trial: pair.a },
      { pair, trial: pair.b },
    ]);
    const work = async (lane: Lane): Promise<void> => {
      for (let job = jobs.shift(); job && !this.isCancelled; job = jobs.shift()) {
        await this.runTrial(lane, job.pair, job.trial);
      }
    };
    this.lanes = Array.from({ length: workersFor(jobs.length) }, () => new Lane(simulator, this.plan.code));
    await Promise.all(this.lanes.map(work));
    this.endLanes();
  }

  private async runTrial(lane: Lane, pair: Pair, trial: Trial): Promise<void> {
    const { source } = this.plan;
    const { policy, seed } = trial;
    trial.state = { kind: 'running', part: 0 };
    this.changed(pair);
    try {
      const spec = { ...source, policy, seed };
      const record = await lane
        .helper(policy)
        .ask<TrialRecord>({ kind: 'trial', spec }, ({ time_s, duration_s, bytes }) => {
          trial.state = { kind: 'running', part: time_s / duration_s };
          if (bytes.length > 0) trial.parts.push(bytes);
          this.changed(pair);
        });
      trial.state = { kind: 'done', record };
    } catch (error) {
      const sentence = error instanceof Error ? error.message : String(error);
      trial.state = this.isCancelled ? { kind: 'cancelled' } : { kind: 'failed', sentence };
    }
    this.changed(pair);
  }

  private endLanes(): void {
    for (const lane of this.lanes) lane.end();
    this.lanes = [];
  }

  /** Stops all trials, and frees their workers. */
  cancel(): void {
    this.isCancelled = true;
    for (const pair of this.pairs) {
      for (const trial of [pair.a, pair.b]) {
        if (trial.state.kind !== 'waiting') continue;
        trial.state = { kind: 'cancelled' };
        this.changed(pair);
      }
    }
    this.endLanes();
  }

  get wasCancelled(): boolean {
    return this.isCancelled;
  }
}

/** The recording of a trial, as far as it has come. */
export function recordingOf({ parts }: Trial): Uint8Array<ArrayBuffer> {
  const bytes = new Uint8Array(parts.reduce((sum, { length }) => sum + length, 0));
  let at = 0;
  for (const part of parts) {
    bytes.set(part, at);
    at += part.length;
  }
  return bytes;
}

/** The energy that all robots of a trial used. */
export const energyOf = ({ tasks, ungrouped_energy }: TrialRecord): number =>
  tasks.reduce((sum, { energy }) => sum + energy, ungrouped_energy);
