#!/usr/bin/env python3
"""Examines `federwerk simulate` from outside: random scene files, own equations, own reference solutions.

usage: independent_simulation_test.py --federwerk EXECUTABLE [--count N] [--seed S] [unittest options]

Without an executable (--federwerk or FEDERWERK_EXECUTABLE) only the examiner itself is examined.
"""

import argparse
import datetime
import hashlib
import os
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import mass_spring_reference as reference  # noqa: E402
import random_scenes  # noqa: E402
from mass_spring_reference import MassSpringModel  # noqa: E402
from trajectory_checks import Trajectory, largest_error, require_agreement, require_close, require_consistent_file  # noqa: E402

LAWS = ("hooke", "strain", "tension_only")
CVODE = ("--method", "sundials:cvode_bdf", "--rtol", "1e-10", "--atol", "1e-12")
settings = argparse.Namespace(federwerk=os.environ.get("FEDERWERK_EXECUTABLE"), count=8, seed=20261122)


def simulate(text, folder, *options):
    """Runs federwerk on a scene's text and reads the result."""
    scene, result = pathlib.Path(folder) / "scene.toml", pathlib.Path(folder) / "result.h5"
    scene.write_text(text)
    result.unlink(missing_ok=True)
    answer = subprocess.run([settings.federwerk, "simulate", str(scene), *map(str, options), "-o", str(result)],
                            stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    if answer.returncode != 0:
        raise AssertionError(f"exit code {answer.returncode}: {answer.stderr}\n{text}")
    return Trajectory(result)


def law_of(index):
    return LAWS[index % 3]


def random_case(index, purpose, **options):
    rng = np.random.default_rng([settings.seed, purpose, index])
    scene = random_scenes.random_scene(rng, **options)
    return rng, scene, random_scenes.toml_text(scene)


class TheExaminer(unittest.TestCase):
    """The reference is itself held against closed forms and first principles."""

    def test_the_integrator_solves_a_damped_oscillator_exactly(self):
        omega, decay = 40.0, 1.5
        times = np.linspace(0.0, 3.0, 31)
        states = reference.integrate(lambda y: np.stack((y[1], -(omega**2 + decay**2) * y[0] - 2 * decay * y[1])),
                                     np.array([[[1.0]], [[-decay]]]), times)
        np.testing.assert_allclose(states[:, 0, 0, 0], np.exp(-decay * times) * np.cos(omega * times), rtol=0,
                                   atol=1e-11)

    def test_the_integrator_passes_the_kinks_of_a_slack_spring(self):
        # A unit mass on a string of k = 1 and l0 = 1 thrown up at 3 m/s under g = 2 m/s^2: parabola above, then a
        # harmonic motion about the sag; the return is found from the two closed forms.
        model = MassSpringModel("[world]\ngravity = [0, 0, -2]\n[particles]\nposition = [[0, 0, 0], [0, 0, -1]]\n"
                                "mass = 1\nfixed = [0]\nvelocity = [[0, 0, 0], [0, 0, 1]]\n[springs]\n"
                                "between = [[0, 1]]\nstiffness = 1\nlaw = 'tension_only'\n")
        times = np.linspace(0.0, 4.0, 41)
        z = reference.integrate(model.rate, model.start(), times)[:, 0, 1, 2]
        exact = np.where(times <= 1.0, -1.0 + times - times**2,
                         -3.0 + 2.0 * np.cos(times - 1.0) - np.sin(times - 1.0))
        np.testing.assert_allclose(z, exact, rtol=0, atol=1e-10)

    def test_the_model_conserves_its_own_energy_and_momentum(self):
        for index in range(3):
            _, scene, text = random_case(index, 1, law=law_of(index), damped=False)
            scene["particles"].pop("fixed", None)
            model = MassSpringModel(random_scenes.toml_text(scene))
            states = reference.integrate(model.rate, model.start(), np.linspace(0.0, 1.5, 6))
            energy = [model.kinetic_energy(y[1]) + model.potential_energy(y[0]) for y in states]
            np.testing.assert_allclose(energy, energy[0], rtol=0, atol=1e-9)
            momentum = model.linear_momentum(states[-1][1]) - model.linear_momentum(states[0][1])
            np.testing.assert_allclose(momentum, 1.5 * model.mass.sum() * model.gravity, rtol=0, atol=1e-10)

    def test_scene_texts_vary_in_every_optional_key(self):
        seen = set()
        for index in range(60):
            scene = tomllib.loads(random_case(index, 2, law=law_of(index), free_flight=index % 8 == 7)[2])
            springs, particles = scene.get("springs", {}), scene["particles"]
            seen |= {("title", "title" in scene), ("springs", "springs" in scene), ("fixed", "fixed" in particles),
                     ("velocity", "velocity" in particles), ("world", "world" in scene),
                     ("mass", type(particles["mass"])), ("law", springs.get("law"))}
            if springs:
                seen |= {(key, type(springs.get(key))) for key in ("stiffness", "damping", "rest_length")}
        for key in ("title", "springs", "fixed", "velocity", "world"):
            self.assertLessEqual({(key, True), (key, False)}, seen)
        for key, forms in (("mass", (int, float, list)), ("stiffness", (int, float, list)),
                           ("damping", (type(None), float, list)), ("rest_length", (type(None), float, list)),
                           ("law", (None, *LAWS))):
            self.assertLessEqual({(key, form) for form in forms}, seen)


class Federwerk(unittest.TestCase):
    def setUp(self):
        if not settings.federwerk:
            self.skipTest("no executable given (--federwerk or FEDERWERK_EXECUTABLE)")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name


class AdaptiveReference(Federwerk):
    def test_cvode_agrees_in_every_position(self):
        for index in range(settings.count):
            rng, _, text = random_case(index, 3, law=law_of(index), free_flight=index % 8 == 7)
            end = round(float(rng.uniform(1.0, 3.0)), 3)
            with self.subTest(index=index, end=end, scene=text):
                result = simulate(text, self.folder, *CVODE, "--t-end", end, "--frames", 14)
                np.testing.assert_allclose(result.time, np.linspace(0.0, end, 14), rtol=0, atol=1e-14)
                self.assertEqual(result.time[-1], end)
                model = MassSpringModel(text)
                require_consistent_file(model, result)
                require_agreement(model, result)

    def test_cvode_agrees_on_stiff_springs(self):
        for index in range(max(2, settings.count // 12)):
            rng, _, text = random_case(index, 4, law=LAWS[index % 2], stiff=True, damped=True)
            end = round(float(rng.uniform(0.05, 0.15)), 4)
            with self.subTest(index=index, end=end, scene=text):
                result = simulate(text, self.folder, *CVODE, "--t-end", end, "--frames", 6)
                model = MassSpringModel(text)
                require_consistent_file(model, result)
                require_agreement(model, result)

    def test_groups_of_springs_have_laws_of_their_own(self):
        methods = ("symplectic_euler", "rk4", "implicit_euler")
        for index in range(max(2, settings.count // 8)):
            rng, scene, _ = random_case(index, 11, law="hooke", damped=index % 2 == 0)
            scene["springs"].setdefault("rest_length", 0.8)  # ropes exactly at their rest length have two tangents
            laws = [LAWS[int(k)] for k in rng.integers(0, 3, int(rng.integers(2, 5)))]
            text = random_scenes.toml_text(random_scenes.in_groups(rng, scene, laws))
            model = MassSpringModel(text)
            with self.subTest(index=index, laws=laws, scene=text):
                result = simulate(text, self.folder, *CVODE, "--t-end", 0.4, "--frames", 8)
                require_consistent_file(model, result)
                require_agreement(model, result)
                number = result.datasets["system/spring_group"]
                law = np.array([name.decode() for name in result.datasets["system/group_law"]], dtype=object)
                self.assertEqual(list(law), laws)
                self.assertEqual(list(law[number]), list(model.law))
                unit = {"strain" if given == "strain" else "other" for given in laws}
                self.assertEqual(result.units["system/stiffness"],
                                 "SI" if len(unit) == 2 else {"strain": "N", "other": "N/m"}[unit.pop()])
                step = round(0.2 / max(model.fastest_rate(), 2.0), 5)
                for method in methods:
                    found = simulate(text, self.folder, "--method", method, "--step", step, "--t-end",
                                     round(20 * step, 10), "--frames", 21)
                    expected = reference.steps(FixedSteps.STEPPERS[method], model, step, 20)
                    require_close(found.position, expected[:, 0], 1.0, f"{method} positions", 1e-11)
        wrong = MassSpringModel(text)
        wrong.law[0] = "tension_only" if wrong.law[0] == "strain" else "strain"
        with self.assertRaises(AssertionError):
            require_agreement(wrong, result)

    def test_a_wrong_model_is_caught(self):
        _, _, text = random_case(0, 5, law="hooke", damped=True)
        result = simulate(text, self.folder, *CVODE, "--t-end", 1.5)
        require_agreement(MassSpringModel(text), result)
        wrong = MassSpringModel(text)
        wrong.stiffness[0] *= 1.0 + 1e-4
        with self.assertRaises(AssertionError):
            require_agreement(wrong, result)
        with self.assertRaises(AssertionError):
            require_consistent_file(wrong, result)
        for name, change in (("damping", 1e-4), ("rest_length", 1e-5), ("mass", 1e-4)):
            wrong = MassSpringModel(text)
            getattr(wrong, name)[:] += change
            with self.subTest(name), self.assertRaises(AssertionError):
                require_agreement(wrong, result)
        moved = simulate(text, self.folder, *CVODE, "--t-end", 1.5)
        moved.position[5, 0, 0] += 2e-7
        with self.assertRaises(AssertionError):
            require_agreement(MassSpringModel(text), moved)


class FixedSteps(Federwerk):
    ORDERS = {"explicit_euler": 1, "symplectic_euler": 1, "implicit_euler": 1, "implicit_euler_linearised": 1,
              "midpoint": 2, "heun": 2, "verlet": 2, "velocity_verlet": 2, "rk4": 4}
    STEP_TIMES_RATE = {1: 0.004, 2: 0.05, 4: 0.1}
    STEPPERS = {"explicit_euler": reference.explicit_euler, "symplectic_euler": reference.symplectic_euler,
                "midpoint": reference.midpoint, "heun": reference.heun, "rk4": reference.rk4,
                "implicit_euler": reference.implicit_euler,
                "implicit_euler_linearised": reference.implicit_euler_linearised}

    def halving(self, model, text, method, end, factor=1):
        """Errors of a method at h and at h/2."""
        limit = self.STEP_TIMES_RATE[self.ORDERS[method]] * factor / max(model.fastest_rate(), 1.0)
        count = 10 * max(2, int(np.ceil(end / limit / 10)))
        errors = []
        for number in (count, 2 * count):
            result = simulate(text, self.folder, "--method", method, "--step", repr(end / number), "--t-end", repr(end),
                              "--frames", 11)
            np.testing.assert_allclose(result.time, np.linspace(0.0, end, 11), rtol=0, atol=1e-13)
            result.time = np.linspace(0.0, end, 11)  # one key for the kept solution
            self.assertEqual(result.time[-1], end)
            require_consistent_file(model, result)
            errors.append(largest_error(model, result))
        return errors

    def test_halving_the_step_divides_the_error_by_two_to_the_order(self):
        for index in range(max(3, settings.count // 6)):
            rng, _, text = random_case(index, 6, law=LAWS[index % 2])
            model, ends = MassSpringModel(text), {1: rng.uniform(0.2, 0.5), 2: rng.uniform(1.0, 2.0)}
            for method, order in self.ORDERS.items():
                end = round(float(ends[min(order, 2)]), 3)
                with self.subTest(index=index, method=method, end=end, scene=text):
                    coarse, fine = self.halving(model, text, method, end)
                    self.assertLess(fine, {1: 2e-2, 2: 2e-3, 4: 1e-5}[order])
                    if fine > 1e-11:  # below, rounding and the reference's error are in the ratio
                        measured = np.log2(coarse / fine)
                        print(f"{method} {index} {measured:.4f} {coarse:.2e} {fine:.2e}") if settings.verbose else None
                        self.assertAlmostEqual(measured, order, delta=0.1 if order < 4 else 0.2)

    def test_kinked_forces_still_converge(self):
        for index in range(max(2, settings.count // 12)):
            rng, _, text = random_case(index, 7, law="tension_only")
            model, end = MassSpringModel(text), round(float(rng.uniform(0.8, 1.6)), 3)
            for method in ("rk4", "velocity_verlet", "verlet"):
                with self.subTest(index=index, method=method, end=end, scene=text):
                    coarse, fine = self.halving(model, text, method, end, factor=0.2)
                    self.assertLess(fine, 1e-4)
                    self.assertLess(fine, max(0.5 * coarse, 1e-11))

    def test_single_steps_are_those_of_the_lecture(self):
        for index in range(max(6, settings.count // 4)):
            _, scene, text = random_case(index, 8, law=law_of(index))
            if law_of(index) == "tension_only" and "rest_length" not in scene["springs"]:
                # exactly at the kink, rounding would choose the tangent
                scene["springs"]["rest_length"] = 0.55
                text = random_scenes.toml_text(scene)
            self.compare_steps(index, text, self.STEPPERS)

    def test_verlet_steps_are_those_of_the_lecture(self):
        verlet = {"velocity_verlet": reference.velocity_verlet, "verlet": reference.velocity_verlet,
                  "verlet_backward_velocity": reference.velocity_verlet}
        for index in range(max(3, settings.count // 4)):
            _, _, text = random_case(index, 9, law=law_of(index), damped=False)
            self.compare_steps(index, text, verlet, velocity_of=("velocity_verlet",))

    def compare_steps(self, index, text, steppers, velocity_of=None, number=30):
        model = MassSpringModel(text)
        step = round(0.2 / max(model.fastest_rate(), 2.0), 5)
        end = round(number * step, 10)
        for method, stepper in steppers.items():
            with self.subTest(index=index, method=method, step=step, scene=text):
                result = simulate(text, self.folder, "--method", method, "--step", step, "--t-end", end,
                                  "--frames", number + 1)
                np.testing.assert_allclose(result.time, step * np.arange(number + 1), rtol=1e-15, atol=1e-15)
                expected = reference.steps(stepper, model, step, number)
                # the one solve of a step is by conjugate gradients, which stop before rounding
                tolerance = 1e-9 if method == "implicit_euler_linearised" else 1e-11
                require_close(result.position, expected[:, 0], 1.0, f"{method} positions", tolerance)
                if velocity_of is None or method in velocity_of:
                    require_close(result.velocity, expected[:, 1], 1.0, f"{method} velocities", 100 * tolerance)


class ResultFile(Federwerk):
    def test_attributes_and_units_are_there(self):
        _, scene, text = random_case(1, 10, law="hooke")
        scene["title"] = "a title with ümlaut"
        text = random_scenes.toml_text(scene)
        result = simulate(text, self.folder, *CVODE, "--t-end", 0.5)
        attributes = result.attributes
        for name in ("format", "kind", "title", "created", "command_line", "git_commit", "compiler", "compiler_flags",
                     "cpu", "libraries", "spec", "spec_sha256", "status", "solver_status"):
            self.assertIsInstance(attributes.get(name), str, name)
        for name in ("format_version", "git_dirty", "seed"):
            self.assertIn(name, attributes)
        self.assertEqual(attributes["format"], "federwerk")
        self.assertEqual(attributes["kind"], "trajectory")
        self.assertEqual(attributes["title"], scene["title"])
        self.assertEqual(attributes["status"], "complete")
        self.assertIn("--rtol 1e-10", attributes["command_line"])
        self.assertEqual(attributes["spec_sha256"], hashlib.sha256(attributes["spec"].encode()).hexdigest())
        made = datetime.datetime.fromisoformat(attributes["created"].replace("Z", "+00:00"))
        self.assertLess(abs(datetime.datetime.now(datetime.timezone.utc) - made), datetime.timedelta(minutes=5))
        for library in attributes["libraries"].split():
            self.assertRegex(library, r"^[^=]+=[^=]+$")
        for name, unit in result.units.items():
            self.assertIsInstance(unit, str, f"{name} has no unit")
        for name in ("time", "position", "velocity", "kinetic_energy", "potential_energy", "linear_momentum",
                     "angular_momentum"):
            self.assertEqual(result.datasets[f"trajectory/{name}"].dtype, np.float64, name)
        self.assertEqual(len(result.time), 101)
        self.assertTrue(any(name.startswith("counters/") for name in result.datasets))

    def test_the_stored_spec_gives_the_same_trajectory(self):
        for index in range(6):
            _, _, text = random_case(index, 11, law=law_of(index), free_flight=index == 5)
            with self.subTest(index=index, scene=text):
                options = ("--method", "rk4", "--step", 0.01, "--t-end", 0.5)
                first = simulate(text, self.folder, *options)
                again = simulate(first.attributes["spec"], self.folder, *options)
                np.testing.assert_array_equal(again.position, first.position)
                self.assertEqual(again.attributes["spec"], first.attributes["spec"])

    def test_frames_are_the_step_times_nearest_to_an_equal_spacing(self):
        _, _, text = random_case(0, 12, law="hooke")
        step, number = 0.01, 100
        for frames in (2, 8, 31, 101):
            result = simulate(text, self.folder, "--method", "rk4", "--step", step, "--t-end", 1, "--frames", frames)
            self.assertEqual(len(result.time), frames)
            indices = np.rint(result.time / step)
            np.testing.assert_allclose(result.time, indices * step, rtol=1e-15, atol=0)
            self.assertLessEqual(np.abs(indices - np.linspace(0, number, frames)).max(), 0.5)
            require_agreement(MassSpringModel(text), result, 1e-3)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--federwerk", default=settings.federwerk, help="the executable to examine")
    parser.add_argument("--count", type=int, default=settings.count, help="random scenes for CVODE (others: fewer)")
    parser.add_argument("--seed", type=int, default=settings.seed, help="seed of the random scenes")
    parser.add_argument("--verbose-orders", dest="verbose", action="store_true", help="print the measured orders")
    known, rest = parser.parse_known_args()
    vars(settings).update(vars(known))
    unittest.main(argv=[sys.argv[0], *rest])


settings.verbose = False
if __name__ == "__main__":
    main()
