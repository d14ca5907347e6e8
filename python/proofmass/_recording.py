"""Recordings: equally long channels on one time base."""
from __future__ import annotations

import math
import os
import re
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, Union

import numpy as np

from . import _core, _options
from ._arrays import Doubles, as_doubles
from ._core import ArgumentError, Error
from ._progress import Progress, Shown

if TYPE_CHECKING:
    import pandas

Path = Union[str, "os.PathLike[str]"]


def read(
    path: Path,
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
    progress: Progress = None,
) -> "Recording":
    """Read a recording in any supported format.

    Parameters
    ----------
    path : path
        CSV, npy, npz, MAT, HDF5, TDMS, LVM, MCAP, WAV, Parquet …, plain or compressed; recognised by
        content.
    rate_hz : float, optional
        Sample rate, if the file has no time column.
    unit : str, optional
        Unit of the accelerometer channels: "g", "mg", "m/s2", "V", "mV" or "counts".
    channel : str or list of str, optional
        Use these channels only.
    variable : str or list of str, optional
        Table to read from a file with several.
    time : str, optional
        Name of the time column; by default found by name and content.
    from_s, to_s : float, optional
        Start and end of the interval to use, in seconds.
    resample, resample_method, skew
        As for the flags of the command.

    Raises
    ------
    FileError
        A file that does not exist or cannot be read; also an OSError.
    ArgumentError
        A channel that does not exist; also a ValueError.

    Examples
    --------
    >>> import proofmass as pm, numpy as np, tempfile, os
    >>> path = os.path.join(tempfile.mkdtemp(), "x.npy")
    >>> np.save(path, np.array([0.0, 1.0, 0.5, 0.25]))
    >>> pm.read(path, rate_hz=2, unit="m/s2").duration_s
    1.5
    """
    options = {k: v for k, v in locals().items() if k not in ("path", "progress")}
    arguments = ["inspect", _options.file_word(os.fspath(path)), *_options.words(options)]
    try:
        with Shown(progress) as shown:
            return Recording(_core.read(arguments, shown))
    except Error as error:
        raise _options.in_python(error) from None


class Recording:
    """Channels of equal length on one time base, from `read` or the constructors below.

    Arrays taken from it are read-only views of its memory, which they keep alive.

    Attributes
    ----------
    source, format : str
        Origin of the data.
    samples : int
    rate_hz : float
        Nominal sample rate; 0 if unknown.
    duration_s : float
    channels : list of str
    units : dict of str to str
        Unit of each channel as recorded; "" if unknown.
    time_s : ndarray, shape (samples,)
        Seconds since the first sample.
    notes : list of (str, str)
        Findings of the reader, each with "info", "warning" or "bad".

    Examples
    --------
    >>> import proofmass as pm
    >>> rec = pm.Recording.from_arrays({"acc_x": [0.0, 1.0, 0.0, -1.0]}, rate_hz=2, unit="m/s2")
    >>> rec["acc_x"]
    array([ 0.,  1.,  0., -1.])
    >>> rec[0.5:1.5].samples
    2
    """

    def __init__(self, handle: _core.Recording) -> None:
        self._handle = handle

    @classmethod
    def from_arrays(
        cls,
        arrays: Any,
        *,
        rate_hz: Optional[float] = None,
        time_s: Any = None,
        unit: Optional[str] = None,
        units: Optional[Mapping[str, str]] = None,
        names: Optional[Sequence[str]] = None,
        source: str = "array",
        start_ns: Optional[int] = None,
        copy: bool = True,
    ) -> "Recording":
        """Make a recording from arrays.

        Parameters
        ----------
        arrays : array_like of shape (n,) or (n, channels), or dict of name to array of shape (n,)
            Default names are x for one channel, and x, y and z for up to three.
        rate_hz : float, optional
            Sample rate, or alternatively
        time_s : array_like of shape (n,), optional
            time of each sample.
        unit : str, optional
            Unit of the accelerometer channels; by default inferred from the magnitude of gravity.
        units : dict of str to str, optional
            Units of single channels, which override `unit`: {"gyro_z": "deg/s"}.
        names : sequence of str, optional
            Names of the columns.
        source : str
            Name used in errors and documents.
        start_ns : int, optional
            Absolute time of the first sample.
        copy : bool
            False: use the memory of contiguous arrays of doubles, which must not change as long as
            the recording is used. The analyses do so with arrays that are passed to them.

        Raises
        ------
        ArgumentError
            Arrays that are not numeric or differ in length; times that do not increase.

        Examples
        --------
        >>> import numpy as np, proofmass as pm
        >>> pm.Recording.from_arrays(np.zeros((5, 3)), rate_hz=10, unit="g").channels
        ['x', 'y', 'z']
        """
        columns = _columns(arrays, names)
        known = dict(units or {})
        for name in known:
            if name not in columns:
                raise ArgumentError(f"units: no channel {name}; there are {', '.join(columns)}")
        times: Optional[Doubles] = None
        if time_s is not None:
            times = as_doubles(time_s, "time_s")
            if not np.all(np.isfinite(times)):
                raise ArgumentError("time_s: expected finite times, got NaN or infinity")
            times = times - times[0]
        table = [(name, known.get(name, ""), values) for name, values in columns.items()]
        arguments = ["inspect", "arrays", *_options.words({"rate_hz": rate_hz, "unit": unit})]
        try:
            return cls(_core.of_arrays(source, table, times, start_ns, arguments, copy))
        except Error as error:
            raise _options.in_python(error) from None

    @classmethod
    def from_pandas(
        cls,
        frame: "pandas.DataFrame",
        *,
        rate_hz: Optional[float] = None,
        time: Optional[str] = None,
        unit: Optional[str] = None,
        source: str = "DataFrame",
        copy: bool = True,
    ) -> "Recording":
        """Make a recording from the numeric columns of a DataFrame.

        The time is the column `time`, or one named time, time_s or t, or an index of dates or durations
        or with such a name; otherwise `rate_hz` is required. A unit may follow a column's name,
        "acc_x (m/s^2)", or be given in ``frame.attrs["units"]``. `copy` as in `from_arrays`.

        Examples
        --------
        >>> import pandas as pd, proofmass as pm
        >>> frame = pd.DataFrame({"time (s)": [0.0, 0.1, 0.2], "acc_x (g)": [1.0, 1.0, 1.1]})
        >>> rec = pm.Recording.from_pandas(frame)
        >>> rec.rate_hz, rec.units
        (10.0, {'acc_x': 'g'})
        """
        times, start_ns, left = _times_of(frame, time if rate_hz is None else None)
        if rate_hz is not None:
            times = None
        columns: dict[str, Any] = {}
        units: dict[str, str] = dict(frame.attrs.get("units", {}))
        for label in left:
            name, own_unit = _split(str(label))
            if frame[label].dtype.kind not in "fiuO" or _holds_words(frame[label]):
                continue
            if name in columns:
                raise ArgumentError(f"two columns are called {name}")
            columns[name] = frame[label]
            if own_unit:
                units[name] = own_unit
        if not columns:
            raise ArgumentError(f"{source}: has no column of numbers beside the time")
        units = {name: text for name, text in units.items() if name in columns and text}
        return cls.from_arrays(
            columns,
            rate_hz=rate_hz,
            time_s=times,
            unit=unit,
            units=units,
            source=source,
            start_ns=start_ns,
            copy=copy,
        )

    @property
    def source(self) -> str:
        return self._handle.source

    @property
    def format(self) -> str:
        return self._handle.format

    @property
    def samples(self) -> int:
        return self._handle.samples

    @property
    def rate_hz(self) -> float:
        return self._handle.rate_hz

    @property
    def duration_s(self) -> float:
        return self._handle.duration_s

    @property
    def channels(self) -> list[str]:
        return self._handle.channels

    @property
    def units(self) -> dict[str, str]:
        return dict(zip(self._handle.channels, self._handle.units))

    @property
    def time_s(self) -> Doubles:
        return self._handle.time_s()

    @property
    def notes(self) -> list[tuple[str, str]]:
        return [(severity, _options.with_option_names(text)) for severity, text in self._handle.notes]

    @property
    def labels(self) -> list[tuple[str, int, int]]:
        """Labels, each with its first and last sample."""
        return self._handle.labels

    def __len__(self) -> int:
        return self.samples

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and self._handle.channel(name) is not None

    def __getitem__(self, key: Any) -> Any:
        """A channel by name; several as an array (n, k); or an interval of time, ``rec[10.0:20.0]``."""
        if isinstance(key, str):
            return self._channel(key)
        if isinstance(key, (list, tuple)):
            return np.column_stack([self._channel(name) for name in key])
        if not isinstance(key, slice):
            raise TypeError("expected a channel's name, a list of them, or a slice of seconds")
        if key.step is not None:
            raise ArgumentError("a slice of seconds has no step: resample where it is read")
        return Recording(
            self._handle.cut(
                -math.inf if key.start is None else float(key.start), math.inf if key.stop is None else float(key.stop)
            )
        )

    def _channel(self, name: str) -> Doubles:
        found = self._handle.channel(name)
        if found is None:
            raise KeyError(f"no channel {name}; there are {', '.join(self.channels)}")
        return found

    def to_pandas(self) -> "pandas.DataFrame":
        """The channels indexed by seconds, with the units in ``frame.attrs["units"]``.

        Examples
        --------
        >>> import proofmass as pm
        >>> rec = pm.Recording.from_arrays({"acc_x": [1.0, 2.0]}, rate_hz=10, unit="g")
        >>> rec.to_pandas().loc[0.1, "acc_x"]
        2.0
        """
        import pandas

        index = pandas.Index(self.time_s, name="time_s")
        frame = pandas.DataFrame({name: self._channel(name) for name in self.channels}, index=index)
        frame.attrs["units"] = self.units
        return frame

    def inspect(self, **options: Any) -> Any:
        """Content and quality of the recording: ``proofmass.inspect``."""
        from ._inspect import inspect

        return inspect(self, **options)

    def plot(self, ax: Any = None) -> Any:
        """Plot the channels against time with matplotlib; returns the axes."""
        import matplotlib.pyplot as plt  # type: ignore[import]

        if ax is None:
            _, ax = plt.subplots()
        for name in self.channels:
            unit = self.units[name]
            ax.plot(self.time_s, self._channel(name), label=f"{name} ({unit})" if unit else name)
        ax.set_xlabel("time (s)")
        ax.legend()
        return ax

    def __repr__(self) -> str:
        shown = ", ".join(self.channels[:6]) + (", …" if len(self.channels) > 6 else "")
        return f"<Recording {self.source}: {self.samples} samples at {self.rate_hz:.6g} Hz of {shown}>"

    def __reduce__(self) -> Any:
        return (Recording, (self._handle,))


def _columns(arrays: Any, names: Optional[Sequence[str]]) -> dict[str, Doubles]:
    if isinstance(arrays, Mapping):
        if names is not None:
            raise ArgumentError("names: the dict has names already")
        return {str(name): as_doubles(values, str(name)) for name, values in arrays.items()}
    table = as_doubles(arrays, "array", ndim=(1, 2))
    if table.ndim == 1:
        table = table[:, np.newaxis]
    width = table.shape[1]
    if names is None:
        names = ["x", "y", "z"][:width] if width <= 3 else [f"c{k + 1}" for k in range(width)]
    if len(names) != width:
        raise ArgumentError(f"names: {len(names)} for {width} columns: expected one for each")
    return {name: np.ascontiguousarray(table[:, k]) for k, name in enumerate(names)}


def _split(label: str) -> tuple[str, str]:
    """Split a column's label into its name and a unit in brackets, if any."""
    match = re.fullmatch(r"\s*(.*?)\s*[(\[]([^()\[\]]+)[)\]]\s*", label)
    if match and match[1] and _core.is_unit(match[2]):
        return match[1], match[2]
    return label.strip(), ""


def _holds_words(column: Any) -> bool:
    return column.dtype.kind == "O" and any(isinstance(value, (str, bytes)) for value in column)


def _times_of(frame: Any, time: Optional[str]) -> tuple[Optional[Doubles], Optional[int], list[Any]]:
    """Seconds since the first row, its absolute time, and the remaining columns."""
    labels = list(frame.columns)
    if time is not None and time not in labels and time != frame.index.name:
        raise ArgumentError(f"time: no column {time}; there are {', '.join(map(str, labels))}")
    for label in labels:
        if label == time or (time is None and _split(str(label))[0].lower() in ("time", "time_s", "t")):
            seconds, start = _seconds(frame[label], _split(str(label))[1])
            return seconds, start, [other for other in labels if other != label]
    index = frame.index
    is_time = index.dtype.kind in "mM" or str(index.name).lower() in ("time", "time_s", "t") or index.name == time
    if index.name is None and index.dtype.kind not in "mM":
        is_time = False
    if is_time:
        seconds, start = _seconds(index, "")
        return seconds, start, labels
    return None, None, labels


def _seconds(column: Any, unit: str) -> tuple[Doubles, Optional[int]]:
    if column.dtype.kind in "mM" or hasattr(column.dtype, "tz"):
        stamps = np.asarray(column, dtype="datetime64[ns]" if column.dtype.kind != "m" else "timedelta64[ns]")
        ns = stamps.astype(np.int64)
        return (ns - ns[0]) * 1e-9, int(ns[0])
    scale = {"": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}.get(unit)
    if scale is None:
        raise ArgumentError(f"time: its unit is {unit}: expected s, ms, us or ns")
    return as_doubles(column, "time") * scale, None
