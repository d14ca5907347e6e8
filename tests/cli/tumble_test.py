"""proofmass tumble, on a simulated turntable with known errors."""
import csv
import math
import random
import tomllib
import unittest

from command import BAD_DATA, BAD_INPUT, USAGE, CommandTest

G = 9.80665
K1, K0, DELTA, K2, K3, KIP, KPP = 0.0337, 0.05, 2e-3, 3e-6, 2e-6, 4e-6, 8e-6


def output(degrees, phase=0.0, bias=K0):
    """Volts, centred at 1.65, of an axis with the force g sin(angle + phase)."""
    phi = math.radians(degrees + phase)
    a, p = G * math.sin(phi), G * math.cos(phi)
    return 1.65 + K1 * (bias + a + DELTA * p + K2 * a * a + K3 * a**3 + KIP * a * p + KPP * p * p)


def table(rows, head="angle_deg,x (V)"):
    return head + "\n" + "\n".join(",".join(f"{v:.9g}" if isinstance(v, float) else str(v) for v in row)
                                   for row in rows) + "\n"


def rests(angles, rate_hz=100.0, rest_s=4.0, move_s=1.0, noise=0.002, encoder=False, seed=1):
    """A three-axis recording, z along the table's axis, with a rest at each angle."""
    draw = random.Random(seed)
    lines = ["time (s)," + ("angle (deg)," if encoder else "") + "acc_x (V),acc_y (V),acc_z (V)"]
    t, previous = 0, angles[0]
    for angle in angles:
        for k in range(int(move_s * rate_hz) if t else 0):
            now = previous + (angle - previous) * k / (move_s * rate_hz)
            lines.append(row(t, now, rate_hz, encoder, draw, 0.05))
            t += 1
        for _ in range(int(rest_s * rate_hz)):
            lines.append(row(t, angle, rate_hz, encoder, draw, noise))
            t += 1
        previous = angle
    return "\n".join(lines) + "\n"


def row(t, angle, rate_hz, encoder, draw, noise):
    values = [output(angle), output(angle, 90.0), 1.65]
    return (f"{t / rate_hz:.4f}," + (f"{angle % 360.0:.4f}," if encoder else "") +
            ",".join(f"{v + draw.gauss(0.0, noise):.6f}" for v in values))


class Tumble(CommandTest):
    def expect_near(self, quantity, truth, least=0.0):
        self.assertAlmostEqual(quantity["value"], truth, delta=4.0 * (quantity["std"] or 0.0) + least)

    def noisy(self, angles, sigma=3e-6, seed=2):
        draw = random.Random(seed)
        return [(float(a), output(a) + draw.gauss(0.0, sigma)) for a in angles]

    def test_a_table_of_positions_in_any_order_gives_every_coefficient(self):
        rows = self.noisy([*range(0, 360, 15), 0])
        random.Random(3).shuffle(rows)
        self.write("p.csv", table(rows))
        found = self.document("tumble", "p.csv")
        bias = K0 + 1.65 / K1
        self.expect_near(found["K1"], K1)
        self.expect_near(found["K0"], bias + KPP * G * G)
        self.expect_near(found["K0_up_down"], bias + K2 * G * G)
        self.expect_near(found["K2_minus_Kpp"], K2 - KPP)
        self.expect_near(found["misalignment_rad"], DELTA)
        self.expect_near(found["Kip"], KIP)
        self.expect_near(found["K3"], K3)
        self.assertEqual(found["K1"]["unit"], "V/(m/s^2)")
        self.assertEqual(found["in_g"]["K1"]["unit"], "V/g")
        self.assertAlmostEqual(found["in_g"]["K1"]["value"], found["K1"]["value"] * G)
        self.assertEqual(found["in_g"]["K2_minus_Kpp"]["unit"], "ug/g^2")
        self.assertEqual(len(found["positions"]), 25)
        self.assertIn("K0 + Kpp g²", found["meanings"]["K0"])
        self.expect_near(found["bias_output"], 1.65 + K1 * (K0 + KPP * G * G))

    def test_four_points_are_the_closed_forms_and_have_no_standard_deviation(self):
        e0, e90, e180, e270 = 1.652, 1.983, 1.6475, 1.319
        self.write("p.csv", table([(0, e0), (90, e90), (180, e180), (270, e270)]))
        found = self.document("tumble", "p.csv")
        self.assertAlmostEqual(found["K1"]["value"], (e90 - e270) / (2 * G), places=12)
        self.assertAlmostEqual(found["K0"]["value"], (e0 + e180) / (e90 - e270) * G, places=9)
        self.assertAlmostEqual(found["misalignment_rad"]["value"], (e0 - e180) / (e90 - e270), places=12)
        self.assertIsNone(found["K1"]["std"])
        self.assertIsNone(found["K3"])
        self.assertFalse(found["drift"]["known"])
        self.assertIn("K3 g²", found["meanings"]["K1"])

    def test_four_points_in_g_stand_for_the_thesis_table(self):
        self.write("x.csv", table([(0, -0.17517), (90, 1.0), (180, -0.22057), (270, -1.0)], "angle,x (g)"))
        found = self.document("tumble", "x.csv", "--gravity", G)
        self.assertAlmostEqual(found["in_g"]["K0"]["value"], -197.87, places=6)

    def test_stated_noise_gives_standard_deviations_and_a_lack_of_fit(self):
        rows = [(a, v, 3e-6) for a, v in self.noisy(range(0, 360, 30))]
        self.write("p.csv", table(rows, "theta (deg),E (V),std"))
        found = self.document("tumble", "p.csv", "--indexing-std", "0.001", "--gravity-std", "1e-4",
                              "--drift-std", 0)
        self.assertTrue(found["noise_known"])
        self.assertEqual(found["lack_of_fit"]["against"], "noise of the means")
        self.assertEqual([share["type"] for share in found["shares"]], ["A", "B", "B"])

    def test_what_is_not_stated_of_the_table_and_the_drift_is_assumed_and_said(self):
        rows = [(a, v, 3e-6) for a, v in self.noisy([0, 90, 180, 270, 0])]
        self.write("p.csv", table(rows, "theta (deg),E (V),std"))
        found = self.document("tumble", "p.csv")
        self.assertTrue(found["indexing"]["assumed"] and found["drift"]["wander_assumed"])
        self.assertAlmostEqual(found["indexing"]["std_rad"], math.radians(0.5))
        self.assertTrue(any("angles is not stated" in w for w in found["warnings"]))
        self.assertTrue(any("--indexing-std" in n for n in found["notes"]))
        self.assertIn("drift that is not straight", [share["source"] for share in found["shares"]])
        exact = self.document("tumble", "p.csv", "--indexing-std", 0, "--drift-std", 0)
        self.assertLess(exact["misalignment_rad"]["std"], 0.01 * found["misalignment_rad"]["std"])
        self.assertFalse(exact["indexing"]["assumed"] or exact["drift"]["wander_assumed"])

    def test_a_column_of_temperatures_is_taken_out(self):
        rows = [(a, v + K1 * 0.02 * math.sin(0.9 * k), 20 + 2 * math.sin(0.9 * k), 3e-6)
                for k, (a, v) in enumerate(self.noisy([*range(0, 360, 30), 0]))]
        self.write("p.csv", table(rows, "angle (deg),x (V),temperature (degC),std"))
        found = self.document("tumble", "p.csv")
        self.expect_near(found["bias_per_kelvin"], 0.01)
        self.assertEqual(found["bias_per_kelvin"]["unit"], "m/s^2/K")
        self.assertEqual(found["in_g"]["bias_per_kelvin"]["unit"], "mg/K")
        self.expect_near(found["misalignment_rad"], DELTA)

    def test_angles_may_be_in_radians(self):
        self.write("p.csv", table([(math.radians(a), v) for a, v in self.noisy(range(0, 360, 15))],
                                  "angle (rad),x (V)"))
        self.expect_near(self.document("tumble", "p.csv")["K1"], K1)

    def test_forward_and_backward_words_give_hysteresis(self):
        rows = [(a, output(a) + 1e-4, "forward") for a in range(0, 361, 30)]
        rows += [(a, output(a) - 1e-4, "backward") for a in range(360, -1, -30)]
        self.write("p.csv", table(rows, "angle,x (V),direction"))
        found = self.document("tumble", "p.csv")
        self.assertAlmostEqual(found["hysteresis"]["value"] * K1, 2e-4, delta=1e-9)
        self.assertAlmostEqual(found["backlash_rad"]["value"], 0.0, delta=1e-9)

    def test_a_second_mounting_separates_the_table(self):
        error = lambda a: 50e-6 * math.cos(math.radians(a))
        rows = [(a, output(a + math.degrees(error(a)) + m), m) for m in (0, 180) for a in range(0, 360, 30)]
        self.write("p.csv", table(rows, "angle,x (V),mount"))
        found = self.document("tumble", "p.csv")
        self.assertTrue(found["indexing"]["once_separated"])
        self.assertAlmostEqual(found["indexing"]["cos_rad"]["value"], 50e-6, delta=1e-6)
        self.assertAlmostEqual(found["K2_minus_Kpp"]["value"], K2 - KPP, delta=1e-7)
        self.write("one.csv", table([r[:2] for r in rows[:12]]))
        alone = self.document("tumble", "one.csv")
        self.assertIn("once per turn", alone["indexing"]["words"][0])

    def test_two_files_are_two_planes(self):
        for name in ("a.csv", "b.csv"):
            self.write(name, table(self.noisy(range(0, 360, 30))))
        found = self.document("tumble", "a.csv", "b.csv", "--plane", 1, "--plane", 2)
        self.expect_near(found["K0_second_plane"], K0 + 1.65 / K1 + KPP * G * G)
        self.expect_near(found["misalignment_p_rad"], -DELTA)

    def test_a_recording_with_given_angles(self):
        self.write("r.csv", rests([0, 90, 180, 270, 0]))
        found = self.document("tumble", "r.csv", "--angles", "0,90,180,270,0")
        self.assertEqual([c["name"] for c in found["channels"]], ["acc_x", "acc_y", "acc_z"])
        self.assertEqual(found["channel"], "acc_x")
        self.expect_near(found["K1"], K1 * (1 + K3 * G * G))
        self.assertTrue(found["drift"]["known"] and found["drift"]["removed"])
        self.assertEqual(found["drift"]["per"], "second")
        y = found["channels"][1]
        self.assertAlmostEqual(y["axis"]["planes"][0]["phase_rad"], math.pi / 2)
        self.expect_near(y["K1"], K1 * (1 + K3 * G * G))
        self.assertIn("is parallel to the table's", found["channels"][2]["refused"])
        only = self.document("tumble", "r.csv", "--angles", "0,90,180,270,0", "--channel", "acc_x")
        self.assertEqual(len(only["channels"]), 1)

    def test_a_recording_with_an_encoder(self):
        self.write("r.csv", rests([*range(0, 360, 45), 360], encoder=True, rest_s=2.0))
        found = self.document("tumble", "r.csv")
        self.assertEqual(len(found["positions"]), 9)
        self.expect_near(found["K1"], K1)
        self.assertIn("is constant", found["source"])

    def test_an_angle_that_is_shown_before_the_table_stands_still(self):
        lines = rests([*range(0, 360, 30), 0], encoder=True).splitlines()
        shown = [line.split(",") for line in lines[1:]]
        for k, cells in enumerate(shown):  # 4 s rest, 1 s move: the setting is recorded at once
            cells[1] = str((k + 100) // 500 * 30 % 360)
        self.write("r.csv", "\n".join([lines[0], *map(",".join, shown)]) + "\n")
        found = self.document("tumble", "r.csv")
        self.assertEqual(len(found["positions"]), 13)
        self.expect_near(found["K1"], K1)
        self.assertGreater(found["lack_of_fit"]["p"], 1e-3)

    def test_rests_and_angles_that_do_not_match_are_one_clear_line(self):
        self.write("r.csv", rests([0, 90, 180, 270, 0]))
        line = self.expect_failure(USAGE, "tumble", "r.csv", "--angles", "0,90,180,270")
        self.assertIn("5 rests found", line)
        self.assertIn("4 angles", line)
        self.assertIn("0.0–", line)

    def test_a_suspect_is_named_by_its_line(self):
        rows = self.noisy([*range(0, 360, 15), 0])
        rows[7] = (rows[7][0], rows[7][1] + 1e-3)
        self.write("p.csv", table(rows))
        found = self.document("tumble", "p.csv")
        self.assertEqual([k for k, p in enumerate(found["positions"]) if p["suspect"]], [7])
        self.assertIn("line 9 at 105°", "\n".join(found["warnings"]))

    def test_the_input_axis_can_be_named(self):
        self.write("p.csv", table([(a, v, output(a, 90.0)) for a, v in self.noisy(range(0, 360, 30))],
                                  "angle,x (V),y (V)"))
        self.assertEqual(self.document("tumble", "p.csv")["channel"], "x")
        document = self.document("tumble", "p.csv", "--input-axis", "y")
        self.assertEqual(document["channel"], "y")
        self.assertIn("does not follow sin(angle)", "\n".join(document["warnings"]))
        self.assertIn("no channel 'w'", self.expect_failure(USAGE, "tumble", "p.csv", "--input-axis", "w"))

    def test_the_sensor_file_takes_bias_and_scale(self):
        self.write("p.csv", table([(a, v, output(a, 90.0)) for a, v in self.noisy(range(0, 360, 15))],
                                  "angle,acc_x (V),acc_y (V)"))
        self.write("s.toml", '[electrical]\nsupply = { value = 3.3, unit = "V" }\n')
        self.succeed("tumble", "p.csv", "--update-sensor", "s.toml")
        calibration = tomllib.loads((self.folder / "s.toml").read_text())["calibration"]
        self.assertIn("proofmass tumble p.csv", str(calibration))
        # After applying it, the readings are accelerations with scale 1 and bias 0.
        again = self.document("tumble", "p.csv", "--sensor", "s.toml")
        self.assertAlmostEqual(again["K1"]["value"], 1.0, places=4)
        self.assertAlmostEqual(again["K0"]["value"], 0.0, places=4)

    def test_report_and_series_are_written(self):
        self.write("p.csv", table(self.noisy(range(0, 360, 15))))
        text = self.succeed("tumble", "p.csv", "--report", "r.html", "--output", "o.csv")
        self.assertIn("Scale factor", text)
        page = (self.folder / "r.html").read_text()
        self.assertIn("residuals against angle", page)
        self.assertIn("Conditions of the test", page)
        with open(self.folder / "o.csv", newline="") as file:
            self.assertEqual(len(list(csv.reader(file))), 25)
        self.assertEqual(self.leftovers(), [])

    def test_what_makes_no_sense_is_refused(self):
        self.write("p.csv", table(self.noisy(range(0, 360, 15))))
        self.write("noangle.csv", "time (s),x (V)\n0,1\n1,2\n2,1\n3,2\n")
        self.write("plane.csv", table([(0, 1.0, 3), (90, 2.0, 3)], "angle,x (V),plane"))
        self.assertIn("--angle", self.expect_failure(USAGE, "tumble", "noangle.csv"))
        self.assertIn("expected 1 or 2", self.expect_failure(BAD_INPUT, "tumble", "plane.csv"))
        self.expect_failure(USAGE, "tumble", "p.csv", "--mount", "45")
        self.expect_failure(USAGE, "tumble", "p.csv", "--angle", "w")
        self.expect_failure(USAGE, "tumble", "p.csv", "--channel", "w")
        self.expect_failure(USAGE, "tumble", "p.csv", "--indexing-std", "-1")
        self.expect_failure(BAD_INPUT, "tumble", "none.csv")

    def test_strict_tells_that_a_channel_was_refused(self):
        self.write("p.csv", table([(a, 1.65) for a in range(0, 360, 30)]))
        document = self.document("tumble", "p.csv")
        self.assertIsNone(document["K1"])
        self.assertEqual(self.run_command("tumble", "p.csv", "--strict").returncode, BAD_DATA)


if __name__ == "__main__":
    unittest.main()
