#!/usr/bin/env python3
"""What ctest ran: how many tests were in its entries, which of them were skipped, and which entries took longest.

usage: scripts/test_report.py BUILD_DIRECTORY [--slowest N]

ctest counts entries, most of which are a suite of a test program; the programs count their own tests. Reads
Testing/Temporary/LastTest.log of the build.
"""

import argparse
import pathlib
import re
import sys

ENTRY = re.compile(r"^\d+/\d+ Testing: (.+)$", re.MULTILINE)
SECONDS = re.compile(r"^Test time =\s+([\d.]+) sec$", re.MULTILINE)
RAN = re.compile(r"^\[==========\] (\d+) tests? from \d+ test suites? ran", re.MULTILINE)
PYTHON_RAN = re.compile(r"^Ran (\d+) tests? in ", re.MULTILINE)
SKIPPED = re.compile(r"^\[  SKIPPED \] ([\w/.]+) \(", re.MULTILINE)


def entries(log):
    """(name, seconds, number of tests, names of skipped tests) of every entry in a log of ctest."""
    starts = [*ENTRY.finditer(log)]
    for start, end in zip(starts, [match.start() for match in starts[1:]] + [len(log)]):
        text = log[start.end():end]
        seconds = SECONDS.search(text)
        tests = sum(int(count) for count in RAN.findall(text) + PYTHON_RAN.findall(text))
        yield start.group(1), float(seconds.group(1)) if seconds else 0.0, max(tests, 1), SKIPPED.findall(text)


def report(log, slowest):
    found = list(entries(log))
    if not found:
        return "no test ran"
    skipped = [name for _, _, _, names in found for name in names]
    lines = [f"{sum(tests for _, _, tests, _ in found)} tests in {len(found)} entries, {len(skipped)} of them skipped, "
             f"{sum(seconds for _, seconds, _, _ in found):.0f} s in all"]
    lines += [f"  skipped: {name}" for name in skipped]
    if slowest:
        lines.append("the slowest:")
        lines += [f"{seconds:8.1f} s  {name}" for name, seconds, _, _ in
                  sorted(found, key=lambda entry: -entry[1])[:slowest]]
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("build", type=pathlib.Path, metavar="BUILD_DIRECTORY")
    parser.add_argument("--slowest", type=int, default=20, metavar="N")
    arguments = parser.parse_args()
    log = arguments.build / "Testing" / "Temporary" / "LastTest.log"
    try:
        print(report(log.read_text(encoding="utf-8", errors="replace"), arguments.slowest))
    except OSError as error:
        print(f"test_report.py: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
