"""Writes result files as docs/results_schema.md describes them, with made-up numbers, to draw pictures of.

Run by itself it fills a folder: synthetic_results.py DIR
"""

import pathlib
import sys

import numpy
from synthetic_motions import (construction, dissipation, energy, new_file, oscillation, propagation, put,
                               simulated_energy, slope_field, spiral, trajectory, vector_field)


METHODS = {"explicit_euler": 1, "symplectic_euler": 1, "midpoint": 2, "velocity_verlet": 2, "rk4": 4,
           "sundials:cvode_bdf": 0}


def convergence(path, problems=("henon_heiles", "single_spring_with_damper")):
    """Errors C·h^p with a rounding floor; the points on the floor are not used. One error is not finite."""
    step = 0.1 * 0.5 ** numpy.arange(9)
    rows = []
    with new_file(path, "convergence", "Convergence on smooth problems") as file:
        for problem in problems:
            for index, (method, order) in enumerate(METHODS.items()):
                case = file.create_group(f"cases/{problem}-{method}")
                power = order or 1.5
                exact = 3.0 * (1 + index) * step ** power
                floor = 4e-13 / step
                used = (exact > 10 * floor) & (step < 0.09) & (order > 0)
                position = exact + floor * (1 + 0.5 * numpy.cos(40 * step))
                if index == 0:
                    position[0] = numpy.inf
                put(case, "step", step, "s")
                put(case, "error_position", position, "m")
                put(case, "error_velocity", 2.5 * position, "m/s")
                put(case, "error", position)
                put(case, "used", used.astype(numpy.int64))
                put(case, "used_position", used.astype(numpy.int64))
                fitted = used & (step > step.min())  # velocity: one point less, to be told apart
                put(case, "used_velocity", fitted.astype(numpy.int64))
                verdict = "holds" if order else "not applicable"
                if method == "midpoint" and problem != problems[0]:
                    verdict = "fails"
                fit = numpy.array([-0.003, -0.02, 0.014]) + (order or numpy.nan)
                rows.append((f"{problem}-{method}", problem, method, order, *fit, *fit, *(fit - 0.01), verdict))
        summary = file.create_group("summary")
        names = ["order", "order_low", "order_high"]
        names = ["case", "problem", "method", "expected_order", *names, *(f"{name}_position" for name in names),
                 *(f"{name}_velocity" for name in names), "verdict"]
        for name, column in zip(names, zip(*rows)):
            put(summary, name, list(column), "" if isinstance(column[0], str) else "1")


def agreement(path, wrong="gsl:rk4"):
    """Seven solutions, one too inaccurate to compare, and one that is wrong by more than it says."""
    methods = ["certified", "explicit_euler", "rk4", "velocity_verlet", "sundials:cvode_bdf", "petsc:ts_rk", "gsl:rk4"]
    families = ["reference", "explicit", "explicit", "splitting", "oracle", "oracle", "oracle"]
    estimate = numpy.array([1e-19, 1e-2, 1e-9, 1e-7, 3e-9, 1e-9, 2e-9])
    value = 0.5 * estimate * numpy.array([1, -1, 1, -1, 1, -1, 1])
    if wrong:
        value[methods.index(wrong)] += 1e-6
    compared = estimate < 1e-3
    difference = numpy.abs(value[:, None] - value[None, :])
    expected = 2 * (estimate[:, None] + estimate[None, :]) + 1e-11
    agrees = numpy.where(compared[:, None] & compared[None, :], difference <= expected, -1).astype(numpy.int64)
    numpy.fill_diagonal(agrees, -1)
    with new_file(path, "agreement", "Agreement of all methods") as file:
        case = file.create_group("cases/small_cloth")
        put(case, "method", methods, "")
        put(case, "family", families, "")
        put(case, "error_estimate", estimate)
        put(case, "compared", compared.astype(numpy.int64))
        put(case, "difference", difference)
        put(case, "expected_difference", expected)
        put(case, "agrees", agrees)
        summary = file.create_group("summary")
        for name, column in {"case": ["small_cloth"], "problem": ["small_cloth"], "methods": [6], "not_accurate": [1],
                             "not_applicable": [0], "pairs": [15], "disagreeing": [5 if wrong else 0],
                             "verdict": ["fails" if wrong else "holds"]}.items():
            put(summary, name, column)


def linear_solver(path):
    """Three sizes of one cloth, a direct and an iterative solver, and the spectrum of the smallest."""
    rows = []
    with new_file(path, "linear_solver", "Linear solvers") as file:
        for count in (8, 16, 32):
            problem, unknowns = f"cloth{count}-k100", 3 * count * count
            if count == 8:
                case = file.create_group(f"cases/{problem}-h0.01-spectrum")
                put(case, "eigenvalue", numpy.geomspace(1e-3, 1, unknowns), "kg")
                put(case, "eigenvalue_block_jacobi", numpy.geomspace(1e-2, 2, unknowns))
                rows.append((f"{problem}-h0.01-spectrum", problem, 0.01, "spectrum", unknowns, numpy.nan, numpy.nan, 9.0,
                             1e3, 200.0))
            for solver in ("cholmod", "petsc -ksp_type cg -pc_type icc -mat_type sbaij"):
                name = f"{problem}-h0.01-{solver.replace(' ', '_')}"
                case = file.create_group(f"cases/{name}")
                iterative = solver.startswith("petsc")
                for start in ("cold", "warm", "kept") if iterative else ("cold",):
                    put(case, f"sequence_iterations_{start}", numpy.arange(10, 20) * count // 8 if iterative else [0] * 10)
                rows.append((name, problem, 0.01, solver, unknowns, 1e-6 * unknowns, 1e-7 * unknowns ** 1.3,
                             2.0 * count if iterative else numpy.nan, numpy.nan, numpy.nan))
        summary = file.create_group("summary")
        for name, column in zip(("case", "problem", "step", "solver", "unknowns", "setup_seconds", "solve_seconds",
                                 "iterations", "condition", "condition_block_jacobi"), zip(*rows)):
            put(summary, name, list(column))


def stability(path):
    """Regions of two schemes, their limits on two problems (one unstable at every step), and S11's thresholds."""
    nan = numpy.nan
    names = ["case", "part", "problem", "method", "basis", "real_interval", "imaginary_interval", "spectral_radius",
             "predicted_limit", "observed_limit", "ratio", "expected_exponent", "verdict"]
    rows = []
    axis_x, axis_y, distance = numpy.linspace(-4, 1.9, 31), numpy.linspace(-3, 3, 31), numpy.linspace(0, 4, 41)
    z = axis_x[None, :] + 1j * axis_y[:, None]
    factor = {"explicit_euler": lambda w: 1 + w, "trapezoidal": lambda w: (1 + w / 2) / (1 - w / 2)}
    with new_file(path, "stability", "Stability") as file:
        for method, R in factor.items():
            case = file.create_group(f"cases/region-{method}")
            put(case, "z_real", axis_x)
            put(case, "z_imaginary", axis_y)
            put(case, "growth", abs(R(z)))
            put(case, "order_star", abs(R(z) * numpy.exp(-z)))
            put(case, "distance", distance)
            put(case, "growth_real_axis", abs(R(-distance)))
            put(case, "growth_imaginary_axis", abs(R(1j * distance)))
            ends = (2.0, 0.0) if method == "explicit_euler" else (numpy.inf, numpy.inf)
            rows.append((f"region-{method}", "region", "", method, "R(z)", *ends, nan, nan, nan, nan, nan, "holds"))
            for problem, limit in (("undamped", 0.0), ("damped", 0.04)):
                predicted = limit if method == "explicit_euler" else numpy.inf
                file.create_group(f"cases/{problem}-{method}")
                rows.append((f"{problem}-{method}", "limit", problem, method, "R(z)", nan, nan, 20.0, predicted,
                             1.01 * predicted if predicted else 0.0, 1.01, nan, "holds"))
            case = file.create_group(f"cases/decay-{method}")
            k = numpy.array([1.0, 10.0, 100.0])
            limit = 2 / k if method == "explicit_euler" else numpy.full(3, numpy.inf)
            put(case, "parameter", -k, "SI").attrs["name"] = "lambda"
            put(case, "spectral_radius", k, "1/s")
            for what, values in (("predicted_limit", limit), ("observed_limit", 1.001 * limit),
                                 ("monotone_predicted", 1 / k if method == "explicit_euler" else 2 / k),
                                 ("monotone_observed", 1.002 / k if method == "explicit_euler" else 2 / k)):
                put(case, what, values, "s")
            rows.append((f"decay-{method}", "law", "decay", method, "R(z)", nan, nan, nan, nan, nan, nan, -1.0, "holds"))
        summary = file.create_group("summary")
        for name, column in zip(names, zip(*rows)):
            put(summary, name, list(column), "" if isinstance(column[0], str) else "1")


#: Kinds of pictures that come as several figures, or are chosen by what a file of kind "simulate" holds.
LATER = {"energy": energy, "dissipation": dissipation, "propagation": propagation, "vector_field": vector_field,
         "oscillation": oscillation, "construction": construction, "simulated_energy": simulated_energy}


def verify(path):
    """A scheme that keeps all it claims, one that does not, and one that has a property of its own."""
    found = {"rk4": {"order, y' = f(t, y)": "holds", "symplectic": "holds"},
             "broken": {"order, y' = f(t, y)": "fails", "symplectic": "not applicable"},
             "velocity_verlet": {"order, y' = f(t, y)": "not applicable", "shorter last step": "holds",
                                 "symplectic": "holds"}}
    rows = []
    with new_file(path, "verify", "Verification of schemes") as file:
        for method, properties in found.items():
            case = file.create_group(f"cases/{method}")
            put(case, "property", list(properties), "")
            for name in ("claimed", "derived", "measured", "reason"):
                put(case, name, ["4"] * len(properties), "")
            put(case, "verdict", list(properties.values()), "")
            rows.append((method, method, "fails" if "fails" in properties.values() else "holds"))
        summary = file.create_group("summary")
        for name, column in zip(("case", "method", "verdict"), zip(*rows)):
            put(summary, name, list(column), "")


def work_precision(path, factorisations=40):
    """Two ladders on one problem: an explicit method of order 4 on the front, an implicit one of order 2 above it."""
    work = numpy.array([100, 200, 400, 800])
    with new_file(path, "work_precision", "Error against work") as file:
        rows, front = [], []
        for method, order, dear in (("rk4", 4, 1), ("implicit_midpoint", 2, 3)):
            name = f"oscillator-{method}-fixed"
            case = file.create_group(f"cases/{name}")
            error = (work / 50.0) ** -order
            put(case, "error", error)
            put(case, "rhs_evaluations", work * dear)
            put(case, "factorisations", work // work[0] * (factorisations if dear > 1 else 0))
            put(case, "seconds", 1e-7 * work * dear, "s")
            on_front = 4 if method == "rk4" else 0
            rows.append((name, "oscillator", method, "fixed", on_front, on_front))
            front = front or [work, error]
        case = file.create_group("cases/oscillator-front")
        for measure, factor, unit in (("rhs_evaluations", 1.0, "1"), ("seconds", 1e-7, "s")):
            put(case, f"front_{measure}", factor * front[0], unit)
            put(case, f"front_{measure}_error", front[1])
        rows.append(("oscillator-front", "oscillator", "Pareto front", "", 4, 4))
        summary = file.create_group("summary")
        for name, column in zip(("case", "problem", "method", "control", "front_points_rhs_evaluations",
                                 "front_points_seconds"), zip(*rows)):
            put(summary, name, list(column), "" if isinstance(column[0], str) else "1")


def stiffness(path, crosses=True):
    """Costs that cross at a stiffness of 1e4, and an order map with order 2 below and 1 above h|lambda| = 1."""
    values = numpy.geomspace(1e2, 1e6, 5)
    eigenvalues = numpy.sqrt(values)
    with new_file(path, "stiffness", "Stiffness") as file:
        rows = []

        def case(method, measure, stepping):
            name = f"pendulum-{method}-{measure}"
            rows.append([name, "pendulum", method, measure, stepping, 2, numpy.nan, numpy.nan, numpy.nan, numpy.nan,
                         numpy.nan, numpy.nan, numpy.nan, numpy.nan, numpy.nan])
            group = file.create_group(f"cases/{name}")
            put(group, "parameter", values, "SI")
            group["parameter"].attrs["name"] = "stiffness"
            put(group, "largest_eigenvalue", eigenvalues, "1/s")
            return group

        costs = {"explicit": eigenvalues, "implicit": numpy.full(5, 100.0)}
        for method, stepping in (("velocity_verlet", "explicit"), ("implicit_euler", "implicit")):
            group = case(method, "cost", stepping)
            put(group, "accepted_steps", costs[stepping].astype(int))
            put(group, "rejected_steps", numpy.zeros(5, int))
            put(group, "cost", costs[stepping])
            put(group, "seconds", 1e-6 * costs[stepping], "s")
        group = case("implicit_midpoint", "orders", "implicit")
        steps = 0.1 / 2.0 ** numpy.arange(6)
        put(group, "step", steps, "s")
        order = numpy.where(steps[None, :] * eigenvalues[:, None] < 1, 2.0, 1.0)
        order[:, 0] = numpy.nan
        put(group, "local_order", order)
        rows[-1][6:9] = [2.0, 1.0, 1.0]
        group = case("overview", "overview", "")
        put(group, "stiffness_index", 2.3 * eigenvalues)
        put(group, "eigenvalue_ratio", eigenvalues)
        put(group, "stiffness_ratio", numpy.full(5, numpy.nan))
        for stepping, cost in costs.items():
            for name, factor, unit in (("cost", 1.0, "1"), ("seconds", 1e-6, "s")):
                put(group, f"cheapest_{stepping}_{name}", factor * cost, unit)
                put(group, f"cheapest_{stepping}_{name}_spread", numpy.full(5, 1.1))
        rows[-1][9:15] = [1e4, 9e3, 1.1e4] * 2 if crosses else [numpy.nan] * 6
        summary = file.create_group("summary")
        for name, column in zip(("case", "problem", "method", "measure", "stepping", "classical_order", "nonstiff_order",
                                 "stiff_order", "predicted_stiff_order", "crossing_cost", "crossing_cost_low",
                                 "crossing_cost_high", "crossing_seconds", "crossing_seconds_low",
                                 "crossing_seconds_high"), zip(*rows)):
            put(summary, name, list(column), "" if isinstance(column[0], str) else "1")


def jacobian(path):
    """All four parts of a study of one spring, with the slopes and limits that theory has."""
    rows = []
    figures = ("deviation", "truncation_slope", "rounding_slope", "best_increment", "filled", "compression")

    def row(case, part, variant, subject="spring", **values):
        rows.append([case, subject, part, variant, *(values.get(name, numpy.nan) for name in figures)])

    increment = 10.0 ** -numpy.arange(1, 14.1, 0.25)
    with new_file(path, "jacobian", "Derivatives of a spring") as file:
        for order, formula in ((1, "forward"), (2, "central")):
            error = 0.3 * increment ** order + 1e-16 / increment
            case = file.create_group(f"cases/spring-{formula}")
            put(case, "increment", increment)
            put(case, "deviation", error)
            row(f"spring-{formula}", "derivative", formula, truncation_slope=order, rounding_slope=-1,
                best_increment=increment[error.argmin()])
        for formula, size in (("analytic", 1e-16), ("printed_e1", 3.0), ("printed_e2", 2.0)):
            case = file.create_group(f"cases/spring-{formula}")
            put(case, "deviation", size * numpy.linspace(1, 2, 9))
            row(f"spring-{formula}", "derivative", formula, deviation=2 * size)
            if formula != "analytic":
                put(case, "block_difference", size * numpy.arange(1, 10), "N/m")
                put(case, "predicted_difference", size * numpy.arange(1, 10), "N/m")
        case = file.create_group("cases/chain-pattern")
        put(case, "block_row", [0, 0, 1, 1, 1, 2, 2])
        put(case, "block_column", [0, 1, 0, 1, 2, 1, 2])
        put(case, "largest_entry", [0.0, 0.0, 5.0, 10.0, 5.0, 5.0, 10.0], "SI")
        row("chain-pattern", "pattern", "3x3 blocks", subject="chain", filled=7 / 9)
        compression, step = numpy.array([0.5, 0.9, 1.1]), numpy.geomspace(1e-3, 1, 7)
        for model in ("exact", "psd_projection"):
            growth = numpy.maximum(1 / compression - 1, 0) * 200 * (model == "exact")
            eigenvalue = 1 - numpy.outer(growth, step ** 2)
            limit = numpy.where(growth > 0, 1 / numpy.sqrt(numpy.maximum(growth, 1e-9)), numpy.nan)
            case = file.create_group(f"cases/spring-{model}")
            put(case, "compression", compression)
            put(case, "step", step, "s")
            put(case, "limit_step", limit, "s")
            put(case, "predicted_limit_step", limit, "s")
            put(case, "eigenvalue", eigenvalue, "kg")
            for name in ("newton_iterations", "newton_cg_iterations", "cg_iterations"):
                put(case, name, numpy.where(eigenvalue > 0, 3, -1))
            row(f"spring-{model}", "definiteness", model)
        for method in ("implicit_euler_linearised", "implicit_euler"):
            case = file.create_group(f"cases/spring-{method}-L0.5")
            stopped = (step > 0.08) & (method != "implicit_euler")
            put(case, "step", step, "s")
            put(case, "status", ["matrix_indefinite" if stop else "success" for stop in stopped], "")
            put(case, "energy_gain", 10 * step)
            row(f"spring-{method}-L0.5", "runs", method, compression=0.5)
        summary = file.create_group("summary")
        for name, column in zip(("case", "subject", "part", "variant", *figures), zip(*rows)):
            put(summary, name, list(column))


def sweep(path, quantities='["end_error"]'):
    """end_error = stiffness * step^p for two schemes and two steps."""
    rows = [(stiffness, step, method, stiffness * step ** METHODS[method])
            for stiffness in (1.0, 10.0, 100.0) for step in (0.01, 0.02) for method in ("velocity_verlet", "rk4")]
    with new_file(path, "sweep", "Error over stiffness and step") as file:
        file.attrs["spec"] = f'kind = "sweep"\nquantities = {quantities}\n'
        summary = file.create_group("summary", track_order=True)
        put(summary, "case", [f"stiffness={row[0]:g},step={row[1]:g}-{row[2]}" for row in rows], "")
        put(summary, "parameter_stiffness", numpy.array([row[0] for row in rows]), "N/m")
        put(summary, "parameter_step", numpy.array([row[1] for row in rows]), "s")
        put(summary, "method", [row[2] for row in rows], "")
        put(summary, "constant", numpy.ones(len(rows)))
        put(summary, "end_error", numpy.array([row[3] for row in rows]), "m")


ALL = {"agreement": agreement, "convergence": convergence, "trajectory": trajectory, "slope_field": slope_field, "spiral": spiral, "sweep": sweep}

if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, write in ALL.items():
        write(folder / f"{name}.h5")
    linear_solver(folder / "linear_solver.h5")
    stability(folder / "stability.h5")
    for name, write in LATER.items():
        write(folder / f"{name}.h5")
    work_precision(folder / "work_precision.h5")
    stiffness(folder / "stiffness.h5")
    jacobian(folder / "jacobian.h5")
    trajectory(folder / "stopped.h5", particles=60, status="blow_up")
