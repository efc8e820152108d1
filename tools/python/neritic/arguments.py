"""Checks of arguments: what does not fit is a BadInput in one line."""

from __future__ import annotations

import math
import operator
import os
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import BadInput


def whole(where: str, value: Any, least: int, most: int) -> int:
    """A whole number within limits. True and False are none."""
    try:
        number = None if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = None
    if number is None or not least <= number <= most:
        raise BadInput(f"{where}: found {shown(value)}; accepted: a whole number from {least} to {most}")
    return number


def numbers(where: str, values: ArrayLike, count: Optional[int] = None) -> NDArray[np.float64]:
    """Numbers in one row, with count: as many."""
    try:
        row = np.asarray(values)
        if row.dtype.kind == "O" and not any(isinstance(one, str) for one in row.ravel()):
            row = np.array([float(one) for one in row.ravel()])
        if row.dtype.kind not in "biuf":
            raise TypeError
    except (TypeError, ValueError, OverflowError):
        raise BadInput(f"{where}: found {shown(values)}; accepted: "
                       f"{'numbers' if count is None else 'a number' if count == 1 else f'{count} numbers'}") from None
    if count is not None and row.size != count:
        raise BadInput(f"{where}: found {row.size} numbers; accepted: {count}")
    return row.astype(np.float64, copy=False).ravel()


def finite(where: str, row: NDArray[np.float64], most: int) -> NDArray[np.float64]:
    """Finite numbers, at most so many."""
    if row.size > most:
        raise BadInput(f"{where}: found {row.size} numbers; accepted: up to {most}")
    if not np.isfinite(row).all():
        place = int(np.argmin(np.isfinite(row)))
        raise BadInput(f"{where}: found {row[place]:g} at place {place}; accepted: finite numbers")
    return row


def number(where: str, value: Any, least: float = -math.inf, most: float = math.inf) -> float:
    """A finite number within limits."""
    row = numbers(where, value, 1)
    if not math.isfinite(row[0]) or not least <= row[0] <= most:
        limits = "a finite number" + (f" from {least:g}" if math.isfinite(least) else "") + (f" to {most:g}" if math.isfinite(most) else "")
        raise BadInput(f"{where}: found {row[0]:g}; accepted: {limits}")
    return float(row[0])


def rotations(where: str, values: ArrayLike, count: int) -> NDArray[np.float64]:
    """Quaternions x y z w in one row, of length 1 as samples of devices have it (testbed/samples/unit_rotation.hpp)."""
    row = numbers(where, values, 4 * count)
    with np.errstate(over="ignore", invalid="ignore"):
        squared = np.square(row.reshape(count, 4)).sum(axis=1)
        length = np.sqrt(squared)
    wrong = ~(np.abs(squared - 1.0) <= 2e-3)
    if wrong.any():
        at = f" at place {int(wrong.argmax())}" if count > 1 else ""
        raise BadInput(f"{where}: found a quaternion of length {length[wrong.argmax()]:g}{at}; accepted: x y z w of length 1, within 0.001")
    return row


def word(where: str, value: Any) -> str:
    """A text."""
    if not isinstance(value, str):
        raise BadInput(f"{where}: found {shown(value)}; accepted: a word in quotes")
    _check_letters(where, value)
    return value


def flag(where: str, value: Any) -> bool:
    """True or False; 0 and 1 are the same."""
    try:
        if value in (True, False):
            return bool(value)
    except ValueError:  # of an array
        pass
    raise BadInput(f"{where}: found {shown(value)}; accepted: True or False")


def path(where: str, value: Any) -> str:
    """A file's path."""
    try:
        name = os.fsdecode(value)
    except (TypeError, ValueError):
        name = ""
    if not name:
        raise BadInput(f"{where}: found {shown(value)}; accepted: a file's path")
    _check_letters(where, name)
    return name


def _check_letters(where: str, text: str) -> None:
    try:
        text.encode()
    except UnicodeEncodeError:
        raise BadInput(f"{where}: found {shown(text)}, with a half of a letter; accepted: whole letters (UTF-8)") from None


def shown(value: Any) -> str:
    """The value in a line of an error."""
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # of a whole number with thousands of digits
        return f"a {type(value).__name__}"
    return text if len(text) <= 60 else text[:57] + "..."
