"""The report on a run of ctest counts what the programs count, and names what was skipped."""

import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import test_report  # noqa: E402

LOG = """Start testing: Nov 28 00:00 UTC
----------------------------------------------------------
1/3 Testing: store.DiskFull
1/3 Test: store.DiskFull
Output:
[ RUN      ] DiskFull.Stops
[       OK ] DiskFull.Stops (3 ms)
[ RUN      ] DiskFull.GoesOn
[  SKIPPED ] DiskFull.GoesOn (0 ms)
[==========] 2 tests from 1 test suite ran. (3 ms total)
[  SKIPPED ] 1 test, listed below:
[  SKIPPED ] DiskFull.GoesOn
<end of output>
Test time =   0.25 sec
2/3 Testing: scripts
Output:
Ran 61 tests in 4.000s
Test time =   4.50 sec
3/3 Testing: format
Output:
Test time =   1.00 sec
"""


class Report(unittest.TestCase):
    def test_counts_tests_and_names_what_was_skipped(self):
        self.assertEqual(test_report.report(LOG, 2), "64 tests in 3 entries, 1 of them skipped, 6 s in all\n"
                         "  skipped: DiskFull.GoesOn\nthe slowest:\n     4.5 s  scripts\n     1.0 s  format")

    def test_says_that_nothing_ran(self):
        self.assertEqual(test_report.report("", 2), "no test ran")


if __name__ == "__main__":
    unittest.main()
