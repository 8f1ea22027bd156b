"""Tests of samples.py and compare: python3 bench/test_samples.py"""

import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

from samples import fit_exponent, mann_whitney, spread

BENCH = pathlib.Path(__file__).resolve().parent


class MannWhitney(unittest.TestCase):
    def test_three_beside_three(self):
        # Of the 20 orders of 3 + 3 values one has U = 0 and one U = 9: p = 2 / 20.
        self.assertAlmostEqual(mann_whitney([1, 2, 3], [4, 5, 6]), 0.1)
        self.assertAlmostEqual(mann_whitney([4, 5, 6], [1, 2, 3]), 0.1)
        # U = 1: one order more on each side.
        self.assertAlmostEqual(mann_whitney([1, 2, 4], [3, 5, 6]), 0.2)
        # U = 4 of 9: 7 of the 20 orders have at most 3, 10 at most 4.
        self.assertAlmostEqual(mann_whitney([1, 4, 5], [2, 3, 6]), 1.0)

    def test_critical_values_of_the_tables(self):
        # Two-sided 5 % for 10 and 10: U <= 23 is significant, 24 is not (tables of the test, e.g.
        # Siegel, "Nonparametric Statistics", table K); 1 %: 16 and 17.
        for u, level in ((23, 0.05), (16, 0.01)):
            self.assertLessEqual(mann_whitney(*self.samples(u)), level)
            self.assertGreater(mann_whitney(*self.samples(u + 1)), level)

    def samples(self, u):
        """Ten and ten different values whose U is u <= 100: how often one of a is the larger."""
        b = [2.0 * i for i in range(10)]
        full, rest = divmod(u, 10)
        above = [10] * full + ([rest] if rest else [])
        above += [0] * (10 - len(above))
        return [2.0 * k - 1.0 - i / 100 for i, k in enumerate(above)], b

    def test_equal_values_say_nothing(self):
        self.assertEqual(mann_whitney([3.0] * 12, [3.0] * 12), 1.0)

    def test_ties_and_many_values(self):
        # The normal approximation is close to the exact value where both can be had.
        a, b = [i + 0.25 for i in range(20)], [i + 6.5 for i in range(20)]
        exact = mann_whitney(a, b)
        approximate = mann_whitney(a + [1000.0], b + [1000.0])
        self.assertLess(abs(exact - approximate), 0.005)


class Fits(unittest.TestCase):
    def test_exponents(self):
        x = [1e3, 1e4, 1e5, 1e6]
        self.assertAlmostEqual(fit_exponent(x, [2.5 * v for v in x]), 1.0)
        self.assertAlmostEqual(fit_exponent(x, [v**0.5 for v in x]), 0.5)
        self.assertAlmostEqual(fit_exponent(x, [7.0] * 4), 0.0)
        # Logarithms (0, 0), (1, 1), (2, 3): the slope is 3 / 2.
        self.assertAlmostEqual(fit_exponent([1, 10, 100], [1, 10, 1000]), 1.5)

    def test_spread(self):
        # Quartiles of 1 .. 5 are 2 and 4, the median 3.
        self.assertAlmostEqual(spread([5, 1, 4, 2, 3]), 1 / 3)
        self.assertEqual(spread([4.0]), 0.0)


class Compare(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.addCleanup(self.directory.cleanup)

    def write(self, name, times):
        path = pathlib.Path(self.directory.name, name)
        runs = [{"name": "stage/x", "run_type": "iteration", "real_time": t, "cpu_time": t,
                 "time_unit": "us"} for t in times]
        runs.append({"name": "stage/x_median", "run_type": "aggregate", "real_time": 1e9,
                     "time_unit": "us"})
        path.write_text(json.dumps({"benchmarks": runs}))
        return str(path)

    def compare(self, *arguments):
        return subprocess.run([sys.executable, str(BENCH / "compare"), *arguments],
                              capture_output=True, text=True)

    def test_slower_and_significant(self):
        before = self.write("a.json", [100 + i for i in range(10)])
        after = self.write("b.json", [110.5 + i for i in range(10)])
        self.assertEqual(self.compare(before, after).returncode, 1)
        self.assertEqual(self.compare(after, before).returncode, 0)
        self.assertEqual(self.compare(before, before).returncode, 0)
        self.assertEqual(self.compare(before, after, "--slower", "15").returncode, 0)

    def test_noise_is_not_slower(self):
        before = self.write("a.json", [100 + 10 * (i % 5) + 0.1 * i for i in range(10)])
        after = self.write("b.json", [105.05 + 10 * (i % 5) + 0.1 * i for i in range(10)])
        self.assertEqual(self.compare(before, after, "--slower", "1").returncode, 0)

    def test_files_that_cannot_be_compared(self):
        good = self.write("a.json", range(1, 11))
        few = self.write("b.json", range(1, 10))
        result = self.compare(good, few)
        self.assertEqual(result.returncode, 3)
        self.assertIn("9 repetitions, expected at least 10", result.stderr)
        self.assertEqual(self.compare(good, "missing.json").returncode, 3)
        (pathlib.Path(self.directory.name) / "c.json").write_text("[1")
        self.assertEqual(self.compare(good, self.directory.name + "/c.json").returncode, 3)


if __name__ == "__main__":
    unittest.main()
