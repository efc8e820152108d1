"""The agents of a world: vehicles, divers, objects, and what can be asked of them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import finite, flag, numbers, rotations, shown, whole, word
from .errors import BadInput
from .observations import Message

if TYPE_CHECKING:
    from .world import World


MOST_NUMBERS = 256
"""Of a command, at most (testbed/server/request.hpp)."""
MOST_BYTES = 64
"""Of a message by sound (testbed/samples/payloads.hpp)."""
MOST_TANKS = 4
"""A diver's tanks, at most (diver/gear.hpp)."""


def _choice(name: str, what: str, choice: str, words: Sequence[str]) -> int:
    if not isinstance(choice, str) or choice not in words:
        raise BadInput(f"{name}: {what}: found {shown(choice)}; accepted: {', '.join(words)}")
    return list(words).index(choice)


def _joints(name: str, values: ArrayLike) -> NDArray[np.float64]:
    return rotations(f"{name}: joints", values, 15)


class Agent:
    """A vehicle, a diver or an object of the scene. A command holds until the next one, until release() or,
    with hold > 0, for that number of seconds."""

    def __init__(self, world: World, name: str) -> None:
        self._world, self.name = world, name
        self.modem = 0
        """The number of its modem among the scene's, from 1 on; 0: it has none."""

    def send(self, data: Union[bytes, str], to: Optional[str] = None) -> None:
        """Sends up to 64 bytes by sound with the next step, to one agent's modem or to all (None). The message
        arrives later or is lost: the other agent's receive() returns it, and readings of NAME/modem tell
        what became of it (event: MODEM_EVENTS). A step handles four messages, up to 32 wait; those that
        come while the modem sends, or while 32 of its messages travel, are refused."""
        try:
            data = data.encode() if isinstance(data, str) else bytes(memoryview(data))
        except (TypeError, UnicodeEncodeError):
            raise BadInput(f"{self.name}: send: found {shown(data)}; accepted: a text or bytes") from None
        if not 1 <= len(data) <= MOST_BYTES:
            raise BadInput(f"{self.name}: send: found {len(data)} bytes; accepted: 1 to {MOST_BYTES}")
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
                           f"{', '.join(self._world._modems) or 'none: the scene has no modem'}")
        mail = self._world._mail[f"{self.name}/modem"]
        messages = list(mail)
        mail.clear()
        return messages

    def command(self, kind: str, values: ArrayLike, hold: float = 0.0) -> None:
        """A command by its name and numbers, as the methods below send it."""
        kind = word(f"{self.name}: command", kind)
        where = f"{self.name}: {kind}"
        self._world._core.command(self.name, kind, finite(where, numbers(where, values), MOST_NUMBERS),
                                  float(numbers(f"{self.name}: {kind}: hold", hold, 1)[0]), self._world.source)

    def _joined(self, kind: str, hold: float, **parts: tuple[ArrayLike, int]) -> None:
        """A command made of parts: each its values and how many they must be. An orientation is a rotation."""
        self.command(kind, np.concatenate([rotations(f"{self.name}: {kind}: {part}", values, 1) if part == "orientation"
                                           else numbers(f"{self.name}: {kind}: {part}", values, count)
                                           for part, (values, count) in parts.items()]), hold)

    def grip(self, choice: str) -> None:
        """Its gripper or hands: "close" grabs what comes into reach, "open" drops it, "auto" keeps what it has
        (hands take what a gripper holds out). Readings of NAME/gripper tell the result."""
        self.command("grip", [_choice(self.name, "grip", choice, ("auto", "open", "close"))])

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
        """Least and most force that a command gives each thruster, in newtons, at the voltage of its file."""
        self.takes_pwm = takes_pwm
        """Whether its file names a thrust table, which pwm() needs."""

    def goto(self, x: float, y: float, z: float, yaw: float = 0.0,
             velocity: Sequence[float] = (0.0, 0.0, 0.0), hold: float = 0.0) -> None:
        """Go to this place and stay there, level: east, north, up in metres, yaw from east towards north.
        velocity: of the place itself, if it moves."""
        self._joined("goto", hold, x=(x, 1), y=(y, 1), z=(z, 1), yaw=(yaw, 1), velocity=(velocity, 3))

    def velocity(self, forward: float, left: float = 0.0, up: float = 0.0, yaw_rate: float = 0.0,
                 hold: float = 0.0) -> None:
        """Move over ground at this velocity, level: m/s relative to the heading, and rad/s. One beyond what its thrusters
        reach in that direction is cut to it; more than 100 m/s or rad/s is refused."""
        self._joined("velocity", hold, forward=(forward, 1), left=(left, 1), up=(up, 1), yaw_rate=(yaw_rate, 1))

    def wrench(self, force: Sequence[float], torque: Sequence[float] = (0.0, 0.0, 0.0),
               hold: float = 0.0) -> None:
        """Forces and moments in N and N m, body axes. Where they are 0, depth and heading are held."""
        self._joined("wrench", hold, force=(force, 3), torque=(torque, 3))

    def thrusters(self, force_n: ArrayLike, hold: float = 0.0) -> None:
        """The force of each thruster in N, in the order of the vehicle's file. Nothing is held. It acts from the next step
        on, while goto, velocity and wrench act through the autopilot at the rate of the vehicle's file (50 Hz unless
        its [control] says otherwise). Thrusters follow with their lag."""
        self.command("thrusters", force_n, hold)

    def pwm(self, width_us: ArrayLike, hold: float = 0.0) -> None:
        """The pulse width of each thruster's controller in microseconds: 1500 stands still. It acts as thrusters()."""
        self.command("pwm", width_us, hold)

    def fail(self, thrusters: Sequence[int] = ()) -> None:
        """These thrusters, counted from 0, give no thrust from now on; () repairs all."""
        failed = np.zeros(len(self.thruster_n))
        for place in [thrusters] if np.ndim(thrusters) == 0 else thrusters:
            failed[whole(f"{self.name}: fail", place, 0, len(failed) - 1)] = 1.0
        self.command("faults", failed)


class Diver(Agent):
    """A diver."""

    def jacket(self, inflate: bool = False, deflate: bool = False, dump: bool = False,
               hold: float = 0.0) -> None:
        """The jacket's buttons that are pressed from now on."""
        pressed = {"inflate": inflate, "deflate": deflate, "dump": dump}
        self.command("buttons", [flag(f"{self.name}: jacket: {name}", value) for name, value in pressed.items()], hold)

    def joints(self, rotations: ArrayLike, hold: float = 0.0) -> None:
        """15 rotations, parent from child, as quaternions x y z w: abdomen, thorax, head; left upper
        arm, forearm, hand; right ones; left upper leg, lower leg, foot; right ones."""
        self.command("joints", _joints(self.name, rotations), hold)

    def head(self, orientation: Sequence[float], position: Optional[Sequence[float]] = None,
             hold: float = 0.0) -> None:
        """The head's orientation (world from head; forward, left, up) and, if given, its position."""
        placed = position is not None
        self._joined("head", hold, position=(position if placed else np.zeros(3), 3), orientation=(orientation, 4),
                     placed=(placed, 1))

    def gas(self, tank: int) -> None:
        """Breathe from that tank; 0 is the first."""
        self.command("gas", [whole(f"{self.name}: gas", tank, 0, MOST_TANKS - 1)])

    def regulator(self, supply: str = "auto", flow: str = "auto") -> None:
        """supply: the diver breathes from "own" tanks, the "donor"'s, or the donor's once the own ones are empty
        ("auto"). flow: the regulator "flows" freely, "holds", or does what the scene says ("auto"). Readings of
        NAME/supply tell the result."""
        self.command("regulator", [_choice(self.name, "supply", supply, ("auto", "own", "donor")),
                                   _choice(self.name, "flow", flow, ("auto", "flows", "holds"))])


class TrackedObject(Agent):
    """An object that devices or programs move."""

    def pose(self, position: Sequence[float], orientation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
             velocity: Optional[Sequence[float]] = None,
             angular_velocity: Sequence[float] = (0.0, 0.0, 0.0), hold: float = 0.0) -> None:
        """Places it there now. Velocities are in world axes; without them they follow from two poses. Until the next pose it
        moves on at them for 0.1 s, or for the time between the last two poses if that is longer; then it stands still."""
        parts = {"position": (position, 3), "orientation": (orientation, 4)}
        if velocity is not None:
            parts.update(velocity=(velocity, 3), angular_velocity=(angular_velocity, 3))
        self._joined("pose", hold, **parts)

    def joints(self, rotations: ArrayLike, hold: float = 0.0) -> None:
        """The limbs of a diver who swims elsewhere, as in Diver.joints(). The object has a diver's model."""
        self.command("joints", _joints(self.name, rotations), hold)
