"""documented_corridor.py RESULTS.md CORRIDOR.json: the table of the corridor in docs/RESULTS.md says what the run says.

Both are of seed 1 (`holdover-sim run corridor --json`). Each figure has to be the run's to within half of its last digit. Exit code: 0 all are; 1 some are not, or the table is not as expected.
"""

import json
import re
import sys

SIDES = ["holdover", "perfect_link", "alone", "envelope", "envelope_perfect_link", "emergencies"]
ROWS = {
    "collisions": lambda side: side["collisions_on_roads"] + side["collisions_at_intersections"],
    "not served": lambda side: side["unserved"],
    "full stops": lambda side: side["full_stops"],
    "drivers who took over": lambda side: side["takeovers"],
    "of these emergencies": lambda side: side["emergency_stops"],
    "mean travel time": lambda side: side["mean_travel_time_s"],
    "smallest gap on a road": lambda side: side["smallest_gap_m"],
    "lowest speed": lambda side: side["lowest_speed_mps"],
    "target outside its bound, ticks": lambda side: side["bound_violations"],
    "target's position error, max": lambda side: side["position_error"]["max_m"],
    "the same, rms": lambda side: side["position_error"]["rms_m"],
    "entry error, standard deviation": lambda side: side["entry_error"]["std_s"],
}


def table(text):
    """The cells of each row of the table below the heading and before the next one, by the row's name."""
    section = re.split(r"\n###? ", text.split("\n## Four intersections without signals\n", 1)[1], maxsplit=1)[0]
    rows = [line.strip().strip("|").split("|") for line in section.splitlines() if line.startswith("|")]
    return {cells[0].strip(): [cell.strip() for cell in cells[1:]] for cells in rows}


def wrong(cell, measured):
    """Whether the figure of the cell is not the measured one."""
    figure = cell.split()[0]
    digits = len(figure.split(".")[1]) if "." in figure else 0
    return abs(float(figure) - measured) > 0.5 * 10**-digits + 1e-9


def main(results, run):
    with open(results) as file:
        rows = table(file.read())
    with open(run) as file:
        measured = json.load(file)
    compared, failures = 0, []
    for name, figure in ROWS.items():
        for side, cell in zip(SIDES, rows[name], strict=True):
            if cell:
                compared += 1
                is_wrong = wrong(cell, figure(measured[side]))
                failures += [f"{name}, {side}: {cell} is documented, {figure(measured[side])} measured"] if is_wrong else []
    print(f"{compared} documented figures of the corridor compared, {len(failures)} differ")
    print("\n".join(failures), end="\n" if failures else "")
    return 1 if failures or compared < 30 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
