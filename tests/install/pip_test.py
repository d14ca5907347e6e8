"""`pip install .` from the finished build, into a folder, without a network."""
import os
import subprocess
import sys
import tempfile
import unittest
from importlib.util import find_spec

SOURCE = os.environ["SOURCE"]

MISSING = [name for name in ("pip", "setuptools", "wheel") if find_spec(name) is None]


@unittest.skipIf(MISSING, f"there is no {', '.join(MISSING)}")
class Pip(unittest.TestCase):
    def test_installs_a_module_that_works(self):
        with tempfile.TemporaryDirectory() as place:
            install = [sys.executable, "-m", "pip", "install", "--no-build-isolation", "--no-deps", "--no-index"]
            ran = subprocess.run([*install, "--target", place, SOURCE], capture_output=True, text=True, timeout=280)
            self.assertEqual(ran.returncode, 0, ran.stdout + ran.stderr)
            work = "import proofmass as pm; print(pm.__file__, pm.KalmanModel(1.0, 1.0, 1.0, 2.0, P0=2.0).filter([1.0]).mean[0, 0])"
            used = subprocess.run([sys.executable, "-c", work], cwd=place, capture_output=True, text=True, timeout=60)
            self.assertEqual(used.returncode, 0, used.stderr)
            file, mean = used.stdout.split()
            self.assertTrue(os.path.realpath(file).startswith(os.path.realpath(place)), file)
            self.assertEqual(float(mean), 0.5)
            self.assertTrue(os.path.exists(os.path.join(place, "proofmass", "_core.pyi")))


if __name__ == "__main__":
    unittest.main()
