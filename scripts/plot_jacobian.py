#!/usr/bin/env python3
"""Draws a study of derivatives: the error of differences over the increment (the V-curve), how wrong the printed
formulas are, the sparsity of tangent matrices, where implicit steps are definite and what Newton and conjugate
gradients make of it, and the energy that runs gain."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.colors import BoundaryNorm, ListedColormap, LogNorm, SymLogNorm
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import MaxNLocator
from plot_style import ALARM, EXACT, MARKERS, PALETTE, QUIET, cell_edges, new_figure, number

EPSILON = float(numpy.finfo(float).eps)
ORDERS = {"forward": 1, "central": 2}
PRINTED = {"printed_e1": "printed K$_{ii}$ (E1)", "printed_e2": "printed K$_{ij}$ = −K$_{ji}$ (E2)"}
MODELS = {"exact": "exact K", "tensile_geometric_term": "tensile geometric term", "psd_projection": "projection"}
SUBJECTS_PER_ROW = 3
ROUNDING = 1e-18   # drawn in place of a deviation that is exactly zero


def part(result, name):
    return [row for row in result.summary() if row["part"] == name]


def grouped(rows, key):
    groups = {}
    for row in rows:
        groups.setdefault(row[key], []).append(row)
    return groups


def grid(result, count, width, height, extra=0.0):
    """A figure with `count` panels in rows of at most three; unused ones are switched off."""
    columns = min(count, SUBJECTS_PER_ROW)
    lines = -(-count // columns)
    figure, axes = new_figure(result, width * max(columns, 2) if count == 1 else width * columns,
                              height * lines + 0.7 + extra, lines, columns)
    panels = axes.ravel()
    for panel in panels[count:]:
        panel.set_axis_off()
    return figure, panels[:count]


def draw_slope(panel, anchor, slope, width, text):
    """A dashed line of a slope beside a curve, from the point `anchor` over `width` decades."""
    x = numpy.array([anchor[0], anchor[0] * 10.0 ** width])
    y = anchor[1] * (x / anchor[0]) ** slope
    panel.loglog(x, y, linestyle=(0, (5, 3)), color=QUIET, linewidth=1.2)
    middle = (numpy.sqrt(x[0] * x[1]), numpy.sqrt(y[0] * y[1]))
    panel.annotate(text, middle, color=QUIET, fontsize=9.5, ha="right" if slope > 0 else "left",
                   va="bottom", xytext=(-5 if slope > 0 else 5, 1), textcoords="offset points")


def draw_differences(result):
    """Error over increment of one-sided and central differences, a panel per subject."""
    subjects = grouped([row for row in part(result, "derivative") if row["variant"] in ORDERS], "subject")
    if not subjects:
        return None
    exact = {row["subject"]: row["deviation"] for row in part(result, "derivative") if row["variant"] == "analytic"}
    figure, panels = grid(result, len(subjects), 5.4, 4.6)
    for panel, (subject, rows) in zip(panels, subjects.items()):
        for index, row in enumerate(sorted(rows, key=lambda row: ORDERS[row["variant"]])):
            case = result.case_of(row)
            increment, error = result.values("increment", case), result.values("deviation", case)
            order, shown = ORDERS[row["variant"]], error > 0
            panel.loglog(increment[shown], error[shown], color=PALETTE[index], marker=MARKERS[index], markersize=4,
                         linewidth=1.3, label=f"{row['variant']} difference")
            panel.axvline(EPSILON ** (1 / (order + 1)), color=PALETTE[index], linewidth=1.0, linestyle=":")
            if numpy.isfinite(row["truncation_slope"]):
                start = 10 ** 1.3 * row["best_increment"]
                level = numpy.interp(numpy.log(start), numpy.log(increment[::-1]), numpy.log(error[::-1]))
                draw_slope(panel, (start, 3 * numpy.exp(level)), order, 2.0 / order + 0.5, f"slope {order}")
            if order == 1 and numpy.isfinite(row["rounding_slope"]):
                start = 1e-13
                level = numpy.interp(numpy.log(start), numpy.log(increment[::-1]), numpy.log(error[::-1]))
                draw_slope(panel, (start, 3 * numpy.exp(level)), -1, 2.5, "slope −1")
        if subject in exact:
            panel.axhline(max(exact[subject], ROUNDING), color=EXACT, linewidth=1.3)
            panel.annotate("analytic", (1, max(exact[subject], ROUNDING)), xycoords=("axes fraction", "data"),
                           ha="right", va="bottom", fontsize=10, xytext=(-3, 2), textcoords="offset points")
        panel.set_title(subject, loc="left")
        panel.set_xlabel("increment h [typical length]")
        panel.set_ylabel("relative error of K")
    panels[0].legend(loc="lower left", fontsize=9.5, title="dotted: √ε, ∛ε", title_fontsize=9.5, alignment="left",
                     bbox_to_anchor=(0.0, 0.06))
    return figure


def draw_printed(result):
    """The relative deviation of each sample, sorted, of the analytic and the printed formulas."""
    subjects = {row["subject"] for row in part(result, "derivative") if row["variant"] in PRINTED}
    rows = [row for row in part(result, "derivative")
            if row["subject"] in subjects and (row["variant"] in PRINTED or row["variant"] == "analytic")]
    if not rows:
        return None
    figure, axes = new_figure(result, 12.5, 5.4, 1, 2, gridspec_kw={"width_ratios": [1.15, 1]})
    left, right = axes[0]
    for index, row in enumerate(sorted(rows, key=lambda row: row["variant"])):
        case = result.case_of(row)
        values = numpy.maximum(numpy.sort(result.values("deviation", case)), ROUNDING)
        name = PRINTED.get(row["variant"], "correct K")
        left.semilogy((numpy.arange(values.size) + 0.5) / values.size, values, color=PALETTE[index])
        # Labels stand where the curves lie apart.
        x, above = {"printed_e1": (0.02, False), "printed_e2": (0.02, True)}.get(row["variant"], (0.5, True))
        level = values[int(x * (values.size - 1))]
        left.annotate(name, (x, level), color=PALETTE[index], va="bottom" if above else "top",
                      xytext=(0, 7 if above else -7), textcoords="offset points")
        if row["variant"] in PRINTED:
            right.loglog(result.values("predicted_difference", case), result.values("block_difference", case),
                         linestyle="none", marker=MARKERS[index], markersize=4.5, markerfacecolor="none",
                         color=PALETTE[index])
    bounds = numpy.array(right.get_xlim())
    right.loglog(bounds, bounds, color=QUIET, linewidth=1.1, zorder=0)
    right.annotate("measured = predicted", (bounds[1], bounds[1]), color=QUIET, ha="right", va="top", fontsize=10,
                   rotation=0, xytext=(-60, -6), textcoords="offset points")
    left.set_ylim(top=30)
    left.set_xlabel("share of the random springs")
    left.set_ylabel("largest deviation from complex steps / largest entry")
    right.set_xlabel("predicted: 3 k l₀/L (E1), 2 k max(1, |1 − l₀/L|) (E2) [N/m]")
    right.set_ylabel("measured ‖ΔK‖₂ of the wrong block [N/m]")
    return figure


def draw_patterns(result):
    """Blocks of the tangent matrices, coloured by their largest entry."""
    rows = [row for row in part(result, "pattern") if row["filled"] < 0.9]  # full matrices have no pattern
    if not rows:
        return None
    figure, panels = grid(result, len(rows), 5.6, 4.8)
    for panel, row in zip(panels, rows):
        case = result.case_of(row)
        block_row, block_column = (result.values(name, case) for name in ("block_row", "block_column"))
        largest = result.values("largest_entry", case)
        blocks = int(max(block_row.max(), block_column.max())) + 1
        image = numpy.full((blocks, blocks), numpy.nan)
        image[block_row, block_column] = numpy.where(largest > 0, largest, numpy.nan)
        empty = numpy.full((blocks, blocks), numpy.nan)
        empty[block_row[largest == 0], block_column[largest == 0]] = 1
        panel.imshow(empty, cmap=ListedColormap(["#DDDDDD"]))
        finite = image[numpy.isfinite(image)]
        shown = panel.imshow(image, cmap="viridis", norm=LogNorm(finite.min(), max(finite.max(), 1.01 * finite.min())))
        figure.colorbar(shown, ax=panel, shrink=0.8, label=f"largest entry [{'N/m' if '3x3' in row['variant'] else 'SI'}]")
        panel.set_title(f"{row['subject']}: {100 * row['filled']:.0f} % of the entries", loc="left", fontsize=12)
        panel.set_xlabel("block column" if "3x3" in row["variant"] else "column")
        panel.set_ylabel("block row" if "3x3" in row["variant"] else "row")
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_locator(MaxNLocator(integer=True))
        panel.grid(False)
    figure.suptitle(f"{result.title}\nBlocks of K; grey: zero (fixed particles, or filled in D only)")
    return figure


def map_axes(result, case):
    step, compression = result.values("step", case), result.values("compression", case)
    return numpy.exp(cell_edges(numpy.log(step), 0.4)), cell_edges(compression, 0.05)


def draw_limits(result, panel, case):
    """The predicted limit as a line, the measured one as points."""
    compression = result.values("compression", case)
    predicted, found = result.values("predicted_limit_step", case), result.values("limit_step", case)
    panel.plot(predicted, compression, color=EXACT, linewidth=1.6, label="predicted: 1/μ")
    panel.plot(found, compression, linestyle="none", marker="o", markersize=4.5, markerfacecolor="white", color=EXACT,
               label="measured")


def set_map_axes(panel, first):
    panel.set_xscale("log")
    panel.set_xlabel("step h [s]")
    if first:
        panel.set_ylabel("compression")
    panel.grid(False)


def draw_definiteness(result):
    """λ_min(A) over compression and step: a row per problem, a panel per tangent model."""
    subjects = grouped(part(result, "definiteness"), "subject")
    if not subjects:
        return None
    models = [model for model in MODELS if any(row["variant"] == model for row in part(result, "definiteness"))]
    figure, axes = new_figure(result, 4.9 * len(models) + 0.8, 3.6 * len(subjects) + 0.8, len(subjects), len(models),
                              sharex=True, sharey=True)
    for line, (subject, rows) in zip(axes, subjects.items()):
        for panel in line:
            panel.set_axis_off()
        scale = max(numpy.abs(result.values("eigenvalue", result.case_of(row))[:, 0]).max() for row in rows)
        for row in rows:
            panel = line[models.index(row["variant"])]
            panel.set_axis_on()
            case = result.case_of(row)
            steps, compressions = map_axes(result, case)
            image = panel.pcolormesh(steps, compressions, result.values("eigenvalue", case), cmap="RdBu", rasterized=True,
                                     norm=SymLogNorm(scale, vmin=-1e3 * scale, vmax=1e3 * scale))
            draw_limits(result, panel, case)
            set_map_axes(panel, models.index(row["variant"]) == 0)
            panel.set_xlim(steps[0], steps[-1])
            panel.set_title(f"{subject}: {MODELS[row['variant']]}", loc="left", fontsize=12)
        unit = 10.0 ** numpy.round(numpy.log10(scale))
        ticks = [-100 * unit, -10 * unit, -unit, 0, unit, 10 * unit, 100 * unit]
        bar = figure.colorbar(image, ax=list(line), label="λ$_{min}$(A) [kg]", shrink=0.9, aspect=14, ticks=ticks)
        bar.ax.set_yticklabels([number(tick).replace("-", "−") for tick in ticks])
        bar.ax.minorticks_off()
    axes[0][0].legend(loc="upper left", fontsize=9.5, frameon=True, framealpha=0.9)
    return figure


def hatch_cells(panel, x, y, chosen):
    """Hatches cells: red alone looks like a step of the colour bar to the colour-blind."""
    for row, column in zip(*numpy.nonzero(chosen)):
        panel.add_patch(Rectangle((x[column], y[row]), x[column + 1] - x[column], y[row + 1] - y[row], fill=False,
                                  edgecolor="white", linewidth=0, hatch="////", zorder=1.5))


def draw_iterations(result, subject, rows):
    """What Newton and conjugate gradients make of it: iterations, and where they fail."""
    quantities = {"newton_iterations": "Newton, LU", "newton_cg_iterations": "Newton, CG", "cg_iterations": "CG, one system"}
    rows = sorted(rows, key=lambda row: list(MODELS).index(row["variant"]))
    figure, axes = new_figure(result, 4.6 * len(quantities) + 0.8, 2.9 * len(rows) + 1.1, len(rows), len(quantities),
                              sharex=True, sharey=True)
    for column, (quantity, title) in enumerate(quantities.items()):
        values = [result.values(quantity, result.case_of(row)) for row in rows]
        largest = max(2, max(value.max() for value in values))
        bounds = numpy.unique(numpy.round(numpy.geomspace(1, largest + 1, 9)).astype(int))
        bounds = numpy.concatenate([[0], bounds])
        for panel, row, value in zip(axes[:, column], rows, values):
            case = result.case_of(row)
            steps, compressions = map_axes(result, case)
            panel.pcolormesh(steps, compressions, numpy.where(value < 0, 1.0, numpy.nan), cmap=ListedColormap([ALARM]),
                             rasterized=True)
            hatch_cells(panel, steps, compressions, value < 0)
            image = panel.pcolormesh(steps, compressions, numpy.ma.masked_less(value, 0), cmap="viridis", rasterized=True,
                                     norm=BoundaryNorm(bounds, 256))
            draw_limits(result, panel, case)
            set_map_axes(panel, column == 0)
            panel.set_xlim(steps[0], steps[-1])
            panel.set_title(f"{title}: {MODELS[row['variant']]}", loc="left", fontsize=11)
        figure.colorbar(image, ax=list(axes[:, column]), label="iterations", shrink=0.7, aspect=25)
    figure.suptitle(f"{result.title}\n{subject}: iterations of one implicit step")
    axes[0][0].legend(handles=[Patch(facecolor=ALARM, edgecolor="white", hatch="////", label="fails")] + axes[0][0].get_legend_handles_labels()[0],
                      loc="upper left", fontsize=9, frameon=True, framealpha=0.9)
    return figure


def short(call):
    """"implicit_euler_linearised[tangent=psd_projection]" as "linearised, psd_projection"."""
    name, _, options = call.partition("[")
    name = {"implicit_euler_linearised": "linearised", "implicit_euler": "Newton to convergence"}.get(name, name)
    chosen = [option.split("=", 1)[1] for option in options.rstrip("]").split(",") if "=" in option]
    default = ["cg"] if name == "linearised" and not chosen else []
    return ", ".join([name] + (chosen or default))


def limit_at(result, subject, compression):
    """The step from which A with the exact K is indefinite at the start, where the study has looked at it."""
    for row in part(result, "definiteness"):
        case = result.case_of(row)
        here = numpy.flatnonzero(result.values("compression", case) == compression)
        if (row["subject"], row["variant"]) == (subject, "exact") and here.size:
            return result.values("limit_step", case)[here[0]]
    return numpy.nan


def draw_runs(result):
    """The largest energy gain over the step: a row per problem, a panel per compression."""
    rows = part(result, "runs")
    if not rows:
        return None
    subjects = grouped(rows, "subject")
    compressions = sorted({row["compression"] for row in rows})
    methods = list(dict.fromkeys(row["variant"] for row in rows))
    figure, axes = new_figure(result, 5.2 * len(compressions) + 3.6, 4.0 * len(subjects) + 0.8, len(subjects),
                              len(compressions), sharex=True)
    floor = 1e-9
    for line, (subject, members) in zip(axes, subjects.items()):
        for panel, compression in zip(line, compressions):
            for row in (row for row in members if row["compression"] == compression):
                index = methods.index(row["variant"])
                case = result.case_of(row)
                step, gain = result.values("step", case), result.values("energy_gain", case)
                ended = numpy.array([status == "success" for status in result.values("status", case)])
                # Hollow and of falling size: series that agree show through each other.
                style = {"color": PALETTE[index], "marker": MARKERS[index], "markersize": 10 - 1.5 * index,
                         "markerfacecolor": "none"}
                panel.loglog(step[ended], numpy.maximum(gain[ended], floor), linewidth=1.2, label=short(row["variant"]), **style)
                panel.loglog(step[~ended], numpy.maximum(gain[~ended], floor), linestyle="none", marker="x",
                             markersize=7, markeredgewidth=1.8, color=PALETTE[index], label=None)
            limit = limit_at(result, subject, compression)
            if numpy.isfinite(limit):
                panel.axvline(limit, color=EXACT, linewidth=1.2, linestyle=":")
                panel.annotate("A singular at first", (limit, 1), xycoords=("data", "axes fraction"), rotation=90, va="top",
                               ha="right", fontsize=9.5, xytext=(-3, -4), textcoords="offset points")
            panel.set_title(f"{subject}, compressed to {compression:g}", loc="left", fontsize=12)
            panel.set_xlabel("step h [s]")
            panel.axhline(1.0, color=QUIET, linewidth=1.0)
        line[0].set_ylabel("largest energy gain / energy at the start")
    axes[0][-1].plot([], [], linestyle="none", marker="x", markersize=7, markeredgewidth=1.8, color=QUIET,
                     label="stopped: matrix indefinite\nor no convergence")
    axes[0][-1].legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), title="≤ 10⁻⁹: none", title_fontsize=10,
                       alignment="left")
    return figure


def draw(result):
    figures = [draw_differences(result), draw_printed(result), draw_patterns(result), draw_definiteness(result)]
    for subject, rows in grouped(part(result, "definiteness"), "subject").items():
        figures.append(draw_iterations(result, subject, rows))
    figures.append(draw_runs(result))
    return [figure for figure in figures if figure is not None]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("jacobian", draw)))
