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
from tests.browser.pages import ROOT, SCREENSHOTS
from tests.browser.test_edit import AXE, serious
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
        name = field.locator(".key").inner_text().split()[0]
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


SCRIPT = """\
name: sm
outcomes: [done, lost, stopped]
states:
  - LOOK:
      template: Camera
      transitions: {found: GRASP, nothing: lost}
  - GRASP:
      template: ScriptedState
      input_keys: [place]
      outcomes: [held, failed]
      timeout: 30 s
      retry: {on: [failed], max: 3}
      transitions: {held: done, exhausted: lost, timeout: lost, preempted: stopped}
"""

CAMERA = """\
kind: state
outcomes: {found: {}, nothing: {}}
output_keys:
  sure: {type: bool}
  count: {type: int}
  label: {type: str}
  place: {type: {name: str, at: "list[float]"}}
writes: {found: [sure, count, label, place]}
"""


@pytest.fixture
def view(tmp_path: Path, start: Callable[..., Viewed]) -> Viewed:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Camera.yml").write_text(CAMERA)
    (tmp_path / "main.yml").write_text(SCRIPT)
    return start("view", tmp_path / "main.yml", "--no-browser")


def test_keys_time_stops_and_steps_back(browser: Browser, view: Viewed, tmp_path: Path) -> None:
    page = opened(browser, view)
    messages = OwnMessages(view.url)
    messages.watch(page)
    page.evaluate(AXE.read_text("utf-8"))
    press(page, "Simulate the machine")
    here = section(page)
    here.get_by_label("Value of sure").select_option("false")
    here.get_by_label("Value of count").fill("three")
    press(page, "End with found")
    here.get_by_text("`count` is int: `three` does not fit").wait_for()
    here.get_by_label("Value of count").fill("3")
    here.get_by_label("Value of label").fill("no: 1")
    here.get_by_label("Value of place").fill("{name: box, at: [.nan, 2.5]}")
    page.screenshot(path=SCREENSHOTS / "simulation_keys.png")
    press(page, "End with found")
    wait_for_steps(page, 1)
    assert "Try 1 of 3 ends with:" in here.inner_text()
    press(page, "End with failed")
    wait_for_steps(page, 2)
    assert "Try 2 of 3 ends with:" in here.inner_text()
    assert "GRASP (try 2 of 3): choose an outcome" in page.locator(".run-status").inner_text()
    press(page, "time limit of GRASP in 30 s: let it pass")
    here.get_by_text("The machine has ended with lost.").wait_for()
    page.screenshot(path=SCREENSHOTS / "simulation_end.png")
    assert serious(page) == []
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("z")
    wait_for_steps(page, 2)
    here.locator("summary", has_text="more").click()
    here.get_by_label("A stop request arrives first").check()
    assert serious(page) == []
    press(page, "End with held")
    here.get_by_text("The machine has ended with stopped.").wait_for()
    press(page, "Save as a scenario")
    here.get_by_text("Written: ").wait_for()
    assert (tmp_path / "scenarios" / "stopped.yml").read_text().splitlines()[1:] == [
        "states:",
        '  sm/LOOK: {outcome: found, set: {sure: false, count: 3, label: "no: 1",'
        " place: {name: box, at: [.nan, 2.5]}}}",
        "  sm/GRASP:",
        "    - failed",
        "    - {stop: true, outcome: held}",
    ]
    press(page, "Back to the choice of LOOK, step 1")
    wait_for_steps(page, 0)
    here.locator("summary", has_text="more").click()
    here.get_by_label("Message of the error").fill("no camera")
    press(page, "Let it fail with an error")
    here.get_by_text("The machine has failed.").wait_for()
    assert "failed in LOOK: no camera" in page.locator(".run-status").inner_text()
    assert len(messages) == 1  # that the value of the wrong type was refused
    page.close()


def test_two_tabs_a_reload_and_an_edit(browser: Browser, view: Viewed, tmp_path: Path) -> None:
    first, second = opened(browser, view), opened(browser, view, color_scheme="dark")
    press(first, "Simulate the machine")
    press(first, "End with found")
    for page in (first, second):
        wait_for_steps(page, 1)
        page.locator(".state.waiting[data-path='sm/GRASP']").wait_for()
    press(second, "End with failed")
    for page in (first, second):
        wait_for_steps(page, 2)
    second.reload()
    second.wait_for_selector("html[data-ready]")
    wait_for_steps(second, 2)
    assert "Try 2 of 3 ends with:" in section(second).inner_text()
    second.screenshot(path=SCREENSHOTS / "simulation_dark.png")
    second.evaluate(AXE.read_text("utf-8"))
    assert serious(second) == []
    script = tmp_path / "main.yml"
    script.write_text(SCRIPT.replace("held", "grasped").replace("max: 3", "max: 4"))
    section(second).get_by_role("button", name="End with grasped", exact=True).wait_for()
    assert "Try 2 of 4 ends with:" in section(second).inner_text()
    script.write_text(SCRIPT.replace("failed", "slipped"))
    section(first).get_by_text("step 2 of 2, `sm/GRASP: failed`, does not fit").wait_for()
    wait_for_steps(first, 1)
    first.screenshot(path=SCREENSHOTS / "simulation_edit.png")
    script.write_text(SCRIPT.replace("LOOK", "SEARCH"))
    for page in (first, second):
        page.locator(".state.selected.waiting[data-path='sm/SEARCH']").wait_for()
        wait_for_steps(page, 0)
    script.write_text(SCRIPT)
    first.locator(".state.selected.waiting[data-path='sm/LOOK']").wait_for()
    press(first, "End with found")
    wait_for_steps(first, 1)
    script.write_text(SCRIPT.replace("held: done", "held: dne"))
    first.get_by_text("`dne` is neither a state nor an outcome").first.wait_for()
    press(first, "End with held")
    section(first).get_by_text("The machine has ended with done.").wait_for()
    press(first, "End the simulation")
    for page in (first, second):
        section(page).wait_for(state="detached")
        page.close()
