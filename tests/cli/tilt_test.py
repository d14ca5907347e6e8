"""proofmass tilt, on synthetic files."""
import csv
import math
import random
import unittest

from command import USAGE, CommandTest

G = 9.80665


def force(roll, pitch):
    return (-G * math.sin(pitch), G * math.cos(pitch) * math.sin(roll),
            G * math.cos(pitch) * math.cos(roll))


class Tilt(CommandTest):
    def write(self, name, header, rows):
        with open(self.folder / name, "w") as file:
            if header:
                file.write(",".join(header) + "\n")
            for row in rows:
                file.write(",".join(f"{x:.9g}" for x in row) + "\n")

    def still(self, name="still.csv", roll=0.2, pitch=-0.1, sign=1.0, axes="xyz"):
        noise = random.Random(1)
        f = dict(zip("xyz", force(roll, pitch)))
        rows = [[0.01 * k] + [sign * f[a] + noise.gauss(0.0, 0.01) for a in axes]
                for k in range(1000)]
        self.write(name, ["time (s)"] + [f"acc_{a} (m/s^2)" for a in axes], rows)

    def moving(self, name="moving.csv"):
        noise = random.Random(2)
        rows = []
        for k in range(2000):
            t = 0.01 * k
            moves = 2.0 < t < 18.0
            pitch = 0.3 * (1.0 - math.cos(t - 2.0)) if moves else 0.3 * (1.0 - math.cos(16.0)) * (t >= 18.0)
            rate = 0.3 * math.sin(t - 2.0) if moves else 0.0
            shake = 0.5 if moves else 0.0
            f = [x + noise.gauss(0.0, 0.01) + shake * noise.gauss(0.0, 1.0) for x in force(0.0, pitch)]
            w = [noise.gauss(0.01, 0.005), rate + noise.gauss(-0.02, 0.005), noise.gauss(0.0, 0.005)]
            rows.append([t] + f + w)
        self.write(name, ["time (s)"] + [f"acc_{a} (m/s^2)" for a in "xyz"]
                   + [f"gyro_{a} (rad/s)" for a in "xyz"], rows)

    def swing(self, name="swing.dat"):
        noise = random.Random(3)
        rows = []
        for k in range(2000):
            t, w = 0.002 * k, 2.0 * math.pi
            rows.append([t, 0.3 * w * math.cos(w * t) + 0.03 + noise.gauss(0.0, 0.02),
                         0.3 * math.sin(w * t) + noise.gauss(0.0, 0.03)])
        self.write(name, None, rows)

    def test_a_still_sensor_tells_roll_and_pitch(self):
        self.still()
        document = self.document("tilt", "still.csv", "--bias-std", "0")
        self.assertEqual(document["mode"], "still")
        self.assertEqual(document["samples"], 1000)
        for key, truth in (("roll_rad", 0.2), ("pitch_rad", -0.1)):
            angle = document[key]
            self.assertAlmostEqual(angle["value"], truth, delta=4.0 * angle["std"])
            self.assertLess(angle["std"], 5e-4)
        self.assertEqual(len(document["rests"]), 1)

    def test_an_uncalibrated_sensor_is_as_accurate_as_such_sensors_are(self):
        self.still()
        document = self.document("tilt", "still.csv")
        self.assertIn("calibration is unknown", " ".join(document["warnings"]))
        self.assertTrue(0.004 < document["pitch_rad"]["std"] < 0.02)

    def test_a_sensor_of_the_other_sign_is_turned_round(self):
        self.still(sign=-1.0)
        document = self.document("tilt", "still.csv", "--reads", "-g")
        self.assertAlmostEqual(document["roll_rad"]["value"], 0.2, delta=2e-3)
        self.assertEqual(document["reads"], "-g")

    def test_an_upright_axis_leaves_no_roll_and_says_so(self):
        self.still(pitch=math.pi / 2)
        document = self.document("tilt", "still.csv", "--bias-std", "0.01")
        self.assertIsNone(document["roll_rad"])
        self.assertAlmostEqual(document["pitch_rad"]["value"], math.pi / 2, delta=0.01)

    def test_two_axes_tell_what_they_can(self):
        self.still(axes="xz")
        document = self.document("tilt", "still.csv")
        self.assertIsNone(document["roll_rad"])
        self.assertAlmostEqual(document["pitch_rad"]["value"], -0.1, delta=0.01)

    def test_without_a_rate_rests_are_told_by_sample(self):
        noise = random.Random(5)
        self.write("rateless.csv", [f"acc_{a} (m/s^2)" for a in "xyz"],
                   [[x + noise.gauss(0.0, 0.01) for x in force(0.2, -0.1)] for _ in range(1000)])
        document = self.document("tilt", "rateless.csv")
        self.assertNotIn("start_s", document["rests"][0])
        self.assertAlmostEqual(document["pitch_rad"]["value"], -0.1, delta=0.002)

    def test_a_moving_base_is_followed_with_its_gyroscope(self):
        self.moving()
        document = self.document("tilt", "moving.csv")
        self.assertEqual(document["mode"], "moving")
        self.assertTrue(document["motion"]["gyroscope"])
        truth = 0.3 * (1.0 - math.cos(16.0))
        self.assertAlmostEqual(document["pitch_rad"]["value"], truth, delta=0.01)
        self.assertAlmostEqual(document["rate_bias_radps"][1]["value"], -0.02, delta=0.003)
        alone = self.document("tilt", "moving.csv", "--no-gyro")
        self.assertFalse(alone["motion"]["gyroscope"])

    def test_the_series_has_every_column_with_its_unit(self):
        self.moving()
        self.succeed("tilt", "moving.csv", "--output", "series.csv")
        with open(self.folder / "series.csv", newline="") as file:
            rows = list(csv.reader(file))
        for column in ("time (s)", "roll (rad)", "roll_std (rad)", "pitch (rad)",
                       "pitch_std (rad)", "filtered_pitch (rad)", "filtered_pitch_std (rad)",
                       "weight", "at_rest"):
            self.assertIn(column, rows[0])
        self.assertEqual(len(rows) - 1, 2000)

    def test_an_angle_and_a_rate_of_a_file_without_names(self):
        self.swing()
        document = self.document("tilt", "swing.dat", "--angle", "3", "--rate-channel", "2")
        self.assertEqual(document["mode"], "angle")
        truth = 0.3 * math.sin(2.0 * math.pi * 0.002 * 1999)
        self.assertAlmostEqual(document["angle_rad"]["value"], truth, delta=0.02)
        bias = document["rate_bias_radps"][0]
        self.assertAlmostEqual(bias["value"], 0.03, delta=4.0 * bias["std"] + 0.01)
        page = self.succeed("tilt", "swing.dat", "--angle", "3", "--rate-channel", "2",
                            "--report", "page.html")
        self.assertIn("Angle at the end", page)

    def test_the_report_opens_with_the_answer(self):
        self.moving()
        self.succeed("tilt", "moving.csv", "--report", "page.html")
        page = (self.folder / "page.html").read_text()
        self.assertIn("Roll", page)
        self.assertIn("<svg", page)

    def test_what_makes_no_sense_is_usage(self):
        self.still()
        self.swing()
        self.expect_failure(USAGE, "tilt", "swing.dat", "--angle", "3")
        self.expect_failure(USAGE, "tilt", "swing.dat", "--angle", "9", "--rate-channel", "2")
        self.expect_failure(USAGE, "tilt", "still.csv", "--gyro", "acc_x")
        self.expect_failure(USAGE, "tilt", "still.csv", "--base", "sideways")

    def test_a_force_without_gravity_is_refused(self):
        noise = random.Random(4)
        self.write("removed.csv", ["time (s)"] + [f"acc_{a} (m/s^2)" for a in "xyz"],
                   [[0.01 * k] + [noise.gauss(0.0, 0.1) for _ in "xyz"] for k in range(500)])
        ran = self.run_command("tilt", "removed.csv")
        self.assertNotEqual(ran.returncode, 0)
        self.assertIn(b"gravity was removed", ran.stderr)


if __name__ == "__main__":
    unittest.main()
