"""The import of SCXML and of the XML of YASMIN: what is taken over, what is named, and documents
that smachac generates."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings

from smachac.commands.cli import main
from smachac.driver import analyse
from smachac.frontend.files import Disk, disk_library
from smachac.ir.nodes import Concurrence, Container, Data, Iterator, Leaf, Machine, Node, Struct
from smachac.ir.traversal import leads_to_child, walk
from smachac.refactor.imports.project import Imported
from smachac.refactor.imports.xml_project import import_xml
from smachac.refactor.imports.xml_source import NoLiteralError, literal
from smachac.refactor.imports.yasmin_xml import typed
from smachac.targets.scxml import document
from tests.strategies.full_machines import busy_machines
from tests.support.examples import examples
from tests.support.typed_machines import with_state_types

EXAMPLES = Path(__file__).parents[2] / "examples"

HEAD = '<scxml xmlns="http://www.w3.org/2005/07/scxml" version="1.0"'

LIFT = f"""{HEAD} name="lift" initial="closed">
  <datamodel><data id="floor" expr="3"/><data id="names">["a", "b"]</data></datamodel>
  <state id="closed">
    <invoke id="door" src="drivers/door.py"><param name="speed" expr="0.5"/></invoke>
    <transition event="door.opened" target="moving"/>
    <transition event="done.invoke.door" target="stopped"/>
  </state>
  <state id="moving" initial="down">
    <state id="up"><transition event="arrived" target="moving-there"/></state>
    <state id="down"><transition event="turn" target="up"/>
      <transition event="hit" target="hurt"/></state>
    <final id="moving-there"/>
    <final id="hurt"><donedata><content expr="'pain'"/></donedata></final>
    <transition event="done.state.moving" cond="_event.data === 'pain'" target="stopped"/>
    <transition event="done.state.moving" target="both"/>
  </state>
  <parallel id="both">
    <state id="lights"><state id="on"><transition event="off" target="dark"/></state>
      <final id="dark"/></state>
    <state id="music"><state id="play"><transition event="end" target="quiet"/></state>
      <final id="quiet"/></state>
    <transition event="done.state.both" cond="In('dark') &amp;&amp; In('quiet')" target="closed"/>
    <transition event="done.state.both" target="stopped"/>
  </parallel>
  <final id="stopped"/>
</scxml>
"""


def imported(text: str | bytes, folder: Path, name: str = "machine.scxml") -> Imported:
    path = folder / name
    path.parent.mkdir(exist_ok=True)
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return import_xml(path, folder / "project", Disk())


def script(made: Imported, folder: Path) -> Machine:
    """The machine of the script that an import makes."""
    disk = Disk({str(folder / "project" / name): text for name, text in made.texts.items()})
    main_file = folder / "project" / "main.yml"
    source = disk.read(main_file, [])
    assert source is not None
    machine = analyse(source, disk_library(main_file, [], disk=disk), []).machine
    assert machine is not None
    return machine


def node(machine: Machine, path: str) -> Node:
    return dict(walk(machine.root))[path]


def targets(state: Node) -> dict[str, str]:
    return {edge.outcome: edge.target for edge in state.transitions}


def lost(made: Imported) -> list[tuple[int, str]]:
    return [(item.span.line, item.text) for item in made.lost
            if not item.text.startswith("the code of the state")]  # fmt: skip


def test_states_containers_ends_and_values_are_taken_over(tmp_path: Path) -> None:
    made = imported(LIFT, tmp_path)
    assert lost(made) == []
    assert [proof.differences for proof in made.proofs] == [()]
    machine = script(made, tmp_path)
    root = machine.root
    assert (root.name, root.initial, [one.name for one in root.outcomes]) == (
        "lift", "closed", ["stopped"],
    )  # fmt: skip
    assert {preset.key: preset.value.data for preset in root.userdata} == {
        "floor": 3, "names": ("a", "b"),
    }  # fmt: skip
    closed = node(machine, "lift/closed")
    assert isinstance(closed, Leaf)
    assert closed.type == "py"
    assert {variable.name: variable.value.data for variable in closed.variables} == {"speed": 0.5}
    assert targets(closed) == {"opened": "moving", "done": "stopped"}
    moving = node(machine, "lift/moving")
    assert targets(moving) == {"hurt": "stopped", "there": "both"}
    assert getattr(moving, "initial", "") == "down"
    assert targets(node(machine, "lift/moving/down")) == {"turn": "up", "hit": "hurt"}
    both = node(machine, "lift/both")
    assert isinstance(both, Concurrence)
    (rule,) = both.rules
    assert {part.child: part.outcome for part in rule.when} == {"lights": "dark", "music": "quiet"}
    assert targets(both) == {rule.outcome: "closed", both.default_outcome: "stopped"}


@pytest.mark.parametrize(
    ("inside", "line", "word"),
    [
        ('<transition event="e" cond="x &gt; 3" target="b"/>', 3, "condition"),
        ('<transition event="e"><log/></transition>', 3, "no target"),
        ('<transition event="e" target="b c"/>', 3, "several targets"),
        ('<transition event="e" target="deep"/>', 3, "another container"),
        ('<transition event="error.execution" target="b"/>', 3, "error"),
        ('<transition event="*" target="b"/>', 3, "`*`"),
        ('<transition event="e" target="b"><script>1</script></transition>', 3, "<script>"),
        ("<onentry><raise event='x'/></onentry>", 3, "<raise>"),
        ("<onexit><script>1</script></onexit>", 3, "<script>"),
        ('<invoke src="x"/><invoke src="y"/>', 3, "second"),
        ('<invoke src="x"><param name="a" expr="f(1)"/></invoke>', 3, "`a`"),
        ('<invoke src="x"><finalize/></invoke>', 3, "<finalize>"),
        ("<datamodel><data id='a' expr='1 + x'/></datamodel>", 3, "`a`"),
        ("<datamodel><data id='a'><b/></data></datamodel>", 3, "`a`"),
    ],
)
def test_what_is_not_taken_over_is_named_with_its_line(
    inside: str, line: int, word: str, tmp_path: Path
) -> None:
    text = f"""{HEAD} name="sm">
  <state id="a">
    {inside}
    <transition event="fine" target="end"/></state>
  <state id="b"><transition event="go" target="c"/></state>
  <state id="c"><state id="deep"><transition event="x" target="c.end"/></state><final id="c.end"/>
    <transition event="done.state.c" target="end"/></state>
  <final id="end"/>
</scxml>
"""
    made = imported(text, tmp_path)
    found = lost(made)
    assert [number for number, _ in found] == [line]
    assert word in found[0][1]
    assert [proof.differences for proof in made.proofs] == [()]
    assert targets(node(script(made, tmp_path), "sm/a"))["fine"] == "end"


@pytest.mark.parametrize(
    ("inside", "word"),
    [
        ('<history id="h" type="deep"/>', "history"),
        ('<transition event="stop" target="end"/>', "can leave every state"),
        ('<invoke src="x"/>', "<invoke>"),
        ("<script>1</script>", "<script>"),
        ('<transition event="done.state.c" cond="x" target="a"/>', "condition"),
    ],
)
def test_what_a_compound_state_has_more_is_named(inside: str, word: str, tmp_path: Path) -> None:
    text = f"""{HEAD}>
  <state id="c">{inside}<state id="a"><transition event="x" target="z"/></state><final id="z"/>
    <transition event="done.state.c" target="end"/></state>
  <state id="d"><transition event="x" target="end"/></state>
  <final id="end"/></scxml>"""
    made = imported(text, tmp_path)
    ((line, found),) = lost(made)
    assert (line, word in found) == (2, True)
    assert targets(node(script(made, tmp_path), "sm/c")) == {"z": "end"}


def test_a_rule_that_smach_would_apply_otherwise_is_named(tmp_path: Path) -> None:
    def with_rules(*conditions: str) -> Imported:
        edges = "".join(f'<transition event="done.state.p"{condition} target="end"/>'
                        for condition in conditions)  # fmt: skip
        branch = ('<state id="{0}"><state id="{0}s"><transition event="x" target="{0}x"/>'
                  '<transition event="y" target="{0}y"/></state><final id="{0}x"/>'
                  '<final id="{0}y"/></state>')  # fmt: skip
        text = (f'{HEAD}><parallel id="p">{branch.format("a")}{branch.format("b")}{edges}'
                f'</parallel><final id="end"/></scxml>')  # fmt: skip
        return imported(text, tmp_path)

    one = " cond=\"In('ax')\""
    two = " cond=\"In('ax') &amp;&amp; In('by')\""
    other = " cond=\"In('ay')\""
    assert lost(with_rules(two, one, other, "")) == []
    assert ["more general" in text for _, text in lost(with_rules(one, two, ""))] == [True]
    assert ["more general" in text for _, text in lost(with_rules("", one))] == [True]
    assert ["waits for ever" in text for _, text in lost(with_rules(one))] == [True]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "latin-1"])
def test_encodings_prefixes_and_comments(encoding: str, tmp_path: Path) -> None:
    name = "utf-8" if encoding == "utf-8-sig" else encoding
    text = f"""<?xml version="1.0" encoding="{name}"?>
<!-- <state id="none"/> -->
<s:scxml xmlns:s="http://www.w3.org/2005/07/scxml" xmlns:e="urn:editor" name="prüfung"
    version="1.0">
  <e:layout x="3"><state id="other"/></e:layout>
  <s:state id="a" e:x="4"><!-- x --><s:transition event="weiter" target="ende"/></s:state>
  <s:final id="ende"/>
</s:scxml>"""
    made = imported(text.encode(encoding), tmp_path)
    assert (made.report, lost(made)) == ([], [])
    machine = script(made, tmp_path)
    assert [path for path, _ in walk(machine.root)][1:] == [f"{machine.root.name}/a"]
    assert targets(node(machine, f"{machine.root.name}/a")) == {"weiter": "ende"}


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ('<!DOCTYPE scxml [<!ENTITY a "b">]><scxml/>', "document type"),
        (f"{HEAD}><state id='a'/>", "not closed"),
        (f"{HEAD}><state id='a'/><state id='a'/></scxml>", "second state"),
        ("", "empty"),
        ("text", "not valid XML"),
        ("<robot/>", "no machine"),
        (f"{HEAD}>{'<state>' * 200}{'</state>' * 200}</scxml>", "levels"),
    ],
)
def test_a_file_that_cannot_be_read_has_a_finding(text: str, word: str, tmp_path: Path) -> None:
    made = imported(text, tmp_path)
    assert not made.is_read
    (finding,) = made.report
    assert (finding.code, word in finding.message) == ("SM007", True)
    assert "URDF" not in f"{finding.message} {finding.help}"


def test_a_transition_that_a_script_implies_is_named(tmp_path: Path) -> None:
    text = f"""{HEAD}><state id="c"><state id="a"><transition event="x" target="c.end"/></state>
      <final id="c.end"/></state><state id="b"><transition event="x" target="end"/></state>
      <final id="end"/></scxml>"""
    made = imported(text, tmp_path)
    ((line, found),) = lost(made)
    assert (line, "no transition after `end`" in found) == (1, True)
    assert [proof.differences for proof in made.proofs] == [()]


def test_a_container_without_states_is_not_imported(tmp_path: Path) -> None:
    for text in (f"{HEAD}></scxml>", f"{HEAD}><state id='a'><final id='b'/></state></scxml>"):
        made = imported(text, tmp_path)
        assert (made.texts, len(made.incomplete)) == ({}, 1)


# --- documents of smachac


def targets_of(container: Container, child: Node) -> set[object]:
    """Where a state leads, with states by their number: SCXML has other names for some."""
    inside = frozenset(state.name for state in container.children)
    numbers = {state.name: number for number, state in enumerate(container.children)}
    return {numbers[edge.target] if leads_to_child(edge, inside)
            else re.sub(r"_\d+$", "", edge.target) for edge in child.transitions}  # fmt: skip


def assert_same(own: Node, other: Node, *, whole: bool) -> None:
    """The graphs of an imported machine and of the one whose document it is. Without `whole`, the
    document has no transitions on outcomes that cannot happen."""
    assert isinstance(own, Leaf) == isinstance(other, Leaf)
    if isinstance(own, Leaf) or isinstance(other, Leaf):
        return
    assert isinstance(own, Concurrence) == isinstance(other, Concurrence)
    first = [next((number for number, child in enumerate(node.children)
                   if child.name == getattr(node, "initial", "")), 0)
             for node in (own, other)]  # fmt: skip
    assert first[0] == first[1]
    for child, same in zip(own.children, other.children, strict=True):
        found, wanted = targets_of(own, child), targets_of(other, same)
        assert found == wanted if whole else found <= wanted
        assert_same(child, same, whole=whole)


def written(machine: Machine, folder: Path) -> Imported | None:
    """The import of the document of a machine; None where SCXML cannot express it."""
    report: list[object] = []
    text = document(machine, report, traced=False)  # type: ignore[arg-type]
    return None if report else imported(text, folder)


PLAIN = ["01_sequence", "02_nesting", "03_concurrence", "04_sub_scripts", "05_userdata",
         "06_callbacks", "08_pick_and_place", "09_stacking", "10_baxter_pick_and_place",
         "11_baxter_stacking", "12_dual_arm_stacking"]  # fmt: skip


@pytest.mark.parametrize("name", PLAIN)
def test_the_document_of_an_example_has_its_graph(name: str, tmp_path: Path) -> None:
    path = EXAMPLES / name / "main.yml"
    disk = Disk()
    source = disk.read(path, [])
    assert source is not None
    machine = analyse(source, disk_library(path, [], disk=disk), []).machine
    assert machine is not None
    made = written(machine, tmp_path)
    assert made is not None
    assert lost(made) == []
    assert [proof.differences for proof in made.proofs] == [()]
    assert_same(script(made, tmp_path).root, machine.root, whole=True)


@settings(max_examples=examples(60), deadline=None, suppress_health_check=list(HealthCheck))
@given(busy_machines())
def test_random_machines(tmp_path: Path, drawn: tuple[Machine, object]) -> None:
    machine = with_state_types(drawn[0])
    made = written(machine, tmp_path)
    if made is None:
        return
    assert [proof.differences for proof in made.proofs] == [()]
    plain = not any(isinstance(state, Iterator) for _, state in walk(machine.root))
    if plain and not lost(made):
        assert_same(script(made, tmp_path).root, machine.root, whole=False)


# --- values


@pytest.mark.parametrize(
    ("code", "value"),
    [
        ("3", 3), ("-1.5e3", -1500.0), ("'a\\'b'", "a'b"), ('"\\u00e9"', "\u00e9"), ("true", True),
        ("null", None), ("[1, [2]]", (1, (2,))), ("({a: 'x'})", Struct(entries=(("a", "x"),))),
        ('{"a-b": {c: []}}', Struct(entries=(("a-b", Struct(entries=(("c", ()),))),))),
    ],
)  # fmt: skip
def test_literals(code: str, value: Data) -> None:
    assert literal(code) == value


@pytest.mark.parametrize(
    "code",
    ["x", "1 + 2", "f()", "{a: b}", "[1,]", "({a: 1, a: 2})", "NaN", "'", "01", "1.", "`a`", "",
     "-x", "[" * 9000, "a: 1", "'a' 'b'", "true.x", "1 2", "'\\x41'"],
)  # fmt: skip
def test_other_code_is_no_literal(code: str) -> None:
    with pytest.raises(NoLiteralError):
        literal(code)


# --- YASMIN

DEMO = """<?xml version="1.0"?>
<StateMachine name="Demo" outcomes="end broken" start_state="B">
  <Param name="speed" default_type="float" default_value="0.5"/>
  <Key name="count" type="in/out" default_type="int" default_value="3"/>
  <State name="A" type="py" module="demo.states" class="FooState">
    <ParamRemap old="velocity" new="speed"/>
    <Remap old="part" new="count"/>
    <Transition from="again" to="B"/>
    <Transition from="over" to="end"/>
  </State>
  <State name="B" type="cpp" class="demo/BarState">
    <Param name="tries" default_type="int" default_value="7"/>
    <Transition from="go" to="Both"/>
  </State>
  <Concurrence name="Both" default_outcome="broken">
    <StateMachine name="Left" outcomes="l">
      <State name="L" type="py" module="demo" class="X"><Transition from="x" to="l"/></State>
    </StateMachine>
    <State name="Right" type="py" module="demo" class="Y"/>
    <OutcomeMap outcome="A">
      <Item state="Left" outcome="l"/><Item state="Right" outcome="r"/>
    </OutcomeMap>
  </Concurrence>
  <FinalOutcome name="end"/>
</StateMachine>
"""


def test_yasmin(tmp_path: Path) -> None:
    made = imported(DEMO, tmp_path, "demo.xml")
    assert lost(made) == []
    assert [proof.differences for proof in made.proofs] == [()]
    machine = script(made, tmp_path)
    assert machine.root.initial == "B"
    first = node(machine, "Demo/A")
    assert isinstance(first, Leaf)
    assert made.texts["templates/FooState.yml"].endswith(
        'code: {yasmin: "imported_states:FooState"}\n'
    )
    own = made.texts["imported_states.py"]
    assert "class FooState(demo.states.FooState):" in own
    assert "        self.set_parameter('velocity', 0.5)\n" in own
    assert "class BarState(yasmin.State):" in own
    assert 'code: {yasmin: "demo:X"}\n' in made.texts["templates/X.yml"]
    second = node(machine, "Demo/B")
    assert isinstance(second, Leaf)
    assert {variable.name: variable.value.data for variable in second.variables} == {"tries": 7}
    assert targets(first) == {"again": "B", "over": "end"}
    assert [(remap.key, remap.to) for remap in first.remaps] == [("part", "count")]
    both = node(machine, "Demo/Both")
    assert isinstance(both, Concurrence)
    assert targets(both) == {"A": "A", "broken": "broken"}  # YASMIN jumps to the state `A`
    assert [[(part.child, part.outcome) for part in rule.when] for rule in both.rules] == [
        [("Left", "l"), ("Right", "r")]
    ]
    assert {preset.key: preset.value.data for preset in machine.root.userdata} == {"count": 3}


@pytest.mark.parametrize(
    ("state", "reason"),
    [
        ('type="cpp" class="demo/FooState"', "`demo/FooState` is no class of Python"),
        ('type="py" class="FooState"', "`FooState` is no class of Python"),
        ('type="py" module="my-demo" class="FooState"', "`my-demo.FooState` is no class"),
        ('type="py" module="demo" class="class"', "`demo.class` is no class of Python"),
        ('type="py" module="demo" class="A b"', "`demo.A b` is no class of Python"),
    ],
)
def test_states_that_are_no_classes_of_python(state: str, reason: str, tmp_path: Path) -> None:
    edge = '<Transition from="a" to="end"/>'
    text = f'<StateMachine outcomes="end"><State name="S" {state}>{edge}</State></StateMachine>'
    made = imported(text, tmp_path, "demo.xml")
    assert any(reason in item.text for item in made.lost)
    assert "raise NotImplementedError" in made.texts["imported_states.py"]
    compile(made.texts["imported_states.py"], "imported_states.py", "exec")


def test_rules_of_yasmin_that_can_both_hold_are_listed(tmp_path: Path) -> None:
    text = DEMO.replace("</Concurrence>", '<OutcomeMap outcome="B"><Item state="Left"'
                        ' outcome="l"/></OutcomeMap></Concurrence>')  # fmt: skip
    assert any("can both hold" in item.text for item in imported(text, tmp_path, "demo.xml").lost)


def test_yasmin_files_include_others(tmp_path: Path) -> None:
    text = """<StateMachine name="Top" outcomes="end">
  <StateMachine name="Inner" file_name="inner.xml"><Transition from="x" to="end"/></StateMachine>
  <StateMachine name="Other" file_name="none.xml"><Transition from="y" to="end"/></StateMachine>
</StateMachine>"""
    inner = '<StateMachine outcomes="x"><State name="S" class="C"><Transition from="a" to="x"/>'
    (tmp_path / "inner.xml").write_text(f"{inner}</State></StateMachine>")
    made = imported(text, tmp_path, "top.xml")
    assert [proof.differences for proof in made.proofs] == [()]
    assert any("none.xml not found" in item.text for item in made.lost)
    machine = script(made, tmp_path)
    assert targets(node(machine, "Top/Inner/S")) == {"a": "x"}
    loop = (
        '<StateMachine outcomes="x"><StateMachine name="S" file_name="inner.xml"/></StateMachine>'
    )
    (tmp_path / "inner.xml").write_text(loop)
    (finding,) = imported(text, tmp_path, "top.xml").report
    assert "includes itself" in finding.message


@pytest.mark.parametrize(
    ("old", "new", "word"),
    [
        ('name="B" type', 'name="end" type', "name of an outcome"),
        ('name="B" type', 'name="A" type', "second state"),
        (' class="FooState"', "", "no `class`"),
        ('from="go" ', "", "no `from`"),
        (' outcomes="end broken"', "", "no `outcomes`"),
    ],
)
def test_what_yasmin_refuses_is_a_finding(old: str, new: str, word: str, tmp_path: Path) -> None:
    made = imported(DEMO.replace(old, new), tmp_path, "demo.xml")
    (finding,) = made.report
    assert word in finding.message


@pytest.mark.parametrize(
    ("text", "type", "value"),
    [("3", "int", 3), ("x", "int", None), ("1", "bool", True), ("2.5", "float", 2.5),
     ("[1, 2]", "list[int]", (1, 2)), ("{", "dict[str,int]", None), ("x", "Pose", None)],
)  # fmt: skip
def test_values_of_yasmin(text: str, type: str, value: Data) -> None:
    assert typed(text, type) == value


# --- the command


def folder_texts(folder: Path) -> Mapping[str, bytes]:
    return {str(path): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def test_importing_twice_and_over_edits(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("lift.scxml").write_text(LIFT)
    assert main(["import", "lift.scxml", "-o", "project"]) == 0
    assert "proof: the graph of main.yml is the graph of lift.scxml: 9" in capsys.readouterr().out
    first = folder_texts(Path("project"))
    assert main(["import", "lift.scxml", "-o", "project"]) == 0
    assert "is up to date" in capsys.readouterr().out
    assert folder_texts(Path("project")) == first
    assert main(["check", "project/main.yml"]) == 0
    assert main(["build", "project/main.yml", "--target", "python", "-o", "out"]) == 0
    script_file = Path("project/main.yml")
    script_file.write_text(script_file.read_text() + "# mine\n")
    assert main(["import", "lift.scxml", "-o", "project"]) == 1
    assert "was edited" in capsys.readouterr().err
    assert script_file.read_text().endswith("# mine\n")


def test_wrong_usage(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "lift.scxml"
    path.write_text(LIFT)
    assert main(["import", str(path), "--assume", "x=true"]) == 2
    assert main(["import", str(path), "--machine", "other"]) == 2
    assert main(["import", str(tmp_path / "lift.txt")]) == 2
    assert main(["import", str(tmp_path / "none.xml")]) == 1
    capsys.readouterr()
