"""The same scene seen from elsewhere: shifted, in a moving frame, in other units of force and mass. What a study says of
it must not change."""

import copy

import numpy as np

from verdict_scenes import generated_as_particles, model_of

SHIFTS = (1e-3, 1.0, 1e3)
BOOSTS = ((1.0, 0.0, 0.0), (3.0, -20.0, 10.0))
UNITS = (1e-6, 1024.0, 1e9)


def spelt_out(scene):
    """Without [generate], and with every rest length, which would follow from rounded positions otherwise."""
    scene = copy.deepcopy(scene)
    if "generate" in scene:
        scene |= generated_as_particles(scene.pop("generate"))
    if "springs" in scene:
        scene["springs"]["rest_length"] = model_of(scene).rest_length.tolist()
    return scene


def shifted(scene, shift):
    scene = copy.deepcopy(scene)
    places = [(scene["particles"], "position")]
    places += [(anchor, "position") for anchor in scene.get("anchor", [])]
    places += [(solid, key) for solid in scene.get("obstacle", []) for key in ("point", "centre", "lower", "upper")]
    for table, key in places:
        if key in table:
            table[key] = (np.array(table[key], dtype=float) + shift).tolist()
    return scene


def may_be_boosted(scene):
    """Nothing stands still but the frame."""
    return not (scene["particles"].get("fixed") or "anchor" in scene or "obstacle" in scene
                or scene.get("world", {}).get("drag", 0.0) > 0.0)


def boosted(scene, velocity):
    scene = copy.deepcopy(scene)
    scene["particles"]["velocity"] = (model_of(scene).velocity + velocity).tolist()
    return scene


def in_units(scene, factor):
    """Masses and all constants of forces multiplied: the same accelerations."""
    scene = copy.deepcopy(scene)
    for table in (scene["particles"], scene.get("world", {}), scene.get("springs", {}), *scene.get("anchor", []),
                  *scene.get("obstacle", [])):
        for key in ("mass", "stiffness", "damping", "drag"):
            if key in table:
                table[key] = (np.array(table[key], dtype=float) * factor).tolist()
    return scene


def variants(scene):
    """Name -> scene; the first is the scene itself."""
    scene = spelt_out(scene)
    result = {"as given": scene}
    for size in SHIFTS:
        for axis, name in enumerate("xyz"):
            result[f"shifted by {size:g} m along {name}"] = shifted(scene, size * np.eye(3)[axis])
    if may_be_boosted(scene):
        for velocity in BOOSTS:
            result[f"boosted by {velocity[0]:g} {velocity[1]:g} {velocity[2]:g} m/s"] = boosted(scene, velocity)
    for factor in UNITS:
        result[f"masses and forces times {factor:g}"] = in_units(scene, factor)
    return result
