/** What goes to the module and comes back from it, and what the page and its workers tell each other. */

/** A scenario as the module takes it. */
export interface Source {
  /** Its path, from the folder of scenarios. */
  name: string;
  text: string;
  /** The texts that it may name as a base, by path. */
  texts: Record<string, string>;
}

/** A mistake in a scenario. Lines and columns are from 1. */
export interface Problem {
  file: string | null;
  line: number | null;
  column: number | null;
  field: string | null;
  rule: string | null;
  found: string | null;
  hint: string | null;
  sentence: string;
}

/** What a scenario is, where it has no mistakes. */
export interface ScenarioFacts {
  name: string;
  description: string;
  duration_s: number;
  robots: number;
  tasks: string[];
}

export interface Checked {
  problems: Problem[];
  warnings: string[];
  scenario: ScenarioFacts | null;
}

export interface PolicyFacts {
  name: string;
  about: string;
  /** The options that it takes, with their defaults. */
  options?: string;
}

/** A trial to run. */
export interface TrialSpec extends Source {
  policy: string;
  seed: string;
}

/** The record of a trial, as far as the page reads it. */
export interface TrialRecord {
  scenario: string;
  policy: string;
  seed: number | string;
  rescuees: number;
  status: unknown;
  time_s: number;
  tasks: { task: string; rescued: number; energy: number }[];
  ungrouped_energy: number;
  state_hash: string;
}

/** Two policies over pairs of trials. */
export interface CompareQuestion {
  a: string;
  b: string;
  pairs: [a: number, b: number, hashA: string, hashB: string][];
  metric: string;
}

export interface Compared {
  n: number;
  mean_a: number;
  mean_b: number;
  difference: number;
  interval: [low: number, high: number] | null;
  p: number | null;
  in_words: string;
}

/** How a trial goes on. */
export type Advanced =
  | { state: 'running'; time_s: number }
  | { state: 'asks'; question: unknown }
  | { state: 'over'; status: unknown; time_s: number };

/** What a worker is asked: the module first, then calls and trials. */
export type Request =
  | { id: number; kind: 'start'; module: WebAssembly.Module | ArrayBuffer }
  | { id: number; kind: 'call'; name: 'check' | 'policies' | 'compare'; argument: unknown }
  | { id: number; kind: 'trial'; spec: TrialSpec };

/** What a worker tells: parts on the way, then the result or a sentence of what went wrong. */
export type Answer =
  | { id: number; kind: 'progress'; time_s: number; duration_s: number; bytes: Uint8Array<ArrayBuffer> }
  | { id: number; kind: 'done'; value: unknown }
  | { id: number; kind: 'failed'; sentence: string };

/** The policy that the page's own function decides. */
export const MINE = 'MINE';

/** The name of a policy, without its options. */
export const policyName = (policy: string): string => policy.split('(', 1)[0].trim();
