"""How federwerk's pictures look, and how they are saved: import this first in every plot script.

Where this Python lacks numpy, h5py or matplotlib, the script starts again with /usr/bin/python3, which has them on
a machine that scripts/bootstrap set up.
"""

import argparse
import math
import os
import pathlib
import sys

try:
    import h5py  # noqa: F401
    import matplotlib
    import numpy
except ImportError as missing:
    SYSTEM_PYTHON = "/usr/bin/python3"
    if not sys.argv[0].endswith(".py") or os.environ.get("FEDERWERK_RESTARTED") or not os.path.exists(SYSTEM_PYTHON):
        sys.exit(f"{sys.executable}: {missing}; install the packages python3-numpy, python3-h5py and "
                 "python3-matplotlib (scripts/bootstrap does) or use a Python that has them")
    os.environ["FEDERWERK_RESTARTED"] = "1"
    os.execv(SYSTEM_PYTHON, [SYSTEM_PYTHON, *sys.argv])

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

from figure_rules import name_hidden_curves, slides  # noqa: E402
from result_file import ResultError, ResultFile  # noqa: E402

# Okabe and Ito 2008: told apart with every kind of colour vision. Its yellow is too pale for lines on white.
PALETTE = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
MARKERS = ["o", "s", "^", "D", "v", "P", "X", "<"]  # as many as are coprime to the colours: 56 pairs
EXACT = "#000000"
QUIET = "#767676"   # references, grids, footers: dark enough to read on a projector
ALARM = "#B00020"

plt.rcParams.update({
    "font.family": "DejaVu Sans",
    "font.size": 12,
    "axes.titlesize": 13,
    "axes.labelsize": 12,
    "legend.fontsize": 10.5,
    "legend.frameon": False,
    "figure.titlesize": 15,
    "axes.prop_cycle": plt.cycler(color=PALETTE),
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "grid.color": "#DDDDDD",
    "grid.linewidth": 0.7,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "lines.linewidth": 1.8,
    "lines.markersize": 6,
    "figure.constrained_layout.use": True,
    "savefig.dpi": 160,
    "figure.max_open_warning": 0,  # slides: a figure per panel
    "pdf.fonttype": 42,  # text stays text
})


def look(index):
    """Colour and marker of the series number `index`."""
    return {"color": PALETTE[index % len(PALETTE)], "marker": MARKERS[index % len(MARKERS)]}


def shade(index, count):
    """Colour of the member number `index` of an ordered series of `count`, such as steps: the palette where it is long
    enough, else from dark to light of viridis without its pale end, so that none has the colour of another."""
    if count < len(PALETTE):
        return PALETTE[index % len(PALETTE)]
    return matplotlib.colormaps["viridis"](0.92 * index / max(1, count - 1))


def power_of_ten(panel):
    """Numbers below 0.001 on an axis become numbers around 1, and the power goes into its label: an offset text would
    stand in the title."""
    largest = max(abs(limit) for limit in panel.get_ylim())
    if not 0 < largest < 1e-3 or panel.get_yscale() != "linear":
        return
    power = math.floor(math.log10(largest))
    panel.yaxis.set_major_formatter(lambda value, _: f"{value / 10.0 ** power:g}")
    panel.set_ylabel(f"{panel.get_ylabel()}  [10$^{{{power}}}$]")


def cell_edges(values, width):
    """Borders of cells around values: half-way between neighbours; a single value has a cell of this half width."""
    if values.size == 1:
        return numpy.array([values[0] - width, values[0] + width])
    middle = 0.5 * (values[1:] + values[:-1])
    return numpy.concatenate([[1.5 * values[0] - 0.5 * values[1]], middle, [1.5 * values[-1] - 0.5 * values[-2]]])


def label(quantity, unit):
    """An axis label: "step h [s]"; a quantity without dimension, or of mixed ones ("SI"), has no brackets."""
    unit = unit.replace("*", "·").replace("^2", "²").replace("^3", "³")
    return quantity if unit in ("", "1", "SI") else f"{quantity} [{unit}]"


UNITS = {"stiffness": "N/m", "mass": "kg", "damping": "N·s/m", "rest_length": "m", "length": "m", "gravity": "m/s²"}


def parameter_label(path, absolute=False):
    """An axis label for a parameter by its path: "generate.stiffness.structural" is "stiffness (structural) [N/m]"."""
    parts = [part for part in path.split(".") if part not in ("generate", "parameters", "springs", "particles")
             and not part.startswith("problem[")]
    name = next((part for part in parts if part in UNITS), parts[-1] if parts else path)
    others = [part.replace("_", " ") for part in parts if part != name]
    shown = name.replace("_", " ") + (f" ({', '.join(others)})" if others else "")
    return label(f"|{shown}|" if absolute else shown, UNITS.get(name, ""))


def number(value):
    """A number as one would write it on a board: 0.5, 1e-05, 2.00001."""
    return f"{value:.6g}"


def new_figure(result, width, height, rows=1, columns=1, **options):
    """A figure with the study's title above and its provenance below; returns it and its axes, always 2D."""
    figure, axes = plt.subplots(rows, columns, figsize=(width, height), squeeze=False, **options)
    figure.suptitle(result.title)
    footer_height = 0.3 / height
    figure.get_layout_engine().set(rect=(0, footer_height, 1, 1 - footer_height), w_pad=0.1, h_pad=0.1)
    figure.text(8 / (72 * width), 6 / (72 * height), result.provenance(), fontsize=8.5,
                color=ALARM if result.warnings() else QUIET, va="bottom")
    return figure, axes


def save(figures, result, directory, formats=("png", "pdf")):
    """Writes each figure in these formats, named after the result file, and returns the paths of the first format."""
    written = []
    for index, figure in enumerate(figures, start=1):
        name_hidden_curves(figure)
        stem = result.path.stem if len(figures) == 1 else f"{result.path.stem}-{index}"
        for extension in formats:
            path = directory / f"{stem}.{extension}"
            # The picture depends on the result file alone: no time of drawing in it.
            options = {"metadata": {"CreationDate": None}} if extension == "pdf" else {}
            figure.savefig(path.with_name("." + path.name), format=extension, **options)
            os.replace(path.with_name("." + path.name), path)
        written.append(directory / f"{stem}.{formats[0]}")
        plt.close(figure)
    return written


def main(description, choose_drawing, arguments=None):
    """The command line of a plot script. `choose_drawing(result)` gives the function that makes the figures of a
    result, or None where there is nothing to draw. Exit code: 0 drawn, 2 a file is not what it should be."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("files", nargs="+", type=pathlib.Path, metavar="FILE.h5")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="DIR", help="default: beside each file")
    parser.add_argument("--formats", default="png,pdf", metavar="A,B", help="png, pdf, svg; default: png,pdf")
    parser.add_argument("--style", choices=("paper", "slide"), default="paper",
                        help="slide: 16:9, a panel per slide, letters of 20 points; default: paper, all panels at once")
    options = parser.parse_args(arguments)
    formats = options.formats.split(",")
    if not set(formats) <= {"png", "pdf", "svg"}:
        parser.error(f'--formats: found "{options.formats}", expected some of png, pdf, svg')
    code = 0
    for path in options.files:
        try:
            with ResultFile(path) as result:
                draw = choose_drawing(result)
                missing = result.not_computed()
                if missing and not result.cases():
                    print(f"{path}: nothing to draw: no case was computed")
                    continue
                if missing:
                    print(f"{path}: not drawn, since they could not be computed: {', '.join(missing)}", file=sys.stderr)
                if draw is None:
                    figures = []
                else:
                    figures = slides(draw, result) if options.style == "slide" else draw(result)
                if not figures:
                    print(f'{path}: nothing to draw for kind "{result.kind}"')
                    continue
                directory = options.output or path.parent
                directory.mkdir(parents=True, exist_ok=True)
                for written in save(figures, result, directory, formats):
                    print(written)
        except ResultError as error:
            print(error, file=sys.stderr)
            code = 2  # the other files are drawn all the same
    return code


def expect_kind(kind, draw):
    """For `main`: draws results of this kind and refuses all others."""
    def choose(result):
        result.expect_kind(kind)
        return draw
    return choose
