#!/usr/bin/env python3
"""Writes the seed files in fuzz/corpus/lvm, wav and npz, without the first bytes, which the fuzzers prepend.
Run by hand; the files are in the repository."""
import struct
from pathlib import Path

CORPUS = Path(__file__).parent / "corpus"


def write(name, content):
    path = CORPUS / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content if isinstance(content, bytes) else content.encode("latin-1"))


def lvm_file(x="No", point=".", separator="Tab", preference="Relative"):
    told = f"Decimal_Separator\t{point}\n" if point else ""
    return (f"\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\t{separator}\n{told}Multi_Headings\tYes\n"
            f"X_Columns\t{x}\nTime_Pref\t{preference}\nOperator\tme\nDate\t2024/03/01\nTime\t12:00:00.5\n"
            "***End_of_Header***\t\n\t\n")


def lvm_segment(rows, time="12:00:01", delta=("0.01", "0.01"), names="X_Value\ta\tb\tComment\n", samples="3", gap="\t"):
    pair = lambda tag, one, other: f"{tag}\t{one}{gap}{other}\t\n"
    return ("Channels\t2\t\t\n" + pair("Samples", samples, samples) + pair("Date", "2024/03/01", "2024/03/01") +
            pair("Time", time, time) + pair("Y_Unit_Label", "g", "Newtons") + pair("X_Dimension", "Time", "Time") +
            pair("X0", "0.0000000000000000E+0", "0.0") + pair("Delta_X", *delta) + "***End_of_Header***\t\t\t\n" +
            names + rows)


ROWS = "\t1.000000\t2.000000\n\t3.000000\t4.000000\n\t5.000000\t6.000000\n"


def lvm():
    write("lvm/plain.lvm", lvm_file() + lvm_segment(ROWS))
    write("lvm/segments.lvm", lvm_file() + lvm_segment(ROWS) + "\t\n" + lvm_segment(ROWS, "12:00:01.03"))
    write("lvm/apart.lvm", lvm_file() + lvm_segment(ROWS) + lvm_segment(ROWS, "12:00:09", ("0.1", "0.1")))
    write("lvm/rates.lvm", lvm_file() + lvm_segment("\t1\t2\n\t3\t\n", delta=("0.01", "0.1")))
    write("lvm/comma.lvm", (lvm_file(point=",") + lvm_segment(ROWS)).replace(".0", ",0"))
    write("lvm/commas.lvm", (lvm_file(point=",", separator="Comma") + lvm_segment(ROWS)).replace("\t", ","))
    write("lvm/one.lvm", lvm_file("One") + lvm_segment("0.00\t1\t2\tok\n0.02\t3\t4\n0.03\tNaN\t6\n").replace("\n", "\r\n"))
    write("lvm/absolute.lvm", lvm_file("One", preference="Absolute") +
          lvm_segment("3792139200.50\t1\t2\n3792139200.51\t3\t4\n3792139200.53\t5\t6\n"))
    write("lvm/multi.lvm", lvm_file("Multi", "") +
          lvm_segment("0.00\t1\t0.00\t2\n0.01\t3\t0.01\t4\n", names="X_Value\ta\tX_Value\tb\tComment\n", gap="\t\t"))
    write("lvm/special.lvm", lvm_file() + "***Start_Special***\nPacket_Notes\nx\t1\n***End_Special***\n" +
          lvm_segment(ROWS, names=""))


def chunk(name, content, size=None, order="<"):
    return name + struct.pack(order + "I", len(content) if size is None else size) + content + bytes(len(content) % 2)


def wav_format(encoding=1, channels=2, bits=16, more=b"", order="<"):
    row = channels * bits // 8
    return chunk(b"fmt ", struct.pack(order + "HHIIHH", encoding, channels, 100, 100 * row, row, bits) + more, order=order)


def wav():
    samples = struct.pack("<8h", *range(-4, 4))
    write("wav/plain.wav", wav_format() + chunk(b"data", samples))
    write("wav/big_endian.wav", wav_format(order=">") + chunk(b"data", samples, order=">"))
    write("wav/bytes.wav", wav_format(1, 1, 8) + chunk(b"data", b"abc"))
    write("wav/three_bytes.wav", chunk(b"junk", b"abc") + wav_format(1, 1, 24) + chunk(b"data", b"abcdef"))
    write("wav/floats.wav", wav_format(3, 1, 32) + chunk(b"data", struct.pack("<3f", 0.5, -1.0, float("nan"))))
    write("wav/doubles.wav", wav_format(3, 1, 64) + chunk(b"data", struct.pack("<3d", 0.5, -1.0, 0.25)))
    guid = bytes([1, 0, 0, 0, 0, 0, 16, 0, 128, 0, 0, 170, 0, 56, 155, 113])
    write("wav/long_form.wav", wav_format(0xFFFE, 1, 32, struct.pack("<HHI", 22, 24, 3) + guid) +
          chunk(b"data", struct.pack("<2i", -256, 512)))
    write("wav/killed.wav", wav_format() + chunk(b"data", samples, 0))
    write("wav/long_sizes.wav", chunk(b"ds64", struct.pack("<QQQI", 100, 16, 4, 0)) + wav_format() +
          chunk(b"data", samples, 0xFFFFFFFF) + chunk(b"LIST", b"INFO" + chunk(b"INAM", b"title")))
    comment = b"Time: 2014-08-01 10:00:00.500\nChannel-1: Accel-X\nScale-1: 8\nChannel-2: Aux\n"
    write("wav/axivity.wav", wav_format() + chunk(b"LIST", b"INFO" + chunk(b"ICMT", comment)) + chunk(b"data", samples))


def array(kind, shape, figures, fortran=False):
    text = f"{{'descr': {kind}, 'fortran_order': {fortran}, 'shape': {shape}, }}\n".encode()
    return b"\1\0" + struct.pack("<H", len(text)) + text + figures


def npz():
    many = struct.pack("<18d", *(k * k % 7 for k in range(18)))
    time = struct.pack("<6f", *(k / 4 for k in range(6)))
    rate = array("'<f8'", "()", struct.pack("<d", 50.0))
    write("npz/table", b"NEXT".join([array("'<f8'", "(6, 3)", many), array("'<f4'", "(6,)", time), rate]))
    write("npz/columns", b"NEXT".join([array("'<f8'", "(6, 3)", many, True), array("'<f4'", "(6,)", time)]))
    write("npz/turned", b"NEXT".join([array("'<f8'", "(3, 6)", many), array("'<f4'", "(6,)", time), rate]))
    write("npz/cube", array("'>i2'", "(6, 2, 2)", bytes(range(48))))
    fields = "[('t', '<u4'), ('tag', '|S2'), ('acc', '<f4', (3,))]"
    write("npz/fields", array(fields, "(3,)", b"".join(struct.pack("<I2s3f", k, b"ab", 1, 2, k) for k in range(3))))


if __name__ == "__main__":
    lvm()
    wav()
    npz()
