"""A scene in this process: stepped by ticks, read by stream, commanded by agent."""

from __future__ import annotations

import asyncio
import os
import tempfile
from collections import deque
from typing import Any, AsyncIterator, Callable, Iterator, Mapping, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .agents import MOST_NUMBERS, Agent, Diver, TrackedObject, Vehicle
from .arguments import finite, flag, number, numbers, path as path_of, shown, whole, word
from .errors import BadInput, Error
from .observations import MODEM_EVENTS, Image, Message, Observations, Reading, Stream, Table, Truth, offsets_of
from .sources import Counts, sources_of

MOST_STEPS = 100_000_000
"""Steps of one tick, at most."""


class Recording:
    """A recording that goes on until its `with` block ends, until stop() or until the world closes."""

    def __init__(self, core: _core.World) -> None:
        self._core, self._on = core, True

    def stop(self) -> None:
        """Ends it and writes what is left; an Error if that cannot be done. Once it has ended, does nothing."""
        on, self._on = self._on, False
        if on and not self._core.closed:  # close() ended it
            self._core.stop_recording()

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, kind: object, error: Optional[BaseException], trace: object) -> None:
        try:
            self.stop()
        except Error as failed:
            if error is None:
                raise
            error.add_note(f"the recording: {failed}")  # beside the block's own exception, which is what ended it


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
        self._offsets = [offsets_of(stream.fields) for stream in self._streams]
        self._table = Table(self._streams, self._places, self._offsets)
        self._callbacks: dict[str, list[Callable[[Any], None]]] = {}
        # What came for callbacks and was not given to them: with callbacks that are left of it, or all (None).
        self._came: deque[tuple[Union[Reading, Image], Optional[list[Callable[[Any], None]]]]] = deque()
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
    def objects(self) -> list[str]:
        """Names of the scene's objects. A number in a reading (`gaze_object`, `held`) counts from 1 in this list; 0 is nothing."""
        return list(self._core.objects)

    @property
    def agents(self) -> Mapping[str, Agent]:
        """Vehicles, divers and objects that can be commanded, by name."""
        return dict(self._agents)

    def __getitem__(self, name: str) -> Any:
        """The agent of that name."""
        try:
            return self._agents[name]
        except (KeyError, TypeError):
            raise BadInput(f"agent: found {shown(name)}; accepted: {', '.join(self._agents)}") from None

    def __contains__(self, name: object) -> bool:
        """Whether an agent has that name."""
        return name in self._agents.keys()

    def __iter__(self) -> Iterator[str]:
        """The names of its agents."""
        return iter(self._agents)

    def truth(self, agent: str) -> Truth:
        """The true motion of the agent, apart from what is measured of it."""
        return Truth(**{"time": self._core.time, **self._core.truth(word("truth: agent", agent))})

    # Time.

    def tick(self, steps: int = 1) -> Observations:
        """Runs this number of physics steps, up to MOST_STEPS, and returns what has arrived by then. Callbacks run
        after them. Ctrl-C ends it after a step: the steps until then are done."""
        of = self._run(whole("tick: steps", steps, 0, MOST_STEPS))
        self._call_back()
        return Observations(self._table, of, self._images)

    def observe(self) -> Observations:
        """Returns what has arrived so far, without a step."""
        of = self._core.newest()
        self._take()
        return Observations(self._table, of, self._images)

    def ticks(self, steps: int = 1, count: Optional[int] = None) -> AsyncIterator[Observations]:
        """Ticks of this number of steps, as an asynchronous iterator. Each runs on another thread, so that the
        event loop continues. count: the number of ticks; None: without end. Cancelled, it ends after a step, and the
        world can be used at once."""
        return self._ticks(whole("ticks: steps", steps, 0, MOST_STEPS),
                           None if count is None else whole("ticks: count", count, 0, 2**63 - 1))

    async def _ticks(self, steps: int, count: Optional[int]) -> AsyncIterator[Observations]:
        done = 0
        while count is None or done < count:
            running = asyncio.get_running_loop().run_in_executor(None, self._run, steps)
            try:
                of = await asyncio.shield(running)
            except asyncio.CancelledError:
                while not running.done():  # a stop between two parts of the tick, or before its first, ends nothing
                    self._core.stop()
                    try:
                        await asyncio.wait([running], timeout=0.01)
                    except asyncio.CancelledError:
                        pass  # asked once more: it is on its way
                running.exception()  # that it was stopped is no news
                raise
            self._call_back()
            yield Observations(self._table, of, self._images)
            done += 1

    def on(self, stream: str, call: Callable[[Any], None]) -> None:
        """Calls `call(reading)` after each tick, for every reading (or image) of the stream that arrived
        in it, in the order of arrival. All are called, then the first exception of one is raised. Images must be
        wanted with keep=True; of a tick the newest 64 come, and counts() has the others."""
        place = self._place(stream)
        if not callable(call):
            raise BadInput(f"on: {stream}: found {shown(call)}; accepted: a function of one reading")
        if self._streams[place].sort != "image":
            self._core.keep(place, True)
        self._callbacks.setdefault(stream, []).append(call)

    def off(self, stream: str) -> None:
        """Ends the callbacks of a stream."""
        place = self._place(stream)
        self._callbacks.pop(stream, None)
        if self._streams[place].sort != "image" and stream not in self._mail:
            self._core.keep(place, False)

    def link(self, stream: str, delay: float = 0.0, jitter: float = 0.0, loss: float = 0.0) -> None:
        """Readings of the stream arrive `delay` seconds late plus up to `jitter` (evenly distributed), and a share
        `loss` never. The measurements and their stamps do not change. Readings that overtake others come as they arrive; an
        observation has the one that was measured last. Inputs have no link: a command acts with the next step."""
        place = self._place(stream)
        row = numbers(f"link: {stream}: delay, jitter, loss", (delay, jitter, loss), 3)
        self._core.set_link(place, *row.tolist())

    # Images.

    def images(self, *streams: str, rate: float = 0.0, keep: bool = False) -> None:
        """Asks for images of these streams from the next tick on, "eye/color" or "rov_sonar/echoes", at the multiples
        of 1 / `rate` s, up to the sensor's own rate (0: that one), counted from time 0: a tick that ends at such a time gives
        that image. At most one image a step comes: of a faster sensor as many a second as the physics has steps. The first
        call makes a Vulkan device. keep: callbacks get every image, not the newest of each tick alone."""
        rate, keep = float(numbers("images: rate", rate, 1)[0]), flag("images: keep", keep)
        for stream in streams:
            self._core.want_image(self._place(stream), rate, keep)
            self._senses = True

    def no_images(self, *streams: str) -> None:
        """Ends the images of these streams."""
        for stream in streams:
            self._core.drop_image(self._place(stream))
        self._images = {name: image for name, image in self._images.items() if name not in streams}

    # State.

    def save(self) -> bytes:
        """The whole state as bytes, for restore() or `neritic dive --restore`."""
        return self._core.save()

    def restore(self, state: Union[bytes, bytearray, memoryview, NDArray[np.uint8]]) -> None:
        """Continues from a saved state of this scene and seed. Readings on their way are dropped, and a stream is empty until
        its sensor reads again. A command that acted when it was saved goes on, until release() or another command."""
        try:
            state = bytes(memoryview(state))
        except (TypeError, BufferError):
            raise BadInput(f"restore: found {shown(state)}; accepted: bytes that save() gave") from None
        self._check_recording("restore")
        self._core.restore(state)
        self._images = {}
        self._came.clear()
        for mail in self._mail.values():
            mail.clear()

    def record(self, path: Union[str, os.PathLike[str]]) -> Recording:
        """Records what follows, up to the end of a block, stop() or close(): `with world.record("out/run"): ...` writes
        out/run.mcap, which `neritic dive --replay` repeats and ROS 2 tools read, and out/run.csv."""
        name = path_of("record", path)
        self._check_recording("record")
        self._check_record(name)
        self._core.record(name)
        return Recording(self._core)

    def _check_recording(self, what: str) -> None:
        if self._core.recording:
            raise BadInput(f"{what}: found a recording that goes on; accepted: the end of its `with` block, or its stop(), before it")

    def _check_record(self, name: str) -> None:
        """Refuses a file that could not be written, before anything runs."""
        folder, stem = os.path.split(name)
        if os.path.isdir(name):
            raise BadInput(f"record: found a folder {name}; accepted: a file's name, as {os.path.join(name, 'run')}")
        if not stem:
            raise BadInput(f"record: found '{name}'; accepted: a file's name")
        try:
            with tempfile.TemporaryFile(dir=folder or "."):
                pass
        except OSError as error:
            raise BadInput(f"record: found folder '{folder or '.'}' ({error.strerror}); accepted: one that can be written") from None
        for end in (".mcap", ".csv"):
            if os.path.isdir(name.removesuffix(".mcap") + end):
                raise BadInput(f"record: found a folder {name.removesuffix('.mcap')}{end}; accepted: a file's name")

    def inject(self, stream: str, values: ArrayLike, source: str, stamp: Optional[float] = None) -> None:
        """Sends a sample into a stream of inputs, as the device `source` would. It acts if that source has the
        authority. stamp: when it was measured; None: now."""
        word("inject: stream", stream)
        source = word(f"inject: {stream}: source", source)
        if stamp is not None:
            stamp = number(f"inject: {stream}: stamp", stamp, -1e9, 1e9)
        row = finite(f"inject: {stream}", numbers(f"inject: {stream}", values), MOST_NUMBERS)
        try:
            self._core.inject(stream, row, source, stamp)
        except BadInput:
            if stamp is None or stamp <= self.observe().time:
                raise
            raise BadInput(f"inject: {stream}: stamp: found {stamp:g} s; accepted: up to now, {self.time:g} s") from None

    def close(self) -> None:
        """Ends the world and its recording. A tick of another thread ends after its step."""
        self._core.close()

    def counts(self) -> Counts:
        """Losses: dropped_readings, of readings and images that came faster than they were taken; sources, by name: what
        became of the samples of each, its health and its clock (Source)."""
        return {"dropped_readings": self._core.dropped, "sources": sources_of(self._core.sources())}

    def __enter__(self) -> World:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if self._core.closed:
            return "<closed world>"
        return f"<world '{self.title}' at {self.time:.4f} s: {', '.join(self._agents)}>"

    # Inside.

    def _place(self, stream: str) -> int:
        return self._core.stream(word("stream", stream))

    def _run(self, steps: int) -> Any:
        """The steps, in parts between which what arrived is taken, so that none of it is lost."""
        end = self._core.step + steps
        while True:
            of = self._core.tick(end - self._core.step)
            self._take()
            if of.step >= end:
                return of

    def _take(self) -> None:
        """Takes what arrived from the core: messages into the mail, images and all for callbacks."""
        if self._senses:
            self._take_images()
        if not self._callbacks and not self._mail:
            return
        arrived = self._core.take_arrived()
        for i in range(len(arrived)):
            place = arrived.header(i)[0]
            reading = Reading(arrived, i, self._streams[place], self._offsets[place])
            if reading.stream in self._mail:
                self._sort_mail(reading)
            if reading.stream in self._callbacks:
                self._came.append((reading, None))

    def _take_images(self) -> None:
        newest = dict(self._images)
        for one in self._core.take_images():
            image = Image(one, self._streams[one.stream])
            if image.stream not in newest or image.stamp >= newest[image.stream].stamp:
                newest[image.stream] = image
            if image.stream in self._callbacks:
                self._came.append((image, None))
        self._images = newest  # observations that were given keep theirs

    def _call_back(self) -> None:
        """Gives all that came to its callbacks; then the first of their exceptions goes on. What ends the program, as
        Ctrl-C does, goes on at once, and the rest comes with the next tick."""
        first, more = None, 0
        while self._came:
            came, calls = self._came.popleft()
            left = list(self._callbacks.get(came.stream, ())) if calls is None else calls
            while left:
                call = left.pop(0)
                try:
                    call(came)
                except Exception as error:
                    more += first is not None
                    first = first or error
                except BaseException:
                    self._came.appendleft((came, left))
                    raise
        if first is not None:
            if more:
                first.add_note(f"{more} more callbacks of this tick raised exceptions")
            raise first

    def _sort_mail(self, reading: Reading) -> None:
        if MODEM_EVENTS[int(reading.event)] != "received" or reading.message_kind:
            return
        data = np.asarray(reading.words, "<u4").tobytes()[:int(reading.bytes)]
        self._mail[reading.stream].append(
            Message(self._modems[int(reading.sender) - 1], data, reading.sent, reading.heard,
                    reading.stamp, reading.snr_db))


def open(scene: Union[str, os.PathLike[str]], seed: Optional[int] = None, *, threads: int = 1,
         real_time: bool = False, device: str = "", validation: bool = False) -> World:
    """Opens a scene in this process.

    scene: a TOML file in which something moves by physics. seed: replaces the scene's. threads: their number
    in a step; 0: by the scene's size. real_time: ticks wait for the clock, and the scene's devices send; else ticks run at once.
    device: a part of the name of the Vulkan device for images. validation: checks Vulkan calls."""
    if seed is not None:
        seed = whole("seed", seed, 0, 2**64 - 1)
    return World(_core.World(path_of("scene", scene), seed, flag("real_time", real_time), whole("threads", threads, 0, 2**32 - 1),
                             word("device", device), flag("validation", validation)))
