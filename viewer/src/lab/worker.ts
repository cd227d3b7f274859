/** The script of the workers: runs trials and answers calls. The own policy stands before it. */

import type { Advanced, Answer, Request, TrialSpec } from './contract';
import { Module } from './module';
import { lineOf } from './policyErrors';

/** The function of the page's own policy, where it stands before this script. */
declare const decide: ((question: unknown) => unknown) | undefined;

/** How long the module may run before the page hears of it, in milliseconds. */
const [SHORT, LONG] = [20, 80];

let module: WebAssembly.Module | null = null;
/** The module for calls; trials have their own. */
let shared: Module | null = null;

const tell = (answer: Answer, transfer: Transferable[] = []): void =>
  (self as unknown as Worker).postMessage(answer, transfer);

async function fresh(): Promise<Module> {
  if (!module) throw new Error('The simulator was not loaded.');
  return Module.make(module);
}

const channel = new MessageChannel();

/** Lets the browser end this worker, if it is to end. */
const pause = (): Promise<void> =>
  new Promise((resolve) => {
    channel.port1.onmessage = () => resolve();
    channel.port2.postMessage(null);
  });

/** What the page's own policy says to a question, as the module takes it. */
function decided(question: unknown): string {
  if (typeof decide !== 'function') throw new Error('There is no function "decide" in the tab "Own policy".');
  let decision: unknown;
  try {
    decision = decide(question);
  } catch (error) {
    const line = lineOf(error);
    const told = error instanceof Error ? `${error.name}: ${error.message}` : String(error);
    throw new Error(`Own policy${line === null ? '' : `, line ${line}`}: ${told}`);
  }
  const text = JSON.stringify(decision) as string | undefined;
  if (text === undefined) throw new Error('Own policy: "decide" returned nothing. It returns the groups.');
  return text;
}

/** Runs a trial to its end; tells the time and the new bytes of the recording on the way. */
async function trial(id: number, spec: TrialSpec): Promise<unknown> {
  const simulator = await fresh();
  const begun = simulator.json('begin', JSON.stringify({ ...spec, record: true, check: false }));
  const { duration_s } = begun as { duration_s: number };
  const progress = (time_s: number): void => {
    const bytes = simulator.bytes('segment');
    tell({ id, kind: 'progress', time_s, duration_s, bytes }, [bytes.buffer]);
  };
  let steps = 200;
  for (;;) {
    const begin = performance.now();
    const advanced = simulator.json('advance', String(steps)) as Advanced;
    const took = performance.now() - begin;
    if (advanced.state === 'asks') {
      simulator.json('answer', decided(advanced.question));
      continue;
    }
    progress(advanced.time_s);
    if (advanced.state === 'over') break;
    await pause();
    if (took < SHORT) steps *= 2;
    else if (took > LONG) steps = Math.max(1, steps >> 1);
  }
  const record = simulator.json('finish');
  progress(duration_s);
  return record;
}

async function answer(request: Request): Promise<unknown> {
  if (request.kind === 'start') {
    const given = request.module;
    module = given instanceof WebAssembly.Module ? given : await WebAssembly.compile(given);
    return null;
  }
  if (request.kind === 'trial') return trial(request.id, request.spec);
  shared ??= await fresh();
  try {
    const argument = request.argument === undefined ? '' : JSON.stringify(request.argument);
    return shared.json(request.name, argument);
  } catch (error) {
    if (error instanceof WebAssembly.RuntimeError) shared = null; // what it left behind is not to be trusted
    throw error;
  }
}

/** What went wrong, as a sentence. */
function sentence(error: unknown): string {
  if (error instanceof WebAssembly.RuntimeError) return `The simulator stopped: ${error.message}.`;
  return error instanceof Error ? error.message : String(error);
}

self.onmessage = ({ data }: MessageEvent<Request>): void => {
  const { id } = data;
  answer(data).then(
    (value) => tell({ id, kind: 'done', value }),
    (error: unknown) => tell({ id, kind: 'failed', sentence: sentence(error) }),
  );
};
