/** What the reader has made, to be saved in the page or put into an address. */

/** Texts and choices. */
export interface Session {
  /** The path of the scenario. */
  file: string;
  /** Texts that differ from those that the page carries, by path. */
  texts: Record<string, string>;
  a: string;
  b: string;
  seeds: string;
  /** The code of the own policy. It is saved in pages, but never put into an address. */
  code?: string;
}

/** The longest address that is made, in characters. */
const LONGEST = 8 * 1024;

/** The most that an address may hold, unpacked, in bytes. */
const MOST = 1 << 20;

const MARK = '#lab=';

const isRecord = (value: unknown): value is Record<string, unknown> =>
  typeof value === 'object' && value !== null;

/** A value from elsewhere as a session; null if it is none. */
export function sessionOf(value: unknown): Session | null {
  if (!isRecord(value) || !isRecord(value.texts)) return null;
  const { file, a, b, seeds, code } = value;
  const texts = Object.entries(value.texts);
  if (![file, a, b, seeds, ...texts.map(([, text]) => text)].every((text) => typeof text === 'string'))
    return null;
  return {
    ...({ file, a, b, seeds } as Session),
    texts: Object.fromEntries(texts) as Record<string, string>,
    ...(typeof code === 'string' ? { code } : {}),
  };
}

/** Sends bytes through a stream; at most so many come out. */
async function through(
  bytes: Uint8Array<ArrayBuffer>,
  stream: CompressionStream | DecompressionStream,
  most: number,
): Promise<Uint8Array<ArrayBuffer>> {
  const reader = new Blob([bytes]).stream().pipeThrough(stream).getReader();
  const parts: Uint8Array<ArrayBuffer>[] = [];
  let length = 0;
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    length += part.value.length;
    if (length > most) throw new Error('The address holds too much.');
    parts.push(part.value);
  }
  return new Uint8Array(await new Blob(parts).arrayBuffer());
}

/** A session as the part of an address that begins with `#`; null if it is too long for one. */
export async function toHash({ file, texts, a, b, seeds }: Session): Promise<string | null> {
  const text = JSON.stringify({ file, texts, a, b, seeds });
  const packed = await through(
    new TextEncoder().encode(text),
    new CompressionStream('deflate-raw'),
    Infinity,
  );
  const coded = btoa(Array.from(packed, (byte) => String.fromCharCode(byte)).join(''));
  const hash = MARK + coded.replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
  return hash.length > LONGEST ? null : hash;
}

/** The session of an address; null if it has none. Code is never taken from an address. */
export async function fromHash(hash: string): Promise<Session | null> {
  if (!hash.startsWith(MARK)) return null;
  const bytes = atob(hash.slice(MARK.length).replaceAll('-', '+').replaceAll('_', '/'));
  const packed = Uint8Array.from({ length: bytes.length }, (_, i) => bytes.charCodeAt(i));
  const unpacked = await through(packed, new DecompressionStream('deflate-raw'), MOST);
  const session = sessionOf(JSON.parse(new TextDecoder().decode(unpacked)));
  if (session) delete session.code;
  return session;
}
