//! Exports of a recorded trial, read back by the libraries of their formats.

use std::collections::BTreeMap;
use std::io::Write;
use std::path::Path;

use exports::parquet::from_csv;
use exports::{ExportError, mcap};
use foxglove::Decode;
use foxglove::messages::{FrameTransforms, PointCloud, SceneEntity, SceneUpdate};
use parquet::file::metadata::RowGroupMetaData;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use recording::{Options, Recording, Table, record};
use scenario::Scenario;
use serde_json::Value;
use tables::{About, Kind};
use usar_sim::simulation::Simulation;

fn recorded(file: &str, duration_s: f64) -> Recording {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenarios").join(file);
    let (scenario, _) = Scenario::load(&path).unwrap();
    let mut file = (*scenario).clone();
    file.duration_s = duration_s;
    let simulation = Simulation::new(&Scenario::try_from(file).unwrap(), 1).unwrap();
    let mut policy = policies::standard().open("RNE").unwrap();
    let mut bytes = Vec::new();
    record(
        simulation,
        &mut *policy,
        &Options::new("RNE", policies::standard().measure("RNE").ok()),
        &mut bytes,
    )
    .unwrap();
    Recording::read(&bytes).unwrap()
}

/// The messages of each topic, with their times in nanoseconds.
fn messages(log: &[u8]) -> BTreeMap<String, Vec<(u64, Vec<u8>)>> {
    let mut topics: BTreeMap<String, Vec<(u64, Vec<u8>)>> = BTreeMap::new();
    for message in ::mcap::MessageStream::new(log).unwrap() {
        let message = message.unwrap();
        let (channel, schema) = (&message.channel, message.channel.schema.as_ref().unwrap());
        let encodings = (channel.message_encoding.as_str(), schema.encoding.as_str());
        let is_foxglove = schema.name.starts_with("foxglove.");
        assert_eq!(encodings, if is_foxglove { ("protobuf", "protobuf") } else { ("json", "jsonschema") });
        topics.entry(channel.topic.clone()).or_default().push((message.log_time, message.data.to_vec()));
    }
    topics
}

#[test]
fn a_log_has_what_the_recording_has() {
    let recording = recorded("paper.ron", 60.0);
    let log = mcap::write(&recording, 5, Vec::new()).unwrap();
    assert_eq!(log, mcap::write(&recording, 5, Vec::new()).unwrap());
    let topics = messages(&log);
    let frames = recording.frames().div_ceil(5);
    assert_eq!(topics["/tf"].len(), frames);
    assert_eq!(topics["/events"].len(), recording.events.len());
    assert_eq!(topics["/world"].len(), 1);
    for (place, number) in (0..recording.frames()).step_by(5).enumerate() {
        let frame = recording.frame(number).unwrap();
        let (time, transforms) = &topics["/tf"][place];
        let transforms = FrameTransforms::decode(&**transforms).unwrap().transforms;
        assert_eq!(*time, (recording.header.time_s_of(number) * 1e9).round() as u64);
        for (id, robot) in frame.robots.iter().enumerate() {
            let transform = &transforms[id];
            assert_eq!(transform.child_frame_id, format!("robot/{id}"));
            let x = f64::from(robot.motion.position_mm[0]) / 1000.0;
            assert_eq!(transform.translation.unwrap().x.to_bits(), x.to_bits());
            let (_, told) = &topics[&format!("/robot/{id}")][place];
            let told: Value = serde_json::from_slice(told).unwrap();
            assert_eq!(told["energy_percent"], f64::from(robot.motion.energy_millipercent) / 1000.0);
            assert_eq!(told["needs"].as_object().unwrap().len(), recording.header.world.needs.len());
        }
    }
    let cloud = PointCloud::decode(&*topics["/rescuees"][0].1).unwrap();
    assert_eq!((cloud.point_stride, cloud.data.len()), (13, 13 * recording.header.world.rescuees.len()));
    let cloud = PointCloud::decode(&*topics["/positions"][0].1).unwrap();
    assert_eq!((cloud.point_stride, cloud.data.len()), (16, 16 * recording.header.world.robots.len()));
    let summary = ::mcap::Summary::read(&log).unwrap().unwrap();
    let names: Vec<&str> = summary.schemas.values().map(|schema| schema.name.as_str()).collect();
    for name in [
        "foxglove.SceneUpdate",
        "foxglove.FrameTransforms",
        "foxglove.PointCloud",
        "foxglove.Log",
        "usar.Robot",
    ] {
        assert!(names.contains(&name), "{names:?}");
    }
}

/// Names of the entities of each message of a topic, each with whether something of it is drawn.
fn drawn(topic: &[(u64, Vec<u8>)]) -> Vec<Vec<(String, bool)>> {
    let entity = |entity: SceneEntity| {
        let is_drawn =
            !(entity.cubes.is_empty() && entity.cylinders.is_empty() && entity.triangles.is_empty());
        (entity.id, is_drawn)
    };
    let names = |data: &[u8]| SceneUpdate::decode(data).unwrap().entities.into_iter().map(entity).collect();
    topic.iter().map(|(_, data)| names(data)).collect()
}

#[test]
fn debris_that_falls_and_radiation_that_appears_are_drawn_from_then_on() {
    let recording = recorded("gallery/collapse.ron", 300.0);
    let topics = messages(&mcap::write(&recording, 5, Vec::new()).unwrap());
    let world = &recording.header.world;
    let slab = format!("debris/{}", world.debris_later[0]);
    let debris = drawn(&topics["/debris"]);
    assert_eq!(debris[0].len(), world.debris.len());
    assert!(debris[0].contains(&(slab.clone(), false)));
    assert!(debris[1..].concat().contains(&(slab, true)));
    let zone = format!("radiation/{}", world.zones_later[0]);
    let radiation = drawn(&topics["/radiation"]);
    assert!(radiation[0].contains(&(zone.clone(), false)));
    assert!(radiation[1..].concat().contains(&(zone, true)));
}

#[test]
fn tables_are_tidy_and_parquet_has_the_same_cells() {
    let recording = recorded("three-tasks.ron", 60.0);
    let world = &recording.header.world;
    for table in Table::ALL {
        let csv = table.write_csv::<_, ExportError>(&recording, 10, Vec::new()).unwrap();
        let columns = table.columns(&world.needs);
        let mut reader = csv::Reader::from_reader(&*csv);
        let header = reader.headers().unwrap().clone();
        assert!(header.iter().eq(columns.iter().map(|about| about.name.as_str())), "{header:?}");
        let rows: Vec<csv::StringRecord> = reader.records().map(Result::unwrap).collect();
        let frames = recording.frames().div_ceil(10);
        let expected = match table {
            Table::Robots => frames * world.robots.len(),
            Table::Groups => frames * world.tasks.len(),
            Table::Events => recording.events.len(),
            Table::Decisions => {
                recording.decisions.iter().map(|decided| decided.question.members.len()).sum()
            }
        };
        assert_eq!(rows.len(), expected, "{}", table.name());
        let written = from_csv(&*csv, &columns, Vec::new()).unwrap();
        assert_eq!(written, from_csv(&*csv, &columns, Vec::new()).unwrap(), "the same bytes every time");
        let mut file = tempfile::tempfile().unwrap();
        file.write_all(&written).unwrap();
        let read = SerializedFileReader::new(file).unwrap();
        for (row, cells) in read.get_row_iter(None).unwrap().zip(&rows) {
            for (((name, field), cell), about) in row.unwrap().get_column_iter().zip(cells).zip(&columns) {
                let is_same = match (about.kind, field) {
                    (_, Field::Null) => cell.is_empty(),
                    (Kind::Natural, Field::ULong(value)) => value.to_string() == cell,
                    (Kind::Number, Field::Double(value)) => value.to_string() == cell,
                    (Kind::Truth, Field::Bool(value)) => value.to_string() == cell,
                    (Kind::Text, Field::Str(value)) => value == cell,
                    _ => false,
                };
                assert!(is_same, "{}: {name}: {field:?}, {cell:?}", table.name());
            }
        }
        assert_eq!(read.metadata().file_metadata().num_rows() as usize, rows.len());
    }
}

#[test]
fn a_cell_that_is_not_of_its_kind_is_named() {
    let table = "a,b\n1,2\n,x\n";
    let columns = ["a", "b"].map(|name| About::new(name, Kind::Natural, "", ""));
    let error = from_csv(table.as_bytes(), &columns, Vec::new()).unwrap_err();
    assert!(matches!(error, ExportError::Cell { row: 2, .. }), "{error}");
    assert_eq!(error.to_string(), "row 2: column b: must be a whole number, found \"x\"");
}

#[test]
fn the_rows_of_a_case_are_row_groups_of_their_own() {
    let table = "case,x\n1,0.5\n1,1.5\n2,2.5\n3,3.5\n3,4.5\n3,5.5\n";
    let columns = ["case", "x"].map(|name| About::new(name, Kind::Number, "", ""));
    let written = from_csv(table.as_bytes(), &columns, Vec::new()).unwrap();
    let mut file = tempfile::tempfile().unwrap();
    file.write_all(&written).unwrap();
    let read = SerializedFileReader::new(file).unwrap();
    let rows: Vec<i64> = read.metadata().row_groups().iter().map(RowGroupMetaData::num_rows).collect();
    assert_eq!(rows, [2, 1, 3]);
}
