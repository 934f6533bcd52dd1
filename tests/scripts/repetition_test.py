#!/usr/bin/env python3
"""Numbers that an earlier version computed come out again, bit for bit: files of every kind of study in
tests/data/repetition/, and digests of trajectories of every family of methods.

usage: repetition_test.py --federwerk EXECUTABLE [unittest options]
       repetition_test.py --federwerk EXECUTABLE --write [KIND...]   writes files and digests anew

Writing is for a number that was wrong, and for a new kind or family: the commit then names the values before and
after. No method here depends on the kernels that a BLAS chooses for the processor (cholmod, petsc); sines and
powers come from the C library, which may round otherwise on a processor without fused multiply-add.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(CHECKOUT / "scripts"))
import compare_results  # noqa: E402
import compare_versions  # noqa: E402

DATA = CHECKOUT / "tests" / "data" / "repetition"
DIGESTS = DATA / "trajectories.json"
FOREIGN = ("sundials:cvode_adams", "sundials:cvode_bdf", "sundials:arkode_erk", "sundials:arkode_dirk", "sundials:ida",
           "gsl:rk8pd", "gsl:bsimp", "gsl:msbdf")
settings = argparse.Namespace(federwerk=None)


def processor():
    """The processor of this machine and of the one that wrote the digests, for messages."""
    here = "unknown"
    if os.path.exists("/proc/cpuinfo"):
        with open("/proc/cpuinfo", encoding="utf-8") as file:
            here = next((line.split(":", 1)[1].strip() for line in file if line.startswith("model name")), here)
    return here


def federwerk(*words, cwd=None):
    environment = dict(os.environ, OPENBLAS_NUM_THREADS="1", OMP_NUM_THREADS="1", OMP_WAIT_POLICY="passive",
                       FEDERWERK_CACHE="")
    return subprocess.run([settings.federwerk, *map(str, words)], cwd=cwd, env=environment, text=True,
                          stdin=subprocess.DEVNULL, capture_output=True, check=False)


def catalogue(what):
    return json.loads(federwerk("list", what, "--json").stdout)


def simulations():
    """Two methods of every family and a few foreign ones: at constant steps and, where they choose their own, with
    tolerances."""
    families = {}
    for method in catalogue("methods"):
        if ":" not in method["name"]:
            families.setdefault(method["family"], []).append(method)
        elif method["name"] in FOREIGN:
            families.setdefault(method["name"], []).append(method)
    for methods in families.values():
        for method in {entry["name"]: entry for entry in (methods[0], methods[-1])}.values():
            for scene in compare_versions.EVERY_METHOD:
                controls = (compare_versions.STEP, compare_versions.TOLERANCES)
                for control in controls[:2 if method["adaptive"] else 1]:
                    yield compare_versions.Simulation(DATA / f"{scene}.toml", method["name"], control)


def digest_of(simulation):
    """The digest of what a run computes, or why there is nothing."""
    with tempfile.TemporaryDirectory() as folder:
        answer = federwerk("simulate", simulation.scene, "--method", simulation.method, *simulation.control, "--frames",
                           7, "-o", "result.h5", cwd=folder)
        if answer.returncode == 2:
            return "refused"
        return compare_results.digest(pathlib.Path(folder) / "result.h5")


def digests():
    """All of them by name, as many at a time as there are processors."""
    planned = list(simulations())
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        return dict(zip((simulation.name for simulation in planned), pool.map(digest_of, planned)))


class Repetition(unittest.TestCase):
    def setUp(self):
        if settings.federwerk is None:
            self.skipTest("no executable given (--federwerk)")

    def test_every_kind_of_study_has_a_file_that_is_repeated(self):
        kinds = {entry["name"] for entry in catalogue("studies")}
        files = {path.stem for path in (DATA / "studies").glob("*.h5")}
        self.assertEqual(files, kinds, "expected a file for every kind; repetition_test.py --write KIND makes it")

    def test_files_of_every_kind_come_out_the_same_bit_for_bit(self):
        with tempfile.TemporaryDirectory() as folder:
            files = sorted((DATA / "studies").glob("*.h5"))
            answer = federwerk("run", *files, "-o", folder, "--jobs", 2, cwd=folder)
            for file in files:
                with self.subTest(file.stem):
                    self.assertIn(f"{file}: repeated, ", answer.stdout, answer.stderr)
                    line = answer.stdout.split(f"{file}: repeated, ")[1]
                    self.assertIn("are the same bit for bit", line.split("\n")[0],
                                  f"on {processor()}: " + line.split("\n\n")[0])
                    found = compare_results.compare_files(file, pathlib.Path(folder) / f"{file.stem}.repeated.h5")
                    self.assertEqual(found.differences, [], f"on {processor()}")
                    self.assertGreater(found.values, 50)

    def test_trajectories_of_every_family_come_out_the_same_bit_for_bit(self):
        expected = json.loads(DIGESTS.read_text())
        found = digests()
        self.assertEqual(sorted(found), sorted(expected["digests"]), "other methods; --write makes their digests")
        for name, value in expected["digests"].items():
            with self.subTest(name):
                self.assertEqual(found[name], value, f"computed on {processor()}, written on {expected['processor']}")


def write(kinds):
    """Makes the files of the kinds, or of all kinds and the digests, with this executable."""
    for study in sorted((DATA / "studies").glob("*.toml")):
        if kinds and study.stem not in kinds:
            continue
        with tempfile.TemporaryDirectory() as folder:
            answer = federwerk("run", study, "-o", folder, "--jobs", 2, cwd=folder)
            if answer.returncode not in (0, 1):
                raise SystemExit(f"{study}: {answer.stderr}")
            (study.with_suffix(".h5")).write_bytes((pathlib.Path(folder) / f"{study.stem}.h5").read_bytes())
    if not kinds:
        DIGESTS.write_text(json.dumps({"processor": processor(), "digests": digests()}, indent=1) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--federwerk", required=True, metavar="EXECUTABLE")
    parser.add_argument("--write", nargs="*", metavar="KIND")
    arguments, others = parser.parse_known_args()
    settings.federwerk = str(pathlib.Path(arguments.federwerk).resolve())
    if arguments.write is not None:
        write(arguments.write)
        return
    unittest.main(argv=[sys.argv[0], *others])


if __name__ == "__main__":
    main()
