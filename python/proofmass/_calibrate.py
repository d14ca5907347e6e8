"""Calibration by positions, and of single axes."""
from __future__ import annotations

from typing import Any, Optional, Sequence, Union

from ._common_options import with_common_options
from ._progress import Progress
from ._recording import Path, Recording
from ._results import Result
from ._run import options_of, run
from ._sensor import Sensor


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
    {encoder_channel to edges}
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
