"""One study of every kind about a scene, and what the independent truth says of each of its verdicts."""

import h5py
import numpy as np

import verdict_scenes
from mass_spring_reference import integrate, rk4, symplectic_euler
from verdict_truth import ORDERS

ADAPTIVE = ["bogacki_shampine_32", "cash_karp_54", "fehlberg_54", "dormand_prince_54", "tsitouras_54", "verner_65",
            "dormand_prince_853", "verner_87", "dormand_prince_rkn_64", "dormand_prince_rkn_86", "sdirk4", "tr_bdf2",
            "esdirk4", "esdirk5", "ros3p", "rodas4", "rodasp", "ark436", "sundials:cvode_bdf", "sundials:cvode_adams",
            "sundials:arkode_erk", "sundials:arkode_dirk", "sundials:ida", "petsc:ts_rk", "petsc:ts_bdf",
            "petsc:ts_rosw", "gsl:rk2", "gsl:rkf45", "gsl:rkck", "gsl:rk8pd", "gsl:bsimp", "gsl:msadams", "gsl:msbdf"]
FIXED = ["explicit_euler", "midpoint", "heun", "kutta3", "ssprk3", "nystrom4", "nystrom5", "symplectic_euler_b",
         "velocity_verlet", "velocity_verlet_predicted", "position_verlet", "ruth3", "forest_ruth", "pefrl",
         "blanes_moan4", "yoshida6", "kahan_li8", "rkc2", "implicit_euler", "implicit_midpoint", "trapezoidal",
         "crouzeix3", "sdirk2", "sdirk3", "gauss2", "gauss3", "radau_ia2", "radau_iia2", "radau_iia3", "lobatto_iiia3",
         "lobatto_iiic3", "lobatto_iiia_iiib3", "rosenbrock_euler", "implicit_euler_linearised", "adams_bashforth3",
         "adams_moulton3", "bdf2", "bdf4", "newmark", "hht_alpha", "generalised_alpha", "average_vector_field",
         "discrete_gradient", "exponential_rosenbrock_euler", "gautschi", "petsc:ts_basicsymplectic"]
EXPLICIT = ["midpoint", "heun", "kutta3", "nystrom4", "velocity_verlet", "position_verlet", "forest_ruth", "pefrl",
            "adams_bashforth2", "symplectic_euler_b", "yoshida6", "rkc2"]
KINDS = ("simulate", "energy", "convergence", "agreement", "work_precision", "stability", "stiffness", "jacobian",
         "linear_solver", "propagation", "sweep", "dissipation")


class Study:
    """What a result file holds: summary rows as dicts and the datasets of the cases."""

    def __init__(self, path):
        with h5py.File(path, "r") as file:
            columns = {name: item[()] for name, item in file["summary"].items()}
            self.rows = [{name: value[i].decode() if isinstance(value[i], bytes) else value[i]
                          for name, value in columns.items()} for i in range(len(columns["verdict"]))]
            self.cases = {name: {key: item[()] for key, item in group.items()} for name, group in file["cases"].items()}


def pick(rng, names, count):
    return [names[int(k)] for k in rng.choice(len(names), count, replace=False)]


def rounded(value):
    return float(f"{value:.3g}")


def table(kind, methods, problem, **sections):
    study = {"kind": kind, "title": kind}
    if methods:
        study["methods"] = methods
    plain = {key: value for key, value in sections.items() if not isinstance(value, dict)}
    return {**study, **plain, **{key: value for key, value in sections.items() if isinstance(value, dict)},
            **({"problem": [problem]} if problem else {})}


def studies_of(rng, truth, scene, file, taut, end):
    """A study per kind as nested dicts; kinds that have nothing to do on the scene are left out."""
    rate = max(truth.model.fastest_rate(), 5.0 / end)
    problem = {"scene": file, "t_end": end, "label": "scene"}
    steps = max(8, int(np.ceil(end * rate)))
    h = end / steps
    result = {
        "simulate": table("simulate", ["rk4", "symplectic_euler", *pick(rng, FIXED, 1), *pick(rng, ADAPTIVE, 3)], problem,
                          steps=[end / max(1, steps // 4), end / (4 * steps)], frames=9),
        "convergence": table("convergence", ["rk4", "symplectic_euler", *pick(rng, FIXED, 2)], problem,
                             convergence={"levels": 6, "max_steps": 20000}),
        "agreement": table("agreement", ["rk4", *pick(rng, FIXED, 3), *pick(rng, ADAPTIVE, 3)], problem,
                           agreement={"error": 1e-6, "most_steps": 1024}),
        "work_precision": table("work_precision", ["rk4", *pick(rng, FIXED, 1), *pick(rng, ADAPTIVE, 1)], problem,
                                work_precision={"levels": 9, "max_evaluations": 6000, "repetitions": 1,
                                                "shortest_sample": 1e-9, "longest_timing": 1e-9}),
        "sweep": {"kind": "sweep", "title": "sweep",
                  "parameter": [{"path": "steps[0]", "name": "h", "unit": "s", "values": [end / steps, end / (2 * steps)]}],
                  "study": {"kind": "simulate", "methods": ["rk4", "symplectic_euler"], "steps": [1.0], "frames": 5,
                            "problem": [problem]}},
    }
    base = rounded((0.05, 0.3, 1.0, 2.5)[int(rng.integers(4))] / rate)
    result["energy"] = table("energy", ["rk4", "symplectic_euler", "velocity_verlet",
                                        *pick(rng, [m for m in FIXED if m != "velocity_verlet"], 2)], problem,
                             energy={"steps": [base, base / 2, base / 4], "step_count": 300, "bins": 40})
    result["jacobian"] = table("jacobian", None, problem,
                               derivatives={"formulas": ["analytic"], "samples": 2},
                               definiteness={"compressions": [0.83, 1.07], "steps": [h, 5.0 * h], "displacement": 0.0,
                                             "tangents": ["exact"]})
    result["linear_solver"] = table("linear_solver", None, problem, solvers=["cg", "cholesky", "lu"],
                                    linear_solver={"steps": [h], "sequence": 2, "repetitions": 1})
    if truth.model.has_velocity_forces() or len(truth.model.between) > 0 or len(truth.model.anchored) > 0:
        result["stability"] = table("stability", ["rk4", "symplectic_euler", "explicit_euler", *pick(rng, EXPLICIT, 1)],
                                    {**problem, "scene": taut, "linearise": True},
                                    limits={"fewest_steps": 300, "most_steps": 2000})
    path = {"springs": "springs.stiffness", "generate": "generate.stiffness"}
    found = [name for name in path if isinstance(scene.get(name), dict) and np.isscalar(scene[name].get("stiffness"))]
    if found and len(truth.model.between) > 0:
        k = float(scene[found[0]]["stiffness"])
        result["stiffness"] = table(
            "stiffness", ["rk4", "symplectic_euler", *pick(rng, FIXED, 1), *pick(rng, ADAPTIVE, 1)],
            {**problem, "vary": {"parameter": path[found[0]], "values": [k, 2.0 * k, 4.0 * k, 8.0 * k]}},
            stiffness={"measure": "cost", "max_evaluations": 10000, "repetitions": 1, "shortest_sample": 1e-9,
                       "longest_timing": 1e-9})
    result["dissipation"] = table("dissipation", ["rk4", "velocity_verlet", "heun", *pick(rng, [m for m in FIXED if m not in ("velocity_verlet", "heun")], 1)],
                                  None,
                                  dissipation={"mass": rounded(10 ** rng.uniform(-3, 3)),
                                               "stiffness": rounded(10 ** rng.uniform(-2, 6)), "count": 7, "periods": 3.0})
    return result


def taut_scene(scene):
    """The same network with all springs stretched by a ninth, so that nothing buckles."""
    if isinstance(scene.get("springs"), dict):
        springs = dict(scene["springs"])
        points = np.array(scene["particles"]["position"], dtype=float)
        ends = points[np.array(springs["between"])]
        springs["rest_length"] = (0.9 * np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)).tolist()
        return {**scene, "springs": springs}
    if "generate" in scene:
        return {**scene, "generate": {**scene["generate"], "rest_length_factor": 0.9}}
    return scene


def scene_at_rest(scene):
    """The same network without a force at rest, or None where it cannot be."""
    if "springs" not in scene or len(scene["particles"]["position"]) < 3:
        return None
    springs = {key: value for key, value in scene["springs"].items() if key not in ("rest_length", "law")}
    particles = {key: value for key, value in scene["particles"].items() if key != "velocity"}
    return {"particles": particles, "springs": springs}


def propagation_study(rng, truth, file):
    h = rounded(0.3 / max(truth.model.fastest_rate(), 1e-3))
    return table("propagation", ["rk4", "symplectic_euler", "explicit_euler", *pick(rng, FIXED, 1)],
                 {"scene": file, "t_end": 1.0, "label": "scene"},
                 propagation={"steps": [h], "step_count": 6, "mass": int(np.flatnonzero(truth.model.free[:, 0])[0])})


class Judge:
    """Collects contradictions between verdicts and the truth."""

    def __init__(self, truth):
        self.truth, self.findings = truth, []

    def contradict(self, row, text):
        self.findings.append((row.get("case", ""), row.get("verdict", ""), text, row.get("reason", "")))

    def judge(self, kind, study, spec):
        for row in study.rows:
            stopped = kind in ("simulate", "sweep") and row["status"] != "success"  # and says so
            if row["verdict"] == "fails" and not stopped:
                self.contradict(row, "fails on a scheme of the catalogue")
            with np.errstate(all="ignore"):
                getattr(self, kind)(row, study.cases.get(row.get("case", ""), {}), spec)
        return self.findings

    # --- one function per kind -------------------------------------------------------------------------------------
    def simulate(self, row, case, spec):
        truth, model = self.truth, self.truth.model
        if row["verdict"] != "done" or "state" not in case:
            return
        state = case["state"].reshape(len(case["time"]), 2, model.count, 3)
        if not np.isfinite(state).all() or case["time"][-1] != truth.end:
            self.contradict(row, "done, with NaN or before the end")
            return
        error = np.abs(state[-1] - truth.state).max(axis=(1, 2)) / truth.size
        if np.isnan(row["step"]):
            allowed = 1e-8 * 1e3 * truth.amplification + truth.error / truth.size.min()
            if error.max() > allowed:
                self.contradict(row, f"done, end state off by {error.max():.2e} of its size, allowed {allowed:.2e}")
        elif truth.is_conservative():
            gain = max(truth.energy(y) for y in state) - truth.energy(state[0])
            if gain > 200.0 * truth.energy_size:
                self.contradict(row, f"done, energy grows by {gain:.2e} J where the motion has {truth.energy_size:.2e} J")
        for solid in model.solids:
            apart = ((state[-1, 0] - truth.state[0]) ** 2).sum(axis=1) ** 0.5
            if solid.shape == "box" and not np.isnan(row["step"]):
                passed = (state[-1, 0, :, 0] > solid.upper[0]) & (truth.state[0, :, 0] <= solid.upper[0])
                if passed.any() and "obstacles" not in row["reason"]:
                    self.contradict(row, f"done, passed through the box without a word (off by {apart.max():.2g} m)")

    sweep = simulate

    def convergence(self, row, case, spec):
        truth, method = self.truth, row["method"]
        if not len(case.get("step", [])) or truth.stepper(method) is None:
            return
        ratios = []
        for k in (0, len(case["step"]) // 2):
            count = round(truth.end / case["step"][k])
            if count > 3000:
                continue
            mine = truth.run(method, truth.end / count, count)[-1] - truth.state
            theirs = case["error_components"][k].reshape(mine.shape)
            if not np.isfinite(mine).all():
                continue
            off = np.abs(mine - theirs).max()
            allowed = truth.error + 1e-6 * np.abs(mine).max() + 1e-12 * truth.amplification * np.abs(truth.state).max()
            if off > allowed:
                self.contradict(row, f"error at step {case['step'][k]:.3g} is off by {off:.2e} (of {np.abs(mine).max():.2e}), "
                                     f"allowed {allowed:.2e}")
            ratios.append((count, np.abs(mine).max(axis=(1, 2))))
        if row["verdict"] == "holds" and len(ratios) == 2 and ratios[1][1].min() > 1e3 * truth.error:
            orders = np.log(ratios[0][1] / ratios[1][1]) / np.log(ratios[1][0] / ratios[0][0])
            # one half may be better than the scheme is in general
            if abs(orders.min() - ORDERS[method]) > 0.7:
                self.contradict(row, f"holds, the orders by independent runs are {orders}")

    def work_precision(self, row, case, spec):
        truth, method = self.truth, row["method"]
        if truth.stepper(method) is None or row["control"] != "fixed" or not len(case.get("step", [])):
            return
        k = len(case["step"]) // 2
        count = round(truth.end / case["step"][k])
        if count > 3000:
            return
        mine = truth.relative_error(truth.run(method, truth.end / count, count)[-1] - truth.state)
        if np.isfinite(mine) and abs(mine - case["error"][k]) > 1e-3 * mine + truth.relative_error(
                np.full(truth.state.shape, truth.error)) + 1e-11 * truth.amplification:
            self.contradict(row, f"error {case['error'][k]:.4e} at step {case['step'][k]:.3g}, by independent runs {mine:.4e}")

    def agreement(self, row, case, spec):
        truth = self.truth
        if row["verdict"] != "holds":
            return
        own = truth.relative_error(np.full(truth.state.shape, truth.error))
        for method, state, estimate, compared in zip(case["method"], case["state"], case["error_estimate"],
                                                     case["compared"]):
            if not compared:
                continue
            off = truth.relative_error(state.reshape(truth.state.shape) - truth.state)
            if off > 2.0 * estimate + 1e-10 + own:
                self.contradict(row, f"holds, but {method.decode()} is off by {off:.2e}, estimated {estimate:.2e}, truth {own:.1e}")

    def energy(self, row, case, spec):
        truth, method = self.truth, row["method"]
        if truth.stepper(method) is None:
            grown = np.nanmax(np.abs(case["change_largest"]), initial=0.0)
            if row["verdict"] == "holds" and truth.is_conservative() and grown > 1e3 * (
                    truth.energy_size + truth.largest_energy_change) and "predicted 1" not in row["reason"]:
                self.contradict(row, f"holds, the energy changes by {grown:.2e} J of {truth.energy_size:.2e} J")
            return
        defects, explosions = [], 0
        for k, step in enumerate(case["step"]):
            if k == 1 and not truth.model.has_velocity_forces():
                continue
            count = int(case["steps_taken"].max())
            states = truth.run(method, step, count)
            energy = np.array([truth.energy(y) for y in states])
            size = max(truth.energy_size, np.nanmax([truth.model.kinetic_energy(y[1]) + truth.model.elastic_energy(y[0])
                                                     for y in states[:40]]))
            if not np.isfinite(energy).all() or np.ptp(energy) > 1e3 * size and truth.is_conservative():
                explosions += 1
                continue
            found = (np.nanmin(case["change_least"][k]), np.nanmax(case["change_largest"][k]))
            mine = (energy.min() - energy[0], energy.max() - energy[0])
            magnitude = np.abs(truth.model.mass[:, None] * states[:, 0] * truth.model.gravity).sum(axis=(1, 2)).max()
            rough = 1e-10 * (size + np.ptp(energy) + magnitude) * min(truth.amplification, 1e4)
            # beyond, steps are too long for the motion, and chaos multiplies rounding
            if truth.amplification < 100 and np.ptp(energy) < 3.0 * size and max(abs(np.subtract(found, mine))) > 1e3 * rough:
                self.contradict(row, f"energy changes in {found} at h = {step:.3g}, by independent runs {mine}")
            if truth.model.has_velocity_forces():
                defects.append((step, abs(truth.balance(states, step)[-1]), rough))
            elif row["verdict"] == "holds" and "no secular drift" in row["reason"]:
                if k > 0:
                    continue
                longer = np.array([truth.energy(y) for y in truth.run(method, step, 3 * count)])
                first, last = longer[:count], longer[-count:]
                shift = abs(last.mean() - first.mean())
                if not shift <= 3.0 * np.ptp(first) + 1e-9 * size:
                    self.contradict(row, f"holds without drift, over three times as many steps (h = {step:.3g}) the energy "
                                         f"moves by {shift:.2e} J, oscillation {np.ptp(first):.2e} J")
        if row["verdict"] == "holds" and explosions and "predicted 1" not in row["reason"]:
            self.contradict(row, f"holds, {explosions} of the runs explode")
        clear = [d for d in defects if d[1] > 100 * d[2]]
        if row["verdict"] == "holds" and len(clear) == 3 and len(defects) == 3 and "falls with" in row["reason"]:
            power = np.polyfit(np.log([d[0] for d in clear]), np.log([d[1] for d in clear]), 1)[0]
            if power < ORDERS[method] - 1.0:
                self.contradict(row, f"holds, the balance by independent runs falls with h^{power:.2f}")

    def stability(self, row, case, spec):
        truth, method = self.truth, row["method"]
        if row["part"] != "limit" or truth.stepper(method) is None or row["verdict"] != "holds":
            return
        limit = row["predicted_limit"]
        if limit == 0.0:
            if truth.growth(method, 0.1 / truth.model.fastest_rate()) <= 1.0 + 1e-13:
                self.contradict(row, "holds with the limit 0, but a small step is stable")
        elif np.isfinite(limit):
            below, above = truth.growth(method, 0.975 * limit), truth.growth(method, 1.025 * limit)
            least = 1e-11 if "too weak" in row["reason"] else 1e-7
            if below > 1.0 + 1e-6 or above < 1.0 + least:
                self.contradict(row, f"holds with the limit {limit:.4g} s, growth is {below:.8f} below and {above:.8f} above it")

    def stiffness(self, row, case, spec):
        truth, method = self.truth, row["method"]
        if "largest_eigenvalue" not in case or "stiffness_index" in case or not len(case["parameter"]):
            return
        largest = np.abs(np.linalg.eigvals(truth.jacobian())).max()
        # a defective eigenvalue 0 is the root of a rounding error
        if abs(largest - case["largest_eigenvalue"][0]) > 1e-5 * largest + 1e-5:
            self.contradict(row, f"largest eigenvalue {case['largest_eigenvalue'][0]:.6g}, by complex steps {largest:.6g}")
        if truth.stepper(method) is None or not np.isfinite(case["step"][0]) or not np.isfinite(case["error"][0]):
            return
        count = round(truth.end / case["step"][0])
        if count > 5000:
            return
        mine = truth.relative_error(truth.run(method, truth.end / count, count)[-1] - truth.state)
        if abs(mine - case["error"][0]) > 1e-3 * mine + 1e-6:
            self.contradict(row, f"error {case['error'][0]:.4e} at the step {case['step'][0]:.3g}, by independent runs {mine:.4e}")

    def jacobian(self, row, case, spec):
        truth, model = self.truth, self.truth.model
        if row["part"] != "definiteness" or "eigenvalue" not in case:
            return
        centre = model.position.mean(axis=0)
        moving = np.repeat(model.free[:, 0] > 0.0, 3)
        mass = np.repeat(model.mass, 3)[moving]
        for c, factor in enumerate(case["compression"]):
            x = centre + factor * (model.position - centre)
            J = truth.jacobian(x, np.zeros_like(x))
            n = len(mass)
            K, D = mass[:, None] * J[n:, :n], mass[:, None] * J[n:, n:]
            for k, h in enumerate(case["step"]):
                A = np.diag(mass) - h * D - h * h * K
                # a fixed particle keeps its mass on the diagonal of A
                mine = np.sort(np.append(np.linalg.eigvalsh(0.5 * (A + A.T)), np.repeat(model.mass, 3)[~moving]))
                if abs(mine[0] - case["eigenvalue"][c, k]) > 1e-8 * np.abs(mine).max():
                    self.contradict(row, f"smallest eigenvalue {case['eigenvalue'][c, k]:.6e} at {factor}, h = {h:.3g}; "
                                         f"by complex steps {mine[0]:.6e}")

    def linear_solver(self, row, case, spec):
        if row["verdict"] == "holds" and row["solver"] != "spectrum" and not row["residual"] <= 1e-7:
            self.contradict(row, f"holds with the residual {row['residual']:.1e}")
        if row["solver"] != "spectrum" or "eigenvalue" not in case:
            return
        truth, model = self.truth, self.truth.model
        matrix, moving = projected_step_matrix(model, row["step"])
        mine = np.linalg.eigvalsh(matrix[np.ix_(moving, moving)])
        found = case["eigenvalue"]
        if len(found) != len(mine):
            fixed = np.repeat(model.mass, 3)[~moving]
            mine = np.sort(np.concatenate((mine, fixed)))
        if len(found) != len(mine) or np.abs(found - mine).max() > 1e-9 * np.abs(mine).max():
            self.contradict(row, f"spectrum {found[0]:.6e}..{found[-1]:.6e}, written anew {mine[0]:.6e}..{mine[-1]:.6e}")

    def propagation(self, row, case, spec):
        truth, model, method = self.truth, self.truth.model, row["method"]
        if truth.stepper(method) is None or row["verdict"] != "holds":
            return
        mass = spec["propagation"]["mass"]
        y = model.start()
        y[1, mass, 0] = 1.0
        distance = np.full(model.count, -1)
        distance[mass] = 0
        for _ in range(model.count):
            for i, j in model.between:
                for a, b in ((i, j), (j, i)):
                    if distance[a] >= 0 and model.free[b] and (distance[b] < 0 or distance[b] > distance[a] + 1):
                        distance[b] = distance[a] + 1
        for n in range(1, len(case["time"])):
            y = truth.stepper(method)(model, y, row["step"])
            # small displacements are lost in positions, small velocities are not
            front = distance[np.abs(y[1]).max(axis=1) > 0.0].max(initial=-1)
            if front != case["front_velocity"][n]:
                self.contradict(row, f"holds, velocities are {front} springs away after {n} steps, found "
                                     f"{case['front_velocity'][n]}")
                return

    def dissipation(self, row, case, spec):
        method = row["method"]
        if row["verdict"] != "holds" or method not in ("rk4", "heun", "velocity_verlet"):
            return
        for z, damping, period in zip(case["frequency_step"], case["measured_damping_ratio"], case["measured_period_error"]):
            if np.isnan(damping) or z > 1.4:  # beyond, the two factors change places
                continue
            w = 1j * z
            factor = {"rk4": 1 + w + w**2 / 2 + w**3 / 6 + w**4 / 24, "heun": 1 + w + w**2 / 2,
                      "velocity_verlet": 1 - z * z / 2 + 1j * z * np.sqrt(max(0.0, 1 - z * z / 4))}[method]
            angle = np.angle(factor)
            if abs(-np.log(abs(factor)) / angle - damping) > 1e-7 or abs(z / angle - 1 - period) > 1e-7:
                self.contradict(row, f"holds, at z = {z:.4g} damping {damping:.6g} and period {period:.6g}, by formula "
                                     f"{-np.log(abs(factor)) / angle:.6g} and {z / angle - 1:.6g}")


def projected_step_matrix(model, h):
    """M - h D - h^2 K at the start, of every spring without the negative part of its tangent and the position term of its
    damper; which coordinates move."""
    size = 3 * model.count
    A = np.diag(np.repeat(model.mass, 3) + h * model.drag)
    for s, (i, j) in enumerate(model.between):
        d = model.position[j] - model.position[i]
        length = np.sqrt(d @ d)
        r = np.outer(d, d) / length**2
        k = model.effective_stiffness()[s]
        slack = model.law[s] == "tension_only" and length < model.rest_length[s]
        tension = 0.0 if slack else k * (length - model.rest_length[s])
        block = h * h * ((0.0 if slack else k) * r + max(0.0, tension / length) * (np.eye(3) - r)) + h * model.damping[s] * r
        for a, b, sign in ((i, i, 1), (j, j, 1), (i, j, -1), (j, i, -1)):
            A[3 * a:3 * a + 3, 3 * b:3 * b + 3] += sign * block
    for p, k, c in zip(model.anchored, model.anchor_stiffness, model.anchor_damping):
        A[3 * p:3 * p + 3, 3 * p:3 * p + 3] += (h * h * k + h * c) * np.eye(3)
    return A, np.repeat(model.free[:, 0] > 0.0, 3)
