"""docs/licences.md lists every dependency, with the licence that the package itself states."""

from __future__ import annotations

import json
import re
import sys
from importlib import import_module
from importlib.metadata import PackageNotFoundError, metadata
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "licences.md").read_text("utf-8")
SECTIONS = dict(re.findall(r"^## (.+)\n((?:(?!## ).*\n)*)", PAGE, re.MULTILINE))
CLASSIFIERS = {
    "MIT License": "MIT",
    "BSD License": "BSD",
    "Apache Software License": "Apache-2.0",
    "zlib/libpng License": "Zlib",
    "GNU Lesser General Public License v3 (LGPLv3)": "LGPL-3.0-only",
}
"""The classifiers of packages that state no SPDX identifier."""


def rows(section: str) -> list[list[str]]:
    """The cells of a table below its heading."""
    lines = re.findall(r"^\| (.*) \|$", SECTIONS[section], re.MULTILINE)[2:]
    return [line.replace("`", "").split(" | ") for line in lines]


def project() -> dict[str, Any]:
    toml = import_module("tomllib" if sys.version_info >= (3, 11) else "tomli")
    found: dict[str, Any] = toml.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
    return found


def name(requirement: str) -> str:
    """The distribution of a requirement."""
    return re.split(r"[\[<>=;! ]", requirement)[0]


def test_every_required_package_is_listed() -> None:
    assert [row[0] for row in rows("Required")] == [name(e) for e in project()["dependencies"]]


def test_every_package_of_an_extra_is_listed() -> None:
    extras = project()["optional-dependencies"]
    listed = {(row[0], row[1]) for row in rows("Optional")}
    assert listed == {
        (extra, name(item)) for extra in extras if extra != "dev" for item in extras[extra]
    }
    others = {package for _, package in listed}
    wanted = [name(item) for item in extras["dev"] if name(item) not in others]
    assert [row[0] for row in rows("For development")] == wanted


def test_every_package_of_the_extension_is_listed() -> None:
    package = json.loads((ROOT / "editors" / "vscode" / "package.json").read_text("utf-8"))
    wanted = {**package.get("dependencies", {}), **package["devDependencies"]}
    assert {row[0] for row in rows("The extension for VS Code")} == set(wanted)
    lock = json.loads((ROOT / "editors" / "vscode" / "package-lock.json").read_text("utf-8"))
    for listed in rows("The extension for VS Code"):
        assert lock["packages"][f"node_modules/{listed[0]}"]["license"] == listed[-1]


def test_contained_parts_have_their_licence_beside_them() -> None:
    for part, _, licence in rows("Contained"):
        found = list(ROOT.glob("smachac/**/LICENSES.txt"))
        assert any(part in path.read_text("utf-8") for path in found)
        assert any(f"under the {licence}" in path.read_text("utf-8") for path in found)


LISTED = [
    *((row[0], row[-1]) for row in rows("Required")),
    *((row[1], row[-1]) for row in rows("Optional")),
    *((row[0], row[-1]) for row in rows("For development")),
]


@pytest.mark.parametrize(("package", "licence"), LISTED)
def test_a_licence_is_the_one_that_the_package_states(package: str, licence: str) -> None:
    try:
        found = metadata(package)
    except PackageNotFoundError:
        assert licence  # not installed here: nothing to compare with
        return
    stated = " ".join(found.get_all("License-Expression") or [])
    for classifier in found.get_all("Classifier") or []:
        stated += f" {CLASSIFIERS.get(classifier.rpartition(' :: ')[2], '')}"
    assert licence in stated or ("BSD" in licence and "BSD" in stated) or not stated.strip()
