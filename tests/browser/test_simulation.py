"""The simulation in the viewer: a machine is played by clicks, saved, and played again."""

from __future__ import annotations

import json
import shlex
import shutil
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from smachac.commands.cli import main
from smachac.diagnostics.source import Source
from smachac.driver import analyse_script
from smachac.frontend.text.data_files import plain
from smachac.frontend.text.yaml_tree import parse
from smachac.interpreter.scenario import ScenarioStep, flow_text, read_scenario
from smachac.ir.written import written
from smachac.verify.scenarios import outcome_scenarios
from tests.browser.pages import ROOT
from tests.browser.test_live_view import OwnMessages
from tests.support.viewed import Viewed, starter

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

    from smachac.ir.nodes import Machine

pytestmark = pytest.mark.browser

EXAMPLES = ("03_concurrence", "07_iterator", "13_recovery", "14_delivery_round")


@pytest.fixture
def start() -> Iterator[Callable[..., Viewed]]:
    with starter() as start:
        yield start


def opened(browser: Browser, view: Viewed, **options: Any) -> Page:
    page = browser.new_page(viewport={"width": 1440, "height": 900}, **options)
    page.goto(view.url)
    page.wait_for_selector("html[data-ready]")
    return page


def press(page: Page, name: str) -> None:
    page.get_by_role("button", name=name, exact=True).click()


def section(page: Page) -> Locator:
    return page.locator("[data-section=simulate]")


def wait_for_steps(page: Page, count: int) -> None:
    """Wait until the page shows so many choices."""
    page.wait_for_function(
        "(count) => document.querySelectorAll('.simulate .steps li').length === count"
        " && document.querySelector('.simulate')",
        arg=count,
    )


class Plan:
    """The steps of a scenario, by the path of the state in the script."""

    def __init__(self, machine: Machine, text: str) -> None:
        tree = parse(Source("plan.yml", text), [])
        assert tree is not None
        scenario, problems = read_scenario(plain(tree), machine)
        assert problems == []
        view = written(machine)
        parts = view.parts
        self._steps = {
            view.state(full): steps
            for full, steps in scenario.steps.items()
            if parts[full].role == "state"
        }
        self._done: Counter[str] = Counter()

    def step(self, path: str) -> ScenarioStep:
        """The next step of a state."""
        steps = self._steps.get(path, (ScenarioStep(),))
        return steps[min(self._done[path], len(steps) - 1)]

    def take(self, path: str) -> ScenarioStep:
        step = self.step(path)
        self._done[path] += 1
        return step


def click_step(page: Page, path: str, step: ScenarioStep) -> None:
    """Choose a step of the state that waits."""
    here = section(page)
    is_selected = "(path) => document.querySelector('.state.selected')?.dataset.path === path"
    if not page.evaluate(is_selected, path):
        here.get_by_role("button", name=path.rpartition("/")[2], exact=True).last.click()
        page.wait_for_function(is_selected, arg=path)
    if step.stop:
        here.locator("summary", has_text="more").click()
        here.get_by_label("A stop request arrives first").check()
    if step.wait:
        here.get_by_title("Let time pass").click()
        return
    ends = here.locator(".ending")
    end = page.get_by_role("button", name=f"End with {step.outcome}", exact=True)
    ending = ends.filter(has=end)
    if step.outcome is None or not ending.count():
        ending = ends.first  # the usual outcome; that of a state with a stop request
    writes = dict(step.writes)
    for field in ending.locator(".key-field").all():
        name = field.locator(".key").inner_text()
        if name in writes:
            value = writes[name]
            text = value if isinstance(value, str) else flow_text(value)
            field.locator("input[type=text]").fill(text)
        else:
            field.get_by_role("checkbox").uncheck()
    ending.get_by_role("button").click()


def play(page: Page, plan: Plan) -> int:
    """Choose the steps of a plan until the machine ends; their number."""
    count = 0
    press(page, "Simulate the machine")
    while True:
        wait_for_steps(page, count)
        section(page).locator(".ending, form").first.wait_for()
        page.wait_for_selector("svg.picture:not([aria-busy])")
        waiting = page.evaluate(WAITING)
        if not waiting:
            return count
        path = next((path for path in waiting if plan.step(path).wait), waiting[0])
        click_step(page, path, plan.take(path))
        count += 1


WAITING = """() => [...document.querySelectorAll(".state.leaf.waiting")]
  .map((each) => each.dataset.path)"""


def simulated(view: Viewed) -> Any:
    """The last message of the simulation."""
    view.reopen()
    return view.until(lambda each: each["kind"] == "simulation")


@pytest.mark.parametrize("name", EXAMPLES)
def test_each_outcome_is_reached_by_clicks_saved_and_played(
    name: str,
    browser: Browser,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    start: Callable[..., Viewed],
    capsys: pytest.CaptureFixture[str],
) -> None:
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    (tmp_path / ".git").mkdir()  # the folder of the project
    monkeypatch.chdir(tmp_path / "examples" / name)
    machine = analyse_script(Path("main.yml")).checked
    assert machine is not None
    outcomes = [outcome.name for outcome in machine.root.outcomes]
    plans = outcome_scenarios(machine, "main.yml", outcomes)
    assert sorted(plans) == sorted(outcomes)
    view = start("view", "main.yml", "--no-browser")
    page = opened(browser, view)
    messages = OwnMessages(view.url)
    messages.watch(page)
    for outcome, text in plans.items():
        play(page, Plan(machine, text))
        assert f"The machine has ended with {outcome}." in section(page).inner_text()
        press(page, "Save as a scenario")
        section(page).get_by_text("Written: ").wait_for()
        saved = Path("scenarios", f"{outcome}.yml")
        first = saved.read_bytes()
        events = simulated(view)["events"]
        words = shlex.split(first.decode().splitlines()[0].removeprefix("# "))
        assert words[:4] == ["smachac", "run", "main.yml", "--mock"]
        capsys.readouterr()
        assert main([*words[1:], "-q", "--trace", "run.jsonl"]) == 0
        assert [json.loads(line) for line in Path("run.jsonl").read_text().splitlines()] == events
        press(page, "Save as a scenario")
        assert saved.read_bytes() == first
        press(page, "End the simulation")
        page.get_by_role("button", name="Simulate the machine", disabled=False).wait_for()
    assert list(messages) == []
    page.close()
