#!/usr/bin/env python3
"""An MCAP file as the official reader reads it, beside the CSV of the same run: two files enter; the first difference leaves, or nothing.

    mcap_check.py RUN.mcap RUN.csv
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


def main():
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
