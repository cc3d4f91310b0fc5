#!/usr/bin/env python3
"""Facts about recordings.py, on small files in the formats as published; the last one asks `holdover-sim` what it thinks.

    test_recordings.py HOLDOVER_SIM
"""

import csv
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

import recordings

DBC = Path(__file__).resolve().parents[2] / "holdover.dbc"
PROGRAM = sys.argv.pop(1)


def rows(file):
    with open(file) as text:
        return [{key: float(value) if value else None for key, value in row.items()} for row in csv.DictReader(text)]


class Converted(unittest.TestCase):
    def setUp(self):
        held = tempfile.TemporaryDirectory()
        self.addCleanup(held.cleanup)
        self.folder = Path(held.name)

    def convert(self, *arguments):
        recordings.main([str(argument) for argument in arguments])

    def refused(self, *arguments):
        with self.assertRaises(SystemExit) as ended:
            self.convert(*arguments)
        return str(ended.exception.code)

    def is_sound(self, *files):
        checked = subprocess.run([PROGRAM, "check", *files], capture_output=True, text=True)
        self.assertEqual(checked.returncode, 0, checked.stdout + checked.stderr)

    def test_a_segment_of_comma2k19_is_its_way_and_speed(self):
        pose = self.folder / "40" / "global_pose"
        pose.mkdir(parents=True)
        t = 46408.5 + np.arange(200) / 20
        # 10 m/s on a line that is neither along an axis nor through the centre of the earth.
        direction = np.array([0.6, 0.0, 0.8])
        for name, array in [("frame_times", t), ("frame_positions", [4e6, -3e6, 3e6] + np.outer((t - t[0]) * 10, direction)),
                            ("frame_velocities", np.tile(10 * direction, (200, 1)))]:
            with open(pose / name, "wb") as file:
                np.save(file, array)
        self.convert("comma2k19", self.folder / "40", self.folder / "m.csv")
        drive = rows(self.folder / "m.csv")
        self.assertEqual(drive[0], {"t_s": 0.0, "position_m": 0.0, "speed_mps": 10.0})
        self.assertAlmostEqual(drive[-1]["position_m"], 99.5, places=2)
        self.is_sound(self.folder / "m.csv")
        self.assertIn("has no global_pose/frame_times; give the folder", self.refused("comma2k19", self.folder, "x.csv"))

    def test_a_run_of_cicv5g_is_a_drive_and_a_link(self):
        header = ("pub_time(ms) sub_time(ms) delay(ms) utmX(m) utmY(m) heading(rad) velocity(m/s) cellid(db) sinr(db) rsrp(db) "
                  "currentX(m) currentY currentHeading(rad)")
        line = lambda n, delay: (f"{1723188920442 + 55 * n} {1723188920442 + 55 * n + delay} {delay} 329059.98 3463127.09 -2.49 "
                                 f"{5 + 0.01 * n:.15f} 5C4225714 7 -93 329059.97 3463127.09 -2.48")
        text = "\n".join([header, *(line(n, -1 if n == 3 else 40 + n % 7) for n in range(100)), ""])
        (self.folder / "run.txt").write_text(text)
        self.convert("cicv5g", self.folder / "run.txt", "--motion", self.folder / "m.csv", "--channel", self.folder / "c.csv")
        link, drive = rows(self.folder / "c.csv"), rows(self.folder / "m.csv")
        self.assertEqual(link[1], {"t_s": 0.055, "delay_s": 0.041})
        self.assertEqual([row["delay_s"] for row in link].count(None), 1)
        t = 99 * 0.055
        self.assertAlmostEqual(drive[-1]["position_m"], 5 * t + 0.5 * (0.01 / 0.055) * t * t, places=2)
        self.is_sound(self.folder / "m.csv", self.folder / "c.csv")
        (self.folder / "run.txt").write_text(header + "\n1 2\n")
        self.assertIn("line 2 is no message", self.refused("cicv5g", self.folder / "run.txt", "--motion", "m.csv"))
        (self.folder / "run.txt").write_text("t;v\n1;2\n")
        self.assertIn("has no column pub_time(ms)", self.refused("cicv5g", self.folder / "run.txt", "--motion", "m.csv"))

    def test_a_platoon_of_openacc_is_on_one_axis(self):
        about = "Date,15,10,2019\nVehicle_order,A,B\nNumber_of_vehicles,2\nACC,1\nDistance_setting,short\n"
        header = "Time,Speed1,Lat1,Lon1,Alt1,E1,N1,U1,Speed2,Lat2,Lon2,Alt2,E2,N2,U2,IVS1,Driver2\n"
        def line(n):
            t = n / 10
            return (f"{t + 50:.1f},12,0.8,0.3,150,{300 + 7.2 * t},{400 + 9.6 * t},0,"
                    f"{'' if n == 0 else 12},0.8,0.3,150,{285 + 7.2 * t},{380 + 9.6 * t},0,20.5,ACC\n")
        (self.folder / "run.csv").write_text(about + header + "".join(map(line, range(100))))
        self.convert("openacc", self.folder / "run.csv", self.folder / "out")
        leader, follower = rows(self.folder / "out/veh1.csv"), rows(self.folder / "out/veh2.csv")
        self.assertEqual((leader[0]["position_m"], follower[0]["position_m"]), (25.0, 0.0))
        self.assertAlmostEqual(leader[-1]["position_m"] - follower[-1]["position_m"], 25.0, places=2)
        self.assertEqual((leader[0]["t_s"], len(leader), len(follower)), (0.0, 99, 99))
        self.is_sound(self.folder / "out/veh1.csv", self.folder / "out/veh2.csv")
        (self.folder / "run.csv").write_text("a,b\n1,2\n")
        self.assertIn("no header that begins with Time", self.refused("openacc", self.folder / "run.csv", self.folder))

    def test_a_run_of_tlssc_is_the_drive_of_one_car_or_of_two(self):
        alone = "Track Name,Time,Geometry,Latitude,Longitude,Elevation,Speed,Speed_Smoothed\n"
        line = lambda n: f"Track 5,15-05-2025 22:44:{5 + n // 10:02}.{n % 10}00 -0500,POINTZ(1 2 3),43.0155,-89.4416,268.9,{8 + 0.1 * n},0\n"
        (self.folder / "25-mph_1.csv").write_text(alone + "".join(map(line, range(50))))
        self.convert("tlssc", self.folder / "25-mph_1.csv", self.folder / "one")
        drive = rows(self.folder / "one/veh1.csv")
        self.assertEqual((drive[0], drive[1]["t_s"], len(drive)), ({"t_s": 0.0, "position_m": 0.0, "speed_mps": 8.0}, 0.1, 50))
        self.assertAlmostEqual(drive[-1]["position_m"], 8 * 4.9 + 0.5 * 4.9 * 4.9, places=2)
        self.is_sound(self.folder / "one/veh1.csv")
        # Two fixes a second of the leader, between which the publishers drew lines; a whole second has no decimals. Both go west.
        two = "Time,Track Name_lead,Latitude_lead,Longitude_lead,Speed_lead,Latitude_follow,Longitude_follow,Speed_follow,Speed_lead_smoothed\n"
        degrees = 1 / (math.radians(1) * 6_371_009 * math.cos(math.radians(43)))
        def pair(n):
            clock = f"2025-06-10 23:29:{5 + n // 10:02}{f'.{n % 10}00000' if n % 10 else ''}-05:00"
            way = 12 * n / 10 * degrees
            return f"{clock},,43.0,{-89.4 - 25 * degrees - way:.9f},{'' if n == 0 else 12.0},43.0,{-89.4 - way:.9f},12.0,0\n"
        (self.folder / "gap-2.csv").write_text(two + "".join(map(pair, range(101))))
        self.convert("tlssc", self.folder / "gap-2.csv", self.folder / "two")
        leader, follower = rows(self.folder / "two/veh1.csv"), rows(self.folder / "two/veh2.csv")
        self.assertEqual((len(leader), len(follower), leader[0]["t_s"], follower[0]["position_m"]), (100, 100, 0.0, 0.0))
        for at in (0, -1):
            self.assertAlmostEqual(leader[at]["position_m"] - follower[at]["position_m"], 25, places=2)
        self.is_sound(self.folder / "two/veh1.csv", self.folder / "two/veh2.csv")
        (self.folder / "gap-2.csv").write_text("Time,Speed_lead\n1,2\n")
        self.assertIn("has no column Latitude_lead", self.refused("tlssc", self.folder / "gap-2.csv", self.folder))
        (self.folder / "gap-2.csv").write_text(alone + line(0) + line(1).replace("22:44", "noon"))
        self.assertIn("line 3 is no sample", self.refused("tlssc", self.folder / "gap-2.csv", self.folder))
        (self.folder / "gap-2.csv").write_text(alone)
        self.assertIn("fewer than two samples", self.refused("tlssc", self.folder / "gap-2.csv", self.folder))

    def test_a_log_of_a_unit_is_the_drives_and_the_links_of_its_peers(self):
        scenario = self.folder / "link.toml"
        scenario.write_text("duration_s = 20\n[channel]\ndelay_mean_s = 0.12\ndelay_std_s = 0.02\nloss = 0.2\noutages = [[9, 11]]\n"
                            "applies_to = \"all\"\n")
        log, table = self.folder / "ego.log", self.folder / "all.csv"
        ran = subprocess.run([PROGRAM, "run", scenario, "--no-report", "--candump", log, "--trajectories", table,
                              "--trajectories-every", "0.01"], capture_output=True, text=True)
        self.assertLessEqual(ran.returncode, 1, ran.stderr)
        self.convert("candump", log, "--dbc", DBC, self.folder / "bus")
        peers = sorted(self.folder.glob("bus/peer?_link.csv"))
        self.assertGreaterEqual(len(peers), 4)
        for peer in peers:
            link = rows(peer)
            came = [row["delay_s"] for row in link if row["delay_s"] is not None]
            self.assertAlmostEqual(sum(came) / len(came), 0.12, delta=0.02)
            lost = [row["delay_s"] for row in link].count(None) / len(link)
            self.assertAlmostEqual(lost, 1 - 0.8 * 0.9, delta=0.1, msg=peer.name)
        # The ego's drive is the one that was simulated.
        with open(table) as text:
            true = {float(row["t_s"]): float(row["speed_mps"]) for row in csv.DictReader(text) if row["vehicle"] == "2"}
        drive = rows(self.folder / "bus/ego.csv")
        self.assertGreater(len(drive), 900)
        begins = min(true, key=lambda t: abs(true[t] - drive[0]["speed_mps"]) + t)
        errors = [abs(true[near] - row["speed_mps"]) for row in drive
                  if (near := round(row["t_s"] + begins, 2)) in true]
        self.assertLess(math.sqrt(sum(e * e for e in errors) / len(errors)), 0.3)
        self.assertIn("no EgoMotionA", self.refused("candump", scenario, "--dbc", DBC, self.folder)
                      if scenario.write_text("(1.0) can0 123#00\n") else "")


unittest.main()
