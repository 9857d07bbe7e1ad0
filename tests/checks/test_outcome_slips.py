"""Slips around outcomes, outputs and messages: one finding at the cause, and what to write."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported
from tests.trust.judged_repairs import printed, shown
from tests.trust.project_text import analysed

WATCH = """\
name: sm
template: Base
outcomes: [succeeded, aborted]
states:
  - LOOK:
      template: ScriptedState
      outcomes: [OUTCOMES]
      transitions: {TRANSITIONS}
  - SAY:
      template: ScriptedState
      outcomes: [said]
      transitions: {said: succeeded}
"""


def look(outcomes: str, transitions: str) -> list[tuple[str, str, str | None]]:
    script = WATCH.replace("OUTCOMES", outcomes).replace("TRANSITIONS", transitions)
    return reported({"main.yml": script})


@pytest.mark.parametrize(
    ("outcomes", "transitions", "found"),
    [
        # a success and a failure with other words
        ("valid, lost", "succeeded: SAY, lost: aborted", [("succeeded", "valid")]),
        ("valid, failed", "succeeded: SAY, aborted: aborted",
         [("succeeded", "valid"), ("aborted", "failed")]),
        # the only outcome that is left
        ("seen, empty", "seen: SAY, nothing: aborted", [("nothing", "empty")]),
        # a near name comes first
        ("found, lost", "fuond: SAY, gone: aborted", [("fuond", "found"), ("gone", "lost")]),
    ],
)  # fmt: skip
def test_an_unknown_outcome_is_the_one_without_a_transition(
    outcomes: str, transitions: str, found: list[tuple[str, str]]
) -> None:
    helps = [("SM102", word, f"did you mean `{meant}`?") for word, meant in found]
    assert look(outcomes, transitions) == helps


def test_an_unknown_outcome_that_can_mean_several() -> None:
    found = look("left, right, lost", "seen: SAY, lost: aborted")
    assert [(code, help) for code, _, help in found] == [
        ("SM102", "use one of its outcomes: `left`, `lost`, `right`")
    ]


@pytest.mark.parametrize(
    ("outcomes", "transitions", "help"),
    [
        ("seen, lost", "seen: SAY",
         "add `lost: aborted` to the transitions of `LOOK`"),
        ("done, failed", "failed: aborted",
         "add `done: SAY` to the transitions of `LOOK`"),
        ("seen, lost, gone", "", "write `transitions: {seen: SAY, lost: aborted, gone: aborted}` in"
         " `LOOK`"),
    ],
)  # fmt: skip
def test_a_missing_transition_has_a_target(outcomes: str, transitions: str, help: str) -> None:
    assert ("SM104", "LOOK", help) in look(outcomes, transitions)


OUTPUTS = """\
name: sm
template: Base
outcomes: [done]
states:
  - FIND:
      template: StateMachine
      outcomes: [found]
      output_keys: [psoe]
      states:
        - LOOK:
            template: ScriptedState
            outcomes: [seen]
            output_keys: [pose]
            steps: [{outcome: seen, set: {pose: 0.5}}]
            transitions: {seen: found}
      transitions: {found: GRASP}
  - GRASP: {template: PrintUserdataState, input_keys: [pose], transitions: {succeeded: done}}
"""


def test_a_misspelt_output_key_of_a_container() -> None:
    ((_, place, help),) = printed({"main.yml": OUTPUTS})
    assert place == "psoe"
    assert help.startswith("did you mean `pose`?")


PUBLISH = """\
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {msg: MESSAGE, msg_type: std_msgs/Bool}
states:
  - SAY:
      template: PublishMsgState
      action: start
      input_keys: [msg, msg_type]
      transitions: {succeeded: done, aborted: failed}
"""


@pytest.mark.parametrize(
    ("message", "found"),
    [
        ("{data: true}", []),
        ("{date: true}", [("SM512", "date", "did you mean `data`?")]),
        ("{data: 3}", [("SM512", "3", "write a value of the type `bool`, such as `true`")]),
    ],
)
def test_the_messages_of_every_installation_are_known(
    message: str, found: list[tuple[str, str, str]]
) -> None:
    assert reported({"main.yml": PUBLISH.replace("MESSAGE", message)}) == found


def test_a_message_without_its_type_is_one_finding() -> None:
    script = PUBLISH.replace("MESSAGE", "{data: true}").replace("[msg, msg_type]", "[msg]")
    assert [code for code, *_ in printed({"main.yml": script})] == ["SM515"]


def test_a_state_with_two_transitions_to_its_wrong_name() -> None:
    script = WATCH.replace("OUTCOMES", "done, again, lost").replace("- SAY", "- SPAEK")
    script = script.replace("TRANSITIONS", "done: SPEAK, again: SPEAK, lost: aborted")
    found = analysed({"main.yml": script}).report
    assert [(item.code, item.span.text, item.help) for item in found] == [
        ("SM101", "SPEAK", "did you mean `SPAEK`?")
    ]
    assert [one.span.text for one in found[0].related] == ["SPEAK"]
    items, repair = shown(analysed({"main.yml": script}))
    assert len(items) == 1
    assert repair is not None
    assert [(edit.span.text, edit.text) for edit in repair.edits] == [("SPAEK", "SPEAK")]


def test_the_only_variable_under_another_name() -> None:
    script = WATCH.replace("OUTCOMES", "done, lost")
    script = script.replace("TRANSITIONS", "done: WAIT, lost: aborted")
    wait = "  - WAIT: {template: SleepState, duration: 1.5, transitions: {succeeded: SAY}}\n"
    found = reported({"main.yml": script.replace("  - SAY", wait + "  - SAY")})
    assert found == [("SM003", "duration", "did you mean `time`?")]


def test_the_role_of_a_variable_means_the_variable() -> None:
    script = """\
name: sm
template: Base
outcomes: [done]
userdata: {n: 1}
states:
  - ASK:
      template: ConditionalOutcomeState
      outcomes: [low]
      input_keys: [n]
      conditions: {low: 'lambda ud: ud.n < 3'}
      default_outcome: high
      transitions: {low: done, high: done}
"""
    assert reported({"main.yml": script}) == [("SM003", "conditions", "did you mean `callbacks`?")]
