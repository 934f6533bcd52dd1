#!/usr/bin/env python3
"""docs/adding_an_integrator.md as a test: every block of it that is marked with a file name is applied to a copy of the
sources, compiled against the libraries of a build, and its commands are run.

usage: adding_an_integrator_test.py --build DIRECTORY

A block is marked by the line before it: **`path`** is a new file, **`path`** (change) a change in a file that exists,
whose lines with "-" and " " have to stand there exactly once. Commands end with exit code 0, or what their comment
"# exit code N" says. Compiled is only what the page adds or changes; the rest comes from the static libraries of the
build, so the page's text is tested as it stands at the price of a few files.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "adding_an_integrator.md"
MARK = re.compile(r"^\*\*`([^`]+)`\*\*( \(change\))?$")
INCLUDED = re.compile(r'^#include "([^"]+)"$', re.MULTILINE)
EXIT_CODE = re.compile(r"#\s*exit code (\d+)\s*$")


class Failure(Exception):
    pass


def blocks(text):
    """(mark or None, language, content, line number) of every fenced block of a page."""
    lines = text.split("\n")
    found, i = [], 0
    while i < len(lines):
        if lines[i].startswith("```"):
            end = lines.index("```", i + 1)
            mark = MARK.match(lines[i - 1]) if i else None
            found.append((mark, lines[i][3:], "\n".join(lines[i + 1:end]) + "\n", i + 1))
            i = end
        i += 1
    return found


def changed(original, diff, where):
    """`original` with the lines of a ```diff block replaced."""
    lines = diff.rstrip("\n").split("\n")
    if not all(line[:1] in ("+", "-", " ") for line in lines):
        raise Failure(f"{where}: a line of a change begins with +, - or a blank")
    old = "\n".join(line[1:] for line in lines if line[0] != "+")
    new = "\n".join(line[1:] for line in lines if line[0] != "-")
    count = original.count(old)
    if count != 1:
        raise Failure(f"{where}: these lines stand {count} times in the file, not once:\n{old}")
    return original.replace(old, new)


def apply_page(text, tree):
    """Writes what the page adds and changes below `tree`; returns the paths and the commands with their exit codes."""
    files, commands = {}, []
    for mark, language, content, line in blocks(text):
        where = f"{PAGE.name}:{line}"
        if mark is None:
            if language == "sh":
                for command in content.strip().split("\n"):
                    code = EXIT_CODE.search(command)
                    commands.append((command, int(code.group(1)) if code else 0))
            elif language == "cpp":
                raise Failure(f"{where}: a block of C++ without a file name would not be tested")
            continue
        path = mark.group(1)
        if mark.group(2):
            source = files.get(path) or (ROOT / path).read_text()
            files[path] = changed(source, content, where)
        else:
            if (ROOT / path).exists() or path in files:
                raise Failure(f"{where}: {path} exists already")
            files[path] = content
    for path, content in files.items():
        target = tree / path
        target.parent.mkdir(parents=True, exist_ok=True)
        if not target.exists() or target.read_text() != content:
            target.write_text(content)
    return sorted(files), commands


def run(command, directory, shell=False):
    return subprocess.run(command, cwd=directory, shell=shell, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)


class Build:
    """Compiles and links as the build in `directory` does, with the tree's files before those of the project."""

    def __init__(self, directory, tree):
        self.directory, self.tree = directory, tree
        entries = json.loads((directory / "compile_commands.json").read_text())
        self.commands = {entry["file"]: shlex.split(entry["command"]) for entry in entries}
        # Source -> the file of several sources with which it is compiled.
        self.together = {source: file for file in self.commands if "/Unity/" in file
                         for source in INCLUDED.findall(pathlib.Path(file).read_text())}
        answer = run(["ninja", "-t", "commands", "bin/federwerk"], directory)
        link = [line for line in answer.stdout.split("\n") if " -o bin/federwerk " in line]
        if answer.returncode != 0 or len(link) != 1:
            raise Failure(f"no link command for bin/federwerk in {directory}:\n{answer.stdout[-2000:]}")
        # ": && c++ ... -o bin/federwerk ... && :"
        self.link = shlex.split(re.sub(r"^: && | && :$", "", link[0]))

    def source_of(self, path):
        """What is compiled for a file of the tree: itself, or it and those that are compiled with it."""
        group = self.together.get(str(ROOT / path))
        if group is None:
            return self.tree / path
        text = pathlib.Path(group).read_text()
        for source in INCLUDED.findall(text):
            own = self.tree / pathlib.Path(source).relative_to(ROOT)
            if own.exists():
                text = text.replace(f'"{source}"', f'"{own}"')
        target = self.tree / "objects" / pathlib.Path(group).relative_to(self.directory).as_posix().replace("/", "_")
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text)
        return target

    def compile(self, path):
        """A new file is compiled like any other of its folder."""
        own = str(ROOT / path)
        folder = (ROOT / path).parent
        like = self.together.get(own) or (own if own in self.commands else next(
            (self.together.get(file, file) for file in [*self.commands, *self.together]
             if pathlib.Path(file).parent == folder), None))
        if like is None:
            raise Failure(f"nothing in {folder} shows how {path} is compiled")
        # Headers of the tree go before those of the rooms.
        command, result = self.commands[like], []
        first = next(k for k, word in enumerate(command) if word.startswith("-"))
        words = iter(command[:first] + [f"-I{self.tree / 'src'}"] + command[first:])
        for word in words:
            if word in ("-o", "-c"):
                next(words)
            else:
                result.append(word)
        source = self.source_of(path)
        target = self.tree / "objects" / (source.relative_to(self.tree).as_posix().replace("/", "_") + ".o")
        target.parent.mkdir(parents=True, exist_ok=True)
        answer = run(result + ["-Werror", "-o", str(target), "-c", str(source)], self.directory)
        if answer.returncode != 0:
            raise Failure(f"{path} does not compile:\n{answer.stdout[-6000:]}")
        return target

    def link_with(self, objects, executable):
        """Objects come before the libraries, whose members of the same names are then not looked at."""
        command, output = list(self.link), self.link.index("-o")
        executable.parent.mkdir(parents=True, exist_ok=True)
        command[output + 1] = str(executable)
        command[output:output] = [str(file) for file in objects]
        answer = run(command, self.directory)
        if answer.returncode != 0:
            raise Failure(f"the executable does not link:\n{answer.stdout[-4000:]}")


def findings(executable, method):
    """verify's rows for a method, by property."""
    answer = subprocess.run([str(executable), "verify", "--json", "--method", method], text=True,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if not answer.stdout:
        raise Failure(f"verify --method {method} says nothing:\n{answer.stderr[-2000:]}")
    return answer.returncode, {row["property"]: row for row in json.loads(answer.stdout)}


def check_applier():
    """The examiner is examined: what is not there, or there twice, is refused."""
    assert changed("a\nb\nc\n", "-b\n+B\n", "self") == "a\nB\nc\n"
    assert changed("a\nb\nc\n", " b\n+x\n", "self") == "a\nb\nx\nc\n"
    for original in ("a\nc\n", "b\nb\n"):
        try:
            changed(original, "-b\n+B\n", "self")
        except Failure:
            continue
        raise AssertionError(f"a change of {original!r} went through")


def examine(build_directory):
    tree = build_directory / "adding_an_integrator"
    shutil.rmtree(tree, ignore_errors=True)
    files, commands = apply_page(PAGE.read_text(), tree)
    build = Build(build_directory, tree)
    groups = {build.together.get(str(ROOT / path), path): path for path in files if path.endswith(".cpp")}
    sources = list(groups.values())  # one of each group
    with concurrent.futures.ThreadPoolExecutor(max_workers=min(2, os.cpu_count() or 1)) as pool:
        objects = list(pool.map(build.compile, sources))
    executable = tree / "build" / "release" / "bin" / "federwerk"
    build.link_with(objects, executable)
    print(f"{len(files)} files of the page applied, {len(objects)} compiled")

    ran = 0
    for command, expected in commands:
        answer = run(["bash", "-c", command], tree)
        if answer.returncode != expected:
            raise Failure(f"exit code {answer.returncode} instead of {expected}: {command}\n{answer.stdout[-6000:]}")
        ran += 1
    if ran < 4:
        raise Failure(f"{PAGE.name}: only {ran} commands found")
    print(f"{ran} commands run")

    # What the page says of them.
    for method, order in (("nystrom3", 3), ("omelyan2", 2), ("modified_midpoint", 2)):
        _, rows = findings(executable, method)
        orders = [row for name, row in rows.items() if name.startswith("order")]
        if not any(row["verdict"] == "holds" and row["claimed"] == str(order) for row in orders):
            raise Failure(f"{method}: order {order} is not among the findings {orders}")
        if "holds" not in {row["verdict"] for row in rows.values()} or any(
                row["verdict"] == "fails" for row in rows.values()):
            raise Failure(f"{method}: {rows}")
    answer = run([str(executable), "run", "energy_drift.toml", "-o", "energy_drift"], tree)
    holds = len(re.findall(r"\bholds\b", answer.stdout))
    words = " ".join(answer.stdout.split())  # reasons are wrapped
    if holds != 3 or not re.search(r"largest drift 39(\.\d*)? J", words):
        raise Failure(f"three cases hold and explicit Euler gains 39 J, says the page, but:\n{answer.stdout}")

    # The seeded mistake that the page names.
    path = "src/integrators/special/modified_midpoint.cpp"
    wrong = changed((tree / path).read_text(), "-(2.0 * substep)\n+substep\n", "seeded mistake")
    (tree / path).write_text(wrong)
    build.compile(path)
    build.link_with(objects, executable)
    code, rows = findings(executable, "modified_midpoint")
    if code != 1 or not any(row["verdict"] == "fails" for name, row in rows.items() if name.startswith("order")):
        raise Failure(f"verify does not see the wrong factor: exit code {code}, {rows}")
    print("the seeded mistake is found")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    try:
        check_applier()
        examine(arguments.build.resolve())
    except Failure as failure:
        print(f"adding_an_integrator_test: {failure}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
