"""Arguments of callers as arrays for the library."""
from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._core import ArgumentError

Doubles = NDArray[np.float64]


def as_doubles(values: Any, what: str, ndim: tuple[int, ...] = (1,)) -> Doubles:
    """Values as contiguous doubles, copied only if necessary.

    Masked values become NaN. Raises ArgumentError if the values are not numbers or the dimension is wrong.
    """
    array = _filled(values, what)
    if array.dtype.kind not in "fiu":
        raise ArgumentError(f"{what}: expected real numbers, got an array of {_kind(array)}")
    if array.ndim not in ndim:
        shapes = " or ".join(f"{n}-dimensional" for n in ndim)
        raise ArgumentError(f"{what}: expected a {shapes} array, got one of shape {array.shape}")
    if array.size == 0:
        raise ArgumentError(f"{what}: expected one sample at least, got an empty array")
    return np.ascontiguousarray(array, dtype=np.float64)


def _filled(values: Any, what: str) -> NDArray[Any]:
    if isinstance(values, np.ma.MaskedArray):
        if values.dtype.kind not in "fiu":
            raise ArgumentError(f"{what}: expected real numbers, got a masked array of {values.dtype}")
        return np.asarray(np.ma.filled(values.astype(np.float64), np.nan))  # type: ignore[no-untyped-call]
    if hasattr(values, "to_numpy"):
        numbers = values.to_numpy()
        if numbers.dtype.kind == "O" and hasattr(values, "convert_dtypes"):
            numbers = values.convert_dtypes().to_numpy(dtype=object, na_value=np.nan)
        return _without_objects(numbers, what)
    try:
        return _without_objects(np.asarray(values), what)
    except (ValueError, TypeError) as error:
        raise ArgumentError(f"{what}: expected an array of numbers: {error}") from None


def _without_objects(array: NDArray[Any], what: str) -> NDArray[Any]:
    """Convert an array of objects that are all real numbers to doubles."""
    if array.dtype.kind != "O" or array.ndim == 0:
        return array
    for value in array.flat:
        if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating)):
            raise ArgumentError(
                f"{what}: expected real numbers, got an array of objects with {type(value).__name__} in it"
            )
    return array.astype(np.float64)


def _kind(array: NDArray[Any]) -> str:
    names = {"O": "objects", "U": "text", "S": "bytes", "c": "complex numbers", "b": "truth values", "M": "dates"}
    return names.get(array.dtype.kind, str(array.dtype))
