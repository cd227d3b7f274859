/** The page: stages side by side, the time below them, panels beside them. */

import { LARGE_TEAM } from '../draw/sheet';
import { groupColour, onThemeChange } from '../draw/theme';
import type { Moment, Recording } from '../recording/recording';
import { Clock } from './clock';
import { Curves } from './curves';
import { button, clockTime, element, swatch } from './dom';
import { EventPanel } from './eventPanel';
import { Help } from './help';
import { RobotPanel } from './robotPanel';
import { RoundPanel } from './roundPanel';
import { Stage } from './stage';
import { Timeline, rounds } from './timeline';

/** Height of the line above a stage, in pixels. */
const CAPTION = 32;

/** The panels are drawn at most so often while the trial plays, in milliseconds. */
const PANEL_PERIOD = 120;

export class App {
  readonly clock: Clock;
  readonly stages: Stage[];
  focus = 0;
  private readonly looks = { routes: true, links: true };
  private readonly timeline: Timeline;
  private readonly curves: Curves;
  private readonly robotPanel: RobotPanel;
  private readonly roundPanel: RoundPanel;
  private readonly eventPanel: EventPanel;
  private readonly help = new Help();
  private readonly play: HTMLButtonElement;
  private readonly told = element('output', { class: 'time' });
  private readonly speed = element('output', { class: 'speed' });
  private readonly viewpoints = element('div', {
    class: 'viewpoints',
    role: 'group',
    'aria-label': 'Whose knowledge',
  });
  private readonly tabs = element('div', { class: 'tabs', role: 'group', 'aria-label': 'Recording' });
  private isDirty = true;
  private isAfresh = true;
  private panelsDrawn = 0;
  private last = 0;
  /** Drawings so far, and the time that they took, in milliseconds: to measure. */
  readonly drawn = { frames: 0, milliseconds: 0 };

  constructor(
    root: HTMLElement,
    readonly recordings: readonly Recording[],
  ) {
    const starts = recordings.map(({ start }) => start);
    this.looks.routes = recordings.every(({ header }) => header.world.robots.length <= LARGE_TEAM);
    this.clock = new Clock(Math.min(...starts), Math.max(...recordings.map(({ end }) => end)));
    const changed = (): void => {
      this.change();
    };
    this.stages = recordings.map(
      (recording, number) =>
        new Stage(recording, this.looks, changed, (robot) => {
          this.select(number, robot);
        }),
    );
    this.timeline = new Timeline(this.clock, recordings, changed);
    this.curves = new Curves(this.clock, recordings, changed);
    this.robotPanel = new RobotPanel(
      (robot) => {
        this.select(this.focus, robot);
      },
      () => {
        this.follow();
      },
    );
    this.eventPanel = new EventPanel((time) => {
      this.seek(time);
    });
    this.roundPanel = new RoundPanel((time) => {
      this.seek(time);
    });
    this.play = button(
      '▶',
      'Play or pause (space)',
      () => {
        this.toggle();
      },
      'play',
    );
    root.replaceChildren(this.layout());
    document.title = recordings.map(({ header }) => `${header.policy} ${header.scenario.name}`).join(' | ');
    window.addEventListener('keydown', (event) => {
      this.key(event);
    });
    onThemeChange(() => {
      this.showViewpoints();
      this.refresh();
    });
    this.showViewpoints();
    this.showTabs();
    requestAnimationFrame((now) => {
      this.tick(now);
    });
  }

  private layout(): HTMLElement {
    const transport = element('div', { class: 'transport' });
    transport.append(
      this.play,
      button('−', 'Slower (-)', () => {
        this.faster(-1);
      }),
      this.speed,
      button('+', 'Faster (+)', () => {
        this.faster(1);
      }),
      this.told,
      element('span', { class: 'gap' }),
      this.viewpoints,
      button('?', 'Help (?)', () => {
        this.help.toggle();
      }),
    );
    const stages = element('div', { class: `stages count-${Math.min(this.stages.length, 4)}` });
    stages.append(...this.stages.map(({ root }) => root));
    new ResizeObserver(() => {
      this.arrange(stages);
    }).observe(stages);
    const main = element('div', { class: 'main' }, stages, transport, this.timeline.root);
    const side = element('aside', { class: 'side' }, this.tabs, this.robotPanel.root, this.roundPanel.root);
    side.append(this.curves.root, this.eventPanel.root, this.about());
    return element('div', { class: 'app' }, main, side, this.help.root);
  }

  /** Puts as many stages side by side as shows the arena the largest. */
  private arrange(stages: HTMLElement): void {
    const [width, height] = this.recordings[0].header.world.arena_m;
    const count = this.stages.length;
    const isPhone = window.matchMedia('(max-width: 860px)').matches;
    const scale = (columns: number): number => {
      const rows = Math.ceil(count / columns);
      const room = stages.clientHeight / rows - CAPTION;
      return Math.min(stages.clientWidth / columns / width, room / height);
    };
    let best = 1;
    for (let columns = 2; columns <= count; columns++) if (scale(columns) > scale(best)) best = columns;
    stages.style.gridTemplateColumns = `repeat(${isPhone ? 1 : best}, minmax(0, 1fr))`;
  }

  private about(): HTMLElement {
    const { header, cut } = this.recordings[0];
    const about = element('section', { class: 'panel about' });
    about.append(element('p', {}, header.scenario.description));
    if (cut !== null)
      about.append(element('p', {}, 'The recording was cut short: this is what was whole of it.'));
    about.append(element('p', { class: 'hint' }, `${header.program}, scenario ${header.scenario.xxh3_128}`));
    return about;
  }

  private showTabs(): void {
    if (this.recordings.length < 2) return;
    this.tabs.replaceChildren(
      ...this.recordings.map(({ header }, number) => {
        const tab = button(header.policy, `Show the panels of ${header.policy}, seed ${header.seed}`, () => {
          this.focusOn(number);
        });
        tab.setAttribute('aria-pressed', String(number === this.focus));
        return tab;
      }),
    );
  }

  private focusOn(number: number): void {
    this.focus = number;
    this.stages.forEach(({ root }, i) => {
      root.classList.toggle('focused', i === number && this.stages.length > 1);
    });
    this.showTabs();
    this.showViewpoints();
    this.refresh();
  }

  /** The groups whose knowledge can be shown. */
  private showViewpoints(): void {
    const { tasks } = this.recordings[this.focus].header.world;
    const of = (text: string, viewpoint: number | null, colour: string | null): HTMLElement => {
      const title = viewpoint === null ? 'Show the world as it is' : `Show what is known to ${text}`;
      const chip = button(
        '',
        title,
        () => {
          this.setViewpoint(viewpoint);
        },
        'chip',
      );
      if (colour) chip.append(swatch(colour));
      chip.append(element('span', {}, text));
      chip.setAttribute('aria-pressed', String(this.stages[this.focus].viewpoint === viewpoint));
      return chip;
    };
    const groups = tasks.map((task, number) => of(task.name, number, groupColour(number)));
    const home = tasks.length > 0 ? [of('home', tasks.length, groupColour(null))] : [];
    this.viewpoints.replaceChildren(of('the world', null, null), ...groups, ...home);
  }

  private setViewpoint(viewpoint: number | null): void {
    for (const stage of this.stages) stage.viewpoint = viewpoint;
    this.showViewpoints();
    this.change();
  }

  select(number: number, robot: number | null): void {
    // The same robot is shown on all stages: side by side, trials differ in what became of it.
    for (const stage of this.stages) {
      const exists = robot !== null && robot < stage.recording.header.world.robots.length;
      stage.selected = exists ? robot : null;
      if (!exists) stage.isFollowing = false;
    }
    this.focusOn(number);
  }

  seek(time: number): void {
    this.clock.seek(time);
    this.change();
  }

  toggle(): void {
    this.clock.toggle();
    this.change();
  }

  private faster(by: 1 | -1): void {
    this.clock.faster(by);
    this.change();
  }

  private follow(): void {
    const isFollowing = !this.stages[this.focus].isFollowing;
    for (const stage of this.stages) stage.follow(isFollowing && stage.selected !== null);
    this.refresh();
  }

  private toRound(by: 1 | -1): void {
    const times = rounds(this.recordings[this.focus]).map(({ from }) => from);
    const later = times.find((time) => time > this.clock.time + 0.2);
    const before = times.filter((time) => time < this.clock.time - 0.2).pop();
    this.seek((by === 1 ? later : before) ?? this.clock.time);
  }

  private key(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = event.shiftKey ? 10 : 1;
    const actions: Record<string, () => void> = {
      ' ': () => {
        this.toggle();
      },
      ArrowLeft: () => {
        this.seek(this.clock.time - step);
      },
      ArrowRight: () => {
        this.seek(this.clock.time + step);
      },
      Home: () => {
        this.seek(this.clock.start);
      },
      End: () => {
        this.seek(this.clock.end);
      },
      '+': () => {
        this.faster(1);
      },
      '=': () => {
        this.faster(1);
      },
      '-': () => {
        this.faster(-1);
      },
      '[': () => {
        this.toRound(-1);
      },
      ']': () => {
        this.toRound(1);
      },
      f: () => {
        this.follow();
      },
      r: () => {
        this.looks.routes = !this.looks.routes;
      },
      w: () => {
        this.looks.links = !this.looks.links;
      },
      Escape: () => {
        this.select(this.focus, null);
      },
      '?': () => {
        this.help.toggle();
      },
    };
    const action = Object.hasOwn(actions, event.key) ? actions[event.key] : undefined;
    if (!action || (this.help.root.open && event.key !== '?')) return;
    event.preventDefault();
    action();
    this.change();
  }

  private change(): void {
    this.isDirty = true;
  }

  /** Draws all anew, the panels too. */
  refresh(): void {
    this.isAfresh = true;
    this.change();
  }

  private tick(now: number): void {
    const seconds = Math.min((now - this.last) / 1000, 0.25);
    this.last = now;
    requestAnimationFrame((next) => {
      this.tick(next);
    });
    if (this.clock.advance(seconds) || this.isDirty) this.draw(now);
  }

  private draw(now: number): void {
    const begin = performance.now();
    this.isDirty = false;
    const moments = this.stages.map((stage) => stage.draw(this.clock.time));
    this.timeline.draw();
    const isDue = !this.clock.isPlaying || this.isAfresh || now - this.panelsDrawn > PANEL_PERIOD;
    if (isDue) {
      this.panelsDrawn = now;
      this.drawPanels(moments[this.focus]);
    }
    this.play.textContent = this.clock.isPlaying ? '❚❚' : '▶';
    this.speed.textContent = `${this.clock.speed}×`;
    this.told.textContent = `${clockTime(this.clock.time)} / ${clockTime(this.clock.end)}`;
    this.drawn.frames += 1;
    this.drawn.milliseconds += performance.now() - begin;
  }

  private drawPanels(moment: Moment | null): void {
    const recording = this.recordings[this.focus];
    const { selected, isFollowing } = this.stages[this.focus];
    if (moment) this.robotPanel.draw(recording, moment, selected, isFollowing);
    this.roundPanel.draw(recording, this.clock.time, this.isAfresh);
    this.curves.draw(this.focus);
    this.eventPanel.draw(recording, this.clock.time, selected);
    this.isAfresh = false;
  }
}
