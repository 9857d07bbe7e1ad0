"""docs/targets.md shows generated programs as they are: what stands between elisions is in them."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import smachac
from smachac.targets import target_names

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "targets.md").read_text("utf-8")
ELISION = re.compile(r"^ *(?://|#) \.\.\.\n", re.MULTILINE)


def shown(language: str) -> list[tuple[str, str]]:
    """The blocks of a language behind the name of an example in the same section, each with the
    folder of that example."""
    found, folder = [], ""
    pattern = rf"\]\(\.\./examples/(\w+)\)|^```{language}\n(.*?)^```$|^## "
    for match in re.finditer(pattern, PAGE, re.MULTILINE | re.DOTALL):
        folder = "" if match[0] == "## " else match[1] or folder
        if match[2] and folder:
            found.append((folder, match[2]))
    return found


def missing(block: str, header: str) -> str | None:
    """The first part of a block that is not in a header where it should be, whole lines long; a
    part behind an elision stands somewhere after the part before, with something between."""
    at = 0
    for number, part in enumerate(ELISION.split(block)):
        text = part.strip("\n")
        if not text:
            continue
        place = re.compile(f"^{re.escape(text)}$", re.MULTILINE).search(header, at)
        if place is None or (number and not header[at : place.start()].strip()):
            return text
        at = place.end()
    return None


def test_each_target_has_a_section() -> None:
    headings = re.findall(r"^## (.+)$", PAGE, re.MULTILINE)
    assert set(target_names()) <= {name for heading in headings for name in heading.split(", ")}


def test_blocks_are_found() -> None:
    assert [folder for folder, _ in shown("python")] == ["09_stacking", "14_delivery_round"]
    folders = [folder for folder, _ in shown("cpp")]
    assert folders.count("06_callbacks") == 2
    assert folders.count("08_pick_and_place") == 1


@pytest.mark.parametrize(
    ("target", "folder", "block"),
    [(target, *item) for target in ("cpp", "python") for item in shown(target)],
)
def test_a_program_holds_what_is_shown_of_it(target: str, folder: str, block: str) -> None:
    files = smachac.compile(ROOT / "examples" / folder / "main.yml", target)
    assert missing(block, next(iter(files.values()))) is None


@pytest.mark.parametrize(
    ("block", "wrong"),
    [
        ("one\n// ...\nthree\n", None),
        ("  // ...\ntwo\n\nthree\n// ...\n", None),
        ("one\nthree\n", "one\nthree"),
        ("three\n// ...\none\n", "one"),
        ("one\n// ...\ntwo\n", "two"),
        ("on\n", "on"),
        ("wo\n", "wo"),
    ],
)
def test_what_is_not_there_is_found(block: str, wrong: str | None) -> None:
    assert missing(block, "one\ntwo\n\nthree\nfour\n") == wrong
