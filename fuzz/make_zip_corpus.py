#!/usr/bin/env python3
"""Writes the seed files of fuzz_zip, fuzz_layout and fuzz_ximu: fuzz/corpus/zip, fuzz/corpus/layout,
fuzz/corpus/ximu. The output is reproducible."""
import gzip
import io
import pathlib
import zipfile

corpus = pathlib.Path(__file__).parent / "corpus"


def table(rows, header="t (s),acc x (g),acc y (g),acc z (g)"):
    lines = [header] + [f"{0.01 * k:.2f},{k % 7},0.5,1" for k in range(rows)]
    return "\n".join(lines) + "\n"


def archive(files, method):
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", method) as made:
        for name, content in files.items():
            entry = zipfile.ZipInfo(name, (2024, 1, 17, 8, 14, 46))
            entry.compress_type = method
            made.writestr(entry, content)
    return out.getvalue()


time_csv = (
    '"event","experiment time","system time","system time text"\n'
    '"START",0.0E0,1.705472086068796E9,"2024-01-17 08:14:46.069 UTC+02:00"\n'
    '"PAUSE",3.0E0,1.705472089068796E9,""\n'
    '"START",3.0E0,1.705472099568796E9,""\n'
)
device_csv = '"property","value"\n"version","1.1.12"\n"deviceModel","X"\n'
inertial = "Packet number,Accelerometer X (g),Accelerometer Y (g),Accelerometer Z (g)\n" + "".join(
    f"{2 * k},0,0,1\n" for k in range(40)
)
dates = "Packet number,Year,Month,Day,Hours,Minutes,Seconds\n" + "".join(
    f"{k * 8},2000,1,5,23,59,{k}\n" for k in range(12)
)
registers = (
    "Packet number,Address,Value,Fixed-point value,Name\n"
    "70,69,9,NaN,InertialAndMagneticDataRate\n"
)
metadata = "version,device name,platform\n3,X,android\n"
logged = "time,seconds_elapsed,z,y,x\n" + "".join(
    f"{1716979893874983200 + k * 10000000},{k * 0.01:.2f},9.8,0,0\n" for k in range(20)
)

zips = {
    "deflated": archive({"a.csv": table(20)}, zipfile.ZIP_DEFLATED),
    "stored": archive({"a.csv": table(20), "b.txt": "words"}, zipfile.ZIP_STORED),
    "two_sensors": archive(
        {"x/Accelerometer.csv": table(9), "x/Gyroscope.csv": table(9)}, zipfile.ZIP_DEFLATED
    ),
    "bzip2": archive({"a.csv": table(9)}, zipfile.ZIP_BZIP2),
    "gzip_within": archive({"a.csv.gz": gzip.compress(table(9).encode(), mtime=0)}, 0),
    "phyphox": archive(
        {"Raw Data.csv": table(9), "meta/time.csv": time_csv, "meta/device.csv": device_csv},
        zipfile.ZIP_DEFLATED,
    ),
    "empty_file": archive({"a.csv": ""}, zipfile.ZIP_STORED),
}
order = (
    "Accelerometer.csv",
    "meta/time.csv",
    "meta/device.csv",
    "r_CalInertialAndMag.csv",
    "r_DateTime.csv",
    "r_Registers.csv",
    "Metadata.csv",
    "record.properties",
    "r.BIN",
)
layouts = {
    "phyphox": {"Accelerometer.csv": table(9), "meta/time.csv": time_csv,
                "meta/device.csv": device_csv},
    "dates": {"r_CalInertialAndMag.csv": inertial, "r_DateTime.csv": dates},
    "registers": {"r_CalInertialAndMag.csv": inertial, "r_Registers.csv": registers},
    "logged": {"Accelerometer.csv": logged, "Metadata.csv": metadata},
    "phone": {"Accelerometer.csv": table(9), "record.properties": "Model = Nexus 5\n"},
}
inertial_packet = bytes([9] + [0, 16] * 3 + [8, 0] * 3 + [2, 0] * 3)
date_packet = bytes([5, 0x00, 0x01, 0x01, 0x10, 0x20])
packets = {
    "inertial": inertial_packet * 5,
    "dated": b"".join(
        date_packet + bytes([0x10 * (s // 10) + s % 10]) + inertial_packet * 2 for s in range(12)
    ),
    "kinds": b"".join(bytes([kind] + [1] * 18) for kind in range(12)),
    "raw": inertial_packet + b"\xff\x02\x40\x00\x10\x08\x40\x40\x54\x45\xc0" * 3,
}

for folder, specimens in (
    ("zip", {name: made[4:] for name, made in zips.items()}),
    ("layout", {n: b"\0".join(f.get(o, "").encode() for o in order) for n, f in layouts.items()}),
    ("ximu", packets),
):
    (corpus / folder).mkdir(parents=True, exist_ok=True)
    for name, content in specimens.items():
        (corpus / folder / name).write_bytes(content)
