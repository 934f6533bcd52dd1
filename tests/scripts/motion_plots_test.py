"""What stands in pictures of motions and of what follows them in time, on synthetic result files."""

import unittest

from plot_testing import PlotTest, texts_of_legend  # isort: first, it makes the scripts importable
import h5py
import numpy
import plot_construction
import plot_dissipation
import plot_energy
import plot_oscillation
import plot_propagation
import plot_slope_field
import plot_spiral
import plot_trajectory
import plot_vector_field
import synthetic_results
from result_file import ResultError


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


if __name__ == "__main__":
    unittest.main()
