"""Links of the documents lead somewhere; pictures exist, can be read, and are used."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import pytest

ROOT = Path(__file__).parents[2]
DOCUMENTS = sorted(
    [
        *ROOT.glob("*.md"),
        *ROOT.glob("docs/*.md"),
        *ROOT.glob("bench/*.md"),
        *ROOT.glob("examples/**/*.md"),
    ]
)
PICTURES = sorted(path for path in (ROOT / "docs" / "images").iterdir())
SVG = "{http://www.w3.org/2000/svg}"


def prose(path: Path) -> str:
    """A document without its code."""
    text = re.sub(r"^```.*?^```$", "", path.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"`[^`\n]*`", "", text)


@cache
def anchors(path: Path) -> frozenset[str]:
    """The fragments of its headings, as GitHub makes them."""
    text = re.sub(r"^```.*?^```$", "", path.read_text("utf-8"), flags=re.MULTILINE | re.DOTALL)
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return frozenset(
        re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings
    )


def targets(path: Path) -> list[str]:
    """What a document links to or shows, but for what is on the web."""
    text = prose(path)
    found = re.findall(r"\]\(([^)\s]+)\)", text) + re.findall(r'(?:src|href)="([^"]+)"', text)
    return [target for target in found if not re.match(r"[a-z]+:", target)]


def broken(path: Path, target: str) -> bool:
    name, _, fragment = target.partition("#")
    place = path.parent / name if name else path
    if not place.exists():
        return True
    return bool(fragment) and fragment not in anchors(place.resolve())


@pytest.mark.parametrize("path", DOCUMENTS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_links_lead_somewhere(path: Path) -> None:
    assert [target for target in targets(path) if broken(path, target)] == []


def test_links_are_found() -> None:
    semantics = targets(ROOT / "docs" / "semantics.md")
    assert "#userdata" in semantics
    assert "images/userdata.svg" in semantics
    assert broken(ROOT / "README.md", "docs/no.md")
    assert broken(ROOT / "README.md", "docs/semantics.md#no-such-heading")


@pytest.mark.parametrize("picture", PICTURES, ids=lambda path: path.name)
def test_a_picture_is_used(picture: Path) -> None:
    shown = {(path.parent / target).resolve() for path in DOCUMENTS for target in targets(path)}
    assert picture.resolve() in shown


@pytest.mark.parametrize(
    "picture",
    [path for path in PICTURES if path.suffix == ".svg"],
    ids=lambda path: path.name,
)
def test_a_drawing_has_a_title_and_its_own_light_ground(picture: Path) -> None:
    """The ground makes it readable in dark themes too."""
    root = ElementTree.parse(picture).getroot()
    assert root.find(f".//{SVG}title") is not None
    grounds = [
        node.get("fill") for node in root.iter() if node.tag in (f"{SVG}rect", f"{SVG}polygon")
    ]
    assert grounds[0] in ("#ffffff", "white")
