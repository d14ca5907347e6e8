"""Recordings of the digital twin."""
from __future__ import annotations

from typing import Optional

from ._progress import Progress
from ._recording import Path, Recording
from ._results import Result
from ._run import options_of, run
from ._sensor import Sensor


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
