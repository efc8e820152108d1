"""The examples of the Python package and the Python of the READMEs: they run and do what they say."""

import binascii
import contextlib
import importlib.util
import io
import os
import re
import socket
import struct
import subprocess
import tempfile
import time
import unittest
import wave
from pathlib import Path

import numpy as np

import neritic

ROOT = Path(__file__).resolve().parents[2]
MISSION = str(ROOT / "assets/scenes/mission.toml")
TALK = str(ROOT / "assets/scenes/talk.toml")


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

    def test_each_is_run_in_any_folder(self):
        names = sorted(file.stem for file in (ROOT / "tools/python/examples").glob("*.py"))
        self.assertGreater(len(names), 4)
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            for name in names:
                self.assertTrue(Path(example(name).SCENE).is_file(), name)
            self.assertLess(quietly(example("square").main), 0.5)
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

    def test_counts_tell_the_health_and_the_clock_of_the_scenes_devices(self):
        assets, port = ROOT / "assets", 46000 + os.getpid() % 900
        with tempfile.TemporaryDirectory() as folder, socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            scene = Path(folder) / "lab.toml"
            scene.write_text(f'[physics]\n[[objects]]\nname = "diver"\nmodel = "{assets}/models/diver.glb"\n'
                             f'human = "{assets}/divers/recreational.toml"\nposition_m = [0, -12, 0]\n'
                             f'[sources]\njacket = "jacket udp {port}"\ngaze = "gaze udp {port + 1}"\n')
            with neritic.open(scene) as world:
                self.assertIsNone(world.counts()["sources"]["jacket"].link)  # in lock-step nobody listens
            with neritic.open(scene, real_time=True) as world:
                self.assertEqual(world.counts()["sources"]["jacket"].health, "waiting")
                begin = time.monotonic()
                for i in range(40):
                    # UBCD version 1 (engine/net/jacket_wire.hpp), by a clock that is 500 s behind; number 10 never comes.
                    late_us = int((time.monotonic() - begin + 100.0) * 1e6)
                    body = struct.pack("<4sBBHQBB3H", b"UBCD", 1, 0, i + (i >= 10), late_us, 0, 0, 0, 0, 0)
                    sender.sendto(body + struct.pack("<H", binascii.crc_hqx(body, 0xffff)), ("127.0.0.1", port))
                    world.tick(6)
                sources = world.counts()["sources"]
                jacket = sources["jacket"]
                self.assertEqual((jacket.health, sources["gaze"].health), ("good", "waiting"))
                self.assertGreater(jacket.accepted, 20)
                self.assertEqual((jacket.link.device, jacket.link.lost, jacket.link.trouble), ("jacket", 1, ""))
                # The host's clock and this one are the same but for their starts.
                self.assertAlmostEqual(jacket.link.clock_offset_s, begin - 100.0, delta=1.0)
                self.assertIsNone(sources["gaze"].link.clock_offset_s)

    def test_a_recording_has_the_sound_of_the_scenes_microphone(self):
        assets = ROOT / "assets"
        with tempfile.TemporaryDirectory() as folder:
            ramp = np.arange(-8000, 8000, dtype="<i2")
            with wave.open(f"{folder}/ramp.wav", "wb") as file:
                file.setparams((1, 2, 16000, 0, "NONE", ""))
                file.writeframes(ramp.tobytes())
            scene = Path(folder) / "lab.toml"
            scene.write_text(f'[physics]\n[[objects]]\nname = "diver"\nmodel = "{assets}/models/diver.glb"\n'
                             f'human = "{assets}/divers/recreational.toml"\nposition_m = [0, -12, 0]\n'
                             f'[sources]\nmic = "microphone wav {folder}/ramp.wav"\n')
            with neritic.open(scene, real_time=True) as world, world.record(Path(folder) / "run"):
                world.tick(360)
            subprocess.run([os.environ.get("NERITIC", str(ROOT / "build/release/tools/neritic")), "-q", "recording", "export", f"{folder}/run.mcap", "--format", "wav", "--out", f"{folder}/sounds"],
                           check=True)
            sound = (Path(folder) / "sounds/mic_sound.wav").read_bytes()
            heard = np.frombuffer(sound[sound.index(b"data") + 8:], dtype="<f4") * 32768
            self.assertGreater(len(heard), 8000)
            np.testing.assert_array_equal((heard - heard[0]) % 16000, np.arange(len(heard)) % 16000)

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
        world.no_images("rov_sonar/echoes")  # ten a second, each drawn; the goal is reached without
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


if __name__ == "__main__":
    unittest.main()
