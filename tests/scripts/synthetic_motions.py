"""Made-up result files of motions and of what follows them in time, as docs/results_schema.md describes them."""

import h5py
import numpy


def put(group, name, values, unit="1"):
    values = list(values) if isinstance(values, (list, tuple)) else values
    if isinstance(values, list) and values and isinstance(values[0], str):
        values = numpy.array(values, dtype=h5py.string_dtype("utf-8"))
    dataset = group.create_dataset(name, data=values)
    dataset.attrs["unit"] = unit
    return dataset


def new_file(path, kind, title):
    file = h5py.File(path, "w")
    for name, value in {"format": "federwerk", "format_version": 1, "kind": kind, "title": title,
                        "created": "2026-01-31T12:34:56Z", "git_commit": "0123456789" * 4, "git_dirty": True,
                        "status": "complete"}.items():
        file.attrs[name] = value
    return file


def trajectory(path, particles=4, status="success", frames=400):
    """A free chain that swings and turns; its momenta are constant to rounding."""
    time = numpy.linspace(0, 10, frames)
    random = numpy.random.default_rng(20111208)
    row = numpy.arange(particles)
    position = numpy.zeros((frames, particles, 3))
    velocity = numpy.zeros_like(position)
    centre = row - row.mean()
    for i in row:
        phase = 0.5 * time
        stretch = 1 + 0.15 * numpy.sin(3 * time + 0)
        position[:, i, 0] = centre[i] * stretch * numpy.cos(phase) + 0.05 * time
        position[:, i, 2] = centre[i] * stretch * numpy.sin(phase)
        velocity[:, i] = numpy.gradient(position[:, i], time, axis=0)
    with new_file(path, "trajectory", "A free chain of springs") as file:
        group = file.create_group("trajectory")
        put(group, "time", time, "s")
        put(group, "position", position, "m")
        put(group, "velocity", velocity, "m/s")
        kinetic = 2 + numpy.cos(6 * time)
        put(group, "kinetic_energy", kinetic, "J")
        put(group, "potential_energy", 3 - kinetic + 0.01 * time, "J")
        put(group, "linear_momentum", 1e-14 * random.standard_normal((frames, 3)) + [0.2, 0, 0], "kg*m/s")
        put(group, "angular_momentum", 1e-13 * random.standard_normal((frames, 3)) + [0, -2.5, 0], "kg*m^2/s")
        file.attrs["solver_status"] = status
        system = file.create_group("system")
        put(system, "mass", numpy.ones(particles), "kg")
        put(system, "springs", numpy.stack([row[:-1], row[1:]], axis=1).astype(numpy.int64))


def simulate(path, title, problem, rhs, start, exact, steps, end, field_axes, methods=("explicit_euler",)):
    """Explicit or implicit Euler's solutions of a linear equation, the exact one and the vector field."""
    size = len(start)
    with new_file(path, "simulate", title) as file:
        rows = []
        for method in methods:
            matrix = numpy.stack([rhs(0.0, unit) for unit in numpy.eye(size)], axis=1)
            for number, step in enumerate(steps):
                count = int(end / step + 1e-9)
                growth = numpy.eye(size) + step * matrix if method == "explicit_euler" else \
                    numpy.linalg.inv(numpy.eye(size) - step * matrix)
                states = [numpy.array(start, dtype=float)]
                for _ in range(count):
                    states.append(growth @ states[-1])
                case = file.create_group(f"cases/{problem}-{method}-{number}")
                case.attrs["problem"], case.attrs["method"], case.attrs["step"] = problem, method, step
                put(case, "time", step * numpy.arange(count + 1), "s")
                put(case, "state", numpy.array(states))
                fine = numpy.linspace(0, end, 400)
                put(case, "exact_time", fine, "s")
                put(case, "exact_state", exact(fine))
                rows.append((problem, method, step, end, "success", "not applicable", ""))
        field = file.create_group("cases/vector_field")
        grid = [axis.ravel() for axis in numpy.meshgrid(*field_axes, indexing="ij")]
        times = grid[0] if size == 1 else numpy.zeros_like(grid[0])
        states = numpy.stack(grid[1:] if size == 1 else grid, axis=1)
        put(field, "field_t", times, "s")
        put(field, "field_y", states)
        put(field, "field_dydt", numpy.array([rhs(t, y) for t, y in zip(times, states)]))
        summary = file.create_group("summary")
        for name, column in zip(("problem", "method", "step", "end_time", "status", "verdict", "reason"), zip(*rows)):
            put(summary, name, list(column))


def slope_field(path):
    simulate(path, "ẋ = −x with explicit and implicit Euler", "decay", lambda t, y: -y, [1.0],
             lambda t: numpy.exp(-t)[:, None], [0.5, 1.0, 1.5, 2.0, 2.2], 8.0,
             [numpy.linspace(0, 8, 25), numpy.linspace(-1.5, 1.5, 17)], ("explicit_euler", "implicit_euler"))


def spiral(path):
    simulate(path, "ẋ = (−x₂, x₁): circles become spirals", "circle", lambda t, y: numpy.array([-y[1], y[0]]),
             [1.0, 0.0], lambda t: numpy.stack([numpy.cos(t), numpy.sin(t)], axis=1), [0.5, 0.2, 0.1, 0.02],
             4 * numpy.pi, [numpy.linspace(-3, 3, 19)] * 2)


def vector_field(path):
    """A field that turns with time, at three times."""
    simulate(path, "A field that changes with time", "turning", lambda t, y: numpy.array([-y[1], y[0]]),
             [1.0, 0.0], lambda t: numpy.stack([numpy.cos(t), numpy.sin(t)], axis=1), [0.1], 4.0,
             [numpy.linspace(-2, 2, 9)] * 2)
    with h5py.File(path, "r+") as file:
        field = file["cases/vector_field"]
        arrays = {name: field[name][()] for name in ("field_t", "field_y", "field_dydt")}
        for name, array in arrays.items():
            del field[name]
            put(field, name, numpy.concatenate([array + t * (name == "field_t") for t in (0.0, 2.0, 4.0)]))


def oscillation(path):
    """A mass on a spring: position and velocity, exploding at the larger step."""
    simulate(path, "A single spring", "spring", lambda t, y: numpy.array([y[1], -y[0]]), [1.0, 0.0],
             lambda t: numpy.stack([numpy.cos(t), -numpy.sin(t)], axis=1), [0.5, 0.05], 12.0,
             [numpy.linspace(-3, 3, 9)] * 2)
    with h5py.File(path, "r+") as file:
        del file["cases/vector_field"]
        for case in file["cases"].values():
            put(case, "second_order", [1])


def simulated_energy(path):
    """The same mass on a spring with the energies of its runs: one of them explodes."""
    oscillation(path)
    with h5py.File(path, "r+") as file:
        for case in file["cases"].values():
            state = case["state"][()]
            kinetic, potential = 0.5 * state[:, 1] ** 2, 0.5 * state[:, 0] ** 2
            for name, values in (("kinetic", kinetic), ("potential", potential), ("total", kinetic + potential)):
                put(case, f"{name}_energy", values, "J")
        names = list(file["cases"])
        summary = file.require_group("summary")
        if "case" not in summary:
            put(summary, "case", names, "")
        put(summary, "seconds", [0.25] * len(summary["case"]), "s")


def construction(path):
    """Two steps of each Euler scheme on x' = -x."""
    slope_field(path)
    with h5py.File(path, "r+") as file:
        for name, case in file["cases"].items():
            if name == "vector_field":
                continue
            time, state = case["time"][:3], case["state"][:3, 0]
            put(case, "construction_start_time", time[:-1], "s")
            put(case, "construction_end_time", time[1:], "s")
            put(case, "construction_start", state[:-1])
            put(case, "construction_end", state[1:])
            put(case, "construction_slope", numpy.diff(state) / numpy.diff(time), "SI/s")
            put(case, "construction_start_slope", -state[:-1], "SI/s")
            put(case, "construction_end_slope", -state[1:], "SI/s")
            times = numpy.linspace(time[:-1], time[1:], 9, axis=-1)[:, None, :] * numpy.ones((1, 2, 1))
            through = numpy.stack([time[:-1], time[1:]], axis=1)
            values = numpy.stack([state[:-1], state[1:]], axis=1)
            put(case, "construction_flow_time", times, "s")
            put(case, "construction_flow", values[:, :, None] * numpy.exp(through[:, :, None] - times))


def energy(path):
    """A single spring: one scheme that explodes, one with a modified energy."""
    step, bins = numpy.array([0.2, 0.1]), 50
    rows = []
    with new_file(path, "energy", "Energy") as file:
        for method, rate in (("explicit_euler", 2.0), ("velocity_verlet", 0.0)):
            case = file.create_group(f"cases/spring-{method}")
            time = numpy.linspace(0, 100, bins)[None, :] * numpy.ones((2, 1))
            growth = numpy.expm1(0.5 * rate * step[:, None] ** 2 * time)
            put(case, "step", step, "s")
            put(case, "energy_start", [2.0, 2.0], "J").attrs["quantity"] = "energy"
            put(case, "energy_scale", [2.5, 2.5], "J")
            put(case, "end_time", [100.0, 100.0], "s")
            put(case, "drift", rate * step, "J/s")
            put(case, "drift_low", 0.9 * rate * step - 1e-9, "J/s")
            put(case, "drift_high", 1.1 * rate * step + 1e-9, "J/s")
            put(case, "oscillation", 0.1 * step ** 2, "J")
            put(case, "growth", 0.5 * rate * step ** 2)
            put(case, "predicted_growth", 0.5 * rate * step ** 2)
            put(case, "bin_time", time, "s")
            for name, shift in (("least", -0.01), ("mean", 0.0), ("largest", 0.01)):
                put(case, f"change_{name}", 2 * growth + shift, "J")
            if rate == 0.0:
                put(case, "modified_least", -1e-16 * numpy.sqrt(1 + time), "J")
                put(case, "modified_largest", 2e-16 * numpy.sqrt(1 + time), "J")
            rows.append((f"spring-{method}", "spring", method, 0.2, "holds"))
        summary = file.create_group("summary")
        for name, column in zip(("case", "problem", "method", "step", "verdict"), zip(*rows)):
            put(summary, name, list(column))


def dissipation(path):
    """A scheme that damps, one that only has a wrong period."""
    z = numpy.geomspace(0.05, 5, 25)
    rows = []
    with new_file(path, "dissipation", "Damping") as file:
        for method, damping in (("implicit_euler", 0.5 * z), ("trapezoidal", 0 * z)):
            case = file.create_group(f"cases/{method}")
            put(case, "frequency_step", z)
            for name, values in (("damping_ratio", damping), ("period_error", z ** 2 / 12),
                                 ("spectral_radius", numpy.exp(-damping * z))):
                put(case, name, values)
                put(case, {"spectral_radius": "measured_radius"}.get(name, f"measured_{name}"), values)
            time = numpy.linspace(0, 10, 101)
            put(case, "motion_time", time, "s")
            put(case, "motion_position", numpy.cos(time) * numpy.exp(-0.1 * time), "m")
            put(case, "motion_exact", numpy.cos(time), "m")
            rows.append((method, method, 20.0, damping[5], 0.01, "holds"))
        summary = file.create_group("summary")
        for name, column in zip(("case", "method", "steps_per_period", "damping_ratio", "period_error", "verdict"),
                                zip(*rows)):
            put(summary, name, list(column))


def propagation(path):
    """A front of one spring per step, and one that is everywhere at once; two steps."""
    masses, steps = 21, 12
    distance = numpy.abs(numpy.arange(masses) - 10)
    rows = []
    with new_file(path, "propagation", "Propagation") as file:
        for h in (0.1, 0.2):
            for method, speed in (("velocity_verlet", 1), ("implicit_euler", 10)):
                case = file.create_group(f"cases/chain-{method}-h{h}")
                reach = numpy.minimum(speed * numpy.arange(steps + 1), 10)
                put(case, "time", h * numpy.arange(steps + 1), "s")
                put(case, "distance", distance)
                put(case, "displacement", numpy.where(distance[None, :] <= reach[:, None], 0.1 ** distance, 0.0), "m")
                put(case, "front_velocity", reach)
                put(case, "front_wave", 5 * h * numpy.arange(steps + 1))
                rows.append((f"chain-{method}-h{h}", "chain", method, h, 10, float(speed), speed, 5 * h, 5.0, 5.0, "holds"))
        summary = file.create_group("summary")
        names = ("case", "problem", "method", "step", "farthest", "springs_per_step", "first_step_velocity", "wave_springs_per_step",
                 "wave_speed", "physical_wave_speed", "verdict")
        for name, column in zip(names, zip(*rows)):
            put(summary, name, list(column))
