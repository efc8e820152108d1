"""Vectors of environments: arrays, seeds, episodes, rewards and Gymnasium's interface."""

import importlib
import types
import unittest
import unittest.mock

import numpy as np

import neritic
from neritic import speed, tradeoff


class Environments(unittest.TestCase):
    def test_arrays_are_written_in_place_and_contiguous(self):
        env = neritic.vector("hover", 64)
        first, info = env.reset(seed=1)
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        for name, array in observation.items():
            self.assertIs(array, first[name])
            self.assertTrue(array.flags.c_contiguous)
            self.assertEqual(array.dtype, np.float32)
        self.assertTrue(env.observation_space.contains(observation))
        self.assertEqual((reward.shape, terminated.dtype, truncated.dtype), ((64,), np.bool_, np.bool_))

    def test_the_same_seed_gives_the_same_bits_on_any_number_of_threads(self):
        for task in ("hover", "track", "dock", "follow", "shark"):
            ends = []
            for threads in (1, 2, 5):
                env = neritic.vector(task, 200, threads=threads, max_steps=20)
                env.reset(seed=3)
                random = np.random.default_rng(1)
                for _ in range(50):
                    obs, reward, *_ = env.step(random.uniform(-1, 1, (200, 8)))
                ends.append(b"".join(a.tobytes() for a in obs.values()) + reward.tobytes())
            self.assertEqual(ends[0], ends[1], task)
            self.assertEqual(ends[0], ends[2], task)

    def test_two_cores_make_a_quarter_of_a_million_steps_a_second(self):
        for task in speed.TASKS:
            _, cost_us = speed.env_steps(task, 4096, seconds=0.3)
            self.assertLess(cost_us, 2e6 / 250e3, task)

    def test_actions_have_the_exact_shape_and_are_finite_numbers(self):
        env = neritic.vector("hover", 5)
        fine = np.zeros((5, 8), np.float32)
        env.step(fine.tolist())
        env.step(np.asfortranarray(fine))
        env.step(fine.astype(int))
        wide = np.zeros((5, 8))
        nan, large, infinite = fine.copy(), wide.copy(), fine.copy()
        nan[3, 2], large[1, 0], infinite[0, 7] = np.nan, 1e300, -np.inf
        for actions, words in ((np.zeros((8, 5)), "8 x 5 of float64"), (np.zeros(40), "found 40 of"), (np.zeros((5, 8, 1)), "5 x 8 x 1"),
                               (fine.astype(object), "object"), (fine.astype(complex), "complex"), (fine.astype(str), "str"),
                               ([[1], [1, 2]], "several lengths"), (None, "found one of object"), (nan, "nan in environment 3, action 2"),
                               (large, "inf in environment 1, action 0"), (infinite, "-inf in environment 0, action 7")):
            with self.subTest(words=words), self.assertRaisesRegex(neritic.BadInput, words + ".*; accepted: "):
                env.step(actions)

    def test_what_environments_do_not_understand_is_refused(self):
        bad = {
            "randomise: found": [{"randomise": r} for r in (None, 0, 3, "mass", ["mass"], {"colour": 1}, {3: 1})],
            "randomise: mass: found": [{"randomise": {"mass": m}} for m in ("x", None, float("nan"), [1, 2])],
            "num_envs: found .*; accepted: a whole number from 1 to 1048576": [{"num_envs": n} for n in (-1, 0, True, 2**21, 1.5)],
            "step_s": [{"step_s": "x"}, {"step_s": float("inf")}],
            "accepted: ": [{"substeps": "x"}, {"substeps": 0}, {"max_steps": 0}, {"threads": 1000}, {"method": 3}, {"copy": "x"},
                           {"thrust_table": None}, {"control": []}],
        }
        for words, cases in bad.items():
            for case in cases:
                with self.subTest(case=case), self.assertRaisesRegex(neritic.BadInput, words):
                    neritic.vector("hover", **case)
        for randomise in (True, False, np.False_, {}, {"mass": np.float32(0.1)}):
            neritic.vector("hover", np.int64(2), randomise=randomise)
        env = neritic.vector("hover", 2)
        with self.assertRaises(neritic.BadInput):
            env.reset(options=3)
        with self.assertRaises(neritic.BadInput):
            env.reset(seed=[[1], [1, 2]])
        env.reset(seed=np.array([3, 4]))
        env.close()
        for call in (lambda: env.step(np.zeros((2, 8))), env.reset, env.truth):
            with self.assertRaisesRegex(neritic.BadInput, "closed"):
                call()

    def test_episodes_end_and_begin_anew(self):
        for mode in ("next_step", "same_step"):
            env = neritic.vector("hover", 3, max_steps=5, autoreset=mode, control="wrench")
            still = np.zeros((3, 6), np.float32)
            for _ in range(4):
                *_, truncated, info = env.step(still)
                self.assertFalse(truncated.any())
            obs, _, _, truncated, info = env.step(still)
            self.assertTrue(truncated.all())
            last = {k: v.copy() for k, v in obs.items()}
            if mode == "same_step":
                self.assertTrue(info["_final_obs"].all())
                self.assertFalse((info["final_obs"]["goal"] == last["goal"]).all())
                continue
            obs, reward, terminated, truncated, _ = env.step(still)
            self.assertFalse(truncated.any() or terminated.any() or reward.any())
            self.assertGreater(np.abs(obs["goal"] - last["goal"]).max(), 0.1)

    def test_environments_differ_only_as_they_are_told(self):
        same = neritic.vector("hover", 2, randomise=False)
        obs, _ = same.reset(seed=[5, 6])
        self.assertGreater(np.abs(obs["goal"][0] - obs["goal"][1]).max(), 0.0)  # places do
        self.assertEqual(obs["motion"][0, :3].tolist(), [0, 0, 0])  # no noise
        equal, _ = same.reset(seed=[5, 5])
        np.testing.assert_array_equal(equal["goal"][0], equal["goal"][1])
        noisy, _ = neritic.vector("hover", 2).reset(seed=5)
        self.assertGreater(np.abs(noisy["motion"][0, :3]).max(), 0.0)

    def test_a_seed_identifies_an_environment_wherever_it_stands(self):
        def run(env, seed, places, resets=0):
            obs, _ = env.reset(seed=seed)
            for _ in range(resets):
                obs, _ = env.reset()
            out = [{name: array[places].copy() for name, array in obs.items()}]
            for k in range(30):
                action = np.full((env.num_envs, 8), 0.1 * (k % 5 - 2), np.float32)
                obs, reward, *_ = env.step(action)
                out.append({**{name: array[places].copy() for name, array in obs.items()}, "reward": reward[places].copy()})
            return out

        def same(a, b):
            return all(np.array_equal(x[name], y[name]) for x, y in zip(a, b) for name in x)

        for task in ("hover", "shark"):
            many, one = neritic.vector(task, 8, max_steps=12), neritic.vector(task, 1, max_steps=12)
            self.assertTrue(same(run(many, list(range(10, 18)), [3]), run(one, 13, [0])))
            self.assertTrue(same(run(many, 10, [3]), run(one, [13], [0])))
            self.assertFalse(same(run(many, 10, [3]), run(many, 10, [4])))
            # Without a seed each goes on from its own.
            self.assertTrue(same(run(many, 10, [3], resets=1), run(one, 13, [0], resets=1)))
            self.assertFalse(same(run(many, 1, [0], resets=1), run(many, 2, [0])))
            many.reset(seed=10)
            obs, _ = many.reset(seed=[None, 11, None, 5, None, None, None, None])
            kept = {name: array.copy() for name, array in obs.items()}
            many.reset(seed=10)
            obs, _ = many.reset()
            np.testing.assert_array_equal(obs["goal"][0], kept["goal"][0])
            self.assertFalse(np.array_equal(obs["goal"][1], kept["goal"][1]))
        with self.assertRaisesRegex(neritic.BadInput, "found 2 seeds; accepted: a number, or one for each of 8"):
            many.reset(seed=[1, 2])

    def test_a_step_has_the_substeps_that_it_needs(self):
        def rises(**options):
            env = neritic.vector("hover", 2, randomise=False, **options)
            env.reset(seed=1)
            for _ in range(round(4.0 / options["step_s"])):
                env.step(np.full((2, 8), 0.1))
            return env.truth()[0]

        fine = rises(step_s=0.04, substeps=4)
        for step_s in (0.04, 0.2, 0.5, 1.0):
            np.testing.assert_allclose(rises(step_s=step_s), fine, atol=1e-3)
        for step_s, substeps in ((1.0, 1), (1.0, 9), (0.2, 1)):
            with self.assertRaisesRegex(neritic.BadInput, "substeps: found .*, so that none is longer than 0.1 s"):
                neritic.vector("hover", step_s=step_s, substeps=substeps)
        neritic.vector("hover", step_s=1.0, substeps=10)
        neritic.vector("hover", step_s=1.0, substeps=1, method="guarded")

    def test_what_a_task_asks_for_earns_most(self):
        """A policy that does the task earns more than one that stays short of it, that does nothing, or that ends it early."""
        def fly(task, short, idle=False, flees=False):
            env = neritic.vector(task, 128, control="wrench", randomise={"current_m_s": 0.1})
            obs, _ = env.reset(seed=1)
            earned, alive, inside = np.zeros(128), np.ones(128, bool), np.zeros((128, 1), bool)
            for _ in range(500):
                goal, motion = obs["goal"], obs["motion"]
                place, turn = goal[:, :3].copy(), goal[:, 6:9]
                axis = goal[:, :3] - goal[:, 9:12]
                axis /= np.maximum(np.linalg.norm(axis, axis=1, keepdims=True), 1e-6)
                inside |= np.linalg.norm(goal[:, 9:12], axis=1, keepdims=True) < 0.3
                back = np.where(inside, short, 1.0) if task == "dock" else short
                place -= back * (axis if task == "dock" else np.array([1.0, 0.0, 0.0], np.float32))
                if flees:
                    place *= -1.0
                action = np.hstack([0.35 * np.clip(place, -1, 1) + 0.5 * goal[:, 3:6], 0.4 * turn - 0.3 * motion[:, 3:6]])
                obs, reward, terminated, truncated, _ = env.step(0.0 * action if idle else action)
                earned += np.where(alive, reward, 0.0)
                alive &= ~(terminated | truncated)
            return earned.mean()

        for task in ("hover", "track", "dock", "follow", "shark"):
            done, others = fly(task, 0.0), {"short": fly(task, 0.5), "idle": fly(task, 0.0, idle=True),
                                            "flees": fly(task, 0.0, flees=True)}
            if task == "dock":
                others["a little short"] = fly(task, 0.25)
            with self.subTest(task=task, done=done, others=others):
                self.assertGreater(done, max(others.values()))
                self.assertLess(others["flees"], others["idle"])

    def test_spaces_are_compared_and_asked_as_gymnasiums(self):
        env, other = neritic.vector("hover", 3), neritic.vector("track", 3)
        self.assertEqual(env.observation_space, other.observation_space)
        self.assertNotEqual(env.observation_space, env.single_observation_space)
        self.assertNotEqual(env.action_space, 3)
        fine = np.zeros((3, 8), np.float32)
        self.assertIn(fine, env.action_space)
        self.assertIn(env.observation_space.sample(), env.observation_space)
        self.assertIn("goal", env.observation_space)
        for wrong in (fine.astype(np.float64), fine[:2], 2 * fine + 2, "x", None, [[1], [1, 2]], fine.astype(str), object(), {"a": 1}):
            self.assertFalse(env.action_space.contains(wrong))
            self.assertFalse(env.observation_space.contains(wrong))
        with env as same:
            self.assertIs(same, env)
        self.assertTrue(env.closed)
        other.close(timeout=3)

    def test_gymnasium_gets_environments_of_its_own_kind(self):
        """Against the part of Gymnasium 1.1's interface that neritic.gym uses; the package itself is not here."""
        import enum

        class AutoresetMode(enum.Enum):
            NEXT_STEP, SAME_STEP, DISABLED = "NextStep", "SameStep", "Disabled"

        class Space:
            def __init__(self, *arguments, **named):
                self.arguments = (*arguments, *named.values())

        class Base:
            metadata, spec, render_mode, closed = {}, None, None, False

            def reset(self, *, seed=None, options=None):
                if seed is not None:
                    self.np_random_seed = seed

            def close(self, **named):
                if not self.closed:
                    self.close_extras(**named)
                    self.closed = True

        registered = {}
        gymnasium, of_vectors = types.ModuleType("gymnasium"), types.ModuleType("gymnasium.vector")
        of_vectors.VectorEnv, of_vectors.AutoresetMode = Base, AutoresetMode
        gymnasium.vector, gymnasium.spaces = of_vectors, types.SimpleNamespace(Box=Space, Dict=Space)
        gymnasium.register = lambda id, **named: registered.update({id: named})
        with unittest.mock.patch.dict("sys.modules", {"gymnasium": gymnasium, "gymnasium.vector": of_vectors}):
            env = neritic.gym.make_vec("hover", num_envs=3, autoreset="same_step")
            self.assertIsInstance(env, Base)
            self.assertIs(env.metadata["autoreset_mode"], AutoresetMode.SAME_STEP)
            self.assertIsInstance(env.single_action_space, Space)
            first, _ = env.reset(seed=4)
            self.assertEqual(env.np_random_seed, 4)
            self.assertEqual(env.reset(seed=[1, None, 2])[1], {})
            obs, reward, terminated, truncated, info = env.step(np.zeros((3, 8), np.float32))
            self.assertIsNot(obs["goal"], first["goal"])
            env.close(timeout=1)
            self.assertTrue(env.closed and env.env.closed)
            neritic.gym.register()
            self.assertEqual(registered["neritic/dock-v0"]["kwargs"], {"task": "dock"})
            module, name = registered["neritic/dock-v0"]["vector_entry_point"].split(":")
            self.assertIs(getattr(importlib.import_module(module), name), neritic.gym.make_vec)
        del neritic.gym
        with unittest.mock.patch.dict("sys.modules", {"gymnasium": None}), \
                self.assertRaisesRegex(neritic.Error, "found no gymnasium.*; accepted: "):
            neritic.gym  # loads it

    def test_each_task_can_be_done(self):
        # A damped spring to the goal, with the wrench that it asks for.
        floors = {"hover": 0.8, "track": 0.5, "dock": 0.8, "follow": 0.6, "shark": 0.8}
        for task, floor in floors.items():
            env = neritic.vector(task, 64, control="wrench", randomise={"current_m_s": 0.1}, max_steps=400)
            obs, _ = env.reset(seed=2)
            good = np.zeros(64, bool)
            failed = np.zeros(64, bool)
            for _ in range(400):
                goal, motion = obs["goal"], obs["motion"]
                force = 0.6 * goal[:, :3] + 0.6 * goal[:, 3:6]
                if task == "dock":  # to the mouth first, then in
                    aside = np.linalg.norm(goal[:, 1:3], axis=1, keepdims=True)
                    force = np.where(aside > 0.15, 0.4 * goal[:, 9:], 0.3 * goal[:, :3]) - 0.8 * motion[:, :3]
                torque = 1.0 * goal[:, 6:9] - 0.5 * motion[:, 3:6]
                obs, reward, terminated, truncated, _ = env.step(np.hstack([force, torque]))
                if task == "dock":
                    good |= (reward > 8.0) & ~failed
                failed |= reward < -8.0
            if task != "dock":
                near = 0.5 if task == "hover" else 1.0
                good = ~failed if task == "shark" else ~failed & (np.linalg.norm(obs["goal"][:, :3], axis=1) < near)
            self.assertGreater(good.mean(), floor, f"{task}: {good.mean()}")

    def test_it_moves_as_the_simulation_of_a_scene(self):
        self.assertLess(tradeoff.error_against_scene(substeps=1, seconds=4.0), 0.01)
        self.assertLess(tradeoff.error_against_scene(substeps=8, seconds=4.0), 0.001)


if __name__ == "__main__":
    unittest.main()
