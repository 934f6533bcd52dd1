#!/usr/bin/env python3
"""Draws the energies of the runs of a study of kind "simulate" over time: the total of every run, and kinetic and
potential energy of each problem's calmest one; the legend says what a run cost."""

import math
import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from plot_style import EXACT, MARKERS, label, new_figure, number, shade
from simulated_cases import MOST_MARKERS, MOST_PANELS, read_case

ROOM = 1.5  # the axis reaches this many ranges of the calmest run's kinetic or potential energy from the start


def read_cases(result):
    """The runs of each problem; a file without energies is refused."""
    problems = {}
    seconds = {}
    if "summary/seconds" in result.file:  # files of earlier versions have none
        seconds = dict(zip(result.values("summary/case"), result.values("summary/seconds")))
    for name, group in result.cases().items():
        if "state" not in group:
            continue
        case = read_case(result, group) | {"seconds": float(seconds.get(name, math.nan))}
        if "total_energy" not in case:
            raise result.error(f"{group.name} has no energies: they are there for scenes and for problems with an energy")
        problems.setdefault(case["problem"], []).append(case)
    if not problems:
        raise result.error("there is no run to draw")
    if len(problems) > MOST_PANELS:
        raise result.error(f"{len(problems)} problems do not fit into one picture; at most {MOST_PANELS} do")
    return problems


def run_label(case, limits):
    """ "rk4, h = 0.01 s (0.12 s)", and whether the curve leaves the picture."""
    step = "adaptive steps" if math.isnan(case["step"]) else f"h = {number(case['step'])} s"
    text = f"{case['method']}, {step}"
    if not math.isnan(case["seconds"]):
        text += f" ({case['seconds']:.2g} s)"
    values = case["total_energy"]
    if not numpy.all((values >= limits[0]) & (values <= limits[1])):
        text += "\n(leaves the picture)"
    return text


def range_of_parts(case):
    """How far kinetic and potential energy of a run move at most [J]; infinite where the run exploded."""
    ranges = [numpy.ptp(case[name]) for name in ("kinetic_energy", "potential_energy")]
    return max(ranges) if numpy.all(numpy.isfinite(ranges)) else math.inf


def energy_limits(cases, calmest):
    """Of the totals of runs that stay near their start, and no more: one that explodes must not flatten the others."""
    size, start = range_of_parts(calmest), calmest["total_energy"][0]
    values = numpy.concatenate([case["total_energy"] for case in cases])
    values = values[numpy.abs(values - start) <= ROOM * size] if 0.0 < size < math.inf else numpy.array([start])
    low, high = values.min(), values.max()
    margin = 0.06 * (high - low) or 0.06 * abs(high) or 1.0
    return low - margin, high + margin


def draw(result):
    """One figure: a line of two panels per problem."""
    problems = read_cases(result)
    lines = max(len(cases) for cases in problems.values())  # of the legend below
    figure, axes = new_figure(result, 15.5, (4.4 + 0.25 * lines) * len(problems) + 0.6, len(problems), 2)
    for (left, right), (problem, cases) in zip(numpy.reshape(axes, (-1, 2)), problems.items()):
        calmest = min(cases, key=range_of_parts)
        limits = energy_limits(cases, calmest)
        for index, case in enumerate(cases):
            few = len(case["time"]) <= MOST_MARKERS
            left.plot(case["time"], case["total_energy"], color=shade(index, len(cases)), linewidth=1.6, markersize=4,
                      marker=MARKERS[index % len(MARKERS)] if few else "", label=run_label(case, limits))
        for name, style in (("kinetic", "-"), ("potential", "--"), ("total", ":")):
            right.plot(calmest["time"], calmest[f"{name}_energy"], color=EXACT, linestyle=style, linewidth=1.6, label=name)
        left.set_ylim(limits)
        for panel in (left, right):
            panel.set_xlabel(label("time t", cases[0]["time_unit"]))
            panel.set_ylabel("energy [J]")
        left.set_title(f"total energy: {problem}", loc="left")
        step = "" if math.isnan(calmest["step"]) else f", h = {number(calmest['step'])} s"
        right.set_title(f"energies of {calmest['method']}{step}", loc="left")
        for panel in (left, right):
            panel.legend(loc="upper left", bbox_to_anchor=(0.0, -0.22), borderaxespad=0, fontsize="small")
    return [figure]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("simulate", draw)))
