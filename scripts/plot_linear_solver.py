#!/usr/bin/env python3
"""Draws a study of linear solvers: seconds and iterations over the number of unknowns, what a warm start and a kept
preconditioner save along a simulation, and the spectra of small systems."""

import sys

import plot_style  # first: it finds a Python with the libraries
import numpy
from matplotlib.lines import Line2D
from plot_style import QUIET, label, look, new_figure

STARTS = {"cold": "set-up anew, guess zero", "warm": "set-up anew, warm guess",
          "kept": "first preconditioner kept, warm guess"}


def short(name):
    """"petsc -ksp_type cg -pc_type icc -mat_type sbaij" as "petsc cg + icc (sbaij)"."""
    words = name.split()
    if words[0] != "petsc" or len(words) == 1:
        return name
    chosen = dict(zip(words[1::2], words[2::2]))
    storage = f" ({chosen['-mat_type']})" if "-mat_type" in chosen else ""
    parts = [chosen[key] for key in ("-ksp_type", "-pc_type") if key in chosen]
    return f"petsc {' + '.join(parts)}{storage}"


def solver_rows(result):
    return [row for row in result.summary() if row["solver"] != "spectrum" and numpy.isfinite(row["solve_seconds"])]


def systems_by_family(rows):
    """The rows by (stiffness of the problem's label, step): the label without its count is the family."""
    families = {}
    for row in rows:
        family = row["problem"].rstrip("0123456789") if "-" not in row["problem"] else row["problem"].split("-", 1)[1]
        families.setdefault((family, row["step"]), []).append(row)
    return families


def draw_scaling(result, rows, solvers):
    """Seconds and iterations over unknowns, a row of panels per family of systems."""
    families = systems_by_family(rows)
    figure, axes = new_figure(result, 15.5, 3.9 * len(families) + 0.7, len(families), 3,
                              gridspec_kw={"width_ratios": [1, 1, 0.62]})
    for line, ((family, step), members) in zip(axes, sorted(families.items())):
        for solver in solvers:
            mine = sorted((row for row in members if row["solver"] == solver), key=lambda row: row["unknowns"])
            if not mine:
                continue
            unknowns = numpy.array([row["unknowns"] for row in mine])
            seconds = numpy.array([row["setup_seconds"] + row["solve_seconds"] for row in mine])
            iterations = numpy.array([row["iterations"] for row in mine])
            style = look(solvers.index(solver))
            line[0].loglog(unknowns, 1e3 * seconds, linewidth=1.3, **style)
            if numpy.isfinite(iterations).all() and (iterations > 0).all():
                line[1].loglog(unknowns, iterations, linewidth=1.3, **style)
        line[0].set_title(f"{family}, step {step:g} s", loc="left")
        line[0].set_ylabel("set-up and solve [ms]")
        line[1].set_title("iterations to the tolerance", loc="left")
        line[1].set_ylabel("iterations")
        sizes = numpy.array(sorted({row["unknowns"] for row in members}), float)
        if sizes.size > 1:
            lowest = min(row["setup_seconds"] + row["solve_seconds"] for row in members) * 1e3 * 0.6
            line[0].loglog(sizes, lowest * sizes / sizes[0], linestyle=(0, (5, 3)), color=QUIET, linewidth=1.1)
            line[0].annotate("slope 1", (sizes[-1], lowest * sizes[-1] / sizes[0]), color=QUIET, fontsize=9.5,
                             ha="right", va="top", xytext=(0, -4), textcoords="offset points")
        for panel in line[:2]:
            panel.set_xlabel("unknowns 3n")
        line[2].set_axis_off()
    handles = [Line2D([], [], linewidth=1.3, label=short(solver), **look(k)) for k, solver in enumerate(solvers)]
    axes[0][2].legend(handles=handles, loc="upper left", borderaxespad=0)
    return figure


def draw_sequence(result, rows, solvers):
    """Iterations along the simulation of the largest, stiffest system."""
    iterative = [row for row in rows if "sequence_iterations_kept" in result.case_of(row)
                 and result.values("sequence_iterations_kept", result.case_of(row)).size > 1
                 and result.values("sequence_iterations_cold", result.case_of(row)).max() > 1]
    if not iterative:
        return None
    largest = max(iterative, key=lambda row: (row["unknowns"], row["iterations"]))
    shown = [row for row in iterative
             if (row["problem"], row["step"]) == (largest["problem"], largest["step"])]
    figure, axes = new_figure(result, 15.5, 5.2, 1, len(STARTS), sharey=True)
    for panel, (start, meaning) in zip(axes[0], STARTS.items()):
        for row in shown:
            iterations = result.values(f"sequence_iterations_{start}", result.case_of(row))
            panel.semilogy(numpy.arange(1, iterations.size + 1), numpy.maximum(iterations, 1), linewidth=1.4,
                           label=short(row["solver"]), markevery=max(1, iterations.size // 6),
                           **look(solvers.index(row["solver"])))
        panel.set_title(meaning, loc="left", fontsize=11)
        panel.set_xlabel("step of the simulation")
    axes[0][0].set_ylabel("iterations")
    axes[0][-1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5),
                       title=f"{largest['problem']}, h = {largest['step']:g} s", alignment="left")
    return figure


def draw_spectra(result):
    spectra = [row for row in result.summary() if row["solver"] == "spectrum"]
    if not spectra:
        return None
    figure, axes = new_figure(result, 15.5, 5.0, 1, 3, gridspec_kw={"width_ratios": [1, 1, 0.62]})
    for index, row in enumerate(spectra):
        case = result.case_of(row)
        for panel, name in zip(axes[0], ("eigenvalue", "eigenvalue_block_jacobi")):
            values = numpy.sort(result.values(name, case))
            panel.semilogy(numpy.linspace(0, 1, values.size), values, linewidth=1.5,
                           markevery=max(1, values.size // 5), **look(index),
                           label=f"{row['problem']}, h = {row['step']:g} s: κ = {row['condition']:.3g}, "
                                 f"{row['condition_block_jacobi']:.3g}")
            panel.set_xlabel("share of the eigenvalues below")
    axes[0][0].set_title("A = M − hD − h²K", loc="left")
    axes[0][0].set_ylabel(label("eigenvalue", result.unit("eigenvalue", case)))
    axes[0][1].set_title("with the block-Jacobi preconditioner", loc="left")
    axes[0][1].set_ylabel("eigenvalue")
    axes[0][2].set_axis_off()
    axes[0][2].legend(*axes[0][0].get_legend_handles_labels(), loc="upper left", borderaxespad=0, fontsize=9,
                      title="condition κ, without and with", alignment="left")
    return figure


def draw(result):
    rows = solver_rows(result)
    solvers = list(dict.fromkeys(row["solver"] for row in rows))
    figures = [draw_scaling(result, rows, solvers)] if rows else []
    for figure in (draw_sequence(result, rows, solvers), draw_spectra(result)):
        if figure is not None:
            figures.append(figure)
    return figures


if __name__ == "__main__":
    sys.exit(plot_style.main(__doc__, plot_style.expect_kind("linear_solver", draw)))
