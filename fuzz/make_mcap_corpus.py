#!/usr/bin/env python3
"""Writes the seed files of fuzz_mcap (corpus/mcap) and, damaged, of fuzz_recover (corpus/recover), without
the magic number, which the fuzzers prepend. All chunks but one have no checksum (0), so that mutations are
not rejected.

    fuzz/make_mcap_corpus.py
"""
import json
import struct
import zlib
from pathlib import Path

FOLDER = Path(__file__).parent / "corpus"
MAGIC = b"\x89MCAP0\r\n"


def text(value):
    data = value.encode() if isinstance(value, str) else value
    return struct.pack("<I", len(data)) + data


def pairs(entries):
    return text(b"".join(text(key) + text(value) for key, value in entries.items()))


def record(op, content):
    return struct.pack("<BQ", op, len(content)) + content


def header(profile=""):
    return record(1, text(profile) + text("corpus"))


def schema(number, name, encoding, data):
    return record(3, struct.pack("<H", number) + text(name) + text(encoding) + text(data))


def channel(number, of, topic, encoding, **metadata):
    return record(4, struct.pack("<HH", number, of) + text(topic) + text(encoding) + pairs(metadata))


def message(number, log_ns, data):
    data = data.encode() if isinstance(data, str) else data
    return record(5, struct.pack("<HIQQ", number, 0, log_ns, log_ns) + data)


def stored_zstd(data):
    """A frame of one uncompressed block."""
    return (b"\x28\xB5\x2F\xFD\xA0" + struct.pack("<I", len(data))
            + struct.pack("<I", 1 | len(data) << 3)[:3] + data)


def repeated_zstd(byte, count):
    """A frame of one run-length block."""
    return (b"\x28\xB5\x2F\xFD\xA0" + struct.pack("<I", count)
            + struct.pack("<I", 1 | 1 << 1 | count << 3)[:3] + byte)


def stored_lz4(data):
    return (b"\x04\x22\x4D\x18\x60\x40\x82" + struct.pack("<I", 1 << 31 | len(data)) + data
            + bytes(4))


def chunk(records, compression="", packed=None, crc=0):
    pack = {"": lambda data: data, "zstd": stored_zstd, "lz4": stored_lz4}[compression]
    packed = pack(records) if packed is None else packed
    return record(6, struct.pack("<QQQI", 0, 9, len(records), crc) + text(compression)
                  + struct.pack("<Q", len(packed)) + packed)


def end():
    return record(15, bytes(4)) + record(2, bytes(20)) + MAGIC


def end_with_summary(data, counts, starts=()):
    data_end = record(15, struct.pack("<I", zlib.crc32(MAGIC + data)))
    summary = b"".join(record(8, struct.pack("<QQQQ", 0, 9, start, 0) + bytes(4 + 8 + 4 + 16))
                       for start in starts)
    counted = b"".join(struct.pack("<HQ", number, count) for number, count in counts.items())
    summary += record(11, struct.pack("<QHIIIIQQ", sum(counts.values()), 0, 1, 0, 0, 0, 0, 0) + text(counted))
    checked = summary + struct.pack("<BQQQ", 2, 20, len(MAGIC + data + data_end), 0)
    return data_end + checked + struct.pack("<I", zlib.crc32(checked)) + MAGIC


IMU = """Header header
Quaternion orientation
float64[9] orientation_covariance
geometry_msgs/Vector3[<=2] list
geometry_msgs/Vector3 linear_acceleration
===
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
===
MSG: sensor_msgs/Quaternion
float32 w 1
===
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
"""


def imu(k, big_endian=False):
    order = ">" if big_endian else "<"
    return (bytes([0, 0 if big_endian else 1, 0, 0])
            + struct.pack(order + "iII4sf", 100, k * 10_000_000, 4, b"imu\0", 1.0)
            + bytes(4) + bytes(72) + struct.pack(order + "I", 1) + bytes(4)
            + struct.pack(order + "6d", 1, 2, 3, k, 0.5, 9.81))


def block(first, rows, stamps=False):
    figures = [float(k) for k in range(rows * (3 if stamps else 2))]
    return struct.pack("<BBHIQ", 1, 1 if stamps else 0, 2, rows, first) + struct.pack(
        f"<{len(figures)}d", *figures)


def samples_channel(stamps):
    columns = json.dumps({"columns": [{"name": "a", "unit": "g"}, {"name": "b", "unit": ""}]})
    return (schema(1, "proofmass.samples", "jsonschema", columns)
            + channel(1, 1, "recording", "proofmass-samples", stamps="yes" if stamps else "no",
                      rate_hz="50", start_ns="1700000000000000000"))


def specimens():
    acc = channel(1, 0, "/acc", "json")
    rows = b"".join(message(1, k * 10_000_000, json.dumps({"t": {"sec": k}, "acc": [k, 0.5, 9.8]}))
                    for k in range(4))
    stamped = b"".join(message(1, k, json.dumps({"timestamp": {"sec": 5, "nsec": k}, "a": k}))
                       for k in range(4))
    ros = schema(1, "sensor_msgs/msg/Imu", "ros2msg", IMU) + channel(1, 1, "/imu", "cdr")
    metadata = record(12, text("bench") + pairs({"rig": "7"}))
    labels = b"first,last,\"pose\"\n0,1,\"up\"\n2,3,\"down\"\n"
    attachment = record(9, bytes(16) + text("labels.csv") + text("text/csv")
                        + struct.pack("<Q", len(labels)) + labels + bytes(4))
    data = header() + chunk(acc + rows)
    yield "json", header() + acc + rows + end()
    yield "json_chunk", data + end()
    yield "json_checked", header() + chunk(acc + rows, crc=zlib.crc32(acc + rows)) + end()
    yield "json_stamped", header() + acc + stamped + end()
    yield "zstd", header() + chunk(acc + rows, "zstd") + chunk(rows, "zstd") + end()
    yield "zstd_bomb", header() + acc + rows + chunk(
        bytes(100_000), "zstd", repeated_zstd(b"\0", 100_000)) + end()
    yield "lz4", header() + chunk(acc + rows, "lz4") + chunk(rows, "lz4") + end()
    yield "summary", data + end_with_summary(data, {1: 4}, [8 + len(header())])
    yield "ros2", header("ros2") + ros + b"".join(message(1, k, imu(k)) for k in range(3)) + end()
    yield "ros2_big", header() + ros + b"".join(message(1, k, imu(k, True)) for k in range(3))
    yield "ros1", header("ros1") + schema(
        1, "t/T", "ros1msg", "Header header\nfloat32 a\nuint8[] b\nstring[2] c\nint16 d\n===\n"
        "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n") + channel(
            1, 1, "/t", "ros1") + b"".join(message(1, k, struct.pack("<IIIIfI2xIIh", k, 5, k, 0, 1.5, 2,
                                                                      0, 0, 7)) for k in range(3))
    yield "samples", (header() + metadata + samples_channel(False) + message(1, 0, block(0, 3))
                      + message(1, 0, block(5, 2)) + attachment + end())
    yield "samples_stamps", header() + samples_channel(True) + message(1, 0, block(0, 4, True)) + end()


def broken():
    recording = samples_channel(True)
    chunks = [chunk(recording + message(1, k, block(4 * k, 4, True))) for k in range(3)]
    checked = [chunk(recording + message(1, k, block(4 * k, 4, True)),
                     crc=zlib.crc32(recording + message(1, k, block(4 * k, 4, True)))) for k in range(3)]
    yield "cut", header() + b"".join(chunks)[:-40]
    yield "never_closed", header() + b"".join(chunks)
    yield "garbage", header() + chunks[0] + b"\0garbage\x06" + chunks[2] + end()
    yield "damaged_chunk", header() + checked[0] + checked[1][:-9] + bytes(9) + checked[2] + end()
    yield "damaged_length", header() + checked[0] + b"\x06\x01" + checked[1][2:] + checked[2] + end()
    yield "no_channel", header() + chunk(message(1, 0, block(0, 4, True))) + chunks[1] + end()
    yield "two_meanings", (header() + chunks[0] + chunk(channel(1, 0, "/acc", "json") + message(1, 3, "{}"))
                           + chunks[2] + end())
    yield "attached", header() + record(9, bytes(16) + text("sensor.toml") + text("application/toml")
                                        + struct.pack("<Q", 9) + b"[sensor]\n" + bytes(4)) + chunks[0]


for folder, files in {"mcap": specimens(), "recover": broken()}.items():
    (FOLDER / folder).mkdir(parents=True, exist_ok=True)
    for name, content in files:
        (FOLDER / folder / name).write_bytes(content)
