"""A world on a server is the world in this process: the same observations, hashes and truths."""

import contextlib
import io
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import unittest.mock

import numpy as np

import neritic
import neritic.join
from neritic import speed

try:
    import msgpack  # noqa: F401
    import zmq  # noqa: F401
except ImportError as missing:
    print(f"skipped: no {missing.name}")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("NERITIC", str(ROOT / "build/release/tools/neritic"))
SCENE = str(ROOT / "tests/scenes/over_sand.toml")
PORT = 47000 + os.getpid() % 900


class Served:
    """`neritic serve` of a scene, until the end of the block."""

    def __init__(self, *flags, scene=SCENE):
        self.address = f"tcp://127.0.0.1:{PORT}"
        self.flags, self.scene = flags, scene

    def __enter__(self):
        self.process = subprocess.Popen(
            [PROGRAM, "serve", self.scene, "--seed", "3", "--bind", self.address, *self.flags],
            stdout=subprocess.PIPE, text=True)
        self.process.stdout.readline()
        return self.address

    def __exit__(self, *_):
        self.process.terminate()
        self.process.communicate(timeout=30)


class Remote(unittest.TestCase):
    def same(self, here, there):
        self.assertEqual(list(here), list(there))
        for name in here:
            a, b = here[name], there[name]
            self.assertEqual((a.stamp, a.arrival, a.sequence, a.frame), (b.stamp, b.arrival, b.sequence, b.frame))
            np.testing.assert_array_equal(a.values, b.values)

    def test_observations_are_those_of_the_process(self):
        with Served() as address, neritic.open(SCENE, seed=3) as here, neritic.connect(address) as there:
            self.assertEqual([s for s in here.streams], [s for s in there.streams])
            heard = ([], [])
            for world, list_ in zip((here, there), heard):
                world.link("diver/motion", delay=0.02, jitter=0.01, loss=0.1)
                world.on("diver/motion", lambda reading, to=list_: to.append((reading.sequence, reading.arrival)))
            for turn in range(6):
                if turn == 2:
                    for world in (here, there):
                        world["rov"].goto(8, 15, -15)
                        world["diver"].jacket(inflate=True)
                self.same(here.tick(40), there.tick(40))
                self.assertEqual(here.hash, there.hash)
                a, b = here.truth("rov"), there.truth("rov")
                np.testing.assert_array_equal(a.position, b.position)
                np.testing.assert_array_equal(a.thruster_n, b.thruster_n)
            self.assertEqual(*heard)
            self.assertGreater(len(heard[0]), 10)
            state = there.save()
            self.assertEqual(state, here.save())
            there.tick(10)
            there.restore(state)
            self.assertEqual(there.hash, here.hash)
            with self.assertRaisesRegex(neritic.BadInput, "agent"):
                there._core.truth("fish")

    def test_limits_and_errors_are_those_of_the_process(self):
        with Served() as address, neritic.open(SCENE, seed=3) as here, neritic.connect(address) as there:
            self.assertEqual(here.hash, there.hash)  # before a first tick
            self.same(here.tick(0), there.tick(0))
            self.assertEqual(there.step, 0)
            with unittest.mock.patch.object(neritic.remote, "_STEPS", 25):  # in parts, with all that arrives
                heard = ([], [])
                for world, list_ in zip((here, there), heard):
                    world.on("diver/motion", lambda reading, to=list_: to.append(reading.sequence))
                self.same(here.tick(130), there.tick(130))
                self.assertEqual(*heard)
            self.assertEqual(here.hash, there.hash)
            for world in (here, there):
                before = list(world.observe())
                self.assertGreater(len(before), 1)
                with self.assertRaises(neritic.BadInput):
                    world.restore(b"xx")
                self.assertEqual(list(world.observe()), before)
                with self.assertRaisesRegex(neritic.BadInput, "stamp: found 99 s; accepted: up to now"):
                    world.inject("diver/buttons", [0, 0, 0], "suit", stamp=99.0)
            there.wait(np.int64(1), np.float32(0.01))
            there.wait(0)
            for call in (lambda: there.wait(-1), lambda: there.wait("x"), lambda: there.wait(1, -1.0), lambda: there.tick("x"),
                         lambda: neritic.connect(address, key="none.secret", server_key="none.public"),
                         lambda: neritic.connect(address, key=3, server_key=3), lambda: neritic.connect(3),
                         lambda: neritic.connect(address, patience="x"), lambda: neritic.connect("tcp://127.0.0.1:99999")):
                with self.assertRaisesRegex(neritic.BadInput, "found .*; accepted: ") as caught:
                    call()
                self.assertNotIn("\n", str(caught.exception))

    def test_a_server_that_cannot_listen_moves_no_recording(self):
        with tempfile.TemporaryDirectory() as folder, Served() as address:
            pathlib.Path(folder, "kept.mcap").write_text("precious")
            served = subprocess.run([PROGRAM, "serve", SCENE, "--bind", address, "--record", f"{folder}/kept.mcap"], capture_output=True, text=True)
            self.assertEqual((served.returncode, os.listdir(folder)), (1, ["kept.mcap"]), served.stderr)

    def test_an_image_of_500_x_500_floats_costs_no_new_pages(self):
        faults, bring = [], neritic.remote.Core._bring

        def counted(core, images, frames):
            before = resource.getrusage(resource.RUSAGE_THREAD).ru_minflt
            bring(core, images, frames)
            if images:
                faults.append(resource.getrusage(resource.RUSAGE_THREAD).ru_minflt - before)

        try:
            with unittest.mock.patch.object(neritic.remote.Core, "_bring", counted):
                speed.remote_image_ms(rounds=7)
        except neritic.Error as error:
            if "Vulkan" not in str(error):
                raise
            self.skipTest(str(error))
        # Its 245 pages are new with the first ones, whose memory the others use again.
        self.assertGreaterEqual(len(faults), 6)
        self.assertLess(sum(faults[3:]), 100, faults)

    def test_an_images_memory_is_used_again_when_nobody_has_it(self):
        buffers = neritic.remote._Buffers()
        first, _ = buffers.take((10, 100), "<f4")
        second, _ = buffers.take((10, 100), "<f4")
        self.assertFalse(np.shares_memory(first, second))
        part, at = first[3:], first.ctypes.data
        del first
        self.assertNotEqual(buffers.take((10, 100), "<f4")[0].ctypes.data, at)
        del part
        again, data = buffers.take((10, 100), "<f4")
        self.assertEqual((again.ctypes.data, data.ctypes.data, data.size), (at, at, 4000))
        self.assertEqual(buffers.take((9, 111), "<u2")[0].dtype, np.uint16)
        kept = [buffers.take((10, 100), "<f4")[0] for _ in range(100)]
        self.assertEqual(len({id(one) for one in kept}), 100)

    def test_a_long_tick_loses_no_reading(self):
        scene = str(ROOT / "tests/scenes/measured_over_sand.toml")
        with Served(scene=scene) as address, neritic.open(scene, seed=3) as here, neritic.connect(address) as there:
            heard = ([], [])
            for world, to in zip((here, there), heard):
                world.on("rov/imu", lambda reading, to=to: to.append(reading.sequence))
                world.tick(240 * 60)
            self.assertEqual(*heard)
            self.assertGreater(len(heard[0]), 8192)
            self.assertEqual((there.step, there.lost_readings), (here.step, 0))
            self.assertEqual((there.counts()["lost_readings"], there.counts()["lost_images"]), (0, 0))

    def test_counts_of_sources_are_those_of_the_process(self):
        with Served() as address, neritic.open(SCENE, seed=3) as here, neritic.connect(address) as there:
            for world in (here, there):
                for k in range(1500):
                    world.inject("diver/buttons", [k % 2, 0, 0], source="jacket")
                world["diver"].jacket(inflate=True)
                world.tick(3)
            a, b = here.counts()["sources"], there.counts()["sources"]
            self.assertEqual(a, b)
            self.assertEqual((a["jacket"].accepted, a["jacket"].dropped), (1500, 1500 - 1024 - 1))
            self.assertEqual((a["python"].health, a["jacket"].link), ("good", None))

    def test_a_call_that_was_given_up_loses_no_reading(self):
        with Served() as address, neritic.connect(address) as there:
            heard = []
            there.on("diver/motion", lambda reading: heard.append(reading.sequence))
            there.tick(24)
            patience, there._core._patience = there._core._patience, -1e3
            with self.assertRaisesRegex(neritic.Error, "no answer"):
                there.tick(240)
            there._core._patience = patience
            there.tick(24)
            self.assertEqual(heard, list(range(heard[0], heard[0] + len(heard))))
            self.assertGreater(len(heard), 24 + 24)

    def test_a_server_that_was_started_anew_is_named(self):
        with Served() as address, neritic.connect(address) as there:
            pass
        with Served() as address:
            there = neritic.connect(address)
            there.tick(1)
        with Served():
            with self.assertRaisesRegex(neritic.Error, "the server knows nothing of this client.*; accepted: neritic.connect"):
                for _ in range(2):  # the first call may find the connection closed
                    try:
                        there.tick(1)
                    except neritic.Error as error:
                        if "was closed" not in str(error):
                            raise
            there.close()

    def test_a_closed_world_and_bad_numbers_are_refused_as_in_the_process(self):
        with Served("--seconds", "60") as address, neritic.open(SCENE, seed=3) as here, neritic.connect(address) as there:
            lines = []
            for world in (here, there):
                for call in (lambda: world["rov"].goto(float("nan"), 0, 0), lambda: world["rov"].thrusters([0] * 300),
                             lambda: world["rov"].thrusters(np.inf * np.ones(8))):
                    with self.assertRaises(neritic.BadInput) as raised:
                        call()
                    lines.append(str(raised.exception))
            self.assertEqual(lines[:3], lines[3:])
            there.close()
            for name in ("time", "step", "title", "seed", "step_s", "hash"):
                with self.assertRaisesRegex(neritic.BadInput, "closed"):
                    getattr(there, name)

    def test_close_ends_a_tick_of_another_thread(self):
        with Served() as address:
            world, ends = neritic.connect(address), []

            def long():
                try:
                    world.tick(240 * 3600)
                except neritic.Error as error:
                    ends.append(str(error))

            thread = threading.Thread(target=long)
            thread.start()
            time.sleep(0.3)
            world.close()
            thread.join(5.0)
            self.assertFalse(thread.is_alive())
            self.assertRegex(ends[0], "closed")

    def test_a_server_is_refused_what_it_cannot_use(self):
        for flags, words in ((["--bind", "foo"], "--bind: found 'foo'; accepted: tcp://ADDRESS:PORT"),
                             (["--recordings", "/nowhere/at/all"], "--recordings: found /nowhere/at/all, no folder; accepted: ")):
            done = subprocess.run([PROGRAM, "serve", SCENE, *flags], capture_output=True, text=True, timeout=30)
            self.assertEqual(done.returncode, 2)
            self.assertIn(words, done.stderr)

    def test_a_client_that_does_not_tick_gets_images_mail_and_callbacks(self):
        scene = str(ROOT / "tests/scenes/talk_over_sand.toml")
        with Served(scene=scene) as address, neritic.connect(address) as ticks, neritic.connect(address) as looks:
            heard = []
            looks.on("diver/motion", heard.append)
            ticks.tick(336)
            ticks["diver"].send("look", to="rov")
            ticks.tick(1200)
            looks.observe()
            self.assertEqual([message.data for message in looks["rov"].receive()], [b"look"])
            self.assertEqual(heard, [])
            looks.wait(0)
            self.assertEqual(heard[-1].sequence - heard[0].sequence, len(heard) - 1)
            self.assertGreater(len(heard), 100)
        with Served() as address, neritic.connect(address) as ticks, neritic.connect(address) as looks:
            try:
                looks.images("rov_sonar/echoes", rate=2)
            except neritic.Error as error:
                self.skipTest(str(error))
            with self.assertRaisesRegex(neritic.BadInput, "images of rov_sonar/echoes: found 30 Hz; accepted: 0 .* to 10 Hz"):
                ticks.images("rov_sonar/echoes", rate=30)
            for ping in (5, 10):  # each tick gives the image of its end
                ticks.tick(120)
                image = looks.observe()["rov_sonar/echoes"]
                self.assertEqual((image.sequence, round(image.stamp / ticks.step_s)), (ping, 24 * ping))

    def test_a_wait_ends_with_the_steps_of_others(self):
        with Served("--realtime") as address, neritic.connect(address) as there, \
                unittest.mock.patch.object(neritic.remote, "_STEPS", 10), unittest.mock.patch.object(neritic.remote, "_WAIT_S", 0.01):
            before = there.step
            there.wait(30, 20.0)
            self.assertGreaterEqual(there.step, before + 30)

    def test_joining_fails_in_one_line(self):
        def join(*words):  # in this process
            out = io.StringIO()
            with unittest.mock.patch.object(sys, "argv", ["join", *words]), contextlib.redirect_stderr(out):
                status = neritic.join.main()
            self.assertEqual(out.getvalue().count("\n"), 1 if status else 0, out.getvalue())
            return status, out.getvalue()

        def run(*words):
            done = subprocess.run(["/usr/bin/python3", "-m", "neritic.join", *words], capture_output=True, text=True, timeout=60)
            self.assertEqual(done.stderr.count("\n"), 1 if done.returncode else 0, done.stderr)
            return done.returncode, done.stderr

        with Served() as address:
            found = run(address, SCENE, "--seconds", "0.1")
            self.assertEqual(found[0], 2, found)
            self.assertIn("found a server in lock-step", found[1])
        with Served("--realtime") as address:
            for words, status, line in (((address, "none.toml"), 2, "no such file"), (("there", SCENE), 2, "accepted: tcp://ADDRESS:PORT"),
                                        ((address, SCENE, "--as", "fish"), 2, "found 'fish'"),
                                        ((address, SCENE, "--as", "rov"), 2, "no object with a pose input"),
                                        ((address, SCENE, "--seconds", "nan"), 2, "--seconds"), ((address,), 2, "scene"),
                                        (("tcp://127.0.0.1:1", SCENE), 1, "no answer"),
                                        (("tcp://nosuch.invalid:5", SCENE), 1, "found no computer of the name nosuch.invalid")):
                found = join(*words)
                self.assertEqual(found[0], status, found)
                self.assertIn(line, found[1])
            self.assertEqual(run(address, SCENE, "--seconds", "0.1"), (0, ""))

    def test_messages_by_sound_are_those_of_the_process(self):
        talk = str(ROOT / "tests/scenes/talk_over_sand.toml")
        with Served(scene=talk) as address, neritic.open(talk, seed=3) as here, neritic.connect(address) as there:
            heard = []
            for world in (here, there):
                world.tick(240)
                world["diver"].send("look", to="rov")
                world.tick(120)
                world["rov"].send(bytes(range(64)))
                world.tick(360)
                heard.append(world["rov"].receive() + world["diver"].receive())
            self.assertEqual(*heard)
            self.assertEqual([m.data for m in heard[0]], [b"look", bytes(range(64))])
            self.assertEqual(here.hash, there.hash)

    def test_the_end_of_a_server_is_noticed_at_once(self):
        for end in ("terminate", "kill"):
            served = Served()
            with served as address, neritic.connect(address) as there:
                there.tick(1)
                timer = threading.Timer(0.3, getattr(served.process, end))
                timer.start()
                began = time.monotonic()
                with self.assertRaisesRegex(neritic.Error, "the connection was closed: the server has ended"):
                    while True:
                        there.tick(24)
                with self.assertRaisesRegex(neritic.Error, "the server has ended"):
                    there.tick(1)
                self.assertLess(time.monotonic() - began, 10.0)

    def test_keys_let_in_and_keep_out(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("ada", "eve"):
                subprocess.run([PROGRAM, "-q", "keys", folder, "--client", name], check=True)
            os.remove(f"{folder}/clients/eve.public")
            with Served("--keys", folder, "--realtime") as address:
                server = f"{folder}/server.public"
                with neritic.connect(address, key=f"{folder}/ada.secret", server_key=server) as world:
                    step = world.tick(5).step
                    self.assertGreaterEqual(world.tick(5).step, step + 5)
                for keys in ({"key": f"{folder}/eve.secret", "server_key": server}, {}):
                    with self.assertRaisesRegex(neritic.Error, "no answer"):
                        neritic.connect(address, patience=0.5, **keys)


    def test_two_machines_see_each_others_vehicles(self):
        vehicle = ('[[vehicles]]\nname = "{0}"\nshape = "box"\nposition_m = [{1}, -6, 0]\ndynamics = "'
                   + str(ROOT / "assets/vehicles/bluerov2_heavy_dynamics.toml") + '"\n')
        thing = ('[[objects]]\nname = "{0}"\nshape = "box"\nposition_m = [{1}, -6, 0]\n'
                 'inputs = {{ pose = "network" }}\n')
        with tempfile.TemporaryDirectory() as folder:
            scenes = []
            for i, (one, other) in enumerate(((vehicle, thing), (thing, vehicle))):
                scenes.append(pathlib.Path(folder) / f"{i}.toml")
                scenes[-1].write_text("[physics]\n" + one.format("ada", 0) + other.format("bob", 9))
            with Served("--realtime", scene=str(scenes[0])) as address, \
                    neritic.open(scenes[1], real_time=True) as here, \
                    neritic.connect(address, name="bob") as there:
                here["bob"].goto(9, 3, -5)
                there["ada"].goto(0, 3, -5)
                neritic.join.join(here, there, "bob", seconds=2.0)
                for name in ("ada", "bob"):
                    a, b = here.truth(name), there.truth(name)
                    self.assertGreater(np.linalg.norm(a.position - [9.0 * (name == "bob"), 0, -6]), 0.2)
                    self.assertLess(np.linalg.norm(a.position - b.position), 0.05)

    def test_a_participant_is_one_client_at_a_time(self):
        thing = '[[objects]]\nname = "bob"\nshape = "box"\nposition_m = [{0}, -6, 0]\n'
        vehicle = thing.replace("objects", "vehicles") + f'dynamics = "{ROOT}/assets/vehicles/bluerov2_heavy_dynamics.toml"\n'
        with tempfile.TemporaryDirectory() as folder:
            scenes = []
            for i, text in enumerate((thing + 'inputs = {{ pose = "network" }}\n', vehicle, vehicle)):
                scenes.append(pathlib.Path(folder) / f"{i}.toml")
                scenes[-1].write_text("[physics]\n" + text.format(10 * i))
            with Served("--realtime", scene=str(scenes[0])) as address:
                def joined():
                    return subprocess.run(["/usr/bin/python3", "-m", "neritic.join", address, scenes[2], "--as", "bob",
                                           "--seconds", "0.5"], capture_output=True, text=True, timeout=60)

                with neritic.open(scenes[1], real_time=True) as here, neritic.connect(address, name="bob") as there:
                    neritic.join.join(here, there, "bob", seconds=0.3)
                    second = joined()
                    self.assertEqual(second.returncode, 2, second.stderr)
                    self.assertRegex(second.stderr, "participant: found 'bob', whom another client is; accepted: one that nobody is\n$")
                    self.assertEqual(second.stderr.count("\n"), 1)
                    neritic.join.join(here, there, "bob", seconds=0.3)  # the same client again
                    self.assertLess(np.linalg.norm(there.truth("bob").position - here.truth("bob").position), 0.05)
                time.sleep(0.3)  # it has gone
                third = joined()
                self.assertEqual(third.returncode, 0, third.stderr)

    def test_a_diver_who_joins_is_shown_lying_as_he_swims(self):
        assets = str(ROOT / "assets")
        eve = f'[[objects]]\nname = "eve"\nmodel = "{assets}/models/diver.glb"\nposition_m = [5, -8, 0]\n'
        with tempfile.TemporaryDirectory() as folder:
            scenes = [pathlib.Path(folder) / "sea.toml", pathlib.Path(folder) / "lab.toml"]
            scenes[0].write_text("[physics]\n" + eve + 'inputs = { pose = "network" }\n')
            scenes[1].write_text("[physics]\n" + eve + f'human = "{assets}/divers/recreational.toml"\npitch_deg = -90\n'
                                 "swim = { waypoints_m = [[5, -8, -30]] }\n")
            with Served("--realtime", scene=str(scenes[0])) as address, \
                    neritic.open(scenes[1], real_time=True) as here, \
                    neritic.connect(address, name="eve") as there:
                neritic.join.join(here, there, "eve", seconds=1.5)
                a, b = here.truth("eve"), there.truth("eve")
                self.assertLess(np.linalg.norm(a.position - b.position), 0.05)
                to_head = neritic.join._turned(a.orientation, np.array((1.0, 0.0, 0.0)))
                up = neritic.join._turned(b.orientation, np.array((0.0, 0.0, 1.0)))
                self.assertGreater(to_head @ up, 0.99)
                # Her limbs there are her own, and kick.
                seen = []
                for _ in range(10):
                    neritic.join.join(here, there, "eve", seconds=0.1)
                    a, b = (world.truth("eve").joints.reshape(15, 4) for world in (here, there))
                    cosine = np.abs(np.sum(a * b, axis=1))
                    self.assertLess(2 * np.arccos(np.minimum(cosine, 1.0)).max(), 0.2)
                    seen.append(b)
                self.assertGreater(np.ptp(np.array(seen), axis=0).max(), 0.1)


if __name__ == "__main__":
    sys.exit(unittest.main())
