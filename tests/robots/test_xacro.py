# ruff: noqa: E501 (tables of short texts)
"""Macro files of robots: what is expanded, what is refused, and the place of each mistake."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

import smachac
from smachac.frontend.files import Disk
from smachac.robots import urdf
from smachac.robots.files import Packages, project_folder
from smachac.robots.xacro_files import XacroError, expand

pytest.importorskip("xacro")

HEAD = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
ARM = (
    HEAD
    + """<xacro:include filename="parts/macros.xacro"/>
<xacro:arg name="reach" default="1.5"/>
<xacro:property name="limits" value="${xacro.load_yaml('limits.yaml')}"/>
<link name="base"/>
<xacro:turning name="j1" parent="base" reach="$(arg reach)"/>
<xacro:if value="${limits['wrist']['used'] and len([k for k in limits]) == 1}">
  <xacro:turning name="j2" parent="j1_link" reach="${radians(limits.wrist.reach)}"/>
</xacro:if>
</robot>
"""
)
MACROS = (
    HEAD
    + """<xacro:macro name="turning" params="name parent reach">
<link name="${name}_link"/>
<joint name="${name}" type="revolute"><parent link="${parent}"/><child link="${name}_link"/>
<limit lower="${-float(reach)}" upper="${reach}" effort="10" velocity="1"/></joint>
</xacro:macro>
</robot>
"""
)


def project(folder: Path, **texts: str) -> Path:
    """A robot in macros; `main` is the text of its file."""
    files = {"arm.urdf.xacro": texts.pop("main", ARM), "parts/macros.xacro": MACROS}
    files["limits.yaml"] = "wrist: {used: true, reach: 90}"
    for name, written in (files | texts).items():
        (folder / "robot" / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / "robot" / name).write_text(written)
    return folder / "robot" / "arm.urdf.xacro"


def mistake(path: Path, packages: Packages | None = None) -> tuple[str, str, str]:
    """The message, the file, and the text at the place of a mistake."""
    with pytest.raises(XacroError) as error:
        expand(path, {}, packages or {})
    assert error.value.help
    start, end = error.value.place
    return error.value.message, error.value.file.name, error.value.text[start:end]


def test_a_file_is_expanded(tmp_path: Path) -> None:
    path = project(tmp_path)
    found = expand(path, {"reach": "2.0"}, {})
    joints = urdf.read(found.text).joints
    assert [(j.lower, j.upper) for j in joints.values()] == [
        (-2.0, 2.0),
        (pytest.approx(-1.5708, abs=1e-4), pytest.approx(1.5708, abs=1e-4)),
    ]
    names = {file.name for file in found.files}
    assert names == {"arm.urdf.xacro", "macros.xacro", "limits.yaml"}
    assert expand(path, {"reach": "2.0"}, {}) == found


def test_packages_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    main = (
        HEAD + '<xacro:include filename="$(find parts)/macros.xacro"/><link name="base"/></robot>'
    )
    path = project(tmp_path, main=main)
    assert "<link" in expand(path, {}, {}).text  # the folder of this name above the file
    (tmp_path / "robot" / "parts").rename(tmp_path / "robot" / "vendor")
    assert mistake(path)[0] == "the package `parts` was not found"
    assert mistake(path)[2] == "$(find parts)"
    assert "<link" in expand(path, {}, {"parts": tmp_path / "robot" / "vendor"}).text
    outside = tmp_path / "ros" / "ws"
    outside.mkdir(parents=True)
    (tmp_path / "robot" / ".git").mkdir()
    (tmp_path / "robot" / "vendor").rename(outside / "parts")
    given = mistake(path, {"parts": outside / "parts"})  # only the project and what is installed
    assert "is outside of the project and of all packages" in given[0]
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(outside))
    assert "<link" in expand(path, {}, {}).text


@pytest.mark.parametrize(
    ("body", "message", "place"),
    [
        ('<link name="$(arg side)"/>', "the argument `side` has no value", "$(arg side)"),
        ('<link name="${side}"/>', "the name `side` is not defined", "side"),
        ('<link name="${1 +}"/>', "invalid syntax", "1 +"),
        ('<link name="${9.0 ** 999}"/>', "Numerical result out of range", "9.0 ** 999"),
        ('<link name="${1 / 0}"/>', "division by zero", "1 / 0"),
        ('<link name="$(env HOME)"/>', "`$(env ...)` is not read", "$(env"),
        ('<link name="$(eval 1 + 1)"/>', "`$(eval ...)` is not read", "$(eval"),
        ('<link name="${lambda: 1}"/>', "`lambda: 1` is not an expression", "lambda: 1"),
        ("<link name=\"${'a'.encode()}\"/>", "`.encode` is not allowed here", "'a'.encode()"),
        ('<link name="${python.type(1)}"/>', "the function `type` is not allowed", "python.type(1)"),
        ("<link name=\"${python.set('ab')}\"/>", "the function `set` is not allowed", "python.set('ab')"),
        ('<xacro:include filename="none.xacro"/>', "was not found", "none.xacro"),
        ("<xacro:include filename=\"../../secret.xacro\"/>", "is outside of the project", "secret.xacro"),
        ("<link name=\"${xacro.load_yaml('../../secret.yaml')}\"/>", "is outside of the project", "secret.yaml"),
        ('<xacro:macro name="m" params=""><xacro:m/></xacro:macro><xacro:m/>', "a macro calls itself without an end", "<xacro:m/>"),
        ("<xacro:unknown/>", "the macro `unknown` is not defined", "<xacro:unknown/>"),
    ],
)  # fmt: skip
def test_mistakes(tmp_path: Path, body: str, message: str, place: str) -> None:
    (tmp_path / "secret.xacro").write_text(MACROS)
    (tmp_path / "secret.yaml").write_text("a: 1")
    path = project(tmp_path / "more", main=f"{HEAD}<link name='a'/>\n{body}\n</robot>")
    found = mistake(path)
    assert message in found[0]
    assert found[1:] == ("arm.urdf.xacro", place)


NESTED = """\
  <xacro:macro name="inner" params="name parent:=base *shape">
    <link name="${name}"/>
  </xacro:macro>
  <xacro:macro name="outer" params="name"><xacro:inner CALL><link/></xacro:inner></xacro:macro>
</robot>
"""


@pytest.mark.parametrize(
    ("call", "message", "place", "help"),
    [
        ('name="${nam}"', "the name `nam` is not defined", "nam", "correct the macro file"),
        ('nam="${name}"', "the macro `inner` has no parameter `nam`", 'nam="${name}"', "did you mean `name`?"),
        ('size="1"', "the macro `inner` has no parameter `size`", 'size="1"', "remove it, or add it"),
        ('parent="a"', "the macro `inner` needs `name`", '<xacro:inner parent="a">', 'write `name="..."`'),
    ],
)  # fmt: skip
def test_mistakes_in_a_call_inside_a_macro(
    tmp_path: Path, call: str, message: str, place: str, help: str
) -> None:
    """The place is the call in the macro around it, in the included file."""
    body = '<xacro:include filename="parts/nested.xacro"/><link name="base"/>'
    body += """<xacro:property name="limits" value="${xacro.load_yaml('limits.yaml')}"/>"""
    body += '<xacro:outer name="a"/><xacro:inner name="b"><link/></xacro:inner></robot>'
    path = project(
        tmp_path, main=HEAD + body, **{"parts/nested.xacro": HEAD + NESTED.replace("CALL", call)}
    )
    with pytest.raises(XacroError) as error:
        expand(path, {}, {})
    found = error.value
    start, end = found.place
    assert (found.message, found.file.name) == (message, "nested.xacro")
    assert found.text[start:end] == place
    assert found.help.startswith(help)


def test_a_macro_with_a_similar_name_is_proposed(tmp_path: Path) -> None:
    body = '<xacro:include filename="parts/macros.xacro"/><xacro:turned name="a"/></robot>'
    path = project(tmp_path, main=HEAD + body)
    with pytest.raises(XacroError, match="the macro `turned` is not defined") as error:
        expand(path, {}, {})
    assert error.value.help == "did you mean `turning`?"


def test_an_optional_environment_and_include(tmp_path: Path) -> None:
    body = '<link name="$(optenv HOME a)"/><xacro:include filename="none.xacro" optional="true"/>'
    found = expand(project(tmp_path, main=f"{HEAD}{body}</robot>"), {}, {})
    assert urdf.read(found.text).links == ("a",)


@pytest.mark.parametrize(
    ("value", "expected"),
    [
        ("2 ** 3 // 3 - -1", "3"),
        ("2 ** 65 == 2.0 ** 65", "True"),
        ("not 1 > 2 and 'a' in 'abc'", "True"),
        ("'x' if 1 &lt; 2 &lt; 3 else 'y'", "x"),
        ("None or [1, 2, 3][1:]", "[2, 3]"),
        ("dict(a=1, **dict())['a']", None),
        ("dict(k=(1, 2)).get('k')[-1]", "2"),
        ("'_'.join(['a', 'b']).upper()", "A_B"),
        ("max(map(python.abs, [-3, 2]))", "3"),
        ("[a + b for a, b in [(1, 2), (3, 4)] if a > 1]", "[7]"),
        ("python.sum(x * x for x in python.range(4))", "14"),
        ("round(math.pi, 2)", "3.14"),
        ("'%s%d' % ('a', 1)", "a1"),
        ("xacro.arg('side')", "left"),
    ],
)
def test_expressions(tmp_path: Path, value: str, expected: str | None) -> None:
    path = project(tmp_path, main=f'{HEAD}<link name="${{{value}}}"/></robot>')
    if expected is None:
        with pytest.raises(XacroError):
            expand(path, {"side": "left"}, {})
        return
    assert urdf.read(expand(path, {"side": "left"}, {}).text).links == (expected,)


def test_faults_of_xml_in_an_included_file(tmp_path: Path) -> None:
    path = project(tmp_path, **{"parts/macros.xacro": "<robot>\n<!-- a -- b -->\n</robot>"})
    assert mistake(path) == ("a comment contains `--`", "macros.xacro", "--")


def test_without_the_package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = project(tmp_path)
    folders = [folder for folder in sys.path if "site-packages" not in folder]
    monkeypatch.setattr(sys, "path", [*folders, str(Path(smachac.__file__).parents[1])])
    with pytest.raises(XacroError, match=r"`xacro`.* is not installed") as error:
        expand(path, {}, {})
    assert "pip install 'smachac[xacro]'" in error.value.help
    assert error.value.file == path


SCRIPT = """
name: sm
template: {base}
robot: {robot}
outcomes: [done, failed]
userdata: {{up: [{angle}, 0.5]}}
states:
  - MOVE:
      template: MoveToJointPositionsState
      remapping: {{positions: up}}
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""
DESCRIPTION = """
name: arm
urdf: arm.urdf.xacro
arguments: {reach: 1.25}
arms:
  arm: {joints: [j1, j2], tool: j2_link, home: [0.0, 0.0]}
"""


def findings(path: Path, **script: str) -> list[tuple[str, str, str]]:
    main = path.with_name("main.yml")
    values = {"base": "PyBulletBase", "robot": "arm.yml", "angle": "0.0"}
    main.write_text(SCRIPT.format(**(values | script)))
    return [
        (item.code, item.finding.message, Path(item.finding.span.source.name).name)
        for item in smachac.check(main)
    ]


def test_a_description_with_arguments(tmp_path: Path) -> None:
    path = project(tmp_path, **{"arm.yml": DESCRIPTION})
    assert findings(path) == []
    ((code, message, _),) = findings(path, angle="1.3")
    assert (code, message) == (
        "SM502",
        "joint 1 of `up` is 1.3 rad, outside its limits -1.25 to 1.25",
    )


def test_mistakes_name_the_macro_file(tmp_path: Path) -> None:
    wrong = MACROS.replace('upper="${reach}"', 'upper="${-2 * float(reach)}"')
    path = project(tmp_path, **{"arm.yml": DESCRIPTION, "parts/macros.xacro": wrong})
    ((code, message, file),) = findings(path)
    assert (code, file) == ("SM018", "arm.urdf.xacro")
    assert "the lower limit -1.25 of joint `j1` is above its upper limit -2.5" in message
    assert '(in the expanded text: `<limit effort="10" lower="-1.25"`' in message
    broken = project(tmp_path, **{"arm.yml": DESCRIPTION, "parts/macros.xacro": MACROS + "<b/>"})
    ((code, message, file),) = findings(broken)
    assert (code, file) == ("SM018", "macros.xacro")
    assert "junk after document element" in message


def test_a_macro_file_without_a_description(tmp_path: Path) -> None:
    path = project(tmp_path)
    codes = [code for code, _, _ in findings(path, base="Base", robot="arm.urdf.xacro")]
    assert codes == []
    ((code, _, _),) = findings(path, base="Base", robot="arm.urdf.xacro", angle="1.6")
    assert code == "SM502"


def test_a_changed_file_is_expanded_again(tmp_path: Path) -> None:
    path = project(tmp_path)
    disk = Disk()
    before = disk.expand(str(path), {}, {})
    assert disk.expand(str(path), {}, {}) is before
    macros = path.parent / "parts" / "macros.xacro"
    macros.write_text(MACROS.replace('effort="10"', 'effort="10.5"'))
    assert disk.refresh() == {str(macros.resolve())}
    assert 'effort="10.5"' in disk.expand(str(path), {}, {})


@pytest.mark.parametrize("mark", [".git", "package.xml", None])
def test_the_project_of_a_file(tmp_path: Path, mark: str | None) -> None:
    folder = tmp_path / "arm" / "urdf"
    folder.mkdir(parents=True)
    if mark is not None:
        (tmp_path / mark).touch()
    assert project_folder(folder / "arm.urdf.xacro") == (folder if mark is None else tmp_path)
