"""What stands in the pictures of each kind of study, on synthetic result files."""

import unittest

from plot_testing import PlotTest, legend_of_row, texts_of_legend  # isort: first, it makes the scripts importable
import h5py
import matplotlib.colors as colors
import numpy
import plot_agreement
import plot_convergence
import plot_jacobian
import plot_linear_solver
import plot_results
import plot_stability
import plot_stiffness
import plot_style
import plot_sweep
import plot_verify
import plot_work_precision
import synthetic_results
from result_file import ResultError, ResultFile


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


    def test_laws_name_the_methods_without_a_line_in_bands(self):
        with h5py.File(self.path, "r+") as file:
            case = next(case for name, case in file["cases"].items() if "parameter" in case
                        and numpy.isfinite(case["predicted_limit"][:]).all())
            for column in ("predicted_limit", "observed_limit"):
                case[column][:] = numpy.inf
        laws = self.draw(plot_stability, self.path)[-1]
        self.assertTrue(any(text.get_text().startswith("↑ no limit: ") for text in laws.axes[0].texts))

    def test_parameters_are_named_with_their_units(self):
        for path, expected in (("generate.stiffness.structural", "stiffness (structural) [N/m]"),
                               ("problem[0].parameters.mass", "mass [kg]"), ("count", "count")):
            self.assertEqual(plot_style.parameter_label(path), expected)


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


if __name__ == "__main__":
    unittest.main()
