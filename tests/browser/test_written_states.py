"""The boxes of the page are the states that are written."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from smachac.diagnostics.source import NOWHERE
from smachac.driver import analyse_script
from smachac.ir.nodes import Machine, StateMachine
from smachac.ir.written import written
from smachac.targets.html.model import machine_model
from smachac.targets.html.page import render_page
from tests.browser.pages import ROOT, SCREENSHOTS, Messages
from tests.support.examples import seeds
from tests.support.sugared_scripts import random_script

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Page

pytestmark = pytest.mark.browser

EXAMPLES = sorted((ROOT / "examples").glob("[0-9]*/main.yml"))
DELIVERY = ROOT / "examples" / "14_delivery_round" / "main.yml"

BOXES = """() => [...document.querySelectorAll("svg.picture g.state")].map((state) =>
  [state.dataset.path, state.querySelector(":scope > .name, :scope > .title").textContent])"""

TOGETHER = 60
"""The random machines on one page: most of the time of a page is its start."""


@pytest.fixture
def messages() -> Messages:
    return Messages()


def together(machines: dict[str, Machine]) -> Machine:
    """A machine with the states of several ones, each in a state with its name here."""
    children = tuple(
        replace(machine.root, name=name, transitions=()) for name, machine in machines.items()
    )
    return Machine(root=StateMachine(type="", name="all", children=children, span=NOWHERE))


def opened(browser: Browser, machine: Machine, folder: Path, messages: Messages) -> Page:
    """The page of a machine with all containers open."""
    path = folder / "page.html"
    path.write_text(render_page(machine, machine_model(machine)), "utf-8")
    page = browser.new_page(viewport={"width": 1440, "height": 900})
    messages.watch(page)
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready]")
    page.get_by_role("button", name="Open all").click()
    page.wait_for_selector("svg.picture:not([aria-busy])")
    return page


def assert_boxes_are(page: Page, states: dict[str, str], messages: Messages) -> None:
    """The boxes on the page are these states, names by path."""
    boxes = page.evaluate(BOXES)
    assert len(boxes) == len(states)
    assert dict(boxes) == states
    assert messages == []


def test_each_state_of_an_example_is_one_box(
    browser: Browser, tmp_path: Path, messages: Messages
) -> None:
    machines = {}
    for path in EXAMPLES:
        machine = analyse_script(path).machine
        assert machine is not None
        machines[path.parent.name] = machine
    machine = together(machines)
    states = {path: state.name for path, state in written(machine).states.items()}
    page = opened(browser, machine, tmp_path, messages)
    assert_boxes_are(page, states, messages)
    assert not {"TIMER", "PAUSE"} & set(states.values())
    page.close()


@pytest.mark.parametrize("part", seeds(1, 1, 300 // TOGETHER))
def test_each_state_of_a_random_script_is_one_box(
    browser: Browser, tmp_path: Path, messages: Messages, part: int
) -> None:
    scripts = {
        f"S{seed}": random_script(seed) for seed in range(part * TOGETHER, (part + 1) * TOGETHER)
    }
    states = {"all": "all"}
    for name, script in scripts.items():
        for path in script.states:  # those that were written, not those of the view
            here = path.replace("sm", f"all/{name}", 1)
            states[here] = here.rpartition("/")[2]
    machine = together({name: script.machine() for name, script in scripts.items()})
    page = opened(browser, machine, tmp_path, messages)
    assert_boxes_are(page, states, messages)
    page.close()


def test_a_state_has_its_badges_and_is_found_once(
    browser: Browser, tmp_path: Path, messages: Messages
) -> None:
    machine = analyse_script(DELIVERY).machine
    assert machine is not None
    page = opened(browser, machine, tmp_path, messages)
    box = page.locator("[data-path='delivery_round/VISIT_ROOMS/DRIVE']")
    assert box.locator(".chip").all_text_contents() == ["limit 5 min", "3 tries"]
    exits = page.locator("[data-of='delivery_round/VISIT_ROOMS'] text").all_text_contents()
    assert exits == ["visited \N{RIGHTWARDS ARROW} next item", "stuck", "preempted"]
    page.keyboard.press("/")
    page.keyboard.type("GO_HOME")
    assert page.locator("#hits [role=option]").count() == 1
    page.keyboard.press("Enter")
    panel = page.locator("aside")
    assert "3 tries: the next one after blocked" in panel.inner_text()
    page.screenshot(path=SCREENSHOTS / "written_states.png")
    assert messages == []
    page.close()
