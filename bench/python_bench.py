#!/usr/bin/env python3
"""Times the Python module against plain NumPy.

    PYTHONPATH=build/release/python /usr/bin/python3 bench/python_bench.py [--samples N]

Of the slow NumPy filter and smoother only a part is run, and its time scaled to the record's length.
"""
import argparse
import resource
import time

import numpy as np

import proofmass as pm


def timed(work, runs=1):
    """The shortest of some runs, and the result of the last."""
    seconds = []
    for _ in range(runs):
        found = None  # its memory is that of the next run
        begun = time.perf_counter()
        found = work()
        seconds.append(time.perf_counter() - begun)
    return min(seconds), found


def peak_mb():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def numpy_oadev(x, rate_hz, factors):
    """The loop that people write: overlapping deviation by second differences of the phase."""
    phase = np.concatenate([[0.0], np.cumsum(x)]) / rate_hz
    out = []
    for m in factors:
        difference = phase[2 * m :] - 2 * phase[m:-m] + phase[: -2 * m]
        out.append(np.sqrt(0.5 * np.mean(difference**2)) / (m / rate_hz))
    return np.array(out)


def numpy_smoother(F, H, Q, R, x, P, z):
    n, N = z.size, x.size
    means, covs, ahead, ahead_covs = np.empty((n, N)), np.empty((n, N, N)), np.empty((n, N)), np.empty((n, N, N))
    for k in range(n):
        if k > 0:
            x, P = F @ x, F @ P @ F.T + Q
        ahead[k], ahead_covs[k] = x, P
        S = H @ P @ H.T + R
        K = P @ H.T @ np.linalg.inv(S)
        x = x + K @ (z[k] - H @ x)
        P = P - K @ H @ P
        means[k], covs[k] = x, P
    for k in range(n - 2, -1, -1):
        G = covs[k] @ F.T @ np.linalg.inv(ahead_covs[k + 1])
        means[k] += G @ (means[k + 1] - ahead[k + 1])
        covs[k] += G @ (covs[k + 1] - ahead_covs[k + 1]) @ G.T
    return means, covs


def bench_noise(samples):
    x = np.random.default_rng(1).normal(size=samples)
    before = peak_mb()
    allan_s, curve = timed(lambda: pm.allan(x, rate_hz=1000), 3)
    allan_mb = peak_mb() - before
    before = peak_mb()
    noise_s, _ = timed(lambda: pm.noise(x, rate_hz=1000, unit="m/s2"), 3)
    noise_mb = peak_mb() - before
    numpy_s, plain = timed(lambda: numpy_oadev(x, 1000, curve.m))
    size_mb = x.nbytes / 2**20
    print(f"{samples} samples ({size_mb:.0f} MiB), {curve.m.size} averaging times; largest difference from NumPy "
          f"{np.max(np.abs(curve.uncorrected / plain - 1)):.1e}")  # fmt: skip
    print(f"  NumPy's loop  {numpy_s:7.2f} s")
    print(f"  pm.allan      {allan_s:7.2f} s  {numpy_s / allan_s:6.1f} x  {allan_mb:5.0f} MiB more at the peak")
    print(f"  pm.noise      {noise_s:7.2f} s  {numpy_s / noise_s:6.1f} x  {noise_mb:5.0f} MiB more beyond that")


def bench_smoother(samples):
    dt = 0.01
    F = np.array([[1, dt, dt**2 / 2, 0], [0, 1, dt, 0], [0, 0, 1, 0], [0, 0, 0, 1.0]])
    H, Q, R = np.array([[0, 0, 1.0, 1.0]]), np.diag([1e-9, 1e-7, 1e-4, 1e-8]), np.array([[0.04]])
    z = np.random.default_rng(2).normal(size=samples)
    model = pm.KalmanModel(F, H, Q, R, P0=np.eye(4))
    ours_s, _ = timed(lambda: model.smooth(z), 5)
    part = min(samples, 5000)
    numpy_s, (means, _) = timed(lambda: numpy_smoother(F, H, Q, R, np.zeros(4), np.eye(4), z[:part]))
    same = model.smooth(z[:part]).mean
    numpy_s *= samples / part
    print(f"{samples} samples, 4 states, every covariance; largest difference from NumPy {np.max(np.abs(same - means)):.1e}")
    print(f"  NumPy         {numpy_s:7.1f} s (of {part} samples, scaled)")
    print(f"  KalmanModel   {ours_s:7.3f} s  {numpy_s / ours_s:6.0f} x")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=7_200_000)
    samples = parser.parse_args().samples
    bench_noise(samples)
    bench_smoother(min(samples, 1_000_000))
