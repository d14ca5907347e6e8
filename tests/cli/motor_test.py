"""proofmass motor, on the simulated rig with its drive."""
import csv
import unittest

from command import FAILED, USAGE, CommandTest


class Motor(CommandTest):
    def setUp(self):
        super().setUp()
        self.truth = self.document("simulate", "--procedure", "motor", "--seed", "5", "-o", "drive.csv")["truth"]

    def figures(self, *flags):
        document = self.document("motor", "drive.csv", *flags)
        return document, {one["name"]: one for one in document["parameters"]}

    def test_figures_are_those_of_the_drive(self):
        document, figures = self.figures()
        for name, most in (("torque_constant", 0.005), ("inertia", 0.01), ("coulomb_friction", 0.01), ("backlash", 0.06)):
            found = figures[name]
            self.assertAlmostEqual(found["value"], self.truth[name], delta=4 * found["std"])
            self.assertLess(found["std"], most * self.truth[name], name)
            self.assertLess(found["interval_95"][0], found["value"])
        self.assertEqual(figures["unbalance"]["reason"], "not distinguishable from zero")
        self.assertTrue(document["current_recorded"])
        self.assertGreater(document["reversals"], 8)
        # The curve falls from breakaway, then rises with the viscous friction.
        curve = [point["value"] for point in document["friction"]["curve"]]
        self.assertGreater(curve[0], min(curve) + 0.5)
        self.assertGreater(curve[-1], min(curve) + 0.5)

    def test_without_a_current_only_ratios_are_known(self):
        document, figures = self.figures("--no-current")
        self.assertFalse(document["current_recorded"])
        self.assertAlmostEqual(figures["friction_voltage"]["value"], 3.15 * 13 / 22.6, delta=4 * figures["friction_voltage"]["std"])
        for name in ("inertia", "backlash", "coulomb_friction"):
            self.assertIsNone(figures[name]["value"])
            self.assertIn("no current", figures[name]["reason"])

    def test_the_series_is_written(self):
        self.succeed("motor", "drive.csv", "-o", "motor.csv", "--report", "motor.html")
        with open(self.folder / "motor.csv", newline="") as file:
            heading = next(csv.reader(file))
        self.assertEqual(heading, ["time (s)", "load_angle (rad)", "motor_angle (rad)", "speed (rad/s)", "friction (N*m)", "contact"])
        self.assertIn("Friction against speed", (self.folder / "motor.html").read_text())

    def test_rows_of_a_stuck_logger_and_of_a_clipped_current_do_not_count(self):
        with open(self.folder / "drive.csv", newline="") as file:
            heading, *rows = csv.reader(file)
        at = heading.index("current (A)")
        limit = sorted(abs(float(row[at])) for row in rows)[int(0.97 * len(rows))]
        for row in rows:
            row[at] = f"{min(max(float(row[at]), -limit), limit):.6g}"
        for first in (1500, 4200, 6100):
            for row in rows[first + 1 : first + 250]:
                row[1:] = rows[first][1:]
        self.write("worn.csv", "\n".join(",".join(row) for row in [heading, *rows]) + "\n")
        document = self.document("motor", "worn.csv")
        figures = {one["name"]: one for one in document["parameters"]}
        for name in ("torque_constant", "inertia", "coulomb_friction", "backlash"):
            found = figures[name]
            self.assertAlmostEqual(found["value"], self.truth[name], delta=4 * found["std"], msg=name)
        warnings = " ".join(document["warnings"])
        self.assertIn("current (A): 2", warnings)
        self.assertIn("repeat one value in 747", warnings)

    def test_a_wrong_column_is_named(self):
        self.assertIn("no column 'u'", self.expect_failure(USAGE, "motor", "drive.csv", "--voltage", "u"))
        self.write("other.csv", "time (s),x (m/s^2),y (m/s^2)\n" + "".join(f"{0.01 * k},0,9.8\n" for k in range(500)))
        self.assertIn("--voltage", self.expect_failure(USAGE, "motor", "other.csv"))

    def test_a_drive_at_rest_is_refused(self):
        rows = "".join(f"{0.005 * k:.3f},0,0,0.1,9.8\n" for k in range(2000))
        self.write("rest.csv", "time (s),voltage (V),current (A),acc_x (m/s^2),acc_y (m/s^2)\n" + rows)
        self.assertIn("gravity does not turn", self.expect_failure(FAILED, "motor", "rest.csv"))


if __name__ == "__main__":
    unittest.main()
