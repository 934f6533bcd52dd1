"""What the tests of the plot scripts share: a folder of synthetic result files, and a look into legends."""

import contextlib
import io
import pathlib
import runpy
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

SCRIPTS = pathlib.Path(__file__).resolve().parent.parent.parent / "scripts"
sys.path.insert(0, str(SCRIPTS))

import plot_style  # noqa: E402
import plot_results  # noqa: E402
import synthetic_results  # noqa: E402
from result_file import ResultFile  # noqa: E402


class PlotTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="feder werk ")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.addCleanup(plot_style.plt.close, "all")

    def write(self, kind, **options):
        path = self.folder / f"{kind}.h5"
        synthetic_results.ALL[kind](path, **options)
        return path

    def draw(self, module, path):
        with ResultFile(path) as result:
            return module.draw(result)

    def plot_results(self, *arguments):
        """What scripts/plot_results.py does, without a process of its own and with small pictures."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), \
                plot_style.plt.rc_context({"savefig.dpi": 50}):
            code = plot_style.main("", plot_results.choose_drawing, [*map(str, arguments), "--formats", "png"])
        return subprocess.CompletedProcess(arguments, code, out.getvalue(), err.getvalue())

    def run_here(self, name, *arguments):
        """A script as from the shell, but in this process: starting matplotlib takes longer than most pictures."""
        out, err, code = io.StringIO(), io.StringIO(), 0
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), \
                unittest.mock.patch.object(sys, "argv", [name, *map(str, arguments)]):
            try:
                runpy.run_path(str(SCRIPTS / name), run_name="__main__")
            except SystemExit as end:
                code = end.code or 0
        return subprocess.CompletedProcess(arguments, code, out.getvalue(), err.getvalue())

    def script(self, name, *arguments):
        return subprocess.run([sys.executable, SCRIPTS / name, *arguments], cwd="/", text=True, capture_output=True,
                              check=False)


def legend_of_row(figure, row):
    """The legend's entries of a row of panels."""
    return texts_of_legend([axes for axes in figure.axes if axes.get_legend()][row])


def texts_of_legend(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]
