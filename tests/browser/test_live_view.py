"""Runs in the viewer: live, controlled, replayed; scripts that are edited while they are shown."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from smachac.commands.cli import main
from tests.browser.pages import ROOT, SCREENSHOTS, Messages
from tests.support.viewed import Viewed, starter

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.browser

PICK_AND_PLACE = ROOT / "examples" / "08_pick_and_place" / "main.yml"
ROOT_STATE = "pick_and_place"
PICK = f"{ROOT_STATE}/PICK_BLOCK"


class OwnMessages(Messages):
    """As Messages; a page that a server serves may load from this server."""

    def __init__(self, url: str) -> None:
        super().__init__()
        self._own = url.partition("#")[0]

    def _request(self, request: object) -> None:
        if not str(getattr(request, "url", "")).startswith(self._own):
            super()._request(request)  # type: ignore[arg-type]


@pytest.fixture
def start() -> Iterator[Callable[..., Viewed]]:
    with starter() as start:
        yield start


@pytest.fixture
def opened(browser: Browser) -> Iterator[Callable[[str], Page]]:
    """Opens pages, which must report nothing."""
    watched: list[Messages] = []

    def open_page(url: str) -> Page:
        page = browser.new_page(viewport={"width": 1440, "height": 900})
        watched.append(OwnMessages(url))
        watched[-1].watch(page)
        page.goto(url)
        page.wait_for_selector("html[data-ready]")
        return page

    yield open_page
    assert [list(each) for each in watched] == [[] for _ in watched]


def shoot(page: Page, name: str) -> None:
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / f"{name}.png")


def state(path: str, mark: str) -> str:
    """The selector of a state of the picture with a mark."""
    return f'.state.{mark}[data-path="{path}"]'


def press(page: Page, name: str) -> None:
    page.get_by_role("button", name=name, exact=True).click()


@pytest.fixture
def scenario(tmp_path: Path) -> Path:
    """All states of pick and place succeed."""
    path = tmp_path / "scenario.yml"
    path.write_text("states: {}\n")
    return path


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "main.yml"
    path.write_text(LINE)
    return path


LINE = """\
name: sm
outcomes: [done, failed]
states:
  - A:
      template: ScriptedState
      outcomes: [ok, bad]
      transitions: {ok: BOTH, bad: failed}
  - BOTH:
      template: Concurrence
      outcomes: [done, failed]
      default_outcome: failed
      outcome_map: {done: {LEFT: ok, RIGHT: ok}}
      transitions: {done: C, failed: failed}
      states:
        - LEFT:
            template: ScriptedState
            outcomes: [ok, bad]
        - RIGHT:
            template: ScriptedState
            outcomes: [ok, bad]
  - C:
      template: ScriptedState
      outcomes: [ok, bad]
      transitions: {ok: done, bad: failed}
"""
"""A, then LEFT and RIGHT in parallel, then C."""


def test_a_run_is_watched_step_by_step(
    script: Path, start: Callable[..., Viewed], opened: Callable[[str], Page]
) -> None:
    page = opened(start("run", script, "--view", "--view-paused", "-q").url)
    assert "token" not in page.url
    page.wait_for_selector(state("sm/A", "waiting"))
    press(page, "Step")
    page.wait_for_selector(state("sm/BOTH", "waiting"))
    press(page, "Step")
    page.wait_for_selector(state("sm/BOTH/LEFT", "waiting"))
    page.wait_for_selector(state("sm/BOTH/RIGHT", "waiting"))
    shoot(page, "live_branches")
    page.locator('[data-path="sm/BOTH/RIGHT"]').click()
    press(page, "End with bad")
    press(page, "Step")
    page.wait_for_selector("text=ended with failed")
    assert page.locator(".log li", has_text="RIGHT ends with bad (forced)").count() == 1
    shoot(page, "live_end")


TRIES = """\
name: sm
outcomes: [done, failed]
states:
  - DRIVE:
      template: ScriptedState
      outcomes: [ok, bad]
      steps: [{outcome: bad}, {outcome: bad}, {outcome: ok}]
      timeout: 5 min
      retry: {on: [bad], max: 4}
      transitions: {ok: done, timeout: failed, exhausted: failed, preempted: failed}
"""


def test_a_state_with_tries_is_one_box_that_waits_before_each_try(
    script: Path, start: Callable[..., Viewed], opened: Callable[[str], Page]
) -> None:
    script.write_text(TRIES)
    page = opened(start("run", script, "--view", "--view-paused", "-q").url)
    page.wait_for_selector(state("sm/DRIVE", "waiting"))
    assert page.locator("g.state").count() == 2
    page.locator('[data-path="sm/DRIVE"] > .body').click()
    page.get_by_label("Pause before each try").check()
    press(page, "Run this state")
    page.wait_for_selector("text=paused before a try of DRIVE")
    press(page, "Run this state")
    page.wait_for_selector("text=DRIVE: try 1 ends with bad")
    page.wait_for_selector("text=paused before a try of DRIVE")
    assert page.locator('[data-path="sm/DRIVE"] > .visits').text_content() == "try 1 of 4"
    shoot(page, "live_tries")
    press(page, "End with timeout")
    page.wait_for_selector("text=ended with failed")
    log = page.locator(".log li").all_inner_texts()
    assert not any("TIMER" in line or "(retry)" in line for line in log)


def test_pick_and_place_shows_its_active_state_and_stops_at_a_breakpoint(
    start: Callable[..., Viewed], opened: Callable[[str], Page]
) -> None:
    page = opened(start("run", PICK_AND_PLACE, "--view", "--view-paused", "-q").url)
    page.wait_for_selector(state(f"{ROOT_STATE}/LOAD_TABLE", "waiting"))
    page.get_by_placeholder("Search").fill("LIFT")
    page.keyboard.press("Enter")
    page.get_by_label("Pause before it starts").check()
    page.wait_for_selector(state(f"{PICK}/LIFT", "breakpoint"))
    press(page, "Resume")
    page.wait_for_selector(state(f"{PICK}/LIFT", "waiting"))
    assert page.locator(".run-status").inner_text() == "paused before LIFT"
    assert page.locator(".values th").count() > 3
    shoot(page, "live_breakpoint")
    page.get_by_label("Pause before it starts").uncheck()
    page.wait_for_selector(state(f"{PICK}/LIFT", "waiting") + ":not(.breakpoint)")
    press(page, "Run this state")
    page.wait_for_selector(state(f"{PICK}/CHECK_GRASP", "waiting"))
    press(page, "Stop the run")
    page.wait_for_selector("text=ended with")
    shoot(page, "live_stopped")


def recorded(script: Path, folder: Path) -> Path:
    trace = folder / "run.jsonl"
    assert main(["run", str(script), "-q", "--trace", str(trace)]) == 0
    return trace


def test_a_replay_goes_to_its_end(
    script: Path, tmp_path: Path, opened: Callable[[str], Page]
) -> None:
    option = f"trace={recorded(script, tmp_path)}"
    words = ["build", script, "-t", "html", "-o", tmp_path, "--option", option]
    assert main([*map(str, words)]) == 0
    page = opened((tmp_path / "sm.html").as_uri())
    page.wait_for_selector("text=ended with done")
    assert not page.get_by_role("button", name="Step", exact=True).is_visible()
    press(page, "First event")
    page.wait_for_selector("text=not started")
    press(page, "Next event")
    press(page, "Next event")
    page.wait_for_selector(state("sm/A", "active"))
    shoot(page, "replay_start")
    page.get_by_role("slider").fill("10")
    page.get_by_label("Speed").select_option("64")
    press(page, "Play")
    page.wait_for_selector("text=ended with done")
    assert page.locator(".line.taken").count() > 4


def test_a_trace_is_followed_while_it_grows(
    script: Path, tmp_path: Path, start: Callable[..., Viewed], opened: Callable[[str], Page]
) -> None:
    lines = recorded(script, tmp_path).read_text().splitlines(keepends=True)
    trace = tmp_path / "growing.jsonl"
    trace.write_text("".join(lines[:2]))
    page = opened(start("view", script, "--attach", trace, "--no-browser").url)
    page.wait_for_selector(state("sm/A", "active"))
    with trace.open("a") as stream:
        stream.write("".join(lines[2:]))
    page.wait_for_selector("text=ended with done")


def test_the_picture_changes_with_the_script(
    script: Path, start: Callable[..., Viewed], opened: Callable[[str], Page]
) -> None:
    page = opened(start("view", script, "--no-browser").url)
    page.wait_for_selector('[data-path="sm/C"]')
    script.write_text(LINE.replace("ok: done, bad: failed}", "ok: nowhere, bad: failed}"))
    page.wait_for_selector("text=SM101")
    assert page.locator('[data-path="sm/C"]').count() == 1
    notice = page.locator(".notice").first
    assert not notice.locator(".help").first.is_visible()
    notice.locator("summary").click()
    assert "help: " in notice.locator(".help").first.inner_text()
    shoot(page, "live_broken")
    below, picture = notice.bounding_box(), page.locator("svg.picture").bounding_box()
    assert below is not None
    assert picture is not None
    assert below["y"] >= picture["y"] + picture["height"] - 1
    script.write_text(LINE.replace("- C:", "- LAST:").replace("done: C,", "done: LAST,"))
    page.wait_for_selector('[data-path="sm/LAST"]')
    page.wait_for_selector("text=SM101", state="detached")


def test_ten_thousand_events_a_second_do_not_freeze_the_page(
    script: Path, tmp_path: Path, start: Callable[..., Viewed], opened: Callable[[str], Page]
) -> None:
    """The page answers between the parts of a trace of 100,000 events."""
    trace = tmp_path / "growing.jsonl"
    trace.write_text("")
    page = opened(start("view", script, "--attach", trace, "--no-browser").url)
    kinds = [("enter", {}), ("exit", {"outcome": "ok"})]
    with trace.open("a") as stream:
        stream.write(json.dumps({"event": "start", "path": "sm", "t": 0.0}) + "\n")
        for part in range(10):
            for number in range(5_000):
                for kind, more in kinds:
                    event = {"event": kind, "path": "sm/A", "t": part + number / 5_000, **more}
                    stream.write(json.dumps(event) + "\n")
            stream.flush()
            assert page.evaluate("1 + 1") == 2
    page.wait_for_selector("text=event 100001 of 100001")
    page.locator('[data-path="sm/A"]').click()
    page.wait_for_selector("text=50000 of 50000")


def test_markup_in_values_and_names_is_shown_as_text(
    script: Path, tmp_path: Path, start: Callable[..., Viewed], opened: Callable[[str], Page]
) -> None:
    markup = "<img src=x onerror=alert(1)>"
    trace = tmp_path / "run.jsonl"
    events = [
        {"event": "start", "path": "sm", "t": 0.0},
        {"event": "enter", "path": f"sm/{markup}", "t": 0.0},
        {"event": "write", "path": "sm/A", "key": markup, "value": {markup: markup}, "t": 0.0},
        {"event": "error", "path": "sm/A", "message": markup, "t": 0.0},
    ]
    trace.write_text("".join(json.dumps(event) + "\n" for event in events))
    page = opened(start("view", script, "--attach", trace, "--no-browser").url)
    page.wait_for_selector(".values th")
    assert page.locator("img").count() == 0
    assert markup in page.locator(".values").inner_text()
    assert markup in page.locator(".log").inner_text()


def test_without_the_token_a_page_only_shows(
    script: Path, start: Callable[..., Viewed], opened: Callable[[str], Page]
) -> None:
    view = start("run", script, "--view", "--view-paused", "-q")
    page = opened(view.url.partition("#")[0])
    page.wait_for_selector(state("sm/A", "waiting"))
    assert page.get_by_role("button", name="Step", exact=True).count() == 0
    assert view.act(action="stop") == 200


def test_a_trace_of_another_machine_is_named(
    start: Callable[..., Viewed], opened: Callable[[str], Page], tmp_path: Path
) -> None:
    trace = tmp_path / "run.jsonl"
    events = [{"event": "start", "path": "other", "t": 0.0}]
    trace.write_text("".join(f"{json.dumps(event)}\n" for event in events))
    page = opened(start("view", PICK_AND_PLACE, "--attach", trace, "--no-browser").url)
    expected = f"This is the trace of the machine other, not of {ROOT_STATE}."
    page.locator(".run-foreign", has_text=expected).wait_for()
