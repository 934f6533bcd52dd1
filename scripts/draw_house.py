#!/usr/bin/env python3
"""Draws the rooms of src/ (src/rooms.txt) floor by floor: docs/images/house.png.

    scripts/python scripts/draw_house.py           draws it
    scripts/python scripts/draw_house.py --check   exit code 1 where the picture is of other rooms

The picture carries the SHA-256 of the rooms it shows, so that a test can tell whether it is of today's.
"""

import argparse
import hashlib
import pathlib
import re
import sys
import textwrap

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent
KEY = "rooms-sha256"


def floors_of(text):
    """[(title, [(room, rooms that it includes directly, foreign libraries)])] from the ground up."""
    floors = []
    for line in text.splitlines():
        heading = re.match(r"#\s*Floor \d+:\s*(.*)", line)
        if heading:
            floors.append((heading[1], []))
        line = line.split("#")[0].strip()
        if line:
            room, _, rest = line.partition(":")
            others, _, libraries = rest.partition("|")
            floors[-1][1].append((room.strip(), others.split(), libraries.split()))
    return floors


def digest(text):
    """Of what the picture shows: comments other than floors do not count."""
    return hashlib.sha256(repr(floors_of(text)).encode()).hexdigest()


def draw(floors, output, sha256):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.patches import FancyBboxPatch

    per_row = 5
    rows = [(title if start == 0 else "", rooms[start:start + per_row])
            for title, rooms in floors for start in range(0, len(rooms), per_row)]
    height = len(rows)
    figure, axes = plt.subplots(figsize=(13.3, 0.78 * height + 0.6))
    shades = ["#f2efe6", "#e6eef5"]
    shade = -1
    for y, (title, rooms) in enumerate(rows):
        shade += bool(title)
        axes.axhspan(y, y + 1, color=shades[shade % 2], zorder=0, linewidth=0)
        if title:
            words = textwrap.fill(f"{shade}  {title}", 26, subsequent_indent="    ")
            axes.text(0.05, y + 0.5, words, va="center", fontsize=11, color="#444444")
        for k, (room, others, libraries) in enumerate(rooms):
            x = 2.75 + 2.12 * k
            axes.add_patch(FancyBboxPatch((x, y + 0.12), 1.9, 0.78, boxstyle="round,pad=0.02", facecolor="white",
                                          edgecolor="#336699" if libraries else "#888888", linewidth=1.3))
            name = room if len(room) <= 17 else room.replace("/", "/\n")
            axes.text(x + 0.95, y + 0.7, name, ha="center", va="center", fontsize=9.5, weight="bold", linespacing=0.9)
            below = textwrap.shorten(", ".join(others), 34, placeholder=" …")
            axes.text(x + 0.95, y + 0.4, below, ha="center", va="center", fontsize=7, color="#555555")
            axes.text(x + 0.95, y + 0.23, ", ".join(libraries), ha="center", va="center", fontsize=7.5, color="#336699")
    axes.set_xlim(0, 13.4)
    axes.set_ylim(0, height)
    axes.set_axis_off()
    axes.set_title("A room includes the rooms named in it, which are on its floor or below (grey), and through them theirs; "
                   "blue: foreign libraries", fontsize=10, loc="left")
    figure.savefig(output, dpi=110, bbox_inches="tight", metadata={KEY: sha256})


def drawn_digest(picture):
    """The digest that a picture carries, or None."""
    match = re.search(KEY.encode() + rb"\x00([0-9a-f]{64})", picture.read_bytes()) if picture.exists() else None
    return match[1].decode() if match else None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="only say whether the picture is of today's rooms")
    parser.add_argument("--rooms", type=pathlib.Path, default=CHECKOUT / "src" / "rooms.txt")
    parser.add_argument("--output", type=pathlib.Path, default=CHECKOUT / "docs" / "images" / "house.png")
    arguments = parser.parse_args()
    text = arguments.rooms.read_text(encoding="utf-8")
    if not arguments.check:
        draw(floors_of(text), arguments.output, digest(text))
    elif drawn_digest(arguments.output) != digest(text):
        print(f"{arguments.output}: the picture is not of the rooms in {arguments.rooms}; run scripts/draw_house.py",
              file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
