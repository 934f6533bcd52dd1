#!/usr/bin/env python3
"""Draws a study of stability: regions |R(hλ)| <= 1 and order stars, predicted and observed largest stable steps, how they
depend on a parameter, and the thresholds of oscillation and instability on x' = -k x."""

import math
import sys
import textwrap

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from plot_style import ALARM, EXACT, PALETTE, QUIET, label, look, new_figure, number, parameter_label
from result_file import text as text_of

INSIDE = "#BFD9EC"
STAR = "#F6CFB4"
OSCILLATES = "#F6CFB4"
DIVERGES = "#EEEEEE"


def rows_of(result, part):
    return [row for row in result.summary() if row["part"] == part]


def short(method):
    """"implicit_euler_linearised[linear_solver=cholesky]" without its settings."""
    return method.split("[", 1)[0]


def explain(figure, result, text):
    """A line below the title that says what is drawn."""
    figure.suptitle(f"{result.title}\n{text}", fontsize=12.5)


def panel_grid(result, count, size, columns, extra=0.9):
    rows = math.ceil(count / columns)
    figure, axes = new_figure(result, size * columns + 0.5, size * rows + extra, rows, columns)
    for panel in axes.flat[count:]:
        panel.set_axis_off()
    return figure, axes.flat


def interval_text(value):
    if math.isnan(value):
        return "—"
    return "∞" if math.isinf(value) else f"{value:.3g}"


def draw_plane(panel, result, case, column, colour):
    """Fills where the column is at most 1 (growth) or above 1 (order star)."""
    x, y, values = (result.values(name, case) for name in ("z_real", "z_imaginary", column))
    values = numpy.where(numpy.isfinite(values), values, numpy.inf if column == "growth" else numpy.nan)
    clipped = numpy.minimum(values, 10.0)
    # A region ends where growth exceeds 1 by more than rounding.
    level = 1.0 + 1e-9
    levels = [-1.0, level] if column == "growth" else [level, 11.0]
    panel.contourf(x, y, clipped, levels=levels, colors=[colour])
    panel.contour(x, y, clipped, levels=[level], colors=[PALETTE[0] if column == "growth" else PALETTE[1]],
                  linewidths=1.4)
    panel.axhline(0, color=QUIET, linewidth=0.8)
    panel.axvline(0, color=QUIET, linewidth=0.8)
    panel.set_xlim(x[0], x[-1])
    panel.set_ylim(y[0], y[-1])
    panel.set_aspect("equal")
    panel.tick_params(labelsize=9)


def has_plane(result, row):
    return numpy.isfinite(result.values("growth", result.case_of(row))).any()


def draw_regions(result, rows):
    rows = [row for row in rows if has_plane(result, row)]
    figure, panels = panel_grid(result, len(rows), 3.0, min(6, len(rows)), 1.3)
    for panel, row in zip(panels, rows):
        case = result.case_of(row)
        draw_plane(panel, result, case, "growth", INSIDE)
        if "locus_real" in case:
            panel.plot(result.values("locus_real", case), result.values("locus_imaginary", case), color=EXACT,
                       linewidth=1.0, linestyle=(0, (4, 2)))
        panel.set_title(short(row["method"]), loc="left", fontsize=11)
        panel.set_xlabel(f"Re hλ\nreal axis {interval_text(row['real_interval'])}, "
                         f"imaginary {interval_text(row['imaginary_interval'])}", fontsize=9)
        panel.set_ylabel("Im hλ" if panel.get_subplotspec().is_first_col() else "", fontsize=9)
    explain(figure, result, "filled: |R(hλ)| ≤ 1, nothing grows; dashed: root locus of multistep formulas")
    return figure


def draw_order_stars(result, rows):
    rows = [row for row in rows if row["basis"] == "R(z)"]
    if not rows:
        return None
    figure, panels = panel_grid(result, len(rows), 3.0, min(6, len(rows)), 1.3)
    for panel, row in zip(panels, rows):
        draw_plane(panel, result, result.case_of(row), "order_star", STAR)
        panel.set_title(short(row["method"]), loc="left", fontsize=11)
        panel.set_xlabel("Re z", fontsize=9)
        panel.set_ylabel("Im z" if panel.get_subplotspec().is_first_col() else "", fontsize=9)
    explain(figure, result, "order stars, filled: |R(z) e⁻ᶻ| > 1; order + 1 fingers meet at 0")
    return figure


def draw_imaginary_axis(result, rows):
    """Growth per step of an undamped vibration, which is all that a position scheme has a say in."""
    bases = list(dict.fromkeys(row["basis"] for row in rows))
    figure, axes = new_figure(result, 15, 5.0, 1, len(bases), sharey=True)
    for panel, basis in zip(axes[0], bases):
        for index, row in enumerate(row for row in rows if row["basis"] == basis):
            case = result.case_of(row)
            panel.plot(result.values("distance", case), result.values("growth_imaginary_axis", case),
                       linewidth=1.5, color=PALETTE[index % len(PALETTE)],
                       linestyle=["-", (0, (5, 2)), (0, (1, 1.3))][index // len(PALETTE) % 3],
                       label=short(row["method"]))
        panel.axhline(1, color=EXACT, linewidth=0.9)
        panel.set_ylim(0, 2)
        panel.set_title(basis, loc="left")
        panel.set_xlabel("hω")
        panel.legend(fontsize=8.5, loc="upper left", bbox_to_anchor=(0, -0.27), ncols=2, borderaxespad=0)
    axes[0][0].set_ylabel("growth of an undamped\nvibration per step")
    return figure


def place(value, low, high):
    """Where a limit is drawn: 0 and infinity stand at the edges."""
    if math.isnan(value):
        return math.nan
    return min(max(value, low), high)


def draw_limits(result, rows):
    problems = list(dict.fromkeys(row["problem"] for row in rows))
    methods = list(dict.fromkeys(row["method"] for row in rows))
    scaled = [row[name] * row["spectral_radius"] for row in rows for name in ("predicted_limit", "observed_limit")]
    finite = [value for value in scaled if math.isfinite(value) and value > 0]
    if not finite:
        return None
    low, high = min(finite) / 2.5, max(finite) * 2.5
    height = max(0.235 * len(methods), 1.6)
    figure, axes = new_figure(result, max(4.2 * len(problems) + 2.6, 10.5), height + 2.0, 1, len(problems), sharey=True)
    for panel, problem in zip(axes[0], problems):
        for row in (row for row in rows if row["problem"] == problem):
            level = methods.index(row["method"])
            radius = row["spectral_radius"]
            predicted, observed = row["predicted_limit"] * radius, row["observed_limit"] * radius
            by_growth = row["verdict"] == "holds" and math.isnan(observed)
            colour = ALARM if row["verdict"] == "fails" else PALETTE[1]
            panel.plot(place(predicted, low, high), level, marker="|", markersize=11, markeredgewidth=2.2,
                       color=PALETTE[0])
            panel.plot(place(observed, low, high), level, marker="o", markersize=5, color=colour,
                       markerfacecolor="none" if not 0 < observed < math.inf else colour)
            if by_growth:
                panel.annotate("growth as predicted", (place(predicted, low, high), level), fontsize=7.5, va="center",
                               xytext=(7, 0), textcoords="offset points", color=QUIET)
            if math.isnan(predicted) and math.isnan(observed):
                panel.annotate("not applicable", (low, level), fontsize=7.5, va="center", color=QUIET,
                               xytext=(4, 0), textcoords="offset points")
        panel.set_xscale("log")
        panel.set_xlim(low / 1.3, high * 1.3)
        ticks = [digit * 10.0 ** power for power in range(-4, 5) for digit in (1, 2, 5)]
        ticks = [tick for tick in ticks if low / 1.3 <= tick <= high * 1.3]
        ticks = ticks if len(ticks) <= 7 else [tick for tick in ticks if f"{tick:e}".startswith("1")]
        panel.set_xticks(ticks, [number(tick) for tick in ticks])
        panel.minorticks_off()
        panel.set_title(problem, loc="left")
        panel.set_xlabel("largest stable step  h |λ|max")
        ratios = [abs(row["ratio"] - 1) for row in rows if row["problem"] == problem
                  and math.isfinite(row["ratio"]) and row["verdict"] != "not applicable"]
        if ratios:
            panel.annotate(f"largest |observed/predicted − 1|: {100 * max(ratios):.2g} %", (1, 0),
                           xycoords="axes fraction", ha="right", va="bottom", fontsize=8.5, color=QUIET,
                           xytext=(-4, 4), textcoords="offset points",
                           bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5})
        panel.grid(axis="y", linewidth=0.4)
    axes[0][0].set_yticks(range(len(methods)), [short(method) for method in methods], fontsize=8.5)
    axes[0][0].set_ylim(len(methods) + 0.2, -1)
    explain(figure, result, "bar: predicted from the spectrum of J; dot: observed by bisection on runs\n"
            "ring at the left edge: unstable at every step; at the right edge: no limit")
    return figure


def draw_bands(panel, unlimited):
    """Above the lines the methods that have no limit, below those that are stable at no step."""
    low, high = panel.get_ylim()
    span = max(high / low, 10.0) ** 0.28
    for what, colour, at_top in (("no limit", INSIDE, True), ("unstable at every step", DIVERGES, False)):
        if not unlimited[what]:
            continue
        names = "\n".join(textwrap.wrap(", ".join(unlimited[what]), 44))
        edge, other = (high, high * span) if at_top else (low / span, low)
        panel.axhspan(edge, other, color=colour, alpha=0.55, linewidth=0, zorder=0)
        panel.annotate(f"{'↑ ' if at_top else ''}{what}: {names}", (0.5, numpy.sqrt(edge * other)),
                       xycoords=("axes fraction", "data"), ha="center", va="center", fontsize=11)
        low, high = min(low, edge), max(high, other)
    panel.set_ylim(low, high)
    if unlimited["not applicable"]:
        panel.annotate("not applicable: " + ", ".join(unlimited["not applicable"]), (0.98, 0.02), xycoords="axes fraction",
                       ha="right", va="bottom", fontsize=9.5, color=QUIET)


def draw_laws(result, rows):
    problems = list(dict.fromkeys(row["problem"] for row in rows))
    methods = list(dict.fromkeys(row["method"] for row in rows))
    figure, axes = new_figure(result, 6.6 * len(problems) + 3.4, 6.0, 1, len(problems))
    seen = {}
    for panel, problem in zip(axes[0], problems):
        lowest, mine = math.inf, [row for row in rows if row["problem"] == problem]
        unlimited = {"no limit": [], "unstable at every step": [], "not applicable": []}
        for row in mine:
            case = result.case_of(row)
            x = numpy.abs(result.values("parameter", case))
            predicted, observed = result.values("predicted_limit", case), result.values("observed_limit", case)
            style = look(methods.index(row["method"]))
            usable = numpy.isfinite(observed) & (observed > 0)
            known = numpy.isfinite(predicted) & (predicted > 0)
            if not known.any():
                unlimited["no limit" if numpy.isinf(predicted).all() else "unstable at every step" if (predicted == 0).all()
                          else "not applicable"].append(short(row["method"]))
                continue
            panel.plot(x[known], predicted[known], color=style["color"], linewidth=1.3)
            panel.plot(x[usable], observed[usable], linestyle="none", markersize=6.5, **style)
            seen[row["method"]] = style
            lowest = min(lowest, predicted[known].min())
        panel.set_xscale("log")
        panel.set_yscale("log")
        if math.isfinite(lowest):
            expected = next((row["expected_exponent"] for row in mine if math.isfinite(row["expected_exponent"])), None)
            if expected is not None:
                ends = numpy.array([x.min(), x.max()])
                line = 0.45 * lowest * (ends / ends[1]) ** expected
                panel.plot(ends, line, color=QUIET, linestyle=(0, (5, 3)), linewidth=1.2)
                panel.annotate(f"slope {number(expected)}", (ends[0], line[0]), color=QUIET, fontsize=10,
                               xytext=(0, -16), textcoords="offset points", va="top")
        parameter = result.case_of(mine[0])["parameter"].attrs["name"]
        panel.set_xlabel(parameter_label(text_of(parameter), (result.values("parameter", result.case_of(mine[0])) < 0).any()))
        panel.set_ylabel(label("largest stable step h", "s"))
        panel.set_title(problem, loc="left")
        draw_bands(panel, unlimited)
    handles = [Line2D([], [], markersize=6.5, linewidth=1.3, label=short(method), **style)
               for method, style in seen.items()]
    axes[0][-1].legend(handles=handles, loc="upper left", bbox_to_anchor=(1.02, 1), borderaxespad=0,
                       title="lines: predicted\nmarks: observed\n(no mark: shown by growth)", alignment="left", fontsize=9.5)
    return figure


def has_thresholds(result, row):
    return numpy.isfinite(result.values("monotone_observed", result.case_of(row))).any()


def draw_thresholds(result, rows):
    """The two thresholds of one scheme over k, and those of all schemes in units of 1/k."""
    rows = [row for row in rows
            if not numpy.isnan(result.values("observed_limit", result.case_of(row))).all()]
    shown = next((row for row in rows if has_thresholds(result, row)
                  and numpy.isfinite(result.values("predicted_limit", result.case_of(row))).all()), None)
    if shown is None:
        return None
    figure, axes = new_figure(result, 15, 5.6, 1, 2)
    left, right = axes[0]
    case = result.case_of(shown)
    k = result.values("spectral_radius", case)
    order = numpy.argsort(k)
    k = k[order]
    curves = {name: result.values(name, case)[order] for name in
              ("monotone_predicted", "monotone_observed", "predicted_limit", "observed_limit")}
    top = 8 * curves["predicted_limit"].max()
    left.fill_between(k, curves["monotone_predicted"], color=INSIDE, linewidth=0)
    left.fill_between(k, curves["monotone_predicted"], curves["predicted_limit"], color=OSCILLATES, linewidth=0)
    left.fill_between(k, curves["predicted_limit"], top, color=DIVERGES, linewidth=0)
    for name, colour, text in (("monotone", PALETTE[0], "oscillates above"), ("limit", PALETTE[1], "diverges above")):
        predicted = curves["monotone_predicted" if name == "monotone" else "predicted_limit"]
        observed = curves["monotone_observed" if name == "monotone" else "observed_limit"]
        factor = float(numpy.median(predicted * k))
        left.loglog(k, predicted, color=colour, linewidth=1.4, label=f"theory h = {number(round(factor, 5))}/k")
        left.loglog(k, observed, color=colour, linestyle="none", marker="o", label=f"found by bisection: {text}")
    middle = len(k) // 2
    for height, text in ((0.05, "decays monotonically"), (8.0, "diverges")):
        left.annotate(text, (k[middle], height / k[middle]), ha="center", va="center", fontsize=10.5)
    left.set_ylim(0.1 / k.max(), top)
    left.set_xlim(k.min(), k.max())
    left.set_xlabel(label("stiffness k", "1/s"))
    left.set_ylabel(label("step h", "s"))
    left.set_title(f"{short(shown['method'])} on ẋ = −k x", loc="left")
    left.legend(loc="upper right", fontsize=9.5)
    end = 3.2
    for height, row in enumerate(rows):
        case = result.case_of(row)
        k = result.values("spectral_radius", case)
        limit, monotone = result.values("observed_limit", case) * k, result.values("monotone_observed", case) * k
        for values, colour in ((limit, OSCILLATES), (numpy.minimum(monotone, limit), INSIDE)):
            if not numpy.isnan(values).all():
                right.barh(height, min(values.min(), end), height=0.6, color=colour)
        known = not numpy.isnan(monotone).all()
        if not known:
            right.barh(height, min(limit.min(), end), height=0.6, color="white", edgecolor=QUIET, linewidth=0.8)
        for values, colour in ((monotone, PALETTE[0]), (limit, PALETTE[1])):
            values = values[numpy.isfinite(values)]
            right.plot(values, numpy.full(values.size, height), linestyle="none", marker="o", markersize=4.5,
                       color=colour)
        if numpy.isinf(limit).all():
            right.annotate("→ no limit", (end, height), ha="right", va="center", fontsize=9.5,
                           xytext=(-4, 0), textcoords="offset points")
    right.set_yticks(range(len(rows)), [short(row["method"]) for row in rows])
    right.set_ylim(len(rows) - 0.4, -0.6)
    right.set_xlim(0, end)
    right.set_xlabel("h k, found for every k")
    right.set_title("in units of 1/k", loc="left")
    right.legend(handles=[Patch(color=INSIDE, label="decays monotonically"),
                          Patch(color=OSCILLATES, label="oscillates about 0, decays"),
                          Patch(facecolor="white", edgecolor=QUIET, label="stable, sign not predicted")],
                 loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=3, fontsize=9.5)
    return figure


def draw(result):
    figures = []
    regions, limits, laws = (rows_of(result, part) for part in ("region", "limit", "law"))
    if regions:
        figures += [draw_regions(result, regions), draw_order_stars(result, regions),
                    draw_imaginary_axis(result, regions)]
    if limits:
        figures.append(draw_limits(result, limits))
    thresholds = [row for row in laws if "monotone_observed" in result.case_of(row)
                  and not numpy.isnan(result.values("monotone_predicted", result.case_of(row))).all()]
    if thresholds:
        problem = thresholds[0]["problem"]
        figures.append(draw_thresholds(result, [row for row in laws if row["problem"] == problem]))
    if laws:
        figures.append(draw_laws(result, laws))
    return [figure for figure in figures if figure is not None]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("stability", draw)))
