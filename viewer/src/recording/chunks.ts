/** The container: a magic number, then chunks, each compressed and with checksums of its own. */

const MAGIC = [0x55, 0x53, 0x52, 0x45, 0x43, 0x0d, 0x0a, 0x1a];
const HEAD = 20;
const MAX_INFLATED = 1 << 30;

export type Kind = 'HEAD' | 'EVNT' | 'DECI' | 'SEGM' | 'DONE';

export interface Chunk {
  kind: Kind;
  number: number;
  at: number;
  stored: Uint8Array;
  inflated: number;
}

/** A file that cannot be read as a recording. */
export class ReadError extends Error {}

const table = Uint32Array.from({ length: 256 }, (_, byte) => {
  let sum = byte;
  for (let bit = 0; bit < 8; bit++) sum = sum & 1 ? 0xedb88320 ^ (sum >>> 1) : sum >>> 1;
  return sum >>> 0;
});

/** CRC-32 of bytes. */
export function crc32(bytes: Uint8Array): number {
  let sum = 0xffffffff;
  for (const byte of bytes) sum = table[(sum ^ byte) & 0xff] ^ (sum >>> 8);
  return (sum ^ 0xffffffff) >>> 0;
}

const KINDS: readonly string[] = ['HEAD', 'EVNT', 'DECI', 'SEGM', 'DONE'];

/** The whole chunks of a file, and how many bytes after them belong to none. */
export function chunksOf(bytes: Uint8Array): { chunks: Chunk[]; rest: number } {
  if (bytes.length < MAGIC.length || MAGIC.some((byte, i) => bytes[i] !== byte)) {
    throw new ReadError('This is not a recording: its first bytes are not "USREC".');
  }
  return chunksFrom(bytes, MAGIC.length, 0);
}

/** The whole chunks from a byte on, numbered from `first`, and how many bytes after them belong to none. */
export function chunksFrom(
  bytes: Uint8Array,
  from: number,
  first: number,
): { chunks: Chunk[]; rest: number } {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const chunks: Chunk[] = [];
  let at = from;
  while (at + HEAD <= bytes.length) {
    const kind = String.fromCharCode(...bytes.subarray(at, at + 4));
    const damaged = (reason: string): never => {
      throw new ReadError(
        `The recording is damaged: chunk ${first + chunks.length}, at byte ${at}: ${reason}.`,
      );
    };
    if (crc32(bytes.subarray(at, at + 16)) !== view.getUint32(at + 16, true)) {
      damaged('its head does not have its checksum');
    }
    if (!KINDS.includes(kind)) damaged('its kind is not known');
    const begin = at + HEAD;
    const end = begin + view.getUint32(at + 4, true);
    const inflated = view.getUint32(at + 8, true);
    if (inflated > MAX_INFLATED) damaged('it is too large');
    if (end > bytes.length) break;
    const stored = bytes.subarray(begin, end);
    if (crc32(stored) !== view.getUint32(at + 12, true)) damaged('its content does not have its checksum');
    chunks.push({ kind: kind as Kind, number: first + chunks.length, at, stored, inflated });
    at = end;
  }
  return { chunks, rest: bytes.length - at };
}

/** The content of a chunk. */
export async function inflate(chunk: Chunk): Promise<Uint8Array> {
  const content = new Uint8Array(chunk.inflated);
  let length = 0;
  try {
    const stored = new Blob([chunk.stored as Uint8Array<ArrayBuffer>]).stream();
    const reader = stored.pipeThrough(new DecompressionStream('deflate-raw')).getReader();
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
      content.set(part.value, length);
      length += part.value.length;
    }
  } catch {
    length = -1;
  }
  if (length !== chunk.inflated) {
    throw new ReadError(`The recording is damaged: chunk ${chunk.number} cannot be inflated.`);
  }
  return content;
}

/** The content of a chunk of text. */
export async function inflateJson<T>(chunk: Chunk): Promise<T> {
  return JSON.parse(new TextDecoder().decode(await inflate(chunk))) as T;
}
