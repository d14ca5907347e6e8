"""Documentation of the options, results and exceptions that all verbs for recordings have in common."""
from __future__ import annotations

import textwrap
from typing import Any, Callable, TypeVar

_Function = TypeVar("_Function", bound=Callable[..., Any])

#: Replacements for a line "{name}" in a docstring.
_PARTS = {
    "rate_hz, unit": """rate_hz : float, optional
    Sample rate in Hz, if the file has no time column.
unit : str, optional
    Unit of the accelerometer channels: g, mg, m/s2, V, mV or counts; of gyroscopes: deg/s or rad/s.""",
    "channel to supply": """channel : str or list of str, optional
    Use this channel; may be repeated (default: all).
variable : str or list of str, optional
    Dataset, variable, group, topic or file to read from a file or folder with several; may be
    repeated (default: chosen by size and name).
time : str, optional
    The time column (default: found by name and content).
from_s : float, optional
    Start of the interval to use, in s.
to_s : float, optional
    End of the interval to use, in s.
resample : float, optional
    Resample to a uniform grid of this rate in Hz (default: the samples as recorded).
resample_method : str, optional
    Interpolation of resample: sinc (band-limited), cubic, linear, nearest or mean (default sinc).
skew : float, optional
    Correct a multiplexer skew of this many seconds between successive channels.
sensor : Sensor, path or list of them, optional
    Apply this sensor file's calibration first; once for all sensors or once for each.
supply : float, optional
    Supply voltage in V of a ratiometric sensor, instead of the sensor file's (needs sensor).""",
    "encoder_channel to edges": """encoder_channel : str, optional
    The encoder's counts or angle (default: the channel encoder, counts, ticks or angle).
counts_per_turn : float, optional
    Quadrature counts of one turn of the encoder.
wrap : float, optional
    Number of counts at which the counter wraps, such as 65536 (default: none, or one turn).
index : str, optional
    Channel of the index pulse, where the angle is 0.
edges : path, optional
    File of the encoder's edges: time and count after each, on the clock of x.""",
    "gravity, latitude, height": """gravity : float, optional
    Local gravity in m/s² (default 9.80665; not with latitude).
latitude : float, optional
    Latitude in degrees, from which gravity is computed (not with gravity).
height : float, optional
    Height in m above the ellipsoid (needs latitude).""",
    "progress": """progress : bool or callable of (stage, fraction), optional
    True shows a bar.

Returns
-------
Result
    The members of the document of ``proofmass {verb} --json`` as attributes.

Raises
------
ArgumentError
    An invalid option; also a ValueError.
FileError
    A file that cannot be read; also an OSError.
DataError
    Data that cannot be analysed; also a ValueError.""",
}


def with_common_options(function: _Function) -> _Function:
    """Fills in the parts of the docstring that several functions share."""
    if function.__doc__ is None:  # python -OO
        return function
    for name, text in _PARTS.items():
        text = textwrap.indent(text.replace("{verb}", function.__name__), "    ")
        function.__doc__ = function.__doc__.replace("    {%s}" % name, text)
    return function
