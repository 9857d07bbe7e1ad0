"""Slips in the scripts of people who know another tool: one finding at the fault, and a help that
shows what to write."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import Source
from smachac.driver import CODES
from smachac.frontend.config import read_project
from smachac.frontend.errors.references import package_help
from smachac.repair.search import again, clusters
from smachac.robots.fields import DataError, named, number
from tests.trust.judged_repairs import shown
from tests.trust.project_text import analysed

PATROL = """\
name: patrol
outcomes: [succeeded, aborted]
userdata: {blocks: [red, green]}
states:
  - LOOK:
      template: ScriptedState
      input_keys: [blocks]
      outcomes: [found, nothing]
      transitions: {found: GRAB, nothing: aborted}
  - GRAB:
      template: ScriptedState
      outcomes: [held, slipped]
      transitions: {held: BOTH, slipped: LET_GO}
  - BOTH:
      template: Concurrence
      outcomes: [ready, not_ready]
      default_outcome: not_ready
      outcome_map: {ready: {LIGHT: done, DRIVE: done}}
      transitions: {ready: succeeded, not_ready: EACH}
      states:
        - LIGHT: {template: ScriptedState, outcomes: [done]}
        - DRIVE: {template: ScriptedState, outcomes: [done, lost]}
  - EACH:
      template: Iterator
      outcomes: [counted, aborted]
      input_keys: [blocks]
      it: blocks
      it_label: block
      exhausted_outcome: placed
      loop_outcomes: [put]
      final_outcome_map: {placed: counted, put: aborted}
      transitions: {counted: succeeded, aborted: LET_GO}
      states:
        - PUT:
            template: ScriptedState
            input_keys: [block]
            outcomes: [put, aborted]
  - LET_GO:
      template: ScriptedState
      outcomes: [open]
      transitions: {open: aborted}
"""


def reported(files: Mapping[str, str]) -> list[tuple[str, str, str | None]]:
    """Code, text at the place, and help of each finding above an info."""
    return [
        (item.code, item.span.text, item.finding.help)
        for item in analysed(files).report
        if item.severity is not Severity.INFO
    ]


def test_the_script_has_no_fault() -> None:
    assert reported({"main.yml": PATROL}) == []


MAPPINGS = [
    (
        "{found: GRAB, nothing: aborted}",
        "[found: GRAB, nothing: aborted]",
        "SM004",
        "write one mapping: `{found: GRAB, nothing: aborted}`",
    ),
    (
        "{found: GRAB, nothing: aborted}",
        "{found: GRAB, [nothing]: aborted}",
        "SM004",
        "write an entry for each name: `nothing: aborted`",
    ),
    ("{blocks: [red, green]}", "[blocks]", "SM004", "with a value for each name: `{blocks: ...}`"),
    (
        "{held: BOTH, slipped: LET_GO}",
        "{held: BOTH slipped: LET_GO}",
        "SM001",
        "write `transitions: {held: BOTH, slipped: LET_GO}`",
    ),
    ("    it: blocks", "    it: 3", "SM004", "a loop of 3 turns has the items `[0, 1, 2]`"),
    (
        "    it: blocks",
        "    it: 30",
        "SM004",
        "a loop of 30 turns has the items '`range(30)`', with",
    ),
    (
        "default_outcome: not_ready",
        "join: first\n      default_outcome: not_ready",
        "SM004",
        "any`",
    ),
    (
        "default_outcome: not_ready",
        "join: ayn\n      default_outcome: not_ready",
        "SM004",
        "`any`?",
    ),
    (
        "states:\n  - LOOK",
        "on_error: {TimeoutError: LET_GO}\nstates:\n  - LOOK",
        "SM004",
        ": LET_GO`",
    ),
    ("states:\n  - LOOK", "robot: [panda, baxter]\nstates:\n  - LOOK", "SM004", "with `parts:`"),
    ("  - GRAB:\n", "    GRAB:\n", "SM004", "begin another item with `- GRAB:`"),
    ("  - GRAB:\n", "---\n  - GRAB:\n", "SM004", "remove the `---`: a script is one document"),
    (
        "default_outcome: not_ready",
        "initial: DRIVE\n      default_outcome: not_ready",
        "SM003",
        "only `Sequence` and `StateMachine` and the script itself can have `initial`",
    ),
    (
        "      outcomes: [held, slipped]",
        "      outcomes: [held, slipped]\n      scene: table.yml",
        "SM003",
        "write it at the top of the script: no state has `scene`",
    ),
    (
        "      outcomes: [held, slipped]",
        "      outcomes: [held, slipped]\n     \u00a0steps: []",
        "SM001",
        "replace it with spaces",
    ),
    (
        "      outcomes: [held, slipped]",
        "\u00a0     outcomes: [held, slipped]",
        "SM001",
        "replace it with spaces",
    ),
]


@pytest.mark.parametrize(("before", "after", "code", "help"), MAPPINGS)
def test_a_slip_is_one_finding_that_shows_what_to_write(
    before: str, after: str, code: str, help: str
) -> None:
    assert PATROL.count(before) == 1
    (found,) = reported({"main.yml": PATROL.replace(before, after)})
    assert found[0] == code
    assert help in (found[2] or "")


PLACES = [
    (
        "slipped: LET_GO}",
        "default: LET_GO}",
        "SM102 default",
        "each outcome has its own transition: write `slipped: LET_GO`",
    ),
    (
        "{ready: {LIGHT: done, DRIVE: done}}",
        "{LIGHT: {done: ready}, DRIVE: {done: ready}}",
        "SM103 LIGHT",
        "the outcome comes first: `outcome_map: {ready: {LIGHT: done, DRIVE: done}}`",
    ),
    (
        "{placed: counted, put: aborted}",
        "{counted: placed, put: aborted}",
        "SM403 counted",
        "write `placed: counted`: the outcome that is renamed comes first",
    ),
    (
        "{placed: counted, put: aborted}",
        "{placed: counted, put: aborted, lost: aborted}",
        "SM403 lost",
        "with which it can end: `aborted`, `placed`, `put`",
    ),
    (
        "  - LET_GO:",
        "  - PARK:  # smachac: allow SM210 later\n      template: ScriptedState\n"
        "      outcomes: [open]\n      transitions: {open: aborted}\n  - LET_GO:",
        "SM021 SM210",
        "on this line SM201 occurs: correct its fault, or write `allow SM201`",
    ),
    (
        "      template: ScriptedState\n      outcomes: [held, slipped]",
        "      class: flexbe_states.grab.Grab\n      outcomes: [held, slipped]",
        "SM005 class",
        "write `template:` in place of `class:`",
    ),
]


@pytest.mark.parametrize(("before", "after", "place", "help"), PLACES)
def test_a_finding_of_a_rule_is_at_the_slip(before: str, after: str, place: str, help: str) -> None:
    assert PATROL.count(before) == 1
    found = reported({"main.yml": PATROL.replace(before, after)})
    (mine,) = [item for item in found if f"{item[0]} {item[1]}" == place]
    assert help in (mine[2] or "")
    assert "SM019" not in [code for code, _, _ in found]


def test_a_transition_for_all_other_outcomes_is_one_finding() -> None:
    main = PATROL.replace("slipped: LET_GO}", "default: LET_GO}")
    assert [code for code, _, _ in reported({"main.yml": main})] == ["SM102"]


def test_an_inverted_outcome_map_is_one_finding() -> None:
    inverted = "{LIGHT: {done: ready}, DRIVE: {done: ready}}"
    main = PATROL.replace("{ready: {LIGHT: done, DRIVE: done}}", inverted)
    assert [code for code, _, _ in reported({"main.yml": main})] == ["SM103"]


def test_a_comment_beside_a_number() -> None:
    main = PATROL.replace(
        "template: ScriptedState\n      outcomes: [held, slipped]",
        "template: SleepState\n      time: 0.5# short",
    )
    found = {code: help for code, _, help in reported({"main.yml": main})}
    assert found["SM304"] == "a comment needs a space before its `#`: `0.5 # short`"


SETTINGS = [
    (
        "smachac.toml",
        '[tool.smachac]\nscripts = ["parts"]\n',
        "write its settings without a table, and `[severity]` for the severities",
    ),
    ("pyproject.toml", '[smachac]\nscripts = ["parts"]\n', "write `[tool.smachac]`"),
    ("smachac.toml", "[severity]\nSM105 = off\n", 'write `"off"`'),
    ("smachac.toml", '[severity]\nSM105 = "ignore"\n', "did you mean `off`?"),
]


@pytest.mark.parametrize(("name", "text", "help"), SETTINGS)
def test_a_slip_in_the_settings(name: str, text: str, help: str) -> None:
    report: Report = []
    read_project(Source(name, text), Path(name), report, CODES)
    assert [(item.code, item.finding.help) for item in report] == [("SM007", help)]


def test_another_tool_may_have_a_table_of_that_name() -> None:
    report: Report = []
    text = '[smachac]\nline = 3\n[project]\nname = "cell"\n'
    assert read_project(Source("pyproject.toml", text), Path("pyproject.toml"), report) is None
    assert report == []


DATA = [
    ([{"table": {}}], "write `table:` with its keys below it, without the `-`"),
    (
        [{"name": "arm", "home": []}],
        "write `arm:` with its keys below it, without the `-`, without `name:` inside",
    ),
    (["arm"], "write a name for each, with its keys below it: `name: {...}`"),
]


@pytest.mark.parametrize(("data", "help"), DATA)
def test_a_list_in_place_of_named_values(data: object, help: str | None) -> None:
    with pytest.raises(DataError) as raised:
        named(number)(data, ())
    assert raised.value.help == help


NUMBERS = [
    ("0.2kg", "write the number without its unit: `0.2`"),
    ("40 mm", "write the number without its unit: `0.04`"),
    ("90deg", "write the number without its unit: `1.570796327`"),
    ("0,5", "a decimal comma? write `0.5`"),
    ("heavy", "write a finite number, as in `0.5`"),
]


@pytest.mark.parametrize(("data", "help"), NUMBERS)
def test_a_number_with_its_unit(data: str, help: str | None) -> None:
    with pytest.raises(DataError) as raised:
        number(data, ())
    assert raised.value.help == help


@pytest.mark.parametrize(
    ("path", "help"),
    [
        (
            "package://arm/urdf/arm.urdf",
            "`package://` is not replaced here: write the path from this file, such as `arm.urdf`",
        ),
        ("urdf/arm.urdf", None),
    ],
)
def test_a_path_that_ros_replaces(path: str, help: str | None) -> None:
    assert package_help(path) == help


CALL = """\
name: pick
outcomes: [succeeded]
states:
  - LEFT:
      script: grip
      params: {limb: left}
      transitions: {done: succeeded}
"""
GRIP = """\
- GRIP:
    template: ScriptedState
    doc: [params, limb]
    outcomes: [done]
"""


def test_a_param_beside_params() -> None:
    main = CALL.replace("params: {limb: left}", "limb: left")
    assert reported({"main.yml": main, "grip.yml": GRIP}) == [
        ("SM003", "limb", "`limb` is a param of the sub-script: write it inside `params:`")
    ]


@pytest.mark.parametrize("word", ["param", "parmas", "Params"])
def test_a_misspelt_look_up(word: str) -> None:
    grip = GRIP.replace("[params,", f"[{word},")
    assert reported({"main.yml": CALL, "grip.yml": grip}) == [
        ("SM004", word, "did you mean `[params, limb]`?")
    ]


def test_a_call_by_a_path_that_ros_replaces() -> None:
    main = CALL.replace("script: grip", "script: $(find cell)/scripts/grip.yml")
    assert reported({"main.yml": main, "grip.yml": GRIP})[-1][2] == (
        "write `script: grip`, and add its folder to `scripts = [...]` in `smachac.toml`"
    )


def test_a_call_of_a_machine() -> None:
    grip = "name: grip\noutcomes: [done]\nstates: []\n"
    assert reported({"main.yml": CALL, "grip.yml": grip})[-1][2] == (
        "write `- GRIP:` first, and indented below it `template: StateMachine` and the rest"
        " without `name:`"
    )


def test_a_list_whose_second_text_is_no_param() -> None:
    grip = GRIP.replace("[params, limb]", "[params, limb]\n    steps: [param, left]")
    assert "SM004" not in [code for code, _, _ in reported({"main.yml": CALL, "grip.yml": grip})]


def test_a_look_up_in_the_braces_of_jinja() -> None:
    grip = GRIP.replace("[params, limb]", "{{ params.limb }}")
    assert reported({"main.yml": CALL, "grip.yml": grip}) == [
        ("SM004", "{{ params.limb }}", "a param is looked up with `[params, limb]`")
    ]


@pytest.mark.parametrize(
    ("loop", "more"),
    [
        ("block in blocks", ""),
        ("{block: blocks}", ""),
        ("{block: blocks, exhausted: done}", "; there is no part `exhausted`"),
    ],
)
def test_a_loop_in_another_form(loop: str, more: str) -> None:
    main = PATROL.replace(
        "      transitions: {held: BOTH, slipped: LET_GO}",
        f"      for_each: {loop}\n      input_keys: [block]\n"
        "      transitions: {held: BOTH, slipped: LET_GO, preempted: aborted}",
    )
    assert reported({"main.yml": main}) == [
        ("SM004", loop, "write `for_each: {item: block, in: blocks}`" + more)
    ]


def test_the_item_of_a_loop_under_another_name_is_marked() -> None:
    main = PATROL.replace(
        "      transitions: {held: BOTH, slipped: LET_GO}",
        "      for_each: {item: blok, in: blocks, on: [held]}\n      input_keys: [block]\n"
        "      transitions: {held: BOTH, slipped: LET_GO, preempted: aborted}",
    )
    (found,) = (item for item in analysed({"main.yml": main}).report if item.code == "SM301")
    marked = [(one.span.text, one.message) for one in found.finding.related]
    assert ("blok", "the loop calls its item `blok`") in marked


def test_outcomes_that_fields_of_a_state_add() -> None:
    main = PATROL.replace(
        "      transitions: {held: BOTH, slipped: LET_GO}",
        "      timeout: 5s\n      retry: {on: [slipped], max: 3}\n"
        "      transitions: {held: BOTH, exhausted: LET_GO}",
    )
    found = [item.finding for item in analysed({"main.yml": main}).report if item.code == "SM104"]
    marked = [(each.span.text, each.message) for one in found for each in one.related]
    assert marked == [
        ("timeout", "`timeout` adds the outcome `preempted`"),
        ("timeout", "`timeout` adds the outcome `timeout`"),
    ]
    assert (found[0].help or "").startswith("after a stop request `timeout` ends with it: add")
    assert (found[1].help or "").startswith("add `timeout` to `on` of `retry` if the state must")


GRAB = """\
name: Grab
variables: {limb: {one_of: [left, right]}, force: {type: float, min: 0, max: 1}}
input_keys: [blocks]
output_keys: [width]
outcomes: [held, slipped]
writes: {held: [width]}
code: {python: "grab:Grab"}
"""

GRAB_CODE = """\
import smach


class Grab(smach.State):
    def __init__(self, limb, force):
        smach.State.__init__(
            self, ["held", "slipped"], input_keys=["blocks"], output_keys=["width"]
        )
        self.limb = limb
        self.force = force

    def execute(self, userdata):
        if not userdata.blocks:
            return "slipped"
        userdata.width = self.force
        return "held"
"""

WITH_GRAB = PATROL.replace(
    "ScriptedState\n      outcomes: [held, slipped]",
    "Grab\n      limb: left\n      force: 0.5\n      input_keys: [blocks]",
)


def test_an_interface_with_lists_of_keys_and_outcomes() -> None:
    files = {"main.yml": WITH_GRAB, "templates/Grab.yml": GRAB, "grab.py": GRAB_CODE}
    assert reported(files) == []
    typo = GRAB_CODE.replace('return "slipped"', 'return "sliped"')
    assert [code for code, _, _ in reported(files | {"grab.py": typo})] == ["SM309"]


def test_an_interface_whose_list_has_a_name_twice() -> None:
    grab = GRAB.replace("[held, slipped]", "[held, slipped, held]")
    files = {"main.yml": WITH_GRAB, "templates/Grab.yml": grab, "grab.py": GRAB_CODE}
    assert [(code, text) for code, text, _ in reported(files)] == [("SM002", "held")]


@pytest.mark.parametrize("word", ["params", "parameters", "arguments", "variabels"])
def test_an_interface_with_another_word_for_variables(word: str) -> None:
    grab = GRAB.replace("variables:", f"{word}:")
    files = {"main.yml": WITH_GRAB, "templates/Grab.yml": grab, "grab.py": GRAB_CODE}
    assert reported(files) == [("SM003", word, "did you mean `variables`?")]


def test_a_state_with_its_variables_in_params() -> None:
    main = WITH_GRAB.replace("limb: left\n      force: 0.5", "params: {limb: left, force: 0.5}")
    files = {"main.yml": main, "templates/Grab.yml": GRAB, "grab.py": GRAB_CODE}
    help = "write `{}:` beside `params:`; `params` has only constants for look-ups"
    assert set(reported(files)) == {
        ("SM005", "limb", help.format("limb")),
        ("SM005", "force", help.format("force")),
    }


def test_a_missing_variable_has_an_example_that_its_interface_allows() -> None:
    main = WITH_GRAB.replace("limb: left\n      force: 0.5\n      ", "")
    files = {"main.yml": main, "templates/Grab.yml": GRAB, "grab.py": GRAB_CODE}
    assert {help for _, _, help in reported(files)} == {"add `limb: left`", "add `force: 0.5`"}


@pytest.mark.parametrize("folder", ["cell", "cell/arm"])
def test_a_state_type_in_a_folder_that_is_not_searched(folder: str) -> None:
    files = {"main.yml": WITH_GRAB, f"{folder}/Grab.yml": GRAB, "grab.py": GRAB_CODE}
    assert reported(files) == [
        (
            "SM013",
            "Grab",
            f"`{folder}` has `Grab`, but is not searched: write `--templates {folder}`, or add the"
            f" folder to `templates = [...]` in `smachac.toml`",
        )
    ]


def test_a_sub_script_in_a_folder_that_is_not_searched() -> None:
    (fault,) = reported({"main.yml": CALL, "parts/grip.yml": GRIP})
    assert fault[:2] == ("SM011", "grip")
    assert fault[2] == (
        "`parts` has `grip`, but is not searched: write `--scripts parts`, or add the folder to"
        " `scripts = [...]` in `smachac.toml`"
    )


@pytest.mark.parametrize(
    ("before", "after", "place", "help"),
    [
        (
            "      transitions: {found: GRAB, nothing: aborted}",
            "    transitions: {found: GRAB, nothing: aborted}",
            "transitions",
            "indent `transitions` by 6 spaces, like `outcomes`",
        ),
        (
            "  - LET_GO:\n      template: ScriptedState\n      outcomes: [open]\n      trans",
            "  - LET_GO: {template: ScriptedState, outcomes: [open]}\n    trans",
            "transitions",
            "write it inside the braces of `LET_GO`: it is a field of the state",
        ),
    ],
)
def test_a_field_that_is_indented_too_little(
    before: str, after: str, place: str, help: str
) -> None:
    assert before in PATROL
    code = "SM001" if help.startswith("indent") else "SM004"
    assert reported({"main.yml": PATROL.replace(before, after)}) == [(code, place, help)]


@pytest.mark.parametrize(
    ("retry", "place", "help"),
    [
        ("{on: [slipped], maximum: 3}", "maximum", "did you mean `max`?"),
        ("{when: [slipped], max: 3}", "when", "did you mean `on`?"),
        ("{on: [slipped], max: 3, pause: 1s}", "pause", "did you mean `delay`?"),
        ("{on: [slipped], max: 3, backof: 1}", "backof", "use one of its parts: `delay`"),
        (
            "{on: [slipped], max: 3, delay: 1s, backoff: 1}",
            "backoff",
            "remove it: `retry` has no other parts",
        ),
    ],
)
def test_parts_of_retry(retry: str, place: str, help: str) -> None:
    main = PATROL.replace(
        "{held: BOTH, slipped: LET_GO}",
        f"{{held: BOTH, exhausted: LET_GO, preempted: aborted}}\n      retry: {retry}",
    )
    assert reported({"main.yml": main}) == [("SM003", place, help)]


@pytest.mark.parametrize(
    ("fact", "value"),
    [
        ("{type: int, min: 5}", "6"),
        ("{type: int, max: -5}", "-6"),
        ("{type: float, min: 2}", "3.0"),
        ("{type: float, max: 1}", "0.0"),
        ("{type: float, min: 3, max: 4, exclusive: true}", "3.5"),
        ("{type: int, one_of: [4, 8]}", "4"),
        ("{type: int, min: 1}", "3"),
        ("{type: float, min: 1.0e+308}", None),
        ("{type: int, min: 10, max: 10}", "10"),
    ],
)
def test_an_example_within_the_limits_of_a_variable(fact: str, value: str | None) -> None:
    main = WITH_GRAB.replace("force: 0.5\n      ", "")
    grab = GRAB.replace("{type: float, min: 0, max: 1}", fact)
    files = {"main.yml": main, "templates/Grab.yml": grab, "grab.py": GRAB_CODE}
    ((code, _, help),) = [item for item in reported(files) if item[0] != "SM304"]
    assert code == "SM005"
    assert value is None or help == f"add `force: {value}`"


def test_a_misspelt_container_type_has_no_consequences() -> None:
    main = PATROL.replace("template: Concurrence", "template: Concurence")
    ((code, place, help),) = reported({"main.yml": main})
    assert (code, place) == ("SM013", "Concurence")
    assert help is not None
    assert help.startswith("did you mean `Concurrence`?")


NESTED = """\
name: sm
outcomes: [done, aborted]
states:
  - PICK:
      template: StateMachine
      outcomes: [held, aborted]
      transitions: {held: CARRY, aborted: aborted}
      states:
        - GRIP:
            template: ScriptedState
            outcomes: [closed, slipped]
            transitions: {closed: held, slipped: aborted}
  - CARRY:
      template: ScriptedState
      outcomes: [done]
      transitions: {done: done}
"""


def test_a_transition_out_of_a_container() -> None:
    assert reported({"main.yml": NESTED}) == []
    main = NESTED.replace("closed: held", "closed: CARRY")
    assert (
        "SM101",
        "CARRY",
        "write `closed: held`: the outcome `held` of `PICK` leads to `CARRY`",
    ) in reported({"main.yml": main})
    main = NESTED.replace("slipped: aborted", "slipped: PICK")
    assert reported({"main.yml": main})[0] == (
        "SM101",
        "PICK",
        "use a state or an outcome of `PICK`: `GRIP`, `aborted`, `held`; the state `PICK` in `sm`"
        " cannot be a target here",
    )


def test_a_function_without_quotes_in_braces() -> None:
    main = PATROL.replace("userdata: {blocks: [red, green]}", "userdata: {blocks: lambda ud: []}")
    assert [item[0::2] for item in reported({"main.yml": main})] == [
        ("SM001", "put the code in quotes: `'lambda ud: ...'`")
    ]


def test_the_path_of_an_unset_key_has_no_state_that_a_field_adds() -> None:
    main = PATROL.replace("transitions: {held: BOTH, slipped: LET_GO}", "input_keys: [pose]\n"
        "      retry: {on: [slipped], max: 3, delay: 1s}\n"
        "      transitions: {held: BOTH, exhausted: LET_GO, preempted: LET_GO}")  # fmt: skip
    (found,) = (item for item in analysed({"main.yml": main}).report if item.code == "SM301")
    labels = [step.label for step in found.finding.path]
    assert labels[0] == "LOOK"
    assert labels[-1] == "GRAB"
    assert labels.count("GRAB") == 1
    assert "PAUSE" not in labels


TOPICS = """
name: sm
template: ROSBase
outcomes: [done, failed]
params: {{space: /arm}}
states:
  - WAIT:
      template: WaitForMsgState
      topic: {topic}
      msg_type: std_msgs/Bool
      timeout: 5.0
      transitions: {{succeeded: CALL, aborted: failed, preempted: failed}}
  - CALL:
      template: ServiceState
      service_namespace: {topic}
      service: std_srvs/Trigger
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""


@pytest.mark.parametrize("topic", ["[[space], /load]", "[/load, [space]]"])
def test_a_list_in_place_of_a_text_with_a_look_up(topic: str) -> None:
    items, _ = shown(analysed({"main.yml": TOPICS.format(topic=topic)}))
    assert any(item.span.text == topic for item in items)
    assert any("[params, space]" in str(item.help) for item in items)


@pytest.mark.parametrize("topic", ["[[params, space], /load]", "[[[space]], /load]"])
def test_a_look_up_in_a_text(topic: str) -> None:
    assert reported({"main.yml": TOPICS.format(topic=topic)}) == []


HEAD = "name: sm\noutcomes: [done, failed]\nstates:\n"

FIRST = {
    "two unknown types": (
        """\
- A:
    template: CallbackState
    callbacks: {n: 'lambda ud: 1'}
    transitions: {succeeded: B}
- B:
    template: Concurrent
    outcomes: [done]
    default_outcome: done
    states:
    - C: {template: SleepState, time: 1}
    - D: {template: SleepState, time: 2}
    outcome_map: {done: {C: succeeded, D: succeeded}}
    transitions: {done: done}
""",
        [
            ("SM013", "CallbackState", "did you mean `CallbacksState`?"),
            ("SM013", "Concurrent", "did you mean `Concurrence`? Only a Concurrence has"),
        ],
    ),
    "the name of a service as its type": (
        """\
- DETECT:
    template: ServiceState
    service: /detect
    transitions: {succeeded: done, aborted: failed, preempted: failed}
""",
        [
            (
                "SM004",
                "/detect",
                "write `service_namespace: /detect`, and `service: std_srvs/Trigger`",
            )
        ],
    ),
    "the name of an action in another framework": (
        """\
- DRIVE:
    template: SimpleActionState
    action_name: drive
    action: actionlib/TestAction
    transitions: {succeeded: done, aborted: failed, preempted: failed}
""",
        [("SM003", "action_name", "did you mean `action_server_namespace`?")],
    ),
    "a number of retries": (
        """\
- A:
    template: SleepState
    time: 1
    retries: 3
    transitions: {succeeded: done, preempted: failed}
""",
        [("SM003", "retries", "write `retry: {on: [OUTCOME], max: NUMBER}`")],
    ),
    "a key that is read without userdata": (
        """\
- COUNT:
    template: CallbacksState
    output_keys: [n]
    callbacks: {n: n + 1}
    transitions: {succeeded: done, error: failed}
""",
        [("SM316", "n + 1", "write `'lambda ud: ud.n + 1'`")],
    ),
    "names of states as fields": (
        """\
- name: A
  template: SleepState
  time: 1
  transitions: {succeeded: B, preempted: failed}
- name: B
  template: SleepState
  time: 1
  transitions: {succeeded: done}
""",
        [
            ("SM004", "name", "write `- A:` in place of `- name: A`"),
            ("SM004", "name", "write `- B:` in place of `- name: B`"),
        ],
    ),
    "a param in code": (
        """\
- A:
    template: SleepState
    params: {pause: 1}
    time: params.pause
    transitions: {succeeded: done, preempted: failed}
""",
        [("SM019", "params", "a param is looked up outside of code: write `[params, pause]`")],
    ),
    "a loop without an end": (
        "- A: {template: ScriptedState, outcomes: [ok], transitions: {ok: A}}\n",
        [("SM202", "A", "lead an outcome of `A` to an outcome of `sm`")],
    ),
}


@pytest.mark.parametrize("name", FIRST)
def test_a_first_script(name: str) -> None:
    states, expected = FIRST[name]
    found = reported({"main.yml": HEAD + states})
    assert [(code, text) for code, text, _ in found] == [row[:2] for row in expected]
    for (_, _, help), (_, _, start) in zip(found, expected, strict=True):
        assert help is not None
        assert help.startswith(start)


def test_no_repair_writes_another_unknown_type() -> None:
    analysis = analysed({"main.yml": HEAD + FIRST["two unknown types"][0]})
    found = clusters(analysis, analysis.report, again(analysis))
    texts = {edit.text for cluster in found for edit in cluster.repair.edits}
    assert texts == {"CallbacksState"}  # the help of the other finding has its type
