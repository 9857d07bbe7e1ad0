"""docs/checks.md shows what is printed, and says of SMACH what its semantics say."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import smachac
from smachac.commands.cli import main
from smachac.interpreter.behaviours import builtin_behaviour
from smachac.interpreter.interpreter import run
from smachac.interpreter.result import InterpreterResult
from smachac.interpreter.scenario import read_scenario, scenario_behaviour
from smachac.runtime import smach
from tests.support.golden import REWRITE

PAGE = Path(__file__).parents[2] / "docs" / "checks.md"
TEXT = PAGE.read_text("utf-8")
FILES = {
    block.split("\n", 1)[0].removeprefix("# "): block
    for block in re.findall(r"^```yaml\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
}
SHOWN = re.findall(r"^\$ smachac (.*)\n((?:(?!\$ |```).*\n)*)", TEXT, re.MULTILINE)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, "utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_there_are_ten_mistakes() -> None:
    assert len(FILES) == 10
    checked = {command.partition(" ")[2] for command, _ in SHOWN if command.startswith("check ")}
    assert checked == set(FILES)


@pytest.mark.parametrize(("command", "shown"), SHOWN)
def test_golden_commands_print_what_is_shown(
    command: str, shown: str, folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    main(shlex.split(command))
    found = capsys.readouterr().out
    if REWRITE:
        head = f"$ smachac {command}\n"
        PAGE.write_text(PAGE.read_text("utf-8").replace(head + shown, head + found), "utf-8")
        shown = found
    assert found == shown


@pytest.mark.parametrize("name", FILES)
def test_a_script_has_one_mistake(name: str, folder: Path) -> None:
    report = smachac.check(name)
    (code,) = {item.code for item in report if item.severity.value != "info"}
    row = re.search(rf"\| {code}, while you write \|", TEXT)
    assert row is not None


class Body(smach.State):
    """A state of SMACH that does what a function does."""

    def __init__(
        self, act: Callable[[Any], str], outcomes: list[str], inputs: tuple[str, ...] = ()
    ) -> None:
        smach.State.__init__(self, outcomes=outcomes, input_keys=list(inputs))
        self.act = act

    def execute(self, userdata: Any) -> str:
        return self.act(userdata)


def machine(**states: tuple[Any, dict[str, str]]) -> smach.StateMachine:
    whole = smach.StateMachine(outcomes=["delivered", "failed"])
    with whole:
        for name, (state, transitions) in states.items():
            smach.StateMachine.add(name, state, transitions=transitions)
    return whole


def test_smach_returns_none_for_a_target_that_does_not_exist() -> None:
    pick = Body(lambda _: "lost", ["held", "lost"])
    assert machine(PICK=(pick, {"held": "delivered", "lost": "ANOUNCE"})).execute() is None


def test_smach_leaves_by_the_name_of_an_outcome() -> None:
    pick = Body(lambda _: "failed", ["held", "failed"])
    assert machine(PICK=(pick, {"held": "delivered"})).execute() == "failed"


def test_smach_raises_when_a_key_is_read_that_stays_outside() -> None:
    inner = smach.StateMachine(outcomes=["held"])
    with inner:
        smach.StateMachine.add("REACH", Body(lambda ud: str(ud.grasp), ["held"], ("grasp",)))
    whole = machine(PICK=(inner, {"held": "delivered"}))
    whole.userdata.grasp = [0.5, 0.0, 0.1]
    with pytest.raises(smach.InvalidUserCodeError):
        whole.execute()


def test_smach_raises_on_the_way_on_which_a_key_is_unset() -> None:
    look = Body(lambda _: "nothing", ["nothing"])
    pick = Body(lambda ud: str(ud.grasp), ["held"], ("grasp",))
    whole = machine(LOOK=(look, {"nothing": "PICK"}), PICK=(pick, {"held": "delivered"}))
    with pytest.raises(smach.InvalidUserCodeError):
        whole.execute()


def test_smach_does_not_look_at_states_that_nothing_leads_to() -> None:
    there = (Body(lambda _: "held", ["held"]), {"held": "delivered"})
    assert machine(PICK=there, LET_GO=there).execute() == "delivered"


def played(name: str, states: dict[str, object]) -> InterpreterResult:
    """How a script of the page ends when its states do as a scenario says."""
    whole = smachac.load(name)
    scenario, wrong = read_scenario({"states": states}, whole)
    assert not wrong
    return run(whole, scenario_behaviour(scenario, whole, builtin_behaviour()))


def test_one_arm_fails_and_all_is_well(folder: Path) -> None:
    assert played("masked.yml", {"LEFT": "failed"}).outcome == "delivered"


def test_a_rule_that_holds_alone_decides(folder: Path) -> None:
    assert played("tie.yml", {"MOVE": "blocked"}).outcome == "failed"
