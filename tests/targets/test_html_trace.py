"""The page that replays a trace: what is in it, and what is refused."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import pytest

from smachac.commands.cli import main

SCRIPT = """\
name: sm
outcomes: [done]
states:
  - A:
      template: ScriptedState
      outcomes: [ok]
      transitions: {ok: done}
"""


def build(folder: Path, trace: str) -> int:
    (folder / "main.yml").write_text(SCRIPT)
    (folder / "run.jsonl").write_text(trace)
    words = ["build", folder / "main.yml", "-t", "html", "-o", folder, "--option"]
    return main([*map(str, words), f"trace={folder / 'run.jsonl'}"])


def replayed(folder: Path) -> Any:
    text = (folder / "sm.html").read_text()
    found = re.search('id="smachac-trace">(.*?)</script>', text)
    assert found is not None
    return json.loads(found[1])


def test_the_events_are_in_the_page(tmp_path: Path) -> None:
    run = ["run", str(tmp_path / "main.yml"), "-q", "--trace", str(tmp_path / "made.jsonl")]
    (tmp_path / "main.yml").write_text(SCRIPT)
    assert main(run) == 0
    trace = (tmp_path / "made.jsonl").read_text()
    assert build(tmp_path, trace) == 0
    assert replayed(tmp_path) == [json.loads(line) for line in trace.splitlines()]


def test_markup_in_a_value_is_escaped_and_long_values_are_cut(tmp_path: Path) -> None:
    event = {"seq": 1, "event": "write", "path": "sm/A", "key": "k", "value": "</script><b>" * 500}
    assert build(tmp_path, json.dumps(event) + "\n") == 0
    (found,) = replayed(tmp_path)
    assert found["value"].startswith("</script><b>")
    assert len(found["value"]) < 500
    assert "<b>" not in (tmp_path / "sm.html").read_text()


@pytest.mark.parametrize(
    ("trace", "message"),
    [
        ("name: sm\n", "line 1 is no event of a trace"),
        ('\n{"event": "enter", "path": "other/A"}\n', "line 2 is of another machine than `sm`"),
        ('{"event": 1, "path": "sm"}', "line 1 is no event"),
    ],
)
def test_what_is_no_trace_of_the_machine_is_refused(
    trace: str, message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert build(tmp_path, trace) == 2
    assert message in capsys.readouterr().err


def test_a_trace_that_does_not_exist_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "main.yml").write_text(SCRIPT)
    words = ["build", str(tmp_path / "main.yml"), "-t", "html", "-o", str(tmp_path)]
    assert main([*words, "--option", "trace=none.jsonl"]) == 2
    assert "--option trace: the file none.jsonl cannot be read" in capsys.readouterr().err
