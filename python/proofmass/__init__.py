"""Angle and position from accelerometers, with honest error bars.

>>> import numpy as np, proofmass as pm
>>> x = np.random.default_rng(1).normal(scale=0.1, size=20000)
>>> pm.noise(x, rate_hz=100, unit="m/s2").channels[0].white.unit
'm/s^2/sqrt(Hz)'
"""
from . import fleet, live
from ._allan import Deviation, allan
from ._calibrate import calibrate, tumble
from ._characterise import drift, noise
from ._core import ArgumentError, DataError, Error, FileError
from ._core import version as __version__
from ._drive import drive
from ._estimate import motor, tilt, track, tune, wheel
from ._inspect import inspect
from ._kalman import Estimate, KalmanModel
from ._recording import Recording, read
from ._results import Missing, Node, Quantity, Result
from ._run import ProofmassWarning
from ._sensor import Sensor
from ._simulate import Simulated, simulate

__all__ = [
    "ArgumentError", "DataError", "Deviation", "Error", "Estimate", "FileError", "KalmanModel", "Missing", "Node",
    "ProofmassWarning", "Quantity", "Recording", "Result", "Sensor", "Simulated", "allan", "calibrate", "drift", "drive",
    "fleet", "inspect", "live", "motor", "noise", "read", "simulate", "tilt", "track", "tumble", "tune", "wheel", "__version__",
]  # fmt: skip
