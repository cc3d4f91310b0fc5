"""compare.py: SUMO on the roads and the trips of `holdover-sim run corridor`, with four rules at the intersections.

It exports the scenario's roads to SUMO, runs SUMO on the same trips, and prints a table: the mean travel time and the full stops per
vehicle at each demand, and the vehicles that leave per minute at the largest one. scripts/sumo/README.md says what is equal and what is
not.
"""

import argparse
import json
import math
import sys
from pathlib import Path

if sys.version_info < (3, 11):
    sys.exit("compare.py: this Python is older than 3.11, the first one that reads TOML; remedy: run it with python3.11 or newer")

from corridor import SHIPPED, Corridor, Unusable
from network import RULES, export
from simulation import FILLED_S, Case, Run, run
from sumo_programs import version

ROOT = Path(__file__).resolve().parents[2]
KNOWN_TRIPS = [(30, 1, 301), (90, 1, 891)]  # demand, seed, vehicles in ten minutes
SIDES = {"holdover": "holdover, without the envelope", "envelope": "holdover, with the envelope"}  # of holdover-sim, beside SUMO
EPILOG = """examples:
  compare.py                                     the table of scripts/sumo/README.md
  compare.py --check                             only export the network and examine it
  compare.py --demand 90 --seeds 10 --json       one demand, ten seeds, as JSON
  compare.py --beside corridor.json              beside a result of holdover-sim, which has the same trips:
      holdover-sim run corridor --demand 30,60,90 --seeds 2 --slots 16 --no-report --json >corridor.json

exit codes: 0 done; 2 something is wrong, and one line on stderr names cause and remedy"""


def numbers(text):
    """Numbers above 0 with commas between them."""
    try:
        values = [float(part) for part in text.split(",")]
    except ValueError:
        values = []
    if not values or not all(0.0 < value < math.inf for value in values):
        raise argparse.ArgumentTypeError(f"is {text!r}; give numbers above 0, such as 30,60,90")
    return values


def within(least, most, kind=float):
    """A number between two limits."""

    def checked(text):
        try:
            value = kind(text)
        except ValueError:
            value = math.nan
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"is {text!r}; give a number from {least:g} to {most:g}")
        return value

    return checked


class Parser(argparse.ArgumentParser):
    """A parser that says in one line what is wrong."""

    def error(self, message):
        self.exit(2, f"{self.prog}: {message}; --help lists the options\n")


def arguments():
    """The options."""
    parser = Parser(description=__doc__.split(": ", 1)[1], epilog=EPILOG, formatter_class=argparse.RawDescriptionHelpFormatter)
    add = parser.add_argument
    add("--scenario", type=Path, default=SHIPPED, metavar="FILE", help="scenario of a corridor [default: the shipped one]")
    add("--demand", type=numbers, default=[30.0, 60.0, 90.0], metavar="N,…", help="vehicles a minute on all roads [30,60,90]")
    add("--seeds", type=within(1, 10_000, int), default=2, metavar="N", help="number of seeds, from the scenario's on [2]")
    add("--duration", type=within(2 * FILLED_S, 86_400), metavar="S", help="vehicles arrive for so long [the scenario's]")
    add("--rules", default=",".join(RULES), metavar="RULE,…", help="rules at the intersections [none,priority,actuated,allway]")
    add("--sigma", type=within(0, 1), default=0.5, metavar="X", help="imperfection of the drivers, 0 to 1 [SUMO's 0.5]")
    add("--out", type=Path, default=ROOT / "target/sumo", metavar="FOLDER", help="folder for all files [target/sumo]")
    add("--beside", type=Path, metavar="FILE", help="result of `holdover-sim run corridor --demand … --json`, for two more rows")
    add("--json", action="store_true", help="print the figures as JSON")
    add("--check", action="store_true", help="export the network under every rule, examine it, and run nothing")
    given = parser.parse_args()
    given.rules = given.rules.split(",")
    if unknown := [rule for rule in given.rules if rule not in RULES]:
        parser.error(f"there is no rule “{unknown[0]}”; give some of {', '.join(RULES)}")
    return given


def say(text):
    """Progress."""
    print(text, file=sys.stderr, flush=True)


def load(path):
    """The scenario."""
    try:
        return Corridor(path)
    except (KeyError, TypeError, ValueError, ZeroDivisionError) as error:
        raise Unusable(f"{path} is no scenario of a corridor ({error!r}); `holdover-sim run {path}` names the line") from error


def rows(given, corridor, nets, trips, duration):
    """Runs everything. The result: the figures of every rule and demand, of all seeds together."""
    total, done, found = len(nets) * len(given.demand) * given.seeds, 0, []
    for rule, net in nets.items():
        for demand in given.demand:
            result = Run()
            for seed, some in trips[demand].items():
                case = Case(rule, net, demand, seed, some)
                result += run(corridor, case, duration, given.sigma, given.out)
                done += 1
                say(f"{done} of {total} runs done ({rule}, {demand:g} a minute, seed {seed})")
            what = RULES[rule][1].format(main=corridor.main)
            found.append({"rule": rule, "what": what, "vehicles_per_min": demand, **result.figures()})
    return found


def beside(path):
    """The rows of holdover-sim over the scenario's link, with the most slots that its result has."""
    try:
        theirs = json.loads(path.read_text())
        slots = max(row["slots"] for row in theirs)
        return [
            {
                "rule": "holdover",
                "what": SIDES[row["side"]],
                "vehicles_per_min": row["vehicles_per_min"],
                "vehicles": row["served"] + row["unserved"],
                "served": row["served"],
                "mean_travel_time_s": row["mean_travel_time_s"],
                "full_stops_per_vehicle": row["full_stops"] / (row["served"] + row["unserved"]),
                "exits_per_min": row["exits_per_min"],
                "collisions": row["collisions_on_roads"] + row["collisions_at_intersections"],
            }
            for row in theirs
            if row["slots"] == slots and row["side"] in SIDES
        ]
    except (OSError, ValueError, KeyError, TypeError) as error:
        remedy = "give the output of `holdover-sim run corridor --demand N,… --json`"
        raise Unusable(f"{path} is not a result of a corridor ({error}); {remedy}") from error


def known_trips():
    """The trips of the shipped scenario are as many as holdover-sim has (docs/RESULTS.md, docs/CORRIDOR.md)."""
    shipped = Corridor()
    for demand, seed, vehicles in KNOWN_TRIPS:
        found = len(shipped.trips(demand, seed, 600.0))
        if found != vehicles:
            cause = f"seed {seed} at {demand} a minute has {found} trips, and holdover-sim has {vehicles}"
            raise Unusable(f"{cause}; let trips() do what host-sim/src/roads/trips.rs does")


def same_trips(trips, theirs):
    """The result of holdover-sim has as many vehicles at each demand as the trips, as it has if they are the same."""
    for row in theirs:
        demand, vehicles = row["vehicles_per_min"], row["vehicles"]
        own = sum(map(len, trips[demand].values())) if demand in trips else vehicles
        if own != vehicles:
            cause = f"at {demand:g} a minute the result of --beside has {vehicles} vehicles, and there are {own} here"
            raise Unusable(f"{cause}; give both the same scenario, seeds and duration")


def table(found, demands):
    """The figures as a table in Markdown."""
    largest = max(demands)
    lines = [
        f"| vehicles a minute | {' | '.join(f'{demand:g}' for demand in demands)} | exits/min at {largest:g} |",
        "|---|" + "---|" * (len(demands) + 1),
    ]
    for what in dict.fromkeys(row["what"] for row in found):
        at = {row["vehicles_per_min"]: row for row in found if row["what"] == what}
        cells = [cell(at.get(demand)) for demand in demands]
        exits = at.get(largest, {}).get("exits_per_min")
        lines.append(f"| {what} | {' | '.join(cells)} | {'' if exits is None else f'{exits:.0f}'} |")
    return "\n".join(lines)


def cell(row):
    """Mean travel time / full stops per vehicle; what has not been served, and collisions, if there are any."""
    if row is None or row["mean_travel_time_s"] is None:
        return ""
    text = f"{row['mean_travel_time_s']:.1f} / {row['full_stops_per_vehicle']:.2f}"
    unserved = row["vehicles"] - row["served"]
    text += f", {unserved} not served" if unserved else ""
    return text + (f", {row['collisions']} collisions" if row["collisions"] else "")


def main():
    given = arguments()
    corridor = load(given.scenario)
    duration = given.duration or corridor.duration
    seeds = range(corridor.seed, corridor.seed + given.seeds)
    trips = {demand: {seed: corridor.trips(demand, seed, duration) for seed in seeds} for demand in given.demand}
    theirs = beside(given.beside) if given.beside else []
    same_trips(trips, theirs)
    sumo = version()
    say(f"SUMO {sumo}; files go to {given.out}")
    nets = {rule: export(corridor, rule, given.out) for rule in given.rules}
    if given.check:
        known_trips()
        ways = ", ".join(f"{road.name} {road.length:.1f} m" for road in corridor.roads)
        print(f"{len(nets)} networks are as the scenario says: {ways}")
        return
    found = rows(given, corridor, nets, trips, duration) + theirs
    if given.json:
        print(json.dumps({"sumo": sumo, "seeds": given.seeds, "sigma": given.sigma, "rows": found}, indent=2))
    else:
        print(table(found, given.demand))


if __name__ == "__main__":
    try:
        main()
    except (Unusable, OSError) as error:
        say(f"compare.py: {error}")
        sys.exit(2)
