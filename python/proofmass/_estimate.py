"""Angle and displacement."""
from __future__ import annotations

from typing import Any, Optional, Sequence, Union

from ._common_options import with_common_options
from ._progress import Progress
from ._recording import Path, Recording
from ._results import Result
from ._run import options_of, run
from ._sensor import Sensor


@with_common_options
def wheel(
    x: Any,
    /,
    *,
    rate_hz: Optional[float] = None,
    unit: Optional[str] = None,
    spin_axis: Union[str, Sequence[float], None] = None,
    radius: Optional[float] = None,
    radius_std: Optional[float] = None,
    bandwidth: Optional[float] = None,
    axle_tilt_std: Optional[float] = None,
    no_gyro: bool = False,
    rate_unit: Optional[str] = None,
    rolling_radius: Optional[float] = None,
    rim_radius: Optional[float] = None,
    encoder: bool = False,
    encoder_channel: Optional[str] = None,
    counts_per_turn: Optional[float] = None,
    wrap: Optional[float] = None,
    index: Optional[str] = None,
    edges: Optional[Path] = None,
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
    """Angle, turns and speed from one or two accelerometers on a wheel.

    Parameters
    ----------
    x : path, Recording, DataFrame, dict of arrays, or array_like (n,) or (n, channels)
        One recording, or one for each of two sensors.
    {rate_hz, unit}
    spin_axis : str or list of float, optional
        x, y, z, -x, -y, -z or "X,Y,Z" in the sensor's axes (default: from the data).
    radius : float, optional
        Distance of the sensor from the axle, if known.
    radius_std : float, optional
        Standard deviation of radius (default: 2 %, at least 0.0002) (needs radius).
    bandwidth : float, optional
        -3 dB bandwidth of the sensor's filter, which delays the angle (default: from the sensor file,
        else assumed between 6 Hz and 2.5 times the rate).
    axle_tilt_std : float, optional
        Standard deviation of the axle's inclination (default 5).
    no_gyro : bool
        Do not use the gyroscope's channels.
    rate_unit : str, optional
        Unit of the gyroscope if its heading has none: rad/s (default) or deg/s.
    rolling_radius : float, optional
        Rolling radius of a vehicle's wheel (0: a bench); corrects the angle for the vehicle's
        acceleration.
    rim_radius : float, optional
        Radius of the rim, whose path length is the distance.
    encoder : bool
        Use the encoder on the axle, recorded in the first file, as a further measurement.
    {encoder_channel to edges}
    since_switch_on : float, optional
        Time between power-on and the file's first sample: corrects the warm-up of the sensor files.
    {channel to supply}
    {gravity, latitude, height}
    {progress}

    Examples
    --------
    >>> import proofmass as pm
    >>> twin = pm.simulate(duration=20, rpm=60, seed=1)
    >>> turns = pm.wheel(twin.recording).turns
    >>> abs(turns.value - twin.truth["angle"][-1] / 6.283185307179586) < 0.02
    True
    """
    return run("wheel", x, options_of(locals()), progress, "wheel.csv")


@with_common_options
def track(
    x: Any,
    /,
    *,
    rate_hz: Optional[float] = None,
    unit: Optional[str] = None,
    model: Optional[str] = None,
    jerk_psd: Optional[float] = None,
    axis: Union[str, Sequence[float], None] = None,
    same_place: bool = False,
    same_place_std: Optional[float] = None,
    fixes: Optional[Path] = None,
    fix_std: Optional[float] = None,
    still: Optional[Path] = None,
    rests: Optional[str] = None,
    turns: Optional[Path] = None,
    shortest_rest: Optional[float] = None,
    rest_speed_std: Optional[float] = None,
    scale_std: Optional[float] = None,
    take_as_acceleration: bool = False,
    no_gyro: bool = False,
    rate_unit: Optional[str] = None,
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
    latitude: Optional[float] = None,
    height: Optional[float] = None,
    gravity: Union[float, str, None] = None,
    progress: Progress = None,
) -> Result:
    """Displacement from acceleration, from rest to rest.

    Parameters
    ----------
    x : path, Recording, DataFrame, dict of arrays, or array_like (n,) or (n, channels)
        A recording.
    {rate_hz, unit}
    model : str, optional
        inertial (default): the acceleration is integrated between stops, for any kind of motion; pva:
        position, velocity and acceleration are states driven by white jerk, with NIS for each sample;
        fused: the same from 2 to 4 accelerometers with parallel axes.
    jerk_psd : float, optional
        Density of that jerk (default: by maximum likelihood).
    axis : str or list of float, optional
        Direction of the displacement: x, y, z, with a sign, or X,Y,Z in the sensor's axes, with a
        gyroscope the world's (default: direction of the largest motion).
    same_place : bool
        The motion ended at its starting point.
    same_place_std : float, optional
        Standard deviation of that (default 0.001) (needs same_place).
    fixes : path, optional
        Known positions: time, position and, if known, std.
    fix_std : float, optional
        Standard deviation of fixes without their own (default 0.01) (needs fixes).
    still : path, optional
        List of static intervals, instead of detection (not with rests).
    rests : str, optional
        Quiet intervals used as rests: found (default: those consistent with the motion), or ends: the
        first and the last only (not with still).
    turns : path, optional
        List of times of reversal: velocity 0.
    shortest_rest : float, optional
        Minimum duration of a rest (default 0.5).
    rest_speed_std : float, optional
        Standard deviation of the speed at rest (default 0.0001).
    scale_std : float, optional
        Relative standard deviation of the scale (default: from the sensor file, or from gravity at
        rest).
    take_as_acceleration : bool
        Integrate even if the data look like jerk.
    no_gyro : bool
        Do not use the gyroscope's channels.
    rate_unit : str, optional
        Unit of the gyroscope if its heading has none: rad/s (default) or deg/s.
    since_switch_on : float, optional
        Time between power-on and the first sample: corrects the warm-up of the sensor file.
    {channel to supply}
    latitude : float, optional
        Latitude from which gravity is computed.
    height : float, optional
        Height above the ellipsoid, for gravity (needs latitude).
    gravity : float or str, optional
        removed or present, if the data do not show it; or local gravity (default 9.80665); may be
        repeated.
    {progress}

    Examples
    --------
    >>> import proofmass as pm
    >>> slide = pm.simulate(procedure="slide", length=0.5, strokes=2, seed=1)
    >>> [round(stroke.length_m, 1) for stroke in pm.track(slide.recording).strokes]
    [0.5, 0.5]
    """
    return run("track", x, options_of(locals()), progress, "track.csv")


@with_common_options
def tilt(
    x: Any,
    /,
    *,
    rate_hz: Optional[float] = None,
    unit: Optional[str] = None,
    base: Optional[str] = None,
    reads: Optional[str] = None,
    gyro: Union[str, Sequence[str], None] = None,
    no_gyro: bool = False,
    rate_unit: Optional[str] = None,
    shortest_rest: Optional[float] = None,
    bias_std: Optional[float] = None,
    gravity_std: Optional[float] = None,
    angle: Union[str, int, None] = None,
    rate_channel: Union[str, int, None] = None,
    angle_unit: Optional[str] = None,
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
    """Roll and pitch from gravity, at rest and on a moving base.

    Parameters
    ----------
    x : path, Recording, DataFrame, dict of arrays, or array_like (n,) or (n, channels)
        A recording.
    {rate_hz, unit}
    base : str, optional
        auto (default; still if it rests nearly throughout), still or moving.
    reads : str, optional
        Output at rest of an axis that points up: +g (default), or -g as on an iPhone.
    gyro : str or list of str, optional
        The gyroscope's channels for x, y and z: three of them (default: found by name and unit).
    no_gyro : bool
        Do not use the gyroscope's channels.
    rate_unit : str, optional
        Unit of the gyroscope if its heading has none: rad/s (default) or deg/s.
    shortest_rest : float, optional
        Minimum duration of a rest (default 0.5).
    bias_std : float, optional
        Standard deviation of the bias of each axis; with a sensor file, of its change since the
        calibration (default: from a prior and the norm of the force at rest).
    gravity_std : float, optional
        Standard deviation of gravity (default: 0 with gravity, 4e-4 with latitude, else 0.015).
    angle : str or int, optional
        Column with an angle instead of accelerations (name, or number from 1).
    rate_channel : str or int, optional
        Column with the gyroscope's rate about the same axis (needs angle).
    angle_unit : str, optional
        Unit of that column if its heading has none: rad (default) or deg (needs angle).
    {channel to supply}
    {gravity, latitude, height}
    {progress}

    Examples
    --------
    >>> import numpy as np, proofmass as pm
    >>> g = np.array([0.0, 9.80665 * np.sin(0.1), 9.80665 * np.cos(0.1)])
    >>> lying = g + np.random.default_rng(3).normal(scale=0.01, size=(2000, 3))
    >>> round(pm.tilt(lying, rate_hz=100, unit="m/s2", gravity=9.80665).roll_rad.value, 3)
    0.1
    """
    return run("tilt", x, options_of(locals()), progress, "tilt.csv")


@with_common_options
def motor(
    x: Any,
    /,
    *,
    rate_hz: Optional[float] = None,
    unit: Optional[str] = None,
    voltage: Optional[str] = None,
    current: Optional[str] = None,
    current_unit: Optional[str] = None,
    no_current: bool = False,
    angle: Optional[str] = None,
    angle_unit: Optional[str] = None,
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
    """Friction, inertia and backlash of a geared DC motor, from voltage, current and its wheel.

    Parameters
    ----------
    x : path, Recording, DataFrame, dict of arrays, or array_like (n,) or (n, channels)
        A recording.
    {rate_hz, unit}
    voltage : str, optional
        Column with the motor's voltage (default: the one named voltage).
    current : str, optional
        Column with its current (default: the one named current, if any).
    current_unit : str, optional
        Unit of the current: A (default) or mA.
    no_current : bool
        Do not use the current (not with current).
    angle : str, optional
        Column with the angle of the load, unwrapped, as an encoder's, instead of accelerometers.
    angle_unit : str, optional
        Unit of that column if its heading has none: rad (default) or deg.
    {channel to supply}
    {gravity, latitude, height}
    {progress}

    Examples
    --------
    >>> import proofmass as pm
    >>> drive = pm.simulate(procedure="motor", seed=1)
    >>> found = {p.name: p for p in pm.motor(drive.recording).parameters}
    >>> round(found["backlash"].value, 3)
    0.012
    """
    return run("motor", x, options_of(locals()), progress, "motor.csv")


@with_common_options
def tune(
    x: Any,
    /,
    *,
    rate_hz: Optional[float] = None,
    unit: Optional[str] = None,
    model: Optional[str] = None,
    fix: Union[str, Sequence[str], None] = None,
    share: Union[str, Sequence[str], None] = None,
    start_at_sensor: bool = False,
    study_step: Optional[float] = None,
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
    """Q, R and the time constant of the bias for a filter, from a recording of its input.

    Parameters
    ----------
    x : path, Recording, DataFrame, dict of arrays, or array_like (n,) or (n, channels)
        A recording.
    {rate_hz, unit}
    model : str, optional
        auto (default; rest if it rests nearly throughout, else pva), rest, rest-markov, pva, pva-bias,
        local-level, local-trend or position.
    fix : str or list of str, optional
        Fix a parameter, NAME=VALUE in SI; may be repeated.
    share : str or list of str, optional
        Estimate one common value of this parameter for all channels; may be repeated.
    start_at_sensor : bool
        Start from the noise of the sensor file instead of the Allan deviation.
    study_step : float, optional
        Time step of the study of gain and covariance (default: the recording's).
    update_sensor : path, optional
        Write white noise and random walk into this sensor file (model rest).
    {channel to supply}
    {gravity, latitude, height}
    {progress}

    Examples
    --------
    >>> import numpy as np, proofmass as pm
    >>> level = np.cumsum(np.random.default_rng(4).normal(scale=0.01, size=4000))
    >>> z = level + np.random.default_rng(5).normal(scale=0.1, size=4000)
    >>> found = pm.tune({"height": z}, rate_hz=1, model="local-level")
    >>> len(found.parameters)
    2
    """
    return run("tune", x, options_of(locals()), progress, "tune.csv")
