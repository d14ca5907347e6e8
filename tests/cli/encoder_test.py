"""proofmass calibrate --encoder and wheel --encoder, on a wheel whose encoder is known."""
import math
import random
import tomllib

from command import FAILED, USAGE, CommandTest, parse_json

G, RATE_HZ, COUNTS = 9.81, 200, 2048
ECCENTRICITY, PHASE = 0.005, 0.7


def encoder(angle):
    return angle + ECCENTRICITY * math.cos(angle + PHASE) + 0.0008 * math.cos(2 * angle + 1)


def wheel(seconds=60, missed_at=None, wrap=65536):
    draw = random.Random(3)
    rows = ["time (s),acc_x (m/s^2),acc_y (m/s^2),acc_z (m/s^2),encoder (counts),index"]
    angle, radius = 0.3, 0.08
    for k in range(RATE_HZ * seconds):
        t = k / RATE_HZ
        speed = 1.2 * (1 + 0.01 * math.cos(angle + 0.3))
        accel = -1.2 * speed * 0.01 * math.sin(angle + 0.3)
        u = 1.01 * (G * math.sin(angle + 0.5) - radius * speed**2) + 0.2
        v = 0.99 * (G * math.cos(angle + 0.5) + radius * accel) - 0.1
        count = math.floor(encoder(angle) * COUNTS / (2 * math.pi))
        if missed_at is not None and t > missed_at:
            count -= 2
        index = 1 if encoder(angle) % (2 * math.pi) < speed / RATE_HZ else 0
        values = [x + draw.gauss(0, 0.018) for x in (u, v, 0.3)]
        rows.append("%.4f,%.4f,%.4f,%.4f,%d,%d" % (t, *values, count % wrap, index))
        angle += speed / RATE_HZ
    return "\n".join(rows) + "\n"


class Encoder(CommandTest):
    def calibrated(self, *flags):
        text = self.succeed("calibrate", "wheel.csv", "--encoder", "--counts-per-turn", COUNTS, *flags, "--json", "-")
        document = parse_json(text)
        self.check_document("calibrate_encoder", document)
        return document

    def test_finds_the_eccentricity_and_writes_it_into_the_sensor_file(self):
        self.write("wheel.csv", wheel())
        found = self.calibrated("--index", "index", "--update-sensor", "wheel.toml")
        once = found["harmonics"][0]
        low, high = once["amplitude_95_rad"]
        self.assertLess(low, ECCENTRICITY)
        self.assertGreater(high, ECCENTRICITY)
        self.assertLess(once["amplitude"]["std"], 0.0003)
        self.assertAlmostEqual(once["phase"]["value"], PHASE, delta=0.15)
        self.assertEqual(found["missed_counts"], [])
        self.assertAlmostEqual(found["resolution_rad"], 2 * math.pi / COUNTS)
        model = tomllib.loads((self.folder / "wheel.toml").read_text())["encoder"]
        self.assertEqual(model["counts_per_turn"]["value"], COUNTS)
        self.assertAlmostEqual(model["once_cos"]["value"], once["cos"]["value"])
        self.assertIn("Encoder", self.succeed("sensor", "show", "wheel.toml"))

    def test_names_missed_counts(self):
        self.write("wheel.csv", wheel(missed_at=30))
        found = self.calibrated()["missed_counts"]
        self.assertEqual([slip["counts"] for slip in found], [-2])
        low, high = found[0]["interval_95_s"]
        self.assertLess(low, 30)
        self.assertGreater(high, 30)
        self.assertLess(high - low, 1)

    def test_a_wrapping_count_is_followed(self):
        self.write("wheel.csv", wheel(wrap=4096))
        once = self.calibrated("--wrap", 4096)["harmonics"][0]
        self.assertAlmostEqual(once["amplitude"]["value"], ECCENTRICITY, delta=0.001)

    def test_the_wheel_uses_it(self):
        self.write("wheel.csv", wheel(missed_at=30))
        flags = "--spin-axis", "z", "--index", "index"
        alone = parse_json(self.succeed("wheel", "wheel.csv", *flags[:2], "--json", "-"))
        self.assertIsNone(alone["encoder"])
        text = self.succeed("wheel", "wheel.csv", "--encoder", "--counts-per-turn", COUNTS, *flags, "--json", "-")
        found = parse_json(text)
        self.check_document("wheel", found)
        self.assertLess(found["peak_speed_rpm"]["std"], 0.5 * alone["peak_speed_rpm"]["std"])
        self.assertAlmostEqual(found["turns"]["value"], alone["turns"]["value"], delta=4 * found["turns"]["std"])
        encoder = found["encoder"]
        self.assertEqual(encoder["channel"], "encoder")
        self.assertFalse(encoder["reversed"])
        once = encoder["once_cos_rad"]
        self.assertAlmostEqual(once["value"], ECCENTRICITY * math.cos(PHASE), delta=4 * once["std"])
        self.assertEqual([slip["counts"] for slip in encoder["missed_counts"]], [-2])

    def test_says_what_it_needs(self):
        self.write("wheel.csv", wheel(20))
        self.assertIn("--counts-per-turn", self.expect_failure(USAGE, "calibrate", "wheel.csv", "--encoder"))
        for verb in ("calibrate", "wheel"):
            self.assertIn("--encoder", self.expect_failure(USAGE, verb, "wheel.csv", "--counts-per-turn", COUNTS))
        self.expect_failure(USAGE, "calibrate", "wheel.csv", "--encoder", "--counts-per-turn", COUNTS,
                            "--encoder-channel", "absent")
        self.expect_failure(USAGE, "calibrate", "wheel.csv", "--encoder", "--counts-per-turn", COUNTS, "--means")
        self.assertIn("--counts-per-turn", self.expect_failure(USAGE, "wheel", "wheel.csv", "--encoder"))
        self.assertIn("--counts-per-turn", self.expect_failure(FAILED, "wheel", "wheel.csv", "--encoder",
                                                            "--counts-per-turn", 4 * COUNTS))


if __name__ == "__main__":
    import unittest

    unittest.main()
