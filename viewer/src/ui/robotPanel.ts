/** What there is to know of one robot at one moment. */

import { inWords } from '../recording/words';
import { LARGE_TEAM } from '../draw/sheet';
import { groupColour, theme } from '../draw/theme';
import type { Moment, Recording } from '../recording/recording';
import { type RobotState, mostOf, needOf, robotAt } from '../recording/state';
import type { Need } from '../recording/types';
import type { CoursePanel } from './coursePanel';
import { button, clockTime, element, swatch, words } from './dom';

/** A large team is listed anew at most so often, in milliseconds. */
const TEAM_PERIOD = 1000;

const UNITS: Record<Need['measures'], string> = {
  Health: '',
  Speed: 'm/s',
  Sensing: 'm',
  Energy: '',
  Resources: '',
  Capacity: '',
  Observing: 'm',
  Constant: '',
};

function bar(share: number, colour: string): HTMLElement {
  const fill = element('span');
  fill.style.width = `${100 * Math.min(Math.max(share, 0), 1)}%`;
  fill.style.background = colour;
  return element('span', { class: 'bar' }, fill);
}

function line(name: string, value: Node | string, picture?: Node): HTMLElement {
  const row = element(
    'tr',
    {},
    element('th', { scope: 'row' }, name),
    element('td', { class: 'value' }, value),
  );
  row.append(element('td', { class: 'picture' }, ...(picture ? [picture] : [])));
  return row;
}

/** What it does, in words. */
export function doing(robot: RobotState): string {
  const until = robot.until === null ? '' : ` until ${clockTime(robot.until)}`;
  const rescuee = robot.rescuee === null ? '' : ` rescuee ${robot.rescuee}`;
  return words(robot.activity) + rescuee + until;
}

/** Why it does not move on, in words. */
export function held(robot: RobotState): string {
  const other = robot.waitsFor === null ? '' : `, waits for robot ${robot.waitsFor}`;
  return words(robot.delay) + other;
}

export class RobotPanel {
  readonly root = element('section', { class: 'panel robot-panel', 'aria-live': 'off' });
  private readonly state = element('div');
  private isTeam = false;
  private teamDrawn = 0;

  constructor(
    private readonly select: (robot: number | null) => void,
    private readonly follow: () => void,
    private readonly course: CoursePanel,
  ) {
    this.root.append(this.state, course.root);
  }

  draw(recording: Recording, moment: Moment, selected: number | null, isFollowing: boolean): void {
    this.course.root.hidden = selected === null;
    if (selected === null) {
      this.drawTeam(recording, moment);
      return;
    }
    this.drawRobot(recording, robotAt(recording, moment, selected), isFollowing);
    this.course.draw(recording, selected);
  }

  private drawTeam(recording: Recording, moment: Moment): void {
    const { world } = recording.header;
    const now = performance.now();
    if (this.isTeam && world.robots.length > LARGE_TEAM && now - this.teamDrawn < TEAM_PERIOD) return;
    [this.isTeam, this.teamDrawn] = [true, now];
    const list = element('div', { class: 'team' });
    const shown = Math.min(world.robots.length, LARGE_TEAM);
    for (let id = 0; id < shown; id++) {
      const robot = robotAt(recording, moment, id);
      const chip = button(
        '',
        `Robot ${id}, ${robot.role.name}: ${doing(robot)}`,
        () => this.select(id),
        'member',
      );
      chip.append(swatch(groupColour(robot.task)), element('span', {}, `${id}`));
      chip.append(bar(robot.energy / 100, theme().energy), bar(robot.hp / 100, theme().hp));
      list.append(chip);
    }
    const hint = 'Click a robot, here or in the arena, for its levels, needs and delays.';
    this.state.replaceChildren(
      element('h2', {}, `Team of ${world.robots.length}`),
      element('p', { class: 'hint' }, hint),
      list,
    );
  }

  private drawRobot(recording: Recording, robot: RobotState, isFollowing: boolean): void {
    const { world } = recording.header;
    this.isTeam = false;
    const title = element('h2', {}, swatch(groupColour(robot.task)), `Robot ${robot.id}, ${robot.role.name}`);
    const group = robot.task === null ? 'none' : world.tasks[robot.task].name;
    const state = element('table', { class: 'facts' });
    const colours = theme();
    const fields: [string, string, Node?][] = [
      ['group', group],
      ['activity', inWords(world, doing(robot))],
      ['delay', held(robot)],
      ['energy', `${robot.energy.toFixed(1)} %`, bar(robot.energy / 100, colours.energy)],
      [inWords(world, 'HP'), `${robot.hp.toFixed(1)} %`, bar(robot.hp / 100, colours.hp)],
      ['speed', `${Math.hypot(...robot.velocity).toFixed(2)} m/s`],
      [
        'on board',
        `${robot.load} of ${robot.role.capacity}`,
        bar(robot.load / Math.max(robot.role.capacity, 1), colours.soft),
      ],
    ];
    if (robot.condition !== 'able') fields.push(['condition', words(robot.condition)]);
    for (const [name, value, picture] of fields) state.append(line(name, value, picture));
    const needs = element('table', { class: 'facts needs' });
    for (const need of world.needs) {
      const value = needOf(need, robot, world.health_floor);
      const most = mostOf(need, robot.role);
      const text =
        `${Number.isInteger(value) ? value : Number(value.toPrecision(4))} ${UNITS[need.measures]}`.trim();
      needs.append(line(need.name, text, most > 0 ? bar(value / most, colours.soft) : undefined));
    }
    const tools = element('div', { class: 'tools' });
    tools.append(
      button(
        isFollowing ? 'Stop following' : 'Follow',
        'Follow this robot (f)',
        this.follow,
        isFollowing ? 'on' : '',
      ),
      button('Whole team', 'Show the whole team (Escape)', () => this.select(null)),
    );
    this.state.replaceChildren(title, state, element('h3', {}, 'Needs'), needs, tools);
    this.root.dataset.robot = String(robot.id);
  }
}
