"""Fixtures: the command beside the module, and recordings that may be unavailable."""
import json
import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
COMMAND = os.environ.get("PROOFMASS", str(ROOT / "build" / "release" / "proofmass"))


@pytest.fixture
def document():
    """The JSON document of a command line, without its provenance."""

    def run(*words: str) -> dict:
        done = subprocess.run([COMMAND, *words, "--json", "-", "--quiet"], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        found = json.loads(done.stdout)
        del found["provenance"]
        return found

    return run


@pytest.fixture
def recordings() -> Path:
    """Folder of the recordings that are not distributed."""
    for folder in (os.environ.get("PROOFMASS_DATA"), ROOT.parent / "shared" / "data"):
        if folder and Path(folder).is_dir():
            return Path(folder)
    pytest.skip("needs the recordings in ../shared/data or PROOFMASS_DATA")
