"""What is true of a scene, without federwerk: solutions of the independent equations of motion with their own errors,
runs of the simple schemes written anew, spectra by complex steps."""

import numpy as np

import mass_spring_reference as reference
from mass_spring_reference import integrate
from verdict_scenes import model_of

STEPPERS = {"explicit_euler": reference.explicit_euler, "symplectic_euler": reference.symplectic_euler,
            "midpoint": reference.midpoint, "heun": reference.heun, "rk4": reference.rk4}
ORDERS = {"explicit_euler": 1, "symplectic_euler": 1, "midpoint": 2, "heun": 2, "rk4": 4, "velocity_verlet": 2}


class Linearised:
    """Spectra of a scene about its start."""

    def __init__(self, scene):
        self.model = model_of(scene)

    def stepper(self, method):
        return STEPPERS.get(method)

    def jacobian(self, x=None, v=None):
        """d(v, a)/d(x, v) of the moving coordinates by complex steps."""
        model = self.model
        x, v = model.position if x is None else x, model.start()[1] if v is None else v
        stiffness, damping = reference.force_jacobians(model, x, v)
        moving = np.repeat(model.free[:, 0] > 0.0, 3)
        mass = np.repeat(model.mass, 3)[moving]
        K, D = stiffness[np.ix_(moving, moving)], damping[np.ix_(moving, moving)]
        n = len(mass)
        return np.block([[np.zeros((n, n)), np.eye(n)], [K / mass[:, None], D / mass[:, None]]])

    def growth(self, method, step):
        """Spectral radius of a step of the scheme written anew on the linearised scene."""
        J = self.jacobian()
        n = len(J) // 2

        class Linear:
            free = 1.0
            @staticmethod
            def rate(y):
                return np.stack((y[1], J[n:, :n] @ y[0] + J[n:, n:] @ y[1]))
        start = np.eye(2 * n).reshape(2, n, 2 * n)
        end = self.stepper(method)(Linear, start, step).reshape(2 * n, 2 * n)
        return float(np.abs(np.linalg.eigvals(end)).max())

class Truth(Linearised):
    """The solution of a scene at its end, its error, and by how much it multiplies perturbations of the start."""

    def __init__(self, scene, end):
        super().__init__(scene)
        self.end = end
        model = self.model
        # damped solids make the force jump: the tolerance is what a halved step can still reach there
        tolerance = 1e-10 if model.solids else 1e-12
        longest = end / 200.0 if model.solids else np.inf
        times = np.linspace(0.0, end, 9)

        def solve(start, tolerance):
            return integrate(model.rate, start, times, tolerance, longest)
        states = solve(model.start(), tolerance)
        coarse = solve(model.start(), 30.0 * tolerance)
        self.state = states[-1]
        self.error = 10.0 * float(np.abs(states - coarse).max()) + 1e-14 * float(np.abs(states).max())
        size = np.maximum(np.ptp(states, axis=0).max(axis=(1, 2)), 1e-3)
        self.size = np.maximum(size, np.abs(states[:, 1]).max() * np.array([0.0, 1.0]))
        nudge = 1e-7 * size[:, None, None] * np.random.default_rng(5).normal(0, 1, self.state.shape) * model.free
        moved = solve(model.start() + nudge, 30.0 * tolerance)[-1]
        self.amplification = max(1.0, float(np.abs((moved - self.state) / size[:, None, None]).max()) / 1e-7)
        self.energy_size = max(model.kinetic_energy(y[1]) + model.elastic_energy(y[0])
                               + model.kinetic_energy(y[1] - states[0][1]) for y in states)
        self.largest_energy_change = max(abs(self.energy(y) - self.energy(states[0])) for y in states)
        self.crossed = [solid.depths(self.state[0])[0] > 0.0 for solid in model.solids]

    def energy(self, y):
        return self.model.kinetic_energy(y[1]) + self.model.potential_energy(y[0])

    def is_conservative(self):
        return not self.model.has_velocity_forces()

    def stepper(self, method):
        """The scheme written anew, or None."""
        if method == "velocity_verlet" and self.is_conservative():
            return reference.velocity_verlet
        return super().stepper(method)

    def run(self, method, step, count):
        """States of the scheme written anew, (count + 1, 2, n, 3); NaN behind an overflow."""
        stepper = self.stepper(method)
        states = [self.model.start()]
        with np.errstate(all="ignore"):
            for _ in range(count):
                states.append(stepper(self.model, states[-1], step))
        return np.array(states)

    def relative_error(self, difference):
        """As the attribute `norm` of error columns describes it."""
        start = self.model.start()
        def rms(values):
            return float(np.sqrt(np.mean(np.square(values))))
        def positive(value):
            return value if value > 0.0 else 1.0
        position = positive(max(rms(self.state[0] - start[0]), 1e-3 * rms(self.state[0])))
        velocity = positive(max(rms(self.state[1]), rms(start[1])))
        return np.sqrt(0.5 * ((rms(difference[0]) / position) ** 2 + (rms(difference[1]) / velocity) ** 2))

    def balance(self, states, step):
        """Energy at every step minus that at the start plus what was dissipated (Simpson's rule over pairs of steps)."""
        energy = np.array([self.energy(y) for y in states])
        power = np.array([self.model.dissipated_power(y[0], y[1]) for y in states])
        pairs = (power[:-2:2] + 4.0 * power[1:-1:2] + power[2::2]) * step / 3.0
        return energy[::2] - energy[0] + np.concatenate(([0.0], np.cumsum(pairs)))
