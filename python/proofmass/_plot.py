"""Plots of series with matplotlib."""
from __future__ import annotations

from typing import Any

import numpy as np

from ._recording import Recording


def plot_series(recording: Recording, ax: Any) -> Any:
    """Plot the columns with the first one's unit against time, or deviations against averaging time."""
    import matplotlib.pyplot as plt  # type: ignore[import]

    if ax is None:
        _, ax = plt.subplots()
    is_deviation = "tau_s" in recording
    x = recording["tau_s"] if is_deviation else recording.time_s
    names = [name for name in recording.channels if not name.endswith(("_std", "_lower", "_upper", "tau_s"))]
    unit = recording.units[names[0]] if names else ""
    for name in names:
        if recording.units[name] != unit:
            continue
        values = recording[name]
        (line,) = ax.plot(x, values, label=name)
        band = _band(recording, name, values)
        if band is not None:
            ax.fill_between(x, *band, alpha=0.25, color=line.get_color(), linewidth=0)
    if is_deviation:
        ax.set_xscale("log")
        ax.set_yscale("log")
    ax.set_xlabel("averaging time (s)" if is_deviation else "time (s)")
    ax.set_ylabel(unit)
    ax.legend()
    return ax


def _band(recording: Recording, name: str, values: Any) -> Any:
    if f"{name}_lower" in recording:
        return recording[f"{name}_lower"], recording[f"{name}_upper"]
    if f"{name}_std" in recording:
        std = np.asarray(recording[f"{name}_std"])
        return values - std, values + std
    return None
