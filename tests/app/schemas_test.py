#!/usr/bin/env python3
"""The JSON schemas that `federwerk schema` prints: every study of the project is valid, and for every declared
setting and every option of a method a misspelt name, a wrong type and a value out of range are refused by the schema
and by the program alike. The program reads all files at once (`federwerk check`).

usage: schemas_test.py FEDERWERK [unittest arguments]
"""

import copy
import functools
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib
import unittest

import jsonschema

from scene_samples import FLAWED_SCENES, MISSING, SCENES

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
STUDIES = ROOT / "studies"
PROJECT = sorted(STUDIES.rglob("*.toml"))
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


def toml(table, path=""):
    """The table as TOML text."""
    def is_sections(value):
        return isinstance(value, list) and value and all(isinstance(entry, dict) for entry in value)
    def text(value):
        return json.dumps(value).replace("NaN", "nan").replace("Infinity", "inf")
    lines = [f"{key} = {text(value)}" for key, value in table.items()
             if not isinstance(value, dict) and not is_sections(value)]
    for key, value in table.items():
        place = f"{path}.{key}" if path else key
        if isinstance(value, dict):
            lines += [f"[{place}]", toml(value, place)]
        elif is_sections(value):
            for entry in value:
                lines += [f"[[{place}]]", toml(entry, place)]
    return "\n".join(lines)


@functools.cache
def schema_of(kind):
    schema = json.loads(subprocess.run([FEDERWERK, "schema", kind], check=True, capture_output=True).stdout)
    jsonschema.Draft202012Validator.check_schema(schema)
    return schema


@functools.cache
def validator_of(kind):
    return jsonschema.Draft202012Validator(schema_of(kind))


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
    if value is MISSING:
        del place[key]
    else:
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


def checked(arguments):
    """What the program says of files or calls: exit code, and an answer for each."""
    run = subprocess.run([FEDERWERK, "check", "--json", "--quick", *map(str, arguments)], capture_output=True,
                         encoding="utf-8", timeout=120)
    return run.returncode, json.loads(run.stdout)


def refusal(file):
    """Exit code and message of the program that is to compute what the file says."""
    command = ["run", "--quick", file, "-o", file.parent / "out"]
    if "kind" not in tomllib.loads(file.read_text(encoding="utf-8")):
        command = ["simulate", file, "--method", "rk4", "--step", "0.01", "--t-end", "0.01",
                   "-o", file.with_suffix(".h5")]
    run = subprocess.run([FEDERWERK, *map(str, command)], capture_output=True, encoding="utf-8", timeout=120)
    return run.returncode, run.stderr


def call_of(method, option, value):
    return f"{method}[{option}={value}]"


def wrong_calls():
    """(call, the name that is wrong, the call as the schema sees it): each has one mistake."""
    for method, section in schema_of("method-options")["properties"].items():
        for option, schema in section["properties"].items():
            yield call_of(method, option + "z", 1), option + "z", {method: {option + "z": 1}}
            seen = []
            for wrong in wrong_values(schema):
                is_text = isinstance(wrong, str)
                if wrong not in seen and (is_text or schema.get("type") != "string"):  # a call is text anyway
                    seen.append(wrong)
                    yield call_of(method, option, wrong), option, {method: {option: wrong}}


class Schemas(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        # Reads for some seconds beside the tests.
        cls.project = subprocess.Popen([FEDERWERK, "check", "--json", "--quick", *map(str, PROJECT)],
                                       stdout=subprocess.PIPE, encoding="utf-8")

    @classmethod
    def tearDownClass(cls):
        cls.project.kill()
        cls.project.communicate()

    def test_every_study_of_the_project_is_valid(self):
        count = 0
        for file in PROJECT:
            document = tomllib.loads(file.read_text(encoding="utf-8"))
            if "kind" not in document:
                continue  # a scene
            count += 1
            with self.subTest(file=file.relative_to(ROOT)):
                errors = [error.message for error in validator_of(document["kind"]).iter_errors(document)]
                self.assertEqual(errors, [])
        self.assertGreaterEqual(count, 40)

    def test_every_scene_of_the_project_is_valid(self):
        files = sorted((STUDIES / "scenes").rglob("*.toml"))
        self.assertGreaterEqual(len(files), 10)
        for file in files:
            with self.subTest(file=file.relative_to(ROOT)):
                document = tomllib.loads(file.read_text(encoding="utf-8"))
                self.assertEqual([error.message for error in validator_of("scene").iter_errors(document)], [])

    def test_the_program_accepts_every_file_of_the_project(self):
        answers, _ = self.project.communicate(timeout=120)
        answers = json.loads(answers)
        self.assertEqual([answer["message"] for answer in answers if not answer["valid"]], [])
        self.assertEqual(self.project.returncode, 0)
        self.assertEqual([answer["name"] for answer in answers], [str(file) for file in PROJECT])
        self.assertEqual({answer["type"] for answer in answers}, {"study", "scene"})

    def test_mistakes_in_every_setting_are_refused_by_schema_and_program_alike(self):
        with tempfile.TemporaryDirectory() as name:
            cases, samples = [], []
            for place, kind in enumerate([*BASES, *SCENES]):
                validator = validator_of(kind.split("-")[0])
                self.assertTrue(validator.is_valid(base_of(kind)),
                                [error.message for error in validator.iter_errors(base_of(kind))])
                flawed = list(mutations(kind, schema_of(kind.split("-")[0])))
                self.assertGreater(len(flawed), 25, kind)
                samples.append(len(cases) + 17 * place % len(flawed))
                cases += [(kind, key, document, toml(document)) for key, document in flawed]
            self.assertGreater(len(cases), 2500)
            files = [pathlib.Path(name) / f"{number}.toml" for number in range(len(cases))]
            for file, (_, _, _, text) in zip(files, cases):
                file.write_text(text, encoding="utf-8")
            code, answers = checked(files)
            self.assertEqual(code, 2)
            self.assertEqual(len(answers), len(cases))
            for (kind, key, document, text), answer in zip(cases, answers):
                with self.subTest(kind=kind, key=key, text=text):
                    self.assertFalse(validator_of(kind.split("-")[0]).is_valid(document), "the schema accepts it")
                    self.assertFalse(answer["valid"], "the program accepts it")
                    self.assertIn(key.rstrip("z"), answer["message"])
            for number in samples:  # whoever is to compute it says the same
                with self.subTest(kind=cases[number][0], text=cases[number][3]):
                    self.assertEqual(refusal(files[number]), (2, f"federwerk: {answers[number]['message']}\n"))

    def test_flaws_of_scenes_are_refused_by_the_program_and_where_it_can_by_the_schema(self):
        with tempfile.TemporaryDirectory() as name:
            files, documents = [], []
            for number, (base, place, value, _, _) in enumerate(FLAWED_SCENES):
                documents.append(changed(base_of(base), place[:-1], place[-1], value))
                files.append(pathlib.Path(name) / f"{number}.toml")
                files[-1].write_text(toml(documents[-1]), encoding="utf-8")
            code, answers = checked(files)
            self.assertEqual(code, 2)
            for flaw, file, document, answer in zip(FLAWED_SCENES, files, documents, answers):
                with self.subTest(flaw=flaw[:3], message=answer["message"]):
                    self.assertFalse(answer["valid"])
                    self.assertEqual(answer["type"], "scene")
                    self.assertRegex(answer["message"], rf"^{re.escape(str(file))}(:\d+)?: ")
                    self.assertIn(flaw[3], answer["message"])
                    self.assertEqual(validator_of("scene").is_valid(document), not flaw[4])

    def test_valid_bases_are_valid_for_the_program(self):
        with tempfile.TemporaryDirectory() as name:
            files = []
            for kind in [*BASES, *SCENES]:
                files.append(pathlib.Path(name) / f"{kind}.toml")
                files[-1].write_text(toml(base_of(kind)), encoding="utf-8")
            code, answers = checked(files)
            self.assertEqual([answer["message"] for answer in answers if not answer["valid"]], [])
            self.assertEqual(code, 0)

    def test_mistakes_in_options_of_methods_are_refused_by_schema_and_program_alike(self):
        cases = list(wrong_calls())
        self.assertGreater(len(cases), 400)
        self.assertGreater(len({call.split("[")[0] for call, _, _ in cases if ":" in call}), 20)  # foreign methods
        code, answers = checked(word for call, _, _ in cases for word in ("--method", call))
        self.assertEqual(code, 2)
        self.assertEqual(len(answers), len(cases))
        for (call, wrong, document), answer in zip(cases, answers):
            with self.subTest(call=call):
                self.assertFalse(validator_of("method-options").is_valid(document), "the schema accepts it")
                self.assertFalse(answer["valid"], "the program accepts it")
                self.assertIn(wrong, answer["message"])

    def test_choices_and_defaults_of_options_are_accepted_by_schema_and_program_alike(self):
        right = []
        for method, section in schema_of("method-options")["properties"].items():
            for option, schema in section["properties"].items():
                values = schema.get("enum", [])
                if option == "inner_table":  # which ones there are depends on `inner`
                    values = values[:1]
                values = {*values, *(one["const"] for one in schema.get("anyOf", []) if "const" in one),
                          schema.get("default", "")} - {""}
                right += [(call_of(method, option, value), {method: {option: value}})
                          for value in sorted(values, key=str)]
        self.assertGreater(len(right), 300)
        code, answers = checked(word for call, _ in right for word in ("--method", call))
        self.assertEqual([answer["message"] for answer in answers if not answer["valid"]], [])
        self.assertEqual(code, 0)
        for call, document in right:
            with self.subTest(call=call):
                self.assertTrue(validator_of("method-options").is_valid(document))


if __name__ == "__main__":
    FEDERWERK = sys.argv.pop(1)
    unittest.main()
