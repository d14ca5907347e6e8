"""Results are identical to the command's documents, for files and for data in memory."""
import subprocess
from pathlib import Path

import numpy as np
import pytest

import proofmass as pm
from conftest import COMMAND

pytestmark = pytest.mark.filterwarnings("ignore::proofmass.ProofmassWarning")


def simulated(folder: Path, *words: str) -> str:
    path = str(folder / "made.csv")
    subprocess.run([COMMAND, "simulate", *words, "-o", path, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    return path


@pytest.fixture(scope="module")
def rig(tmp_path_factory):
    return simulated(tmp_path_factory.mktemp("rig"), "--rpm", "60", "--duration", "20", "--seed", "7")


@pytest.fixture(scope="module")
def poses(tmp_path_factory):
    return simulated(tmp_path_factory.mktemp("poses"), "--procedure", "multi-position", "--seed", "3")


@pytest.fixture(scope="module")
def table(tmp_path_factory):
    return simulated(tmp_path_factory.mktemp("table"), "--procedure", "four-position", "--seed", "5")


@pytest.fixture(scope="module")
def slide(tmp_path_factory):
    return simulated(tmp_path_factory.mktemp("slide"), "--procedure", "slide", "--strokes", "2", "--seed", "4")


@pytest.mark.parametrize(
    "verb, file, options",
    [
        ("inspect", "rig", {}),
        ("noise", "poses", {"to_s": 2.0, "statistic": "mdev", "taus": [0.01, 0.1]}),
        ("drift", "poses", {"to_s": 2.0}),
        ("calibrate", "poses", {"gravity": 9.80665, "monte_carlo": 0}),
        ("tumble", "table", {"gravity": 9.80665, "angles": [0, 90, 180, 270]}),
        ("wheel", "rig", {"spin_axis": "z", "rim_radius": 0.3}),
        ("track", "slide", {"axis": "x"}),
        ("tilt", "poses", {"base": "moving", "gravity": 9.80665}),
        ("tune", "poses", {"to_s": 2.0, "model": "rest", "fix": ["random_walk=0.001"]}),
    ],
)
def test_document_is_the_commands(verb, file, options, document, request):
    path = request.getfixturevalue(file)
    flags = []
    for name, value in options.items():
        flag = "--" + {"to_s": "to"}.get(name, name).replace("_", "-")
        if name in ("taus", "angles"):
            value = ",".join(map(str, value))
        flags += [f"{flag}={item}" for item in (value if isinstance(value, list) else [value])]
    expected = document(verb, path, *flags)
    function = getattr(pm, verb)
    assert function(path, **options).to_dict() == expected
    assert function(pm.read(path), **options).to_dict() == expected


def test_simulated_recording_is_the_commands(rig):
    twin, read = pm.simulate(rpm=60, duration=20, seed=7), pm.read(rig)
    assert twin.recording.channels == read.channels
    for name in read.channels:
        assert np.array_equal(twin.recording[name], read[name])
    assert np.array_equal(twin.truth["angle"], pm.read(rig.replace("made", "made.truth"))["angle"])


def test_series_is_what_the_command_writes(rig, tmp_path):
    path = str(tmp_path / "wheel.csv")
    subprocess.run([COMMAND, "wheel", rig, "-o", path, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    frame, read = pm.wheel(rig).to_pandas(), pm.read(path)
    for name in ("angle", "angle_std", "speed", "atan2_angle"):
        assert np.array_equal(frame[name].to_numpy(), read[name])


def test_array_is_the_file_of_the_same_values(tmp_path, document):
    x = np.random.default_rng(1).normal(scale=0.1, size=(5000, 3))
    path = str(tmp_path / "x.npy")
    np.save(path, x)
    expected = document("noise", path, "--rate", "100", "--unit", "m/s2")["channels"]
    found = pm.noise(x, rate_hz=100, unit="m/s2").to_dict()["channels"]
    for ours, theirs in zip(found, expected):
        ours.pop("name"), theirs.pop("name")
        assert ours == theirs


@pytest.mark.parametrize("verb, file", [("noise", "noise_N9sigma_11454000.npy.xz"), ("wheel", "wheel_R2_2104212.csv.xz")])
def test_document_of_open_recordings(verb, file, document, recordings):
    path = recordings / "independent" / file
    if not path.exists():
        pytest.skip(f"needs {file}")
    flags, options = ([], {}) if verb == "wheel" else (["--rate=100"], {"rate_hz": 100})
    assert getattr(pm, verb)(path, **options).to_dict() == document(verb, str(path), *flags)
