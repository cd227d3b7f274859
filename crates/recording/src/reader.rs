//! Reads recordings.

use ron_tree::{Problem, without_types};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use teaming::{Decision, Member, Question};
use usar_sim::event::Event;
use usar_sim::fit::is_result;
use usar_sim::record::{Join, TrialRecord};

use crate::chunk::{Chunk, Chunks, Kind};
use crate::error::ReadError;
use crate::frame::{Frame, Motion, Stored};
use crate::header::{Header, VERSION};
use crate::rows::STREAMS;
use crate::segment::Segment;
use crate::trust::Trust;
use crate::words::{Names, ToldEvent};

/// The most bytes that a recording may have when its chunks are inflated.
const MOST_INFLATED: u64 = 512 << 20;

/// A step is shorter than this, in seconds.
const LONGEST_STEP_S: f64 = 1.0;

/// A recording begins, has its frames and tells its events at smaller numbers of steps than this.
const MOST_STEPS: u64 = 1 << 32;

/// A recording that was read from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// The header.
    pub header: Header,
    /// The events, each with the step at whose end it had happened.
    pub events: Vec<(u64, Event)>,
    /// The decisions.
    pub decisions: Vec<TimedDecision>,
    /// The record of the trial, without its decisions; `None` for a truncated recording.
    pub summary: Option<TrialRecord>,
    /// Number of bytes at the end of a truncated recording that belong to no complete chunk.
    pub cut: Option<usize>,
    segments: Vec<Segment>,
}

/// A decision with its time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TimedDecision {
    /// The step in which it was made.
    pub step: u64,
    /// The question, without its history.
    pub question: Question,
    /// The answer.
    pub decision: Decision,
    /// The members as they really were; absent where the question had them as they were.
    pub truth: Option<Vec<Member>>,
    /// How each robot decided, where robots did.
    #[serde(default)]
    pub joins: Vec<Join>,
    /// The matrix of trust at the decision, by what was reported.
    pub trust: Option<Trust>,
}

impl TimedDecision {
    /// The members as they really were, by id.
    pub fn team(&self) -> &[Member] {
        self.truth.as_ref().unwrap_or(&self.question.members)
    }
}

#[derive(Deserialize)]
struct Events {
    events: Vec<(u64, Event)>,
}

/// Only the version. It is read first, because another version may differ in everything else.
#[derive(Deserialize)]
struct Version {
    version: u32,
}

fn json<T: DeserializeOwned>(chunk: &Chunk, content: &[u8]) -> Result<T, ReadError> {
    serde_json::from_slice(content).map_err(|error| chunk.damaged(without_types(&error)))
}

impl Recording {
    /// For each radiation zone, whether it is on at a step.
    pub fn zones_on(&self, step: u64) -> Vec<bool> {
        let world = &self.header.world;
        let mut on: Vec<bool> =
            (0..world.zones.len()).map(|zone| !world.zones_later.contains(&zone)).collect();
        for (_, event) in self.events.iter().take_while(|(at, _)| *at <= step) {
            let (zone, is_on) = match event {
                Event::SourceAppeared { zone } => (*zone, true),
                Event::SourceDied { zone } => (*zone, false),
                _ => continue,
            };
            on.get_mut(zone as usize).into_iter().for_each(|on| *on = is_on);
        }
        on
    }

    /// Reads a recording. A truncated recording gives all its complete chunks.
    ///
    /// # Errors
    /// The file is not a recording, has another version, ends within its header, or is damaged.
    pub fn read(bytes: &[u8]) -> Result<Self, ReadError> {
        let mut chunks = Chunks::new(bytes)?;
        let first = chunks.next()?.ok_or(ReadError::NoHeader { bytes: bytes.len() })?;
        let mut recording = Self {
            header: header(&first)?,
            events: Vec::new(),
            decisions: Vec::new(),
            summary: None,
            cut: None,
            segments: Vec::new(),
        };
        let mut inflated = first.inflated_bytes();
        while let Some(chunk) = chunks.next()? {
            inflated += chunk.inflated_bytes();
            if inflated > MOST_INFLATED {
                return Err(ReadError::TooLarge { most: MOST_INFLATED });
            }
            recording.add(&chunk)?;
        }
        let rest = bytes.len() - chunks.at();
        recording.cut = (rest > 0 || recording.summary.is_none()).then_some(rest);
        Ok(recording)
    }

    fn add(&mut self, chunk: &Chunk) -> Result<(), ReadError> {
        let content = chunk.content()?;
        if self.summary.is_some() {
            return Err(chunk.damaged("comes after the end of the recording"));
        }
        let misfit = |problem: Box<Problem>| chunk.damaged(problem.to_string());
        match chunk.kind {
            Kind::Header => return Err(chunk.damaged("is a second header")),
            Kind::Events => {
                let Events { events } = json(chunk, &content)?;
                let tables = self.header.world.tables();
                events.iter().try_for_each(|(_, event)| tables.check_event(event)).map_err(misfit)?;
                check_steps(events.iter().map(|(step, _)| *step)).map_err(misfit)?;
                self.events.extend(events);
            }
            Kind::Decision => {
                let decided: TimedDecision = json(chunk, &content)?;
                decided.check(&self.header.world.tables()).map_err(misfit)?;
                check_steps([decided.step].into_iter()).map_err(misfit)?;
                self.decisions.push(decided);
            }
            Kind::Segment => {
                let world = &self.header.world;
                let segment = Segment::read(&content, world.robots.len(), world.rows());
                let segment = segment.ok().filter(|segment| segment.first_frame == self.frames());
                self.segments.push(segment.ok_or_else(|| chunk.damaged("does not hold the next frames"))?);
            }
            Kind::Summary => {
                let summary: TrialRecord = json(chunk, &content)?;
                self.header.world.tables().check_record(&summary).map_err(misfit)?;
                self.summary = Some(summary);
            }
        }
        Ok(())
    }

    /// Number of frames.
    pub fn frames(&self) -> usize {
        self.segments.last().map_or(0, |last| last.first_frame + last.frames)
    }

    /// The state at a frame, numbered from 0.
    ///
    /// # Errors
    /// The frame does not exist, or its numbers are invalid.
    pub fn frame(&self, number: usize) -> Result<Frame, ReadError> {
        let at = self.segments.partition_point(|segment| segment.first_frame <= number);
        let segment = at.checked_sub(1).map(|at| &self.segments[at]);
        let segment = segment.filter(|segment| number < segment.first_frame + segment.frames);
        let segment = segment.ok_or(ReadError::NoFrame { asked: number, frames: self.frames() })?;
        segment.frame(number - segment.first_frame, self.header.step_of(number)).map_err(|_| {
            ReadError::Damaged {
                chunk: at,
                kind: "SEGM".to_owned(),
                at: 0,
                reason: format!("frame {number} holds numbers that have no meaning"),
            }
        })
    }

    /// The events in words.
    pub fn told(&self) -> impl Iterator<Item = ToldEvent> + '_ {
        let Header { dt_s, world, .. } = &self.header;
        let tasks: Vec<&str> = world.tasks.iter().map(|task| task.name.as_str()).collect();
        self.events.iter().map(move |(step, event)| {
            let names = Names { tasks: &tasks, debris: &world.debris, zones: &world.zones };
            ToldEvent::new(*step, *dt_s, event, names)
        })
    }

    /// The number of the last frame at or before a simulated time in seconds. Times outside the recording
    /// give its first or its last frame.
    pub fn frame_at(&self, time_s: f64) -> usize {
        let Header { dt_s, first_step, steps_per_frame, .. } = self.header;
        let steps = (time_s / dt_s + 1e-6).floor() - first_step as f64;
        let frame = (steps / steps_per_frame as f64).floor().max(0.0) as usize;
        frame.min(self.frames().saturating_sub(1))
    }
}

fn check_steps(mut steps: impl Iterator<Item = u64>) -> Result<(), Box<Problem>> {
    let wrong = steps.find(|step| *step >= MOST_STEPS);
    wrong.map_or(Ok(()), |step| {
        Err(Box::new(Problem::new("step", format!("must be below {MOST_STEPS}"), step)))
    })
}

fn header(chunk: &Chunk) -> Result<Header, ReadError> {
    if chunk.kind != Kind::Header {
        return Err(chunk.damaged("must be the header"));
    }
    let content = chunk.content()?;
    let Version { version } = json(chunk, &content)?;
    if version != VERSION {
        return Err(ReadError::Version { found: version, expected: VERSION });
    }
    let header: Header = json(chunk, &content)?;
    let rows: Vec<usize> = header.streams.iter().map(|(_, rows)| *rows).collect();
    let streams = header.streams.iter().map(|(name, _)| name.as_str()).eq(STREAMS);
    let fields = header.motion_fields == Motion::NAMES;
    let is_known = streams && fields && header.codes.are_known();
    let is_timed = header.dt_s > 0.0 && header.dt_s < LONGEST_STEP_S && is_result(header.duration_s);
    let is_counted = is_timed
        && (1..MOST_STEPS).contains(&header.steps_per_frame)
        && header.first_step < MOST_STEPS
        && header.frames_per_segment > 0;
    let is_sound = is_counted && header.world.fits() && rows == header.world.rows();
    if is_known && is_sound { Ok(header) } else { Err(chunk.damaged("its tables do not fit each other")) }
}
