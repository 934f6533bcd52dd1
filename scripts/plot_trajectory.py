#!/usr/bin/env python3
"""Draws a trajectory: the paths of the masses among obstacles and anchors (sheets and bodies as a strip of frames in
space), the energies, and the momenta where nothing acts from outside."""

import sys
import textwrap

import plot_style  # first: it finds a Python with the libraries
import numpy
from film_strip import Strip, note
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgba
from plot_style import ALARM, PALETTE, QUIET, label, new_figure, number
from result_file import text
from scene_shapes import (SOLID, SOLID_EDGE, anchors, draw_anchors, draw_obstacles, drawable_frames, drawn_springs, is_free, is_spatial,
                          obstacles, reach_of, seen_plane, too_few_frames)

MOST_PATHS = 12   # more are a tangle
FLAT = 1e-6       # a change below this part of its natural scale is drawn flat
COMPONENTS = "xyz"


def fading(axes, path, color):
    """A path that was long ago is pale."""
    pieces = numpy.stack([path[:-1], path[1:]], axis=1)
    shades = numpy.tile(to_rgba(color), (len(pieces), 1))
    shades[:, 3] = numpy.linspace(0.15, 1.0, len(pieces))
    axes.add_collection(LineCollection(pieces, colors=shades, linewidths=1.3, zorder=1, capstyle="round"))


def draw_paths(result, axes, frames, spec):
    """The paths up to the frame number `frames`, the network at the start and then, seen along one axis."""
    position = result.values("trajectory/position")[:frames]
    fixed = result.values("system/fixed").astype(int) if "system/fixed" in result.file else numpy.zeros(0, int)
    springs = drawn_springs(spec, result.values("system/springs").astype(int).reshape(-1, 2), position.shape[1])
    found = obstacles(spec)
    first, second = seen_plane(position)
    plane = [first, second]
    moving = numpy.setdiff1d(numpy.arange(position.shape[1]), fixed)
    chosen = moving[numpy.unique(numpy.linspace(0, len(moving) - 1, min(len(moving), MOST_PATHS)).round().astype(int))]
    ends = ((0, "#9A9A9A", 1.0, "start"), (-1, "#000000", 1.4, "end"))
    size = 7 if position.shape[1] <= 50 else 2
    for frame, color, width, name in ends:
        points = position[frame][:, plane]
        axes.add_collection(LineCollection(points[springs], colors=color, linewidths=width, zorder=2))
        axes.plot(*points[moving].T, linestyle="none", marker="o", markersize=size, color=color, zorder=3, label=name)
    if len(fixed):
        axes.plot(*position[0][fixed][:, plane].T, linestyle="none", marker="s", markersize=size + 1, color=QUIET, zorder=4,
                  label="fixed")
    draw_anchors(axes, anchors(spec, position[0]), position[-1], first, second)
    sparse = [particle for particle in chosen if too_few_frames(position[:, particle])]
    for index, particle in enumerate(chosen):
        color, path = PALETTE[index % (len(PALETTE) - 1)], position[:, particle][:, plane]
        axes.update_datalim(path)
        if particle in sparse:
            axes.plot(*path.T, linestyle="none", marker=".", markersize=2.5, color=color, alpha=0.6, zorder=1)
        else:
            fading(axes, path, color)
    axes.update_datalim(reach_of(found, position)[:, plane])
    axes.margins(0.06)
    axes.autoscale_view()
    axes.set_aspect("equal", adjustable="datalim")
    axes.apply_aspect()  # obstacles reach to the limits that this leaves
    if draw_obstacles(axes, found, first, second):
        axes.plot([], [], linestyle="none", marker="s", markersize=9, color=SOLID, markeredgecolor=SOLID_EDGE,
                  label=" and ".join(dict.fromkeys(shape for shape, _, _ in found)))
    unit = result.unit("trajectory/position")
    axes.set_xlabel(label(COMPONENTS[first], unit))
    axes.set_ylabel(label(COMPONENTS[second], unit))
    shown = "paths" if len(chosen) == len(moving) else f"paths ({len(chosen)} of {len(moving)})"
    axes.set_title(f"{shown}, seen along {COMPONENTS[3 - first - second]}", loc="left")
    if sparse:
        axes.text(0.5, 0.01, "dots: too few frames for a path (--frames)", transform=axes.transAxes, ha="center", va="bottom",
                  fontsize=9.5, color=ALARM)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.12), ncols=5, columnspacing=1.2, handletextpad=0.3)


def draw_curves(result, axes, title, curves, quantity, scale, explodes=False):
    """Curves over time; the axis spans at least FLAT × scale, so that rounding is not drawn as waves. Of an explosion
    the magnitudes, on a logarithmic axis."""
    time = result.values("trajectory/time")
    styles = ["-", "--", ":"]
    values = []
    for index, (name, value) in enumerate(curves):
        value = numpy.where(value != 0, numpy.abs(value), numpy.nan) if explodes else value
        axes.plot(time, value, styles[index % 3], color=PALETTE[index], label=name)
        values.append(value[numpy.isfinite(value)])
    values = numpy.concatenate(values)
    if explodes:
        axes.set_yscale("log")
    elif values.size:
        low, high = values.min(), values.max()
        half = max(0.55 * (high - low), 0.5 * FLAT * scale)
        if half > 0:
            axes.set_ylim(0.5 * (low + high) - half, 0.5 * (low + high) + half)
    axes.set_xlim(time[0], time[-1])
    unit = result.unit(f"trajectory/{curves.dataset}")
    axes.set_ylabel(label(f"|{quantity}|" if explodes else quantity, unit))
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


def energies_of(result):
    """Kinetic, potential and total, and the parts of the potential that vary."""
    names = ("kinetic", "potential", "total")
    present = [(name, result.values(f"trajectory/{name}_energy")) for name in names
               if f"trajectory/{name}_energy" in result.file]
    return Curves("kinetic_energy", present)


def finite_largest(values):
    values = numpy.abs(values[numpy.isfinite(values)])
    return values.max(initial=0.0)


def draw_momenta(result, panels):
    mass = numpy.broadcast_to(result.values("system/mass"), result.values("trajectory/velocity").shape[1:2])
    speed = numpy.linalg.norm(result.values("trajectory/velocity"), axis=2)
    distance = numpy.linalg.norm(result.values("trajectory/position"), axis=2)
    # Natural scales, for the axis limits only.
    for panel, title, dataset, symbol, scale in (
            (panels[0], "linear momentum", "linear_momentum", "p", finite_largest(mass * speed)),
            (panels[1], "angular momentum about the origin", "angular_momentum", "L", finite_largest(mass * speed * distance))):
        draw_curves(result, panel, title, components(result, dataset), symbol, scale)


WIDTH, HEIGHT = 13.33, 7.5  # inches: a slide
STRIP = 0.62                # of the height, for frames in space


def draw_in_space(result, figure, spec, fixed, frames, curves, scale, explodes):
    """Frames side by side, the energies below."""
    position, time = result.values("trajectory/position")[:frames], result.values("trajectory/time")[:frames]
    found = obstacles(spec)
    springs = drawn_springs(spec, result.values("system/springs").astype(int).reshape(-1, 2), position.shape[1])
    tied = anchors(spec, position[0])
    strip = Strip(time, position, springs, found, fixed, tied)
    rows, columns = strip.shape(WIDTH, STRIP * HEIGHT)
    outer = figure.add_gridspec(2, 1, height_ratios=[STRIP, 1 - STRIP])
    inner = outer[0].subgridspec(rows, columns)
    instants = strip.draw(figure, [inner[k // columns, k % columns] for k in range(len(strip.frames))])
    panel = figure.add_subplot(outer[1])
    for instant in instants:
        panel.axvline(instant, color=QUIET, linewidth=0.8, linestyle=":")
    meaning = note(fixed, found, tied)
    draw_curves(result, panel, "energy" + (f" ({meaning})" if meaning else ""), curves, "energy", scale, explodes)
    return panel


def draw_in_plane(result, figure, spec, free, frames, curves, scale, explodes):
    """Paths on the left; on the right the energies, and the momenta where they are constant."""
    lines = 3 if free else 1
    grid = figure.add_gridspec(lines, 2, width_ratios=[1.1, 1])
    panels = [figure.add_subplot(grid[0, 1])]
    panels += [figure.add_subplot(grid[line, 1], sharex=panels[0]) for line in range(1, lines)]
    draw_paths(result, figure.add_subplot(grid[:, 0]), frames, spec)
    draw_curves(result, panels[0], "energy", curves, "energy", scale, explodes)
    if free:
        draw_momenta(result, panels[1:])
    for panel in panels[:-1]:
        panel.tick_params(labelbottom=False)
    return panels[-1]


def draw(result):
    """One figure of the size of a slide."""
    spec, status = result.spec(), text(result.file.attrs.get("solver_status", "success"))
    position, time = result.values("trajectory/position"), result.values("trajectory/time")
    fixed = result.values("system/fixed").astype(int) if "system/fixed" in result.file else numpy.zeros(0, int)
    stopped = not status.startswith("success")
    frames = drawable_frames(position, stopped)
    explodes = frames < len(time)
    figure, axes = new_figure(result, WIDTH, HEIGHT)
    axes[0, 0].remove()
    curves = energies_of(result)
    scale = max(finite_largest(value) for _, value in curves)
    if is_spatial(position[:frames]):
        lowest = draw_in_space(result, figure, spec, fixed, frames, curves, scale, explodes)
    else:
        free = is_free(spec, fixed) and not explodes
        lowest = draw_in_plane(result, figure, spec, free, frames, curves, scale, explodes)
    lowest.set_xlabel(label("time t", result.unit("trajectory/time")))

    how = result.how_it_ran()
    lines = [f"{result.title}: {how}" if how else result.title]
    if stopped:
        lines += textwrap.wrap(f"stopped: {status}", 100)
    if explodes:
        lines.append(f"masses drawn up to t = {number(time[frames - 1])} s, energies on a logarithmic axis")
    figure.suptitle("\n".join(lines), color=ALARM if stopped or explodes else None, fontsize=15 if len(lines) == 1 else 13)
    return [figure]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("trajectory", draw)))
