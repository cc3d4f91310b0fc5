#!/usr/bin/env python3
"""An MCAP file as the official reader reads it, beside the CSV of the same run: two files enter; the first difference leaves, or nothing.

    mcap_check.py RUN.mcap RUN.csv
    mcap_check.py RUN.mcap TRAJECTORIES.csv roads
"""

import csv
import json
import sys

from mcap.reader import make_reader


def same(value, field):
    if field == "" or value is None:
        return field == "" and value is None
    if isinstance(value, (bool, str)):
        return str(int(value) if isinstance(value, bool) else value) == field
    return abs(value - float(field)) <= 5.1e-7


def of_roads(messages, table):
    """The file of a corridor beside the table of its trajectories, which has a row of a vehicle every tick."""
    rows = {(round(float(row["t_s"]), 3), int(row["vehicle"])): row for row in csv.DictReader(table)}
    pairs = {"speed_mps": "speed_mps", "position_m": "position_m", "command_mps2": "command_mps2", "mode": "mode", "limited": "limited",
             "age_s": "age_s", "target_position_m": "estimated_position_m", "lowest_position_m": "lowest_position_m",
             "highest_position_m": "highest_position_m", "target_speed_mps": "estimated_speed_mps"}
    seen = fixes = 0
    for schema, channel, message in messages:
        values = json.loads(message.data)
        if values.keys() != json.loads(schema.data)["properties"].keys():
            sys.exit(f"{channel.topic}: {values.keys()} are not those of the schema")
        if channel.topic.endswith("/fix"):
            fixes += 1
            if not (37.7 < values["latitude"] < 37.9 and -122.5 < values["longitude"] < -122.3):
                sys.exit(f"{channel.topic}: {values} is not in San Francisco")
            continue
        seen += 1
        row = rows[round(values["t_s"], 3), values["trip"]]
        for name, column in pairs.items():
            if not same(values[name], row[column]):
                sys.exit(f"{channel.topic} at {values['t_s']}: {name} is {values[name]} in the MCAP file and {row[column]} in the CSV")
    if not seen == fixes == len(rows) > 1000:
        sys.exit(f"{seen} messages and {fixes} places of {len(rows)} rows")
    print(f"{seen} messages and as many places, with the figures of the trajectories")


def main():
    if sys.argv[3:] == ["roads"]:
        with open(sys.argv[1], "rb") as file, open(sys.argv[2], newline="", encoding="utf-8") as table:
            of_roads(make_reader(file).iter_messages(), table)
        return
    counts = {}
    with open(sys.argv[1], "rb") as file, open(sys.argv[2], newline="", encoding="utf-8") as table:
        rows = csv.DictReader(table)
        for schema, channel, message in make_reader(file).iter_messages():
            counts[channel.topic] = counts.get(channel.topic, 0) + 1
            values = json.loads(message.data)
            strangers = values.keys() - json.loads(schema.data)["properties"].keys()
            if strangers:
                sys.exit(f"{channel.topic}: {strangers} are not in the schema")
            if channel.topic == "/measured":
                row = next(rows)
                for name, field in row.items():
                    if not same(values[name], field):
                        sys.exit(f"line {rows.line_num}: {name} is {values[name]} in the MCAP file and {field} in the CSV")
        if next(rows, None) is not None or len(set(counts.values())) != 1:
            sys.exit(f"not every tick is in every channel: {counts}")
    print(f"{len(counts)} channels of {counts['/measured']} messages, with the figures of the CSV")


main()
