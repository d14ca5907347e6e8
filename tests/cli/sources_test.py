"""A minute at 1 kHz and six channels through each kind of source that needs no separate machine, in
parallel: nothing may be lost. Each sender counts its rows, so that the recorder detects a loss."""
import os
import pty
import shutil
import socket
import subprocess
import sys
import threading
import time
import tty
import unittest
from pathlib import Path

from command import DONE, PROGRAM, CommandTest, parse_json

SECONDS, RATE = int(os.environ.get("PROOFMASS_SOURCE_SECONDS", "60")), 1000
ROWS = SECONDS * RATE
RIG = Path(__file__).resolve().parents[2] / "rig"
HEADER = "n,t (us)," + ",".join(f"c{i} (g)" for i in range(6)) + "\n"


def line(k):
    """Row k: its number, its microseconds and six values."""
    return f"{k},{1000 * k},{k % 1000},{k % 7},{k % 11},{k % 13},{k % 17},{k % 19}\n"


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def send_paced(write, first=0):
    """A minute of rows, ten at a time, when they are due."""
    start = time.monotonic()
    for k in range(first, ROWS + RATE, 10):
        time.sleep(max(0.0, start + (k - first) / RATE - time.monotonic()))
        try:
            write("".join(line(i) for i in range(k, k + 10)).encode())
        except (BrokenPipeError, ConnectionRefusedError, OSError):
            return


class Sources(CommandTest):
    def setUp(self):
        super().setUp()
        self.running = {}

    def background(self, *command, **how):
        process = subprocess.Popen([*map(str, command)], cwd=self.folder, **how)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def record(self, name, source, environment=None, **how):
        """Records a minute from the source, in parallel with all others."""
        said = (self.folder / f"{name}.err").open("wb")
        self.addCleanup(said.close)
        self.running[name] = self.background(
            PROGRAM, "record", source, "-o", f"{name}.mcap", "--duration", SECONDS, "--json",
            f"{name}.json", "--stall-end", 120,
            stdout=subprocess.DEVNULL, stderr=said,
            env={**os.environ, **(environment or {})}, **how,
        )
        return self.running[name]

    def send(self, write):
        threading.Thread(target=send_paced, args=(write,), daemon=True).start()

    def start_twin_and_replay(self):
        self.record("sim", f"sim:wheel?rate={RATE}")
        self.succeed("record", f"sim:wheel?rate={RATE}&speed=max&seconds={SECONDS + 1}", "-o", "played.mcap")
        self.record("replay", "replay:played.mcap")

    def start_serial(self):
        ours, theirs = pty.openpty()
        tty.setraw(theirs)
        os.write(ours, HEADER.encode())
        self.record("serial", f"serial:{os.ttyname(theirs)}?baud=921600")
        self.send(lambda text: os.write(ours, text))
        self.addCleanup(os.close, theirs)
        self.addCleanup(os.close, ours)

    def start_stdin(self):
        process = self.record("stdin", "-", stdin=subprocess.PIPE, bufsize=0)
        process.stdin.write(HEADER.encode())
        self.send(process.stdin.write)

    def start_udp(self):
        port = free_port()
        self.record("udp", f"udp:127.0.0.1:{port}?columns=n,t_us,c0,c1,c2,c3,c4,c5")
        sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.addCleanup(sender.close)

        def write(text):
            try:
                sender.sendto(text, ("127.0.0.1", port))
            except ConnectionRefusedError:
                pass  # the recorder is not running yet, or no longer

        self.send(write)

    def start_mqtt(self):
        broker = shutil.which("mosquitto", path=os.environ["PATH"] + ":/usr/sbin")
        if not broker:
            print("mqtt: left out: install mosquitto and mosquitto-clients", file=sys.stderr)
            return
        port = free_port()
        self.background(broker, "-p", port, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.wait_for_port(port)
        sender = self.background(
            "mosquitto_pub", "-p", port, "-t", "bench/imu", "-l", stdin=subprocess.PIPE, bufsize=0
        )
        self.addCleanup(sender.stdin.close)
        self.record("mqtt", f"mqtt://127.0.0.1:{port}/bench/imu?columns=n,t_us,c0,c1,c2,c3,c4,c5")
        self.send(sender.stdin.write)

    def wait_for_port(self, port):
        end = time.monotonic() + 60
        while time.monotonic() < end:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", port)) == 0:
                    return
            time.sleep(0.05)
        self.fail("the broker does not listen")

    def start_phones(self):
        for kind, source in (
            ("phyphox", "phyphox://127.0.0.1:{}"),
            ("sensorserver", "sensorserver://127.0.0.1:{}?type=accelerometer,gyroscope"),
        ):
            peer = self.background(
                sys.executable, RIG / "phones/peer.py", f"--{kind}", 0, "--rate", RATE, "--until-stdin-ends",
                stdin=subprocess.PIPE, stdout=subprocess.PIPE,
            )
            port = peer.stdout.readline().decode().split()[1]
            self.addCleanup(peer.stdin.close)
            self.addCleanup(peer.stdout.close)
            self.record(kind, source.format(port))

    def start_card(self):
        library = os.environ.get("PROOFMASS_STANDIN_NIDAQMX", "")
        self.assertTrue(library, "the build names the library that stands in for NI's")
        self.record(
            "daqmx", f"daqmx:Dev1/ai0:5?rate={RATE}&range=-10..10&terminal=rse",
            environment={"PROOFMASS_NIDAQMX_LIB": library},
        )

    def test_a_minute_at_1_khz_comes_whole_from_each(self):
        self.start_twin_and_replay()
        self.start_serial()
        self.start_stdin()
        self.start_udp()
        self.start_mqtt()
        self.start_phones()
        self.start_card()
        for name, process in self.running.items():
            with self.subTest(source=name):
                status = process.wait(timeout=300)
                said = (self.folder / f"{name}.err").read_text()
                self.assertEqual(status, DONE, said)
                document = parse_json((self.folder / f"{name}.json").read_text())
                self.check_document("record", document)
                self.assertEqual((document["lost"], document["gaps"]), (0, 0), said)
                self.assertAlmostEqual(document["samples"], ROWS, delta=0.002 * ROWS)
                self.assertEqual(document["end"], "duration")
                audit = self.document("inspect", f"{name}.mcap")
                self.assertEqual(audit["samples"], document["samples"])
                self.assertGreaterEqual(len(audit["channels"]), 6)


if __name__ == "__main__":
    unittest.main()
