"""network.py: the roads of a corridor as a network of SUMO, with one of four rules at every intersection.

A corridor enters; files of nodes, edges and connections leave, and the net that `netconvert` makes of them. The geometry is the same
under every rule: one lane a road, straight on only, and a junction that reaches as far as the conflict area.
"""

import xml.etree.ElementTree as xml
from itertools import pairwise
from xml.sax.saxutils import quoteattr

from corridor import Unusable
from sumo_programs import call

LANE_M = 3.5
FLAT_M2 = 0.1  # corners of an outline that deviate less than this are one
TOLERANCE_M = 0.1  # lengths in SUMO's files are rounded to centimetres, one for each edge and junction

# The rules: how SUMO calls such a junction, and what the table says.
RULES = {
    "none": ("unregulated", "no conflicts at all"),
    "priority": ("priority", "priority, {main} major"),
    "actuated": ("traffic_light", "actuated signals"),
    "allway": ("allway_stop", "all-way stop, 1 s dwell"),
}


def edge(road, piece):
    """The name of a road's piece; piece 0 leads to the first intersection."""
    return f"r{road}_{piece}"


def edges(corridor, road):
    """The names of all pieces of a road."""
    return [edge(road, piece) for piece in range(len(corridor.roads[road].stops) + 1)]


def export(corridor, rule, folder):
    """Writes the network under a rule. The result: the net file."""
    folder.mkdir(parents=True, exist_ok=True)
    files = {part: folder / f"{rule}.{part}.xml" for part in ("nod", "edg", "con", "net")}
    write(files["nod"], "nodes", nodes(corridor, RULES[rule][0]))
    write(files["edg"], "edges", pieces(corridor))
    write(files["con"], "connections", connections(corridor))
    options = [
        "--node-files", files["nod"], "--edge-files", files["edg"], "--connection-files", files["con"], "--output-file", files["net"],
        "--no-turnarounds", "--offset.disable-normalization", "--junctions.limit-turn-speed", -1, "--tls.default-type", "actuated",
    ]  # fmt: skip
    call("netconvert", *options)
    validate(corridor, files["net"], RULES[rule][0])
    return files["net"]


def nodes(corridor, kind):
    """Every intersection, and both ends of every road."""
    for index, place in enumerate(corridor.places):
        yield "node", {"id": f"j{index}", "x": place[0], "y": place[1], "type": kind, "shape": text(outline(corridor, index))}
    for index, road in enumerate(corridor.roads):
        for name, along in (("in", road.entry), ("out", road.exit)):
            x, y = road.at(along)
            yield "node", {"id": f"{name}{index}", "x": x, "y": y, "type": "dead_end"}


def pieces(corridor):
    """Every road, from end to end, in pieces between its intersections."""
    for index, road in enumerate(corridor.roads):
        ends = [(f"in{index}", road.entry), *((f"j{stop}", along) for stop, along in road.stops), (f"out{index}", road.exit)]
        for piece, ((start, begins), (end, finishes)) in enumerate(pairwise(ends)):
            yield "edge", {
                "id": edge(index, piece),
                "name": road.name,
                "from": start,
                "to": end,
                "numLanes": 1,
                "width": LANE_M,
                "spreadType": "center",
                "speed": corridor.traffic["target_speed_mps"],
                "priority": 2 if road.street == corridor.main else 1,
                "shape": text([road.at(begins), road.at(finishes)]),
            }


def connections(corridor):
    """Everyone goes straight on."""
    for index in range(len(corridor.roads)):
        names = edges(corridor, index)
        for start, end in pairwise(names):
            yield "connection", {"from": start, "to": end, "fromLane": 0, "toLane": 0}


def outline(corridor, index):
    """The outline of an intersection: the hull of its lanes, as far as the conflict area reaches along each."""
    corners = [
        road.at(along + sign * corridor.halves[index], side * LANE_M / 2)
        for road in corridor.roads
        for stop, along in road.stops
        if stop == index
        for sign in (-1, 1)
        for side in (-1, 1)
    ]
    return hull(corners)


def hull(points):
    """The convex hull of points in a plane, counterclockwise."""

    def half(order):
        chain = []
        for point in order:
            while len(chain) > 1 and turn(chain[-2], chain[-1], point) <= FLAT_M2:
                chain.pop()
            chain.append(point)
        return chain[:-1]

    order = sorted(points)
    return half(order) + half(order[::-1])


def turn(a, b, c):
    """Above 0 if the way from a over b to c turns left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def text(points):
    """Points as SUMO's files have them."""
    return " ".join(f"{x:.3f},{y:.3f}" for x, y in points)


def write(path, root, elements):
    """A file of elements without content."""
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"<{root}>\n")
        for tag, values in elements:
            file.write(f"  <{tag} {' '.join(f'{key}={quoteattr(str(value))}' for key, value in values.items())}/>\n")
        file.write(f"</{root}>\n")


def validate(corridor, net, kind):
    """The net has every road in its length, straight on only, and every intersection of the right kind."""
    tree = xml.parse(net).getroot()
    lanes = {lane.get("id"): float(lane.get("length")) for lane in tree.iter("lane")}
    ways = {(one.get("from"), one.get("to")): one.get("via") for one in tree.iter("connection") if one.get("from")[0] != ":"}
    for index, road in enumerate(corridor.roads):
        names = edges(corridor, index)
        inside = [ways.pop(pair, None) for pair in pairwise(names)]
        if None in inside or not all(f"{name}_0" in lanes for name in names):
            raise Unusable(f"{net} does not lead through “{road.name}”; look at it with netedit")
        length = sum(lanes[f"{name}_0"] for name in names) + sum(lanes[via] for via in inside)
        if abs(length - road.length) > TOLERANCE_M:
            raise Unusable(f"“{road.name}” is {length:.2f} m long in {net}, not {road.length:.2f} m; look at it with netedit")
    if ways:
        raise Unusable(f"{net} has ways that are not straight on: {sorted(ways)}; look at it with netedit")
    kinds = {one.get("id"): one.get("type") for one in tree.iter("junction")}
    other = [f"j{index}" for index in range(len(corridor.places)) if kinds.get(f"j{index}") != kind]
    if other:
        raise Unusable(f"{net} has other rules than “{kind}” at {', '.join(other)}; look at it with netedit")
