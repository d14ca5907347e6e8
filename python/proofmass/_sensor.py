"""The sensor file: calibration, noise and drift of a sensor."""
from __future__ import annotations

import os
from typing import Any, Optional, Union

from . import _core


class Sensor:
    """A sensor file's contents: calibration, noise and drift of a sensor, with standard deviations.

    Parameters
    ----------
    path : path, optional
        File to read, or alternatively
    text : str, optional
        its text, TOML.

    Attributes
    ----------
    name : str
        Name used in errors.
    text : str
        Text of the file as Proofmass writes it.

    Raises
    ------
    FileError
        A file that does not exist or is not a sensor file; also an OSError.

    Examples
    --------
    >>> import proofmass as pm
    >>> sensor = pm.Sensor(text='[sensor]\\nname = "left"\\n')
    >>> "left" in sensor.text
    True
    """

    def __init__(self, path: Union[str, "os.PathLike[str]", None] = None, *, text: Optional[str] = None) -> None:
        if (path is None) == (text is None):
            raise TypeError("expected a path or a text")
        if path is not None:
            self.name = os.fspath(path)
            self.text = _core.sensor_text_of_file(self.name)
        else:
            self.name = "sensor"
            self.text = _core.sensor_text(str(text), self.name)

    def write(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Write the file atomically. Raises FileError."""
        _core.write_sensor(self.text, os.fspath(path))

    def __repr__(self) -> str:
        return f"<Sensor {self.name}>"

    def __reduce__(self) -> Any:
        return (_sensor_of, (self.name, self.text))


def _sensor_of(name: str, text: str) -> Sensor:
    sensor = Sensor(text=text)
    sensor.name = name
    return sensor
