"""Processor time of numpy for the overlapping Allan deviation at so many tau: the cumulative sum
once, then slices. What noise_bench.cpp compares with.

    numpy_oadev.py SAMPLES TAUS
"""
import sys
import time

import numpy as np

samples, taus = int(sys.argv[1]), int(sys.argv[2])
y = 9.8 + 0.01 * np.random.default_rng(1).normal(size=samples)
factors = np.unique(np.round(np.logspace(0, np.log10(samples / 4), taus)).astype(int))
while len(factors) < taus:  # the shortest fall together
    free = np.setdiff1d(np.arange(1, samples // 4), factors[: taus])[0]
    factors = np.sort(np.append(factors, free))
start = time.process_time()
x = np.concatenate([[0.0], np.cumsum(y - y.mean())])
deviations = []
for m in factors:
    z = x[2 * m:] - 2.0 * x[m:-m] + x[:-2 * m]
    deviations.append(np.sqrt(np.mean(z**2) / 2.0) / m)
print(time.process_time() - start)
