#!/usr/bin/env python3
"""Checks that the rooms (folders) of src/ include only what src/rooms.txt allows.

A room includes itself, the rooms that its line names, and theirs. Each foreign library is included by the rooms
that name it and nowhere else. Random numbers come from a named seed. Exit code 0: all is well; 1: violations, one a
line; 2: bad usage.
"""

import argparse
import pathlib
import re
import sys
import tempfile

# Foreign header (regular expression on what stands between the brackets) -> the library's name in rooms.txt. Libraries
# that are not here (Eigen, Boost, fmt) are for every room.
LIBRARIES = [
    (r"(hdf5|hdf5_hl|H5[A-Z]\w*)\.h(pp)?$", "hdf5"),
    (r"gsl/", "gsl"),
    (r"(sundials|cvodes?|arkode|idas?|kinsol|nvector|sunmatrix|sunlinsol|sunnonlinsol|sunmemory)/", "sundials"),
    (r"(petsc|slepc)", "petsc"),
    (r"(klu|cholmod)\.h", "suitesparse"),
    (r"toml(\+\+/|\.hpp)", "tomlplusplus"),
    (r"CLI/", "cli11"),
    (r"openssl/", "openssl"),
]

# What is generated into the build folder and thus has no folder in its name.
GENERATED = {"provenance_build.hpp": "system"}

UNSEEDED = [
    (re.compile(r"(::|\.|->)\s*(set)?Random\s*\("), "Eigen's Random() has no named seed; use std::mt19937_64"),
    (re.compile(r"\bstd\s*::\s*random_device\b"), "std::random_device has no named seed; use std::mt19937_64"),
    (re.compile(r"\bs?rand\s*\("), "rand() has no named seed; use std::mt19937_64"),
]

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')
COMMENT_OR_TEXT = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.DOTALL)


def blank(match):
    """Comments and literals as spaces, so that line numbers stay."""
    return re.sub(r"[^\n]", " ", match.group(0))


def folder_of(path, root):
    """"oracles/gsl" for src/oracles/gsl/a.cpp."""
    return path.relative_to(root).parent.as_posix()


class Rooms:
    """The rooms of rooms.txt: what each includes, directly and through others, and its foreign libraries."""

    def __init__(self, text):
        self.reach = {}  # room -> all rooms that it may include, itself too
        self.owners = {}  # library -> rooms
        self.faults = []  # (line, reason)
        for number, line in enumerate(text.splitlines(), start=1):
            line = line.split("#")[0].strip()
            if line:
                self._read(number, line)

    def _read(self, number, line):
        room, _, rest = line.partition(":")
        room = room.strip()
        others, _, libraries = rest.partition("|")
        if room in self.reach:
            self.faults.append((number, f"room {room} is listed twice"))
        reach = {room}
        for name in others.split():
            inside = [r for r in self.reach if r.startswith(name[:-1])] if name.endswith("/*") else [name]
            for other in inside:
                if other not in self.reach:
                    self.faults.append((number, f"room {room} names {other}, which is not above it"))
                reach |= self.reach.get(other, set())
        self.reach[room] = reach
        for library in libraries.split():
            self.owners.setdefault(library, []).append(room)

    def violation(self, room, included):
        """Why `room` must not include the project's header `included`, or None."""
        if included in GENERATED:
            owner = GENERATED[included]
            return None if room == owner else f'"{included}" is for {owner}/ only'
        target = pathlib.PurePosixPath(included).parent.as_posix()
        if target not in self.reach:
            return f'"{included}" does not begin with a folder of src/'
        if target not in self.reach[room]:
            return f"{room}/ includes {target}/, which src/rooms.txt does not allow"
        return None

    def foreign_violation(self, room, included):
        """Why `room` must not include the foreign header `included`, or None."""
        for pattern, library in LIBRARIES:
            owners = self.owners.get(library, [])
            if re.match(pattern, included) and room not in owners:
                return f"<{included}>: {library} is for {', '.join(o + '/' for o in owners)} only"
        return None


def source_files(root):
    return sorted(p for p in root.rglob("*") if p.suffix in (".cpp", ".hpp", ".h", ".c", ".cc", ".inl", ".ipp"))


def violations(checkout):
    """All violations below `checkout` as "file:line: reason"."""
    rooms = Rooms((checkout / "src" / "rooms.txt").read_text(encoding="utf-8"))
    found = [f"src/rooms.txt:{line}: {reason}" for line, reason in rooms.faults]
    for part in ("src", "tests"):
        root = checkout / part
        for path in source_files(root):
            text = path.read_text(encoding="utf-8")
            name = path.relative_to(checkout).as_posix()
            room = folder_of(path, root)
            if part == "src" and room == ".":
                continue  # the precompiled header
            if part == "src" and room not in rooms.reach:
                found.append(f"{name}:1: folder {room}/ is not among the rooms of src/rooms.txt")
                continue
            code = COMMENT_OR_TEXT.sub(blank, text).splitlines()
            for number, (line, bare) in enumerate(zip(text.splitlines(), code), start=1):
                include = INCLUDE.match(line)
                if include and part == "src" and "#" in bare:
                    foreign = rooms.foreign_violation(room, include[2])
                    own = rooms.violation(room, include[2]) if include[1] == '"' else None
                    reason = foreign or own
                    if reason:
                        found.append(f"{name}:{number}: {reason}")
                for pattern, reason in UNSEEDED:
                    if pattern.search(bare):
                        found.append(f"{name}:{number}: {reason}")
    return found


ROOMS = pathlib.Path(__file__).resolve().parent.parent / "src" / "rooms.txt"

# Self test: (file, text, what the violation must say, or None where the text is lawful).
SEEDS = [
    ("src/rooms.txt", "core: ode\node:\n", "names ode, which is not above it"),
    ("src/rooms.txt", "core:\node: core\ncore:\n", "is listed twice"),
    ("src/study/energy/a.cpp", '#include "study/jacobian/jacobian.hpp"\n', "which src/rooms.txt does not allow"),
    ("src/study/a.cpp", '#include "study/energy/energy.hpp"\n', "which src/rooms.txt does not allow"),
    ("src/ode/a.cpp", '#include "core/types.hpp"\n', None),
    ("src/ode/a.cpp", '#include "ode/ivp.hpp"\n', None),
    ("src/ode/a.cpp", '#include "linalg/newton.hpp"\n', "which src/rooms.txt does not allow"),
    ("src/core/a.hpp", '  #  include "app/main.hpp"\n', "which src/rooms.txt does not allow"),
    ("src/ode/a.cpp", '// #include "linalg/newton.hpp"\n', None),
    ("src/ode/a.cpp", '/*\n#include "linalg/newton.hpp"\n*/\n', None),
    ("src/ode/a.cpp", '#include "ivp.hpp"\n', "does not begin with a folder"),
    ("src/ode/a.cpp", '#include "../app/main.hpp"\n', "does not begin with a folder"),
    ("src/system/a.cpp", '#include "provenance_build.hpp"\n', None),
    ("src/ode/a.cpp", '#include "provenance_build.hpp"\n', "for system/ only"),
    ("src/oracles/gsl/a.cpp", '#include "oracles/tolerances.hpp"\n', None),
    ("src/oracles/gsl/a.cpp", '#include "oracles/gsl/driver.hpp"\n', None),
    ("src/oracles/gsl/a.cpp", '#include "oracles/petsc/ts.hpp"\n', "includes oracles/petsc/, which src/rooms.txt"),
    ("src/oracles/gsl/a.cpp", '#include "study/result.hpp"\n', "which src/rooms.txt does not allow"),
    ("src/utility/a.hpp", "\n", "not among the rooms"),
    ("src/store/hdf5/a.cpp", "#include <hdf5.h>\n", None),
    ("src/study/a.cpp", "#include <hdf5.h>\n", "hdf5 is for store/hdf5/"),
    ("src/app/a.cpp", '#include "H5Cpp.h"\n', "hdf5 is for store/hdf5/"),
    ("src/analysis/fit/a.cpp", "#include <gsl/gsl_fit.h>\n", None),
    ("src/oracles/gsl/a.cpp", "#include <gsl/gsl_odeiv2.h>\n", None),
    ("src/oracles/sundials/a.cpp", "#include <gsl/gsl_fit.h>\n", "gsl is for"),
    ("src/oracles/sundials/a.cpp", "#include <cvode/cvode.h>\n", None),
    ("src/integrators/loop/a.cpp", "#include <arkode/arkode_erkstep.h>\n", "sundials is for"),
    ("src/integrators/loop/a.cpp", "#include <nvector/nvector_serial.h>\n", "sundials is for"),
    ("src/linalg/a.cpp", "#include <petscksp.h>\n", None),
    ("src/integrators/loop/a.cpp", "#include <petscts.h>\n", "petsc is for"),
    ("src/text/a.cpp", "#include <toml++/toml.h>\n", None),
    ("src/scene/a.cpp", "#include <toml++/toml.h>\n", "tomlplusplus is for text/"),
    ("src/study/a.cpp", "#include <CLI/CLI.hpp>\n", "cli11 is for app/"),
    ("src/ode/a.cpp", "auto x = Eigen::VectorXd::Random(3);\n", "no named seed"),
    ("tests/ode/a_test.cpp", "x.setRandom();\n", "no named seed"),
    ("tests/ode/a_test.cpp", "std::random_device device;\n", "no named seed"),
    ("src/ode/a.cpp", "// never VectorXd::Random()\nauto s = \"a.Random()\";\n", None),
    ("src/ode/a.cpp", "Random make(int seed);\n", None),
    ("tests/core/a_test.cpp", '#include "app/main.hpp"\n#include <hdf5.h>\n', None),
]


def self_test():
    """Seeds each violation into an empty tree: the checker must find it and nothing else. Returns the failures."""
    failures = []
    for file, text, expected in SEEDS:
        with tempfile.TemporaryDirectory() as folder:
            checkout = pathlib.Path(folder)
            (checkout / file).parent.mkdir(parents=True)
            (checkout / file).write_text(text, encoding="utf-8")
            (checkout / "src").mkdir(exist_ok=True)
            if file != "src/rooms.txt":
                (checkout / "src" / "rooms.txt").write_text(ROOMS.read_text(encoding="utf-8"), encoding="utf-8")
            found = violations(checkout)
        right = found == [] if expected is None else len(found) == 1 and expected in found[0]
        if not right:
            failures.append(f"{file} with {text!r}: expected {expected!r}, found {found}")
    return failures


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--self-test", action="store_true", help="check the checker with seeded violations")
    parser.add_argument("checkout", nargs="?", type=pathlib.Path,
                        default=pathlib.Path(__file__).resolve().parent.parent, help="default: this one")
    arguments = parser.parse_args()
    if arguments.self_test:
        found, checked = self_test(), f"{len(SEEDS)} seeded sources"
    else:
        if not source_files(arguments.checkout / "src"):
            parser.error(f"no sources in {arguments.checkout / 'src'}")
        found, checked = violations(arguments.checkout), "includes of src/"
    for line in found:
        print(line, file=sys.stderr)
    print(f"check_layers: {checked}: {len(found)} violation(s)")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
