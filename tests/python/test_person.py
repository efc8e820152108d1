"""A person in a headset as the diver of the shark's task: a fake runtime turns the head until the eyes meet the shark."""
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

try:
    import msgpack  # noqa: F401
    import numpy as np
    import zmq  # noqa: F401
except ImportError as missing:
    print(f"skipped: no {missing.name}")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("NERITIC", str(ROOT / "build/release/tools/neritic"))
RUNTIME = os.environ.get("NERITIC_FAKE_OPENXR", str(ROOT / "build/release/tests/fakes/libneritic_fake_openxr.so"))
if not os.path.exists(RUNTIME):
    print("skipped: no fake OpenXR runtime")
    sys.exit(77)
sys.dont_write_bytecode = True
sys.path[:0] = [str(ROOT / "tools/experiment")]

import shark_person

# 35 degrees beside the shark for six seconds, then on it.
SCRIPT = "size 32 32\nperiod 0.05\nreal_time yes\nhead 0 0 1.6 0 0\nhead 6 0 1.6 0 0\nhead 8 0 1.6 0 35\ngaze 0 0 0\n"


class Gaze(unittest.TestCase):
    def test_it_meets_what_it_passes_near_ahead_of_the_eyes(self):
        ahead = np.array([1.0, 0.0, 0.0])
        self.assertTrue(shark_person.rests_on(np.zeros(3), ahead, np.array([6.0, 0.4, 0.0]), 1.0))
        self.assertTrue(shark_person.rests_on(np.zeros(3), ahead, np.array([20.0, 1.5, 0.0]), 5.0))
        self.assertFalse(shark_person.rests_on(np.zeros(3), ahead, np.array([6.0, 1.4, 0.0]), 5.0))
        self.assertFalse(shark_person.rests_on(np.zeros(3), -ahead, np.array([6.0, 0.0, 0.0]), 5.0))
        self.assertFalse(shark_person.rests_on(np.zeros(3), np.zeros(3), ahead, 5.0))


class Headset(unittest.TestCase):
    def run_of(self, folder, *sets):
        """The run's measures and markers."""
        manifest, script, out = (os.path.join(folder, name) for name in ("fake.json", "script", "out"))
        with open(manifest, "w") as file:
            json.dump({"file_format_version": "1.0.0", "runtime": {"name": "fake", "library_path": RUNTIME}}, file)
        with open(script, "w") as file:
            file.write(SCRIPT + f"report {folder}/report\n")
        done = subprocess.run(
            ["/usr/bin/python3", "-B", str(ROOT / "tools/experiment"), "shark", "--program", PROGRAM, "--out", out, "--runs", "1", "--quiet",
             "--set=person=\"headset\"", "--set=person_bearing_deg=35", "--set=person_spread_deg=0", "--set=person_side=port", "--set=gaze_within_deg=12", *(f"--set={one}" for one in sets)],
            env=os.environ | {"XR_RUNTIME_JSON": manifest, "NERITIC_FAKE_XR": script}, capture_output=True, text=True, timeout=250)
        with open(os.path.join(out, "runs.jsonl")) as file:
            run = json.loads(file.read().splitlines()[1])
        if run["failure"] and "Vulkan" in run["failure"]:
            self.skipTest(run["failure"])
        self.assertIsNone(run["failure"], done.stderr)
        self.assertFalse(os.path.exists(folder + "/report") and open(folder + "/report").read())
        with open(os.path.join(out, "person", "seed_1_1.markers.jsonl")) as file:
            return run["measures"], [json.loads(line)["marker"] for line in file]

    def test_the_run_begins_with_the_wearers_gaze_and_is_judged_and_recorded_as_any(self):
        with tempfile.TemporaryDirectory() as folder:
            measures, markers = self.run_of(folder, "seconds=3", "from_recording=true")
            # Not before the head had turned, and then soon.
            self.assertGreater(measures["found_s"], 0.15)
            self.assertIn("blocked", measures)
            self.assertTrue(measures["same_from_recording"])
            self.assertLess(measures["person_moved_m"], 3.0)  # hovers
            self.assertEqual(markers[:3], ["shark shown", "gaze met the shark", "the ROV is told"])
            self.assertEqual(markers[-1], "run ends")
            # The recording has them too.
            told = subprocess.run([PROGRAM, "recording", "export", os.path.join(folder, "out/person/seed_1_1.mcap"), "--out", folder + "/rows", "-q"],
                                  capture_output=True, text=True, timeout=60)
            self.assertEqual(told.returncode, 0, told.stderr)
            rows = "".join(p.read_text() for p in pathlib.Path(folder, "rows").rglob("*markers*") if p.is_file())
            self.assertIn("gaze met the shark", rows)

    def test_what_the_wearer_looks_at_goes_to_the_detector_whose_word_the_rov_waits_for(self):
        try:
            import cv2  # noqa: F401
        except ImportError as missing:
            self.skipTest(f"no {missing.name}")
        with tempfile.TemporaryDirectory() as folder:
            measures, markers = self.run_of(folder, "seconds=3", "detector=\"shipped\"", "detector_least=0.2", "shark_known_by=\"sonar\"")
            self.assertGreaterEqual(measures["looks"], 1)
            told = [m for m in markers if m in ("the detector says shark", "the ROV is told")]
            self.assertIn(told, ([], ["the detector says shark"], ["the detector says shark", "the ROV is told"]))


if __name__ == "__main__":
    unittest.main()
