"""proofmass tune, on synthetic recordings with known noise."""
import csv
import math
import random
import tomllib
import unittest

from command import FAILED, USAGE, CommandTest


def level(samples, reading_std, step_std, seed, start=0.0):
    """A random walk measured with white noise."""
    draw, values, at = random.Random(seed), [], start
    for _ in range(samples):
        values.append(at + draw.gauss(0.0, reading_std))
        at += draw.gauss(0.0, step_std)
    return values


def table(columns, rate_hz=100.0):
    lines = [",".join(["time (s)", *columns])]
    for k, row in enumerate(zip(*columns.values())):
        lines.append(f"{k / rate_hz:.5f}," + ",".join(f"{value:.10g}" for value in row))
    return "\n".join(lines) + "\n"


class Tune(CommandTest):
    def resting(self, name="rest.csv", samples=6000, step_std=4e-3):
        return self.write(name, table({
            "acc_x (m/s^2)": level(samples, 0.05, step_std, 1, 9.8),
            "acc_y (m/s^2)": level(samples, 0.05, step_std, 2)}))

    def moving(self, name="moving.csv"):
        return self.write(name, table({"acc_x (m/s^2)": level(3000, 0.2, 0.1, 3)}))

    @staticmethod
    def parameter(document, name, channel="acc_x"):
        return next(p for p in document["parameters"] if p["name"] == name and p["channel"] == channel)

    def expect_near(self, parameter, truth):
        self.assertEqual(parameter["verdict"], "identified")
        self.assertAlmostEqual(parameter["value"], truth, delta=4 * parameter["std"])
        lower, upper = parameter["interval_95"]
        self.assertLess(lower, parameter["value"])
        self.assertGreater(upper, parameter["value"])

    def test_a_resting_sensor_is_told_its_density_and_its_walk(self):
        self.resting()
        document = self.document("tune", "rest.csv", "--model", "rest")
        self.expect_near(self.parameter(document, "white"), 0.05 / math.sqrt(100.0))
        self.expect_near(self.parameter(document, "random_walk"), 4e-3 * math.sqrt(100.0))
        self.assertEqual(self.parameter(document, "white")["unit"], "m/s^2/sqrt(Hz)")
        self.assertEqual(self.parameter(document, "random_walk")["unit"], "m/s^2/sqrt(s)")
        self.assertEqual(len(document["parameters"]), 4)
        self.assertTrue(document["converged"])
        self.assertIn(document["consistency"]["verdict"], ("consistent", "undetermined"))

    def test_what_moves_is_taken_for_motion(self):
        self.moving()
        document = self.document("tune", "moving.csv")
        self.assertEqual(document["model"], "pva")
        self.assertIn("at rest", document["model_reason"])
        self.expect_near(self.parameter(document, "jerk_psd"), 0.1**2 * 100.0)
        self.expect_near(self.parameter(document, "accel_variance"), 0.2**2)
        self.assertEqual(self.parameter(document, "jerk_psd")["unit"], "m^2/s^5")

    def test_the_likelihood_is_that_of_its_channels(self):
        self.resting()
        document = self.document("tune", "rest.csv", "--model", "rest")
        self.assertAlmostEqual(document["log_likelihood"],
                               sum(c["log_likelihood"] for c in document["channels"]), places=6)
        steps = document["em_log_likelihood"]
        self.assertEqual(steps, sorted(steps))
        self.assertGreaterEqual(document["log_likelihood"], steps[-1] - 4.0)

    def test_a_walk_that_is_not_there_is_null_with_a_limit_and_a_reason(self):
        self.write("white.csv", table({"acc_x (m/s^2)": level(4000, 0.05, 0.0, 4)}))
        document = self.document("tune", "white.csv", "--model", "rest")
        walk = self.parameter(document, "random_walk")
        self.assertEqual(walk["verdict"], "not_observable")
        self.assertIsNone(walk["value"])
        self.assertGreater(walk["upper_95"], 0.0)
        self.assertIn("zero", walk["reason"])

    def test_a_parameter_may_be_fixed_or_shared(self):
        self.resting()
        document = self.document("tune", "rest.csv", "--model", "rest", "--fix", "white=0.005",
                                 "--share", "random_walk")
        self.assertEqual(self.parameter(document, "white", "all")["verdict"], "fixed")
        self.expect_near(self.parameter(document, "random_walk", "all"), 0.04)
        self.assertEqual(len(document["parameters"]), 2)

    def test_the_study_stands_beside_the_figures(self):
        self.moving()
        study = self.document("tune", "moving.csv")["study"][0]
        tuned, larger_q, larger_r = study["cases"]
        self.assertLess(larger_q["settling_s"][2], larger_r["settling_s"][2])
        self.assertGreater(larger_q["gain_limit"][2], larger_r["gain_limit"][2])
        std = [step["std"] for step in study["steps"]]
        self.assertEqual(std, sorted(std))

    def test_the_sensor_file_takes_the_figures_of_a_rest(self):
        self.resting()
        self.succeed("tune", "rest.csv", "--model", "rest", "--update-sensor", "sensor.toml")
        noise = tomllib.loads((self.folder / "sensor.toml").read_text())["noise"]
        self.assertIn("white", noise)
        self.assertIn("random_walk", noise)
        self.moving()
        self.expect_failure(USAGE, "tune", "moving.csv", "--model", "pva",
                            "--update-sensor", "sensor.toml")

    def test_the_innovations_are_written(self):
        self.moving()
        self.succeed("tune", "moving.csv", "--output", "out.csv")
        with open(self.folder / "out.csv", newline="") as file:
            rows = list(csv.reader(file))
        self.assertIn("acc_x_innovation (m/s^2)", rows[0])
        self.assertIn("acc_x_innovation_std (m/s^2)", rows[0])
        self.assertEqual(len(rows), 3001)

    def test_the_report_opens_with_the_answer(self):
        self.moving()
        self.succeed("tune", "moving.csv", "--report", "tune.html")
        page = (self.folder / "tune.html").read_text()
        for words in ("jerk_psd", "gain against time", "covariance", "innovations"):
            self.assertTrue(words in page, words)

    def test_any_column_has_a_level(self):
        self.write("flow.csv", table({"flow": level(800, 2.0, 1.0, 5, 1000.0)}, rate_hz=1.0))
        document = self.document("tune", "flow.csv", "--model", "local-level")
        self.expect_near(self.parameter(document, "reading_variance", "flow"), 4.0)
        self.expect_near(self.parameter(document, "level_psd", "flow"), 1.0)

    def test_says_what_is_wrong(self):
        self.moving()
        self.write("few.csv", table({"acc_x (m/s^2)": [1.0, 2.0, 1.5]}))
        self.write("same.csv", table({"acc_x (m/s^2)": [1.0] * 500}))
        self.assertIn("NAME=VALUE", self.expect_failure(USAGE, "tune", "moving.csv", "--fix", "white"))
        self.assertIn("jerk_psd", self.expect_failure(USAGE, "tune", "moving.csv", "--fix", "white=1"))
        self.expect_failure(USAGE, "tune", "moving.csv", "--model", "nothing")
        self.expect_failure(FAILED, "tune", "few.csv")
        self.assertIn("equal", self.expect_failure(FAILED, "tune", "same.csv", "--model", "rest"))


if __name__ == "__main__":
    unittest.main()
