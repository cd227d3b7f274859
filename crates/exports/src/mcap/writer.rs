//! The channels of a log.

use std::collections::BTreeMap;
use std::io::Write;

use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{WriteOptions, Writer};
use recording::Recording;
use schemars::JsonSchema;
use schemars::generate::SchemaSettings;
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::messages::{FrameTransforms, Log, PointCloud, SceneUpdate, nanoseconds};
use crate::error::ExportError;

/// The topic of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Channel {
    World,
    Debris,
    Robots,
    Transforms,
    Rescuees,
    Robot(usize),
    Team,
    Events,
}

/// A log that is being written.
pub(super) struct Channels<W: Write> {
    log: Writer<NoSeek<W>>,
    /// The number of each channel in the log, and its number of messages.
    channels: BTreeMap<Channel, (u16, u32)>,
}

/// The schema of a message. Subschemas are inlined, because not every reader follows references.
fn schema<T: JsonSchema>() -> Value {
    let settings = SchemaSettings::draft07().with(|settings| settings.inline_subschemas = true);
    settings.into_generator().into_root_schema_for::<T>().to_value()
}

/// The schema of an object with these properties, each with its type in JSON.
fn object(title: &str, properties: impl IntoIterator<Item = (String, Value)>) -> Value {
    json!({ "title": title, "type": "object", "properties": Map::from_iter(properties) })
}

fn typed(names: &[&str], kind: &str) -> Vec<(String, Value)> {
    names.iter().map(|name| ((*name).to_owned(), json!({ "type": kind }))).collect()
}

impl<W: Write> Channels<W> {
    /// Begins a log with the channels of a recording.
    pub(super) fn begin(out: W, recording: &Recording) -> Result<Self, ExportError> {
        let options = WriteOptions::new().disable_seeking(true).library(&recording.header.program);
        let log = options.create(NoSeek::new(out))?;
        let mut channels = Self { log, channels: BTreeMap::new() };
        let scene = schema::<SceneUpdate>();
        channels.add(Channel::World, "/world", ("foxglove.SceneUpdate", &scene))?;
        channels.add(Channel::Debris, "/debris", ("foxglove.SceneUpdate", &scene))?;
        channels.add(Channel::Robots, "/robots", ("foxglove.SceneUpdate", &scene))?;
        channels.add(
            Channel::Transforms,
            "/tf",
            ("foxglove.FrameTransforms", &schema::<FrameTransforms>()),
        )?;
        channels.add(Channel::Rescuees, "/rescuees", ("foxglove.PointCloud", &schema::<PointCloud>()))?;
        let world = &recording.header.world;
        let robot = robot_schema(world.needs.iter().map(|need| need.name.as_str()));
        for id in 0..world.robots.len() {
            channels.add(Channel::Robot(id), &format!("/robot/{id}"), ("usar.Robot", &robot))?;
        }
        let counts = ["round", "waiting", "claimed", "on_board", "delivered"];
        channels.add(
            Channel::Team,
            "/team",
            ("usar.Team", &object("usar.Team", typed(&counts, "integer"))),
        )?;
        channels.add(Channel::Events, "/events", ("foxglove.Log", &schema::<Log>()))?;
        Ok(channels)
    }

    fn add(
        &mut self,
        channel: Channel,
        topic: &str,
        (name, schema): (&str, &Value),
    ) -> Result<(), ExportError> {
        let schema = self.log.add_schema(name, "jsonschema", &serde_json::to_vec(schema)?)?;
        let id = self.log.add_channel(schema, topic, "json", &BTreeMap::new())?;
        self.channels.insert(channel, (id, 0));
        Ok(())
    }

    /// Writes a message with a time in seconds.
    pub(super) fn write(
        &mut self,
        channel: Channel,
        time_s: f64,
        message: &impl Serialize,
    ) -> Result<(), ExportError> {
        let Some((channel_id, sequence)) = self.channels.get_mut(&channel) else { return Ok(()) };
        let log_time = nanoseconds(time_s);
        let header =
            MessageHeader { channel_id: *channel_id, sequence: *sequence, log_time, publish_time: log_time };
        *sequence += 1;
        Ok(self.log.write_to_known_channel(&header, &serde_json::to_vec(message)?)?)
    }

    /// Ends the log.
    pub(super) fn finish(mut self) -> Result<W, ExportError> {
        self.log.finish()?;
        Ok(self.log.into_inner().into_inner())
    }
}

fn robot_schema<'n>(needs: impl Iterator<Item = &'n str>) -> Value {
    let mut properties = typed(&["energy_percent", "hp_percent", "speed_mps"], "number");
    properties.extend(typed(&["resources", "on_board", "waits_for"], "integer"));
    properties.extend(typed(&["activity", "delay", "task"], "string"));
    let needs = needs.map(|need| (need.to_owned(), json!({ "type": "number" })));
    properties.push(("needs".to_owned(), object("needs", needs)));
    object("usar.Robot", properties)
}
