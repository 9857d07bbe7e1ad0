"""The page of the html target in a browser."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from smachac.driver import analyse_script, compile_script
from smachac.targets.html import TARGET
from tests.browser.pages import ROOT, SCREENSHOTS, Messages

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.browser

PICK_AND_PLACE = ROOT / "examples" / "08_pick_and_place" / "main.yml"


def write_page(script: Path, folder: Path) -> Path:
    """The page of a script in a file."""
    compiled = compile_script(analyse_script(script), TARGET)
    assert compiled.files, compiled.report
    ((name, text),) = compiled.files.items()
    path = folder / name
    path.write_text(text, "utf-8")
    return path


@pytest.fixture
def messages() -> Iterator[Messages]:
    """The messages of the page: none is allowed."""
    found = Messages()
    yield found
    assert found == []


def opened(browser: Browser, path: Path, messages: Messages, *, colours: str = "light") -> Page:
    """A page after its picture is drawn."""
    page = browser.new_page(
        viewport={"width": 1440, "height": 900},
        color_scheme="dark" if colours == "dark" else "light",
    )
    messages.watch(page)
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready]")
    return page


def shoot(page: Page, name: str) -> None:
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / f"{name}.png")


def test_page_shows_the_states(browser: Browser, tmp_path: Path, messages: Messages) -> None:
    page = opened(browser, write_page(PICK_AND_PLACE, tmp_path), messages)
    shoot(page, "pick_and_place")
    shown = page.locator("[data-path]").evaluate_all("all => all.map(e => e.dataset.path)")
    assert "pick_and_place/PICK_BLOCK/OPEN_GRIPPER" in shown or len(shown) > 10
