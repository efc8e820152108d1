"""The environments as Gymnasium's own: subclasses and spaces of that package, which must be installed.

    import neritic.gym
    env = neritic.gym.make_vec("hover", num_envs=4096)    # the arguments of neritic.vector()

Wrappers of gymnasium.vector accept it. Or by name, with gymnasium.make_vec("neritic/hover-v0", num_envs=64) after
neritic.gym.register(). It is for Gymnasium 1.1 and later; tests/python runs it against the part of the interface that
it uses, not against the package.
"""

from __future__ import annotations

from typing import Any, Mapping, Optional, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import spaces
from .errors import Error
from .vector import TASKS, vector

try:
    import gymnasium
    from gymnasium.vector import AutoresetMode
except ImportError as missing:
    raise Error(f"neritic.gym: found no {missing.name} with vector.AutoresetMode; accepted: gymnasium 1.1 or later "
                "(neritic.vector() needs none)") from None

Arrays = dict[str, NDArray[np.float32]]


def _space(space: Union[spaces.Box, spaces.Dict]) -> Any:
    """The same space of Gymnasium."""
    if isinstance(space, spaces.Dict):
        return gymnasium.spaces.Dict({name: _space(part) for name, part in space.items()})
    return gymnasium.spaces.Box(space.low, space.high, space.shape, np.float32)


class VectorEnv(gymnasium.vector.VectorEnv):  # type: ignore[misc]
    """neritic.vector() as a gymnasium.vector.VectorEnv. `env` is the environments behind it."""

    def __init__(self, task: str, num_envs: int = 1, **options: Any) -> None:
        self.env = vector(task, num_envs, **options)
        self.num_envs = self.env.num_envs
        mode = {"next_step": AutoresetMode.NEXT_STEP, "same_step": AutoresetMode.SAME_STEP}
        self.metadata = {**self.env.metadata, "autoreset_mode": mode[self.env.metadata["autoreset_mode"]]}
        self.single_observation_space = _space(self.env.single_observation_space)
        self.observation_space = _space(self.env.observation_space)
        self.single_action_space = _space(self.env.single_action_space)
        self.action_space = _space(self.env.action_space)

    def reset(self, *, seed: Union[None, int, Sequence[Optional[int]]] = None,
              options: Optional[Mapping[str, Any]] = None) -> tuple[Arrays, dict[str, Any]]:
        """As of neritic.vector(). A number also seeds np_random, which the environments do not use."""
        super().reset(seed=seed if seed is None or isinstance(seed, int) else None, options=options)
        return self.env.reset(seed=seed, options=options)

    def step(self, actions: ArrayLike) -> tuple[Arrays, NDArray[np.float32], NDArray[np.bool_], NDArray[np.bool_],
                                                dict[str, Any]]:
        """As of neritic.vector()."""
        return self.env.step(actions)

    def close_extras(self, **_: Any) -> None:
        """Called by close(), also of one that could not be made."""
        if hasattr(self, "env"):
            self.env.close()

    def __enter__(self) -> VectorEnv:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def make_vec(task: str, num_envs: int = 1, **options: Any) -> VectorEnv:
    """The environments of a task, by the arguments of neritic.vector(). Its arrays are written in place unless
    copy=True, which wrappers that keep observations need."""
    return VectorEnv(task, num_envs, **{"copy": True, **options})


def register() -> None:
    """Makes the tasks known to gymnasium.make_vec() as neritic/TASK-v0."""
    for task in TASKS:
        gymnasium.register(id=f"neritic/{task}-v0", vector_entry_point="neritic.gym:make_vec", kwargs={"task": task})
