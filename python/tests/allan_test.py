"""Published values of the Allan family.

Source: W. J. Riley, NIST SP 1065 (2008), tables 31 and 32: nine frequencies of NBS Monograph 140.
"""
import numpy as np
import pytest

import proofmass as pm

pytestmark = pytest.mark.filterwarnings("ignore::proofmass.ProofmassWarning")

NBS14 = [892.0, 809.0, 823.0, 798.0, 671.0, 644.0, 883.0, 903.0, 677.0]


@pytest.mark.parametrize(
    "statistic, first, second",
    [
        ("adev", 91.22945, 115.8082),
        ("oadev", 91.22945, 85.95287),
        ("mdev", 91.22945, 74.78849),
        ("hdev", 70.80607, 116.7980),
        ("ohdev", 70.80607, 85.61487),
    ],
)
def test_deviations_of_nbs14_are_the_published_ones(statistic, first, second):
    curve = pm.allan(NBS14, rate_hz=1, statistic=statistic, taus=[1, 2], stop_ratio=1)
    assert curve.tau_s.tolist() == [1.0, 2.0]
    assert curve.uncorrected == pytest.approx([first, second], rel=1e-6)


def test_phase_of_a_rate_gives_its_deviation():
    y = np.random.default_rng(2).normal(size=4000)
    rate = pm.allan(y, rate_hz=10, taus="octave")
    phase = pm.allan(np.concatenate([[0.0], np.cumsum(y) / 10]), rate_hz=10, taus="octave", data="phase")
    assert phase.deviation == pytest.approx(rate.deviation, rel=1e-9)


def test_limits_enclose_the_deviation_of_white_noise():
    curve = pm.allan(np.random.default_rng(3).normal(size=100_000), rate_hz=1, confidence=0.999)
    true = 1 / np.sqrt(curve.tau_s)
    assert np.mean((curve.lower < true) & (true < curve.upper)) > 0.95
    assert set(curve.alpha[:10]) == {0}


def test_published_deviations_of_phase_dat(recordings):
    found = list((recordings / "allan-reference" / "phasedat").glob("PHASE.DAT"))
    if not found:
        pytest.skip("needs PHASE.DAT")
    phase = np.loadtxt(found[0], comments="#")
    # Stable32's overlapping Allan deviation at τ = 1 s, as in its file of results.
    results = found[0].with_name("phase_dat_oadev_octave.txt")
    if not results.exists():
        pytest.skip("needs Stable32's results")
    table = np.array(
        [[float(word) for word in line.split()] for line in results.read_text().splitlines() if line[:1].isdigit() or line[:1] == " "]
    )
    curve = pm.allan(phase, rate_hz=1, data="phase", taus=[float(tau) for tau in table[:, 1]], stop_ratio=1)
    assert curve.uncorrected == pytest.approx(table[: curve.uncorrected.size, -2], rel=1e-4)
