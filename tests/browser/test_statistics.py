"""The statistics of many runs in the viewer."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from smachac.commands.cli import main
from smachac.driver import analyse_script
from smachac.verify.coverage import Coverage
from smachac.verify.statistics_page import statistics_html
from smachac.verify.trace_statistics import TraceStatistics
from tests.browser.pages import ROOT, SCREENSHOTS, Messages
from tests.browser.scripts import limited_script
from tests.browser.test_edit import serious

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.browser

SCRIPT = """\
name: sm
outcomes: [done, lost]
states:
  - A: {template: ScriptedState, outcomes: [ok, aborted], transitions: {ok: B, aborted: LATER}}
  - B:
      template: ScriptedState
      outcomes: [ok, constructor]
      transitions: {ok: done, constructor: lost}
  - LATER: {template: ScriptedState, outcomes: [ok], transitions: {ok: A}}
"""


def statistics_page(folder: Path, runs: int, lost: int) -> Path:
    """A page with the statistics of runs, of which some end with `lost`."""
    script, page = folder / "main.yml", folder / "main.html"
    script.write_text(SCRIPT)
    machine = analyse_script(script).checked
    assert machine is not None
    taken, statistics = Coverage(machine), TraceStatistics()
    for number in range(runs):
        last, end = ("constructor", "lost") if number < lost else ("ok", "done")
        for event in (
            {"event": "start", "path": "sm", "t": 0.0},
            {"event": "enter", "path": "sm/A", "t": 0.0},
            {"event": "exit", "path": "sm/A", "outcome": "ok", "t": 1.5},
            {"event": "transition", "path": "sm/A", "outcome": "ok", "to": "sm/B", "t": 1.5},
            {"event": "enter", "path": "sm/B", "t": 1.5},
            {"event": "exit", "path": "sm/B", "outcome": last, "t": 2.0},
            {"event": "transition", "path": "sm/B", "outcome": last, "to": f"sm:{end}", "t": 2.0},
            {"event": "finish", "path": "sm", "outcome": end, "t": 2.0},
        ):
            taken.record(event)
            statistics.record(event)
        statistics.end_trace()
    page.write_text(statistics_html(machine, statistics, taken), "utf-8")
    return page


def opened(browser: Browser, path: Path) -> tuple[Page, Messages]:
    page, messages = browser.new_page(viewport={"width": 1440, "height": 900}), Messages()
    messages.watch(page)
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready]")
    return page, messages


def never(page: Page) -> list[str | None]:
    found: list[str | None] = page.locator(".state.never").evaluate_all(
        "all => all.map(each => each.dataset.path)"
    )
    return found


def test_figures_are_at_states_and_transitions(browser: Browser, tmp_path: Path) -> None:
    page, messages = opened(browser, statistics_page(tmp_path, runs=4, lost=1))
    labels = page.locator(".label text").all_text_contents()
    assert sorted(labels) == sorted(
        ["ok 100 %", "aborted 0 %", "ok 75 %", "constructor 25 %", "ok"]
    )
    assert page.locator('[data-path="sm/A"] .visits').text_content() == "\u00d74 \u00b7 1.5 s"
    assert never(page) == ["sm/LATER"]
    assert page.locator(".line.never").count() == 2
    assert page.locator(".line.taken").count() == 4
    section = page.locator('[data-section="statistics"]')
    assert "3 of 5 transitions taken" in section.inner_text()
    assert "1 of the others follows a failure that was never exercised" in section.inner_text()
    assert "done\n3 (75 %)" in section.inner_text()
    page.evaluate((ROOT / "viewer/node_modules/axe-core/axe.min.js").read_text("utf-8"))
    assert serious(page) == []
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / "statistics.png")
    page.get_by_label("Transitions never taken").get_by_text("sm/LATER: ok").click()
    page.locator('.state.selected[data-path="sm/LATER"]').wait_for()
    assert "no run entered it" in section.inner_text()
    assert list(messages) == []


def test_an_outcome_that_objects_have_is_counted(browser: Browser, tmp_path: Path) -> None:
    """`constructor` is also a name that every object of the page has."""
    page, _ = opened(browser, statistics_page(tmp_path, runs=2, lost=0))
    assert "constructor 0 %" in page.locator(".label text").all_text_contents()
    assert page.locator(".line.never").count() == 3


WIDTH, HEIGHT = 1280, 800


def test_the_page_of_a_sweep_of_50_states_has_at_most_three_screens(
    browser: Browser, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    script, scenario, page_file = Path("big.yml"), Path("mock.yml"), Path("page.html")
    script.write_text(limited_script(2, 25), "utf-8")
    chances = {
        f"big/M{machine}/S{state}": {"outcome": {"ok": 0.9, "bad": 0.1}}
        for machine in range(2)
        for state in range(25)
    }
    scenario.write_text(json.dumps({"states": chances}), "utf-8")
    options = ["--runs", "40", "--jobs", "1", "--format", "html", "-o", str(page_file)]
    main(["sweep", str(script), "--mock", str(scenario), *options])
    for scheme in ("light", "dark"):
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT}, color_scheme=scheme)
        page.goto(page_file.resolve().as_uri())
        page.frame_locator("iframe").locator("html[data-ready]").wait_for()
        root = "document.documentElement"
        height, width = page.evaluate(f"[{root}.scrollHeight, {root}.scrollWidth]")
        assert height <= 3 * HEIGHT
        assert width <= WIDTH
        page.screenshot(path=SCREENSHOTS / f"sweep_{scheme}.png", full_page=True)
        page.close()
