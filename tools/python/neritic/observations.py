"""Everything that a world gives: streams, readings, images, the truth, messages."""

from __future__ import annotations

import copy
from dataclasses import astuple, dataclass
from typing import Any, Iterator, Mapping, NamedTuple, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _core

Float = NDArray[np.float64]
Header = tuple[int, int, int, int, int]
Row = tuple[Header, Float]


@dataclass(frozen=True)
class Stream:
    """A stream of readings, inputs or images, by name."""

    name: str  # "rov/imu"
    owner: str  # "rov"
    kind: str  # "imu"
    frame: str  # of its vectors or its picture
    sort: str  # "reading", "input" or "image"
    fields: tuple[tuple[str, int], ...]  # names and numbers of values; of readings and inputs
    rate_hz: float  # of images
    encoding: str  # of images, as in ROS's sensor_msgs/Image


class Rows:
    """Readings in memory of Python's own, with the interface of those of the C++ side."""

    def __init__(self, rows: Sequence[Row], step: int, time_s: float) -> None:
        self._rows, self.step, self.time = rows, step, time_s

    def __len__(self) -> int:
        return len(self._rows)

    def header(self, place: int) -> Header:
        """Stream, count of values, sequence, stamp and arrival in nanoseconds."""
        return self._rows[place][0]

    def number(self, place: int, index: int) -> float:
        """One value."""
        return float(self._rows[place][1][index])

    def values(self, place: int, first: int, count: int) -> Float:
        """Some values, in their memory."""
        return self._rows[place][1][first:first + count]


class Pixels(NamedTuple):
    """An image in memory of Python's own, with the interface of one of the C++ side."""

    pixels: NDArray[Any]
    stream: int
    sequence: int
    stamp_ns: int
    arrival_ns: int
    position: Sequence[float]
    orientation: Sequence[float]
    intrinsics: Sequence[float]
    range_m: Sequence[float]
    azimuth: Sequence[float]
    elevation: Sequence[float]


@dataclass(frozen=True)
class Table:
    """The streams of a world, by place, and where their values lie."""

    streams: Sequence[Stream]
    places: Mapping[str, int]
    offsets: Sequence[Mapping[str, tuple[int, int]]]


class Reading:
    """One measurement. Its fields are attributes: `reading.linear_acceleration`, a number or an array.

    Arrays are read-only views of the observation's memory. `fields()` names them. A copy, by copy or pickle, has
    arrays of its own. Two are equal if stream, number, times and values are.
    """

    __slots__ = ("_of", "_place", "_stream", "_offsets")

    def __init__(self, of: Union[_core.Readings, Rows], place: int, stream: Stream,
                 offsets: Mapping[str, tuple[int, int]]) -> None:
        self._of, self._place, self._stream, self._offsets = of, place, stream, offsets

    def __reduce__(self) -> tuple[Any, ...]:
        row = (self._of.header(self._place), self.values.copy())
        return Reading, (Rows([row], self._of.step, self._of.time), 0, self._stream, self._offsets)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Reading):
            return NotImplemented
        return self._key() == other._key() and np.array_equal(self.values, other.values, equal_nan=True)

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[Any, ...]:
        return (self.stream, *self._of.header(self._place)[1:])

    @property
    def stream(self) -> str:
        """The stream's name."""
        return self._stream.name

    @property
    def frame(self) -> str:
        """The frame of its vectors: "world" (east, north, up), or a body or sensor (forward, left, up)."""
        return self._stream.frame

    @property
    def sequence(self) -> int:
        """Its number in the stream; a gap is a reading that did not arrive."""
        return self._of.header(self._place)[2]

    @property
    def stamp(self) -> float:
        """When it was measured, in simulated seconds."""
        return self._of.header(self._place)[3] * 1e-9

    @property
    def arrival(self) -> float:
        """When it arrived here: later than the stamp if the stream has a link."""
        return self._of.header(self._place)[4] * 1e-9

    def fields(self) -> list[str]:
        """The names of its values."""
        return list(self._offsets)

    @property
    def values(self) -> Float:
        """All its values in one array."""
        return self._of.values(self._place, 0, self._of.header(self._place)[1])

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            first, count = self._offsets[name]
        except KeyError:
            raise AttributeError(f"{self.stream}: found '{name}'; accepted: "
                                 f"{', '.join(self._offsets)}") from None
        if count == 1:
            return self._of.number(self._place, first)
        return self._of.values(self._place, first, count)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._offsets]

    def __repr__(self) -> str:
        values = ", ".join(f"{name}={getattr(self, name)}" for name in self._offsets)
        return f"<{self.stream} {self.sequence} at {self.stamp:.4f} s: {values}>"


class Image:
    """A picture or sonar image. `pixels` is its own memory: no copy, writable, valid as long as you keep it. A copy, by
    copy or pickle, has pixels of its own. Two are equal if stream, number, times, pose and pixels are."""

    __slots__ = ("_of", "_stream")

    def __init__(self, of: Union[_core.Image, Pixels], stream: Stream) -> None:
        self._of, self._stream = of, stream

    def __reduce__(self) -> tuple[Any, ...]:
        of = self._of
        return Image, (Pixels(of.pixels.copy(), of.stream, of.sequence, of.stamp_ns, of.arrival_ns, of.position, of.orientation,
                              of.intrinsics, of.range_m, of.azimuth, of.elevation), self._stream)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Image):
            return NotImplemented
        return self._key() == other._key() and np.array_equal(self.pixels, other.pixels, equal_nan=self.pixels.dtype.kind == "f")

    def __hash__(self) -> int:
        return hash(self._key())

    def _key(self) -> tuple[Any, ...]:
        of = self._of
        return (self.stream, of.sequence, of.stamp_ns, of.arrival_ns, *of.position, *of.orientation)

    @property
    def pixels(self) -> NDArray[Any]:
        """Rows from the top; [row, column] or [row, column, channel]. A sonar's rows are ranges, nearest first,
        its columns bearings, full port first."""
        return self._of.pixels

    @property
    def stream(self) -> str:
        """The stream's name."""
        return self._stream.name

    @property
    def frame(self) -> str:
        """The frame whose pose `position` and `orientation` give."""
        return self._stream.frame

    @property
    def encoding(self) -> str:
        """As in ROS's sensor_msgs/Image: "rgb8", "32FC1", "16UC1"."""
        return self._stream.encoding

    @property
    def sequence(self) -> int:
        """The sensor's beat since time 0; a gap is an image that was not taken or did not arrive."""
        return self._of.sequence

    @property
    def stamp(self) -> float:
        """The simulated time that it shows, in seconds."""
        return self._of.stamp_ns * 1e-9

    @property
    def arrival(self) -> float:
        """When it arrived here, in simulated seconds."""
        return self._of.arrival_ns * 1e-9

    @property
    def position(self) -> Float:
        """The origin of the frame in the world: east, north, up, in metres."""
        return np.array(self._of.position)

    @property
    def orientation(self) -> Float:
        """World from frame: a camera's optical axes (right, down, forward), a sonar head's forward,
        left, up. x, y, z, w."""
        return np.array(self._of.orientation)

    @property
    def intrinsics(self) -> Float:
        """The pinhole of a camera's picture: fx, fy, cx, cy in pixels."""
        return np.array(self._of.intrinsics)

    @property
    def range_limits(self) -> tuple[float, float]:
        """The ranges of a sonar image's first and last edge, in metres."""
        return (self._of.range_m[0], self._of.range_m[1])

    @property
    def azimuth_limits(self) -> tuple[float, float]:
        """The bearings of a sonar image's first and last edge, positive to the left."""
        return (self._of.azimuth[0], self._of.azimuth[1])

    def __repr__(self) -> str:
        return f"<{self.stream} {self.sequence} at {self.stamp:.4f} s: {self.pixels.shape} {self.encoding}>"


class Observations(Mapping[str, Union[Reading, Image]]):
    """The newest reading of each stream that has arrived, and the newest image of each requested stream. It
    does not change with later ticks. A copy, by copy or pickle, has arrays of its own."""

    __slots__ = ("_table", "_of", "_images")

    def __init__(self, table: Table, of: Union[_core.Readings, Rows], images: Mapping[str, Image]) -> None:
        self._table, self._of, self._images = table, of, images

    def __reduce__(self) -> tuple[Any, ...]:
        of = self._of
        rows = [(of.header(i), of.values(i, 0, of.header(i)[1]).copy()) for i in range(len(of))]
        images = {name: copy.copy(image) for name, image in self._images.items()}
        return Observations, (self._table, Rows(rows, of.step, of.time), images)

    @property
    def step(self) -> int:
        """Physics steps so far."""
        return self._of.step

    @property
    def time(self) -> float:
        """Simulated seconds so far."""
        return self._of.time

    def __getitem__(self, name: str) -> Any:
        if name in self._images:
            return self._images[name]
        place = self._table.places.get(name)
        if place is None:
            raise KeyError(f"found '{name}'; accepted: {', '.join(self) or 'none: nothing has arrived yet'}")
        if place >= len(self._of) or self._of.header(place)[1] == 0:
            raise KeyError(f"{name}: nothing has arrived yet")
        return Reading(self._of, place, self._table.streams[place], self._table.offsets[place])

    def __iter__(self) -> Iterator[str]:
        for place in range(len(self._of)):
            if self._of.header(place)[1]:
                yield self._table.streams[place].name
        yield from self._images

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        if name in self._images:
            return True
        place = self._table.places.get(name) if isinstance(name, str) else None
        return place is not None and place < len(self._of) and self._of.header(place)[1] > 0

    def __repr__(self) -> str:
        return f"<observations at {self.time:.4f} s: {', '.join(self)}>"


@dataclass(frozen=True, eq=False)
class Truth:
    """The true motion of an agent. Nothing of it is measured. Two are equal if all their numbers are."""

    time: float  # simulated seconds at which it holds: of a dive that runs by itself, later than the last tick
    position: Float  # of its origin: east, north, up
    orientation: Float  # world from body: x, y, z, w
    linear_velocity: Float  # over ground, body axes: forward, left, up
    angular_velocity: Float  # body axes
    current: Float  # of the water there: east, north, up
    thruster_n: Float  # of a vehicle: the commands that act, in newtons
    touched_steps: int  # in which it touched something, so far
    joints: Float  # of a diver: 15 rotations as of Diver.joints(), in one row; empty: none are known

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Truth):
            return NotImplemented
        return all(np.array_equal(a, b) for a, b in zip(astuple(self), astuple(other)))

    __hash__ = None  # type: ignore[assignment]  # as arrays have none


MODEM_EVENTS = ("sent", "refused", "received", "too_weak", "noisy", "collided", "was_sending")
"""The meanings of the number `event` of a reading of NAME/modem: what became of a message at its sender, or
at a modem that it was for. The last four are the causes of its loss."""


@dataclass(frozen=True)
class Message:
    """A message that a modem received."""

    sender: str  # the agent that sent it
    data: bytes
    sent: float  # when its first sound left, and arrived, in simulated seconds: their difference is the
    heard: float  # travel, as modems with synchronised clocks measure it
    received: float  # when the last bit had come
    snr_db: float  # signal to noise in the receiver's band


def offsets_of(fields: Sequence[tuple[str, int]]) -> dict[str, tuple[int, int]]:
    first, out = 0, {}
    for name, count in fields:
        out[name] = (first, count)
        first += count
    return out
