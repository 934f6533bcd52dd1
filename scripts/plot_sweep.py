#!/usr/bin/env python3
"""Draws columns of a sweep's summary over its first parameter: a panel per quantity, a line per method and value of the
other parameters."""

import sys
import tomllib

import plot_style  # first: it finds a Python with the libraries
import numpy
from plot_style import label, look, new_figure, number
from result_file import text

PREFIX = "parameter_"


def numeric(values):
    return not isinstance(values, list) and values.dtype.kind in "fi"


def quantities_of(result, columns):
    """Those that the study names as `quantities`, else the first number of the inner study that varies."""
    wanted = tomllib.loads(text(result.file.attrs["spec"])).get("quantities", [])
    for name in wanted:
        if name not in columns or not numeric(columns[name]):
            raise result.error(f'quantities names "{name}", which is no number in /summary')
    if wanted:
        return wanted
    numbers = {name: values[numpy.isfinite(values)] for name, values in columns.items()
               if not name.startswith(PREFIX) and numeric(values) and values.dtype.kind == "f"}
    varying = [name for name, usable in numbers.items() if usable.size > 1 and usable.min() < usable.max()]
    return (varying or [name for name, usable in numbers.items() if usable.size])[:1]  # of a single case nothing varies


def is_wide(values):
    """Whether values ask for a logarithmic axis."""
    usable = values[numpy.isfinite(values)]
    return len(usable) > 0 and usable.min() > 0 and usable.max() / usable.min() > 20


def series_of(result, columns, parameter):
    """The rows of each line by its name: everything that tells cases apart but the first parameter."""
    keys = [name for name in columns if name in ("problem", "method")]
    keys += [name for name in columns if name.startswith(PREFIX) and name != parameter]
    varying = [name for name in keys if len(set(map(str, columns[name]))) > 1]
    lines = {}
    for row in range(len(columns[parameter])):
        parts = []
        for name in varying:
            value = columns[name][row]
            shown = value if isinstance(value, str) else number(value)
            if name.startswith(PREFIX):
                unit = label("", result.unit(f"summary/{name}")).strip(" []")
                shown = f"{name.removeprefix(PREFIX).replace('_', ' ')} = {shown} {unit}".rstrip()
            parts.append(shown)
        lines.setdefault(", ".join(parts), []).append(row)
    return lines


def draw(result):
    columns = result.columns()
    parameters = [name for name in columns if name.startswith(PREFIX)]
    parameter = next((name for name in parameters if numeric(columns[name])), parameters[0])
    quantities = quantities_of(result, columns)
    if not quantities:
        return []
    lines = series_of(result, columns, parameter)
    figure, axes = new_figure(result, 6.0 * len(quantities) + 2.6, 5.2, 1, len(quantities))
    for panel, quantity in zip(axes.flat, quantities):
        values = columns[quantity]
        for index, (name, rows) in enumerate(lines.items()):
            x = columns[parameter][rows] if numeric(columns[parameter]) else [columns[parameter][row] for row in rows]
            panel.plot(x, values[rows], label=name or None, **look(index))
        if numeric(columns[parameter]) and is_wide(columns[parameter]):
            panel.set_xscale("log")
        if is_wide(values):
            panel.set_yscale("log")
        panel.set_xlabel(label(parameter.removeprefix(PREFIX).replace("_", " "), result.unit(f"summary/{parameter}")))
        panel.set_ylabel(label(quantity.replace("_", " "), result.unit(f"summary/{quantity}")))
    if len(lines) > 1:
        axes.flat[-1].legend(loc="upper left", bbox_to_anchor=(1.01, 1.02), borderaxespad=0)
    return [figure]


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("sweep", draw)))
