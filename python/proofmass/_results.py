"""A verb's document as objects with named attributes."""
from __future__ import annotations

import copy
import html
import json
import os
import re
from typing import TYPE_CHECKING, Any, Iterator

from ._core import ArgumentError
from ._recording import Recording

if TYPE_CHECKING:
    import pandas

#: Follows the keys that are null in a reason: "sensors[0] (a.csv): radius, bias[0]", "positions[]: start_s".
_NULL = re.compile(r": null(?: \(\d+ times\))?(?: for ([^:]*))?: ")


class Missing:
    """A value that could not be determined: false, equal to None, with the reason in `why`.

    Examples
    --------
    >>> import proofmass as pm
    >>> wheel = pm.wheel(pm.simulate(duration=20, rpm=60, seed=1).recording)
    >>> bool(wheel.gyroscope), wheel.gyroscope == None
    (False, True)
    >>> wheel.gyroscope.why
    'no gyroscope was used'
    """

    value = std = interval = unit = None

    def __init__(self, why: str) -> None:
        self.why = why

    def __bool__(self) -> bool:
        return False

    def __eq__(self, other: object) -> bool:
        return other is None or isinstance(other, Missing)

    def __hash__(self) -> int:
        return hash(None)

    def __repr__(self) -> str:
        return f"None ({self.why})" if self.why else "None"


class Node:
    """An object of a document; its members are available as attributes and as items."""

    def __init__(self, members: dict[str, Any], path: tuple[str, ...], reasons: list[str]) -> None:
        self._members = members
        self._path = path
        self._reasons = reasons

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"no {name}; there are {', '.join(self._members)}") from None

    def __getitem__(self, name: str) -> Any:
        if name in self._members:
            return self._wrapped(name, self._members[name])
        # Fitted parameters are also members: channel.white is channel.parameters.white.
        parameters = self._members.get("parameters")
        if isinstance(parameters, dict) and name in parameters:
            return self["parameters"][name]
        if isinstance(parameters, list):
            for k, parameter in enumerate(parameters):
                if isinstance(parameter, dict) and parameter.get("name") == name:
                    return self["parameters"][k]
        raise KeyError(name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._members)

    def __len__(self) -> int:
        return len(self._members)

    def __contains__(self, name: object) -> bool:
        return name in self._members

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._members]

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {', '.join(self._members)}>"

    def __reduce__(self) -> Any:
        return (type(self), (self._members, self._path, self._reasons))

    def to_dict(self) -> dict[str, Any]:
        """A copy of its part of the document."""
        return copy.deepcopy(self._members)

    def _wrapped(self, name: str, value: Any) -> Any:
        return _wrapped(value, (*self._path, name), self._reasons)


class Quantity(Node):
    """A figure with its uncertainty.

    Attributes
    ----------
    value, std : float, or Missing
    unit : str
    interval : (float, float), or Missing
        The 95 % interval of the document if there is one, else `value` ± 1.96 `std`.
    """

    @property
    def interval(self) -> Any:
        """The 95 % interval."""
        members = self._members
        if isinstance(members.get("interval_95"), list):
            return tuple(members["interval_95"])
        value, std = members.get("value"), members.get("std")
        if value is None or std is None:
            return self["value"] if value is None else self["std"]
        return (value - 1.959963984540054 * std, value + 1.959963984540054 * std)

    def __float__(self) -> float:
        value = self._members.get("value")
        if value is None:
            raise ArgumentError(f"{self._path[-1]} is not determined: {self['value'].why}")
        return float(value)

    def __repr__(self) -> str:
        value, std = self._members.get("value"), self._members.get("std")
        if value is None:
            return repr(self["value"])
        unit = self._members.get("unit", "")
        shown = f"{value:.6g}" + ("" if std is None else f" ± {std:.2g}")
        return shown if unit in ("", "1") else f"{shown} {unit}"


class Result(Node):
    """Result of an analysis: the members of the command's JSON document as attributes.

    Attributes
    ----------
    warnings : list of str
        Warnings of the document, including the reason for each missing figure.
    notes : list of (str, str)
        Messages that the command would show, each with "info", "warning" or "bad".
    text : str
        Text that the command would print.
    series : dict of str to Recording
        Series that the command would write with ``--output``.
    """

    def __init__(self, given: dict[str, Any]) -> None:
        document = json.loads(given["json"])
        super().__init__(document, (), document.get("warnings", []))
        self._given = given

    def to_dict(self) -> dict[str, Any]:
        """The command's JSON document without its provenance."""
        return copy.deepcopy(self._members)

    @property
    def notes(self) -> list[tuple[str, str]]:
        return list(self._given["notes"])

    @property
    def text(self) -> str:
        return str(self._given["text"])

    @property
    def series(self) -> dict[str, Recording]:
        return {name: Recording(handle) for name, handle in self._given["series"]}

    def to_pandas(self) -> "pandas.DataFrame":
        """The series that the command writes with ``--output``, as a DataFrame.

        Examples
        --------
        >>> import proofmass as pm
        >>> wheel = pm.wheel(pm.simulate(duration=20, rpm=60, seed=1).recording)
        >>> list(wheel.to_pandas().columns)[:4]
        ['angle', 'angle_std', 'speed', 'speed_std']
        """
        return self._first_series().to_pandas()

    def report(self, path: "str | os.PathLike[str]") -> None:
        """Write the self-contained page that the command writes with ``--report``."""
        if not self._given["html"]:
            raise ArgumentError(f"{self._members['verb']}: has no page")
        with open(path, "w", encoding="utf-8") as file:
            file.write(self._given["html"])

    def plot(self, ax: Any = None) -> Any:
        """Plot the series with matplotlib, with bands of one standard deviation; returns the axes."""
        from ._plot import plot_series

        return plot_series(self._first_series(), ax)

    def _first_series(self) -> Recording:
        for recording in self.series.values():
            return recording
        raise ArgumentError(f"{self._members['verb']}: has no series")

    def _repr_html_(self) -> str:
        page = self._given["html"]
        if not page:
            return f"<pre>{html.escape(self.text)}</pre>"
        return (
            f'<iframe srcdoc="{html.escape(page)}" style="width:100%;height:40em;border:1px solid #ccc" '
            'sandbox="allow-scripts"></iframe>'
        )

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"<Result of {self._members['verb']}: {', '.join(self._members)}>"

    def __reduce__(self) -> Any:
        return (type(self), (self._given,))


def _wrapped(value: Any, path: tuple[str, ...], reasons: list[str]) -> Any:
    if isinstance(value, dict):
        kind = Quantity if "value" in value and ("std" in value or "unit" in value) else Node
        named = value.get("name", value.get("file"))
        return kind(value, (*path, named) if isinstance(named, str) else path, reasons)
    if isinstance(value, list):
        items = [(*path[:-1], f"{path[-1]}[{k}]") for k in range(len(value))]
        return [_wrapped(item, at, reasons) for item, at in zip(value, items)]
    if value is None:
        return Missing(_why(path, reasons))
    return value


def _why(path: tuple[str, ...], reasons: list[str]) -> str:
    """The reason of a null: the sentence that names it and matches its path best."""
    best, most = "", (0, 0)
    for sentence in reasons:
        null = _NULL.search(sentence)
        if not null:
            continue
        about = sentence[: null.start()] + " " + (null[1] or "")
        named = [_names(about, name) for name in path]
        weight = (sum(named) + 2 * named[-1], -len(about))
        if any(named) and weight > most:
            best, most = sentence[null.end() :].strip(), weight
    return best


def _names(about: str, name: str) -> int:
    """Match of a text with a member: 2 if it names it, 1 if it names its list, 0 if neither."""
    if re.search(rf"(?<!\w){re.escape(name)}(?!\w)", about):
        return 2
    key, bracket, _ = name.partition("[")
    return int(bool(bracket) and re.search(rf"(?<!\w){re.escape(key)}(\[\]|(?![\w\[]))", about) is not None)

