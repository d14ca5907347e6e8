"""proofmass convert."""
import unittest

from command import USAGE, CommandTest, turning_csv


class Convert(CommandTest):
    def test_what_is_written_reads_back_the_same(self):
        self.write("a.csv", turning_csv(seconds=3))
        document = self.document("convert", "a.csv", "-o", "b.csv.gz")
        self.assertEqual(document["file"], "b.csv.gz")
        self.assertEqual(document["samples"], 300)
        before = self.document("inspect", "a.csv")
        after = self.document("inspect", "b.csv.gz")
        self.assertEqual(before["channels"], after["channels"])
        self.assertEqual(before["rate_hz"], after["rate_hz"])
        self.assertEqual(self.leftovers(), [])

    def test_npy_keeps_the_numbers(self):
        self.write("a.csv", turning_csv(seconds=3))
        self.succeed("convert", "a.csv", "-o", "b.npy")
        self.assertEqual((self.folder / "b.npy").read_bytes()[:6], b"\x93NUMPY")
        before = self.document("inspect", "a.csv")["channels"]
        after = self.document("inspect", "b.npy")
        self.assertAlmostEqual(after["rate_hz"], 100.0, places=6)
        self.assertEqual([c["mean"] for c in after["channels"]], [c["mean"] for c in before])

    def test_to_standard_output_is_csv_and_nothing_else(self):
        self.write("a.csv", turning_csv(seconds=1))
        text = self.succeed("convert", "a.csv", "-o", "-")
        self.assertEqual(len(text.splitlines()), 101)
        self.assertTrue(text.startswith("time (s),acc_x (m/s^2),"))

    def test_two_things_cannot_have_standard_output(self):
        self.write("a.csv", turning_csv(seconds=1))
        self.expect_failure(USAGE, "convert", "a.csv", "-o", "-", "--json", "-")

    def test_a_given_supply_takes_the_place_of_the_sensor_files(self):
        # Half the supply plus 0.1 of it is 1 g at any supply.
        self.write("a.csv", "time (s),acc_x (V)\n0,1.8\n0.01,1.8\n0.02,1.8\n")
        electrical = ('[electrical]\nsupply = { value = 3.3, unit = "V" }\n'
                      'sensitivity = { value = [330, 330, 330], unit = "mV/g" }\n'
                      'zero_g_fraction = { value = [0.5, 0.5, 0.5], unit = "1" }\n')
        self.write("plain.toml", electrical)
        self.write("s.toml", electrical + 'reference_supply = { value = 3.3, unit = "V" }\n'
                   'supply_channel = "rail"\n')
        self.succeed("convert", "a.csv", "--sensor", "s.toml", "--supply", "3.0", "-o", "b.csv")
        last = (self.folder / "b.csv").read_text().splitlines()[-1]
        self.assertAlmostEqual(float(last.split(",")[1]), 9.80665, places=9)
        error = self.expect_failure(USAGE, "convert", "a.csv", "--sensor", "plain.toml", "--supply", "3",
                                    "-o", "c.csv")
        self.assertIn("reference_supply", error)
        self.expect_failure(USAGE, "convert", "a.csv", "--supply", "3", "-o", "c.csv")
        self.expect_failure(USAGE, "convert", "a.csv", "--sensor", "s.toml", "--supply", "0", "-o", "c.csv")

    def test_a_sensor_file_is_applied(self):
        self.write("a.csv", turning_csv(seconds=1))
        self.write("s.toml", '[sensor]\nname = "s"\n[calibration]\n'
                             'bias = { value = [1.0, 0.0, 0.0], unit = "m/s^2", origin = "test" }\n'
                             'scale = { value = [2.0, 1.0, 1.0], unit = "1", origin = "test" }\n')
        self.succeed("convert", "a.csv", "--sensor", "s.toml", "-o", "b.csv")
        before = self.document("inspect", "a.csv")["channels"]
        after = self.document("inspect", "b.csv")["channels"]
        self.assertAlmostEqual(after[0]["mean"], (before[0]["mean"] - 1.0) / 2.0, places=9)
        self.assertAlmostEqual(after[1]["mean"], before[1]["mean"], places=9)


if __name__ == "__main__":
    unittest.main()
