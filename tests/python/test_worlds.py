"""Worlds in this process: ticks, commands, observations, states, links, recordings and refusals."""

import asyncio
import contextlib
import copy
import errno
import inspect
import io
import os
import pickle
import shutil
import signal
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

import neritic
from neritic import speed

ROOT = Path(__file__).resolve().parents[2]
SCENES = ROOT / "tests/scenes"
DIVE = str(SCENES / "over_sand.toml")
TALK = str(SCENES / "talk_over_sand.toml")
MEASURED = str(SCENES / "measured_over_sand.toml")


class Divers(unittest.TestCase):
    """neritic.human_state."""

    SCENE = f"""[physics]
[[objects]]
name = "diver"
class = "diver"
model = "{ROOT}/assets/models/diver.glb"
human = "{ROOT}/assets/divers/recreational.toml"
position_m = [0, -10, 0]
pitch_deg = -90
inputs = {{ gaze = "python", heart = "strap" }}
[[objects]]
name = "shark"
class = "shark"
shape = "sphere"
radius_m = 0.2
position_m = [3, -10, -6]
"""

    def test_what_a_robot_knows_of_a_diver_has_its_quality(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = os.path.join(folder, "scene.toml")
            Path(scene).write_text(self.SCENE)
            with neritic.open(scene, seed=1) as world:
                self.assertEqual(world.objects, ["diver", "shark"])
                state = neritic.human_state(world, world.tick(480))
                self.assertEqual({name: value.quality for name, value in state.items()}, {
                    "gaze_target": "lost", "gaze_off_deg": "lost", "gaze_distance_m": "lost", "breath_bpm": "modelled",
                    "heart_bpm": "lost", "sdnn_ms": "missing", "rmssd_ms": "missing", "depth_m": "good", "ascent_m_min": "good",
                    "gas_bar": "good"})
                self.assertTrue(np.isnan(state["rmssd_ms"].value))
                self.assertAlmostEqual(state["depth_m"].value, 10.0, delta=0.3)
                self.assertLess(state["gas_bar"].age_s, 0.11)
                # The eyes are some 0.8 m north of the hips, of a diver who lies.
                for aside_m, target in ((0.3, "shark"), (2.0, None)):
                    line = np.array([3.0 + aside_m, 6.0, -10.0]) - np.array([0.0, 0.786, -10.09])
                    world.inject("diver/gaze", [world.time, *line / np.linalg.norm(line), 1, 0, 0, 0, 0], "python")
                    state = neritic.human_state(world, world.tick(48))
                    self.assertEqual(state["gaze_target"][:2], (target, "good"))
                self.assertEqual(neritic.human_state(world, world.tick(480))["gaze_target"].quality, "lost")


class Worlds(unittest.TestCase):
    def test_the_same_seed_and_commands_give_the_same_hashes(self):
        hashes = []
        for _ in range(2):
            world = neritic.open(MEASURED, seed=7)
            world["rov"].velocity(0.3, yaw_rate=0.1)
            world.tick(480)
            hashes.append(world.hash)
        self.assertEqual(*hashes)
        self.assertNotEqual(neritic.open(MEASURED, seed=8).hash, neritic.open(MEASURED, seed=7).hash)

    def test_a_saved_state_goes_on_with_the_same_hashes(self):
        world = neritic.open(DIVE, seed=1)
        world.tick(100)
        state = world.save()
        world.tick(100)
        ended = world.hash
        world.restore(state)
        self.assertEqual(world.step, 100)
        world.tick(100)
        self.assertEqual(world.hash, ended)

    def test_a_saved_state_fits_a_world_whose_sources_came_in_another_order(self):
        with neritic.open(DIVE, seed=1) as one, neritic.open(DIVE, seed=1) as other:
            one.inject("diver/buttons", [1, 0, 0], source="ada")
            one["rov"].goto(1, 2, -10)
            one.tick(24)
            state = one.save()
            other.inject("diver/buttons", [0, 1, 0], source="bob")
            other.tick(7)
            other["rov"].goto(3, 2, -10)
            other.tick(5)
            other.restore(state)
            self.assertEqual((one.step, one.hash), (other.step, other.hash))
            for world in (one, other):
                world.inject("diver/buttons", [0, 0, 1], source="ada")
                world["rov"].velocity(0.2, 0, 0)
                world.tick(48)
            self.assertEqual(one.hash, other.hash)

    def test_observations_do_not_change_and_say_where_they_come_from(self):
        world = neritic.open(MEASURED, seed=1)
        before = world.tick(48)
        imu = before["rov/imu"]
        kept = imu.linear_acceleration
        copied, sequence = kept.copy(), imu.sequence
        world.tick(48)
        self.assertTrue((kept == copied).all())
        self.assertEqual(imu.sequence, sequence)
        self.assertEqual(imu.frame, "rov/imu")
        self.assertLessEqual(imu.stamp, imu.arrival)
        self.assertFalse(kept.flags.writeable)
        self.assertGreater(world.observe()["rov/imu"].sequence, sequence)

    def test_a_command_that_was_saved_is_released_or_followed_by_another(self):
        with neritic.open(DIVE, seed=1) as world:
            world["rov"].thrusters([0, 0, 0, 0, 20, 20, 20, 20])
            world.tick(48)
            state = world.save()
            world.tick(240)
            kept = (world.hash, world.truth("rov").thruster_n.tolist())
        for end in (lambda rov: rov.release(), lambda rov: rov.goto(8, 15, -10), lambda rov: rov.velocity(0.2)):
            runs = []
            for restored in (False, True):
                with neritic.open(DIVE, seed=1) as world:
                    if restored:
                        world.restore(state)
                    else:
                        world["rov"].thrusters([0, 0, 0, 0, 20, 20, 20, 20])
                        world.tick(48)
                    end(world["rov"])
                    world.tick(240)
                    runs.append((world.hash, world.truth("rov").thruster_n.tolist()))
            self.assertEqual(*runs)
            self.assertNotEqual(runs[0], kept)

    def test_all_that_came_in_a_tick_is_delivered_whatever_a_callback_raises(self):
        with neritic.open(TALK, seed=1) as world:
            heard, events = [], []

            def breaks(reading):
                events.append(reading.sequence)
                raise ValueError(f"of {reading.sequence}")

            world.tick(336)
            world["diver"].send("look", to="rov")
            world["diver"].send("again", to="rov")  # refused, while the first one is sent
            world.on("diver/modem", breaks)
            world.on("diver/motion", heard.append)
            with self.assertRaisesRegex(ValueError, "of 0") as raised:
                world.tick(240 * 5)
            self.assertGreater(len(events), 1)
            self.assertIn(f"{len(events) - 1} more callbacks", raised.exception.__notes__[0])
            self.assertEqual([reading.sequence for reading in heard], list(range(heard[0].sequence, heard[0].sequence + len(heard))))
            self.assertGreater(heard[-1].stamp, 6.3)
            self.assertEqual([message.data for message in world["rov"].receive()], [b"look"])

    def test_what_ends_the_program_leaves_the_rest_for_the_next_tick(self):
        with neritic.open(DIVE, seed=1) as world:
            heard = []

            def ends(reading):
                if len(heard) == 3:
                    raise KeyboardInterrupt

            world.on("diver/motion", ends)
            world.on("diver/motion", lambda reading: heard.append(reading.sequence))
            with self.assertRaises(KeyboardInterrupt):
                world.tick(48)
            self.assertEqual(len(heard), 3)
            world.off("diver/motion")
            world.on("diver/motion", lambda reading: heard.append(reading.sequence))
            world.tick(48)
            self.assertEqual(heard, list(range(heard[0], heard[0] + len(heard))))
            self.assertGreater(len(heard), 20)

    def test_a_long_tick_loses_no_reading(self):
        with neritic.open(MEASURED, seed=1) as world:
            heard, core = [], world._core
            world.on("rov/imu", lambda reading: heard.append(reading.sequence))

            class Small:  # of which a tick ends early, as of the core where many readings wait
                def __getattr__(self, name):
                    return getattr(core, name)

                def tick(self, steps):
                    return core.tick(min(steps, 7))

            world._core = Small()
            world.tick(240)
            self.assertEqual(world.step, 240)
            self.assertEqual(heard, list(range(heard[0], heard[0] + len(heard))))
            self.assertEqual(world.counts()["dropped_readings"], 0)

    def test_a_sensor_faster_than_the_steps_loses_no_reading(self):
        with tempfile.TemporaryDirectory() as folder:
            scene = Path(folder) / "slow.toml"
            scene.write_text(f'include = "{MEASURED}"\n[physics]\nrate_hz = 60\n')
            with neritic.open(str(scene), seed=1) as world:
                heard = []
                world.on("rov/imu", lambda reading: heard.append(reading))
                world.tick(60)
                self.assertEqual(len(heard), 200)
                self.assertEqual([r.sequence for r in heard], list(range(1, 201)))
                for reading in heard:
                    self.assertAlmostEqual(reading.stamp, reading.sequence / 200, delta=2e-9)

    def test_ctrl_c_ends_a_tick_and_leaves_the_world(self):
        with neritic.open(DIVE, seed=1) as world, neritic.open(DIVE, seed=1) as other:
            threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
            begun = time.monotonic()
            with self.assertRaises(KeyboardInterrupt):
                world.tick(240 * 3600 * 10)
            self.assertLess(time.monotonic() - begun, 5.0)
            step = world.step
            self.assertGreater(step, 0)
            world.tick(24)
            self.assertEqual(world.step, step + 24)
            other.tick(step + 24)
            self.assertEqual(world.hash, other.hash)

    def test_cancelled_ticks_leave_a_world_that_is_free(self):
        async def endless(world):
            async for _ in world.ticks(240 * 3600):
                pass

        async def work():
            with neritic.open(DIVE, seed=1) as world:
                await endless(world)

        async def main():
            for scope in (work, lambda: endless(kept)):
                task = asyncio.create_task(scope())
                await asyncio.sleep(0.1)
                task.cancel()
                with self.assertRaises(asyncio.CancelledError):
                    await task
            with self.assertRaises(asyncio.TimeoutError):
                await asyncio.wait_for(work(), 0.1)

        with neritic.open(DIVE, seed=1) as kept:
            asyncio.run(main())
            step = kept.step
            kept.tick(1)
            self.assertEqual(kept.step, step + 1)

    def test_a_tick_that_is_cancelled_before_its_first_step_ends(self):
        run = neritic.World._run

        def late(world, steps):
            time.sleep(0.2)
            return run(world, steps)

        async def main():
            await asyncio.wait_for(anext(world.ticks(240 * 3600)), 0.1)

        with neritic.open(DIVE, seed=1) as world, unittest.mock.patch.object(neritic.World, "_run", late):
            with self.assertRaises(asyncio.TimeoutError):
                asyncio.run(main())
            self.assertLess(world.step, 240 * 3600)

    def test_ticks_that_are_cancelled_twice_end_as_if_once(self):
        run = neritic.World._run

        def late(world, steps):
            time.sleep(0.2)
            return run(world, steps)

        async def endless(world):
            async for _ in world.ticks(240 * 3600):
                pass

        async def main():
            task = asyncio.create_task(endless(world))
            for _ in range(2):
                await asyncio.sleep(0.05)
                task.cancel()
            with self.assertRaises(asyncio.CancelledError):
                await task
            world.tick(1)  # no other goes on

        with neritic.open(DIVE, seed=1) as world, unittest.mock.patch.object(neritic.World, "_run", late):
            asyncio.run(main())
            self.assertLess(world.step, 240 * 3600)

    def test_close_ends_a_tick_of_another_thread(self):
        world, ends = neritic.open(DIVE, seed=1), []

        def long():
            try:
                world.tick(240 * 3600)
            except neritic.Error as error:
                ends.append(str(error))

        thread = threading.Thread(target=long)
        thread.start()
        time.sleep(0.2)
        world.close()
        thread.join(5.0)
        self.assertFalse(thread.is_alive())
        self.assertRegex(ends[0], "stopped at step|closed")

    def test_inputs_have_no_link(self):
        with neritic.open(DIVE, seed=1) as world, self.assertRaisesRegex(neritic.BadInput, "a stream of inputs.*; accepted: "):
            world.link("rov/setpoint", delay=0.5)

    def test_an_observation_never_goes_back_in_time(self):
        with neritic.open(DIVE, seed=1) as world:
            world.link("diver/motion", delay=0.2, jitter=0.1)
            stamps = [world.tick(6)["diver/motion"].stamp for _ in range(200) if "diver/motion" in world.observe() or world.step > 120]
            self.assertGreater(len(stamps), 100)
            self.assertEqual(stamps, sorted(stamps))

    def test_readings_and_images_are_copied_and_pickled(self):
        with neritic.open(MEASURED, seed=1) as world:
            first, last = world.tick(240), world.tick(24)
            for made in (copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))):
                reading = made(first["rov/imu"])
                self.assertEqual(reading, first["rov/imu"])
                self.assertEqual((reading.frame, reading.fields()), (first["rov/imu"].frame, first["rov/imu"].fields()))
                np.testing.assert_array_equal(reading.linear_acceleration, first["rov/imu"].linear_acceleration)
                reading.values[0] += 1.0
                self.assertNotEqual(reading, first["rov/imu"])
                whole = made(first)
                self.assertEqual(whole, first)
                self.assertEqual((whole.step, whole.time, list(whole)), (first.step, first.time, list(first)))
            self.assertNotEqual(first, last)
            truth = world.truth("rov")
            self.assertEqual(truth, pickle.loads(pickle.dumps(truth)))
            world.tick(1)
            self.assertNotEqual(truth, world.truth("rov"))

    def test_images_are_copied_and_pickled(self):
        with neritic.open(DIVE, seed=1) as world:
            try:
                world.images("rov_sonar/echoes", rate=4)
            except neritic.Error as error:
                self.skipTest(str(error))
            seen = world.tick(120)["rov_sonar/echoes"]
            for made in (copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))):
                image = made(seen)
                self.assertEqual(image, seen)
                self.assertEqual((image.stamp, image.range_limits, image.encoding), (seen.stamp, seen.range_limits, seen.encoding))
                image.pixels[0, 0] += 1
                self.assertNotEqual(image, seen)

    def test_a_tick_that_ends_at_a_ping_gives_its_image(self):
        with neritic.open(DIVE, seed=1) as world:  # ten pings a second, 240 steps
            try:
                world.images("rov_sonar/echoes")
            except neritic.Error as error:
                self.skipTest(str(error))
            for ping in (1, 2, 3):
                image = world.tick(24)["rov_sonar/echoes"]
                self.assertEqual((image.sequence, round(image.stamp / world.step_s)), (ping, 24 * ping))
            world.no_images("rov_sonar/echoes")
            world.tick(1)
            world.images("rov_sonar/echoes", rate=5)  # from time 0 on, whenever it is asked for
            image = world.tick(23)["rov_sonar/echoes"]
            self.assertEqual((image.sequence, round(image.stamp / world.step_s)), (4, 96))
            for rate in (10.1, -1, float("inf")):
                with self.assertRaisesRegex(neritic.BadInput, "images of rov_sonar/echoes: found .* Hz; accepted: 0 .* to 10 Hz"):
                    world.images("rov_sonar/echoes", rate=rate)

    def test_small_things_are_refused_in_words_that_fit(self):
        with neritic.open(TALK, seed=1) as world, tempfile.TemporaryDirectory() as folder:
            with world.record(Path(folder) / "a"):
                for call in (lambda: world.record(Path(folder) / "b").__enter__(), lambda: world.restore(world.save())):
                    with self.assertRaisesRegex(neritic.BadInput, "a recording that goes on; accepted: the end of its `with`"):
                        call()
            cases = {
                "send: found 65 bytes; accepted: 1 to 64": lambda: world["diver"].send(b"x" * 65),
                "send: found 0 bytes": lambda: world["diver"].send(b""),
                "accepted: a text or bytes": lambda: world["diver"].send("\udcff"),
                "half of a letter": lambda: neritic.open("\udcff"),
                "scene: found ''; accepted: a file's path": lambda: neritic.open(""),
                "stream: found .*half of a letter": lambda: world.keep if world.off("\udcff") else None,
                "goto: found nan at place 0; accepted: finite numbers": lambda: world["rov"].goto(float("nan"), 0, 0),
                "pressed: found 5; accepted: 0 or 1": lambda: world.inject("diver/buttons", [5, 0, 0], "jacket"),
                "pressed: found -1": lambda: world.inject("diver/buttons", [-1, 0, 0], "jacket"),
                "pressed: found 0.5": lambda: world.inject("diver/buttons", [0, 0.5, 0], "jacket"),
            }
            for words, call in cases.items():
                with self.subTest(words=words), self.assertRaisesRegex(neritic.BadInput, words):
                    call()
        state = neritic.open(TALK, seed=1).save()
        with self.assertRaisesRegex(neritic.BadInput, "a state of seed 1; accepted: one of seed 2"):
            neritic.open(TALK, seed=2).restore(state)

    def test_close_ends_a_recording_inside_its_block(self):
        with tempfile.TemporaryDirectory() as folder:
            world = neritic.open(DIVE, seed=1)
            with world.record(Path(folder) / "run"):
                world.tick(24)
                world.close()
            self.assertGreater((Path(folder) / "run.mcap").stat().st_size, 1000)

    def test_a_link_delays_and_loses_on_arrival_alone(self):
        world = neritic.open(MEASURED, seed=1)
        world.link("rov/imu", delay=0.1, loss=0.3)
        arrived = []
        world.on("rov/imu", arrived.append)
        world.tick(480)
        numbers = [reading.sequence for reading in arrived]
        self.assertEqual(numbers, sorted(numbers))
        lost = 1 - len(numbers) / (numbers[-1] + 1)
        self.assertAlmostEqual(lost, 0.3, delta=0.1)
        self.assertTrue(all(abs(r.arrival - r.stamp - 0.1) < 0.005 for r in arrived))

    def test_messages_take_their_way_and_bad_ones_are_refused(self):
        world = neritic.open(TALK, seed=1)
        diver, rov = world["diver"], world["rov"]
        world.tick(240)  # the buoy has asked and was answered
        diver.send("up", to="rov")
        self.assertEqual(rov.receive(), [])
        world.tick(120)
        message, = rov.receive()
        self.assertEqual((message.sender, message.data), ("diver", b"up"))
        away = np.linalg.norm(world.truth("rov").position - world.truth("diver").position)
        self.assertAlmostEqual((message.heard - message.sent) * 1500.0, away, delta=0.3)
        self.assertGreater(message.received, message.heard)
        for call in (lambda: diver.send(b"", to="rov"), lambda: diver.send(bytes(65)),
                     lambda: diver.send(b"x", to="fish"), lambda: diver.send(b"x", to="diver"),
                     lambda: rov.command("send", [9, 1]),
                     lambda: rov.command("send", [0, 256])):
            with self.assertRaises(neritic.BadInput):
                call()

    def test_each_of_many_messages_in_a_tick_has_its_event(self):
        world = neritic.open(TALK, seed=1)
        world.tick(240)
        events = []
        world.on("diver/modem", events.append)
        for i in range(20):
            world["diver"].send(f"m{i:02}", to="rov")
        world.tick(60)
        own = [neritic.MODEM_EVENTS[int(e.event)] for e in events if e.bytes == 3]
        self.assertEqual(own, ["sent"] + 19 * ["refused"])
        with self.assertRaisesRegex(neritic.BadInput, "one more message; accepted: up to 32"):
            for i in range(33):
                world["diver"].send("x", to="rov")

    def test_grips_and_regulators_do_what_they_are_told(self):
        with neritic.open(str(ROOT / "assets/experiments/team/tool.toml")) as world:
            grip = world.tick(24)["rov/gripper"]
            self.assertEqual(grip.held, 0)
            world["tool"].pose(grip.position, hold=0.05)
            world["rov"].grip("close")
            grip = world.tick(120)["rov/gripper"]
            self.assertEqual((grip.held, grip.grabs, grip.drops), (1, 1, 0))
            world["rov"].grip("open")
            self.assertEqual(world.tick(24)["rov/gripper"].drops, 1)
            with self.assertRaisesRegex(neritic.BadInput, "accepted: auto, open, close"):
                world["rov"].grip("hold")
            with self.assertRaisesRegex(neritic.BadInput, "regulator"):
                world["diver"].regulator("own")
        with neritic.open(str(ROOT / "assets/experiments/team/buddies.toml")) as world:
            world["low"].regulator("donor", "flows")
            supply = world.tick(480)["low/supply"]
            self.assertEqual(supply.donor, 2)
            self.assertGreater(supply.taken_l, 0.0)
            self.assertGreater(supply.flow_l_min, 500.0)

    def test_an_asynchronous_iterator_ticks(self):
        async def run():
            world = neritic.open(DIVE, seed=1)
            return [obs.step async for obs in world.ticks(10, count=3)]

        self.assertEqual(asyncio.run(run()), [10, 20, 30])

    def test_other_threads_run_while_a_world_steps(self):
        world = neritic.open(DIVE, seed=1)
        counted, done = [0], threading.Event()

        def count():
            while not done.is_set():
                counted[0] += 1
                time.sleep(0.0005)

        thread = threading.Thread(target=count)
        thread.start()
        world.tick(4000)
        done.set()
        thread.join()
        self.assertGreater(counted[0], 10)

    def test_an_image_is_the_same_memory_and_outlives_its_world(self):
        world = neritic.open(DIVE, seed=1)
        world.images("rov_sonar/echoes")
        image = world.tick(240)["rov_sonar/echoes"]
        pixels = image.pixels
        self.assertTrue(np.shares_memory(pixels, image.pixels))
        self.assertFalse(pixels.flags.owndata)
        total = float(pixels.sum())
        world.close()
        del world, image
        self.assertEqual(float(pixels.sum()), total)
        self.assertGreater(total, 0.0)

    def test_a_tick_costs_less_than_20_us_above_its_step(self):
        self.assertLess(np.median(speed.tick_above_step_us(rounds=9)), 20.0)

    def test_an_image_of_500_x_500_floats_is_read_in_less_than_a_fifth_of_a_millisecond(self):
        try:
            spent_ms = speed.image_ms(rounds=6)
        except neritic.Error as error:
            if "Vulkan" not in str(error):
                raise
            self.skipTest(str(error))
        self.assertLess(min(spent_ms), 0.2)  # the least: other programs run beside

    def told_of_speed(self, **patched):
        """(exit status, standard output, standard error) of the table, its long measurements left out."""
        parts = {"tick_above_step_us": lambda: [1.0], "image_ms": lambda: [0.1], "env_steps": lambda *_: (1e6, 1.0), **patched}
        out, err = io.StringIO(), io.StringIO()
        with unittest.mock.patch.multiple(speed, **parts), contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            status = speed.main()
        return status, out.getvalue(), err.getvalue()

    def test_the_table_of_speed_tells_what_it_lacks_in_one_line(self):
        status, out, err = self.told_of_speed(PROGRAM="/nowhere/neritic")
        self.assertEqual((status, err), (1, ""))
        self.assertIn("an image from a server: /nowhere/neritic: No such file or directory\n", out)
        self.assertIn("follow, 4096 environments", out)  # the others are measured

        def read_only(*_, **__):
            raise OSError(errno.EROFS, os.strerror(errno.EROFS), "/tmp/x")

        with unittest.mock.patch.object(tempfile, "TemporaryDirectory", read_only):
            status, _, err = self.told_of_speed(tick_above_step_us=speed.tick_above_step_us)
        self.assertEqual((status, err), (1, "neritic.speed: /tmp/x: Read-only file system\n"))

    def test_a_recording_is_made(self):
        world = neritic.open(DIVE, seed=1)
        with tempfile.TemporaryDirectory() as folder:
            with world.record(Path(folder) / "run"):
                world["rov"].goto(5, 5, -5)
                world.tick(240)
            self.assertEqual((Path(folder) / "run.mcap").read_bytes()[:8], b"\x89MCAP0\r\n")

    def test_refusals_are_one_line_that_says_what_is_accepted(self):
        world = neritic.open(DIVE, seed=1)
        rov = world["rov"]
        for call in (lambda: neritic.open("nowhere.toml"), lambda: world["ROV"],
                     lambda: world.truth("rob"), lambda: rov.thrusters([1.0]),
                     lambda: rov.goto(float("nan"), 0, 0), lambda: rov.command("fly", [1]),
                     lambda: world.link("rov/collision", loss=2), lambda: world.images("rov/imu"),
                     lambda: world.restore(b"nothing"), lambda: neritic.vector("sleep", 2),
                     lambda: neritic.vector("hover", 2, randomise={"colour": 1}),
                     lambda: world.tick(-1), lambda: world.tick(1.5), lambda: world.tick("a"), lambda: world.tick(2**63),
                     lambda: rov.goto("x", 0, 0), lambda: rov.goto(0, 0, 0, velocity=1), lambda: rov.wrench([0] * 5),
                     lambda: rov.velocity([1, 0, 0]), lambda: rov.goto(0, 0, 0, hold="x"), lambda: rov.receive(),
                     lambda: rov.fail([99]), lambda: rov.fail([-1]), lambda: rov.fail("x"), lambda: rov.goto(10**400, 0, 0), lambda: world.images("rov_camera/color", rate="x"),
                     lambda: world.tick(10**5000), lambda: neritic.vector("hover", 2).reset(seed=1.5), lambda: neritic.vector("hover", 2).reset(seed=[]),
                     lambda: neritic.open(DIVE, seed=-1), lambda: neritic.open(DIVE, seed=2**64),
                     lambda: neritic.open(DIVE, threads=10**6), lambda: neritic.vector("hover", "x"),
                     lambda: neritic.vector("hover", 2).reset(seed=-1), lambda: neritic.vector("hover", 2).reset(seed=[1, 2, 3]),
                     lambda: neritic.vector("hover", 0), lambda: neritic.vector("hover", 2).step(np.zeros(3))):
            with self.assertRaises(neritic.BadInput) as caught:
                call()
            line = str(caught.exception)
            self.assertNotIn("\n", line)
        with self.assertRaises(KeyError):
            world.tick()["rov/imu"]
        world.close()
        with self.assertRaises(neritic.BadInput):
            world.tick()

    def test_what_the_core_would_take_or_tell_badly_is_refused_in_one_line(self):
        world = neritic.open(DIVE, seed=1)
        rov, diver = world["rov"], world["diver"]
        stands = np.tile([0.0, 0.0, 0.0, 1.0], 15)
        world.tick(4)
        diver.joints(stands)
        diver.jacket(inflate=1, dump=np.True_)
        bad = {
            "accepted: a word in quotes": (lambda: world.truth(3), lambda: world.images(3), lambda: rov.command(3, [1]),
                                           lambda: world.inject("diver/buttons", [0, 0, 0], source=3), lambda: world.on(3, print),
                                           lambda: world.link(3), lambda: world.off(3), lambda: neritic.vector(3),
                                           lambda: neritic.open(DIVE, device=3), lambda: neritic.connect("tcp://127.0.0.1:1", name=3)),
            "accepted: a function": (lambda: world.on("diver/motion", 3),),
            "accepted: bytes that save": (lambda: world.restore(3), lambda: world.restore("x")),
            "accepted: a text or bytes": (lambda: rov.send(None), lambda: rov.send(7)),
            "accepted: a file's path": (lambda: neritic.open(None), lambda: neritic.vector("hover", vehicle=3), lambda: world.record(3).__enter__()),
            "accepted: 60": (lambda: diver.joints(np.zeros(59)), lambda: diver.joints(np.zeros(61))),
            "a quaternion of length": (lambda: diver.joints(np.zeros(60)), lambda: diver.joints(stands * 1e200), lambda: diver.head([0] * 4),
                                       lambda: diver.joints(stands * 1.8), lambda: diver.joints(stands * 0.99),
                                       lambda: world.inject("diver/joints", np.zeros(61), "suit"),
                                       lambda: diver.joints(stands * np.nan)),
            "accepted: True or False": (lambda: diver.jacket(inflate=-1), lambda: diver.jacket(dump="x"),
                                        lambda: neritic.open(DIVE, real_time="x")),
            "accepted: a whole number from 0 to 3": (lambda: diver.gas(9), lambda: diver.gas(-1)),
            "stamp: found 99 s; accepted: up to now": (lambda: world.inject("diver/buttons", [0, 0, 0], "suit", stamp=99.0),),
            "ticks: count: found": (lambda: world.ticks(count=-3), lambda: world.ticks(count="x")),
            "accepted: .*number": (lambda: rov.goto(None, 0, 0), lambda: rov.goto("1", 0, 0), lambda: rov.goto(1j, 0, 0),
                                   lambda: world.tick(True)),
            "agent: found": (lambda: world[3], lambda: world[[]]),
        }
        for words, calls in bad.items():
            for i, call in enumerate(calls):
                with self.subTest(words=words, i=i), self.assertRaisesRegex(neritic.BadInput, words) as caught:
                    call()
                self.assertNotIn("\n", str(caught.exception))
        for state in (bytearray(world.save()), memoryview(world.save()), np.frombuffer(world.save(), np.uint8)):
            world.restore(state)
        self.assertEqual([obs.step for obs in asyncio.run(self.all_of(world.ticks(np.int64(3), count=np.int64(2))))], [7, 10])

    def test_a_source_with_a_name_that_states_and_recordings_cannot_have_is_refused(self):
        world = neritic.open(DIVE, seed=1)
        for name in ("süit", "", "tab\tx", "two words", "x" * 65, "x" * 300, "simulation", "recording"):
            with self.subTest(name=name), self.assertRaisesRegex(neritic.BadInput, "source: found .*; accepted: 1 to 64 printable"):
                world.inject("diver/buttons", [1, 0, 0], source=name)
        world.inject("diver/buttons", [1, 0, 0], source="x" * 64)
        world.tick(3)
        world.restore(world.save())

    @staticmethod
    async def all_of(ticks):
        return [one async for one in ticks]

    def test_files_of_a_recordings_name_are_kept(self):
        with tempfile.TemporaryDirectory() as folder, neritic.open(TALK) as world:
            for name in ("mine.mcap", "mine.csv"):
                Path(folder, name).write_text("precious")
            with world.record(Path(folder, "mine.mcap")):
                world.tick(24)
            self.assertEqual(sorted(os.listdir(folder)), ["mine.csv", "mine.mcap", "mine_old1.csv", "mine_old1.mcap"])
            for name in ("mine_old1.mcap", "mine_old1.csv"):
                self.assertEqual(Path(folder, name).read_text(), "precious")

    def test_a_recording_begins_with_its_call_and_ends_with_stop_or_the_world(self):
        with tempfile.TemporaryDirectory() as folder:
            world = neritic.open(DIVE, seed=1)
            with self.assertRaisesRegex(neritic.BadInput, "record: found folder"):
                world.record("/proc/run")
            recording = world.record(Path(folder, "a"))
            world.tick(24)
            with self.assertRaisesRegex(neritic.BadInput, "found a recording that goes on"):
                world.record(Path(folder, "b"))
            with neritic.open(DIVE, seed=2) as other, self.assertRaisesRegex(neritic.BadInput, "a.mcap, which another program writes"):
                other.record(Path(folder, "a"))
            recording.stop()
            recording.stop()
            world.record(Path(folder, "b"))
            world.tick(24)
            world.close()
            for name in ("a", "b"):
                self.assertGreater(Path(folder, name + ".mcap").stat().st_size, 1000)
                self.assertGreater(Path(folder, name + ".csv").read_text().count("\n"), 1, name)
            self.assertEqual(sorted(os.listdir(folder)), ["a.csv", "a.mcap", "b.csv", "b.mcap"])

    def test_a_world_has_its_agents_names(self):
        with neritic.open(DIVE, seed=1) as world:
            self.assertEqual(list(world), list(world.agents))
            self.assertIn("rov", world)
            self.assertNotIn("submarine", world)
            self.assertNotIn(0, world)

    def test_a_recording_that_cannot_be_written_is_refused_before_the_trial(self):
        world = neritic.open(DIVE, seed=1)
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "file").write_text("")
            Path(folder, "run.mcap").mkdir()
            for name in ("none/run", "file/run", "run", "run.mcap", ""):
                with self.assertRaisesRegex(neritic.BadInput, "record: found .*; accepted: "), world.record(os.path.join(folder, name)):
                    self.fail("the trial ran")
            Path(folder, "kept").mkdir()
            for name in ("kept", "kept/", "kept/.", "."):
                with self.assertRaisesRegex(neritic.BadInput, "record: found a folder .*; accepted: a file's name, as .*run$"), \
                        world.record(os.path.join(folder, name)):
                    self.fail("the trial ran")
            self.assertEqual(sorted(os.listdir(folder)), ["file", "kept", "run.mcap"])
            self.assertEqual(os.listdir(Path(folder, "kept")), [])
        self.assertEqual(world.step, 0)
        with self.assertRaises(neritic.BadInput), world.record("/proc/run"):
            self.fail("the trial ran")

    def test_the_blocks_own_exception_is_not_replaced_by_the_recordings(self):
        world = neritic.open(DIVE, seed=1)
        folder = tempfile.mkdtemp()
        with self.assertRaises(ZeroDivisionError) as caught, world.record(folder + "/run"):
            world.tick(4)
            while os.path.exists(folder):  # a thread may just write into it
                shutil.rmtree(folder, ignore_errors=True)
            1 / 0
        self.assertIn("cannot be written", caught.exception.__notes__[0])
        with tempfile.TemporaryDirectory() as folder:
            with world.record(folder + "/run"):
                world.tick(4)
            self.assertEqual(sorted(os.listdir(folder)), ["run.csv", "run.mcap"])

    def test_everything_public_is_documented(self):
        for name in neritic.__all__:
            thing = getattr(neritic, name)
            self.assertTrue(inspect.getdoc(thing), name)
            if inspect.isclass(thing):
                for member, value in vars(thing).items():
                    if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                        self.assertTrue(inspect.getdoc(value), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
