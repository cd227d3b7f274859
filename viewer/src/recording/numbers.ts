/** Whole numbers as few bytes: seven bits a byte, the sign in the lowest bit (LEB128, zigzag). */

/** Bytes that are not the numbers that they should be. */
export class NotNumbers extends Error {}

/** Reads numbers from bytes, one after the other. */
export class Numbers {
  private at = 0;

  constructor(private readonly bytes: Uint8Array) {}

  /** Bytes that are left. */
  get left(): number {
    return this.bytes.length - this.at;
  }

  unsigned(): number {
    let value = 0;
    let factor = 1;
    for (;;) {
      if (this.at >= this.bytes.length || factor > 2 ** 49) throw new NotNumbers('numbers end too early');
      const byte = this.bytes[this.at++];
      value += (byte & 0x7f) * factor;
      if (byte < 0x80) return value;
      factor *= 128;
    }
  }

  signed(): number {
    const value = this.unsigned();
    return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
  }

  /** A number of things, each of which takes at least one byte of what is left. */
  count(): number {
    const count = this.unsigned();
    if (count > this.left) throw new NotNumbers('a number of things is too large');
    return count;
  }
}
