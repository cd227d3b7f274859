"""Reads what .ci/exports wrote: an MCAP log against the table of robots, and each Parquet file against its CSV."""

import csv
import json
import pathlib
import sys

import pyarrow
import pyarrow.parquet
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

place = pathlib.Path(sys.argv[1])


def rows(path):
    with open(path, newline="") as table:
        return list(csv.DictReader(table))


def check_log():
    robots = {(round(float(row["time_s"]) * 1e9), int(row["robot"])): row for row in rows(place / "trial-robots.csv")}
    topics = {}
    decoders = DecoderFactory()
    with open(place / "trial.mcap", "rb") as log:
        for schema, channel, message in make_reader(log, validate_crcs=True).iter_messages():
            topics[channel.topic] = topics.get(channel.topic, 0) + 1
            if schema.name.startswith("foxglove."):
                told = decoders.decoder_for(channel.message_encoding, schema)(message.data)
            else:
                assert schema.encoding == "jsonschema" and json.loads(schema.data)["type"] == "object"
                told = json.loads(message.data)
            if channel.topic == "/tf":
                for robot, transform in enumerate(told.transforms):
                    row = robots[message.log_time, robot]
                    place_m = [transform.translation.x, transform.translation.y]
                    assert place_m == [float(row["x_m"]), float(row["y_m"])], (row, transform)
            if channel.topic.startswith("/robot/"):
                row = robots[message.log_time, int(channel.topic.rsplit("/", 1)[1])]
                assert told["energy_percent"] == float(row["energy_percent"]), row
                assert told["activity"] == row["activity"], row
    assert sum(count for topic, count in topics.items() if topic.startswith("/robot/")) == len(robots)
    assert topics["/events"] == len(rows(place / "trial-events.csv")), topics
    assert {"/world", "/debris", "/radiation", "/robots", "/positions", "/rescuees", "/team"} <= topics.keys(), topics
    return sum(topics.values())


def text(value):
    if isinstance(value, bool):
        return str(value).lower()
    return "" if value is None else value


def check_table(path, kind):
    table = pyarrow.parquet.read_table(path)
    expected = rows(kind)
    assert table.num_rows == len(expected), path
    for name in table.column_names:
        column = table[name]
        is_text = pyarrow.types.is_string(column.type) or pyarrow.types.is_boolean(column.type)
        for found, row in zip(column.to_pylist(), expected):
            cell = row[name]
            same = text(found) == cell if is_text or cell == "" else found == float(cell) or found == int(cell)
            assert same or found is None and cell == "", (path, name, found, cell)
    return table.num_rows


messages = check_log()
tables = [(path, path.with_suffix(".csv")) for path in [*place.glob("trial-*.parquet"), *place.glob("sweep/*.parquet")]]
assert len(tables) == 11, tables
count = sum(check_table(path, kind) for path, kind in tables)
print(f"exports: {messages} messages and {count} rows of {len(tables)} Parquet files are what the CSV tables have")
