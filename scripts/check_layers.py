#!/usr/bin/env python3
"""Checks that the folders of src/ include only what they may.

A folder includes itself and the folders above it in LAYERS; a folder inside a folder (oracles/sundials) its parent
too, but not its siblings. Each foreign library is included where OWNERS says and nowhere else. Random numbers come
from a named seed. Exit code 0: all is well; 1: violations, one a line; 2: bad usage.
"""

import argparse
import pathlib
import re
import sys
import tempfile

LAYERS = [
    "core", "ode", "schemes", "linalg", "mechanics", "problems", "mesh", "scene", "constraints", "collision", "integrators",
    "oracles", "analysis", "study", "store", "catalog", "app",
]

# Foreign header (regular expression on what stands between the brackets) -> name, folders that may include it.
OWNERS = [
    (r"(hdf5|hdf5_hl|H5[A-Z]\w*)\.h(pp)?$", "HDF5", ["store"]),
    (r"gsl/", "GSL", ["analysis", "oracles/gsl"]),
    (r"(sundials|cvodes?|arkode|idas?|kinsol|nvector|sunmatrix|sunlinsol|sunnonlinsol|sunmemory)/", "SUNDIALS",
     ["oracles/sundials"]),
    (r"(petsc|slepc)", "PETSc", ["linalg", "oracles/petsc"]),
    (r"(klu|cholmod)\.h", "SuiteSparse", ["linalg"]),
    (r"toml(\+\+/|\.hpp)", "toml++", ["core"]),
    (r"CLI/", "CLI11", ["app"]),
    (r"openssl/", "OpenSSL", ["core"]),
]

# What is generated into the build folder and thus has no folder in its name.
GENERATED = {"provenance_build.hpp": "core"}

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


def layer_violation(folder, included):
    """Why `folder` must not include the project's header `included`, or None."""
    if included in GENERATED:
        owner = GENERATED[included]
        return None if folder == owner else f'"{included}" is for {owner}/ only'
    target = pathlib.PurePosixPath(included).parent.as_posix()
    top, target_top = folder.split("/")[0], target.split("/")[0]
    if target_top not in LAYERS:
        return f'"{included}" does not begin with a folder of src/'
    if top == target_top:
        siblings = target != top and target != folder and not folder.startswith(target + "/")
        return f"{folder}/ includes its sibling {target}/" if siblings and folder != top else None
    if LAYERS.index(target_top) > LAYERS.index(top):
        return f"{folder}/ includes {target}/, which is below it"
    return None


def owner_violation(folder, included):
    """Why `folder` must not include the foreign header `included`, or None."""
    for pattern, name, owners in OWNERS:
        if re.match(pattern, included) and not any(folder == o or folder.startswith(o + "/") for o in owners):
            return f"<{included}>: {name} is included in {', '.join(o + '/' for o in owners)} only"
    return None


def source_files(root):
    return sorted(p for p in root.rglob("*") if p.suffix in (".cpp", ".hpp", ".h", ".c", ".cc", ".inl", ".ipp"))


def violations(checkout):
    """All violations below `checkout` as "file:line: reason"."""
    found = []
    for part in ("src", "tests"):
        root = checkout / part
        for path in source_files(root):
            text = path.read_text(encoding="utf-8")
            name = path.relative_to(checkout).as_posix()
            folder = folder_of(path, root)
            if part == "src" and folder.split("/")[0] not in LAYERS:
                found.append(f"{name}:1: folder {folder}/ is not among the layers of scripts/check_layers.py")
                continue
            code = COMMENT_OR_TEXT.sub(blank, text).splitlines()
            for number, (line, bare) in enumerate(zip(text.splitlines(), code), start=1):
                include = INCLUDE.match(line)
                if include and part == "src" and "#" in bare:
                    foreign = owner_violation(folder, include[2])
                    own = layer_violation(folder, include[2]) if include[1] == '"' else None
                    reason = foreign or own
                    if reason:
                        found.append(f"{name}:{number}: {reason}")
                for pattern, reason in UNSEEDED:
                    if pattern.search(bare):
                        found.append(f"{name}:{number}: {reason}")
    return found


# Self test: (file, text, what the violation must say, or None where the text is lawful).
SEEDS = [
    ("src/ode/a.cpp", '#include "core/types.hpp"\n', None),
    ("src/ode/a.cpp", '#include "ode/ivp.hpp"\n', None),
    ("src/ode/a.cpp", '#include "linalg/newton.hpp"\n', "which is below it"),
    ("src/core/a.hpp", '  #  include "app/main.hpp"\n', "which is below it"),
    ("src/ode/a.cpp", '// #include "linalg/newton.hpp"\n', None),
    ("src/ode/a.cpp", '/*\n#include "linalg/newton.hpp"\n*/\n', None),
    ("src/ode/a.cpp", '#include "ivp.hpp"\n', "does not begin with a folder"),
    ("src/ode/a.cpp", '#include "../app/main.hpp"\n', "does not begin with a folder"),
    ("src/core/a.cpp", '#include "provenance_build.hpp"\n', None),
    ("src/ode/a.cpp", '#include "provenance_build.hpp"\n', "for core/ only"),
    ("src/oracles/gsl/a.cpp", '#include "oracles/tolerances.hpp"\n', None),
    ("src/oracles/gsl/a.cpp", '#include "oracles/gsl/driver.hpp"\n', None),
    ("src/oracles/gsl/a.cpp", '#include "oracles/petsc/ts.hpp"\n', "its sibling oracles/petsc/"),
    ("src/oracles/gsl/a.cpp", '#include "study/result.hpp"\n', "which is below it"),
    ("src/utility/a.hpp", "\n", "not among the layers"),
    ("src/store/a.cpp", "#include <hdf5.h>\n", None),
    ("src/study/a.cpp", "#include <hdf5.h>\n", "HDF5 is included in store/"),
    ("src/app/a.cpp", '#include "H5Cpp.h"\n', "HDF5 is included in store/"),
    ("src/analysis/a.cpp", "#include <gsl/gsl_fit.h>\n", None),
    ("src/oracles/gsl/a.cpp", "#include <gsl/gsl_odeiv2.h>\n", None),
    ("src/oracles/sundials/a.cpp", "#include <gsl/gsl_fit.h>\n", "GSL is included in"),
    ("src/oracles/sundials/a.cpp", "#include <cvode/cvode.h>\n", None),
    ("src/integrators/a.cpp", "#include <arkode/arkode_erkstep.h>\n", "SUNDIALS is included in"),
    ("src/integrators/a.cpp", "#include <nvector/nvector_serial.h>\n", "SUNDIALS is included in"),
    ("src/linalg/a.cpp", "#include <petscksp.h>\n", None),
    ("src/integrators/a.cpp", "#include <petscts.h>\n", "PETSc is included in"),
    ("src/core/a.cpp", "#include <toml++/toml.h>\n", None),
    ("src/scene/a.cpp", "#include <toml++/toml.h>\n", "toml++ is included in core/"),
    ("src/study/a.cpp", "#include <CLI/CLI.hpp>\n", "CLI11 is included in app/"),
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
