# SPDX-License-Identifier: Apache-2.0
"""judge_by_schema.py SCHEMA FILE...: prints what the JSON Schema says against each YAML file, as an
editor would, one line each; exit code 1 when there is any."""
import json
import re
import sys

import jsonschema
import yaml


class Yaml12(yaml.SafeLoader):
    """Scalars by the core schema of YAML 1.2, as editors and Armature read them: 1e-3 is a number,
    on a text."""


Yaml12.yaml_implicit_resolvers = {}
for tag, pattern in (
    ("null", r"~|null|Null|NULL|"),
    ("bool", r"true|True|TRUE|false|False|FALSE"),
    ("int", r"[-+]?[0-9]+"),
    ("float", r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?"),
):
    Yaml12.add_implicit_resolver(f"tag:yaml.org,2002:{tag}", re.compile(f"^(?:{pattern})$"), None)
Yaml12.add_constructor("tag:yaml.org,2002:float", lambda loader, node: float(node.value))
Yaml12.add_constructor("tag:yaml.org,2002:int", lambda loader, node: int(node.value))


def main(schema_file, *files):
    with open(schema_file) as file:
        schema = json.load(file)
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    found = False
    for name in files:
        with open(name) as file:
            document = yaml.load(file, Yaml12)
        for error in validator.iter_errors(document):
            found = True
            place = ".".join(str(key) for key in error.absolute_path)
            print(f"{name}: {place}: {error.message}")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
