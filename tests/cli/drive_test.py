"""proofmass drive, on wheels that are computed here: speed, bend and position fixes of one drive."""
import json
import math
import random
import unittest

from command import USAGE, CommandTest

GRAVITY, RADIUS, TRACK = 9.80665, 0.3, 1.5
DURATION, RATE = 60.0, 100


def speed(t):
    up, down = min(max((t - 4) / 8, 0), 1), min(max((56 - t) / 8, 0), 1)
    return 5 * min(up, down)


class Drive:
    """A bend of curvature 0.02 per metre at up to 5 m/s, in steps of a millisecond."""

    def __init__(self):
        self.rows, x, y, yaw, path, step = [], 0.0, 0.0, 0.0, 0.0, 1e-3
        wheels = {"right": 0.4, "left": 1.3}
        for k in range(int(DURATION / step)):
            v = speed(k * step)
            w = 0.02 * v
            if k % 10 == 0:
                self.rows.append((k * step, x, y, yaw, v, w, dict(wheels)))
            x += v * step * math.cos(yaw)
            y += v * step * math.sin(yaw)
            yaw += w * step
            path += v * step
            wheels["right"] += (v + w * TRACK / 2) * step / RADIUS
            wheels["left"] += (v - w * TRACK / 2) * step / RADIUS
        self.distance, self.turn, self.end = path, yaw, (x, y)

    def wheel(self, side, gyroscope=True) -> str:
        noise = random.Random(side)
        heading = "time (s),acc_x (m/s^2),acc_y (m/s^2),acc_z (m/s^2)"
        lines = [heading + (",gyr_x (rad/s),gyr_y (rad/s),gyr_z (rad/s)" if gyroscope else "")]
        sign = 1 if side == "right" else -1
        for t, _, _, _, v, w, angles in self.rows:
            a = angles[side]
            spin = (v + sign * w * TRACK / 2) / RADIUS
            # With z along the axle, the upward direction turns in x and y.
            values = [GRAVITY * math.sin(a), GRAVITY * math.cos(a), 0.0]
            if gyroscope:
                values += [w * math.sin(a), w * math.cos(a), spin]
            size = [0.05] * 3 + [0.002] * 3
            lines.append(f"{t:.3f}," + ",".join(f"{x + s * noise.gauss(0, 1):.6f}" for x, s in zip(values, size)))
        return "\n".join(lines) + "\n"

    def encoder(self, side) -> str:
        return "time (s),encoder\n" + "".join(f"{t:.3f},{int(a[side] * 1000 / (2 * math.pi))}\n" for t, *_, a in self.rows)

    def frame(self) -> str:
        noise = random.Random("frame")
        return "time (s),acc_x (m/s^2),acc_y (m/s^2),acc_z (m/s^2),gyr_x (rad/s),gyr_y (rad/s),gyr_z (rad/s)\n" + "".join(
            f"{t:.3f},0.1,{v * w:.4f},{GRAVITY + 0.05 * noise.gauss(0, 1):.4f},0.001,0.002,{w + 0.01 + 0.002 * noise.gauss(0, 1):.5f}\n"
            for t, _, _, _, v, w, _ in self.rows)

    def nmea(self) -> str:
        """At 5 Hz from 10:00:00, with the vehicle heading north-east at the start."""
        noise, lines = random.Random("fixes"), []
        for t, x, y, *_ in self.rows[::20]:
            east = (x - y) * math.sqrt(0.5) + 0.05 * noise.gauss(0, 1)
            north = (x + y) * math.sqrt(0.5) + 0.05 * noise.gauss(0, 1)
            latitude = 48.1 + math.degrees(north / 6366000)
            longitude = 11.1 + math.degrees(east / (6390000 * math.cos(math.radians(48.1))))
            body = (
                f"GPGGA,{100000 + 100 * int(t // 60) + t % 60:09.2f},{48 * 100 + 60 * (latitude - 48):.6f},N,"
                f"{11 * 100 + 60 * (longitude - 11):011.6f},E,1,08,0.9,500.0,M,46.9,M,,"
            )
            checksum = 0
            for c in body.encode():
                checksum ^= c
            lines.append(f"${body}*{checksum:02X}\r\n")
        return "".join(lines)


class Vehicle(CommandTest):
    drive = Drive()
    known = ("--circumference", 2 * math.pi * RADIUS, "--track", TRACK)

    def setUp(self):
        super().setUp()
        for side in ("right", "left"):
            self.write(f"{side}.csv", self.drive.wheel(side))

    def close(self, quantity, truth, at_most):
        self.assertLess(quantity["std"], at_most)
        self.assertAlmostEqual(quantity["value"], truth, delta=4 * quantity["std"] + 1e-6)

    def test_path_from_the_gyroscopes_of_two_wheels(self):
        document = self.document("drive", "--right", "right.csv", "--left", "left.csv", *self.known)
        self.close(document["distance_m"], self.drive.distance, 0.01 * self.drive.distance)
        self.close(document["heading_change_rad"], self.drive.turn, 0.1)
        for quantity, truth in zip(document["end_m"], self.drive.end):
            self.close(quantity, truth, 10)
        self.assertEqual([wheel["side"] for wheel in document["wheels"]], ["right", "left"])
        self.assertEqual(len(document["clock_offsets_s"]), 2)
        self.assertIsNone(document["heading_start_rad"])
        self.assertTrue(any("relative to the start" in reason for reason in document["not_observable"]))

    def test_one_side_without_gyroscope_has_no_heading(self):
        document = self.document("drive", "--right", "right.csv", "--no-gyro", "--circumference", 2 * math.pi * RADIUS)
        self.assertIsNone(document["heading_change_rad"])
        self.assertEqual(document["end_m"], [None, None])
        self.assertTrue(any("do not show turns" in reason for reason in document["not_observable"]))

    def test_fixes_give_scale_and_direction(self):
        self.write("fixes.nmea", self.drive.nmea())
        document = self.document("drive", "--right", "right.csv", "--left", "left.csv", "--gnss", "fixes.nmea",
                                 "--geojson", "path.geojson", "-o", "path.csv", "--report", "path.html")
        self.close(document["distance_m"], self.drive.distance, 0.02 * self.drive.distance)
        self.close(document["heading_start_rad"], math.pi / 4, 0.1)
        self.close(document["wheels"][0]["circumference_m"], 2 * math.pi * RADIUS, 0.05)
        collection = json.loads((self.folder / "path.geojson").read_text())
        line = collection["features"][0]["geometry"]["coordinates"]
        self.assertAlmostEqual(line[0][0], 11.1, places=4)
        self.assertGreater(len(line), 100)
        self.assertIn("The path to scale", (self.folder / "path.html").read_text())
        self.assertIn("heading", (self.folder / "path.csv").read_text().splitlines()[0])

    def test_encoders_count_turns(self):
        for side in ("right", "left"):
            self.write(f"{side}.csv", self.drive.encoder(side))
        document = self.document("drive", "--right", "right.csv", "--left", "left.csv", "--counts-per-turn", 1000,
                                 *self.known)
        self.close(document["distance_m"], self.drive.distance, 0.01 * self.drive.distance)

    def test_files_of_one_logger_from_zero_share_a_clock(self):
        for side in ("right", "left"):
            self.write(f"{side}.csv", self.drive.encoder(side))
        self.write("frame.csv", self.drive.frame())
        words = ("drive", "--right", "right.csv", "--left", "left.csv", "--frame", "frame.csv", "--counts-per-turn", 1000,
                 *self.known)
        document = self.document(*words)
        self.assertEqual([offset["value"] for offset in document["clock_offsets_s"]], [0, 0, 0])
        self.close(document["heading_change_rad"], self.drive.turn, 0.1)
        # A shorter file is another recorder's: its clock is found by the turns of the wheels.
        self.write("frame.csv", "".join(line + "\n" for i, line in enumerate(self.drive.frame().splitlines())
                                        if i == 0 or i > 50))
        document = self.document(*words)
        self.assertEqual(document["clock_offsets_s"][1]["value"], 0)
        self.close(document["heading_change_rad"], self.drive.turn, 0.1)

    def test_what_is_missing_is_said(self):
        self.assertIn("--right", self.expect_failure(USAGE, "drive", "--frame", "right.csv"))
        self.assertIn("--gnss", self.expect_failure(USAGE, "drive", "--right", "right.csv", "--geojson", "a.geojson"))
        self.assertIn("twice", self.expect_failure(USAGE, "drive", "--right", "right.csv", "--left", "right.csv"))
        self.assertIn("metres", self.expect_failure(USAGE, "drive", "--right", "right.csv", "--circumference", "1800"))
        line = self.expect_failure(USAGE, "drive", "--right", "right.csv", "--circumference", "1.8", "1.9")
        self.assertIn("2 values for 1 wheels", line)
        self.assertIn("--front", self.expect_failure(USAGE, "drive", "--right", "right.csv", "--front", "left.csv"))


if __name__ == "__main__":
    unittest.main()
