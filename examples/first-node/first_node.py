#!/usr/bin/env python3
"""A first node: everything around one holdover unit on a CAN bus, in half a minute.

The program is the vehicle (EgoMotion, DriverRequest), its modem (TimeSync, TimeFollowUp), and one vehicle ahead that the
modem hears (Peer0Motion, Peer0DrivingParameters). It knows the unit by `holdover.dbc` alone, or over CAN FD (`--fd`) by
`holdover-fd.dbc`. It engages the unit and moves its vehicle as the unit commands. The vehicle ahead begins to accelerate,
falls silent for 16.5 s, and speaks again. So the unit goes from standby to cooperative, holdover, fallback and back. The
program prints what it saw.

    pip install -r examples/first-node/requirements.txt
    holdover-sim ecu --bus vcan0 --station 1 &
    python3 examples/first-node/first_node.py --channel vcan0
    kill $!

Exit code: 0 all was as it should be; 1 something was not, and the last lines say what; 3 so too, but this program was late
itself, so that it says nothing of the unit. docs/FIRST-NODE.md explains it all.
"""

from __future__ import annotations

import argparse
import math
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import can
import cantools
from e2e.p01 import e2e_p01_check, e2e_p01_protect
from e2e.p05 import e2e_p05_check, e2e_p05_protect

ROOT = Path(__file__).resolve().parents[2]
Signals = dict[str, Any]

# GNSS time counts from 1980-01-06 and has no leap seconds; UTC has had 18 since. It goes on by a clock that never steps.
EPOCH = time.time() - 315_964_800 + 18 - time.monotonic()

# What happens, and when: seconds since the first frame.
ENGAGE, FASTER, SILENT, BACK, RELEASE, END = 2.0, 7.0, 8.0, 24.5, 28.5, 29.5
PERIOD = 0.010  # s: that of EgoMotion, and of the unit
LATE = 0.025  # s: at twice that the unit rightly takes its vehicle's motion for lost
STATION, PEER_STATION = 1, 7  # the unit's own name, as it is configured, and that of the vehicle ahead
CRUISE, WANTED = 12.0, 14.0  # m/s: the speed of both vehicles at first, and what the vehicle ahead wants later
LENGTH, LAG, TIME_GAP, STANDSTILL = 4.8, 0.3, 1.6, 2.0  # m, s, s, m: of both vehicles


# 1. The bus. Every frame has AUTOSAR E2E Profile 1A: a checksum in byte 0, a counter, 0 to 14, in the low half of byte 1. Over CAN FD
#    it is Profile 5: a checksum in bytes 0 and 1, a counter, 0 to 255, in byte 2. The DBC's attributes have the data id, the
#    cycle time and the timeout of each message.
class Bus:
    """Messages of the DBC by name: signals enter and leave, protected and checked."""

    def __init__(self, bus: can.BusABC, dbc: Any, fd: bool) -> None:
        self.bus, self.dbc, self.fd = bus, dbc, fd
        self.protect, self.check = (e2e_p05_protect, e2e_p05_check) if fd else (e2e_p01_protect, e2e_p01_check)
        self.counters = 256 if fd else 15
        self.most_lost = "E2EMaxDeltaCounter" if fd else "E2EMaxDeltaCounterInit"
        self.of_unit = {message.frame_id: message for message in dbc.messages if "Unit" in message.senders}
        bus.set_filters([{"can_id": i, "can_mask": 0x7FF, "extended": False} for i in self.of_unit])
        self.next_counter: dict[str, int] = {}  # of what we send
        self.last_counter: dict[str, int] = {}  # of what the unit sends
        self.received = self.broken = self.gaps = 0

    def attribute(self, message: str, name: str) -> int:
        return int(self.dbc.get_message_by_name(message).dbc.attributes[name].value)

    def maximum(self, message: str, signal: str) -> float:
        return float(self.dbc.get_message_by_name(message).get_signal_by_name(signal).maximum)

    def send(self, name: str, **signals: float | str) -> None:
        message, counter = self.dbc.get_message_by_name(name), self.next_counter.get(name, 0)
        data = bytearray(message.encode({"Crc": 0, "Counter": counter, **signals}))
        self.protect(data, self.attribute(name, "E2EDataId"), increment_counter=False)
        kind = {"is_extended_id": False, "is_fd": self.fd, "bitrate_switch": self.fd}
        self.bus.send(can.Message(arbitration_id=message.frame_id, data=data, **kind))
        self.next_counter[name] = (counter + 1) % self.counters  # each identifier counts all of its frames

    def receive(self, timeout: float) -> tuple[str, Signals] | None:
        """The next message of the unit, if one comes in time and its checksum is right."""
        frame = self.bus.recv(max(timeout, 0.0))
        if frame is None or (message := self.of_unit.get(frame.arbitration_id)) is None:
            return None
        name, self.received = message.name, self.received + 1
        if len(frame.data) != message.length or not self.check(frame.data, self.attribute(name, "E2EDataId")):
            self.broken += 1
            return None
        signals = message.decode(bytes(frame.data))
        counter = signals["Counter"]
        step = (counter - self.last_counter.get(name, counter - 1)) % self.counters
        self.gaps += not 1 <= step <= self.attribute(name, self.most_lost)
        self.last_counter[name] = counter
        return name, signals


# 2. The vehicles. A position is that of the front bumper along the lane.
@dataclass
class Vehicle:
    """A vehicle whose acceleration follows the demand with a lag."""

    position: float
    speed: float = CRUISE
    acceleration: float = 0.0
    demand: float = 0.0

    def drive(self, dt: float) -> None:
        self.acceleration += (self.demand - self.acceleration) * min(dt / LAG, 1.0)
        self.position += self.speed * dt
        self.speed = max(self.speed + self.acceleration * dt, 0.0)
        if self.speed == 0.0:
            self.acceleration = max(self.acceleration, 0.0)

    def motion(self, station: int, gnss: float) -> tuple[dict[str, float], dict[str, float]]:
        """Both halves of its motion; the stamp says when all of it was true, modulo 13.1072 s."""
        place = {"Position": self.position, "Stamp": int(gnss * 10_000) % 2**17 / 10_000, "Station": station}
        change = {"Speed": self.speed, "Acceleration": self.acceleration, "Demand": self.demand}
        return place, change | {"PositionAccuracy": 0.1, "SpeedAccuracy": 0.04}

    def tell(self, bus: Bus, name: str, station: int, tag: int, gnss: float) -> None:
        """Two frames of one tag, one right after the other, are one motion: the unit takes both or none. Over CAN FD it is one."""
        place, change = self.motion(station, gnss)
        if bus.fd:
            bus.send(f"{name}Motion", **place, **change)
        else:
            bus.send(f"{name}MotionA", Tag=tag, **place)
            bus.send(f"{name}MotionB", Tag=tag, **change)


def free_road(speed: float, target_speed: float) -> float:
    """The law of a vehicle that follows nobody, by which the unit foresees it in a silence."""
    return 0.73 * (1.0 - (speed / target_speed) ** 4)


# How the vehicle ahead drives, beside its TargetSpeed. The three parts are three frames of one identifier and one tag.
PARAMETERS: list[dict[str, float | str]] = [
    {"Length": LENGTH, "Standstill": STANDSTILL, "PredecessorKind": "nobody", "PredecessorStation": 0, "FeedForward": 0.0},
    {"TimeGap": TIME_GAP, "Gain": 0.5, "Damping": 2.0, "Lag": LAG, "CatchUp": 0.0},
    {"AccelerationLimit": 2.5, "BrakingLimit": 4.0, "JerkLimit": 5.0, "EmergencyBraking": 8.0, "HorizonLength": 0.0},
]

# What stands over CAN FD in place of a horizon that is absent.
NO_HORIZON = {f"{name}{knot}": 0.0 for name in ("Displacement", "Speed", "Acceleration", "Bow") for knot in range(5)}


def number(value: Any) -> float:
    """Some raw values have a name instead, such as "no bound" of an end that is too far away to be told."""
    return float("inf") if str(value) == "no bound" else float(value)


# 3. The node. Every 10 ms it moves the vehicles and sends what is due; between, it hears the unit.
@dataclass
class Seen:
    """What the unit did, for the verdict."""

    modes: list[tuple[float, str]] = field(default_factory=list)  # since when, which
    fallbacks: set[str] = field(default_factory=set)  # causes in Health
    version: int | None = None  # in Health
    synchronised: str = ""  # in Health
    refused: dict[str, list[int]] = field(default_factory=dict)  # by cause: the counts in Health since the driver engaged
    estimates: int = 0  # in holdover
    largest_error: float = 0.0  # m, of these estimates
    outside: int = 0  # estimates whose bound does not contain the truth
    oldest_command: float = 0.0  # s, when the actuators looked at it
    smallest_gap: float = float("inf")  # m
    lateness: float = 0.0  # s, of this program itself


class Node:
    """Vehicle, modem and vehicle ahead."""

    def __init__(self, bus: Bus) -> None:
        self.bus, self.seen = bus, Seen()
        self.ego, self.peer = Vehicle(0.0), Vehicle(35.0)
        self.mode, self.estimate, self.wanted = "standby", Signals(), CRUISE
        self.start = self.driven = self.commanded = time.monotonic()

    def now(self) -> float:
        return time.monotonic() - self.start

    def gap(self) -> float:
        return self.peer.position - LENGTH - self.ego.position

    def say(self, what: str) -> None:
        print(f"{self.now():6.2f} s  {self.ego.speed:5.2f} m/s  gap {self.gap():5.1f} m  {what}", flush=True)

    def run(self) -> Seen:
        script = [(ENGAGE, "the driver engages"), (FASTER, f"the vehicle ahead wants {WANTED} m/s"),
                  (SILENT, "the vehicle ahead falls silent"), (BACK, "the vehicle ahead speaks again"),
                  (RELEASE, "the driver takes over")]  # fmt: skip
        for cycle in range(round(END / PERIOD)):
            due = cycle * PERIOD
            while (left := due - self.now()) > 0.0:
                self.hear(left)
            self.seen.lateness = max(self.seen.lateness, self.now() - due)
            self.drive()
            self.tell(due)
            if script and due >= script[0][0]:
                self.say(script.pop(0)[1])
        return self.seen

    def drive(self) -> None:
        """In standby the driver keeps the speed. Otherwise the newest command holds; when it is too old, the vehicle brakes."""
        now = time.monotonic()
        self.seen.oldest_command = max(self.seen.oldest_command, now - self.commanded)
        if self.mode == "standby":
            self.ego.demand = 0.0
        elif now - self.commanded > self.bus.attribute("MotionCommand", "GenMsgTimeout") / 1000:
            self.ego.demand = -2.0
        self.peer.demand = free_road(self.peer.speed, self.wanted)
        for vehicle in (self.ego, self.peer):
            vehicle.drive(now - self.driven)
        self.driven = now
        self.seen.smallest_gap = min(self.seen.smallest_gap, self.gap())

    def turn(self, name: str, due: float) -> int | None:
        """How many times the message was sent before, if it is due now."""
        turn, rest = divmod(round(due * 1000), self.bus.dbc.get_message_by_name(name).cycle_time)
        return None if rest else turn

    def tell(self, due: float) -> None:
        """What is due, the frames of one message one right after the other."""
        # The unit takes the reception of TimeSync for the instant that TimeFollowUp tells. A controller's own time stamp of the
        # transmission is better than what stands here.
        if (turn := self.turn("TimeSync", due)) is not None:
            sent = EPOCH + time.monotonic()
            self.bus.send("TimeSync", Sequence=turn % 16, Seconds=int(sent))
            self.bus.send("TimeFollowUp", Sequence=turn % 16, Micros=int(sent % 1 * 1e6))
        at = EPOCH + self.driven  # when the vehicles were where they are
        self.ego.tell(self.bus, "Ego", STATION, round(due / PERIOD) % 4, at)
        # Rounded up. A view that is older than the signal can say is not sent.
        age = math.ceil((time.monotonic() - self.driven) * 1000) / 1000
        if self.turn("RangeSensor", due) is not None and age <= self.bus.maximum("RangeSensor", "Age"):
            view = {"Distance": self.gap(), "SpeedDifference": self.peer.speed - self.ego.speed, "Age": age}
            self.bus.send("RangeSensor", **view, Nobody="vehicle at Distance", DistanceAccuracy=0.1, SpeedAccuracy=0.1)
        if self.turn("DriverRequest", due) is not None:
            wish = {"Engaged": "drive" if ENGAGE <= due < RELEASE else "off", "TargetSpeed": 16.0, "TimeGap": TIME_GAP}
            self.bus.send("DriverRequest", PredecessorKind="station", PredecessorStation=PEER_STATION, **wish)
        self.wanted = CRUISE if due < FASTER else WANTED
        if SILENT <= due < BACK:
            return
        parameters = [PARAMETERS[0] | {"TargetSpeed": self.wanted}, *PARAMETERS[1:]]
        if self.bus.fd:
            # Motion, driving parameters and horizon are one message: here without a horizon, and each time with the parameters.
            if self.turn("Peer0State", due) is not None:
                place, change = self.peer.motion(PEER_STATION, at)
                said = parameters[0] | parameters[1] | parameters[2]
                self.bus.send("Peer0State", **place, **change, HorizonValid="absent", **NO_HORIZON, ParametersValid="present", **said)
            return
        if (turn := self.turn("Peer0MotionA", due)) is not None:
            self.peer.tell(self.bus, "Peer0", PEER_STATION, turn % 4, at)
        if (turn := self.turn("Peer0DrivingParameters", due)) is not None:
            for part, signals in enumerate(parameters):
                self.bus.send("Peer0DrivingParameters", Tag=turn % 4, Part=part, **signals)

    def hear(self, timeout: float) -> None:
        if (heard := self.bus.receive(timeout)) is None:
            return
        name, signals = heard
        if name == "MotionCommand":
            self.obey(str(signals["Mode"]), signals["Acceleration"])
        elif name == "TargetEstimateA":
            self.estimate = signals
        elif name in ("TargetEstimate", "TargetEstimateB") and self.mode == "holdover":
            if self.bus.fd:
                self.estimate = signals
            elif signals["Tag"] != self.estimate.get("Tag"):
                return
            ahead = self.peer.position + self.peer.speed * (time.monotonic() - self.driven) - self.estimate["Position"]
            self.seen.estimates += 1
            self.seen.largest_error = max(self.seen.largest_error, abs(ahead))
            self.seen.outside += not -number(signals["Behind"]) <= ahead <= number(signals["Ahead"])
        elif name == "Health":
            self.seen.version, self.seen.synchronised = signals["InterfaceVersion"], str(signals["Synchronised"])
            if self.now() >= ENGAGE:  # by then it trusts us: the first frame of each identifier is always refused
                self.seen.refused.setdefault(str(signals["Cause"]), []).append(signals["Count"])
            if signals["Mode"] == "fallback":
                self.seen.fallbacks.add(str(signals["Detail"]))

    def obey(self, mode: str, acceleration: float) -> None:
        self.commanded, self.mode, self.ego.demand = time.monotonic(), mode, acceleration
        if not self.seen.modes or self.seen.modes[-1][1] != mode:
            self.seen.modes.append((self.now(), mode))
            self.say(f"-> {mode}")


# 4. The verdict.
def judge(seen: Seen, bus: Bus, gap: float) -> list[tuple[bool, str]]:
    """Each check: whether it holds, and what was found."""
    names = [mode for _, mode in seen.modes]
    order = ["standby", "cooperative", "holdover", "fallback", "cooperative", "standby"]
    checks = [(names == order, "modes: " + ", ".join(names))]
    # After which event each mode begins, and how many seconds later: `holdover_us` is 15 s from the last message, and a peer that
    # has fallen silent is followed again 0.3 s after its link is on.
    late = [("cooperative", ENGAGE, 0.0, 0.5), ("holdover", SILENT, 0.0, 0.5), ("fallback", SILENT, 14.7, 15.3),
            ("cooperative", BACK, 0.3, 1.0), ("standby", RELEASE, 0.0, 0.5)]  # fmt: skip
    for (at, mode), (_, event, least, most) in zip(seen.modes[1:], late, strict=True) if names == order else []:
        checks.append((least <= at - event <= most, f"{mode} {at - event:.2f} s after the event, of {least} to {most} s"))
    version = bus.dbc.dbc.attribute_definitions["InterfaceVersion"].default_value
    checks.append((seen.version == version, f"interface version {seen.version}, that of the DBC is {version}"))
    checks.append((seen.synchronised == "GNSS time known", f"time: {seen.synchronised}"))
    checks.append((seen.fallbacks == {"silent"}, f"causes of fallback: {', '.join(sorted(seen.fallbacks))}"))
    checks.append((bus.broken + bus.gaps == 0, f"E2E: {bus.received} frames, {bus.broken} broken, {bus.gaps} gaps"))
    grown = {cause: max(counts) - min(counts) for cause, counts in seen.refused.items() if max(counts) > min(counts)}
    refused = ", ".join(f"{count} {cause}" for cause, count in grown.items())
    checks.append((not grown, f"frames refused since the driver engaged: {refused or 'none'}"))
    error = f"largest error {seen.largest_error:.2f} m, {seen.outside} of {seen.estimates} outside their bound"
    checks.append((seen.estimates > 1000 and seen.largest_error < 1.0 and seen.outside == 0, f"estimates in holdover: {error}"))
    checks.append((seen.smallest_gap > 10.0 and gap < 50.0, f"gap at least {seen.smallest_gap:.1f} m, {gap:.1f} m in the end"))
    timeout = bus.attribute("MotionCommand", "GenMsgTimeout")
    checks.append((seen.oldest_command * 1e3 < timeout, f"commands at most {seen.oldest_command * 1e3:.0f} ms old"))
    return checks


def main() -> int:
    parser = argparse.ArgumentParser(description="A first node for a holdover unit; see docs/FIRST-NODE.md.")
    parser.add_argument("--interface", default="socketcan", help="of python-can (default: socketcan)")
    parser.add_argument("--channel", default="vcan0", help="of that interface (default: vcan0)")
    parser.add_argument("--bitrate", type=int, help="for interfaces that need one: 500000")
    parser.add_argument("--fd", action="store_true", help="the bus is CAN FD")
    arguments = parser.parse_args()
    options = {name: value for name, value in vars(arguments).items() if value is not None}
    dbc = ROOT / ("holdover-fd.dbc" if arguments.fd else "holdover.dbc")
    with can.Bus(**options) as raw:
        bus = Bus(raw, cantools.database.load_file(dbc), arguments.fd)
        if bus.receive(5.0) is None:
            remedy = f"holdover-sim ecu --bus {arguments.channel} --station {STATION}{' --fd' * arguments.fd}"
            print(f"no unit on {arguments.channel}; remedy: {remedy}", file=sys.stderr)
            return 1
        node = Node(bus)
        seen = node.run()
        checks = judge(seen, bus, node.gap())
    print()
    for holds, what in checks:
        print(f"{'ok    ' if holds else 'FAILED'}  {what}")
    print(f"        this program was at most {seen.lateness * 1e3:.0f} ms late itself")
    return 0 if all(holds for holds, _ in checks) else 3 if seen.lateness > LATE else 1


if __name__ == "__main__":
    sys.exit(main())
