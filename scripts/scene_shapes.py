"""What a trajectory's picture shows beside the paths: obstacles, anchors, fixed particles, the springs that make a mesh
readable, the view. Everything comes from the file: `spec` is the resolved scene."""

import numpy
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle, Polygon, Rectangle
from plot_style import QUIET

SOLID, SOLID_EDGE = "#D8CFC0", "#8A7A5C"  # obstacles: sand, told apart from springs and paths
STILL = 1e-3        # a motion below this part of the largest one is none
MESH_FROM = 20      # particles: more are a sheet or a body
MOST_STEPS_OF_TURN = 0.7  # rad between two frames' displacements: beyond, a path through them is made up


def numbers(value):
    """An array of floats, or None where the scene has something else there (a path over time)."""
    try:
        array = numpy.asarray(value, float)
    except (TypeError, ValueError):
        return None
    return array if array.size and numpy.isfinite(array).all() else None


def tables(spec, name):
    found = spec.get(name, [])
    return [entry for entry in (found if isinstance(found, list) else [found]) if isinstance(entry, dict)]


def obstacles(spec):
    """(shape, first, second): a plane by point and unit normal, a sphere by centre and radius, a box by its corners."""
    keys = {"plane": ("point", "normal"), "sphere": ("centre", "radius"), "box": ("lower", "upper")}
    found = []
    for entry in tables(spec, "obstacle"):
        shape = entry.get("shape", "")
        first, second = (numbers(entry.get(key)) for key in keys.get(shape, ("", "")))
        if first is None or second is None:
            continue
        if shape == "plane":
            second = second / numpy.linalg.norm(second)
        found.append((shape, first, second))
    return found


def anchors(spec, start):
    """(particle, place) of every anchor that stands; one without a place of its own holds its particle where that starts.
    Particles given by the name of a group are left out: only the program knows which they are."""
    found = []
    for entry in tables(spec, "anchor"):
        if any(key in entry for key in ("velocity", "table", "expression")):
            continue  # its support moves
        given = entry.get("particle", [])
        listed = given if isinstance(given, list) else [given]
        particles = numpy.array([one for one in listed if not isinstance(one, str)], int)
        place = numbers(entry.get("position"))
        places = start[particles] if place is None else numpy.broadcast_to(place, (particles.size, 3))
        found += list(zip(particles, places))
    return found


def is_free(spec, fixed):
    """Whether nothing acts from outside, so that the momenta are constant."""
    world = spec.get("world", {})
    return not (len(fixed) or any(spec.get(name) for name in ("anchor", "obstacle", "force", "constraint"))
                or numpy.any(numpy.asarray(world.get("gravity", 0.0), float)) or world.get("drag", 0.0)
                or world.get("rayleigh", {}).get("mass", 0.0))


def drawn_springs(spec, springs, count):
    """Of a generated cloth or grid the structural springs, which are the threads that one sees; else all."""
    generate = spec.get("generate", {})
    counts = numpy.atleast_1d(generate.get("counts", [])).astype(int)
    if generate.get("kind") not in ("cloth", "grid") or counts.size < 2 or numpy.prod(counts) != count:
        return springs
    places = numpy.array(numpy.unravel_index(numpy.arange(count), counts[::-1]))
    apart = numpy.abs(places[:, springs[:, 0]] - places[:, springs[:, 1]]).sum(axis=0)
    return springs[apart == 1] if (apart == 1).any() else springs


def motion(position):
    """Along each axis, how far the particle moves that moves most."""
    return numpy.ptp(position, axis=0).max(axis=0)


def seen_plane(position):
    """The two coordinates with the most motion, in their order (z upright); where the motion has but one, the other is
    the one along which the masses extend most."""
    moves, extent = motion(position), numpy.ptp(position.reshape(-1, 3), axis=0)
    moves = numpy.where(moves > STILL * moves.max(), moves, 0.0)
    first, second = sorted(sorted(range(3), key=lambda axis: (-moves[axis], -extent[axis], axis))[:2])
    return first, second


def is_spatial(position):
    """Whether a mesh needs to be seen in space: many masses whose places fill all three directions."""
    extent = numpy.ptp(position.reshape(-1, 3), axis=0)
    return position.shape[1] >= MESH_FROM and extent.min() > 0.02 * extent.max()


def drawable_frames(position, stopped):
    """The frames to be drawn: all of a run that reached its end. An explosion is drawn until the masses are ten times
    as far from their centre as at the start (as in the first frame in which they are apart, where they start in one
    place): beyond, nothing else would be seen. A run that moves by a million times its size is one too."""
    finite = numpy.isfinite(position).all(axis=(1, 2))
    known = numpy.where(numpy.isfinite(position), position, 0.0)
    distance = numpy.where(finite, numpy.abs(known - known[0].mean(axis=0)).max(axis=(1, 2)), numpy.inf)
    size = distance[0] or next((value for value in distance if 0 < value < numpy.inf), 1.0)
    if not stopped and distance.max() < 1e6 * size:
        return position.shape[0]
    inside = distance <= 10 * size
    return position.shape[0] if inside.all() else max(1, int(numpy.argmin(inside)))


def too_few_frames(path):
    """Whether a path turns so far from frame to frame that straight pieces between them would be made up."""
    steps = numpy.diff(path, axis=0)
    length = numpy.linalg.norm(steps, axis=1)
    steps, length = steps[length > 0.02 * length.max(initial=0.0)], length[length > 0.02 * length.max(initial=0.0)]
    if len(steps) < 4:
        return False
    turn = (steps[1:] * steps[:-1]).sum(axis=1) / (length[1:] * length[:-1])
    return float(numpy.median(numpy.arccos(numpy.clip(turn, -1, 1)))) > MOST_STEPS_OF_TURN


def draw_obstacles(axes, found, first, second):
    """The obstacles as seen along the third axis, clipped by the limits that the axes have. Returns whether one is drawn."""
    away = 3 - first - second
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    drawn = False
    for shape, one, two in found:
        style = {"facecolor": SOLID, "edgecolor": SOLID_EDGE, "linewidth": 1.2, "zorder": 0.5}
        if shape == "sphere":
            patch = Circle((one[first], one[second]), float(numpy.ravel(two)[0]), **style)
        elif shape == "box":
            patch = Rectangle((one[first], one[second]), *(two - one)[[first, second]], **style)
        elif abs(two[away]) > 0.999:
            continue  # seen face on: it is everywhere
        else:
            corners = numpy.array([[left, low], [right, low], [right, high], [left, high]])
            corners = clipped(corners, one[[first, second]], two[[first, second]])
            if len(corners) < 3:
                continue
            patch = Polygon(corners, **style)
        axes.add_patch(patch)
        drawn = True
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)
    return drawn


def clipped(corners, point, normal):
    """The part of a polygon behind a line."""
    kept, depth = [], (corners - point) @ normal
    for k in range(len(corners)):
        n = (k + 1) % len(corners)
        if depth[k] <= 0:
            kept.append(corners[k])
        if depth[k] * depth[n] < 0:
            kept.append(corners[k] + (corners[n] - corners[k]) * depth[k] / (depth[k] - depth[n]))
    return numpy.array(kept)


def reach_of(found, position):
    """Places that a view has to hold beside the masses: spheres and boxes nearby, and the point of a plane below."""
    centre = position.reshape(-1, 3).mean(axis=0)
    size = numpy.ptp(position.reshape(-1, 3), axis=0).max() or 1.0
    places = []
    for shape, one, two in found:
        if shape == "plane":
            places.append(centre - two * ((centre - one) @ two + 0.04 * size))
        else:
            corners = [one - two, one + two] if shape == "sphere" else [one, two]
            places += [numpy.clip(corner, centre - 2 * size, centre + 2 * size) for corner in corners]
    return numpy.array(places).reshape(-1, 3)


def draw_anchors(axes, found, position, first, second):
    """A cross at each anchor's place and a thin line to its particle."""
    if not found:
        return
    lines = [[place[[first, second]], position[particle][[first, second]]] for particle, place in found]
    axes.add_collection(LineCollection(lines, colors=QUIET, linewidths=0.9, linestyles=":", zorder=2))
    places = numpy.array([place for _, place in found])
    axes.plot(places[:, first], places[:, second], linestyle="none", marker="x", markersize=8, markeredgewidth=2,
              color=QUIET, zorder=4, label="anchor" if len(found) == 1 else "anchors")
