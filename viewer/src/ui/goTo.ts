/** A field for the time to go to. */

import { button, clockTime, element } from './dom';
import { parseTime } from './link';

export class GoTo {
  readonly root = element('dialog', { class: 'help', 'aria-label': 'Go to a time' });
  private readonly field = element('input', { name: 'time', autocomplete: 'off', size: '10' });

  constructor(private readonly seek: (time: number) => void) {
    const go = button('Go', 'Go to this time (Enter)', () => this.go());
    const label = element('label', {}, 'Go to ', this.field);
    const hint = 'Seconds, or minutes and seconds: 128 or 2:08';
    this.root.append(element('p', { class: 'tools' }, label, go), element('p', { class: 'hint' }, hint));
    this.field.addEventListener('input', () => this.field.setCustomValidity(''));
    this.field.addEventListener('keydown', (event) => {
      if (event.key !== 'Enter') return;
      event.preventDefault(); // or the button that gets the focus back is pressed by the same key
      this.go();
    });
    this.root.addEventListener('click', (event) => {
      if (event.target === this.root) this.root.close();
    });
  }

  /** Asks for a time; the field begins with the present one. */
  ask(time: number): void {
    this.field.value = clockTime(time);
    this.root.showModal();
    this.field.select();
  }

  private go(): void {
    const time = parseTime(this.field.value);
    this.field.setCustomValidity(time === null ? 'Not a time. Write 128 or 2:08.' : '');
    if (!this.field.reportValidity() || time === null) return;
    this.root.close();
    this.seek(time);
  }
}
