"""The Python package: its examples run and do what they say, and what they do not show."""

import asyncio
import contextlib
import copy
import importlib.util
import inspect
import io
import os
import pickle
import re
import shutil
import signal
import socket
import tempfile
import threading
import time
import types
import unittest
import unittest.mock
from pathlib import Path

import numpy as np

import neritic
from neritic import tradeoff

ROOT = Path(__file__).resolve().parents[2]
MISSION = str(ROOT / "assets/scenes/mission.toml")
DIVE = str(ROOT / "assets/scenes/dive.toml")
TALK = str(ROOT / "assets/scenes/talk.toml")
MEASURED = str(ROOT / "assets/scenes/mission_measured.toml")


def example(name):
    spec = importlib.util.spec_from_file_location(name, ROOT / f"tools/python/examples/{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def quietly(call, *arguments):
    with contextlib.redirect_stdout(io.StringIO()):
        return call(*arguments)


class Examples(unittest.TestCase):
    def setUp(self):
        os.chdir(ROOT)

    def test_a_square_is_flown_to_each_corner(self):
        self.assertLess(quietly(example("square").main), 0.15)

    def test_a_vehicle_keeps_beside_a_diver_who_is_seen_late(self):
        self.assertAlmostEqual(quietly(example("follow_diver").main), 2.0, delta=0.5)

    def test_a_controller_of_ones_own_holds_the_depth(self):
        self.assertLess(abs(quietly(example("own_controller").main)), 0.2)

    def test_a_diver_and_a_vehicle_talk_by_sound(self):
        said = quietly(example("talk").main, "assets/scenes/talk.toml", 20.0)
        self.assertGreaterEqual(said["told"], 4)
        self.assertLess(said["worst_m"], 1.5)
        self.assertGreaterEqual(said["answered"], 2)

    def test_devices_of_the_scene_are_heard_in_real_time(self):
        assets, port = ROOT / "assets", 46000 + os.getpid() % 900
        with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            scene = Path(folder) / "lab.toml"
            scene.write_text(f'[physics]\n[[objects]]\nname = "diver"\nmodel = "{assets}/models/diver.glb"\n'
                             f'human = "{assets}/divers/recreational.toml"\nposition_m = [0, -12, 0]\n'
                             f'[sources]\njacket = "jacket udp {port}"\n')
            with neritic.open(scene, real_time=True) as world:
                for _ in range(100):
                    sender.sendto(b"[false,true,false]", ("127.0.0.1", port))
                    if list(world.tick(6)["diver/motion"].buttons) == [0, 1, 0]:
                        break
                else:
                    self.fail("nothing was heard")

    def test_messages_by_sound_end_as_was_accepted(self):
        """Each message as heard, when, or as lost, and why: tests/golden/talk.messages.csv (NERITIC_UPDATE_GOLDEN=1 writes it)."""
        said = {1.4: ("diver", b"look", "rov"), 5.0: ("rov", bytes(64), None), 5.1: ("diver", b"busy", "rov"),
                10.5: ("diver", b"a", None), 10.52: ("rov", b"b", None), 13.0: ("buoy", bytes(range(40)), "diver")}
        rows = ["modem,event,kind,from,to,number,bytes,sent_s,heard_s,snr_db"]
        with neritic.open(TALK, seed=1) as world:
            for name in ("diver", "rov", "buoy"):
                def note(seen, name=name):
                    rows.append(f"{name},{neritic.MODEM_EVENTS[int(seen.event)]},{('message', 'request', 'answer')[int(seen.message_kind)]},"
                                f"{seen.sender:.0f},{seen.to:.0f},{seen.number:.0f},{seen.bytes:.0f},{seen.sent:.5f},{seen.heard:.5f},"
                                f"{seen.snr_db:.2f}")
                world.on(f"{name}/modem", note)
            while world.time < 20.0:
                for at in [at for at in said if at <= world.time + 1e-9]:
                    name, data, to = said.pop(at)
                    world[name].send(data, to=to)
                world.tick(12)
        golden, text = ROOT / "tests/golden/talk.messages.csv", "\n".join(rows) + "\n"
        if os.environ.get("NERITIC_UPDATE_GOLDEN"):
            golden.write_text(text)
        self.assertEqual(text, golden.read_text())

    def test_a_sonar_dataset_is_written(self):
        with tempfile.TemporaryDirectory() as folder:
            self.assertEqual(quietly(example("sonar_dataset").main, MISSION, folder, 2), 2)
            files = sorted(Path(folder).glob("*.npz"))
            self.assertEqual(len(files), 2)
            data = np.load(files[0])
            self.assertEqual(data["echoes"].dtype, np.float32)
            self.assertGreater(data["echoes"].max(), 0.0)
            self.assertAlmostEqual(np.linalg.norm(data["orientation"]), 1.0, places=6)


class Readme(unittest.TestCase):
    """The Python of the READMEs, as it stands."""

    def blocks(self, file, first):
        text = (ROOT / file).read_text()
        found = re.findall(r"^((?: {4}.*\n|\n)+)", text, re.MULTILINE)
        return ["".join(line[4:] or "\n" for line in block.splitlines(keepends=True)) for block in found if first in block]

    def test_its_worlds_run(self):
        os.chdir(ROOT)
        names = {}
        world_block, talk_block = self.blocks("tools/python/README.md", "neritic.open(") + self.blocks("tools/python/README.md", ".send(")
        try:
            exec(world_block, names)
        except neritic.Error as error:
            if "Vulkan" not in str(error):
                raise
            self.skipTest(str(error))
        world, place = names["world"], names["truth"].position
        self.assertGreater(names["picture"].size, 1000)
        world.tick(240 * 60)
        there = world.truth("rov")
        self.assertEqual(there.touched_steps, 0)
        goal = [float(x) for x in re.search(r"goto\((.*?)\)", world_block)[1].split(",")]
        np.testing.assert_allclose(there.position, goal, atol=0.3)
        self.assertEqual(place.shape, (3,))
        world.close()
        with neritic.open(TALK, seed=1) as names["world"]:
            world = names["world"]
            names["rov"] = world["rov"]
            names["obs"] = world.tick(240 * 12)
            exec(talk_block, names)

    def test_its_environments_run(self):
        names = {"neritic": neritic}
        block, = self.blocks("tools/python/README.md", "neritic.vector(")
        names["actions"] = np.zeros((4096, 8), np.float32)
        exec(block, names)
        self.assertEqual(names["reward"].shape, (4096,))

    def test_the_top_readmes_python_runs(self):
        os.chdir(ROOT)
        code, = re.findall(r"python3 -c '(.*?)'", (ROOT / "README.md").read_text(), re.DOTALL)
        names = {}
        quietly(exec, code, names)
        world = names["world"]
        world.tick(240 * 60)
        self.assertEqual(world.truth("rov").touched_steps, 0)
        goal = [float(x) for x in re.search(r"goto\((.*?)\)", code)[1].split(",")]
        np.testing.assert_allclose(world.truth("rov").position, goal, atol=0.3)


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
        world = neritic.open(MISSION, seed=1)
        world.tick(100)
        state = world.save()
        world.tick(100)
        ended = world.hash
        world.restore(state)
        self.assertEqual(world.step, 100)
        world.tick(100)
        self.assertEqual(world.hash, ended)

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
        with neritic.open(MISSION, seed=1) as world:
            world["rov"].thrusters([0, 0, 0, 0, 20, 20, 20, 20])
            world.tick(48)
            state = world.save()
            world.tick(240)
            kept = (world.hash, world.truth("rov").thruster_n.tolist())
        for end in (lambda rov: rov.release(), lambda rov: rov.goto(8, 15, -10), lambda rov: rov.velocity(0.2)):
            runs = []
            for restored in (False, True):
                with neritic.open(MISSION, seed=1) as world:
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
            self.assertEqual(world.counts(), {"dropped_readings": 0})

    def test_ctrl_c_ends_a_tick_and_leaves_the_world(self):
        with neritic.open(MISSION, seed=1) as world, neritic.open(MISSION, seed=1) as other:
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
            with neritic.open(MISSION, seed=1) as world:
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

        with neritic.open(MISSION, seed=1) as kept:
            asyncio.run(main())
            step = kept.step
            kept.tick(1)
            self.assertEqual(kept.step, step + 1)

    def test_close_ends_a_tick_of_another_thread(self):
        world, ends = neritic.open(MISSION, seed=1), []

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
        with neritic.open(MISSION, seed=1) as world, self.assertRaisesRegex(neritic.BadInput, "a stream of inputs.*; accepted: "):
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
        with neritic.open(MISSION, seed=1) as world:
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
            world = neritic.open(MISSION, seed=1)
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
                     lambda: diver.send(b"x", to="fish"), lambda: rov.command("send", [9, 1]),
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
            world = neritic.open(MISSION, seed=1)
            return [obs.step async for obs in world.ticks(10, count=3)]

        self.assertEqual(asyncio.run(run()), [10, 20, 30])

    def test_other_threads_run_while_a_world_steps(self):
        world = neritic.open(MISSION, seed=1)
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
        world = neritic.open(MISSION, seed=1)
        world.images("rov_sonar/echoes")
        image = world.tick(1)["rov_sonar/echoes"]
        pixels = image.pixels
        self.assertTrue(np.shares_memory(pixels, image.pixels))
        self.assertFalse(pixels.flags.owndata)
        begun = time.perf_counter()
        for _ in range(100):
            image.pixels
        self.assertLess((time.perf_counter() - begun) / 100, 0.2e-3)
        total = float(pixels.sum())
        world.close()
        del world, image
        self.assertEqual(float(pixels.sum()), total)
        self.assertGreater(total, 0.0)

    def test_a_recording_is_made(self):
        world = neritic.open(MISSION, seed=1)
        with tempfile.TemporaryDirectory() as folder:
            with world.record(Path(folder) / "run"):
                world["rov"].goto(5, 5, -5)
                world.tick(240)
            self.assertEqual((Path(folder) / "run.mcap").read_bytes()[:8], b"\x89MCAP0\r\n")

    def test_refusals_are_one_line_that_says_what_is_accepted(self):
        world = neritic.open(MISSION, seed=1)
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
                     lambda: neritic.open(MISSION, seed=-1), lambda: neritic.open(MISSION, seed=2**64),
                     lambda: neritic.open(MISSION, threads=10**6), lambda: neritic.vector("hover", "x"),
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
        world = neritic.open(str(ROOT / "assets/scenes/dive.toml"), seed=1)
        rov, diver = world["rov"], world["diver"]
        stands = np.tile([0.0, 0.0, 0.0, 1.0], 15)
        world.tick(4)
        diver.joints(stands)
        diver.jacket(inflate=1, dump=np.True_)
        bad = {
            "accepted: a word in quotes": (lambda: world.truth(3), lambda: world.images(3), lambda: rov.command(3, [1]),
                                           lambda: world.inject("diver/buttons", [0, 0, 0], source=3), lambda: world.on(3, print),
                                           lambda: world.link(3), lambda: world.off(3), lambda: neritic.vector(3),
                                           lambda: neritic.open(MISSION, device=3), lambda: neritic.connect("tcp://127.0.0.1:1", name=3)),
            "accepted: a function": (lambda: world.on("diver/motion", 3),),
            "accepted: bytes that save": (lambda: world.restore(3), lambda: world.restore("x")),
            "accepted: a text or bytes": (lambda: rov.send(None), lambda: rov.send(7)),
            "accepted: a file's path": (lambda: neritic.open(None), lambda: neritic.vector("hover", vehicle=3), lambda: world.record(3).__enter__()),
            "accepted: 60": (lambda: diver.joints(np.zeros(59)), lambda: diver.joints(np.zeros(61))),
            "a quaternion of length": (lambda: diver.joints(np.zeros(60)), lambda: diver.joints(stands * 1e200), lambda: diver.head([0] * 4),
                                       lambda: diver.joints(stands * np.nan)),
            "accepted: True or False": (lambda: diver.jacket(inflate=-1), lambda: diver.jacket(dump="x"),
                                        lambda: neritic.open(MISSION, real_time="x")),
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

    @staticmethod
    async def all_of(ticks):
        return [one async for one in ticks]

    def test_a_recording_that_cannot_be_written_is_refused_before_the_trial(self):
        world = neritic.open(MISSION, seed=1)
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "file").write_text("")
            Path(folder, "run.mcap").mkdir()
            for name in ("none/run", "file/run", "run", "run.mcap", ""):
                with self.assertRaisesRegex(neritic.BadInput, "record: found .*; accepted: "), world.record(os.path.join(folder, name)):
                    self.fail("the trial ran")
        self.assertEqual(world.step, 0)
        with self.assertRaises(neritic.BadInput), world.record("/proc/run"):
            self.fail("the trial ran")

    def test_the_blocks_own_exception_is_not_replaced_by_the_recordings(self):
        world = neritic.open(MISSION, seed=1)
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
            import neritic.gym
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
            import neritic.gym  # noqa: F811

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
