/** The simulator that the page carries: unpacked, compiled once, and handed to workers. */

import { Helper } from './helper';

/** The bytes of the module: base 64 of gzip. */
async function unpacked(): Promise<ArrayBuffer> {
  const block = document.getElementById('wasm')?.textContent ?? '';
  const text = atob(block.trim());
  const packed = Uint8Array.from({ length: text.length }, (_, i) => text.charCodeAt(i));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}

/** Whether a compiled module can be copied to a worker in this browser. */
function canPost(module: WebAssembly.Module): boolean {
  const { port1, port2 } = new MessageChannel();
  try {
    port1.postMessage(module);
    return true;
  } catch {
    return false;
  } finally {
    port1.close();
    port2.close();
  }
}

export class Simulator {
  private helper: Helper;

  private constructor(private readonly module: WebAssembly.Module | ArrayBuffer) {
    this.helper = new Helper(module);
  }

  static async load(): Promise<Simulator> {
    const bytes = await unpacked();
    const module = await WebAssembly.compile(bytes);
    return new Simulator(canPost(module) ? module : bytes);
  }

  /** A new worker, with the code of the page's own policy if it is to run that. */
  worker(code = ''): Helper {
    return new Helper(this.module, code);
  }

  /** Calls a function of the module. */
  call<T>(name: 'check' | 'policies' | 'compare', argument?: unknown): Promise<T> {
    if (this.helper.isBroken) this.helper = new Helper(this.module);
    return this.helper.ask<T>({ kind: 'call', name, argument });
  }
}
