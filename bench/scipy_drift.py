"""Processor time of numpy and scipy for reading a recording at rest and fitting a warm-up to all
samples of each axis by Levenberg and Marquardt's method (curve_fit). What drift_bench.cpp compares
with.

    scipy_drift.py FILE.npy AXES

Column 0 is the time in seconds, the next AXES are fitted. Prints the seconds of reading and of all
the fits.
"""
import os
import sys
import time

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
import numpy as np  # noqa: E402
from scipy.optimize import curve_fit  # noqa: E402


def warm_up(t, a1, tau, a2):
    return a2 - a1 * np.expm1(-t / tau)


def jacobian(t, a1, tau, a2):
    decay = np.exp(-t / tau)
    return np.stack([1.0 - decay, -a1 * t / tau**2 * decay, np.ones_like(t)], axis=1)


start = time.process_time()
table = np.load(sys.argv[1])
read = time.process_time() - start
t = np.ascontiguousarray(table[:, 0])
for axis in range(1, 1 + int(sys.argv[2])):
    y = np.ascontiguousarray(table[:, axis])
    n = max(1, len(y) // 100)
    first, last = y[:n].mean(), y[-n:].mean()
    curve_fit(warm_up, t, y, p0=(last - first, 0.2 * t[-1], first), jac=jacobian, method="lm")
print(read, time.process_time() - start - read)
