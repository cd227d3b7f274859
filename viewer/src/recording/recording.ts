/** A recording: what does not change at once, segments when they are needed. */

import { type Chunk, ReadError, chunksFrom, chunksOf, inflate, inflateJson } from './chunks';
import { Course } from './course';
import { type MotionField, Segment, Stream } from './segment';
import { doingOf } from './robotRow';
import type { EventJson, Header, Summary, TimedDecision } from './types';

const VERSION = 1;

/** Numbers that decoded segments may take in memory, over all segments of a recording. */
const BUDGET = 24e6;

/** Something that happened. */
export interface Happening {
  time: number;
  kind: string;
  fields: Record<string, unknown>;
}

/** Where the state at a time is found: a segment, and a frame of it. */
export interface Moment {
  segment: Segment;
  frame: number;
  /** How far the time is on its way to the next frame, from 0 to 1. */
  part: number;
}

/** Levels of the team at one time. */
export interface Levels {
  time: number;
  energy: [least: number, mean: number, most: number];
  hp: [least: number, mean: number, most: number];
}

function happening(event: EventJson, time: number): Happening {
  if (typeof event === 'string') return { time, kind: event, fields: {} };
  const [kind, fields] = Object.entries(event)[0];
  return { time, kind, fields };
}

export class Recording {
  readonly happenings: Happening[] = [];
  readonly decisions: TimedDecision[] = [];
  frames = 0;
  summary: Summary | null = null;
  /** Bytes at the end of a recording that was cut short; null for a whole one. */
  cut: number | null = 0;
  /** Whether further bytes are to come. */
  isGrowing = false;
  levels: Levels[] = [];
  /** What became of each robot; filled by the survey. */
  readonly courses: Course[];
  private readonly segments = new Map<number, Segment>();
  private readonly pending = new Map<number, Promise<Segment>>();

  private readonly chunks: Chunk[] = [];
  private chunksRead = 0;
  private surveyed = 0;
  /** Bytes after the last whole chunk. */
  private tail = new Uint8Array();

  private constructor(
    readonly name: string,
    readonly header: Header,
  ) {
    this.courses = header.world.robots.map(() => new Course());
  }

  static async read(name: string, bytes: Uint8Array): Promise<Recording> {
    const { chunks, rest } = chunksOf(bytes);
    if (chunks.length === 0 || chunks[0].kind !== 'HEAD') {
      throw new ReadError('The recording ends within its header: there is nothing to show.');
    }
    const header = await inflateJson<Header>(chunks[0]);
    if (header.version !== VERSION) {
      throw new ReadError(`The recording has version ${header.version} of the format, not ${VERSION}.`);
    }
    const recording = new Recording(name, header);
    await recording.take(chunks, bytes.slice(bytes.length - rest));
    if (recording.frames === 0) throw new ReadError('The recording was cut short before its first frames.');
    return recording;
  }

  /** Adds further bytes of a recording that grows. Each call waits for the one before. */
  async append(bytes: Uint8Array): Promise<void> {
    const joined = new Uint8Array(this.tail.length + bytes.length);
    joined.set(this.tail);
    joined.set(bytes, this.tail.length);
    const { chunks, rest } = chunksFrom(joined, 0, this.chunksRead);
    await this.take(chunks, joined.slice(joined.length - rest));
  }

  private async take(chunks: readonly Chunk[], tail: Uint8Array<ArrayBuffer>): Promise<void> {
    for (const chunk of chunks) {
      if (chunk.kind === 'EVNT') {
        const { events } = await inflateJson<{ events: [number, EventJson][] }>(chunk);
        for (const [step, event] of events) {
          this.happenings.push(happening(event, step * this.header.dt_s));
        }
      } else if (chunk.kind === 'DECI') {
        this.decisions.push(await inflateJson<TimedDecision>(chunk));
      } else if (chunk.kind === 'DONE') {
        this.summary = await inflateJson<Summary>(chunk);
      }
    }
    const segments = chunks.filter(({ kind }) => kind === 'SEGM');
    const last = segments.at(-1) && (await decode(segments[segments.length - 1], this.header));
    this.chunks.push(...segments);
    this.chunksRead += chunks.length;
    if (last) this.frames = last.firstFrame + last.frames;
    this.tail = tail;
    this.cut = this.summary && tail.length === 0 ? null : tail.length;
  }

  /** The simulated time of a frame, in seconds. */
  timeOf(frame: number): number {
    return (this.header.first_step + frame * this.header.steps_per_frame) * this.header.dt_s;
  }

  get start(): number {
    return this.timeOf(0);
  }

  get end(): number {
    return this.timeOf(this.frames - 1);
  }

  /** Where the state at a time is, if its segment is decoded; if not, it is decoded and `ready` is called. */
  at(time: number, ready: () => void): Moment | null {
    const perFrame = this.header.steps_per_frame * this.header.dt_s;
    const exact = Math.min(Math.max((time - this.start) / perFrame, 0), this.frames - 1);
    const frame = Math.floor(exact + 1e-6);
    const number = Math.floor(frame / this.header.frames_per_segment);
    const segment = this.segment(number, ready);
    if (!segment) return null;
    this.segment(Math.min(number + 1, this.chunks.length - 1), () => undefined);
    return { segment, frame: frame - segment.firstFrame, part: Math.max(exact - frame, 0) };
  }

  /** The segment with a frame, if it is decoded. */
  segmentOf(frame: number): Segment | null {
    return this.segments.get(Math.floor(frame / this.header.frames_per_segment)) ?? null;
  }

  /**
   * Decodes all segments once, for the levels and the courses; those that the memory allows stay. After
   * bytes were added, it goes on with the new segments.
   */
  async survey(): Promise<void> {
    const every = Math.max(1, Math.round(this.frames / 600));
    while (this.surveyed < this.chunks.length) {
      const number = this.surveyed++;
      const segment = await this.decoded(number);
      for (let frame = 0; frame < segment.frames; frame++) {
        if ((segment.firstFrame + frame) % every === 0) this.levels.push(this.levelsAt(segment, frame));
      }
      this.addCourses(segment);
    }
  }

  private addCourses(segment: Segment): void {
    this.courses.forEach((course, robot) => {
      for (const [frame, row] of segment.changes(Stream.Robots, robot)) {
        course.add(this.timeOf(segment.firstFrame + frame), doingOf(this.header, row));
      }
      course.end(this.timeOf(segment.firstFrame + segment.frames - 1));
    });
  }

  private levelsAt(segment: Segment, frame: number): Levels {
    const robots = this.header.world.robots.length;
    const range = (field: MotionField): [number, number, number] => {
      let [least, sum, most] = [Infinity, 0, -Infinity];
      for (let robot = 0; robot < robots; robot++) {
        const level = segment.motion(robot, field, frame) / 1000;
        [least, sum, most] = [Math.min(least, level), sum + level, Math.max(most, level)];
      }
      return [least, sum / robots, most];
    };
    const time = this.timeOf(segment.firstFrame + frame);
    return { time, energy: range('energy_millipercent'), hp: range('hp_millipercent') };
  }

  private segment(number: number, ready: () => void): Segment | null {
    const segment = this.segments.get(number);
    if (segment) return segment;
    void this.decoded(number).then(ready);
    return null;
  }

  private decoded(number: number): Promise<Segment> {
    const known = this.segments.get(number);
    if (known) return Promise.resolve(known);
    let pending = this.pending.get(number);
    if (!pending) {
      pending = decode(this.chunks[number], this.header).then((segment) => {
        this.pending.delete(number);
        this.keep(number, segment);
        return segment;
      });
      this.pending.set(number, pending);
    }
    return pending;
  }

  /** Keeps a segment; the ones that were decoded first make room for it. */
  private keep(number: number, segment: Segment): void {
    this.segments.set(number, segment);
    const most = Math.max(4, Math.floor(BUDGET / segment.size));
    for (const oldest of this.segments.keys()) {
      if (this.segments.size <= most) return;
      this.segments.delete(oldest);
    }
  }
}

async function decode(chunk: Chunk, header: Header): Promise<Segment> {
  const rows = header.streams.map(([, count]) => count);
  try {
    return new Segment(await inflate(chunk), header.world.robots.length, header.motion_fields, rows);
  } catch (error) {
    if (error instanceof ReadError) throw error;
    throw new ReadError(`The recording is damaged: chunk ${chunk.number} does not hold frames.`);
  }
}
