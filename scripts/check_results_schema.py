#!/usr/bin/env python3
"""Compares result files with their description: check_results_schema.py docs/results_schema.md FILE.h5...

Every dataset and root attribute of a file must be described, with its shape, type and unit, and everything described for
the file's kind must be there. A kind without a section of its own is held against "Studies in general". Prints one line
per deviation; the exit code is 1 if there is one.
"""
import re
import sys

import h5py


def tables(document):
    """Maps each heading to the rows of all tables below it (cells without backquotes)."""
    sections, heading = {}, None
    for line in document.splitlines():
        if line.startswith("## "):
            heading = line[3:].replace("`", "").strip()
            sections[heading] = []
        elif line.startswith("| `"):
            sections[heading].append([cell.strip() for cell in line.strip().strip("|").split("|")])
    return sections


def type_name(dtype):
    return "text" if h5py.check_string_dtype(dtype) else str(dtype)


def units(cell):
    return re.findall(r"`([^`]*)`", cell) or [""]


def datasets(file):
    found = {}
    file.visititems(lambda name, item: found.update({"/" + name: item}) if isinstance(item, h5py.Dataset) else None)
    return found


def pattern(path):
    return re.compile(re.sub(r"<\w+>", "[^/]+", path.replace("`", "")) + "$")


def check_attributes(rows, attributes, kind):
    described = {}
    for name, type_, kinds, *_ in rows:
        if kinds in ("all", kind):
            described[name.strip("`")] = type_
    for name, type_ in described.items():
        if name not in attributes:
            yield f"attribute {name} is missing"
        else:
            value = attributes[name]
            found = "text" if isinstance(value, str) else str(getattr(value, "dtype", type(value).__name__))
            if found != type_:
                yield f"attribute {name} is {found}, described as {type_}"
    for name in attributes:
        if name not in described:
            yield f"attribute {name} is not described"


def check_dataset(path, dataset, row, sizes):
    _, shape, type_, unit, *_ = row
    if "unit" not in dataset.attrs:
        yield f"{path} has no unit"
    elif unit != "any" and dataset.attrs["unit"] not in units(unit):
        yield f"{path} has unit {dataset.attrs['unit']!r}, described as {unit}"
    if type_ != "any" and type_name(dataset.dtype) != type_:
        yield f"{path} is {type_name(dataset.dtype)}, described as {type_}"
    if shape == "any":
        return
    described = [size.strip() for size in shape.strip("()").split(",") if size.strip()]
    if len(described) != len(dataset.shape):
        yield f"{path} has shape {dataset.shape}, described as {shape}"
        return
    scope = path.rsplit("/", 1)[0] if path.startswith("/cases/") else ""
    for size, found in zip(described, dataset.shape):
        expected = int(size) if size.isdigit() else sizes.setdefault((scope, size), found)
        if found != expected:
            yield f"{path} has shape {dataset.shape}, described as {shape} with {size} = {expected}"


def check(document, path):
    sections = tables(document)
    with h5py.File(path, "r") as file:
        kind = file.attrs["kind"]
        yield from check_attributes(sections["Root attributes"], file.attrs, kind)
        rows = sections.get(f"Kind {kind}", sections["Studies in general"])
        rows = [row for row in rows if row[0].startswith("`/")]
        rows.sort(key=lambda row: row[0].count("<"))  # a fixed name goes before a pattern
        used, sizes = set(), {}
        for name, dataset in datasets(file).items():
            row = next((row for row in rows if pattern(row[0]).match(name)), None)
            if row is None:
                yield f"{name} is not described"
                continue
            used.add(row[0])
            yield from check_dataset(name, dataset, row, sizes)
        if "cases" in file:
            for id_, group in file["cases"].items():
                for row in sections["Studies in general"]:
                    name = row[0].strip("`")
                    if not name.startswith("/") and not isinstance(group.attrs.get(name), str):
                        yield f"/cases/{id_} has no text attribute {name}"
            if not len(file["cases"]):
                return
        for row in rows:
            if row[0] not in used:
                yield f"{row[0].strip('`')} is described but not there"


def main():
    with open(sys.argv[1], encoding="utf-8") as document:
        description = document.read()
    deviations = [f"{path}: {line}" for path in sys.argv[2:] for line in check(description, path)]
    print("\n".join(deviations) if deviations else f"{len(sys.argv) - 2} file(s) as described")
    sys.exit(1 if deviations else 0)


if __name__ == "__main__":
    main()
