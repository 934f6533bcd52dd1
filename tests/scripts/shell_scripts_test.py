"""The shell scripts: usage, honest exit codes, and what bootstrap does, against package tools that only pretend."""

import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

CHECKOUT = pathlib.Path(__file__).resolve().parent.parent.parent
SCRIPTS = CHECKOUT / "scripts"
COMMANDS = [SCRIPTS / name for name in ("bootstrap", "build", "test", "reproduce", "check_format")]


def run(command, path=None, cwd="/"):
    environment = dict(os.environ)
    if path:
        environment["PATH"] = f"{path}:{environment['PATH']}"
    return subprocess.run([str(word) for word in command], cwd=cwd, env=environment, stdin=subprocess.DEVNULL,
                          text=True, capture_output=True, check=False)


class Usage(unittest.TestCase):
    def test_help_is_given_from_any_directory(self):
        for command in COMMANDS:
            with self.subTest(command.name):
                answer = run([command, "--help"])
                self.assertEqual(answer.returncode, 0, answer.stderr)
                self.assertIn("usage:", answer.stdout)

    def test_an_unknown_option_is_bad_usage_and_is_named(self):
        for command in COMMANDS:
            with self.subTest(command.name):
                answer = run([command, "--instal"])
                self.assertEqual(answer.returncode, 2)
                self.assertIn("--instal", answer.stderr)

    def test_shell_scripts_parse(self):
        for command in [*COMMANDS, SCRIPTS / "python", CHECKOUT / ".ci" / "run"]:
            with self.subTest(command.name):
                answer = run(["bash", "-n", command])
                self.assertEqual(answer.returncode, 0, answer.stderr)


class Bootstrap(unittest.TestCase):
    """dpkg-query, apt-cache and apt-get are replaced by scripts that keep a list of packages in a file."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="feder werk ")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.installed = self.root / "installed"
        self.log = self.root / "log"
        self.log.touch()
        (self.root / "scripts").mkdir()
        (self.root / "bin").mkdir()
        shutil.copy(SCRIPTS / "bootstrap", self.root / "scripts")
        (self.root / "scripts" / "packages.txt").write_text("# tools\ng++   compiler\nninja  # build\n")
        self.tool("id", "echo 0")
        self.tool("dpkg-query", f'sed "s/^/installed /" "{self.installed}"')
        self.tool("apt-cache", 'shift; for p in "$@"; do echo "  Candidate: 1.0"; done')
        self.apt_get()

    def tool(self, name, text):
        path = self.root / "bin" / name
        path.write_text(f"#!/bin/sh\n{text}\n")
        path.chmod(0o755)

    def apt_get(self, fails_until_updated=False):
        condition = f'grep -q update "{self.log}"' if fails_until_updated else "true"
        self.tool("apt-get", f'''echo "$DEBIAN_FRONTEND $*" >>"{self.log}"
case "$*" in *" install "*) {condition} && printf 'g++\\nninja\\n' >"{self.installed}" ;; esac''')

    def bootstrap(self, *options):
        return run([self.root / "scripts" / "bootstrap", *options], path=self.root / "bin")

    def test_does_nothing_where_all_is_installed(self):
        self.installed.write_text("g++\nninja\n")
        answer = self.bootstrap()
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertEqual(self.log.read_text(), "")

    def test_no_install_names_what_is_missing_and_installs_nothing(self):
        self.installed.write_text("g++\n")
        answer = self.bootstrap("--no-install")
        self.assertEqual(answer.returncode, 1)
        self.assertIn("1 of 2 packages are missing: ninja", answer.stdout)
        self.assertEqual(self.log.read_text(), "")

    def test_installs_only_what_is_missing_without_recommended_packages(self):
        self.installed.write_text("g++\n")
        answer = self.bootstrap()
        self.assertEqual(answer.returncode, 0, answer.stderr)
        calls = self.log.read_text().splitlines()
        self.assertEqual(len(calls), 1, calls)
        self.assertRegex(calls[0], r"^noninteractive .*install --no-install-recommends ninja$")

    def test_fetches_the_package_lists_where_apt_knows_no_candidate(self):
        self.installed.write_text("")
        self.tool("apt-cache", "true")
        self.assertEqual(self.bootstrap().returncode, 0)
        self.assertRegex(self.log.read_text(), r"(?s)update.*install")

    def test_tries_again_with_fresh_lists_where_they_are_stale(self):
        self.installed.write_text("")
        self.apt_get(fails_until_updated=True)
        self.assertEqual(self.bootstrap().returncode, 0)
        self.assertRegex(self.log.read_text(), r"(?s)install.*update.*install")

    def test_fails_where_apt_fails(self):
        self.installed.write_text("")
        for failing, message in (("install", "could not install"), ("", "could not fetch the package lists")):
            with self.subTest(message):
                self.tool("apt-get", f'case "$*" in *"{failing}"*) exit 100 ;; esac')
                answer = self.bootstrap()
                self.assertEqual(answer.returncode, 1)
                self.assertIn(message, answer.stderr)

    def test_fails_where_apt_claims_success_but_a_package_is_still_missing(self):
        self.installed.write_text("")
        self.tool("apt-get", "exit 0")
        answer = self.bootstrap()
        self.assertEqual(answer.returncode, 1)
        self.assertIn("still missing: g++ ninja", answer.stderr)



class Reproduce(unittest.TestCase):
    """A checkout in a path with spaces whose federwerk only pretends: it exits with the code in its study file and
    writes a result unless the study says "no file"."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="feder werk ")
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        (self.root / "scripts").mkdir()
        shutil.copy(SCRIPTS / "reproduce", self.root / "scripts")
        for name in ("scripts/bootstrap", "scripts/build"):
            self.tool(name, "exit 0")
        self.tool("scripts/python", """
shift 3  # the script and its formats
for file; do
  echo "drawing $file"
  case $file in *undrawable*) echo "cannot draw $file" >&2; exit 2 ;; esac
done""")
        self.tool("build/release/bin/federwerk", """
case $1 in
  show) echo "table of $2"; exit ;;
  run) file=$4/$(basename "$2" .toml).h5; input=$2; echo "$*" >>arguments ;;
  simulate) input=$2; while [ "$1" != -o ]; do shift; done; file=$2 ;;
esac
grep -q "no file" "$input" || echo result >"$file"
exit $(head -n 1 "$input")""")

    def tool(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"#!/bin/sh\n{text}\n")
        path.chmod(0o755)

    def study(self, name, code, more=""):
        path = self.root / "studies" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(f"{code}\n{more}\n")

    def reproduce(self, *options):
        return run([self.root / "scripts" / "reproduce", *options])

    def summary(self, folder="results"):
        return (self.root / folder / "summary.txt").read_text()

    def test_runs_and_draws_every_study_and_scene(self):
        self.study("lecture/s 12.toml", 0)
        self.study("order.toml", 0)
        self.study("scenes/double_spring.toml", 0)
        (self.root / "studies/scenes/simulations.txt").write_text("# a remark\ndouble_spring sundials:ida 1e-3 1 11\n")
        answer = self.reproduce()
        self.assertEqual(answer.returncode, 0, answer.stderr)
        for file in ("lecture/s 12.h5", "order.h5", "scenes/double_spring-sundials_ida.h5"):
            self.assertTrue((self.root / "results" / file).exists(), file)
            self.assertIn(f"drawing results/{file}", answer.stdout)
            self.assertIn(f"table of results/{file}", self.summary())
        self.assertIn("all verdicts hold", self.summary())

    def test_a_failing_verdict_is_exit_code_1_and_stops_nothing(self):
        self.study("a.toml", 1)
        self.study("b.toml", 0)
        self.assertEqual(self.reproduce().returncode, 1)
        self.assertIn("studies/a.toml: a verdict fails", self.summary())
        self.assertTrue((self.root / "results/b.h5").exists())

    def test_a_study_that_cannot_be_done_is_exit_code_3_and_stops_nothing(self):
        for code in (2, 3, 139):
            with self.subTest(code):
                self.study("a.toml", code, "no file")
                self.study("b.toml", 1)
                self.assertEqual(self.reproduce().returncode, 3)
                self.assertIn(f"studies/a.toml: exit code {code}", self.summary())
                self.assertTrue((self.root / "results/b.h5").exists())

    def test_success_without_a_result_file_is_a_failure(self):
        self.study("a.toml", 0, "no file")
        self.assertEqual(self.reproduce().returncode, 3)
        self.assertIn("but no results/a.h5", self.summary())

    def test_a_picture_that_cannot_be_drawn_is_a_failure(self):
        self.study("undrawable.toml", 0)
        answer = self.reproduce()
        self.assertEqual(answer.returncode, 3)
        self.assertIn("cannot draw results/undrawable.h5", answer.stderr)
        self.assertIn("a plot could not be drawn", self.summary())

    def test_a_failing_build_is_a_failure(self):
        self.study("a.toml", 0)
        self.tool("scripts/build", "exit 1")
        self.assertEqual(self.reproduce().returncode, 3)
        self.assertFalse((self.root / "results/a.h5").exists())

    def test_nothing_to_run_is_a_failure(self):
        (self.root / "studies").mkdir()
        self.assertEqual(self.reproduce().returncode, 3)

    def test_quick_results_are_kept_apart(self):
        self.study("a.toml", 0)
        answer = self.reproduce("--quick")
        self.assertEqual(answer.returncode, 0, answer.stderr)
        self.assertIn("--quick", (self.root / "arguments").read_text())
        self.assertTrue((self.root / "results/quick/a.h5").exists())
        self.assertFalse((self.root / "results/a.h5").exists())
        self.assertIn("quick", self.summary("results/quick").splitlines()[0])

    def test_can_be_repeated(self):
        self.study("a.toml", 0)
        self.assertEqual([self.reproduce().returncode for _ in range(2)], [0, 0])


if __name__ == "__main__":
    unittest.main()
