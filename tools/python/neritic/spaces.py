"""Spaces with the attributes and methods of Gymnasium's, without that package."""

from __future__ import annotations

from typing import Any, Iterator, Mapping, Optional

import numpy as np
from numpy.typing import NDArray


class Box:
    """Arrays of float32 within limits."""

    def __init__(self, low: float, high: float, shape: tuple[int, ...], seed: Optional[int] = None) -> None:
        self.shape, self.dtype = shape, np.dtype(np.float32)
        self.low = np.full(shape, low, np.float32)
        self.high = np.full(shape, high, np.float32)
        self._random = np.random.default_rng(seed)

    def seed(self, seed: Optional[int] = None) -> None:
        """Seeds the samples that follow."""
        self._random = np.random.default_rng(seed)

    def sample(self) -> NDArray[np.float32]:
        """Even within the limits; of those that are infinite from -1 to 1."""
        low = np.where(np.isfinite(self.low), self.low, -1.0)
        high = np.where(np.isfinite(self.high), self.high, 1.0)
        return self._random.uniform(low, high).astype(np.float32)

    def contains(self, value: Any) -> bool:
        """Whether it is an array of that shape within the limits, whose numbers float32 holds without loss, as Gymnasium
        has it: float64 is none."""
        try:
            array = np.asarray(value)
        except ValueError:  # rows of several lengths
            return False
        return bool(array.shape == self.shape and np.can_cast(array.dtype, self.dtype)
                    and np.all((array >= self.low) & (array <= self.high)))

    def __contains__(self, value: Any) -> bool:
        return self.contains(value)

    def __eq__(self, other: object) -> bool:
        return (isinstance(other, Box) and self.shape == other.shape and np.array_equal(self.low, other.low)
                and np.array_equal(self.high, other.high))

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"


class Dict(Mapping[str, Box]):
    """Named spaces."""

    def __init__(self, spaces: Mapping[str, Box]) -> None:
        self.spaces = dict(spaces)

    def __getitem__(self, name: str) -> Box:
        return self.spaces[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.spaces)

    def __len__(self) -> int:
        return len(self.spaces)

    def seed(self, seed: Optional[int] = None) -> None:
        """Seeds the samples that follow."""
        for i, space in enumerate(self.spaces.values()):
            space.seed(None if seed is None else seed + i)

    def sample(self) -> dict[str, NDArray[np.float32]]:
        """A sample of each."""
        return {name: space.sample() for name, space in self.spaces.items()}

    def contains(self, value: Any) -> bool:
        """Whether it is a mapping of the same names, and every space contains its part."""
        return (isinstance(value, Mapping) and set(value) == set(self.spaces)
                and all(self[name].contains(part) for name, part in value.items()))

    def __contains__(self, value: object) -> bool:
        """Of a sample, as contains(); of a name, whether there is such a space."""
        return value in self.spaces if isinstance(value, str) else self.contains(value)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Dict) and self.spaces == other.spaces

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"Dict({self.spaces})"
