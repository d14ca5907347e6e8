"""The extension of `pip install .`, built by CMake; the rest is in pyproject.toml."""
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

SOURCE = Path(__file__).resolve().parent


def interpreter_of(build):
    """The interpreter that a build folder is configured for, or None."""
    try:
        cache = (build / "CMakeCache.txt").read_text()
    except OSError:
        return None
    entries = dict(line.split("=", 1) for line in cache.splitlines() if "=" in line)
    path = entries.get("_Python_EXECUTABLE:INTERNAL")
    return path and os.path.realpath(path)


class CMakeBuild(build_ext):
    """Builds in build/release where that is configured for this interpreter, else in a folder of its own."""

    def build_extension(self, extension):
        python = os.path.realpath(getattr(sys, "_base_executable", sys.executable))
        build = SOURCE / "build" / "release"
        if interpreter_of(build) != python:
            build = SOURCE / "build" / f"python-{sys.implementation.cache_tag}"
        if not (build / "CMakeCache.txt").exists():
            configure = ["cmake", "--preset", "release", "-B", build, f"-DPython_EXECUTABLE={python}"]
            subprocess.run(configure, cwd=SOURCE, check=True)
        subprocess.run(["cmake", "--build", build, "--target", "proofmass_python"], check=True)
        with tempfile.TemporaryDirectory() as prefix:
            subprocess.run(["cmake", "--install", build, "--component", "python", "--prefix", prefix], check=True)
            made = next(Path(prefix).glob("**/proofmass/_core.*.so"))
            target = Path(self.get_ext_fullpath(extension.name))
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(made, target)


(SOURCE / "build").mkdir(exist_ok=True)
setup(
    ext_modules=[Extension("proofmass._core", [])],
    cmdclass={"build_ext": CMakeBuild},
    options={"egg_info": {"egg_base": "build"}, "build": {"build_base": "build/pip"}},
)
