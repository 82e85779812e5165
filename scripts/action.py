#!/usr/bin/env python3
"""The steps of action.yml as a shell script, for a machine without GitHub. Usage: action.py [NAME=VALUE]...

VALUEs are the action's inputs. Each step becomes a bash of its own, run as GitHub runs `shell: bash`. An expression of GitHub's
may stand for a value of `env` alone: inside `run`, the text of an input would be read as commands."""
import re
import shlex
import sys
from pathlib import Path

import yaml


def main():
    action = yaml.safe_load(Path(__file__).resolve().parents[1].joinpath("action.yml").read_text(encoding="utf-8"))
    given = dict(argument.split("=", 1) for argument in sys.argv[1:])
    unknown = given.keys() - action["inputs"].keys()
    assert not unknown, f"action.yml has no input {unknown}"
    inputs = {name: given.get(name, row["default"]) for name, row in action["inputs"].items()}
    assert action["runs"]["using"] == "composite"
    print("set -e")
    for step in action["runs"]["steps"]:
        assert step.keys() <= {"name", "shell", "env", "run"} and step["shell"] == "bash", step
        assert "${{" not in step["run"], f"an expression stands in the commands of '{step['name']}'"
        values = []
        for name, expression in step.get("env", {}).items():
            asked = re.fullmatch(r"\$\{\{ inputs\.(\w+)( \|\| .*)? \}\}", expression)
            value = inputs[asked.group(1)]
            assert value or not asked.group(2), f"say {asked.group(1)}=VALUE: GitHub's own values are not here"
            values.append(f"{name}={shlex.quote(value)}")
        print("env", *values, "bash --noprofile --norc -eo pipefail -c", shlex.quote(step["run"]))


main()
