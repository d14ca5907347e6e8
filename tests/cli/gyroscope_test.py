"""proofmass calibrate --gyro, on a sensor whose parameters are known."""
import math
import random
import tomllib
import unittest

from command import USAGE, CommandTest

G = 9.80665
BIAS = (0.01, -0.02, 0.005)  # rad/s
SCALE = (1.02, 0.99, 1.01)
RATE_HZ, STEPS = 100.0, 4


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


class Turned:
    """Gravity's direction in a sensor that is turned by hand: du/dt = u x omega."""

    def __init__(self, seed, noise=1e-3):
        self.draw = random.Random(seed)
        self.up = (0.0, 0.0, 1.0)
        self.noise = noise
        self.rows = []

    def sample(self, omega):
        accel = [G * u + self.draw.gauss(0.0, 0.005) for u in self.up]
        rate = [s * w + b + self.draw.gauss(0.0, self.noise) for s, w, b in zip(SCALE, omega, BIAS)]
        self.rows.append((len(self.rows) / RATE_HZ, accel, rate))

    def rest(self, seconds):
        for _ in range(int(seconds * RATE_HZ)):
            self.sample((0.0, 0.0, 0.0))

    def turn(self, vector, seconds):
        def rate(s):
            part = s / seconds
            return tuple(30.0 * part**2 * (1.0 - part) ** 2 / seconds * v for v in vector)

        count = int(seconds * RATE_HZ)
        h = 1.0 / (RATE_HZ * STEPS)
        for n in range(count):
            for k in range(STEPS):  # midpoint rule
                s = n / RATE_HZ + k * h
                slope = cross(self.up, rate(s))
                middle = tuple(u + 0.5 * h * d for u, d in zip(self.up, slope))
                slope = cross(middle, rate(s + 0.5 * h))
                moved = [u + h * d for u, d in zip(self.up, slope)]
                size = math.sqrt(sum(u * u for u in moved))
                self.up = tuple(u / size for u in moved)
            if n + 1 < count:
                self.sample(rate((n + 1) / RATE_HZ))

    def by_hand(self, rests=16):
        for k in range(rests):
            if k:
                axis = [self.draw.gauss(0.0, 1.0) for _ in range(3)]
                size = self.draw.uniform(1.0, 2.2) / math.sqrt(sum(a * a for a in axis))
                self.turn([size * a for a in axis], 2.0)
            self.rest(3.0)
        return self

    def csv(self, gyroscope=True):
        lines = ["time (s),acc_x (m/s^2),acc_y (m/s^2),acc_z (m/s^2)" +
                 (",gyr_x (rad/s),gyr_y (rad/s),gyr_z (rad/s)" if gyroscope else "")]
        for time, accel, rate in self.rows:
            lines.append(",".join(f"{v:.7g}" for v in [time, *accel, *(rate if gyroscope else [])]))
        return "\n".join(lines) + "\n"


class Gyroscope(CommandTest):
    def calibrated(self, *flags):
        self.write("turned.csv", Turned(1).by_hand().csv())
        return self.document("calibrate", "turned.csv", "--gravity", G, "--monte-carlo", 0, "--gyro", *flags)

    def test_parameters_are_those_of_the_sensor(self):
        found = self.calibrated()["gyroscope"]
        for axis in range(3):
            bias, scale = found["bias"][axis], found["scale"][axis]
            self.assertLess(abs(bias["value"] - BIAS[axis]), 4.0 * bias["std"])
            self.assertLess(abs(scale["value"] - SCALE[axis]), 4.0 * scale["std"] + 2e-5)
            self.assertLess(scale["std"], 1e-3)
            low, high = found["interval_95"]["scale"][axis]
            self.assertLess(low, scale["value"])
            self.assertGreater(high, scale["value"])
        self.assertEqual(len(found["motions"]), 15)
        self.assertEqual((len(found["covariance"]), len(found["covariance"][0])), (21, 21))
        self.assertEqual(len(found["budgets"]), 21)

    def test_sensor_file_has_both_sensors_and_its_export_is_complete(self):
        self.calibrated("--update-sensor", "imu.toml")
        rest = Turned(2)
        rest.rest(120.0)
        self.write("still.csv", rest.csv())
        self.succeed("noise", "still.csv", "--update-sensor", "imu.toml")
        self.succeed("noise", "still.csv", "--channel", "gyr_x", "--channel", "gyr_y", "--channel", "gyr_z",
                     "--update-sensor", "imu.toml")
        model = tomllib.loads((self.folder / "imu.toml").read_text())
        self.assertAlmostEqual(model["gyroscope"]["scale"]["value"][0], SCALE[0], delta=2e-3)
        self.assertEqual(model["gyroscope"]["scale"]["unit"], "1")
        yaml = self.succeed("sensor", "export", "imu.toml", "--format", "imu-yaml", "--rate", "100")
        density = [line for line in yaml.splitlines() if line.startswith("gyroscope_noise_density: ")]
        # 1e-3 rad/s a sample at 100 Hz is 1e-4 rad/s/√Hz.
        self.assertAlmostEqual(float(density[0].split()[1]), 1e-4, delta=1e-5)
        self.assertIn("gyroscope", self.succeed("sensor", "show", "imu.toml"))

    def test_a_gyroscope_may_be_in_a_file_of_its_own(self):
        turned = Turned(1).by_hand()
        self.write("acc.csv", turned.csv(gyroscope=False))
        lines = ["time (s),x,y,z"] + [f"{t:.4f}," + ",".join(f"{6258.0 * r + 32768.0:.0f}" for r in rate)
                                      for t, _, rate in turned.rows]
        self.write("gyr.csv", "\n".join(lines) + "\n")
        found = self.document("calibrate", "acc.csv", "--gravity", G, "--monte-carlo", 0,
                              "--gyro-file", "gyr.csv", "--rate-unit", "counts")["gyroscope"]
        self.assertEqual(found["unit"], "counts")
        self.assertAlmostEqual(found["scale"][0]["value"] / 6258.0, SCALE[0], delta=2e-3)

    def test_says_what_is_missing(self):
        self.write("acc.csv", Turned(1).by_hand().csv(gyroscope=False))
        self.assertIn("no gyroscope", self.expect_failure(USAGE, "calibrate", "acc.csv", "--gyro"))
        self.expect_failure(USAGE, "calibrate", "acc.csv", "--turntable", "1,2,30")
        self.write("turned.csv", Turned(1).by_hand().csv())
        self.expect_failure(USAGE, "calibrate", "turned.csv", "--gyro", "--turntable", "2,1,30")
        line = self.expect_failure(USAGE, "calibrate", "turned.csv", "--gyro", "--turntable", "900,901,30")
        self.assertIn("no samples", line)

    def test_refuses_a_mirrored_gyroscope(self):
        turned = Turned(1).by_hand()
        turned.rows = [(t, a, [-r[0], r[1], r[2]]) for t, a, r in turned.rows]
        self.write("turned.csv", turned.csv())
        self.assertIn("left-handed", self.expect_failure(USAGE, "calibrate", "turned.csv", "--gyro"))


if __name__ == "__main__":
    unittest.main()
