"""proofmass track, on the simulated slide and on synthetic files."""
import csv
import math
import random
import unittest

from command import BAD_DATA, BAD_INPUT, FAILED, USAGE, CommandTest, parse_json

GRAVITY = 9.80665


def strokes_csv(heading="acc_{} (m/s^2)", scale=1.0, gravity=GRAVITY, axes="xyz", rate_hz=100, count=3) -> str:
    """Strokes of 0.4 m along x, one second out and one back, with rests of 2 s in between."""
    noise = random.Random(1)
    lines = ["time (s)," + ",".join(heading.format(axis) for axis in axes)]
    for k in range(int((2 + 4 * count) * rate_hz)):
        t = k / rate_hz
        phase = (t - 2.0) % 4.0 if t >= 2.0 else 3.0
        x = 0.8 * math.pi * math.sin(2 * math.pi * phase) * (1 if phase < 1 else -1) if phase < 2 else 0.0
        readings = {"x": x + 0.02, "y": 0.0, "z": gravity}
        values = [f"{scale * (readings[a or 'x'] + noise.gauss(0, 0.01)):.7f}" for a in axes]
        lines.append(f"{t:.4f}," + ",".join(values))
    return "\n".join(lines) + "\n"


class Track(CommandTest):
    def smoothed(self, *arguments):
        return self.document("track", *arguments)["methods"]["smoother"]

    def test_strokes_are_counted_and_measured(self):
        self.write("a.csv", strokes_csv())
        document = self.document("track", "a.csv")
        self.assertEqual(len(document["strokes"]), 3)
        for stroke in document["strokes"]:
            self.assertEqual(stroke["kind"], "there_and_back")
            self.assertAlmostEqual(stroke["length_m"], 0.4, delta=5 * stroke["length_std_m"])
            self.assertAlmostEqual(stroke["length_m"], 0.4, delta=0.01)
        self.assertEqual(document["stroke_summary"]["count"], 3)
        self.assertEqual(len(document["rests"]), 4)
        self.assertEqual(document["gravity"], "present")
        self.assertGreater(abs(document["axis"][0]), 0.999)
        smoother = document["methods"]["smoother"]
        self.assertLess(abs(smoother["displacement_m"]), 5 * smoother["std_m"])
        lower, upper = smoother["interval_95_m"]
        self.assertAlmostEqual(0.5 * (lower + upper), smoother["displacement_m"])

    def test_accelerations_beyond_the_range_are_not_taken_as_measured(self):
        rows = [line.split(",") for line in strokes_csv().splitlines()]
        for row in rows[1:]:
            row[1] = f"{max(-1.8, min(1.8, float(row[1]))):.7f}"
        self.write("a.csv", "\n".join(",".join(row) for row in rows) + "\n")
        document = self.document("track", "a.csv")
        self.assertTrue(any("limits of the range (-1.8 and 1.8 m/s^2)" in text for text in document["warnings"]))
        self.assertEqual(len(document["strokes"]), 3)
        for stroke in document["strokes"]:  # 0.343 ± 0.006 m as measured
            self.assertAlmostEqual(stroke["length_m"], 0.4, delta=3 * stroke["length_std_m"])

    def test_rows_in_bursts_are_evenly_spaced(self):
        """Stamped when a packet of eight arrives, by a computer that is late now and then."""
        late = random.Random(2)
        lines = strokes_csv().splitlines()
        for first in range(1, len(lines), 8):
            arrival = 0.01 * (first + 7) + late.expovariate(250.0)
            for k in range(first, min(first + 8, len(lines))):
                lines[k] = f"{arrival + 1e-4 * (k - first):.5f},{lines[k].split(',', 1)[1]}"
        self.write("a.csv", "\n".join(lines) + "\n")
        document = self.document("track", "a.csv")
        self.assertEqual(len(document["strokes"]), 3)
        for stroke in document["strokes"]:
            self.assertAlmostEqual(stroke["length_m"], 0.4, delta=0.01)

    def test_a_logger_that_repeats_its_last_row_measures_nothing(self):
        lines = strokes_csv().splitlines()
        at = next(k for k, line in enumerate(lines) if line.startswith("12.25"))
        values = lines[at].split(",", 1)[1]
        lines[at + 1 :] = [line.split(",")[0] + "," + values for line in lines[at + 1 :]]
        self.write("a.csv", "\n".join(lines) + "\n")
        self.assertIn("repeat one value", self.run_command("track", "a.csv").stderr.decode())

    def test_the_simulated_slide_lies_in_the_band(self):
        self.succeed("simulate", "--procedure", "slide", "--seed", "5", "-o", "slide.csv")
        with open(self.folder / "slide.truth.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.succeed("track", "slide.csv", "--json", "t.json")
        document = parse_json((self.folder / "t.json").read_text())
        self.check_document("track", document)
        column = next(name for name in rows[0] if name.startswith("displacement"))
        end = abs(float(rows[-1][column]) - float(rows[0][column]))
        smoother = document["methods"]["smoother"]
        self.assertAlmostEqual(abs(smoother["displacement_m"]), end, delta=2 * document["factor_95"] * smoother["std_m"])

    def slide_of_two(self, seed=5, noise=0.02):
        """A slide with a second sensor; its true final position along the axis."""
        self.write("two.toml", f"procedure = 'slide'\n[slide]\nsecond_sensor = true\nstrokes = 5\n"
                               f"[sensor]\nnoise_rms_mps2 = [{noise}, {noise}, {noise}]\n")
        self.succeed("simulate", "two.toml", "--procedure", "slide", "--seed", seed, "-o", "two.csv")
        with open(self.folder / "two.truth.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        column = next(name for name in rows[0] if name.startswith("displacement"))
        return float(rows[-1][column]) - float(rows[0][column])

    def test_the_model_pva_agrees_with_the_inertial_one(self):
        self.write("a.csv", strokes_csv())
        inertial = self.document("track", "a.csv")
        self.assertEqual(inertial["model"], "inertial")
        pva = self.document("track", "a.csv", "--model", "pva")
        self.assertEqual(pva["model"], "pva")
        self.assertEqual(pva["jerk_psd"]["unit"], "m^2/s^5")
        self.assertGreater(pva["jerk_psd"]["std"], 0)
        self.assertEqual(len(pva["strokes"]), 3)
        self.assertAlmostEqual(pva["methods"]["smoother"]["displacement_m"],
                               inertial["methods"]["smoother"]["displacement_m"],
                               delta=inertial["methods"]["smoother"]["std_m"])
        self.assertEqual(pva["consistency"]["channels"][0]["name"], "acceleration")
        given = self.document("track", "a.csv", "--model", "pva", "--jerk-psd", "20")
        self.assertEqual(given["jerk_psd"]["value"], 20)
        self.expect_failure(USAGE, "track", "a.csv", "--jerk-psd", "20")
        self.expect_failure(USAGE, "track", "a.csv", "--model", "pva", "--jerk-psd", "0")
        self.expect_failure(USAGE, "track", "a.csv", "--model", "fancy")
        self.assertIn("Model pva", self.succeed("track", "a.csv", "--model", "pva", "--report", "r.html"))

    def test_two_accelerometers_are_fused(self):
        end = self.slide_of_two()
        self.assertIn("--model fused", self.expect_failure(USAGE, "track", "two.csv"))
        document = self.document("track", "two.csv", "--model", "fused", "--axis", "x")
        self.check_document("track", document)
        fused = document["fused"]
        self.assertEqual([sensor["name"] for sensor in fused["sensors"]], ["acc", "acc2"])
        smoother = document["methods"]["smoother"]
        self.assertAlmostEqual(smoother["displacement_m"], end, delta=2 * document["factor_95"] * smoother["std_m"])
        self.assertGreater(fused["variance_gain"], 1.2)
        for sensor in fused["sensors"]:
            self.assertGreater(sensor["std_m"], smoother["std_m"])
        text = self.succeed("track", "two.csv", "--model", "fused", "--axis", "x", "--report", "r.html")
        self.assertIn("acc2 alone", text)
        self.assertIn("acc2 alone", (self.folder / "r.html").read_text())

    def test_the_warm_up_of_the_sensor_file_is_followed(self):
        lines = strokes_csv(axes="x", heading="acc_{} (m/s^2)").splitlines()
        warm = [f"{t},{float(a) + 0.4 * (1 - math.exp(-float(t) / 5)):.7f}"
                for t, a in (line.split(",") for line in lines[1:])]
        self.write("warm.csv", "\n".join([lines[0]] + warm) + "\n")
        self.write("still.csv", "start,end\n0,1.9\n4.2,5.8\n8.2,9.8\n12.2,13.8\n")
        self.write("s.toml", "[drift]\na1 = { value = 0.4, unit = \"m/s^2\" }\n"
                             "a2 = { value = 0.0, unit = \"m/s^2\" }\nT = { value = 5.0, unit = \"s\" }\n")
        flags = ("warm.csv", "--model", "pva", "--still", "still.csv", "--gravity", "removed")
        blind = self.smoothed(*flags)
        known = self.smoothed(*flags, "--sensor", "s.toml", "--since-switch-on", "0")
        self.assertLess(known["std_m"], blind["std_m"])
        self.assertLess(abs(known["displacement_m"]), 4 * known["std_m"])

    def test_one_accelerometer_cannot_be_fused(self):
        self.write("a.csv", strokes_csv())
        self.assertIn("2 to 4", self.expect_failure(USAGE, "track", "a.csv", "--model", "fused"))

    def test_one_axis_without_a_letter_will_do_and_a_magnitude_beside_three_stays_out(self):
        self.write("one.csv", strokes_csv(heading="Acceleration (m/s^2)", axes=["x"]))
        document = self.document("track", "one.csv")
        self.assertEqual(document["axis"], [1.0, 0.0, 0.0])
        self.assertEqual(len(document["strokes"]), 3)
        lines = strokes_csv().splitlines()
        lines = [lines[0] + ",Absolute acceleration (m/s^2)"] + [line + ",9.9" for line in lines[1:]]
        self.write("abs.csv", "\n".join(lines) + "\n")
        self.assertEqual(len(self.document("track", "abs.csv")["strokes"]), 3)
        flags = ("--channel", "Absolute acceleration")
        self.assertIn("no accelerometer channel", self.expect_failure(USAGE, "track", "abs.csv", *flags))

    def test_a_wrong_unit_is_refused(self):
        self.write("g.csv", strokes_csv(scale=1 / GRAVITY))
        self.assertIn("--unit g", self.expect_failure(USAGE, "track", "g.csv"))
        self.assertEqual(len(self.document("track", "g.csv", "--unit", "g")["strokes"]), 3)
        self.write("a.csv", strokes_csv())
        self.assertIn("--unit m/s2", self.expect_failure(USAGE, "track", "a.csv", "--unit", "g"))

    def test_gravity_takes_a_word_and_a_number(self):
        self.write("a.csv", strokes_csv(gravity=0.0))
        self.assertEqual(self.document("track", "a.csv")["gravity"], "removed")
        document = self.document("track", "a.csv", "--gravity", "removed", "--gravity", "9.81")
        self.assertEqual((document["gravity"], document["gravity_mps2"]), ("removed", 9.81))
        self.expect_failure(USAGE, "track", "a.csv", "--gravity", "gone")
        self.expect_failure(USAGE, "track", "a.csv", "--gravity", "removed", "--gravity", "present")
        self.expect_failure(USAGE, "track", "a.csv", "--gravity", "9.81", "--latitude", "47")
        self.document("track", "a.csv", "--gravity", "removed", "--latitude", "47")

    def test_fixes_and_the_same_place_narrow_the_band(self):
        self.write("a.csv", strokes_csv())
        plain = self.smoothed("a.csv")
        self.write("fixes.csv", "time (s),position (mm),std (mm)\n3.0,400,1\n13.9,0,0.5\n")
        self.assertLess(self.smoothed("a.csv", "--axis", "x", "--fixes", "fixes.csv")["std_m"], plain["std_m"])
        back = self.smoothed("a.csv", "--same-place", "--same-place-std", "0.0005")
        self.assertLess(back["std_m"], 0.00051)

    def test_lists_that_do_not_fit_are_refused(self):
        self.write("a.csv", strokes_csv())
        self.write("late.csv", "time (s),position (m)\n300,0.4\n")
        self.assertIn("late.csv", self.expect_failure(USAGE, "track", "a.csv", "--fixes", "late.csv"))
        self.write("around.csv", "time (s),position (mm),std (mm)\n-0.5,0,1\n3.0,400,1\n13.9,0,0.5\n400,0,1\n")
        around = self.document("track", "a.csv", "--axis", "x", "--fixes", "around.csv")
        self.assertTrue(any("2 of 4 fixes are before or after" in warning for warning in around["warnings"]))
        self.write("times.csv", "time (s)\n3.0\n")
        self.assertIn("positions", self.expect_failure(BAD_INPUT, "track", "a.csv", "--fixes", "times.csv"))
        self.write("late_rest.csv", "start,end\n1,900\n")
        self.expect_failure(USAGE, "track", "a.csv", "--still", "late_rest.csv")
        self.document("track", "a.csv", "--turns", "times.csv")

    def test_the_series_has_every_column_with_its_unit(self):
        self.write("a.csv", strokes_csv())
        self.succeed("track", "a.csv", "--output", "series.csv")
        with open(self.folder / "series.csv", newline="") as file:
            rows = list(csv.reader(file))
        for column in ("time (s)", "position (m)", "position_std (m)", "velocity (m/s)", "velocity_std (m/s)",
                       "filtered_position (m)", "filtered_position_std (m)", "double_integral_position (m)",
                       "accel (m/s^2)"):
            self.assertIn(column, rows[0])
        self.assertEqual(len(rows) - 1, 1400)

    def test_the_budget_is_in_the_text_and_the_page_has_the_plots(self):
        self.write("a.csv", strokes_csv())
        text = self.succeed("track", "a.csv", "--report", "r.html")
        self.assertIn("What sensor, duration and stops allow:", text)
        page = (self.folder / "r.html").read_text()
        self.assertEqual(page.count("</svg>"), 4)
        self.assertLess(page.index("stops allow"), page.index("by method"))

    def test_missing_readings_are_told_and_bridged(self):
        lines = strokes_csv().splitlines()
        for k in range(260, 266):
            lines[k] = lines[k].split(",")[0] + ",nan,,nan"
        self.write("a.csv", "\n".join(lines) + "\n")
        document = self.document("track", "a.csv")
        self.assertEqual(document["missing"], 6)
        self.assertEqual(len(document["strokes"]), 3)

    def test_jerk_gets_no_figure_and_is_bad_data(self):
        """A lift ride with differentiated acceleration: pulses at both ends of a long cruise."""
        noise = random.Random(2)
        lines = ["time (s),Acceleration (m/s^2)"]
        last = 0.0
        for k in range(3000):
            t = k / 30
            jerk = sum(s * math.sin(math.pi * (t - at)) ** 3 for at, s in
                       ((20, 1), (21, -1), (70, -1), (71, 1)) if at <= t < at + 1)
            shake = noise.gauss(0, 0.03 if 22 <= t < 70 else 0.0)
            lines.append(f"{t:.4f},{jerk + shake - last + noise.gauss(0, 0.001):.7f}")
            last = shake
        self.write("lift.csv", "\n".join(lines) + "\n")
        ran = self.run_command("track", "lift.csv", "--strict", "--json", "-")
        document = parse_json(ran.stdout.decode())
        self.check_document("track", document)
        self.assertTrue(document["suspected_jerk"])
        self.assertEqual(ran.returncode, BAD_DATA)
        self.assertIsNone(document["methods"]["smoother"]["displacement_m"])
        taken = self.document("track", "lift.csv", "--take-as-acceleration")
        self.assertIsNotNone(taken["methods"]["smoother"]["displacement_m"])

    def test_without_a_time_base_or_a_rest_nothing_is_said(self):
        rows = strokes_csv().splitlines()
        self.write("untimed.csv", "\n".join(line.split(",", 1)[1] for line in rows) + "\n")
        self.assertIn("--rate", self.expect_failure(USAGE, "track", "untimed.csv"))
        self.assertEqual(len(self.document("track", "untimed.csv", "--rate", "100")["strokes"]), 3)
        self.write("short.csv", "\n".join(rows[:21]) + "\n")
        self.assertIn("--still", self.expect_failure(FAILED, "track", "short.csv"))
        self.write("empty.csv", "")
        self.expect_failure(BAD_INPUT, "track", "empty.csv")

    def test_a_gyroscope_tells_where_the_world_is_and_can_be_left_out(self):
        rows = strokes_csv().splitlines()
        noise = random.Random(3)
        rates = [",".join(f"{noise.gauss(0.01, 0.002):.6f}" for _ in "xyz") for _ in rows]
        lines = [rows[0] + ",gyro_x (rad/s),gyro_y (rad/s),gyro_z (rad/s)"]
        lines += [row + "," + rate for row, rate in zip(rows[1:], rates)]
        self.write("imu.csv", "\n".join(lines) + "\n")
        self.assertEqual(self.document("track", "imu.csv")["axis_frame"], "world")
        self.assertEqual(self.document("track", "imu.csv", "--no-gyro")["axis_frame"], "sensor")


if __name__ == "__main__":
    unittest.main()
