"""proofmass inspect."""
import gzip
import struct
import unittest
from pathlib import Path

from command import BAD_DATA, BAD_INPUT, USAGE, CommandTest, turning_csv


class Inspect(CommandTest):
    def test_the_document_has_what_the_contract_names(self):
        self.write("a.csv", turning_csv())
        document = self.document("inspect", "a.csv")
        self.assertEqual(document["input"], ["a.csv"])
        self.assertEqual(document["samples"], 2000)
        self.assertAlmostEqual(document["rate_hz"], 100.0, places=3)
        self.assertAlmostEqual(document["duration_s"], 19.99, places=6)
        names = [channel["name"] for channel in document["channels"]]
        self.assertEqual(names, ["acc_x", "acc_y", "acc_z"])
        self.assertEqual({channel["unit"] for channel in document["channels"]}, {"m/s^2"})
        self.assertEqual(document["timing"]["source"], "stamps")
        self.assertEqual(document["timing"]["gaps"], [])

    def test_words_are_labels_and_go_with_the_window(self):
        rows = [f"{k / 100},{'up' if k < 300 else 'down' if k < 500 else ''},0.1,{k % 7}"
                for k in range(1000)]
        self.write("a.csv", "t,part,acc_x (g),acc_y (g)\n" + "\n".join(rows) + "\n")
        document = self.document("inspect", "a.csv")
        self.assertEqual(document["labels"],
                         [{"channel": "part", "name": "up", "runs": 1, "samples": 300},
                          {"channel": "part", "name": "down", "runs": 1, "samples": 200}])
        self.assertIn("Labels in column part", self.succeed("inspect", "a.csv"))
        self.succeed("convert", "a.csv", "--from", "2", "--to", "6", "--output", "b.csv")
        labels = self.document("inspect", "b.csv")["labels"]
        self.assertEqual([(use["name"], use["samples"]) for use in labels],
                         [("up", 100), ("down", 200)])

    def test_gaps_and_dirt_are_counted(self):
        lines = turning_csv(seconds=4).splitlines()
        lines[50] = lines[50].split(",")[0] + ",nan,1,1"
        del lines[200:250]
        self.write("a.csv", "\n".join(lines) + "\n")
        document = self.document("inspect", "a.csv")
        self.assertEqual(len(document["timing"]["gaps"]), 1)
        self.assertAlmostEqual(document["timing"]["gaps"][0]["duration_s"], 0.51, places=6)
        self.assertEqual(document["channels"][0]["nonfinite"], 1)

    def test_without_time_the_rate_is_null_and_given_it_is_there(self):
        rows = "\n".join(f"{0.1 + k % 3},9.8" for k in range(100))
        self.write("a.csv", "acc_x (g),acc_y (g)\n" + rows + "\n")
        self.assertIsNone(self.document("inspect", "a.csv")["rate_hz"])
        document = self.document("inspect", "a.csv", "--rate", "50")
        self.assertEqual(document["rate_hz"], 50)
        self.assertEqual(document["timing"]["source"], "given_rate")

    def test_several_files_are_each_told(self):
        self.write("a.csv", turning_csv(seconds=2))
        self.write("b.csv", turning_csv(seconds=3))
        document = self.document("inspect", "a.csv", "b.csv")
        self.assertEqual([f["samples"] for f in document["files"]], [200, 300])
        self.assertEqual(document["samples"], 200)
        text = self.succeed("inspect", "a.csv", "b.csv")
        self.assertIn("a.csv", text)
        self.assertIn("b.csv", text)

    def test_a_compressed_file_and_standard_input_read_the_same(self):
        csv = turning_csv(seconds=2)
        self.write("a.csv", csv)
        self.write("a.csv.gz", gzip.compress(csv.encode()))
        plain = self.document("inspect", "a.csv")
        packed = self.document("inspect", "a.csv.gz")
        piped = self.document("inspect", "-", stdin=csv.encode())
        for other in (packed, piped):
            self.assertEqual(other["channels"], plain["channels"])
            self.assertEqual(other["timing"], plain["timing"])
        self.assertEqual(piped["input"], ["-"])

    def test_a_window_leaves_out_what_is_outside(self):
        self.write("a.csv", turning_csv())
        document = self.document("inspect", "a.csv", "--from", "5", "--to", "10")
        self.assertEqual(document["samples"], 500)

    def test_the_unit_given_holds(self):
        self.write("a.csv", turning_csv(seconds=2).replace(" (m/s^2)", ""))
        document = self.document("inspect", "a.csv", "--unit", "mg")
        self.assertEqual({channel["unit"] for channel in document["channels"]}, {"mg"})

    def test_channels_are_chosen_one_by_one(self):
        self.write("a.csv", turning_csv(seconds=2))
        document = self.document("inspect", "--channel", "acc_z", "--channel", "acc_x", "a.csv")
        self.assertEqual([c["name"] for c in document["channels"]], ["acc_x", "acc_z"])

    def test_strict_tells_bad_data_by_the_status_and_still_gives_the_result(self):
        self.write("good.csv", turning_csv(seconds=2))
        self.succeed("inspect", "good.csv", "--strict")
        lines = turning_csv(seconds=4).splitlines()
        for k in range(100, 130):
            lines[k] = lines[k].split(",")[0] + ",3e34,nan,1"
        self.write("bad.csv", "\n".join(lines) + "\n")
        self.assertTrue(self.document("inspect", "bad.csv")["bad"])
        ran = self.run_command("inspect", "bad.csv", "--strict")
        self.assertEqual(ran.returncode, BAD_DATA)
        self.assertIn("acc_x", ran.stdout.decode())

    def test_a_variable_of_a_mat_file_is_chosen_by_its_name(self):
        def variable(name, values):
            head = struct.pack("<5i", 0, len(values), 1, 0, len(name) + 1)
            return head + name.encode() + b"\0" + struct.pack(f"<{len(values)}d", *values)

        mat = variable("t", [k * 0.01 for k in range(50)]) + variable("ax", [1.0, -1.0] * 25)
        mat += variable("long", [1.0, -1.0] * 50)
        self.write("a.mat", mat)
        document = self.document("inspect", "a.mat")
        self.assertEqual(document["format"], "MAT v4")
        self.assertEqual([channel["name"] for channel in document["channels"]], ["ax"], "accelerations come first")
        for flag in ("--variable", "--channel"):
            chosen = self.document("inspect", "a.mat", flag, "long")
            self.assertEqual([channel["name"] for channel in chosen["channels"]], ["long"])
        self.assertAlmostEqual(document["rate_hz"], 100.0, places=6)
        self.write("cut.mat", mat[:-8])
        self.assertIn("byte", self.expect_failure(BAD_INPUT, "inspect", "cut.mat"))
        self.expect_failure(USAGE, "inspect", "a.mat", "--variable", "az")

    def test_a_dataset_of_an_hdf5_file_is_chosen_by_its_name(self):
        specimen = Path(__file__).parents[2] / "fuzz/corpus/hdf5/sensors.h5"
        if b"without the HDF5 library" in self.run_command("inspect", specimen).stderr:
            self.skipTest("built without the HDF5 library")
        document = self.document("inspect", specimen)
        self.assertEqual(document["format"], "HDF5")
        self.assertEqual([channel["min"] for channel in document["channels"]], [1, 2, 3])
        document = self.document("inspect", specimen, "--dataset", "right")
        self.assertEqual([channel["min"] for channel in document["channels"]], [5, 6, 7])
        self.assertAlmostEqual(document["rate_hz"], 200.0, places=6)
        self.expect_failure(USAGE, "inspect", specimen, "--dataset", "middle")
        self.write("cut.h5", specimen.read_bytes()[:4000])
        self.assertIn("breaks off", self.expect_failure(BAD_INPUT, "inspect", "cut.h5"))

    def test_the_report_is_one_page_with_every_channel(self):
        self.write("a.csv", turning_csv(seconds=2))
        self.succeed("inspect", "a.csv", "--report", "a.html")
        page = (self.folder / "a.html").read_text()
        self.assertIn("acc_x, acc_y, acc_z", page)
        self.assertIn("</svg>", page)
        self.assertNotIn("src=", page)


if __name__ == "__main__":
    unittest.main()
