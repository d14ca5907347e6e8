"""The path of a vehicle, whose recordings have an option each."""
from __future__ import annotations

from typing import Any, Optional, Sequence, Union

from ._common_options import with_common_options
from ._progress import Progress
from ._recording import Path
from ._results import Result
from ._run import options_of, run
from ._sensor import Sensor

_RECORDINGS = ("right", "left", "front", "frame")


@with_common_options
def drive(
    *,
    right: Any = None,
    left: Any = None,
    front: Any = None,
    frame: Any = None,
    gnss: Optional[Path] = None,
    circumference: Union[float, Sequence[float], None] = None,
    circumference_std: Optional[float] = None,
    track: Optional[float] = None,
    track_std: Optional[float] = None,
    wheelbase: Optional[float] = None,
    wheelbase_std: Optional[float] = None,
    counts_per_turn: Optional[float] = None,
    bandwidth: Optional[float] = None,
    no_gyro: bool = False,
    rate_unit: Optional[str] = None,
    geojson: Optional[Path] = None,
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
    """Path of a vehicle from sensors on its wheels, with or without position fixes.

    Parameters
    ----------
    right : path, Recording, or list of them, optional
        Recordings of the wheels on the right.
    left : path, Recording, or list of them, optional
        Recordings of the wheels on the left.
    front : path, Recording, or list of them, optional
        Which of these wheels are on the steered axle (default: determined by the motion).
    frame : path or Recording, optional
        Recording of an inertial sensor on the vehicle's frame.
    gnss : path, optional
        Position fixes: NMEA, or a table with latitude and longitude in degrees.
    circumference : float or list of float, optional
        Rolling circumference: one for all wheels, or one for each, those of right first.
    circumference_std : float, optional
        Its standard deviation (default: 0.3 %) (needs circumference).
    track : float, optional
        Track width: between the wheels of an axle.
    track_std : float, optional
        Its standard deviation (default: 2 %) (needs track).
    wheelbase : float, optional
        Between the axles of a steered vehicle.
    wheelbase_std : float, optional
        Its standard deviation (default: 2 %) (needs wheelbase).
    counts_per_turn : float, optional
        Counts per turn of wheels with an encoder instead of an accelerometer.
    bandwidth : float, optional
        -3 dB bandwidth of the accelerometers' filter.
    no_gyro : bool
        Do not use the gyroscopes' channels.
    rate_unit : str, optional
        Unit of the gyroscopes if their heading has none: rad/s (default) or deg/s.
    geojson : path, optional
        Write the path as GeoJSON; needs gnss.
    {rate_hz, unit}
    {channel to supply}
    {gravity, latitude, height}
    {progress}

    Examples
    --------
    A wheel on one side, with a known circumference: distance, and no heading.

    >>> import proofmass as pm
    >>> wheel = pm.simulate(duration=30, rpm=60, seed=1).recording
    >>> path = pm.drive(right=wheel, channel=["acc1_x", "acc1_y", "acc1_z"], circumference=1.9)
    >>> round(path.distance_m.value), path.heading_change_rad.value is None
    (57, True)
    """
    given = options_of(locals())
    recordings = {name: given.pop(name) for name in _RECORDINGS}
    return run("drive", None, given, progress, "drive.csv", recordings)
