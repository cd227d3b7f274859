/** The buttons below the stages: play, speed, time, whose knowledge, link, help. */

import type { Clock } from './clock';
import { button, clockTime, element } from './dom';

/** What the buttons do. */
interface Actions {
  toggle: () => void;
  faster: (by: 1 | -1) => void;
  askTime: () => void;
  copyLink: () => void;
  help: () => void;
}

/** How long a button says that it has copied the link, in milliseconds. */
const SAID = 1500;

export class Transport {
  readonly root = element('div', { class: 'transport' });
  private readonly play: HTMLButtonElement;
  private readonly speed = element('output', { class: 'speed' });
  private readonly time: HTMLButtonElement;
  private readonly link: HTMLButtonElement;

  constructor(
    private readonly clock: Clock,
    { toggle, faster, askTime, copyLink, help }: Actions,
    viewpoints: HTMLElement,
    hasLinks: boolean,
  ) {
    this.play = button('▶', 'Play or pause (space)', toggle, 'play');
    this.time = button('', 'Go to a time (g)', askTime, 'time');
    this.link = button('Link', 'Copy a link to this moment and robot (c)', copyLink, 'link');
    const slower = button('−', 'Slower (-)', () => faster(-1));
    const quicker = button('+', 'Faster (+)', () => faster(1));
    this.root.append(this.play, slower, this.speed, quicker, this.time, element('span', { class: 'gap' }));
    this.root.append(viewpoints, ...(hasLinks ? [this.link] : []), button('?', 'Help (?)', help));
  }

  draw(): void {
    const { isPlaying, speed, time, end } = this.clock;
    this.play.textContent = isPlaying ? '❚❚' : '▶';
    this.speed.textContent = `${speed}×`;
    this.time.textContent = `${clockTime(time)} / ${clockTime(end)}`;
  }

  sayCopied(): void {
    this.link.textContent = 'Copied';
    setTimeout(() => (this.link.textContent = 'Link'), SAID);
  }
}
