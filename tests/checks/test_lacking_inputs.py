"""Input keys that a container lacks, although its remapping and its states use them, are one
finding."""

from __future__ import annotations

from tests.trust.project_text import MAIN, analysed

SUB = """- MOVE:
    template: StateMachine
    outcomes: [moved]
    input_keys: [from_slot, to_slot]
    states:
    - GRIP:
        template: ScriptedState
        input_keys: [from_slot]
        outcomes: [held]
        transitions: {held: CARRY}
    - CARRY:
        template: ScriptedState
        input_keys: [to_slot]
        outcomes: [there]
        transitions: {there: moved}
"""

SCRIPT = """name: plates
template: Base
outcomes: [done]
userdata: {hotel: 4, reader: 1}
states:
- THERE:
    script: move
    remapping: {from_slot: hotel, to_slot: reader}
    transitions: {moved: BACK}
- BACK:
    script: move
    remapping: {from_slot: reader, to_slot: hotel}
    transitions: {moved: done}
"""


def test_lost_input_keys_of_a_sub_script_are_one_finding() -> None:
    assert analysed({MAIN: SCRIPT, "move.yml": SUB}).report == []
    sub = SUB.replace("    input_keys: [from_slot, to_slot]\n", "")
    (found,) = analysed({MAIN: SCRIPT, "move.yml": sub}).report
    assert (found.code, found.span.text) == ("SM302", "from_slot")
    assert found.help == "write `input_keys: [from_slot, to_slot]` in the state of `move.yml`"


def test_one_lost_key_keeps_the_others() -> None:
    sub = SUB.replace("[from_slot, to_slot]", "[from_slot]")
    (found,) = analysed({MAIN: SCRIPT, "move.yml": sub}).report
    assert (found.code, found.span.text) == ("SM302", "to_slot")
    assert found.help == "write `input_keys: [from_slot, to_slot]` in the state of `move.yml`"


def test_a_key_that_no_state_reads_is_an_unknown_one() -> None:
    script = SCRIPT.replace(
        "{from_slot: hotel, to_slot: reader}", "{from_slot: hotel, speed: reader}"
    )
    found = analysed({MAIN: script, "move.yml": SUB}).report
    assert ("SM302", "speed") in [(item.code, item.span.text) for item in found]
