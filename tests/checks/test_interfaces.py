"""Classes of the user are held against their interfaces: what they declare, read and never run."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.commands.scaffold import NewStateType, code_file, interface, stub
from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import Source
from smachac.driver import analyse, build, merged
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from smachac.frontend.types.state_types import find_state_type
from smachac.targets import load_target
from tests.support.examples import examples

GRASP = """
name: Grasp
variables: {force: {type: float, default: 10.0}}
input_keys: {target: Pose, near: Pose, "two words": int}
output_keys: {width: float}
outcomes: {held: {}, "not-held": {}}
"""
BOTH = (
    GRASP + 'code: {python: "arm.grasp:Grasp", cpp: {header: arm/grasp.hpp, class: "arm::Grasp"}}'
)
SCRIPT = """
name: sm
outcomes: [done, lost]
userdata:
  target: {type: Pose, value: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]}
  near: {type: Pose, value: [[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]}
  two words: 1
  width: 0.0
output_keys: [width]
states:
  - GRASP: {template: Grasp, transitions: {held: AGAIN, not-held: lost}}
  - AGAIN: {template: Grasp, transitions: {held: done, not-held: lost}}
"""
BUILT_IN = disk_library(Path("main.yml"), [])


def files(python: str = "", cpp: str = "", grasp: str = BOTH) -> dict[str, str]:
    return {
        "main.yml": SCRIPT,
        "templates/Grasp.yml": grasp,
        **({"arm/grasp.py": python} if python else {}),
        **({"arm/grasp.hpp": cpp} if cpp else {}),
    }


def stubs(grasp: str = BOTH, name: str = "Grasp") -> tuple[str, str]:
    """The code of a state type as smachac begins it, in Python and in C++."""
    type_ = find_state_type(name, memory_library({f"templates/{name}.yml": grasp}, BUILT_IN), [])
    assert type_ is not None
    return stub(type_, "python", BUILT_IN), stub(type_, "cpp", BUILT_IN)


def judged(texts: Mapping[str, str], target_name: str | None = None) -> Report:
    """What is said of classes by `check`, or by a build for a target."""
    library = memory_library(texts, BUILT_IN)
    analysis = analyse(Source("main.yml", texts["main.yml"]), library, [])
    report = analysis.report
    if target_name is not None:
        assert analysis.checked is not None, analysis.report
        target = load_target(target_name)
        assert target is not None
        built: Report = []
        files = build(analysis.checked, target, library, built)
        assert bool(files) == (not built)
        report = merged(report, built)
    return [item for item in report if item.code in ("SM603", "SM604")]


def said(texts: Mapping[str, str], target: str | None = None) -> list[str]:
    return [f"{item.code} {item.finding.message}" for item in judged(texts, target)]


PYTHON, CPP = stubs()


def changed(text: str, *pairs: tuple[str, str]) -> str:
    for old, new in pairs:
        assert text.count(old) == 1, (old, text)
        text = text.replace(old, new)
    return text


@pytest.mark.parametrize("target", [None, "python", "cpp"])
def test_a_stub_is_what_its_interface_says(target: str | None) -> None:
    assert said(files(PYTHON, CPP), target) == []


WORDS = st.sampled_from(["a", "b", "goal", "no_one", "class", "x1"])
KEYS = st.lists(
    st.tuples(WORDS, st.sampled_from(["int", "float", "Pose", "str", "list[str]", "bool"])),
    unique_by=lambda each: each[0],
    max_size=4,
)
WANTED = st.builds(
    lambda inputs, outputs, outcomes: NewStateType(
        name="Grasp", inputs=inputs, outputs=outputs, outcomes=outcomes
    ),
    KEYS,
    KEYS,
    st.lists(WORDS, min_size=1, max_size=4, unique=True),
)


def machine(wanted: NewStateType) -> str:
    """A script with one state of a type, and all it reads."""
    lines = ["name: sm", "outcomes: [over]", "input_keys:"]
    lines += [f"  {key}: {type_}" for key, type_ in wanted.inputs]
    ends = ", ".join(f"{name}: over" for name in wanted.outcomes)
    lines += ["states:", f"  - GRASP: {{template: Grasp, transitions: {{{ends}}}}}"]
    return "\n".join(line for line in lines if wanted.inputs or line != "input_keys:") + "\n"


@settings(max_examples=examples(30))
@given(wanted=WANTED, language=st.sampled_from(["python", "cpp"]))
def test_a_stub_of_any_interface_is_what_that_says(wanted: NewStateType, language: str) -> None:
    text = interface(wanted, language)
    type_ = find_state_type("Grasp", memory_library({"templates/Grasp.yml": text}, BUILT_IN), [])
    assert type_ is not None
    code = stub(type_, language, BUILT_IN)
    texts = {"main.yml": machine(wanted), "templates/Grasp.yml": text}
    assert said({**texts, code_file("Grasp", language).removeprefix("include/"): code}) == []


@settings(max_examples=examples(30))
@given(one=WANTED, other=WANTED)
def test_a_stub_of_another_interface_is_found(one: NewStateType, other: NewStateType) -> None:
    """In C++ all that a class depends on, in Python names alone."""

    def outside(wanted: NewStateType) -> tuple[object, ...]:
        return wanted.inputs, wanted.outputs, wanted.outcomes

    def names(wanted: NewStateType) -> list[set[str]]:
        keys = ([key for key, _ in part] for part in (wanted.inputs, wanted.outputs))
        return [set(wanted.outcomes), *map(set, keys)]

    for language, alike in (("cpp", outside(one) == outside(other)),
                            ("python", names(one) == names(other))):  # fmt: skip
        text = interface(one, language)
        library = memory_library({"templates/Grasp.yml": interface(other, language)}, BUILT_IN)
        type_ = find_state_type("Grasp", library, [])
        assert type_ is not None
        file = code_file("Grasp", language).removeprefix("include/")
        texts = {
            "main.yml": machine(one),
            "templates/Grasp.yml": text,
            file: stub(type_, language, BUILT_IN),
        }
        library = memory_library(texts, BUILT_IN)
        report = analyse(Source("main.yml", texts["main.yml"]), library, []).report
        differing = ("SM308", "SM309", "SM310", "SM603", "SM604")
        assert (not any(item.code in differing for item in report)) == alike


@pytest.mark.parametrize(
    ("pair", "told"),
    [
        (("'not-held'", "'lost'"), "it has the outcome `lost`, the interface has `not-held`"),
        (("['held', 'not-held']", "('held',)"), "the outcome `not-held` is missing"),
        (("'near', ", ""), "the input key `near` is missing"),
        (("'near', ", "'near', 'far', "), "the input key `far` is not in the interface"),
        (("            output_keys=['width'],\n", ""), "the output key `width` is missing"),
        (("['target', 'near', 'two words'],", "['target', 'near'], io_keys=['two words'],"),
         "the output key `two words` is not in the interface"),
        (("super().__init__(", "smach.State.__init__(self, "), ""),
        (("super().__init__(", "super(Grasp, self).__init__("), ""),
        (("outcomes=['held', 'not-held']", "['not-held', 'held']"), ""),
        (("['target', 'near', 'two words'],", "['target', 'near'], io_keys=KEYS,"), ""),
        (("'held', 'not-held'", "'held', *MORE"), ""),
        (("try:\n", "try\n"), ""),
    ],
)  # fmt: skip
def test_a_class_of_python(pair: tuple[str, str], told: str) -> None:
    """Where a part cannot be read it is not judged."""
    report = said(files(changed(PYTHON, pair)))
    if told:
        (message,) = report
        assert message.startswith("SM603 the class `arm.grasp:Grasp` does not match `Grasp.yml`: ")
        assert told in message
    else:
        assert report == []


@pytest.mark.parametrize(
    "part", ["['held', 'not-held']", "['target', 'near', 'two words']", "['width']"]
)
def test_a_part_that_cannot_be_read_hides_no_other(part: str) -> None:
    text = changed(PYTHON, (part, f"list({part})"))
    assert said(files(text)) == []
    for other in ("'held'", "'near'", "'width'"):
        report = said(files(text.replace(other, "'other'", 1)))
        assert len(report) == (other not in part)


@pytest.mark.parametrize(
    "pair",
    [
        ("(smach.State)", "(Skill)"),
        ("(smach.State)", "(smach.State, Logged)"),
        ("(smach.State)", "(smach.State, metaclass=Meta)"),
        ("class Grasp", "@registered\nclass Grasp"),
        ("class Grasp", "class Grip"),
        ("        self.force = force\n", "        self.register_outcomes(['more'])\n"),
        ("        self.force = force\n", "        self._outcomes = MORE\n"),
        ("        super().__init__(", "        if force: super().__init__("),
        ("    def __init__", "    @counted\n    def __init__"),
        ("input_keys=['target', 'near', 'two words'],", "**lists,"),
        ("input_keys=['target', 'near', 'two words'],", "*lists,"),
    ],
)
def test_a_class_that_may_declare_elsewhere_is_not_judged(pair: tuple[str, str]) -> None:
    text = changed(PYTHON, ("'not-held'", "'lost'"))
    assert len(said(files(text))) == 1
    assert said(files(changed(text, pair))) == []


@pytest.mark.parametrize(
    ("pair", "told"),
    [
        (("{ held, not_held }", "{ held, lost }"), "it has the outcome `lost`, the interface has"),
        (("{ held, not_held }", "{ held = 3, /* , no */ not_held, }"), ""),
        (("{ held, not_held }", "{ held [[deprecated]] }"), ""),
        (("enum class Outcome { held, not_held };", "using Outcome = smachac::Outcome;"), ""),
        (("const smachac::Pose &near; ", ""), "the input key `near` is missing"),
        (("int64_t two_words;", "int64_t two_words; bool far;"), "the input key `far` is not in"),
        (("&target; const smachac::Pose &near", "&near; const smachac::Pose &target"),
         "the fields of `In` must be in the order `target`, `near`, `two_words`"),
        (("std::int64_t two_words", "double two_words"), "`In::two_words` must be `std::int64_t`"),
        (("std::int64_t two_words", "int64_t two_words"), ""),
        (("std::int64_t two_words", "Count two_words"), ""),
        (("Key<double> &width", "Key<float> &width"), "`Out::width` must be `smachac::Key<do"),
        (("const smachac::Pose &near", "const std::map<a, b> &near"), ""),
        (("const smachac::Pose &near", "const smachac::Pose *far, &near"), ""),
        (("  struct Out { smachac::Key<double> &width; };\n", ""), ""),
        (("struct Out { smachac::Key<double> &width; };", "using Out = Results;"), ""),
        (("class Grasp {", "class Grasp final : public Skill<Grasp> {"), ""),
        (("class Grasp {", "// class Grasp {}\nclass Grip;\nclass Grasp {"), ""),
        (("class Grasp {", 'static const char *text = "class Grasp {";\nclass Grasp {'), ""),
        (("class Grasp {", "class Grip {"), ""),
        (("struct In {", "struct In : Common {"), ""),
        (("#pragma once", "#pragma once\n#define HELD 1'000"), ""),
    ],
)  # fmt: skip
def test_a_class_of_cpp(pair: tuple[str, str], told: str) -> None:
    report = said(files(cpp=changed(CPP, pair)))
    if told:
        (message,) = report
        assert message.startswith("SM603 the class `arm::Grasp` does not match `Grasp.yml`: ")
        assert told in message
    else:
        assert report == []


def test_inherited_parts_are_not_judged() -> None:
    base = changed(CPP, ("class Grasp {", "class Grasp : public Skill {"))
    assert (
        said(files(cpp=changed(base, ("  struct Out { smachac::Key<double> &width; };\n", ""))))
        == []
    )


def test_the_number_of_another_interface() -> None:
    grasp = changed(BOTH, ('"not-held": {}', '"not-held": {}, lost: {}'))
    script = SCRIPT.replace("not-held: lost", "not-held: lost, lost: lost")
    (item,) = judged({**files(cpp=CPP, grasp=grasp), "main.yml": script})
    right = stubs(grasp)[1].partition("smachac_interface = ")[2].partition(";")[0]
    finding = item.finding
    assert item.severity is Severity.WARNING
    assert (
        finding.message == "the class `arm::Grasp` was written for another version of `Grasp.yml`:"
        " the outcome `lost` is missing"
    )
    assert (
        finding.help
        == f"add `lost` to the outcomes of the class, then set `smachac_interface` to {right}"
    )
    assert str(finding.span) == "arm/grasp.hpp:12:24"
    assert [str(each.span) for each in finding.related] == ["arm/grasp.hpp:16:54", "main.yml:11:5"]


@pytest.mark.parametrize("spelling", ["{0}", "0X{1}u", "{2}U", "0x{3}'{4}UL"])
def test_the_number_may_be_spelt_otherwise(spelling: str) -> None:
    number = CPP.partition("smachac_interface = ")[2].partition(";")[0]
    digits = number[2:-1]
    same = spelling.format(number, digits.upper(), int(digits, 16), digits[:4], digits[4:])
    assert said(files(cpp=changed(CPP, (number, same)))) == []
    assert said(files(cpp=changed(CPP, (f" = {number}", f"{{{number}}}")))) == []
    assert len(said(files(cpp=changed(CPP, (number, "0x1U"))))) == 1


@pytest.mark.parametrize("number", ["0777", "089", "0x", "9" * 5000, "0x" + "f" * 5000, "1''2"])
def test_any_number_is_read_or_left_alone(number: str) -> None:
    found = said(
        files(cpp=changed(CPP, ("smachac_interface = 0x", f"smachac_interface = {number}; //")))
    )
    assert len(found) <= 1


@settings(max_examples=200)
@given(st.data())
@pytest.mark.slow
def test_damaged_code_is_judged_without_a_crash(data: st.DataObject) -> None:
    """Pieces of a class taken out, doubled or exchanged for others."""
    text = data.draw(st.sampled_from([PYTHON, CPP]))
    pieces = re.findall(r"\w+|\s+|.", text)
    for _ in range(data.draw(st.integers(1, 6))):
        at = data.draw(st.integers(0, len(pieces) - 1))
        new = data.draw(st.sampled_from([*pieces, "", "{{", "'", '"', "/*", "\\", "0", "\0", "é"]))
        pieces[at] = new
    damaged = "".join(pieces)
    assert len(said(files(cpp=damaged) if text is CPP else files(damaged))) <= 1


def test_a_fault_stops_a_build_for_its_language_and_is_told_once() -> None:
    stale = files(PYTHON, changed(CPP, ("smachac_interface = 0x", "smachac_interface = 0xf")))
    assert [item.severity for item in judged(stale, "python")] == [Severity.WARNING]
    assert [item.severity for item in judged(stale, "cpp")] == [Severity.ERROR]


def test_lists_left_to_the_script_are_not_held_against_a_class() -> None:
    grasp = changed(BOTH, ("outcomes: {held", 'outcomes: {"*": {}, held'))
    text = changed(PYTHON, ("'not-held'", "'lost'"))
    assert said(files(text, grasp=grasp.partition(", cpp")[0] + "}")) == []


TEMPLATE = """{% block class_defs %}
class Grasp(smach.State):
    def __init__(self, force=10.0):
        super().__init__(outcomes=["held", OTHER], input_keys=["target", "near", "two words"],
                         output_keys=["width"])

    def execute(self, userdata):
        userdata.width = {{ 1.0 }}
        return "held"
{% endblock %}
"""


@pytest.mark.parametrize(
    ("other", "findings"),
    [('"not-held"', 0), ('"lost"', 1), ("{{ name }}", 0), ('"{{ name }}"', 0)],
)
def test_a_class_in_a_template_is_read_as_well(other: str, findings: int) -> None:
    texts = files(grasp=GRASP + "code: {python: Grasp.tpl.py}\n")
    texts["templates/Grasp.tpl.py"] = TEMPLATE.replace("OTHER", other)
    assert len(said(texts)) == findings


def test_code_is_found_beside_the_script_and_where_the_project_says(tmp_path: Path) -> None:
    (tmp_path / "smachac.toml").write_text('code = ["src", "headers"]\n')
    main = tmp_path / "main.yml"
    library = disk_library(main, [])
    for folder in ("include", ".", "headers", "src"):  # the last one comes first
        (tmp_path / folder / "arm").mkdir(parents=True)
        (tmp_path / folder / "arm" / "grasp.hpp").write_text(folder)
        found = disk_library(main, []).code("arm/grasp.hpp")
        assert found is not None
        assert found.text == folder
    assert library.code("../main.yml") is None
    assert library.code("arm/other.hpp") is None
