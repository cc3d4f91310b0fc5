"""corridor.py: a scenario of a corridor, as holdover-sim reads it: its roads in a plane, and its trips.

A file enters; straight roads with their crossing points leave, and for each seed the same trips that holdover-sim has
(`host-sim/src/roads/network.rs` and `trips.rs`): road, time of arrival, speed at arrival, kind.
"""

import math
import tomllib
from dataclasses import dataclass
from pathlib import Path

from chacha import units

SHIPPED = Path(__file__).resolve().parents[2] / "host-sim/scenarios/corridor.toml"
PASSES_WITHIN_M = 12.0  # a road is a leg of an intersection that it passes so near
ARRIVALS = 6  # the kind of random stream of the arrivals
WGS84_M, WGS84_E2 = 6_378_137.0, 6.694_379_990_141_3e-3


class Unusable(Exception):
    """What cannot be done, and the remedy."""


@dataclass(frozen=True)
class Kind:
    """A kind of vehicle: length in m; acceleration, normal and emergency braking in m/s²."""

    name: str
    length: float
    acceleration: float
    braking: float
    emergency: float


# As host-sim/src/input/kind.rs and the configuration of a car have them.
CAR = Kind("car", 4.8, 2.5, 4.0, 8.0)
VAN = Kind("van", 6.0, 2.0, 3.5, 7.5)
BUS = Kind("bus", 12.0, 1.2, 3.0, 6.0)
KINDS = [CAR, VAN, BUS]


@dataclass(frozen=True)
class Road:
    """A straight lane. Distances along it are from its first point; `stops` has the intersections in the order of travel."""

    name: str
    origin: tuple[float, float]
    way: tuple[float, float]
    stops: list[tuple[int, float]]
    entry: float
    exit: float
    rate: float

    @property
    def street(self):
        """The name without the direction."""
        return self.name.split(",")[0]

    @property
    def length(self):
        """The length of a vehicle's way."""
        return self.exit - self.entry

    def at(self, along, aside=0.0):
        """The place so far along the road and to its right, in metres to the east and to the north."""
        (x, y), (dx, dy) = self.origin, self.way
        return x + along * dx + aside * dy, y + along * dy - aside * dx


@dataclass(frozen=True)
class Trip:
    """One vehicle's way."""

    road: int
    at: float
    speed: float
    kind: Kind


class Corridor:
    """A scenario. What its file leaves out is as in the shipped one."""

    def __init__(self, path=SHIPPED):
        own, shipped = read(path), read(SHIPPED)
        if own.get("kind") != "corridor" or not own.get("road") or not own.get("intersection"):
            raise Unusable(f'{path} has no roads that cross; give a scenario with `kind = "corridor"`, as {SHIPPED.name}')
        self.traffic = shipped["traffic"] | own.get("traffic", {})
        self.seed = own.get("seed", shipped["seed"])
        self.duration = own.get("duration_s", shipped["duration_s"])
        plane = Plane(own["intersection"])
        self.places = [plane.at(plan["at"]) for plan in own["intersection"]]
        self.halves = [plan.get("half_m", 3.5) for plan in own["intersection"]]
        self.roads = [self.road(plan, plane) for plan in own["road"]]
        most = max(self.roads, key=lambda road: len(road.stops))
        self.main = most.street

    def road(self, plan, plane):
        """A road of the file, with the intersections that it passes."""
        name, points = plan.get("name", "road"), plan["points"]
        if len(points) != 2:
            raise Unusable(f"the road “{name}” has {len(points)} points, and only straight roads are exported; give it two")
        (x, y), (to_x, to_y) = map(plane.at, points)
        length = math.hypot(to_x - x, to_y - y)
        way = (dx, dy) = (to_x - x) / length, (to_y - y) / length
        right = plan.get("right_m", 0.0)
        origin = (x, y) = x + right * dy, y - right * dx
        stops = []
        for index, (at_x, at_y) in enumerate(self.places):
            along, aside = (at_x - x) * dx + (at_y - y) * dy, (at_x - x) * dy - (at_y - y) * dx
            if abs(aside) <= PASSES_WITHIN_M:
                stops.append((index, along))
        stops.sort(key=lambda stop: stop[1])
        if not stops:
            raise Unusable(f"the road “{name}” passes no intersection; let it pass one within {PASSES_WITHIN_M:.0f} m")
        entry, leaves = stops[0][1] - self.traffic["appear_m"], stops[-1][1] + self.traffic["leave_m"]
        return Road(name, origin, way, stops, entry, leaves, plan.get("vehicles_per_min", 3.0))

    def trips(self, demand, seed, duration):
        """The trips of a seed with so many vehicles a minute on all roads together, in the order of their arrival."""
        scale = demand / sum(road.rate for road in self.roads)
        busiest = max(road.rate for road in self.roads) * scale
        least = self.traffic["headway_s"]
        if busiest * least >= 60.0:
            raise Unusable(f"one road cannot take {busiest:.1f} vehicles a minute {least} s apart; give a smaller --demand")
        span = self.traffic["entry_speed_mps"]
        low, high = span if isinstance(span, list) else (span, span)
        trips = []
        for index, road in enumerate(self.roads):
            draw, at = units(seed, ARRIVALS << 32 | index), 0.0
            while road.rate > 0.0:
                at += least - (60.0 / (road.rate * scale) - least) * math.log(1.0 - next(draw))
                if at >= duration:
                    break
                pace, sort, _dark, _odometer = (next(draw) for _ in range(4))
                trips.append(Trip(index, at, low + (high - low) * pace, self.kind(sort)))
        return sorted(trips, key=lambda trip: (trip.at, trip.road))

    def kind(self, share):
        """The kind of a vehicle, by its random number."""
        vans, buses = self.traffic["vans"], self.traffic["buses"]
        return VAN if share < vans else BUS if share < vans + buses else CAR


class Plane:
    """The plane that touches the globe in the middle of these intersections."""

    def __init__(self, intersections):
        north, east = zip(*(plan["at"] for plan in intersections))
        self.north, self.east = sum(north) / len(north), sum(east) / len(east)
        sine, cosine = math.sin(math.radians(self.north)), math.cos(math.radians(self.north))
        w = math.sqrt(1.0 - WGS84_E2 * sine * sine)
        self.degree_north = WGS84_M * (1.0 - WGS84_E2) / w**3 * math.radians(1.0)
        self.degree_east = WGS84_M / w * cosine * math.radians(1.0)

    def at(self, point):
        """Metres to the east and to the north of a point in degrees north and east."""
        north, east = point
        return (east - self.east) * self.degree_east, (north - self.north) * self.degree_north


def read(path):
    """The table in a TOML file."""
    try:
        with open(path, "rb") as file:
            return tomllib.load(file)
    except OSError as error:
        raise Unusable(f"{path} cannot be read ({error.strerror}); give a scenario with --scenario") from error
    except tomllib.TOMLDecodeError as error:
        raise Unusable(f"{path} is not TOML ({error}); correct it") from error
