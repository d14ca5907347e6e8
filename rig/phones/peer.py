#!/usr/bin/env python3
"""Stands in for a phone: phyphox's web server, SensorServer's WebSocket, or both, on the loopback.

  peer.py --phyphox 0 --rate 1000              prints "phyphox PORT" once it listens
  peer.py --sensorserver 0 --rate 200

Row k was measured k/RATE seconds after the start, and its channel c reads (k mod 100000) + c/10:
accelerometer 0 to 2, gyroscope 3 to 5. So whoever reads can tell each row that is missing, twice
there or out of its place. The faults come at rows, not at times, to be the same on a slow machine.
"""
import argparse
import base64
import hashlib
import json
import math
import signal
import socketserver
import struct
import sys
import threading
import time
from http.server import BaseHTTPRequestHandler
from urllib.parse import parse_qs, urlsplit

SENSORS = {"accelerometer": ("acc", 0), "gyroscope": ("gyr", 3)}
ALL = 1 << 60


def value_at(row, channel):
    return row % 100000 + channel / 10


class Phone:
    """What was measured up to now, worked out and not kept."""

    def __init__(self, options):
        self.options = options
        self.measuring = options.measuring
        self.began = time.monotonic() if options.measuring else None
        self.jump_back_s = options.jump_by
        self.answers = 0

    def start(self):
        if not self.measuring:
            self.began = time.monotonic()
        self.measuring = True

    def rows(self):
        """How many there are since the start."""
        if self.began is None:
            return 0
        return min(int((time.monotonic() - self.began) * self.options.rate), self.options.silence_at)

    def parts(self, count):
        """Runs of rows with a clock without a step: the first row, the one behind the last, the first's time."""
        cut = self.options.jump_at
        if self.options.restart_at <= count:
            return [(self.options.restart_at, count, 0.0)]
        if cut >= count:
            return [(0, count, 0.0)]
        return [(0, cut, 0.0), (cut, count, cut / self.options.rate - self.jump_back_s)]

    def session(self, count):
        return "bbbbbb" if self.options.restart_at <= count else "aaaaaa"

    def time_at(self, row):
        for first, end, start_s in self.parts(row + 1):
            if first <= row < end:
                return start_s + (row - first) / self.options.rate
        return 0.0


def threshold_of(text):
    """Source: phyphox-android, RemoteServer.java, parseBufferRequest."""
    if text == "":
        return None
    if text == "full":
        return -math.inf
    threshold = float(text.split("|")[0])
    return threshold + (10 ** math.floor(math.log10(abs(threshold) / 1e7)) if threshold else 0.0)


class Phyphox(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    disable_nagle_algorithm = True
    phone: Phone

    def do_GET(self):
        phone, place = self.phone, urlsplit(self.path)
        if phone.rows() >= phone.options.drop_at:
            self.close_connection = True
            return
        query = {key: values[0] for key, values in parse_qs(place.query, keep_blank_values=True).items()}
        answers = {"/config": self.config, "/get": self.get, "/control": self.control, "/time": self.time}
        if place.path not in answers:
            return self.say(404, "{}")
        self.say(200, answers[place.path](query))

    def say(self, status, text):
        body = text.encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def config(self, _):
        buffers, inputs, sources = [], [], []
        for sensor, (short, _) in SENSORS.items():
            names = {axis: short + axis.upper() for axis in "xyz"} | {"t": short + "_time"}
            buffers += [{"name": name, "size": 0} for name in names.values()]
            inputs.append({"source": sensor, "outputs": [{key: name} for key, name in names.items()]})
            sources.append({"set": sensor, "sources": [{"label": f"{key} (s)" if key == "t" else key, "buffer": name}
                                                       for key, name in names.items()]})
        return json.dumps({"title": "Stand-in", "buffers": buffers, "inputs": inputs, "export": sources})

    def control(self, query):
        if query.get("cmd") == "start":
            self.phone.start()
        return '{"result": true}'

    def time(self, _):
        if not self.phone.measuring:
            return "[]"
        return json.dumps([{"event": "START", "experimentTime": 0.0, "systemTime": time.time()}])

    def get(self, query):
        phone = self.phone
        phone.answers += 1
        if phone.options.garbage_every and phone.answers % phone.options.garbage_every == 0:
            return '{"buffer":{"acc_time":{"buffer":[1.0,'
        count = phone.rows()
        parts, session = phone.parts(count), phone.session(count)
        buffers = [text for name, value in query.items() if (text := self.buffer(name, value, parts))]
        status = {"session": session, "measuring": phone.measuring, "timedRun": False, "countDown": 0}
        return '{"buffer":{' + ",".join(buffers) + '},"status":' + json.dumps(status) + "}"

    def buffer(self, name, value, parts):
        """The rows behind a threshold as the phone writes them, with eight figures."""
        short, kind = name[:3], name[3:]
        channel = {"X": 0, "Y": 1, "Z": 2}.get(kind)
        base = {short: base for short, base in SENSORS.values()}.get(short)
        if base is None or (channel is None and kind != "_time"):
            return None
        rate, threshold, figures = self.phone.options.rate, threshold_of(value), []
        for first, end, start_s in parts:
            if threshold is None:
                begin = max(end - 1, first)
            elif threshold == -math.inf:
                begin = first
            else:
                begin = max(first, min(end, first + math.floor((threshold - start_s) * rate) + 1))
            rows = range(begin, end)
            if kind == "_time":
                figures += [f"{start_s + (row - first) / rate:.7E}" for row in rows]
            else:
                figures += [f"{value_at(row, base + channel):.7E}" for row in rows]
        if threshold is None:
            figures = figures[-1:] or ["null"]
        elif self.phone.options.unequal and kind in ("Y", "Z") and figures:
            figures = figures[: -(1 + self.phone.answers % 3)]
        mode = "single" if threshold is None else "partial"
        return f'"{name}":{{"size":0,"updateMode":"{mode}","buffer":[{",".join(figures)}]}}'

    def log_message(self, *_):
        pass


def frame(opcode, payload):
    """Source: RFC 6455, 5.2; a server does not mask."""
    length = struct.pack("!B", len(payload)) if len(payload) < 126 else struct.pack("!BH", 126, len(payload))
    return bytes([0x80 | opcode]) + length + payload


class SensorServer(socketserver.StreamRequestHandler):
    disable_nagle_algorithm = True
    phone: Phone

    def handle(self):
        target = self.rfile.readline().decode().split(" ")[1]
        headers = {}
        while line := self.rfile.readline().strip():
            name, _, text = line.decode().partition(":")
            headers[name.lower()] = text.strip()
        key = headers["sec-websocket-key"] + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11"
        accept = base64.b64encode(hashlib.sha1(key.encode()).digest()).decode()
        self.wfile.write(("HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                          f"Sec-WebSocket-Accept: {accept}\r\n\r\n").encode())
        self.lock = threading.Lock()
        self.gone = False
        threading.Thread(target=self.listen, daemon=True).start()
        place = urlsplit(target)
        query = parse_qs(place.query)
        types = query["type"] if place.path == "/sensor/connect" else json.loads(query["types"][0])
        try:
            self.stream([one.removeprefix("android.sensor.") for one in types], len(types) > 1)
        except OSError:
            pass

    def send(self, data):
        with self.lock:
            self.wfile.write(data)

    def close(self, code, reason):
        self.send(frame(8, struct.pack("!H", code) + reason.encode()))

    def listen(self):
        """Answers pings and notices the other's end."""
        try:
            while head := self.rfile.read(2):
                length = head[1] & 0x7F
                if length == 126:
                    length = struct.unpack("!H", self.rfile.read(2))[0]
                mask, payload = self.rfile.read(4), self.rfile.read(length)
                payload = bytes(byte ^ mask[k % 4] for k, byte in enumerate(payload))
                if head[0] & 0x0F == 9:
                    self.send(frame(10, payload))
                if head[0] & 0x0F == 8:
                    break
        except (OSError, IndexError, struct.error):
            pass
        self.gone = True

    def stream(self, types, named):
        phone, options = self.phone, self.phone.options
        for one in types:
            if one not in SENSORS:
                return self.close(4001, f"Sensor of type {one} not found")
        phone.start()
        sent = phone.rows()
        while not self.gone:
            count = min(phone.rows(), options.drop_at)
            data = b"".join(frame(1, self.message(row, one, named).encode()) for row in range(sent, count) for one in types)
            if data:
                self.send(data)
            sent = count
            if count >= options.drop_at:
                return self.close(4004, "Server stopped")
            if count >= options.nonsense_at:
                # A frame of a kind that there is not; what the other side makes of it is not answered.
                self.send(frame(3, b"x"))
                return time.sleep(30)
            time.sleep(0.005)

    def message(self, row, one, named):
        if self.phone.options.garbage_every and row % self.phone.options.garbage_every == 1:
            return '{"accuracy":2,"timestamp":'
        seconds = self.phone.time_at(row) + 1000.0
        told = {"accuracy": 2, "timestamp": round(seconds * 1e9),
                "values": [value_at(row, SENSORS[one][1] + axis) for axis in range(3)]}
        return json.dumps(told | {"type": "android.sensor." + one} if named else told)


class Server(socketserver.ThreadingTCPServer):
    allow_reuse_address = True
    daemon_threads = True
    request_queue_size = 16

    def handle_error(self, request, client_address):
        pass


def serve(name, port, handler, phone):
    handler.phone = phone
    server = Server(("127.0.0.1", port), handler)
    print(name, server.server_address[1], flush=True)
    threading.Thread(target=server.serve_forever, daemon=True).start()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--phyphox", type=int, metavar="PORT", help="0: any that is free")
    parser.add_argument("--sensorserver", type=int, metavar="PORT", help="0: any that is free")
    parser.add_argument("--rate", type=float, default=100.0, help="rows a second")
    parser.add_argument("--measuring", action="store_true", help="begin before anybody asks for it")
    parser.add_argument("--unequal", action="store_true", help="Y and Z are shorter than X and the time")
    parser.add_argument("--garbage-every", type=int, default=0, metavar="N", help="each Nth answer or message is cut off")
    parser.add_argument("--until-stdin-ends", action="store_true", help="go with whoever holds the other end of a pipe")
    for fault, meaning in {"jump": "the clock goes back by --jump-by", "restart": "the experiment is opened anew",
                           "silence": "no more rows", "nonsense": "what is no WebSocket frame, then nothing (SensorServer)",
                           "drop": "the connection breaks"}.items():
        parser.add_argument(f"--{fault}-at", type=int, default=ALL, metavar="ROW", help=meaning)
    parser.add_argument("--jump-by", type=float, default=5.0, metavar="SECONDS")
    options = parser.parse_args()
    phone = Phone(options)
    if options.phyphox is not None:
        serve("phyphox", options.phyphox, Phyphox, phone)
    if options.sensorserver is not None:
        serve("sensorserver", options.sensorserver, SensorServer, phone)
    sys.stdin.read() if options.until_stdin_ends else signal.pause()


if __name__ == "__main__":
    main()
