"""The page of the html target in a headless Chromium: large machines.

    python bench/html_page.py [states ...]

One flat machine of each shape for each number of states, and one of 40 machines of 50 states.
"""

from __future__ import annotations

import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

sys.path.insert(0, str(Path(__file__).parents[1]))

from smachac.driver import analyse_script, compile_script
from smachac.targets.html import TARGET
from tests.browser.pages import started_browser
from tests.browser.scripts import SHAPES, flat_script, large_script, limited_script

if TYPE_CHECKING:
    from playwright.sync_api import Browser

TIMEOUT = 60_000
"""After so many milliseconds a page counts as one that does not load."""


def page_of(text: str, folder: Path) -> Path:
    script = folder / "main.yml"
    script.write_text(text, "utf-8")
    compiled = compile_script(analyse_script(script), TARGET)
    path = folder / "page.html"
    path.write_text(next(iter(compiled.files.values())), "utf-8")
    return path


def measure(browser: Browser, path: Path, *, open_all: bool = False) -> str:
    """Seconds until the page is drawn, then until a key selects a state, then until the whole
    machine is on a screenshot."""
    from playwright.sync_api import TimeoutError as Timeout

    page = browser.new_page(viewport={"width": 1440, "height": 900})
    page.set_default_timeout(TIMEOUT)
    try:
        start = time.perf_counter()
        page.goto(path.as_uri())
        page.wait_for_selector("html[data-ready]")
        if open_all:
            start = time.perf_counter()
            page.get_by_role("button", name="Open all").click()
            page.locator("[data-path='big/M39/S49']").wait_for()
            page.evaluate("document.activeElement.blur()")
        drawn = time.perf_counter() - start
        page.keyboard.press("ArrowDown")
        page.locator(".selected").wait_for()
        answered = time.perf_counter() - start - drawn
        page.keyboard.press("f")
        page.screenshot()
        fitted = time.perf_counter() - start - drawn - answered
    except Timeout:
        return f"> {TIMEOUT // 1000} | |"
    finally:
        page.close()
    return f"{drawn:.1f} | {answered:.1f} | {fitted:.1f}"


CLICKS = 40


def click_cost(browser: Browser, path: Path) -> str:
    """The CPU time of the page's thread for one click on a state, in ms, with all containers open,
    and the wall time of the middle one of the clicks until the next frame."""
    page = browser.new_page(viewport={"width": 1440, "height": 900})
    page.set_default_timeout(10 * TIMEOUT)
    page.goto(path.as_uri())
    page.wait_for_selector("html[data-ready]")
    page.get_by_role("button", name="Open all").click()
    page.wait_for_selector("svg.picture:not([aria-busy])")
    devtools = page.context.new_cdp_session(page)
    devtools.send("Performance.enable")

    def thread_time() -> float:
        found = devtools.send("Performance.getMetrics")["metrics"]
        return next(float(item["value"]) for item in found if item["name"] == "ThreadTime")

    before = thread_time()
    walls = page.evaluate(
        """async (count) => {
          const states = [...document.querySelectorAll("g.state")], found = [];
          for (let at = 0; at < count; at += 1) {
            const start = performance.now(), state = states[(at * 53 + 7) % states.length];
            state.dispatchEvent(new MouseEvent("click", { bubbles: true }));
            await new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
            found.push(performance.now() - start);
          }
          return found;
        }""",
        CLICKS,
    )
    cost = 1000 * (thread_time() - before) / CLICKS
    page.close()
    return f"{cost:.0f} ms of CPU, {sorted(walls)[CLICKS // 2]:.0f} ms until the next frame"


def main(counts: list[int]) -> None:
    print("| shape | states | until drawn, s | a selection, s | the whole machine, s |")
    print("|---|---:|---:|---:|---:|")
    with tempfile.TemporaryDirectory() as name, started_browser() as browser:
        for shape in SHAPES:
            for count in counts:
                path = page_of(flat_script(shape, count), Path(name))
                print(f"| {shape} | {count:,} | {measure(browser, path)} |", flush=True)
        path = page_of(large_script(40, 50), Path(name))
        print(f"| 40 machines of 50 | 2,041 | {measure(browser, path)} |", flush=True)
        found = measure(browser, path, open_all=True)
        print(f"| the same, Open all | 2,041 | {found} |", flush=True)
        path = page_of(limited_script(20, 24), Path(name))
        print(f"a click, 500 states with limits and tries: {click_cost(browser, path)}")


if __name__ == "__main__":
    main([int(argument) for argument in sys.argv[1:]] or [100, 300, 1000, 2000])
