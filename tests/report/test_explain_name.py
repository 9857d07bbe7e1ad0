"""`smachac explain SCRIPT NAME`: which names mean something, and what else is said of them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.analysis.context import Context
from smachac.analysis.definite_assignment import data_flow
from smachac.commands.cli import main
from smachac.ir.nodes import Machine
from smachac.ir.traversal import walk
from smachac.report.explain_failures import render_failures
from smachac.report.explain_key import key_names
from smachac.report.explain_name import UnclearError, explain_name
from tests.strategies.machines import machines
from tests.strategies.userdata_machines import data_machines
from tests.support.examples import examples

ROOT = Path(__file__).parents[2]
PICK = str(ROOT / "examples" / "08_pick_and_place" / "main.yml")
BROKEN = str(ROOT / "tests" / "explained" / "main.yml")


@pytest.mark.parametrize(
    ("words", "says"),
    [
        ([PICK, "blok_pose"], "did you mean `block_pose`?"),
        ([PICK, "PICK_BLOCK/MOVE_DWN"], "did you mean `MOVE_DOWN`?"),
        ([PICK, "xyzzy"], "states: `CHECK_GRASP`, "),
        ([PICK, "CHECK_GRASP"], "  pick_and_place/PLACE_BLOCK/CHECK_GRASP ("),
        ([PICK, "pose"], "  pick_and_place/PICK_BLOCK/pick_pose"),
        ([PICK], "name a state or a key of"),
        ([PICK, "home", "more"], "name a code such as SM201"),
        ([PICK, "home", "--failures"], "name a code such as SM201"),
        ([PICK, "home", "--format", "md"], "--format md needs --failures"),
        ([], "name a code such as SM201"),
    ],
)
def test_what_is_asked_wrongly(
    words: list[str], says: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["explain", *words]) == 2
    shown = capsys.readouterr()
    assert says in shown.err
    assert not shown.out


def test_a_part_of_a_name_is_not_the_name(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", PICK, "BLOCK/CHECK_GRASP"]) == 2
    assert "there is no state" in capsys.readouterr().err


def test_a_script_with_errors_is_explained(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["explain", BROKEN, "LOOK"]) == 0
    shown = capsys.readouterr()
    assert "state sm/LOOK" in shown.out
    assert "the script has errors" in shown.err


def test_of_many_states_with_one_name_some_are_listed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    inner = "[A: {T: ScriptedState, o: [ok], t: {ok: ok}}]"
    boxes = "".join(
        f"  - B{n}: {{T: StateMachine, o: [ok], s: {inner}, t: {{ok: B{n + 1}}}}}\n"
        for n in range(30)
    )
    end = "  - B30: {T: ScriptedState, o: [ok], t: {ok: ok}}\n"
    script = tmp_path / "main.yml"
    script.write_text(f"name: sm\ntemplate: Base\noutcomes: [ok]\nstates:\n{boxes}{end}")
    assert main(["explain", str(script), "A"]) == 2
    shown = capsys.readouterr().err.splitlines()
    assert "there are 30 states `A`" in shown[0]
    assert len(shown) == 22
    assert shown[-1] == "  and 10 more"


@pytest.mark.parametrize("text", ["name: [", "- A: {}", None])
def test_an_unreadable_script_is_reported(
    text: str | None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "main.yml"
    if text is not None:
        path.write_text(text)
    assert main(["explain", str(path), "A"]) == 1
    assert "error[SM0" in capsys.readouterr().err


def test_nothing_of_a_script_steers_the_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    script = tmp_path / "main.yml"
    script.write_text(
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        '  - "A\\e[31m":\n      template: ScriptedState\n      doc: "x\\ay"\n'
        '      outcomes: [done, "a|b\\e_failed"]\n      transitions: {"a|b\\e_failed": done}\n'
    )
    for words in (["A\x1b[31m"], ["--failures"], ["--failures", "--format", "md"]):
        assert main(["explain", str(script), *words]) == 0
        shown = capsys.readouterr().out
        assert "\x1b" not in shown
        assert "A\u241b" in shown


def explained(machine: Machine, name: str, form: str) -> str:
    try:
        return explain_name(Context(machine), [], name, form)
    except UnclearError as error:
        return str(error)


@settings(max_examples=examples(60))
@given(st.one_of(machines(), data_machines()), st.data())
def test_every_name_of_any_machine_can_be_asked_for(machine: Machine, data: st.DataObject) -> None:
    paths = [path for path, _ in walk(machine.root)]
    known = [*paths, *(path.rpartition("/")[2] for path in paths), *key_names(data_flow(machine))]
    name = data.draw(st.sampled_from(known))
    form = data.draw(st.sampled_from(["text", "json"]))
    said = explained(machine, name, form)
    assert not said.startswith("there is no")  # it is the name of something
    if said.startswith("{"):
        found = json.loads(said)
        assert found["states"] or found["keys"]
    for table in ("text", "json", "md", "csv"):
        assert render_failures("sm", Context(machine).failures, table)


CALLED = """\
name: sm
template: Base
outcomes: [done]
input_keys: [goal, limit]
userdata: {limit: 3}
states:
  - A: {template: ScriptedState, outcomes: [ok], input_keys: [goal, limit], transitions: {ok: B}}
  - B:
      template: CallbacksState
      output_keys: [goal]
      callbacks: {goal: 'lambda ud: 3'}
      transitions: {succeeded: C}
  - C: {template: ScriptedState, outcomes: [ok], input_keys: [goal], transitions: {ok: done}}
"""


def test_an_input_key_of_the_machine_is_a_promise_of_its_caller(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "main.yml").write_text(CALLED, "utf-8")
    for key, reads in (
        ("goal", ["by A: always set, if the caller of the machine sets it", "by C: always set"]),
        ("limit", ["by A: always set"]),
    ):
        assert main(["explain", str(tmp_path / "main.yml"), key]) == 0
        lines = capsys.readouterr().out.replace("read ", "     ").splitlines()
        found = [
            line.strip().partition(" (")[0] for line in lines if " set (" in line or "it (" in line
        ]
        assert found == reads


def test_without_a_failure_the_report_says_how_one_is_declared() -> None:
    text = render_failures("sm", [], "text")
    assert text.startswith("sm: no outcome of a state means a failure; `outcomes: {NAME: {failure")
