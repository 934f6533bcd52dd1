"""Random scenes for verdicts, mild to violent: what random_scenes.py makes, thrown at walls, squeezed, stiffened, shifted
from the origin, tied to anchors, made of generators, or left without a force at all."""

import numpy as np

import random_scenes
from mass_spring_reference import MassSpringModel

LAWS = ("hooke", "strain", "tension_only")
CHARACTERS = ("mild", "damped", "rope", "stiff", "violent", "free flight", "wall", "anchored", "far", "generated")


def small_network(rng, law, **options):
    """A random scene of at most seven particles, so that references stay cheap."""
    while True:
        scene = random_scenes.random_scene(rng, law, **options)
        if len(scene["particles"]["position"]) <= 7:
            return scene


def thrown_at_solid(rng):
    """Points on their way to a plane, sphere or box of 2 mm to 0.4 m; some tied to each other."""
    count = int(rng.integers(1, 4))
    speed = float(10.0 ** rng.uniform(-0.3, 1.3))
    mass = float(rng.uniform(0.1, 2.0))
    scene = {"particles": {"position": [[0.0, 0.7 * i, 0.0] for i in range(count)],
                           "velocity": [[speed, 0.0, 0.0]] * count, "mass": mass}}
    if rng.random() < 0.4:
        scene = {"world": {"gravity": [0.0, 0.0, -9.81]}, **scene}
    if count > 1:
        scene["springs"] = {"between": [[i, i + 1] for i in range(count - 1)],
                            "stiffness": float(10.0 ** rng.uniform(1, 3)), "rest_length": 0.7}
    stiffness = float(10.0 ** rng.uniform(3.0, 7.0))
    distance = speed * float(rng.uniform(0.05, 0.2))
    shape = ("plane", "sphere", "box")[int(rng.integers(3))]
    thickness = float(10.0 ** rng.uniform(-2.7, -0.4))
    solid = {"shape": shape, "stiffness": stiffness}
    if rng.random() < 0.3:
        solid["damping"] = float(0.2 * np.sqrt(stiffness * mass))
    if shape == "plane":
        solid |= {"point": [distance, 0.0, 0.0], "normal": [-1.0, 0.0, 0.0]}
    elif shape == "sphere":
        solid |= {"centre": [distance + 0.5, 0.01, 0.02], "radius": 0.5}
    else:
        # thick enough to stop the point before its middle, from where the far face would push it out
        depth = speed * np.sqrt(mass / stiffness)
        solid |= {"lower": [distance, -9.0, -9.0], "upper": [distance + max(thickness, 4.0 * depth), 9.0, 9.0]}
    scene["obstacle"] = [solid]
    return scene, 2.0 * distance / speed


def random_generated(rng):
    kind = ("chain", "cloth")[int(rng.integers(2))]
    generate = {"kind": kind, "stiffness": float(10.0 ** rng.uniform(1, 4)), "mass": float(rng.uniform(0.05, 0.5)),
                "spacing": float(rng.uniform(0.1, 0.5)), "rest_length_factor": float(rng.uniform(0.8, 1.1)),
                "law": LAWS[int(rng.integers(2))]}
    if rng.random() < 0.4:
        generate["damping"] = float(rng.uniform(0.01, 0.5))
    if kind == "chain":
        generate |= {"count": int(rng.integers(3, 7)), "pinned": ["start", "ends"][int(rng.integers(2))]}
    else:
        generate |= {"counts": [3, 2], "pinned": ["top_left", "top_right"]}
    return {"world": {"gravity": [0.3, 0.2, -9.81]}, "generate": generate}


def random_case(seed, index):
    """(character, scene, end time [s]) of one scene; the end time is some tens of the shortest time scale."""
    rng = np.random.default_rng([seed, 77, index])
    character, law = CHARACTERS[index % len(CHARACTERS)], LAWS[(index // len(CHARACTERS)) % 2]
    end = float(rng.uniform(0.2, 0.6))
    if character == "wall":
        scene, end = thrown_at_solid(rng)
    elif character == "generated":
        scene = random_generated(rng)
        end = float(rng.uniform(5.0, 40.0)) / model_of(scene).fastest_rate()
        return character, scene, float(f"{end:.4g}")
    elif character == "free flight":
        scene = small_network(rng, law, free_flight=True, damped=False)
        end = float(rng.uniform(0.5, 2.0))
    else:
        damped = True if character == "damped" else None if character in ("stiff", "anchored", "rope") else False
        scene = small_network(rng, "tension_only" if character == "rope" else law, stiff=character == "stiff",
                              damped=damped)
    particles = scene["particles"]
    points = np.array(particles["position"], dtype=float)
    fixed = particles.get("fixed", [])
    if character == "violent":
        velocity = rng.normal(0.0, 10.0 ** rng.uniform(0.5, 1.5), points.shape)
        velocity[fixed] = 0.0
        particles["velocity"] = velocity.tolist()
        between = np.array(scene["springs"]["between"])
        length = np.linalg.norm(points[between[:, 1]] - points[between[:, 0]], axis=1)
        scene["springs"]["rest_length"] = (length * rng.uniform(0.3, 2.5, len(length))).tolist()
        scene["springs"]["stiffness"] = float(10.0 ** rng.uniform(1, 4))
    if character == "anchored":
        scene["anchor"] = [{"particle": int(rng.integers(len(points))), "stiffness": float(10.0 ** rng.uniform(0, 3)),
                            "damping": float(rng.uniform(0, 1)) if rng.random() < 0.4 else 0.0,
                            "position": rng.uniform(-1, 1, 3).tolist()}]
    if character == "far":
        particles["position"] = (points + 10.0 ** rng.uniform(0, 4) * rng.normal(0, 1, 3)).tolist()
    if character not in ("wall", "free flight"):
        end = min(float(rng.uniform(5.0, 40.0)) / model_of(scene).fastest_rate(), 2.0)
    return character, scene, float(f"{end:.4g}")


def generated_as_particles(generate):
    """The points, masses, pinned points and springs of a [generate] section, from its public description."""
    spacing, k = generate["spacing"], generate["stiffness"]
    if generate["kind"] == "chain":
        n = generate["count"]
        points = [[spacing * i, 0.0, 0.0] for i in range(n)]
        pairs = [[i, i + 1] for i in range(n - 1)]
        fixed = [0] if generate["pinned"] == "start" else [0, n - 1]
    else:
        nx, ny = generate["counts"]
        number = {(i, j): i + nx * j for j in range(ny) for i in range(nx)}
        points = [[spacing * i, spacing * j, 0.0] for j in range(ny) for i in range(nx)]
        offsets = [(1, 0), (0, 1), (1, 1), (-1, 1), (2, 0), (0, 2)]
        pairs = [[a, number[(i + p, j + q)]] for (i, j), a in number.items() for p, q in offsets
                 if (i + p, j + q) in number]
        fixed = [number[(0, ny - 1)], number[(nx - 1, ny - 1)]]
    x = np.array(points)
    ends = np.array(pairs)
    length = np.linalg.norm(x[ends[:, 1]] - x[ends[:, 0]], axis=1) * generate["rest_length_factor"]
    return {"particles": {"position": points, "mass": generate["mass"], "fixed": fixed},
            "springs": {"between": pairs, "stiffness": k, "damping": generate.get("damping", 0.0),
                        "rest_length": length.tolist(), "law": generate["law"]}}


def model_of(scene):
    """The independent equations of motion of a scene."""
    if "generate" in scene:
        scene = {**{key: value for key, value in scene.items() if key != "generate"},
                 **generated_as_particles(scene["generate"])}
    return MassSpringModel(random_scenes.toml_text(scene))
