"""Records: mappings whose fields have types, in scripts and interfaces."""

from __future__ import annotations

import pytest

from smachac.diagnostics.diagnostic import Diagnostic, Severity
from tests.trust.project_text import analysed

SCRIPT = """
name: sm
outcomes: [done]
types: {{Item: {{name: str, shelf: "one_of[left, right]", at: Pose?}}}}
userdata: {{item: {value}}}
states:
  - READ:
      template: CallbacksState
      input_keys: {{item: {type}}}
      output_keys: [label]
      callbacks: {{label: 'lambda ud: {code}'}}
      transitions: {{succeeded: SHOW}}
  - SHOW: {{template: PrintUserdataState, input_keys: [label], transitions: {{succeeded: done}}}}
"""
BOLT = "{name: bolt, shelf: left}"


def findings(value: str = BOLT, type: str = "Item", code: str = "ud.item") -> list[Diagnostic]:
    text = SCRIPT.format(value=value, type=type, code=code)
    report = analysed({"main.yml": text}).report
    loud = [item for item in report if item.severity is not Severity.INFO]
    return [item for item in loud if item.code != "SM306"]  # `Item` is not used everywhere


@pytest.mark.parametrize(
    ("value", "type_"),
    [
        (BOLT, "Item"),
        ("{name: bolt, shelf: left, at: null}", "Item"),
        ("{name: bolt, shelf: left, at: [1, 2, 3], more: 4}", "Item"),
        ("{type: Item, value: {shelf: right, name: nut}}", "Item"),
        ("{type: {name: str, shelf: str}, value: {shelf: a, name: b}}", "{name: str}"),
        ("{type: Item, value: {name: b, shelf: left}}", "'dict[str, any]'"),
        ("[{name: bolt, shelf: left}]", "'list[Item]'"),
        ("{name: bolt, shelf: left}", "{name: str, shelf: str}"),
        ("{at: {x: 1, y: 2.5}}", "{at: {x: float, y: float}}"),
        ("{a: 1, b: 2}", "'{a: int, b: float<m>}'"),
    ],
)
def test_what_fits_a_record(value: str, type_: str) -> None:
    assert findings(value, type_) == []


@pytest.mark.parametrize(
    ("value", "type_", "help"),
    [
        ("{name: bolt}", "Item", "add `shelf`"),
        ("{name: bolt, shlef: left}", "Item", "did you mean `shelf` in place of `shlef`?"),
        ("{name: bolt, shelf: lft}", "Item", "did you mean `left`?"),
        ("{name: 1, shelf: left}", "Item", ""),
        ("{name: bolt, shelf: left, at: 3}", "Item", ""),
        ("bolt", "Item", ""),
        ("[bolt, left]", "Item", ""),
        ("[{name: bolt, shelf: left}, {name: nut}]", "'list[Item]'", "add `shelf`"),
        ("{type: {name: str}, value: {name: bolt}}", "Item", "add `shelf`"),
        ("{type: {a: float<m>}, value: {a: 1}}", "'{a: float<mm>}'", ""),
    ],
)
def test_what_does_not_fit_a_record(value: str, type_: str, help: str) -> None:
    (found,) = findings(value, type_)
    assert found.code in ("SM304", "SM504")
    assert (found.help or "").startswith(help)


@pytest.mark.parametrize(
    ("code", "fault"),
    [
        ('ud.item["shelf"] + "_"', ""),
        ('ud.item["at"]', ""),
        ('len(ud.item["name"])', ""),
        ('ud.item["shlef"]', "shelf"),
        ('ud.item["name"] + 1', "convert"),
        ("ud.item.shelf", 'write `ud.item["shelf"]`'),
        ("ud.item[0]", "use text as the index"),
    ],
)
def test_code_over_a_record(code: str, fault: str) -> None:
    found = findings(code=code)
    assert [item.code for item in found] == (["SM311"] if fault else [])
    assert all(fault in (item.help or "") for item in found)


@pytest.mark.parametrize(
    ("type_", "code"),
    [("{name: string}", "SM017"), ("'{name: }'", "SM017"), ("{name: [str]}", "SM004")],
)
def test_what_is_no_record(type_: str, code: str) -> None:
    assert code in [item.code for item in findings(type=type_)]


def test_the_names_of_fields_are_no_aliases() -> None:
    """An alias `name` is not meant where a field has this name."""
    text = SCRIPT.format(value=BOLT, type="Item", code="ud.item")
    text = text.replace("types: {", "types: {name: int, ")
    report = analysed({"main.yml": text}).report
    unused = [item.span.text for item in report if item.code == "SM306"]
    assert [item.code for item in report if item.code == "SM304"] == []
    assert unused == ["name"]


def test_a_record_in_an_interface() -> None:
    script = """
    name: sm
    outcomes: [done]
    userdata: {item: {name: bolt, shelf: a}}
    states:
      - PICK: {template: Pick, box: {wide: 1, hihg: 2}, transitions: {ok: done}}
    """
    interface = """
    name: Pick
    variables: {box: {type: {wide: float, high: float}, default: {wide: 1.0}}}
    input_keys: {item: {type: {name: str, shelf: int}}}
    outcomes: {ok: {}}
    """
    report = analysed({"main.yml": script, "templates/Pick.yml": interface}).report
    found = [(item.code, item.span.text) for item in report if item.code == "SM304"]
    assert sorted(found) == [
        ("SM304", "a"),
        ("SM304", "hihg"),
        ("SM304", "{wide: 1.0}"),
    ]


CLASS = """
from smachac.runtime import smach

class Pick(smach.State):
    def __init__(self):
        super().__init__(outcomes=["ok"], input_keys=["item"])

    def execute(self, userdata):
        item = userdata.item
        print({code})
        return "ok"
"""


@pytest.mark.parametrize(
    ("code", "help"),
    [
        ("item.shelf", 'write `item["shelf"]`'),
        ("userdata.item.shelf", 'write `userdata.item["shelf"]`'),
        ("item.shlef", 'write `item["shelf"]`'),
        ("item.weight", "use one of its fields"),
        ('item["box"].wide', 'write `item["box"]["wide"]`'),
        ("item.get('shelf')", ""),
        ('item["shelf"].strip()', ""),
        ("hasattr(item, 'shelf') and item.shelf", ""),
        ("self.item.shelf", ""),
    ],
)
def test_a_record_in_a_class_is_a_dictionary(code: str, help: str) -> None:
    script = """
    name: sm
    outcomes: [done]
    userdata: {item: {name: bolt, shelf: a, box: {wide: 1}}}
    states:
      - PICK: {template: Pick, transitions: {ok: done}}
    """
    interface = """
    name: Pick
    input_keys: {item: {type: {name: str, shelf: str, box: {wide: int}}}}
    outcomes: {ok: {}}
    code: {python: "robot:Pick"}
    """
    files = {"main.yml": script, "templates/Pick.yml": interface}
    report = analysed({**files, "robot.py": CLASS.format(code=code)}).report
    found = [item.help or "" for item in report if item.code == "SM311"]
    assert len(found) == bool(help)
    assert all(item.startswith(help) for item in found)


PART = """
name: sm
outcomes: [done]
types: {{Seam: {{id: str, passes: int}}}}
userdata: {{seam: {{type: Seam, value: {value}}}}}
states:
  - SHOW: {{template: PrintUserdataState, input_keys: [seam], transitions: {{succeeded: done}}}}
"""


@pytest.mark.parametrize(
    ("value", "message", "help"),
    [
        (
            "{id: A, passes: 1.5}",
            "`passes` of `seam` is `1.5`, but `Seam` has",
            "or write `passes:",
        ),
        (
            "{id: A, pases: 1}",
            "`seam` has no field `passes`, which its type `Seam` requires",
            "did",
        ),
        ("{id: A, passes: 1}", "", ""),
    ],
)
def test_a_part_of_a_record_is_named_with_its_type(value: str, message: str, help: str) -> None:
    report = analysed({"main.yml": PART.format(value=value)}).report
    found = [item for item in report if item.code == "SM304"]
    assert len(found) == bool(message)
    assert all(item.finding.message.startswith(message) for item in found)
    assert all(help in (item.help or "") for item in found)


SCREWS = """
name: sm
template: Base
outcomes: [done]
types:
  Screw: {size: str, torque: float<N*m>}
userdata:
  screws: {type: "list[Screw]", value: [{size: M3, torque: 0.8}, {size: M4, torque: 1.6}]}
states:
  - DRIVE:
      template: ScriptedState
      input_keys: {screw: "{size: str, torque: float<UNIT>}"}
      outcomes: [driven]
      for_each: {item: screw, in: screws}
      transitions: {succeeded: done}
"""


@pytest.mark.parametrize("unit", ["N*mm", "N*m"])
def test_a_field_of_a_record_in_another_unit(unit: str) -> None:
    """Only the field is named, and a loop provides its items."""
    report = analysed({"main.yml": SCREWS.replace("UNIT", unit)}).report
    messages = [item.finding.message for item in report if item.code == "SM504"]
    message = "`torque` of `screw` is in `N*m` in the type `Screw`, but `DRIVE` reads it in `N*mm`"
    assert messages == ([message] if unit == "N*mm" else [])


def test_a_part_in_a_local_variable_is_reported_once() -> None:
    code = """
import smach
class Open(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["open"], input_keys=["entry"])
    def execute(self, userdata):
        number = userdata.entry.drawer
        print(number, number + 1)
        return "open"
"""
    interface = """
name: Open
input_keys: {entry: {type: {code: str, drawer: int}}}
outcomes: [open]
code: {python: "lab:Open"}
"""
    main = """
name: sm
outcomes: [done]
userdata: {entry: {code: a, drawer: 2}}
states:
  - OPEN: {template: Open, transitions: {open: done}}
"""
    files = {"main.yml": main, "templates/Open.yml": interface, "lab.py": code}
    found = [(item.code, item.span.text, item.help) for item in analysed(files).report]
    assert found == [("SM311", "userdata.entry.drawer", 'write `userdata.entry["drawer"]`')]
