"""Deviations of the Allan family for arrays."""
from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _core, _options
from ._arrays import Doubles, as_doubles
from ._core import Error
from ._progress import Progress, Shown
from ._run import ProofmassWarning

if TYPE_CHECKING:
    import pandas


@dataclass(frozen=True)
class Deviation:
    """A deviation curve; arrays of equal length, ascending in `tau_s`.

    Attributes
    ----------
    statistic : str
    confidence : float
        Confidence level of the limits.
    tau_s, deviation, lower, upper : ndarray
        Averaging time, the deviation in the unit of the samples, and its limits.
    uncorrected : ndarray
        Deviation before the correction for the statistic's bias.
    edf : ndarray
        Equivalent degrees of freedom of the variance.
    alpha : ndarray of int
        Noise type, a spectrum ∝ f^alpha: 2 … -4.
    m, terms : ndarray of int
        Averaging factor, and number of squared differences in a point.
    """

    statistic: str
    confidence: float
    bias_correction: str
    tau_s: Doubles
    deviation: Doubles
    lower: Doubles
    upper: Doubles
    uncorrected: Doubles
    edf: Doubles
    alpha: NDArray[np.int64]
    m: NDArray[np.int64]
    terms: NDArray[np.int64]

    def to_pandas(self) -> "pandas.DataFrame":
        """The points, one per row."""
        import pandas

        columns = ("deviation", "lower", "upper", "edf", "alpha", "m", "terms")
        index = pandas.Index(self.tau_s, name="tau_s")
        return pandas.DataFrame({name: getattr(self, name) for name in columns}, index=index)

    def plot(self, ax: Any = None) -> Any:
        """Plot on logarithmic axes, with limits; returns the axes."""
        import matplotlib.pyplot as plt  # type: ignore[import]

        if ax is None:
            _, ax = plt.subplots()
        (line,) = ax.loglog(self.tau_s, self.deviation, label=self.statistic)
        ax.fill_between(self.tau_s, self.lower, self.upper, alpha=0.25, color=line.get_color(), linewidth=0)
        ax.set_xlabel("averaging time (s)")
        ax.legend()
        return ax


def allan(
    x: Any,
    *,
    rate_hz: float,
    statistic: str = "oadev",
    taus: Union[str, Sequence[float], None] = None,
    data: str = "rate",
    confidence: float = 0.683,
    noise_type: Union[str, int] = "auto",
    stop_ratio: Optional[float] = None,
    exclude_events: bool = False,
    progress: Progress = None,
) -> Deviation:
    """Deviation of the Allan family, with limits, for evenly sampled values.

    Parameters
    ----------
    x : array_like, shape (n,)
        Samples, NaN if missing. Contiguous doubles are not copied.
    rate_hz : float
        Samples per second.
    statistic : str
        oadev, adev, mdev, tdev, hdev, ohdev, totdev, mtotdev, ttotdev, htotdev, theo1 or pdev.
    taus : str or sequence of float, optional
        "octave", "decade", "all", "16-per-decade" (default), or times in seconds.
    data : str
        "rate", the quantity itself, or "phase", its integral over time.
    confidence : float
        Confidence level of the limits.
    noise_type : str or int
        Noise type used for the limits: "auto", "lag1", or the power of f from -4 to 2.
    stop_ratio : float, optional
        Length of the record over the longest averaging time.
    exclude_events : bool
        Exclude outliers, and intervals that span a step.
    progress : bool or callable, optional

    Raises
    ------
    ArgumentError
        An invalid option, or no array of numbers; also a ValueError.
    DataError
        Too few samples, or constant ones; also a ValueError.

    Examples
    --------
    The nine frequencies of W. J. Riley, NIST SP 1065, table 31:

    >>> import proofmass as pm
    >>> y = [892, 809, 823, 798, 671, 644, 883, 903, 677]
    >>> curve = pm.allan(y, rate_hz=1, statistic="adev", taus=[1, 2])
    >>> [round(float(d), 3) for d in curve.deviation]
    [91.229, 115.808]
    """
    series = as_doubles(x, "x")
    options = dict(
        rate_hz=rate_hz, statistic=statistic, taus=taus, data=data, confidence=confidence,
        noise_type=noise_type, stop_ratio=stop_ratio, exclude_events=exclude_events,
    )  # fmt: skip
    try:
        with Shown(progress) as shown:
            found = _core.allan(["noise", "array", *_options.words(options)], series, shown)
    except Error as error:
        raise _options.in_python(error) from None
    for severity, text in found.pop("notes"):
        if severity != "info":
            warnings.warn(text, ProofmassWarning, stacklevel=2)
    return Deviation(**found)
