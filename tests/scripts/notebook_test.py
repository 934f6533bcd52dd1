#!/usr/bin/env python3
"""Executes docs/results.ipynb as Jupyter does, on a result file that the executable writes.

usage: notebook_test.py --federwerk EXECUTABLE

The notebook is stored without outputs, so that none can be out of date. It is executed from a folder that is laid out like
the checkout, in which only the command that the notebook names has been run (with --quick).
"""

import argparse
import copy
import os
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import nbclient
    import nbformat
except ImportError:  # main() finds a Python that has them
    nbclient = nbformat = None

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOTEBOOK = ROOT / "docs" / "results.ipynb"
COMMAND = re.compile(r"^federwerk (run \S+\.toml -o \S+)$", re.MULTILINE)


class Failure(Exception):
    pass


def check_stored(notebook):
    for cell in notebook.cells:
        if cell.cell_type == "code" and (cell.outputs or cell.execution_count):
            raise Failure(f"{NOTEBOOK.name} is stored with outputs, which nobody keeps up to date: clear them")


def run_named_command(notebook, federwerk, folder):
    text = "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "markdown")
    commands = COMMAND.findall(text)
    if len(commands) != 1:
        raise Failure(f"found {len(commands)} commands of federwerk in {NOTEBOOK.name}, expected one")
    arguments = commands[0].split()
    arguments[1] = str(ROOT / arguments[1])
    answer = subprocess.run([federwerk, *arguments, "--quick"], cwd=folder, text=True, capture_output=True, check=False,
                            env=os.environ | {"FEDERWERK_CACHE": str(folder / "cache")})
    if answer.returncode != 0:
        raise Failure(f"federwerk {commands[0]} ended with {answer.returncode}: {answer.stderr}")


def execute(notebook, folder):
    nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3",
                            resources={"metadata": {"path": str(folder)}}).execute()
    return [(output.get("data", {}), output.get("text", "")) for cell in notebook.cells if cell.cell_type == "code"
            for output in cell.outputs]


def examine(federwerk):
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    nbformat.validate(notebook)
    check_stored(notebook)
    with tempfile.TemporaryDirectory(prefix="feder werk ") as name:
        folder = pathlib.Path(name)
        (folder / "docs").mkdir()
        run_named_command(notebook, federwerk, folder)
        wrong = copy.deepcopy(notebook)
        outputs = execute(notebook, folder / "docs")
        if not any("image/png" in data for data, _ in outputs):
            raise Failure("the notebook draws no figure")
        if not any("text/html" in data and "verlet_backward_velocity" in data["text/html"] for data, _ in outputs):
            raise Failure("the notebook shows no table of the methods")
        print(f"{NOTEBOOK.name}: {len(outputs)} outputs, a table and a figure among them")

        # A wrong cell is an error, and so is a file that says something else than its points.
        cell = next(cell for cell in wrong.cells if "np.polyfit" in cell.source)
        changed = cell.source.replace("np.log(fitted.step)", "2 * np.log(fitted.step)")
        if changed == cell.source:
            raise Failure("the seeded mistake has nothing to change")
        cell.source = changed
        try:
            execute(wrong, folder / "docs")
        except nbclient.exceptions.CellExecutionError:
            print("a seeded mistake is found")
        else:
            raise Failure("the notebook does not see a wrong order")


def restart_with_system_python():
    system = "/usr/bin/python3"  # which has what scripts/bootstrap installs
    if os.environ.get("FEDERWERK_RESTARTED") or not os.path.exists(system):
        sys.exit(f"{sys.executable} has no nbclient; install python3-nbclient and python3-ipykernel (scripts/bootstrap does)")
    os.environ["FEDERWERK_RESTARTED"] = "1"
    os.execv(system, [system, *sys.argv])


def main():
    if nbclient is None:
        restart_with_system_python()
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"  # no debugger is in use
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--federwerk", required=True)
    try:
        examine(str(pathlib.Path(parser.parse_args().federwerk).resolve()))
    except (Failure, nbclient.exceptions.CellExecutionError) as failure:
        print(f"notebook_test: {failure}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
