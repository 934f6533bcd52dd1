#!/usr/bin/env python3
"""Writes what the declarations of settings and of summaries say into docs/, as the program prints it.

usage: update_settings_pages.py [--check] [FEDERWERK]

 - docs/schemas/NAME.schema.json: the JSON schema of every kind of study, of scenes and of the options of
   methods;
 - tables between the marks `<!-- settings: KIND SECTION -->` and `<!-- end of settings -->` in docs/studies.md,
   docs/studies/ and docs/scene_format.md: the keys of a section (SECTION: `top`, or its name as in `problem.vary`);
 - the rows of /summary/ in docs/results_schema.md.

With --check nothing is written; exit code 1 says that something is out of date. FEDERWERK is the executable
(build/release/bin/federwerk).
"""

import functools
import json
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
MARK = re.compile(r"<!-- settings: (\w+) ([\w.]+) -->\n(.*?)<!-- end of settings -->\n", re.DOTALL)
SECTION = re.compile(r"<!-- section: ([\w.]+) -->\n(.*?)\n(?=<!-- section|\Z)", re.DOTALL)


class Program:
    def __init__(self, executable):
        self.executable = executable

    def prints(self, *arguments):
        return subprocess.run([self.executable, *arguments], check=True, capture_output=True,
                              encoding="utf-8").stdout

    def kinds(self):
        return [entry["name"] for entry in json.loads(self.prints("list", "studies", "--json"))]

    @functools.cache
    def sections(self, kind):
        return dict(SECTION.findall(self.prints("schema", kind, "--form", "settings")))


def with_settings(text, program, page):
    """The page with its tables of settings renewed."""
    def table(match):
        kind, section = match.group(1), match.group(2)
        known = program.sections(kind)
        if section not in known:
            raise SystemExit(f"{page}: no section {section} of {kind}, expected one of {', '.join(known)}")
        return f"<!-- settings: {kind} {section} -->\n{known[section]}<!-- end of settings -->\n"
    return MARK.sub(table, text)


def with_summaries(text, program):
    """The description of result files with the rows of the summaries renewed."""
    kinds = set(program.kinds())
    lines, kind, done = [], None, set()
    for line in text.splitlines(keepends=True):
        heading = re.match(r"## (?:Kind `(\w+)`)?", line)
        if heading:
            kind = heading.group(1)
        if kind not in kinds or kind == "sweep" or not line.startswith("| `/summary/"):
            lines.append(line)
        elif kind not in done:
            done.add(kind)
            lines += program.prints("schema", kind, "--form", "summary").splitlines(keepends=True)[2:]
    return "".join(lines)


def main(arguments):
    check = "--check" in arguments
    rest = [argument for argument in arguments if argument != "--check"]
    if len(rest) > 1 or any(argument.startswith("-") for argument in rest):
        print(__doc__.strip(), file=sys.stderr)
        return 2
    program = Program(rest[0] if rest else str(ROOT / "build" / "release" / "bin" / "federwerk"))
    wanted = {DOCS / "schemas" / f"{name}.schema.json": program.prints("schema", name)
              for name in [*program.kinds(), "scene", "method-options"]}
    for page in [DOCS / "studies.md", DOCS / "scene_format.md", *sorted((DOCS / "studies").glob("*.md"))]:
        wanted[page] = with_settings(page.read_text(encoding="utf-8"), program, page)
    page = DOCS / "results_schema.md"
    wanted[page] = with_summaries(page.read_text(encoding="utf-8"), program)
    stale = [path for path, text in wanted.items()
             if not path.exists() or path.read_text(encoding="utf-8") != text]
    for path in stale:
        name = path.relative_to(ROOT)
        if check:
            print(f"{name} is out of date: run scripts/update_settings_pages.py", file=sys.stderr)
        else:
            path.parent.mkdir(exist_ok=True)
            path.write_text(wanted[path], encoding="utf-8")
            print(f"{name} written")
    if not stale:
        print(f"{len(wanted)} files are up to date")
    return 1 if check and stale else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
