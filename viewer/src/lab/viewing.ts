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

export class Viewing {
  readonly root = element('section', { class: 'viewing', 'aria-label': 'Both trials' });
  private readonly bar = element('header', { class: 'strip' });
  private readonly place = element('div', { class: 'viewer' });
  private app: App | null = null;
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

  async open(experiment: Experiment, pair: Pair): Promise<void> {
    this.end();
    const number = ++this.opened;
    this.root.hidden = false;
    this.showBar(experiment, pair);
    this.place.replaceChildren(
      element('p', { class: 'message', role: 'status' }, 'Reading the recordings ...'),
    );
    try {
      const recordings: Recording[] = [];
      for (const trial of [pair.a, pair.b]) {
        recordings.push(await Recording.read(recordingName(experiment.plan, trial), recordingOf(trial)));
      }
      if (number !== this.opened) return;
      const app = new App(this.place, recordings, { isPage: false });
      this.app = app;
      for (const recording of recordings) await recording.survey();
      app.refresh();
    } catch (error) {
      if (number !== this.opened) return;
      const sentence = error instanceof Error ? error.message : String(error);
      this.place.replaceChildren(element('p', { class: 'message', role: 'alert' }, sentence));
    }
  }

  private showBar(experiment: Experiment, { seed, a, b }: Pair): void {
    const back = button('◂ Laboratory', 'Go back to the laboratory', () => {
      this.close();
    });
    const title = element('strong', {}, `Seed ${seed}: ${rescued(a)}, ${rescued(b)}`);
    const saves = [a, b].map((trial) => {
      const name = recordingName(experiment.plan, trial);
      return button(`Save ${trial.policy}`, `Save the recording ${name}`, () => {
        download(name, recordingOf(trial), 'application/octet-stream');
      });
    });
    this.bar.replaceChildren(back, title, ...saves);
  }

  /** Takes the viewer away. */
  private end(): void {
    this.app?.dispose();
    this.app = null;
  }

  close(): void {
    this.opened += 1;
    this.end();
    this.root.hidden = true;
    this.closed();
  }
}
