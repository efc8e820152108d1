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
        """Whether the array has the shape and lies within the limits."""
        array = np.asarray(value)
        return array.shape == self.shape and bool(np.all((array >= self.low) & (array <= self.high)))

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
        """Whether every space contains its part."""
        return set(value) == set(self.spaces) and all(self[k].contains(v) for k, v in value.items())

    def __repr__(self) -> str:
        return f"Dict({self.spaces})"
