"""What a recording contains."""
from __future__ import annotations

from typing import Any, Optional, Sequence, Union

from ._common_options import with_common_options
from ._progress import Progress
from ._recording import Path, Recording
from ._results import Result
from ._run import options_of, run
from ._sensor import Sensor


@with_common_options
def inspect(
    x: Any,
    /,
    *,
    rate_hz: Optional[float] = None,
    unit: Optional[str] = None,
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
    """Content and quality of a recording.

    Parameters
    ----------
    x : path, Recording, DataFrame, dict of arrays, or array_like (n,) or (n, channels)
        A recording, or several.
    {rate_hz, unit}
    {channel to supply}
    {gravity, latitude, height}
    {progress}

    Examples
    --------
    >>> import proofmass as pm
    >>> found = pm.inspect(pm.simulate(duration=20, rpm=60, seed=1).recording)
    >>> found.samples, found.timing.source, found.channels[0].unit
    (4000, 'given_rate', 'm/s^2')
    """
    return run("inspect", x, options_of(locals()), progress, None)
