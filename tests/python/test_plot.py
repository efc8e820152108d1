"""The parts of tools/plot that need no program. Exit 77: skipped."""
import os
import sys
import unittest

try:
    import matplotlib  # noqa: F401
except ModuleNotFoundError:
    sys.exit(77)

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(os.path.realpath(__file__)), "..", "..", "tools", "plot"))

import plan
import style


class Gaps(unittest.TestCase):
    def test_a_row_tells_of_the_time_since_the_row_before(self):
        self.assertEqual(style.gaps([0, 1, 2, 5, 6], [0, 1, 1, 0, 1]), [(0, 2), (5, 1)])
        self.assertEqual(style.gaps([0, 1, 2], [1, 0, 0]), [(0, 0)])
        self.assertEqual(style.gaps([0, 1, 2], [0, 0, 0]), [])
        self.assertEqual(style.gaps([0, 1, 2], [1, 1, 1]), [(0, 2)])

    def test_an_alarm_before_a_surface_interval_without_rows_ends_with_its_row(self):
        run = [0.0, 10.0, 11.0, 1500.0, 1510.0, 1511.0]
        data = {"run_min": run, "depth_m": [0, 18, 0, 0, 18, 0], "ceiling_m": [0] * 6, "gas": [0] * 6, "gases": ["air"],
                "ceiling_violated": [0] * 6, "alarm": [0, 0, 1, 0, 0, 1], "stops": []}
        fig = style.figure(900, 500)
        ax = style.area(fig, 70, 40, 870, 440)
        plan.draw_profile(ax, data, 1600.0)
        shaded = [(p.get_extents().x0, p.get_extents().width) for p in (ax.transData.inverted().transform_path(
            patch.get_transform().transform_path(patch.get_path())) for patch in ax.patches)]
        self.assertEqual(len(shaded), 2)
        for (x, wide), since in zip(shaded, (10.0, 1510.0)):
            self.assertAlmostEqual(x, since, places=3)
            self.assertLess(wide, 4.0)


class Legend(unittest.TestCase):
    def test_no_entry_is_left_out_however_little_room_there_is(self):
        for count, wide in ((2, 400), (6, 400), (6, 220), (12, 800)):
            fig = style.figure(900, 400)
            ax = style.area(fig, 70, 60, 70 + wide, 320)
            for i in range(count):
                ax.plot([0, 1], [0, i], label=f"shark_range_m {i}, delay_s 0.5")
            style.title(ax, "Distance of the ROV from the line")
            style.legend(ax)
            self.assertEqual(len(ax.get_legend().get_texts()), count)
            box = ax.get_legend().get_window_extent()
            self.assertLessEqual(box.width, max(wide + 6, 230))


if __name__ == "__main__":
    unittest.main()
