"""Recordings that are read in blocks because they exceed --memory."""
import math
import random
import unittest

from command import USAGE, CommandTest, turning_csv


def noisy_csv(samples):
    """A static sensor that occasionally loses samples."""
    random.seed(7)
    lines = ["time (s),ax (g),ay (g),az (g)"]
    time_s = 0.0
    for k in range(samples):
        time_s += 0.01 if k % 10_000 else 0.05
        values = (0.002 * random.gauss(0, 1), 0.001 * math.sin(0.3 * k), 1 + 0.003 * random.gauss(0, 1))
        lines.append(f"{time_s:.3f}," + ",".join(f"{x:.6f}" for x in values))
    return "\n".join(lines) + "\n"


class Streams(CommandTest):
    def test_are_judged_as_when_read_whole(self):
        self.write("a.csv", noisy_csv(120_000))
        whole = self.document("inspect", "a.csv")
        self.assertEqual(self.without_provenance(self.document("inspect", "a.csv", "--memory", "0")),
                         self.without_provenance(whole))
        self.assertEqual(self.document("inspect", "a.csv", "--from", "100", "--to", "900")["samples"],
                         self.document("inspect", "a.csv", "--from", "100", "--to", "900", "--memory",
                                       "0")["samples"])

    def test_have_their_stamps_mended_and_counted_likewise(self):
        lines = noisy_csv(120_000).splitlines()
        for line, stamp in ((50, "nan"), (70_000, "3e34"), (90_000, "12.5")):
            lines[line] = ",".join([stamp] + lines[line].split(",")[1:])
        self.write("a.csv", "\n".join(lines) + "\n")
        whole = self.document("inspect", "a.csv")
        self.assertEqual(whole["timing"]["mended"], 3)
        self.assertEqual(whole["timing"]["backwards"], 1)
        self.assertEqual(self.without_provenance(self.document("inspect", "a.csv", "--memory", "0")),
                         self.without_provenance(whole))

    def test_are_converted_to_the_same_bytes(self):
        self.write("a.csv", noisy_csv(120_000))
        self.write("s.toml", '[calibration]\nbias = { value = [1.0, 0.0, 0.0], unit = "m/s^2" }\n'
                             'scale = { value = [2.0, 1.0, 1.0], unit = "1" }\n')
        for flags in ([], ["--sensor", "s.toml"], ["--from", "300", "--to", "700"], ["--channel", "az"]):
            self.succeed("convert", "a.csv", *flags, "-o", "whole.csv")
            self.succeed("convert", "a.csv", *flags, "-o", "pieces.csv", "--memory", "0")
            self.assertEqual((self.folder / "whole.csv").read_bytes(),
                             (self.folder / "pieces.csv").read_bytes(), flags)

    def test_come_back_from_every_format(self):
        self.write("a.csv", noisy_csv(30_000))
        before = self.document("inspect", "a.csv")
        for ending in ("mat", "tdms", "h5", "mcap", "csv.gz"):
            for memory in ("0", "1000"):
                self.succeed("convert", "a.csv", "-o", f"b.{ending}", "--memory", memory)
                after = self.document("inspect", f"b.{ending}", "--memory", memory)
                self.assertEqual(after["channels"], before["channels"], ending)
                self.assertEqual(after["samples"], before["samples"], ending)
                self.assertEqual(len(after["timing"]["gaps"]), len(before["timing"]["gaps"]), ending)
                self.assertAlmostEqual(after["duration_s"], before["duration_s"], 9, ending)

    def test_lose_labels_only_with_a_word(self):
        rows = "".join(f"{k / 100},{k % 7},{'up' if k < 50 else 'down'}\n" for k in range(100))
        self.write("a.csv", "time (s),ax (g),part\n" + rows)
        for output, memory, lost in (("b.csv", "1000", False), ("b.csv", "0", True), ("b.npy", "1000", True),
                                     ("b.tdms", "0", False), ("b.h5", "0", False)):
            warnings = self.document("convert", "a.csv", "-o", output, "--memory", memory)["warnings"]
            self.assertEqual(any("labels of column part" in text for text in warnings), lost, output + memory)
        cut = self.document("convert", "a.csv", "-o", "b.mcap", "--memory", "0", "--from", "0.2")["warnings"]
        self.assertTrue(any("labels of column part" in text for text in cut), cut)

    def test_have_the_noise_that_they_have_when_read_whole(self):
        self.write("a.csv", noisy_csv(120_000))
        whole = self.document("noise", "a.csv", "--channel", "ax", "--channel", "az")
        pieces = self.document("noise", "a.csv", "--channel", "ax", "--channel", "az", "--memory", "0")
        for one, other in zip(whole["channels"], pieces["channels"]):
            white, same = one["parameters"]["white"], other["parameters"]["white"]
            self.assertAlmostEqual(white["value"], same["value"], delta=0.01 * white["value"])
            for at, again in zip(one["deviation"]["points"], other["deviation"]["points"]):
                self.assertAlmostEqual(at["value"], again["value"], delta=1e-3 * at["value"])
        self.assertTrue(any("Outliers" in text or "outliers" in text for text in pieces["warnings"]),
                        pieces["warnings"])

    def test_say_what_needs_the_whole_recording(self):
        self.write("a.csv", turning_csv(seconds=20))
        error = self.expect_failure(USAGE, "noise", "a.csv", "--statistic", "totdev", "--memory", "0")
        self.assertIn("total deviation", error)
        error = self.expect_failure(USAGE, "noise", "a.csv", "--temperature", "acc_x", "--memory", "0")
        self.assertIn("--memory", error)


if __name__ == "__main__":
    unittest.main()
