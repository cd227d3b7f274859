//! A segment: the frames of some seconds. It begins with the whole state, so that it can be read without
//! earlier segments.

use usar_sim::simulation::Simulation;

use crate::frame::{
    Frame, GroupFrame, Motion, MovedDebris, RescueeFrame, RobotFrame, RobotState, Route, Stored, read_sets,
};
use crate::numbers::{NotNumbers, Numbers, write_signed, write_unsigned};
use crate::rows::{POSITIONS, RESCUEES, STREAMS, is_fixed, write_row};

/// A number that is stored in every frame, as the difference from its prediction by earlier frames.
#[derive(Default)]
struct Column {
    bytes: Vec<u8>,
    before: [i32; 2],
}

impl Column {
    fn push(&mut self, value: i32, frame: usize, is_position: bool) {
        let [last, before_last] = self.before.map(i64::from);
        let expected = match frame {
            0 => 0,
            1 => last,
            _ if is_position => 2 * last - before_last,
            _ => last,
        };
        write_signed(&mut self.bytes, i64::from(value) - expected);
        self.before = [value, self.before[0]];
    }
}

/// A row, with its changes and the frames in which they happened.
#[derive(Default)]
struct ChangingRow {
    bytes: Vec<u8>,
    entries: u64,
    changed_at: usize,
    now: Vec<i32>,
}

impl ChangingRow {
    fn note(&mut self, row: &[i32], frame: usize) {
        if self.entries > 0 && self.now == row {
            return;
        }
        write_unsigned(&mut self.bytes, (frame - self.changed_at) as u64);
        write_unsigned(&mut self.bytes, row.len() as u64);
        row.iter().for_each(|value| write_signed(&mut self.bytes, i64::from(*value)));
        (self.entries, self.changed_at) = (self.entries + 1, frame);
        self.now.clear();
        self.now.extend(row);
    }
}

/// A segment that is being written.
pub(crate) struct Draft {
    first_frame: usize,
    frames: usize,
    columns: Vec<Column>,
    rows: Vec<Vec<ChangingRow>>,
    /// The counts of changes of rescuees and of claims when the rescuees were last checked.
    rescuee_changes: Option<[u64; 2]>,
    row: Vec<i32>,
}

impl Draft {
    /// An empty segment of a world with this many robots and this many rows of each stream.
    pub(crate) fn new(robots: usize, rows: [usize; STREAMS.len()]) -> Self {
        let columns = || (0..robots * Motion::NAMES.len()).map(|_| Column::default()).collect();
        let stream = |rows: usize| (0..rows).map(|_| ChangingRow::default()).collect();
        Self {
            first_frame: 0,
            frames: 0,
            columns: columns(),
            rows: rows.map(stream).into(),
            rescuee_changes: None,
            row: Vec::new(),
        }
    }

    pub(crate) fn frames(&self) -> usize {
        self.frames
    }

    /// Adds the current state.
    pub(crate) fn push(&mut self, simulation: &Simulation) {
        for (robot, columns) in self.columns.chunks_exact_mut(Motion::NAMES.len()).enumerate() {
            self.row.clear();
            Motion::of(&simulation.world().robots[robot]).write(&mut self.row);
            for ((field, column), value) in columns.iter_mut().enumerate().zip(&self.row) {
                column.push(*value, self.frames, field < POSITIONS);
            }
        }
        let changes = Some([simulation.world().rescuees.changes(), simulation.mission().claims.changes()]);
        for (stream, rows) in self.rows.iter_mut().enumerate() {
            if stream == RESCUEES && self.rescuee_changes == changes {
                continue;
            }
            for (number, row) in rows.iter_mut().enumerate() {
                if row.entries > 0 && is_fixed(simulation, stream, number) {
                    continue;
                }
                self.row.clear();
                write_row(simulation, stream, number, &mut self.row);
                row.note(&self.row, self.frames);
            }
        }
        self.rescuee_changes = changes;
        self.frames += 1;
    }

    /// Returns the segment as bytes, and begins the next one.
    pub(crate) fn take(&mut self) -> Vec<u8> {
        let mut out = Vec::new();
        write_unsigned(&mut out, self.first_frame as u64);
        write_unsigned(&mut out, self.frames as u64);
        for column in &mut self.columns {
            out.append(&mut column.bytes);
        }
        for row in self.rows.iter_mut().flatten() {
            write_unsigned(&mut out, row.entries);
            out.append(&mut row.bytes);
            (row.entries, row.changed_at) = (0, 0);
        }
        self.first_frame += self.frames;
        (self.frames, self.rescuee_changes) = (0, None);
        out
    }
}

/// The frame from which a row has these numbers, and the numbers.
type Entry = (usize, Vec<i32>);

/// A segment that was read from a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Segment {
    pub(crate) first_frame: usize,
    pub(crate) frames: usize,
    columns: Vec<Vec<i32>>,
    rows: Vec<Vec<Vec<Entry>>>,
}

impl Segment {
    /// Reads the bytes of a segment of a world with this many robots and this many rows of each stream.
    pub(crate) fn read(
        bytes: &[u8],
        robots: usize,
        rows: [usize; STREAMS.len()],
    ) -> Result<Self, NotNumbers> {
        let mut numbers = Numbers::new(bytes);
        let first_frame = usize::try_from(numbers.unsigned()?).map_err(|_| NotNumbers)?;
        let frames = numbers.count()?;
        let count = robots.checked_mul(Motion::NAMES.len()).ok_or(NotNumbers)?;
        if frames == 0 || count.saturating_mul(frames) > numbers.left() {
            return Err(NotNumbers);
        }
        let column = |i: usize| read_column(&mut numbers, frames, i % Motion::NAMES.len() < POSITIONS);
        let columns = (0..count).map(column).collect::<Result<_, _>>()?;
        let mut stream = |rows: usize| (0..rows).map(|_| read_row(&mut numbers, frames)).collect();
        let read = rows.iter().map(|rows| stream(*rows)).collect::<Result<_, _>>()?;
        let segment = Self { first_frame, frames, columns, rows: read };
        if numbers.left() > 0 || segment.rows.len() != STREAMS.len() {
            return Err(NotNumbers);
        }
        segment.check_entries(rows)?;
        Ok(segment)
    }

    /// Checks that every entry is valid, so that every frame can be read, and names only robots, rescuees,
    /// debris and tasks that are there. A group may know of zones that are not there.
    fn check_entries(&self, counts: [usize; STREAMS.len()]) -> Result<(), NotNumbers> {
        let [robots, _, rescuees, debris, groups, _] = counts;
        let is_there = |numbers: &[Option<u32>], count: usize| {
            numbers.iter().flatten().all(|number| (*number as usize) < count)
        };
        for (stream, rows) in self.rows.iter().enumerate() {
            for (_, entry) in rows.iter().flatten() {
                let are_there = match stream {
                    0 => {
                        let RobotState { rescuee, waits_for, task, .. } = RobotState::read(entry)?;
                        is_there(&[rescuee], rescuees)
                            && is_there(&[waits_for], robots)
                            && is_there(&[task], groups - 1)
                    }
                    1 => Route::read(entry).map(|_| true)?,
                    RESCUEES => is_there(&[RescueeFrame::read(entry)?.robot], robots),
                    3 => MovedDebris::read(entry).map(|_| true)?,
                    4 => {
                        let known = GroupFrame::read(entry)?.debris;
                        known.iter().all(|(piece, _)| is_there(&[Some(*piece)], debris))
                    }
                    _ => read_sets(entry)?.iter().flatten().all(|robot| is_there(&[Some(*robot)], robots)),
                };
                if !are_there {
                    return Err(NotNumbers);
                }
            }
        }
        Ok(())
    }

    /// The state at a frame of this segment; frames are numbered from its first one.
    pub(crate) fn frame(&self, frame: usize, step: u64) -> Result<Frame, NotNumbers> {
        let [states, routes, rescuees, debris, groups, conflicts] = &self.rows[..] else {
            return Err(NotNumbers);
        };
        let now = |row: &Vec<Entry>| {
            let at = row.partition_point(|(from, _)| *from <= frame);
            at.checked_sub(1).map(|at| row[at].1.clone()).ok_or(NotNumbers)
        };
        let robot = |(number, columns): (usize, &[Vec<i32>])| {
            let motion: Vec<i32> = columns.iter().map(|column| column[frame]).collect();
            Ok(RobotFrame {
                motion: Motion::read(&motion)?,
                state: RobotState::read(&now(&states[number])?)?,
                route: Route::read(&now(&routes[number])?)?,
            })
        };
        let robots = self.columns.chunks_exact(Motion::NAMES.len()).enumerate().map(robot);
        Ok(Frame {
            step,
            robots: robots.collect::<Result<_, _>>()?,
            rescuees: rescuees.iter().map(|row| RescueeFrame::read(&now(row)?)).collect::<Result<_, _>>()?,
            debris: debris.iter().map(|row| MovedDebris::read(&now(row)?)).collect::<Result<_, _>>()?,
            groups: groups.iter().map(|row| GroupFrame::read(&now(row)?)).collect::<Result<_, _>>()?,
            conflict_sets: read_sets(&now(conflicts.first().ok_or(NotNumbers)?)?)?,
        })
    }
}

fn read_column(numbers: &mut Numbers, frames: usize, is_position: bool) -> Result<Vec<i32>, NotNumbers> {
    let mut values: Vec<i32> = Vec::with_capacity(frames);
    for frame in 0..frames {
        let back = |by: usize| i64::from(values[frame - by]);
        let expected = match frame {
            0 => 0,
            1 => back(1),
            _ if is_position => 2 * back(1) - back(2),
            _ => back(1),
        };
        let value = numbers.signed()?.checked_add(expected).ok_or(NotNumbers)?;
        values.push(i32::try_from(value).map_err(|_| NotNumbers)?);
    }
    Ok(values)
}

fn read_row(numbers: &mut Numbers, frames: usize) -> Result<Vec<Entry>, NotNumbers> {
    let entries = numbers.count()?;
    let mut row = Vec::new();
    let mut at = 0_usize;
    for _ in 0..entries {
        let gap = usize::try_from(numbers.unsigned()?).map_err(|_| NotNumbers)?;
        at = at.checked_add(gap).filter(|at| *at < frames).ok_or(NotNumbers)?;
        let length = numbers.count()?;
        row.push((at, (0..length).map(|_| numbers.small()).collect::<Result<_, _>>()?));
    }
    if row.first().is_some_and(|(at, _)| *at == 0) { Ok(row) } else { Err(NotNumbers) }
}
