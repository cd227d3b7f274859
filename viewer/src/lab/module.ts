/** The simulator as a WebAssembly module: the one place that knows how its memory is used. */

type Call =
  'check' | 'policies' | 'begin' | 'advance' | 'answer' | 'frame' | 'segment' | 'finish' | 'compare';

type Exports = Record<Call | 'room', (bytes: number) => number> & {
  memory: WebAssembly.Memory;
  reply: () => number;
};

/** A failure that the module tells of in a sentence. */
export class ModuleError extends Error {}

export class Module {
  private constructor(private readonly exports: Exports) {}

  /** A module of its own: what one trial does, no other sees. */
  static async make(module: WebAssembly.Module): Promise<Module> {
    const { exports } = await WebAssembly.instantiate(module, {});
    return new Module(exports as unknown as Exports);
  }

  /** Calls the module, and returns a copy of the bytes of its reply. */
  bytes(name: Call, argument = ''): Uint8Array<ArrayBuffer> {
    const { exports } = this;
    const given = new TextEncoder().encode(argument);
    const room = exports.room(given.length);
    new Uint8Array(exports.memory.buffer, room, given.length).set(given);
    const length = exports[name](given.length);
    // The memory may have grown, so that its buffer is another one.
    return new Uint8Array(exports.memory.buffer, exports.reply(), length).slice();
  }

  /** Calls the module, and returns its reply; throws the sentence of a failure. */
  json(name: Call, argument = ''): unknown {
    const text = new TextDecoder().decode(this.bytes(name, argument));
    const reply: unknown = JSON.parse(text === '' ? 'null' : text);
    const failed = reply as { error?: unknown } | null;
    if (typeof failed?.error === 'string') throw new ModuleError(failed.error);
    return reply;
  }
}
