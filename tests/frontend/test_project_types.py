"""The types and classes of C++ that a project file names, in scripts and interfaces."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.config import Project, read_project
from smachac.ir.types import CppClass

SETTINGS = """
[types]
Joints = "float<rad>[7]"
Part = {name = "str", "long side" = "float", at = {frame = "str?", pose = "Pose"}}
Parts = "list[Part]"
"""
MACHINE = """
name: sm
outcomes: [done]
userdata: {part: {type: Part, value: VALUE}}
states:
  - TAKE: {template: Take, transitions: {taken: done}}
"""
TAKE = "name: Take\ninput_keys: {part: TYPE}\noutcomes: [taken]\n"
VALUE = "{name: bolt, long side: 1, at: {pose: [0.5, 0.5, 0.5]}}"


def project_of(text: str) -> tuple[Project, Report]:
    report: Report = []
    found = read_project(Source("smachac.toml", text), Path("smachac.toml"), report)
    assert found is not None
    return found, report


def test_types_use_earlier_names() -> None:
    found, report = project_of(SETTINGS)
    assert report == []
    part = '{name: str, "long side": float, at: {frame: str?, pose: Pose}}'
    assert found.types == {
        "Joints": "float<rad>[7]",
        "Part": part,
        "Parts": f"list[{part}]",
    }


def test_classes_of_cpp() -> None:
    text = """
    [cpp_types]
    Part = {class = "::shop::Part", header = "shop/part.hpp"}
    "geometry_msgs/Pose" = {class = "msg::Pose", header = "msg/pose.hpp"}
    """
    found, report = project_of(text)
    assert report == []
    assert found.cpp_types == {
        "Part": CppClass("shop::Part", "shop/part.hpp"),
        "geometry_msgs/Pose": CppClass("msg::Pose", "msg/pose.hpp"),
    }


@pytest.mark.parametrize(
    ("text", "place", "message", "help_"),
    [
        ("types = 3", "types", "`types` must be a table", "write `[types]`"),
        ("[types]\nlist = 'int'", "list", "`list` cannot be the name of a type", "no word that is"),
        ("[types]\n'a b' = 'int'", "'a b'", "`a b` cannot be the name of a type", "use letters"),
        ("[types]\nPart = 3", "3", "this is no type (`Part`)", "write a type in quotes"),
        ("[types]\nPart = 'list['", "'list['", "this is no type (`Part`)", "write a type in"),
        ("[types]\nPart = 'flot'", "'flot'", "`flot` is no type (`Part`)", "did you mean `float`?"),
        ("[types]\nPart = {a = 3}", "{a", "this is no type (`Part`)", "a table of fields"),
        ("[types]\nB = 'Part'\nPart = 'int'", "'Part'", "`Part` is no type (`B`)", "write a type"),
        ("cpp_types = []", "cpp_types", "`cpp_types` must be a table", "write it as"),
        ("[cpp_types]\nPart = 'A'", "Part", "`Part` must have a class and a header", "write it as"),
        (
            "[cpp_types]\nPart = {class = 'a b', header = 'a.hpp'}",
            "Part",
            "`Part` names no class of C++ in a header",
            "write it as",
        ),
        (
            "[cpp_types]\nPart = {class = 'a', header = 'a.hpp\"\\n#error'}",
            "Part",
            "`Part` names no class",
            "write it as",
        ),
        ("[cpp_types]\nPart = {class = 'a', more = 1}", "Part", "must have a class", "write it as"),
    ],
)
def test_faults(text: str, place: str, message: str, help_: str) -> None:
    _, (found,) = project_of(text)
    assert found.code == "SM007"
    assert found.span.text == place
    assert message in found.message
    assert found.finding.help is not None
    assert help_ in found.finding.help


def checked(folder: Path, value: str, type_: str, capsys: pytest.CaptureFixture[str]) -> str:
    """The report of a machine whose state type `Take` has an input `part`."""
    (folder / "templates").mkdir(exist_ok=True)
    (folder / "smachac.toml").write_text(SETTINGS)
    (folder / "templates" / "Take.yml").write_text(TAKE.replace("TYPE", type_))
    (folder / "main.yml").write_text(MACHINE.replace("VALUE", value))
    main(["check", str(folder / "main.yml"), "-q"])
    return capsys.readouterr().out


@pytest.mark.parametrize("type_", ["Part", "{type: Part, doc: What to take.}"])
def test_an_interface_uses_them(
    type_: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert checked(tmp_path, VALUE, type_, capsys) == ""
    wrong = VALUE.replace("name: bolt", "name: 3")
    told = checked(tmp_path, wrong, type_, capsys)
    assert "SM304" in told
    assert "`Part`" in told


def test_an_unknown_name_in_an_interface(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    told = checked(tmp_path, VALUE, "list of Jonts", capsys)
    assert "SM017" in told
    assert "did you mean `Joints`?" in told


def test_a_script_has_its_own_types_beside_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    own = "types: {Box: {inside: Part}}\nuserdata: {part: {type: Part, value: VALUE},"
    own += " box: {type: Box, value: {inside: VALUE}}}"
    text = MACHINE.replace("userdata: {part: {type: Part, value: VALUE}}", own)
    text = text.replace("transitions", "input_keys: [box], transitions")
    assert text.count("Box") == 2
    checked(tmp_path, VALUE, "Part", capsys)
    for value, code in ((VALUE, ""), (VALUE.replace("long", "short"), "SM304")):
        (tmp_path / "main.yml").write_text(text.replace("VALUE", value))
        main(["check", str(tmp_path / "main.yml"), "-q", "--select", "SM304"])
        assert code in capsys.readouterr().out


def test_findings_of_a_project_file_are_corrected_by_no_other_text(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    checked(tmp_path, VALUE, "Part", capsys)
    (tmp_path / "smachac.toml").write_text(f"{SETTINGS}\n[bounds]\ntext = 'x'\n")
    text = MACHINE.replace("VALUE", VALUE).replace("taken: done", "taken: dne")
    (tmp_path / "main.yml").write_text(text)
    main(["check", str(tmp_path / "main.yml")])
    told = capsys.readouterr().out
    assert "SM007" in told
    assert "did you mean `done`?" in told
    assert "this also corrects" not in told
