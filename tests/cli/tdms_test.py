"""TDMS files written by proofmass, read by an independent reader; and damaged files."""
import struct
import unittest

from command import BAD_DATA, BAD_INPUT, CommandTest, turning_csv

LEAD_IN = 28


def segments(content: bytes):
    """Contents, metadata and values of each segment."""
    at = 0
    while at < len(content):
        tag, contents, version, following, raw = struct.unpack_from("<4sIIQQ", content, at)
        assert tag == b"TDSm" and version == 4713
        at += LEAD_IN
        yield contents, content[at:at + raw], content[at + raw:at + following]
        at += following


class Metadata:
    """The objects that a segment lists."""

    def __init__(self, raw: bytes):
        self.raw = raw
        self.at = 0
        self.values = {}
        self.properties = {}
        for _ in range(self.take("I")):
            self.take_object()
        assert self.at == len(raw)

    def take(self, form: str):
        (value,) = struct.unpack_from("<" + form, self.raw, self.at)
        self.at += struct.calcsize("<" + form)
        return value

    def text(self) -> str:
        size = self.take("I")
        self.at += size
        return self.raw[self.at - size:self.at].decode()

    def take_object(self):
        path = self.text()
        if self.take("I") != 0xFFFFFFFF:
            assert (self.take("I"), self.take("I")) == (10, 1)  # doubles, one dimension
            self.values[path] = self.take("Q")
        properties = self.properties.setdefault(path, {})
        for _ in range(self.take("I")):
            name, kind = self.text(), self.take("I")
            if kind == 0x20:
                properties[name] = self.text()
            elif kind == 0x44:
                fraction, seconds = self.take("Q"), self.take("q")
                properties[name] = seconds + fraction / 2**64
            else:
                properties[name] = self.take({3: "i", 10: "d"}[kind])


def read(content: bytes):
    """Properties and values by path."""
    columns, properties, paths = {}, {}, []
    for contents, metadata, values in segments(content):
        assert contents & 0b101000 == 0b101000  # interleaved values
        if contents & 2:
            said = Metadata(metadata)
            paths = list(said.values)
            for path, more in said.properties.items():
                properties.setdefault(path, {}).update(more)
            rows = next(iter(said.values.values()))
        figures = struct.unpack(f"<{len(values) // 8}d", values)
        assert len(figures) == rows * len(paths)
        for place, path in enumerate(paths):
            columns.setdefault(path, []).extend(figures[place::len(paths)])
    return properties, columns


class Tdms(CommandTest):
    def written(self) -> bytes:
        self.write("a.csv", turning_csv(seconds=3))
        self.succeed("convert", "a.csv", "-o", "a.tdms")
        return (self.folder / "a.tdms").read_bytes()

    def test_another_reader_finds_channels_units_and_rate(self):
        properties, columns = read(self.written())
        self.assertIn("/", properties)
        self.assertEqual(list(columns), [f"/'recording'/'acc_{axis}'" for axis in "xyz"])
        waveform = properties["/'recording'/'acc_x'"]
        self.assertEqual(waveform["unit_string"], "m/s^2")
        self.assertEqual(waveform["wf_increment"], 0.01)
        rows = (self.folder / "a.csv").read_text().splitlines()[1:]
        self.assertEqual(columns["/'recording'/'acc_x'"], [float(row.split(",")[1]) for row in rows])

    def test_what_is_written_reads_back_the_same(self):
        self.written()
        before = self.document("inspect", "a.csv")
        after = self.document("inspect", "a.tdms")
        self.assertEqual(after["format"], "TDMS")
        self.assertEqual(before["channels"], after["channels"])
        self.assertEqual(before["rate_hz"], after["rate_hz"])

    def test_a_file_that_breaks_off_is_read_and_told(self):
        content = self.written()
        (self.folder / "cut.tdms").write_bytes(content[:len(content) - 1000])
        document = self.document("inspect", "cut.tdms")
        self.assertGreater(document["samples"], 250)
        self.assertLess(document["samples"], 300)
        self.assertTrue(any("breaks off" in warning for warning in document["warnings"]))
        self.expect_failure(BAD_DATA, "inspect", "cut.tdms", "--strict")

    def test_an_index_file_is_refused_in_one_line(self):
        (self.folder / "a.tdms_index").write_bytes(b"TDSh" + self.written()[4:200])
        error = self.expect_failure(BAD_INPUT, "inspect", "a.tdms_index")
        self.assertIn("index", error)
        self.assertEqual(len(error.strip().splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
