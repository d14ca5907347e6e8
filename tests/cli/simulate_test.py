"""proofmass simulate."""
import csv
import math
import unittest

from command import BAD_INPUT, USAGE, CommandTest


class Simulate(CommandTest):
    def test_it_writes_a_recording_and_the_truth_beside_it(self):
        document = self.document("simulate", "-o", "rig.csv", "--duration", "6", "--rpm", "30")
        self.assertEqual(document["file"], "rig.csv")
        self.assertEqual(document["truth_file"], "rig.truth.csv")
        self.assertEqual(document["samples"], self.document("inspect", "rig.csv")["samples"])
        with open(self.folder / "rig.truth.csv", newline="") as file:
            rows = list(csv.reader(file))
        angle = rows[0].index("angle (rad)")
        turns = (float(rows[-1][angle]) - float(rows[1][angle])) / (2.0 * math.pi)
        self.assertAlmostEqual(turns, document["truth"]["turns"], places=9)
        self.assertAlmostEqual(turns, 3.0, delta=0.05)

    def test_the_same_seed_gives_the_same_bytes_and_another_seed_others(self):
        for name, seed in (("a", "7"), ("b", "7"), ("c", "8")):
            self.succeed("simulate", "-o", f"{name}.csv", "--seed", seed, "--duration", "2")
        a, b, c = ((self.folder / f"{name}.csv").read_bytes() for name in "abc")
        self.assertEqual(a, b)
        self.assertNotEqual(a, c)

    def test_its_printed_description_reads_back_as_the_same_rig(self):
        description = self.succeed("simulate", "--rpm", "17", "--duration", "3", "--print-config")
        self.write("rig.toml", description)
        self.assertEqual(self.succeed("simulate", "rig.toml", "--print-config"), description)
        self.succeed("simulate", "rig.toml", "-o", "a.csv")
        self.succeed("simulate", "--rpm", "17", "--duration", "3", "-o", "b.csv")
        self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes())

    def test_a_coarse_converter_is_seen_as_its_step(self):
        self.succeed("simulate", "-o", "a.csv", "--adc-bits", "10", "--duration", "10")
        channel = self.document("inspect", "a.csv")["channels"][0]
        self.assertIsNotNone(channel["lsb"])

    def test_to_standard_output_it_is_the_recording_alone(self):
        text = self.succeed("simulate", "-o", "-", "--duration", "1", "--rate", "50")
        self.assertTrue(text.startswith("time (s),"))

    def test_without_a_place_to_write_it_asks_for_one(self):
        self.assertIn("-o", self.expect_failure(USAGE, "simulate"))

    def test_a_description_with_an_unknown_key_is_bad_input(self):
        self.write("rig.toml", "colour = 'red'\n")
        self.assertIn("colour", self.expect_failure(BAD_INPUT, "simulate", "rig.toml", "-o", "a.csv"))


class SimulateProcedure(CommandTest):
    def columns(self, name):
        with open(self.folder / name, newline="") as file:
            rows = list(csv.reader(file))
        return {heading: [float(row[k]) for row in rows[1:]] for k, heading in enumerate(rows[0])}

    def test_every_procedure_writes_recording_truth_and_sensor(self):
        for name, positions in (("tumble", 25), ("four-position", 4), ("six-position", 6), ("multi-position", 25)):
            document = self.document("simulate", "--procedure", name, "--rate", "50", "-o", f"{name}.csv")
            self.assertEqual(document["procedure"], name)
            self.assertEqual(len(document["truth"]["positions"]), positions)
            truth = self.columns(document["truth_file"])
            self.assertEqual(max(truth["position"]), positions)
            self.assertEqual(document["samples"], len(truth["rest"]))
            self.assertIn("[calibration]", (self.folder / document["sensor_file"]).read_text())

    def test_the_true_sensor_file_brings_the_rests_to_gravity(self):
        document = self.document("simulate", "--procedure", "six-position", "-o", "a.csv", "--signal", "counts")
        self.succeed("convert", "a.csv", "--sensor", "a.sensor.toml", "-o", "b.csv")
        read = self.columns("b.csv")
        drift = document["truth"]["mean_drift_mps2"]
        for position in document["truth"]["positions"]:
            rows = [k for k, t in enumerate(read["time (s)"]) if position["start_s"] <= t < position["end_s"]]
            for axis, letter in enumerate("xyz"):
                mean = sum(read[f"acc_{letter} (m/s^2)"][k] for k in rows) / len(rows)
                self.assertAlmostEqual(mean, position["force_mps2"][axis] + drift[axis], delta=0.01)

    def test_a_drive_knows_its_friction_and_its_gear(self):
        document = self.document("simulate", "--procedure", "motor", "--duration", "6", "--seed", "3", "-o", "drive.csv")
        figures = document["truth"]
        self.assertEqual(document["procedure"], "motor")
        self.assertEqual([channel["name"] for channel in document["channels"][:2]], ["voltage", "current"])
        truth = self.columns("drive.truth.csv")
        play = [motor - angle + truth["angle (rad)"][0] for motor, angle in zip(truth["motor_angle (rad)"], truth["angle (rad)"])]
        # From one flank to the other: the whole backlash, and never more.
        self.assertAlmostEqual(max(play) - min(play), figures["backlash"], delta=1e-4)
        self.assertEqual(set(truth["contact"]), {-1.0, 0.0, 1.0})

    def test_a_drive_takes_no_flags_of_other_procedures(self):
        for flags in (["--strokes", "3"], ["--rpm", "11"], ["--positions", "4"], ["--print-config"]):
            self.expect_failure(USAGE, "simulate", "--procedure", "motor", *flags, "-o", "drive.csv")

    def test_a_servo_compares_four_kinds_of_feedback(self):
        document = self.document("simulate", "--procedure", "servo", "--seed", "2", "-o", "loops.csv")
        loops = {(one["feedback"], one["friction_compensated"]): one for one in document["loops"]}
        self.assertEqual(len(loops), 8)
        live, gravity = loops["live_estimate", True]["speed"], loops["atan2", True]["speed"]
        self.assertLess(live["settling_s"], 2.0)
        self.assertLess(live["ripple_radps"], 0.3 * gravity["ripple_radps"])
        self.assertIsNone(loops["double_integration", True]["speed"]["settling_s"])
        self.assertEqual(document["delay_s"], 0.01)
        traces = self.columns("loops.csv")
        # The wheel follows the reference of the angle with the encoder.
        off = [a - b for a, b in zip(traces["angle_encoder (rad)"], traces["angle_reference (rad)"])]
        self.assertLess(max(abs(x) for x in off[-200:]), 0.01)
        for flags in (["--strokes", "3"], ["--duration", "9"], ["--print-config"]):
            self.expect_failure(USAGE, "simulate", "--procedure", "servo", *flags)

    def test_a_slide_knows_where_it_was(self):
        document = self.document("simulate", "--procedure", "slide", "--strokes", "3", "--length", "0.5", "--elevation", "30",
                                 "--gyro", "--gravity-removed", "-o", "slide.csv")
        strokes = document["truth"]["strokes"]
        self.assertEqual([stroke["to_m"] for stroke in strokes], [0.5, 0.0, 0.5])
        self.assertEqual([channel["name"] for channel in document["channels"]][3:], ["gyro_x", "gyro_y", "gyro_z"])
        truth = self.columns("slide.truth.csv")
        self.assertEqual(truth["displacement (m)"][-1], 0.5)
        self.assertAlmostEqual(max(truth["velocity (m/s)"]), 15 / 8 * 0.5, delta=0.15)
        self.assertLess(abs(self.columns("slide.csv")["acc_z (m/s^2)"][0]), 1.0)
        self.expect_failure(USAGE, "simulate", "--procedure", "tumble", "--strokes", "3", "-o", "a.csv")
        self.expect_failure(USAGE, "simulate", "--strokes", "3", "-o", "a.csv")

    def test_its_printed_description_reads_back_as_the_same_procedure(self):
        flags = ("--procedure", "tumble", "--positions", "12", "--dwell", "3", "--supply", "3.1", "--session", "4")
        description = self.succeed("simulate", *flags, "--print-config")
        self.write("bench.toml", description)
        read = ("simulate", "--procedure", "tumble", "bench.toml")
        self.assertEqual(self.succeed(*read, "--print-config"), description)
        self.succeed(*read, "-o", "a.csv")
        self.succeed("simulate", *flags, "-o", "b.csv")
        self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes())

    def test_another_session_has_the_same_sensor(self):
        a, b = (self.document("simulate", "--procedure", "four-position", "--session", n, "-o", f"{n}.csv") for n in "12")
        self.assertEqual(a["truth"]["axes"], b["truth"]["axes"])
        self.assertNotEqual((self.folder / "1.csv").read_bytes(), (self.folder / "2.csv").read_bytes())

    def test_supplies_and_table_columns_are_there_where_asked_for(self):
        self.write("bench.toml", "labelled = true\n[table]\nplanes = 2\nremounted = true\n[supply]\nrecorded = true\n")
        document = self.document("simulate", "--procedure", "tumble", "bench.toml", "-o", "a.csv", "--rate", "20")
        self.assertEqual([c["name"] for c in document["channels"]],
                         ["acc_x", "acc_y", "acc_z", "angle", "plane", "mount", "supply"])
        self.assertTrue((self.folder / "a.csv").read_text().splitlines()[0].count("label"))

    def test_flags_that_do_not_go_together_are_refused(self):
        for flags in (("--procedure", "tumble", "--rpm", "3"), ("--positions", "3"),
                      ("--procedure", "six-position", "--positions", "3"), ("--procedure", "tumble", "--dwell", "0.3"),
                      ("--procedure", "tumbling")):
            self.expect_failure(USAGE, "simulate", "-o", "a.csv", *flags)
        self.write("bench.toml", "procedure = 'six-position'\n")
        self.assertIn("line 1", self.expect_failure(BAD_INPUT, "simulate", "--procedure", "tumble", "bench.toml", "-o", "a.csv"))


if __name__ == "__main__":
    unittest.main()
