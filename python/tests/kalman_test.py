"""Filter and smoothers against published numbers and a second computation."""
import csv

import numpy as np
import pytest

import proofmass as pm


def batch(F, H, Q, R, x0, P0, z):
    """All states from all measurements, by batch least squares."""
    n, N = len(z), len(x0)
    information, right = np.zeros((n * N, n * N)), np.zeros(n * N)

    def add(row, cov, target):
        weight = np.linalg.inv(cov)
        information[:] += row.T @ weight @ row
        right[:] += row.T @ weight @ target

    for k in range(n):
        row = np.zeros((N, n * N))
        row[:, k * N : (k + 1) * N] = np.eye(N)
        if k > 0:
            row[:, (k - 1) * N : k * N] = -F[k]
        add(row, P0 if k == 0 else Q[k], x0 if k == 0 else np.zeros(N))
        for i in np.flatnonzero(~np.isnan(z[k])):
            reading = np.zeros((1, n * N))
            reading[0, k * N : (k + 1) * N] = H[k][i]
            add(reading, R[k][i : i + 1, i : i + 1], z[k][i : i + 1])
    cov = np.linalg.inv(information)
    return (cov @ right).reshape(n, N), np.stack([cov[k * N : (k + 1) * N, k * N : (k + 1) * N] for k in range(n)])


def drawn(n, N=4, M=2):
    rng = np.random.default_rng(5)
    F = np.eye(N) + 0.2 * rng.normal(size=(n, N, N))
    root = rng.normal(size=(n, N, N))
    R = np.stack([np.diag(rng.uniform(0.2, 2, size=M)) for _ in range(n)])
    z = rng.normal(size=(n, M))
    z[3, 0], z[5] = np.nan, np.nan
    return F, rng.normal(size=(n, M, N)), 0.1 * root @ root.transpose(0, 2, 1) + 0.01 * np.eye(N), R, z


def test_smoother_of_time_varying_matrices_is_batch_least_squares():
    F, H, Q, R, z = drawn(12)
    x0, P0 = np.arange(4.0), np.diag([1.0, 2.0, 3.0, 4.0])
    mean, cov = batch(F, H, Q, R, x0, P0, z)
    found = pm.KalmanModel(F, H, Q, R, x0=x0, P0=P0).smooth(z)
    assert found.mean == pytest.approx(mean, abs=1e-10)
    assert found.cov == pytest.approx(cov, abs=1e-10)


def test_filter_is_batch_least_squares_of_what_was_read_so_far():
    F, H, Q, R, z = drawn(9)
    model = pm.KalmanModel(F[:7], H[:7], Q[:7], R[:7], P0=np.eye(4))
    mean, cov = batch(F, H, Q, R, np.zeros(4), np.eye(4), z[:7])
    found = model.filter(z[:7])
    assert found.mean[-1] == pytest.approx(mean[-1], abs=1e-10)
    assert found.cov[-1] == pytest.approx(cov[-1], abs=1e-10)


def test_fixed_lag_is_the_smoother_of_what_was_read_by_then():
    z = np.random.default_rng(6).normal(size=40)
    model = pm.KalmanModel([[1, 1], [0, 1]], [1, 0], 0.1 * np.eye(2), 1.0, P0=np.eye(2))
    assert model.fixed_lag(z, 5).mean[10] == pytest.approx(model.smooth(z[:16]).mean[10], abs=1e-12)
    assert model.fixed_lag(z, 100).mean == pytest.approx(model.smooth(z).mean, abs=1e-12)
    assert model.fixed_lag(z, 0).mean == pytest.approx(model.filter(z).mean, abs=1e-12)


def test_log_likelihood_is_that_of_the_readings_together():
    z = np.array([0.3, -1.0, 2.0])
    model = pm.KalmanModel(1.0, 1.0, 0.5, 2.0, P0=3.0)
    level = np.array([[3.0, 3.0, 3.0], [3.0, 3.5, 3.5], [3.0, 3.5, 4.0]])
    S = level + 2.0 * np.eye(3)
    expected = -0.5 * (3 * np.log(2 * np.pi) + np.log(np.linalg.det(S)) + z @ np.linalg.solve(S, z))
    assert model.loglikelihood(z) == pytest.approx(expected, abs=1e-12)


def test_uniform_passes_give_what_one_matrix_an_epoch_gives():
    z = np.random.default_rng(7).normal(size=3000)
    z[500:520] = np.nan
    F, H, Q = np.array([[1, 0.1], [0, 1]]), np.array([[1.0, 0.0]]), np.diag([1e-4, 1e-2])
    fast = pm.KalmanModel(F, H, Q, 0.5, P0=np.eye(2))
    slow = pm.KalmanModel(np.tile(F, (z.size, 1, 1)), H, Q, 0.5, P0=np.eye(2))
    for name in ("filter", "smooth"):
        a, b = getattr(fast, name)(z), getattr(slow, name)(z)
        assert a.mean == pytest.approx(b.mean, abs=1e-9)
        assert a.cov == pytest.approx(b.cov, abs=1e-9)
        assert a.log_likelihood == pytest.approx(b.log_likelihood, rel=1e-10)


def test_input_moves_the_state():
    model = pm.KalmanModel(1.0, 1.0, 0.0, 1e-12, B=2.0, P0=1e-9)
    found = model.filter([np.nan] * 4, u=[9.0, 1.0, 1.0, -3.0])
    assert found.mean[:, 0] == pytest.approx([0.0, 2.0, 4.0, -2.0])


def test_irregular_steps_are_as_matrices_of_each_epoch():
    dt = np.array([0.0, 0.1, 0.3, 0.1, 2.0])
    F = lambda step: np.array([[1, step], [0, 1]])  # noqa: E731
    Q = lambda step: 0.1 * np.array([[step**3 / 3, step**2 / 2], [step**2 / 2, step]])  # noqa: E731
    z = [0.0, 0.2, 0.5, np.nan, 3.0]
    by_step = pm.KalmanModel(F, [1, 0], Q, 0.01, P0=np.eye(2)).smooth(z, dt_s=dt)
    by_matrix = pm.KalmanModel(
        np.stack([F(s) for s in dt]), [1, 0], np.stack([Q(s) for s in dt]), 0.01, P0=np.eye(2)
    ).smooth(z)
    assert np.array_equal(by_step.mean, by_matrix.mean)


def test_thirty_two_states():
    found = pm.KalmanModel(np.eye(32), np.eye(32), np.zeros((32, 32)), np.eye(32), P0=1e6 * np.eye(32)).filter(
        np.tile(np.arange(32.0), (4, 1))
    )
    assert found.mean[-1] == pytest.approx(np.arange(32.0), abs=1e-4)
    with pytest.raises(pm.ArgumentError, match="32 states"):
        pm.KalmanModel(np.eye(33), np.ones(33), np.eye(33), 1.0, P0=np.eye(33))


@pytest.mark.parametrize(
    "wrong, sentence",
    [
        (dict(F=np.eye(3)), "F: expected shape"),
        (dict(H=[1, 0, 0]), "H: expected shape"),
        (dict(R=np.eye(2)), "R: expected shape"),
        (dict(P0=np.ones((2, 3))), "P0: expected a square"),
        (dict(x0=[1, 2, 3]), "x0: expected shape"),
        (dict(F=[["a", "b"], ["c", "d"]]), "F: expected real numbers"),
    ],
)
def test_shapes_that_do_not_fit_are_refused_in_a_sentence(wrong, sentence):
    right = dict(F=np.eye(2), H=[1, 0], Q=np.eye(2), R=1.0, P0=np.eye(2))
    with pytest.raises(pm.ArgumentError, match=sentence):
        pm.KalmanModel(**{**right, **wrong})


def test_readings_that_do_not_fit_are_refused_in_a_sentence():
    model = pm.KalmanModel(np.eye(2), np.eye(2), np.eye(2), np.eye(2), P0=np.eye(2))
    with pytest.raises(pm.ArgumentError, match=r"z: expected shape \(n, 2\)"):
        model.filter(np.zeros(5))
    with pytest.raises(ValueError, match="infinite"):
        model.filter([[np.inf, 0.0]])
    with pytest.raises(pm.DataError, match="positive definite"):
        pm.KalmanModel(1.0, 1.0, 0.0, -2.0, P0=1.0).filter([0.0])


def test_local_level_of_kfas_to_its_digits(recordings):
    """Results of the R package KFAS used in statsmodels' tests; the state after its diffuse first epoch is the prior."""
    path = recordings / "kalman-reference" / "results_exact_initial_local_level_R.csv"
    if not path.exists():
        pytest.skip("needs the published results of the local level")
    table = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            for name, text in row.items():
                table.setdefault(name, []).append(np.nan if text == "NA" else float(text))
    r = {name: np.array(values) for name, values in table.items()}
    # a and P are one row ahead of the innovations.
    rows = np.flatnonzero(~np.isnan(r["v_1"]) & ~np.isnan(r["F_1"]))
    z = (r["a_1"] + r["v_1"])[rows]
    assert z[0] == pytest.approx(10.2394)
    Q = r["sumP"][1] - 1.993  # contribution of the level to the variance after the first, diffuse measurement
    model = pm.KalmanModel(1.0, 1.0, Q, 1.993, x0=[r["a_1"][1]], P0=r["sumP"][1])
    filtered, smoothed = model.filter(z[1:]), model.smooth(z[1:])
    assert filtered.innovation[:, 0] == pytest.approx(r["v_1"][rows][1:], abs=1e-10)
    assert filtered.innovation_cov[:, 0, 0] == pytest.approx(r["F_1"][rows][1:], abs=1e-10)
    assert filtered.mean[:, 0] == pytest.approx(r["att_1"][rows][1:], abs=1e-10)
    assert smoothed.mean[:, 0] == pytest.approx(r["alphahat_1"][rows][1:], abs=1e-10)
    assert smoothed.cov[:, 0, 0] == pytest.approx(r["sumV"][rows][1:], abs=1e-10)


# Innovation and its variance, filtered level and slope, smoothed level and slope and the sum of their covariance matrix:
# results of KFAS, as published with statsmodels (results_exact_initial_local_linear_trend_R.csv), from the third epoch.
KFAS_TREND = np.array([  # fmt: skip
    (7.954723, 30.798, 5.60835701068251, -1.75671757198519, 5.21735755213863, -1.74226662021634, 3.60076175360198),
    (-2.85163943869732, 22.250346743295, 1.25542601501419, -2.91892501722355, 1.59001831093635, -1.1334669932635, 3.44977255623722),
    (2.66349900220936, 20.3194339439886, 0.73875485281549, -1.94280306025839, 1.01474067368523, -0.682526806142577, 3.40417641537387),
    (2.2040482074429, 19.7436685873651, 0.777515102727931, -1.16474757404214, 0.951444257134675, -0.406708844795046, 3.41779499251488),
    (1.38723247131421, 19.5578741215719, 0.858637278359423, -0.681255709019103, 0.962896787447189, -0.249149534786548, 3.51108468447222),
    (0.82261843065968, 19.4963427441272, 0.915908406318996, -0.395782473854191, 0.978264466604951, -0.166397346715046, 3.81786955269073),
    (0.479874067535195, 19.4757829323051, 0.950893423903834, -0.229493137203491, 0.986377631822506, -0.132997822505254, 4.85378169531128),
    (0.278599713299656, 19.4688920344185, 0.971480183483241, -0.132997822505254, 0.971480183483241, -0.132997822505254, 9.22058000043485),
])


def test_local_linear_trend_of_kfas_to_its_digits():
    """After two epochs of a diffuse start the state is known exactly: S. J. Koopman and J. Durbin (2000)."""
    z = np.array([10.2394, 4.2039, 6.123123] + 7 * [1.0])
    noise, level, slope = 1.993, 8.253, 2.334
    P0 = noise * np.array([[5.0, 3.0], [3.0, 2.0]]) + [[2 * level + slope, level + slope], [level + slope, level + 2 * slope]]
    model = pm.KalmanModel([[1.0, 1.0], [0.0, 1.0]], [[1.0, 0.0]], np.diag([level, slope]), noise,
                           x0=[2 * z[1] - z[0], z[1] - z[0]], P0=P0)  # fmt: skip
    filtered, smoothed = model.filter(z[2:]), model.smooth(z[2:])
    assert filtered.innovation[:, 0] == pytest.approx(KFAS_TREND[:, 0], abs=1e-10)
    assert filtered.innovation_cov[:, 0, 0] == pytest.approx(KFAS_TREND[:, 1], abs=1e-10)
    assert filtered.mean == pytest.approx(KFAS_TREND[:, 2:4], abs=1e-10)
    assert smoothed.mean == pytest.approx(KFAS_TREND[:, 4:6], abs=1e-10)
    assert smoothed.cov.sum(axis=(1, 2)) == pytest.approx(KFAS_TREND[:, 6], abs=1e-10)
