"""A scene in this process: stepped by ticks, read by stream, commanded by agent."""

from __future__ import annotations

import asyncio
import os
from collections import deque
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, AsyncIterator, Callable, Iterator, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .errors import BadInput

Float = NDArray[np.float64]


@dataclass(frozen=True)
class Stream:
    """All that a world can tell or be told, by name."""

    name: str  # "rov/imu"
    owner: str  # "rov"
    kind: str  # "imu"
    frame: str  # of its vectors or its picture
    sort: str  # "reading", "input" or "image"
    fields: tuple[tuple[str, int], ...]  # names and numbers of values; of readings and inputs
    rate_hz: float  # of images
    encoding: str  # of images, as in ROS's sensor_msgs/Image


class Reading:
    """One measurement. Its fields are attributes: `reading.linear_acceleration`, a number or an array.

    Arrays are read-only views of the observation's memory. `fields()` names them.
    """

    __slots__ = ("_of", "_place", "_stream", "_offsets")

    def __init__(self, of: _core.Readings, place: int, stream: Stream,
                 offsets: Mapping[str, tuple[int, int]]) -> None:
        self._of, self._place, self._stream, self._offsets = of, place, stream, offsets

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
    """A picture or sonar image. `pixels` is its own memory: no copy, valid as long as you keep it."""

    __slots__ = ("_of", "_stream")

    def __init__(self, of: _core.Image, stream: Stream) -> None:
        self._of, self._stream = of, stream

    @property
    def pixels(self) -> NDArray[Any]:
        """Rows from the top; [row, column] or [row, column, channel]. Of a sonar: rows are ranges,
        nearest first, columns bearings, full port first."""
        return self._of.pixels

    @property
    def stream(self) -> str:
        """The stream's name."""
        return self._stream.name

    @property
    def frame(self) -> str:
        """The frame whose pose `position` and `orientation` say."""
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
        """The rotation of the frame in the world: east, north, up."""
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
    """The newest reading of each stream that has arrived, and the newest image of each stream that is
    wanted. Does not change with later ticks."""

    __slots__ = ("_world", "_of", "_images")

    def __init__(self, world: World, of: _core.Readings, images: Mapping[str, Image]) -> None:
        self._world, self._of, self._images = world, of, images

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
        place = self._world._places.get(name)
        if place is None:
            raise KeyError(f"found '{name}'; accepted: {', '.join(self)}")
        if place >= len(self._of) or self._of.header(place)[1] == 0:
            raise KeyError(f"{name}: nothing has arrived yet")
        return Reading(self._of, place, self._world._streams[place], self._world._offsets[place])

    def __iter__(self) -> Iterator[str]:
        for place in range(len(self._of)):
            if self._of.header(place)[1]:
                yield self._world._streams[place].name
        yield from self._images

    def __len__(self) -> int:
        return sum(1 for _ in self)

    def __contains__(self, name: object) -> bool:
        if name in self._images:
            return True
        place = self._world._places.get(name) if isinstance(name, str) else None
        return place is not None and place < len(self._of) and self._of.header(place)[1] > 0

    def __repr__(self) -> str:
        return f"<observations at {self.time:.4f} s: {', '.join(self)}>"


@dataclass(frozen=True)
class Truth:
    """The true motion of an agent. Nothing of it is measured."""

    position: Float  # of its origin: east, north, up
    orientation: Float  # world from body: x, y, z, w
    linear_velocity: Float  # over ground, body axes: forward, left, up
    angular_velocity: Float  # body axes
    current: Float  # of the water there: east, north, up
    thruster_n: Float  # of a vehicle: the commands that act, in newtons
    touched_steps: int  # in which it touched something, so far


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


class Agent:
    """A vehicle, a diver or an object of the scene. A command holds until the next one, until
    release(), or, with hold > 0, until so many seconds passed without one."""

    def __init__(self, world: World, name: str) -> None:
        self._world, self.name = world, name
        self.modem = 0
        """The number of its modem among the scene's, from 1 on; 0: it has none."""

    def send(self, data: Union[bytes, str], to: Optional[str] = None) -> None:
        """Sends up to 64 bytes by sound with the next step, to one agent's modem or to all (None). Whether
        and when it arrives is the water's affair: receive() of the other one, and readings of NAME/modem
        (event: MODEM_EVENTS)."""
        if isinstance(data, str):
            data = data.encode()
        number = 0
        if to is not None:
            number = self._world[to].modem
            if not number:
                raise BadInput(f"{self.name}: send: found {to}, an agent without a modem; accepted: "
                               f"{', '.join(self._world._modems)}")
        self.command("send", [number, *data])

    def receive(self) -> list[Message]:
        """The messages that its modem received since the last call, oldest first (the newest 1024)."""
        if not self.modem:
            raise BadInput(f"{self.name}: receive: found an agent without a modem; accepted: "
                           f"{', '.join(self._world._modems)}")
        mail = self._world._mail[f"{self.name}/modem"]
        messages = list(mail)
        mail.clear()
        return messages

    def command(self, kind: str, values: ArrayLike, hold: float = 0.0) -> None:
        """A command by its name and numbers, as the methods below send it."""
        self._world._core.command(self.name, kind, np.asarray(values, np.float64).ravel(), hold,
                                  self._world.source)

    def release(self) -> None:
        """Gives the agent back to what the scene chose: its mission, its autopilot, its devices."""
        self._world._core.release(self.name, self._world.source)

    def __repr__(self) -> str:
        return f"<{type(self).__name__.lower()} {self.name}>"


class Vehicle(Agent):
    """An underwater vehicle."""

    def __init__(self, world: World, name: str, thruster_n: Sequence[tuple[float, float]],
                 takes_pwm: bool) -> None:
        super().__init__(world, name)
        self.thruster_n = np.array(thruster_n, np.float64).reshape(-1, 2)
        """Least and most force of each thruster, in newtons."""
        self.takes_pwm = takes_pwm
        """Whether its file names a thrust table, which pwm() needs."""

    def goto(self, x: float, y: float, z: float, yaw: float = 0.0,
             velocity: Sequence[float] = (0.0, 0.0, 0.0), hold: float = 0.0) -> None:
        """Be there, level: east, north, up in metres, yaw from east towards north. velocity: of the
        place itself, if it moves."""
        self.command("goto", [x, y, z, yaw, *velocity], hold)

    def velocity(self, forward: float, left: float = 0.0, up: float = 0.0, yaw_rate: float = 0.0,
                 hold: float = 0.0) -> None:
        """Move so over ground, level, in m/s of its heading and rad/s."""
        self.command("velocity", [forward, left, up, yaw_rate], hold)

    def wrench(self, force: Sequence[float], torque: Sequence[float] = (0.0, 0.0, 0.0),
               hold: float = 0.0) -> None:
        """Forces and moments in N and N m, body axes. Depth and heading are held where it is 0."""
        self.command("wrench", [*force, *torque], hold)

    def thrusters(self, force_n: ArrayLike, hold: float = 0.0) -> None:
        """The force of each thruster in N, in the order of the vehicle's file. Nothing is held."""
        self.command("thrusters", force_n, hold)

    def pwm(self, width_us: ArrayLike, hold: float = 0.0) -> None:
        """The pulse width of each thruster's controller in microseconds: 1500 stands still."""
        self.command("pwm", width_us, hold)

    def fail(self, thrusters: Sequence[int] = ()) -> None:
        """These thrusters, counted from 0, give nothing from now on; () mends all."""
        failed = np.zeros(len(self.thruster_n))
        failed[list(thrusters)] = 1.0
        self.command("faults", failed)


class Diver(Agent):
    """A diver."""

    def jacket(self, inflate: bool = False, deflate: bool = False, dump: bool = False,
               hold: float = 0.0) -> None:
        """The jacket's buttons that are pressed from now on."""
        self.command("buttons", [inflate, deflate, dump], hold)

    def joints(self, rotations: ArrayLike, hold: float = 0.0) -> None:
        """15 rotations, parent from child, as quaternions x y z w: abdomen, thorax, head; left upper
        arm, forearm, hand; right ones; left upper leg, lower leg, foot; right ones."""
        self.command("joints", rotations, hold)

    def head(self, orientation: Sequence[float], position: Optional[Sequence[float]] = None,
             hold: float = 0.0) -> None:
        """Where the head looks (world from head, forward, left, up) and, if position is given, is."""
        placed = position is not None
        self.command("head", [*(position or (0.0, 0.0, 0.0)), *orientation, placed], hold)

    def gas(self, tank: int) -> None:
        """Breathe from that tank; 0 is the first."""
        self.command("gas", [tank])


class TrackedObject(Agent):
    """An object that devices or programs move."""

    def pose(self, position: Sequence[float], orientation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
             velocity: Optional[Sequence[float]] = None,
             angular_velocity: Sequence[float] = (0.0, 0.0, 0.0), hold: float = 0.0) -> None:
        """It is there now. Velocities are over world axes; absent: they follow from two poses."""
        values = [*position, *orientation]
        if velocity is not None:
            values += [*velocity, *angular_velocity]
        self.command("pose", values, hold)


class World:
    """A scene that runs. Made by neritic.open(). One thread at a time uses it; while it steps, other
    Python threads run."""

    source = "python"
    """Under this name its commands enter recordings."""

    def __init__(self, core: _core.World) -> None:
        self._core = core
        self._streams = [Stream(name, owner, kind, frame, sort, tuple(fields), rate, encoding)
                         for name, owner, kind, frame, sort, fields, rate, encoding in core.streams]
        self._places = {stream.name: i for i, stream in enumerate(self._streams)}
        self._offsets = [_offsets(stream.fields) for stream in self._streams]
        self._callbacks: dict[str, list[Callable[[Any], None]]] = {}
        self._images: dict[str, Image] = {}  # the newest; another one with each change
        self._senses = False  # images are wanted
        self._agents: dict[str, Agent] = {}
        self._modems: list[str] = []  # their agents, by number
        self._mail: dict[str, deque[Message]] = {}
        modems: dict[int, str] = {}
        for name, kind, thruster_n, takes_pwm, _, modem in core.agents:
            if modem:
                modems[modem] = name
                self._mail[f"{name}/modem"] = deque(maxlen=1024)
                core.keep(self._places[f"{name}/modem"], True)
            self._agents[name] = (Vehicle(self, name, thruster_n, takes_pwm) if kind == "vehicle"
                                  else Diver(self, name) if kind == "diver"
                                  else TrackedObject(self, name))
            self._agents[name].modem = modem
        self._modems = [modems[number] for number in sorted(modems)]

    # The scene.

    @property
    def title(self) -> str:
        """The scene's title."""
        return self._core.title

    @property
    def seed(self) -> int:
        """Everything random follows from it."""
        return self._core.seed

    @property
    def step_s(self) -> float:
        """Seconds of a physics step."""
        return self._core.step_s

    @property
    def step(self) -> int:
        """Physics steps so far."""
        return self._core.step

    @property
    def time(self) -> float:
        """Simulated seconds so far."""
        return self._core.time

    @property
    def hash(self) -> int:
        """The hash of the state: two runs with the same hash are in the same state, bit for bit."""
        return self._core.hash

    @property
    def streams(self) -> list[Stream]:
        """Every stream: readings, inputs and images."""
        return list(self._streams)

    @property
    def agents(self) -> Mapping[str, Agent]:
        """Vehicles, divers and objects that can be commanded, by name."""
        return dict(self._agents)

    def __getitem__(self, name: str) -> Any:
        """The agent of that name."""
        try:
            return self._agents[name]
        except KeyError:
            raise BadInput(f"agent: found '{name}'; accepted: {', '.join(self._agents)}") from None

    def truth(self, agent: str) -> Truth:
        """The true motion of the agent, apart from what is measured of it."""
        return Truth(**self._core.truth(agent))

    # Time.

    def tick(self, steps: int = 1) -> Observations:
        """Takes so many physics steps and returns what has arrived by then. Callbacks run after them."""
        of = self._core.tick(steps)
        self._after_tick()
        return Observations(self, of, self._images)

    def observe(self) -> Observations:
        """Returns what has arrived so far, without a step."""
        return Observations(self, self._core.newest(), self._images)

    async def ticks(self, steps: int = 1, count: Optional[int] = None) -> AsyncIterator[Observations]:
        """An asynchronous iterator of ticks of so many steps: each runs on another thread, so that the
        event loop goes on. count: so many ticks; None: without end."""
        done = 0
        while count is None or done < count:
            of = await asyncio.get_running_loop().run_in_executor(None, self._core.tick, steps)
            self._after_tick()
            yield Observations(self, of, self._images)
            done += 1

    def on(self, stream: str, call: Callable[[Any], None]) -> None:
        """Calls `call(reading)` after each tick, for every reading (or image) of the stream that arrived
        in it, in the order of arrival. Images must be wanted with keep=True."""
        place = self._core.stream(stream)
        if self._streams[place].sort != "image":
            self._core.keep(place, True)
        self._callbacks.setdefault(stream, []).append(call)

    def off(self, stream: str) -> None:
        """Ends the callbacks of a stream."""
        self._callbacks.pop(stream, None)
        place = self._core.stream(stream)
        if self._streams[place].sort != "image" and stream not in self._mail:
            self._core.keep(place, False)

    def link(self, stream: str, delay: float = 0.0, jitter: float = 0.0, loss: float = 0.0) -> None:
        """Readings of the stream arrive `delay` seconds late and evenly up to `jitter` more, and a share
        `loss` never. The measurements and their times stay as they are."""
        self._core.set_link(self._core.stream(stream), delay, jitter, loss)

    # Images.

    def images(self, *streams: str, rate: float = 0.0, keep: bool = False) -> None:
        """Wants images of these streams from the next tick on, "eye/color" or "sonar/echoes", at `rate`
        Hz or the sensor's own (0). The first one makes a Vulkan device. keep: every one for its
        callbacks, not the newest of each tick alone."""
        for stream in streams:
            self._core.want_image(self._core.stream(stream), rate, keep)
            self._senses = True

    def no_images(self, *streams: str) -> None:
        """Wants no images of these streams any more."""
        for stream in streams:
            self._core.drop_image(self._core.stream(stream))
        self._images = {name: image for name, image in self._images.items() if name not in streams}

    # State.

    def save(self) -> bytes:
        """The whole state as bytes, for restore() or `neritic dive --restore`."""
        return self._core.save()

    def restore(self, state: bytes) -> None:
        """Goes on from a saved state of this scene. Readings on their way are dropped; commands end."""
        self._core.restore(state)
        self._images = {}
        for mail in self._mail.values():
            mail.clear()

    @contextmanager
    def record(self, path: Union[str, os.PathLike[str]]) -> Iterator[None]:
        """Records what follows: `with world.record("out/run"): ...` leaves out/run.mcap,
        which `neritic dive --replay` runs again and ROS 2 tools read, and out/run.csv."""
        self._core.record(os.fspath(path))
        try:
            yield
        finally:
            self._core.stop_recording()

    def inject(self, stream: str, values: ArrayLike, source: str, stamp: Optional[float] = None) -> None:
        """Sends a sample as the device `source` does, into a stream of inputs. It acts if the scene gives
        that source the authority. stamp: when it was measured; None: now."""
        self._core.inject(stream, np.asarray(values, np.float64).ravel(), source, stamp)

    def close(self) -> None:
        """Ends the world; ends its recording."""
        self._core.close()

    def __enter__(self) -> World:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._core.closed:
            return "<closed world>"
        return f"<world '{self.title}' at {self.time:.4f} s: {', '.join(self._agents)}>"

    # Inside.

    def _take_images(self) -> None:
        taken = self._core.take_images() if self._senses else []
        if not taken:
            return
        newest = dict(self._images)
        for one in taken:
            image = Image(one, self._streams[one.stream])
            newest[image.stream] = image
            for call in self._callbacks.get(image.stream, ()):
                call(image)
        self._images = newest  # observations that were given keep theirs

    def _after_tick(self) -> None:
        if self._senses or self._callbacks or self._mail:
            self._take_images()
            self._call_back()

    def _call_back(self) -> None:
        if not self._callbacks and not self._mail:
            return
        arrived = self._core.take_arrived()
        for i in range(len(arrived)):
            place = arrived.header(i)[0]
            stream = self._streams[place]
            reading = Reading(arrived, i, stream, self._offsets[place])
            if stream.name in self._mail:
                self._sort_mail(reading)
            for call in self._callbacks.get(stream.name, ()):
                call(reading)

    def _sort_mail(self, reading: Reading) -> None:
        if MODEM_EVENTS[int(reading.event)] != "received" or reading.message_kind:
            return
        data = np.asarray(reading.words, "<u4").tobytes()[:int(reading.bytes)]
        self._mail[reading.stream].append(
            Message(self._modems[int(reading.sender) - 1], data, reading.sent, reading.heard,
                    reading.stamp, reading.snr_db))


def _offsets(fields: Sequence[tuple[str, int]]) -> dict[str, tuple[int, int]]:
    first, out = 0, {}
    for name, count in fields:
        out[name] = (first, count)
        first += count
    return out


def open(scene: Union[str, os.PathLike[str]], seed: Optional[int] = None, *, threads: int = 1,
         real_time: bool = False, device: str = "", validation: bool = False) -> World:
    """Opens a scene in this process.

    scene: a TOML file in which something moves by physics. seed: instead of the scene's. threads: that
    share a step. real_time: ticks wait for the clock, else they run at once. device: of images, a part
    of its name. validation: of Vulkan, for images."""
    return World(_core.World(os.fspath(scene), seed, real_time, threads, device, validation))
