"""Reads federwerk's result files (docs/results_schema.md). Reads only: every number is computed by federwerk."""

import pathlib
import shlex
import tomllib

import h5py
import numpy


class ResultError(Exception):
    """A file that is not what it should be; the message names the file."""


def text(value):
    """Text of an attribute or of an entry of a column."""
    return value.decode("utf-8") if isinstance(value, bytes) else str(value)


class ResultFile:
    """An open result file; use it in a with statement."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        try:
            self.file = h5py.File(self.path, "r")
        except OSError as error:
            raise ResultError(f"{self.path}: cannot be read as HDF5: {error}") from error
        attributes = self.file.attrs
        if text(attributes.get("format", "")) != "federwerk":
            raise ResultError(f'{self.path}: not a result file of federwerk (no attribute format = "federwerk")')
        self.kind = text(attributes.get("kind", ""))
        self.title = text(attributes.get("title", self.path.stem))
        self.complete = text(attributes.get("status", "complete")) == "complete"
        self.quick = bool(attributes.get("quick", 0))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.file.close()

    def error(self, message):
        return ResultError(f"{self.path}: {message}")

    def expect_kind(self, kind):
        if self.kind != kind:
            raise self.error(f'found kind "{self.kind}", expected "{kind}"')

    def spec(self):
        """The resolved input as a dictionary; empty where the file has none."""
        try:
            return tomllib.loads(text(self.file.attrs.get("spec", "")))
        except tomllib.TOMLDecodeError as error:
            raise self.error(f"the attribute spec is no TOML: {error}") from error

    def how_it_ran(self):
        """Of a trajectory: method and step or tolerances, as `federwerk simulate` was called; empty where unknown."""
        try:
            words = shlex.split(text(self.file.attrs.get("command_line", "")))
        except ValueError:
            return ""
        given = {}
        for word, following in zip(words, words[1:] + [""]):
            name, equals, value = word.partition("=")
            if name in ("--method", "--step", "--rtol", "--atol"):
                given[name] = value if equals else following
        parts = [given[name] if name == "--method" else f"{short} = {given[name]}{unit}"
                 for name, short, unit in (("--method", "", ""), ("--step", "h", " s"), ("--rtol", "rtol", ""),
                                           ("--atol", "atol", "")) if name in given]
        return ", ".join(parts)

    def warnings(self):
        """What a reader of the picture must not miss, as short texts: coarse, incomplete, failed."""
        found = ["QUICK, coarse"] if self.quick else []
        if not self.complete:
            found.append("STOPPED before its end" if self.kind == "trajectory" else "INCOMPLETE: cases are missing")
        failed = len(self.not_computed())
        if failed:
            found.append(f"{failed} case{'s' if failed > 1 else ''} could not be computed")
        return found

    def provenance(self):
        """One line: file, how a trajectory ran, commit, date. The title stands above the picture."""
        attributes = self.file.attrs
        commit = text(attributes.get("git_commit", "unknown"))[:10]
        dirty = " + uncommitted changes" if bool(attributes.get("git_dirty", False)) else ""
        created = text(attributes.get("created", "unknown date"))[:10]
        how = self.how_it_ran() if self.kind == "trajectory" else ""
        parts = [self.path.name, how, f"federwerk {commit}{dirty}", created, *self.warnings()]
        return " · ".join(part for part in parts if part)

    def dataset(self, name, group=None):
        parent = self.file if group is None else group
        if name not in parent:
            raise self.error(f"found no {parent.name.rstrip('/')}/{name}")
        return parent[name]

    def values(self, name, group=None):
        """A dataset's values as an array of numbers, or as a list where they are text."""
        data = self.dataset(name, group)[()]
        if isinstance(data, (bytes, str)):
            return text(data)
        if data.dtype.kind in "OS":
            return [text(entry) for entry in data]
        return data

    def unit(self, name, group=None):
        return text(self.dataset(name, group).attrs.get("unit", ""))

    @staticmethod
    def was_computed(group):
        """Whether a case has a result: one that threw, crashed or ran out of time has a group, but no key."""
        return text(group.attrs.get("key", "a file without keys")) != ""

    def not_computed(self):
        """The names of the cases that have no result."""
        return [name for name, group in self.file.get("cases", {}).items() if not self.was_computed(group)]

    def cases(self):
        """The groups below /cases by name that have a result, without the vector field."""
        groups = {name: group for name, group in self.dataset("cases").items() if name != "vector_field"}
        if not groups:
            raise self.error("found no case below /cases")
        return {name: group for name, group in groups.items() if self.was_computed(group)}

    def columns(self):
        """The columns of the summary by name, without the rows of cases that have no result."""
        columns = {name: self.values(name, self.file["summary"]) for name in self.dataset("summary")}
        lengths = {len(column) for column in columns.values()}
        if len(lengths) != 1:
            raise self.error(f"the columns of /summary have the lengths {sorted(lengths)}, expected one length")
        missing = set(self.not_computed())
        if not missing or "case" not in columns:
            return columns
        kept = [row for row, name in enumerate(columns["case"]) if name not in missing]
        return {name: [column[row] for row in kept] if isinstance(column, list) else column[kept]
                for name, column in columns.items()}

    def summary(self):
        """The rows of the summary that have a result: a list of dictionaries, column name to value."""
        columns = self.columns()
        return [dict(zip(columns, row)) for row in zip(*columns.values())]

    def case_of(self, row):
        """The group of the case that a summary row describes."""
        name = row.get("case") or row.get("id") or f"{row.get('problem')}-{row.get('method')}"
        return self.dataset(f"cases/{name}")

    def fact(self, name, group):
        """What a case says of itself, as an attribute or as a column with one entry."""
        if name in group.attrs:
            value = group.attrs[name]
        else:
            value = self.values(name, group)
        if isinstance(value, (bytes, str)):
            return text(value)
        value = numpy.ravel(numpy.asarray(value, dtype=object))
        if len(value) != 1:
            raise self.error(f"{group.name}/{name} has {len(value)} entries, expected one")
        return text(value[0]) if isinstance(value[0], (bytes, str)) else float(value[0])
