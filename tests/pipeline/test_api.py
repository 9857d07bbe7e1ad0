"""The verbs for programs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import smachac

EXAMPLES = Path(__file__).parents[2] / "examples"
GOOD = EXAMPLES / "06_callbacks" / "main.yml"


def test_a_good_script(capsys: pytest.CaptureFixture[str]) -> None:
    assert [item.code.code for item in smachac.check(GOOD)] == []
    assert smachac.load(GOOD).root.name == "three_tries"
    assert list(smachac.build(GOOD, "dot")) == ["three_tries.dot"]
    events: list[dict[str, Any]] = []
    assert smachac.run(GOOD, observe=events.append) == "succeeded"
    assert events[-1]["event"] == "finish"
    assert capsys.readouterr().out == ""


def test_a_script_with_errors(tmp_path: Path) -> None:
    path = tmp_path / "main.yml"
    path.write_text(GOOD.read_text().replace("enough: aborted", "enough: abroted"))
    assert [item.code.code for item in smachac.check(str(path))] == ["SM101"]
    for verb in (smachac.load, smachac.run):
        with pytest.raises(smachac.ScriptError, match="did you mean `aborted`"):
            verb(path)
    with pytest.raises(smachac.ScriptError):
        smachac.build(tmp_path / "no.yml", "dot")


def test_wrong_use() -> None:
    with pytest.raises(LookupError, match="no target"):
        smachac.build(GOOD, "pyton")
    with pytest.raises(ValueError, match="depth"):
        smachac.build(GOOD, "dot", options={"depth": "x"})


def test_more_folders() -> None:
    script = EXAMPLES / "09_stacking" / "main.yml"
    assert smachac.load(script, scripts=[EXAMPLES / "08_pick_and_place"]).root.name == "stacking"
