"""The examples of docs/python.md print what the page shows, and the package passes type checking."""
import doctest
import importlib.util
import os
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

import proofmass as pm
from conftest import ROOT


def test_gallery_prints_what_it_says():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pm.ProofmassWarning)
        outcome = doctest.testfile(str(ROOT / "docs" / "python.md"), module_relative=False)
    assert outcome.attempted > 20 and outcome.failed == 0


def test_types_are_right(tmp_path):
    if importlib.util.find_spec("mypy") is None:
        pytest.skip("needs mypy")
    package = Path(pm.__file__).parent
    environment = {**os.environ, "MYPYPATH": str(package.parent)}
    environment.pop("PYTHONPATH", None)
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--allow-untyped-calls",
         "--no-warn-unused-ignores", "--cache-dir", str(tmp_path), "-p", "proofmass"],
        capture_output=True, text=True, env=environment, cwd=tmp_path,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
