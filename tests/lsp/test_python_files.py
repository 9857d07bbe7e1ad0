"""Python files that build machines, in a running language server."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.lsp.test_server import here, line_of, where
from tests.support.lsp_client import Client

pytest.importorskip("pygls")

STATES = '''import smach


class Weigh(smach.State):
    """Weighs a parcel."""

    def __init__(self):
        smach.State.__init__(self, outcomes=["light", "heavy"], output_keys=["weight"])

    def execute(self, userdata):
        userdata.weight = 3
        return "light"
'''

MACHINE = """import smach
from conveyor_drivers import Drop
from parcel_states import Weigh

inner = smach.StateMachine(outcomes=["sorted"])
with inner:
    smach.StateMachine.add("DROP", Drop(), transitions={"dropped": "sorted"})

sm = smach.StateMachine(outcomes=["done", "stopped"])
targets = {"light": "SORT", "heavy": "stopped"}
with sm:
    smach.StateMachine.add("WEIGH", Weigh(), transitions=targets)
    smach.StateMachine.add("SORT", inner, transitions={"sorted": "done"})
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    made = Path(os.path.realpath(tmp_path)) / "repository"
    (made / ".git").mkdir(parents=True)
    (made / "parcel_states.py").write_text(STATES)
    (made / "parcels.py").write_text(MACHINE)
    return made


@pytest.fixture
def client(folder: Path) -> Iterator[Client]:
    with Client(folder) as running:
        yield running
        assert running.end() == ""


def position(text: str, word: str, after: str = "") -> dict[str, int]:
    """The position in a word, behind another one."""
    at = text.index(word, text.index(after)) + 1
    return {"line": text[:at].count("\n"), "character": at - text.rfind("\n", 0, at) - 1}


def ask(client: Client, method: str, uri: str, **more: Any) -> Any:
    return client.ask(f"textDocument/{method}", textDocument={"uri": uri}, **more)


def hover(client: Client, uri: str, at: dict[str, int]) -> str:
    found = ask(client, "hover", uri, position=at)
    return found["contents"]["value"] if found is not None else ""


def test_findings_as_one_types(client: Client, folder: Path) -> None:
    uri = client.open(folder / "parcels.py")
    assert client.findings(uri) == []
    wrong = MACHINE.replace('"heavy": "stopped"', '"heavy": "stoped"')
    client.change(uri, wrong)
    (finding,) = client.findings(uri)
    assert (finding["code"], finding["severity"]) == ("SM101", 1)
    assert finding["range"]["start"]["line"] == line_of(wrong, "stoped")
    allowed = wrong.replace('"stoped"}', '"stoped"}  # smachac: allow SM101 tried')
    client.change(uri, allowed)
    assert client.findings(uri) == []


BEHAVIOR = """from flexbe_core import Behavior, EventState, OperatableStateMachine


class Wait(EventState):
    def __init__(self):
        super().__init__(outcomes=["done"])

    def execute(self, userdata):
        pass


class TaskSM(Behavior):
    def create(self):
        _state_machine = OperatableStateMachine(outcomes=["finished"])
        with _state_machine:
            OperatableStateMachine.add("WAIT", Wait(), transitions={"done": "finishd"})
        return _state_machine
"""


def test_behaviors_of_flexbe(client: Client, folder: Path) -> None:
    uri = client.open(folder / "task_sm.py", BEHAVIOR)
    (finding,) = client.findings(uri)
    assert (finding["code"], finding["severity"]) == ("SM101", 1)
    assert finding["range"]["start"]["line"] == line_of(BEHAVIOR, "finishd")
    assert "done" in hover(client, uri, position(BEHAVIOR, "WAIT"))
    client.change(uri, BEHAVIOR.replace("finishd", "finished"))
    assert client.findings(uri) == []


def test_a_finding_can_be_allowed_by_a_code_action(client: Client, folder: Path) -> None:
    wrong = MACHINE.replace('"heavy": "stopped"', '"heavy": "stoped"')
    uri = client.open(folder / "parcels.py", wrong)
    client.findings(uri)
    (action,) = ask(client, "codeAction", uri, range=here(wrong, "stoped"),
                    context={"diagnostics": []})  # fmt: skip
    assert action["title"] == "Allow SM101 here"


@pytest.mark.parametrize("name", ["other.py", "parcels.py"])
@pytest.mark.parametrize("text", ["", "print(1)\n", "def f(:\n", "import smach\n", "\0\n"])
def test_other_python_files_have_no_answers(
    text: str, name: str, client: Client, folder: Path
) -> None:
    uri = client.open(folder / name, text)
    assert client.findings(uri) == []
    assert ask(client, "documentSymbol", uri) is None
    assert ask(client, "codeLens", uri) is None
    assert hover(client, uri, {"line": 0, "character": 0}) == ""


def test_hover_on_states_and_targets(client: Client, folder: Path) -> None:
    uri = client.open(folder / "parcels.py")
    state = hover(client, uri, position(MACHINE, "WEIGH"))
    assert "state sm/WEIGH" in state
    assert "a Weigh (parcels.py:12:5)" in state
    assert all(word in state for word in ("light", "SORT", "`weight`"))
    assert "unknown" not in state
    assert "state sm/SORT" in hover(client, uri, position(MACHINE, "SORT"))
    ended = hover(client, uri, position(MACHINE, "stopped", "targets ="))
    assert ended == "outcome `stopped` of sm"
    assert "machine sm" in hover(client, uri, position(MACHINE, "smach", "sm = "))
    unknown = hover(client, uri, position(MACHINE, "DROP"))
    assert "package conveyor_drivers not found" in unknown


def test_a_target_leads_to_the_call_that_adds_the_state(client: Client, folder: Path) -> None:
    uri = client.open(folder / "parcels.py")

    def definition(at: dict[str, int]) -> list[tuple[str, int]]:
        return where(ask(client, "definition", uri, position=at))

    sort = line_of(MACHINE, 'add("SORT"') + 1
    assert definition(position(MACHINE, "SORT")) == [("parcels.py", sort)]
    outcomes = line_of(MACHINE, '"done", "stopped"') + 1
    assert definition(position(MACHINE, "done", 'transitions={"sorted": "done')) == [
        ("parcels.py", outcomes)
    ]
    cls = line_of(STATES, "class Weigh") + 1
    assert definition(position(MACHINE, "Weigh()")) == [("parcel_states.py", cls)]
    assert definition(position(MACHINE, "inner", 'add("SORT"')) == [("parcels.py", 5)]
    assert definition(position(MACHINE, "Drop()")) == []


def test_symbols_and_the_picture(client: Client, folder: Path) -> None:
    uri = client.open(folder / "parcels.py")
    (machine,) = ask(client, "documentSymbol", uri)
    assert (machine["name"], machine["detail"]) == ("sm", "StateMachine")
    weigh, sort = machine["children"]
    assert [weigh["name"], weigh["detail"], sort["name"]] == ["WEIGH", "Weigh", "SORT"]
    assert [inner["name"] for inner in sort["children"]] == ["DROP"]
    assert weigh["selectionRange"] == here(MACHINE, "WEIGH")
    (lens,) = ask(client, "codeLens", uri)
    assert lens["command"]["title"] == "Draw"
    found = client.ask("workspace/executeCommand", command="smachac.picture", arguments=[uri])
    assert found["dot"].startswith("digraph")
    assert found["places"]["sm/WEIGH"]["line"] == line_of(MACHINE, 'add("WEIGH"')


def test_the_picture_is_that_of_the_machine_at_the_line(client: Client, folder: Path) -> None:
    text = MACHINE + MACHINE.replace("sm =", "second =").replace("with sm:", "with second:")
    uri = client.open(folder / "parcels.py", text)

    def drawn(*arguments: object) -> set[str]:
        found = client.ask("workspace/executeCommand", command="smachac.picture",
                           arguments=[uri, *arguments])  # fmt: skip
        return {name.split("/")[0] for name in found["places"]}

    last = text.count("\n")
    assert drawn() == drawn(line_of(text, "with sm")) == {"sm"}
    assert drawn(last) == {"second"}
    assert drawn(None) == drawn("text") == drawn(-5) == {"sm"}


def test_a_syntax_error_keeps_the_last_symbols(client: Client, folder: Path) -> None:
    uri = client.open(folder / "parcels.py")
    before = ask(client, "documentSymbol", uri)
    for broken in (
        "with sm:\n    smach.StateMachine.add(",
        "with sm",
        "\tx = (\n",
        "'''",
        "(" * 99,
    ):
        client.change(uri, MACHINE + broken)
        assert [item["code"] for item in client.findings(uri)] == ["SM805"]
        assert ask(client, "documentSymbol", uri) == before
        assert "sm/WEIGH" in hover(client, uri, position(MACHINE, "WEIGH"))
    client.change(uri, MACHINE)
    assert client.findings(uri) == []


def test_unsaved_texts_of_imported_modules_count(client: Client, folder: Path) -> None:
    main = client.open(folder / "parcels.py")
    assert client.findings(main) == []
    states = client.open(folder / "parcel_states.py", STATES.replace('"heavy"]', '"heavy", "x"]'))
    client.findings(states)
    while not client.diagnostics[main]["diagnostics"]:
        client.note(client.receive())
    (finding,) = client.diagnostics[main]["diagnostics"]
    assert (finding["code"], "`x`" in finding["message"]) == ("SM104", True)
    client.change(states, STATES)
    while client.diagnostics[main]["diagnostics"]:
        client.note(client.receive())


def test_a_finding_in_a_module_is_shown_there(client: Client, folder: Path) -> None:
    main = client.open(folder / "parcels.py")
    client.findings(main)
    wrong = STATES.replace('return "light"', 'return "lite"')
    states = client.open(folder / "parcel_states.py", wrong)
    assert [item["code"] for item in client.findings(states)] == ["SM309"]


def test_a_new_module_of_the_folder_is_found(client: Client, folder: Path) -> None:
    uri = client.open(folder / "parcels.py")
    client.findings(uri)
    drop = STATES.replace("Weigh", "Drop").replace('"light", "heavy"', '"dropped", "lost"')
    path = folder / "conveyor_drivers.py"
    path.write_text(drop.replace('"light"', '"dropped"'))
    client.tell("workspace/didChangeWatchedFiles", changes=[{"uri": path.as_uri(), "type": 1}])
    while not client.diagnostics[uri]["diagnostics"]:
        client.note(client.receive())
    assert [item["code"] for item in client.findings(uri)] == ["SM104"]


MADE = """import smach
import parcel_states
from parcel_states import Weigh as Scale

def chain(names):
    made = smach.StateMachine(outcomes=["done"])
    with made:
        for name, after in zip(names, [*names[1:], "done"]):
            smach.StateMachine.add(name, parcel_states.Weigh(),
                                   transitions=dict.fromkeys(["light", "heavy"], after))
    return made

class Parcels(smach.StateMachine):
    def __init__(self):
        super().__init__(outcomes=["end"])
        scale = Scale()
        with self:
            smach.StateMachine.add(transitions={"light": "OUT", "heavy": "end"}, label="IN",
                                   state=scale)
            smach.StateMachine.add("OUT", chain(["A", "B"]), {"done": "end"})

top = Parcels()
"""


def test_states_of_loops_functions_and_classes(client: Client, folder: Path) -> None:
    uri = client.open(folder / "made.py", MADE)
    assert client.findings(uri) == []
    (machine,) = ask(client, "documentSymbol", uri)
    assert [child["name"] for child in machine["children"]] == ["IN", "OUT"]
    assert [child["name"] for child in machine["children"][1]["children"]] == ["A", "B"]
    both = hover(client, uri, position(MADE, "StateMachine.add", "for name"))
    assert all(word in both for word in ("OUT/A", "OUT/B"))
    cls = ("parcel_states.py", line_of(STATES, "class Weigh") + 1)
    for word, after in (("scale", "state=scale"), ("parcel_states.Weigh()", "for name")):
        found = ask(client, "definition", uri, position=position(MADE, word, after))
        assert where(found) == [cls]
    found = ask(client, "definition", uri, position=position(MADE, "OUT"))
    assert where(found) == [("made.py", line_of(MADE, 'add("OUT"') + 1)]


# --- machines for YASMIN

GRIPPERS = '''from yasmin import State


class Grasp(State):
    """Closes the gripper."""

    def __init__(self, force=1.0):
        super().__init__(outcomes=["held", "lost"])

    def execute(self, blackboard):
        return "held" if blackboard["part"] else "lost"
'''

PICKING = """from grippers import Grasp
from yasmin import CbState, Concurrence, StateMachine
from yasmin_ros.basic_outcomes import SUCCEED


def beep(blackboard):
    return SUCCEED


class Both(StateMachine):
    def __init__(self):
        super().__init__(outcomes=["over"])
        pair = Concurrence(
            states={"LEFT": Grasp(2.0), "RIGHT": CbState([SUCCEED], beep)},
            default_outcome="missed",
            outcome_map={"got": {"LEFT": "held", "RIGHT": SUCCEED}},
        )
        self.add_state("PAIR", pair, {"got": "over", "missed": "over"})


sm = StateMachine(outcomes=["done", "failed"])
sm.add_state("GRASP", Grasp(), transitions={"held": "BOTH", "lost": "failed"},
             remappings={"part": "box"})
sm.add_state("BOTH", Both(), {"over": "done"})
sm.set_start_state("GRASP")
"""


@pytest.fixture
def picking(folder: Path) -> Path:
    (folder / "grippers.py").write_text(GRIPPERS)
    (folder / "picking.py").write_text(PICKING)
    return folder / "picking.py"


def test_findings_in_a_file_for_yasmin(client: Client, picking: Path) -> None:
    uri = client.open(picking)
    assert client.findings(uri) == []
    wrong = PICKING.replace('"held": "BOTH"', '"held": "BOHT"')
    client.change(uri, wrong)
    found = client.findings(uri)
    assert [item["code"] for item in found] == ["SM101"]
    assert "YASMIN raises an exception when the machine starts" in found[0]["message"]
    client.change(uri, PICKING.replace('set_start_state("GRASP")', 'set_start_state("GRAPS")'))
    assert [item["code"] for item in client.findings(uri)] == ["SM807"]
    client.change(uri, PICKING.replace('add_state("BOTH"', 'add_state("done"'))
    assert {item["code"] for item in client.findings(uri)} == {"SM101", "SM806"}
    client.change(uri, PICKING)
    assert client.findings(uri) == []


def test_hover_in_a_file_for_yasmin(client: Client, picking: Path) -> None:
    uri = client.open(picking)
    shown = hover(client, uri, position(PICKING, "GRASP", 'add_state("GRASP'))
    assert "state sm/GRASP" in shown
    assert "on held: to BOTH" in shown
    assert "state sm/BOTH" in hover(client, uri, position(PICKING, "BOTH", '"held": '))
    assert "outcome `failed` of sm" in hover(client, uri, position(PICKING, "failed", '"lost": '))
    left = hover(client, uri, position(PICKING, "LEFT"))
    assert "state sm/BOTH/PAIR/LEFT" in left
    assert "on held: PAIR ends with got" in left


def test_definitions_in_a_file_for_yasmin(client: Client, picking: Path) -> None:
    uri = client.open(picking)

    def line(word: str, after: str) -> str:
        (found,) = ask(client, "definition", uri, position=position(PICKING, word, after))
        path = picking.parent / str(found["uri"]).rpartition("/")[2]
        return path.read_text().splitlines()[int(found["range"]["start"]["line"])]

    assert line("BOTH", '"held": ').startswith('sm.add_state("BOTH"')
    assert line("Grasp", '"GRASP", ') == "class Grasp(State):"
    assert line("Grasp", '"LEFT": ') == "class Grasp(State):"
    assert line("Both", '"BOTH", ') == "class Both(StateMachine):"
    assert line("pair", '"PAIR", ').strip() == "pair = Concurrence("
    assert line("over", '"got": ').strip() == 'super().__init__(outcomes=["over"])'


def test_symbols_and_picture_of_a_file_for_yasmin(client: Client, picking: Path) -> None:
    uri = client.open(picking)
    (machine,) = ask(client, "documentSymbol", uri)
    assert machine["name"] == "sm"
    assert [child["name"] for child in machine["children"]] == ["GRASP", "BOTH"]
    assert [child["name"] for child in machine["children"][1]["children"]] == ["PAIR"]
    found = client.ask("workspace/executeCommand", command="smachac.picture", arguments=[uri])
    assert found["dot"].startswith("digraph")
    assert found["places"]["sm/BOTH/PAIR/LEFT"]["line"] == line_of(PICKING, '"LEFT": G')


def test_unsaved_texts_of_classes_of_yasmin_count(client: Client, picking: Path) -> None:
    uri = client.open(picking)
    assert client.findings(uri) == []
    wrong = GRIPPERS.replace('"lost"]', '"gone"]').replace('else "lost"', 'else "gone"')
    client.findings(client.open(picking.parent / "grippers.py", wrong))
    while not client.diagnostics[uri]["diagnostics"]:
        client.note(client.receive())
    found = {item["code"] for item in client.diagnostics[uri]["diagnostics"]}
    assert found == {"SM102"}
