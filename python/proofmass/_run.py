"""Calls of the library's verbs with arguments from Python."""
from __future__ import annotations

import os
import warnings
from typing import Any, Optional

import numpy as np

from . import _core, _options
from ._core import ArgumentError, Error
from ._progress import Progress, Shown
from ._recording import Recording
from ._results import Result
from ._sensor import Sensor


class ProofmassWarning(UserWarning):
    """A warning about the data or a result."""


def run(
    verb: str,
    data: Any,
    options: dict[str, Any],
    progress: Progress,
    output: Optional[str],
    by_option: Optional[dict[str, Any]] = None,
) -> Result:
    """Run a verb on files, recordings, DataFrames or arrays; `by_option` has those that an option takes."""
    sensors: dict[str, str] = {}
    options = {name: _without_sensors(value, sensors) for name, value in options.items()}
    inputs = _inputs(data)
    as_array = any(not isinstance(item, (str, Recording)) for item in inputs)
    given: dict[str, _core.Recording] = {}
    known: dict[int, str] = {}

    def name_of(item: Any) -> str:
        if isinstance(item, str):
            return _options.file_word(item)
        if id(item) not in known:
            recording = item if isinstance(item, Recording) else _made(item, options)
            known[id(item)] = _free_name(_options.file_word(recording.source), given)
            given[known[id(item)]] = recording._handle
        return known[id(item)]

    names = [name_of(item) for item in inputs]
    named = {flag: [name_of(item) for item in _inputs(value)] for flag, value in (by_option or {}).items()}
    if as_array:
        options = {name: value for name, value in options.items() if name not in ("rate_hz", "unit", "time")}
    words = [verb, *names, *_options.words(named), *_options.words(options), *([f"--output={output}"] if output else [])]
    temporary = as_array and not any(isinstance(item, Recording) for item in inputs)
    try:
        with Shown(progress) as shown:
            found = _core.run(words, given, sensors, temporary, verb == "calibrate", shown)
    except Error as error:
        raise _options.in_python(error) from None
    for severity, text in found["notes"]:
        if severity != "info":
            warnings.warn(_options.with_option_names(text), ProofmassWarning, stacklevel=3)
    return Result(found)


def options_of(given: dict[str, Any]) -> dict[str, Any]:
    """The arguments of a function that correspond to flags."""
    return {name: value for name, value in given.items() if name not in ("x", "rig", "progress")}


def _inputs(data: Any) -> list[Any]:
    """Inputs, each a path, a Recording, or data for a recording."""
    if data is None:
        return []
    several = isinstance(data, (list, tuple)) and len(data) > 0 and all(_is_whole(item) for item in data)
    return [_input(item) for item in (data if several else [data])]


def _is_whole(item: Any) -> bool:
    """True if an item of a list is a whole recording, not a sample or column of one."""
    return isinstance(item, (str, os.PathLike, Recording)) or hasattr(item, "columns") or isinstance(item, np.ndarray)


def _input(item: Any) -> Any:
    if isinstance(item, (str, os.PathLike)):
        return os.fspath(item)
    return item


def _made(item: Any, options: dict[str, Any]) -> Recording:
    rate_hz, unit, time = (options.get(name) for name in ("rate_hz", "unit", "time"))
    if hasattr(item, "columns"):
        return Recording.from_pandas(item, rate_hz=rate_hz, time=time, unit=unit, copy=False)
    if time is not None:
        raise ArgumentError("time: an array has no named columns: give rate_hz, or a Recording")
    return Recording.from_arrays(item, rate_hz=rate_hz, unit=unit, copy=False)


def _free_name(name: str, taken: dict[str, Any]) -> str:
    free, number = name, 2
    while free in taken:
        free, number = f"{name} ({number})", number + 1
    return free


def _without_sensors(value: Any, texts: dict[str, str]) -> Any:
    """Replace sensors by file names; their text goes into `texts`."""
    if isinstance(value, Sensor):
        texts[value.name] = value.text
        return value.name
    if isinstance(value, (list, tuple)):
        return [_without_sensors(item, texts) for item in value]
    return value
