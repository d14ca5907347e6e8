#!/usr/bin/env python3
"""Writes the seed files in fuzz/corpus/hdf5, which io/hdf5/hdf5_test.cpp reads, too. Run by hand with h5py 3.7
and NumPy; the files are in the repository, since other versions write different bytes.
The list of contents beside them, groups.contents, is encode(list_hdf5()) of groups.h5."""
from pathlib import Path

import h5py
import numpy as np

FOLDER = Path(__file__).parent / "corpus" / "hdf5"
N = 40
K = np.arange(N)


def vectors(first, width=3):
    """Row k, column c: first + c + k / 4, exactly representable in all types used here."""
    return first + np.arange(width)[None, :] + K[:, None] / 4


def tiny():
    """The shortest possible file with numbers, which are in the dataset's header."""
    with h5py.File(FOLDER / "tiny.h5", "w", libver="latest") as f:
        layout = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
        layout.set_layout(h5py.h5d.COMPACT)
        space = h5py.h5s.create_simple((3,))
        dataset = h5py.h5d.create(f.id, b"a", h5py.h5t.IEEE_F64LE, space, layout)
        dataset.write(h5py.h5s.ALL, h5py.h5s.ALL, np.array([1.5, -2.0, 3.25]))


def groups():
    with h5py.File(FOLDER / "groups.h5", "w") as f:
        f.attrs["fs"] = 100.0
        f.attrs["info"] = "Made by a test: `gyro` in rad/s, `pos` in mm."
        packed = {"chunks": (16, 2), "compression": "gzip", "shuffle": True, "fletcher32": True}
        acc = f.create_dataset("imu/acc", data=vectors(1).astype(">f4"), **packed)
        acc.attrs["units"] = "m/s^2"
        f["imu/gyro"] = vectors(10).T
        f["imu/temp"] = (4 * vectors(-7, 1)).astype(">i2")
        f["imu/temp"].attrs["units"] = np.array([b"degC"])
        f["imu/moving"] = K % 3 == 0
        f["imu/quat"] = vectors(0, 4).astype("<f2")
        f["pos"] = vectors(20).astype("<f8")
        f["imu/phase"] = K + 1j
        f["other"] = np.arange(7, dtype="<u8")
        f["title"] = "text"
        f["rows"] = np.zeros(N, dtype=[("a", "<f4"), ("b", "<i4")])
        f["soft"] = h5py.SoftLink("/imu/acc")
        f["far"] = h5py.ExternalLink("/etc/passwd", "/x")
        f["imu/again"] = f["imu"]


def sensors():
    with h5py.File(FOLDER / "sensors.h5", "w", libver="latest") as f:
        for name, first in (("left", 1), ("right", 5)):
            group = f.create_group(name)
            group["acc"] = vectors(first).astype("<i8")
            group["time"] = 5000 * K + 1_600_000_000_000_000
            group["time"].attrs["units"] = "us"


def columns():
    with h5py.File(FOLDER / "columns.h5", "w") as f:
        data = f.create_dataset("data", data=np.c_[K / 50, vectors(1, 4)], maxshape=(None, 5), chunks=(7, 5))
        data.attrs["columns"] = ["t", "ax", "ay", "az", "T"]
        data.attrs["units"] = ["s", "g", "g", "g", "degC"]


def compound():
    fields = [("time", "<f8"), ("acc", "<f4", (3,)), ("temp", ">i2"), ("on", "?"), ("word", "S4"), ("grid", "<f4", (2, 2))]
    rows = np.zeros(N, dtype=fields)
    rows["time"], rows["acc"], rows["temp"], rows["on"] = K / 50, vectors(1), K - 28, K % 3 == 0
    with h5py.File(FOLDER / "compound.h5", "w") as f:
        f.create_dataset("log/imu", data=rows, chunks=(7,), compression="gzip")
        f["log/gps"] = np.zeros(5, dtype=[("lat", "<f8"), ("lon", "<f8")])
        f["other"] = vectors(20)


def stamps():
    with h5py.File(FOLDER / "stamps.h5", "w", track_order=True) as f:
        f["time"] = 1_700_000_000_000_000_001 + 5_000_000 * K + K % 3
        f["time"].attrs["units"] = "ns"
        for name, first in (("z", 3), ("x", 1), ("y", 2)):
            f[name] = vectors(first, 1)


def matlab():
    path = FOLDER / "matlab.mat"
    with h5py.File(path, "w", userblock_size=512) as f:

        def variable(name, array, kind):
            f[name] = np.asarray(array).T
            f[name].attrs["MATLAB_class"] = np.bytes_(kind)
            return f[name]

        variable("imu/acc", vectors(1), "double")
        variable("imu/t", K[:, None] / 50, "double")
        variable("imu/on", (K % 2)[:, None].astype("u1"), "logical")
        f["imu"].attrs["MATLAB_class"] = np.bytes_("struct")
        variable("name", [[ord(c)] for c in "title"], "char")
        variable("fs", [[200.0]], "double")
        parts = [variable(f"#refs#/{c}", vectors(10 * i), "single") for i, c in enumerate("abcd", 1)]
        f["parts"] = np.array([[p.ref] for p in parts[:2]], dtype=h5py.ref_dtype)
        f["parts"].attrs["MATLAB_class"] = np.bytes_("cell")
        f["runs/acc"] = np.array([[p.ref] for p in parts[2:]], dtype=h5py.ref_dtype)
        f["runs"].attrs["MATLAB_class"] = np.bytes_("struct")
        f["sparse/data"] = np.ones(3)
        f["sparse"].attrs["MATLAB_sparse"] = 3
        f["none"] = np.zeros(2, dtype="u8")
        f["none"].attrs["MATLAB_empty"] = 1
    with open(path, "r+b") as f:
        f.write(b"MATLAB 7.3 MAT-file, made by a test".ljust(124) + b"\0\2IM")


def frame(kind, data=b""):
    return kind + len(data).to_bytes(4, "little") + data


def messages():
    """Messages of a child process: the contents, and 20 samples of five columns."""
    contents = (FOLDER / "groups.contents").read_bytes()
    (FOLDER / "contents.message").write_bytes(frame(b"data", contents) + frame(b"end "))
    figures = [vectors(1)[:20].T, 5_000_000 * K[:20] - 7, K[:20].astype("<u8")]
    said = b"".join(frame(b"data", np.ascontiguousarray(f).tobytes()) for f in figures)
    (FOLDER / "figures.message").write_bytes(said + frame(b"end "))
    (FOLDER / "error.message").write_bytes(frame(b"erro", b"\2is damaged"))


if __name__ == "__main__":
    FOLDER.mkdir(parents=True, exist_ok=True)
    for specimen in (tiny, groups, sensors, columns, compound, stamps, matlab, messages):
        specimen()
