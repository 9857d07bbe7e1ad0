"""The page of the html target in a browser."""

from __future__ import annotations

import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from smachac.driver import analyse_script, compile_script
from smachac.ir.traversal import walk
from smachac.targets.html import TARGET
from tests.browser.pages import ROOT, SCREENSHOTS, Messages
from tests.browser.scripts import SHAPES, flat_script, large_script
from tests.targets.test_html import MARKUP

if TYPE_CHECKING:
    from playwright.sync_api import Browser, Locator, Page

pytestmark = pytest.mark.browser

CONCURRENCE = ROOT / "examples" / "03_concurrence" / "main.yml"
PICK_AND_PLACE = ROOT / "examples" / "08_pick_and_place" / "main.yml"
RECOVERY = ROOT / "examples" / "13_recovery" / "main.yml"

OVERLAPPING_LABELS = """() => {
  const all = [...document.querySelectorAll("g.label")].map((label) => {
    const { left, right, top, bottom } = label.getBoundingClientRect();
    return { text: label.textContent, left, right, top, bottom };
  });
  return all.flatMap((a, index) => all.slice(index + 1)
    .filter((b) => a.left < b.right - 1 && b.left < a.right - 1
      && a.top < b.bottom - 1 && b.top < a.bottom - 1)
    .map((b) => [a.text, b.text]));
}"""
"""The labels of edges that cover each other."""

CROSSED_STATES = """() => {
  const inside = (box, x, y) =>
    x > box.left + 2 && x < box.right - 2 && y > box.top + 2 && y < box.bottom - 2;
  const boxes = [...document.querySelectorAll("g.state.closed")].map((state) =>
    ({ path: state.dataset.path, box: state.getBoundingClientRect() }));
  const covering = boxes.filter(({ path, box }) => boxes.some((other) => other.path !== path
    && inside(other.box, (box.left + box.right) / 2, (box.top + box.bottom) / 2)));
  const lines = [...document.querySelectorAll("svg.picture g.line path.stroke")];
  const points = lines.flatMap((line) => {
    const matrix = line.getScreenCTM();
    const length = line.getTotalLength();
    return Array.from({ length: 60 }, (_, index) =>
      line.getPointAtLength((length * index) / 59).matrixTransform(matrix));
  });
  const crossed = boxes.filter(({ box }) => points.some(({ x, y }) => inside(box, x, y)));
  return [...covering, ...crossed].map(({ path }) => path);
}"""
"""The states that are covered by another one or crossed by a line."""

DONE = "svg.picture:not([aria-busy])"
"""The picture when no layout goes on."""


def state(page: Page, path: str) -> Locator:
    """The box of a state."""
    return page.locator(f"[data-path='{path}']")


def shown(page: Page) -> list[str]:
    """The paths of the states in the picture."""
    found: list[str] = page.locator("[data-path]").evaluate_all(
        "all => all.map(each => each.dataset.path)"
    )
    return found


def transform(page: Page) -> str | None:
    return page.locator("svg.picture > g").get_attribute("transform")


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


def opened(
    browser: Browser, path: Path, messages: Messages, *, colours: str = "light", fragment: str = ""
) -> Page:
    """A page after its picture is drawn."""
    page = browser.new_page(
        viewport={"width": 1440, "height": 900},
        color_scheme="dark" if colours == "dark" else "light",
    )
    page.set_default_timeout(120_000)
    messages.watch(page)
    page.goto(path.as_uri() + fragment)
    page.wait_for_selector("html[data-ready]")
    return page


def shoot(page: Page, name: str) -> None:
    SCREENSHOTS.mkdir(exist_ok=True)
    page.screenshot(path=SCREENSHOTS / f"{name}.png")


def test_containers_open_and_close(browser: Browser, tmp_path: Path, messages: Messages) -> None:
    page = opened(browser, write_page(PICK_AND_PLACE, tmp_path), messages)
    shoot(page, "pick_and_place")
    inner = state(page, "pick_and_place/PICK_BLOCK/OPEN_GRIPPER")
    assert inner.count() == 0
    container = state(page, "pick_and_place/PICK_BLOCK")
    assert container.get_attribute("aria-expanded") == "false"
    container.locator(".toggle").click()
    inner.wait_for()
    shoot(page, "pick_and_place_open")
    assert container.get_attribute("aria-expanded") == "true"
    container.locator(".toggle").click()
    inner.wait_for(state="detached")
    page.get_by_role("button", name="Open all").click()
    inner.wait_for()
    analysis = analyse_script(PICK_AND_PLACE)
    assert analysis.machine is not None
    assert sorted(shown(page)) == sorted(path for path, _ in walk(analysis.machine.root))
    assert page.evaluate(OVERLAPPING_LABELS) == []


def test_panel_describes_the_state(browser: Browser, tmp_path: Path, messages: Messages) -> None:
    page = opened(browser, write_page(PICK_AND_PLACE, tmp_path), messages)
    state(page, "pick_and_place/MOVE_TO_START").click()
    panel = page.get_by_role("complementary")
    assert panel.locator("h2").inner_text() == "MOVE_TO_START"
    text = panel.inner_text()
    assert "MoveToJointPositionsState" in text
    assert "ends pick_and_place with aborted" in text
    assert "- MOVE_TO_START:" in text
    assert "main.yml:39" in text
    assert page.url.endswith("#state=pick_and_place/MOVE_TO_START")
    shoot(page, "panel")
    panel.get_by_role("button", name="PICK_BLOCK").click()
    assert panel.locator("h2").inner_text() == "PICK_BLOCK"


def test_address_leads_to_a_state(browser: Browser, tmp_path: Path, messages: Messages) -> None:
    path = write_page(PICK_AND_PLACE, tmp_path)
    fragment = "#token=x&state=pick_and_place/PLACE_BLOCK/MOVE_DOWN"
    page = opened(browser, path, messages, fragment=fragment)
    chosen = state(page, "pick_and_place/PLACE_BLOCK/MOVE_DOWN")
    assert chosen.get_attribute("aria-selected") == "true"
    page.keyboard.press("Escape")
    page.locator(".selected[data-path='pick_and_place/PLACE_BLOCK']").wait_for()
    assert page.url.endswith("#token=x&state=pick_and_place/PLACE_BLOCK")


def test_search(browser: Browser, tmp_path: Path, messages: Messages) -> None:
    page = opened(browser, write_page(PICK_AND_PLACE, tmp_path), messages)
    page.keyboard.press("/")
    page.keyboard.type("check_gr")
    hits = page.get_by_role("option")
    assert [text.split("\n")[0].split()[0] for text in hits.all_inner_texts()] == [
        "CHECK_GRASP"
    ] * 2
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    page.locator(".selected[data-path='pick_and_place/PLACE_BLOCK/CHECK_GRASP']").wait_for()
    page.keyboard.press("/")
    for text, reason in (("gripper_width", "key gripper_width"), ("LoadModel", "type LoadModel")):
        page.get_by_role("combobox").fill(text)
        assert reason in hits.first.inner_text()
    page.get_by_role("combobox").fill("<img src=x>")
    assert hits.all_inner_texts() == ["nothing found"]
    page.keyboard.press("Escape")
    assert page.get_by_role("combobox").input_value() == ""


def test_keyboard_alone_is_enough(browser: Browser, tmp_path: Path, messages: Messages) -> None:
    page = opened(browser, write_page(PICK_AND_PLACE, tmp_path), messages)

    def selected() -> str | None:
        return page.locator(".selected").get_attribute("data-path")

    page.keyboard.press("ArrowDown")
    assert selected() == "pick_and_place/LOAD_TABLE"
    page.keyboard.press("ArrowDown")
    assert selected() == "pick_and_place/LOAD_BLOCK"
    assert page.evaluate("document.activeElement.dataset.path") == "pick_and_place/LOAD_BLOCK"
    page.keyboard.press("ArrowUp")
    page.keyboard.press("ArrowUp")
    assert selected() == "pick_and_place"
    for _ in range(5):
        page.keyboard.press("ArrowDown")
    assert selected() == "pick_and_place/PICK_BLOCK"
    page.keyboard.press("Enter")
    state(page, "pick_and_place/PICK_BLOCK/OPEN_GRIPPER").wait_for()
    page.keyboard.press("ArrowDown")
    assert selected() == "pick_and_place/PICK_BLOCK/OPEN_GRIPPER"
    page.keyboard.press("Escape")
    page.keyboard.press("Enter")
    state(page, "pick_and_place/PICK_BLOCK/OPEN_GRIPPER").wait_for(state="detached")
    before = transform(page)
    page.keyboard.press("+")
    assert transform(page) != before
    page.keyboard.press("f")
    page.keyboard.press("d")
    page.keyboard.press("c")
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.tagName") != "BODY"


def test_wheel_zooms_and_dragging_pans(
    browser: Browser, tmp_path: Path, messages: Messages
) -> None:
    page = opened(browser, write_page(PICK_AND_PLACE, tmp_path), messages)
    first = transform(page)
    page.mouse.move(300, 500)
    page.mouse.wheel(0, -300)
    page.locator(f"svg.picture > g:not([transform='{first}'])").wait_for()
    second = transform(page)
    page.mouse.down()
    page.mouse.move(360, 540, steps=4)
    page.mouse.up()
    assert transform(page) not in (first, second)
    assert page.locator(".selected").count() == 0


@pytest.mark.parametrize("colours", ["light", "dark"])
def test_colours(browser: Browser, tmp_path: Path, messages: Messages, colours: str) -> None:
    page = opened(browser, write_page(CONCURRENCE, tmp_path), messages, colours=colours)
    shoot(page, f"concurrence_{colours}")
    background = "getComputedStyle(document.body).backgroundColor"
    first = page.evaluate(background)
    page.get_by_role("button", name="Dark colours").click()
    assert page.evaluate(background) != first
    page.reload()
    page.wait_for_selector("html[data-ready]")
    assert page.evaluate(background) != first


@pytest.mark.parametrize("colours", ["light", "dark"])
@pytest.mark.parametrize("script", [CONCURRENCE, RECOVERY], ids=["concurrence", "recovery"])
def test_accessibility(
    browser: Browser, tmp_path: Path, messages: Messages, script: Path, colours: str
) -> None:
    path = write_page(script, tmp_path)
    axe = (ROOT / "viewer/node_modules/axe-core/axe.min.js").read_text("utf-8")
    page = opened(browser, path, messages, colours=colours)
    page.keyboard.press("ArrowDown")
    page.locator(".selected").wait_for()
    shoot(page, f"{script.parent.name}_{colours}")
    page.evaluate(axe)
    results = page.evaluate("axe.run()")
    serious = [each for each in results["violations"] if each["impact"] in ("serious", "critical")]
    assert [(each["id"], each["nodes"][0]["html"]) for each in serious] == []


def test_markup_is_shown_as_text(browser: Browser, tmp_path: Path, messages: Messages) -> None:
    script = tmp_path / "main.yml"
    script.write_text(MARKUP, "utf-8")
    page = opened(browser, write_page(script, tmp_path), messages)
    assert page.get_by_role("complementary").inner_text().count("<script>alert(1)</script>") == 1
    state(page, "sm/GRÜßE").click()
    assert "<img src=x onerror=alert(1)>" in page.get_by_role("complementary").inner_text()
    assert page.locator("img").count() == 0


def test_two_thousand_states(browser: Browser, tmp_path: Path, messages: Messages) -> None:
    script = tmp_path / "main.yml"
    script.write_text(large_script(40, 50), "utf-8")
    page = opened(browser, write_page(script, tmp_path), messages)
    shoot(page, "two_thousand_states")
    assert len(shown(page)) == 41
    state(page, "big/M00").locator(".toggle").click()
    page.locator(f"{DONE} .selected.open[data-path='big/M00']").wait_for()
    # An arrow key, not a click: large containers reach below the panel, where no click arrives.
    page.keyboard.press("ArrowDown")
    page.locator(".selected[data-path='big/M00/S00']").wait_for()
    assert page.get_by_role("complementary").locator("h2").inner_text() == "S00"
    page.keyboard.press("/")
    page.keyboard.type("M39")
    page.keyboard.press("Enter")
    page.locator(".selected[data-path='big/M39']").wait_for()
    assert len(shown(page)) == 91


def test_layout_in_progress_can_be_cancelled(
    browser: Browser, tmp_path: Path, messages: Messages
) -> None:
    script = tmp_path / "main.yml"
    script.write_text(large_script(40, 50), "utf-8")
    page = opened(browser, write_page(script, tmp_path), messages)
    progress = page.locator(".progress")
    page.get_by_role("button", name="Open all").click()
    progress.get_by_text("of 2,040 states").wait_for()
    assert page.locator("svg.picture").get_attribute("aria-busy") == "true"
    page.keyboard.press("Escape")
    page.locator(DONE).wait_for()
    progress.wait_for(state="hidden")
    assert len(shown(page)) == 41
    page.get_by_role("button", name="Open all").click()
    progress.get_by_role("button", name="Cancel").click()
    progress.wait_for(state="hidden")
    state(page, "big/M00").locator(".toggle").click()
    page.locator(f"{DONE} .selected.open[data-path='big/M00']").wait_for()
    assert len(shown(page)) == 91


@pytest.mark.parametrize("shape", SHAPES)
def test_two_thousand_states_in_one_container(
    browser: Browser, tmp_path: Path, messages: Messages, shape: str
) -> None:
    script = tmp_path / "main.yml"
    script.write_text(flat_script(shape, 2000), "utf-8")
    page = opened(browser, write_page(script, tmp_path), messages)
    shoot(page, f"two_thousand_flat_{shape}")
    assert len(shown(page)) == 2001
    state(page, "flat/S1").click()
    assert page.get_by_role("complementary").locator("h2").inner_text() == "S1"
    page.keyboard.press("/")
    page.keyboard.type("S1999")
    page.keyboard.press("Enter")
    page.locator(".selected[data-path='flat/S1999']").wait_for()
    page.get_by_role("button", name="Turn").click()
    page.locator(DONE).wait_for()
    assert len(shown(page)) == 2001


def test_rows_cover_nothing(browser: Browser, tmp_path: Path, messages: Messages) -> None:
    script = tmp_path / "main.yml"
    script.write_text(flat_script("random", 200), "utf-8")
    page = opened(browser, write_page(script, tmp_path), messages)
    for _ in ("down", "right"):
        while "far" in (page.locator("svg.picture").get_attribute("class") or "").split():
            page.keyboard.press("+")
        assert page.locator("g.label").count() > 300
        assert page.evaluate(OVERLAPPING_LABELS) == []
        assert page.evaluate(CROSSED_STATES) == []
        first = transform(page)
        page.keyboard.press("d")
        page.locator(f"{DONE} > g:not([transform='{first}'])").wait_for()


def test_the_parts_of_the_viewer_that_need_no_page(browser: Browser) -> None:
    """The types of all sources, and the tests in viewer/tests, run by Node."""
    for name in ("check", "test"):
        command = ["npm", "run", "--silent", name]
        done = subprocess.run(
            command, cwd=ROOT / "viewer", check=False, capture_output=True, text=True
        )
        assert done.returncode == 0, done.stdout + done.stderr
    texts = [path.read_text("utf-8") for path in (ROOT / "viewer/tests").glob("*.test.mjs")]
    written = sum(text.count('\ntest("') for text in texts)
    assert f"# pass {written}\n" in done.stdout, "each test is found"


def test_committed_files_are_those_of_the_sources(browser: Browser, tmp_path: Path) -> None:
    command = ["node", "build.mjs", f"--outdir={tmp_path}"]
    subprocess.run(command, cwd=ROOT / "viewer", check=True)
    built = sorted(tmp_path.iterdir())
    assert len(built) == 4
    for path in built:
        committed = ROOT / "smachac" / "targets" / "html" / path.name
        assert path.read_bytes() == committed.read_bytes(), f"{path.name}: run `make viewer`"
