#!/usr/bin/env python3
"""The JSON schemas that `federwerk schema` prints: every study of the project is valid, and for every declared
setting a misspelt key, a wrong type and a value out of range are refused by the schema and by the program alike.

usage: schemas_test.py FEDERWERK [unittest arguments]
"""

import concurrent.futures
import copy
import json
import pathlib
import subprocess
import sys
import tempfile
import tomllib
import unittest

import jsonschema

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
STUDIES = ROOT / "studies"
FEDERWERK = None

OSCILLATOR = {"name": "harmonic_oscillator", "t_end": 1.0, "parameters": {"stiffness": 2.0}, "label": "a"}
SCENE = {"scene": str(STUDIES / "scenes" / "damped_network.toml"), "t_end": 1.0, "label": "b",
         "set": {"springs": {"damping": 0.1}}}
FAMILY = {**OSCILLATOR, "vary": {"parameter": "stiffness", "values": [1.0, 2.0, 3.0]}}
SEQUENCE = {**OSCILLATOR, "label": "c", "vary": {"parameter": "stiffness", "from": 1.0, "to": 4.0, "count": 3}}

# One valid study of each kind with all its sections.
BASES = {
    "convergence": {"methods": ["rk4"], "convergence": {}, "problem": [OSCILLATOR, SCENE]},
    "agreement": {"methods": ["rk4"], "agreement": {}, "problem": [OSCILLATOR, SCENE]},
    "stability": {"methods": ["rk4"], "regions": {}, "limits": {}, "problem": [FAMILY, SEQUENCE]},
    "stiffness": {"methods": ["rk4"], "stiffness": {"operation_costs": {}}, "problem": [FAMILY, SEQUENCE]},
    "work_precision": {"methods": ["rk4"], "work_precision": {}, "problem": [FAMILY, SEQUENCE]},
    "energy": {"methods": ["rk4"], "energy": {"steps": [0.1]}, "problem": [OSCILLATOR, SCENE]},
    "verify": {"methods": ["rk4"], "verify": {}},
    "dissipation": {"methods": ["rk4"], "dissipation": {}},
    "propagation": {"methods": ["rk4"], "propagation": {"steps": [0.1]}, "problem": [{"name": "linear_chain"}]},
    "jacobian": {"springs": {}, "derivatives": {}, "definiteness": {"compressions": [1.0], "steps": [0.1]},
                 "runs": {"compressions": [1.0], "steps": [0.1], "methods": ["implicit_euler"]},
                 "problem": [SCENE]},
    "linear_solver": {"solvers": ["cg"], "linear_solver": {"steps": [0.1]}, "problem": [SCENE]},
    "simulate": {"methods": ["rk4"], "steps": [0.1], "tolerances": {}, "problem": [OSCILLATOR],
                 "vector_field": {"lower": [0.0, 0.0], "upper": [1.0, 1.0], "counts": [3, 3]}},
    "sweep": {"parameter": [{"path": "steps[0]", "values": [0.1, 0.2]},
                            {"path": "problem[0].t_end", "from": 1.0, "to": 2.0, "count": 2}],
              "study": {"kind": "simulate", "methods": ["rk4"], "steps": [0.1], "problem": [OSCILLATOR]}},
}


WORLD = {"title": "T", "world": {}, "anchor": [{"particle": 0, "stiffness": 1.0}],
         "obstacle": [{"shape": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "stiffness": 1.0},
                      {"shape": "sphere", "centre": [0, 0, 0], "radius": 1.0, "stiffness": 1.0},
                      {"shape": "box", "lower": [0, 0, 0], "upper": [1, 1, 1], "stiffness": 1.0}]}
CHAIN = {"kind": "chain", "count": 3, "length": 1.0, "mass": 1.0, "stiffness": 1.0}
CLOTH = {"kind": "cloth", "counts": [3, 3], "size": [1.0, 1.0], "total_mass": 1.0, "stiffness": 1.0}
GRID = {"kind": "grid", "counts": [3, 3, 3], "spacing": 1.0, "density": 1.0, "stiffness": {"structural": 1.0, "shear": 2.0}}
# Valid scenes with all sections.
SCENES = {
    "scene-explicit": {**WORLD, "particles": {"position": [[0, 0, 0], [1, 0, 0]], "mass": 1.0},
                       "springs": {"between": [[0, 1]], "stiffness": 1.0}},
    "scene-chain": {**WORLD, "generate": CHAIN},
    "scene-cloth": {**WORLD, "generate": CLOTH},
    "scene-grid": {**WORLD, "generate": GRID},
    "scene-block": {**WORLD, "generate": {**GRID, "kind": "block", "stiffness": 1.0}},
}


def toml(table, path=""):
    """The table as TOML text."""
    def is_sections(value):
        return isinstance(value, list) and value and all(isinstance(entry, dict) for entry in value)
    lines = [f"{key} = {json.dumps(value)}" for key, value in table.items()
             if not isinstance(value, dict) and not is_sections(value)]
    for key, value in table.items():
        place = f"{path}.{key}" if path else key
        if isinstance(value, dict):
            lines += [f"[{place}]", toml(value, place)]
        elif is_sections(value):
            for entry in value:
                lines += [f"[[{place}]]", toml(entry, place)]
    return "\n".join(lines)


def schema_of(kind):
    return json.loads(subprocess.run([FEDERWERK, "schema", kind], check=True, capture_output=True).stdout)


def subschemas(schema, key):
    """Everything that a schema says of a key, in whatever form of the section."""
    found = [schema.get("properties", {}).get(key)]
    for rule in schema.get("allOf", []):
        for form in [*rule.get("oneOf", []), rule.get("then", {})]:
            found += subschemas(form, key)
    return [one for one in found if isinstance(one, dict) and one]


def wrong_values(schema):
    """Values that the schema of a setting has to refuse."""
    validator = jsonschema.Draft202012Validator(schema)
    for alternative in schema.get("anyOf", []):
        if "pattern" in alternative:
            yield "no_such_name"
        yield from (value for value in wrong_values(alternative) if not validator.is_valid(value))
    if "enum" in schema:
        yield "no_such_name"
    kind = schema.get("type")
    if kind in ("number", "integer"):
        yield "text"
        if "minimum" in schema:
            yield schema["minimum"] - 1
        if "exclusiveMinimum" in schema:
            yield schema["exclusiveMinimum"]
        if "maximum" in schema:
            yield schema["maximum"] + 1
        if "exclusiveMaximum" in schema:
            yield schema["exclusiveMaximum"]
        if kind == "integer":
            yield 7.5
    elif kind == "boolean":
        yield "yes"
        yield 1
    elif kind == "string":
        yield 7
    elif kind == "array":
        yield "text"
        items = schema["items"]
        fewest = schema.get("minItems", 0)
        if fewest > 0:
            yield []
        if schema.get("maxItems", 0) == fewest and fewest > 0:
            yield [1.5] * (fewest + 1)
        for wrong in wrong_values(items):
            if items.get("type") != "object":
                yield [wrong] * max(fewest, 1)
    elif kind == "object":
        yield 7


def places(schema, document, path=()):
    """Sections of the document with their schemas."""
    yield path, schema
    for key, value in document.items():
        for inner in subschemas(schema, key):
            if inner.get("type") == "object" and inner.get("properties") and isinstance(value, dict):
                yield from places(inner, value, (*path, key))
            elif inner.get("type") == "array" and inner["items"].get("properties") and isinstance(value, list):
                for index, entry in enumerate(value):
                    yield from places(inner["items"], entry, (*path, key, index))


def keys_of(schema):
    keys = set(schema.get("properties", {}))
    for rule in schema.get("allOf", []):
        for form in [*rule.get("oneOf", []), rule.get("then", {})]:
            keys |= keys_of(form)
    return keys


def changed(document, path, key, value):
    result = copy.deepcopy(document)
    place = result
    for step in path:
        place = place[step]
    place[key] = value
    return result


def base_of(kind):
    if kind in SCENES:
        return copy.deepcopy(SCENES[kind])
    return {"kind": kind, "title": "T", "seed": 0, "time_limit": 0, **copy.deepcopy(BASES[kind]), "quick": {}}


def mutations(kind, schema):
    """(key, document): each document has one mistake, at the key."""
    base = base_of(kind)
    for path, section in places(schema, base):
        if path[:1] == ("study",):
            continue
        yield "no_such_key", changed(base, path, "no_such_key", 1)
        for key in sorted(keys_of(section)):
            yield key + "z", changed(base, path, key + "z", 1)
            seen = []
            for one in subschemas(section, key):
                for wrong in wrong_values(one):
                    if wrong not in seen and not (key == "kind" and not path):
                        seen.append(wrong)
                        yield key, changed(base, path, key, wrong)


def refusal(document, directory, number, is_scene):
    """Exit code and message of the program for the document."""
    file = directory / f"m{number}.toml"
    file.write_text(toml(document), encoding="utf-8")
    command = ["run", "--quick", str(file), "-o", str(directory / "out")]
    if is_scene:
        command = ["simulate", str(file), "--method", "rk4", "--step", "0.01", "--t-end", "0.01",
                   "-o", str(directory / f"s{number}.h5")]
    run = subprocess.run([FEDERWERK, *command], capture_output=True, encoding="utf-8", timeout=120)
    return run.returncode, run.stderr


class Schemas(unittest.TestCase):
    def test_every_study_of_the_project_is_valid(self):
        schemas = {kind: jsonschema.Draft202012Validator(schema_of(kind)) for kind in BASES}
        count = 0
        for file in sorted(STUDIES.rglob("*.toml")):
            document = tomllib.loads(file.read_text(encoding="utf-8"))
            if "kind" not in document:
                continue  # a scene
            count += 1
            with self.subTest(file=file.relative_to(ROOT)):
                errors = [error.message for error in schemas[document["kind"]].iter_errors(document)]
                self.assertEqual(errors, [])
        self.assertGreaterEqual(count, 40)

    def test_every_scene_of_the_project_is_valid(self):
        schema = jsonschema.Draft202012Validator(schema_of("scene"))
        files = sorted((STUDIES / "scenes").rglob("*.toml"))
        self.assertGreaterEqual(len(files), 10)
        for file in files:
            with self.subTest(file=file.relative_to(ROOT)):
                document = tomllib.loads(file.read_text(encoding="utf-8"))
                self.assertEqual([error.message for error in schema.iter_errors(document)], [])

    def test_mistakes_in_every_setting_are_refused_by_schema_and_program_alike(self):
        with tempfile.TemporaryDirectory() as name, concurrent.futures.ThreadPoolExecutor(2) as pool:
            directory = pathlib.Path(name)
            for kind in [*BASES, *SCENES]:
                schema = schema_of(kind.split("-")[0])
                jsonschema.Draft202012Validator.check_schema(schema)
                validator = jsonschema.Draft202012Validator(schema)
                self.assertTrue(validator.is_valid(base_of(kind)),
                                [error.message for error in validator.iter_errors(base_of(kind))])
                cases = list(mutations(kind, schema))
                self.assertGreater(len(cases), 25, kind)
                answers = pool.map(lambda case: refusal(case[1][1], directory, f"{kind}{case[0]}", kind in SCENES),
                                   enumerate(cases))
                for (key, document), (code, message) in zip(cases, answers):
                    with self.subTest(kind=kind, key=key, text=toml(document)):
                        self.assertFalse(validator.is_valid(document), "the schema accepts it")
                        self.assertEqual(code, 2, message)
                        self.assertIn(key.rstrip("z"), message)


if __name__ == "__main__":
    FEDERWERK = sys.argv.pop(1)
    unittest.main()
