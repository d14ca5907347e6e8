"""proofmass budget."""
import unittest

from command import BAD_INPUT, CommandTest

G = 9.80665


class Budget(CommandTest):
    def test_its_default_is_all_sixteen_cells_of_table_2_1(self):
        rows = self.document("budget")["rows"]
        for row, bias_mg in zip(rows, [0.025, 0.3, 3.0, 125.0], strict=True):
            self.assertAlmostEqual(row["bias_mg"], bias_mg, places=12)
            self.assertEqual([error["t_s"] for error in row["error_m"]], [1, 10, 60, 3600])
            for error in row["error_m"]:
                expected = 0.5 * row["bias_mg"] * 1e-3 * G * error["t_s"] ** 2
                self.assertAlmostEqual(error["value"] / expected, 1.0, places=12)

    def test_a_bias_and_times_of_ones_own(self):
        rows = self.document("budget", "--bias-mg", "2", "--times", "1,5")["rows"]
        self.assertEqual(len(rows), 1)
        self.assertAlmostEqual(rows[0]["bias"]["value"], 2e-3 * G, places=12)
        self.assertEqual([error["t_s"] for error in rows[0]["error_m"]], [1, 5])

    def test_a_sensor_file_gives_what_its_calibration_leaves(self):
        self.write("s.toml", '[sensor]\nname = "s"\n[calibration]\n'
                             'bias = { value = 0.1, std = 0.002, unit = "m/s^2", origin = "test" }\n')
        rows = self.document("budget", "--sensor", "s.toml", "--times", "10")["rows"]
        self.assertEqual([row["grade"] for row in rows], ["s x", "s y", "s z"])
        self.assertEqual(rows[0]["error_m"][0]["value"], 0.0)
        self.assertAlmostEqual(rows[0]["error_m"][0]["std"], 0.5 * 0.002 * 100.0, places=12)

    def test_flicker_and_random_walk_of_the_sensor_file_count(self):
        self.write("s.toml", '[sensor]\nname = "s"\n[calibration]\n'
                             'bias = { value = 0.1, std = 0.001, unit = "m/s^2", origin = "test" }\n[noise]\n'
                             'white = { value = 1e-3, unit = "m/s^2/sqrt(Hz)", origin = "test" }\n'
                             'flicker = { value = 2e-3, unit = "m/s^2", origin = "test" }\n'
                             'random_walk = { value = 1e-4, unit = "m/s^2/sqrt(s)", origin = "test" }\n')
        document = self.document("budget", "--sensor", "s.toml", "--times", "600")
        error = document["rows"][0]["error_m"][0]
        parts = error["std_parts"]
        self.assertAlmostEqual(parts["bias"], 0.5 * 0.001 * 600**2, places=9)
        self.assertAlmostEqual(parts["white"], 1e-3 * (600**3 / 3) ** 0.5, places=9)
        self.assertAlmostEqual(parts["random_walk"], 1e-4 * (600**5 / 20) ** 0.5, places=9)
        self.assertAlmostEqual(parts["flicker"] / (0.5 * 2e-3 * 600**2), 0.72, delta=0.02)
        self.assertAlmostEqual(error["std"] ** 2, sum(part**2 for part in parts.values()), places=6)
        self.assertEqual(document["warnings"], [])

    def test_noise_that_the_sensor_file_lacks_or_only_bounds_is_named(self):
        self.write("s.toml", '[sensor]\nname = "s"\n[calibration]\n'
                             'bias = { value = 0.1, std = 0.001, unit = "m/s^2", origin = "test" }\n[noise]\n'
                             'white = { value = 1e-3, unit = "m/s^2/sqrt(Hz)", origin = "test" }\n'
                             'random_walk = { value = 0, std = 1e-4, unit = "m/s^2/sqrt(s)", origin = "test" }\n')
        warnings = "\n".join(self.document("budget", "--sensor", "s.toml")["warnings"])
        self.assertIn("does not determine flicker, random walk (below 0.00016 m/s^2/sqrt(s))", warnings)

    def test_a_sensor_file_without_a_std_says_what_is_missing(self):
        self.write("s.toml", '[sensor]\nname = "s"\n')
        self.assertIn("calibration.bias", self.expect_failure(BAD_INPUT, "budget", "--sensor", "s.toml"))

    def test_the_text_has_the_thesis_s_figures(self):
        text = self.succeed("budget")
        for cell in ("0.12 mm", "15 mm", "7900 km"):
            self.assertIn(cell, text)

    def test_the_report_is_drawn(self):
        self.succeed("budget", "--report", "b.html")
        self.assertIn("</svg>", (self.folder / "b.html").read_text())


if __name__ == "__main__":
    unittest.main()
