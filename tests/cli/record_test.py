"""proofmass record and recover."""
import json
import math
import os
import pty
import resource
import signal
import subprocess
import time
import tty
import unittest

from command import DONE, FAILED, INTERRUPTED, PROGRAM, USAGE, CommandTest, parse_json

BAD_DEVICE = 4
ROW = b"%d,%.3f,%.3f,%.3f\n"
HEADER = b"t (ms),x (m/s^2),y (m/s^2),z (m/s^2)\n"


def rows(first, count):
    """Lines as sent by a microcontroller: milliseconds and three values."""
    return b"".join(ROW % (10 * k, k % 7, k % 11, 9.81) for k in range(first, first + count))


class Record(CommandTest):
    def start(self, *arguments, **how):
        """The command in the background; killed with the test."""
        process = subprocess.Popen(
            [PROGRAM, "record", *map(str, arguments)],
            cwd=self.folder,
            stdin=how.get("stdin", subprocess.DEVNULL),
            stdout=subprocess.PIPE,
            stderr=how.get("stderr", subprocess.PIPE),
            env={**os.environ, **how.get("environment", {})},
            preexec_fn=how.get("preexec_fn"),
        )
        self.addCleanup(process.communicate)
        self.addCleanup(process.kill)
        return process

    def wait_for(self, condition, what, seconds=120):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if condition():
                return
            time.sleep(0.02)
        self.fail(f"waited {seconds} s for {what}")

    def wait_for_part(self, name, size=1):
        part = self.folder / f"{name}.part"
        self.wait_for(lambda: part.exists() and part.stat().st_size >= size, part.name)

    def end(self, process, status):
        """Its document, once it has exited with this status."""
        out, err = process.communicate(timeout=200)
        self.assertEqual(process.returncode, status, (err or b"").decode())
        document = parse_json(out.decode())
        self.check_document("record", document)
        return document

    def test_the_twin_arrives_whole(self):
        document = self.document(
            "record", "sim:wheel?rate=1000&speed=max&seconds=20", "-o", "run.mcap"
        )
        self.assertEqual(document["file"], "run.mcap")
        self.assertEqual(document["samples"], 20000)
        self.assertEqual((document["lost"], document["gaps"]), (0, 0))
        self.assertEqual(document["end"], "source_end")
        audit = self.document("inspect", "run.mcap")
        self.assertEqual(audit["samples"], 20000)
        self.assertEqual(audit["timing"]["gaps"], [])
        self.assertAlmostEqual(audit["rate_hz"], 1000.0, places=6)
        self.assertEqual(self.leftovers(), [])

    def test_what_is_recorded_can_be_analysed(self):
        self.succeed("record", "sim:wheel?rpm=30&speed=max&seconds=40", "-o", "run.mcap")
        turns = self.document("wheel", "run.mcap", "--radius", "0.1")["turns"]
        self.assertAlmostEqual(turns["value"], 20.0, delta=0.2)

    def test_duration_ends_a_source_that_would_go_on(self):
        document = self.document(
            "record", "sim:?rate=500&speed=max", "--duration", "4", "-o", "run.mcap"
        )
        self.assertEqual(document["samples"], 2000)
        self.assertEqual(document["end"], "duration")

    def test_ctrl_c_closes_the_file(self):
        process = self.start("sim:?rate=200", "-o", "run.mcap", "--json", "-")
        self.wait_for_part("run.mcap", 20000)
        process.send_signal(signal.SIGINT)
        document = self.end(process, INTERRUPTED)
        self.assertEqual(document["end"], "stopped")
        self.assertGreater(document["samples"], 0)
        self.assertEqual(self.document("inspect", "run.mcap")["samples"], document["samples"])
        self.assertEqual(self.leftovers(), [])

    def test_every_usual_signal_closes_the_file_without_a_word_of_interruption(self):
        # A closed terminal, a stopped service, and Ctrl-C pressed twice.
        for signals in ([signal.SIGHUP], [signal.SIGTERM], [signal.SIGINT, signal.SIGINT]):
            name = f"{signals[0].name}{len(signals)}.mcap"
            process = self.start("sim:?rate=200", "-o", name)
            self.wait_for_part(name, 20000)
            for one in signals:
                process.send_signal(one)
            out, err = process.communicate(timeout=200)
            self.assertEqual(process.returncode, INTERRUPTED, err.decode())
            self.assertNotIn(b"interrupted", err)
            self.assertIn(b"Nothing was lost", out)
            self.assertGreater(self.document("inspect", name)["samples"], 0)
        self.assertEqual(self.leftovers(), [])

    def test_what_nohup_ignores_stays_ignored(self):
        process = self.start("sim:?rate=200", "-o", "run.mcap",
                             preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN))
        self.wait_for_part("run.mcap", 1)
        process.send_signal(signal.SIGHUP)
        time.sleep(0.3)
        self.assertIsNone(process.poll())
        process.send_signal(signal.SIGINT)
        process.communicate(timeout=200)
        self.assertEqual(process.returncode, INTERRUPTED)

    def test_a_limit_on_the_size_of_files_is_a_full_disk(self):
        most = 2_500_000
        process = self.start("sim:?rate=1000&speed=max&seconds=100", "-o", "run.mcap",
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
        out, err = process.communicate(timeout=200)
        self.assertEqual(process.returncode, FAILED, err.decode())
        self.assertIn(b"are in no file, since the disk failed", out)
        self.assertNotIn(b"Nothing was lost", out)
        self.assertGreater(self.document("inspect", "run.mcap")["samples"], 0)

    def test_a_limit_that_leaves_no_room_at_all_leaves_no_part(self):
        process = self.start("sim:?rate=1000&speed=max&seconds=100", "-o", "run.mcap",
                             preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (0, 0)))
        _, err = process.communicate(timeout=200)
        self.assertNotEqual(process.returncode, DONE, err.decode())
        self.assertEqual(self.leftovers(), [])

    def test_killed_it_is_recovered(self):
        process = self.start("sim:?rate=1000", "-o", "run.mcap")
        self.wait_for_part("run.mcap", 150000)
        process.kill()
        process.wait()
        self.assertGreater(self.document("inspect", "run.mcap.part")["samples"], 1000)
        document = self.document("recover", "run.mcap.part")
        self.assertEqual(document["file"], "run.mcap")
        self.assertFalse(document["was_whole"])
        self.assertEqual(document["missing_samples"], 0)
        audit = self.document("inspect", "run.mcap")
        self.assertEqual(audit["samples"], document["samples"])
        self.assertEqual(audit["timing"]["gaps"], [])
        self.expect_failure(USAGE, "recover", "run.mcap.part")

    def test_a_leftover_is_never_written_over(self):
        self.write("run.mcap.part", "what a crash has left")
        error = self.expect_failure(USAGE, "record", "sim:?speed=max&seconds=1", "-o", "run.mcap")
        self.assertIn("proofmass recover", error)
        self.write("old.mcap", "somebody's")
        self.expect_failure(USAGE, "record", "sim:?speed=max&seconds=1", "-o", "old.mcap")
        self.assertEqual((self.folder / "old.mcap").read_text(), "somebody's")

    def test_rotation_makes_files_that_are_whole(self):
        document = self.document(
            "record", "sim:?rate=100&speed=max&seconds=10", "--rotate", "4", "-o", "run.mcap"
        )
        self.assertEqual(
            document["files"], ["run.0001.mcap", "run.0002.mcap", "run.0003.mcap"]
        )
        counts = [self.document("inspect", name)["samples"] for name in document["files"]]
        self.assertEqual(counts, [400, 400, 200])

    def test_a_trigger_keeps_what_is_around_it(self):
        # A turn of 2 s: the level is crossed once per turn.
        document = self.document(
            "record", "sim:wheel?rpm=30&rate=200&speed=max&seconds=20", "-o", "run.mcap",
            "--trigger", "acc1_x > 5.0", "--trigger-before", "0.1", "--trigger-after", "0.2",
        )
        kept = document["samples"] / 200
        self.assertGreater(kept, 8 * 0.3)
        self.assertLess(kept, 11 * 1.0)
        self.assertEqual(document["samples"] + document["not_kept"], 4000)
        self.assertEqual(document["gaps"], 0)

    def test_the_wheel_is_followed_live(self):
        document = self.document(
            "record", "sim:wheel?rpm=20&rate=200&seconds=15", "-o", "run.mcap",
            "--estimate", "wheel", "--radius", "0.1",
        )
        self.assertGreater(document["latency"]["blocks"], 100)
        self.succeed("convert", "run.mcap", "--variable", "estimates", "-o", "angle.csv")
        head, *lines = (self.folder / "angle.csv").read_text().splitlines()
        names = [cell.split(" ")[0] for cell in head.split(",")]
        first, last = ([float(x or "nan") for x in line.split(",")] for line in (lines[0], lines[-1]))
        angle, at = names.index("angle"), names.index("time")
        speed = (last[angle] - first[angle]) / (last[at] - first[at])
        self.assertAlmostEqual(abs(speed) * 60 / 6.283185307, 20.0, delta=0.2)

    def estimates(self, source, what):
        """The columns that are recorded beside the samples."""
        self.succeed("record", source, "-o", f"{what}.mcap", "--estimate", what)
        self.succeed("convert", f"{what}.mcap", "--variable", "estimates", "-o", f"{what}.csv")
        head, *lines = (self.folder / f"{what}.csv").read_text().splitlines()
        columns = zip(*([float(cell or "nan") for cell in line.split(",")] for line in lines))
        return dict(zip((cell.split(" ")[0] for cell in head.split(",")), columns))

    def test_a_carriage_is_followed_live(self):
        # Six strokes of 0.4 m in alternating directions.
        columns = self.estimates("sim:slide?speed=max", "track")
        self.assertAlmostEqual(max(columns["position"]), 0.4, delta=0.05)
        self.assertLess(abs(columns["position"][-1]), 4 * columns["position_std"][-1])

    def test_inclination_is_followed_live(self):
        columns = self.estimates("sim:static?seconds=20&speed=max", "tilt")
        self.assertEqual(len(columns["roll"]), 4000)
        self.assertLess(columns["roll_std"][-1], 0.05)

    def pushed_wheel(self, unit):
        """Rows of a wheel of 0.3 m that is pushed by hand, with a gyroscope about its axle in degrees a second."""
        lines, angle, rate = [f"t (s),ax (m/s^2),ay (m/s^2),az (m/s^2),gx{unit},gy{unit},gz{unit}"], 0.3, 100
        for k in range(30 * rate):
            t = k / rate
            since = (t - 4) % 1.5
            push = t > 4 and t < 24 and since < 0.3
            accel = 20 * math.sin(math.pi * since / 0.3) if push else 0
            speed = self.speed if k else 0
            if not push:
                accel = -2 if speed > 0.1 else 0
            self.speed = max(0, speed + accel / rate)
            angle += self.speed / rate
            hub = -0.3 * accel
            force = (9.81 * math.sin(angle) + hub * math.cos(angle) - 0.05 * speed ** 2,
                     9.81 * math.cos(angle) - hub * math.sin(angle) + 0.05 * accel)
            noise = [0.05 * math.sin(k * (k % 97 + n)) for n in range(3)]
            lines.append(f"{t:.3f},{force[0] + noise[0]:.5f},{force[1] + noise[1]:.5f},{noise[2]:.5f},"
                         f"{noise[1]:.4f},{noise[0]:.4f},{math.degrees(self.speed) + noise[2]:.4f}")
        self.turned = angle - 0.3
        return "\n".join(lines).encode() + b"\n"

    def angle_of_wheel(self, samples, *flags):
        """Turned angle and its standard deviation at the end, and the warnings."""
        ran = self.run_command("record", "-", "-o", "run.mcap", "--estimate", "wheel", "--axis", "z", *flags,
                               stdin=samples)
        self.assertEqual(ran.returncode, DONE, ran.stderr)
        self.succeed("convert", "run.mcap", "--variable", "estimates", "-o", "angle.csv")
        head, *lines = (self.folder / "angle.csv").read_text().splitlines()
        first, last = (dict(zip((cell.split(" ")[0] for cell in head.split(",")), line.split(",")))
                       for line in (lines[0], lines[-1]))
        (self.folder / "run.mcap").unlink()
        return float(last["angle"]) - float(first["angle"]), float(last["angle_std"]), ran.stderr.decode()

    def test_a_gyroscope_follows_a_wheel_that_is_pushed(self):
        turned, std, said = self.angle_of_wheel(self.pushed_wheel(" (deg/s)"))
        self.assertAlmostEqual(turned, self.turned, delta=0.2)
        self.assertLess(std, 0.2)
        self.assertNotIn("turns may be lost", said)
        self.assertGreater(self.angle_of_wheel(self.pushed_wheel(" (deg/s)"), "--no-gyro")[1], std)

    def test_the_unit_of_a_gyroscope_that_has_none_can_be_said(self):
        samples = self.pushed_wheel("").replace(b"gx,gy,gz", b"gyr_x,gyr_y,gyr_z")
        turned, std, said = self.angle_of_wheel(samples, "--rate-unit", "deg/s")
        self.assertIn("have no unit: deg/s is assumed", said)
        self.assertAlmostEqual(turned, self.turned, delta=0.2)
        self.assertLess(std, 0.2)
        self.expect_failure(USAGE, "record", "-", "--no-file", "--rate-unit", "deg/s", stdin=b"")

    def test_an_estimate_needs_an_accelerometer(self):
        error = self.expect_failure(
            USAGE, "record", "-", "-o", "run.mcap", "--estimate", "tilt",
            stdin=b"pressure (Pa)\n" + b"1\n2\n" * 50,
        )
        self.assertIn("no accelerometer", error)

    def test_a_pipe_is_read_to_its_end(self):
        document = self.document(
            "record", "-", "-o", "run.mcap", stdin=HEADER + rows(0, 500)
        )
        self.assertEqual((document["samples"], document["lost"]), (500, 0))
        audit = self.document("inspect", "run.mcap")
        self.assertAlmostEqual(audit["rate_hz"], 100.0, places=6)
        self.assertEqual([c["name"] for c in audit["channels"]], ["x", "y", "z"])

    def test_a_unit_that_the_source_does_not_know_can_be_said(self):
        document = self.document(
            "record", "stdin:?rate=100", "--unit", "g", "-o", "run.mcap", stdin=b"0.1,0.2,0.9\n" * 100
        )
        self.assertEqual([c["unit"] for c in document["channels"]], ["g"] * 3)

    def open_pty(self, link):
        """A serial line that the program opens by a link."""
        ours, theirs = pty.openpty()
        tty.setraw(theirs)
        os.set_blocking(ours, False)
        path = self.folder / link
        path.unlink(missing_ok=True)
        path.symlink_to(os.ttyname(theirs))
        return ours, theirs

    def feed(self, ours, first, process, until):
        """Sends rows at intervals until the condition holds; returns the next row's number."""
        end = time.monotonic() + 120
        while not until():
            self.assertLess(time.monotonic(), end, "waited 120 s")
            self.assertIsNone(process.poll(), "it ended early")
            try:
                os.write(ours, rows(first, 10))
                first += 10
            except BlockingIOError:
                pass
            time.sleep(0.05)
        return first

    def test_a_cable_that_is_pulled_ends_it_with_the_file_closed(self):
        ours, theirs = self.open_pty("tty")
        process = self.start("serial:tty?baud=115200", "-o", "run.mcap", "--json", "-")
        part = self.folder / "run.mcap.part"
        self.feed(ours, 0, process, lambda: part.exists() and part.stat().st_size > 8000)
        os.close(ours)
        os.close(theirs)
        document = self.end(process, BAD_DEVICE)
        self.assertEqual(document["end"], "source_gone")
        self.assertGreater(document["samples"], 0)
        self.assertEqual(self.document("inspect", "run.mcap")["samples"], document["samples"])
        self.assertEqual(self.leftovers(), [])

    def test_a_cable_that_comes_back_leaves_a_marked_gap(self):
        ours, theirs = self.open_pty("tty")
        process = self.start("serial:tty", "-o", "run.mcap", "--json", "-", "--reconnect")
        part = self.folder / "run.mcap.part"
        self.feed(ours, 0, process, lambda: part.exists() and part.stat().st_size > 8000)
        os.close(ours)
        os.close(theirs)
        ours, theirs = self.open_pty("tty")
        size = part.stat().st_size
        self.feed(ours, 0, process, lambda: part.stat().st_size > size + 20000)
        process.send_signal(signal.SIGINT)
        document = self.end(process, INTERRUPTED)
        os.close(ours)
        os.close(theirs)
        kinds = [event["kind"] for event in document["events"]]
        self.assertIn("disconnected", kinds)
        self.assertIn("reconnected", kinds)
        self.assertGreaterEqual(document["gaps"], 1)

    def test_a_source_that_is_not_there_is_status_4(self):
        error = self.expect_failure(BAD_DEVICE, "record", "serial:no-such-tty", "-o", "run.mcap")
        self.assertIn("no-such-tty", error)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_what_makes_no_sense_is_told_before_anything_is_opened(self):
        for arguments in (
            [],
            ["sim:", "-o", "run.csv"],
            ["nosuch:"],
            ["sim:?rete=10"],
            ["sim:", "--trigger", "acc1_x"],
            ["sim:", "--trigger", ">3"],
            ["sim:", "--estimate", "nothing"],
            ["sim:", "--duration", "-1"],
            ["sim:?speed=max&seconds=1", "--trigger", "nosuch>3"],
        ):
            with self.subTest(arguments=arguments):
                self.expect_failure(USAGE, "record", *arguments)
        self.assertEqual(self.leftovers(), [])

    def test_the_list_shows_every_kind(self):
        document = self.document("record", "--list")
        grammar = " ".join(kind["grammar"] for kind in document["kinds"])
        for scheme in (
            "sim:", "replay:", "iio:", "serial:", "udp:", "mqtt:", "phyphox:", "sensorserver:",
            "daqmx:", "comedi:", "stdin:",
        ):
            self.assertIn(scheme, grammar)

    def test_the_view_draws_in_place_on_a_terminal_only(self):
        ours, theirs = pty.openpty()
        process = self.start(
            "sim:?rate=200", "--duration", "2", "-o", "run.mcap",
            stderr=theirs, environment={"TERM": "xterm"},
        )
        os.close(theirs)
        drawn = b""
        try:
            while chunk := os.read(ours, 65536):
                drawn += chunk
        except OSError:  # the terminal closes with the process
            pass
        os.close(ours)
        self.assertEqual(process.wait(timeout=60), DONE)
        self.assertIn(b"acc1_x", drawn)
        self.assertIn(b"\x1b[", drawn)
        plain = self.run_command("record", "sim:?rate=200&speed=max&seconds=1", "-o", "b.mcap")
        self.assertNotIn(b"\x1b", plain.stderr)

    def test_strict_speaks_of_what_is_missing(self):
        ran = self.run_command(
            "record", "sim:?rate=100&speed=max&seconds=20&drop=0.1", "-o", "run.mcap", "--strict",
            "--json", "run.json",
        )
        self.assertEqual(ran.returncode, 5, ran.stderr)
        document = json.loads((self.folder / "run.json").read_text())
        self.assertGreater(document["lost"], 0)
        self.assertEqual(document["samples"] + document["lost"], 2000)


if __name__ == "__main__":
    unittest.main()
