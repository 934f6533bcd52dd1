#!/usr/bin/env python3
"""Compares two result files of federwerk bit for bit: every dataset and attribute but what the machine measured.

usage: scripts/python scripts/compare_results.py BEFORE.h5 AFTER.h5

Left out are the build and the moment (created, command_line, git_*, compiler*, cpu, libraries), the keys of cases,
which depend on the program, and columns with "seconds" or "memory" in their name. Of a reason, which repeats numbers
of other columns, only the words count. A NaN equals a NaN. What only AFTER has is told, but is no difference. Exit
code: 0 the same, 1 they differ, 2 a file cannot be read.
"""

import argparse
import dataclasses
import hashlib
import re
import sys

import h5py
import numpy

PROVENANCE = {"created", "command_line", "git_commit", "git_dirty", "compiler", "compiler_flags", "cpu", "libraries"}
NUMBER = re.compile(r"[-+]?\d[\d.]*(e[-+]?\d+)?|\binf\b|\bnan\b|-inf\b")


def is_measured(name):
    """Whether a dataset holds what the machine measured, as study/comparison.hpp decides it."""
    return "seconds" in name or "memory" in name


@dataclasses.dataclass
class Comparison:
    differences: list = dataclasses.field(default_factory=list)  # one sentence each: where, index, both values
    additions: list = dataclasses.field(default_factory=list)  # what only the second file has
    datasets: int = 0  # compared
    values: int = 0  # in them


def text(value):
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


def is_text(array):
    return array.dtype.kind in "OSU"


def first_text_difference(before, after):
    """The first lines in which two texts differ."""
    lines = zip(before.split("\n") + ["<end>"], after.split("\n") + ["<end>"])
    return next(((a, b) for a, b in lines if a != b), (before[-40:], after[-40:]))


def differing(before, after):
    """The flat indices at which two arrays of the same type and shape differ; a NaN equals a NaN."""
    if is_text(before):
        return [k for k, (a, b) in enumerate(zip(before.ravel(), after.ravel())) if text(a) != text(b)]
    bits = numpy.dtype(f"u{before.dtype.itemsize}")
    different = numpy.ascontiguousarray(before).reshape(-1).view(bits) != \
        numpy.ascontiguousarray(after).reshape(-1).view(bits)
    if before.dtype.kind == "f":
        different &= ~(numpy.isnan(before.reshape(-1)) & numpy.isnan(after.reshape(-1)))
    return numpy.flatnonzero(different)


def compare_values(where, before, after, found):
    """Adds a sentence to `found.differences` if two arrays differ."""
    before, after = numpy.asarray(before), numpy.asarray(after)
    if is_text(before) != is_text(after) or (not is_text(before) and before.dtype != after.dtype):
        found.differences.append(f"{where}: type {before.dtype} before, {after.dtype} after")
        return
    if before.shape != after.shape:
        found.differences.append(f"{where}: shape {before.shape} before, {after.shape} after")
        return
    found.values += before.size
    where_different = differing(before, after)
    if len(where_different) == 0:
        return
    index = where_different[0]
    place = ", ".join(str(int(i)) for i in numpy.unravel_index(index, before.shape)) if before.shape else ""
    a, b = before.reshape(-1)[index], after.reshape(-1)[index]
    if is_text(before):
        a, b = (repr(line) for line in first_text_difference(text(a), text(b)))
    elif before.dtype.kind == "f":
        a, b = (f"{float(value)!r} ({float(value).hex()})" for value in (a, b))
    more = f"; {len(where_different)} of {before.size} values differ" if before.size > 1 else ""
    found.differences.append(f"{where}[{place}]: {a} before, {b} after{more}")


def words(value):
    """A text or an array of texts without the numbers in it."""
    if isinstance(value, (bytes, str)):
        return NUMBER.sub("#", text(value))
    return numpy.array([NUMBER.sub("#", text(entry)) for entry in numpy.ravel(value)], dtype=object)


def compare_names(where, before, after, found):
    """The names in both, after telling of the others and of another order."""
    for name in before:
        if name not in after:
            found.differences.append(f"{where}/{name}: missing after")
    found.additions.extend(f"{where}/{name}" for name in after if name not in before)
    common = [name for name in before if name in after]
    if common != [name for name in after if name in before]:
        found.differences.append(f"{where}: the order of {', '.join(common[:5])}… is another one after")
    return common


def compare_attributes(where, before, after, found, left_out):
    names = [[name for name in attributes if name not in left_out] for attributes in (before, after)]
    for name in compare_names(f"{where} attribute", sorted(names[0]), sorted(names[1]), found):
        a, b = before[name], after[name]
        if name == "reason":
            a, b = words(a), words(b)
        compare_values(f"{where} attribute {name}", a, b, found)


def compare_groups(where, before, after, found):
    compare_attributes(where or "/", before.attrs, after.attrs, found, {"key"} if where else PROVENANCE)
    for name in compare_names(where, list(before), list(after), found):
        a, b, place = before[name], after[name], f"{where}/{name}"
        if isinstance(a, h5py.Group) != isinstance(b, h5py.Group):
            found.differences.append(f"{place}: a group in one file, a dataset in the other")
        elif isinstance(a, h5py.Group):
            compare_groups(place, a, b, found)
        elif not is_measured(name):
            found.datasets += 1
            compare_attributes(place, a.attrs, b.attrs, found, ())
            a, b = a[()], b[()]
            if name == "reason":
                a, b = words(a), words(b)
            compare_values(place, a, b, found)


def compare_files(before, after):
    """Compares two result files; a Comparison."""
    found = Comparison()
    with h5py.File(before, "r", track_order=True) as a, h5py.File(after, "r", track_order=True) as b:
        compare_groups("", a, b, found)
    return found


DIGESTED = {  # of a trajectory
    "trajectory": ("time", "position", "velocity", "kinetic_energy", "potential_energy", "total_energy",
                   "elastic_energy", "gravitational_energy", "obstacle_energy", "linear_momentum", "angular_momentum"),
    "counters": ("rhs_evaluations", "jacobian_evaluations", "jacobian_products", "factorisations", "linear_solves",
                 "linear_iterations", "newton_iterations", "accepted_steps", "rejected_steps"),
}


def digest(path):
    """SHA-256 of the states, energies, momenta and counters of a trajectory, with their types and shapes."""
    sha = hashlib.sha256()
    with h5py.File(path, "r") as file:
        for group, names in DIGESTED.items():
            for name in names:
                data = numpy.ascontiguousarray(file[group][name][()])
                sha.update(f"{group}/{name} {data.dtype.str} {data.shape}\n".encode())
                sha.update(data.tobytes())
    return sha.hexdigest()


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("before", metavar="BEFORE.h5")
    parser.add_argument("after", metavar="AFTER.h5")
    arguments = parser.parse_args()
    try:
        found = compare_files(arguments.before, arguments.after)
    except OSError as error:
        print(f"compare_results.py: {error}", file=sys.stderr)
        return 2
    for difference in found.differences:
        print(difference)
    for addition in found.additions:
        print(f"only in {arguments.after}: {addition}")
    print(f"{found.values} values in {found.datasets} datasets compared, {len(found.differences)} differences")
    return 1 if found.differences else 0


if __name__ == "__main__":
    sys.exit(main())
