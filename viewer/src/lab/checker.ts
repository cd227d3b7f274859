/** Checks the scenario whenever its text changes, a moment after the last key. */

import type { Checked, Source } from './contract';
import type { Simulator } from './simulator';

/** So long it waits for a further key, in milliseconds. */
const PAUSE = 120;

export class Checker {
  private timer: ReturnType<typeof setTimeout> | undefined;
  private asked = 0;
  simulator: Simulator | null = null;

  constructor(
    private readonly source: () => Source,
    private readonly told: (checked: Checked, source: Source) => void,
    private readonly failed: (sentence: string) => void,
  ) {}

  /** The text has changed. */
  later(): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => {
      void this.now();
    }, PAUSE);
  }

  /** Checks at once. Only what the latest check says is told. */
  async now(): Promise<Checked | null> {
    clearTimeout(this.timer);
    if (!this.simulator) return null;
    const number = ++this.asked;
    const source = this.source();
    try {
      const checked = await this.simulator.call<Checked>('check', source);
      if (number === this.asked) this.told(checked, source);
      return checked;
    } catch (error) {
      if (number === this.asked) this.failed(error instanceof Error ? error.message : String(error));
      return null;
    }
  }
}
