"""Obstacles written anew from the scene-file contract: force max(k delta - c v.n, 0) n at the depth delta of a point."""

import numpy as np


class Solid:
    """One [[obstacle]]: plane, sphere or box."""

    def __init__(self, entry):
        self.shape, self.stiffness, self.damping = entry["shape"], float(entry["stiffness"]), float(entry.get("damping", 0))
        if self.shape == "plane":
            self.point = np.array(entry["point"], dtype=float)
            normal = np.array(entry["normal"], dtype=float)
            self.normal = normal / np.linalg.norm(normal)
        elif self.shape == "sphere":
            self.centre, self.radius = np.array(entry["centre"], dtype=float), float(entry["radius"])
        else:
            self.lower, self.upper = np.array(entry["lower"], dtype=float), np.array(entry["upper"], dtype=float)

    def depths(self, x):
        """Depth [m] of every point and the direction out of the solid; a depth <= 0 is minus a distance outside, for
        boxes that along the farthest axis."""
        if self.shape == "plane":
            return -((x - self.point) @ self.normal), np.broadcast_to(self.normal, x.shape)
        if self.shape == "sphere":
            offset = x - self.centre
            distance = np.sqrt((offset * offset).sum(axis=1))
            return self.radius - distance, offset / np.where(distance == 0.0, 1.0, distance)[:, None]
        inward = np.stack((x - self.lower, self.upper - x), axis=2)  # (n, 3, 2)
        nearest = inward.real.reshape(len(x), 6).argmin(axis=1)
        normal = np.zeros(x.shape)
        normal[np.arange(len(x)), nearest // 2] = np.where(nearest % 2 == 0, -1.0, 1.0)
        return inward.reshape(len(x), 6)[np.arange(len(x)), nearest], normal

    def force(self, x, v):
        depth, normal = self.depths(x)
        pressing = self.stiffness * depth - self.damping * (v * normal).sum(axis=1)
        pressing = np.where((depth.real > 0.0) & (pressing.real > 0.0), pressing, 0.0)
        return pressing[:, None] * normal

    def energy(self, x):
        depth = np.maximum(self.depths(x)[0], 0.0)
        return 0.5 * self.stiffness * float((depth * depth).sum())
