"""The film of a run beside its trace, in step with the time line."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from smachac.sim.video import RATE, Gif, Mp4, Writer
from tests.browser.pages import SCREENSHOTS
from tests.browser.test_live_view import OwnMessages
from tests.support.viewed import Viewed, starter

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.browser

SCRIPT = """\
name: sm
outcomes: [done]
states:
  - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: B}}
  - B: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}
"""

EVENTS = [
    {"event": "start", "path": "sm", "t": 0.0},
    {"event": "enter", "path": "sm/A", "t": 0.0},
    {"event": "exit", "path": "sm/A", "outcome": "ok", "t": 1.0},
    {"event": "transition", "path": "sm/A", "outcome": "ok", "to": "sm/B", "t": 1.0},
    {"event": "enter", "path": "sm/B", "t": 1.0},
    {"event": "exit", "path": "sm/B", "outcome": "ok", "t": 2.0},
    {"event": "transition", "path": "sm/B", "outcome": "ok", "to": "sm:done", "t": 2.0},
    {"event": "finish", "path": "sm", "outcome": "done", "t": 2.0},
]

RED, BLUE = (220, 20, 20), (20, 20, 220)

MIDDLE = """element => {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 1;
  const context = canvas.getContext("2d");
  context.drawImage(element, 0, 0, 1, 1);
  const [red, , blue] = context.getImageData(0, 0, 1, 1).data;
  return red > blue ? "red" : "blue";
}"""
"""The colour of a canvas or a video."""


@pytest.fixture
def start() -> Iterator[Callable[..., Viewed]]:
    with starter() as start:
        yield start


def make_film(path: Path) -> None:
    """A film of two seconds: red in the first one, blue from then on."""
    from PIL import Image

    makers: dict[str, Callable[[Path], Writer]] = {".gif": Gif, ".mp4": Mp4}
    writer = makers[path.suffix](path)
    for index in range(2 * RATE + 1):
        writer.add(Image.new("RGB", writer.size, RED if index < RATE else BLUE))
    writer.close()


def colour(page: Page, frame: int) -> str:
    """The colour of the film when it shows a frame."""
    page.locator(f'.film[data-frame="{frame}"]').wait_for()
    found: str = page.locator(".film canvas, .film video").evaluate(MIDDLE)
    return found


@pytest.mark.parametrize("name", ["film.gif", "film.mp4"])
def test_the_film_is_in_step_with_the_time_line(
    browser: Browser, tmp_path: Path, start: Callable[..., Viewed], name: str
) -> None:
    script, trace, film = tmp_path / "main.yml", tmp_path / "run.jsonl", tmp_path / name
    script.write_text(SCRIPT)
    trace.write_text("".join(f"{json.dumps(event)}\n" for event in EVENTS))
    make_film(film)
    url = start("view", script, "--attach", trace, "--film", film, "--no-browser").url
    page = browser.new_page(viewport={"width": 1440, "height": 900})
    messages = OwnMessages(url)
    messages.watch(page)
    page.goto(url)
    page.wait_for_selector("html[data-ready]")
    assert colour(page, 2 * RATE) == "blue"
    page.get_by_role("button", name="First event").click()
    assert colour(page, 0) == "red"
    slider = page.get_by_label("Position in the run")
    slider.fill("5")
    assert colour(page, RATE) == "blue"
    page.locator("text=Film at 1.0 s").wait_for()
    page.locator('.state.active[data-path="sm/B"]').wait_for()
    slider.fill("2")
    assert colour(page, 0) == "red"
    page.get_by_role("button", name="Play", exact=True).click()
    assert colour(page, 2 * RATE) == "blue"
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / f"film_{film.suffix[1:]}.png")
    assert list(messages) == []


def test_a_film_that_cannot_be_read_is_named(
    browser: Browser, tmp_path: Path, start: Callable[..., Viewed]
) -> None:
    """The browser reports the failure to the console too: this page may report."""
    script, trace, film = tmp_path / "main.yml", tmp_path / "run.jsonl", tmp_path / "film.mp4"
    script.write_text(SCRIPT)
    trace.write_text("".join(f"{json.dumps(event)}\n" for event in EVENTS))
    film.write_bytes(b"\0\0\0\x20ftypisom" + b"\0" * 100)
    page = browser.new_page()
    page.goto(start("view", script, "--attach", trace, "--film", film, "--no-browser").url)
    reason = page.locator(".film figcaption", has_text="The film cannot be shown")
    reason.wait_for()
    page.get_by_role("button", name="First event").click()
    page.locator("text=event 0 of 8").wait_for()
    assert reason.count() == 1
