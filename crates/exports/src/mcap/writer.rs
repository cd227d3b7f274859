//! The channels of a log.

use std::collections::BTreeMap;
use std::io::Write;

use foxglove::messages::{FrameTransforms, Log, PointCloud, SceneUpdate};
use foxglove::{Encode, Schema};
use mcap::records::MessageHeader;
use mcap::write::NoSeek;
use mcap::{WriteOptions, Writer};
use recording::Recording;
use serde_json::{Map, Value, json};

use super::messages::nanoseconds;
use crate::error::ExportError;

/// The topic of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Channel {
    World,
    Debris,
    Radiation,
    Robots,
    Transforms,
    Positions,
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

/// The schema of messages like this one.
fn schema_of(title: &str, message: &Value) -> Value {
    let kind = |(name, value): (&String, &Value)| match value {
        Value::Object(_) => schema_of(name, value),
        Value::Number(number) if number.is_f64() => json!({ "type": "number" }),
        Value::Number(_) => json!({ "type": "integer" }),
        _ => json!({ "type": "string" }),
    };
    let properties = message.as_object().into_iter().flatten();
    let properties: Map<_, _> = properties.map(|field| (field.0.clone(), kind(field))).collect();
    json!({ "title": title, "type": "object", "properties": properties })
}

impl<W: Write> Channels<W> {
    /// Begins a log with the channels of Foxglove's messages.
    pub(super) fn begin(out: W, recording: &Recording) -> Result<Self, ExportError> {
        let options = WriteOptions::new().disable_seeking(true).library(&recording.header.program);
        let log = options.create(NoSeek::new(out))?;
        let mut channels = Self { log, channels: BTreeMap::new() };
        channels.add_foxglove::<SceneUpdate>(Channel::World, "/world")?;
        channels.add_foxglove::<SceneUpdate>(Channel::Debris, "/debris")?;
        channels.add_foxglove::<SceneUpdate>(Channel::Radiation, "/radiation")?;
        channels.add_foxglove::<SceneUpdate>(Channel::Robots, "/robots")?;
        channels.add_foxglove::<FrameTransforms>(Channel::Transforms, "/tf")?;
        channels.add_foxglove::<PointCloud>(Channel::Positions, "/positions")?;
        channels.add_foxglove::<PointCloud>(Channel::Rescuees, "/rescuees")?;
        channels.add_foxglove::<Log>(Channel::Events, "/events")?;
        Ok(channels)
    }

    fn add_foxglove<M: Encode>(&mut self, channel: Channel, topic: &str) -> Result<(), ExportError> {
        let Some(Schema { name, encoding, data }) = M::get_schema() else { return Ok(()) };
        let schema = self.log.add_schema(&name, &encoding, &data)?;
        self.add(channel, schema, topic, &M::get_message_encoding())
    }

    /// Adds a channel for messages of our own like this one.
    pub(super) fn add_json(
        &mut self,
        channel: Channel,
        topic: &str,
        name: &str,
        message: &Value,
    ) -> Result<(), ExportError> {
        let schema = serde_json::to_vec(&schema_of(name, message))?;
        let schema = self.log.add_schema(name, "jsonschema", &schema)?;
        self.add(channel, schema, topic, "json")
    }

    fn add(&mut self, channel: Channel, schema: u16, topic: &str, encoding: &str) -> Result<(), ExportError> {
        let id = self.log.add_channel(schema, topic, encoding, &BTreeMap::new())?;
        self.channels.insert(channel, (id, 0));
        Ok(())
    }

    /// Writes a message of Foxglove's, with a time in seconds.
    pub(super) fn write<M: Encode>(
        &mut self,
        channel: Channel,
        time_s: f64,
        message: &M,
    ) -> Result<(), ExportError> {
        let mut bytes = Vec::new();
        message.encode(&mut bytes).map_err(|error| ExportError::Message(error.to_string()))?;
        self.write_bytes(channel, time_s, &bytes)
    }

    /// Writes a message of our own, with a time in seconds.
    pub(super) fn write_json(
        &mut self,
        channel: Channel,
        time_s: f64,
        message: &Value,
    ) -> Result<(), ExportError> {
        self.write_bytes(channel, time_s, &serde_json::to_vec(message)?)
    }

    fn write_bytes(&mut self, channel: Channel, time_s: f64, bytes: &[u8]) -> Result<(), ExportError> {
        let Some((channel_id, sequence)) = self.channels.get_mut(&channel) else { return Ok(()) };
        let log_time = nanoseconds(time_s);
        let header =
            MessageHeader { channel_id: *channel_id, sequence: *sequence, log_time, publish_time: log_time };
        *sequence += 1;
        Ok(self.log.write_to_known_channel(&header, bytes)?)
    }

    /// Ends the log.
    pub(super) fn finish(mut self) -> Result<W, ExportError> {
        self.log.finish()?;
        Ok(self.log.into_inner().into_inner())
    }
}
