"""Rules that hold for the figures of every kind: hidden curves are named, slides are readable, colours differ."""

import unittest

from plot_testing import PlotTest, texts_of_legend  # isort: first, it makes the scripts importable
import figure_rules
import h5py
import matplotlib
import numpy
import plot_energy
import plot_jacobian
import plot_stiffness
import plot_style
import plot_sweep
import synthetic_results
from matplotlib.colors import to_hex
from result_file import ResultFile


class HiddenCurves(PlotTest):
    def legend(self, curves, **options):
        figure, panel = plot_style.plt.subplots()
        for index, (name, values) in enumerate(curves):
            panel.plot([1, 2, 4], values, label=name, **(plot_style.look(index) | options))
        panel.legend()
        figure_rules.name_hidden_curves(figure)
        return texts_of_legend(panel)

    def test_are_named_by_the_curve_that_they_lie_on(self):
        entries = self.legend([("verlet", [1, 4, 16]), ("heun", [1, 4, 16.5]), ("velocity_verlet", [1, 4, 16 + 1e-9])])
        self.assertEqual(entries, ["verlet", "heun", "velocity_verlet (= verlet)"])

    def test_are_those_that_are_the_same_in_every_panel(self):
        figure, panels = plot_style.plt.subplots(1, 2)
        for index in range(2):
            panels[0].plot([1, 2], [1, 2], label=f"m{index}", **plot_style.look(index))
            panels[1].plot([1, 2], [1, 2 + index], label=f"m{index}", **plot_style.look(index))
        panels[0].legend()
        figure_rules.name_hidden_curves(figure)
        self.assertEqual(texts_of_legend(panels[0]), ["m0", "m1"])

    def test_are_not_points_that_lie_on_the_line_of_theory(self):
        figure, panel = plot_style.plt.subplots()
        panel.plot([1, 2], [1, 2], label="theory", color="C0")
        panel.plot([1, 2], [1, 2], label="measured", color="C1", marker="o", linestyle="none")
        panel.legend()
        figure_rules.name_hidden_curves(figure)
        self.assertEqual(texts_of_legend(panel), ["theory", "measured"])


class Shades(PlotTest):
    def test_of_steps_are_all_different(self):
        for count in (1, 4, 6, 9, 20):
            self.assertEqual(len({to_hex(plot_style.shade(k, count)) for k in range(count)}), count)


class Slides(PlotTest):
    def slides(self, module, path):
        with ResultFile(path) as result:
            return figure_rules.slides(module.draw, result)

    def test_have_one_panel_each_with_large_letters(self):
        path = self.folder / "energy.h5"
        synthetic_results.LATER["energy"](path)
        with ResultFile(path) as result:
            panels = sum(len(figure_rules.content(figure)) for figure in plot_energy.draw(result))
        slides = self.slides(plot_energy, path)
        self.assertEqual(len(slides), panels)
        for slide in slides:
            panel, = figure_rules.content(slide)
            numpy.testing.assert_allclose(slide.get_size_inches(), (13.33, 7.5))
            self.assertGreaterEqual(panel.xaxis.label.get_fontsize(), 20)
            self.assertTrue(panel.get_xlabel() and panel.get_ylabel())
            self.assertTrue(any("federwerk" in text.get_text() for text in slide.texts))

    def test_are_made_on_the_command_line(self):
        for kind in ("sweep",):
            path = self.write(kind)
            answer = self.script("plot_results.py", path, "--style", "slide", "--formats", "png", "-o", self.folder / kind)
            self.assertEqual(answer.returncode, 0, answer.stderr)
            self.assertGreaterEqual(len(answer.stdout.splitlines()), 1)


class ListsOfOne(PlotTest):
    """A study of one step, one value, one compression has a picture, or nothing to draw, and no traceback."""

    def cut(self, kind, datasets):
        """The synthetic file with these datasets of its cases cut to their first entries along the axes named."""
        path = self.folder / f"{kind}.h5"
        synthetic_results.LATER.get(kind, synthetic_results.ALL.get(kind))(path) if kind not in ("jacobian", "stiffness") \
            else getattr(synthetic_results, kind)(path)
        with h5py.File(path, "r+") as file:
            for case in file["cases"].values():
                for name in [name for name in case if name in datasets]:
                    values, attributes = case[name][()], dict(case[name].attrs)
                    for axis in datasets[name]:
                        values = values.take([0], axis=axis)
                    del case[name]
                    case[name] = values
                    case[name].attrs.update(attributes)
        return path

    def test_draw_one_compression_at_one_step(self):
        grid = {name: (0, 1) for name in ("eigenvalue", "newton_iterations", "newton_cg_iterations", "cg_iterations")}
        path = self.cut("jacobian", grid | {"step": (0,), "compression": (0,), "predicted_limit_step": (0,),
                                            "limit_step": (0,), "energy_gain": (0,), "status": (0,)})
        for figure in self.draw(plot_jacobian, path):
            figure.canvas.draw()

    def test_draw_one_stiffness(self):
        path = self.folder / "stiffness.h5"
        synthetic_results.stiffness(path)
        with h5py.File(path) as file:
            names = {name: (0,) for case in file["cases"].values() for name in case}
        for figure in self.draw(plot_stiffness, self.cut("stiffness", names)):
            figure.canvas.draw()

    def test_draw_a_sweep_in_which_nothing_varies(self):
        path = self.write("sweep", quantities="[]")
        with h5py.File(path, "r+") as file:
            rows = len(file["summary/case"])
            for name in list(file["summary"]):
                if file["summary"][name].dtype.kind == "f" and not name.startswith("parameter"):
                    file["summary"][name][:] = numpy.ones(rows)
        self.assertEqual(len(self.draw(plot_sweep, path)), 1)


class Numbers(PlotTest):
    def test_below_a_thousandth_have_their_power_in_the_label(self):
        figure, panel = plot_style.plt.subplots()
        panel.plot([0, 1], [0, 3e-14])
        panel.set_ylabel("change")
        plot_style.power_of_ten(panel)
        figure.canvas.draw()
        self.assertEqual(panel.yaxis.get_offset_text().get_text(), "")
        self.assertIn("10$^{-14}$", panel.get_ylabel())
        self.assertIn("3", [text.get_text() for text in panel.get_yticklabels()])
        self.assertTrue(matplotlib.get_backend().lower().endswith("agg"))


if __name__ == "__main__":
    unittest.main()
