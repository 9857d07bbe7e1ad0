"""The page of `diff --format html`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from smachac.diff.comparison import compare
from smachac.diff.page import render_difference_page
from smachac.driver import analyse_script
from tests.browser.pages import ROOT, SCREENSHOTS, Messages
from tests.browser.test_edit import serious

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.browser

BEFORE = """\
name: sm
outcomes: [done, failed]
states:
  - A: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: OLD, bad: failed}}
  - OLD: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: C, bad: failed}}
  - C: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: done, bad: failed}}
"""

AFTER = """\
name: sm
outcomes: [done, failed]
states:
  - A: {template: ScriptedState, outcomes: [ok, bad], transitions: {ok: NEW, bad: failed}}
  - NEW: {template: SleepState, time: 1.0, transitions: {succeeded: C, preempted: failed}}
  - C:
      template: ScriptedState
      doc: <b>new</b>
      outcomes: [ok, bad]
      transitions: {ok: done, bad: A}
"""


def states(page: Page, change: str) -> list[str]:
    found: list[str] = page.locator(f".state.{change}").evaluate_all(
        "all => all.map(each => each.dataset.path)"
    )
    return found


def difference_page(folder: Path, before: str, after: str) -> Path:
    """The page of the differences of two scripts."""
    analyses = []
    for name, text in (("old.yml", before), ("new.yml", after)):
        (folder / name).write_text(text)
        analyses.append(analyse_script(folder / name))
    machine = analyses[1].machine
    assert machine is not None
    path = folder / "diff.html"
    path.write_text(render_difference_page(compare(*analyses), machine), "utf-8")
    return path


@pytest.mark.parametrize("colours", ["light", "dark"])
def test_both_machines_are_one_picture(browser: Browser, tmp_path: Path, colours: str) -> None:
    path = difference_page(tmp_path, BEFORE, AFTER)
    page, messages = browser.new_page(viewport={"width": 1440, "height": 900}), Messages()
    messages.watch(page)
    page.emulate_media(color_scheme=colours)  # type: ignore[arg-type]
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready]")
    page.evaluate("theme => document.documentElement.dataset.theme = theme", colours)
    assert states(page, "added") == ["sm/NEW"]
    assert states(page, "removed") == ["sm/OLD (removed)"]
    assert states(page, "changed") == ["sm/C"]
    assert page.locator(".state .sign").count() == 3
    label = page.locator('[data-path="sm/NEW"]').get_attribute("aria-label")
    assert label is not None
    assert label.endswith("; added")
    labels = page.locator(".label text").all_text_contents()
    assert {"+ ok", "\u2212 ok", "+ bad"} <= set(labels)
    section = page.locator('[data-section="differences"]')
    assert "1 state added, 1 state removed" in section.inner_text()
    assert "<b>new</b>" in section.inner_text()
    page.evaluate((ROOT / "viewer/node_modules/axe-core/axe.min.js").read_text("utf-8"))
    assert serious(page) == []
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / f"differences_{colours}.png")
    changes = page.get_by_label("All differences")
    changes.get_by_role("button", name="sm/OLD (removed)").first.click()
    page.locator('.state.selected[data-path="sm/OLD (removed)"]').wait_for()
    assert "- state sm/OLD" in section.inner_text()
    assert list(messages) == []


CONCURRENCE = """\
name: sm
outcomes: [done, failed]
states:
  - BOTH:
      template: Concurrence
      outcomes: [all, none]
      default_outcome: none
      outcome_map: {all: {A: ok, B: ok, C: ok}}
      transitions: {all: done, none: failed}
      states:
        - A: {template: ScriptedState, outcomes: [ok, bad]}
        - B: {template: ScriptedState, outcomes: [ok, bad]}
        - C: {template: ScriptedState, outcomes: [ok, bad]}
"""


def joins(page: Page) -> list[str]:
    found: list[str] = page.locator(".piece.join").evaluate_all(
        "all => all.map(each => each.getAttribute('class').split(' ')[2])"
    )
    return found


def test_rules_are_bars(browser: Browser, tmp_path: Path) -> None:
    """One bar for a rule of both machines; one for each where its conditions differ."""
    page, messages = browser.new_page(viewport={"width": 1440, "height": 900}), Messages()
    messages.watch(page)
    fewer = CONCURRENCE.replace("B: ok, C: ok}", "B: ok}")
    for after, bars in ((CONCURRENCE, ["same"]), (fewer, ["added", "removed"])):
        page.goto(difference_page(tmp_path, CONCURRENCE, after).as_uri())
        page.wait_for_selector("html[data-ready]")
        assert joins(page) == bars
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / "differences_of_rules.png")
    lines = page.locator(".line.removed")
    assert lines.count() == 4, "three conditions and the outcome of the former rule"
    assert page.locator(".line.added").count() == 3
    assert list(messages) == []


BOXED = """\
name: m
outcomes: [done]
states:
- BOX:
    template: StateMachine
    outcomes: [done]
    transitions: {done: done}
    states:
    - A: {template: CallbacksState, transitions: {succeeded: B}}
    - B: {template: CallbacksState, transitions: {succeeded: done}}
"""
FLAT = """\
name: m
outcomes: [done]
states:
- A: {template: CallbacksState, transitions: {succeeded: B}}
- B: {template: CallbacksState, transitions: {succeeded: done}}
"""


@pytest.mark.parametrize(("before", "after"), [(FLAT, BOXED), (BOXED, FLAT)])
def test_states_that_moved_between_levels(
    browser: Browser, tmp_path: Path, before: str, after: str
) -> None:
    """The lines of the other version cross the border of the container: they are drawn straight."""
    page, messages = browser.new_page(viewport={"width": 1440, "height": 900}), Messages()
    messages.watch(page)
    page.goto(difference_page(tmp_path, before, after).as_uri())
    page.wait_for_selector("html[data-ready]")
    page.get_by_role("button", name="Open all").click()
    page.wait_for_selector("svg.picture:not([aria-busy])")
    assert page.locator("g.state").count() == 4
    drawn = page.locator("g.line path.stroke").evaluate_all(
        "all => all.map(each => each.getAttribute('d')).filter(d => d.includes('L')).length"
    )
    model = json.loads(page.locator("#smachac-model").text_content() or "")
    assert drawn == len(model["edges"])
    page.get_by_role("button", name="Close all").click()
    page.wait_for_selector("svg.picture:not([aria-busy])")
    assert list(messages) == []
