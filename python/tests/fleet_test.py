"""Fleets of recordings, from Python."""
import numpy as np
import pytest

import proofmass as pm
from conftest import COMMAND


@pytest.fixture
def tray(tmp_path, monkeypatch):
    """A folder with seven recordings of white noise, one with twice the density, and a damaged one."""
    monkeypatch.setenv("PROOFMASS", COMMAND)
    monkeypatch.chdir(tmp_path)
    draw = np.random.default_rng(1)
    lines = ["path,sensor"]
    for k in range(8):
        values = 9.8 + (0.02 if k == 5 else 0.01) * draw.normal(size=500)
        rows = "".join(f"{n / 100:.2f},{value:.6f}\n" for n, value in enumerate(values))
        (tmp_path / f"r{k}.csv").write_text("time (s),acc_z (m/s^2)\n" + rows)
        lines.append(f"r{k}.csv,S{k}")
    (tmp_path / "lost.csv").write_text("the disk was full\n")
    (tmp_path / "manifest.csv").write_text("\n".join([*lines, "lost.csv,S9"]) + "\n")
    return tmp_path


def test_each_recording_is_done_and_the_odd_sensor_stands_out(tray):
    done = pm.fleet.run("noise", "manifest.csv", "results", jobs=2, taus="octave")
    assert (done.jobs, done.done, done.skipped) == (9, 8, 0)
    assert [one.file for one in done.failed] == ["lost.csv"]
    assert "8 done" in done.text
    again = pm.fleet.run("noise", "manifest.csv", "results", jobs=2, taus="octave")
    assert (again.done, again.skipped) == (0, 8)
    found = pm.fleet.summary("results", limit=["white<1.5e-3"])
    assert {one.sensor for one in found.out_of_family} == {"S5"}
    white = next(one for one in found.figures if one.name == "white")
    assert (white["yield"][0].within, white["yield"][0].sensors) == (7, 8)
    found.report("summary.html")
    assert "S5" in (tray / "summary.html").read_text()


def test_errors_name_options_and_have_the_kind_of_the_commands_status(tray):
    with pytest.raises(pm.FileError, match="holds no results"):
        pm.fleet.summary("nowhere")
    with pytest.raises(pm.Error, match="rate_hz="):
        pm.fleet.run("noise", "manifest.csv", "results", rate_hz="x")
    with pytest.raises(pm.Error, match="by=: of noise alone"):
        pm.fleet.run("inspect", "manifest.csv", "results", by="sensor")
