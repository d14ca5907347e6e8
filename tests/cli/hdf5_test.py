"""HDF5 files written by proofmass and read by h5py, and the reverse."""
import unittest

import h5py
import numpy as np

from command import BAD_INPUT, CommandTest


class Hdf5(CommandTest):
    def test_h5py_reads_every_bit_of_what_is_written(self):
        values = np.random.default_rng(3).normal(size=(1000, 3))
        values[5, 1], values[6, 2] = np.nan, np.inf
        stamps = np.cumsum(0.01 + 0.001 * np.arange(1000) % 0.003)
        rows = [f"{t!r},{','.join(repr(v) for v in row)}" for t, row in zip(stamps.tolist(), values.tolist())]
        self.write("a.csv", "time (s),acc_x (m/s^2),acc_y (m/s^2),gyr z (deg/s)\n" + "\n".join(rows))
        self.succeed("convert", "a.csv", "-o", "b.h5")
        with h5py.File(self.folder / "b.h5") as f:
            group = f["recording"]
            self.assertEqual(list(group), ["time", "acc_x", "acc_y", "gyr z"])
            for c, name in enumerate(["acc_x", "acc_y", "gyr z"]):
                np.testing.assert_array_equal(group[name][:], values[:, c])
            self.assertEqual(group["acc_x"].attrs["units"], "m/s^2")
            self.assertEqual(group["gyr z"].attrs["units"], "deg/s")
            np.testing.assert_allclose(group["time"][:], stamps - stamps[0], rtol=0, atol=1e-12)
        self.assertEqual(self.leftovers(), [])

    def test_an_even_time_base_is_a_rate(self):
        self.write("a.csv", "acc_x (g)\n" + "\n".join(str(k / 8) for k in range(100)))
        self.succeed("convert", "a.csv", "--rate", "50", "-o", "b.hdf5")
        with h5py.File(self.folder / "b.hdf5") as f:
            self.assertEqual(f["recording"].attrs["sample_rate_hz"], 50.0)
            np.testing.assert_array_equal(f["recording/acc_x"][:], np.arange(100) / 8)
        self.assertEqual(self.document("inspect", "b.hdf5")["rate_hz"], 50.0)

    def test_what_h5py_writes_comes_back_from_a_round_trip(self):
        rows = np.zeros(300, dtype=[("t", "<i8"), ("acc", "<f4", (3,)), ("word", "S3")])
        rows["t"] = 1_700_000_000_000_000_000 + 10_000_000 * np.arange(300)
        rows["acc"] = np.random.default_rng(4).normal(size=(300, 3))
        with h5py.File(self.folder / "a.h5", "w") as f:
            f["log"] = rows
        self.succeed("convert", "a.h5", "-o", "b.h5")
        with h5py.File(self.folder / "b.h5") as f:
            for c, axis in enumerate("xyz"):
                np.testing.assert_array_equal(f[f"recording/acc_{axis}"][:], rows["acc"][:, c])
            start = f["recording"].attrs["start_time_ns"]
        self.assertEqual(start, rows["t"][0])

    def test_a_chunked_and_turned_dataset_is_read_as_it_is(self):
        values = np.random.default_rng(5).normal(size=(3, 50_000)).astype("f4")
        with h5py.File(self.folder / "a.h5", "w") as f:
            f.create_dataset("acc", data=values, chunks=(1, 9999), compression="gzip", shuffle=True)
            f.attrs["fs"] = 100.0
        self.succeed("convert", "a.h5", "-o", "b.npy")
        np.testing.assert_array_equal(np.load(self.folder / "b.npy")[:, 1:], values.T.astype("f8"))

    def test_a_claim_that_no_compression_could_hold_is_refused_before_it_is_unpacked(self):
        with h5py.File(self.folder / "empty.h5", "w") as f:
            f.create_dataset("acc_x", shape=(2 * 10**9,), dtype="f8", chunks=(10**6,), compression="gzip")
        ran = self.run_command("inspect", "empty.h5")
        self.assertEqual(ran.returncode, BAD_INPUT)
        self.assertIn("claims 2000000000 figures", ran.stderr.decode())


if __name__ == "__main__":
    unittest.main()
