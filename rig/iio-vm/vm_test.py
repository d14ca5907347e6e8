#!/usr/bin/env python3
"""Records from the kernel's own accelerometer and data acquisition drivers in a virtual machine.

    PROOFMASS=PROGRAM vm_test.py FOLDER     FOLDER is build.sh's; exits 77 where there is no machine

The machine is emulated and shares its processor with whatever else runs, so nothing here asks for
a rate that is kept: only that what came is right, and that what did not is told.
"""
import json
import math
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

PROGRAM = os.environ["PROOFMASS"]
HERE = Path(__file__).resolve().parent
BAD_DEVICE = 4
PATIENCE_S = 240


def free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return listener.getsockname()[1]


class Machine:
    """The virtual machine, from its boot to its end."""

    def __init__(self, folder: Path):
        self.iiod_port, self.command_port = free_port(), free_port()
        self.process = subprocess.Popen(
            [HERE / "boot.sh", folder, str(self.iiod_port), str(self.command_port)],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )
        self.console = []
        self.ready = threading.Event()
        threading.Thread(target=self.listen, daemon=True).start()

    def listen(self):
        for line in self.process.stdout:
            self.console.append(line.rstrip())
            if "proofmass-vm: ready" in line:
                self.ready.set()
        self.ready.set()

    def wait_until_ready(self):
        if not self.ready.wait(PATIENCE_S) or self.process.poll() is not None:
            raise RuntimeError("the machine did not come up:\n" + "\n".join(self.console[-30:]))

    def run(self, command: str) -> tuple[int, str]:
        """Status and output of a line of shell inside."""
        with socket.create_connection(("127.0.0.1", self.command_port), timeout=PATIENCE_S) as line:
            line.sendall(command.encode() + b"\n")
            output = b"".join(iter(lambda: line.recv(65536), b"")).decode()
        text, _, status = output.rpartition("status ")
        return int(status), text

    def stop(self):
        self.process.kill()
        self.process.wait()


class VirtualMachineTest(unittest.TestCase):
    machine: Machine

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="proofmass-vm-"))
        self.addCleanup(shutil.rmtree, self.folder)
        self.file = self.folder / "run.mcap"
        # A test before may have killed the daemon, which is started anew.
        self.machine.run("until netstat -lnt | grep -q :30431; do sleep 0.2; done")

    def uri(self, device: str, **settings) -> str:
        words = "".join(f"&{key}={value}" for key, value in settings.items())
        return f"iio:ip:127.0.0.1:{self.machine.iiod_port}?device={device}{words}"

    def start(self, source: str, *flags) -> subprocess.Popen:
        recording = subprocess.Popen(
            [PROGRAM, "record", source, "-o", self.file, "--json", "-", *flags],
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(recording.communicate)
        self.addCleanup(recording.kill)
        return recording

    def end(self, recording: subprocess.Popen, status: int) -> tuple[dict, str]:
        """The document and the messages of a recording that must end so."""
        output, messages = recording.communicate(timeout=PATIENCE_S)
        self.assertEqual(recording.returncode, status, messages)
        return (json.loads(output) if output else {}), messages

    def record(self, source: str, *flags) -> dict:
        return self.end(self.start(source, *flags), 0)[0]

    def rows(self) -> list[list[float]]:
        """What is in the recording, each row with its time first."""
        table = self.folder / "run.csv"
        subprocess.run([PROGRAM, "convert", self.file, "-o", table], check=True, capture_output=True)
        lines = table.read_text().splitlines()
        first = next(k for k, line in enumerate(lines) if line[:1] in "-0123456789")
        return [[float(cell) for cell in line.split(",")] for line in lines[first:]]

    def check_wheel(self, rows: list[list[float]]):
        """The wheel's acceleration is gravity, turning."""
        for _, x, y, _ in rows:
            self.assertAlmostEqual(math.hypot(x, y), 9.81, delta=0.06)

    def wait_for_samples(self, recording: subprocess.Popen):
        """Until there is something on the disk to lose."""
        part = self.file.with_name(self.file.name + ".part")
        deadline = time.monotonic() + PATIENCE_S
        while not (part.exists() and part.stat().st_size > 4096):
            if recording.poll() is not None:
                self.fail("it ended before a sample came: " + recording.communicate()[1])
            self.assertLess(time.monotonic(), deadline, "no sample came")
            time.sleep(0.1)

    def check_live_timestamps(self, rate: int):
        told = self.record(self.uri("lis3dh", trigger="t0", rate=rate), "--duration", "5")
        self.assertEqual(told["settings"]["trigger"], "t0")
        self.assertEqual(told["settings"]["rate granted"], f"{rate} Hz, by t0")
        self.assertEqual(told["settings"]["timestamps"], "the device's")
        self.assertEqual(told["settings"]["clock"], "monotonic")
        self.assertEqual([channel["unit"] for channel in told["channels"]], ["m/s^2"] * 3)
        self.assertEqual(told["end"], "duration")
        self.assertAlmostEqual(told["duration_s"], 5.0, delta=0.6)
        self.assertGreater(told["samples"], 50)
        rows = self.rows()
        self.assertEqual(len(rows), told["samples"])
        self.check_wheel(rows)
        self.assertTrue(all(a[0] < b[0] for a, b in zip(rows, rows[1:])), "time runs forward")

    def test_a_driver_with_live_timestamps(self):
        self.check_live_timestamps(200)

    def test_a_driver_that_cannot_keep_up(self):
        self.check_live_timestamps(1000)

    def test_a_driver_whose_timestamps_are_dead(self):
        told = self.record(self.uri("kxcjk1013", trigger="t0", rate=200), "--duration", "4")
        self.assertEqual(told["settings"]["timestamps"], "dead")
        self.assertIn("timestamps are dead", "\n".join(told["warnings"] + [event["text"] for event in told["events"]]))
        rows = self.rows()
        self.check_wheel(rows)
        self.assertGreater(rows[-1][0], 3.0)

    def test_a_driver_that_refuses_the_trigger(self):
        _, messages = self.end(self.start(self.uri("bmc150_accel", trigger="t0")), BAD_DEVICE)
        self.assertIn("bmc150_accel refuses the trigger t0 (Invalid argument)", messages)
        self.assertFalse(self.file.exists())

    def test_several_sensors_have_to_be_told_apart(self):
        recording = self.start(f"iio:ip:127.0.0.1:{self.machine.iiod_port}")
        output, messages = recording.communicate(timeout=PATIENCE_S)
        self.assertNotEqual(recording.returncode, 0, output)
        for name in ("kxcjk1013", "bmc150_accel", "lis3dh"):
            self.assertIn(name, messages)

    def test_the_daemons_death_is_a_gap_where_it_may_come_back(self):
        recording = self.start(self.uri("lis3dh", trigger="t0", rate=200), "--reconnect", "--duration", "15")
        self.wait_for_samples(recording)
        self.machine.run("kill -9 $(pidof iiod)")
        told, _ = self.end(recording, 0)
        kinds = [event["kind"] for event in told["events"]]
        self.assertIn("disconnected", kinds)
        self.assertIn("reconnected", kinds)
        self.assertGreaterEqual(told["gaps"], 1)
        self.assertEqual(told["end"], "duration")
        self.check_wheel(self.rows())

    def test_the_daemons_death_ends_it_where_it_may_not(self):
        recording = self.start(self.uri("lis3dh", trigger="t0", rate=200))
        self.wait_for_samples(recording)
        self.machine.run("kill -9 $(pidof iiod)")
        told, messages = self.end(recording, BAD_DEVICE)
        self.assertEqual(told["end"], "source_gone")
        self.assertIn("the board is gone", messages)
        self.assertEqual(os.listdir(self.folder), ["run.mcap"])
        self.check_wheel(self.rows())

    def test_a_data_acquisition_card(self):
        source = "comedi:/dev/comedi0?channels=0,1,2,3,4,5&rate=1000"
        status, output = self.machine.run(
            f"proofmass record '{source}' --duration 10 -o /tmp/card.mcap --json /tmp/card.json >/tmp/card.txt 2>&1;"
            " status=$?; cat /tmp/card.json || cat /tmp/card.txt; rm -f /tmp/card.*; (exit $status)"
        )
        self.assertEqual(status, 0, output)
        told = json.loads(output)
        self.assertEqual(told["lost"], 0, told["gap_list"])
        # Six channels, one after the other, each a whole number of microseconds.
        self.assertEqual(told["settings"]["between channels"], "167000 ns")
        self.assertEqual(told["settings"]["rate granted"], "998.003992 Hz")
        self.assertEqual([channel["name"] for channel in told["channels"]], [f"ch{k}" for k in range(6)])
        self.assertEqual({channel["unit"] for channel in told["channels"]}, {"V"})
        self.assertAlmostEqual(told["samples"], 10000, delta=200)


def main():
    folder = Path(sys.argv.pop(1))
    built = subprocess.run([HERE / "build.sh", folder, PROGRAM])
    if built.returncode != 0:
        sys.exit(built.returncode)
    machine = Machine(folder)
    try:
        machine.wait_until_ready()
        VirtualMachineTest.machine = machine
        unittest.main(verbosity=2)
    finally:
        machine.stop()


if __name__ == "__main__":
    main()
