"""proofmass tumble --coefficients and --rotating."""
import json
import math
import random
import unittest
from pathlib import Path

import jsonschema

from command import BAD_DATA, BAD_INPUT, FAILED, SCHEMAS, USAGE, CommandTest, nulls, parse_json

G = 9.80665


class ModesTest(CommandTest):
    def document(self, mode, *arguments, **how):
        document = parse_json(self.succeed("tumble", *arguments, "--json", "-", **how))
        schema = json.loads((Path(SCHEMAS) / f"tumble_{mode}.schema.json").read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        jsonschema.Draft202012Validator(schema).validate(document)
        self.assertEqual(list(document)[:4], ["proofmass", "verb", "input", "warnings"])
        reasons = "\n".join(document["warnings"])
        for path in nulls(document):
            leaf = path.split(".")[-1].split("[")[0]
            self.assertIn(leaf, reasons, f"{path} is null and no warning says why")
        return document


class Coefficients(ModesTest):
    def table(self, rows, header="a_i (g),a_p (g),a_o (g),E (V)", name="rows.csv"):
        self.write(name, "\n".join([header, *(",".join(f"{x:.9g}" for x in row) for row in rows)]) + "\n")

    def centrifuge(self):
        """K1 0.33 V/g, K0 20 mg, K2 1 mg/g², K3 −0.05 mg/g³, misalignments 4 and −3 mrad."""
        draw = random.Random(4)
        rows = []
        for _ in range(40):
            i, p, o = (draw.uniform(-3, 3) for _ in range(3))
            e = 0.33 * (0.02 + i + 1e-3 * i * i - 5e-5 * i**3 + 4e-3 * p + 3e-3 * o)
            rows.append((i, p, o, e + draw.gauss(0, 1e-6)))
        return rows

    def test_a_centrifuge_tells_each_coefficient(self):
        self.table(self.centrifuge())
        asked = "K1,K0,K2,K3,delta_o,delta_p"
        document = self.document("coefficients", "rows.csv", "--coefficients", asked)
        standard = {c["name"]: c["value_standard"] for c in document["outputs"][0]["coefficients"]}
        for name, truth in (("K1", 0.33), ("K0", 0.02), ("K2", 1e-3), ("K3", -5e-5), ("delta_o", 4e-3),
                            ("delta_p", -3e-3)):
            figure = standard[name]
            self.assertLess(abs(figure["value"] - truth), 4 * figure["std"], name)
        self.assertEqual(standard["K1"]["unit"], "V/g")
        self.assertAlmostEqual(document["K1"]["value"] * G, 0.33, places=5)
        self.assertEqual(document["K0"]["unit"], "m/s^2")
        cross = document["outputs"][0]["cross_axis_sensitivity"]["value"]
        self.assertAlmostEqual(cross["value"], 5e-3, places=5)

    def test_at_one_g_it_says_what_goes_together(self):
        self.write("t.csv", "angle (deg),E (V)\n" + "".join(
            f"{a},{0.33 * (0.02 + math.sin(math.radians(a)) + 1e-3 * math.sin(math.radians(a))**2):.9f}\n"
            for a in range(0, 360, 15)))
        document = self.document("coefficients", "t.csv", "--coefficients", "K1,K0,K2,Kpp")
        self.assertIsNone(document["K2"])
        group = document["outputs"][0]["confounded"][0]
        self.assertIn("only by their difference", group["words"])
        self.assertEqual([c["name"] for c in group["combinations"]], ["K0 + 96.17 Kpp", "K2 − Kpp"])
        self.assertAlmostEqual(group["combinations"][1]["value"]["value"] * G, 1e-3, places=7)
        self.assertAlmostEqual(document["gravity_mps2"], G)

    def test_stated_standard_deviations_are_tested(self):
        rows = [(*row, 1e-9) for row in self.centrifuge()]
        self.table(rows, "a_i (g),a_p (g),a_o (g),E (V),E_std (V)")
        document = self.document("coefficients", "rows.csv", "--coefficients", "K1,K0,K2,K3,delta_o,delta_p")
        output = document["outputs"][0]
        self.assertTrue(output["std_stated"])
        self.assertLess(output["residual_test"]["p"], 1e-6)
        self.assertTrue(any("increased" in text for text in document["warnings"]))

    def test_several_outputs_and_the_unit_by_a_flag(self):
        rows = [(*row, 2 * row[3]) for row in self.centrifuge()]
        self.table(rows, "a_i,a_p,a_o,one (V),two (V)")
        document = self.document("coefficients", "rows.csv", "--coefficients", "K1,K0", "--unit", "g")
        self.assertEqual([o["name"] for o in document["outputs"]], ["one", "two"])
        self.assertNotIn("K1", document)
        chosen = self.document("coefficients", "rows.csv", "--coefficients", "K1", "--unit", "g", "--channel", "two")
        self.assertAlmostEqual(chosen["K1"]["value"] * G, 0.66, places=2)

    def test_text_and_page(self):
        self.table(self.centrifuge())
        text = self.succeed("tumble", "rows.csv", "--coefficients", "K1,K0,K2,Kspin", "--report", "p.html")
        self.assertIn("3 of 4 coefficients determined", text)
        self.assertIn("no row turns about", text)
        self.assertIn("</svg>", (self.folder / "p.html").read_text())

    def test_bad_usage_is_told(self):
        self.table(self.centrifuge())
        self.assertIn("K9", self.expect_failure(USAGE, "tumble", "rows.csv", "--coefficients", "K1,K9"))
        self.assertIn("twice", self.expect_failure(USAGE, "tumble", "rows.csv", "--coefficients", "K1,k1"))
        self.expect_failure(USAGE, "tumble", "rows.csv", "--coefficients", "K1", "--channel", "nothing")
        self.table(self.centrifuge(), "a_i,a_p,a_o,E (V)", "bare.csv")
        self.assertIn("(g)", self.expect_failure(USAGE, "tumble", "bare.csv", "--coefficients", "K1"))
        self.table([(1, 2)], "x,E", "none.csv")
        self.expect_failure(USAGE, "tumble", "none.csv", "--coefficients", "K1")
        self.table([(1, 1)], "a_i (g),E (V)", "one.csv")
        self.expect_failure(BAD_INPUT, "tumble", "missing.csv", "--coefficients", "K1")
        ran = self.run_command("tumble", "one.csv", "--coefficients", "K1,K0")
        self.assertIn(ran.returncode, (FAILED, BAD_INPUT))


class Rotating(ModesTest):
    def wheel(self, name="wheel.csv", rpm=11.0, seconds=200, noise=0.02, seed=1, encoder=False, ripple=0.0):
        """Two axes in the plane and one along the axle: K1 1 and 0.98, biases 0.2 and −0.1 m/s², r 0.1 m."""
        draw = random.Random(seed)
        omega = rpm * 2.0 * math.pi / 60.0
        lines = ["time (s),acc_x (m/s^2),acc_y (m/s^2),acc_z (m/s^2)" + (",angle (deg)" if encoder else "")]
        for k in range(int(seconds * 25)):
            t = k / 25
            theta = omega * t + 0.3 + ripple * math.sin(omega * t)
            speed = omega * (1 + ripple * math.cos(omega * t))
            x = 0.2 + G * math.sin(theta) - 0.1 * speed**2 + draw.gauss(0, noise)
            y = -0.1 + 0.98 * G * math.cos(theta) + draw.gauss(0, noise)
            row = f"{t:.3f},{x:.6f},{y:.6f},{draw.gauss(0, noise):.6f}"
            lines.append(row + (f",{math.degrees(theta) % 360:.6f}" if encoder else ""))
        self.write(name, "\n".join(lines) + "\n")

    def test_two_speeds_tell_bias_and_radius(self):
        self.wheel()
        self.wheel("fast.csv", rpm=21.0, seed=2)
        document = self.document("rotating", "wheel.csv", "fast.csv", "--rotating")
        for name, truth in (("K1", 1.0), ("K0", 0.2), ("radius_m", 0.1)):
            figure = document[name]
            self.assertLess(abs(figure["value"] - truth), 4 * figure["std"], name)
        self.assertEqual([axis["name"] for axis in document["axes"]], ["acc_x", "acc_y"])
        self.assertLess(abs(document["axes"][1]["K1"]["value"] - 0.98), 1e-3)
        self.assertEqual(document["direction"], 1)
        self.assertEqual([s["recording"] for s in document["sections"]], [0, 1])

    def test_one_speed_does_not(self):
        self.wheel()
        document = self.document("rotating", "wheel.csv", "--rotating")
        self.assertIsNone(document["K0"])
        self.assertIsNone(document["radius_m"])
        self.assertTrue(any("record a second speed" in text for text in document["warnings"]))
        self.assertAlmostEqual(document["K0_radial"]["value"], 0.2 - 0.1 * (11 * math.pi / 30) ** 2, delta=2e-3)

    def test_an_encoder_tells_the_misalignment(self):
        self.wheel(encoder=True)
        document = self.document("rotating", "wheel.csv", "--rotating", "--angle", "angle")
        self.assertTrue(document["angle_given"])
        self.assertLess(abs(document["misalignment_rad"]["value"]), 4 * document["misalignment_rad"]["std"])

    def test_two_axes_show_a_ripple(self):
        self.wheel(ripple=0.02)
        document = self.document("rotating", "wheel.csv", "--rotating")
        self.assertTrue(document["ripples"][0]["accepted"])
        self.assertAlmostEqual(document["ripples"][0]["amplitude"]["value"], 0.02, delta=2e-3)

    def test_page_text_and_one_axis(self):
        self.wheel()
        text = self.succeed("tumble", "wheel.csv", "--rotating", "--channel", "acc_y", "--report", "p.html")
        self.assertIn("steady turns", text)
        self.assertEqual((self.folder / "p.html").read_text().count("</svg>"), 2)

    def test_a_wheel_whose_axle_moves_is_refused_or_doubted(self):
        self.wheel(noise=2.0)
        ran = self.run_command("tumble", "wheel.csv", "--rotating", "--strict")
        self.assertIn(ran.returncode, (FAILED, BAD_DATA), ran.stderr)
        self.assertIn(b"bench", ran.stderr)

    def test_bad_usage_is_told(self):
        self.wheel(seconds=20)
        self.assertIn("turns", self.expect_failure(BAD_INPUT, "tumble", "wheel.csv", "--rotating"))
        self.expect_failure(USAGE, "tumble", "wheel.csv", "--rotating", "--angle", "nothing")
        self.expect_failure(USAGE, "tumble", "wheel.csv", "--rotating", "--angle", "acc_z")
        three = [flag for axis in "xyz" for flag in ("--channel", f"acc_{axis}")]
        self.expect_failure(USAGE, "tumble", "wheel.csv", "--rotating", *three)


if __name__ == "__main__":
    unittest.main()
