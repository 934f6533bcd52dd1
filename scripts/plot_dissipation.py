#!/usr/bin/env python3
"""Draws a study of numerical damping: damping ratio, period error and spectral radius over ωh, from theory (lines) and
measured (markers), and what becomes of an oscillation."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.lines import Line2D
from plot_style import EXACT, PALETTE, QUIET, label, new_figure, number

MOST_MARKERS = 12
FLOOR = 1e-12  # what is smaller is rounding
STYLES = ["-", (0, (6, 1.6)), (0, (1.2, 1.2)), (0, (6, 1.5, 1.2, 1.5))]  # one per round through the colours


def look(index):
    return {"color": PALETTE[index % (len(PALETTE) - 1)], "linestyle": STYLES[index // (len(PALETTE) - 1) % len(STYLES)]}


def series(result):
    """The cases in the order of the study, with their curves as arrays."""
    found = []
    for index, row in enumerate(result.summary()):
        case = result.case_of(row)
        names = ("frequency_step", "damping_ratio", "period_error", "spectral_radius", "measured_damping_ratio",
                 "measured_period_error", "measured_radius", "motion_time", "motion_position", "motion_exact")
        found.append({name: numpy.asarray(result.values(name, case), float) for name in names}
                     | {"row": row, "look": look(index), "units": {name: result.unit(name, case) for name in names}})
    return found


def steps_per_period_axis(panel):
    top = panel.secondary_xaxis("top", functions=(lambda z: 2 * numpy.pi / numpy.maximum(z, 1e-12),
                                                  lambda n: 2 * numpy.pi / numpy.maximum(n, 1e-12)))
    top.set_xlabel("steps per period")
    ticks = [number for number in (1000, 300, 100, 30, 10, 5, 3, 2, 1, 0.5)
             if panel.get_xlim()[0] <= 2 * numpy.pi / number <= panel.get_xlim()[1]]
    top.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    top.minorticks_off()


def signed_curve(panel, z, values, measured, style, width=1.7):
    """|values| on a logarithmic axis; where they are negative the line is thin."""
    known = values if numpy.isfinite(values).any() else measured
    for sign, line_width in ((1, width), (-1, 0.55 * width)):
        part = numpy.where(sign * known > FLOOR, numpy.abs(known), numpy.nan)
        panel.loglog(z, part, linewidth=line_width, **style)
    # A double root is known to the root of the rounding only: a zero of theory that is none at a single point is no curve.
    has_value = numpy.abs(known) > FLOOR
    has_neighbour = numpy.convolve(has_value, [1, 0, 1], mode="same") > 0
    is_there = (numpy.abs(measured) > FLOOR) & has_value & (has_neighbour if z.size > 1 else True)
    shown = numpy.where(is_there, numpy.abs(measured), numpy.nan)
    every = max(1, z.size // MOST_MARKERS)
    panel.loglog(z[::every], shown[::every], linestyle="none", marker="o", markersize=4, color=style["color"])


def is_undamped(curve):
    known = curve["damping_ratio"][numpy.isfinite(curve["damping_ratio"])]
    return known.size > 0 and not (numpy.abs(known) > FLOOR).any()


def method_legend(panel, curves, extra=()):
    handles = [Line2D([], [], linewidth=2, label=curve["row"]["method"] + (" (no damping)" if is_undamped(curve) else ""),
                      **curve["look"]) for curve in curves]
    handles += [Line2D([], [], linestyle="none", marker="o", markersize=4, color=QUIET, label="measured on a run"), *extra]
    panel.set_axis_off()
    panel.legend(handles=handles, loc="upper left", borderaxespad=0)


def draw_errors(result, curves):
    figure, axes = new_figure(result, 16.5, 6.4, 1, 3, gridspec_kw={"width_ratios": [1, 1, 0.52]})
    for panel, name, title in ((axes[0][0], "damping_ratio", "numerical damping ratio |ξ|"),
                               (axes[0][1], "period_error", r"relative error of the period $|\bar{T}/T - 1|$")):
        for curve in curves:
            signed_curve(panel, curve["frequency_step"], curve[name], curve[f"measured_{name}"], curve["look"])
        panel.set_title(title, loc="left", pad=40)
        panel.set_xlabel("ω h")
        low, high = panel.get_ylim()
        panel.set_ylim(max(low, FLOOR), min(high, 20))
        steps_per_period_axis(panel)
    axes[0][0].set_ylabel("damping ratio")
    axes[0][1].set_ylabel("period error")
    method_legend(axes[0][2], curves, [
        Line2D([], [], color=QUIET, linewidth=1.7, label="damps; period too long"),
        Line2D([], [], color=QUIET, linewidth=0.8, label="amplifies; period too short")])
    return figure


def draw_radius(result, curves):
    figure, axes = new_figure(result, 13.5, 6.0, 1, 2, gridspec_kw={"width_ratios": [1, 0.4]})
    panel = axes[0][0]
    for curve in curves:
        z = curve["frequency_step"]
        panel.semilogx(z, curve["spectral_radius"], **curve["look"])
        every = max(1, z.size // MOST_MARKERS)
        panel.semilogx(z[::every], curve["measured_radius"][::every], linestyle="none", marker="o", markersize=4,
                       color=curve["look"]["color"])
    panel.axhline(1.0, color=EXACT, linewidth=0.9)
    panel.annotate("stable below", (panel.get_xlim()[0], 1.0), xytext=(4, -4), textcoords="offset points", va="top",
                   fontsize=9.5, color=QUIET)
    panel.set_ylim(-0.03, 1.6)
    panel.set_xlabel("ω h")
    panel.set_ylabel("spectral radius ρ")
    panel.set_title("growth per step", loc="left", pad=40)
    steps_per_period_axis(panel)
    method_legend(axes[0][1], curves)
    return figure


def in_words(row):
    """ "damps 62 % per period, period +3.2 %" from damping ratio ξ̄ = −ln|λ|/ω̄ and period error."""
    per_period = numpy.expm1(-2 * numpy.pi * row["damping_ratio"])  # change of the amplitude
    size = f"{number(float(f'{100 * abs(per_period):.2g}'))} % per period"
    what = "no damping" if abs(per_period) < 5e-7 else f"damps {size}" if per_period < 0 else f"grows by {size}"
    period = row["period_error"]
    off = "" if not numpy.isfinite(period) else ", period exact" if abs(period) < 5e-7 else f", period {100 * period:+.2g} %"
    return what + off


def draw_motion(result, curves):
    """A panel per method: the exact oscillation and what the method makes of it."""
    columns = min(4, len(curves))
    rows = -(-len(curves) // columns)
    figure, axes = new_figure(result, 4.1 * columns, 2.7 * rows + 0.9, rows, columns, sharex=True, sharey=True)
    for panel in axes.flat[len(curves):]:
        panel.remove()
    for index, (panel, curve) in enumerate(zip(axes.flat, curves)):
        size = numpy.abs(curve["motion_exact"]).max()
        panel.plot(curve["motion_time"], curve["motion_exact"], color=EXACT, linewidth=1.0)
        panel.plot(curve["motion_time"], curve["motion_position"], color=curve["look"]["color"], linewidth=1.8)
        panel.set_ylim(-1.9 * size, 1.9 * size)
        row = curve["row"]
        panel.set_title(f"{row['method']}\n{in_words(row)}", loc="left", fontsize=10.5)
        if index + columns >= len(curves):
            panel.set_xlabel(label("time t", curve["units"]["motion_time"]))
            panel.tick_params(labelbottom=True)
        if index % columns == 0:
            panel.set_ylabel(label("position", curve["units"]["motion_position"]))
    figure.suptitle(f"{result.title}: {number(curves[0]['row']['steps_per_period'])} steps per period, exact in black")
    return figure


def draw(result):
    curves = series(result)
    return [draw_errors(result, curves), draw_motion(result, curves), draw_radius(result, curves)]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("dissipation", draw)))
