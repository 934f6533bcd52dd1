"""What the pictures of kind "simulate" have in common: reading the cases, axis limits, labels and styles."""

import math

import numpy
from plot_style import EXACT, MARKERS, number, shade

MOST_MARKERS = 60  # a curve with more points is drawn without markers
MOST_PANELS = 9


def read_case(result, group):
    """One run: its facts, its curve and the exact one."""
    case = {name: result.fact(name, group) for name in ("problem", "method", "step")}
    case |= {name: numpy.asarray(result.values(name, group), dtype=float) for name in ("time", "state")}
    case |= {"time_unit": result.unit("time", group), "state_unit": result.unit("state", group)}
    if "total_energy" in group:
        case |= {name: numpy.asarray(result.values(name, group), dtype=float)
                 for name in ("kinetic_energy", "potential_energy", "total_energy")}
    if "exact_time" in group:
        case |= {name: numpy.asarray(result.values(name, group), dtype=float)
                 for name in ("exact_time", "exact_state")}
    for name in ("state", "exact_state"):
        if name in case and case[name].ndim == 1:
            case[name] = case[name][:, None]
    return case


def read_field(result):
    """The vector field as arrays "t", "y", "dydt", or None where the file has none."""
    if "cases/vector_field" not in result.file or not result.was_computed(result.file["cases/vector_field"]):
        return None
    group = result.file["cases/vector_field"]
    field = {name: numpy.asarray(result.values(f"field_{name}", group), dtype=float) for name in ("t", "y", "dydt")}
    for name in ("y", "dydt"):
        if field[name].ndim == 1:
            field[name] = field[name][:, None]
    return field


def panels(result, state_size):
    """The cases by (problem, method), each sorted by falling step; and the vector field."""
    groups = {}
    for group in result.cases().values():
        case = read_case(result, group)
        if case["state"].shape[1] != state_size:
            raise result.error(f"{group.name}/state has {case['state'].shape[1]} components, expected {state_size}")
        groups.setdefault((case["problem"], case["method"]), []).append(case)
    for cases in groups.values():
        cases.sort(key=lambda case: (math.isnan(case["step"]), -case["step"]))
    if len(groups) > MOST_PANELS:
        raise result.error(f"{len(groups)} pairs of problem and method do not fit into one picture; at most "
                           f"{MOST_PANELS} do")
    return groups, read_field(result)


def field_limits(curves, field):
    """Axis limits: the field's extent where there is one (a curve that explodes leaves it), else the curves'."""
    values = numpy.concatenate(curves) if field is None else field
    values = values[numpy.isfinite(values)]
    low, high = values.min(), values.max()
    margin = 0.04 * (high - low) or 1.0
    return low - margin, high + margin


def series_label(case, *values_and_limits):
    """ "h = 0.5 s" (a scheme that chooses its steps has none), and whether the curve leaves the picture."""
    unit = case["time_unit"] if case["time_unit"] != "1" else ""
    text = "adaptive steps" if math.isnan(case["step"]) else f"h = {number(case['step'])} {unit}".rstrip()
    for values, (low, high) in zip(values_and_limits[::2], values_and_limits[1::2]):
        if not numpy.all((values >= low) & (values <= high)):
            return text + "\n(leaves the picture)"
    return text


def style_of_steps(cases):
    """One colour and marker per step."""
    for index, case in enumerate(cases):
        few = len(case["time"]) <= MOST_MARKERS
        yield {"color": shade(index, len(cases)), "marker": MARKERS[index % len(MARKERS)] if few else "",
               "linewidth": 1.6, "markersize": 5, "zorder": 3}


def draw_exact(axes, cases, coordinates):
    """The exact solution of the case that follows it longest."""
    known = [case for case in cases if "exact_time" in case]
    if known:
        longest = max(known, key=lambda case: case["exact_time"][-1])
        axes.plot(*coordinates(longest["exact_time"], longest["exact_state"]), color=EXACT, linewidth=2.4, zorder=4,
                  label="exact")
