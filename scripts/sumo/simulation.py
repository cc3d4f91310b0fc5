"""simulation.py: a run of SUMO: a net and trips enter; the figures of the run leave.

Times are those of SUMO's tripinfo. Full stops are counted from the speeds at every step, as holdover-sim counts them.
"""

import subprocess
import xml.etree.ElementTree as xml
from dataclasses import dataclass, field
from pathlib import Path

from corridor import KINDS, Trip, Unusable
from network import edges, write
from sumo_programs import failed, program

STEP_S = 0.1
STANDING_BELOW_MPS, FULL_STOP_FROM_S = 0.1, 0.5
DWELL_S = 1.0
FILLED_S = 60.0  # by then the roads are filled, and exits are counted


@dataclass
class Run:
    """The figures of one run, or of several together."""

    vehicles: int = 0
    travel_times: list[float] = field(default_factory=list)
    stops: int = 0
    exits: int = 0
    counted_s: float = 0.0
    collisions: int = 0

    def __add__(self, other):
        return Run(*(getattr(self, name) + getattr(other, name) for name in self.__dataclass_fields__))

    def figures(self):
        """What is printed."""
        served = len(self.travel_times)
        return {
            "vehicles": self.vehicles,
            "served": served,
            "mean_travel_time_s": sum(self.travel_times) / served if served else None,
            "full_stops_per_vehicle": self.stops / self.vehicles if self.vehicles else None,
            "exits_per_min": 60.0 * self.exits / self.counted_s if self.counted_s > 0.0 else None,
            "collisions": self.collisions,
        }


def write_trips(corridor, trips, path, sigma):
    """Writes the kinds of vehicles, the routes and the trips."""
    traffic = corridor.traffic
    kinds = (("vType", {
        "id": kind.name,
        "carFollowModel": "Krauss",
        "length": kind.length,
        "accel": kind.acceleration,
        "decel": kind.braking,
        "emergencyDecel": kind.emergency,
        "tau": traffic["time_gap_s"],
        "minGap": traffic["standstill_m"],
        "maxSpeed": traffic["target_speed_mps"],
        "speedFactor": 1.0,
        "speedDev": 0.0,
        "sigma": sigma,
        "jmAllwayStopWait": DWELL_S,
    }) for kind in KINDS)
    routes = (("route", {"id": f"r{road}", "edges": " ".join(edges(corridor, road))}) for road in range(len(corridor.roads)))
    vehicles = (("vehicle", {
        "id": index,
        "type": trip.kind.name,
        "route": f"r{trip.road}",
        "depart": f"{trip.at:.3f}",
        "departPos": 0,
        "departSpeed": f"{trip.speed:.3f}",
    }) for index, trip in enumerate(trips))
    write(path, "routes", [*kinds, *routes, *vehicles])


@dataclass(frozen=True)
class Case:
    """What is run: a net under a rule, and the trips of one demand and seed."""

    rule: str
    net: Path
    demand: float
    seed: int
    trips: list[Trip]

    @property
    def name(self):
        return f"{self.rule}-{self.demand:g}-{self.seed}"


def run(corridor, case, duration, sigma, folder):
    """One run, until every vehicle has left, or twice the duration and five minutes have passed."""
    routes, info, statistic, said = (folder / f"{case.name}.{part}" for part in ("rou.xml", "tripinfo.xml", "statistic.xml", "log"))
    write_trips(corridor, case.trips, routes, sigma)
    path, environment = program("sumo")
    options = [
        "--net-file", case.net, "--route-files", routes, "--seed", case.seed, "--step-length", STEP_S, "--end", 2 * duration + 300,
        "--tripinfo-output", info, "--statistic-output", statistic, "--fcd-output", "stdout",
        "--fcd-output.attributes", "speed", "--fcd-output.skip-empty", "--time-to-teleport", -1, "--collision.action", "warn",
        "--collision.check-junctions", str(case.rule != "none").lower(), "--no-step-log", "--error-log", said, "--xml-validation", "never",
    ]  # fmt: skip
    command = [path, *map(str, options)]
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as process:
        stops = full_stops(process.stdout)
    if process.returncode:
        raise Unusable(failed("sumo", process.returncode, said.read_text() if said.exists() else ""))
    return measured(case.trips, info, statistic, stops, duration)


def full_stops(lines):
    """The number of times that a vehicle stood for long enough, from SUMO's floating car data."""
    stops, step, since = 0, 0, {}
    for line in lines:
        words = line.split('"')
        if words[0].endswith("<timestep time="):
            step = round(float(words[1]) / STEP_S)
        elif words[0].endswith("<vehicle id="):
            if float(words[3]) >= STANDING_BELOW_MPS:
                since.pop(words[1], None)
            elif step - since.setdefault(words[1], step) == round(FULL_STOP_FROM_S / STEP_S):
                stops += 1
    return stops


def measured(trips, info, statistic, stops, duration):
    """The figures of a run, from its files."""
    arrivals = {int(one.get("id")): float(one.get("arrival")) for one in xml.parse(info).getroot().iter("tripinfo")}
    times = [at - trips[index].at for index, at in sorted(arrivals.items())]
    exits = sum(FILLED_S <= at < duration for at in arrivals.values())
    collisions = int(xml.parse(statistic).getroot().find("safety").get("collisions"))
    return Run(len(trips), times, stops, exits, duration - FILLED_S, collisions)
