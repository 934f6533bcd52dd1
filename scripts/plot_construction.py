#!/usr/bin/env python3
"""Draws how single steps come about over a slope field: the explicit step follows the tangent of the solution through
its start, the implicit one arrives with the tangent of the solution through its end (the lecture's slide 33)."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from plot_slope_field import draw_field
from plot_style import EXACT, PALETTE, QUIET, label, new_figure, number
from simulated_cases import field_limits, read_field

CLOSE = 1e-9  # a slope is the step's own to this, relative


def read(result):
    cases = []
    for group in result.cases().values():
        case = {name: numpy.asarray(result.values(f"construction_{name}", group), float)
                for name in ("start_time", "start", "end_time", "end", "slope", "start_slope", "end_slope", "flow_time",
                             "flow")}
        cases.append(case | {"method": result.fact("method", group), "step": result.fact("step", group),
                             "exact_time": result.values("exact_time", group) if "exact_time" in group else None,
                             "exact_state": result.values("exact_state", group) if "exact_time" in group else None,
                             "time_unit": result.unit("time", group)})
    return cases


def draw_steps(panel, case):
    """Each step as an arrow; where its slope is that of the field, a dot, and the solution through that point."""
    for n in range(case["start"].size):
        t0, t1, y0, y1 = (case[name][n] for name in ("start_time", "end_time", "start", "end"))
        touches = [abs(case["slope"][n] - case[f"{end}_slope"][n]) <= CLOSE * max(1, abs(case["slope"][n]))
                   for end in ("start", "end")]
        for end, touch in enumerate(touches):
            panel.plot(case["flow_time"][n, end], case["flow"][n, end], color=PALETTE[2] if touch else QUIET,
                       linewidth=2.2 if touch else 0.0, zorder=3)
            if touch:
                t, y, slope = (t0, y0, case["start_slope"][n]) if end == 0 else (t1, y1, case["end_slope"][n])
                reach = 0.28 * (t1 - t0)  # the tangent, a little beyond the step
                inwards = (t0 - reach, t1) if end == 1 else (t0, t1 + reach)
                panel.plot(inwards, [y + slope * (x - t) for x in inwards], color=PALETTE[1], linewidth=1.0,
                           linestyle=(0, (4, 2)), zorder=3)
                panel.plot(t, y, marker="o", color=PALETTE[2], markersize=9, zorder=5)
        panel.annotate("", (t1, y1), (t0, y0), zorder=4,
                       arrowprops={"arrowstyle": "-|>", "color": PALETTE[1], "linewidth": 2.0, "shrinkA": 0, "shrinkB": 0})
    panel.plot(case["start_time"][0], case["start"][0], marker="s", color=EXACT, markersize=6, zorder=6)


def draw(result):
    """A panel per run."""
    cases, field = read(result), read_field(result)
    columns = min(3, len(cases))
    rows = -(-len(cases) // columns)
    figure, axes = new_figure(result, 5.2 * columns + 2.4, 3.9 * rows + 1.3, rows, columns, sharex=True, sharey=True)
    for panel in axes.flat[len(cases):]:
        panel.remove()
    for index, (panel, case) in enumerate(zip(axes.flat, cases)):
        if field is not None:
            draw_field(panel, field)
        if case["exact_time"] is not None:
            panel.plot(case["exact_time"], case["exact_state"], color=EXACT, linewidth=1.2, zorder=2)
        draw_steps(panel, case)
        panel.axhline(0, color=EXACT, linewidth=0.6)
        if field is not None:
            panel.set_xlim(field_limits([], field["t"]))
            panel.set_ylim(field_limits([], field["y"][:, 0]))
        panel.set_title(f"{case['method']}, h = {number(case['step'])} s", loc="left", fontsize=11)
        panel.grid(False)
        if index % columns == 0:
            panel.set_ylabel("state x")
        if index + columns >= len(cases):
            panel.set_xlabel(label("time t", case["time_unit"]))
            panel.tick_params(labelbottom=True)
    line = plot_style.plt.Line2D
    axes[0][columns - 1].legend(
        handles=[line([], [], color=PALETTE[1], marker=">", label="step"),
                 line([], [], color=PALETTE[2], marker="o", linewidth=2.2,
                      label="its slope is that of\nthe field here, and the\nsolution through there"),
                 line([], [], color=PALETTE[1], linewidth=1.0, linestyle=(0, (4, 2)), label="tangent"),
                 line([], [], color=EXACT, linewidth=1.2, label="exact solution\nfrom the start")],
        loc="upper left", bbox_to_anchor=(1.02, 1.0), borderaxespad=0)
    return [figure]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("simulate", draw)))
