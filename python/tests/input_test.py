"""Arrays and tables of every kind, errors, threads, processes, signals and memory."""
import gc
import json
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time
import weakref

import numpy as np
import pandas as pd
import pytest

import proofmass as pm
from proofmass import _core
from proofmass._arrays import as_doubles
from proofmass._results import Result

pytestmark = pytest.mark.filterwarnings("ignore::proofmass.ProofmassWarning")

RNG = np.random.default_rng(11)
PLAIN = np.round(RNG.normal(scale=100, size=3000))
EXPECTED = pm.allan(PLAIN, rate_hz=100, taus="octave").deviation


def read_only(x):
    x = x.copy()
    x.flags.writeable = False
    return x


@pytest.mark.parametrize(
    "kind",
    [
        lambda x: x.astype(">f8"),
        lambda x: x.astype(np.float32),
        lambda x: x.astype(np.int16),
        lambda x: x.astype(">i4"),
        lambda x: np.repeat(x, 2)[::2],
        lambda x: x[::-1].copy()[::-1],
        lambda x: np.asfortranarray(np.column_stack([x, x]))[:, 0],
        read_only,
        list,
        tuple,
        lambda x: pd.Series(x),
        lambda x: np.ma.masked_array(x),
        lambda x: np.array(list(x), dtype=object),
    ],
)
def test_every_kind_of_array_gives_the_same(kind):
    assert np.array_equal(pm.allan(kind(PLAIN), rate_hz=100, taus="octave").deviation, EXPECTED)


def test_masked_samples_are_missing():
    mask = np.zeros(PLAIN.size, dtype=bool)
    mask[100:105] = True
    holed = np.where(mask, np.nan, PLAIN)
    found = pm.noise(np.ma.masked_array(PLAIN, mask), rate_hz=100, unit="m/s2").channels[0]
    assert found.missing == 5
    assert found.to_dict() == pm.noise(holed, rate_hz=100, unit="m/s2").channels[0].to_dict()


@pytest.mark.parametrize(
    "wrong, sentence",
    [
        ([], "one sample at least"),
        (np.zeros((3, 4, 5)), "dimensional"),
        (np.zeros(5, dtype=complex), "real numbers"),
        (np.zeros(5, dtype=bool), "truth values"),
        (np.array([object()] * 3), "objects"),
        (["a", "b"], "text"),
        ([[1.0, 2.0], [3.0]], "numbers"),
        (None, "numbers"),
        (np.zeros(100), "vary"),
        (np.full(100, np.nan), "no sample is a number"),
    ],
)
def test_what_is_no_series_is_refused_in_a_sentence(wrong, sentence):
    with pytest.raises(ValueError, match=sentence) as refused:
        pm.allan(wrong, rate_hz=100)
    assert isinstance(refused.value, pm.Error)


def test_errors_are_of_the_kinds_that_people_catch(tmp_path):
    with pytest.raises(OSError) as missing:
        pm.read(tmp_path / "none.csv")
    assert isinstance(missing.value, pm.FileError)
    with pytest.raises(pm.ArgumentError, match="taus="):
        pm.noise(PLAIN, rate_hz=100, unit="m/s2", taus="often")
    with pytest.raises(ValueError, match="rate_hz="):
        pm.noise(PLAIN, unit="m/s2")
    with pytest.raises(ValueError, match=r"rate_hz=: .*see help\(proofmass\.[a-z]+\)"):
        pm.noise(PLAIN, rate_hz=-1, unit="m/s2")
    with pytest.raises(TypeError, match="colour"):
        pm.noise(PLAIN, rate_hz=100, colour="red")  # type: ignore[call-arg]
    with pytest.raises(pm.FileError):
        pm.Sensor(tmp_path / "none.toml")


def test_recording_goes_to_pandas_and_back():
    rec = pm.Recording.from_arrays({"acc_x": PLAIN, "gyro_z": PLAIN}, rate_hz=10, unit="mg", units={"gyro_z": "deg/s"})
    back = pm.Recording.from_pandas(rec.to_pandas())
    assert back.units == rec.units == {"acc_x": "mg", "gyro_z": "deg/s"}
    assert back.rate_hz == pytest.approx(10)
    assert np.array_equal(back["acc_x"], PLAIN)
    dated = rec.to_pandas().set_axis(pd.date_range("2026-01-01", periods=PLAIN.size, freq="100ms"))
    assert pm.Recording.from_pandas(dated).rate_hz == pytest.approx(10)


def test_views_outlive_their_recording_and_are_read_only():
    rec = pm.Recording.from_arrays({"acc_x": PLAIN}, rate_hz=10, unit="g")
    view, again = rec["acc_x"], rec["acc_x"]
    assert np.shares_memory(view, again)
    del rec, again
    gc.collect()
    assert np.array_equal(view, PLAIN)
    with pytest.raises(ValueError):
        view[0] = 1.0


def test_recording_is_cut_by_time():
    rec = pm.Recording.from_arrays(np.arange(10.0), rate_hz=2, unit="g")
    assert rec[1:3]["x"].tolist() == [2.0, 3.0, 4.0, 5.0]
    with pytest.raises(KeyError, match="no channel y"):
        rec["y"]
    with pytest.raises(pm.ArgumentError):
        rec[3:1]


def test_times_that_do_not_rise_or_fit_are_refused():
    with pytest.raises(ValueError, match="times for"):
        pm.Recording.from_arrays(np.arange(4.0), time_s=[0, 1, 2])
    with pytest.raises(ValueError, match="finite times"):
        pm.Recording.from_arrays(np.arange(3.0), time_s=[0, np.nan, 2])


def test_results_pickle_and_say_why_something_is_missing():
    found = pm.noise(PLAIN, rate_hz=100, unit="m/s2")
    again = pickle.loads(pickle.dumps(found))
    assert again.to_dict() == found.to_dict()
    assert again.channels[0].white.value == found.channels[0].parameters.white.value
    assert again.to_pandas().equals(found.to_pandas())
    missing = found.channels[0].bandwidth_hz
    assert missing == None and not missing and "roll off" in missing.why  # noqa: E711
    curve = pm.allan(PLAIN, rate_hz=1)
    assert np.array_equal(pickle.loads(pickle.dumps(curve)).deviation, curve.deviation)
    sensor = pm.simulate(procedure="six-position", seed=1).sensor
    assert pickle.loads(pickle.dumps(sensor)).text == sensor.text


def test_reasons_are_those_of_the_member_that_is_missing():
    document = {
        "turns": None,
        "sensors": [{"file": "a.csv", "radius_m": None, "bias": [None, 1.0], "skew_rad": None}],
        "positions": [{"start_s": None}] * 3 + [{"start_s": 1.0}, {"start_s": None}],
        "cross_axis": [None, None, None],
        "methods": {"atan2": {"turns": {"value": 1.0, "std": None, "unit": "turn"}}},
        "warnings": [
            "sensors[0] (a.csv): radius_m, bias[0]: null: still",
            "sensors[0] (a.csv): skew_rad: null: slow",
            "positions[4].start_s: null: cut off",
            "positions[]: start_s: null (3 times): the file has no times",
            "cross_axis[0], cross_axis[1]: null: misalignment was not fitted",
            "cross_axis[2]: null: the z axis defines the frame",
            "methods.atan2.turns.std: null: it has none",
            "turns: null: the angle was lost",
        ],
    }
    found = Result({"json": json.dumps(document)})
    sensor = found.sensors[0]
    assert [found.turns.why, sensor.radius_m.why, sensor.bias[0].why, sensor.skew_rad.why] == [
        "the angle was lost", "still", "still", "slow",
    ]  # fmt: skip
    assert [position.start_s for position in found.positions][3] == 1.0
    assert [found.positions[k].start_s.why for k in (0, 4)] == ["the file has no times", "cut off"]
    assert [axis.why for axis in found.cross_axis][1:] == ["misalignment was not fitted", "the z axis defines the frame"]
    assert found.methods.atan2.turns.std.why == "it has none"


def test_page_and_plots_are_there(tmp_path):
    found = pm.noise(PLAIN, rate_hz=100, unit="m/s2")
    found.report(tmp_path / "noise.html")
    assert "<svg" in (tmp_path / "noise.html").read_text()
    assert "<iframe" in found._repr_html_()
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    assert len(found.plot().lines) == 1
    assert len(pm.allan(PLAIN, rate_hz=100).plot().lines) == 1


def test_findings_become_warnings():
    with pytest.warns(pm.ProofmassWarning, match="gravity"):
        pm.calibrate(pm.simulate(procedure="multi-position", seed=3).recording, monte_carlo=0)
    level = np.random.default_rng(1).normal(scale=0.01, size=(2000, 3)) + [0.0, 0.0, 9.81]
    with pytest.warns(pm.ProofmassWarning, match="use sensor= or bias_std="):
        pm.tilt(level, rate_hz=100, unit="m/s2")


def test_sensor_is_applied_from_memory_as_from_a_file(tmp_path):
    twin = pm.simulate(procedure="multi-position", seed=3, signal="voltage")
    path = tmp_path / "sensor.toml"
    twin.sensor.write(path)
    from_file = pm.noise(twin.recording, sensor=path, to_s=2)
    assert from_file.channels[0].unit == "m/s^2"
    assert pm.noise(twin.recording, sensor=twin.sensor, to_s=2).channels[0].to_dict() == from_file.channels[0].to_dict()


def test_two_threads_at_once_give_what_one_gives():
    series = [np.random.default_rng(k).normal(size=20_000) for k in range(4)]
    expected = [pm.noise(x, rate_hz=100, unit="m/s2").to_dict() for x in series]
    found = [None] * 4

    def work(k):
        found[k] = pm.noise(series[k], rate_hz=100, unit="m/s2").to_dict()

    threads = [threading.Thread(target=work, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == expected


def deviation_of(seed):
    return pm.allan(np.random.default_rng(seed).normal(size=5000), rate_hz=1, taus="octave").deviation


def test_a_fork_computes_as_its_parent():
    expected = [deviation_of(seed) for seed in range(3)]
    with multiprocessing.get_context("fork").Pool(2) as pool:
        found = pool.map(deviation_of, range(3))
    assert all(np.array_equal(a, b) for a, b in zip(found, expected))


def test_progress_is_told_and_what_it_raises_ends_the_work():
    x = np.random.default_rng(1).normal(size=2_000_000)
    told = []
    pm.noise(x, rate_hz=1000, unit="m/s2", progress=lambda stage, fraction: told.append((stage, fraction)))
    assert told and all(0 <= fraction <= 1 for _, fraction in told)

    def stop(stage, fraction):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        pm.noise(x, rate_hz=1000, unit="m/s2", progress=stop)


def test_ctrl_c_ends_a_long_computation():
    code = (
        "import numpy as np, proofmass as pm\n"
        "model = pm.KalmanModel(np.eye(16), np.ones(16), np.eye(16), 1.0, P0=np.eye(16))\n"
        "print('begun', flush=True)\n"
        "try:\n"
        "    model.fixed_lag(np.zeros(20000), 5000)\n"
        "except KeyboardInterrupt:\n"
        "    print('interrupted')\n"
    )
    process = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "begun\n"
    time.sleep(1.0)
    os.kill(process.pid, signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert out == "interrupted\n"


def test_deviations_of_contiguous_doubles_take_no_copy_at_the_border():
    assert np.shares_memory(as_doubles(PLAIN, "x"), PLAIN)
    with pytest.raises(TypeError):  # the library does not convert its arguments
        _core.allan(["noise", "array", "--rate=1"], PLAIN.astype(np.float32), None)


def test_recordings_copy_arrays_unless_told_otherwise():
    assert not np.shares_memory(pm.Recording.from_arrays(PLAIN, rate_hz=10)["x"], PLAIN)
    x = PLAIN.copy()
    recording = pm.Recording.from_arrays(x, rate_hz=10, unit="g", copy=False)
    assert np.shares_memory(recording["x"], x)
    held = weakref.ref(x)
    del x
    assert held() is not None and np.array_equal(recording["x"], PLAIN)
    del recording
    assert held() is None


def test_analyses_leave_their_arrays_as_they_were():
    x = np.random.default_rng(7).normal(size=(3000, 3))
    x[5, 0] = 3e34  # becomes missing
    columns = {name: np.ascontiguousarray(x[:, k]) for k, name in enumerate(["acc_x", "acc_y", "acc_z"])}
    before = {name: values.copy() for name, values in columns.items()}
    pm.noise(columns, rate_hz=100, unit="g", temperature="acc_z")  # conversion to m/s^2, regression
    pm.drift(columns, rate_hz=100, unit="g")
    pm.inspect(columns, rate_hz=100, unit="g")
    for name, values in columns.items():
        assert np.array_equal(values, before[name])


@pytest.mark.parametrize("kind", ["Tilt", "Track", "Wheel"])
def test_live_estimates_come_sample_by_sample(kind):
    rng = np.random.default_rng(2)
    t = np.arange(3000) / 100
    samples = rng.normal(scale=0.01, size=(t.size, 3)) + [0.0, 0.0, 9.80665]
    if kind == "Wheel":
        samples[:, :2] += 9.80665 * np.column_stack([np.sin(6 * t), np.cos(6 * t)])
        samples[:, 2] -= 9.80665
    make = getattr(pm.live, kind)
    channels = {"acc_x": "m/s2", "acc_y": "m/s2", "acc_z": "m/s2"}
    whole, single = make(channels, rate_hz=100), make(channels, rate_hz=100)
    rows = [whole.add(t, samples), whole.finish()]
    pushed = [single.push(time_s, sample) for time_s, sample in zip(t, samples)]
    assert list(rows[0])[0] == "time_s" and list(rows[0])[1:] == list(whole.columns)
    assert sum(part["time_s"].size for part in rows) > 2000
    assert sum(row is not None for row in pushed) > 100
    with pytest.raises(pm.ArgumentError, match="samples: expected shape"):
        whole.add(t, samples[:, :2])
