#!/usr/bin/env python3
"""Shows that two builds of federwerk compute the same numbers, bit for bit.

usage: scripts/python scripts/compare_versions.py BEFORE AFTER [--jobs N] [--keep DIR] [--only PATTERN] [...]

BEFORE and AFTER are executables. Both run every study of studies/ (with --quick) and simulate scenes with every
method of the catalogue, at constant steps and with tolerances, with every listed value of its options. AFTER
also repeats the files that BEFORE made (`federwerk run FILE.h5`). Every dataset and attribute is compared
(compare_results.py says what counts); a run that is refused or fails has to end with the same exit code and message.

Results lie in DIR, in a folder per program (named after its SHA-256), and are taken from there when the same programs
are compared again. Exit code: 0 all the same, 1 something differs, 2 bad usage.
"""

import argparse
import concurrent.futures
import dataclasses
import fnmatch
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import compare_results  # noqa: E402

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent
SCENES = CHECKOUT / "tests" / "data" / "repetition"
EVERY_METHOD = ("all_forces", "conservative")  # scenes
A_FEW_METHODS = ("strain", "tension_only")
FEW = ("symplectic_euler", "velocity_verlet", "rk4", "implicit_midpoint", "implicit_euler_linearised",
       "generalised_alpha", "sundials:cvode_bdf", "petsc:ts_theta")
STEP = ("--step", "0.01", "--t-end", "0.3")  # whole steps: multistep methods ask for them
SHORT_LAST_STEP = ("--step", "0.02", "--t-end", "0.25")
TOLERANCES = ("--rtol", "1e-5", "--atol", "1e-7", "--t-end", "0.3")
TIME_LIMIT = 600  # s, of one simulation
CLOCK = re.compile(r"[-+.\de]+ s$", re.MULTILINE)  # the seconds at the end of what simulate prints


class Program:
    """An executable and the folder of its results."""

    def __init__(self, path, keep):
        self.path = pathlib.Path(path).resolve()
        self.identity = hashlib.sha256(self.path.read_bytes()).hexdigest()
        self.folder = keep / self.identity[:16]
        self.environment = dict(os.environ, FEDERWERK_CACHE=str(self.folder / "references"), OMP_NUM_THREADS="1",
                                OPENBLAS_NUM_THREADS="1", OMP_WAIT_POLICY="passive")

    def run(self, *words, cwd=None, timeout=None):
        return subprocess.run([str(self.path), *map(str, words)], cwd=cwd, env=self.environment,
                              stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False, timeout=timeout)

    def names(self):
        """The methods of the catalogue."""
        return [entry["name"] for entry in json.loads(self.run("list", "methods", "--json").stdout)]

    def methods(self):
        """The methods of the catalogue with the description of their options."""
        return {name: json.loads(self.run("describe", name, "--json").stdout).get("options", [])
                for name in self.names()}


@dataclasses.dataclass(frozen=True)
class Simulation:
    """One run of `federwerk simulate`."""
    scene: pathlib.Path
    method: str
    control: tuple

    @property
    def name(self):
        return f"{self.scene.stem} {self.method} {' '.join(self.control)}"

    def run(self, program):
        """Exit code, messages and result file of the program, from an earlier comparison if there is one."""
        folder = program.folder / "simulations" / hashlib.sha256(
            self.name.encode() + self.scene.read_bytes()).hexdigest()[:24]
        answer, result = folder / "answer.json", folder / "result.h5"
        if not answer.exists():
            folder.mkdir(parents=True, exist_ok=True)
            result.unlink(missing_ok=True)
            try:
                ended = program.run("simulate", self.scene, "--method", self.method, *self.control, "--frames", 7, "-o",
                                    "result.h5", cwd=folder, timeout=TIME_LIMIT)
                said = {"exit code": ended.returncode, "output": CLOCK.sub("# s", ended.stdout),
                        "message": ended.stderr}
            except subprocess.TimeoutExpired:
                said = {"exit code": f"still running after {TIME_LIMIT} s"}
            answer.write_text(json.dumps({"run": self.name, **said}))
        return json.loads(answer.read_text()), result


@dataclasses.dataclass
class Outcome:
    """What the comparison of one run or study found."""
    name: str
    differences: list
    additions: list = dataclasses.field(default_factory=list)
    values: int = 0
    refused: bool = False


def compare_simulation(simulation, before, after):
    answer, file = simulation.run(before)
    other_answer, other_file = simulation.run(after)
    differences = [f"{key}: {answer.get(key)!r} before, {other_answer.get(key)!r} after"
                   for key in ("exit code", "output", "message") if answer.get(key) != other_answer.get(key)]
    outcome = Outcome(simulation.name, differences, refused=not file.exists())
    if file.exists() != other_file.exists():
        differences.append(f"a result file only {'before' if file.exists() else 'after'}")
    elif file.exists():
        found = compare_results.compare_files(file, other_file)
        outcome.additions, outcome.values = found.additions, found.values
        differences += found.differences
    return outcome


def compare_study(study, directory, before, after):
    """The study by BEFORE; its file repeated by AFTER; the study anew by AFTER, which takes over a case of the
    repetition only if it is the same case to the last digit of its specification."""
    name = str(study.relative_to(directory))
    outcome = Outcome(name, [])
    place = [program.folder / "studies" / study.relative_to(directory).with_suffix("") for program in (before, after)]
    file, repeated = place[0] / f"{study.stem}.h5", place[1] / f"{study.stem}.repeated.h5"
    anew = place[1] / f"{study.stem}.h5"
    made = before.run("run", study, "--quick", "-o", place[0])
    if made.returncode not in (0, 1):
        outcome.refused = True
        outcome.additions.append(f"BEFORE cannot run it: {made.stderr.strip()}")
        return outcome
    told = place[1] / f"repetition_of_{before.identity[:16]}.json"
    if not told.exists():
        answer = after.run("run", file, "-o", place[1])
        lines = [line for line in answer.stdout.splitlines() if line.startswith("  ") and "[" not in line[:4]]
        told.parent.mkdir(parents=True, exist_ok=True)
        told.write_text(json.dumps("" if "are the same bit for bit" in answer.stdout else
                                   " | ".join([f"exit code {answer.returncode}", *lines[:5], answer.stderr.strip()])))
        if repeated.exists() and not anew.exists():
            repeated.rename(anew)
    if json.loads(told.read_text()):
        outcome.differences.append(f"AFTER does not repeat {file}: {json.loads(told.read_text())}")
    answer = after.run("run", study, "--quick", "-o", place[1])
    if answer.returncode != made.returncode:
        outcome.differences.append(f"exit code {made.returncode} before, {answer.returncode} after "
                                   f"{answer.stderr.strip()}")
    if anew.exists():
        found = compare_results.compare_files(file, anew)
        outcome.differences += found.differences
        outcome.additions, outcome.values = found.additions, found.values
    return outcome


def option_values(option):
    """The values that an option can have but the default one: its choices; programs that print no choices say "cg,
    cholesky or lu"."""
    names = option.get("choices") or re.split(r", | or ", option["expected"])
    if "choices" not in option and (
            len(names) < 2 or not all(re.fullmatch(r"[a-z][a-z0-9_]*", name) for name in names)):
        return []
    return [name for name in names if name != option["default"]]


def planned_simulations(methods):
    """Every method at constant steps and with tolerances (a method that has no such refuses), with its options."""
    runs = []
    for name, options in methods.items():
        for scene in EVERY_METHOD:
            runs += [Simulation(SCENES / f"{scene}.toml", name, control) for control in (STEP, TOLERANCES)]
        runs.append(Simulation(SCENES / "conservative.toml", name, SHORT_LAST_STEP))
        if name in FEW:
            runs += [Simulation(SCENES / f"{scene}.toml", name, control)
                     for scene in A_FEW_METHODS for control in (STEP, TOLERANCES)]
        for option in options:
            runs += [Simulation(SCENES / "all_forces.toml", f"{name}[{option['name']}={value}]", control)
                     for value in option_values(option) for control in (STEP, TOLERANCES)]
    return runs


def show(outcome):
    for difference in outcome.differences[:8]:
        print(f"DIFFERS  {outcome.name}: {difference}")
    if len(outcome.differences) > 8:
        print(f"DIFFERS  {outcome.name}: and {len(outcome.differences) - 8} more")
    for addition in outcome.additions[:3]:
        print(f"note     {outcome.name}: new: {addition}")
    sys.stdout.flush()


def run_all(title, tasks, jobs):
    """Runs the tasks, shows what differs and a closing line; the number of runs that differ."""
    start = time.monotonic()
    outcomes = []
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for finished in concurrent.futures.as_completed([pool.submit(*task) for task in tasks]):
            outcomes.append(finished.result())
            show(outcomes[-1])
    differ = sum(bool(outcome.differences) for outcome in outcomes)
    print(f"{title}: {len(outcomes)} compared, {differ} differ, {sum(o.values for o in outcomes)} values, "
          f"{sum(o.refused for o in outcomes)} refused, {time.monotonic() - start:.0f} s")
    return differ


def compare_catalogues(before, after):
    """Names that are gone are a difference; new ones are told."""
    gone = [name for name in before if name not in after]
    new = [name for name in after if name not in before]
    if new:
        print(f"note     new methods, not compared: {', '.join(new)}")
    if gone:
        print(f"DIFFERS  methods that AFTER does not have: {', '.join(gone)}")
    return bool(gone)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("before", metavar="BEFORE")
    parser.add_argument("after", metavar="AFTER")
    parser.add_argument("--jobs", type=int, default=2, help="runs at the same time (default 2)")
    parser.add_argument("--keep", type=pathlib.Path, default=CHECKOUT / "build" / "compare_versions", metavar="DIR",
                        help="where results lie (default build/compare_versions)")
    parser.add_argument("--studies", type=pathlib.Path, default=CHECKOUT / "studies", metavar="DIR",
                        help="folder of the studies (default studies/)")
    parser.add_argument("--only", default="*", metavar="PATTERN",
                        help="only studies and simulations whose name fits, as \"energy/*\" or \"* gauss2 *\"")
    parser.add_argument("--no-studies", action="store_true", help="simulations only")
    parser.add_argument("--no-simulations", action="store_true", help="studies only")
    arguments = parser.parse_args()
    keep = arguments.keep.resolve()
    try:
        before, after = Program(arguments.before, keep), Program(arguments.after, keep)
    except OSError as error:
        parser.error(str(error))
    if before.identity == after.identity:
        print("note     BEFORE and AFTER are the same program")
    differ = compared = 0
    if not arguments.no_simulations:
        methods = before.methods()
        differ += compare_catalogues(methods, after.methods())
        tasks = [(compare_simulation, simulation, before, after) for simulation in planned_simulations(methods)
                 if fnmatch.fnmatch(simulation.name, arguments.only)]
        compared += len(tasks)
        differ += run_all("simulations", tasks, arguments.jobs)
    if not arguments.no_studies:
        directory = arguments.studies.resolve()
        studies = [path for path in sorted(directory.rglob("*.toml")) if "scenes" not in path.parts
                   and fnmatch.fnmatch(str(path.relative_to(directory)), arguments.only)]
        compared += len(studies)
        differ += run_all("studies", [(compare_study, study, directory, before, after) for study in studies],
                          arguments.jobs)
    if compared == 0:
        parser.error(f"--only {arguments.only}: no study and no simulation has such a name")
    print("DIFFERENT" if differ else "THE SAME, bit for bit")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main())
