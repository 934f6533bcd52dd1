#!/usr/bin/env python3
"""Follows the user guide and the pages on studies as a newcomer would: writes every file that they show, runs every command
in their order, and looks for the files that they promise.

usage: user_guide_test.py --federwerk EXECUTABLE

A file is a fenced block after a line **`path`**. A command is a line of a block ```sh, which ends with exit code 0 or with
what its comment "# exit code N" says, or an inline `federwerk ...` without placeholders. Promised are the files behind -o and
those that a comment names. Each page starts in a fresh tree with what the guide's first section has exported. What is not run,
or run otherwise, is declared below with a reason; everything else is run, so that a new command is covered by standing there.
"""

import argparse
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "docs" / "user_guide.md", ROOT / "docs" / "studies.md", *sorted((ROOT / "docs" / "studies").glob("*.md"))]

NOT_RUN = {
    "scripts/bootstrap": "installs packages, which a machine that tests has",
    "scripts/build release federwerk": "builds the executable that is under test here",
}
# Commands that would take long, as they are run here.
RUN_OTHERWISE = {}

MARK = re.compile(r"^\*\*`([^`]+)`\*\*$")
EXIT_CODE = re.compile(r"#\s*exit code (\d+)\b")
PROMISED = re.compile(r"\b(?:mine|results)/[\w./-]*\.(?:png|pdf|h5|xdmf)\b")
INLINE = re.compile(r"`(federwerk [^`]+)`")
COMMAND = re.compile(r"^\s*(\$ )?(federwerk|scripts/|build/release/bin/federwerk)\b", re.MULTILINE)
PLACEHOLDER = re.compile(r"[A-Z]{2,}|…|\.\.\.")


class Failure(Exception):
    pass


def fenced_blocks(text):
    """(path of a file or None, language, content, line number of the content) and the text between the blocks."""
    lines, blocks, prose, i = text.split("\n"), [], [], 0
    while i < len(lines):
        if lines[i].startswith("```"):
            end = lines.index("```", i + 1)
            mark = MARK.match(lines[i - 1]) if i else None
            blocks.append((mark.group(1) if mark else None, lines[i][3:].strip(), "\n".join(lines[i + 1:end]) + "\n", i + 2))
            i = end
        else:
            prose.append(lines[i])
        i += 1
    return blocks, "\n".join(prose)


def commands_of(content, first_line):
    """(command, line number) of a block; a line that ends with a backslash goes on."""
    found, pending, start = [], "", 0
    for number, line in enumerate(content.rstrip("\n").split("\n"), first_line):
        start = start if pending else number
        pending += line
        if pending.endswith("\\"):
            pending = pending[:-1]
            continue
        if pending.strip() and not pending.lstrip().startswith("#"):
            found.append((pending.strip(), start))
        pending = ""
    return found


def without_comment(command):
    """The command as bash sees it."""
    lexer = shlex.shlex(command, posix=False, punctuation_chars=False)
    lexer.whitespace_split, lexer.commenters = True, "#"
    return " ".join(lexer)


def promised_files(command):
    """What a command says that it writes: in its comment, and behind -o."""
    files = set(PROMISED.findall(command.partition("#")[2]))
    words = shlex.split(command, comments=True)
    if "-o" in words[:-1] and words[0].endswith("federwerk"):
        target = words[words.index("-o") + 1]
        if words[1] in ("simulate", "equilibrium"):
            files.add(target)
        elif words[1] == "run":
            files |= {f"{target}/{pathlib.Path(word).stem}.h5" for word in words[2:]
                      if word.endswith(".toml") and "*" not in word}
    return files


class Follower:
    """A newcomer in a tree of their own."""

    def __init__(self, federwerk, folder):
        self.federwerk, self.folder = federwerk, folder
        self.exports, self.seconds, self.declared = [], [], set()

    def fresh_tree(self, name):
        self.tree = self.folder / name
        for part in ("studies", "scripts", "docs"):
            shutil.copytree(ROOT / part, self.tree / part)
        target = self.tree / "build" / "release" / "bin" / "federwerk"
        target.parent.mkdir(parents=True)
        target.symlink_to(self.federwerk)

    def run(self, command, where):
        bare = without_comment(command)
        if bare in NOT_RUN:
            self.declared.add(bare)
            return
        if bare.startswith("export "):
            self.exports.append(bare)
        if bare in RUN_OTHERWISE:
            self.declared.add(bare)
            bare = RUN_OTHERWISE[bare]
        expected = int((EXIT_CODE.search(command) or [0, 0])[1])
        begin = time.time()
        environment = os.environ | {"FEDERWERK_CACHE": str(self.folder / "cache"), "OMP_WAIT_POLICY": "passive"}
        answer = subprocess.run(["bash", "-c", "\n".join([*self.exports, bare])], cwd=self.tree, env=environment, text=True,
                                stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        self.seconds.append((time.time() - begin, bare))
        if answer.returncode != expected:
            raise Failure(f"{where}: exit code {answer.returncode} instead of {expected}: {command}\n{answer.stdout[-3000:]}")
        for file in sorted(promised_files(command)) if expected == 0 else []:
            if not (self.tree / file).is_file() or (self.tree / file).stat().st_size == 0:
                raise Failure(f"{where}: promises {file}, which is not there: {command}\n{answer.stdout[-3000:]}")
        if "plot_" in bare and ".png" not in answer.stdout:
            raise Failure(f"{where}: draws nothing: {command}\n{answer.stdout[-3000:]}")

    def follow(self, name, text):
        """Returns the number of commands and of files."""
        self.fresh_tree(name)
        blocks, prose = fenced_blocks(text)
        commands = files = 0
        for path, language, content, line in blocks:
            where = f"{name}:{line}"
            if path is not None:
                target = self.tree / path
                if not target.resolve().is_relative_to(self.tree.resolve()) or (ROOT / path).exists():
                    raise Failure(f"{where}: {path} is no new file of the newcomer")
                target.parent.mkdir(parents=True, exist_ok=True)
                target.write_text(content, encoding="utf-8")
                files += 1
            elif language == "sh":
                for command, number in commands_of(content, line):
                    self.run(command, f"{name}:{number}")
                    commands += 1
            elif COMMAND.search(content):
                raise Failure(f"{where}: a command in a block ```{language}, which nobody runs; mark it with sh")
            elif language in ("toml", "python"):
                raise Failure(f"{where}: a block of {language} without a file name, which nobody tries")
        for command in dict.fromkeys(INLINE.findall(prose)):
            if not PLACEHOLDER.search(command):
                self.run(command, f"{name}: `{command}`")
                commands += 1
        return commands, files


def check_follower(federwerk, folder):
    """The follower itself: what is wrong in a page has to be found."""
    start = 'export PATH="$PWD/build/release/bin:$PATH"\n'
    scene = "**`mine/a.toml`**\n```toml\nkind = \"simulate\"\n```\n"
    right = f"```sh\n{start}federwerk list methods   # all\nfederwerk run mine/none.toml -o mine   # exit code 2\n```\n"
    wrong = {
        "a command fails": f"```sh\n{start}federwerk list metods\n```\n",
        "an exit code is another": f"```sh\n{start}federwerk list methods   # exit code 1\n```\n",
        "a promised file is missing": f"```sh\n{start}federwerk list methods   # mine/list.png\n```\n",
        "a command in another kind of block": f"{scene}```\nfederwerk list methods\n```\n",
        "an inline command fails": f"```sh\n{start}```\nSee `federwerk list metods`.\n",
        "a file that nobody tries": "```toml\nkind = \"simulate\"\n```\n",
        "a file with a mistake": f"{scene}```sh\n{start}federwerk run mine/a.toml -o mine\n```\n",
        "a picture is not drawn": "```sh\ntrue scripts/plot_results.py mine/a.h5\n```\n",
    }
    Follower(federwerk, folder).follow("right", right)
    for number, (mistake, page) in enumerate(wrong.items()):
        try:
            Follower(federwerk, folder).follow(f"wrong {number}", page)
        except Failure:
            continue
        raise Failure(f"the test itself does not see that {mistake}")


def examine(federwerk):
    with tempfile.TemporaryDirectory(prefix="feder werk ") as name:
        folder = pathlib.Path(name)
        check_follower(federwerk, folder)
        follower = Follower(federwerk, folder)
        for page in PAGES:
            commands, files = follower.follow(str(page.relative_to(ROOT)), page.read_text(encoding="utf-8"))
            print(f"{page.relative_to(ROOT)}: {commands} commands, {files} files", flush=True)
        unused = sorted((set(NOT_RUN) | set(RUN_OTHERWISE)) - follower.declared)
        if unused:
            raise Failure(f"declared, but on no page: {unused}")
        if len(follower.seconds) < 20:
            raise Failure(f"only {len(follower.seconds)} commands found on all pages")
        total = sum(seconds for seconds, _ in follower.seconds)
        print(f"{len(follower.seconds)} commands run in {total:.0f} s; the longest:")
        for seconds, command in sorted(follower.seconds, reverse=True)[:5]:
            print(f"  {seconds:5.1f} s  {command}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--federwerk", type=pathlib.Path, required=True)
    try:
        examine(parser.parse_args().federwerk.resolve())
    except Failure as failure:
        print(f"user_guide_test: {failure}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
