"""What Python costs on this machine: `python3 -m neritic.speed`.

How far a tick of a scene with one vehicle exceeds its step; how long a sonar's image of 500 x 500 floats takes from the
core, and from a server of this machine, into an array; how many steps vectorised environments make a second."""

from __future__ import annotations

import math
import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from . import _core
from .errors import Error
from .remote import connect
from .vector import TASKS, _vehicle_file, vector
from .world import World
from .world import open as open_world

BINS = 500
PROGRAM = os.environ.get("NERITIC", str(Path(_core.__file__).parents[2] / "tools/neritic"))
_SCENE = """title = "One vehicle before a wall"
[physics]
[[objects]]
name = "wall"
shape = "box"
size_m = [4, 4, 0.2]
position_m = [0, -5, -3]
[[vehicles]]
name = "rov"
shape = "box"
dynamics = "{vehicle}"
position_m = [0, -5, 0]
[[vehicles.sonars]]
name = "sonar"
kind = "imaging"
range_m = [1, 5]
azimuth_deg = 90
elevation_deg = 28
bins = [{bins}, {bins}, {bins}]
rate_hz = 10
"""


@contextmanager
def scene() -> Iterator[str]:
    """The file of a scene with one vehicle that has a sonar."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "one_vehicle.toml"
        file.write_text(_SCENE.format(vehicle=_vehicle_file(), bins=BINS))
        yield str(file)


def tick_above_step_us(rounds: int = 20, ticks: int = 240) -> list[float]:
    """Processor time by which a tick of one step exceeds a step of a long tick, for each round."""
    def spent(world: World, times: int, steps: int) -> float:
        begun = time.thread_time()
        for _ in range(times):
            world.tick(steps)
        return 1e6 * (time.thread_time() - begun) / (times * steps)

    with scene() as file, open_world(file, seed=1) as world:
        world.tick(ticks)
        return [spent(world, ticks, 1) - spent(world, 1, ticks) for _ in range(rounds)]


def _read_ms(world: World, take: str, rounds: int) -> list[float]:
    """The time of the core's call that brings an image, and of its first and last number, for each image."""
    core, spent = world._core, [0.0]
    call = getattr(core, take)

    def timed(*arguments: Any) -> Any:
        begun = time.perf_counter()
        out = call(*arguments)
        spent[0] = time.perf_counter() - begun
        return out

    class Timed:
        def __getattr__(self, name: str) -> Any:
            return timed if name == take else getattr(core, name)

    if isinstance(core, _core.World):
        world._core = Timed()  # type: ignore[assignment]
    else:
        setattr(core, take, timed)
    world.images("rov_sonar/echoes")
    out = []
    for _ in range(rounds):
        seen = world.tick(round(0.1 / world.step_s))
        begun = time.perf_counter()
        pixels = seen["rov_sonar/echoes"].pixels
        if pixels.shape != (BINS, BINS) or not math.isfinite(pixels.item(0) + pixels.item(-1)):
            raise Error(f"found an image of {pixels.shape}; accepted: {BINS} x {BINS}")
        out.append(1e3 * (spent[0] + time.perf_counter() - begun))
    return out


def image_ms(rounds: int = 20) -> list[float]:
    """Milliseconds of each image from the core of this process into an array."""
    with scene() as file, open_world(file, seed=1) as world:
        return _read_ms(world, "take_images", rounds)


def remote_image_ms(rounds: int = 20) -> list[float]:
    """Milliseconds of each image from the answer of a server of this machine into an array."""
    with scene() as file:
        address = f"tcp://127.0.0.1:{48000 + os.getpid() % 900}"
        server = subprocess.Popen([PROGRAM, "serve", file, "--bind", address], stdout=subprocess.PIPE, text=True)
        try:
            server.stdout.readline()  # type: ignore[union-attr]
            with connect(address) as world:
                return _read_ms(world, "_bring", rounds)
        finally:
            server.terminate()
            server.communicate()


def env_steps(task: str, num_envs: int, seconds: float = 2.0) -> tuple[float, float]:
    """Steps of environments a second of wall time on all cores, the call included, and microseconds of processor time
    of each."""
    env = vector(task, num_envs)
    actions = np.random.default_rng(1).uniform(-0.5, 0.5, (num_envs, 8)).astype(np.float32)
    env.step(actions)
    begun, spent, calls = time.perf_counter(), time.process_time(), 0
    while time.perf_counter() - begun < seconds:
        env.step(actions)
        calls += 1
    steps = calls * num_envs
    return steps / (time.perf_counter() - begun), 1e6 * (time.process_time() - spent) / steps


def _words(error: Exception) -> str:
    """One line of what went wrong outside."""
    if isinstance(error, OSError) and error.filename is not None:
        return f"{error.filename}: {error.strerror}"
    return " ".join(str(error).split())


def _table() -> bool:
    """Prints it; false: an image could not be had."""
    def line(what: str, unit: str, times: list[float]) -> None:
        print(f"{what}: least {min(times):.3g} {unit}, median {np.median(times):.3g}, largest {max(times):.3g}")

    whole = True
    print(f"load average {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores")
    line("a tick above its step", "us", tick_above_step_us())
    for what, images in (("in this process", image_ms), ("from a server", remote_image_ms)):
        try:
            line(f"an image of {BINS} x {BINS} floats {what}", "ms", images())
        except (Error, OSError) as error:
            whole = False
            print(f"an image {what}: {_words(error)}")
    for task in TASKS:
        for num_envs in (256, 4096):
            rate, cost_us = env_steps(task, num_envs)
            print(f"{task}, {num_envs} environments: {rate / 1e3:.0f} 000 steps a second, {cost_us:.2f} us of a core each")
    return whole


def main() -> int:
    """Prints the table. 0; 1 where something could not be measured, with a line that says why."""
    try:
        whole = _table()
        sys.stdout.flush()
        return 0 if whole else 1
    except BrokenPipeError:  # whoever read it, as head, has enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except (Error, OSError) as error:
        print(f"neritic.speed: {_words(error)}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
