"""Conversion of function options to flags of the command, which checks them."""
from __future__ import annotations

import os
import re
from typing import Any

import numpy as np

from ._core import Error

#: Options whose flag is not a Python name, or lacks the unit.
NAMES = {"rate_hz": "rate", "from_s": "from", "to_s": "to"}
_FLAGS = {flag: name for name, flag in NAMES.items()}

#: Flags that take a list in one value; others are repeated.
_JOINED = {"taus", "starts", "supplies", "angles", "coefficients", "spin_axis", "axis"}


def words(options: dict[str, Any]) -> list[str]:
    """["--rate=100", "--no-gyro"] of {"rate_hz": 100, "no_gyro": True, "unit": None}."""
    out: list[str] = []
    for name, value in options.items():
        flag = "--" + NAMES.get(name, name).replace("_", "-")
        if value is None or value is False:
            continue
        if value is True:
            out.append(flag)
        elif isinstance(value, (list, tuple, np.ndarray)):
            texts = [_text(name, item) for item in value]
            out += [f"{flag}={','.join(texts)}"] if name in _JOINED else [f"{flag}={text}" for text in texts]
        else:
            out.append(f"{flag}={_text(name, value)}")
    return out


def file_word(path: str) -> str:
    """A path in a form that cannot be mistaken for a flag."""
    return "./" + path if path.startswith("-") else path


def in_python(error: Error) -> Error:
    """The same error, with names of options instead of flags."""
    return type(error)(with_option_names(str(error)))


def with_option_names(text: str) -> str:
    """A message of the command, with names of options instead of flags.

    >>> with_option_names("which is gravity in g (use --unit g or --gravity removed)")
    "which is gravity in g (use unit='g' or gravity='removed')"
    """
    text = re.sub(r"proofmass ([a-z]+) --help", r"help(proofmass.\1)", text)
    text = re.sub(r"\(use (--[^()]+)\)$", lambda advice: f"(use {' or '.join(map(_assigned, advice[1].split(' or ')))})", text)
    return re.sub(r"--([a-z][a-z0-9-]*)", lambda flag: _name_of(flag[1]) + "=", text)


def _assigned(flag: str) -> str:
    name, _, value = flag.removeprefix("--").partition(" ")
    return f"{_name_of(name)}={value!r}" if value else f"{_name_of(name)}="


def _name_of(flag: str) -> str:
    return _FLAGS.get(flag, flag.replace("-", "_"))


def _text(name: str, value: Any) -> str:
    if isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name}: expected a number or text, not {value!r}")
    if isinstance(value, (int, np.integer)):
        return str(int(value))
    if isinstance(value, (float, np.floating)):
        return repr(float(value))
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    raise TypeError(f"{name}: expected a number, text or a list of them, not {type(value).__name__}")
