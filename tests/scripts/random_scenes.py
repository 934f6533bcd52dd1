"""Random scene files in the public TOML form, from a named seed: every optional key present or not, one number or
a list, integers or floats."""

import json

import numpy as np


def number(rng, low, high, integer=None):
    """A number as TOML may hold it: an integer or a float with few or all digits."""
    form = rng.integers(3) if integer is None else (0 if integer else 2)
    value = rng.uniform(low, high)
    if form == 0 and round(value) >= max(low, 1) or form == 0 and low < 0:
        return int(round(value))
    return round(float(value), 3) if form == 1 and round(value, 3) > 0 else float(value)


def numbers(rng, low, high, count):
    """One number for all or one per item."""
    return number(rng, low, high) if rng.random() < 0.5 else [number(rng, low, high) for _ in range(count)]


def scattered_points(rng, count):
    """Points at least 0.6 m from each other."""
    points = []
    side = 0.9 * count ** (1.0 / 3.0) + 0.5
    integer = rng.random() < 0.2
    while len(points) < count:
        side *= 1.002
        p = [int(c) for c in rng.integers(-2, 4, 3)] if integer else [float(c) for c in rng.uniform(0, side, 3)]
        if rng.random() < 0.2 and not integer:
            p[int(rng.integers(3))] = int(rng.integers(0, 3))
        if all(np.linalg.norm(np.subtract(p, q)) >= 0.6 for q in points):
            points.append(p)
    return points


def random_network(rng, points):
    """A spanning tree of short springs and some more, in random orientation."""
    x = np.array(points, dtype=float)
    pairs = set()
    for i in range(1, len(x)):
        nearest = int(np.argmin(np.linalg.norm(x[:i] - x[i], axis=1)))
        pairs.add((nearest, i))
    for _ in range(int(rng.integers(0, len(x) + 1))):
        i, j = sorted(int(k) for k in rng.choice(len(x), 2, replace=False))
        pairs.add((i, j))
    ordered = sorted(pairs)
    rng.shuffle(ordered)
    return [[int(i), int(j)] if rng.random() < 0.5 else [int(j), int(i)] for i, j in ordered]


def random_scene(rng, law, stiff=False, free_flight=False, damped=None):
    """A scene as nested dicts; `stiff` has k of 1e4 to 1e5 and m of 1e-2, `damped` None leaves dampers and drag to
    chance, False has neither."""
    count = int(rng.integers(2, 16))
    points = scattered_points(rng, count)
    scene = {}
    if rng.random() < 0.8:
        scene["title"] = f"random {law} system"
    world = {}
    if rng.random() < 0.7:
        world["gravity"] = [number(rng, -3, 3) for _ in range(2)] + [[-9.81, -10, 2.5][int(rng.integers(3))]]
    if damped is not False and rng.random() < 0.5:
        world["drag"] = number(rng, 0.001, 0.5, False) if rng.random() < 0.8 else 0
    if world or rng.random() < 0.3:
        scene["world"] = world
    particles = scene["particles"] = {"position": points}
    fixed = []
    if rng.random() < 0.6:
        fixed = [int(i) for i in rng.choice(count, int(rng.integers(0, min(count, 4))), replace=False)]
        particles["fixed"] = fixed
    if rng.random() < 0.6:
        particles["velocity"] = [[0, 0, 0] if i in fixed else [number(rng, -1, 1) for _ in range(3)]
                                 for i in range(count)]
    if stiff:
        particles["mass"] = 0.01 if rng.random() < 0.5 else [float(m) for m in rng.uniform(0.01, 0.02, count)]
    else:
        particles["mass"] = numbers(rng, 0.4, 4, count)
    if free_flight:
        return scene
    springs = scene["springs"] = {"between": random_network(rng, points)}
    total = len(springs["between"])
    springs["stiffness"] = numbers(rng, 1e4, 1e5, total) if stiff else numbers(rng, 5, 120, total)
    if damped is not False and (damped or rng.random() < 0.6):
        springs["damping"] = numbers(rng, 0.01, 1.0, total)
    elif rng.random() < 0.2:
        springs["damping"] = 0
    ends = np.array(points, dtype=float)[np.array(springs["between"])]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    choice = rng.random()
    spread = 0.02 if stiff else 0.15
    if choice < 0.5:
        springs["rest_length"] = [float(value) for value in length * rng.uniform(1 - spread, 1 + spread, total)]
    elif choice < 0.7 and (not stiff or total == 1):
        springs["rest_length"] = round(float(length.min() * rng.uniform(0.9, 1.0)), 2)
    elif stiff:
        # at rest, a stiff system would only slide: something has to ring
        springs["rest_length"] = [float(value) for value in length * 0.99]
    if law != "hooke" or rng.random() < 0.5:
        springs["law"] = law
    return scene


def in_groups(rng, scene, laws):
    """The scene with its springs in groups [[springs]], one per law of `laws`, cut at random places; a group may be
    empty."""
    springs = scene["springs"]
    count = len(springs["between"])
    borders = [0, *sorted(int(k) for k in rng.integers(0, count + 1, len(laws) - 1)), count]
    groups = []
    for law, begin, end in zip(laws, borders[:-1], borders[1:]):
        group = {key: value[begin:end] if isinstance(value, list) else value for key, value in springs.items()}
        if law == "hooke" and rng.random() < 0.5:
            group.pop("law", None)
        else:
            group["law"] = law
        if rng.random() < 0.5:
            group["name"] = f"group {len(groups)}"
        groups.append(group)
    return {**scene, "springs": groups}


def toml_text(scene):
    """Lists, strings and numbers look alike in TOML and JSON, except that JSON writes 1e-05 the same way too."""
    def is_section(value):
        return isinstance(value, dict) or isinstance(value, list) and value and isinstance(value[0], dict)

    lines = [f"{key} = {json.dumps(value)}" for key, value in scene.items() if not is_section(value)]
    for name, section in scene.items():
        if not is_section(section):
            continue
        for table in [section] if isinstance(section, dict) else section:
            lines.append(f"[{name}]" if isinstance(section, dict) else f"[[{name}]]")
            lines += [f"{key} = {json.dumps(value)}" for key, value in table.items()]
    return "\n".join(lines) + "\n"
