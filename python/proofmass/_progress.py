"""Progress display for the argument `progress`."""
from __future__ import annotations

import sys
from typing import Any, Callable, Optional, Union

Progress = Union[None, bool, Callable[[str, float], Any]]


class _Bar:
    """A tqdm bar, or a line on standard error if tqdm is not installed."""

    def __init__(self) -> None:
        self._stage = ""
        self._bar: Any = None
        try:
            from tqdm.auto import tqdm  # type: ignore[import]

            self._bar = tqdm(total=100, leave=False, bar_format="{l_bar}{bar}| {remaining}")
        except ImportError:
            pass

    def __call__(self, stage: str, fraction: float) -> None:
        percent = round(100 * min(max(fraction, 0.0), 1.0))
        if self._bar is None:
            sys.stderr.write(f"\r{stage}: {percent} % ")
            return
        self._bar.set_description(stage)
        self._bar.update(percent - self._bar.n)

    def close(self) -> None:
        if self._bar is not None:
            self._bar.close()
        else:
            sys.stderr.write("\r\033[K")


class Shown:
    """Context manager that provides the library's progress callable."""

    def __init__(self, progress: Progress) -> None:
        if progress not in (None, True, False) and not callable(progress):
            raise TypeError("progress: expected True, or a callable of a stage and a fraction")
        self._progress = progress
        self._bar: Optional[_Bar] = None

    def __enter__(self) -> Optional[Callable[[str, float], Any]]:
        if self._progress is True:
            self._bar = _Bar()
            return self._bar
        return self._progress if callable(self._progress) else None

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()
