#!/usr/bin/python3
"""Writes the seed files of fuzz_pyramid: the arrays of small pyramids in numpy's format."""
import io
import pathlib
import struct

import numpy as np

NAMES = ["names.txt", "source", "samples", "end_s", "bin_samples"] + [
    f"{level:02}_{what}" for level in range(2) for what in ("start_s", "min", "max", "nonfinite")]


def npy(array):
    out = io.BytesIO()
    np.save(out, array)
    return out.getvalue()


def pyramid(samples, channels, levels):
    entries = {"names.txt": "".join(f"a{c}\tg\n" for c in range(channels)).encode(),
               "source": npy(np.array([8, 1], "<i8")), "samples": npy(np.array([samples], "<i8")),
               "end_s": npy(np.array([samples / 100 - 0.01])),
               "bin_samples": npy(np.array([256 * 4**i for i in range(levels)], "<i8"))}
    for level in range(levels):
        bins = -(-samples // (256 * 4**level))
        entries[f"{level:02}_start_s"] = npy(np.arange(bins) * 2.56 * 4**level)
        entries[f"{level:02}_min"] = npy(-np.ones((channels, bins)))
        entries[f"{level:02}_max"] = npy(np.ones((channels, bins)))
        entries[f"{level:02}_nonfinite"] = npy(np.zeros((channels, bins), "<u4"))
    return entries


def packed(entries):
    return b"".join(struct.pack("<BH", NAMES.index(name), len(data)) + data
                    for name, data in entries.items())


folder = pathlib.Path(__file__).parent / "corpus/pyramid"
folder.mkdir(parents=True, exist_ok=True)
(folder / "one_bin").write_bytes(packed(pyramid(100, 1, 1)))
(folder / "two_levels").write_bytes(packed(pyramid(1300, 2, 2)))
(folder / "no_channel").write_bytes(packed(pyramid(700, 0, 1)))
short = pyramid(1300, 1, 2)
del short["01_max"]
(folder / "level_missing").write_bytes(packed(short))
big = pyramid(100, 1, 1)
big["samples"] = npy(np.array([2**62], "<i8"))
(folder / "too_many_samples").write_bytes(packed(big))
