#!/usr/bin/env python3
"""The test of agreement on numbers of known distribution: its level, its power, its verdicts.

python3 tests/mitsuba/test_agreement.py
"""

import unittest

import numpy as np

import blocks
from agreement import MEAN_LIMIT, compare, judge, normal_from_student, student_from_normal


class Statistics(unittest.TestCase):
    """The test of agreement, on numbers whose distribution is known."""

    def test_normal_from_student(self):
        """Equal tail probabilities, from tables; and its inverse."""
        for dof, t, z in (
            (15, 2.1812, 2),
            (15, 6.7261, 4.5),
            (31, 4.1328, 3.66),
            (62, 4.9163, 4.5),
        ):
            self.assertAlmostEqual(normal_from_student(t, dof) / z, 1, delta=2e-3)
            self.assertAlmostEqual(
                student_from_normal(normal_from_student(t, dof), dof), t, places=9
            )

    def test_level(self):
        """Equal means, unequal variances, 16 seeds: sigma is as often beyond 2 and 3 as normal."""
        rng = np.random.default_rng(2)
        ours, theirs = 10 + rng.normal(size=(16, 400_000)), 10 + 3 * rng.normal(size=(16, 400_000))
        sigma = np.abs(compare(ours, theirs, 3.0)["sigma"])
        self.assertAlmostEqual(np.mean(sigma > 2) / 0.0455, 1, delta=0.05)
        self.assertAlmostEqual(np.mean(sigma > 3) / 0.0027, 1, delta=0.15)

    def test_power(self):
        """An error of the size called "seen" is seen about nine times out of ten."""
        rng = np.random.default_rng(3)
        ours, theirs = (10 + rng.normal(size=(16, 100_000)) for _ in range(2))
        seen = np.median(compare(ours, theirs, MEAN_LIMIT)["seen"])
        found = np.abs(compare(ours + 10 * seen, theirs, MEAN_LIMIT)["sigma"]) > MEAN_LIMIT
        self.assertAlmostEqual(np.mean(found), 0.9, delta=0.05)

    def test_verdicts(self):
        """Equal, scaled, one block off, not finite, black, noisy, constant."""
        rng = np.random.default_rng(4)
        ours, theirs = (1 + 0.3 * rng.normal(size=(16, 40, 40, 3)) for _ in range(2))
        self.assertEqual(judge(ours, theirs)["verdict"], "AGREE")
        self.assertEqual(judge(ours * 1.02, theirs)["verdict"], "FAILED")
        spot = ours.copy()
        spot[:, 32:, 16:32] *= 1.06
        report = judge(spot, theirs)
        self.assertEqual(
            (report["verdict"], report["rows"][0]["block"]["pixel"]), ("FAILED", [16, 32])
        )
        spot = ours.copy()
        spot[3, 5, 5, 1] = np.nan
        self.assertEqual(judge(spot, theirs)["verdict"], "FAILED")
        self.assertEqual(judge(0 * ours, 0 * theirs)["verdict"], "UNDECIDED")
        self.assertEqual(
            judge(*(1 + 30 * rng.normal(size=(2, 16, 16, 16, 3))))["verdict"], "UNDECIDED"
        )
        flat = np.ones((16, 16, 16, 3))
        self.assertEqual(judge(flat, flat * (1 + 1e-6))["verdict"], "AGREE")
        self.assertEqual(judge(flat, flat * 1.001)["verdict"], "FAILED")

    def test_blocks(self):
        """95 % within 10 %: equal, a little off, too far off, three and four of 64 far off."""
        rng = np.random.default_rng(5)
        ours, theirs = (1 + 0.1 * rng.normal(size=(2, 256, 256, 3)) for _ in range(2))
        for factor, agree in ((1, True), (1.08, True), (0.92, True), (1.12, False), (0.88, False)):
            self.assertEqual(blocks.judge(ours * factor, theirs)["agree"], agree)
        for count, agree in ((3, True), (4, False)):
            spot = ours.copy()
            spot[:, -32:, -32 * count :] *= 1.3
            report = blocks.judge(spot, theirs)
            self.assertEqual((report["agree"], report["worst_pixel"][1]), (agree, 224))
        spot = ours.copy()
        spot[0, 5, 5, 1] = np.nan
        self.assertEqual(blocks.judge(spot, theirs)["agree"], False)
        self.assertEqual(blocks.judge(0 * ours, 0 * theirs)["agree"], True)


if __name__ == "__main__":
    unittest.main()
