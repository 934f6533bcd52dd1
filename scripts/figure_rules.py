"""Rules for finished figures of every kind: curves that cover each other are named, and figures become slides."""

import re
import textwrap

import numpy
from matplotlib import pyplot, rcParams
from matplotlib.colors import to_hex
from matplotlib.font_manager import FontProperties
from matplotlib.gridspec import GridSpec
from matplotlib.lines import Line2D
from matplotlib.text import Text

SLIDE = (13.33, 7.5)     # inches, 16:9
ENLARGED = 20 / 12       # letters of 12 points become 20
THICKER = 1.6
LARGEST_FOOTER = 12      # points
TITLE_WIDTH = 66         # characters
LEGEND_WIDTH = 30         # characters
SAME = 1.5               # pixels


# --- curves that cover each other ---

def look_of(line):
    """What tells a curve from others: colour, and its marker or else its dashes."""
    marker = line.get_marker()
    if marker not in (None, "None", "none", "", " "):
        return to_hex(line.get_color()), str(marker)
    return to_hex(line.get_color()), line.get_linestyle() if line.get_linestyle() in ("None", "none") else \
        line._unscaled_dash_pattern[1]


def drawn_points(axes, wanted):
    """The points of the lines of a look in display coordinates, without those outside the axes."""
    box, found = axes.bbox, []
    for line in axes.lines:
        if look_of(line) != wanted or not line.get_visible() or line.get_transform() != axes.transData:
            continue
        points = numpy.asarray(line.get_xydata(), float)
        with numpy.errstate(all="ignore"):
            points = axes.transData.transform(points)
            inside = (numpy.abs(points - (box.p0 + box.p1) / 2) <= box.size / 2 + 1).all(axis=1)
        found.append(points[inside])
    return numpy.concatenate(found) if found else numpy.zeros((0, 2))


def name_hidden_curves(figure):
    """In each legend, an entry whose curves lie within a line's width on those of an earlier entry, in every panel, says
    so: "heun (= midpoint)"."""
    legends = [axes.get_legend() for axes in figure.axes if axes.get_legend() is not None] + list(figure.legends)
    panels = [axes for axes in figure.axes if axes.axison]
    for axes in panels:
        axes.get_xlim(), axes.get_ylim()  # limits that are worked out late
    for legend in legends:
        handles = getattr(legend, "legend_handles", None) or legend.legendHandles
        looks = [look_of(handle) if isinstance(handle, Line2D) else None for handle in handles]
        known = []
        for handle, look, text in zip(handles, looks, legend.get_texts()):
            if look is None or looks.count(look) > 1:
                continue
            curves = [drawn_points(axes, look) for axes in panels]
            if sum(len(points) for points in curves) < 2:
                continue
            is_line = handle.get_linestyle() not in ("None", "none")  # points on a line of theory cover nothing
            same = next((name for name, line, others in known if line == is_line and all(
                a.shape == b.shape and (a.size == 0 or numpy.abs(a - b).max() <= SAME) for a, b in zip(curves, others))),
                None)
            if same is None:
                known.append((re.split(r":| \(|\n", text.get_text())[0], is_line, curves))
            else:
                text.set_text(f"{text.get_text()} (= {same})")


# --- slides ---

def is_colorbar(axes):
    return hasattr(axes, "_colorbar_info") or axes.get_label() == "<colorbar>"


def content(figure):
    """The panels of a figure, without colour bars and the places of legends."""
    return [axes for axes in figure.axes if axes.get_visible() and axes.axison and not is_colorbar(axes)]


def enlarge(figure):
    figure.set_size_inches(*SLIDE)
    footer_like = [text for text in figure.texts if text is not figure._suptitle]
    for text in figure.findobj(Text):
        size = text.get_fontsize() * ENLARGED
        text.set_fontsize(min(size, LARGEST_FOOTER) if text in footer_like else size)
    for line in figure.findobj(Line2D):
        line.set_linewidth(line.get_linewidth() * THICKER)
        line.set_markersize(line.get_markersize() * THICKER)
    for axes in figure.axes:
        for which in ("x", "y"):
            axes.tick_params(axis=which, which="both", labelsize=plain_size(axes) * ENLARGED)
        if axes.child_axes:  # a second scale between the panel and its title
            axes._set_title_offset_trans(40 * ENLARGED)
        if axes.get_legend() is not None:
            for text in axes.get_legend().get_texts():
                text.set_text("\n".join(part for line in text.get_text().split("\n")
                                        for part in textwrap.wrap(line, LEGEND_WIDTH)))
    if figure._suptitle is not None:
        lines = figure._suptitle.get_text().split("\n")
        figure._suptitle.set_text("\n".join(part for line in lines for part in textwrap.wrap(line, TITLE_WIDTH) or [""]))


def plain_size(axes):
    """The size of letters that tick labels have by the style."""
    return FontProperties(size=rcParams["xtick.labelsize"]).get_size_in_points()


def legend_of(figure, panel):
    """Handles and labels for a panel that stands alone: of its own legend, else of the one that the figure has for all."""
    for axes in [panel] + [axes for axes in figure.axes if axes is not panel]:
        legend = axes.get_legend()
        if legend is not None:
            handles = getattr(legend, "legend_handles", None) or legend.legendHandles
            title = legend.get_title().get_text()
            return handles, [text.get_text() for text in legend.get_texts()], title
    return [], [], ""


def alone(figure, panel):
    """Leaves one panel in its figure, with the labels that it shared, its colour bar and its legend."""
    own = panel.get_legend() is not None
    handles, labels, title = legend_of(figure, panel)
    panels = content(figure)
    if not panel.get_xlabel():
        panel.set_xlabel(next((axes.get_xlabel() for axes in reversed(panels) if axes.get_xlabel()), ""))
    if not panel.get_ylabel():
        panel.set_ylabel(next((axes.get_ylabel() for axes in panels if axes.get_ylabel()), ""))
    panel.tick_params(labelbottom=True, labelleft=True)
    for axes in list(figure.axes):
        if axes is panel:
            continue
        parents = getattr(axes, "_colorbar_info", {}).get("parents", [])
        if panel in parents:
            axes._colorbar_info["parents"] = [panel]
            continue
        axes.remove()
    panel.set_subplotspec(GridSpec(1, 1, figure=figure)[0, 0])
    if handles and not own:
        panel.legend(handles=list(handles), labels=labels, title=title or None, loc="upper left", bbox_to_anchor=(1.01, 1.0),
                     borderaxespad=0)


def slides(draw, result):
    """The figures of `draw(result)` as slides: a panel each with large letters and thick lines; a figure that already has
    the size of a slide stays whole."""
    first = draw(result) or []
    whole = [len(content(figure)) == 1 or numpy.allclose(figure.get_size_inches(), SLIDE, atol=0.05)
             for figure in first]
    found = [[figure] if stays else [] for figure, stays in zip(first, whole)]
    panels = [0 if stays else len(content(figure)) for figure, stays in zip(first, whole)]
    for k in range(max(panels, default=0)):
        # Drawn anew, since a panel cannot leave its figure.
        for own, count, figure in zip(found, panels, draw(result)):
            if k < count:
                alone(figure, content(figure)[k])
                own.append(figure)
            else:
                pyplot.close(figure)
    for figure, stays in zip(first, whole):
        if not stays:
            pyplot.close(figure)
    for figure in (figure for own in found for figure in own):
        enlarge(figure)
    return [figure for own in found for figure in own]
