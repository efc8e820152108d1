"""Checks of arguments: what does not fit is a BadInput in one line."""

from __future__ import annotations

import operator
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import BadInput


def whole(where: str, value: Any, least: int, most: int) -> int:
    """A whole number within limits."""
    try:
        number = operator.index(value)
    except TypeError:
        number = None
    if number is None or not least <= number <= most:
        raise BadInput(f"{where}: found {_shown(value)}; accepted: a whole number from {least} to {most}")
    return number


def numbers(where: str, values: ArrayLike, count: Optional[int] = None) -> NDArray[np.float64]:
    """Numbers in one row, with count: as many."""
    try:
        row = np.asarray(values, np.float64).ravel()
    except (TypeError, ValueError, OverflowError):
        raise BadInput(f"{where}: found {_shown(values)}; accepted: "
                       f"{'numbers' if count is None else f'{count} numbers'}") from None
    if count is not None and row.size != count:
        raise BadInput(f"{where}: found {row.size} numbers; accepted: {count}")
    return row


def _shown(value: Any) -> str:
    try:
        text = " ".join(repr(value).split())
    except ValueError:  # of a whole number with thousands of digits
        return f"a {type(value).__name__}"
    return text if len(text) <= 60 else text[:57] + "..."
