"""The verbs of the command as functions; ``tests/options_test.py`` holds their options to its flags."""
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


@with_common_options
def calibrate(
    x: Any,
    /,
    *,
    rate_hz: Optional[float] = None,
    unit: Optional[str] = None,
    rests: Optional[Path] = None,
    rest: Optional[float] = None,
    means: bool = False,
    parameters: Optional[int] = None,
    six_position: bool = False,
    keep_suspects: bool = False,
    validate: Union[str, Sequence[str], None] = None,
    gravity_std: Optional[float] = None,
    orthogonality_std: Optional[float] = None,
    placement_std: Optional[float] = None,
    bias_stability: Optional[float] = None,
    type_b: Union[str, Sequence[str], None] = None,
    monte_carlo: Optional[int] = None,
    supplies: Optional[Sequence[float]] = None,
    gyro: bool = False,
    gyro_file: Optional[Path] = None,
    rate_unit: Optional[str] = None,
    turntable: Union[str, Sequence[str], None] = None,
    encoder: bool = False,
    encoder_channel: Optional[str] = None,
    counts_per_turn: Optional[float] = None,
    wrap: Optional[float] = None,
    index: Optional[str] = None,
    edges: Optional[Path] = None,
    nonlinearity: Optional[float] = None,
    runout: Optional[float] = None,
    radius: Optional[float] = None,
    name: Optional[str] = None,
    serial: Optional[str] = None,
    date: Optional[str] = None,
    temperature: Optional[float] = None,
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
    """Bias, scale and misalignment from rests in several positions.

    Parameters
    ----------
    x : path, Recording, DataFrame, dict of arrays, or array_like (n,) or (n, channels)
        Recordings of a sensor at rest in 9 or more orientations, or tables of means.
    {rate_hz, unit}
    rests : path, optional
        Start and end of each rest, optionally with label and direction (default: detected).
    rest : float, optional
        Minimum duration of a rest (default: 0.5).
    means : bool
        The files are tables of means, one row per position.
    parameters : int, optional
        6: bias and scale; 9: also misalignment; 12: also mounting, from given directions (default: 9,
        or 6 if the positions determine no more).
    six_position : bool
        Assume six exact orientations (the classical method; free orientations are more accurate).
    keep_suspects : bool
        Keep positions that contradict the others in the fit.
    validate : str or list of str, optional
        Independent positions to validate the calibration with.
    gravity_std : float, optional
        Standard deviation of gravity (default: 0 with gravity, 4e-4 with latitude, else 0.015).
    orthogonality_std : float, optional
        Standard deviation of the angles between the axes if they are not fitted (default 0.57).
    placement_std : float, optional
        Standard deviation of the orientations that six_position assumes exact (default 1).
    bias_stability : float, optional
        Standard deviation of the biases between sessions, as drift estimates it from several power-ups
        (default: from the flicker noise and random walk of the file to update, else of the recording).
    type_b : str or list of str, optional
        A contribution to the uncertainty: "ADC reference,scale,0.05 %,uniform"; may be repeated.
    monte_carlo : int, optional
        Monte Carlo draws that check the uncertainties; 0: none (default 200; for the certificate of a report as many
        as JCGM 101's adaptive procedure needs).
    supplies : list of float, optional
        Supply voltage of each file, to estimate its effect.
    gyro : bool
        Calibrate the gyroscope too, by the rotations between the positions.
    gyro_file : path, optional
        Recording of the gyroscope, sampled together with x.
    rate_unit : str, optional
        Unit of the gyroscope where its headings have none: "rad/s" (default), "deg/s", "counts", "V".
    turntable : str or list of str, optional
        A steady rotation, "START,END,DEG_PER_S[,STD]"; may be repeated.
    encoder : bool
        Calibrate the encoder of a wheel by the accelerometers on it, instead of an accelerometer by
        positions.
    encoder_channel : str, optional
        The encoder's counts or angle (default: the channel encoder, counts, ticks or angle).
    counts_per_turn : float, optional
        Quadrature counts of one turn of the encoder.
    wrap : float, optional
        Number of counts at which the counter wraps, such as 65536 (default: none, or one turn).
    index : str, optional
        Channel of the index pulse, where the angle is 0.
    edges : path, optional
        File of the encoder's edges: time and count after each, on the clock of x.
    nonlinearity : float, optional
        Standard deviation of the accelerometers' nonlinearity at 1 g in per cent, with encoder
        (default 0.02).
    runout : float, optional
        Standard deviation of the axle's run-out in m, with encoder (default 3e-5).
    radius : float, optional
        Largest distance of the accelerometers from the axle in m, with encoder (default 0.3).
    name : str, optional
        Name of the sensor, for certificate and sensor file.
    serial : str, optional
        Its serial number.
    date : str, optional
        Date of the measurement, ISO 8601.
    temperature : float, optional
        Temperature of the measurement.
    update_sensor : path, optional
        Write the calibration into this sensor file.
    {channel to supply}
    {gravity, latitude, height}
    {progress}

    Examples
    --------
    >>> import proofmass as pm
    >>> twin = pm.simulate(procedure="multi-position", seed=3)
    >>> found = pm.calibrate(twin.recording, gravity=9.80665, monte_carlo=0)
    >>> len(found.bias), len(found.positions)
    (3, 25)
    """
    return run("calibrate", x, options_of(locals()), progress, "calibrate.csv")


@with_common_options
def tumble(
    x: Any,
    /,
    *,
    rate_hz: Optional[float] = None,
    unit: Optional[str] = None,
    angles: Optional[Sequence[float]] = None,
    rests: Optional[Path] = None,
    angle: Optional[str] = None,
    rest: Optional[float] = None,
    plane: Union[int, Sequence[int], None] = None,
    mount: Union[int, Sequence[int], None] = None,
    input_axis: Optional[str] = None,
    indexing_std: Optional[float] = None,
    drift_std: Optional[float] = None,
    bandwidth: Optional[float] = None,
    gravity_std: Optional[float] = None,
    rotating: bool = False,
    coefficients: Union[str, Sequence[str], None] = None,
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
    """Scale factor, bias and the other coefficients of the model on a turntable, IEEE 1293.

    Parameters
    ----------
    x : path, Recording, DataFrame, dict of arrays, or array_like (n,) or (n, channels)
        Positions (angle and output), or a recording with a rest in each.
    {rate_hz, unit}
    angles : list of float, optional
        Angle of each rest of a recording, in order: "0,90,180,270,0".
    rests : path, optional
        Start and end of each rest, optionally with the table's angle (default: detected).
    angle : str, optional
        Column with the angle (default: found by name and unit).
    rest : float, optional
        Minimum duration of a rest (default: from the recording).
    plane : int or list of int, optional
        Plane in which the file was tumbled; once for all files or once for each.
    mount : int or list of int, optional
        Mounting of the sensor on the table; once for all files or once for each.
    input_axis : str, optional
        The channel whose axis measures g·sin(angle) (default: found from the data).
    indexing_std : float, optional
        Standard deviation of the table's angles (default: 0.5, less if the residuals show it).
    drift_std : float, optional
        Standard deviation of the bias drift about a straight line (default: 0.0057, 1 mg/√3, and a
        quarter of the linear drift; less if repeats show it).
    bandwidth : float, optional
        Bandwidth of the sensor's one-pole filter, with rotating and angle: its delay is removed from
        the misalignment.
    gravity_std : float, optional
        Standard deviation of gravity (default: 0 with gravity, 4e-4 with latitude, else 0.015).
    rotating : bool
        The sensor rotated continuously: scale factor and bias from the turns.
    coefficients : str or list of str, optional
        Fit these coefficients of the whole model equation.
    update_sensor : path, optional
        Write bias and scale into this sensor file.
    {channel to supply}
    {gravity, latitude, height}
    {progress}

    Examples
    --------
    >>> import math, pandas as pd, proofmass as pm
    >>> angles = [0, 90, 180, 270]
    >>> table = pd.DataFrame({"angle (deg)": angles, "x (g)": [0.02 + math.sin(math.radians(a)) for a in angles]})
    >>> found = pm.tumble(table, gravity=9.80665)
    >>> round(found.K0.value / 9.80665, 6)
    0.02
    """
    return run("tumble", x, options_of(locals()), progress, "tumble.csv")


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
        calibration (default: from the norm of the force at rest).
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


class Simulated(Result):
    """A recording of the digital twin with its true values.

    Attributes
    ----------
    recording, truth : Recording
        Simulated measurements, and the true trajectory.
    sensor : Sensor or None
        For a calibration, the true figures of the sensor.
    """

    @property
    def recording(self) -> Recording:
        return Recording(self._given["series"][0][1])

    @property
    def truth(self) -> Recording:
        return Recording(self._given["series"][1][1])

    @property
    def sensor(self) -> Optional[Sensor]:
        for _, text in self._given["texts"]:
            return Sensor(text=text)
        return None


def simulate(
    rig: Optional[Path] = None,
    *,
    seed: Optional[int] = None,
    rpm: Optional[float] = None,
    rate_hz: Optional[float] = None,
    duration: Optional[float] = None,
    gravity: Optional[float] = None,
    datasheet_errors: bool = False,
    adc_bits: Optional[int] = None,
    procedure: Optional[str] = None,
    session: Optional[int] = None,
    positions: Optional[int] = None,
    dwell: Optional[float] = None,
    supply: Optional[float] = None,
    strokes: Optional[int] = None,
    repetitions: Optional[int] = None,
    length: Optional[float] = None,
    stroke_time: Optional[float] = None,
    elevation: Optional[float] = None,
    gravity_removed: bool = False,
    gyro: bool = False,
    signal: Optional[str] = None,
    progress: Progress = None,
) -> Simulated:
    """The rig, a calibration, a slide or the drive as a digital twin.

    Parameters
    ----------
    rig : path, optional
        Description, TOML; the thesis's rig if omitted.
    seed : int, optional
        Same seed, same numbers.
    rpm : float, optional
        Constant speed of rotation.
    rate_hz : float, optional
        Samples per second.
    duration : float, optional
        Length of the recording.
    gravity : float, optional
        Local gravity (default 9.80665).
    datasheet_errors : bool
        Misalignment, cross-axis sensitivity, scale error and nonlinearity within the datasheet's limits.
    adc_bits : int, optional
        Resolution of the converter.
    procedure : str, optional
        Instead of the rig, a calibration (tumble, four-position, six-position or multi-position), a
        slide along a line, or motor: the rig's drive.
    session : int, optional
        Same sensor and table, other noise and placement (needs procedure).
    positions : int, optional
        Positions of tumble (default 24) or multi-position (24) (needs procedure).
    dwell : float, optional
        Time in each position (needs procedure).
    supply : float, optional
        Supply of the ratiometric sensor (default 3.3) (needs procedure).
    strokes : int, optional
        Strokes of a slide, each followed by a rest (default 6) (needs procedure).
    repetitions : int, optional
        Number of times that each stroke of a slide goes there and back (needs procedure).
    length : float, optional
        Length of a slide's stroke (default 0.4) (needs procedure).
    stroke_time : float, optional
        Duration of a slide's stroke (default 1) (needs procedure).
    elevation : float, optional
        Elevation of a slide's line above the horizontal (needs procedure).
    gravity_removed : bool
        Remove gravity from the slide's data, as phones do (needs procedure).
    gyro : bool
        Add channels of angular rate to a slide (needs procedure).
    signal : str, optional
        acceleration (default), voltage or counts (needs procedure).
    progress : bool or callable of (stage, fraction), optional
        True shows a bar.

    Returns
    -------
    Simulated
        With `recording` and `truth`, and the document's members as attributes.

    Raises
    ------
    ArgumentError
        An invalid option; also a ValueError.

    Examples
    --------
    >>> import proofmass as pm
    >>> twin = pm.simulate(duration=20, rpm=60, seed=1)
    >>> twin.recording.channels
    ['acc1_x', 'acc1_y', 'acc1_z', 'acc2_x', 'acc2_y', 'acc2_z']
    """
    found = run("simulate", rig, options_of(locals()), progress, "simulated.csv")
    return Simulated(found._given)
