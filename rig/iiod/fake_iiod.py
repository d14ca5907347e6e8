#!/usr/bin/env python3
"""An iiod for tests: one accelerometer, one trigger, the text protocol of libiio 0.24, and faults.

    fake_iiod.py [--fault NAME] [--after ROWS] [--rate HZ] [--stamps real|zero|stuck|back]

Says "port N" once it listens, and ends when its standard input does. Sample k is x = k mod 2000,
y = -x, z = 1000 (raw, 12 bits, in the upper bits of 16) and the time 10^18 ns + k / rate.

Faults, where `after` rows have gone (0: at once):
    none       it does what iiod does
    mute       takes connections and never answers
    refuse     the device refuses its trigger (-EINVAL)
    held       the trigger is set, and cannot be while the buffer is enabled (-EBUSY)
    bare       there is no trigger, and nothing fires (-ETIMEDOUT)
    silent     the trigger never fires (-ETIMEDOUT)
    busy       another program reads the buffer (-EBUSY)
    short      half of each buffer
    ragged     buffers that end within a row
    garbage    words where a number is due
    dead       the connection is closed
    hang       it says nothing more
"""
import argparse
import socketserver
import struct
import sys
import threading
import time

EINVAL, EBUSY, ENOENT, ETIMEDOUT = -22, -16, -2, -110
FAULTS = "none mute refuse held bare silent busy short ragged garbage dead hang".split()
SCALE = "0.009806"
MOUNT = "0, 1, 0; -1, 0, 0; 0, 0, 1"


def channel(name: str, index: int) -> str:
    scan = f'<scan-element index="{index}" format="le:s12/16&gt;&gt;4" scale="{SCALE}" />'
    names = ("raw", f"in_{name}_raw"), ("scale", "in_accel_scale"), ("mount_matrix", "in_accel_mount_matrix")
    attributes = "".join(f'<attribute name="{name}" filename="{file}" />' for name, file in names)
    return f'<channel id="{name}" type="input" >{scan}{attributes}</channel>'


def description(fault: str) -> str:
    channels = "".join(channel(f"accel_{axis}", index) for index, axis in enumerate("xyz"))
    stamp = '<scan-element index="3" format="le:s64/64&gt;&gt;0" />'
    channels += f'<channel id="timestamp" type="input" >{stamp}</channel>'
    own = "".join(f'<attribute name="{name}" />' for name in
                  ("current_timestamp_clock", "sampling_frequency", "sampling_frequency_available"))
    trigger = '<device id="trigger0" name="t0" ><attribute name="sampling_frequency" /></device>'
    return (
        '<?xml version="1.0" encoding="utf-8"?><!DOCTYPE context ['
        "<!ELEMENT context (device | context-attribute)*>"
        "<!ELEMENT context-attribute EMPTY>"
        "<!ELEMENT device (channel | attribute | debug-attribute | buffer-attribute)*>"
        "<!ELEMENT channel (scan-element?, attribute*)>"
        "<!ELEMENT attribute EMPTY><!ELEMENT scan-element EMPTY>"
        "<!ELEMENT debug-attribute EMPTY><!ELEMENT buffer-attribute EMPTY>"
        "<!ATTLIST context name CDATA #REQUIRED description CDATA #IMPLIED>"
        "<!ATTLIST context-attribute name CDATA #REQUIRED value CDATA #REQUIRED>"
        "<!ATTLIST device id CDATA #REQUIRED name CDATA #IMPLIED label CDATA #IMPLIED>"
        "<!ATTLIST channel id CDATA #REQUIRED type (input|output) #REQUIRED name CDATA #IMPLIED>"
        "<!ATTLIST scan-element index CDATA #REQUIRED format CDATA #REQUIRED scale CDATA #IMPLIED>"
        "<!ATTLIST attribute name CDATA #REQUIRED filename CDATA #IMPLIED>"
        "<!ATTLIST debug-attribute name CDATA #REQUIRED><!ATTLIST buffer-attribute name CDATA #REQUIRED>"
        ']><context name="local" description="a board that is none" >'
        f'<device id="iio:device0" name="faux3d" >{channels}{own}</device>'
        f'{"" if fault == "bare" else trigger}</context>'
    )


class Board:
    """What all connections see."""

    def __init__(self, options):
        self.options = options
        self.trigger = "t0" if options.fault == "held" else ""
        self.rates = {"iio:device0": "12.5", "trigger0": str(options.rate)}
        self.clock = "realtime"
        self.timeout_ms = 2500
        self.row = 0
        self.began = 0.0

    def rows(self, count: int) -> bytes:
        """The next rows, once they are due: with jitter of none but the machine's own."""
        rate = float(self.rates["trigger0"])
        if self.row == 0:
            self.began = time.monotonic()
        time.sleep(max(0.0, self.began + (self.row + count) / rate - time.monotonic()))
        out = b"".join(self.one_row(k, rate) for k in range(self.row, self.row + count))
        self.row += count
        return out

    def one_row(self, k: int, rate: float) -> bytes:
        x = k % 2000
        step_ns = int(1e9 / rate)
        stamp = {
            "real": 10**18 + k * step_ns,
            "zero": 0,
            "stuck": 10**18,
            "back": 10**18 + (k - 5 * (k // 50)) * step_ns,
        }[self.options.stamps]
        return struct.pack("<hhhxxq", x << 4, -x << 4, 1000 << 4, stamp)

    def read(self, words: list) -> str | None:
        """READ iio:device0 [INPUT accel_x] attribute."""
        device, attribute = words[1], words[-1]
        if device not in self.rates:
            return None
        return {
            "scale": SCALE,
            "mount_matrix": MOUNT,
            "current_timestamp_clock": self.clock,
            "sampling_frequency": self.rates[device],
            "sampling_frequency_available": "12.5 100 400 1600",
        }.get(attribute)

    def write(self, words: list, value: str) -> bool:
        device, attribute = words[1], words[-2]
        if attribute == "current_timestamp_clock":
            self.clock = value
        elif attribute == "sampling_frequency" and float(value) <= 5000:
            self.rates[device] = value
        else:
            return False
        return True


class Connection(socketserver.StreamRequestHandler):
    def handle(self):
        try:
            if self.fault() == "mute":
                time.sleep(3600)
            while line := self.rfile.readline(1024):
                words = line.decode().split()
                if not words:
                    continue
                if words[0] == "EXIT":
                    return
                getattr(self, "on_" + words[0].lower())(words)
        except (ConnectionError, StopIteration):
            pass

    def fault(self) -> str:
        options = self.server.board.options
        return options.fault if self.server.board.row >= options.after else "none"

    def say(self, number: int, data: bytes = b""):
        self.wfile.write(b"%d\n" % number + data)

    def text(self, text: str | None):
        data = text.encode() if text is not None else b""
        self.say(*(ENOENT,) if text is None else (len(data), data + b"\n"))

    def on_version(self, _):
        self.wfile.write(b"0.24.v0.24  \n")

    def on_print(self, _):
        self.text(description(self.fault()))

    def on_timeout(self, words):
        self.server.board.timeout_ms = int(words[1])
        self.say(0)

    def on_set(self, _):
        self.say(0)

    def on_read(self, words):
        self.text(self.server.board.read(words))

    def on_write(self, words):
        value = self.rfile.read(int(words[-1])).decode().rstrip("\0\n")
        self.say(int(words[-1]) if self.server.board.write(words, value) else EINVAL)

    def on_gettrig(self, _):
        name = self.server.board.trigger
        self.text(name or None)

    def on_settrig(self, words):
        if self.fault() in ("refuse", "held"):
            return self.say(EINVAL if self.fault() == "refuse" else EBUSY)
        self.server.board.trigger = words[2] if len(words) > 2 else ""
        self.say(0)

    def on_open(self, words):
        self.mask = words[3].encode()
        self.fresh = True
        self.say(EBUSY if self.fault() == "busy" else 0)

    def on_close(self, _):
        self.say(0)

    def on_readbuf(self, words):
        size, fault = int(words[2]), self.fault()
        if fault in ("silent", "bare", "refuse"):
            time.sleep(self.server.board.timeout_ms / 1000)
            return self.say(ETIMEDOUT)
        if fault == "dead":
            raise ConnectionError
        if fault == "hang":
            time.sleep(3600)
        if fault == "garbage":
            return self.wfile.write(b"banana\n")
        row = 16
        data = self.server.board.rows(size // row)
        if fault in ("short", "ragged"):
            data = data[: len(data) // row // 2 * row + (5 if fault == "ragged" else 0)]
        self.say(len(data), self.mask + b"\n" + data)
        if len(data) < size:
            self.say(0)


class Server(socketserver.ThreadingTCPServer):
    daemon_threads = True
    block_on_close = False


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--fault", choices=FAULTS, default="none")
    parser.add_argument("--after", type=int, default=0)
    parser.add_argument("--rate", type=float, default=100.0)
    parser.add_argument("--stamps", choices=["real", "zero", "stuck", "back"], default="real")
    options = parser.parse_args()
    with Server(("127.0.0.1", 0), Connection) as server:
        server.board = Board(options)
        print(f"port {server.server_address[1]}", flush=True)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        sys.stdin.read()


if __name__ == "__main__":
    main()
