"""What stands in pictures of motions and of what follows them in time, on synthetic result files."""

import unittest

from plot_testing import PlotTest, texts_of_legend  # isort: first, it makes the scripts importable
import h5py
import numpy
import plot_construction
import plot_dissipation
import plot_energy
import plot_oscillation
import plot_simulated_energy
import plot_propagation
import plot_slope_field
import plot_spiral
import plot_trajectory
import plot_vector_field
import scene_shapes
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


PLANE = """
[[obstacle]]
shape = "plane"
point = [0.0, 0.0, -6.0]
normal = [0.0, 0.0, 2.0]
"""
SOLIDS = """
[[obstacle]]
shape = "sphere"
centre = [0.5, 0.0, 1.0]
radius = 0.75
[[obstacle]]
shape = "box"
lower = [-3.0, -1.0, -2.0]
upper = [-2.0, 1.0, 0.5]
"""
ANCHORS = """
[[anchor]]
particle = [0, 2]
stiffness = 1.0
[[anchor]]
particle = 1
position = [0.25, 0.0, 3.0]
stiffness = 1.0
"""


class TrajectoryOfAScene(PlotTest):
    def scene(self, spec, command="federwerk simulate s.toml --method rk4 --step=1e-3 --t-end 10", **options):
        path = self.write("trajectory", **options)
        with h5py.File(path, "r+") as file:
            file.attrs["spec"] = spec
            file.attrs["command_line"] = command
        return path

    def paths(self, path):
        figure, = self.draw(plot_trajectory, path)
        return figure, next(axes for axes in figure.axes if "seen along" in axes.get_title(loc="left"))

    def test_has_method_and_step_or_tolerances_above_and_below(self):
        for control, expected in (("--step=1e-3", "rk4, h = 1e-3 s"), ("--rtol 1e-6 --atol 1e-8", "rk4, rtol = 1e-6, atol = 1e-8")):
            figure, _ = self.paths(self.scene("", f"federwerk simulate 's x.toml' --method rk4 {control}"))
            self.assertIn(expected, figure._suptitle.get_text())
            self.assertTrue(any(expected in text.get_text() for text in figure.texts))

    def test_shows_a_plane_up_to_its_surface(self):
        _, panel = self.paths(self.scene(PLANE))
        solid, = panel.patches
        self.assertAlmostEqual(solid.get_xy()[:, 1].max(), -6.0)
        self.assertAlmostEqual(solid.get_xy()[:, 1].min(), panel.get_ylim()[0])
        self.assertIn("plane", texts_of_legend(panel))

    def test_shows_spheres_and_boxes_where_they_are(self):
        _, panel = self.paths(self.scene(SOLIDS))
        sphere, box = panel.patches
        self.assertEqual((sphere.center, sphere.radius), ((0.5, 1.0), 0.75))
        self.assertEqual((box.get_xy(), box.get_width(), box.get_height()), ((-3.0, -2.0), 1.0, 2.5))

    def test_marks_anchors_at_their_places_or_at_the_start_of_their_particles(self):
        path = self.scene(ANCHORS)
        _, panel = self.paths(path)
        places, = [line.get_xydata() for line in panel.lines if line.get_marker() == "x"]
        with h5py.File(path) as file:
            start = file["trajectory/position"][0]
        numpy.testing.assert_allclose(places, [start[0, [0, 2]], start[2, [0, 2]], [0.25, 3.0]])

    def test_shows_momenta_only_where_nothing_acts_from_outside(self):
        for spec, count in (("", 3), (PLANE, 1), (ANCHORS, 1), ("[world]\ngravity = [0.0, 0.0, -9.81]\n", 1)):
            figure, _ = self.paths(self.scene(spec))
            self.assertEqual(sum(bool(axes.get_ylabel()) for axes in figure.axes) - 1, count, spec)

    def test_is_seen_so_that_the_motion_is_in_the_plane(self):
        position = numpy.zeros((5, 9, 3))
        position[:, :, 0], position[:, :, 1] = numpy.meshgrid([0, 1, 2], [0, 1, 3])[0].ravel(), numpy.repeat([0, 1, 3], 3)
        position[:, 4, 2] = 0.01 * numpy.arange(5)  # a sheet that swings out of its plane
        self.assertEqual(scene_shapes.seen_plane(position), (1, 2))

    def sheet(self):
        path = self.scene('[generate]\nkind = "cloth"\ncounts = [6, 5]\n' + PLANE, particles=30)
        row = numpy.arange(30)
        with h5py.File(path, "r+") as file:
            place = file["trajectory/position"]
            time = file["trajectory/time"][:]
            place[:] = 0
            place[:, :, 0], place[:, :, 1] = row % 6, row // 6
            place[:, :, 2] = numpy.sin(time)[:, None] * (row // 6)
            del file["system/springs"]
            pairs = [(i, j) for i in row for j in row if i < j and abs(i % 6 - j % 6) <= 1 and abs(i // 6 - j // 6) <= 1]
            file["system/springs"] = numpy.array(pairs)
            file["system/fixed"] = numpy.array([0, 5])
        return path

    def test_of_a_sheet_is_a_strip_of_frames_of_its_threads(self):
        figure, = self.draw(plot_trajectory, self.sheet())
        frames = [axes for axes in figure.axes if axes.get_title().startswith("t = ")]
        self.assertEqual([axes.get_title() for axes in frames][::5], ["t = 0 s", "t = 10 s"])
        self.assertEqual(len({(*axes.get_xlim(), *axes.get_ylim()) for axes in frames}), 1)
        for axes in frames:
            threads, = axes.collections
            self.assertEqual(len(threads.get_segments()), 5 * 5 + 6 * 4)  # no shear springs
            self.assertEqual(len(axes.patches), 1)

    def test_of_an_explosion_stops_where_nothing_else_would_be_seen(self):
        path = self.scene("", status="blow_up: 1e200 J")
        with h5py.File(path, "r+") as file:
            file["trajectory/position"][200:] *= 1e90
            file["trajectory/kinetic_energy"][200:] *= 1e180
            start = numpy.abs(file["trajectory/position"][0]).max()
        figure, panel = self.paths(path)
        self.assertLess(numpy.abs(panel.get_xlim()).max(), 20 * start)
        self.assertIn("drawn up to t = ", figure._suptitle.get_text())
        self.assertEqual([axes.get_yscale() for axes in figure.axes if "energy" in axes.get_ylabel()], ["log"])
        self.assertFalse(any("cases are missing" in text.get_text() for text in figure.texts))

    def test_that_travels_far_is_drawn_to_its_end(self):
        path = self.scene("")
        with h5py.File(path, "r+") as file:
            file["trajectory/position"][:] += numpy.linspace(0, 1000, 400)[:, None, None]
        _, panel = self.paths(path)
        self.assertGreater(panel.get_xlim()[1], 1000)

    def test_draws_dots_where_frames_are_too_few_for_a_path(self):
        for frames, sparse in ((400, False), (6, True)):
            _, panel = self.paths(self.scene("", frames=frames))
            self.assertEqual(any("too few frames" in text.get_text() for text in panel.texts), sparse)


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
        for line in growth.axes[0].lines[:2]:  # theory, and the runs
            numpy.testing.assert_allclose(line.get_ydata(), [0.04, 0.01])
        self.assertEqual(laws.axes[0].get_xlabel(), "step h [s]")
        numpy.testing.assert_allclose(rounding.axes[0].lines[0].get_ydata()[-1], 2e-16 * numpy.sqrt(101) / 2.5)

    def energy_of_explosions(self):
        """Explicit Euler until the numbers end, as in the lecture: the largest energies of the runs differ by 200 decades."""
        path = self.make("energy")
        with h5py.File(path, "r+") as file:
            case = file["cases/spring-explicit_euler"]
            step, time = case["step"][:], case["bin_time"][:]
            change = 2 * numpy.expm1(numpy.array([[4.0], [1.0]]) * time / 2)
            for name in ("least", "mean", "largest"):
                case[f"change_{name}"][:] = change
            case["energy_scale"][:] = [change[0].max(), change[1].max()]
            self.assertGreater(step[0], step[1])
        return path

    def test_the_larger_step_explodes_first(self):
        change = self.draw(plot_energy, self.energy_of_explosions())[0]
        panel = change.axes[0]
        large, small = panel.lines[:2]
        self.assertEqual([line.get_label() for line in (large, small)], ["h = 0.2 s", "h = 0.1 s"])
        time = numpy.linspace(0, 100, 50)
        numpy.testing.assert_allclose(large.get_ydata()[1:], numpy.exp(2 * time))  # E/E₀, whatever it reaches
        numpy.testing.assert_allclose(small.get_ydata()[1:], numpy.exp(time / 2))
        self.assertLess(panel.get_ylim()[1], 1e21)
        self.assertEqual(panel.get_yscale(), "log")
        # Compared until the first ends of those that do not reach 10²⁰, else until the last one does.
        self.assertAlmostEqual(panel.get_xlim()[1], time[numpy.exp(time / 2) > 1e20][0])

    def test_a_run_without_energy_has_no_drift(self):
        path = self.make("energy")
        with h5py.File(path, "r+") as file:
            case = file["cases/spring-velocity_verlet"]
            for name in ("least", "mean", "largest"):
                case[f"change_{name}"][0] = -2.0  # all of it is gone
        laws = self.draw(plot_energy, path)[2]
        shown = [line.get_xdata() for panel in laws.axes[:2] for line in panel.lines if len(line.get_xdata())]
        self.assertTrue(shown)
        self.assertFalse(any(0.2 in steps for steps in shown))

    def test_an_energy_without_a_start_is_measured_against_its_size(self):
        path = self.make("energy")
        with h5py.File(path, "r+") as file:
            file["cases/spring-velocity_verlet/energy_start"][:] = 1e-17
        change = self.draw(plot_energy, path)[0]
        self.assertEqual(change.axes[1].get_ylabel(), "(E − E₀) / its size")
        self.assertLess(numpy.abs(change.axes[1].get_ylim()).max(), 0.1)

    def test_the_bar_over_a_mean_is_set_as_mathematics(self):
        errors, motion, _ = self.draw(plot_dissipation, self.make("dissipation"))
        self.assertIn(r"$|\bar{T}/T - 1|$", errors.axes[1].get_title(loc="left"))
        self.assertIn("per period, period +1 %", motion.axes[0].get_title(loc="left"))
        self.assertIn("no damping", motion.axes[1].get_title(loc="left"))

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
        self.assertIn("1 spring per step", [text.get_text() for text in figures[0].axes[0].texts])
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

    def test_energies_stay_readable_beside_one_that_explodes(self):
        figure, = self.draw(plot_simulated_energy, self.make("simulated_energy"))
        total, parts = figure.axes
        low, high = total.get_ylim()
        self.assertLess(high, 4)
        names = texts_of_legend(total)
        self.assertEqual(len(names), len(total.lines))
        self.assertTrue(any("h = 0.5 s (0.25 s)\n(leaves the picture)" in name for name in names), names)
        self.assertEqual(texts_of_legend(parts), ["kinetic", "potential", "total"])
        kinetic, potential, whole = (line.get_ydata() for line in parts.lines)
        numpy.testing.assert_allclose(kinetic + potential, whole)

    def test_the_tangent_touches_where_the_slope_is_that_of_the_field(self):
        figure, = self.draw(plot_construction, self.make("construction"))
        for axes in figure.axes:
            dots = [line for line in axes.lines if line.get_marker() == "o"]
            self.assertGreaterEqual(len(dots), 2, axes.get_title(loc="left"))
            first = numpy.ravel(dots[0].get_xdata())[0]
            self.assertEqual(first > 0, axes.get_title(loc="left").startswith("implicit_euler"))


if __name__ == "__main__":
    unittest.main()
