/** The time that all recordings show, and how fast it goes. */

export const SPEEDS = [1, 2, 5, 10, 20, 50, 100] as const;

export class Clock {
  time: number;
  isPlaying = false;
  private place = 2;

  constructor(
    readonly start: number,
    public end: number,
  ) {
    this.time = start;
  }

  get speed(): number {
    return SPEEDS[this.place];
  }

  faster(by: 1 | -1): void {
    this.place = Math.min(Math.max(this.place + by, 0), SPEEDS.length - 1);
  }

  /** Goes to a time, as far as there is one. */
  seek(time: number): void {
    this.time = Math.min(Math.max(time, this.start), this.end);
  }

  /** Plays or pauses; at the end it begins again. */
  toggle(): void {
    if (!this.isPlaying && this.time >= this.end) this.time = this.start;
    this.isPlaying = !this.isPlaying;
  }

  /** Goes on by so many seconds of the viewer. Returns whether the time changed. */
  advance(seconds: number): boolean {
    if (!this.isPlaying) return false;
    this.seek(this.time + seconds * this.speed);
    if (this.time >= this.end) this.isPlaying = false;
    return true;
  }
}
