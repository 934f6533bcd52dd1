"""The plot scripts, on synthetic result files: what every picture has, and how bad files are refused."""

import contextlib
import io
import pathlib
import shutil
import sys
import unittest

from plot_testing import SCRIPTS, PlotTest  # isort: first, it makes the scripts importable
import h5py
import numpy
import plot_agreement  # noqa: F401
import plot_construction  # noqa: F401
import plot_convergence
import plot_dissipation  # noqa: F401
import plot_energy  # noqa: F401
import plot_jacobian  # noqa: F401
import plot_linear_solver  # noqa: F401
import plot_oscillation  # noqa: F401
import plot_propagation  # noqa: F401
import plot_results
import plot_slope_field
import plot_spiral
import plot_stability  # noqa: F401
import plot_stiffness  # noqa: F401
import plot_style
import plot_sweep  # noqa: F401
import plot_trajectory
import plot_vector_field  # noqa: F401
import plot_verify  # noqa: F401
import plot_work_precision  # noqa: F401
import synthetic_results
from result_file import ResultError, ResultFile


class EveryPlot(PlotTest):
    def test_is_written_as_png_and_pdf_beside_its_file(self):
        for kind in synthetic_results.ALL:
            with self.subTest(kind):
                answer = self.run_here(f"plot_{kind}.py", self.write(kind))
                self.assertEqual(answer.returncode, 0, answer.stderr)
                for extension, magic in (("png", b"\x89PNG"), ("pdf", b"%PDF")):
                    self.assertTrue((self.folder / f"{kind}.{extension}").read_bytes().startswith(magic))

    def test_is_chosen_by_the_kind_of_the_file(self):
        files = [self.write(kind) for kind in synthetic_results.ALL]
        answer = self.plot_results(*files, "-o", self.folder / "plots")
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(sorted(path.name for path in (self.folder / "plots").glob("*.png")),
                         sorted(f"{kind}.png" for kind in synthetic_results.ALL))

    def test_depends_on_the_file_alone(self):
        path = self.write("spiral")
        pictures = []
        for folder in ("first", "second"):
            self.script("plot_spiral.py", path, "-o", self.folder / folder)
            pictures.append([(self.folder / folder / f"spiral.{extension}").read_bytes()
                             for extension in ("png", "pdf")])
        self.assertEqual(pictures[0], pictures[1])

    def test_names_file_commit_and_date_in_its_footer_and_the_study_above(self):
        for kind, module in (("convergence", plot_convergence), ("trajectory", plot_trajectory),
                             ("slope_field", plot_slope_field), ("spiral", plot_spiral)):
            with self.subTest(kind):
                figure, = self.draw(module, self.write(kind))
                footer = [text.get_text() for text in figure.texts if "federwerk" in text.get_text()]
                self.assertEqual(len(footer), 1)
                for part in (f"{kind}.h5", "0123456789", "uncommitted changes", "2026-01-31"):
                    self.assertIn(part, footer[0])
                self.assertNotIn("QUICK", footer[0])
                self.assertGreater(len(figure._suptitle.get_text()), 5)

    def test_says_in_the_footer_that_a_result_is_quick(self):
        path = self.write("convergence")
        with h5py.File(path, "r+") as file:
            file.attrs["quick"] = 1
        figure, = self.draw(plot_convergence, path)
        footer, = [text for text in figure.texts if "federwerk" in text.get_text()]
        self.assertIn("QUICK, coarse", footer.get_text())
        self.assertEqual(footer.get_color(), plot_style.ALARM)

    def test_says_in_the_footer_that_a_result_is_incomplete(self):
        path = self.write("convergence")
        with h5py.File(path, "r+") as file:
            file.attrs["status"] = "incomplete"
        figure, = self.draw(plot_convergence, path)
        self.assertTrue(any("INCOMPLETE" in text.get_text() for text in figure.texts))

    def test_has_units_on_every_axis_that_has_a_dimension(self):
        figure, = self.draw(plot_convergence, self.write("convergence"))
        self.assertEqual(figure.axes[0].get_xlabel(), "step h [s]")
        self.assertEqual(figure.axes[0].get_ylabel(), "position error [m]")
        self.assertEqual(figure.axes[1].get_ylabel(), "velocity error [m/s]")
        figure, = self.draw(plot_trajectory, self.write("trajectory"))
        self.assertEqual(sorted(axes.get_ylabel() for axes in figure.axes),
                         ["L [kg·m²/s]", "energy [J]", "p [kg·m/s]", "z [m]"])


def fail(path, names=None):
    """Makes cases of a file look as federwerk leaves those that it could not compute: all of them where no names are
    given. Returns the names."""
    with h5py.File(path, "r+") as file:
        cases = file.require_group("cases")
        for name in file["summary/case"].asstr()[:] if "summary/case" in file else []:
            cases.require_group(name)
        names = list(cases) if names is None else names
        for name in cases:
            for column in list(cases[name]) if name in names else []:
                del cases[name][column]
            cases[name].attrs["key"] = "" if name in names else "0123"
        if "case" not in file.get("summary", {}):
            return names
        summary = file["summary"]
        rows = [row for row, name in enumerate(summary["case"].asstr()[:]) if name in names]
        for name in list(summary):
            if len(rows) == len(summary["case"]) and name not in ("case", "verdict", "reason"):
                del summary[name]  # a column is made of what the cases say
            elif name not in ("case", "verdict", "reason"):
                values = summary[name][:]
                values[rows] = {"f": numpy.nan, "O": ""}.get(values.dtype.kind, 0)
                summary[name][:] = values
    return names


class CasesThatCouldNotBeComputed(PlotTest):
    KINDS = ["agreement", "construction", "convergence", "dissipation", "energy", "jacobian", "linear_solver", "oscillation",
             "propagation", "simulated_energy", "slope_field", "spiral", "stability", "stiffness", "sweep", "vector_field", "verify",
             "work_precision"]

    def make(self, kind):
        path = self.folder / f"{kind}.h5"
        getattr(synthetic_results, kind)(path)
        return path

    def names(self, kind):
        with h5py.File(self.make(kind)) as file:
            return list(file["cases"]) if "cases" in file else list(file["summary/case"].asstr()[:])

    def test_are_looked_at_for_every_script_that_draws_cases(self):
        scripts = {path.stem.removeprefix("plot_") for path in SCRIPTS.glob("plot_*.py")}
        self.assertEqual(scripts - set(self.KINDS), {"results", "style", "trajectory"})

    def test_of_all_cases_leave_nothing_to_draw(self):
        for kind in self.KINDS:
            path = self.make(kind)
            fail(path)
            with ResultFile(path) as result:
                own = plot_style.expect_kind(result.kind, sys.modules[f"plot_{kind}"].draw)
            for choose in (own, plot_results.choose_drawing):
                with self.subTest(kind, script=choose.__module__), contextlib.redirect_stdout(io.StringIO()) as answer:
                    self.assertEqual(plot_style.main("", choose, [str(path)]), 0)
                    self.assertEqual(answer.getvalue(), f"{path}: nothing to draw: no case was computed\n")
        self.assertEqual(list(self.folder.glob("*.png")), [])

    def test_of_any_one_case_leave_the_others_to_be_drawn(self):
        for kind in set(self.KINDS) - {"vector_field"}:  # it has one case
            names = self.names(kind)
            original = self.folder / f"{kind}.h5"
            original.rename(self.folder / "original.h5")
            for name in {names[0], names[len(names) // 2], names[-1]} if len(names) > 1 else []:
                with self.subTest(kind, case=name):
                    path = pathlib.Path(shutil.copy(self.folder / "original.h5", original))
                    fail(path, [name])
                    for figure in self.draw(sys.modules[f"plot_{kind}"], path):
                        footers = [text.get_text() for text in figure.texts if "federwerk" in text.get_text()]
                        self.assertIn("1 case could not be computed", footers[0])
                    plot_style.plt.close("all")

    def test_are_named_in_one_message(self):
        path = self.make("convergence")
        fail(path, ["henon_heiles-rk4", "henon_heiles-midpoint"])
        answer = self.plot_results(path)
        self.assertEqual(answer.returncode, 0)
        self.assertEqual(answer.stderr, f"{path}: not drawn, since they could not be computed: henon_heiles-midpoint, "
                                        "henon_heiles-rk4\n")
        self.assertEqual(answer.stdout, f"{self.folder / 'convergence.png'}\n")


class Refusals(PlotTest):
    def test_a_file_of_another_kind_is_refused_by_name(self):
        answer = self.script("plot_convergence.py", self.write("trajectory"))
        self.assertEqual(answer.returncode, 2)
        self.assertIn("trajectory.h5", answer.stderr)
        self.assertIn('found kind "trajectory", expected "convergence"', answer.stderr)

    def test_a_missing_dataset_is_named(self):
        path = self.write("convergence")
        with h5py.File(path, "r+") as file:
            del file["cases/henon_heiles-rk4/step"]
        answer = self.script("plot_convergence.py", path)
        self.assertEqual(answer.returncode, 2)
        self.assertIn("found no /cases/henon_heiles-rk4/step", answer.stderr)

    def test_files_that_are_no_results_are_refused(self):
        (self.folder / "text.h5").write_text("no HDF5")
        with h5py.File(self.folder / "foreign.h5", "w") as file:
            file["x"] = 1
        for name in ("text.h5", "foreign.h5", "absent.h5"):
            with self.subTest(name):
                answer = self.script("plot_results.py", self.folder / name)
                self.assertEqual(answer.returncode, 2)
                self.assertIn(name, answer.stderr)
                self.assertNotIn("Traceback", answer.stderr)

    def test_a_refused_file_leaves_no_picture(self):
        self.script("plot_convergence.py", self.write("trajectory"))
        self.assertEqual([path.name for path in self.folder.iterdir()], ["trajectory.h5"])

    def test_columns_of_unequal_length_are_refused(self):
        path = self.write("convergence")
        with h5py.File(path, "r+") as file:
            del file["summary/order"]
            file["summary/order"] = [1.0]
        with ResultFile(path) as result, self.assertRaisesRegex(ResultError, "lengths"):
            result.summary()


if __name__ == "__main__":
    unittest.main()
