"""proofmass record from an MQTT broker on the loopback."""
import shutil
import socket
import subprocess
import time
import unittest

from command import PROGRAM, CommandTest, parse_json

BAD_DEVICE, USAGE = 4, 2
BROKER = shutil.which("mosquitto", path="/usr/sbin:/usr/local/sbin:/usr/bin")
SENDER = shutil.which("mosquitto_pub")


@unittest.skipUnless(BROKER and SENDER, "install mosquitto and mosquitto-clients")
class Mqtt(CommandTest):
    def setUp(self):
        super().setUp()
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.broker = self.background(BROKER, "-p", self.port, stderr=subprocess.DEVNULL)
        end = time.monotonic() + 60
        while time.monotonic() < end:
            with socket.socket() as probe:
                if probe.connect_ex(("127.0.0.1", self.port)) == 0:
                    break
            time.sleep(0.05)

    def background(self, *command, **how):
        process = subprocess.Popen([*map(str, command)], cwd=self.folder, **how)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def sender(self):
        process = self.background(
            SENDER, "-p", self.port, "-t", "bench/imu", "-l", stdin=subprocess.PIPE, bufsize=0
        )
        self.addCleanup(process.stdin.close)
        return process

    def send_until(self, sender, recorder, condition):
        end, k = time.monotonic() + 120, 0
        while not condition():
            self.assertLess(time.monotonic(), end, "waited two minutes")
            self.assertIsNone(recorder.poll(), "it ended early")
            for k in range(k, k + 10):
                sender.stdin.write(f"{k},{1000 * k},0.5,{k % 7}\n".encode())
            k += 1
            time.sleep(0.02)

    def record(self, *arguments):
        return self.background(
            PROGRAM, "record", f"mqtt://127.0.0.1:{self.port}/bench/imu?columns=n,t_us,x,y", *arguments,
            stdout=subprocess.PIPE, stderr=subprocess.PIPE,
        )

    def test_messages_are_recorded_in_order(self):
        recorder, sender = self.record("-o", "run.mcap", "--duration", "2", "--json", "-"), self.sender()
        self.send_until(sender, recorder, lambda: (self.folder / "run.mcap").exists() or recorder.poll() == 0)
        out, err = recorder.communicate(timeout=60)
        self.assertEqual(recorder.returncode, 0, err)
        document = parse_json(out.decode())
        self.check_document("record", document)
        self.assertEqual((document["lost"], document["gaps"]), (0, 0))
        self.assertEqual([c["name"] for c in document["channels"]], ["n", "x", "y"])

    def test_a_broker_that_goes_ends_it_with_the_file_closed(self):
        recorder, sender = self.record("-o", "run.mcap", "--json", "-"), self.sender()
        part = self.folder / "run.mcap.part"
        self.send_until(sender, recorder, lambda: part.exists() and part.stat().st_size > 4000)
        self.broker.kill()
        out, err = recorder.communicate(timeout=200)
        self.assertEqual(recorder.returncode, BAD_DEVICE, err)
        self.assertEqual(parse_json(out.decode())["end"], "source_gone")
        self.assertGreater(self.document("inspect", "run.mcap")["samples"], 0)

    def test_nobody_there_is_told_without_the_password(self):
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            free = probe.getsockname()[1]
        ran = self.run_command("record", f"mqtt://127.0.0.1:{free}/imu?user=me&password=hidden", "-o", "a.mcap")
        self.assertEqual(ran.returncode, BAD_DEVICE)
        self.assertIn(b"no response", ran.stderr)
        self.assertNotIn(b"hidden", ran.stderr + ran.stdout)

    def test_a_topic_has_to_be_named(self):
        for place in ("", "/", "/imu/%23", "/+/imu"):
            self.expect_failure(USAGE, "record", f"mqtt://127.0.0.1:{self.port}{place}", "-o", "a.mcap")


if __name__ == "__main__":
    unittest.main()
