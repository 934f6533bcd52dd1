#!/usr/bin/env python3
"""Writes the catalogue of schemes and their options into docs/methods.md, between its marks, as the program prints
them.

usage: update_methods_page.py [--check] [FEDERWERK]

With --check nothing is written; exit code 1 says that the page is out of date. FEDERWERK is the executable
(build/release/bin/federwerk).
"""

import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "methods.md"
MARK = re.compile(r"(<!-- (catalogue|options): begin \(written by scripts/update_methods_page.py\) -->\n)(.*?)"
                  r"(<!-- \2: end -->\n)", re.DOTALL)
COMMANDS = {"catalogue": ["list", "methods", "--markdown"],
            "options": ["schema", "method-options", "--form", "settings"]}


def main(arguments):
    check = "--check" in arguments
    rest = [argument for argument in arguments if argument != "--check"]
    if len(rest) > 1 or any(argument.startswith("-") for argument in rest):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    executable = rest[0] if rest else str(ROOT / "build" / "release" / "bin" / "federwerk")
    old = PAGE.read_text(encoding="utf-8")
    found = [match.group(2) for match in MARK.finditer(old)]
    if found != list(COMMANDS):
        print(f"{PAGE}: found the marked parts {found}, expected {list(COMMANDS)}", file=sys.stderr)
        return 2
    printed = {part: subprocess.run([executable, *command], check=True, capture_output=True, encoding="utf-8").stdout
               for part, command in COMMANDS.items()}
    new = MARK.sub(lambda match: f"{match.group(1)}{printed[match.group(2)]}\n{match.group(4)}", old)
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
