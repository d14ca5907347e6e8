"""record --stream and --no-file: the lines that a program reads, and a file that does not depend on it."""
import json
import os
import signal
import socket
import subprocess
import time
import unittest

from command import PROGRAM, USAGE, CommandTest


def by_kind(lines):
    kinds = {}
    for line in lines:
        frame = json.loads(line)
        (kind, value), = frame.items()
        kinds.setdefault(kind, []).append(value)
    return kinds


class RecordStream(CommandTest):
    def start(self, *arguments):
        recorder = subprocess.Popen([PROGRAM, "record", *arguments, "--stream"], cwd=self.folder,
                                    stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self.addCleanup(recorder.stderr.close)
        self.addCleanup(recorder.stdout.close)
        self.addCleanup(recorder.wait, 120)
        self.addCleanup(recorder.kill)
        return recorder

    def test_the_lines_are_the_samples_of_the_file(self):
        lines = self.succeed("record", "sim:wheel?rate=100&speed=max&seconds=60", "-o", "run.mcap",
                             "--stream").splitlines()
        kinds = by_kind(lines)
        self.assertEqual(kinds["head"][0]["file"], "run.mcap")
        self.assertEqual(kinds["end"][0]["files"], ["run.mcap"])
        names = [channel["name"] for channel in kinds["head"][0]["channels"]]
        self.succeed("convert", "run.mcap", "-o", "run.csv")
        rows = [line.split(",") for line in (self.folder / "run.csv").read_text().splitlines()
                if line[:1].isdigit()]
        self.assertEqual(len(rows), 6000)
        times = [time for frame in kinds["rows"] for time in frame["t"]]
        self.assertEqual(len(times), 6000)
        for c, name in enumerate(names):
            streamed = [value for frame in kinds["rows"] for value in frame["min"][c]]
            for k in range(0, 6000, 97):
                self.assertAlmostEqual(times[k], float(rows[k][0]) - float(rows[0][0]), places=5)
                self.assertAlmostEqual(streamed[k], float(rows[k][1 + c]), delta=1e-5 * max(1.0, abs(streamed[k])),
                                       msg=f"{name} {k}")

    def received(self, reader, address):
        """Datagrams of an estimate of tilt while it is recorded."""
        reader.settimeout(20)
        with reader:
            recorder = subprocess.Popen(
                [PROGRAM, "record", "sim:static?rate=100", "--duration", "4", "--estimate", "tilt", "--send-to", address,
                 "--no-file", "--quiet"], cwd=self.folder, stdout=subprocess.DEVNULL)
            self.addCleanup(recorder.wait, 60)
            self.addCleanup(recorder.kill)
            found = [json.loads(reader.recv(4096)) for _ in range(40)]
        self.assertEqual(recorder.wait(60), 0)
        return found

    def test_estimates_are_sent_to_a_controller(self):
        to_port = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        to_port.bind(("127.0.0.1", 0))
        to_path = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        to_path.bind(str(self.folder / "controller"))
        for reader, address in ((to_port, f"udp:127.0.0.1:{to_port.getsockname()[1]}"), (to_path, "unix:controller")):
            found = self.received(reader, address)
            times = [one["time_s"] for one in found]
            self.assertEqual(times, sorted(times))
            self.assertGreater(times[-1], 0.3)
            self.assertIn("roll", found[-1])
            self.assertLess(found[-1]["roll_std"], 0.2)

    def test_nobody_takes_the_estimates(self):
        ran = self.run_command("record", "sim:static?rate=100", "--duration", "1", "--estimate", "tilt", "--no-file",
                               "--send-to", "unix:nobody")
        self.assertEqual(ran.returncode, 0)
        self.assertIn("dropped by --send-to", ran.stderr.decode())
        self.assertFalse((self.folder / "nobody").exists())
        for address in ("tcp:1", "udp:9000", "unix:", "unix:" + "x" * 200):
            self.expect_failure(USAGE, "record", "sim:static", "--estimate", "tilt", "--no-file", "--send-to", address)

    def test_without_a_file_nothing_is_written(self):
        kinds = by_kind(self.succeed("record", "sim:static?rate=100&speed=max&seconds=20", "--no-file",
                                     "--stream").splitlines())
        self.assertIsNone(kinds["head"][0]["file"])
        self.assertEqual(kinds["end"][0]["files"], [])
        self.assertEqual(kinds["end"][0]["samples"], 2000)
        self.assertEqual(list(self.folder.iterdir()), [])
        self.expect_failure(USAGE, "record", "sim:", "--no-file", "-o", "a.mcap")
        self.expect_failure(USAGE, "record", "sim:", "--no-file", "--rotate", "5")

    def test_a_reader_that_stops_reading_delays_nothing(self):
        recorder = self.start("sim:wheel?rate=1000", "-o", "run.mcap", "--duration", "8")
        self.assertIn(b"head", recorder.stdout.readline())
        self.assertEqual(recorder.wait(120), 0)  # nobody has read a line since
        found = self.document("inspect", "run.mcap")
        self.assertEqual(found["samples"], 8000)
        self.assertEqual(found["timing"]["gaps"], [])

    def test_the_recording_ends_with_its_reader(self):
        recorder = self.start("sim:wheel?rate=200", "-o", "run.mcap")
        self.assertIn(b"head", recorder.stdout.readline())
        time.sleep(1.0)
        recorder.stdout.close()
        recorder.wait(60)
        self.assertGreater(self.document("inspect", "run.mcap")["samples"], 100)

    def test_a_signal_closes_the_file_and_the_last_line_says_so(self):
        recorder = self.start("sim:wheel?rate=200", "-o", "run.mcap", "--estimate", "wheel")
        time.sleep(2.0)
        os.kill(recorder.pid, signal.SIGTERM)
        kinds = by_kind(recorder.stdout.read().decode().splitlines())
        recorder.wait(60)
        self.assertEqual([column["name"] for column in kinds["columns"][0]][:2], ["angle", "angle_std"])
        self.assertEqual(kinds["end"][0]["how"], "stopped")
        self.assertTrue((self.folder / "run.mcap").exists())


if __name__ == "__main__":
    unittest.main()
