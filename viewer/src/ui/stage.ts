/** One recording from above: a canvas to pan, zoom and click. */

import { Camera } from '../draw/camera';
import { Labels } from '../draw/labels';
import { drawScene } from '../draw/scene';
import type { Looks } from '../draw/sheet';
import type { Moment, Recording } from '../recording/recording';
import { positionOf } from '../recording/state';
import type { Point } from '../recording/types';
import { inWords } from '../recording/words';
import { countUntil, deliveries } from './curves';
import { Sheet, element } from './dom';

/** How near to a robot a click may be, in pixels. */
const REACH = 16;

/** A pointer that moved less than this between down and up has clicked, in pixels. */
const CLICK = 5;

export class Stage {
  readonly root: HTMLElement;
  readonly camera: Camera;
  selected: number | null = null;
  viewpoint: number | null = null;
  isFollowing = false;
  private readonly sheet: Sheet;
  private readonly pointers = new Map<number, Point>();
  private moved = 0;
  private moment: Moment | null = null;
  private readonly labels = new Labels();
  private delivered: number[] = [];
  private readonly cut = element('em');
  private readonly total = element('output', { class: 'total' });

  constructor(
    readonly recording: Recording,
    private readonly looks: { routes: boolean; links: boolean; messages: boolean },
    private readonly changed: () => void,
    private readonly clicked: (robot: number | null) => void,
  ) {
    this.camera = new Camera(recording.header.world.arena_m);
    this.sheet = new Sheet(
      { class: 'stage-canvas', role: 'img', 'aria-label': 'The arena from above' },
      () => {
        this.camera.resize(this.sheet.width, this.sheet.height);
        changed();
      },
    );
    const { policy, seed, scenario } = recording.header;
    const caption = element('div', { class: 'caption' }, element('strong', {}, policy), ' ', this.total);
    caption.append(` ${scenario.name}, seed ${seed}`);
    caption.append(this.cut);
    this.grew();
    this.root = element(
      'section',
      { class: 'stage' },
      caption,
      element('div', { class: 'view' }, this.sheet.canvas),
    );
    this.listen();
  }

  /** Takes account of what was added to the recording. */
  grew(): void {
    const { cut, isGrowing } = this.recording;
    this.delivered = deliveries(this.recording)
      .flat()
      .sort((a, b) => a - b);
    this.cut.textContent = cut === null ? '' : isGrowing ? ' (running)' : ' (cut short)';
  }

  draw(time: number): Moment | null {
    const moment = this.recording.at(time, this.changed) ?? this.moment;
    if (!moment) return null;
    this.moment = moment;
    if (this.isFollowing && this.selected !== null) {
      this.camera.center = positionOf(this.recording, moment, this.selected);
      this.camera.isFitted = false;
    }
    const looks: Looks = { ...this.looks, selected: this.selected, viewpoint: this.viewpoint };
    drawScene(this.sheet.context, this.sheet.ratio, this.camera, this.recording, moment, looks, this.labels);
    const { world } = this.recording.header;
    if (world.rescuees.length > 0)
      this.total.textContent = inWords(world, `${countUntil(this.delivered, time)} rescued`);
    return moment;
  }

  /** Follows the selected robot, from near, or stops doing so. */
  follow(isFollowing: boolean): void {
    this.isFollowing = isFollowing && this.selected !== null;
    if (this.isFollowing) this.camera.scale = Math.max(this.camera.scale, 22);
    else if (!isFollowing) this.camera.fit();
    this.changed();
  }

  /** Where a robot is on the screen, from the corner of the page. */
  placeOf(robot: number): Point | null {
    if (!this.moment) return null;
    const { left, top } = this.sheet.canvas.getBoundingClientRect();
    const [x, y] = this.camera.toScreen(positionOf(this.recording, this.moment, robot));
    return [x + left, y + top];
  }

  private robotAt(place: Point): number | null {
    if (!this.moment) return null;
    let [best, nearest] = [null as number | null, Math.max(REACH, this.camera.scale)];
    for (let robot = 0; robot < this.recording.header.world.robots.length; robot++) {
      const [x, y] = this.camera.toScreen(positionOf(this.recording, this.moment, robot));
      const distance = Math.hypot(x - place[0], y - place[1]);
      if (distance < nearest) [best, nearest] = [robot, distance];
    }
    return best;
  }

  private placeIn(event: MouseEvent): Point {
    const { left, top } = this.sheet.canvas.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  }

  private listen(): void {
    const { canvas } = this.sheet;
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      this.pointers.set(event.pointerId, this.placeIn(event));
      if (this.pointers.size === 1) this.moved = 0;
    });
    canvas.addEventListener('pointermove', (event) => this.drag(event));
    const lift = (event: PointerEvent): void => {
      const place = this.pointers.get(event.pointerId);
      this.pointers.delete(event.pointerId);
      if (place && event.type === 'pointerup' && this.pointers.size === 0 && this.moved < CLICK) {
        this.clicked(this.robotAt(place));
      }
    };
    canvas.addEventListener('pointerup', lift);
    canvas.addEventListener('pointercancel', lift);
    canvas.addEventListener('dblclick', () => {
      this.isFollowing = false;
      this.camera.fit();
      this.changed();
    });
    canvas.addEventListener(
      'wheel',
      (event) => {
        event.preventDefault();
        this.camera.zoom(Math.exp(-event.deltaY * 0.0015), this.placeIn(event));
        this.changed();
      },
      { passive: false },
    );
  }

  private drag(event: PointerEvent): void {
    const before = this.pointers.get(event.pointerId);
    if (!before) return;
    const now = this.placeIn(event);
    const others = [...this.pointers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
    this.pointers.set(event.pointerId, now);
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    this.moved += Math.hypot(dx, dy);
    if (this.moved < CLICK) return;
    if (others.length === 0) {
      this.isFollowing = false;
      this.camera.pan(dx, dy);
    } else {
      const [other] = others;
      const distance = (place: Point): number => Math.hypot(place[0] - other[0], place[1] - other[1]);
      const middle: Point = [(now[0] + other[0]) / 2, (now[1] + other[1]) / 2];
      this.camera.zoom(Math.max(distance(now), 1) / Math.max(distance(before), 1), middle);
      this.camera.pan(dx / 2, dy / 2);
    }
    this.changed();
  }
}
