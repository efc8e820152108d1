"""Thousands of environments at once, with the interface of Gymnasium's VectorEnv."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, spaces
from .arguments import flag, number, path, shown, whole, word
from .errors import BadInput

MOST_ENVS = 2**20
TASKS = ("hover", "track", "dock", "follow", "shark")
RANDOMISED = {
    "mass": 0.05,
    "net_buoyancy_n": 1.0,
    "drag": 0.3,
    "thrust": 0.1,
    "current_m_s": 0.3,
    "position_noise_m": 0.02,
    "velocity_noise_m_s": 0.02,
    "angle_noise_rad": 0.01,
    "rate_noise_rad_s": 0.01,
}
"""How much environments differ, unless vector(randomise=...) says otherwise: shares of the vehicle's
values each way, a largest current, deviations of what is observed."""


class VectorEnv:
    """Environments of one vehicle each, stepped together. Made by neritic.vector(). It is no subclass of
    Gymnasium's, which need not be installed; neritic.gym has one.

    Observations are a dict of float32 arrays, one row an environment, in the vehicle's own axes
    (forward, left, up):

    goal    12  to the goal: place (3), its velocity less the vehicle's (3), turn (3);
                to the task's point (3): a second ahead on the path, the dock's mouth, the diver, the shark
    motion  10  velocity over ground (3), angular velocity (3), up (3), depth
    action      the newest action

    The arrays that reset() and step() return are written in place by the next step: copy what you keep,
    or ask for copies with copy=True.
    """

    metadata: dict[str, Any] = {"render_modes": []}
    render_mode = None
    spec = None

    def __init__(self, task: str, num_envs: int, core: _core.VectorEnv, max_steps: int, step_s: float,
                 autoreset: str, copy: bool) -> None:
        self._core, self._copy = core, copy
        self.task, self.num_envs, self.max_steps, self.step_s = task, num_envs, max_steps, step_s
        self.metadata = {**self.metadata, "autoreset_mode": autoreset}
        self._same_step = autoreset == "same_step"
        self.closed = False
        sizes = {"goal": _core.GOAL, "motion": _core.MOTION, "action": core.actions}
        limits = {name: 1.0 if name == "action" else np.inf for name in sizes}

        def observations(*rows: int) -> spaces.Dict:
            return spaces.Dict({name: spaces.Box(-limits[name], limits[name], (*rows, size))
                                for name, size in sizes.items()})

        self.single_observation_space, self.observation_space = observations(), observations(num_envs)
        self.single_action_space = spaces.Box(-1.0, 1.0, (core.actions,))
        self.action_space = spaces.Box(-1.0, 1.0, (num_envs, core.actions))
        self._observation = {name: np.zeros((num_envs, size), np.float32) for name, size in sizes.items()}
        self._last = {name: np.zeros((num_envs, size), np.float32) for name, size in sizes.items()}
        self._reward = np.zeros(num_envs, np.float32)
        self._terminated = np.zeros(num_envs, np.bool_)
        self._truncated = np.zeros(num_envs, np.bool_)
        last = {"last_" + name: array if self._same_step else None for name, array in self._last.items()}
        core.set_arrays({**self._observation, **last, "reward": self._reward,
                         "terminated": self._terminated.view(np.uint8),
                         "truncated": self._truncated.view(np.uint8)})
        self.reset(seed=0)

    def __enter__(self) -> VectorEnv:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def unwrapped(self) -> VectorEnv:
        """Itself."""
        return self

    def reset(self, *, seed: Union[None, int, Sequence[Optional[int]]] = None,
              options: Optional[Mapping[str, Any]] = None) -> tuple[dict[str, NDArray[np.float32]], dict[str, Any]]:
        """All environments begin an episode: observations and an empty info. seed: a number, of which environment i
        gets seed + i; or one for each. An environment without a seed (None) goes on to its next episode. Until a
        first seed it is 0. Seed and actions give an environment its bits, whatever others are beside it, on any
        number of threads."""
        self._check_open()
        if options:
            raise BadInput(f"options: found {shown(options)}; accepted: none")
        seeds: list[Optional[int]]
        if hasattr(seed, "__iter__") and not isinstance(seed, (str, bytes)) and getattr(seed, "ndim", 1) != 0:
            seeds = [None if one is None else whole("seed", one, 0, 2**64 - 1) for one in seed]
            if len(seeds) != self.num_envs:
                raise BadInput(f"seed: found {len(seeds)} seeds; accepted: a number, or one for each of {self.num_envs}")
        elif seed is None:
            seeds = [None] * self.num_envs
        else:
            first = whole("seed", seed, 0, 2**64 - 1)
            seeds = [(first + i) % 2**64 for i in range(self.num_envs)]
        self._core.reset(seeds)
        return self._given(self._observation), {}

    def step(self, actions: ArrayLike) -> tuple[dict[str, NDArray[np.float32]], NDArray[np.float32],
                                                NDArray[np.bool_], NDArray[np.bool_], dict[str, Any]]:
        """Observations, rewards, terminated, truncated, info. actions: [num_envs, actions] from -1 to 1, others are
        cut to that: shares of each thruster's largest force or, with control="wrench", of the largest surge, sway,
        heave, roll, pitch, yaw.

        An episode that ended begins anew in the next step, which ignores its action and rewards 0. With
        autoreset="same_step" it begins anew in the same step, and info has "final_obs" and "_final_obs"."""
        self._core.step(self._checked(actions))
        info: dict[str, Any] = {}
        if self._same_step:
            over = self._terminated | self._truncated
            if over.any():
                info = {"final_obs": {k: v.copy() for k, v in self._last.items()}, "_final_obs": over}
        if not self._copy:
            return self._observation, self._reward, self._terminated, self._truncated, info
        return (self._given(self._observation), self._reward.copy(), self._terminated.copy(),
                self._truncated.copy(), info)

    def truth(self) -> NDArray[np.float64]:
        """The truth, without noise, [num_envs, 13]: place (east, north, up), rotation (world from body, x y
        z w), velocity over ground and angular velocity (forward, left, up)."""
        self._check_open()
        return self._core.truth()

    @property
    def threads(self) -> int:
        """That share a step."""
        return self._core.threads

    def close(self, **_: Any) -> None:
        """Ends it: what follows is refused."""
        self.closed = True

    def __repr__(self) -> str:
        return f"<{self.num_envs} environments '{self.task}'>"

    def _check_open(self) -> None:
        if self.closed:
            raise BadInput("found environments that are closed; accepted: neritic.vector()")

    def _checked(self, actions: ArrayLike) -> NDArray[np.float32]:
        self._check_open()
        shape = self.action_space.shape
        try:
            array = np.asarray(actions)
        except ValueError:
            raise BadInput(f"actions: found rows of several lengths; accepted: {shape[0]} x {shape[1]} numbers") from None
        if array.shape != shape or array.dtype.kind not in "fiub":
            raise BadInput(f"actions: found {' x '.join(map(str, array.shape)) or 'one'} of {array.dtype.name}; "
                           f"accepted: {shape[0]} x {shape[1]} numbers")
        with np.errstate(over="ignore"):
            array = array.astype(np.float32, order="C", copy=False)
        if not np.isfinite(array).all():
            at, which = np.argwhere(~np.isfinite(array))[0]
            raise BadInput(f"actions: found {array[at, which]} in environment {at}, action {which}; accepted: finite numbers")
        return array

    def _given(self, arrays: Mapping[str, NDArray[np.float32]]) -> dict[str, NDArray[np.float32]]:
        return {name: array.copy() if self._copy else array for name, array in arrays.items()}

def vector(task: str, num_envs: int = 1, *, vehicle: Union[None, str, os.PathLike[str]] = None,
           step_s: float = 0.04, max_steps: int = 500, method: str = "split", substeps: Optional[int] = None,
           thrust_table: bool = True, randomise: Union[bool, Mapping[str, float]] = True,
           control: str = "thrusters", autoreset: str = "next_step", copy: bool = False,
           threads: int = 0) -> VectorEnv:
    """Environments for learning, all of one task:

    hover   stay at a place and a heading       track   follow a point on a smooth path
    dock    come into a dock along its axis     follow  keep beside a diver who swims about
    shark   keep between a diver and a shark

    vehicle: its file; None: a BlueROV2 Heavy. step_s, max_steps: of an episode. method, substeps: "split"
    computes the thrusters' lag exactly and the rest by RK4 in `substeps` substeps (None: none longer than 0.04 s; at
    most 0.1 s is accepted); "guarded" is what a scene's simulation does. `python3 -m neritic.tradeoff` shows error over cost. thrust_table: commands in whole
    microseconds, as in a scene. randomise: True (RANDOMISED), False, or a dict of some of its values.
    control: "thrusters" or "wrench". autoreset: "next_step" or "same_step". threads: 0 for all cores."""
    for name, found, accepted in (("control", control, ("thrusters", "wrench")),
                                  ("autoreset", autoreset, ("next_step", "same_step"))):
        if found not in accepted:
            raise BadInput(f"{name}: found '{found}'; accepted: {', '.join(accepted)}")
    num_envs, max_steps = whole("num_envs", num_envs, 1, MOST_ENVS), whole("max_steps", max_steps, 1, 2**31 - 1)
    file = path("vehicle", vehicle) if vehicle is not None else str(_vehicle_file())
    core = _core.VectorEnv(word("task", task), num_envs, file, number("step_s", step_s), max_steps, word("method", method),
                           0 if substeps is None else whole("substeps", substeps, 1, 1000), flag("thrust_table", thrust_table), _random(randomise),
                           control == "wrench", autoreset == "same_step", whole("threads", threads, 0, 256))
    return VectorEnv(task, num_envs, core, max_steps, step_s, autoreset, flag("copy", copy))


def _random(randomise: Any) -> Optional[dict[str, float]]:
    """What may differ, as True, False or a dict says; None: nothing does."""
    if isinstance(randomise, Mapping):
        for name in randomise:
            if name not in RANDOMISED:
                raise BadInput(f"randomise: found {shown(name)}; accepted: {', '.join(RANDOMISED)}")
        return {**RANDOMISED, **{name: number(f"randomise: {name}", value) for name, value in randomise.items()}}
    if not isinstance(randomise, (bool, np.bool_)):
        raise BadInput(f"randomise: found {shown(randomise)}; accepted: True, False, or a dict of {', '.join(RANDOMISED)}")
    return dict(RANDOMISED) if randomise else None


def _vehicle_file() -> Path:
    # The package lies in tools/python/neritic of the source, whatever link led here.
    return Path(__file__).resolve().parents[3] / "assets/vehicles/bluerov2_heavy_dynamics.toml"
