/** The page: stages side by side, the time below them, panels beside them. */

import { LARGE_TEAM } from '../draw/sheet';
import { onThemeChange } from '../draw/theme';
import type { Moment, Recording } from '../recording/recording';
import { about } from './about';
import { Clock } from './clock';
import { CoursePanel } from './coursePanel';
import { Curves } from './curves';
import { button, element } from './dom';
import { EventPanel } from './eventPanel';
import { GoTo } from './goTo';
import { Help } from './help';
import { type KeyActions, actionOf } from './keys';
import { LEAST_BELOW, arrange } from './layout';
import { copyLink, linkTo, readLink, showLink } from './link';
import { RobotPanel } from './robotPanel';
import { RoundPanel } from './roundPanel';
import { Stage } from './stage';
import { Timeline, rounds } from './timeline';
import { Transport } from './transport';
import { viewpointChips } from './viewpoints';

/** The address follows a trial that plays at most so often, in milliseconds: browsers allow no more. */
const LINK_PERIOD = 1000;

/** The panels are drawn at most so often while the trial plays, in milliseconds. */
const PANEL_PERIOD = 120;

/** How the viewer stands in its page. */
export interface AppOptions {
  /** A list of trials to choose from. */
  list?: HTMLElement;
  /** Whether the page is the viewer's: its title and its address then say what is shown. */
  isPage?: boolean;
}

export class App {
  readonly clock: Clock;
  readonly stages: Stage[];
  focus = 0;
  private readonly looks = { routes: true, links: true, messages: false };
  private readonly timeline: Timeline;
  private readonly curves: Curves;
  private readonly robotPanel: RobotPanel;
  private readonly roundPanel: RoundPanel;
  private readonly eventPanel: EventPanel;
  private readonly help: Help;
  private readonly isPage: boolean;
  /** Ends listeners and the loop when the viewer is taken away. */
  private readonly ended = new AbortController();
  private readonly goTo = new GoTo((time) => this.seek(time));
  private readonly transport: Transport;
  private readonly main = element('div', { class: 'main' });
  private readonly side = element('aside', { class: 'side' });
  private readonly viewpoints = element('div', {
    class: 'viewpoints',
    role: 'group',
    'aria-label': 'Whose knowledge',
  });
  private readonly tabs = element('div', { class: 'tabs', role: 'group', 'aria-label': 'Recording' });
  private isDirty = true;
  private isAfresh = true;
  private panelsDrawn = 0;
  private linkShown = 0;
  private last = 0;
  /** Drawings so far, and the time that they took, in milliseconds: to measure. */
  readonly drawn = { frames: 0, milliseconds: 0 };

  constructor(
    root: HTMLElement,
    readonly recordings: readonly Recording[],
    { list, isPage = true }: AppOptions = {},
  ) {
    this.isPage = isPage;
    this.help = new Help(isPage);
    const starts = recordings.map(({ start }) => start);
    this.looks.routes = recordings.every(({ header }) => header.world.robots.length <= LARGE_TEAM);
    this.clock = new Clock(Math.min(...starts), Math.max(...recordings.map(({ end }) => end)));
    const changed = (): void => this.change();
    this.stages = recordings.map(
      (recording, number) => new Stage(recording, this.looks, changed, (robot) => this.select(number, robot)),
    );
    this.timeline = new Timeline(this.clock, recordings, changed);
    this.curves = new Curves(this.clock, recordings, changed);
    this.robotPanel = new RobotPanel(
      (robot) => this.select(this.focus, robot),
      () => this.follow(),
      new CoursePanel(this.clock, (time) => this.seek(time), changed),
    );
    this.eventPanel = new EventPanel((time) => this.seek(time));
    this.roundPanel = new RoundPanel((time) => this.seek(time));
    this.transport = this.makeTransport();
    root.replaceChildren(this.layout(list));
    this.listen();
    this.showViewpoints();
    this.showTabs();
    if (isPage) this.goToLink();
    requestAnimationFrame((now) => this.tick(now));
  }

  private listen(): void {
    const { signal } = this.ended;
    const key = (event: KeyboardEvent): void => this.key(event);
    window.addEventListener('keydown', key, { signal });
    onThemeChange(() => {
      this.showViewpoints();
      this.refresh();
    }, signal);
    if (!this.isPage) return;
    const names = this.recordings.map(({ header }) => `${header.policy} ${header.scenario.name}`);
    document.title = names.join(' | ');
    const goTo = (): void => this.goToLink();
    window.addEventListener('hashchange', goTo, { signal });
  }

  /** Takes the viewer away: its loop, its listeners and its elements end. */
  dispose(): void {
    this.ended.abort();
    this.main.parentElement?.remove();
  }

  private makeTransport(): Transport {
    return new Transport(this.clock, this.keys(), this.viewpoints, this.isPage);
  }

  private layout(list?: HTMLElement): HTMLElement {
    const stages = element('div', { class: `stages count-${Math.min(this.stages.length, 4)}` });
    stages.append(...this.stages.map(({ root }) => root));
    this.main.append(stages, this.transport.root, this.timeline.root);
    const observer = new ResizeObserver(() => this.arrange(stages));
    observer.observe(this.main);
    this.ended.signal.addEventListener('abort', () => observer.disconnect());
    this.side.append(...(list ? [list] : []), this.tabs, this.robotPanel.root, this.roundPanel.root);
    this.side.append(this.curves.root, this.eventPanel.root, about(this.recordings[0]));
    return element('div', { class: 'app' }, this.main, this.side, this.help.root, this.goTo.root);
  }

  /** Makes stages as large as the room allows. Where room is left below them, it is for the curves. */
  private arrange(stages: HTMLElement): void {
    const isPhone = window.matchMedia('(max-width: 860px)').matches;
    const { top } = stages.getBoundingClientRect();
    const bottom = this.main.getBoundingClientRect().bottom - 10;
    const others = this.transport.root.offsetHeight + this.timeline.root.offsetHeight + 16;
    const count = this.stages.length;
    const room = isPhone ? 0.4 * window.innerHeight * count : bottom - top - others;
    const { arena_m: arena } = this.recordings[0].header.world;
    const { columns, height } = arrange(count, [stages.clientWidth, room], arena, isPhone ? 1 : count);
    const isBelow = !isPhone && room - height >= LEAST_BELOW;
    stages.style.gridTemplateColumns = `repeat(${columns}, minmax(0, 1fr))`;
    stages.style.height = `${isBelow || isPhone ? height : room}px`;
    if (isBelow) this.main.append(this.curves.root);
    else this.eventPanel.root.before(this.curves.root);
  }

  private showTabs(): void {
    if (this.recordings.length < 2) return;
    this.tabs.replaceChildren(
      ...this.recordings.map(({ header }, number) => {
        const tab = button(header.policy, `Show the panels of ${header.policy}, seed ${header.seed}`, () =>
          this.focusOn(number),
        );
        tab.setAttribute('aria-pressed', String(number === this.focus));
        return tab;
      }),
    );
  }

  private focusOn(number: number): void {
    this.focus = number;
    this.stages.forEach(({ root }, i) =>
      root.classList.toggle('focused', i === number && this.stages.length > 1),
    );
    this.showTabs();
    this.showViewpoints();
    this.refresh();
  }

  private showViewpoints(): void {
    const { tasks } = this.recordings[this.focus].header.world;
    const chips = viewpointChips(tasks, this.stages[this.focus].viewpoint, (viewpoint) =>
      this.setViewpoint(viewpoint),
    );
    this.viewpoints.replaceChildren(...chips);
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

  /** Goes where the address says, as far as it says something. */
  private goToLink(): void {
    const { time, robot } = readLink(location.hash);
    if (time !== null) this.clock.seek(time);
    if (robot !== null) this.select(this.focus, robot);
    this.refresh();
  }

  private link(): string {
    const { trials } = readLink(location.hash);
    return linkTo({ time: this.clock.time, robot: this.stages[this.focus].selected, trials });
  }

  private copyLink(): void {
    if (!this.isPage) return;
    showLink(this.link());
    void copyLink().then(() => this.transport.sayCopied());
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

  private keys(): KeyActions {
    const { clock, looks } = this;
    return {
      toggle: () => this.toggle(),
      step: (seconds) => this.seek(clock.time + seconds),
      toStart: () => this.seek(clock.start),
      toEnd: () => this.seek(clock.end),
      faster: (by) => this.faster(by),
      toRound: (by) => this.toRound(by),
      askTime: () => this.goTo.ask(clock.time),
      copyLink: () => this.copyLink(),
      follow: () => this.follow(),
      routes: () => {
        looks.routes = !looks.routes;
      },
      links: () => {
        looks.links = !looks.links;
      },
      messages: () => {
        looks.messages = !looks.messages;
      },
      team: () => this.select(this.focus, null),
      help: () => this.help.toggle(),
    };
  }

  private key(event: KeyboardEvent): void {
    const action = actionOf(event, this.keys());
    if (!action || this.goTo.root.open || (this.help.root.open && event.key !== '?')) return;
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

  /** Takes account of what was added to recordings that grow. */
  grew(): void {
    this.clock.end = Math.max(...this.recordings.map(({ end }) => end));
    for (const part of [...this.stages, this.curves]) part.grew();
    this.refresh();
  }

  private tick(now: number): void {
    if (this.ended.signal.aborted) return;
    const seconds = Math.min((now - this.last) / 1000, 0.25);
    this.last = now;
    requestAnimationFrame((next) => this.tick(next));
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
    if (this.isPage && (!this.clock.isPlaying || now - this.linkShown > LINK_PERIOD)) {
      this.linkShown = now;
      showLink(this.link());
    }
    this.transport.draw();
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
