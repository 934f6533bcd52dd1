"""What a trajectory file holds, and whether it agrees with the equations of motion written anew."""

import h5py
import numpy as np

import mass_spring_reference as reference

AGREEMENT = 1e-7  # m, of every coordinate at every frame


class Trajectory:
    """What a result file holds, read once."""

    def __init__(self, path):
        with h5py.File(path, "r") as file:
            self.attributes = dict(file.attrs)
            self.datasets, self.units = {}, {}

            def read(name, item):
                if isinstance(item, h5py.Dataset):
                    self.datasets[name] = item[()]
                    self.units[name] = item.attrs.get("unit")
            file.visititems(read)
        self.time = self.datasets["trajectory/time"]
        self.position = self.datasets["trajectory/position"]
        self.velocity = self.datasets["trajectory/velocity"]


def largest_error(model, trajectory):
    """Largest difference of any coordinate at any frame from the reference solution of the model [m]."""
    # Kept for the next method on the same model and times.
    key = trajectory.time.tobytes()
    if key not in model.solutions:
        model.solutions[key] = reference.integrate(model.rate, model.start(), trajectory.time)[:, 0]
    return float(np.abs(model.solutions[key] - trajectory.position).max())


def require_agreement(model, trajectory, tolerance=AGREEMENT):
    error = largest_error(model, trajectory)
    if not error <= tolerance:
        raise AssertionError(f"positions are off by {error:.3g} m, allowed {tolerance:.3g} m")


def require_close(found, expected, scale, what, tolerance=1e-12):
    found, expected = np.asarray(found), np.asarray(expected)
    if found.shape != expected.shape:
        raise AssertionError(f"{what}: shape {found.shape}, expected {expected.shape}")
    difference = float(np.abs(found - expected).max(initial=0.0))
    if not difference <= tolerance * max(scale, 1.0):
        raise AssertionError(f"{what}: off by {difference:.3g} at a scale of {scale:.3g}")


def require_consistent_file(model, trajectory):
    """Shapes, conserved quantities, the system and fixed points as the description of result files has them."""
    data, frames = trajectory.datasets, len(trajectory.time)
    x, v = trajectory.position, trajectory.velocity
    if x.shape != (frames, model.count, 3) or v.shape != x.shape:
        raise AssertionError(f"position {x.shape}, velocity {v.shape}: expected ({frames}, {model.count}, 3)")
    start = model.start()
    if not (np.array_equal(x[0], start[0]) and np.array_equal(v[0], start[1])):
        raise AssertionError("frame 0 is not the initial state")
    if not np.array_equal(x[:, model.fixed], np.broadcast_to(start[0][model.fixed], x[:, model.fixed].shape)):
        raise AssertionError("a fixed point moved")
    if np.any(v[:, model.fixed] != 0.0):
        raise AssertionError("a fixed point has a velocity")
    reach, speed, mass = np.abs(x).max(), np.abs(v).max(), model.mass.sum()
    kinetic = np.array([model.kinetic_energy(u) for u in v])
    potential = np.array([model.potential_energy(p) for p in x])
    length = np.abs(model.rest_length).max(initial=0.0) + 2.0 * reach
    potential_scale = (model.effective_stiffness().sum() * length**2 + mass * np.abs(model.gravity).max() * reach)
    require_close(data["trajectory/kinetic_energy"], kinetic, mass * speed**2, "kinetic energy")
    require_close(data["trajectory/potential_energy"], potential, potential_scale, "potential energy")
    require_close(data["trajectory/linear_momentum"], [model.linear_momentum(u) for u in v], mass * speed,
                  "linear momentum")
    require_close(data["trajectory/angular_momentum"], [model.angular_momentum(p, u) for p, u in zip(x, v)],
                  mass * speed * reach, "angular momentum")
    require_close(data["system/mass"], model.mass, 0.0, "mass")
    if not np.array_equal(data["system/springs"], model.between):
        raise AssertionError("system/springs differs from between")
    for name in ("stiffness", "damping", "rest_length"):
        require_close(data[f"system/{name}"], getattr(model, name), 0.0, name, 1e-15 * 1e5 if name == "stiffness"
                      else 1e-14)
