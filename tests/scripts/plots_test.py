"""The plot scripts, on synthetic result files: what stands in the pictures, and how bad files are refused."""

import contextlib
import io
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))

import plot_style  # noqa: E402,F401
import h5py  # noqa: E402
import matplotlib.colors as colors  # noqa: E402
import numpy  # noqa: E402
import plot_agreement  # noqa: E402
import plot_construction  # noqa: E402
import plot_convergence  # noqa: E402
import plot_dissipation  # noqa: E402
import plot_energy  # noqa: E402
import plot_jacobian  # noqa: E402
import plot_linear_solver  # noqa: E402
import plot_oscillation  # noqa: E402
import plot_propagation  # noqa: E402
import plot_results  # noqa: E402
import plot_slope_field  # noqa: E402
import plot_spiral  # noqa: E402
import plot_stability  # noqa: E402
import plot_stiffness  # noqa: E402
import plot_sweep  # noqa: E402
import plot_trajectory  # noqa: E402
import plot_vector_field  # noqa: E402
import plot_verify  # noqa: E402
import plot_work_precision  # noqa: E402
import synthetic_results  # noqa: E402
from result_file import ResultError, ResultFile  # noqa: E402


class PlotTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="feder werk ")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.addCleanup(plot_style.plt.close, "all")

    def write(self, kind, **options):
        path = self.folder / f"{kind}.h5"
        synthetic_results.ALL[kind](path, **options)
        return path

    def draw(self, module, path):
        with ResultFile(path) as result:
            return module.draw(result)

    def plot_results(self, *arguments):
        """What scripts/plot_results.py does, without a process of its own and with small pictures."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), \
                plot_style.plt.rc_context({"savefig.dpi": 50}):
            code = plot_style.main("", plot_results.choose_drawing, [*map(str, arguments), "--formats", "png"])
        return subprocess.CompletedProcess(arguments, code, out.getvalue(), err.getvalue())

    def script(self, name, *arguments):
        return subprocess.run([sys.executable, SCRIPTS / name, *arguments], cwd="/", text=True, capture_output=True,
                              check=False)


def legend_of_row(figure, row):
    """The legend's entries of a row of panels."""
    return texts_of_legend([axes for axes in figure.axes if axes.get_legend()][row])


def texts_of_legend(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


class EveryPlot(PlotTest):
    def test_is_written_as_png_and_pdf_beside_its_file(self):
        for kind in synthetic_results.ALL:
            with self.subTest(kind):
                answer = self.script(f"plot_{kind}.py", self.write(kind))
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

    def test_names_study_commit_and_date_in_its_footer(self):
        for kind, module in (("convergence", plot_convergence), ("trajectory", plot_trajectory),
                             ("slope_field", plot_slope_field), ("spiral", plot_spiral)):
            with self.subTest(kind):
                figure, = self.draw(module, self.write(kind))
                footer = [text.get_text() for text in figure.texts if "federwerk" in text.get_text()]
                self.assertEqual(len(footer), 1)
                for part in (figure._suptitle.get_text(), "0123456789", "uncommitted changes", "2026-01-31"):
                    self.assertIn(part, footer[0])

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
             "propagation", "slope_field", "spiral", "stability", "stiffness", "sweep", "vector_field", "verify",
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
            for name in names if len(names) > 1 else []:
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


class Agreement(PlotTest):
    def marked_pairs(self, figure):
        return sorted((round(patch.get_y() + 0.5), round(patch.get_x() + 0.5)) for patch in figure.axes[0].patches)

    def test_marks_the_pairs_that_disagree_and_no_other(self):
        figure, = self.draw(plot_agreement, self.write("agreement"))
        others = [k for k in range(6) if k != 1]  # explicit Euler is too inaccurate to compare
        self.assertEqual(self.marked_pairs(figure), sorted([(6, k) for k in others] + [(k, 6) for k in others]))
        self.assertIn("5 disagree", figure.axes[0].get_title("left"))

    def test_marks_nothing_where_all_agree(self):
        figure, = self.draw(plot_agreement, self.write("agreement", wrong=None))
        self.assertEqual(self.marked_pairs(figure), [])
        self.assertIn("15 pairs, 0 disagree", figure.axes[0].get_title("left"))

    def test_leaves_rows_blank_that_are_not_compared(self):
        figure, = self.draw(plot_agreement, self.write("agreement", wrong=None))
        lower, share = (image.get_array() for image in figure.axes[0].images)
        self.assertTrue(numpy.ma.getmaskarray(numpy.ma.masked_invalid(lower))[1].all())
        self.assertTrue(numpy.ma.getmaskarray(numpy.ma.masked_invalid(share))[1].all())
        self.assertIn("1 methods", figure.axes[0].get_xlabel())


class WorkPrecision(PlotTest):
    def figures(self, **options):
        path = self.folder / "work_precision.h5"
        synthetic_results.work_precision(path, **options)
        return self.draw(plot_work_precision, path)

    def test_colours_the_methods_on_the_front_and_names_the_others(self):
        figure, = self.figures()
        legend = texts_of_legend(figure.axes[-1])
        self.assertIn("rk4", legend)
        self.assertNotIn("implicit_midpoint", legend)
        self.assertTrue(any("implicit_midpoint" in text.get_text() for text in figure.axes[-1].texts))
        lines = {line.get_color() for line in figure.axes[0].lines}
        self.assertIn(plot_work_precision.PALE, lines)
        self.assertIn(plot_style.PALETTE[0], lines)

    def test_draws_factorisations_where_there_are_any(self):
        titles = [axes.get_xlabel() for axes in self.figures()[0].axes]
        self.assertEqual(titles, ["right-hand sides", "wall-clock time [s]", "factorisations", ""])
        titles = [axes.get_xlabel() for axes in self.figures(factorisations=1)[0].axes]
        self.assertEqual(titles, ["right-hand sides", "wall-clock time [s]", ""])


class Stiffness(PlotTest):
    def figures(self, **options):
        path = self.folder / "stiffness.h5"
        synthetic_results.stiffness(path, **options)
        return self.draw(plot_stiffness, path)

    def test_marks_where_implicit_methods_begin_to_pay(self):
        cost, _ = self.figures()
        self.assertEqual(sum("implicit pays" in text.get_text() for axes in cost.axes for text in axes.texts), 2)
        cost, _ = self.figures(crosses=False)
        self.assertEqual(sum("implicit pays" in text.get_text() for axes in cost.axes for text in axes.texts), 0)

    def test_draws_every_order_of_the_map_at_its_step_and_eigenvalue(self):
        _, orders = self.figures()
        mesh, = orders.axes[0].collections
        drawn = numpy.ma.filled(mesh.get_array().reshape(5, 5), numpy.nan)
        steps = 0.1 / 2.0 ** numpy.arange(6)
        expected = numpy.where(steps[None, 1:] * numpy.geomspace(10, 1000, 5)[:, None] < 1, 2.0, 1.0)
        self.assertTrue((drawn == expected).all())
        self.assertIn("not stiff 2.00 (2), stiff 1.00 (1)", orders.axes[0].get_title("left"))


class Jacobian(PlotTest):
    def setUp(self):
        super().setUp()
        path = self.folder / "jacobian.h5"
        synthetic_results.jacobian(path)
        self.figures = self.draw(plot_jacobian, path)

    def test_has_a_figure_for_each_part(self):
        self.assertEqual(len(self.figures), 6)
        for figure in self.figures:
            self.assertTrue(any("federwerk" in text.get_text() for text in figure.texts))

    def test_draws_the_error_over_the_increment_and_the_slopes(self):
        panel = self.figures[0].axes[0]
        forward = panel.lines[0]
        numpy.testing.assert_allclose(forward.get_ydata(), 0.3 * forward.get_xdata() + 1e-16 / forward.get_xdata())
        self.assertEqual({text.get_text() for text in panel.texts}, {"slope 1", "slope 2", "slope −1", "analytic"})
        self.assertEqual(panel.get_xlabel(), "increment h [typical length]")

    def test_names_the_printed_formulas_and_draws_measured_over_predicted(self):
        left, right = self.figures[1].axes[:2]
        self.assertEqual(sum("printed" in text.get_text() for text in left.texts), 2)
        numpy.testing.assert_array_equal(right.lines[0].get_xdata(), right.lines[0].get_ydata())

    def test_draws_the_blocks_of_a_pattern(self):
        image = self.figures[2].axes[0].images[1].get_array()
        self.assertEqual(image.shape, (3, 3))
        self.assertEqual(numpy.ma.masked_invalid(image).count(), 5)

    def test_draws_the_limit_where_there_is_one(self):
        exact, projected = self.figures[3].axes[:2]
        predicted, found = exact.lines[:2]
        numpy.testing.assert_array_equal(predicted.get_xdata(), found.get_xdata())
        self.assertEqual(numpy.isfinite(predicted.get_xdata()).sum(), 2)
        self.assertEqual(numpy.isfinite(projected.lines[0].get_xdata()).sum(), 0)
        self.assertIn("predicted: 1/μ", texts_of_legend(exact))

    def test_marks_failed_iterations_apart(self):
        failures = self.figures[4].axes[0].collections[0].get_array()
        eigenvalue = 1 - numpy.outer([200, 200 * (1 / 0.9 - 1), 0], numpy.geomspace(1e-3, 1, 7) ** 2)
        self.assertEqual(numpy.ma.masked_invalid(failures).count(), numpy.count_nonzero(eigenvalue <= 0))

    def test_marks_runs_that_stopped(self):
        panel = self.figures[5].axes[0]
        stopped = [line for line in panel.lines if line.get_marker() == "x" and len(line.get_xdata())]
        self.assertEqual([len(line.get_xdata()) for line in stopped], [3])
        self.assertIn("matrix indefinite", " ".join(texts_of_legend(panel)))


class LinearSolver(PlotTest):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "linear_solver.h5"
        synthetic_results.linear_solver(self.path)

    def test_draws_scaling_simulation_and_spectra(self):
        answer = self.plot_results(self.path)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(len(list(self.folder.glob("linear_solver-*.png"))), 3)

    def test_has_seconds_and_iterations_over_unknowns(self):
        scaling, simulation, spectra = self.draw(plot_linear_solver, self.path)
        seconds, iterations = scaling.axes[:2]
        numpy.testing.assert_array_equal(seconds.lines[0].get_xdata(), [192, 768, 3072])
        numpy.testing.assert_allclose(seconds.lines[0].get_ydata()[0], 1e3 * (192e-6 + 1e-7 * 192 ** 1.3))
        self.assertEqual(len([line for line in iterations.lines]), 1, "a direct solver has no iterations")
        self.assertEqual(seconds.get_ylabel(), "set-up and solve [ms]")
        self.assertEqual(len(simulation.axes[0].lines), 1)
        self.assertEqual(spectra.axes[0].get_ylabel(), "eigenvalue [kg]")


class Stability(PlotTest):
    def setUp(self):
        super().setUp()
        self.path = self.folder / "stability.h5"
        synthetic_results.stability(self.path)

    def test_draws_regions_stars_axis_limits_thresholds_and_laws(self):
        answer = self.plot_results(self.path)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(len(list(self.folder.glob("stability-*.png"))), 6)

    def test_regions_have_equal_axes_and_name_their_intervals(self):
        regions = self.draw(plot_stability, self.path)[0]
        for panel in regions.axes[:2]:
            self.assertEqual(panel.get_aspect(), 1.0)
        self.assertEqual(regions.axes[0].get_xlabel(), "Re hλ\nreal axis 2, imaginary 0")
        self.assertEqual(regions.axes[1].get_xlabel(), "Re hλ\nreal axis ∞, imaginary ∞")

    def test_limits_stand_where_they_are_and_at_the_edges(self):
        limits = self.draw(plot_stability, self.path)[3]
        undamped, damped = limits.axes[:2]
        self.assertEqual(undamped.get_title(loc="left"), "undamped")
        explicit = [line.get_xdata()[0] for line in damped.lines if line.get_ydata()[0] == 0]
        numpy.testing.assert_allclose(explicit, [0.8, 0.808])  # h |λ|
        never = [line.get_xdata()[0] for line in undamped.lines if line.get_ydata()[0] == 0]
        self.assertTrue(all(value < 0.4 for value in never))
        always = [line.get_xdata()[0] for line in undamped.lines if line.get_ydata()[0] == 1]
        self.assertTrue(all(value > 1.9 for value in always))

    def test_thresholds_say_the_theory_and_laws_have_a_reference_slope(self):
        thresholds, laws = self.draw(plot_stability, self.path)[4:]
        self.assertEqual(texts_of_legend(thresholds.axes[0])[::2], ["theory h = 1/k", "theory h = 2/k"])
        self.assertIn("slope -1", [text.get_text() for text in laws.axes[0].texts])


class Verification(PlotTest):
    def make(self):
        path = self.folder / "verify.h5"
        synthetic_results.verify(path)
        return path

    def test_is_chosen_by_its_kind(self):
        answer = self.script("plot_results.py", self.make())
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(len(answer.stdout.splitlines()), 1)

    def test_has_a_square_per_scheme_and_property_and_marks_what_fails(self):
        figure, = self.draw(plot_verify, self.make())
        panel = figure.axes[0]
        self.assertEqual([tick.get_text() for tick in panel.get_xticklabels()],
                         ["order, y' = f(t, y)", "shorter last step", "symplectic"])
        self.assertEqual([tick.get_text() for tick in panel.get_yticklabels()], ["rk4", "broken", "velocity_verlet"])
        image = panel.images[0].get_array()
        numpy.testing.assert_array_equal(numpy.ma.getmaskarray(image) | numpy.isnan(numpy.ma.getdata(image)),
                                         [[False, True, False], [False, True, True], [True, False, False]])
        dots, crosses = panel.lines
        numpy.testing.assert_array_equal(crosses.get_xdata(), [0])
        numpy.testing.assert_array_equal(crosses.get_ydata(), [1])
        self.assertEqual(dots.get_xdata().size, 4)
        self.assertEqual(panel.get_legend().get_texts()[1].get_text(), "fails (1)")


class LaterKinds(PlotTest):
    """Energy, dissipation, propagation, and the further pictures of kind "simulate"."""

    def make(self, kind):
        path = self.folder / f"{kind}.h5"
        synthetic_results.LATER[kind](path)
        return path

    def test_are_chosen_by_the_content_of_the_file(self):
        for kind, figures in (("energy", 4), ("dissipation", 3), ("propagation", 4), ("vector_field", 1),
                              ("oscillation", 1), ("construction", 1)):
            with self.subTest(kind):
                answer = self.plot_results(self.make(kind))
                self.assertEqual(answer.returncode, 0, answer.stderr)
                self.assertEqual(len(answer.stdout.splitlines()), figures)

    def test_energy_is_drawn_as_a_factor_where_it_grows_and_as_a_change_elsewhere(self):
        change, growth, laws, rounding = self.draw(plot_energy, self.make("energy"))
        self.assertEqual([axes.get_ylabel() for axes in change.axes], ["E / E₀", "(E − E₀) / E₀"])
        self.assertEqual(change.axes[0].get_yscale(), "log")
        numpy.testing.assert_allclose(growth.axes[0].lines[2].get_ydata(), [0.04, 0.01])
        self.assertEqual(laws.axes[0].get_xlabel(), "step h [s]")
        numpy.testing.assert_allclose(rounding.axes[0].lines[0].get_ydata()[-1], 2e-16 * numpy.sqrt(101) / 2.5)

    def test_damping_has_theory_as_lines_and_runs_as_markers(self):
        errors, motion, radius = self.draw(plot_dissipation, self.make("dissipation"))
        z = numpy.geomspace(0.05, 5, 25)
        line, markers = errors.axes[0].lines[0], errors.axes[0].lines[2]
        numpy.testing.assert_allclose(line.get_ydata(), 0.5 * z)
        numpy.testing.assert_allclose(markers.get_ydata(), 0.5 * z[::2])
        self.assertEqual(texts_of_legend(errors.axes[2])[:2], ["implicit_euler", "trapezoidal (no damping)"])
        self.assertIn("20 steps per period", motion._suptitle.get_text())
        self.assertEqual(radius.axes[0].get_ylabel(), "spectral radius ρ")

    def test_a_front_is_white_where_nothing_has_arrived(self):
        figures = self.draw(plot_propagation, self.make("propagation"))
        image = figures[0].axes[0].images[0].get_array()  # distance × step
        self.assertTrue(numpy.ma.getmaskarray(image)[5, 4])
        self.assertFalse(numpy.ma.getmaskarray(image)[4, 4])
        self.assertIn("1 springs per step", [text.get_text() for text in figures[0].axes[0].texts])
        numpy.testing.assert_allclose(figures[0].axes[0].lines[1].get_ydata()[:3], [0, 0.5, 1.0])

    def test_a_field_has_a_panel_per_time_with_the_way_so_far(self):
        figure, = self.draw(plot_vector_field, self.make("vector_field"))
        self.assertEqual([axes.get_title(loc="left") for axes in figure.axes], ["t = 0 s", "t = 2 s", "t = 4 s"])
        self.assertEqual([axes.lines[0].get_xdata().size for axes in figure.axes], [1, 21, 41])

    def test_a_motion_keeps_the_exact_amplitude_readable(self):
        figure, = self.draw(plot_oscillation, self.make("oscillation"))
        self.assertEqual(figure.axes[0].get_ylabel(), "position x [m]")
        low, high = figure.axes[0].get_ylim()
        self.assertLess(high, 4)
        self.assertIn("h = 0.5 s\n(leaves the picture)", texts_of_legend(figure.axes[1]))

    def test_the_tangent_touches_where_the_slope_is_that_of_the_field(self):
        figure, = self.draw(plot_construction, self.make("construction"))
        for axes in figure.axes:
            dots = [line for line in axes.lines if line.get_marker() == "o"]
            self.assertGreaterEqual(len(dots), 2, axes.get_title(loc="left"))
            first = numpy.ravel(dots[0].get_xdata())[0]
            self.assertEqual(first > 0, axes.get_title(loc="left").startswith("implicit_euler"))


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


class Convergence(PlotTest):
    def test_shows_the_fitted_orders_with_their_intervals_and_the_verdict(self):
        figure, = self.draw(plot_convergence, self.write("convergence"))
        entries = legend_of_row(figure, 1)
        self.assertIn("rk4: order x 4.00 [3.98, 4.01], v 3.99 [3.97, 4.00]", entries)
        self.assertIn("midpoint: order x 2.00 [1.98, 2.01], v 1.99 [1.97, 2.00]: fails", entries)
        self.assertIn("sundials:cvode_bdf: order x not fitted, v not fitted: not applicable", entries)

    def test_shows_one_order_where_position_and_velocity_have_none_of_their_own(self):
        path = self.write("convergence")
        with h5py.File(path, "r+") as file:
            for name in [name for name in file["summary"] if name.endswith(("_position", "_velocity", "case"))]:
                del file["summary"][name]
        figure, = self.draw(plot_convergence, path)
        self.assertIn("rk4: order 4.00 [3.98, 4.01]", legend_of_row(figure, 1))

    def test_finds_a_case_by_the_name_that_the_summary_gives(self):
        path = self.write("convergence")
        with h5py.File(path, "r+") as file:
            file.move("cases/henon_heiles-rk4", "cases/renamed")
            names = [name.decode() for name in file["summary/case"][:]]
            names[names.index("henon_heiles-rk4")] = "renamed"
            file["summary/case"][:] = names
        self.assertEqual(len(self.draw(plot_convergence, path)), 1)

    def test_position_and_velocity_have_hollow_points_of_their_own(self):
        figure, = self.draw(plot_convergence, self.write("convergence"))
        hollow = [sum(len(line.get_xdata()) for line in axes.lines
                      if colors.same_color(line.get_markerfacecolor(), "white")) for axes in figure.axes[:2]]
        self.assertGreater(hollow[1], hollow[0])

    def test_draws_points_outside_the_fit_hollow_and_no_others(self):
        path = self.write("convergence")
        figure, = self.draw(plot_convergence, path)
        with h5py.File(path) as file:
            case = file["cases/henon_heiles-rk4"]
            step, error, used = case["step"][:], case["error_position"][:], case["used"][:].astype(bool)
        color = plot_style.look(list(synthetic_results.METHODS).index("rk4"))["color"]
        markers = [line for line in figure.axes[0].lines
                   if line.get_linestyle() == "None" and line.get_color() == color]
        full = [line for line in markers if colors.same_color(line.get_markerfacecolor(), color)]
        hollow = [line for line in markers if colors.same_color(line.get_markerfacecolor(), "white")]
        self.assertGreater(numpy.count_nonzero(used), 0)
        self.assertGreater(numpy.count_nonzero(~used), 0)
        numpy.testing.assert_array_equal(full[0].get_xydata(), numpy.stack([step, error], axis=1)[used])
        numpy.testing.assert_array_equal(hollow[0].get_xydata(), numpy.stack([step, error], axis=1)[~used])

    def test_reference_lines_have_the_predicted_slopes(self):
        figure, = self.draw(plot_convergence, self.write("convergence"))
        slopes = []
        for line in figure.axes[0].lines:
            if line.is_dashed():
                (x0, y0), (x1, y1) = line.get_xydata()
                slopes.append(numpy.log(y1 / y0) / numpy.log(x1 / x0))
        numpy.testing.assert_allclose(sorted(slopes), [1, 2, 4], rtol=1e-12)

    def test_says_which_points_a_logarithmic_axis_cannot_show(self):
        figure, = self.draw(plot_convergence, self.write("convergence"))
        notes = [text.get_text() for text in figure.axes[0].texts if "not shown" in text.get_text()]
        self.assertEqual(notes, ["1 not shown: zero or not finite"])  # explicit Euler's infinite error

    def test_many_problems_go_to_several_figures(self):
        path = self.write("convergence", problems=[f"problem_{i}" for i in range(7)])
        answer = self.plot_results(path)
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(len(list(self.folder.glob("convergence-[123].png"))), 3)

    def test_panels_go_by_method_on_request(self):
        with ResultFile(self.write("convergence")) as result:
            figures = plot_convergence.draw(result, by="method")
        self.assertEqual(figures[0].axes[0].get_title(loc="left"), "explicit_euler")
        self.assertTrue(legend_of_row(figures[0], 0)[0].startswith("henon_heiles: order x 1.00"))

    def test_a_first_order_system_has_one_panel_with_its_error(self):
        path = self.write("convergence")
        with h5py.File(path, "r+") as file:
            for name, case in file["cases"].items():
                if name.startswith("henon_heiles"):
                    case["error_position"][:] = numpy.nan
                    case["error_velocity"][:] = numpy.nan
        figure, = self.draw(plot_convergence, path)
        self.assertEqual([axes.get_ylabel() for axes in figure.axes if not axes.get_legend()],
                         ["error", "position error [m]", "velocity error [m/s]"])
        self.assertIn("rk4: order 4.00 [3.98, 4.01]", legend_of_row(figure, 0))

    def test_a_case_without_any_level_is_listed(self):
        path = self.write("convergence")
        with h5py.File(path, "r+") as file:
            case = file["cases/henon_heiles-rk4"]
            for name in list(case):
                del case[name]
                synthetic_results.put(case, name, numpy.zeros(0))
        figure, = self.draw(plot_convergence, path)
        self.assertTrue(any(entry.startswith("rk4: ") for entry in legend_of_row(figure, 0)))


class Trajectory(PlotTest):
    def test_does_not_draw_rounding_as_waves(self):
        path = self.write("trajectory")
        with h5py.File(path, "r+") as file:
            file["trajectory/linear_momentum"][:, 0] = 0
        figure, = self.draw(plot_trajectory, path)
        panel = next(axes for axes in figure.axes if axes.get_ylabel().startswith("p "))
        low, high = panel.get_ylim()
        self.assertGreater(high - low, 1e-7)  # the momenta themselves vary by 1e-14

    def test_a_real_drift_of_momentum_fills_the_panel(self):
        path = self.write("trajectory")
        with h5py.File(path, "r+") as file:
            file["trajectory/linear_momentum"][:, 0] = numpy.linspace(0, 0.05, 400)
        figure, = self.draw(plot_trajectory, path)
        low, high = next(axes for axes in figure.axes if axes.get_ylabel().startswith("p ")).get_ylim()
        self.assertLess(high - low, 0.06)

    def test_a_run_that_stopped_says_so(self):
        figure, = self.draw(plot_trajectory, self.write("trajectory", status="blow_up"))
        self.assertIn("blow_up", figure._suptitle.get_text())

    def test_many_particles_have_a_choice_of_paths_that_is_announced(self):
        figure, = self.draw(plot_trajectory, self.write("trajectory", particles=60))
        self.assertIn("paths (12 of 60), seen along y", [axes.get_title(loc="left") for axes in figure.axes])


class Sweep(PlotTest):
    def test_has_a_line_per_method_and_other_parameter_over_the_first_one(self):
        figure, = self.draw(plot_sweep, self.write("sweep"))
        axes, = figure.axes
        self.assertEqual(sorted(texts_of_legend(axes)), ["rk4, step = 0.01 s", "rk4, step = 0.02 s",
                                                         "velocity_verlet, step = 0.01 s", "velocity_verlet, step = 0.02 s"])
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("stiffness [N/m]", "end error [m]"))
        line = next(line for line in axes.lines if line.get_label() == "rk4, step = 0.02 s")
        numpy.testing.assert_allclose(line.get_ydata(), numpy.array([1, 10, 100]) * 0.02 ** 4)
        self.assertEqual((axes.get_xscale(), axes.get_yscale()), ("log", "log"))

    def test_shows_the_first_number_that_varies_where_none_is_named(self):
        figure, = self.draw(plot_sweep, self.write("sweep", quantities="[]"))
        self.assertEqual(figure.axes[0].get_ylabel(), "end error [m]")

    def test_refuses_a_quantity_that_is_not_there(self):
        with self.assertRaisesRegex(ResultError, "end_eror"):
            self.draw(plot_sweep, self.write("sweep", quantities='["end_eror"]'))


class SimulatedCases(PlotTest):
    def test_every_step_has_a_curve_with_its_own_points(self):
        path = self.write("slope_field")
        figure, = self.draw(plot_slope_field, path)
        self.assertEqual([axes.get_title(loc="left") for axes in figure.axes],
                         ["explicit_euler: decay", "implicit_euler: decay"])
        curve = next(line for line in figure.axes[0].lines if line.get_label() == "h = 0.5 s")
        with h5py.File(path) as file:
            case = next(case for case in file["cases"].values()
                        if case.attrs.get("step") == 0.5 and case.attrs["method"] == "explicit_euler")
            numpy.testing.assert_array_equal(curve.get_xdata(), case["time"][:])
            numpy.testing.assert_array_equal(curve.get_ydata(), case["state"][:, 0])

    def test_a_curve_that_leaves_the_picture_says_so_and_no_other(self):
        figure, = self.draw(plot_slope_field, self.write("slope_field"))
        entries = texts_of_legend(figure.axes[0])
        self.assertEqual([entry for entry in entries if "leaves" in entry], ["h = 2.2 s\n(leaves the picture)"])

    def test_the_state_plane_has_equal_axes(self):
        figure, = self.draw(plot_spiral, self.write("spiral"))
        self.assertEqual(figure.axes[0].get_aspect(), 1.0)

    def test_facts_may_be_columns_in_place_of_attributes(self):
        path = self.write("spiral")
        with h5py.File(path, "r+") as file:
            for name, case in file["cases"].items():
                if name != "vector_field":
                    for fact in ("problem", "method", "step"):
                        case[fact] = [case.attrs[fact]]
                        del case.attrs[fact]
        figure, = self.draw(plot_spiral, path)
        self.assertIn("h = 0.02 s", texts_of_legend(figure.axes[0]))

    def test_a_scheme_that_chooses_its_steps_is_labelled_so(self):
        path = self.write("spiral")
        with h5py.File(path, "r+") as file:
            file["cases/circle-explicit_euler-1"].attrs["step"] = numpy.nan
        figure, = self.draw(plot_spiral, path)
        self.assertEqual([entry.split("\n")[0] for entry in texts_of_legend(figure.axes[0])],
                         ["h = 0.5 s", "h = 0.1 s", "h = 0.02 s", "adaptive steps", "exact", "start"])

    def test_a_state_of_another_size_is_refused(self):
        with self.assertRaisesRegex(ResultError, "2 components, expected 1"):
            self.draw(plot_slope_field, self.write("spiral"))


if __name__ == "__main__":
    unittest.main()
