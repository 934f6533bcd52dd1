#!/usr/bin/env python3
"""Writes the catalogue of schemes into docs/methods.md, between its marks, as the program prints it.

usage: update_methods_page.py [--check] [FEDERWERK]

With --check nothing is written; exit code 1 says that the page is out of date. FEDERWERK is the executable
(build/release/bin/federwerk).
"""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "methods.md"
BEGIN = "<!-- catalogue: begin (written by scripts/update_methods_page.py) -->\n"
END = "<!-- catalogue: end -->\n"


def main(arguments):
    check = "--check" in arguments
    rest = [argument for argument in arguments if argument != "--check"]
    if len(rest) > 1 or any(argument.startswith("-") for argument in rest):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    executable = rest[0] if rest else str(ROOT / "build" / "release" / "bin" / "federwerk")
    tables = subprocess.run([executable, "list", "methods", "--markdown"], check=True, capture_output=True,
                            encoding="utf-8").stdout
    old = PAGE.read_text(encoding="utf-8")
    if old.count(BEGIN) != 1 or old.count(END) != 1:
        print(f"{PAGE}: expected the marks {BEGIN.strip()} and {END.strip()} once each", file=sys.stderr)
        return 2
    head, rest_of_page = old.split(BEGIN)
    new = head + BEGIN + tables + "\n" + END + rest_of_page.split(END)[1]
    if new == old:
        print("docs/methods.md is up to date")
        return 0
    if check:
        print("docs/methods.md is out of date: run scripts/update_methods_page.py", file=sys.stderr)
        return 1
    PAGE.write_text(new, encoding="utf-8")
    print("docs/methods.md written")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
