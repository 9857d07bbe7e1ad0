"""The host for SCION runs the example of docs/frameworks.md as a user starts it."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
from pathlib import Path

import pytest

import smachac
from tests.scxml.scion import VIEWER

pytestmark = pytest.mark.browser

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "frameworks.md").read_text("utf-8")
BLOCK = re.compile(r"^```(?:yaml|js)\n(?:#|//) (\S+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The files of the page, with their names as comments, and the built document."""
    if shutil.which("node") is None or not (VIEWER / "node_modules" / "@scion-scxml").is_dir():
        pytest.skip("SCION is not here: make test-browser")
    (tmp_path / "templates").mkdir()
    for name, text in BLOCK.findall(PAGE):
        (tmp_path / name).write_text(f"{'//' if name.endswith('.js') else '#'} {name}\n{text}")
    build(tmp_path)
    return tmp_path


def build(folder: Path, *, trace: bool = False) -> None:
    options = {"trace": "true"} if trace else {}
    files = smachac.compile(folder / "deliver.yml", "scxml", options=options)
    host = ROOT / "smachac" / "runtime" / "scxml" / "scion_host.js"
    for name, text in [*files.items(), (host.name, host.read_text("utf-8"))]:
        (folder / name).write_text(text)


def start(folder: Path, *arguments: str, table: str = "states.js") -> subprocess.Popen[str]:
    return subprocess.Popen(
        ["node", "scion_host.js", "deliver.scxml", table, *arguments],
        cwd=folder,
        env={**os.environ, "NODE_PATH": str(VIEWER / "node_modules")},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
    )


def run(folder: Path, *arguments: str, table: str = "states.js") -> tuple[int, str, str]:
    process = start(folder, *arguments, table=table)
    out, err = process.communicate()
    return process.returncode, out, err


def test_the_page_shows_what_is_printed(folder: Path) -> None:
    code, out, err = run(folder)
    assert (code, err) == (0, "")
    assert f"states.js\n{out}```" in PAGE
    shown = re.search(r"^```xml\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)
    assert shown is not None
    assert shown[1] in (folder / "deliver.scxml").read_text("utf-8")


def test_inputs_and_a_trace(folder: Path) -> None:
    build(folder, trace=True)
    code, out, _ = run(folder, "--inputs", '{"place": "table"}')
    assert code == 0
    assert "looking at the table" in out
    events = [json.loads(line) for line in out.splitlines() if line.startswith("{")]
    assert [event["seq"] for event in events] == list(range(1, len(events) + 1))
    assert events[0]["event"] == "start"
    assert events[-1] == {**events[-1], "event": "finish", "outcome": "delivered"}


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("throw new Error('no camera')", "no camera"),
        ("return 'lost'", '"lost" is not one of its outcomes'),
        ("return inputs.nothing", 'the input "nothing" holds nothing'),
        ("return Promise.reject(new Error('late'))", "late"),
    ],
)
def test_a_fault_ends_the_run(folder: Path, body: str, message: str) -> None:
    (folder / "bad.js").write_text(f"exports.Look = ({{inputs}}) => {{ {body}; }};\n")
    code, out, err = run(folder, table="bad.js")
    assert (code, out, err) == (1, "", f"the run failed: {message}\n")


def test_a_missing_function_is_named(folder: Path) -> None:
    (folder / "empty.js").write_text("")
    code, _, err = run(folder, table="empty.js")
    assert (code, 'state type "Look"' in err) == (1, True)


@pytest.mark.parametrize(("number", "code"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_stops_the_machine(folder: Path, number: int, code: int) -> None:
    (folder / "slow.js").write_text(
        "exports.Look = ({outputs}) => { outputs.box = 1; return 'found'; };\n"
        "exports.Pick = ({signal}) => new Promise(resolve => {\n"
        "  const timer = setTimeout(() => resolve('picked'), 60000);\n"
        "  signal.onabort = () => { clearTimeout(timer); resolve('preempted'); };\n"
        "  console.log('picking');\n"
        "});\n"
    )
    process = start(folder, table="slow.js")
    assert process.stdout is not None
    assert process.stdout.readline() == "picking\n"
    process.send_signal(number)
    out, err = process.communicate()
    assert (process.returncode, out, err) == (code, "outcome: aborted\n", "")
