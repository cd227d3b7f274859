//! Writes a recording while a trial runs.

use std::io::{self, Write};

use serde::Serialize;
use teaming::{MadeMeasure, Session};
use usar_sim::event::Event;
use usar_sim::record::{DecisionRecord, TrialRecord};
use usar_sim::simulation::Simulation;

use crate::chunk::{ChunkWriter, Kind};
use crate::header::Header;
use crate::segment::Draft;
use crate::trust::Trust;

/// Default number of frames in a second of simulated time.
pub const DEFAULT_FPS: f64 = 10.0;

/// Simulated time of a segment, in seconds.
const SEGMENT_S: f64 = 30.0;

/// Compression level of chunks, from 1 to 9. Higher levels save a few percent, but slow the trial down too
/// much.
const LEVEL: u32 = 1;

/// Options of a recording.
#[derive(Debug, Clone)]
pub struct Options {
    /// Label of the policy.
    pub policy: String,
    /// The trust measure whose matrices are recorded at each decision; without one there are none.
    pub measure: Option<MadeMeasure>,
    /// Frames in a second of simulated time; at most one frame for each step.
    pub fps: f64,
}

impl Options {
    /// Options with [`DEFAULT_FPS`].
    pub fn new(policy: &str, measure: Option<MadeMeasure>) -> Self {
        Self { policy: policy.to_owned(), measure, fps: DEFAULT_FPS }
    }
}

#[derive(Serialize)]
struct Events<'e> {
    /// The events, each with the step at whose end it had happened.
    events: &'e [(u64, Event)],
}

#[derive(Serialize)]
struct TimedDecision<'d> {
    /// The step in which it was made.
    step: u64,
    #[serde(flatten)]
    decided: &'d DecisionRecord,
    trust: Option<Trust>,
}

/// Listens to a simulation and writes a recording.
pub struct Recorder<W> {
    out: ChunkWriter<W>,
    measure: Option<MadeMeasure>,
    steps_per_frame: u64,
    frames_per_segment: usize,
    next_frame: u64,
    draft: Draft,
    events: Vec<(u64, Event)>,
    decisions: usize,
}

impl<W: Write> Recorder<W> {
    /// Begins a recording with the current state.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn begin(out: W, simulation: &Simulation, options: &Options) -> io::Result<Self> {
        let dt_s = simulation.scenario().dt_s;
        let steps_per_frame = (1.0 / (options.fps * dt_s)).round().max(1.0) as u64;
        let frames_per_segment = (SEGMENT_S / (dt_s * steps_per_frame as f64)).round().max(1.0) as usize;
        let header = Header::of(simulation, &options.policy, steps_per_frame, frames_per_segment);
        let mut out = ChunkWriter::new(out, LEVEL)?;
        write_json(&mut out, Kind::Header, &header)?;
        let mut recorder = Self {
            out,
            measure: options.measure.clone(),
            steps_per_frame,
            frames_per_segment,
            next_frame: simulation.steps(),
            draft: Draft::new(header.world.robots.len(), header.world.rows()),
            events: Vec::new(),
            decisions: simulation.decisions().len(),
        };
        recorder.note_frame(simulation)?;
        Ok(recorder)
    }

    /// Records a step. Call it after each step.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn listen(&mut self, simulation: &Simulation) -> io::Result<()> {
        let step = simulation.steps();
        self.events.extend(simulation.events().iter().map(|event| (step, event.clone())));
        for decided in &simulation.decisions()[self.decisions..] {
            let trust = self.measure.as_ref().and_then(|measure| Trust::of(decided, measure));
            let timed = TimedDecision { step: step - 1, decided, trust };
            write_json(&mut self.out, Kind::Decision, &timed)?;
            self.decisions += 1;
        }
        self.note_frame(simulation)
    }

    fn note_frame(&mut self, simulation: &Simulation) -> io::Result<()> {
        if simulation.steps() < self.next_frame {
            return Ok(());
        }
        self.draft.push(simulation);
        self.next_frame += self.steps_per_frame;
        if self.draft.frames() == self.frames_per_segment { self.end_segment() } else { Ok(()) }
    }

    /// Writes the events since the last segment, and the segment.
    fn end_segment(&mut self) -> io::Result<()> {
        if !self.events.is_empty() {
            write_json(&mut self.out, Kind::Events, &Events { events: &self.events })?;
            self.events.clear();
        }
        if self.draft.frames() > 0 {
            let segment = self.draft.take();
            self.out.write(Kind::Segment, &segment)?;
        }
        self.out.flush()
    }

    /// Completes the recording with the record of the trial.
    ///
    /// # Errors
    /// It cannot be written.
    pub fn finish(mut self, record: &mut TrialRecord) -> io::Result<W> {
        self.end_segment()?;
        let decisions = std::mem::take(&mut record.decisions); // they are in the recording already
        let written = write_json(&mut self.out, Kind::Summary, record);
        record.decisions = decisions;
        written?;
        self.out.flush()?;
        Ok(self.out.into_inner())
    }
}

fn write_json(out: &mut ChunkWriter<impl Write>, kind: Kind, value: &impl Serialize) -> io::Result<()> {
    out.write(kind, &serde_json::to_vec(value)?)
}

/// Runs a trial to its end and records it. The result of the trial is the same as without a recording.
///
/// # Errors
/// The recording cannot be written.
pub fn record(
    mut simulation: Simulation,
    mut session: impl Session,
    options: &Options,
    out: impl Write,
) -> io::Result<TrialRecord> {
    let mut recorder = Recorder::begin(out, &simulation, options)?;
    while simulation.step(&mut session).is_none() {
        recorder.listen(&simulation)?;
    }
    let mut record = simulation.finish();
    recorder.finish(&mut record)?;
    Ok(record)
}
