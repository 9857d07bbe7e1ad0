"""Edits in the viewer: each with the script that it writes, undone by a key."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from tests.browser.pages import ROOT, SCREENSHOTS
from tests.browser.test_live_view import OwnMessages
from tests.support.viewed import Viewed, starter

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page, Route

pytestmark = pytest.mark.browser

AXE = ROOT / "viewer/node_modules/axe-core/axe.min.js"

SCRIPT = """\
# The line.
name: sm
outcomes: [done, failed]
states:
  - A:  # the first
      template: ScriptedState
      outcomes: [ok, bad]
      transitions: {ok: B, bad: failed}  # and then
  - B:
      template: ScriptedState
      outcomes: [ok, bad]
      transitions: {ok: C, bad: failed}

  # The last.
  - C:
      template: ScriptedState
      outcomes: [ok, bad]
      transitions: {ok: done, bad: failed}
"""


@pytest.fixture
def start() -> Iterator[Callable[..., Viewed]]:
    with starter() as start:
        yield start


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "main.yml"
    path.write_text(SCRIPT)
    return path


@pytest.fixture(params=["stream", "no stream"])
def page(
    request: pytest.FixtureRequest, browser: Browser, script: Path, start: Callable[..., Viewed]
) -> Iterator[Page]:
    """The page of the script with the token, which must report nothing. "no stream": no message of
    the server ever arrives, so that the answers to the edits are all that the page has."""
    url = start("view", script, "--no-browser").url
    page = browser.new_page(viewport={"width": 1440, "height": 900})
    if request.param == "no stream":
        page.route("**/events", lambda route: None)
    messages = OwnMessages(url)
    messages.watch(page)
    page.goto(url)
    page.wait_for_selector("html[data-ready]")
    page.locator("form.edit select").first.wait_for()
    yield page
    assert list(messages) == []


def choose(page: Page, path: str, operation: str) -> Locator:
    """Select a state and a form of it."""
    page.locator(f'.state[data-path="{path}"]').click()
    page.locator(f'.state.selected[data-path="{path}"]').wait_for()
    form = page.locator("form.edit")
    form.get_by_label("Operation", exact=True).select_option(operation)
    return form


def apply(page: Page, script: Path) -> str:
    """Preview and apply; the script afterwards."""
    before = script.read_text()
    press(page, "Preview")
    page.get_by_label("Change of the script").wait_for()
    assert script.read_text() == before
    press(page, "Apply")
    page.wait_for_selector("text=Written: ")
    return script.read_text()


def press(page: Page, name: str) -> None:
    page.get_by_role("button", name=name, exact=True).click()


def undo(page: Page, script: Path) -> None:
    """Undo by the key, and compare with the script at first."""
    page.keyboard.press("u")
    page.wait_for_selector("text=Undone: ")
    assert script.read_text() == SCRIPT


def shoot(page: Page, name: str) -> None:
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / f"{name}.png")


def test_a_state_is_renamed_and_stays_selected(page: Page, script: Path) -> None:
    form = choose(page, "sm/B", "Rename")
    form.get_by_label("New name").fill("MIDDLE")
    expected = SCRIPT.replace("- B:", "- MIDDLE:").replace("ok: B,", "ok: MIDDLE,")
    assert apply(page, script) == expected
    page.locator('.state.selected[data-path="sm/MIDDLE"]').wait_for()
    assert page.locator('.state[data-path="sm/B"]').count() == 0
    assert page.get_by_role("complementary").locator("h2").inner_text() == "MIDDLE"
    undo(page, script)
    page.locator('.state.selected[data-path="sm/B"]').wait_for()


def test_a_transition_is_moved_and_removed(page: Page, script: Path) -> None:
    form = choose(page, "sm/A", "Change a transition")
    form.get_by_label("Outcome").select_option("ok")
    assert form.get_by_label("Leads to").input_value() == "B"
    form.get_by_label("Leads to").select_option("C")
    press(page, "Preview")
    added = page.locator("h4", has_text="New findings")
    added.wait_for()
    assert "`B`" in page.locator("form.edit .findings").inner_text()
    shoot(page, "edit_preview")
    assert apply(page, script) == SCRIPT.replace("{ok: B,", "{ok: C,")
    page.locator('.state.selected[data-path="sm/A"]').wait_for()
    undo(page, script)
    form = choose(page, "sm/A", "Change a transition")
    form.get_by_label("Outcome").select_option("bad")
    form.get_by_label("Leads to").select_option("(no transition)")
    assert apply(page, script) == SCRIPT.replace("{ok: B, bad: failed}", "{ok: B}")
    undo(page, script)


def test_a_state_is_added_from_the_library(page: Page, script: Path) -> None:
    form = choose(page, "sm/A", "Add a state behind it")
    form.get_by_label("Name of the new state").fill("PAUSE")
    form.get_by_label("State type").select_option("SleepState")
    form.get_by_label("Outcome that leads to it").select_option("(none yet)")
    assert form.locator("p.help").inner_text() != ""
    offered = form.get_by_label("State type").locator("option").all_text_contents()
    assert "GripperState" in offered
    assert not {"Utils", "Program", "MsgPublisher"} & set(offered)
    assert form.get_by_label("State type").locator("optgroup").count() >= 1
    lines = """\

  - PAUSE:
      template: SleepState
      time: 0.0
      transitions: {succeeded: done}
"""
    assert apply(page, script) == SCRIPT.replace("  - B:", f"{lines}  - B:")
    page.locator('.state.selected[data-path="sm/PAUSE"]').wait_for()
    undo(page, script)
    page.locator('.state[data-path="sm/PAUSE"]').wait_for(state="detached")


def test_an_outcome_leads_to_the_added_state(page: Page, script: Path) -> None:
    form = choose(page, "sm/A", "Add a state behind it")
    form.get_by_label("Name of the new state").fill("PAUSE")
    form.get_by_label("State type").select_option("SleepState")
    form.get_by_label("Outcome that leads to it").select_option("ok")
    after = apply(page, script)
    assert "transitions: {ok: PAUSE, bad: failed}  # and then" in after
    assert "time: 0.0\n      transitions: {succeeded: B}" in after
    undo(page, script)


def test_a_state_is_added_on_a_transition_that_is_clicked(page: Page, script: Path) -> None:
    page.locator('.label text[data-from="sm/A"][data-outcome="ok"]').click()
    form = page.locator("form.edit")
    assert form.get_by_label("Operation", exact=True).input_value() == "Add a state behind it"
    assert form.get_by_label("Outcome that leads to it").input_value() == "ok"
    page.keyboard.type("PAUSE")
    form.get_by_label("State type").select_option("SleepState")
    press(page, "Preview")
    page.get_by_label("Change of the script").wait_for()
    assert "PAUSE" in page.locator(".diff mark").all_text_contents()
    shoot(page, "edit_insert")
    assert "transitions: {ok: PAUSE, bad: failed}  # and then" in apply(page, script)
    undo(page, script)


def test_the_operation_follows_the_selection(page: Page, script: Path) -> None:
    form = choose(page, "sm/A", "Remove")
    page.locator('.state[data-path="sm/B"] > .body').click()
    page.locator('.state.selected[data-path="sm/B"]').wait_for()
    assert form.get_by_label("Operation", exact=True).input_value() == "Change a transition"
    operations = form.get_by_label("Operation", exact=True).locator("option").all_text_contents()
    assert "Add a state inside" not in operations


def handle(page: Page, path: str, outcome: str) -> Locator:
    """The handle of an outcome of the selected state."""
    return page.locator(f'.handles [data-from="{path}"][data-outcome="{outcome}"]')


def draw_to(page: Page, start: Locator, end: Locator) -> None:
    """Draw a line from one element to another; the button stays pressed."""
    start.hover()
    page.mouse.down()
    box = end.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x + 3, y + 3)
    page.mouse.move(x, y)


def test_a_transition_is_drawn_from_the_handle_of_an_outcome(page: Page, script: Path) -> None:
    choose(page, "sm/A", "Rename")
    draw_to(page, handle(page, "sm/A", "ok"), page.locator('.state[data-path="sm/C"]'))
    page.locator('.state.drop[data-path="sm/C"]').wait_for()
    assert page.locator(".drawn .words").text_content() == "ok → C"
    shoot(page, "edit_drawn")
    page.mouse.up()
    page.get_by_label("Change of the script").wait_for()
    assert page.locator(".drawn, .drop").count() == 0
    form = page.locator("form.edit")
    assert form.get_by_label("Leads to").input_value() == "C"
    assert script.read_text() == SCRIPT
    press(page, "Apply")
    page.wait_for_selector("text=Written: ")
    assert script.read_text() == SCRIPT.replace("{ok: B,", "{ok: C,")
    undo(page, script)


def test_a_transition_is_drawn_from_the_label_of_a_line_to_an_outcome(
    page: Page, script: Path
) -> None:
    label = page.locator('.label [data-from="sm/B"][data-outcome="ok"]')
    draw_to(page, label, page.locator('[data-of="sm"][data-exit="done"]'))
    page.locator('.piece.drop[data-exit="done"]').wait_for()
    page.mouse.up()
    page.get_by_label("Change of the script").wait_for()
    page.locator('.state.selected[data-path="sm/B"]').wait_for()
    press(page, "Apply")
    page.wait_for_selector("text=Written: ")
    assert script.read_text() == SCRIPT.replace("{ok: C,", "{ok: done,")
    undo(page, script)


def test_a_line_that_ends_nowhere_changes_nothing(page: Page, script: Path) -> None:
    """Escape and an empty place end the drawing; a click on a label selects the state."""
    choose(page, "sm/A", "Change a transition")
    draw_to(page, handle(page, "sm/A", "ok"), page.locator('.state[data-path="sm/C"]'))
    page.locator(".state.drop").wait_for()
    page.keyboard.press("Escape")
    page.locator(".drawn").wait_for(state="detached")
    page.mouse.up()
    page.locator('.label [data-from="sm/B"][data-outcome="ok"]').click()
    page.locator('.state.selected[data-path="sm/B"]').wait_for()
    draw_to(page, handle(page, "sm/B", "bad"), page.locator("h1"))
    page.locator(".drawn").wait_for()
    page.mouse.up()
    page.locator(".drawn").wait_for(state="detached")
    assert page.locator('.state.selected[data-path="sm/B"]').count() == 1
    assert page.get_by_label("Change of the script").count() == 0
    assert script.read_text() == SCRIPT


def test_a_state_is_removed(page: Page, script: Path) -> None:
    form = choose(page, "sm/B", "Remove")
    form.get_by_label("What led to it leads to").select_option("C")
    start, end = SCRIPT.index("  - B:"), SCRIPT.index("\n  # The last.")
    removed = SCRIPT[:start] + SCRIPT[end:]
    assert apply(page, script) == removed.replace("{ok: B,", "{ok: C,")
    page.locator('.state[data-path="sm/B"]').wait_for(state="detached")
    page.locator(".run-bar").wait_for(state="hidden")
    undo(page, script)
    page.locator('.state[data-path="sm/B"]').wait_for()


def test_states_move_into_a_container(page: Page, script: Path) -> None:
    form = choose(page, "sm/B", "Move into a new container")
    form.get_by_label("C", exact=True).check()
    form.get_by_label("Name of the container").fill("BOTH")
    after = apply(page, script)
    assert "  - BOTH:\n      template: StateMachine\n" in after
    assert [
        line for line in ("# The line.", "# the first", "# The last.") if line not in after
    ] == []
    page.locator('.state.selected[data-path="sm/BOTH"]').wait_for()
    undo(page, script)


def test_it_works_by_the_keyboard_alone(page: Page, script: Path) -> None:
    page.keyboard.press("/")
    page.keyboard.type("C")
    page.keyboard.press("Enter")
    page.locator('.state.selected[data-path="sm/C"]').wait_for()
    focused = "document.activeElement.labels?.[0]?.textContent"
    while page.evaluate(focused) != "Operation":
        page.keyboard.press("Tab")
    page.keyboard.type("Ren")
    page.keyboard.press("Tab")
    assert page.evaluate(focused) == "New name"
    page.keyboard.press("Control+A")
    page.keyboard.type("LAST")
    page.keyboard.press("Enter")
    page.get_by_label("Change of the script").wait_for()
    page.keyboard.press("Tab")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.textContent") == "Apply"
    page.keyboard.press("Enter")
    page.locator('.state.selected[data-path="sm/LAST"]').wait_for()
    assert script.read_text() == SCRIPT.replace("- C:", "- LAST:").replace("ok: C,", "ok: LAST,")
    assert page.evaluate("document.activeElement.textContent") == "Undo"
    undo(page, script)


def test_a_machine_that_arrives_late_is_not_shown(
    browser: Browser, script: Path, start: Callable[..., Viewed]
) -> None:
    """The stream may bring the machine before an edit after the answer to the edit."""
    view = start("view", script, "--no-browser")
    old = view.until(lambda message: message["kind"] == "model")
    finding = {
        "severity": "error",
        "code": "LATE",
        "message": "",
        "help": "",
        "file": "",
        "line": 0,
        "related": [],
    }
    late = {"kind": "report", "broken": True, "outdated": False, "findings": [finding]}
    held: list[Route] = []
    page = browser.new_page()
    page.route("**/events", lambda route: held.append(route))
    page.goto(view.url)
    page.locator("form.edit select").first.wait_for()
    choose(page, "sm/B", "Rename").get_by_label("New name").fill("MIDDLE")
    apply(page, script)
    choose(page, "sm/A", "Rename").get_by_label("New name").fill("FIRST")
    body = "".join(f"data: {json.dumps(each)}\n\n" for each in (old, late))
    held[0].fulfill(content_type="text/event-stream", body=f"{body}event: end\ndata: {{}}\n\n")
    page.wait_for_selector("text=LATE")
    assert page.get_by_label("New name").input_value() == "FIRST"
    page.locator('.state[data-path="sm/MIDDLE"]').wait_for()
    assert page.locator('.state[data-path="sm/B"]').count() == 0


def test_u_in_a_field_is_a_letter(page: Page, script: Path) -> None:
    form = choose(page, "sm/B", "Rename")
    form.get_by_label("New name").fill("")
    page.keyboard.type("u")
    assert form.get_by_label("New name").input_value() == "u"
    assert page.locator("form.edit .said").inner_text() == ""


def test_what_is_refused_is_shown_as_text(
    browser: Browser, script: Path, start: Callable[..., Viewed]
) -> None:
    """The browser reports answers with an error to the console: 409 is no fault of the page."""
    page = browser.new_page()
    page.goto(start("view", script, "--no-browser").url)
    page.locator("form.edit select").first.wait_for()
    form = choose(page, "sm/B", "Rename")
    form.get_by_label("New name").fill("<img src=x onerror=alert(1)>")
    press(page, "Preview")
    page.wait_for_selector(".said.refused")
    assert "<img src=x onerror=alert(1)>" in page.locator(".said").inner_text()
    assert page.locator("img").count() == 0
    form.get_by_label("New name").fill("MIDDLE")
    press(page, "Preview")
    page.get_by_label("Change of the script").wait_for()
    assert page.get_by_role("button", name="Apply", exact=True).is_enabled()
    other = SCRIPT.replace("ok: done", "ok: failed")
    script.write_text(other)
    page.wait_for_selector("button[aria-label=Apply]:disabled")
    assert page.get_by_label("Change of the script").count() == 0
    page.keyboard.press("u")
    page.wait_for_selector("text=there is nothing to undo")
    assert script.read_text() == other


def test_without_the_token_nothing_can_be_edited(
    browser: Browser, script: Path, start: Callable[..., Viewed]
) -> None:
    page = browser.new_page()
    page.goto(start("view", script, "--no-browser").url.partition("#")[0])
    page.wait_for_selector("html[data-ready]")
    assert page.locator("form.edit").count() == 0


@pytest.mark.parametrize("colours", ["light", "dark"])
def test_the_forms_are_accessible(page: Page, script: Path, colours: str) -> None:
    page.emulate_media(color_scheme=colours)  # type: ignore[arg-type]
    page.evaluate("theme => document.documentElement.dataset.theme = theme", colours)
    page.evaluate(AXE.read_text("utf-8"))
    form = choose(page, "sm/A", "Rename")
    titles = form.get_by_label("Operation", exact=True).locator("option").all_inner_texts()
    assert len(titles) == 5
    for title in titles:
        choose(page, "sm/A", title)
        assert serious(page) == []
    form = choose(page, "sm/A", "Change a transition")
    form.get_by_label("Leads to").select_option("C")
    press(page, "Preview")
    page.get_by_label("Change of the script").wait_for()
    shoot(page, f"edit_{colours}")
    assert serious(page) == []


def serious(page: Page) -> list[tuple[str, str]]:
    results = page.evaluate("axe.run()")
    return [
        (each["id"], each["nodes"][0]["html"])
        for each in results["violations"]
        if each["impact"] in ("serious", "critical")
    ]
