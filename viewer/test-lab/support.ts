/** The module of the page and the command, side by side. */

import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { Module } from '../src/lab/module';

export const root = new URL('../../', import.meta.url).pathname;
const usar = process.env.USAR ?? join(root, 'target/release/usar');
const wasm = process.env.LAB_WASM ?? join(root, 'target/lab/usar_lab.wasm');

export const compiled = new WebAssembly.Module(readFileSync(wasm));
export const text = (path: string): string => readFileSync(join(root, path), 'utf8');

/** What the command prints. */
export function command(...args: string[]): string {
  return execFileSync(usar, args, { cwd: root, encoding: 'utf8', maxBuffer: 1 << 28 });
}

/** Calls a function with a folder that is gone afterwards. */
export function withFolder<T>(use: (folder: string) => T): T {
  const folder = mkdtempSync(join(tmpdir(), 'usar-lab-'));
  try {
    return use(folder);
  } finally {
    rmSync(folder, { recursive: true });
  }
}

/** A trial in the module. */
export interface Asked {
  path: string;
  policy: string;
  seed?: string;
  record?: boolean;
  check?: boolean;
  /** Steps of each advance. */
  slice?: number;
}

export interface Ran {
  /** The record as a line of JSON, or the sentence of the failure. */
  line: string;
  recording: Uint8Array;
}

interface Progress {
  state: 'running' | 'asks' | 'over';
}

/** Runs a scenario of the project to its end. */
export function run(module: Module, asked: Asked): Ran {
  const { path, policy, seed = '1', record = false, check = false, slice = 1000 } = asked;
  const [folder, name] = [path.replace(/[^/]*$/, ''), path.replace(/.*\//, '')];
  const own = text(path);
  const base = /base:\s*"([^"]+)"/.exec(own)?.[1];
  const texts = base ? { [base.replace('../', '')]: text(folder + base) } : {};
  module.json(
    'begin',
    JSON.stringify({
      name: base?.startsWith('../') ? `sub/${name}` : name,
      text: own,
      texts,
      policy,
      seed,
      record,
      check,
    }),
  );
  const parts: Uint8Array[] = [];
  let progress: Progress;
  do {
    progress = module.json('advance', String(slice)) as Progress;
    parts.push(module.bytes('segment'));
  } while (progress.state === 'running');
  const line = new TextDecoder().decode(module.bytes('finish'));
  parts.push(module.bytes('segment'));
  return { line, recording: Buffer.concat(parts) };
}

/** The state hash of a record. */
export const hashOf = (line: string): string => (JSON.parse(line) as { state_hash: string }).state_hash;
