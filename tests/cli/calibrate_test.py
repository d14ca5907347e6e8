"""proofmass calibrate, on a sensor whose bias, scale and misalignment are known."""
import csv
import math
import random
import tomllib
import unittest

from command import BAD_DATA, BAD_INPUT, FAILED, USAGE, CommandTest

G = 9.80665
BIAS = (0.1, -0.2, 0.3)
SCALE = (1.01, 0.99, 1.02)
ANGLES = (2e-3, -1e-3, 3e-3)  # alpha_yz, alpha_zy, alpha_zx


def reading(up, bias=BIAS, scale=SCALE):
    """scale T^-1 f + bias, T = [1 -a_yz a_zy; 0 1 -a_zx; 0 0 1], solved from below."""
    fx, fy, fz = (G * u for u in up)
    az = fz
    ay = fy + ANGLES[2] * az
    ax = fx + ANGLES[0] * ay - ANGLES[1] * az
    return [s * a + b for s, a, b in zip(scale, (ax, ay, az), bias)]


def directions(count):
    """Evenly spread over the sphere, in a spiral."""
    out = []
    for k in range(count):
        z = 1.0 - (2.0 * k + 1.0) / count
        flat, angle = math.sqrt(1.0 - z * z), 2.399963 * k
        out.append((flat * math.cos(angle), flat * math.sin(angle), z))
    return out


def turned(ups, rate_hz=50.0, rest_s=4.0, move_s=1.5, noise=0.01, seed=1, bad=None, head="acc", **sensor):
    """A recording at rest in each direction; position `bad` has an error of 50 mg."""
    draw = random.Random(seed)
    lines = [f"time (s),{head}_x (m/s^2),{head}_y (m/s^2),{head}_z (m/s^2)"]
    t = 0
    previous = ups[0]
    for k, up in enumerate(ups):
        for j in range(int(move_s * rate_hz) if k else 0):
            part = j / (move_s * rate_hz)
            now = [a + (b - a) * part for a, b in zip(previous, up)]
            lines.append(row(t / rate_hz, reading(now, **sensor), draw, 0.5))
            t += 1
        for _ in range(int(rest_s * rate_hz)):
            shake = 1.05 if k == bad else 1.0
            lines.append(row(t / rate_hz, [v * shake for v in reading(up, **sensor)], draw, noise))
            t += 1
        previous = up
    return "\n".join(lines) + "\n"


def row(time_s, values, draw, noise):
    return f"{time_s:.4f}," + ",".join(f"{v + draw.gauss(0.0, noise):.6f}" for v in values)


def means(ups, std=None, head="x_mean (m/s^2),y_mean (m/s^2),z_mean (m/s^2)", seed=2, **sensor):
    draw = random.Random(seed)
    lines = [head + (",x_sem,y_sem,z_sem" if std else "")]
    for up in ups:
        values = [v + draw.gauss(0.0, std or 0.0) for v in reading(up, **sensor)]
        lines.append(",".join(f"{v:.9f}" for v in values) + (f",{std},{std},{std}" if std else ""))
    return "\n".join(lines) + "\n"


class Calibrate(CommandTest):
    def expect_near(self, quantity, truth):
        self.assertAlmostEqual(quantity["value"], truth, delta=4.0 * quantity["std"])

    def expect_truth(self, found):
        for k in range(3):
            self.expect_near(found["bias"][k], BIAS[k])
            self.expect_near(found["scale"][k], SCALE[k])
            self.expect_near(found["misalignment_rad"][k], ANGLES[k])

    def test_a_recording_turned_by_hand_gives_all_nine_figures(self):
        self.write("r.csv", turned(directions(18)))
        found = self.document("calibrate", "r.csv", "--gravity", G)
        self.expect_truth(found)
        self.assertEqual(found["model"], "norm_9")
        self.assertEqual(len(found["positions"]), 18)
        self.assertEqual([len(r) for r in found["covariance"]], [9] * 9)
        self.assertAlmostEqual(found["covariance"][4][4], found["scale"][1]["std"] ** 2, delta=1e-12)
        self.assertEqual(found["gravity"]["value"], G)
        self.assertGreater(found["lack_of_fit"]["p"], 1e-3)
        first = found["positions"][0]
        self.assertLess(first["start_s"], 0.2)
        self.assertAlmostEqual(first["end_s"], 4.0, delta=0.3)
        self.assertLess(found["rest_accuracy"]["overall"], 0.01)
        low, high = found["interval_95"]["bias"][2]
        self.assertLess(low, BIAS[2])
        self.assertGreater(high, BIAS[2])
        self.assertIsNone(found["cross_axis"][2])

    def test_text_report_and_series_are_written(self):
        self.write("r.csv", turned(directions(18)))
        text = self.succeed("calibrate", "r.csv", "--gravity", G, "--report", "r.html", "--output", "o.csv",
                            "--name", "bench <7>", "--temperature", "21.5")
        self.assertIn("18 positions, nine parameters: accurate to", text)
        self.assertIn("Misalignment zx", text)
        page = (self.folder / "r.html").read_text()
        for words in ("Residual of each position", "Upward directions", "Calibration certificate",
                      "bench &lt;7&gt;", "Uncertainty budgets"):
            self.assertIn(words, page)
        self.assertNotIn("src=", page)
        with open(self.folder / "o.csv", newline="") as file:
            self.assertEqual(len(list(csv.reader(file))), 19)
        self.assertEqual(self.leftovers(), [])

    def test_a_position_that_contradicts_the_others_is_named_and_left_out(self):
        self.write("r.csv", turned(directions(18), bad=6))
        found = self.document("calibrate", "r.csv", "--gravity", G)
        self.assertEqual([p["position"] for p in found["positions"] if p["suspect"]], [7])
        self.assertFalse(found["positions"][6]["used"])
        self.assertIn("Position 7 (", "\n".join(found["warnings"]))
        self.expect_truth(found)
        self.assertEqual(self.run_command("calibrate", "r.csv", "--strict").returncode, BAD_DATA)
        kept = self.document("calibrate", "r.csv", "--gravity", G, "--keep-suspects")
        self.assertTrue(kept["positions"][6]["used"])
        self.assertGreater(kept["residual_rms"], 5.0 * found["residual_rms"])

    def test_a_list_says_where_the_rests_are(self):
        self.write("r.csv", turned(directions(12)))
        rows = [f"{5.5 * k + 0.5},{5.5 * k + 3.5},p{k + 1}" for k in range(12)]
        self.write("rests.csv", "start,end,label\n" + "\n".join(rows) + "\n")
        found = self.document("calibrate", "r.csv", "--gravity", G, "--rests", "rests.csv")
        self.expect_truth(found)
        self.assertEqual(found["files"][0]["origin"], "listed")
        self.assertEqual(found["positions"][3]["label"], "p4")
        self.assertAlmostEqual(found["positions"][3]["start_s"], 17.0, places=3)

    def test_a_list_with_errors_is_one_line_that_names_them(self):
        self.write("r.csv", turned(directions(12)))
        for name, text, words in (("turned.csv", "start,end\n3,1\n", "line 2"),
                                  ("across.csv", "start,end\n0,3\n2,4\n", "line"),
                                  ("beyond.csv", "start,end\n0,3\n5000,5003\n", "line 3"),
                                  ("words.csv", "start,end\nnow,then\n", "line 2"),
                                  ("empty.csv", "", "")):
            self.write(name, text)
            line = self.expect_failure(BAD_INPUT, "calibrate", "r.csv", "--rests", name)
            self.assertIn(name, line)
            self.assertIn(words, line)
        self.expect_failure(BAD_INPUT, "calibrate", "r.csv", "--rests", "none.csv")
        self.write("few.csv", "start,end\n0,3\n5.5,8.5\n")
        self.assertIn("2 positions", self.expect_failure(BAD_INPUT, "calibrate", "r.csv", "--rests", "few.csv"))

    def test_a_table_of_means_without_noise_has_no_standard_deviation(self):
        self.write("m.csv", means(directions(9)))
        found = self.document("calibrate", "m.csv", "--gravity", G)
        self.assertAlmostEqual(found["scale"][0]["value"], SCALE[0], places=6)
        self.assertIsNone(found["scale"][0]["std"])
        self.assertIsNone(found["rest_accuracy"])
        self.assertIsNone(found["positions"][0]["start_s"])
        self.assertIn("not determined", found["conclusion"])

    def test_means_with_their_noise(self):
        self.write("m.csv", means(directions(24), std=1e-3))
        found = self.document("calibrate", "m.csv", "--gravity", G)
        self.expect_truth(found)
        self.assertEqual(found["files"][0]["origin"], "table")

    def test_six_directions_taken_for_exact(self):
        names = ["+x", "-x", "+y", "-y", "+z", "-z"]
        ups = [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)]
        body = means(ups, std=1e-3).splitlines()
        self.write("six.csv", "\n".join(["label," + body[0]] + [f"{n},{r}" for n, r in zip(names, body[1:])]) + "\n")
        found = self.document("calibrate", "six.csv", "--gravity", G, "--six-position")
        self.assertEqual(found["model"], "six_position")
        self.assertEqual(found["misalignment_rad"], [None] * 3)
        self.assertIsNone(found["lack_of_fit"])
        self.assertAlmostEqual(found["bias"][0]["value"], BIAS[0], delta=0.01)
        self.assertEqual(len(found["axes_in_fixture"]), 3)

    def test_given_directions_tell_the_mounting(self):
        ups = directions(14)
        body = means(ups, std=1e-3).splitlines()
        lines = [body[0] + ",up_x,up_y,up_z"]
        lines += [r + "," + ",".join(f"{v:.9f}" for v in up) for r, up in zip(body[1:], ups)]
        self.write("given.csv", "\n".join(lines) + "\n")
        found = self.document("calibrate", "given.csv", "--gravity", G, "--parameters", 12)
        self.assertEqual(found["parameters"], 12)
        self.assertLess(max(map(abs, found["mounting"]["rotation_rad"])), 0.01)
        self.assertAlmostEqual(found["scale"][2]["value"], SCALE[2], delta=1e-3)

    def test_new_positions_try_the_calibration(self):
        self.write("r.csv", turned(directions(18)))
        self.write("good.csv", turned(directions(11), seed=7))
        self.write("other.csv", turned(directions(11), seed=8, bias=(0.3, 0.0, 0.0)))
        good = self.document("calibrate", "r.csv", "--gravity", G, "--validate", "good.csv")["validation"]
        self.assertEqual(good["positions"], 11)
        self.assertGreater(good["p"], 1e-3)
        other = self.document("calibrate", "r.csv", "--gravity", G, "--validate", "other.csv")
        self.assertLess(other["validation"]["p"], 1e-6)
        self.assertIn("new positions", "\n".join(other["warnings"]))

    def test_supplies_tell_a_ratiometric_sensor(self):
        head = "x_mean (V),y_mean (V),z_mean (V)"
        names = []
        for v in (3.0, 3.3, 3.6):
            name = f"{v}.csv"
            self.write(name, means(directions(18), std=1e-5, head=head, bias=(v / 2,) * 3,
                                   scale=(0.0337 * v / 3.3,) * 3))
            names.append(name)
        found = self.document("calibrate", *names, "--gravity", G, "--supplies", "3.0,3.3,3.6")
        axis = found["supply"]["axes"][0]
        self.assertAlmostEqual(axis["exponent"]["value"], 1.0, delta=5e-3)
        self.assertAlmostEqual(axis["fraction"]["value"], 0.5, delta=1e-3)
        self.assertTrue(axis["ratiometric"])
        self.assertEqual(len(found["supply"]["points"]), 3)
        self.assertEqual([f["file"] for f in found["files"]], ["3.3.csv"])
        self.assertAlmostEqual(found["bias"][0]["value"], 1.65, delta=1e-3)
        self.expect_failure(USAGE, "calibrate", *names, "--supplies", "3.0,3.3")
        self.assertIn("Supply:", self.succeed("calibrate", *names, "--supplies", "3.0,3.3,3.6", "--report", "r.html"))
        self.assertIn("Scale against the supply", (self.folder / "r.html").read_text())

    def test_type_b_contributions_are_in_the_budget(self):
        self.write("r.csv", turned(directions(18)))
        plain = self.document("calibrate", "r.csv", "--gravity", G)
        found = self.document("calibrate", "r.csv", "--gravity", G, "--type-b", "ADC reference,scale,0.05 %,uniform")
        self.assertAlmostEqual(found["scale"][0]["std"] ** 2,
                               plain["scale"][0]["std"] ** 2 + (SCALE[0] * 5e-4) ** 2 / 3.0, delta=1e-9)
        scale_x = next(b for b in found["budgets"] if b["quantity"] == "scale x")
        line = next(one for one in scale_x["lines"] if one["source"] == "ADC reference")
        self.assertEqual((line["type"], line["distribution"]), ("B", "uniform"))
        for text in ("nonsense", "a,bias", "a,bias,1 V,uniform", "a,taste,1 mg", "a,bias,1 mg,lumpy"):
            line = self.expect_failure(USAGE, "calibrate", "r.csv", "--gravity", G, "--type-b", text)
            self.assertIn("type-b", line)

    def test_the_sensor_file_takes_the_calibration(self):
        self.write("r.csv", turned(directions(18)))
        self.succeed("calibrate", "r.csv", "--gravity", G, "--update-sensor", "s.toml", "--name", "bench")
        text = (self.folder / "s.toml").read_text()
        self.assertIn("proofmass calibrate r.csv", str(tomllib.loads(text)["calibration"]))
        again = self.document("calibrate", "r.csv", "--gravity", G, "--sensor", "s.toml")
        for k in range(3):
            self.assertAlmostEqual(again["scale"][k]["value"], 1.0, places=4)
            self.assertAlmostEqual(again["bias"][k]["value"], 0.0, places=4)

    def test_no_draws_no_check(self):
        self.write("r.csv", turned(directions(18)))
        self.assertIsNone(self.document("calibrate", "r.csv", "--monte-carlo", 0)["monte_carlo"])
        check = self.document("calibrate", "r.csv", "--monte-carlo", 150)["monte_carlo"]
        self.assertEqual(check["draws"] + check["failed"], 150)

    def test_what_cannot_be_calibrated_is_one_clear_line(self):
        self.write("empty.csv", "")
        self.expect_failure(BAD_INPUT, "calibrate", "empty.csv")
        self.expect_failure(BAD_INPUT, "calibrate", "none.csv")
        self.write("alike.csv", means([(0, 0, 1)] * 12))
        self.assertIn("same", self.expect_failure(FAILED, "calibrate", "alike.csv"))
        self.write("plane.csv", means([(math.cos(a), math.sin(a), 0.0) for a in range(12)], std=1e-3))
        self.assertIn("add others", self.expect_failure(FAILED, "calibrate", "plane.csv"))
        self.write("nan.csv", "x_mean (m/s^2),y_mean (m/s^2),z_mean (m/s^2)\n" + "nan,nan,nan\n" * 12)
        self.expect_failure(BAD_INPUT, "calibrate", "nan.csv")
        moving = "\n".join(f"{0.01 * k:.2f},{9.8 * math.sin(0.1 * k):.4f},{9.8 * math.cos(0.1 * k):.4f},"
                           f"{math.sin(0.37 * k):.4f}" for k in range(2000))
        self.write("moving.csv", "time (s),ax (m/s^2),ay (m/s^2),az (m/s^2)\n" + moving + "\n")
        self.assertIn("--rests", self.expect_failure(BAD_INPUT, "calibrate", "moving.csv"))

    def test_gaps_in_a_recording_are_skipped(self):
        lines = turned(directions(18)).splitlines()
        for k in range(50, len(lines), 97):
            lines[k] = lines[k].split(",")[0] + ",nan,nan,nan"
        self.write("gaps.csv", "\n".join(lines) + "\n")
        found = self.document("calibrate", "gaps.csv", "--gravity", G)
        self.expect_truth(found)
        self.assertGreater(found["files"][0]["rejected"], 0)

    def test_two_accelerometers_have_to_be_chosen_from(self):
        one = turned(directions(12), head="acc1").splitlines()
        two = turned(directions(12), head="acc2", seed=3).splitlines()
        both = "\n".join(a + "," + b.split(",", 1)[1] for a, b in zip(one, two)) + "\n"
        self.write("two.csv", both)
        self.assertIn("2 accelerometers", self.expect_failure(USAGE, "calibrate", "two.csv"))
        channels = [f"--channel=acc2_{axis}" for axis in "xyz"]
        self.assertEqual(len(self.document("calibrate", "two.csv", *channels)["positions"]), 12)

    def test_flags_that_contradict_each_other_are_refused(self):
        self.write("r.csv", turned(directions(12)))
        self.expect_failure(USAGE, "calibrate", "r.csv", "--six-position", "--parameters", 9)
        self.expect_failure(USAGE, "calibrate", "r.csv", "--parameters", 7)
        self.expect_failure(USAGE, "calibrate", "r.csv", "--output", "-", "--json", "-")
        self.expect_failure(USAGE, "calibrate", "r.csv", "--supplies", "0")
        self.expect_failure(USAGE, "calibrate")


if __name__ == "__main__":
    unittest.main()
