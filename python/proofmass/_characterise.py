"""Noise and drift."""
from __future__ import annotations

from typing import Any, Optional, Sequence, Union

from ._common_options import with_common_options
from ._progress import Progress
from ._recording import Path, Recording
from ._results import Result
from ._run import options_of, run
from ._sensor import Sensor


@with_common_options
def noise(
    x: Any,
    /,
    *,
    rate_hz: Optional[float] = None,
    unit: Optional[str] = None,
    statistic: Optional[str] = None,
    taus: Union[str, Sequence[float], None] = None,
    stop_ratio: Optional[float] = None,
    data: Optional[str] = None,
    confidence: Optional[float] = None,
    noise_type: Union[str, int, None] = None,
    exclude_events: bool = False,
    as_one: bool = False,
    starts: Optional[Sequence[float]] = None,
    temperature: Optional[str] = None,
    update_sensor: Optional[Path] = None,
    channel: Union[str, Sequence[str], None] = None,
    variable: Union[str, Sequence[str], None] = None,
    time: Optional[str] = None,
    from_s: Optional[float] = None,
    to_s: Optional[float] = None,
    resample: Optional[float] = None,
    resample_method: Optional[str] = None,
    skew: Optional[float] = None,
    sensor: Union[Sensor, Path, Sequence[Union[Sensor, Path]], None] = None,
    supply: Optional[float] = None,
    gravity: Optional[float] = None,
    latitude: Optional[float] = None,
    height: Optional[float] = None,
    progress: Progress = None,
) -> Result:
    """Allan deviation, spectrum and noise figures of a sensor at rest.

    Parameters
    ----------
    x : path, Recording, DataFrame, dict of arrays, or array_like (n,) or (n, channels)
        Recordings at rest.
    {rate_hz, unit}
    statistic : str, optional
        oadev (default), adev, mdev, tdev, hdev, ohdev, totdev, mtotdev, ttotdev, htotdev, theo1 or
        pdev.
    taus : str or list of float, optional
        octave, decade, all, N-per-decade (default 16) or seconds "1,2,10".
    stop_ratio : float, optional
        Length of the recording over the longest averaging time (default: the statistic's).
    data : str, optional
        rate (default), or phase, its integral over time.
    confidence : float, optional
        Confidence level of the deviation's limits (default 0.683).
    noise_type : str or int, optional
        Noise type used for the limits: auto (default), lag1, or the power of f from -4 to 2.
    exclude_events : bool
        Exclude outliers, and intervals that span a step.
    as_one : bool
        Analyse the recordings as one with gaps between them.
    starts : list of float, optional
        Start of each recording in seconds, with as_one (default: from the recordings' clocks).
    temperature : str, optional
        Remove the linear dependence on this channel, by least squares.
    update_sensor : path, optional
        Write the figures into this sensor file.
    {channel to supply}
    {gravity, latitude, height}
    {progress}

    Examples
    --------
    >>> import numpy as np, proofmass as pm
    >>> x = np.random.default_rng(1).normal(scale=0.1, size=20000)
    >>> white = pm.noise(x, rate_hz=100, unit="m/s2").channels[0].white
    >>> white.verdict, abs(white.value - 0.01) < 4 * white.std
    ('identified', True)
    """
    return run("noise", x, options_of(locals()), progress, "noise.csv")


@with_common_options
def drift(
    x: Any,
    /,
    *,
    rate_hz: Optional[float] = None,
    unit: Optional[str] = None,
    forecast: Optional[float] = None,
    temperature: Optional[str] = None,
    order: Optional[str] = None,
    update_sensor: Optional[Path] = None,
    since_switch_on: Optional[float] = None,
    channel: Union[str, Sequence[str], None] = None,
    variable: Union[str, Sequence[str], None] = None,
    time: Optional[str] = None,
    from_s: Optional[float] = None,
    to_s: Optional[float] = None,
    resample: Optional[float] = None,
    resample_method: Optional[str] = None,
    skew: Optional[float] = None,
    sensor: Union[Sensor, Path, Sequence[Union[Sensor, Path]], None] = None,
    supply: Optional[float] = None,
    gravity: Optional[float] = None,
    latitude: Optional[float] = None,
    height: Optional[float] = None,
    progress: Progress = None,
) -> Result:
    """Warm-up of the bias of a sensor at rest, and whether the recording determines it.

    Parameters
    ----------
    x : path, Recording, DataFrame, dict of arrays, or array_like (n,) or (n, channels)
        Recordings at rest from power-on; three or more are compared.
    {rate_hz, unit}
    forecast : float, optional
        Predict the bias this many seconds after power-on.
    temperature : str, optional
        Fit the bias against this channel (default: the only one in a unit of temperature), or none.
    order : str, optional
        Order of three or more files: time (default; by their absolute time stamps, else by the numbers
        in their names) or given (as in the call).
    update_sensor : path, optional
        Write the identified coefficients into this sensor file.
    since_switch_on : float, optional
        Time between power-on and the first sample (default 0).
    {channel to supply}
    {gravity, latitude, height}
    {progress}

    Examples
    --------
    >>> import numpy as np, proofmass as pm
    >>> t = np.arange(36000) / 10
    >>> x = 0.05 * (1 - np.exp(-t / 300)) + np.random.default_rng(2).normal(scale=0.002, size=t.size)
    >>> found = pm.drift(x, rate_hz=10, unit="m/s2").channels[0]
    >>> found.verdict, abs(found.time_constant_s.value - 300) < 4 * found.time_constant_s.std
    ('identified', True)
    """
    return run("drift", x, options_of(locals()), progress, "drift.csv")
