"""Counters that keep their old value when their loop runs again (SM319)."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN

TRIES = """\
name: sm
template: Base
outcomes: [done, given_up]
states:
  - GRASP:
      template: StateMachine
      outcomes: [held, lost]
      userdata: {tries: 0}
      states:
        - CLOSE:
            template: ScriptedState
            outcomes: [held, slipped]
            transitions: {held: held, slipped: COUNT}
        - COUNT:
            template: CallbacksState
            input_keys: [tries]
            output_keys: [tries]
            callbacks: {tries: 'lambda ud: ud.tries + 1'}
            transitions: {succeeded: AGAIN}
        - AGAIN:
            template: ConditionalOutcomeState
            input_keys: [tries]
            outcomes: [again]
            callbacks: {again: 'lambda ud: ud.tries < 3'}
            default_outcome: enough
            transitions: {again: CLOSE, enough: lost}
      transitions: {held: done, lost: LOOK}
  - LOOK:
      template: ScriptedState
      outcomes: [seen, gone, preempted]
      transitions: {seen: GRASP, gone: given_up, preempted: given_up}
"""
"""Three tries; then LOOK, and the container runs again."""

FLAT = """\
name: sm
template: Base
outcomes: [done]
userdata: {tries: 0}
states:
  - NEXT:
      template: ScriptedState
      outcomes: [found, none]
      transitions: {found: CLOSE, none: done}
  - CLOSE:
      template: ScriptedState
      outcomes: [held, slipped]
      transitions: {held: PLACE, slipped: COUNT}
  - COUNT:
      template: CallbacksState
      input_keys: [tries]
      output_keys: [tries]
      callbacks: {tries: 'lambda ud: ud.tries + 1'}
      transitions: {succeeded: AGAIN}
  - AGAIN:
      template: ConditionalOutcomeState
      input_keys: [tries]
      outcomes: [again]
      callbacks: {again: 'lambda ud: ud.tries < 3'}
      default_outcome: enough
      transitions: {again: CLOSE, enough: NEXT}
  - PLACE: {template: ScriptedState, outcomes: [placed], transitions: {placed: NEXT}}
"""
"""Three tries for each part; then the next part."""

SLOTS = """\
name: sm
template: Base
outcomes: [done]
states:
  - FILL:
      template: StateMachine
      outcomes: [full, empty]
      userdata: {slot: 0}
      states:
        - TAKE: {template: ScriptedState, outcomes: [ok, none], transitions: {ok: PUT, none: empty}}
        - PUT:
            template: ScriptedState
            outcomes: [ok]
            input_keys: [slot]
            transitions: {ok: COUNT}
        - COUNT:
            template: CallbacksState
            input_keys: [slot]
            output_keys: [slot]
            callbacks: {slot: 'lambda ud: ud.slot + 1'}
            transitions: {succeeded: FULL}
        - FULL:
            template: ConditionalOutcomeState
            input_keys: [slot]
            outcomes: [full]
            callbacks: {full: 'lambda ud: ud.slot >= 12'}
            default_outcome: more
            transitions: {full: full, more: TAKE}
      transitions: {full: done, empty: REFILL}
  - REFILL: {template: ScriptedState, outcomes: [ok], transitions: {ok: FILL}}
"""
"""An index that is continued after a refill."""


def changed(text: str, *changes: tuple[str, str]) -> str:
    for old, new in changes:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    return text


def found(text: str) -> list[Diagnostic]:
    """The findings of SM319 in a script without an error."""
    report = analyse(Source("main.yml", text), memory_library({}, BUILT_IN), []).report
    assert not [item.message for item in report if item.severity is Severity.ERROR]
    return [item for item in report if item.code == "SM319"]


AFTER = "      transitions: {held: done"
"""What follows the states of GRASP."""

SHOW = """\
        - SHOW:
            template: PrintUserdataState
            input_keys: [tries]
            transitions: {succeeded: lost}
"""
WAIT = """\
        - WAIT:
            template: SleepState
            time: 1
            transitions: {succeeded: held, preempted: lost}
"""
START = """\
        - START: {template: ScriptedState, outcomes: [ok], transitions: {ok: CLOSE}}
"""
SET = """\
        - SET:
            template: CallbacksState
            output_keys: [tries]
            callbacks: {tries: 'lambda ud: 0'}
            transitions: {succeeded: TARGET}
"""

LIMIT = [
    ("template: Base\noutcomes", "template: Base\nuserdata: {most: 3}\noutcomes"),
    ("      userdata: {tries: 0}", "      input_keys: [most]\n      userdata: {tries: 0}"),
    (
        "input_keys: [tries]\n            outcomes",
        "input_keys: [tries, most]\n            outcomes",
    ),
    ("ud.tries < 3", "ud.tries < ud.most"),
]

RENAMED = "remapping: {tries: count}\n            transitions"

ITEMS = "outcomes: [held, lost]\n      for_each: {item: part, in: %s, on: [held, lost]}"


def each_of(items: str) -> list[tuple[str, str]]:
    """The changes that make of the container one that runs for each item."""
    return [
        ("outcomes: [held, lost]", ITEMS % items),
        ("{held: done, lost: LOOK}", "{held: done, preempted: LOOK}"),
        ("seen: GRASP", "seen: done"),
    ]


WRONG = {
    "a cycle": [],
    "the items of a for_each": each_of("[1, 2]"),
    "a retry": [
        ("outcomes: [held, lost]", "outcomes: [held, lost]\n      retry: {on: [lost], max: 3}"),
        ("lost: LOOK}", "exhausted: LOOK, preempted: given_up}"),
        ("seen: GRASP", "seen: done"),
    ],
    "tries that are left": [
        ("{tries: 0}", "{tries: 3}"),
        ("ud.tries + 1", "ud.tries - 1"),
        ("ud.tries < 3", "ud.tries > 0"),
    ],
    "a condition that leaves the loop": [
        ("[again]", "[enough]"),
        ("again: 'lambda ud: ud.tries < 3'", "enough: 'lambda ud: 3 <= ud.tries'"),
        ("default_outcome: enough", "default_outcome: again"),
    ],
    "two conditions": [
        ("[again]", "[again, enough]"),
        ("ud.tries < 3'}", "ud.tries < 3', enough: 'lambda ud: ud.tries >= 3'}"),
        ("default_outcome: enough", "default_outcome: again"),
    ],
    "other ways to write it": [
        ("lambda ud: ud.tries + 1", 'lambda u: 1 + u["tries"]'),
    ],
    "a limit that nothing sets": LIMIT,
    "a remapped counter": [
        ("{tries: 0}", "{count: 0}"),
        ("transitions: {succeeded: AGAIN}", f"{RENAMED}: {{succeeded: AGAIN}}"),
        ("transitions: {again", f"{RENAMED}: {{again"),
    ],
    "a test before the count": [
        ("slipped: COUNT", "slipped: AGAIN"),
        ("succeeded: AGAIN", "succeeded: CLOSE"),
        ("again: CLOSE", "again: COUNT"),
    ],
    "a test at the beginning of a retry": [
        ("states:\n        - CLOSE", "initial: AGAIN\n      states:\n        - CLOSE"),
        ("[held, slipped]", "[held, failed]"),
        ("slipped: COUNT", "failed: COUNT"),
    ],
    "another state reads it on the way out": [
        ("enough: lost", "enough: SHOW"),
        (AFTER, SHOW + AFTER),
    ],
}


@pytest.mark.parametrize("changes", WRONG.values(), ids=WRONG)
def test_a_counter_is_still_at_its_limit(changes: list[tuple[str, str]]) -> None:
    (finding,) = found(changed(TRIES, *changes))
    assert "back to" in finding.message
    assert finding.message.endswith("when `GRASP` runs again: its initial value is set only once")
    assert finding.span.text in ("tries", "count")
    assert finding.effect == "from the second time on `AGAIN` ends the loop in its first round"


def test_the_places_the_path_and_the_help() -> None:
    (finding,) = found(TRIES)
    assert finding.message.startswith("nothing sets `tries` back to 0 when")
    assert [item.span.text for item in finding.related] == ["COUNT", "AGAIN"]
    assert finding.finding.path_labels == (
        "AGAIN", "(enough)", "LOOK", "(seen)", "GRASP", "CLOSE", "(slipped)", "COUNT",
        "(succeeded)", "AGAIN",
    )  # fmt: skip
    assert finding.help == (
        "add `- SET_TRIES: {template: CallbacksState, output_keys: [tries], callbacks: {tries:"
        " 'lambda ud: 0'}, transitions: {succeeded: CLOSE}}` as the first state of `GRASP`"
    )


def test_an_initial_state_is_named_in_the_help() -> None:
    head = "      userdata: {tries: 0}"
    (finding,) = found(
        changed(TRIES, (head, f"      initial: START\n{head}"), (AFTER, START + AFTER))
    )
    end = "{succeeded: START}}` to `GRASP`, and write `initial: SET_TRIES`"
    assert (finding.help or "").endswith(end)


def test_a_loop_around_the_loop_in_one_container() -> None:
    (finding,) = found(FLAT)
    assert finding.message == (
        "nothing sets `tries` back to 0 before the loop of `AGAIN`, `CLOSE`, `COUNT` begins again:"
        " its initial value is set only once"
    )
    assert finding.help is not None
    assert finding.help.endswith("{succeeded: CLOSE}}`, and lead `found` of `NEXT` to it")


def test_a_container_around_the_container_runs_again() -> None:
    inner = "\n".join("      " + row for row in TRIES.split("states:\n", 1)[1].split("\n"))
    text = (
        "name: sm\ntemplate: Base\noutcomes: [end]\nstates:\n  - WORK:\n"
        "      template: StateMachine\n      outcomes: [done, given_up]\n      states:\n"
        + inner.replace("lost: LOOK", "lost: given_up").split("        - LOOK")[0].rstrip()
        + "\n      transitions: {done: end, given_up: WORK}\n"
    )
    assert len(found(text)) == 1
    assert not found(text.replace("given_up: WORK}", "given_up: end}"))


def test_a_limit_that_is_passed_never_ends_the_loop() -> None:
    (finding,) = found(changed(TRIES, ("ud.tries < 3", "ud.tries != 3")))
    assert (
        finding.effect
        == "the second time `AGAIN` never ends the loop: `tries` has passed its limit"
    )


RETRY = [
    ("[held, slipped]", "[held, failed]"),
    ("slipped: COUNT", "failed: COUNT"),
    ("held: done, lost: LOOK}", "held: LOOK, lost: given_up}"),
    ("[seen, gone,", "[seen, gone, all_done,"),
    ("gone: given_up", "gone: given_up, all_done: done"),
]
"""After a success the container runs again, with the tries that are left."""


def test_the_tries_of_one_part_count_for_the_next_one() -> None:
    (finding,) = found(changed(TRIES, *RETRY))
    assert (
        finding.effect
        == "the next time the loop has fewer rounds: those of the last time count too"
    )


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("outcomes: [held, failed]", "outcomes: [held, slipped]"),
        ("      userdata: {tries: 0}", "      output_keys: [tries]\n      userdata: {tries: 0}"),
        ("outcomes: [held, failed]", "outcomes: [held, failed]\n            input_keys: [tries]"),
    ],
)
def test_a_count_that_may_be_meant_for_all_visits(old: str, new: str) -> None:
    text = changed(TRIES, *RETRY)
    if "slipped" in new:
        text = text.replace("failed: COUNT", "slipped: COUNT")
    assert not found(changed(text, (old, new)))


def test_a_declared_failure_is_a_retry() -> None:
    text = changed(TRIES, *RETRY).replace("failed: COUNT", "slipped: COUNT")
    text = text.replace("[held, failed]", "{held: {}, slipped: {failure: true}}")
    assert len(found(text)) == 1


RIGHT = {
    "it is set before the loop": [
        ("        - CLOSE:", SET.replace("TARGET", "CLOSE") + "        - CLOSE:"),
    ],
    "it is set on the way out": [
        ("enough: lost", "enough: SET"),
        (AFTER, SET.replace("TARGET", "lost") + AFTER),
    ],
    "another state may set it": [
        ("        - CLOSE:\n", "        - CLOSE:\n            output_keys: [tries]\n"),
    ],
    "the container does not run again": [("seen: GRASP", "seen: done")],
    "it counts once for each visit": [("again: CLOSE", "again: held")],
    "the caller sets it": [
        ("template: Base\noutcomes", "template: Base\nuserdata: {tries: 0}\noutcomes"),
        ("      userdata: {tries: 0}", "      input_keys: [tries]"),
    ],
    "it is handed in and out": [
        ("template: Base\noutcomes", "template: Base\nuserdata: {tries: 0}\noutcomes"),
        ("      userdata: {tries: 0}", "      input_keys: [tries]\n      output_keys: [tries]"),
    ],
    "every third round": [("ud.tries < 3", "ud.tries % 3 != 0")],
    "the loop has one round the first time too": [("ud.tries < 3", "ud.tries < 1")],
    "a limit that another state sets": [
        *LIMIT,
        ("outcomes: [seen, ", "output_keys: [most]\n      outcomes: [seen, "),
    ],
    "a condition with another value": [("ud.tries < 3", "ud.tries < 3 and random() < 0.5")],
    "a test first, as for the first visit only": [
        ("states:\n        - CLOSE", "initial: AGAIN\n      states:\n        - CLOSE"),
    ],
    "a for_each with one item": each_of("[1]"),
    "only after a stop": [
        ("enough: lost", "enough: WAIT"),
        (AFTER, WAIT + AFTER),
    ],
    "a word, not a number": [
        ("{tries: 0}", "{tries: a}"),
        ("ud.tries + 1", 'ud.tries + "a"'),
        ("ud.tries < 3", 'ud.tries != "aaa"'),
    ],
}


@pytest.mark.parametrize("changes", RIGHT.values(), ids=RIGHT)
def test_a_correct_neighbour(changes: list[tuple[str, str]]) -> None:
    assert not found(changed(TRIES, *changes))


def test_an_index_is_continued_after_an_interruption() -> None:
    assert not found(SLOTS)
    full = changed(SLOTS, ("{full: done,", "{full: REFILL,"))
    full = full.replace(
        "[ok], transitions: {ok: FILL}", "[ok, gone], transitions: {ok: FILL, gone: done}"
    )
    (finding,) = found(full)
    assert finding.message.startswith("nothing sets `slot` back to 0 when `FILL` runs again")


OPEN = "  - OPEN: {template: ScriptedState, outcomes: [ok], transitions: {ok: CLOSE}}\n"
BESIDE = SET.replace("        ", "  ", 1).replace("            ", "      ")

AROUND = {
    "another recovery": [("enough: NEXT", "enough: OPEN"), ("  - PLACE:", f"{OPEN}  - PLACE:")],
    "the first three parts only": [
        ("slipped: COUNT", "slipped: NEXT"),
        ("held: PLACE", "held: COUNT"),
        ("again: CLOSE", "again: NEXT"),
        ("enough: NEXT", "enough: PLACE"),
    ],
    "it is set": [
        ("found: CLOSE", "found: SET"),
        ("  - PLACE:", BESIDE.replace("TARGET", "CLOSE") + "  - PLACE:"),
    ],
    "no more parts": [("enough: NEXT", "enough: done")],
    "three failures in all": [
        ("[held, slipped]", "[held, failed]"),
        ("slipped: COUNT", "failed: COUNT"),
        ("enough: NEXT", "enough: done"),
    ],
}


@pytest.mark.parametrize("changes", AROUND.values(), ids=AROUND)
def test_a_correct_loop_around_the_loop(changes: list[tuple[str, str]]) -> None:
    assert not found(changed(FLAT, *changes))
