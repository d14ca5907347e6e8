"""Online estimates from live samples: angle of a wheel, displacement, inclination.

Examples
--------
>>> import numpy as np, proofmass as pm
>>> tilt = pm.live.Tilt({"acc_x": "m/s2", "acc_y": "m/s2", "acc_z": "m/s2"}, rate_hz=100, gravity=9.80665)
>>> for k in range(500):
...     row = tilt.push(k / 100, [0.0, 0.0, 9.80665])
>>> rows = tilt.finish()
>>> tilt.columns["roll"]
'rad'
"""
from __future__ import annotations

import warnings
from types import SimpleNamespace
from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np

from . import _core, _options
from ._arrays import Doubles, as_doubles
from ._core import ArgumentError, Error
from ._run import ProofmassWarning


def _own(given: dict[str, Any]) -> dict[str, Any]:
    """The arguments that correspond to flags."""
    return {k: v for k, v in given.items() if k not in ("self", "channels", "rate_hz", "__class__")}


class _Live:
    _estimate = ""

    def __init__(self, channels: Mapping[str, str], rate_hz: Optional[float], options: dict[str, Any]) -> None:
        units = {"m/s2": "m/s^2"}
        self._names = list(channels)
        head = [(name, units.get(unit, unit)) for name, unit in channels.items()]
        words = ["record", "live", f"--estimate={self._estimate}", *_options.words(options)]
        try:
            self._live = _core.Live(words, head, float(rate_hz or 0.0))
        except Error as error:
            raise _options.in_python(error) from None
        self._warn()

    @property
    def columns(self) -> dict[str, str]:
        """Names and units of the columns that `add` returns beside ``time_s``."""
        return dict(self._live.columns)

    def add(self, time_s: Any, samples: Any) -> dict[str, Doubles]:
        """Process samples of shape (n, channels) at times of shape (n,); returns the rows completed so far."""
        times = as_doubles(time_s, "time_s")
        table = as_doubles(samples, "samples", (2,))
        if table.shape != (times.size, len(self._names)):
            raise ArgumentError(f"samples: expected shape ({times.size}, {len(self._names)}), got {table.shape}")
        rows = self._live.add(times, np.ascontiguousarray(table.T))
        self._warn()
        return self._named(rows)

    def push(self, time_s: float, sample: Sequence[float]) -> Optional[SimpleNamespace]:
        """Process one sample; returns the newest row as an object, or None if no row is complete."""
        rows = self.add(np.array([time_s], dtype=float), np.asarray(sample, dtype=float).reshape(1, -1))
        if rows["time_s"].size == 0:
            return None
        return SimpleNamespace(**{name: float(values[-1]) for name, values in rows.items()})

    def finish(self) -> dict[str, Doubles]:
        """End the run; returns the remaining rows."""
        rows = self._live.finish()
        self._warn()
        return self._named(rows)

    def _named(self, rows: Doubles) -> dict[str, Doubles]:
        return {name: rows[:, k].copy() for k, name in enumerate(["time_s", *self.columns])}

    def _warn(self) -> None:
        for severity, text in self._live.take_notes():
            if severity != "info":
                warnings.warn(text, ProofmassWarning, stacklevel=4)


class Wheel(_Live):
    """Angle and speed of a wheel with one or two accelerometers, sample by sample.

    Parameters
    ----------
    channels : dict of str to str
        Names and units of the samples' columns: {"acc_x": "g", "acc_y": "g"}.
    rate_hz : float, optional
        Sample rate in Hz (default: from the times of the samples).
    lag : float, optional
        Lag of the fixed-lag smoother in seconds.
    axis : str, optional
        Direction of the axle, "z" or "0,0,1".
    radius, bandwidth, sensor, gravity, latitude, height
        As for the flags of ``proofmass record``.
    """

    _estimate = "wheel"

    def __init__(
        self,
        channels: Mapping[str, str],
        *,
        rate_hz: Optional[float] = None,
        lag: Optional[float] = None,
        axis: Union[str, Sequence[float], None] = None,
        radius: Optional[float] = None,
        bandwidth: Optional[float] = None,
        sensor: Optional[str] = None,
        gravity: Optional[float] = None,
        latitude: Optional[float] = None,
        height: Optional[float] = None,
    ) -> None:
        super().__init__(channels, rate_hz, _own(locals()))


class Track(_Live):
    """Displacement along the axis of motion, sample by sample; parameters as for `Wheel`."""

    _estimate = "track"

    def __init__(
        self,
        channels: Mapping[str, str],
        *,
        rate_hz: Optional[float] = None,
        lag: Optional[float] = None,
        axis: Union[str, Sequence[float], None] = None,
        sensor: Optional[str] = None,
    ) -> None:
        super().__init__(channels, rate_hz, _own(locals()))


class Tilt(_Live):
    """Roll and pitch, sample by sample; parameters as for `Wheel`."""

    _estimate = "tilt"

    def __init__(
        self,
        channels: Mapping[str, str],
        *,
        rate_hz: Optional[float] = None,
        lag: Optional[float] = None,
        sensor: Optional[str] = None,
        gravity: Optional[float] = None,
        latitude: Optional[float] = None,
        height: Optional[float] = None,
    ) -> None:
        super().__init__(channels, rate_hz, _own(locals()))
