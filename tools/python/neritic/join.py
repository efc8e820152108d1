"""Takes part in a dive on a server from this machine: several people and vehicles, each on its own.

    python3 -m neritic.join tcp://SERVER:47910 scene.toml --as rov

In the scene here the participant moves by physics, and the others are objects with a pose input. In the
server's scene the participant is such an object. Poses go both ways as samples, 60 times a second, with
velocities, and each side moves them on between two (testbed/samples). A participant that is silent for half a
second returns to its own track. Elsewhere a diver is an object with a diver's model and the diver's own
limbs: a suit here moves them there. Messages by modem stay in the scene where they are sent.
"""

from __future__ import annotations

import argparse
import time
from typing import Optional

import numpy as np

from .remote import RemoteWorld, connect
from .agents import Diver, TrackedObject
from .observations import Truth
from .world import World, open

_HOLD_S = 0.5


# A diver's body has forward from the hips to the head; a diver's model stands.
_STANDS = np.array((0.0, np.sqrt(0.5), 0.0, np.sqrt(0.5)))


def _times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The product of two rotations x, y, z, w."""
    return np.array((*(a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])), a[3] * b[3] - a[:3] @ b[:3]))


def _turned(orientation: np.ndarray, v: np.ndarray) -> np.ndarray:
    """A vector of the body in the world."""
    axis, w = orientation[:3], orientation[3]
    t = 2.0 * np.cross(axis, v)
    return v + w * t + np.cross(axis, t)


def _place(world: World, name: str, truth: Truth, diver: bool) -> None:
    drawn = _times(truth.orientation, _STANDS) if diver else truth.orientation
    world[name].pose(truth.position, drawn, _turned(truth.orientation, truth.linear_velocity),
                     _turned(truth.orientation, truth.angular_velocity), hold=_HOLD_S)
    if diver and truth.joints.size and f"{name}/joints" in world._places:
        world[name].joints(truth.joints, hold=_HOLD_S)


def exchange(here: World, there: RemoteWorld, own: Optional[str]) -> int:
    """Sends the pose of `own` (None: no one) and fetches those of the others; returns their number."""
    if own is not None:
        _place(there, own, here.truth(own), isinstance(here[own], Diver))
    placed = 0
    for name, truth in there.poses().items():
        if name != own and isinstance(here.agents.get(name), TrackedObject):
            _place(here, name, truth, isinstance(there[name], Diver))
            placed += 1
    return placed


def join(here: World, there: RemoteWorld, own: Optional[str], seconds: Optional[float] = None,
         rate_hz: float = 60.0) -> None:
    """Exchanges poses while the world here, opened with real_time=True, runs."""
    steps = max(1, round(1.0 / (rate_hz * here.step_s)))
    end = None if seconds is None else time.monotonic() + seconds
    while end is None or time.monotonic() < end:
        exchange(here, there, own)
        here.tick(steps)


def main() -> None:
    """The command line."""
    parser = argparse.ArgumentParser(prog="neritic.join", description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("server", help="tcp://ADDRESS:PORT")
    parser.add_argument("scene", help="the scene here")
    parser.add_argument("--as", dest="own", help="the participant that is here (default: none)")
    parser.add_argument("--key", help="NAME.secret of neritic keys")
    parser.add_argument("--server-key", help="server.public")
    parser.add_argument("--seconds", type=float, help="ends after this time")
    flags = parser.parse_args()
    name = flags.own or World.source
    with open(flags.scene, real_time=True) as here, \
            connect(flags.server, name=name, key=flags.key, server_key=flags.server_key) as there:
        try:
            join(here, there, flags.own, flags.seconds)
        except KeyboardInterrupt:
            pass


if __name__ == "__main__":
    main()
