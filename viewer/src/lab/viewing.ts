/** A pair of trials in the viewer, which takes the place of the laboratory until the reader goes back. */

import { Recording } from '../recording/recording';
import { App } from '../ui/app';
import { button, element } from '../ui/dom';
import { recordingName } from './commands';
import { type Experiment, type Pair, type Trial, recordingOf } from './experiment';
import { download } from './page';

/** What a trial has rescued. */
function rescued({ policy, state }: Trial): string {
  if (state.kind === 'done') return `${policy} rescued ${state.record.rescuees}`;
  return `${policy} ${state.kind === 'running' ? 'is still running' : state.kind}`;
}

const isOver = ({ state }: Trial): boolean => state.kind !== 'running' && state.kind !== 'waiting';

/** A trial whose recording is shown, and how many of its parts the recording has. */
interface Shown {
  trial: Trial;
  recording: Recording;
  parts: number;
}

export class Viewing {
  readonly root = element('section', { class: 'viewing', 'aria-label': 'Both trials' });
  private readonly bar = element('header', { class: 'strip' });
  private readonly place = element('div', { class: 'viewer' });
  private app: App | null = null;
  private pair: Pair | null = null;
  private experiment: Experiment | null = null;
  private shown: Shown[] = [];
  /** What is being read; the next comes after it. */
  private reading: Promise<void> = Promise.resolve();
  /** Counts what is opened, so that a slow recording does not appear in place of a later one. */
  private opened = 0;

  /** `closed` is called when the reader goes back. */
  constructor(private readonly closed: () => void) {
    this.root.hidden = true;
    this.root.append(this.bar, this.place);
  }

  get viewer(): App | null {
    return this.app;
  }

  /** Shows a pair; if a trial of it runs, it is watched. */
  open(experiment: Experiment, pair: Pair): Promise<void> {
    this.end();
    [this.experiment, this.pair] = [experiment, pair];
    this.root.hidden = false;
    this.showBar();
    this.say('Reading the recordings ...', 'status');
    return this.next();
  }

  /** A trial has come on: if it is shown, its recording grows. */
  grew(pair: Pair): void {
    if (pair !== this.pair) return;
    this.showBar();
    void this.next();
  }

  /** Reads what there is, after what is being read. */
  private next(): Promise<void> {
    const number = this.opened;
    this.reading = this.reading.then(async () => {
      if (number !== this.opened || !this.pair) return;
      try {
        await (this.app ? this.append(this.app) : this.begin(this.pair, number));
      } catch (error) {
        const sentence = error instanceof Error ? error.message : String(error);
        if (number !== this.opened || this.app) return;
        if (isOver(this.pair.a) && isOver(this.pair.b)) this.say(sentence, 'alert');
        else this.say('These trials have just begun.', 'status');
      }
    });
    return this.reading;
  }

  private async begin(pair: Pair, number: number): Promise<void> {
    const shown: Shown[] = [];
    for (const trial of [pair.a, pair.b]) {
      const parts = trial.parts.length;
      const recording = await Recording.read(this.nameOf(trial), recordingOf(trial));
      recording.isGrowing = !isOver(trial);
      await recording.survey();
      shown.push({ trial, recording, parts });
    }
    if (number !== this.opened) return;
    this.shown = shown;
    const recordings = shown.map(({ recording }) => recording);
    this.app = new App(this.place, recordings, { isPage: false });
  }

  private async append(app: App): Promise<void> {
    for (const shown of this.shown) {
      const { trial, recording } = shown;
      while (shown.parts < trial.parts.length) await recording.append(trial.parts[shown.parts++]);
      recording.isGrowing = !isOver(trial);
      await recording.survey();
    }
    app.grew();
  }

  private nameOf(trial: Trial): string {
    return this.experiment ? recordingName(this.experiment.plan, trial) : '';
  }

  private say(sentence: string, role: 'status' | 'alert'): void {
    this.place.replaceChildren(element('p', { class: 'message', role }, sentence));
  }

  private showBar(): void {
    if (!this.pair) return;
    const { seed, a, b } = this.pair;
    const title = `Seed ${seed}: ${rescued(a)}, ${rescued(b)}`;
    if (this.bar.querySelector('strong')?.textContent === title) return;
    const back = button('◂ Laboratory', 'Go back to the laboratory', () => this.close());
    const saves = [a, b].map((trial) => {
      const name = this.nameOf(trial);
      return button(`Save ${trial.policy}`, `Save the recording ${name}`, () =>
        download(name, recordingOf(trial), 'application/octet-stream'),
      );
    });
    this.bar.replaceChildren(back, element('strong', {}, title), ...saves);
  }

  /** Takes the viewer away. */
  private end(): void {
    this.opened += 1;
    this.app?.dispose();
    this.app = null;
    this.pair = null;
    this.shown = [];
  }

  close(): void {
    this.end();
    this.root.hidden = true;
    this.closed();
  }
}
