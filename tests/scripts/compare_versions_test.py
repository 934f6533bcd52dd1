"""Every seeded difference between two result files, and between what two programs say, is found and told."""

import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(CHECKOUT / "scripts"))
import compare_results  # noqa: E402
import compare_versions  # noqa: E402


def write_file(path):
    """A small study and trajectory in one."""
    with h5py.File(path, "w", track_order=True) as file:
        file.attrs.update(format="federwerk", kind="energy", created="2026-01-01T00:00:00Z", git_commit="abc", cpu="A")
        case = file.create_group("cases/b-rk4", track_order=True)
        case.attrs.update(key="123", verdict="holds", reason="drifts by 1.5e-8 per step")
        case.create_dataset("error", data=numpy.array([[0.1, 0.2], [numpy.nan, numpy.inf]])).attrs["unit"] = "J"
        case.create_dataset("steps", data=numpy.arange(5)).attrs["unit"] = "1"
        case.create_dataset("seconds", data=numpy.array([0.5])).attrs["unit"] = "s"
        case.create_dataset("name", data=["one", "two"]).attrs["unit"] = ""
        case.create_dataset("empty", data=numpy.zeros((0, 3))).attrs["unit"] = "1"
        file.create_group("cases/a-rk4").attrs["key"] = "124"
        file.create_dataset("summary/reason", data=["slope 2.0 ± 0.1"]).attrs["unit"] = ""


class Results(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.before, self.after = (pathlib.Path(folder.name) / name for name in ("before.h5", "after.h5"))
        write_file(self.before)
        shutil.copy(self.before, self.after)

    def compare(self, change):
        with h5py.File(self.after, "r+", track_order=True) as file:
            change(file)
        return compare_results.compare_files(self.before, self.after)

    def assert_found(self, change, *words):
        found = self.compare(change)
        self.assertEqual(len(found.differences), 1, found.differences)
        for word in words:
            self.assertIn(word, found.differences[0])

    def test_the_same_file_is_the_same(self):
        found = self.compare(lambda file: None)
        self.assertEqual((found.differences, found.additions), ([], []))
        self.assertEqual(found.datasets, 5)  # all but the seconds

    def test_one_flipped_bit_is_found_with_its_place_and_both_values(self):
        def flip(file):
            data = file["cases/b-rk4/error"]
            values = data[()]
            values[0, 1] = numpy.nextafter(values[0, 1], 1.0)  # the last bits of 0.2 are …10
            data[...] = values
        self.assert_found(flip, "/cases/b-rk4/error[0, 1]: 0.2 (0x1.999999999999ap-3) before",
                          "0x1.999999999999bp-3", "1 of 4 values differ")

    def test_a_zero_of_another_sign_is_found_and_a_nan_is_a_nan(self):
        def negative_zero(file):
            file["cases/b-rk4/error"][...] = [[0.1, 0.2], [-numpy.nan, numpy.inf]]
        self.assertEqual(self.compare(negative_zero).differences, [])
        self.assertTrue(len(compare_results.differing(numpy.array([0.0]), numpy.array([-0.0]))))
        self.assertTrue(len(compare_results.differing(numpy.array([numpy.nan]), numpy.array([1.0]))))

    def test_an_integer_and_a_text_are_found(self):
        self.assert_found(lambda file: file["cases/b-rk4/steps"].__setitem__(3, 7), "steps[3]: 3 before, 7 after")
        shutil.copy(self.before, self.after)
        self.assert_found(lambda file: file["cases/b-rk4/name"].__setitem__(1, "three"), "name[1]", "'two'", "'three'")

    def test_what_is_missing_is_found_and_what_is_new_is_told(self):
        self.assert_found(lambda file: file.__delitem__("cases/b-rk4/steps"), "/cases/b-rk4/steps: missing after")
        shutil.copy(self.before, self.after)
        self.assert_found(lambda file: file.__delitem__("cases/a-rk4"), "/cases/a-rk4: missing after")
        shutil.copy(self.before, self.after)
        found = self.compare(lambda file: file.create_dataset("cases/b-rk4/new", data=1.0))
        self.assertEqual((found.differences, found.additions), ([], ["/cases/b-rk4/new"]))

    def test_another_shape_type_unit_verdict_or_order_is_found(self):
        def replace(name, data):
            def change(file):
                group = file["cases/b-rk4"]
                attributes = dict(group[name].attrs)
                del group[name]
                group.create_dataset(name, data=data).attrs.update(attributes)
            return change

        def order(file):
            file.move("cases/b-rk4", "cases/c")
            file.move("cases/c", "cases/b-rk4")
        for change, word in ((replace("empty", numpy.zeros((0, 2))), "shape (0, 3) before, (0, 2) after"),
                             (replace("empty", numpy.zeros((0, 3), "f4")), "type float64 before, float32 after"),
                             (lambda file: file["cases/b-rk4/error"].attrs.__setitem__("unit", "N"), "'J' before, 'N'"),
                             (lambda file: file["cases/b-rk4"].attrs.__setitem__("verdict", "fails"), "'fails' after"),
                             (order, "the order of")):
            with self.subTest(word):
                shutil.copy(self.before, self.after)
                found = self.compare(change)
                self.assertTrue(any(word in difference for difference in found.differences), found.differences)

    def test_the_build_the_moment_keys_and_seconds_do_not_count(self):
        def change(file):
            file.attrs.update(created="now", git_commit="def", cpu="B")
            file["cases/b-rk4"].attrs["key"] = "456"
            file["cases/b-rk4/seconds"][0] = 9.0
        self.assertEqual(self.compare(change).differences, [])

    def test_of_a_reason_the_words_count(self):
        def number(file):
            file["cases/b-rk4"].attrs["reason"] = "drifts by -2.25e+10 per step"
            file["summary/reason"][0] = "slope nan ± inf"
        self.assertEqual(self.compare(number).differences, [])
        self.assert_found(lambda file: file["summary/reason"].__setitem__(0, "slope 2.0 is wrong"), "/summary/reason[0]")


PROGRAM = """#!/bin/sh
case "$1 $2" in
  "list methods") echo '[{"name": "rk4"}, {"name": "verlet"}]' ;;
  describe*) echo '{"options": [{"name": "solver", "default": "lu", "expected": "cg, cholesky or lu"}]}' ;;
  simulate*)
    case "$*" in
      *"--rtol"*) echo "rk4 has REFUSAL" >&2; exit 2 ;;
      *"verlet --"*) cp "FILE" result.h5; echo "cannot go on" >&2; exit EXIT ;;
    esac
    cp "FILE" result.h5; echo "result.h5: 7 frames, $$.5e-3 s" ;;
  "run "*.h5)
    for word; do folder=$word; done
    name=$(basename "$2" .h5).repeated.h5
    mkdir -p "$folder" && cp "FILE" "$folder/$name"; echo "REPEATED" ;;
  "run "*)
    for word; do folder=$word; done
    name=$(basename "$2" .toml).h5
    case "$2" in *unknown*) echo "unknown kind" >&2; exit 2 ;; esac
    mkdir -p "$folder"; [ -e "$folder/$name" ] || cp "FILE" "$folder/$name" ;;
esac
"""


class Programs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        write_file(self.root / "a.h5")
        self.before = self.program("before")

    def program(self, name, file="a.h5", refusal="a fixed step", code="3", repeated="are the same bit for bit"):
        path = self.root / name
        text = PROGRAM.replace("FILE", str(self.root / file)).replace("REFUSAL", refusal).replace("EXIT", code)
        path.write_text(text.replace("REPEATED", repeated) + f"# {name}\n")
        path.chmod(0o755)
        return path

    def compare(self, after, *options):
        return subprocess.run([sys.executable, CHECKOUT / "scripts" / "compare_versions.py", self.before, after, "--keep",
                               self.root / "keep", *options], text=True, capture_output=True, check=False)

    def test_programs_that_do_the_same_are_the_same(self):
        answer = self.compare(self.program("after"), "--no-studies")
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        self.assertIn("THE SAME, bit for bit", answer.stdout)
        # Two methods on two scenes at steps and with tolerances, with a short last step, with two values of an option
        # at steps and with tolerances; rk4 is one of the few that run on two more scenes.
        self.assertIn("simulations: 22 compared, 0 differ", answer.stdout)

    def test_another_message_exit_code_number_or_file_is_a_difference(self):
        write_file(self.root / "b.h5")
        with h5py.File(self.root / "b.h5", "r+") as file:
            file["cases/b-rk4/steps"][3] = 7
        for name, changes, word in (("message", {"refusal": "its own steps"}, "'rk4 has its own steps\\n' after"),
                                    ("code", {"code": "1"}, "exit code: 3 before, 1 after"),
                                    ("number", {"file": "b.h5"}, "steps[3]: 3 before, 7 after"),
                                    ("no file", {"file": "none.h5"}, "a result file only before")):
            with self.subTest(name):
                answer = self.compare(self.program(name.replace(" ", "_"), **changes), "--no-studies")
                self.assertEqual(answer.returncode, 1, answer.stderr)
                self.assertIn(word, answer.stdout)
                self.assertIn("\nDIFFERENT\n", answer.stdout)

    def test_studies_are_repeated_and_run_anew(self):
        write_file(self.root / "b.h5")
        with h5py.File(self.root / "b.h5", "r+") as file:
            file["cases/b-rk4/steps"][3] = 7
        studies = self.root / "studies"
        (studies / "scenes").mkdir(parents=True)
        for name in ("one.toml", "unknown.toml", "scenes/scene.toml"):
            (studies / name).write_text("")
        options = ("--no-simulations", "--studies", studies)
        answer = self.compare(self.program("after"), *options)
        self.assertEqual(answer.returncode, 0, answer.stdout + answer.stderr)
        self.assertIn("BEFORE cannot run it: unknown kind", answer.stdout)
        self.assertIn("studies: 2 compared, 0 differ, 21 values, 1 refused", answer.stdout)
        for name, changes, word in (("number", {"file": "b.h5"}, "steps[3]: 3 before, 7 after"),
                                    ("repetition", {"repeated": "1 of 5 columns differ"}, "AFTER does not repeat")):
            after = self.program(name, **changes)
            for attempt in ("first", "from what was kept"):
                with self.subTest(name, attempt=attempt):
                    answer = self.compare(after, *options)
                    self.assertEqual(answer.returncode, 1, answer.stderr)
                    self.assertIn(word, answer.stdout)

    def test_a_method_that_is_gone_is_a_difference_and_a_new_one_is_told(self):
        after = self.program("after")
        after.write_text(after.read_text().replace('"verlet"', '"euler"'))
        answer = self.compare(after, "--no-studies", "--only", "* rk4 *")
        self.assertEqual(answer.returncode, 1)
        self.assertIn("methods that AFTER does not have: verlet", answer.stdout)
        self.assertIn("new methods, not compared: euler", answer.stdout)

    def test_options_are_taken_from_their_description(self):
        self.assertEqual(compare_versions.option_values(
            {"expected": "cg, cholesky or lu", "default": "lu"}), ["cg", "cholesky"])
        self.assertEqual(compare_versions.option_values({"expected": "a number in (0, 1]", "default": "1"}), [])
        self.assertEqual(compare_versions.option_values(
            {"expected": 'one of "1fe", "2a"', "default": "1fe", "choices": ["1fe", "2a"]}), ["2a"])

    def test_a_pattern_that_nothing_fits_is_bad_usage(self):
        answer = self.compare(self.program("after"), "--only", "nothing")
        self.assertEqual(answer.returncode, 2)
        self.assertIn("nothing", answer.stderr)

    def test_a_result_is_kept_for_the_next_comparison(self):
        after = self.program("after")
        self.compare(after, "--no-studies")
        kept = sorted((self.root / "keep").rglob("answer.json"))
        self.assertEqual(len(kept), 44)
        self.assertEqual(json.loads(kept[0].read_text()).keys() >= {"run", "exit code"}, True)


if __name__ == "__main__":
    unittest.main()
