"""Draws a sheet or a body in space: frames side by side like a strip of film, seen obliquely from above in parallel
projection."""

import numpy
from matplotlib.collections import LineCollection
from matplotlib.patches import Circle, Polygon
from plot_style import EXACT, PALETTE, number
from scene_shapes import SOLID, SOLID_EDGE, reach_of

FRAMES = 6
ELEVATION, AZIMUTH = numpy.radians(22), numpy.radians(-62)
RIGHT = numpy.array([-numpy.sin(AZIMUTH), numpy.cos(AZIMUTH), 0.0])
UP = numpy.array([-numpy.sin(ELEVATION) * numpy.cos(AZIMUTH), -numpy.sin(ELEVATION) * numpy.sin(AZIMUTH),
                  numpy.cos(ELEVATION)])
TOWARDS = numpy.cross(RIGHT, UP)  # the eye
FACES = ((0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5))  # of a box's corners


def seen(points):
    """Places in space as places on paper, (..., 3) to (..., 2)."""
    return numpy.stack([points @ RIGHT, points @ UP], axis=-1)


def chosen_frames(time):
    """The first, the last, and those nearest to an even spacing between them."""
    wanted = numpy.linspace(time[0], time[-1], min(FRAMES, len(time)))
    return sorted({int(numpy.abs(time - value).argmin()) for value in wanted})


def corners_of(low, high):
    return numpy.array(numpy.meshgrid(*zip(low, high), indexing="ij")).reshape(3, -1).T


def patches_of(shape, one, two, low, high):
    """A plane as the part of it between the limits, a sphere as its outline, a box by the faces towards the eye."""
    style = {"facecolor": SOLID, "edgecolor": SOLID_EDGE, "linewidth": 0.9, "zorder": 0.5}
    if shape == "sphere":
        return [Circle(seen(one), float(numpy.ravel(two)[0]), **style)]
    if shape == "box":
        corner, middle = corners_of(one, two), (one + two) / 2
        return [Polygon(seen(corner[list(members)]), **style) for members in FACES
                if (corner[list(members)].mean(axis=0) - middle) @ TOWARDS > 0]
    upright = int(numpy.abs(two).argmax())
    others = [axis for axis in range(3) if axis != upright]
    corner = numpy.zeros((4, 3))
    for k, (a, b) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
        corner[k, others] = (low, high)[a][others[0]], (low, high)[b][others[1]]
        corner[k, upright] = one[upright] - (corner[k] - one)[others] @ two[others] / two[upright]
    return [Polygon(seen(corner), **style)]


class Strip:
    """The frames of one trajectory, all with the same limits and one scale along the axes."""

    def __init__(self, time, position, springs, obstacles, held, anchored=()):
        self.time, self.position, self.springs, self.held = time, position, springs, held
        self.anchored = numpy.array([place for _, place in anchored]).reshape(-1, 3)
        self.frames = chosen_frames(time)
        everything = numpy.concatenate([position.reshape(-1, 3), reach_of(obstacles, position)])
        low, high = everything.min(axis=0), everything.max(axis=0)
        room = 0.04 * (high - low).max()
        planes_first = sorted(obstacles, key=lambda solid: solid[0] != "plane")
        self.solids = [(*solid, low - room, high + room) for solid in planes_first]
        places = [seen(position.reshape(-1, 3))]
        for solid in self.solids:
            places += [patch.get_path().transformed(patch.get_patch_transform()).vertices for patch in patches_of(*solid)]
        places = numpy.concatenate(places)
        self.low, self.high = places.min(axis=0) - room, places.max(axis=0) + room

    def shape(self, width, height):
        """(rows, columns) in which the frames are largest on a part of the figure of this size."""
        size = self.high - self.low
        count = len(self.frames)
        return max(((rows, -(-count // rows)) for rows in (1, 2, 3)),
                   key=lambda shape: min(width / shape[1] / size[0], (height / shape[0] - 0.55) / size[1]))

    def draw(self, figure, cells):
        """A panel per frame in the cells of a grid. Returns the times of the frames."""
        for place, frame in zip(cells, self.frames):
            axes = figure.add_subplot(place)
            for solid in self.solids:
                for patch in patches_of(*solid):
                    axes.add_patch(patch)
            points = seen(self.position[frame])
            axes.add_collection(LineCollection(points[self.springs], colors=PALETTE[0], linewidths=0.8, zorder=2))
            if not len(self.springs):
                axes.plot(*points.T, linestyle="none", marker="o", markersize=3, color=PALETTE[0], zorder=2)
            if len(self.held):
                axes.plot(*points[self.held].T, linestyle="none", marker="s", markersize=4, color=PALETTE[1], zorder=3)
            axes.plot(*seen(self.anchored).T, linestyle="none", marker="x", markersize=5, color=EXACT, zorder=4)
            axes.set(xlim=(self.low[0], self.high[0]), ylim=(self.low[1], self.high[1]))
            axes.set_aspect("equal")
            axes.set_axis_off()
            axes.set_title(f"t = {number(self.time[frame])} s", fontsize=12, pad=2)
        return self.time[self.frames]


def note(held, obstacles, anchored=()):
    """What the marks of the strip mean."""
    parts = (["squares: fixed"] if len(held) else []) + (["crosses: anchors"] if len(anchored) else [])
    parts += [", ".join(dict.fromkeys(shape for shape, _, _ in obstacles)) + " in sand"] if obstacles else []
    return "; ".join(parts)
