"""proofmass record --procedure: the twin takes its positions in its own order, and the guide follows."""
import csv
import tomllib
import unittest

from command import BAD_INPUT, USAGE, CommandTest, parse_json


class Guided(CommandTest):
    def guided(self, source, procedure, *arguments):
        """Document of the verb, and the output of the guide."""
        ran = self.run_command("record", source, "-o", "run.mcap", "--procedure", procedure, *arguments,
                               "--json", "-")
        said = ran.stderr.decode()
        self.assertEqual(ran.returncode, 0, said)
        document = parse_json(ran.stdout.decode())
        paths = [one["path"] for one in document["provenance"]["inputs"]]
        self.assertTrue(paths and all((self.folder / path).is_file() for path in paths), paths)
        return document, said

    def rests(self):
        return list(csv.DictReader((self.folder / "run.rests.csv").read_text().splitlines()))

    def test_a_hand_is_led_to_a_calibration(self):
        document, said = self.guided("sim:multi-position?seed=1&speed=max", "multi-position",
                                     "--update-sensor", "s.toml")
        self.check_document("calibrate", document)
        count = len(self.rests())
        self.assertIn(count, range(12, 15))
        self.assertEqual(said.count(" taken: "), count)
        self.assertIn("→ Position 1: place it with +z straight up", said)
        self.assertIn(f"{count} positions: the accuracy at 1 g is", said)
        self.assertIn("To do this again: proofmass calibrate run.mcap --rests run.rests.csv", said)
        self.assertEqual(len(document["positions"]), count)
        self.assertIn("calibration", tomllib.loads((self.folder / "s.toml").read_text()))
        again = self.document("calibrate", "run.mcap", "--rests", "run.rests.csv")
        self.assertEqual(again["parameters"], document["parameters"])

    def test_a_table_is_led_round_and_its_angles_reach_the_verb(self):
        document, said = self.guided("sim:tumble?seed=1&speed=max", "tumble", "--positions", "24")
        self.check_document("tumble", document)
        self.assertEqual([float(rest["angle (deg)"]) for rest in self.rests()],
                         [15.0 * k for k in range(25)])
        self.assertIn("→ Position 25 of 25: turn the table to 0° once more", said)
        again = self.document("tumble", "run.mcap", "--rests", "run.rests.csv")
        self.assertEqual(again["channels"], document["channels"])

    def test_a_sensor_that_lies_still_tells_its_noise(self):
        document, said = self.guided("sim:static?seed=1&speed=max&seconds=200", "static", "--minutes", "2")
        self.check_document("noise", document)
        self.assertIn("of rest.", said)
        self.assertIn("To do this again: proofmass noise run.mcap --from ", said)
        self.assertFalse((self.folder / "run.rests.csv").exists())

    def test_where_nothing_rests_the_recording_is_kept(self):
        line = self.expect_failure(BAD_INPUT, "record", "sim:wheel?speed=max&seconds=20", "-o", "run.mcap",
                                   "--procedure", "multi-position", "--json", "-", "--channel", "acc1_x",
                                   "--channel", "acc1_y", "--channel", "acc1_x")
        self.assertIn("no rest was taken", line)
        self.assertTrue((self.folder / "run.mcap").exists())

    def test_flags_that_do_not_go_together_are_refused(self):
        sim = ("record", "sim:static?speed=max&seconds=1", "-o", "run.mcap")
        self.assertIn("--rotate", self.expect_failure(USAGE, *sim, "--procedure", "tumble", "--rotate", "5"))
        self.assertIn("--minutes", self.expect_failure(USAGE, *sim, "--procedure", "tumble", "--minutes", "5"))
        self.expect_failure(USAGE, *sim, "--positions", "5")

    def test_a_list_of_rests_goes_with_angles_or_without(self):
        self.succeed("simulate", "--procedure", "tumble", "--positions", "8", "--seed", "2", "-o", "t.csv")
        by_itself = self.document("tumble", "t.csv")
        first = "start (s),end (s)\n" + "".join(f"{10.0 * k + 2.0},{10.0 * k + 3.0}\n" for k in range(2))
        self.write("bad.csv", first.replace("end (s)", "end (s),angle (deg)").replace("3.0\n", "3.0,5\n", 1))
        line = self.expect_failure(BAD_INPUT, "tumble", "t.csv", "--rests", "bad.csv", "--json", "-")
        self.assertIn("2 rests and 1 angles", line)
        self.assertTrue(by_itself["channels"])


if __name__ == "__main__":
    unittest.main()
