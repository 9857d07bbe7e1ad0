"""The JSON Schemas, judged by an independent validator: check-jsonschema."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from smachac.commands.schema import schema_text
from tests.report.test_json_schema import YAML_FILES, kind


@pytest.mark.parametrize("name", ["script", "interface", "robot", "scene", "faults", "scenario"])
def test_the_validator_of_editors_accepts_the_files(name: str, tmp_path: Path) -> None:
    """check-jsonschema, an independent validator, on the printed schema."""
    file = tmp_path / f"{name}.json"
    file.write_text(schema_text(name), "utf-8")
    checker = [sys.executable, "-m", "check_jsonschema"]
    subprocess.run([*checker, "--check-metaschema", str(file)], check=True, capture_output=True)
    paths = [str(path) for path in YAML_FILES if kind(path) == name]
    done = subprocess.run(
        [*checker, "--schemafile", str(file), *paths], capture_output=True, text=True
    )
    assert (done.returncode, done.stdout.strip()) == (0, "ok -- validation done")
