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
import sys
import time
from typing import Mapping, NoReturn, Optional

import numpy as np

from .remote import RemoteWorld, connect
from .agents import Agent, Diver, TrackedObject
from .arguments import number
from .errors import BadInput, Error
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
    """Exchanges poses while the world here, opened with real_time=True, runs. BadInput: the server steps in lock-step,
    or another client is `own` there."""
    if not there.real_time:
        raise BadInput("found a server in lock-step, whose time others tick; accepted: one of neritic serve --realtime, or of "
                       "neritic dive --serve")
    if own is not None:
        there.be(own)
    steps = max(1, round(1.0 / (rate_hz * here.step_s)))
    end = None if seconds is None else time.monotonic() + seconds
    while end is None or time.monotonic() < end:
        exchange(here, there, own)
        here.tick(steps)


def _check_own(own: str, here: Mapping[str, Agent], there: Mapping[str, Agent]) -> None:
    """Refuses a participant that this side does not have or that the server's does not take a pose of."""
    if own not in here:
        raise BadInput(f"--as: found '{own}'; accepted, of the scene here: {', '.join(here) or 'none'}")
    if not isinstance(there.get(own), TrackedObject):
        fit = [name for name, agent in there.items() if name in here and isinstance(agent, TrackedObject)]
        raise BadInput(f"--as: found '{own}', which is no object with a pose input in the server's scene; accepted: "
                       f"{', '.join(fit) or 'none: no such object is a participant here'}")


class _Flags(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        raise BadInput(f"{message}; accepted: see --help")


def main() -> int:
    """The command line. Exit status: 0 done, 1 it could not be done, 2 bad input."""
    parser = _Flags(prog="neritic.join", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("server", help="tcp://ADDRESS:PORT")
    parser.add_argument("scene", help="the scene here")
    parser.add_argument("--as", dest="own", help="the participant that is here (default: none)")
    parser.add_argument("--key", help="NAME.secret of neritic keys")
    parser.add_argument("--server-key", help="server.public")
    parser.add_argument("--seconds", type=float, help="ends after this time")
    try:
        flags = parser.parse_args()
        seconds = None if flags.seconds is None else number("--seconds", flags.seconds, 0.0)
        with open(flags.scene, real_time=True) as here, \
                connect(flags.server, name=flags.own or World.source, key=flags.key, server_key=flags.server_key) as there:
            if flags.own is not None:
                _check_own(flags.own, here.agents, there.agents)
            join(here, there, flags.own, seconds)
    except BadInput as error:
        print(f"neritic.join: {error}", file=sys.stderr)
        return 2
    except (Error, OSError) as error:
        print(f"neritic.join: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        pass
    return 0


if __name__ == "__main__":
    sys.exit(main())
