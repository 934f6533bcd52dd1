#!/usr/bin/env python3
"""Draws a trajectory: the paths of the masses, the energies and the momenta."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.collections import LineCollection
from plot_style import ALARM, PALETTE, label, new_figure
from result_file import text

MOST_PATHS = 12   # more are a tangle
FLAT = 1e-6       # a change below this part of its natural scale is drawn flat
COMPONENTS = "xyz"


def seen_plane(position):
    """The two coordinates in which the masses move most; z stays upright."""
    extent = numpy.ptp(position.reshape(-1, 3), axis=0)
    first, second = sorted(numpy.argsort(-extent, kind="stable")[:2])
    return first, second


def draw_paths(result, axes):
    position = result.values("trajectory/position")
    springs = result.values("system/springs").astype(int)
    unit = result.unit("trajectory/position")
    first, second = seen_plane(position)
    count = position.shape[1]
    chosen = numpy.unique(numpy.linspace(0, count - 1, min(count, MOST_PATHS)).round().astype(int))
    for frame, color, width, name in ((0, "#BBBBBB", 1.0, "start"), (-1, "#000000", 1.2, "end")):
        points = position[frame][:, [first, second]]
        axes.add_collection(LineCollection(points[springs], colors=color, linewidths=width, zorder=2))
        size = 6 if count <= 50 else 2
        axes.plot(points[:, 0], points[:, 1], linestyle="none", marker="o", markersize=size, color=color, zorder=3,
                  label=name)
    for index, particle in enumerate(chosen):
        axes.plot(position[:, particle, first], position[:, particle, second], linewidth=1.1, zorder=1,
                  color=PALETTE[index % (len(PALETTE) - 1)])
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_xlabel(label(COMPONENTS[first], unit))
    axes.set_ylabel(label(COMPONENTS[second], unit))
    shown = "paths" if len(chosen) == count else f"paths ({len(chosen)} of {count})"
    axes.set_title(f"{shown}, seen along {COMPONENTS[3 - first - second]}", loc="left")
    axes.legend(loc="best")


def draw_curves(result, axes, title, curves, quantity, scale):
    """Curves over time; the axis spans at least FLAT × scale, so that rounding is not drawn as waves."""
    time = result.values("trajectory/time")
    styles = ["-", "--", ":"]
    values = []
    for index, (name, value) in enumerate(curves):
        axes.plot(time, value, styles[index % 3], color=PALETTE[index], label=name)
        values.append(value[numpy.isfinite(value)])
    values = numpy.concatenate(values)
    if values.size:
        low, high = values.min(), values.max()
        half = max(0.55 * (high - low), 0.5 * FLAT * scale)
        if half > 0:
            axes.set_ylim(0.5 * (low + high) - half, 0.5 * (low + high) + half)
    axes.set_xlim(time[0], time[-1])
    axes.set_ylabel(label(quantity, result.unit(f"trajectory/{curves.dataset}")))
    axes.set_title(title, loc="left")
    axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.03), borderaxespad=0)


class Curves(list):
    """Named curves and the dataset that gives their unit."""

    def __init__(self, dataset, pairs):
        super().__init__(pairs)
        self.dataset = dataset


def components(result, dataset):
    value = result.values(f"trajectory/{dataset}")
    return Curves(dataset, [(COMPONENTS[i], value[:, i]) for i in range(3)])


def draw(result):
    """One figure: the paths on the left, energies and momenta over time on the right."""
    figure, axes = new_figure(result, 13.5, 7.2, 3, 2, sharex="col", gridspec_kw={"width_ratios": [1.1, 1]})
    grid = axes[0, 0].get_gridspec()
    for panel in axes[:, 0]:
        panel.remove()
    draw_paths(result, figure.add_subplot(grid[:, 0]))

    mass = numpy.broadcast_to(result.values("system/mass"), result.values("trajectory/velocity").shape[1:2])
    speed = numpy.linalg.norm(result.values("trajectory/velocity"), axis=2)
    distance = numpy.linalg.norm(result.values("trajectory/position"), axis=2)
    # Natural scales, for the axis limits only.
    momentum_scale = numpy.nanmax(mass * speed, initial=0.0)
    angular_scale = numpy.nanmax(mass * speed * distance, initial=0.0)

    energies = [("kinetic", "kinetic_energy"), ("potential", "potential_energy"), ("total", "total_energy")]
    present = Curves("kinetic_energy", [(name, result.values(f"trajectory/{dataset}")) for name, dataset in energies
                                        if f"trajectory/{dataset}" in result.file or dataset != "total_energy"])
    energy_scale = max(numpy.nanmax(numpy.abs(value)) for _, value in present)
    draw_curves(result, axes[0, 1], "energy", present, "energy", energy_scale)
    draw_curves(result, axes[1, 1], "linear momentum", components(result, "linear_momentum"), "p", momentum_scale)
    draw_curves(result, axes[2, 1], "angular momentum about the origin", components(result, "angular_momentum"), "L",
                angular_scale)
    axes[2, 1].set_xlabel(label("time t", result.unit("trajectory/time")))

    status = text(result.file.attrs.get("solver_status", "success"))
    if not status.startswith("success"):
        figure.suptitle(f"{result.title}\nstopped: {status}", color=ALARM)
    return [figure]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("trajectory", draw)))
