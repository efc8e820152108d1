"""A scene on a server (`neritic serve`), with the same objects as in this process.

The messages are in testbed/server/PROTOCOL.md. Needs Debian's python3-zmq and python3-msgpack.
"""

from __future__ import annotations

import functools
import os
import re
import socket
import struct
import sys
import threading
import time
import weakref
from typing import Any, Mapping, Optional, Sequence, Union, cast

import numpy as np
from numpy.typing import NDArray

from . import _core
from .arguments import number, path, shown, whole, word
from .errors import BadInput, Error
from .observations import Pixels, Row, Rows, Truth
from .sources import ServerCounts, sources_of
from .world import MOST_STEPS, World

_PROTOCOL = 1
# Limits of one request (testbed/server/request.hpp).
_STEPS, _WAIT_S = 100_000, 60.0
# How long a call waits for a connection that was closed; a server that is no longer heard is gone.
_AGAIN_S, _HEARTBEAT_MS, _DEAD_MS = 1.0, 5000, 15000
# A connection that is not there by then is tried anew: a server in a crowd drops some.
_CONNECT_MS = 2000
# How often a call that waits looks whether another thread closes the connection.
_LOOK_S = 0.05
_UNUSED = 3  # references to an array that its pair alone has: its bytes' and the counting call's own among them
_ROW = struct.Struct("<IIQqq")
# Of an image, in the order of Pixels.
_FACTS = ("stream", "sequence", "stamp_ns", "arrival_ns", "position", "orientation", "intrinsics", "range_m", "azimuth",
          "elevation")
_EVENT = struct.Struct("=Hi")  # of the library's monitor, in this machine's byte order


# Of a word as "<f4", which costs microseconds to read.
_dtype = functools.lru_cache(16)(np.dtype)


class _Buffers:
    """Memory of images, used again when nobody has it any more: the system's new pages cost up to milliseconds an image."""

    MOST = 16

    def __init__(self) -> None:
        self._kept: list[tuple[NDArray[Any], NDArray[np.uint8]]] = []

    def take(self, shape: tuple[int, ...], kind: str) -> tuple[NDArray[Any], NDArray[np.uint8]]:
        """An array and its bytes. The memory belongs to whoever keeps the array, or one of its memory."""
        for both in self._kept:
            if both[0].shape == shape and both[0].dtype == _dtype(kind) and sys.getrefcount(both[0]) == _UNUSED:
                return both
        array = np.empty(shape, _dtype(kind))
        self._kept.append((array, array.reshape(-1).view(np.uint8)))
        if len(self._kept) > self.MOST:
            del self._kept[0]
        return self._kept[-1]


_RINGS: weakref.WeakSet[_core.Ring] = weakref.WeakSet()


def _forking() -> None:
    for ring in _RINGS:
        ring.forking()


os.register_at_fork(before=_forking)


def _end(socket: Any, monitor: Any, context: Any) -> None:
    socket.disable_monitor()
    monitor.close(0)
    socket.close(0)
    context.term()


def _key(file: Union[str, os.PathLike[str]], sort: str) -> bytes:
    name = path("connect: key", file)
    try:
        with open(name, encoding="ascii", errors="replace") as lines:
            found = re.search(rf"^{sort} (\S{{40}})$", lines.read(), re.MULTILINE)
    except (OSError, ValueError) as error:
        raise BadInput(f"{name}: found a file that cannot be read ({getattr(error, 'strerror', None) or error}); "
                       "accepted: a key file of neritic keys") from None
    if not found:
        raise BadInput(f"{name}: found no line \"{sort} KEY\"; accepted: a key file of neritic keys")
    return found[1].encode()


class Core:
    """The other end of a connection, with the interface of a world in this process."""

    def __init__(self, address: str, name: str, key: Optional[str], server_key: Optional[str],
                 patience: float) -> None:
        try:
            import msgpack
            import zmq
        except ImportError as missing:
            raise Error(f"connect: found no {missing.name}; accepted: Debian's python3-zmq and "
                        "python3-msgpack") from None
        if not isinstance(address, str) or not re.fullmatch(r"tcp://[\w.\-]+:\d{1,5}", address) or \
                not 0 < int(address.rpartition(":")[2]) < 65536:
            raise BadInput(f"connect: found {shown(address)}; accepted: tcp://ADDRESS:PORT")
        host = address[len("tcp://"):].rpartition(":")[0]
        try:
            socket.getaddrinfo(host, None, socket.AF_INET)
        except (OSError, UnicodeError) as error:
            raise Error(f"connect: found no computer of the name {host} "
                        f"({getattr(error, 'strerror', None) or error})") from None
        if (key is None) != (server_key is None):
            raise BadInput("connect: found one key; accepted: key and server_key, or neither")
        self._msgpack, self._zmq, self._address, self._patience = msgpack, zmq, address, patience
        self._lock = threading.Lock()
        self._context = zmq.Context()
        way = self._socket = self._context.socket(zmq.DEALER)
        way.linger = 0
        way.heartbeat_ivl, way.heartbeat_timeout, way.connect_timeout = _HEARTBEAT_MS, _DEAD_MS, _CONNECT_MS
        self._monitor = way.get_monitor_socket(zmq.EVENT_HANDSHAKE_SUCCEEDED | zmq.EVENT_DISCONNECTED)
        # Of the connection: whether it is there (None: it never was), and how often it was closed.
        self._there: Optional[bool] = None
        self._closures = 0
        # Also where close() was forgotten: a context waits for open sockets.
        self._end = weakref.finalize(self, _end, way, self._monitor, self._context)
        if key is not None and server_key is not None:
            way.curve_serverkey = _key(server_key, "public")
            way.curve_publickey, way.curve_secretkey = _key(key, "public"), _key(key, "secret")
        self.closed, self.recording, self._next = False, False, 0
        self._ring: Optional[_core.Ring] = None
        self._stop = False  # a tick that goes on ends after its part
        try:
            way.connect(address)
            hello, _ = self._call("hello", protocol=_PROTOCOL, name=name)
        except BaseException:
            self.close()
            raise
        self.title, self.path, self.seed = hello["title"], hello["path"], hello["seed"]
        self.step_s, self.real_time = hello["step_s"], hello["real_time"]
        self.name = hello["name"]
        self.streams = [(s["name"], s["owner"], s["kind"], s["frame"], s["sort"],
                         [tuple(field) for field in s["fields"]], s["rate_hz"], s["encoding"])
                        for s in hello["streams"]]
        self.agents = [(a["name"], a["kind"], [tuple(pair) for pair in a["thruster_n"]],
                        a["takes_pwm"], a["has_mission"], a["modem"]) for a in hello["agents"]]
        self.objects = hello["objects"]
        self._places = {stream[0]: i for i, stream in enumerate(self.streams)}
        self._newest: list[Row] = [((i, 0, 0, 0, 0), np.zeros(0)) for i in range(len(self.streams))]
        self._arrived: list[Row] = []
        self._images: list[Pixels] = []
        self._buffers = _Buffers()
        self.step, self.time = hello["step"], hello["time_ns"] * 1e-9
        self._hash, self._hash_step = 0, -1
        self.lost_readings = self.lost_images = self._lost_here = 0
        self.clock = ""
        self._share(hello.get("shared_memory"))
        self._take(*self._call("observe"))

    # Messages.

    def _watch(self) -> int:
        """How often the connection was closed so far."""
        while self._monitor.poll(0):
            event, _ = _EVENT.unpack(self._monitor.recv_multipart()[0])
            if event == self._zmq.EVENT_HANDSHAKE_SUCCEEDED:
                self._there = True
            elif self._there:
                self._there = False
                self._closures += 1
        return self._closures

    def _ended(self) -> BadInput:
        return BadInput("found a world that is closed; accepted: neritic.connect()")

    def _closed(self) -> Error:
        return Error(f"{self._address}: the connection was closed: the server has ended, or it takes this client no more")

    def _receive(self, until: float, closures: int) -> list[bytes]:
        """The next message; an Error as soon as the connection is closed, or at that time. Empty: look again."""
        left_s = min(max(until - time.monotonic(), 0.0), _LOOK_S)
        poller = self._zmq.Poller()
        poller.register(self._socket, self._zmq.POLLIN)
        poller.register(self._monitor, self._zmq.POLLIN)
        poller.poll(left_s * 1e3)
        if self.closed:
            raise self._ended()
        closed = self._watch() > closures
        try:
            return list(self._socket.recv_multipart(self._zmq.NOBLOCK))
        except self._zmq.Again:
            if closed:
                raise self._closed() from None
            return []

    def _call(self, op: str, lasts: float = 0.0, data: Optional[bytes] = None,
              **keys: Any) -> tuple[dict[str, Any], list[bytes]]:
        with self._lock:
            if self.closed:
                raise self._ended()
            self._next += 1
            frames = [self._msgpack.packb({"op": op, "id": self._next, **keys})]
            again = time.monotonic() + _AGAIN_S
            closures = self._watch()
            while self._there is False and time.monotonic() < again:
                self._monitor.poll(50)
                closures = self._watch()
            if self._there is False:
                raise self._closed()
            self._socket.send_multipart(frames if data is None else [*frames, data])
            until = time.monotonic() + self._patience + lasts
            while True:
                frames = self._receive(until, closures)
                if not frames:
                    if time.monotonic() < until:
                        continue
                    raise Error(f"{self._address}: no answer in {self._patience + lasts:g} s: no server, "
                                "one that is busy, or one with other keys")
                answer = self._msgpack.unpackb(frames[0])
                if answer.get("id") not in (0, self._next):  # 0: the server cannot read which one it refuses
                    if answer.get("ok") and "clock" in answer:
                        self._take(answer, frames)  # of a call that was given up, with what is new
                    continue
                if answer.get("unknown"):
                    raise Error(f"{self._address}: the server knows nothing of this client: it was started anew, or dropped the "
                                "client, which it had not heard for long; accepted: neritic.connect() again")
                if not answer.get("ok"):
                    raise BadInput(f"{self._address}: {answer.get('error', 'refused')}")
                return answer, frames

    def _share(self, path: Optional[str]) -> None:
        if not path or not re.fullmatch(r"/proc/\d+/fd/\d+", path):
            return
        try:
            ring = _core.Ring(path)
            self._call("shared", token=ring.token)
        except (Error, BadInput):
            return  # another machine or user: arrays come as frames
        _RINGS.add(ring)
        self._ring = ring

    def _rows(self, array: Mapping[str, int], frames: list[bytes]) -> list[Row]:
        rows, columns, data = array["rows"], array["columns"], frames[array["frame"]]
        size = _ROW.size + 8 * columns
        if len(data) != rows * size:
            raise Error(f"{self._address}: found {len(data)} bytes of readings; accepted: {rows * size}")
        out = []
        for at in range(0, len(data), size):
            header = _ROW.unpack_from(data, at)
            out.append((header, np.frombuffer(data, "<f8", header[1], at + _ROW.size)))
        return out

    def _take(self, answer: Mapping[str, Any], frames: list[bytes]) -> None:
        if "newest" in answer:
            for row in self._rows(answer["newest"], frames):
                self._newest[row[0][0]] = row
        if "arrived" in answer:
            self._arrived += self._rows(answer["arrived"], frames)
        self._bring(answer.get("images", ()), frames)
        self.lost_readings = answer.get("lost_readings", self.lost_readings)
        self.lost_images = answer.get("lost_images", 0) + self._lost_here
        self.step, self.time = answer["step"], answer["time_ns"] * 1e-9
        self.clock = answer["clock"]
        if "hash" in answer:
            self._hash, self._hash_step = answer["hash"], self.step

    def _bring(self, images: Sequence[Mapping[str, Any]], frames: list[bytes]) -> None:
        """The images of an answer: where they lie in the server's memory, as long as somebody has them, or copied."""
        for facts in images:
            height, width, channels = facts["shape"]
            shape, kind = (height, width) if channels == 1 else (height, width, channels), facts["type"]
            pixels = None
            if self._ring and "shared" in facts:
                pixels = self._ring.lend(facts["shared"], shape, _dtype(kind))
            if pixels is None:
                pixels, data = self._buffers.take(shape, kind)
                if "frame" in facts:
                    memoryview(data)[:] = frames[facts["frame"]]
                elif not self._ring or not self._ring.read(facts["shared"], data):
                    self._lost_here += 1
                    continue
            self._images.append(Pixels(pixels, *map(facts.__getitem__, _FACTS)))

    # A world's interface.

    @property
    def hash(self) -> int:
        if self._hash_step != self.step:
            self._take(*self._call("wait", steps=1, wait_s=0.0))  # answered at once, with the hash
        return self._hash

    def stream(self, name: str) -> int:
        try:
            return self._places[name]
        except KeyError:
            raise BadInput(f"stream: found '{name}'; accepted: {', '.join(self._places)}") from None

    def tick(self, steps: int) -> Rows:
        if steps == 0:
            return self.newest()
        self._stop, end = False, self.step + steps
        while steps > 0:
            part = min(steps, _STEPS)
            self._take(*self._call("tick", 60.0 + part * self.step_s, steps=part))
            # The server ends a part early where much arrived.
            steps = end - self.step
            if self._stop:
                raise Error(f"tick: stopped at step {self.step}, before its end")
        return Rows(list(self._newest), self.step, self.time)

    def stop(self) -> None:
        self._stop = True

    def newest(self) -> Rows:
        self._take(*self._call("observe"))
        return Rows(list(self._newest), self.step, self.time)

    def keep(self, place: int, on: bool) -> None:
        self._call("keep", stream=self.streams[place][0], on=on)

    def take_arrived(self) -> Rows:
        arrived, self._arrived = self._arrived, []
        return Rows(arrived, self.step, self.time)

    def take_images(self) -> list[Pixels]:
        images, self._images = self._images, []
        return images

    def set_link(self, place: int, delay: float, jitter: float, loss: float) -> None:
        self._hold()
        self._call("link", stream=self.streams[place][0], delay_s=delay, jitter_s=jitter, loss=loss)

    def want_image(self, place: int, rate: float, keep: bool) -> None:
        if self._ring:
            self._ring.prepare()
        self._call("image", 60.0, stream=self.streams[place][0], rate_hz=rate, keep=keep)

    def drop_image(self, place: int) -> None:
        self._call("image", stream=self.streams[place][0], on=False)

    def command(self, agent: str, kind: str, values: NDArray[np.float64], hold: float,
                source: str) -> None:
        self._call("command", agent=agent, kind=kind, values=values.tolist(), hold_s=float(hold))

    def release(self, agent: str, source: str) -> None:
        self._call("release", agent=agent)

    def inject(self, stream: str, values: NDArray[np.float64], source: str,
               stamp: Optional[float]) -> None:
        stamps = {} if stamp is None else {"stamp_s": float(stamp)}
        self._call("inject", stream=stream, values=values.tolist(), source=source, **stamps)

    def truth(self, agent: str) -> dict[str, Any]:
        answer = self._call("truth", agent=agent)[0]
        values = np.array(answer["values"])
        return {"time": answer["time_s"], "position": values[0:3], "orientation": values[3:7], "linear_velocity": values[7:10],
                "angular_velocity": values[10:13], "current": values[13:16],
                "touched_steps": int(values[16]), "thruster_n": values[17:],
                "joints": np.array(answer.get("joints", ()), np.float64)}

    def poses(self) -> tuple[float, NDArray[np.float64], dict[int, NDArray[np.float64]]]:
        answer, frames = self._call("poses")
        poses = np.frombuffer(frames[answer["poses"]["frame"]], "<f8").reshape(len(self.agents), 13)
        limbs = answer.get("joints")
        if limbs is None:
            return answer["time_s"], poses, {}
        joints = np.frombuffer(frames[limbs["frame"]], "<f8").reshape(limbs["rows"], limbs["columns"])
        return answer["time_s"], poses, dict(zip(limbs["agents"], joints))

    def save(self) -> bytes:
        answer, frames = self._call("save", 10.0)
        return frames[answer["state"]["frame"]]

    def restore(self, state: bytes) -> None:
        self._hold()
        answer = self._call("restore", 10.0, state)
        self._arrived, self._images = [], []
        self._newest = [((i, 0, 0, 0, 0), np.zeros(0)) for i in range(len(self.streams))]
        self._take(*answer)

    def record(self, name: str) -> None:
        self._call("record", name=name)
        self.recording = True

    def stop_recording(self) -> None:
        self.recording = False
        self._call("stop_recording", 60.0)

    def be(self, participant: str) -> None:
        self._call("hello", protocol=_PROTOCOL, participant=participant)

    def _hold(self) -> None:
        if not self.real_time:
            self.take_clock(True)

    def take_clock(self, take: bool) -> None:
        self._call("clock", take=take)

    def wait(self, steps: int, most: float) -> None:
        self.newest()
        until, end = time.monotonic() + most, self.step + steps
        while self.step < end:
            left_s = min(max(until - time.monotonic(), 0.0), _WAIT_S)
            self._take(*self._call("wait", left_s, steps=min(end - self.step, _STEPS), wait_s=left_s))
            if time.monotonic() >= until:
                return

    def counts(self) -> dict[str, int]:
        return self._call("counts")[0]["counts"]

    def sources(self) -> list[dict[str, Any]]:
        return self._call("sources")[0]["sources"]

    def close(self) -> None:
        try:
            if self.recording and not self.closed:
                self.stop_recording()
        finally:
            self.closed = True
            # A call of another thread ends first; one of this thread is being left.
            free = self._lock.acquire(timeout=1.0)
            self._end()
            if free:
                self._lock.release()


class RemoteWorld(World):
    """A world on a server. In lock-step the first client that ticks holds the clock; in real time the
    world goes on by itself and a tick waits for n steps. `record` takes a plain name: the file is
    the server's."""

    _core: Core

    @property
    def title(self) -> str:
        """The scene's title."""
        return self._open().title

    @property
    def seed(self) -> int:
        """Everything random follows from it."""
        return self._open().seed

    @property
    def step_s(self) -> float:
        """Seconds of a physics step."""
        return self._open().step_s

    @property
    def step(self) -> int:
        """Physics steps so far, as was last heard."""
        return self._open().step

    @property
    def time(self) -> float:
        """Simulated seconds so far, as was last heard."""
        return self._open().time

    def _open(self) -> Core:
        if self._core.closed:
            raise self._core._ended()
        return self._core

    @property
    def clock(self) -> str:
        """The client that holds the clock; empty: nobody."""
        return self._core.clock

    @property
    def lost_readings(self) -> int:
        """Readings that this client was too slow for. A tick in lock-step loses none."""
        return self._core.lost_readings

    @property
    def lost_images(self) -> int:
        """Images that this client was too slow for."""
        return self._core.lost_images

    @property
    def real_time(self) -> bool:
        """Whether the scene there goes on by itself; else in lock-step, when a client ticks."""
        return self._open().real_time

    def be(self, participant: str) -> None:
        """Says that this client is that participant of the scene (neritic.join), until it closes. Refused while
        another client is."""
        self._open().be(word("be: participant", participant))

    def take_clock(self) -> None:
        """Takes the clock before a first tick."""
        self._core.take_clock(True)

    def give_clock(self) -> None:
        """Gives the clock back, so that another client may tick."""
        self._core.take_clock(False)

    def _check_record(self, name: str) -> None:
        """The server does."""

    def _run(self, steps: int) -> Rows:
        of = self._core.tick(steps)
        self._take()
        return of

    def wait(self, steps: int = 1, most: float = 60.0) -> None:
        """Waits until `steps` steps of others are done, at most `most` seconds. Callbacks run after them."""
        self._core.wait(whole("wait: steps", steps, 0, MOST_STEPS), number("wait: most", most, 0.0))
        self._take()
        self._call_back()

    def poses(self) -> dict[str, Truth]:
        """The true motion of every agent, in one call; without the current, forces and contacts."""
        nothing = np.zeros(0)
        time_s, poses, joints = self._core.poses()
        return {agent[0]: Truth(time_s, row[0:3], row[3:7], row[7:10], row[10:13], nothing, nothing, 0,
                                joints.get(i, nothing))
                for i, (agent, row) in enumerate(zip(self._core.agents, poses))}

    def counts(self) -> ServerCounts:
        """The server's counts: clients, requests, refusals, losses; lost_readings and lost_images of this client; sources, by
        name, of all clients and devices, as in World.counts()."""
        return cast(ServerCounts, {**self._core.counts(), "sources": sources_of(self._core.sources()),
                                   "lost_readings": self.lost_readings, "lost_images": self.lost_images})


def connect(address: str, *, name: str = World.source, key: Optional[str] = None,
            server_key: Optional[str] = None, patience: float = 10.0) -> RemoteWorld:
    """Connects to `neritic serve`: connect("tcp://127.0.0.1:47910").

    name: under which commands enter recordings (the key's name with keys). key, server_key: files
    NAME.secret and server.public of `neritic keys`. patience: seconds until a server that does not
    answer is an error."""
    return RemoteWorld(Core(address, word("connect: name", name), key, server_key, number("connect: patience", patience, 0.0)))
