#!/usr/bin/env python3
"""Draws a study of propagation: which masses a disturbance has reached after each step of a scheme (the lecture's
slide 32), beside the front that a wave has physically."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.colors import LogNorm
from plot_style import EXACT, PALETTE, new_figure, number

SMALLEST = 1e-16  # relative displacement at the dark end of the colours
FRONT = PALETTE[1]


def field_by_distance(result, case):
    """The largest |displacement| at each distance, a row per step; from −d to d where a chain extends to both sides."""
    displacement = numpy.abs(numpy.asarray(result.values("displacement", case), float))
    distance = numpy.asarray(result.values("distance", case))
    field = numpy.zeros((displacement.shape[0], distance.max() + 1))
    for d in range(distance.max() + 1):
        field[:, d] = displacement[:, distance == d].max(axis=1)
    return field


def draw_fronts(result, rows, title):
    """A panel per method: colour is the displacement, white is exactly zero."""
    columns = min(4, len(rows))
    lines = -(-len(rows) // columns)
    figure, axes = new_figure(result, 3.9 * columns + 1.3, 3.9 * lines + 0.9, lines, columns, sharex=True, sharey=True)
    for panel in axes.flat[len(rows):]:
        panel.remove()
    image = None
    for index, (panel, row) in enumerate(zip(axes.flat, rows)):
        case = result.case_of(row)
        field = field_by_distance(result, case)
        steps = numpy.arange(field.shape[0])
        size = numpy.nanmax(field[numpy.isfinite(field)]) if field.any() else 1.0
        shown = numpy.ma.masked_less_equal(field / size, 0.0)
        image = panel.imshow(shown.T, origin="lower", aspect="auto", interpolation="nearest", cmap="viridis",
                             norm=LogNorm(SMALLEST, 1.0), extent=(-0.5, steps[-1] + 0.5, -0.5, field.shape[1] - 0.5))
        velocity = numpy.asarray(result.values("front_velocity", case), float)
        panel.plot(steps, numpy.where(velocity < 0, numpy.nan, velocity), color=FRONT, linewidth=1.8,
                   drawstyle="steps-post")
        wave = row["wave_springs_per_step"]
        if numpy.isfinite(wave):
            panel.plot(steps, wave * steps, color=EXACT, linewidth=1.2, linestyle=(0, (5, 3)))
        panel.set_ylim(-0.5, field.shape[1] - 0.5)
        panel.set_title(row["method"], loc="left", fontsize=10.5)
        at_once = row["first_step_velocity"] == row["farthest"]
        rate = number(round(row["springs_per_step"], 3))
        rate += " spring per step" if rate == "1" else " springs per step"
        panel.text(0.98, 0.03, "all masses in one step" if at_once else rate, transform=panel.transAxes,
                   ha="right", va="bottom", fontsize=9.5,
                   bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.85, "pad": 2})
        panel.grid(False)
        if index % columns == 0:
            panel.set_ylabel("springs from the disturbed mass")
        if index + columns >= len(rows):
            panel.set_xlabel("step n")
            panel.tick_params(labelbottom=True)
    bar = figure.colorbar(image, ax=[panel for panel in axes.flat[:len(rows)]], shrink=0.8, pad=0.01)
    bar.set_label("|displacement| / largest (white: exactly 0)")
    figure.suptitle(f"{result.title}: {title}\norange: farthest mass that moves at all; dashed: wave at √(k/m)")
    return figure


def draw_speeds(result, rows):
    """Springs per step over ωh: schemes stay at theirs, the wave needs ωh."""
    chains = [row for row in rows if numpy.isfinite(row["wave_springs_per_step"])]
    steps = sorted({row["wave_springs_per_step"] for row in chains})
    if len(steps) < 2:
        return None
    figure, axes = new_figure(result, 12.5, 5.6, 1, 2, gridspec_kw={"width_ratios": [1, 0.45]})
    panel, side = axes[0]
    handles = []
    for index, method in enumerate(dict.fromkeys(row["method"] for row in chains)):
        mine = sorted((row["wave_springs_per_step"], row["springs_per_step"]) for row in chains
                      if row["method"] == method)
        style = plot_style.look(index)
        panel.loglog(*zip(*mine), linewidth=1.3, **style)
        handles.append(plot_style.plt.Line2D([], [], linewidth=1.3, label=method, **style))
    panel.loglog(steps, steps, color=EXACT, linestyle=(0, (5, 3)), linewidth=1.3)
    handles.append(plot_style.plt.Line2D([], [], color=EXACT, linestyle=(0, (5, 3)), label="what the wave needs: ω h"))
    panel.set_xlabel("ω h")
    panel.set_ylabel("springs per step")
    side.set_axis_off()
    side.legend(handles=handles, loc="upper left", borderaxespad=0)
    return figure


def draw_profiles(result, rows):
    """The front of the wave over time: where the displacement has reached a third of its final value."""
    shown = [row for row in rows
             if numpy.isfinite(numpy.asarray(result.values("front_wave", result.case_of(row)), float)).sum() > 5]
    # One step: the largest at which a method of order 2 is accurate, else the smallest.
    steps = sorted({row["step"] for row in shown if row["wave_springs_per_step"] <= 0.5})
    chosen = steps[-1] if steps else min((row["step"] for row in shown), default=None)
    shown = [row for row in shown if row["step"] == chosen]
    if not shown:
        return None
    figure, axes = new_figure(result, 12.5, 5.6, 1, 2, gridspec_kw={"width_ratios": [1, 0.55]})
    panel, side = axes[0]
    handles, longest, speed = [], 0.0, numpy.nan
    for index, row in enumerate(shown):
        case = result.case_of(row)
        time = numpy.asarray(result.values("time", case), float)
        front = numpy.asarray(result.values("front_wave", case), float)
        style = plot_style.look(index)
        panel.plot(time, front, linewidth=1.3, markevery=max(1, time.size // 10), **style)
        off = 100 * (row["wave_speed"] / row["physical_wave_speed"] - 1)
        handles.append(plot_style.plt.Line2D([], [], linewidth=1.3, **style,
                                             label=f"{row['method']}, h = {number(row['step'])} s: {round(off, 1) + 0.0:+.1f} %"))
        known = numpy.isfinite(front)
        longest, speed = max(longest, time[known].max()), row["physical_wave_speed"]
    panel.plot([0, longest], [0, speed * longest], color=EXACT, linestyle=(0, (5, 3)), linewidth=1.3)
    handles.append(plot_style.plt.Line2D([], [], color=EXACT, linestyle=(0, (5, 3)), label="√(k/m) t"))
    panel.set_ylim(0, max(row["farthest"] for row in shown))
    panel.set_xlabel("time t [s]")
    panel.set_ylabel("springs from the disturbed mass")
    panel.set_title("where the displacement reaches a third of its final value", loc="left")
    side.set_axis_off()
    side.legend(handles=handles, loc="upper left", borderaxespad=0, fontsize=9, title="speed against √(k/m)",
                alignment="left")
    return figure


def draw(result):
    rows = result.summary()
    figures = []
    for key in dict.fromkeys((row["problem"], row["step"]) for row in rows):
        mine = [row for row in rows if (row["problem"], row["step"]) == key]
        figures.append(draw_fronts(result, mine, f"{key[0]}, h = {number(key[1])} s"))
    for figure in (draw_speeds(result, rows), draw_profiles(result, rows)):
        if figure is not None:
            figures.append(figure)
    return figures


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("propagation", draw)))
