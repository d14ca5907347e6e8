""".mat files written by `proofmass convert` and read by other programs."""
import unittest

from command import CommandTest, turning_csv

try:
    import numpy
    import scipy.io
except ImportError as error:
    scipy = None
    print(f"SKIPPED: {error}: python3-scipy and python3-numpy are what reads .mat files here", flush=True)


def figures(csv_text, column):
    return [float(line.split(",")[column]) for line in csv_text.splitlines()[1:]]


@unittest.skipIf(scipy is None, "python3-scipy or python3-numpy is absent")
class MatFiles(CommandTest):
    def test_scipy_reads_the_same_numbers(self):
        text = turning_csv(seconds=3)
        self.write("a.csv", text)
        self.succeed("convert", "a.csv", "-o", "b.mat")
        self.assertEqual(self.leftovers(), [])
        mat = scipy.io.loadmat(self.folder / "b.mat", squeeze_me=True)
        for column, name in enumerate(("time_s", "acc_x", "acc_y", "acc_z")):
            self.assertEqual(mat[name].dtype, numpy.dtype("<f8"))
            self.assertEqual(list(mat[name]), figures(text, column), name)
        self.assertAlmostEqual(float(mat["fs"]), 100.0, places=9)
        self.assertEqual(str(mat["units"]["acc_y"]), "m/s^2")
        self.assertEqual(str(mat["names"]["acc_y"]), "acc_y")

    def test_names_and_texts_are_what_matlab_takes(self):
        self.write("a.csv", "time (s),Beschleunigung für x (g),2nd,end,T (°C)\n"
                            "1700000000.5,1,2,3,4\n1700000000.51,nan,inf,6,7\n1700000000.53,8,9,-0.5,11\n")
        self.succeed("convert", "a.csv", "-o", "b.mat")
        mat = scipy.io.loadmat(self.folder / "b.mat", squeeze_me=True)
        names = {str(mat["names"][field]): field for field in mat["names"].dtype.names}
        self.assertEqual(set(names), {"time", "Beschleunigung für x", "2nd", "end", "T"})
        for field in names.values():
            self.assertRegex(field, "^[A-Za-z][A-Za-z0-9_]{0,62}$")
            self.assertEqual(mat[field].shape, (3,))
        self.assertEqual(list(mat["time_s"]), [0.0, 0.01, 0.03])
        self.assertTrue(numpy.isnan(mat[names["Beschleunigung für x"]][1]))
        self.assertTrue(numpy.isinf(mat[names["2nd"]][1]))
        self.assertEqual(int(mat["start_ns"]), 1_700_000_000_500_000_000)

    def test_what_scipy_writes_is_read(self):
        acc = numpy.arange(60.0).reshape(20, 3) % 7 + 0.25
        for packed in (False, True):
            scipy.io.savemat(self.folder / "s.mat", {"acc": acc, "t": numpy.arange(20) / 50.0},
                             do_compression=packed)
            document = self.document("inspect", "s.mat")
            self.assertEqual(document["samples"], 20)
            self.assertAlmostEqual(document["rate_hz"], 50.0, places=6)
            for column, channel in enumerate(document["channels"]):
                self.assertAlmostEqual(channel["mean"], acc[:, column].mean(), places=12)

    def test_what_numpy_packs_is_read(self):
        acc = numpy.asfortranarray(numpy.arange(60.0).reshape(20, 3) % 7 + 0.25)
        for save in (numpy.savez, numpy.savez_compressed):
            save(self.folder / "s.npz", acc=acc, fs=50.0)
            document = self.document("inspect", "s.npz")
            self.assertEqual(document["format"], "npz")
            self.assertEqual(document["rate_hz"], 50.0)
            for column, channel in enumerate(document["channels"]):
                self.assertAlmostEqual(channel["mean"], acc[:, column].mean(), places=12)

    def test_what_scipy_writes_as_sound_is_read(self):
        import scipy.io.wavfile
        sound = (numpy.arange(60).reshape(20, 3) % 7 - 3)
        for kind in ("int16", "int32", "float32", "uint8"):
            values = (sound + (128 if kind == "uint8" else 0)).astype(kind)
            scipy.io.wavfile.write(self.folder / "s.wav", 400, values)
            document = self.document("inspect", "s.wav")
            self.assertEqual(document["rate_hz"], 400.0)
            for column, channel in enumerate(document["channels"]):
                self.assertAlmostEqual(channel["mean"], values[:, column].mean(), places=6)


if __name__ == "__main__":
    unittest.main()
