"""Neritic from Python: worlds of divers and underwater robots, in this process.

    import neritic
    world = neritic.open("scene.toml", seed=1)
    rov = world["rov"]
    rov.goto(4, 3, -7)                # east, north, up in metres
    obs = world.tick(240)             # physics steps
    print(obs["rov/imu"].linear_acceleration, world.truth("rov").position)

Conventions are ROS's: the world is east, north, up; bodies are forward, left, up; quaternions are
x, y, z, w; SI units, radians. Times are simulated seconds.

open(scene)       a World: tick, observations, agents, images, save, restore, record
connect(address)  the same on a server, `neritic serve`
vector(task)      thousands of environments at once, with Gymnasium's vector interface
human_state(...)  what a robot may know of a diver, each value with its quality
Error, BadInput   the exceptions, one line each
"""

from importlib import import_module
from typing import Any

from . import _core
from .agents import Agent, Diver, TrackedObject, Vehicle
from .errors import BadInput, Error
from .human import Value, human_state
from .observations import MODEM_EVENTS, Image, Message, Observations, Reading, Stream, Truth
from .remote import RemoteWorld, connect
from .sources import Counts, Link, ServerCounts, Source
from .vector import VectorEnv, vector
from .world import Recording, World, open

_core.set_errors(Error, BadInput)


def __getattr__(name: str) -> Any:
    """neritic.gym, which needs Gymnasium, is loaded when it is used first."""
    if name == "gym":
        return import_module("neritic.gym")
    raise AttributeError(f"module 'neritic' has no attribute '{name}'")


__all__ = [
    "Agent", "BadInput", "Counts", "Diver", "Error", "Image", "Link", "MODEM_EVENTS", "Message", "Observations", "Reading", "Recording",
    "RemoteWorld", "ServerCounts", "Source", "Stream", "TrackedObject", "Truth", "Value", "VectorEnv", "Vehicle", "World", "connect", "human_state", "open",
    "vector",
]
