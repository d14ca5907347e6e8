"""proofmass wheel, on the simulated rig and on synthetic files."""
import csv
import math
import unittest

from command import BAD_DATA, USAGE, CommandTest, parse_json, turning_csv


class Wheel(CommandTest):
    def simulate(self, name="rig.csv"):
        """Eight seconds, so that a build with sanitizers also completes within minutes."""
        flags = ("--duration", "8", "--rate", "50", "--rpm", "40")
        return self.document("simulate", "-o", name, *flags)["truth"]

    def test_two_sensors_of_one_file_tell_the_turns(self):
        truth = self.simulate()
        document = self.document("wheel", "rig.csv")
        self.assertEqual(len(document["sensors"]), 2)
        self.assertTrue(document["clocks_shared"])
        turns = document["turns"]
        self.assertAlmostEqual(abs(turns["value"]), abs(truth["turns"]), delta=0.005)
        self.assertGreater(turns["std"], 0.0)
        self.assertLess(turns["std"], 0.01)
        self.assertAlmostEqual(document["methods"]["smoother"]["turns"], turns["value"])

    def with_gyro(self, range_mps2=100.0):
        """From rest to 60 rpm and back; the gyroscope has a 2 % scale error and a unit given only in its heading."""
        lasts, top, radius = 20.0, 2.0 * math.pi, 0.05
        rows = ["time (s)," + ",".join(f"acc_{axis} (m/s^2)" for axis in "xyz") + ","
                + ",".join(f"gyr_{axis} (deg/s)" for axis in "xyz")]
        for k in range(2001):
            t = lasts * k / 2000.0
            phase = 2.0 * math.pi * t / lasts
            angle = 0.5 * top * (t - lasts / (2.0 * math.pi) * math.sin(phase))
            speed, accel = 0.5 * top * (1.0 - math.cos(phase)), math.pi * top / lasts * math.sin(phase)
            noise = [0.02 * math.sin(n * k * k) for n in (7.0, 5.0, 3.0, 11.0)] # equidistributed, so nearly white
            x = 9.80665 * math.sin(angle) - speed**2 * radius + noise[0]
            y = 9.80665 * math.cos(angle) + accel * radius + noise[1]
            x = max(x, -range_mps2)
            rows.append(f"{t:.3f},{x:.6f},{y:.6f},{noise[2]:.6f},0.01,-0.02,{1.02 * math.degrees(speed) + 20.0 * noise[3]:.5f}")
        self.write("gyro.csv", "\n".join(rows) + "\n")

    def test_a_gyroscope_is_calibrated_by_the_turns(self):
        self.with_gyro()
        document = self.document("wheel", "gyro.csv", "--spin-axis", "z")
        scale, bias = (document["gyroscope"][name] for name in ("scale", "bias"))
        self.assertAlmostEqual(abs(document["turns"]["value"]), 10.0, delta=0.01)
        self.assertAlmostEqual(scale["value"], 1.02, delta=3.0 * scale["std"])
        self.assertLess(scale["std"], 0.02)
        self.assertAlmostEqual(bias["value"], 0.0, delta=3.0 * bias["std"])
        self.assertEqual((bias["unit"], scale["unit"]), ("rad/s", "1"))

    def test_accelerations_beyond_the_range_are_not_taken_as_measured(self):
        self.with_gyro(range_mps2=10.5)
        document = self.document("wheel", "gyro.csv", "--spin-axis", "z")
        self.assertTrue(any("limits of the range (-10.5 m/s^2)" in text for text in document["warnings"]))
        radius = document["sensors"][0]["radius_m"]  # 48.4 ± 2.1 mm as measured
        self.assertAlmostEqual(radius["value"], 0.05, delta=2.5 * radius["std"])
        self.assertLess(radius["std"], 5e-4)
        self.assertAlmostEqual(abs(document["turns"]["value"]), 10.0, delta=0.01)

    def test_a_gyroscope_can_be_left_alone(self):
        self.with_gyro()
        document = self.document("wheel", "gyro.csv", "--spin-axis", "z", "--no-gyro")
        self.assertIsNone(document["gyroscope"])
        self.assertTrue(any("gyroscope: null" in text for text in document["warnings"]))

    def test_what_is_not_identifiable_is_among_the_warnings(self):
        self.simulate()
        document = self.document("wheel", "rig.csv", "--radius", "0.1")
        self.assertTrue(document["not_observable"])
        self.assertLessEqual(set(document["not_observable"]), set(document["warnings"]))

    def test_a_bandwidth_that_is_given_narrows_the_final_angle(self):
        self.simulate()
        given = self.document("wheel", "rig.csv", "--bandwidth", "100")
        open_ = self.document("wheel", "rig.csv")
        self.assertLess(2.0 * given["angle_final_rad"]["std"], open_["angle_final_rad"]["std"])
        self.assertAlmostEqual(given["delay_s"]["value"], 1.0 / (2.0 * math.pi * 100.0), places=9)

    def test_an_axle_that_is_known_to_be_level_narrows_the_scales(self):
        self.simulate()
        known = self.document("wheel", "rig.csv", "--axle-tilt-std", "0.1", "--bandwidth", "1000")
        open_ = self.document("wheel", "rig.csv", "--bandwidth", "1000")
        self.assertLess(known["sensors"][0]["scale"][0]["std"], open_["sensors"][0]["scale"][0]["std"])

    def test_a_radius_that_the_recording_contradicts_is_an_error_with_both_figures(self):
        self.write("speeds.toml", "bias_spread_mps2 = 0.0\n[[segment]]\nduration_s = 10.0\nspeed_rpm = 40.0\n"
                   "[[segment]]\nduration_s = 12.0\nspeed_rpm = 120.0\nramp_s = 3.0\n[[sensor]]\nradius_m = 0.1\n")
        self.succeed("simulate", "speeds.toml", "-o", "speeds.csv", "--rate", "100")
        ran = self.run_command("wheel", "speeds.csv", "--radius", "0.15", "--radius-std", "0.001", "--strict")
        self.assertEqual(ran.returncode, BAD_DATA, ran.stderr)
        self.assertRegex(ran.stderr.decode(),
                         r"the given radius of 150 mm (±|\+-) 1 mm contradicts the recording's (99|100|101) mm")
        self.succeed("wheel", "speeds.csv", "--radius", "0.1", "--strict")

    def test_the_spin_axis_given_turned_round_turns_the_sign(self):
        self.simulate()
        one = self.document("wheel", "rig.csv", "--spin-axis", "z")["turns"]["value"]
        other = self.document("wheel", "rig.csv", "--spin-axis", "-z")["turns"]["value"]
        written = self.document("wheel", "rig.csv", "--spin-axis", "0,0,-2")["turns"]["value"]
        self.assertAlmostEqual(one, -other, delta=0.005)
        self.assertAlmostEqual(other, written, delta=1e-9)

    def test_one_sensor_of_a_pair_can_be_chosen(self):
        self.simulate()
        flags = [f for axis in "xyz" for f in ("--channel", f"acc1_{axis}")]
        self.assertEqual(len(self.document("wheel", "rig.csv", *flags)["sensors"]), 1)

    def test_two_files_are_two_sensors(self):
        truth = self.simulate()
        for n in "12":
            flags = [f for axis in "xyz" for f in ("--channel", f"acc{n}_{axis}")]
            self.succeed("convert", "rig.csv", *flags, "-o", f"{n}.csv")
        document = self.document("wheel", "1.csv", "2.csv")
        self.assertEqual([s["file"] for s in document["sensors"]], ["1.csv", "2.csv"])
        self.assertAlmostEqual(abs(document["turns"]["value"]), abs(truth["turns"]), delta=0.005)

    def test_the_series_has_every_column_with_its_unit(self):
        self.simulate()
        self.succeed("wheel", "rig.csv", "--output", "series.csv")
        with open(self.folder / "series.csv", newline="") as file:
            rows = list(csv.reader(file))
        for column in ("time (s)", "angle (rad)", "angle_std (rad)", "speed (rad/s)",
                       "speed_std (rad/s)", "accel (rad/s^2)", "accel_std (rad/s^2)",
                       "filtered_angle (rad)", "filtered_angle_std (rad)", "atan2_angle (rad)"):
            self.assertIn(column, rows[0])
        self.assertEqual(len(rows) - 1, self.document("inspect", "rig.csv")["samples"])

    def test_the_report_opens_with_the_answer(self):
        self.simulate()
        text = self.succeed("wheel", "rig.csv", "--report", "r.html")
        self.assertTrue(text.startswith("The wheel turned"))
        page = (self.folder / "r.html").read_text()
        self.assertIn("The wheel turned", page)
        self.assertEqual(page.count("</svg>"), 6)

    def test_the_rim_sets_the_distance_and_the_latitude_gravity(self):
        truth = self.simulate()
        document = self.document("wheel", "rig.csv", "--rim-radius", "0.3", "--latitude", "45")
        self.assertAlmostEqual(document["gravity_mps2"], 9.80620, places=4)
        self.assertEqual(document["distance_of"], "rim")
        self.assertAlmostEqual(document["distance_m"]["value"],
                               abs(truth["turns"]) * 2 * 3.14159265 * 0.3, delta=0.02)

    def test_a_radius_is_not_called_wrong_by_a_recording_that_shows_none(self):
        """At one speed; for this pair the fit without the radius converges to the axle."""
        self.succeed("simulate", "--rpm", "20", "--seed", "3", "-o", "even.csv")
        self.succeed("wheel", "even.csv", "--radius", "0.1", "--strict")

    def test_standard_input_will_do(self):
        csv_text = self.succeed("simulate", "-o", "-", "--duration", "8", "--rate", "50", "--rpm", "40")
        document = self.document("wheel", "-", stdin=csv_text.encode())
        self.assertEqual(document["input"], ["-"])

    def test_corrupt_rows_do_not_reach_the_answer_and_are_counted(self):
        lines = turning_csv(seconds=10, rate_hz=50).splitlines()
        for k in range(200, 220):
            lines[k] = lines[k].split(",")[0] + ",3e34,nan,inf"
        self.write("a.csv", "\n".join(lines) + "\n")
        ran = self.run_command("wheel", "a.csv", "--strict", "--json", "-")
        self.assertEqual(ran.returncode, BAD_DATA)
        document = parse_json(ran.stdout.decode())
        self.check_document("wheel", document)
        self.assertAlmostEqual(abs(document["turns"]["value"]), 5.0, delta=0.03)
        self.assertGreaterEqual(document["rejected_samples"], 20)

    def simulate_warm_up(self):
        """Ten seconds that begin two seconds after power-on, with sensor file and truth."""
        sensor = "radius_m = 0.1\nwarm_up_mps2 = [1.0, -1.0, 0.0]\nwarm_up_time_s = 3.0\n"
        self.write("rig.toml", "seed = 3\n[[segment]]\nduration_s = 12\nspeed_rpm = 40\n[[sensor]]\n" + sensor)
        self.succeed("simulate", "rig.toml", "--rate", "50", "-o", "all.csv")
        self.succeed("convert", "all.csv", "--from", "2", "-o", "part.csv")
        self.write("s.toml", """[drift]
a1 = { value = [1.0, -1.0, 0.0], unit = "m/s^2" }
a2 = { value = 0.0, unit = "m/s^2" }
T = { value = 3.0, unit = "s" }
""")
        with open(self.folder / "all.truth.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        angles = [float(row["angle (rad)"]) for row in rows if float(row["time (s)"]) >= 2.0]
        return abs(angles[-1] - angles[0]) / (2.0 * math.pi)

    def test_a_known_warm_up_no_longer_costs_turns(self):
        truth = self.simulate_warm_up()
        known = ("--sensor", "s.toml", "--since-switch-on", "2")
        with_it = self.document("wheel", "part.csv", *known)["turns"]
        without = self.document("wheel", "part.csv")["turns"]
        error, blind = (abs(abs(turns["value"]) - truth) for turns in (with_it, without))
        self.assertLess(error, 3.0 * with_it["std"])
        self.assertLess(error, 0.0015)
        self.assertGreater(blind, 1.5 * error)
        self.assertLess(with_it["std"], without["std"])

    def test_the_warm_up_counts_from_the_first_sample_of_the_file(self):
        self.simulate_warm_up()
        part = self.document("wheel", "part.csv", "--sensor", "s.toml", "--since-switch-on", "2")
        whole = self.document("wheel", "all.csv", "--sensor", "s.toml", "--since-switch-on", "0", "--from", "2")
        self.assertAlmostEqual(part["turns"]["value"], whole["turns"]["value"], delta=1e-6)

    def test_a_warm_up_is_left_in_unless_it_is_said_since_when(self):
        self.simulate_warm_up()
        plain = self.document("wheel", "part.csv")
        warned = self.document("wheel", "part.csv", "--sensor", "s.toml")
        self.assertEqual(plain["turns"], warned["turns"])
        self.assertTrue(any("--since-switch-on" in text for text in warned["warnings"]), warned["warnings"])
        self.assertFalse(any("--since-switch-on" in text for text in plain["warnings"]))

    def test_a_warm_up_that_no_sensor_file_knows_cannot_be_taken_out(self):
        self.write("a.csv", turning_csv(seconds=2))
        self.write("s.toml", "[sensor]\nname = \"s\"\n")
        for sensor in ((), ("--sensor", "s.toml")):
            said = self.expect_failure(USAGE, "wheel", "a.csv", "--since-switch-on", "0", *sensor)
            self.assertIn("[drift]", said)
        self.write("s.toml", "[drift]\na1 = { value = 0.1, unit = \"m/s^2\" }\n")
        said = self.expect_failure(USAGE, "wheel", "a.csv", "--since-switch-on", "0", "--sensor", "s.toml")
        self.assertIn("drift.a2 of axis x: is missing", said)
        self.expect_failure(USAGE, "wheel", "a.csv", "--since-switch-on", "-1")

    def test_one_axis_alone_is_too_few(self):
        self.write("a.csv", turning_csv(seconds=2))
        self.expect_failure(USAGE, "wheel", "a.csv", "--channel", "acc_x")


if __name__ == "__main__":
    unittest.main()
