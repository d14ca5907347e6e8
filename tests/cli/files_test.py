"""Output files: never over an input, never partial, never through another file."""
import os
import random
import signal
import stat
import subprocess
import threading
import time
import unittest
import zipfile

from command import BAD_INPUT, DONE, PROGRAM, USAGE, CommandTest, parse_json, rest_csv, turning_csv

# Number of times at which each command is killed: a few in the usual run, many in the long one.
INSTANTS = int(os.environ.get("PROOFMASS_KILLS", "6"))


class Files(CommandTest):
    def setUp(self):
        super().setUp()
        self.input = self.write("a.csv", turning_csv(seconds=2))
        self.bytes = self.input.read_bytes()

    def assert_refused(self, *arguments):
        error = self.expect_failure(USAGE, *arguments)
        self.assertEqual(self.input.read_bytes(), self.bytes, error)
        return error

    def test_an_input_is_never_an_output(self):
        (self.folder / "link.csv").symlink_to("a.csv")
        os.link(self.input, self.folder / "hard.csv")
        (self.folder / "room").mkdir()
        for name in ("a.csv", "./a.csv", "room/../a.csv", "link.csv", "hard.csv"):
            self.assertIn("would replace the input", self.assert_refused("convert", "a.csv", "-o", name))
        for verb in ("inspect", "noise", "drift", "wheel", "track", "tilt"):
            self.assert_refused(verb, "a.csv", "--json", "a.csv")
            self.assert_refused(verb, "a.csv", "--report", "a.csv")
        for verb in ("noise", "drift", "wheel", "tilt", "track", "tune", "calibrate", "tumble"):
            self.assert_refused(verb, "a.csv", "-o", "a.csv")
        self.assert_refused("noise", "a.csv", "--update-sensor", "a.csv")
        self.assert_refused("thesis", "--static", "a.csv", "--json", "a.csv")

    def test_nor_is_a_file_of_a_folder_that_is_read(self):
        (self.folder / "runs").mkdir()
        (self.folder / "runs/one.csv").write_bytes(self.bytes)
        self.expect_failure(USAGE, "convert", "runs", "-o", "runs/one.csv")
        self.assertEqual((self.folder / "runs/one.csv").read_bytes(), self.bytes)

    def test_nor_is_a_sensor_file_unless_it_is_updated(self):
        sensor = self.write("imu.toml", '[sensor]\nname = "imu"\n')
        for flag in ("-o", "--json", "--report"):
            self.expect_failure(USAGE, "noise", "a.csv", "--sensor", "imu.toml", flag, "imu.toml")
        self.expect_failure(USAGE, "sensor", "export", "imu.toml", "--format", "imu-yaml", "-o", "imu.toml")
        self.assertEqual(sensor.read_text(), '[sensor]\nname = "imu"\n')

    def test_two_outputs_are_two_files(self):
        self.assertIn("--json and --report both name ./out",
                      self.assert_refused("inspect", "a.csv", "--json", "out", "--report", "./out"))
        self.assertEqual(self.leftovers(), [])

    def test_a_recording_that_a_crash_has_left_is_not_touched(self):
        part = self.write("run.csv.part", self.bytes)
        other = self.write("other.csv", turning_csv(seconds=1))
        self.succeed("convert", other, "-o", "run.csv")
        self.assertEqual(part.read_bytes(), self.bytes)
        # The part file itself as the input: too large for memory, so it is read while it is written.
        self.succeed("convert", "run.csv.part", "-o", "run.csv", "--memory", "0.001")
        self.assertEqual(part.read_bytes(), self.bytes)
        self.assertEqual(self.document("inspect", "run.csv")["samples"], 200)

    def test_a_link_is_kept_and_nothing_goes_through_a_prepared_one(self):
        victim = self.write("victim", "victim")
        for name in ("out.csv.part", "out.json.part"):
            (self.folder / name).symlink_to(victim)
        (self.folder / "link.json").symlink_to("real.json")
        self.succeed("convert", "a.csv", "-o", "out.csv", "--json", "out.json")
        self.succeed("inspect", "a.csv", "--json", "link.json")
        self.assertEqual(victim.read_text(), "victim")
        self.assertTrue((self.folder / "link.json").is_symlink())
        self.assertEqual(parse_json((self.folder / "real.json").read_text())["verb"], "inspect")

    def test_what_is_no_file_is_written_into(self):
        os.mkfifo(self.folder / "pipe")
        for arguments in (("inspect", "a.csv", "--json", "pipe"), ("convert", "a.csv", "-o", "pipe")):
            read = []
            reader = threading.Thread(target=lambda: read.append((self.folder / "pipe").read_bytes()))
            reader.start()
            self.succeed(*arguments)
            reader.join(timeout=30)
            self.assertGreater(len(read[0]), 100)
            self.assertTrue(stat.S_ISFIFO((self.folder / "pipe").stat().st_mode))
        self.succeed("inspect", "a.csv", "--json", "/dev/null", "--report", "/dev/null")
        self.assertTrue(stat.S_ISCHR(os.stat("/dev/null").st_mode))
        document = parse_json(self.succeed("inspect", "a.csv", "--json", "/dev/stdout").split("\na.csv")[0].rsplit("}", 1)[0] + "}")
        self.assertEqual(document["verb"], "inspect")

    def test_the_mode_of_a_file_is_kept(self):
        for name, arguments in (("out.json", ("inspect", "a.csv", "--json")), ("out.csv", ("convert", "a.csv", "-o"))):
            path = self.write(name, "old")
            path.chmod(0o600)
            self.succeed(*arguments, name)
            self.assertEqual(stat.S_IMODE(path.stat().st_mode), 0o600)
            self.assertNotEqual(path.read_text(), "old")

    def test_of_two_at_once_one_is_there_whole(self):
        self.write("short.csv", turning_csv(seconds=1))
        for _ in range(3):
            runs = [subprocess.Popen([PROGRAM, "convert", name, "-o", "same.csv", "-q"], cwd=self.folder, stdout=subprocess.DEVNULL)
                    for name in ("a.csv", "short.csv")]
            self.assertEqual([run.wait(timeout=60) for run in runs], [DONE, DONE])
            self.assertIn(self.document("inspect", "same.csv")["samples"], (100, 200))
        self.assertEqual(self.leftovers(), [])


class Killed(CommandTest):
    """kill -9 at any time: the inputs and the previous files are intact."""

    def kill_at_instants(self, whole_s, *arguments):
        draw = random.Random(7)
        for _ in range(INSTANTS):
            run = subprocess.Popen([PROGRAM, *arguments], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            time.sleep(draw.uniform(0.0, 1.1 * whole_s))
            run.send_signal(signal.SIGKILL)
            run.wait()
            yield run.returncode == DONE

    def check(self, inputs, output, *arguments):
        before = {name: (self.folder / name).read_bytes() for name in inputs}
        began = time.monotonic()
        self.succeed(*arguments)
        whole_s = time.monotonic() - began
        complete = (self.folder / output).read_bytes()
        old = b"what was there before"
        for done in self.kill_at_instants(whole_s, *arguments):
            for name, content in before.items():
                if name != output:
                    self.assertEqual((self.folder / name).read_bytes(), content, name)
            found = (self.folder / output).read_bytes()
            self.assertTrue(found in (complete, before.get(output, old)), "neither the old file nor the new one")
            (self.folder / output).write_bytes(before.get(output, old))

    def test_convert(self):
        self.write("a.csv", turning_csv(seconds=200, rate_hz=200))
        self.write("a.npy.part", "a recorder's")
        self.check(["a.csv", "a.npy.part"], "a.npy", "convert", "a.csv", "-o", "a.npy", "-q")

    def test_simulate(self):
        self.write("s.csv.part", "a recorder's")
        self.check(["s.csv.part"], "s.csv", "simulate", "--duration", "60", "--seed", "3", "-o", "s.csv", "-q")

    def test_update_sensor(self):
        self.write("rest.csv", rest_csv(seconds=30))
        self.write("imu.toml", '[sensor]\nname = "imu"\nserial = "7"\n')
        self.check(["rest.csv", "imu.toml"], "imu.toml", "noise", "rest.csv", "--update-sensor", "imu.toml", "-q")

    def test_record(self):
        """Of a killed recorder's data at most the last second is missing, and an older file stays."""
        rate_hz, draw = 1000, random.Random(7)
        older = self.write("older.mcap", "a recorder's")
        for _ in range(INSTANTS):
            run = subprocess.Popen([PROGRAM, "record", f"sim:?rate={rate_hz}", "-o", "run.mcap", "-q"], cwd=self.folder,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            part, ends = self.folder / "run.mcap.part", time.monotonic() + draw.uniform(0.0, 3.0)
            heading = began = None  # size of the file without data; when the first data were in it
            while time.monotonic() < ends:
                size = part.stat().st_size if part.exists() else 0
                heading = heading or size
                if began is None and size > heading:
                    began = time.monotonic()
                time.sleep(0.005)
            run.send_signal(signal.SIGKILL)
            lived_s = time.monotonic() - began if began else 0.0
            run.wait()
            self.assertEqual(older.read_text(), "a recorder's")
            self.assertFalse((self.folder / "run.mcap").exists())
            samples = 0
            if part.exists():
                if self.run_command("recover", "run.mcap.part").returncode == DONE:
                    samples = self.document("inspect", "run.mcap")["samples"]
                    (self.folder / "run.mcap").unlink()
                else:
                    part.unlink()
            self.assertGreater(samples, (lived_s - 1.0) * rate_hz, f"killed after {lived_s:.3f} s")


class Packed(CommandTest):
    @unittest.skipUnless("PROOFMASS_KILLS" in os.environ, "half a minute; in the long run")
    def test_a_zip_that_unpacks_to_a_thousand_times_its_size_is_refused(self):
        rows = b"0,0\n" * (1 << 20)
        with zipfile.ZipFile(self.folder / "a.zip", "w", zipfile.ZIP_DEFLATED) as archive:
            with archive.open("a.csv", "w", force_zip64=True) as member:
                member.write(b"time (s),acc_x (m/s^2)\n")
                for _ in range(300):
                    member.write(rows)
        ran = self.run_command("inspect", "a.zip")
        self.assertEqual(ran.returncode, BAD_INPUT)
        self.assertIn("unpacks to more than 250 times its size", ran.stderr.decode())


if __name__ == "__main__":
    unittest.main()
