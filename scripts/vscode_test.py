"""The VS Code extension in a real editor: findings, completion, hover, rename, picture.

They are tried in a script, and in Python files for SMACH and YASMIN in a folder without a project.

Started by scripts/vscode_test.sh, with the programs Node and code-server, the packed extension, and
a folder for the files of the run. The last screens are `script.png` and `python.png` there.
"""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from tests.browser.pages import started_browser

if TYPE_CHECKING:
    from playwright.sync_api import Locator, Page

ROOT = Path(__file__).parents[1]
LONGEST = 60_000
"""The longest wait for something on the screen (ms)."""

SETTINGS = {
    "smachac.command": str(ROOT / ".venv" / "bin" / "smachac"),
    "security.workspace.trust.enabled": False,
    "workbench.startupEditor": "none",
    "chat.disableAIFeatures": True,
    "extensions.autoCheckUpdates": False,
    "telemetry.telemetryLevel": "off",
}


class Editor:
    """A page with VS Code. Each step waits for what it makes visible."""

    def __init__(self, page: Page) -> None:
        self.page = page

    def pick(self, key: str, text: str, row: str = "") -> None:
        """Type into the input that a key opens, and take its first row with a text."""
        self.page.keyboard.press(key)
        widget = self.page.locator(".quick-input-widget:visible")
        widget.locator("input.input").fill(text)
        widget.locator(f".monaco-list-row:has-text('{row}')").first.wait_for()
        self.page.keyboard.press("Enter")
        self.page.locator(".quick-input-widget").wait_for(state="hidden")

    def open(self, name: str) -> None:
        self.pick("Control+P", name, name)
        self.page.locator(f".tab.active:has-text('{name}')").wait_for()

    def command(self, name: str) -> None:
        self.pick("F1", f">{name}", name)

    def go_to(self, line: int, column: int) -> None:
        self.pick("Control+G", f":{line}:{column}")
        self.at(line, column)

    def at(self, line: int, column: int) -> None:
        """Wait until the cursor is there."""
        self.page.locator(f".statusbar-item:has-text('Ln {line}, Col {column}')").wait_for()

    def save(self) -> None:
        self.page.keyboard.press("Control+S")
        self.page.locator(".tab.active.dirty").wait_for(state="detached")

    def shown(self, selector: str, text: str | re.Pattern[str]) -> Locator:
        """The first element with a text, when it is visible."""
        found = self.page.locator(f"{selector}:visible").filter(has_text=text).first
        found.wait_for()
        return found


def use(editor: Editor) -> None:
    """Use the extension; a step without its effect raises an error of Playwright."""
    page = editor.page
    editor.open("main.yml")
    page.keyboard.press("Control+Shift+M")
    problem = editor.shown(".markers-panel .monaco-list-row", "neither a state nor an outcome")
    print("a finding is in the panel Problems")

    page.locator(".editor-instance .view-lines").first.click()
    editor.go_to(18, 32)
    page.keyboard.press("Control+Delete")
    page.keyboard.press("Control+Space")
    editor.shown(".suggest-widget .monaco-list-row", "LOAD_BLOCK").click()
    problem.wait_for(state="detached")
    editor.save()
    print("completion offers a state, and the finding vanishes")

    editor.go_to(12, 20)
    editor.command("Show or Focus Hover")
    editor.shown(".monaco-hover", "Adds a model to the simulated world")
    page.keyboard.press("Escape")
    print("the hover describes a state type")

    editor.go_to(20, 8)
    page.keyboard.press("F2")
    page.locator(".rename-box input:visible").fill("LOAD_CUBE")
    page.keyboard.press("Enter")
    editor.shown(".view-line", re.compile(r"succeeded:\sLOAD_CUBE"))
    editor.save()
    print("a state is renamed")

    editor.command("smachac: Draw")
    picture = page.frame_locator("iframe.webview").frame_locator("iframe#active-frame")
    picture.locator("svg .node:has-text('LOAD_CUBE')").wait_for()
    picture.locator("svg .node:has-text('RETREAT')").click()
    editor.at(68, 5)
    print("the picture shows the states, and a click leads to the line")


STATES = """\
from yasmin import State


class Grasp(State):
    def __init__(self):
        super().__init__(outcomes=["held", "lost"])

    def execute(self, blackboard):
        return "held" if blackboard["part"] else "lost"
"""

PICKING = """\
from grippers import Grasp
from yasmin import Concurrence, StateMachine

pair = Concurrence(
    {"LEFT": Grasp(), "RIGHT": Grasp()}, "missed", {"got": {"LEFT": "held", "RIGHT": "held"}},
)
sm = StateMachine(outcomes=["done", "failed"])
sm.add_state("LOOK", Grasp(), transitions={"held": "PIAR", "lost": "failed"})
sm.add_state("PAIR", pair, transitions={"got": "done", "missed": "LOOK"})
"""

PARCELS = """\
import smach
from belts import Weigh

sm = smach.StateMachine(outcomes=["sorted"])
with sm:
    smach.StateMachine.add("WEIGH", Weigh(), {"light": "WEIGH", "heavy": "sotred"})
"""


def use_python(editor: Editor) -> None:
    """Use the extension in Python files."""
    page = editor.page
    editor.open("picking.py")
    page.keyboard.press("Control+Shift+M")
    problem = editor.shown(".markers-panel .monaco-list-row", "neither a state nor an outcome")
    print("a file for YASMIN starts the server, and its finding is in the panel Problems")

    page.locator(".editor-instance .view-lines").first.click()
    editor.go_to(8, 53)
    page.keyboard.press("Control+Delete")
    page.keyboard.type("PAIR")
    problem.wait_for(state="detached")
    editor.save()
    print("the finding vanishes while one types")

    editor.go_to(8, 15)
    editor.command("Show or Focus Hover")
    editor.shown(".monaco-hover", "on held: to PAIR")
    page.keyboard.press("Escape")
    print("the hover describes a state")

    editor.go_to(8, 53)
    page.keyboard.press("F12")
    editor.at(9, 15)
    print("a target leads to the call that adds the state")

    editor.go_to(5, 16)
    page.keyboard.press("F12")
    page.locator(".tab.active:has-text('grippers.py')").wait_for()
    print("the object of a state leads to its class")

    editor.open("picking.py")
    editor.command("smachac: Draw")
    picture = page.frame_locator("iframe.webview").frame_locator("iframe#active-frame")
    picture.locator("svg .node:has-text('RIGHT')").wait_for()
    picture.locator("svg .node:has-text('LOOK')").click()
    editor.at(8, 1)
    print("the picture shows the states, and a click leads to the line")

    editor.open("parcels.py")
    editor.shown(".markers-panel .monaco-list-row", "`sotred` is neither a state nor an outcome")
    print("so it is in a file for SMACH")


@contextmanager
def started_server(arguments: list[str], log: Path) -> Iterator[str]:
    """The address of a running code-server."""
    with log.open("w") as errors:
        server = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=errors, text=True)
        try:
            assert server.stdout is not None
            for line in server.stdout:
                found = re.search(r"listening on (http://\S+?)/?$", line.strip())
                if found is not None:
                    rest = (server.stdout, errors)
                    threading.Thread(target=shutil.copyfileobj, args=rest, daemon=True).start()
                    yield found[1]
                    break
            else:
                raise SystemExit(f"vscode_test: code-server does not start: {log}")
        finally:
            server.terminate()
            server.wait()


def main(node: str, code_server: str, extension: str, output: str) -> None:
    run = Path(output).resolve()
    shutil.rmtree(run, ignore_errors=True)
    project = run / "project"
    shutil.copytree(ROOT / "examples" / "08_pick_and_place", project)
    (project / "smachac.toml").write_text("ros = 2\n")
    script = project / "main.yml"
    text = script.read_text("utf-8")
    script.write_text(text.replace("succeeded: LOAD_BLOCK", "succeeded: NOWHERE", 1), "utf-8")
    python = run / "python"
    (python / ".git").mkdir(parents=True)  # a repository of its own
    for name, text in (("grippers", STATES), ("picking", PICKING), ("parcels", PARCELS)):
        (python / f"{name}.py").write_text(text, "utf-8")
    settings = run / "data" / "User" / "settings.json"
    settings.parent.mkdir(parents=True)
    settings.write_text(json.dumps(SETTINGS))
    (run / "config.yaml").write_text("auth: none\n")
    program = [node, code_server, "--config", str(run / "config.yaml")]
    program += ["--user-data-dir", str(run / "data"), "--extensions-dir", str(run / "extensions")]
    subprocess.run([*program, "--install-extension", extension], check=True, capture_output=True)
    program += ["--bind-addr", "127.0.0.1:0", "--disable-telemetry", "--disable-update-check"]
    with started_server(program, run / "server.log") as address, started_browser() as browser:
        page = browser.new_page(viewport={"width": 1500, "height": 900})
        page.set_default_timeout(LONGEST)
        for name, folder, steps in (("script", project, use), ("python", python, use_python)):
            try:
                page.goto(f"{address}/?folder={folder}")
                page.locator(".explorer-folders-view").wait_for()
                steps(Editor(page))
            finally:
                page.screenshot(path=run / f"{name}.png")


if __name__ == "__main__":
    main(*sys.argv[1:])
