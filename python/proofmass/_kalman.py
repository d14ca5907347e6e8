"""Linear Kalman filter and smoothers for models of up to 32 states."""
from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import Doubles, as_doubles
from ._core import ArgumentError
from ._progress import Progress, Shown

if TYPE_CHECKING:
    import pandas

Matrix = Union[ArrayLike, Callable[[float], ArrayLike]]

_NONE = np.zeros(0, dtype=np.int64)


@dataclass(frozen=True)
class Estimate:
    """State estimates at n epochs.

    Attributes
    ----------
    mean : ndarray, shape (n, states)
    cov : ndarray, shape (n, states, states)
    innovation : ndarray, shape (n, channels)
        Measurement minus its prediction from all previous ones; NaN without a measurement.
    innovation_cov : ndarray, shape (n, channels, channels)
    log_likelihood : float
        Log-likelihood of all measurements under the model.
    nis : float
        Sum of the normalised innovations squared: χ² with `readings` degrees of freedom.
    readings : int
        Number of measurements.
    """

    mean: Doubles
    cov: Doubles
    innovation: Doubles
    innovation_cov: Doubles
    log_likelihood: float
    nis: float
    readings: int

    @property
    def std(self) -> Doubles:
        """Standard deviations of the states, shape (n, states)."""
        return np.sqrt(np.diagonal(self.cov, axis1=1, axis2=2))

    def to_pandas(self) -> "pandas.DataFrame":
        """Means and standard deviations, one epoch per row: x0, x0_std, x1 …"""
        import pandas

        std = self.std
        columns = {}
        for i in range(self.mean.shape[1]):
            columns[f"x{i}"], columns[f"x{i}_std"] = self.mean[:, i], std[:, i]
        return pandas.DataFrame(columns)


class KalmanModel:
    """A linear Gaussian model, x[k] = F x[k-1] + B u[k] + w, z[k] = H x[k] + v.

    Parameters
    ----------
    F : array_like, shape (N, N) or (n, N, N), or callable
        State transition: constant, one per epoch (the k-th leads to epoch k; the first is not used),
        or a function of the step in seconds. N is 32 at most.
    H : array_like, shape (N,), (M, N) or (n, M, N)
        Measurement matrix.
    Q : array_like, shape (N, N) or (n, N, N), or callable
        Covariance of w; may be singular.
    R : array_like, scalar, shape (M, M) or (n, M, M)
        Covariance of v.
    B : array_like, shape (N,), (N, U) or (n, N, U), or callable, optional
        Effect of a known input.
    x0 : array_like, shape (N,)
        Prior mean of the state at the first epoch; default 0.
    P0 : array_like, scalar or shape (N, N)
        Prior covariance of the state at the first epoch.

    Raises
    ------
    ArgumentError
        Incompatible shapes; also a ValueError.

    Notes
    -----
    Other packages begin one step earlier, at x[-1], which is equivalent to ``x0 = F x`` and
    ``P0 = F P F.T + Q``. The smoother inverts no state covariance and is exact for time-varying matrices.
    Models with one channel, up to four states and constant matrices use optimised code.

    Examples
    --------
    A random-walk level measured twice, with a missing measurement in between:

    >>> import numpy as np, proofmass as pm
    >>> model = pm.KalmanModel(F=1.0, H=1.0, Q=1.0, R=2.0, P0=2.0)
    >>> model.filter([1.0, np.nan, 2.0]).mean[:, 0]
    array([0.5, 0.5, 1.4])
    >>> model.smooth([1.0, np.nan, 2.0]).mean[:, 0]
    array([0.8, 1.1, 1.4])
    """

    def __init__(
        self,
        F: Matrix,
        H: ArrayLike,
        Q: Matrix,
        R: ArrayLike,
        B: Optional[Matrix] = None,
        *,
        x0: Optional[ArrayLike] = None,
        P0: ArrayLike,
    ) -> None:
        self._prior_cov = _square(P0, "P0")
        self._states = self._prior_cov.shape[0]
        self._H = _matrix(H, "H", None, self._states)
        self._channels = self._H.shape[-2]
        self._R = _matrix(R, "R", self._channels, self._channels)
        self._F = F if callable(F) else _matrix(F, "F", self._states, self._states)
        self._Q = Q if callable(Q) else _matrix(Q, "Q", self._states, self._states)
        self._B = B if callable(B) or B is None else _input_matrix(B, self._states)
        self._prior_mean = np.zeros(self._states) if x0 is None else np.atleast_1d(as_doubles(x0, "x0", (0, 1)))
        if self._prior_mean.shape != (self._states,):
            raise ArgumentError(f"x0: expected shape ({self._states},), got {self._prior_mean.shape}")
        if self._states > _core.most_states:
            raise ArgumentError(f"expected {_core.most_states} states at most, got {self._states}")

    @property
    def states(self) -> int:
        """N."""
        return self._states

    def filter(
        self, z: ArrayLike, *, u: Optional[ArrayLike] = None, dt_s: Optional[ArrayLike] = None, progress: Progress = None
    ) -> Estimate:
        """Estimate of each state from the measurements up to its epoch.

        Parameters
        ----------
        z : array_like, shape (n,) or (n, M)
            Measurements; NaN marks a missing one.
        u : array_like, shape (n,) or (n, U), optional
            Known input of the step that ends at each epoch.
        dt_s : float or array_like, shape (n,), optional
            Length of the step that ends at each epoch, for matrices that are functions of it.

        Examples
        --------
        A position measured at irregular times:

        >>> import numpy as np, proofmass as pm
        >>> model = pm.KalmanModel(F=lambda dt: [[1, dt], [0, 1]], H=[1, 0],
        ...                        Q=lambda dt: 1e-9 * np.eye(2), R=1e-6, P0=100 * np.eye(2))
        >>> found = model.filter([0.0, 1.0, 4.0], dt_s=[0.0, 0.5, 1.5])
        >>> np.round(found.mean[-1], 3)
        array([4., 2.])
        """
        return self._run("filter", 0, z, u, dt_s, progress)

    def smooth(
        self, z: ArrayLike, *, u: Optional[ArrayLike] = None, dt_s: Optional[ArrayLike] = None, progress: Progress = None
    ) -> Estimate:
        """Estimate of each state from all measurements; arguments as for `filter`.

        Examples
        --------
        >>> import proofmass as pm
        >>> pm.KalmanModel(F=1.0, H=1.0, Q=0.0, R=1.0, P0=1e9).smooth([1.0, 2.0, 3.0]).mean[0].round(6)
        array([2.])
        """
        return self._run("smooth", 0, z, u, dt_s, progress)

    def fixed_lag(
        self,
        z: ArrayLike,
        lag: int,
        *,
        u: Optional[ArrayLike] = None,
        dt_s: Optional[ArrayLike] = None,
        progress: Progress = None,
    ) -> Estimate:
        """Estimate of each state from the measurements up to `lag` epochs later; arguments as for `filter`.

        Examples
        --------
        >>> import proofmass as pm
        >>> model = pm.KalmanModel(F=1.0, H=1.0, Q=0.0, R=1.0, P0=1e9)
        >>> model.fixed_lag([1.0, 2.0, 6.0], 1).mean[:, 0].round(6)
        array([1.5, 3. , 3. ])
        """
        if lag < 0:
            raise ArgumentError(f"lag: expected 0 or more epochs, got {lag}")
        return self._run("fixed_lag", lag, z, u, dt_s, progress)

    def loglikelihood(
        self, z: ArrayLike, *, u: Optional[ArrayLike] = None, dt_s: Optional[ArrayLike] = None, progress: Progress = None
    ) -> float:
        """Log-likelihood of the measurements; arguments as for `filter`.

        Examples
        --------
        One measurement of variance 1 + 1:

        >>> import math, proofmass as pm
        >>> model = pm.KalmanModel(F=1.0, H=1.0, Q=0.0, R=1.0, P0=1.0)
        >>> math.isclose(model.loglikelihood([2.0]), -0.5 * (math.log(4 * math.pi) + 2))
        True
        """
        return self.filter(z, u=u, dt_s=dt_s, progress=progress).log_likelihood

    def _run(
        self, name: str, lag: int, z: ArrayLike, u: Optional[ArrayLike], dt_s: Optional[ArrayLike], progress: Progress
    ) -> Estimate:
        readings = _rows(z, "z", self._channels)
        size = readings.shape[0]
        steps = _steps(dt_s, size)
        B = None if self._B is None else self._sequence(self._B, "B", size, steps)
        inputs = 0 if B is None else B[0].shape[-1]
        if (u is None) != (B is None):
            raise ArgumentError("u: an input and B belong together")
        known = np.zeros(0) if u is None else _rows(u, "u", inputs)
        if u is not None and known.shape[0] != size:
            raise ArgumentError(f"u: {known.shape[0]} rows for {size} readings")
        nothing = (np.zeros(0), _NONE)
        model = {
            "states": self._states, "channels": self._channels, "inputs": inputs,
            "F": self._sequence(self._F, "F", size, steps), "Q": self._sequence(self._Q, "Q", size, steps),
            "H": self._sequence(self._H, "H", size, steps), "R": self._sequence(self._R, "R", size, steps),
            "B": nothing if B is None else B, "x": self._prior_mean, "P": self._prior_cov, "z": readings, "u": known,
        }  # fmt: skip
        with Shown(progress) as shown:
            return Estimate(**_core.kalman(model, name, lag, shown))

    def _sequence(
        self, matrix: Any, name: str, size: int, steps: Optional[tuple[Doubles, NDArray[np.int64]]]
    ) -> tuple[Doubles, NDArray[np.int64]]:
        """Distinct matrices, and the index of the one used at each epoch."""
        if callable(matrix):
            if steps is None:
                raise ArgumentError(f"{name} is a function of the step: give dt_s")
            own = [np.atleast_1d(np.asarray(matrix(float(step)), dtype=float)) for step in steps[0]]
            if name == "B":
                own = [one.reshape(self._states, -1) for one in own]
            shape = own[0].shape if name == "B" else (self._states, self._states)
            for one in own:
                if one.shape != shape:
                    raise ArgumentError(f"{name}: expected shape {shape} of the function, got {one.shape}")
            return np.ascontiguousarray(np.stack(own)), steps[1]
        if matrix.ndim == 2:
            return matrix, _NONE
        if matrix.shape[0] != size:
            raise ArgumentError(f"{name}: {matrix.shape[0]} matrices for {size} readings")
        return matrix, np.arange(size, dtype=np.int64)


def _square(values: ArrayLike, name: str) -> Doubles:
    matrix = np.atleast_2d(as_doubles(values, name, (0, 2)))
    if matrix.shape[0] != matrix.shape[1]:
        raise ArgumentError(f"{name}: expected a square matrix, got shape {matrix.shape}")
    return np.ascontiguousarray(matrix)


def _matrix(values: ArrayLike, name: str, rows: Optional[int], columns: int) -> Doubles:
    """Array of shape (rows, columns) or (n, rows, columns)."""
    matrix = as_doubles(values, name, (0, 1, 2, 3))
    if matrix.ndim == 0:
        matrix = matrix.reshape(1, 1)
    if matrix.ndim == 1 and (rows is None or rows == 1):
        matrix = matrix.reshape(1, -1)
    expected = ("M" if rows is None else rows, columns)
    if matrix.ndim < 2 or matrix.shape[-1] != columns or (rows is not None and matrix.shape[-2] != rows):
        raise ArgumentError(f"{name}: expected shape {expected} or (n, …), got {matrix.shape}")
    return np.ascontiguousarray(matrix)


def _input_matrix(values: ArrayLike, states: int) -> Doubles:
    matrix = as_doubles(values, "B", (0, 1, 2, 3))
    if matrix.ndim < 2:
        matrix = matrix.reshape(-1, 1)
    if matrix.shape[-2] != states:
        raise ArgumentError(f"B: expected shape ({states}, U) or (n, …), got {matrix.shape}")
    return np.ascontiguousarray(matrix)


def _rows(values: ArrayLike, name: str, width: int) -> Doubles:
    rows = as_doubles(values, name, (1, 2))
    if rows.ndim == 1 and width == 1:
        rows = rows.reshape(-1, 1)
    if rows.ndim != 2 or rows.shape[1] != width:
        raise ArgumentError(f"{name}: expected shape (n, {width}), got {rows.shape}")
    return rows


def _steps(dt_s: Optional[ArrayLike], size: int) -> Optional[tuple[Doubles, NDArray[np.int64]]]:
    """Distinct steps, and the index of the one used at each epoch."""
    if dt_s is None:
        return None
    steps = np.broadcast_to(as_doubles(dt_s, "dt_s", (0, 1)), (size,)) if np.ndim(dt_s) == 0 else as_doubles(dt_s, "dt_s")
    if steps.shape != (size,) or not np.all(steps >= 0) or not np.all(np.isfinite(steps)):
        raise ArgumentError(f"dt_s: expected {size} finite steps of 0 or more, or one")
    different, which = np.unique(steps, return_inverse=True)
    return different, which.astype(np.int64)
