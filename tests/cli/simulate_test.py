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


if __name__ == "__main__":
    unittest.main()
