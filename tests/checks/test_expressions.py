from __future__ import annotations

import pytest

from smachac.checks import check_machine
from smachac.diagnostics.diagnostic import Diagnostic, Severity
from smachac.ir.parser import parse_machine
from tests.support.typed_machines import with_state_types
from tests.trust.project_text import analysed

CODES = ("SM311", "SM312", "SM504")

MACHINE = """
machine sm: StateMachine {{
  outcomes done
  {keys}
  initial A
  state A: {first}
  state B: CallbacksState {{
    outcomes succeeded
    {reads}
    output r
    variable callbacks = {{r: `lambda ud: {code}`}}
    on succeeded -> done
  }}
}}"""

PYTHON = "Look {{ outcomes ok; {}on ok -> B; }}"


def found(code: str, keys: str = "", first: str = "", reads: str = "input x") -> list[Diagnostic]:
    """What is said of code in B, after A."""
    text = MACHINE.format(
        code=code, keys=keys, first=first or PYTHON.format(""), reads=reads
    ).replace("; ", "\n")
    return [
        item
        for item in check_machine(with_state_types(parse_machine(text, "m.smir")))
        if item.code in CODES
    ]


def callback(key: str, code: str) -> str:
    return (
        f"CallbacksState {{ outcomes succeeded; input x; output {key}; "
        f"variable callbacks = {{{key}: `lambda ud: {code}`}}; on succeeded -> B; }}"
    )


@pytest.mark.parametrize(
    ("faults", "expected"),
    [
        (found("ud.x + 1", 'userdata x = "left"'), ["SM311"]),
        (found("ud.x + 1", "userdata x: str = `f()`"), ["SM311"]),
        (found("ud.x + 1", "userdata x = null", reads="input x: str"), ["SM311"]),
        (found("ud.x + 1", "", PYTHON.format("output x: str; ")), ["SM311"]),
        (found("ud.x + 1", "userdata x = 1", callback("x", 'str(ud.x) + "a"')), []),
        (found("ud.x + 1", "userdata x = null", callback("x", "str(7)")), ["SM311"]),
        # Nothing comes of code that fails, so the key is still what it was.
        (found("ud.x + 1", "userdata x = 1", callback("x", 'ud.x + "a"')), ["SM311"]),
        # What comes is not known: by Python, before an open state, with the run, as an option.
        (found("ud.x + 1", 'userdata x = "a"', PYTHON.format("output x; ")), []),
        (found("ud.x + 1", 'userdata x = "a"', PYTHON.format("open; ")), []),
        (found("ud.x + 1", 'userdata x = "a"; input x'), []),
        (found("ud.x + 1", "userdata x = null", reads="input x: str?"), []),
        (found("ud.x + 1", 'userdata x = "a"', callback("x", "ud.other")), []),
        # Nothing stands where something is to come, but not for ever.
        (found("ud.x + 1", "userdata x = null", PYTHON.format("output x: int; ")), []),
        (found("ud.x + 1", "userdata x = null"), ["SM311"]),
        (found("ud.x == None", "userdata x = 1"), []),
        # A list of the script may grow, one of a declared length does not.
        (found("ud.x[2]", "userdata x = [1, 2]", PYTHON.format("input x; ")), []),
        (found("ud.x[2]", "userdata x = [1, 2]"), ["SM311"]),
        (found("ud.x[2]", "userdata x: int[2] = [1, 2]"), ["SM311"]),
        (found("ud.x[2]", "userdata x = [1, 2]", reads="input x: int[2]"), ["SM311"]),
        (found("[1, 2][2]"), ["SM311"]),
        # What the reader of another time asks for is not what is there now.
        (found("ud.x + 1", "userdata x: any = `f()`", PYTHON.format("input x: str; ")), []),
        (found("ud.x == 1", 'userdata x = "a"'), ["SM312"]),
        (found('ud.x == "b"', 'userdata x = "a"'), []),
        (found('ud.x == "b"', 'userdata x: one_of[a, c] = "a"'), ["SM312"]),
        (
            found(
                "ud.x + ud.y",
                "userdata x: float<rad> = 1.0; userdata y: float<deg> = 1.0",
                reads="input x; input y",
            ),
            ["SM504"],
        ),
    ],
)
def test_the_types_that_code_is_judged_by(faults: list[Diagnostic], expected: list[str]) -> None:
    assert [item.code for item in faults] == expected


def test_callbacks_see_what_those_before_them_have_written() -> None:
    text = """
    machine sm: StateMachine {{
      outcomes done
      userdata x = 1
      initial A
      state A: CallbacksState {{
        outcomes succeeded
        input x: int
        output {key}
        remap {key} -> x
        variable callbacks = {{{key}: `lambda ud: "a"`, n: `lambda ud: ud.x + "b"`}}
        output n
        on succeeded -> done
      }}
    }}"""

    def codes(key: str) -> list[str]:
        report = check_machine(with_state_types(parse_machine(text.format(key=key), "m.smir")))
        return [item.code for item in report if item.code in CODES]

    assert codes("a") == []
    assert codes("z") == ["SM311"]


def test_what_only_some_runs_evaluate_is_a_warning() -> None:
    (item,) = found("ud.x + 1 if ud.y else 0", 'userdata x = "a"', reads="input x; input y")
    assert item.severity is Severity.WARNING
    assert "can fail" in item.finding.message


def test_the_values_are_shown() -> None:
    (item,) = found("ud.x + 1", 'userdata x = "left"')
    assert [one.message for one in item.finding.related] == ['`x` is `"left"`']


def test_other_code_is_judged_by_itself() -> None:
    text = """
    machine sm: StateMachine {
      outcomes done
      userdata a = `[1] + 2`
      userdata xs = [1]
      initial A
      iterator A: Iterator {
        outcomes done
        loop ok
        items `ud.xs + 1`
        exhausted done
        input xs
        on done -> W
        state S: Look {
          outcomes ok
          variable loop = `lambda n: n + 1 + "a"`
          variable speed = `1 + "a"`
        }
      }
      state W: SleepState {
        outcomes succeeded
        input xs
        variable time = `lambda ud: -ud.xs`
        on succeeded -> done
      }
    }"""
    report = check_machine(with_state_types(parse_machine(text.replace("; ", "\n"), "m.smir")))
    said = [item.finding.message.partition(":")[2] for item in report if item.code in CODES]
    assert said == [
        " `[1] + 2` adds `int[1]` and `int`",
        " `ud.xs + 1` adds `int[1]` and `int`",
        " `1 + 'a'` adds `int` and `str`",
        " `-ud.xs` uses `int[1]` as a number",
    ]


@pytest.mark.parametrize(
    ("written", "bare"),
    [
        ("[2 * k for k in steps]", True),
        ("[f(j, k) for j, k in steps]", True),
        ("[0 for _ in range(3)]", True),
        ("{k: f(k) for k in steps}", True),
        ("['2 * k for k in steps']", False),
        ("'`[2 * k for k in range(3)]`'", False),
        ("[look for cup in kitchen]", False),
        ("[wait for it]", False),
    ],
)
def test_a_comprehension_without_quotes(written: str, bare: bool) -> None:
    text = f"""\
name: sm
template: Base
outcomes: [succeeded]
userdata: {{data: {written}}}
states:
  - SHOW:
      template: PrintUserdataState
      input_keys: [data]
      transitions: {{succeeded: succeeded}}
"""
    codes = [item.code for item in analysed({"main.yml": text}).report]
    assert codes == (["SM016"] if bare else [])


def items(read: str, first: str = "", reads: str = "input x") -> list[str]:
    """The codes for an item of the initial list of x."""
    return [item.code for item in found(read, "userdata x = [1, 2, 3]", first, reads)]


@pytest.mark.parametrize(
    ("read", "first"),
    [
        ("ud.x[3]", "SleepState { outcomes succeeded; variable time = 1; on succeeded -> B; }"),
        ("ud['x'][-4] + ud.x[0]", callback("n", "len(ud.x) + sum(ud.x)")),
        ("ud.x[7]", callback("n", "1 in ud.x")),
        ("len(ud.x) + ud.x[3]", callback("n", "max(ud.x)")),
    ],
)
def test_an_index_beyond_a_list_that_no_state_can_lengthen(read: str, first: str) -> None:
    assert items(read, first) == ["SM311"]


@pytest.mark.parametrize(
    ("read", "first"),
    [
        ("ud.x[2]", callback("n", "len(ud.x)")),
        ("ud.x[-3]", callback("n", "len(ud.x)")),
        # The list may have become longer, also under another name.
        ("ud.x[3]", callback("n", "ud.x.append(4)")),
        ("ud.x[3]", callback("n", "ud.x")),
        ("ud.x[3]", callback("n", "[ud.x]")),
        ("ud.x[3]", callback("n", "more(ud.x)")),
        ("ud.x[3]", callback("n", "[each for each in ud.x]")),
        ("ud.x[3]", callback("x", "ud.x + [4]")),
        ("ud.x[3]", callback("n", "1").replace("`lambda ud: 1`", "`lengthen`")),
        ("ud.x[3]", PYTHON.format("input x; ")),
        ("ud.x[3]", PYTHON.format("output x; ")),
        ("ud.x[3]", PYTHON.format("input x; ").replace("Look", "ScriptedState")),
        # Code that decides first may be meant for lists of several lengths.
        ("ud.x[3] if len(ud.x) > 3 else 0", callback("n", "len(ud.x)")),
        ("ud.n and ud.x[3]", callback("n", "len(ud.x)")),
        ("ud.x.pop() + ud.x[3]", callback("n", "len(ud.x)")),
    ],
)
def test_an_index_of_a_list_that_may_be_longer(read: str, first: str) -> None:
    assert items(read, first, "input n; input x") == []


def test_an_index_beyond_a_list_in_containers() -> None:
    text = """\
name: sm
template: Base
outcomes: [done]
userdata: {slots: [1, 2, 3]}
states:
  - WORK:
      template: StateMachine
      outcomes: [ok]
      input_keys: [places]
      output_keys: [place]
      remapping: {places: slots}
      transitions: {ok: SHOW}
      states:
        - FIRST:
            template: CallbacksState
            input_keys: [places]
            output_keys: [place]
            callbacks: {place: 'lambda ud: ud.places[3]'}
            transitions: {succeeded: ok}
  - SHOW: {template: TYPE, input_keys: [slots, place], transitions: {succeeded: done}}
"""
    (fault,) = [
        item
        for item in analysed({"main.yml": text.replace("TYPE", "PrintUserdataState")}).report
        if item.code == "SM311"
    ]
    assert fault.span.text == "ud.places[3]"
    assert fault.help == "use an index up to `[2]`"
    own = text.replace("TYPE", "ScriptedState, outcomes: [succeeded]")
    assert "SM311" not in {item.code for item in analysed({"main.yml": own}).report}
