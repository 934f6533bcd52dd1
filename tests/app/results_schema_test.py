"""docs/results_schema.md against files that the executable writes: results_schema_test.py FEDERWERK"""

import contextlib
import io
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import h5py
from results_schema_studies import STUDIES

SOURCE = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(SOURCE / "scripts"))
import check_results_schema  # noqa: E402

SCENES = SOURCE / "studies" / "scenes"
DESCRIPTION = (SOURCE / "docs" / "results_schema.md").read_text(encoding="utf-8")

SIMULATED_SCENES = ["double_spring", "box_and_anchor", "refined_chain_strain", "grid_on_sphere", "net_on_ropes", "pulled_grid"]
EVENTS = {"pulled_grid": ["--log-at", "energy:kinetic"]}


class ResultsSchema(unittest.TestCase):
    executable = None

    @classmethod
    def setUpClass(cls):
        cls.directory = tempfile.TemporaryDirectory(prefix="feder werk ")
        cls.addClassCleanup(cls.directory.cleanup)
        cls.folder = pathlib.Path(cls.directory.name)
        for name, text in STUDIES.items():
            study = cls.folder / f"{name}.toml"
            study.write_text(text.replace("SCENES", SCENES.as_posix()), encoding="utf-8")
            # Exit code 1 says that a claim does not hold, as one of "convergence" has to.
            cls.run_federwerk("run", study, "-o", cls.folder, codes=(0, 1))
        for name in SIMULATED_SCENES:
            cls.run_federwerk("simulate", SCENES / f"{name}.toml", "--method", "rk4", "--step", "0.0005", "--t-end", "0.01",
                              "--frames", "5", *EVENTS.get(name, []), "-o", cls.folder / f"{name}.h5")

    @classmethod
    def run_federwerk(cls, *arguments, codes=(0,)):
        environment = os.environ | {"FEDERWERK_CACHE": str(cls.folder / "cache")}
        answer = subprocess.run([cls.executable, *arguments], cwd=cls.folder, env=environment, text=True,
                                capture_output=True, check=False)
        if answer.returncode not in codes:
            raise AssertionError(f"{arguments} ended with {answer.returncode}: {answer.stderr}")

    def check(self, *files, description=DESCRIPTION):
        """Exit code and text of check_results_schema.py, in this process: starting Python takes longer than the check."""
        answer = io.StringIO()
        with contextlib.redirect_stdout(answer):
            code = check_results_schema.report(description, files)
        return code, answer.getvalue()

    def test_the_command_says_the_same(self):
        document, file = SOURCE / "docs" / "results_schema.md", self.folder / "double_spring.h5"
        answer = subprocess.run([sys.executable, SOURCE / "scripts" / "check_results_schema.py", document, file], text=True,
                                capture_output=True, check=False)
        self.assertEqual((answer.returncode, answer.stdout, answer.stderr), (0, "1 file(s) as described\n", ""))

    def assert_deviation(self, expected, name, change):
        """`change(file)` makes a copy of a real file deviate from the description in exactly one way."""
        copy = self.folder / "changed.h5"
        shutil.copyfile(self.folder / f"{name}.h5", copy)
        with h5py.File(copy, "r+") as file:
            change(file)
        self.assertEqual(self.check(copy), (1, f"{copy}: {expected}\n"))

    def test_describes_every_file_that_the_executable_writes(self):
        files = [self.folder / f"{name}.h5" for name in (*STUDIES, *SIMULATED_SCENES)]
        self.assertEqual(self.check(*files), (0, f"{len(files)} file(s) as described\n"))

    def test_the_files_hold_every_dataset_that_is_described(self):
        """Otherwise a row that describes nothing could stay, or what is optional go unseen."""
        found = set()
        for name in (*STUDIES, *SIMULATED_SCENES):
            with h5py.File(self.folder / f"{name}.h5") as file:
                file.visititems(lambda path, item: found.add(path) if isinstance(item, h5py.Dataset) else None)
        for kind in ("trajectory", "convergence", "simulate", "jacobian", "work_precision", "stiffness", "stability", "energy",
                     "dissipation", "propagation", "verify"):
            section = DESCRIPTION.split(f"## Kind `{kind}`")[1].split("\n## ")[0]
            rows = [line for line in section.splitlines() if line.startswith("| `/")]
            self.assertGreater(len(rows), 13, kind)
            for line in rows:
                end = line.split("`")[1].rsplit("/", 1)[1].split("<")[0]
                self.assertTrue(any(path.rsplit("/", 1)[1].startswith(end) for path in found), line)

    def test_without_a_row_its_datasets_are_not_described(self):
        for kind, name in (("convergence", "convergence"), ("simulate", "trajectories decay"), ("trajectory", "double_spring net_on_ropes pulled_grid"),
                           ("stability", "stability"), ("energy", "energy"), ("dissipation", "dissipation"), ("propagation", "propagation"),
                           ("verify", "verify")):
            before, section = DESCRIPTION.split(f"## Kind `{kind}`")
            section, separator, after = section.partition("\n## ")
            for line in [line for line in section.splitlines() if line.startswith("| `/")]:
                with self.subTest(line):
                    document = before + f"## Kind `{kind}`" + section.replace(line + "\n", "", 1) + separator + after
                    if section.endswith(line):
                        document = document.replace(line, "", 1)
                    code, text = self.check(*(self.folder / f"{each}.h5" for each in name.split()), description=document)
                    self.assertEqual(code, 1)
                    self.assertIn("is not described", text)

    def test_an_undescribed_dataset_is_seen(self):
        def add(path):
            def change(file):
                file[path] = [1.0]
                file[path].attrs["unit"] = "1"
            return change
        for name, path in (("convergence", "/cases/scene-rk4/surprise"), ("convergence", "/summary/surprise"),
                           ("convergence", "/surprise"), ("trajectories", "/cases/vector_field/surprise"),
                           ("trajectories", "/cases/rotation-sundials:cvode_bdf/surprise"),
                           ("trajectories", "/cases/rotation-sundials:cvode_bdf/field_y"),
                           ("double_spring", "/trajectory/surprise")):
            with self.subTest(path):
                self.assert_deviation(f"{path} is not described", name, add(path))

    def test_what_is_missing_in_a_single_case_is_seen(self):
        case = "/cases/rotation-explicit_euler-h0.1"
        for name, path, says in (
                ("convergence", "/cases/scene-rk4/used_position", "is described but not there"),
                ("convergence", "/summary/points_velocity", "is described but not there"),
                ("trajectories", "/cases/vector_field/field_dydt", "is described but not there"),
                ("trajectories", f"{case}/time", "is not there, described as there without `field_t`"),
                ("trajectories", f"{case}/exact_state", "is not there, described as there with `exact_time`")):
            with self.subTest(path):
                self.assert_deviation(f"{path} {says}", name, lambda file, path=path: file.pop(path))

    def test_an_optional_dataset_may_be_missing(self):
        copy = self.folder / "changed.h5"
        shutil.copyfile(self.folder / "trajectories.h5", copy)
        with h5py.File(copy, "r+") as file:
            del file["/cases/spring_pendulum-explicit_euler-h0.1/invariant_angular_momentum_z"]
        self.assertEqual(self.check(copy)[0], 0)

    def test_a_dataset_where_its_condition_forbids_it_is_seen(self):
        def change(file):
            file["/cases/vector_field/step"] = [1.0]
            file["/cases/vector_field/step"].attrs["unit"] = "s"
        self.assert_deviation("/cases/vector_field/step is there, described as there without `field_t`", "trajectories",
                              change)

    def test_other_shapes_types_units_and_attributes_are_seen(self):
        def replace(path, values, unit):
            def change(file):
                del file[path]
                file[path] = values
                file[path].attrs["unit"] = unit
            return change
        path = "/cases/vector_field/field_t"
        self.assert_deviation(f"{path} has shape (2, 6), described as (G)", "trajectories",
                              replace(path, [[0.0] * 6] * 2, "s"))
        self.assert_deviation(f"{path} is int64, described as float64", "trajectories", replace(path, [0] * 12, "s"))
        self.assert_deviation(f"{path} has unit 'ms', described as `s`", "trajectories", replace(path, [0.0] * 12, "ms"))
        path = "/cases/spring_pendulum-explicit_euler-h0.1/invariant_energy"
        self.assert_deviation(f"{path} has unit 'kg m', expected one written like kg*m^2/s", "trajectories",
                              lambda file: file[path].attrs.modify("unit", "kg m"))
        path = "/cases/scene-rk4"
        self.assert_deviation(f"{path}/error: attribute norm is missing", "convergence",
                              lambda file: file[f"{path}/error"].attrs.pop("norm"))
        self.assert_deviation(f"{path}/step: attribute norm is not described", "convergence",
                              lambda file: file[f"{path}/step"].attrs.create("norm", "largest"))
        self.assert_deviation(f"{path}: attribute reason is missing", "convergence",
                              lambda file: file[path].attrs.pop("reason"))
        self.assert_deviation(f"{path}: attribute wind is not described", "convergence",
                              lambda file: file[path].attrs.create("wind", "west"))


if __name__ == "__main__":
    ResultsSchema.executable = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main()
