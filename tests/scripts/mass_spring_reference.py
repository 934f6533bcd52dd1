"""Mass-spring systems written anew from the scene-file contract, and an extrapolation integrator for references.

Nothing here is shared with the C++ sources: the force laws come from [Zachmann 2011, S5-S9], the meaning of the keys
from the public description of the scene file. It exists to disagree with federwerk if either of the two is wrong.
"""

import tomllib

import numpy as np

from solid_reference import Solid


def per_item(value, count):
    """One number for all, or a list with one number per item."""
    return np.broadcast_to(np.asarray(value, dtype=float), (count,)).copy()


def solid_force(solid, x, v):
    """What a solid does to points, of one state (n, 3) or of several (n, 3, b)."""
    if x.ndim == 2:
        return solid.force(x, v)
    return np.stack([solid.force(x[..., k], v[..., k]) for k in range(x.shape[2])], axis=2)


class MassSpringModel:
    """The equations of motion of one scene file: m v' = gravity + drag + springs + dampers + anchors + obstacles, fixed
    points at rest."""

    def __init__(self, toml_text):
        scene = tomllib.loads(toml_text)
        world, particles, springs = scene.get("world", {}), scene["particles"], scene.get("springs", [])
        self.position = np.array(particles["position"], dtype=float)
        self.count = len(self.position)
        self.velocity = np.array(particles.get("velocity", np.zeros_like(self.position)), dtype=float)
        self.mass = per_item(particles["mass"], self.count)
        self.fixed = np.array(particles.get("fixed", []), dtype=int)
        self.gravity = np.array(world.get("gravity", [0, 0, 0]), dtype=float)
        self.drag = float(world.get("drag", 0.0))
        # one table [springs], or [[springs]]: groups one after the other, each with a law of its own
        groups = springs if isinstance(springs, list) else [springs]
        columns = [self.spring_columns(group) for group in groups]
        self.between = np.concatenate([column[0] for column in columns] or [np.zeros((0, 2), dtype=int)])
        self.law, self.stiffness, self.damping, self.rest_length = (
            np.concatenate([column[k] for column in columns] or [np.zeros(0)]) for k in range(1, 5))
        self.law = self.law.astype(object)  # also without a spring
        number = len(self.between)
        # incidence[i, s] = +1 where spring s starts at i, -1 where it ends: adds f to i and -f to j (S6).
        self.incidence = np.zeros((self.count, number))
        self.incidence[self.between[:, 0], np.arange(number)] += 1.0
        self.incidence[self.between[:, 1], np.arange(number)] -= 1.0
        self.free = np.ones((self.count, 1))
        self.free[self.fixed] = 0.0
        self.solids = [Solid(entry) for entry in scene.get("obstacle", [])]
        ties = [(p, entry) for entry in scene.get("anchor", []) for p in np.atleast_1d(entry["particle"])]
        self.anchored = np.array([p for p, _ in ties], dtype=int)
        self.anchor_stiffness = np.array([entry["stiffness"] for _, entry in ties], dtype=float)
        self.anchor_damping = np.array([entry.get("damping", 0.0) for _, entry in ties], dtype=float)
        self.anchor_position = np.array([entry.get("position", self.position[p]) for p, entry in ties],
                                        dtype=float).reshape(-1, 3)
        self.solutions = {}

    def spring_columns(self, group):
        """Ends, law, stiffness, damping and rest length of the springs of one group."""
        between = np.array(group["between"], dtype=int).reshape(-1, 2)
        number = len(between)
        start = self.position[between[:, 1]] - self.position[between[:, 0]]
        start_length = np.sqrt((start * start).sum(axis=1))
        return (between, np.full(number, group.get("law", "hooke"), dtype=object),
                per_item(group["stiffness"], number), per_item(group.get("damping", 0.0), number),
                per_item(group.get("rest_length", start_length), number))

    def effective_stiffness(self):
        """N/m for every law: the strain law's constant is in newtons (S7)."""
        return self.stiffness / np.where(self.law == "strain", self.rest_length, 1.0)

    def force(self, x, v):
        """Total force on each point [N], zero on fixed ones; complex arguments give complex-step derivatives. Shape
        (n, 3), or (n, 3, b) for b states at once."""
        per_item = x.size // len(x)
        ones = (1,) * (x.ndim - 2)

        def along(matrix, vectors):
            return (matrix @ vectors.reshape(-1, per_item)).reshape(-1, *x.shape[1:])

        def column(numbers):
            return numbers.reshape(len(numbers), 1, *ones)

        d = along(-self.incidence.T, x)
        w = along(-self.incidence.T, v)
        length = np.sqrt((d * d).sum(axis=1, keepdims=True))
        r = d / length
        elongation = length - column(self.rest_length)
        slack = column(self.law == "tension_only") & (elongation.real < 0.0)  # the tangent is zero only below l0
        elongation = np.where(slack, 0.0, elongation)
        tension = (column(self.effective_stiffness()) * elongation
                   + column(self.damping) * (w * r).sum(axis=1, keepdims=True))
        total = along(self.incidence, tension * r)
        total += column(self.mass) * self.gravity.reshape(1, 3, *ones) - self.drag * v
        if len(self.anchored) > 0:
            pull = (column(self.anchor_stiffness) * (x[self.anchored] - self.anchor_position.reshape(-1, 3, *ones))
                    + column(self.anchor_damping) * v[self.anchored])
            np.subtract.at(total, self.anchored, pull)
        for solid in self.solids:
            total = total + solid_force(solid, x, v)
        return total * column(self.free)

    def rate(self, y):
        """y = (x, v) of shape (2, n, 3), or (2, n, 3, b) for b states at once; y' = (v, f/m), zero for fixed points."""
        ones = (1,) * (y.ndim - 3)
        slope = np.empty(y.shape)
        np.multiply(y[1], self.free.reshape(-1, 1, *ones), out=slope[0])
        np.divide(self.force(y[0], y[1]), self.mass.reshape(-1, 1, *ones), out=slope[1])
        return slope

    def start(self):
        return np.stack((self.position, self.velocity * self.free))

    def fastest_rate(self):
        """A bound [1/s] of the eigenvalues' size at the rest lengths: springs by Gershgorin, dampers and drag alike."""
        stiffness = np.abs(self.incidence) @ self.effective_stiffness()
        damping = np.abs(self.incidence) @ self.damping
        np.add.at(stiffness, self.anchored, self.anchor_stiffness)
        np.add.at(damping, self.anchored, self.anchor_damping)
        return float(np.sqrt(2.0 * (stiffness / self.mass).max()) + (2.0 * damping / self.mass).max()
                     + (self.drag / self.mass).max())

    def kinetic_energy(self, v):
        return 0.5 * float((self.mass[:, None] * v * v).sum())

    def potential_energy(self, x):
        """Gravity, zero at the origin, and `elastic_energy`."""
        return self.elastic_energy(x) - float((self.mass[:, None] * x * self.gravity).sum())

    def dissipated_power(self, x, v):
        """What dampers, drag and damped obstacles take: all forces that velocities add, times the velocity."""
        return float(((self.force(x, np.zeros_like(v)) - self.force(x, v)) * v).sum())

    def has_velocity_forces(self):
        return bool(self.damping.any() or self.anchor_damping.any() or self.drag > 0.0
                    or any(solid.damping > 0.0 for solid in self.solids))

    def elastic_energy(self, x):
        """Springs (half k elongation^2, only stretched ones for tension_only), anchors and obstacles."""
        length = np.sqrt(((self.incidence.T @ x) ** 2).sum(axis=1))
        elongation = length - self.rest_length
        elongation = np.where((self.law == "tension_only") & (elongation < 0.0), 0.0, elongation)
        elastic = 0.5 * float((self.effective_stiffness() * elongation**2).sum())
        offset = x[self.anchored] - self.anchor_position
        elastic += 0.5 * float((self.anchor_stiffness[:, None] * offset**2).sum())
        moving = self.free[:, 0] > 0.0
        return elastic + sum(solid.energy(x[moving]) for solid in self.solids)

    def linear_momentum(self, v):
        return (self.mass[:, None] * v).sum(axis=0)

    def angular_momentum(self, x, v):
        return (self.mass[:, None] * np.cross(x, v)).sum(axis=0)


COLUMNS = 8  # order 16
SUBSTEPS = [2 * (k + 1) for k in range(COLUMNS)]


def extrapolation_step(rate, y, step):
    """Gragg's modified midpoint rule extrapolated in h^2 [Hairer, Norsett, Wanner 1993, II.9]; result, error. The
    columns advance side by side, in one call of the rate per substep."""
    h = step / np.array(SUBSTEPS)
    before = np.broadcast_to(y[..., None], (*y.shape, COLUMNS))
    now = before + h * rate(y)[..., None]
    ends = []
    for done in range(1, SUBSTEPS[-1] + 1):
        slope = h * rate(now)
        if done == SUBSTEPS[len(ends)]:  # the first column is at its end
            ends.append(0.5 * (now + before + slope)[..., 0])
            before, now, slope, h = before[..., 1:], now[..., 1:], slope[..., 1:], h[1:]
        before, now = now, before + 2.0 * slope
    row = []
    for number, end in zip(SUBSTEPS, ends):
        row_before, row = row, [end]
        for k, entry in enumerate(row_before):
            divisor = (number / SUBSTEPS[len(row_before) - 1 - k]) ** 2 - 1.0
            row.append(row[k] + (row[k] - entry) / divisor)
    return row[-1], row[-1] - row[-2]


def integrate(rate, y0, times, tolerance=1e-13, longest=np.inf):
    """States at the given times (the first is the start); `rate` takes several states at once, in a last axis of their
    own. The tolerance is relative to the largest entry of x and of v so far, at least 1 each; a step over a kink of the
    force is halved until its error is as small as any other. No step is longer than `longest`, so that none passes over
    a solid unseen."""
    states, y, t = [y0], y0, float(times[0])
    scale = np.maximum(1.0, np.abs(y0).max(axis=(1, 2)))
    step = min(1e-3 * (times[-1] - times[0]), longest)
    for target in times[1:]:
        while t < target:
            # a remainder close to the step is taken whole, so that no sliver is left before a frame
            last = target - t <= 1.01 * step
            trial = target - t if last else step
            result, difference = extrapolation_step(rate, y, trial)
            error = float((np.abs(difference).max(axis=(1, 2)) / scale).max()) / tolerance
            if not np.isfinite(error):
                step = trial / 4.0
                continue
            factor = min(3.0, max(0.2, 0.8 * max(error, 1e-30) ** (-1.0 / (2 * COLUMNS - 1))))
            if error > 1.0:
                factor = min(factor, 0.5)
                if trial < 1e-12 * max(1.0, abs(t)):
                    raise ArithmeticError(f"the reference cannot pass t = {t}")
                step = trial * factor
                continue
            t, y = (float(target) if last else t + trial), result
            scale = np.maximum(scale, np.abs(y).max(axis=(1, 2)))
            step = min(max(step, trial * factor) if last else trial * factor, longest)
        states.append(y)
    return np.array(states)


# The schemes of the lecture, one step each, to compare with federwerk step by step, not only in the limit.

def explicit_euler(model, y, h):
    return y + h * model.rate(y)


def symplectic_euler(model, y, h):
    v = y[1] + h * model.rate(y)[1]
    return np.stack((y[0] + h * v * model.free, v))


def midpoint(model, y, h):
    return y + h * model.rate(y + 0.5 * h * model.rate(y))


def heun(model, y, h):
    slope = model.rate(y)
    return y + 0.5 * h * (slope + model.rate(y + h * slope))


def rk4(model, y, h):
    k1 = model.rate(y)
    k2 = model.rate(y + 0.5 * h * k1)
    k3 = model.rate(y + 0.5 * h * k2)
    k4 = model.rate(y + h * k3)
    return y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)


def velocity_verlet(model, y, h):
    """Only for forces that do not depend on velocity; its positions are those of the two-step form (S17-S18)."""
    half = y[1] + 0.5 * h * model.rate(y)[1]
    x = y[0] + h * half
    return np.stack((x, half + 0.5 * h * model.rate(np.stack((x, half)))[1]))


def force_jacobians(model, x, v):
    """K = df/dx and D = df/dv by complex steps, so that no formula for a tangent is trusted."""
    size, tiny = 3 * model.count, 1e-30
    nudges = 1j * tiny * np.eye(size).reshape(*x.shape, size)  # a state per coordinate
    x, v = (np.repeat(part[..., None], size, axis=-1) for part in (x, v))
    stiffness = model.force(x + nudges, v + 0j).imag.reshape(size, size) / tiny
    damping = model.force(x + 0j, v + nudges).imag.reshape(size, size) / tiny
    return stiffness, damping


def implicit_euler(model, y, h):
    """Newton's method on m (v' - v) = h f(x + h v', v'), to rounding."""
    x, v = y
    new = v.copy()
    mass = np.repeat(model.mass, 3)
    for _ in range(12):
        stiffness, damping = force_jacobians(model, x + h * new, new)
        residual = mass * (new - v).ravel() - h * model.force(x + h * new, new).ravel()
        matrix = np.diag(mass) - h * damping - h * h * stiffness
        correction = -np.linalg.solve(matrix, residual).reshape(v.shape) * model.free
        new = new + correction
        if np.abs(correction).max() <= 1e-15 * max(1.0, np.abs(new).max()):
            break
    return np.stack((x + h * new, new))


def implicit_euler_linearised(model, y, h):
    """One solve A (v' - v) = h (f + h K v), A = M - h D - h^2 K: S25-S26 with dampers. A damper's position derivative
    is not symmetric; A is replaced by its symmetric part, as federwerk says it does for conjugate gradients.
    Without dampers A is symmetric and this is the lecture's formula."""
    x, v = y
    stiffness, damping = force_jacobians(model, x, v)
    matrix = np.diag(np.repeat(model.mass, 3)) - h * damping - h * h * stiffness
    matrix = 0.5 * (matrix + matrix.T)
    right = h * (model.force(x, v).ravel() + h * (stiffness @ v.ravel()))
    moving = np.repeat(model.free.ravel() > 0.0, 3)
    increment = np.zeros(right.shape)
    increment[moving] = np.linalg.solve(matrix[np.ix_(moving, moving)], right[moving])
    new = v + increment.reshape(v.shape)
    return np.stack((x + h * new, new))


def steps(scheme, model, h, number):
    states = [model.start()]
    for _ in range(number):
        states.append(scheme(model, states[-1], h))
    return np.array(states)
