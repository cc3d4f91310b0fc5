"""Test vectors for the baselines and the reference, computed independently of the Rust code.

Nothing enters, CSV files leave beside this script; run it with Python 3 and numpy, the result is the same every time:

    python3 host-sim/tests/vectors/generate.py

Independent on purpose: times are whole microseconds, so reading steps and nearest steps are exact integers
(a tie raises); continuous motion is integrated by matrix exponentials; Kalman noise comes from Van Loan's method; eq. 13
is solved by evaluating it as printed at two points. Expected values are full double precision.
"""

import csv
import pathlib
import random

import numpy

HERE = pathlib.Path(__file__).parent
TARGET = 3
SECOND = 1_000_000


def expm(matrix):
    """Matrix exponential by scaling, Taylor series and squaring."""
    matrix = numpy.asarray(matrix, dtype=float)
    halvings = max(0, int(numpy.ceil(numpy.log2(max(numpy.abs(matrix).sum(), 1e-300)))) + 4)
    scaled, term, total = matrix / 2.0**halvings, numpy.eye(len(matrix)), numpy.eye(len(matrix))
    for n in range(1, 24):
        term = term @ scaled / n
        total = total + term
    for _ in range(halvings):
        total = total @ total
    return total


def write(name, header, rows):
    with open(HERE / name, "w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        for row in rows:
            writer.writerow(["" if x is None else repr(float(x)) if isinstance(x, float) else x for x in row])


# Motion at a constant and at a fading acceleration, until the vehicle stops.


def moved(generator, speed, acceleration, seconds):
    def at(time):
        return expm(numpy.array(generator) * time) @ [0.0, speed, acceleration]

    if at(seconds)[1] < 0.0:
        low, high = 0.0, seconds
        for _ in range(200):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if at(middle)[1] > 0.0 else (low, middle)
        return at(low)[0], 0.0
    return at(seconds)[0], at(seconds)[1]


def motion_rows(dice):
    constant = [[0, 1, 0], [0, 0, 1], [0, 0, 0]]
    singer = [[0, 1, 0], [0, 0, 1], [0, 0, -1 / 1.5]]
    for _ in range(200):
        speed, acceleration = dice.uniform(0, 30), dice.uniform(-5, 3)
        age = dice.choice([0.02, 0.5, 1, 2, 5, 12]) * dice.random()
        start = (speed, acceleration, age)
        yield (*start, *moved(constant, *start), *moved(singer, *start))


# Messages of a string of four vehicles and of one that is none of its business.


def messages(dice):
    heard = []
    for vehicle in (0, 1, 2, 3, 7):
        mean, swing = dice.uniform(9, 12), dice.uniform(0.5, 2)
        pulse, phase = dice.uniform(0.4, 0.9), dice.uniform(0, 6)
        start, offset = 80.0 - 17.0 * vehicle, dice.randrange(0, 100_000)
        for n in range(200):
            stamp = offset + n * 100_000 + dice.randrange(0, 4_000)
            t = stamp / SECOND
            position = start + mean * t - swing / pulse * (numpy.cos(pulse * t + phase) - numpy.cos(phase))
            speed = mean + swing * numpy.sin(pulse * t + phase)
            acceleration = swing * pulse * numpy.cos(pulse * t + phase)
            delay = max(0.0, dice.gauss(0.040, 0.0259)) if dice.random() < 0.9 else dice.uniform(0.1, 0.6)
            silences = {1: (0.0, 0.9), 2: (4.0, 11.0), 3: (6.0, 9.0)}
            begin, end = silences.get(vehicle, (0.0, 0.0))
            law = None
            if vehicle != 7 and (n % 5 == 0 or vehicle == 3) and not (vehicle == 0 and t < 3.0):
                law = dict(length=4.0 + 0.3 * vehicle, gap=dice.choice([0.9, 1.0, 1.4]), gain=dice.uniform(0.1, 1.0),
                           damping=dice.uniform(0.5, 2.5), target=dice.uniform(9, 14), leads=vehicle == 0,
                           predecessor=None if vehicle == 0 else vehicle - 1)
            if begin < t < end or dice.random() < 0.2:
                continue
            message = dict(at=stamp + int(delay * SECOND), stamp=stamp, vehicle=vehicle, position=float(position),
                           speed=float(speed), acceleration=float(acceleration), law=law)
            heard.append(message)
            if dice.random() < 0.05:
                heard.append(dict(message, at=message["at"] + dice.randrange(1, 200_000)))
    heard.sort(key=lambda message: (message["at"], message["stamp"], message["vehicle"]))
    return heard


def message_rows(heard):
    for m in heard:
        law = m["law"] or {}
        yield [m["at"], m["stamp"], m["vehicle"], m["position"], m["speed"], m["acceleration"]] + [
            law.get(key) for key in ("length", "target", "gap", "gain", "damping")
        ] + [law.get("predecessor")]


# The paper, with integer time.


def nearest(instant, anchor, step):
    doubled = 2 * (instant - anchor) + step
    if doubled % (2 * step) == 0:
        raise ValueError("a tie between two steps: take another seed")
    return doubled // (2 * step)


def held(values, index):
    return values[min(max(index, 0), len(values) - 1)]


def eq13(v, r_now, r_ahead, v_ahead, length, law, dt):
    """Eq. 13 with the missing step, as printed; linear in the speed sought, so two evaluations solve it."""

    def defect(x):
        spacing = r_now - r_ahead + length + x * law["gap"]
        return v - law["gain"] * dt * (spacing + law["damping"] * (x - v_ahead)) - x

    at_zero, at_one = defect(0.0), defect(1.0)
    return at_zero / (at_zero - at_one)


def paper_horizon(sample, ahead, step):
    count, dt = round(5 * SECOND / step), step / SECOND
    law, r, v = sample["law"], [sample["position"]], [sample["speed"]]
    for k in range(1, count + 1):
        r.append(r[k - 1] + v[k - 1] * dt)
        if ahead is None:
            wanted = law["target"] if law else 13.4
            v.append(max(0.0, v[k - 1] + 0.73 * (1 - (v[k - 1] / wanted) ** 4) * dt))
            continue
        tau = ahead["at"] - ahead["stamp"]
        index = nearest(sample["stamp"] + k * step - tau, ahead["stamp"], step)
        r_ahead, v_ahead = held(ahead["r"], index), held(ahead["v"], index)
        if tau >= step:
            index = min(max(index, 0), count)
            v_ahead += tau / step * (held(ahead["v"], index + 1) - held(ahead["v"], index))
        r_ahead += v_ahead * tau / SECOND
        length = ahead["law"]["length"] if ahead["law"] else 4.8
        v.append(max(0.0, eq13(v[k - 1], r[k], r_ahead, v_ahead, length, law, dt)))
    return r, v


def paper_rows(heard, step, instants):
    known, read = {}, 0
    for instant in instants:
        while read * step <= instant:
            due = [m for m in heard if (read - 1) * step < m["at"] <= read * step]
            for m in due:
                old = known.get(m["vehicle"])
                if old is None or m["stamp"] > old["stamp"]:
                    law = m["law"] or (old["law"] if old else None)
                    horizon = {key: old[key] if old else None for key in ("r", "v", "anchor")}
                    known[m["vehicle"]] = dict(m, law=law, news=True, **horizon)
            string, vehicle = [], TARGET
            while vehicle in known:
                string.insert(0, vehicle)
                law = known[vehicle]["law"]
                vehicle = law["predecessor"] if law and not law["leads"] else None
            for place, vehicle in enumerate(string):
                if known[vehicle]["news"]:
                    ahead = known[string[place - 1]] if place else None
                    known[vehicle]["r"], known[vehicle]["v"] = paper_horizon(known[vehicle], ahead, step)
                    known[vehicle].update(news=False, anchor=known[vehicle]["stamp"])
            read += 1
        target = known.get(TARGET)
        if target is None or target["r"] is None:
            yield [step, instant, None, None]
        else:
            index = nearest(instant, target["anchor"], step)
            yield [step, instant, held(target["r"], index), held(target["v"], index)]


# The Kalman filter with whole matrices.


def kalman_rows(heard, instants):
    generator = numpy.array([[0.0, 1, 0], [0, 0, 1], [0, 0, 0]])
    spread = numpy.diag([0.0, 0.0, 1.0])
    observe, noise = numpy.array([[1.0, 0, 0], [0, 1, 0]]), numpy.diag([0.3**2, 0.1**2])
    x, p, stamp = None, None, None
    pending = [m for m in heard if m["vehicle"] == TARGET]
    for instant in instants:
        while pending and pending[0]["at"] <= instant:
            m = pending.pop(0)
            z = numpy.array([m["position"], m["speed"]])
            if x is None:
                x, p, stamp = numpy.array([*z, 0.0]), numpy.diag([0.3**2, 0.1**2, 2.0**2]), m["stamp"]
            elif m["stamp"] > stamp:
                h, stamp = (m["stamp"] - stamp) / SECOND, m["stamp"]
                van_loan = expm(numpy.block([[-generator, spread], [numpy.zeros((3, 3)), generator.T]]) * h)
                f = van_loan[3:, 3:].T
                x, p = f @ x, f @ p @ f.T + f @ van_loan[:3, 3:]
                gain = p @ observe.T @ numpy.linalg.inv(observe @ p @ observe.T + noise)
                keep = numpy.eye(3) - gain @ observe
                x, p = x + gain @ (z - observe @ x), keep @ p @ keep.T + gain @ noise @ gain.T
        if x is None:
            yield [instant, None, None]
        else:
            way, speed = moved(generator, float(x[1]), float(x[2]), (instant - stamp) / SECOND)
            yield [instant, float(x[0] + way), float(speed)]


# The discrete equations of a string of eight, limits and lag included.


def string_of_eight(dice):
    return [dict(position=-float(n) * dice.uniform(12, 22), speed=dice.uniform(4, 16), acceleration=dice.uniform(-2, 1),
                 demand=dice.uniform(-2, 1), length=dice.uniform(3, 18), standstill=dice.uniform(0, 4),
                 target=dice.uniform(3, 20), gap=dice.uniform(0.4, 2), gain=dice.uniform(0.05, 2),
                 damping=dice.uniform(0.2, 3), lag=dice.choice([0.0, dice.uniform(0.05, 1)]),
                 fastest=dice.uniform(0.5, 3), hardest=dice.uniform(1, 6), jerk=dice.uniform(0.5, 20)) for n in range(8)]


def driven(vehicle, ahead, step, count):
    """States of every step; `ahead` are those of the vehicle before it and its length."""
    state = [vehicle["position"], vehicle["speed"], vehicle["acceleration"], vehicle["demand"]]
    states = [state]
    for k in range(1, count + 1):
        r, v, a, last = state
        if ahead is None:
            u = max(0.73 - 0.73 * (v / vehicle["target"]) ** 4, -vehicle["hardest"])
        else:
            (r_ahead, v_ahead, _, _), length = ahead[0][k], ahead[1] + vehicle["standstill"]
            u = (eq13(v, r + v * step, r_ahead, v_ahead, length, vehicle, step) - v) / step
        low = max(-vehicle["hardest"], last - vehicle["jerk"] * step)
        high = min(vehicle["fastest"], last + vehicle["jerk"] * step)
        u = max(min(u, high), low)
        if vehicle["lag"] > 0:
            carry = expm(numpy.array([[0, 1, 0], [0, -1 / vehicle["lag"], 1 / vehicle["lag"]], [0, 0, 0]]) * step)
            v_next, a_next, _ = (float(x) for x in carry @ [v, a, u])
        else:
            v_next, a_next = v + u * step, u
        if v_next < 0:
            v_next, a_next = 0.0, max(a_next, 0.0)
        state = [r + (v + v_next) / 2 * step, v_next, a_next, u]
        states.append(state)
    return states


def string_rows(dice):
    for number in range(6):
        step, count = [(0.01, 400), (0.05, 80), (0.1, 50), (0.01, 200), (0.2, 20), (1.0, 5)][number]
        ahead = None
        for place, vehicle in enumerate(string_of_eight(dice)):
            states = driven(vehicle, ahead, step, count)
            ahead = (states, vehicle["length"])
            for k in (1, count // 2, count):
                yield [number, place, step, k, *vehicle.values(), *(float(x) for x in states[k])]


def main():
    write("motion.csv", ["speed_mps", "acceleration_mps2", "age_s", "constant_position_m", "constant_speed_mps",
                         "singer_position_m", "singer_speed_mps"],
          ([float(x) for x in row] for row in motion_rows(random.Random(1))))
    dice = random.Random(4)
    heard = messages(dice)
    write("messages.csv", ["at_us", "stamp_us", "vehicle", "position_m", "speed_mps", "acceleration_mps2", "length_m",
                           "target_speed_mps", "time_gap_s", "gain", "damping_s", "predecessor"], message_rows(heard))
    write("paper.csv", ["step_us", "now_us", "position_m", "speed_mps"],
          (row for step in (10_000, 100_000, 1_000_000)
           for row in paper_rows(heard, step, sorted(dice.randrange(0, 26 * SECOND) for _ in range(250)))))
    write("kalman.csv", ["now_us", "position_m", "speed_mps"],
          kalman_rows(heard, sorted(dice.randrange(0, 26 * SECOND) for _ in range(250))))
    write("strings.csv", ["string", "place", "step_s", "steps", "position_m", "speed_mps", "acceleration_mps2",
                          "demand_mps2", "length_m", "standstill_m", "target_speed_mps", "time_gap_s", "gain",
                          "damping_s", "lag_s", "limit_acceleration_mps2", "limit_braking_mps2", "limit_jerk_mps3",
                          "end_position_m", "end_speed_mps", "end_acceleration_mps2", "end_demand_mps2"],
          string_rows(random.Random(2)))


if __name__ == "__main__":
    main()
