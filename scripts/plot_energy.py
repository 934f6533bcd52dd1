#!/usr/bin/env python3
"""Draws a study of energy: its change over long runs, drift and oscillation over the step, growth against theory,
momenta and the balance of damped systems."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from plot_style import EXACT, PALETTE, QUIET, label, look, new_figure, number


def read(result):
    """The cases by problem."""
    problems = {}
    for row in result.summary():
        problems.setdefault(row["problem"], []).append((row, result.case_of(row)))
    return problems


def values(result, case, name):
    return numpy.atleast_1d(numpy.asarray(result.values(name, case), float))


def explodes(result, case):
    """Of each run, whether its energy has grown beyond a thousandfold: drift and oscillation then say nothing."""
    scale, start = values(result, case, "energy_scale"), numpy.abs(values(result, case, "energy_start"))
    return scale > 1e3 * numpy.where(start > 0, start, scale)


def draw_change(result, problem, members):
    """A panel per method: the relative change of the energy in bins, one colour per step."""
    columns = min(3, len(members))
    rows = -(-len(members) // columns)
    figure, axes = new_figure(result, 5.4 * columns, 3.3 * rows + 0.9, rows, columns)
    for panel in axes.flat[len(members):]:
        panel.remove()
    for index, (panel, (row, case)) in enumerate(zip(axes.flat, members)):
        steps, scale = values(result, case, "step"), values(result, case, "energy_scale")
        start = numpy.abs(values(result, case, "energy_start"))
        time = values(result, case, "bin_time").reshape(steps.size, -1)
        bins = {name: values(result, case, f"change_{name}").reshape(steps.size, -1)
                for name in ("least", "mean", "largest")}
        size = numpy.where(start > 1e-6 * scale, start, scale)[:, None]
        grows = numpy.nanmax(bins["largest"] / size) > 3
        for k, step in enumerate(steps):
            colour = PALETTE[k % (len(PALETTE) - 1)]
            low, mean, high = (bins[name][k] / size[k] for name in ("least", "mean", "largest"))
            if grows:
                low, mean, high = low + 1, mean + 1, high + 1
            panel.fill_between(time[k], low, high, color=colour, alpha=0.3, linewidth=0)
            panel.plot(time[k], mean, color=colour, linewidth=1.3, label=f"h = {number(step)} s")
        if grows:
            panel.set_yscale("log")
        quantity = case["energy_start"].attrs.get("quantity", "energy")
        if quantity == "energy":
            panel.set_ylabel("E / E₀" if grows else "(E − E₀) / E₀")
        else:
            name = quantity.replace("_", " ")
            panel.set_ylabel(f"{name} / start" if grows else f"change of {name} / start", fontsize=10)
        if index + columns >= len(members):
            panel.set_xlabel(label("time t", result.unit("bin_time", case)))
        panel.set_title(row["method"], loc="left", fontsize=11)
        if index == columns - 1 or len(members) == 1:
            panel.legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0)
    figure.suptitle(f"{result.title}: {problem}")
    return figure


def line_over_steps(panel, steps, magnitudes, index, text):
    good = numpy.isfinite(magnitudes) & (magnitudes > 0)
    if good.any():
        panel.loglog(steps[good], magnitudes[good], linewidth=1.4, label=text, **look(index))


def reference_slopes(panel, steps, powers):
    """Dashed lines h^p through the middle of the picture."""
    low, high = panel.get_ylim()
    for power in powers:
        anchor = numpy.sqrt(low * high)
        middle = numpy.sqrt(steps.min() * steps.max())
        line = anchor * (steps / middle) ** power
        panel.loglog(steps, line, linestyle=(0, (5, 3)), color=QUIET, linewidth=1.0)
        panel.annotate(f"h$^{power}$", (steps.max(), anchor * (steps.max() / middle) ** power), color=QUIET, fontsize=10,
                       xytext=(4, 0), textcoords="offset points")
    panel.set_ylim(low, high)


def draw_laws(result, problem, members):
    """Drift and oscillation, or the balance with the dampers' work, over the step."""
    if max(case["step"].shape[0] for _, case in members) < 2:
        return None
    damped = any("balance" in case for _, case in members)
    figure, axes = new_figure(result, 14.5, 5.6, 1, 3, gridspec_kw={"width_ratios": [1, 1, 0.6]})
    left, right, side = axes[0]
    every = numpy.unique(numpy.concatenate([values(result, case, "step") for _, case in members]))
    for index, (row, case) in enumerate(members):
        steps, scale = values(result, case, "step"), values(result, case, "energy_scale")
        if damped:
            balance = values(result, case, "balance").reshape(steps.size, -1)
            work = values(result, case, "work").reshape(steps.size, -1)
            last = [numpy.flatnonzero(numpy.isfinite(line))[-1:] for line in balance]
            ends = numpy.array([line[at[0]] if at.size else numpy.nan for line, at in zip(balance, last)])
            line_over_steps(left, steps, numpy.abs(ends) / scale, index, row["method"])
            time = values(result, case, "bin_time").reshape(steps.size, -1)
            right.semilogy(time[-1], numpy.abs(balance[-1]) / scale[-1], linewidth=1.2,
                           markevery=max(1, time.shape[1] // 8), **look(index))
            del work
        else:
            kept = ~explodes(result, case)
            duration = values(result, case, "end_time")
            drift = numpy.abs(values(result, case, "drift")) * duration / scale
            interval = numpy.maximum(numpy.abs(values(result, case, "drift_low")),
                                     numpy.abs(values(result, case, "drift_high"))) * duration / scale
            clear = values(result, case, "drift_low") * values(result, case, "drift_high") > 0
            colour = look(index)["color"]
            clear &= kept
            good = numpy.isfinite(interval) & (interval > 0) & kept
            line_over_steps(left, steps[clear], drift[clear], index, row["method"])
            left.loglog(steps[good & ~clear], interval[good & ~clear], linestyle="none", marker=look(index)["marker"],
                        markerfacecolor="none", color=colour)
            line_over_steps(right, steps[kept], values(result, case, "oscillation")[kept] / scale[kept], index,
                            row["method"])
    if damped:
        left.set_title("energy lost − work of the dampers, at the end", loc="left", fontsize=11.5)
        right.set_title("the same along the run with the finest step", loc="left", fontsize=11.5)
        left.set_ylabel("|E − E₀ + ∫P dt| / E")
        right.set_xlabel("time t [s]")
    else:
        left.set_title("drift over the run (open: within its interval of zero)", loc="left", fontsize=11.5)
        right.set_title("oscillation (without runs that explode)", loc="left", fontsize=11.5)
        left.set_ylabel("|drift| · duration / E")
        right.set_ylabel("amplitude / E")
        right.set_xlabel("step h [s]")
        reference_slopes(right, every, (1, 2))
    left.set_xlabel("step h [s]")
    reference_slopes(left, every, (1, 2, 4) if damped else (1, 5))
    for panel in (left,) if damped else (left, right):
        panel.set_xticks(every, [number(step) for step in every])
        panel.minorticks_off()
    side.set_axis_off()
    handles = [plot_style.plt.Line2D([], [], linewidth=1.4, label=row["method"], **look(index))
               for index, (row, _) in enumerate(members)]
    side.legend(handles=handles, loc="upper left", borderaxespad=0)
    figure.suptitle(f"{result.title}: {problem}")
    return figure


def draw_growth(result, problem, members):
    """Growth of the amplitude per step, measured and predicted."""
    shown = [(row, case) for row, case in members if numpy.isfinite(values(result, case, "predicted_growth")).any()]
    if not shown:
        return None
    figure, axes = new_figure(result, 11.5, 5.6, 1, 2, gridspec_kw={"width_ratios": [1, 0.5]})
    panel, side = axes[0]
    handles = []
    for index, (row, case) in enumerate(shown):
        steps = values(result, case, "step")
        growth, predicted = values(result, case, "growth"), values(result, case, "predicted_growth")
        style = look(index)
        for sign, line in ((1, "-"), (-1, (0, (4, 2)))):
            part = numpy.where(sign * predicted > 1e-14, numpy.abs(predicted), numpy.nan)
            panel.loglog(steps, part, color=style["color"], linestyle=line, linewidth=1.3)
        part = numpy.where(numpy.abs(predicted) > 1e-14, numpy.abs(growth), numpy.nan)
        panel.loglog(steps, part, linestyle="none", **style)
        none = not (numpy.abs(predicted) > 1e-14).any()
        handles.append(plot_style.plt.Line2D([], [], label=row["method"] + (": none" if none else ""), **style))
    handles += [plot_style.plt.Line2D([], [], color=QUIET, label="theory: grows"),
                plot_style.plt.Line2D([], [], color=QUIET, linestyle=(0, (4, 2)), label="theory: decays")]
    panel.set_xlabel("step h [s]")
    panel.set_ylabel("|growth of the amplitude per step|")
    panel.set_title("measured (markers) and ln|λ| of theory (lines)", loc="left")
    side.set_axis_off()
    side.legend(handles=handles, loc="upper left", borderaxespad=0)
    figure.suptitle(f"{result.title}: {problem}")
    return figure


def draw_rounding(result, problem, members):
    """What has to be constant to rounding: modified energy, momenta."""
    kinds = (("modified_largest", "modified energy", "energy_scale"), ("momentum_change", "linear momentum", None),
             ("angular_momentum_change", "angular momentum", None))
    present = [kind for kind in kinds if any(kind[0] in case for _, case in members)]
    if not present:
        return None
    figure, axes = new_figure(result, 6.2 * len(present) + 2.6, 5.2, 1, len(present) + 1,
                              gridspec_kw={"width_ratios": [1] * len(present) + [0.5]})
    for panel, (name, title, scale_name) in zip(axes[0], present):
        lowest, highest = numpy.inf, 0.0  # of the runs that do not explode; the others leave the picture
        for index, (row, case) in enumerate(members):
            if name not in case:
                continue
            steps = values(result, case, "step")
            time = values(result, case, "bin_time").reshape(steps.size, -1)[0]
            change = values(result, case, name).reshape(steps.size, -1)[0]
            if name == "modified_largest":
                change = numpy.fmax(numpy.abs(change),
                                    numpy.abs(values(result, case, "modified_least").reshape(steps.size, -1)[0]))
                change = change / values(result, case, scale_name)[0]
            good = change > 0
            if good.any() and not explodes(result, case)[0]:
                lowest, highest = min(lowest, change[good].min()), max(highest, change[good].max())
            panel.loglog(time[good], change[good], linewidth=1.2, markevery=max(1, good.sum() // 8), **look(index))
        low, high = panel.get_ylim()
        if highest > 0:
            low, high = max(low, lowest / 10), min(high, 1e3 * highest)
            panel.set_ylim(low, high)
        time = time[time > 0]
        if time.size:  # else the run stopped at its first step
            walk = numpy.sqrt(low * high) * numpy.sqrt(time / numpy.sqrt(time[0] * time[-1]))
            panel.loglog(time, walk, linestyle=(0, (5, 3)), color=QUIET, linewidth=1.0)
            panel.annotate("√t", (time[-1], walk[-1]), color=QUIET, xytext=(4, 0), textcoords="offset points")
        panel.set_title(f"change of {title}", loc="left")
        panel.set_xlabel(label("time t", "s"))
        panel.set_ylabel("relative to the energy" if scale_name else label("change", result.unit(name, case)))
    axes[0][-1].set_axis_off()
    handles = [plot_style.plt.Line2D([], [], linewidth=1.2, label=f"{row['method']}, h = {number(row['step'])} s",
                                     **look(index))
               for index, (row, case) in enumerate(members) if any(kind[0] in case for kind in present)]
    axes[0][-1].legend(handles=handles, loc="upper left", borderaxespad=0)
    figure.suptitle(f"{result.title}: {problem}")
    return figure


def draw(result):
    figures = []
    for problem, members in read(result).items():
        for make in (draw_change, draw_growth, draw_laws, draw_rounding):
            figure = make(result, problem, members)
            if figure is not None:
                figures.append(figure)
    return figures


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("energy", draw)))
