#!/usr/bin/env python3
"""Public recordings as they are published enter; the CSV files that `holdover-sim` reads leave.

    recordings.py comma2k19 SEGMENT MOTION.csv             a segment's folder
    recordings.py cicv5g RUN.txt [--motion M.csv] [--channel C.csv]
    recordings.py openacc RUN.csv FOLDER                   a file for each vehicle: FOLDER/veh1.csv, the leader, and so on
    recordings.py tlssc RUN.csv FOLDER                     the same of a car by itself, or behind another
    recordings.py candump LOG --dbc holdover.dbc FOLDER    a log of a unit's bus: FOLDER/ego.csv, FOLDER/peer0.csv, ...

A drive has the columns t_s,position_m,speed_mps, a link t_s,delay_s, with an empty delay for a message that was lost. Times
begin at 0. README.md says where the recordings are to be had, and which of them the results use.
"""

import argparse
import csv
import re
import sys
from collections import defaultdict
from datetime import datetime
from pathlib import Path

import numpy as np

STAMPS_WRAP_S = 13.1072  # stamps on the bus are modulo this
POSITIONS_WRAP_M = 33554.432
TOGETHER_S = 0.05  # the frames of one message come within this
EARTH_M = 6_371_009.0  # mean radius


class Unusable(Exception):
    """A file that is not what it should be: the cause, and the remedy."""


def write(file, header, rows):
    Path(file).parent.mkdir(parents=True, exist_ok=True)
    with open(file, "w", newline="") as out:
        lines = csv.writer(out, lineterminator="\n")
        lines.writerow(header)
        lines.writerows(rows)
    print(f"{file}: {len(rows)} rows")


def write_motion(file, times_s, positions_m, speeds_mps):
    """The rows of which the time grows: a recorder writes some samples twice."""
    rows, last = [], -np.inf
    for t, position, speed in zip(times_s - times_s[0], positions_m - positions_m[0], speeds_mps):
        if t > last and np.isfinite([position, speed]).all():
            rows.append([f"{t:.3f}", f"{position:.3f}", f"{speed:.3f}"])
            last = t
    if len(rows) < 2:
        raise Unusable("has fewer than two samples; give a file with a drive in it")
    write(file, ["t_s", "position_m", "speed_mps"], rows)


def integral(times_s, speeds_mps):
    """The way from the speed, by trapezoids."""
    steps = np.diff(times_s) * (speeds_mps[1:] + speeds_mps[:-1]) / 2
    return np.concatenate([[0.0], np.cumsum(steps)])


def comma2k19(segment, motion):
    """Poses of the camera, frame by frame, in metres from the centre of the earth."""
    pose = Path(segment) / "global_pose"
    arrays = {}
    for name in ("frame_times", "frame_positions", "frame_velocities"):
        file = pose / name
        if not file.is_file():
            raise Unusable(f"has no global_pose/{name}; give the folder of a segment, such as Example_1/ROUTE/40")
        arrays[name] = np.load(file)
    times_s, positions = arrays["frame_times"], arrays["frame_positions"]
    way_m = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(positions, axis=0), axis=1))])
    write_motion(motion, times_s, way_m, np.linalg.norm(arrays["frame_velocities"], axis=1))


def cicv5g(run, motion, channel):
    """Messages of a vehicle that a cloud sent back: when published, when returned, and the vehicle's speed. The poses jitter
    by 0.3 m, so that the position is the integral of the speed."""
    lines = Path(run).read_text(encoding="utf-8", errors="replace").split("\n")
    columns = lines[0].split()
    wanted = ["pub_time(ms)", "delay(ms)", "velocity(m/s)"]
    absent = [name for name in wanted if name not in columns]
    if absent:
        raise Unusable(f"has no column {absent[0]}; give a run of the folder data/ as published")
    at = [columns.index(name) for name in wanted]
    rows = []
    for number, line in enumerate(lines[1:], start=2):
        fields = line.split()
        if not fields:
            continue
        try:
            rows.append([float(fields[index]) for index in at])
        except (IndexError, ValueError):
            raise Unusable(f"line {number} is no message: {line[:40]!r}; give the file as published") from None
    rows.sort(key=lambda row: row[0])
    table = np.array(rows)
    times_s = (table[:, 0] - table[0, 0]) / 1000
    if channel:
        # What never came back has no delay or a negative one.
        delays = [f"{delay / 1000:.3f}" if delay >= 0 else "" for delay in table[:, 1]]
        write(channel, ["t_s", "delay_s"], [[f"{t:.3f}", delay] for t, delay in zip(times_s, delays)])
    if motion:
        write_motion(motion, times_s, integral(times_s, table[:, 2]), table[:, 2])


def openacc(run, folder):
    """A platoon at 10 Hz: five lines about the run, a header, then for vehicle n the columns Speed n, E n, N n (metres to the east
    and north of a common centre). Positions are on one axis: the way of each, from where its antenna is behind the leader's."""
    with open(run, newline="", encoding="utf-8", errors="replace") as text:
        lines = list(csv.reader(text))
    header = next((index for index, line in enumerate(lines[:20]) if line and line[0].strip() == "Time"), None)
    if header is None:
        raise Unusable("has no header that begins with Time; give a file of OpenACC as published")
    names = [name.strip() for name in lines[header]]
    vehicles = sorted(int(found[1]) for found in map(re.compile(r"Speed(\d+)$").match, names) if found)
    rows = [line for line in lines[header + 1:] if len(line) == len(names)]
    column = lambda name: np.array([float(row[names.index(name)] or "nan") for row in rows])
    try:
        places = {n: np.stack([column(f"E{n}"), column(f"N{n}")]) for n in vehicles}
    except ValueError as error:
        raise Unusable(f"{error}; give a file of OpenACC as published") from None
    times_s = column("Time")
    speeds = {n: column(f"Speed{n}") for n in vehicles}
    # From the first moment at which all are known.
    known = np.all([np.isfinite(speeds[n]) & np.isfinite(places[n]).all(axis=0) for n in vehicles], axis=0)
    if not known.any():
        raise Unusable("never knows all vehicles at once; give another part of the run")
    first = int(np.argmax(known))
    gaps_m = [float(np.linalg.norm(places[n][:, first] - places[ahead][:, first])) for ahead, n in zip(vehicles, vehicles[1:])]
    write_platoon(folder, times_s[first:], {n: speeds[n][first:] for n in vehicles}, gaps_m)


def write_platoon(folder, times_s, speeds, gaps_m):
    """The drives of vehicles that follow one another, by their numbers, on one axis that begins where the last one does. `gaps_m` is how
    far each is behind the one ahead at the first moment."""
    starts_m = np.cumsum([0.0, *gaps_m])
    for (n, speed), behind_m in zip(speeds.items(), starts_m):
        ok = np.isfinite(speed)
        t = times_s[ok] - times_s[0]
        rows = zip(t, integral(t, speed[ok]) + starts_m[-1] - behind_m, speed[ok])
        write(Path(folder) / f"veh{n}.csv", ["t_s", "position_m", "speed_mps"], [[f"{x:.3f}" for x in row] for row in rows])


def tlssc(run, folder):
    """A car with Tesla's control for traffic lights and stop signs, at 10 Hz, as its receiver had it and not as smoothed. A file of one
    car has the columns Time, Latitude, Longitude and Speed; one of two has the last three with _lead and with _follow."""
    with open(run, newline="", encoding="utf-8-sig", errors="replace") as text:
        reader = csv.DictReader(text)
        names = reader.fieldnames or []
        vehicles = ["_lead", "_follow"] if "Speed_lead" in names else [""]
        wanted = ["Time", *(name + vehicle for vehicle in vehicles for name in ("Latitude", "Longitude", "Speed"))]
        absent = [name for name in wanted if name not in names]
        if absent:
            raise Unusable(f"has no column {absent[0]}; give a file of TLSSC-V as published")
        rows = []
        for line in reader:
            try:
                rows.append([clock_s(line["Time"]), *(float(line[name] or "nan") for name in wanted[1:])])
            except (TypeError, ValueError):
                raise Unusable(f"line {reader.line_num} is no sample; give the file as published") from None
    table = np.array(sorted(rows, key=lambda row: row[0]))
    known = np.flatnonzero(np.isfinite(table).all(axis=1)) if rows else []
    if len(known) < 2:
        raise Unusable("has fewer than two samples; give a file with a drive in it")
    table = table[known[0]:]
    table = table[np.concatenate([[True], np.diff(table[:, 0]) > 0])]
    first = np.radians(table[0, 1:])
    gaps_m = []
    if len(vehicles) == 2:
        north, east = first[3] - first[0], (first[4] - first[1]) * np.cos(first[0])
        gaps_m = [EARTH_M * float(np.hypot(north, east))]
    write_platoon(folder, table[:, 0], {n + 1: table[:, 3 * n + 3] for n in range(len(vehicles))}, gaps_m)


def clock_s(text):
    """A date and time with its offset: year first, or day first as files of one car have it."""
    if re.match(r"\d\d-", text):
        return datetime.strptime(text, "%d-%m-%Y %H:%M:%S.%f %z").timestamp()
    return datetime.fromisoformat(text).timestamp()


def frames(log):
    """Time, identifier and data of each frame of a candump log."""
    for number, line in enumerate(Path(log).read_text().splitlines(), start=1):
        found = re.match(r"\((\d+\.\d+)\) \S+ ([0-9A-Fa-f]+)#([0-9A-Fa-f]*)", line)
        if found:
            yield float(found[1]), int(found[2], 16), bytes.fromhex(found[3])
        elif line.strip() and "##" not in line and "#R" not in line:
            raise Unusable(f"line {number} is no frame; give a log of candump -l")


def motions(log, database):
    """By sender: arrival, stamp, position and speed of each message, whose two frames have one tag."""
    names = {message.frame_id: message for message in database.messages if re.fullmatch(r"(Ego|Peer\d+)Motion[AB]", message.name)}
    halves, found = {}, defaultdict(list)
    for at_s, identifier, data in frames(log):
        message = names.get(identifier)
        if message is None or len(data) != message.length:
            continue
        signals = message.decode(data, decode_choices=False)
        sender, half = message.name[:-len("MotionX")].lower(), message.name[-1]
        if half == "A":
            halves[sender] = (at_s, signals)
        elif sender in halves:
            came_s, first = halves.pop(sender)
            if first["Tag"] == signals["Tag"] and at_s - came_s < TOGETHER_S:
                found[sender].append((came_s, float(first["Stamp"]), float(first["Position"]), float(signals["Speed"])))
    return found


def unwrapped(values, period):
    """Values that count modulo a period, made to go on."""
    steps = (np.diff(values) + period / 2) % period - period / 2
    return values[0] + np.concatenate([[0.0], np.cumsum(steps)])


def candump(log, dbc, folder):
    """What a unit's modem and vehicle put on the bus: the drive of each, and the delay of each peer's messages."""
    import cantools

    found = motions(log, cantools.database.load_file(dbc))
    if "ego" not in found:
        raise Unusable("has no EgoMotionA and EgoMotionB; give a log of a unit's bus, and the DBC file of its identifiers")
    # The ego's own motion is on the bus at once, so it tells how the clock of the log and that of the stamps differ.
    own = np.array(found["ego"])
    offset_s = np.min(unwrapped((own[:, 0] - own[:, 1]) % STAMPS_WRAP_S, STAMPS_WRAP_S))
    for sender, messages in sorted(found.items()):
        table = np.array(messages)
        stamps_s = unwrapped(table[:, 1], STAMPS_WRAP_S)
        order = np.argsort(stamps_s, kind="stable")
        ways_m = unwrapped(table[:, 2], POSITIONS_WRAP_M)
        if len(messages) > 1:
            write_motion(Path(folder) / f"{sender}.csv", stamps_s[order], ways_m[order], table[order, 3])
        if sender == "ego":
            continue
        delays_s = (table[:, 0] - table[:, 1] - offset_s + STAMPS_WRAP_S / 2) % STAMPS_WRAP_S - STAMPS_WRAP_S / 2
        write(Path(folder) / f"{sender}_link.csv", ["t_s", "delay_s"], link(stamps_s[order], np.maximum(delays_s[order], 0)))


def link(stamps_s, delays_s):
    """The rows of a link. Where stamps are several usual intervals apart, the messages between them were lost."""
    rows, every_s = [], float(np.median(np.diff(stamps_s))) if len(stamps_s) > 1 else np.inf
    for index, (stamp_s, delay_s) in enumerate(zip(stamps_s, delays_s)):
        if index > 0:
            lost = round((stamp_s - stamps_s[index - 1]) / every_s) - 1
            rows += [[f"{stamps_s[index - 1] + n * every_s - stamps_s[0]:.4f}", ""] for n in range(1, lost + 1)]
        rows.append([f"{stamp_s - stamps_s[0]:.4f}", f"{delay_s:.4f}"])
    return rows


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    kinds = parser.add_subparsers(dest="kind", required=True)
    kind = kinds.add_parser("comma2k19")
    kind.add_argument("segment"), kind.add_argument("motion")
    kind = kinds.add_parser("cicv5g")
    kind.add_argument("run"), kind.add_argument("--motion"), kind.add_argument("--channel")
    kind = kinds.add_parser("openacc")
    kind.add_argument("run"), kind.add_argument("folder")
    kind = kinds.add_parser("tlssc")
    kind.add_argument("run"), kind.add_argument("folder")
    kind = kinds.add_parser("candump")
    kind.add_argument("log"), kind.add_argument("--dbc", required=True), kind.add_argument("folder")
    given = vars(parser.parse_args(arguments))
    convert = globals()[given.pop("kind")]
    source = next(given[name] for name in ("segment", "run", "log") if name in given)
    try:
        convert(**given)
    except Unusable as cause:
        sys.exit(f"error: {source}: {cause}")
    except OSError as cause:
        sys.exit(f"error: {cause.filename or source}: {cause.strerror}; check the path")


if __name__ == "__main__":
    main(sys.argv[1:])
