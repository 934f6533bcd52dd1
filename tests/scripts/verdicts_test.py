#!/usr/bin/env python3
"""Random scenes, mild to violent, through every kind of study that takes scenes: no verdict may contradict the
independent truth, none may say "fails" of a sound scheme, and none on energies may change with the frame or the units.

usage: verdicts_test.py --federwerk EXECUTABLE [--count N] [--first I] [--kinds A,B] [--keep DIR] [unittest options]

Without --count a few scenes; --count 200 is the campaign. It prints what ran and how many verdicts of each sort.
"""

import argparse
import collections
import copy
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import random_scenes  # noqa: E402
import verdict_judges as judges  # noqa: E402
import verdict_scenes  # noqa: E402
from verdict_truth import Linearised, Truth  # noqa: E402
from verdict_variants import variants  # noqa: E402

FEW = (4, 9, 15)  # violent, generated, free flight
settings = argparse.Namespace(federwerk=os.environ.get("FEDERWERK_EXECUTABLE"), count=0, first=0, seed=20261128, kinds="",
                              keep="")
counts = collections.Counter()


def toml_value(value):
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(toml_value(item) for item in value) + "]"
    return json.dumps(value)


def run(folder, studies):
    """Runs studies together; methods that refuse the scene (forces with velocities, a single spring) are left out."""
    while True:
        for kind, study in studies.items():
            text = "".join(f"{key} = {toml_value(value)}\n" for key, value in study.items())
            (folder / f"{kind}.toml").write_text(text)
        answer = subprocess.run([settings.federwerk, "run", *[str(folder / f"{kind}.toml") for kind in studies], "-o",
                                 str(folder), "--time-limit", "60"],
                                env=dict(os.environ, FEDERWERK_CACHE=str(folder / "cache")), stdin=subprocess.DEVNULL,
                                capture_output=True, text=True, check=False)
        refused = re.search(r"(\w+)\.toml:\d+: methods\[(\d+)\]: ", answer.stderr) if answer.returncode == 2 else None
        if refused is None:
            break
        counts["methods that refused, with a reason"] += 1
        del studies[refused.group(1)]["methods"][int(refused.group(2))]
    if answer.returncode not in (0, 1, 3):
        raise AssertionError(f"exit code {answer.returncode}: {answer.stderr}")
    return {kind: judges.Study(folder / f"{kind}.h5") for kind in studies}


class Campaign:
    """One scene, its truths and its studies."""

    def __init__(self, index, folder):
        self.character, self.scene, end = verdict_scenes.random_case(settings.seed, index)
        self.folder = folder
        rng = np.random.default_rng([settings.seed, 78, index])
        taut = judges.taut_scene(self.scene)
        truth = Truth(self.scene, end)
        self.truths = collections.defaultdict(lambda: truth, stability=Linearised(taut))
        self.studies = judges.studies_of(rng, truth, self.scene, self.write("scene", self.scene), self.write("taut", taut),
                                         end)
        rest = judges.scene_at_rest(self.scene)
        if rest is not None:
            self.truths["propagation"] = Linearised(rest)
            self.studies["propagation"] = judges.propagation_study(rng, self.truths["propagation"],
                                                                   self.write("rest", rest))
        if settings.kinds:
            self.studies = {kind: study for kind, study in self.studies.items() if kind in settings.kinds.split(",")}

    def write(self, name, scene):
        path = self.folder / f"{name}.toml"
        path.write_text(random_scenes.toml_text(scene))
        return str(path)

    def run(self):
        self.results = run(self.folder, self.studies) if self.studies else {}
        for kind, result in self.results.items():
            counts[kind, "studies"] += 1
            for row in result.rows:
                counts[kind, row["verdict"]] += 1

    def contradictions(self, kind, truth=None):
        return judges.Judge(truth or self.truths[kind]).judge(kind, self.results[kind], self.studies[kind])


class Federwerk(unittest.TestCase):
    def setUp(self):
        if not settings.federwerk:
            self.skipTest("no executable given (--federwerk or FEDERWERK_EXECUTABLE)")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(settings.keep or folder.name)

    def subfolder(self, name):
        folder = self.folder / str(name)
        folder.mkdir(parents=True, exist_ok=True)
        return folder


class Verdicts(Federwerk):
    def test_no_verdict_contradicts_the_truth(self):
        indices = range(settings.first, settings.first + settings.count) if settings.count else FEW
        self.addCleanup(lambda: [print(*key if isinstance(key, tuple) else (key,), number)
                                 for key, number in sorted(counts.items(), key=str)])
        for index in indices:
            try:
                campaign = Campaign(index, self.subfolder(index))
            except ArithmeticError as error:  # a jump of the force that the reference cannot pass
                counts[f"no truth: {error}"] += 1
                continue
            campaign.run()
            for kind in campaign.results:
                found = campaign.contradictions(kind)
                if settings.count:
                    print(index, campaign.character, kind, *[" | ".join(text) for text in found], sep="\n  ", flush=True)
                with self.subTest(index=index, character=campaign.character, kind=kind):
                    self.assertEqual(found, [], "\n".join(" | ".join(text) for text in found))

    def test_another_truth_contradicts(self):
        """Masses that are off by a hundredth are seen in every kind that takes them from the scene."""
        if settings.count:
            self.skipTest("in the short run")
        campaign = Campaign(1, self.subfolder("wrong"))
        campaign.run()
        end = campaign.truths["simulate"].end
        wrong = copy.deepcopy(campaign.scene)
        wrong["particles"]["mass"] = (1.01 * campaign.truths["simulate"].model.mass).tolist()
        truth = Truth(wrong, end)
        linearised = Linearised(judges.taut_scene(wrong))
        linearised.model.stiffness = 1.2 * linearised.model.stiffness
        for kind in ("simulate", "convergence", "agreement", "work_precision", "energy", "stiffness", "jacobian",
                     "linear_solver", "stability"):
            with self.subTest(kind=kind):
                if any(row["verdict"] in ("holds", "done") for row in campaign.results[kind].rows) or kind == "stiffness":
                    self.assertNotEqual(campaign.contradictions(kind, linearised if kind == "stability" else truth), [])


class EnergyVerdicts(Federwerk):
    METHODS = ["rk4", "symplectic_euler", "velocity_verlet", "implicit_midpoint", "implicit_euler", "heun"]

    def test_do_not_depend_on_the_frame_or_the_units(self):
        indices = range(settings.first, settings.first + settings.count) if settings.count else (4, 5, 11)
        seen = collections.Counter()
        for index in indices:
            character, scene, end = verdict_scenes.random_case(settings.seed, index)
            folder = self.subfolder(f"frames-{index}")
            rate = max(verdict_scenes.model_of(scene).fastest_rate(), 5.0 / end)
            # mild steps, and one in four beyond the limit of stability
            h = judges.rounded((0.4, 0.05, 0.1, 2.5)[index % 4] / rate)
            problems = []
            for name, variant in variants(scene).items():
                path = folder / f"{len(problems)}.toml"
                path.write_text(random_scenes.toml_text(variant))
                problems.append({"scene": str(path), "t_end": end, "label": name})
            study = {"kind": "energy", "title": "frames", "methods": list(self.METHODS),
                     "energy": {"steps": [h, h / 2, h / 4], "step_count": 200, "bins": 40}, "problem": problems}
            rows = run(folder, {"energy": study})["energy"].rows
            given = {row["method"]: row for row in rows if row["problem"] == "as given"}
            for row in rows:
                seen[row["verdict"]] += 1
                with self.subTest(index=index, character=character, method=row["method"], variant=row["problem"]):
                    plain = given[row["method"]]
                    self.assertEqual(row["verdict"], plain["verdict"], f"{row['reason']}\nas given: {plain['reason']}")
        print("energies in other frames:", dict(seen))
        self.assertGreater(seen["holds"], 0)
        self.assertGreater(seen["not applicable"], 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--federwerk", default=settings.federwerk, help="the executable to examine")
    parser.add_argument("--count", type=int, default=settings.count, help="random scenes (default: a few)")
    parser.add_argument("--first", type=int, default=settings.first, help="index of the first one")
    parser.add_argument("--seed", type=int, default=settings.seed, help="seed of the random scenes")
    parser.add_argument("--kinds", default=settings.kinds, help="of studies, separated by commas (default: all)")
    parser.add_argument("--keep", default=settings.keep, help="folder for scenes, studies and results")
    known, rest = parser.parse_known_args()
    vars(settings).update(vars(known))
    unittest.main(argv=[sys.argv[0], *rest])


if __name__ == "__main__":
    main()
