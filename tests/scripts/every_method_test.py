#!/usr/bin/env python3
"""Every method of the catalogue simulates a scene with all forces, or one without dampers if it takes no others, at
constant steps and with tolerances; no sanitizer complains. For builds with sanitizers, where the methods' own test
programs are not built.

usage: every_method_test.py --federwerk EXECUTABLE
"""

import argparse
import concurrent.futures
import os
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import compare_versions  # noqa: E402

COMPLAINTS = ("Sanitizer", "runtime error:", "Assertion")


def complaint(answer):
    """Why a run is not to be accepted, or nothing: a refusal is, and so is a solver that gives up."""
    if answer.returncode not in (0, 2, 3):
        return f"exit code {answer.returncode}: {answer.stderr[-3000:]}"
    if any(word in answer.stderr for word in COMPLAINTS):
        return answer.stderr[-3000:]
    return ""


def examine(federwerk, method):
    """(number of runs that were not refused, complaints) of a method."""
    ran, complaints = 0, []
    environment = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")
    with tempfile.TemporaryDirectory() as folder:
        for control in (compare_versions.STEP, compare_versions.TOLERANCES):
            for scene in compare_versions.EVERY_METHOD:
                answer = subprocess.run(
                    [federwerk, "simulate", compare_versions.SCENES / f"{scene}.toml", "--method", method, *control,
                     "--frames", "3", "-o", f"{folder}/{scene}.h5"],
                    env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
                found = complaint(answer)
                if found:
                    complaints.append(f"{method} on {scene} {' '.join(control)}: {found}")
                if answer.returncode != 2:
                    ran += 1
                    break
    return ran, complaints


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--federwerk", required=True, metavar="EXECUTABLE")
    program = compare_versions.Program(parser.parse_args().federwerk, pathlib.Path(tempfile.gettempdir()))
    for seeded in ("==1==ERROR: AddressSanitizer: heap-use-after-free", "a.cpp:1: runtime error: index 7 out of bounds"):
        if not complaint(subprocess.CompletedProcess([], 0, "", seeded)):
            sys.exit("the test itself does not see what a sanitizer says")
    methods = program.names()
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        results = dict(zip(methods, pool.map(lambda name: examine(str(program.path), name), methods)))
    for _, complaints in results.values():
        for found in complaints:
            print(found)
    idle = [name for name, (ran, _) in results.items() if ran == 0]
    if idle:
        print(f"methods that ran on no scene: {', '.join(idle)}")
    print(f"{len(methods)} methods, {sum(ran for ran, _ in results.values())} runs")
    return 1 if idle or any(complaints for _, complaints in results.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
