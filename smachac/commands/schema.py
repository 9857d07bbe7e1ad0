"""The command `schema`: print the JSON Schema of a kind of file, for editors and other programs."""

from __future__ import annotations

import argparse
import sys
from argparse import Namespace

from smachac.commands.arguments import report_output
from smachac.commands.output import OK, usage

TYPE_CHECKING = False  # annotations only: `--help` imports none of this
if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Any

EXAMPLES = """\
examples:
  smachac schema                            the names of the schemas
  smachac schema script -o script.json      the schema of scripts and sub-scripts

In a script, the comment `# yaml-language-server: $schema=script.json` names the schema for editors.
exit codes: 0 success, 2 wrong usage, 70 a bug in smachac
"""

SCHEMAS: Mapping[str, str] = {
    "script": "scripts and sub-scripts",
    "interface": "interfaces of state types",
    "project": "smachac.toml",
    "scenario": "scenarios for `run --mock`",
    "robot": "descriptions of robots",
    "scene": "scenes: the bodies in the simulated world",
    "faults": "faults for `run --faults`",
    "machine": "the output of the target `json`",
    "report": "the output of `check --format json`",
    "diff": "the output of `diff --format json`",
}
"""The names of the schemas, and the files that they describe."""


def schema_arguments(parser: argparse.ArgumentParser) -> None:
    parser.epilog = EXAMPLES
    parser.add_argument("name", nargs="?", metavar="NAME", help="the name of a schema")
    report_output(parser)


def schema_command(arguments: Namespace) -> int:
    """Print a schema, or the names of all; the exit code."""
    if arguments.name is None:
        for name, text in SCHEMAS.items():
            print(f"{name:<10} {text}")
        return OK
    if arguments.name not in SCHEMAS:
        return usage(f"there is no schema `{arguments.name}`", arguments.name, list(SCHEMAS))
    sys.stdout.write(schema_text(arguments.name))
    return OK


def schema_text(name: str) -> str:
    """The text of a schema of SCHEMAS."""
    import json
    from importlib.resources import files

    from smachac.driver import CODES
    from smachac.report.json import json_text
    from smachac.report.json_schema import generated_schemas

    generated = generated_schemas(CODES)
    if name in generated:
        return json_text(generated[name]())

    def stored(name: str) -> dict[str, Any]:
        text = files("smachac.grammars").joinpath(f"{name}.schema.json").read_text("utf-8")
        data: dict[str, Any] = json.loads(text)
        return data

    data = stored(name)
    if name == "diff":  # its findings are those of a report
        data["definitions"] |= stored("report")["definitions"]
    return json_text(data)
