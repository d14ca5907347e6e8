#!/usr/bin/env python3
"""Writes fuzz/corpus/tdms: small TDMS files with every feature that the reader supports, each without
its first four bytes, which the fuzzer prepends.

    fuzz/make_tdms_corpus.py
"""
import pathlib
import struct

META, NEW, RAW, ROWS, BIG, DAQMX = 2, 4, 8, 32, 64, 128
I16, I32, F64, TEXT, BOOL, INSTANT, EXTENDED = 2, 3, 10, 0x20, 0x21, 0x44, 0x0B


class Writer:
    """Writes numbers and objects in one byte order."""

    def __init__(self, order="<"):
        self.order = order

    def pack(self, form, *values):
        return struct.pack(self.order + form, *values)

    def text(self, words):
        raw = words.encode()
        return self.pack("I", len(raw)) + raw

    def property(self, name, value):
        if isinstance(value, str):
            typed = self.pack("I", TEXT) + self.text(value)
        elif isinstance(value, float):
            typed = self.pack("Id", F64, value)
        elif isinstance(value, tuple):
            seconds, fraction = value
            parts = (("q", seconds), ("Q", fraction))
            typed = self.pack("I", INSTANT)
            for form, part in parts if self.order == ">" else parts[::-1]:
                typed += self.pack(form, part)
        else:
            typed = self.pack("II", 7, value)
        return self.text(name) + typed

    def object(self, path, index, properties=()):
        listed = [self.property(*one) for one in properties]
        return self.text(path) + index + self.pack("I", len(listed)) + b"".join(listed)

    def nothing(self):
        return self.pack("I", 0xFFFFFFFF)

    def as_before(self):
        return self.pack("I", 0)

    def index(self, kind, values, size=None):
        if size is None:
            return self.pack("IIIQ", 20, kind, 1, values)
        return self.pack("IIIQQ", 28, kind, 1, values, size)

    def daqmx(self, values, scalers, widths, header=0x1269):
        out = self.pack("IIIQI", header, 0xFFFFFFFF, 1, values, len(scalers))
        for kind, buffer, offset, number in scalers:
            out += self.pack("III", kind, buffer, offset)
            out += b"\0" * (1 if header == 0x126A else 4) + self.pack("I", number)
        return out + self.pack("I", len(widths)) + self.pack(f"{len(widths)}I", *widths)

    def segment(self, contents, objects, data, unfinished=False):
        metadata = self.pack("I", len(objects)) + b"".join(objects) if objects else b""
        following = 0xFFFFFFFFFFFFFFFF if unfinished else len(metadata) + len(data)
        if self.order == ">":
            contents |= BIG
        return (b"TDSm" + struct.pack("<I", contents)
                + self.pack("IQQ", 4713, following, len(metadata)) + metadata + data)


def specimens():
    little, big = Writer("<"), Writer(">")
    whole = META | NEW | RAW
    waveform = [("wf_start_time", (3_788_905_723, 1 << 62)), ("wf_start_offset", 0.0),
                ("wf_increment", 0.01), ("wf_samples", 3), ("unit_string", "g")]

    def two(writer, kind=F64, values=3):
        return [writer.object("/", writer.nothing(), [("title", "a test")]),
                writer.object("/'g'", writer.nothing()),
                writer.object("/'g'/'acc''s x'", writer.index(kind, values), waveform),
                writer.object("/'g'/'acc y'", writer.index(kind, values), waveform)]

    six = little.pack("6d", 1, 2, 3, 4, 5, 6)
    yield "contiguous", little.segment(whole, two(little), six) + little.segment(RAW, [], six)
    yield "interleaved", little.segment(whole | ROWS, two(little), six + six[:16], True)
    yield "big_endian", big.segment(whole | ROWS, two(big, I16), big.pack("6h", 1, 4, 2, 5, 3, 6))
    yield "incremental", (
        little.segment(whole, two(little), six)
        + little.segment(META | RAW, [little.object("/'g'/'acc y'", little.index(F64, 1))], six[:32])
        + little.segment(META | RAW, [little.object("/'g'/'acc y'", little.nothing())], six[:24])
        + little.segment(META | RAW, [little.object("/'g'/'acc y'", little.as_before())], six[:32]))
    one = [little.object("/'g'/'a'", little.index(I32, 1)), little.object("/'g'/'b'", little.index(BOOL, 1))]
    yield "fragmented", b"".join(little.segment(whole, one, little.pack("iB", k, k % 2)) for k in range(6))
    stamps = b"".join(little.pack("Qq", k << 60, 3_788_905_723) for k in range(3))
    yield "instants", little.segment(
        whole, [little.object("/'g'/'t'", little.index(INSTANT, 3)),
                little.object("/'g'/'a'", little.index(F64, 3))], stamps + six[:24])
    yield "words", little.segment(
        whole, [little.object("/'g'/'w'", little.index(TEXT, 2, 11)),
                little.object("/'g'/'x'", little.index(EXTENDED, 1)),
                little.object("/'g'/'a'", little.index(I16, 2))],
        little.pack("II", 1, 3) + b"xyz" + bytes(10) + little.pack("2h", 1, 2))
    chain = [("NI_Number_Of_Scales", 5),
             ("NI_Scale[2]_Scale_Type", "Linear"), ("NI_Scale[2]_Linear_Slope", 2.0),
             ("NI_Scale[2]_Linear_Y_Intercept", 1.0), ("NI_Scale[2]_Linear_Input_Source", 0),
             ("NI_Scale[3]_Scale_Type", "Add"), ("NI_Scale[3]_Add_Left_Operand_Input_Source", 2),
             ("NI_Scale[3]_Add_Right_Operand_Input_Source", 1),
             ("NI_Scale[4]_Scale_Type", "Thermocouple"),
             ("NI_Scale[4]_Thermocouple_Thermocouple_Type", 10073),
             ("NI_Scale[4]_Thermocouple_Scaling_Direction", 0),
             ("NI_Scale[4]_Thermocouple_Input_Source", 3)]
    yield "daqmx", little.segment(
        whole | DAQMX,
        [little.object("/'g'/'a'", little.daqmx(2, [(3, 0, 0, 0), (5, 1, 0, 1)], [2, 4]), chain),
         little.object("/'g'/'b'", little.daqmx(2, [(3, 0, 0, 0)], [2, 4]))],
        little.pack("2h2i", 100, 200, 1000, 2000))
    yield "digital", little.segment(
        whole | DAQMX, [little.object("/'g'/'a'", little.daqmx(3, [(0, 0, 9, 0)], [4], 0x126A))],
        little.pack("3I", 0, 0x200, 0xFFFF))
    table = [("NI_Number_Of_Scales", 1), ("NI_Scale[0]_Scale_Type", "Table"),
             ("NI_Scale[0]_Table_Scaled_Values_Size", 2), ("NI_Scale[0]_Table_Pre_Scaled_Values_Size", 2),
             ("NI_Scale[0]_Table_Scaled_Values[0]", 1.0), ("NI_Scale[0]_Table_Scaled_Values[1]", 2.0),
             ("NI_Scale[0]_Table_Pre_Scaled_Values[0]", 5.0), ("NI_Scale[0]_Table_Pre_Scaled_Values[1]", 7.0)]
    platinum = [("NI_Number_Of_Scales", 1), ("NI_Scale[0]_Scale_Type", "RTD"),
                ("NI_Scale[0]_RTD_Current_Excitation", 0.001),
                ("NI_Scale[0]_RTD_R0_Nominal_Resistance", 100.0), ("NI_Scale[0]_RTD_A", 3.9083e-3),
                ("NI_Scale[0]_RTD_B", -5.775e-7), ("NI_Scale[0]_RTD_C", -4.183e-12),
                ("NI_Scale[0]_RTD_Lead_Wire_Resistance", 0.0),
                ("NI_Scale[0]_RTD_Resistance_Configuration", 4)]
    yield "scales", little.segment(
        whole, [little.object("/'g'/'a'", little.index(F64, 2), table),
                little.object("/'g'/'b'", little.index(F64, 2), platinum)],
        little.pack("4d", 1.5, 1.0, 0.09, 0.12))
    yield "uneven_rows", little.segment(
        whole | ROWS, [little.object("/'g'/'a'", little.index(I16, 1)),
                       little.object("/'g'/'b'", little.index(I16, 3))], little.pack("4h", 1, 2, 3, 4))


def main():
    folder = pathlib.Path(__file__).resolve().parent / "corpus" / "tdms"
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in specimens():
        (folder / f"{name}.tdms").write_bytes(content[4:])


if __name__ == "__main__":
    main()
