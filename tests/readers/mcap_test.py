"""Our MCAP files read by @mcap/core, and its files read by us."""
import json
import math
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE.parent / "cli"))
from command import CommandTest, turning_csv  # noqa: E402

LIBRARY = HERE / "node_modules" / "@mcap" / "core"


def why_not():
    if shutil.which("node") is None:
        return "node is not installed"
    if not LIBRARY.is_dir():
        return f"{LIBRARY.relative_to(HERE.parent.parent)} is missing: tools/setup.sh test installs it"
    return None


@unittest.skipIf(why_not(), f"SKIPPED, MCAP IS NOT HELD AGAINST AN INDEPENDENT READER: {why_not()}")
class Mcap(CommandTest):
    def node(self, script, *arguments) -> str:
        ran = subprocess.run(["node", HERE / script, *map(str, arguments)], cwd=self.folder,
                             capture_output=True, timeout=200)
        self.assertEqual(ran.returncode, 0, ran.stderr.decode())
        return ran.stdout.decode()

    def read_by_node(self, name) -> dict:
        return json.loads(self.node("read_mcap.mjs", self.folder / name))

    def columns_of(self, found) -> list:
        """The blocks concatenated."""
        first = 0
        columns = [[] for _ in found["blocks"][0]["columns"]]
        for block in found["blocks"]:
            self.assertEqual(block["version"], 1)
            self.assertEqual(block["first"], first)
            first += block["rows"]
            for column, part in zip(columns, block["columns"]):
                column += part
        return columns

    def test_a_file_of_ours_has_the_same_values_there(self):
        self.write("a.csv", turning_csv(seconds=300))
        self.succeed("convert", "a.csv", "-o", "a.mcap")
        found = self.read_by_node("a.mcap")
        rows = (self.folder / "a.csv").read_text().splitlines()[1:]
        values = [[float(field) for field in row.split(",")] for row in rows]
        columns = self.columns_of(found)
        self.assertEqual(columns, [list(column) for column in zip(*values)][1:])
        self.assertEqual(found["encoding"], "proofmass-samples")
        self.assertEqual(found["schemaEncoding"], "jsonschema")
        self.assertEqual(found["schema"]["columns"],
                         [{"name": f"acc_{axis}", "unit": "m/s^2"} for axis in "xyz"])
        self.assertEqual(found["channel"]["rate_hz"], "100")
        self.assertEqual(found["messageCount"], len(found["blocks"]))
        self.assertEqual(found["metadata"]["proofmass"]["source"], "a.csv")
        self.assertTrue(found["library"].startswith("proofmass "))

    def test_every_checksum_is_right_there_and_the_file_is_whole(self):
        self.write("a.csv", turning_csv(seconds=600))
        self.succeed("convert", "a.csv", "-o", "a.mcap")
        found = self.read_by_node("a.mcap")
        self.assertTrue(found["streamed"]["done"])
        self.assertEqual(found["streamed"]["kinds"]["Message"], found["messageCount"])
        self.assertEqual(found["chunks"], 2)
        times = [int(time) for time in found["times"]]
        self.assertEqual(times, sorted(times))

    def test_stamps_that_are_not_even_are_kept(self):
        rows = [f"{0.01 * k + 0.001 * math.sin(k):.6f},{k}" for k in range(500)]
        self.write("a.csv", "time (s),acc_x (g)\n" + "\n".join(rows) + "\n")
        self.succeed("convert", "a.csv", "-o", "a.mcap")
        found = self.read_by_node("a.mcap")
        stamps = [stamp for block in found["blocks"] for stamp in block["stamps"]]
        expected = [float(row.split(",")[0]) for row in rows]
        self.assertEqual(len(stamps), 500)
        for stamp, time in zip(stamps, expected):
            self.assertAlmostEqual(stamp, time - expected[0], places=12)
        before = self.document("inspect", "a.csv")
        after = self.document("inspect", "a.mcap")
        self.assertEqual(before["channels"], after["channels"])
        self.assertEqual(before["timing"]["jitter_s"], after["timing"]["jitter_s"])

    def test_a_file_of_theirs_is_read(self):
        self.node("write_mcap.mjs", self.folder / "b.mcap", 500)
        imu = self.document("inspect", "b.mcap")
        self.assertEqual(imu["format"], "MCAP")
        self.assertEqual(imu["samples"], 500)
        self.assertAlmostEqual(imu["rate_hz"], 100.0, places=9)
        channels = {channel["name"]: channel for channel in imu["channels"]}
        self.assertEqual(channels["linear_acceleration_z"]["unit"], "m/s^2")
        self.assertAlmostEqual(channels["linear_acceleration_z"]["mean"], 9.81, places=12)
        self.assertAlmostEqual(channels["linear_acceleration_x"]["max"], 0.499, places=12)
        self.assertEqual(channels["angular_velocity_y"]["unit"], "rad/s")
        battery = self.document("inspect", "b.mcap", "--variable", "/battery")
        self.assertEqual(battery["samples"], 50)
        channels = {channel["name"]: channel for channel in battery["channels"]}
        self.assertAlmostEqual(channels["voltage"]["max"], 12.0, places=12)
        self.assertEqual(channels["cell_temp"]["max"], 510.0)

    def test_a_file_of_theirs_that_is_cut_off_is_read_up_to_there(self):
        self.node("write_mcap.mjs", self.folder / "b.mcap", 500)
        whole = (self.folder / "b.mcap").read_bytes()
        self.write("c.mcap", whole[: len(whole) * 6 // 10])
        document = self.document("inspect", "c.mcap")
        self.assertGreater(document["samples"], 250)
        self.assertLess(document["samples"], 310)
        self.assertTrue(any("breaks off at byte" in warning for warning in document["warnings"]))


if __name__ == "__main__":
    unittest.main()
