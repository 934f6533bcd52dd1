"""A study under attack: fault_injection_test.py FEDERWERK [--kills N] [--seed S]

Whatever happens to `federwerk run`, no case that it called finished is lost or run again, every file that is there opens,
and every end has one clear message.
"""

import argparse
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import h5py

FINISHED = re.compile(r"^  \[\d+/\d+\] (holds|fails|not applicable|done) +(\S+) ")

OPTIONS = argparse.Namespace(federwerk=None, kills=100, seed=20261122)


def study(problems=12, steps="[2e-6, 1e-6]", end=1.0):
    """Short cases, about a tenth of a second each."""
    sections = "".join(f"[[problem]]\nname = 'harmonic_oscillator'\nlabel = 'p{k}'\nt_end = {end}\n"
                       for k in range(problems))
    return f"kind = 'simulate'\ntitle = 'T'\nmethods = ['rk4']\nframes = 11\nsteps = {steps}\n{sections}"


class Run:
    """`federwerk run s.toml -o r` in a directory, in a process group of its own."""

    def __init__(self, folder, *options):
        self.out = tempfile.TemporaryFile(mode="w+")
        self.process = subprocess.Popen([OPTIONS.federwerk, "run", "s.toml", "-o", "r", *options], cwd=folder,
                                        stdin=subprocess.DEVNULL, stdout=self.out, stderr=subprocess.PIPE, text=True,
                                        start_new_session=True)

    def workers(self):
        children = pathlib.Path(f"/proc/{self.process.pid}/task/{self.process.pid}/children")
        try:
            return [int(number) for number in children.read_text().split()]
        except OSError:
            return []

    def printed(self):
        self.out.seek(0)
        return self.out.read()

    def wait_for_a_case(self):
        for _ in range(600):
            if FINISHED.search(self.printed().split("\n")[1] if self.printed().count("\n") > 1 else ""):
                return
            time.sleep(0.02)
        raise AssertionError("no case finished within 12 s")

    def end(self):
        """Exit code, standard output, standard error; nothing of it is left running."""
        workers = self.workers()
        _, error = self.process.communicate(timeout=120)
        for worker in workers:
            for _ in range(200):
                if not pathlib.Path(f"/proc/{worker}/stat").exists() or state_of(worker) == "Z":
                    break
                time.sleep(0.01)
            else:
                raise AssertionError(f"worker {worker} has outlived the run")
        printed = self.printed()
        self.out.close()
        return self.process.returncode, printed, error


def state_of(process):
    try:
        return pathlib.Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0]
    except OSError:
        return "Z"


def finished(text, kept=None):
    """Names of the cases that the run called finished; with `kept`, only those (not) taken from an earlier run."""
    names = []
    for line in re.sub(r"\n {3,}", " ", text).splitlines():  # reasons are wrapped
        found = FINISHED.match(line)
        if found and "could not" not in line and kept in (None, "(kept)" in line):
            names.append(found.group(2))
    return names


class FaultInjection(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory(prefix="feder werk ")
        self.addCleanup(directory.cleanup)
        self.folder = pathlib.Path(directory.name)

    def write(self, text):
        (self.folder / "s.toml").write_text(text, encoding="utf-8")

    def check_files(self):
        """Every file that carries a final name opens and is whole."""
        for path in (self.folder / "r").rglob("*.h5"):
            if path.name.startswith("."):
                continue
            with h5py.File(path) as file:
                self.assertEqual(file.attrs["format"], "federwerk", path)
                self.assertIn(file.attrs["status"], ("complete", "incomplete"))
                for case in file["cases"].values():
                    self.assertTrue(len(case) > 0 or case.attrs["key"] == "", path)  # without: could not be computed

    def test_loses_and_repeats_nothing_in_a_hundred_kills_at_random_moments(self):
        draw = random.Random(OPTIONS.seed)
        print(f"seed {OPTIONS.seed}, {OPTIONS.kills} kills")
        kills = rounds = 0
        while kills < OPTIONS.kills:
            rounds += 1
            self.assertLess(rounds, OPTIONS.kills, "the runs end before they can be killed")
            shutil.rmtree(self.folder / "r", ignore_errors=True)
            self.write(study(steps="[6e-6, 3e-6]"))
            done = set()
            while True:
                run = Run(self.folder, "--jobs", str(draw.choice((1, 2, 3))))
                time.sleep(draw.uniform(0.0, 0.5))
                victim = draw.choice(("run", "run", "worker", "interrupt", "terminate"))
                workers = run.workers()
                killed = run.process.poll() is None
                if victim == "run":
                    run.process.kill()
                elif victim == "worker" and workers:
                    os.kill(draw.choice(workers), signal.SIGKILL)
                elif victim == "interrupt":
                    if killed:
                        os.killpg(run.process.pid, signal.SIGINT)  # as a terminal does
                else:
                    run.process.terminate()
                code, out, error = run.end()
                kills += killed
                again = set(finished(out, kept=False)) & done
                self.assertEqual(again, set(), "finished cases were run again")
                words = re.sub(r"\n {3,}", " ", out)  # reasons are wrapped
                done |= {name for name in finished(out)
                         if not re.search(rf" {re.escape(name)} .*the process of this case ended", words)}
                self.check_files()
                if code == 0:
                    self.assertEqual(len(done), 24)
                    self.assertEqual(len(finished(out)), 24)
                    break
                if code == 3:
                    self.assertRegex(error, r"^federwerk: (interrupted; finished cases are saved|\d+ cases? could not be computed)")
                    self.assertEqual(error.count("\n"), 1)
                elif code not in (-signal.SIGKILL, -signal.SIGTERM, -signal.SIGINT):
                    self.fail(f"{victim}: exit code {code}: {error}")
            with h5py.File(self.folder / "r" / "s.h5") as file:
                self.assertEqual(file.attrs["status"], "complete")
                self.assertEqual(len(file["cases"]), 24)
            self.assertEqual([path.name for path in (self.folder / "r").iterdir()], ["s.h5"])
        print(f"{kills} kills in {rounds} studies")

    def test_goes_on_when_a_worker_is_killed_and_tries_its_case_again(self):
        self.write(study(problems=3))
        run = Run(self.folder)
        run.wait_for_a_case()
        os.kill(run.workers()[0], signal.SIGSEGV)
        code, out, error = run.end()
        self.assertEqual(code, 3, out)
        self.assertIn("1 case could not be computed", error)
        self.assertIn("the process of this case ended by signal 11", out)
        self.assertEqual(len(finished(out)), 6)
        again = Run(self.folder)
        code, out, _ = again.end()
        self.assertEqual((code, len(finished(out, kept=True)), len(finished(out, kept=False))), (0, 5, 1), out)

    def test_ends_a_case_at_its_time_limit_and_the_others_go_on(self):
        self.write(study(problems=2, steps="[1e-9, 1e-3]"))
        code, out, error = Run(self.folder, "--time-limit", "0.5").end()
        self.assertEqual(code, 3)
        self.assertEqual(out.count("ran past its time limit of 0.5 s  ("), 2)
        self.assertEqual(len(finished(out)), 4)
        self.assertIn("2 cases could not be computed", error)
        with h5py.File(self.folder / "r" / "s.h5") as file:
            verdicts = [verdict.decode() for verdict in file["summary/verdict"]]
        self.assertEqual(sorted(verdicts), ["done", "done", "fails", "fails"])

    def test_refuses_a_second_run_on_the_same_file_and_the_first_goes_on(self):
        self.write(study(problems=6))
        first = Run(self.folder)
        first.wait_for_a_case()
        code, _, error = Run(self.folder).end()
        self.assertEqual(code, 2)
        self.assertIn("another run is working on", error)
        code, out, _ = first.end()
        self.assertEqual((code, len(finished(out, kept=False))), (0, 12))

    def test_says_that_the_output_directory_has_vanished(self):
        self.write(study())
        run = Run(self.folder)
        run.wait_for_a_case()
        for _ in range(100):  # a case may be written while it goes
            shutil.rmtree(self.folder / "r", ignore_errors=True)
            if not (self.folder / "r").exists():
                break
        code, _, error = run.end()
        self.assertEqual(code, 3)
        self.assertEqual(error.count("\n"), 1, error)
        self.assertRegex(error, r"^federwerk: .*(No such file|vanish|gone)")

    def test_refuses_targets_that_are_no_results_of_its_own_and_leaves_them_alone(self):
        self.write(study(problems=1, steps="[1e-3]"))
        result = self.folder / "r" / "s.h5"
        result.parent.mkdir()

        def foreign():
            with h5py.File(result, "w") as file:
                file["data"] = [1, 2, 3]

        def truncated():
            self.assertEqual(Run(self.folder).end()[0], 0)
            result.write_bytes(result.read_bytes()[:-2000])

        def text():
            result.write_text("my thesis")

        for make in (foreign, truncated, text):
            result.unlink(missing_ok=True)
            make()
            before = result.read_bytes()
            code, _, error = Run(self.folder).end()
            self.assertEqual(code, 2, make.__name__)
            self.assertEqual(error.count("\n"), 1, error)
            self.assertIn("s.h5", error)
            self.assertEqual(result.read_bytes(), before)
            self.assertEqual([path.name for path in result.parent.iterdir()], ["s.h5"])

    def test_refuses_a_read_only_directory(self):
        self.write(study(problems=1, steps="[1e-3]"))
        (self.folder / "r").mkdir(mode=0o555)
        if os.access(self.folder / "r", os.W_OK):
            self.skipTest("this user may write everywhere; WriteTarget.RefusesAReadOnlyFileSystem covers it")
        code, _, error = Run(self.folder).end()
        self.assertEqual(code, 2)
        self.assertEqual(error.count("\n"), 1, error)

    def test_ends_with_one_message_on_a_disk_of_one_mebibyte_and_goes_on_with_room(self):
        # The cases are of 400 KB each; the file system exists for the children of `unshare` only.
        self.write(study(problems=6, steps="[1e-3]").replace("frames = 11", "frames = 10000").replace("1e-3", "1e-4"))
        script = ("mkdir -p r && mount -t tmpfs -o size=1m none r && "
                  '{ "$0" run s.toml -o r; code=$?; cp -r r kept; exit $code; }')
        answer = subprocess.run(["unshare", "--mount", "--map-root-user", "sh", "-c", script, OPTIONS.federwerk],
                                cwd=self.folder, text=True, capture_output=True, check=False, timeout=120)
        if answer.returncode not in (0, 3) and not (self.folder / "kept").exists():
            self.skipTest(f"not allowed to mount: {answer.stderr.strip()}")
        self.assertEqual(answer.returncode, 3, answer.stderr)
        self.assertIn("disk full", answer.stderr)
        self.assertEqual(answer.stderr.count("\n"), 1)
        done = finished(answer.stdout)
        self.assertGreater(len(done), 0)
        shutil.rmtree(self.folder / "r", ignore_errors=True)
        shutil.copytree(self.folder / "kept", self.folder / "r")
        code, out, _ = Run(self.folder).end()
        self.assertEqual(code, 0)
        self.assertEqual(finished(out, kept=True), done)
        self.assertEqual(len(finished(out)), 6)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("federwerk")
    parser.add_argument("--kills", type=int, default=OPTIONS.kills)
    parser.add_argument("--seed", type=int, default=OPTIONS.seed)
    parser.parse_known_args(namespace=OPTIONS)
    OPTIONS.federwerk = str(pathlib.Path(OPTIONS.federwerk).resolve())
    unittest.main(argv=[sys.argv[0], *[word for word in sys.argv[2:] if word.startswith(("Fault", "-v", "-k"))]])
