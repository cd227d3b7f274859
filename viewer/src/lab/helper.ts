/** A worker with the simulator, as the page sees it. */

import workerText from 'virtual:lab-worker';
import type { Answer, Request } from './contract';

/** What a trial tells on its way. */
export type Progress = Extract<Answer, { kind: 'progress' }>;

/** A request without its number. */
type Asked = Request extends infer R ? (R extends Request ? Omit<R, 'id'> : never) : never;

interface Waiting {
  resolve: (value: unknown) => void;
  reject: (error: Error) => void;
  progress?: (progress: Progress) => void;
}

/** Workers that are at work, for tests. */
export const running = { workers: 0 };

export class Helper {
  private readonly worker: Worker;
  private readonly waiting = new Map<number, Waiting>();
  private last = 0;
  /** Why it can answer nothing any more. */
  private broken: Error | null = null;

  /** Starts a worker. The code of the page's own policy stands before the script, so that lines agree. */
  constructor(module: WebAssembly.Module | ArrayBuffer, code = '') {
    const url = URL.createObjectURL(new Blob([`${code}\n`, workerText], { type: 'text/javascript' }));
    this.worker = new Worker(url);
    running.workers += 1;
    this.worker.onmessage = ({ data }: MessageEvent<Answer>) => {
      URL.revokeObjectURL(url);
      this.hear(data);
    };
    this.worker.onerror = (event) => {
      event.preventDefault();
      const line = event.lineno && event.lineno <= code.split('\n').length ? `, line ${event.lineno}` : '';
      const what = event.message ? event.message.replace(/^Uncaught /, '') : 'a worker could not start.';
      this.end(new Error(code === '' ? what : `Own policy${line}: ${what}`));
    };
    this.worker.onmessageerror = () =>
      this.end(new Error('The browser cannot hand the simulator to a worker.'));
    this.start(module);
  }

  private start(module: WebAssembly.Module | ArrayBuffer): void {
    // A failure of the start is told by each request that follows.
    this.ask({ kind: 'start', module }).catch((error: unknown) =>
      this.end(error instanceof Error ? error : new Error(String(error))),
    );
  }

  private hear(answer: Answer): void {
    const waiting = this.waiting.get(answer.id);
    if (!waiting) return;
    if (answer.kind === 'progress') {
      waiting.progress?.(answer);
      return;
    }
    this.waiting.delete(answer.id);
    if (answer.kind === 'done') waiting.resolve(answer.value);
    else waiting.reject(new Error(answer.sentence));
  }

  /** Asks the worker; the promise fails with a sentence. */
  ask<T>(asked: Asked, progress?: (progress: Progress) => void): Promise<T> {
    if (this.broken) return Promise.reject(this.broken);
    const id = ++this.last;
    return new Promise<T>((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as (value: unknown) => void, reject, progress });
      this.worker.postMessage({ ...asked, id });
    });
  }

  get isBroken(): boolean {
    return this.broken !== null;
  }

  /** Terminates the worker; what was asked of it fails. */
  end(error = new Error('Cancelled.')): void {
    if (this.broken) return;
    this.broken = error;
    this.worker.terminate();
    running.workers -= 1;
    for (const { reject } of this.waiting.values()) reject(error);
    this.waiting.clear();
  }
}
