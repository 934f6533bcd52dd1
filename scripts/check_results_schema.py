#!/usr/bin/env python3
"""Compares result files with their description: check_results_schema.py docs/results_schema.md FILE.h5...

Every dataset and attribute of a file must be described, with its shape, type and unit, and everything described for the
file's kind must be there: in the file, and in every case. A table's column "present" says where a dataset is: "always",
"with `x`" or "without `x`" (x in the same group); any other text makes it optional. A kind without a section of its own is
held against "Studies in general". Prints one line per deviation; the exit code is 1 if there is one.
"""
import re
import sys
import tomllib

import h5py

COLUMNS = ("dataset", "attribute", "shape", "type", "unit", "kinds", "present", "meaning")
UNIT = re.compile(r"(1|[A-Za-z]+(\^\d+)?)([*/][A-Za-z]+(\^\d+)?)*")


def cells(line):
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def tables(document):
    """Maps each heading to the rows of all tables below it; a row maps the head of each column to its cell."""
    sections, rows, head = {}, None, None
    for number, line in enumerate(document.splitlines(), 1):
        if line.startswith("## "):
            rows = sections.setdefault(line[3:].replace("`", "").strip(), [])
        elif not line.startswith("|"):
            head = None
        elif head is None:
            head = cells(line)
            if not set(head) <= set(COLUMNS):
                raise ValueError(f"line {number} of the description: found columns {head}, expected some of {COLUMNS}")
        elif not line.startswith("|---"):
            if len(cells(line)) != len(head):
                raise ValueError(f"line {number} of the description: found {len(cells(line))} cells, expected {len(head)}")
            rows.append(dict(zip(head, cells(line))))
    return sections


def name_of(row):
    return (row.get("dataset") or row["attribute"]).strip("`")


def type_name(dtype):
    return "text" if h5py.check_string_dtype(dtype) else str(dtype)


def value_type(value):
    return "text" if isinstance(value, str) else str(getattr(value, "dtype", type(value).__name__))


def quoted(cell):
    return re.findall(r"`([^`]*)`", cell)


def datasets(file):
    found = {}
    file.visititems(lambda name, item: found.update({"/" + name: item}) if isinstance(item, h5py.Dataset) else None)
    return found


def pattern(path):
    return re.compile("[^/]+".join(re.escape(part) for part in re.split(r"<\w+>", path)))


def is_optional(row):
    """What there is "only where" or "only with" something, as its meaning begins."""
    return row.get("meaning", "").startswith("only w")


def check_attributes(rows, attributes, where):
    described = {name_of(row): row["type"] for row in rows}
    optional = {name_of(row) for row in rows if is_optional(row)}
    for name, type_ in described.items():
        if name not in attributes:
            if name not in optional:
                yield f"{where}attribute {name} is missing"
        elif value_type(attributes[name]) != type_:
            yield f"{where}attribute {name} is {value_type(attributes[name])}, described as {type_}"
    for name in attributes:
        if name not in described:
            yield f"{where}attribute {name} is not described"


def check_unit(path, dataset, row):
    unit = dataset.attrs.get("unit")
    if not isinstance(unit, str):
        yield f"{path} has no unit"
    elif row["unit"] != "any" and unit not in (quoted(row["unit"]) or [""]):
        yield f"{path} has unit {unit!r}, described as {row['unit'] or 'none'}"
    elif unit and not UNIT.fullmatch(unit):
        yield f"{path} has unit {unit!r}, expected one written like kg*m^2/s"


def check_dataset(path, dataset, row, sizes):
    yield from check_unit(path, dataset, row)
    if row["type"] != "any" and type_name(dataset.dtype) != row["type"]:
        yield f"{path} is {type_name(dataset.dtype)}, described as {row['type']}"
    shape = row["shape"]
    if shape == "any":
        return  # the general description of a column leaves its attributes open, too
    texts = [{"attribute": name, "type": "text"} for name in re.findall(r"attribute `(\w+)`", row["meaning"])]
    if "missing" in dataset.attrs and row["type"] == "int64":
        texts.append({"attribute": "missing", "type": "text"})  # see "Conventions"
    yield from check_attributes([{"attribute": "unit", "type": "text"}, *texts], dataset.attrs, f"{path}: ")
    described = [size.strip() for size in shape.strip("()").split(",") if size.strip()]
    if len(described) != len(dataset.shape):
        yield f"{path} has shape {dataset.shape}, described as {shape}"
        return
    scope = path.rsplit("/", 1)[0] if path.startswith("/cases/") else ""
    for size, found in zip(described, dataset.shape):
        expected = int(size) if size.isdigit() else sizes.setdefault((scope, size), found)
        if found != expected:
            yield f"{path} has shape {dataset.shape}, described as {shape} with {size} = {expected}"


def check_presence(group, row, members):
    """Holds a row against a group that it applies to: `members` are the names of its datasets."""
    name = name_of(row).rsplit("/", 1)[1]
    there = row.get("present", "sometimes" if is_optional(row) else "always")
    found = any(pattern(name).fullmatch(member) for member in members)
    condition = re.fullmatch(r"(with|without) `(\w+)`", there)
    if condition:
        expected = (condition[2] in members) == (condition[1] == "with")
        if expected != found:
            yield f"{group}/{name} is {'there' if found else 'not there'}, described as there {there}"
    elif there == "always" and not found:
        yield f"{group}/{name} is described but not there"


def check(document, path):
    sections = tables(document)
    general = sections["Studies in general"]
    with h5py.File(path, "r") as file:
        kind = file.attrs["kind"]
        root = [row for row in sections["Root attributes"] if row["kinds"] in ("all", kind)]
        yield from check_attributes(root, file.attrs, "")
        tables_of_kind = list(sections.get(f"Kind {kind}", general))
        if kind == "sweep":  # has what its inner kind has
            tables_of_kind += sections[f"Kind {tomllib.loads(file.attrs['spec'])['study']['kind']}"]
        rows = [row for row in tables_of_kind if "dataset" in row]
        rows.sort(key=lambda row: name_of(row).count("<"))  # a fixed name takes precedence over a pattern
        sizes, members = {}, {}
        for name, dataset in datasets(file).items():
            members.setdefault(name.rsplit("/", 1)[0], []).append(name.rsplit("/", 1)[1])
            row = next((row for row in rows if pattern(name_of(row)).fullmatch(name)), None)
            if row is None:
                yield f"{name} is not described"
            else:
                yield from check_dataset(name, dataset, row, sizes)
        for id_, case in file.get("cases", {}).items():
            members.setdefault(f"/cases/{id_}", [])
            yield from check_attributes([row for row in general if "attribute" in row], case.attrs, f"/cases/{id_}: ")
        if "cases" in file and not len(file["cases"]):
            return  # without a case the summary has no columns
        for row in rows:
            parent = name_of(row).rsplit("/", 1)[0]
            if not parent.startswith("/cases/"):
                members.setdefault(parent, [])
            for group in [group for group in members if pattern(parent).fullmatch(group)]:
                yield from check_presence(group, row, members[group])


def report(description, paths):
    """Prints the deviations of files from the text of a description; the exit code."""
    deviations = [f"{path}: {line}" for path in paths for line in check(description, path)]
    print("\n".join(deviations) if deviations else f"{len(paths)} file(s) as described")
    return 1 if deviations else 0


def main():
    with open(sys.argv[1], encoding="utf-8") as document:
        description = document.read()
    sys.exit(report(description, sys.argv[2:]))


if __name__ == "__main__":
    main()
