#!/usr/bin/env python3
"""Draws a study of energy: its change over long runs, drift and oscillation over the step, growth against theory,
momenta and the balance of damped systems."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from plot_style import QUIET, label, look, new_figure, number, power_of_ten, shade
from result_file import text


def read(result):
    """The cases by problem."""
    problems = {}
    for row in result.summary():
        problems.setdefault(row["problem"], []).append((row, result.case_of(row)))
    return problems


def values(result, case, name):
    return numpy.atleast_1d(numpy.asarray(result.values(name, case), float))


GONE = 0.2     # of the size: beyond this change no rate of drift describes a run
GROWN = 3.0    # times the start: beyond, factors on a logarithmic axis are drawn
CUT = 1e20     # times the start: an explosion is cut here


def bins_of(result, case):
    """Time and change of the energy in bins, (runs, bins) each."""
    count = values(result, case, "step").size
    names = {"time": "bin_time", "least": "change_least", "mean": "change_mean", "largest": "change_largest"}
    return {short: values(result, case, name).reshape(count, -1) for short, name in names.items()}


def unit_of_change(result, case):
    """What changes are divided by, the same for all runs since all start with the same energy, and whether it is E₀: that
    is so unless E₀ is next to nothing beside the size that the energy has in a run that does not explode (its zero is
    arbitrary); then it is that size."""
    start, scale = abs(values(result, case, "energy_start")[0]), values(result, case, "energy_scale")
    largest = bins_of(result, case)["largest"]
    gain = numpy.max(numpy.nan_to_num(largest, nan=0.0, posinf=numpy.inf), axis=1)
    calm = scale[numpy.isfinite(scale) & (scale > 0) & (gain < 0.9 * scale)]
    if calm.size and start <= 1e-3 * calm.min():
        return calm.min(), False
    if start == 0.0:  # every run explodes
        early = numpy.abs(largest[:, 0])
        return numpy.nanmin(early[early > 0], initial=numpy.inf) if (early > 0).any() else 1.0, False
    return start, True


def last_known(line):
    """The last finite entry, NaN where there is none."""
    known = line[numpy.isfinite(line)]
    return known[-1] if known.size else numpy.nan


def has_no_drift(result, case):
    """Of each run, whether its energy has grown beyond a thousandfold or has changed by more than a fifth at the end:
    drift and oscillation then say nothing."""
    size, _ = unit_of_change(result, case)
    bins = bins_of(result, case)
    largest = numpy.nanmax(numpy.abs(numpy.nan_to_num(bins["largest"], posinf=numpy.inf)), axis=1)
    end = numpy.array([last_known(line) for line in bins["mean"]])
    return (largest > 1e3 * size) | ~(numpy.abs(end) <= GONE * size)


class Change:
    """The curves of one panel: the change of the energy of a method's runs, in units of the start."""

    def __init__(self, result, row, case):
        self.row, self.steps = row, values(result, case, "step")
        size, self.of_start = unit_of_change(result, case)
        bins = bins_of(result, case)
        self.time = bins["time"]
        self.curves = {name: bins[name] / size for name in ("least", "mean", "largest")}
        self.sign = numpy.sign(values(result, case, "energy_start")[0])
        self.largest = numpy.nanmax(numpy.abs(self.curves["mean"]), initial=0.0)
        self.grows = self.largest > GROWN
        self.is_factor = self.grows and self.of_start and self.sign > 0
        if self.is_factor:
            self.curves = {name: 1 + curve for name, curve in self.curves.items()}
        elif self.grows:
            low, mean, high = (numpy.abs(self.curves[name]) for name in ("least", "mean", "largest"))
            self.curves = {"least": numpy.fmin(low, high), "mean": mean, "largest": numpy.fmax(low, high)}
        self.quantity = text(case["energy_start"].attrs.get("quantity", "energy")).replace("_", " ")

    def end(self):
        """The time up to which runs are compared that grow or lose much: where the first of those ends that do not
        explode, else where the last one does. The whole time where there would be nothing to compare by then."""
        whole = numpy.nanmax(self.time, initial=0.0)
        if self.largest <= GONE:
            return whole
        ends, explosions = [], []
        for time, mean in zip(self.time, self.curves["mean"]):
            known = numpy.isfinite(time) & numpy.isfinite(mean)
            beyond = known & (numpy.abs(mean) > CUT)
            (explosions if beyond.any() else ends).append(time[beyond][0] if beyond.any() else time[known].max(initial=0.0))
        end = min(ends) if ends else max(explosions)
        by_then = numpy.where(self.time <= end, self.curves["mean"] - self.is_factor, numpy.nan)
        return end if numpy.nanmax(numpy.abs(by_then), initial=0.0) > 0.25 * GONE else whole

    def label(self):
        what = "E" if self.quantity == "energy" else self.quantity
        if self.is_factor:
            return "E / E₀" if what == "E" else f"{what} / start"
        change = "E − E₀" if what == "E" else f"change of {what}"
        change = f"|{change}|" if self.grows else f"({change})" if what == "E" else change
        return f"{change} / " + (("E₀" if self.sign > 0 else "|E₀|") if what == "E" else "start") if self.of_start \
            else f"{change} / its size"


def draw_change(result, problem, members):
    """A panel per method, a colour per step: the change of the energy over its start. Where it grows, on a logarithmic
    axis; these panels have the same axes, over the time that all runs reach, so that steps can be compared."""
    changes = [Change(result, row, case) for row, case in members]
    columns = min(3, len(members))
    rows = -(-len(members) // columns)
    figure, axes = new_figure(result, 5.0 * columns + (1.6 if columns > 1 else 2.4), 3.3 * rows + 0.9, rows, columns)
    for panel in axes.flat[len(members):]:
        panel.remove()
    for index, (panel, change) in enumerate(zip(axes.flat, changes)):
        end = change.end()
        for k, step in enumerate(change.steps):
            colour = shade(k, change.steps.size)
            low, mean, high = (change.curves[name][k] for name in ("least", "mean", "largest"))
            if change.largest <= GONE:  # else the width would be the change within a bin
                panel.fill_between(change.time[k], low, high, color=colour, alpha=0.3, linewidth=0)
            start = ([0.0], [1.0]) if change.is_factor else ([], []) if change.grows else ([0.0], [0.0])
            panel.plot(numpy.append(start[0], change.time[k]), numpy.append(start[1], mean), color=colour, linewidth=1.5,
                       label=f"h = {number(step)} s")
        if change.grows:
            panel.set_yscale("log")
        if end > 0:
            panel.set_xlim(0, end)
        fit_limits(panel, end)
        panel.set_ylabel(change.label())
        if index + columns >= len(members):
            panel.set_xlabel(label("time t", result.unit("bin_time", members[index][1])))
        panel.set_title(change.row["method"], loc="left", fontsize=11)
        power_of_ten(panel)
    axes[0, columns - 1].legend(loc="upper left", bbox_to_anchor=(1.01, 1.0), borderaxespad=0)
    figure.suptitle(f"{result.title}: {problem.replace('_', ' ')}")
    return figure


def fit_limits(panel, end):
    """The vertical axis from what is drawn up to the time `end`; factors at most up to CUT."""
    drawn = [numpy.zeros(0)]
    for line in panel.lines:
        time, curve = numpy.asarray(line.get_xdata(), float), numpy.asarray(line.get_ydata(), float)
        drawn.append(curve[(time <= end) & numpy.isfinite(curve)])
    for band in panel.collections:
        vertices = numpy.concatenate([path.vertices for path in band.get_paths()] or [numpy.zeros((0, 2))])
        drawn.append(vertices[(vertices[:, 0] <= end) & numpy.isfinite(vertices[:, 1]), 1])
    drawn = numpy.concatenate(drawn)
    if panel.get_yscale() == "log":
        drawn = drawn[drawn > 0]
        if drawn.size:
            high = min(drawn.max(), CUT)
            panel.set_ylim(max(drawn.min(), min(1e-3, 1e-6 * high)) / 1.5, 3 * high)
    elif drawn.size and drawn.min() < drawn.max():
        room = 0.05 * (drawn.max() - drawn.min())
        panel.set_ylim(drawn.min() - room, drawn.max() + room)


def line_over_steps(panel, steps, magnitudes, index, text):
    good = numpy.isfinite(magnitudes) & (magnitudes > 0)
    if good.any():
        panel.loglog(steps[good], magnitudes[good], linewidth=1.4, label=text, **look(index))


def reference_slopes(panel, powers):
    """A dashed line h^p below the lowest curve that has about that slope; none where no curve has it."""
    curves = [(numpy.asarray(line.get_xdata(), float), numpy.asarray(line.get_ydata(), float)) for line in panel.lines
              if len(line.get_xdata()) > 1 and line.get_linestyle() not in ("None", "none")]
    limits = panel.get_ylim()
    for power in powers:
        close = [(steps, values) for steps, values in curves
                 if abs(numpy.polyfit(numpy.log(steps), numpy.log(values), 1)[0] - power) < 0.35]
        if not close:
            continue
        steps, values = min(close, key=lambda curve: curve[1].max())
        ends = numpy.array([steps.min(), steps.max()])
        line = 0.3 * values[steps.argmax()] * (ends / ends[1]) ** power
        panel.loglog(ends, line, linestyle=(0, (5, 3)), color=QUIET, linewidth=1.0)
        panel.annotate(f"h$^{power}$", (ends[1], line[1]), color=QUIET, fontsize=10, xytext=(4, -4),
                       textcoords="offset points")
    if curves:
        panel.set_ylim(limits[0] / 3, limits[1])


def step_ticks(panel, steps):
    """Ticks at the steps, without those that would touch the label before them."""
    kept, room = [], 0.07 * numpy.log(steps.max() / steps.min())
    for step in sorted(steps, reverse=True):
        if not kept or numpy.log(kept[-1] / step) > max(room, 0.05) * len(number(step)) / 3:
            kept.append(step)
    panel.set_xticks(kept, [number(step) for step in kept])
    panel.minorticks_off()


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
            kept = ~has_no_drift(result, case)
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
        right.set_title("oscillation (without runs that explode or decay)", loc="left", fontsize=11.5)
        left.set_ylabel("|drift| · duration / E")
        right.set_ylabel("amplitude / E")
        right.set_xlabel("step h [s]")
        reference_slopes(right, (1, 2, 4))
    left.set_xlabel("step h [s]")
    reference_slopes(left, (1, 2, 4) if damped else (1, 2, 3, 4, 5, 6))
    for panel in (left,) if damped else (left, right):
        step_ticks(panel, every)
    side.set_axis_off()
    handles = [plot_style.plt.Line2D([], [], linewidth=1.4, **look(index), label=row["method"] + (
                   "" if damped or not has_no_drift(result, case).all() else ": not shown, explodes or decays"))
               for index, (row, case) in enumerate(members)]
    side.legend(handles=handles, loc="upper left", borderaxespad=0)
    figure.suptitle(f"{result.title}: {problem.replace('_', ' ')}")
    return figure


def draw_growth(result, problem, members):
    """Growth of the amplitude per step, measured and predicted: a panel for what grows and one for what decays, since on
    one logarithmic axis they would lie on each other."""
    smallest = 1e-14
    shown = [(row, case) for row, case in members if numpy.isfinite(values(result, case, "predicted_growth")).any()]
    if not shown:
        return None
    predictions = [values(result, case, "predicted_growth") for _, case in shown]
    signs = [sign for sign in (1, -1) if any((sign * growth > smallest).any() for growth in predictions)] or [1]
    figure, axes = new_figure(result, 5.4 * len(signs) + 3.0, 5.6, 1, len(signs), sharey=True)
    for panel, sign in zip(axes[0], signs):
        for index, ((row, case), predicted) in enumerate(zip(shown, predictions)):
            steps, growth, style = values(result, case, "step"), values(result, case, "growth"), look(index)
            part = sign * predicted > smallest
            panel.loglog(steps, numpy.where(part, numpy.abs(predicted), numpy.nan), color=style["color"], linewidth=1.4)
            # A measured value of the other sign than theory's has no place here: it would be a disagreement.
            panel.loglog(steps, numpy.where(part & (sign * growth > 0), numpy.abs(growth), numpy.nan), linestyle="none",
                         **style)
        panel.set_xlabel("step h [s]")
        panel.set_title("the amplitude " + ("grows" if sign > 0 else "decays"), loc="left")
        panel.tick_params(labelleft=True)
    axes[0][0].set_ylabel("|growth of the amplitude per step|")
    handles = []
    for index, ((row, _), predicted) in enumerate(zip(shown, predictions)):
        none = not (numpy.abs(predicted) > smallest).any()
        handles.append(plot_style.plt.Line2D([], [], label=row["method"] + (": none" if none else ""), **look(index)))
    handles += [plot_style.plt.Line2D([], [], color=QUIET, label="lines: ln|λ| of theory"),
                plot_style.plt.Line2D([], [], color=QUIET, marker="o", linestyle="none", label="markers: measured")]
    axes[0][-1].legend(handles=handles, loc="upper left", bbox_to_anchor=(1.02, 1.0), borderaxespad=0)
    figure.suptitle(f"{result.title}: {problem.replace('_', ' ')}")
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
            if good.any() and not has_no_drift(result, case)[0]:
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
    figure.suptitle(f"{result.title}: {problem.replace('_', ' ')}")
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
