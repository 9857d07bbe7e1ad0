"""Text files in other encodings than UTF-8: those that are valid are read, others are findings."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.driver import analyse_script
from smachac.robots.encodings import EncodingError, decoded
from smachac.robots.files import read_file

STATE = "{template: ScriptedState, outcomes: [done], transitions: {done: done}}"
SCRIPT = f"name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n- A: {STATE}\n"
CALL = SCRIPT.replace("template: ScriptedState, outcomes: [done]", "template: Wave")
ROBOT = SCRIPT.replace("template: Base\n", "template: PyBulletBase\nrobot: arm.yml\n")
MESSAGE = """name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {msg: {width: 1.0}, msg_type: cell_msgs/msg/Lamp}
states:
- A:
    template: PublishMsgState
    action: start
    input_keys: [msg, msg_type]
    transitions: {succeeded: done, aborted: failed}
"""
CLASS = """import smach


class Wave(smach.State):
    "größe"

    def __init__(self):
        super().__init__(outcomes=["done"])

    def execute(self, userdata):
        return "off"
"""
INTERFACE = b'name: Wave\noutcomes: [done]\ncode: {python: "waves:Wave"}\n'
LINKS = "".join(f'<link name="glied_{number}"/>' for number in range(2))
URDF = f"""<?xml version="1.0" encoding="ENCODING"?>
<robot name="größe">{LINKS}
<joint name="drehung_ä" type="revolute"><parent link="glied_0"/><child link="glied_1"/>
<limit lower="-2" upper="2" velocity="1" effort="10"/></joint></robot>
"""
DESCRIPTION = (
    "name: arm\nurdf: arm.urdf\narms: {left: {joints: [drehung_ä], tool: glied_1, home: [0]}}\n"
)


def findings(folder: Path, files: dict[str, bytes]) -> list[tuple[str, str, str | None]]:
    """The code, message and help of each finding about files in a folder."""
    for name, data in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
    report = analyse_script(folder / "main.yml").report
    return [(item.code, item.message, item.help) for item in report]


UTF_8 = "save the file as UTF-8"
LATIN = f"{UTF_8}: it seems to be Latin-1, with `ö` here"
UTF_16 = f"{UTF_8}: it seems to be UTF-16"
MARK = f"{UTF_8} without a byte order mark: ROS does not accept it"


@pytest.mark.parametrize(
    ("data", "found"),
    [
        ("# größe\nfloat64 width\n".encode(), None),
        ("# größe\nfloat64 width\n".encode("latin-1"), ("the byte 0xf6", LATIN)),
        ("float64 width\n".encode("utf-16"), ("the byte 0xff", UTF_16)),
        ("float64 width\n".encode("utf-8-sig"), ("the file begins with a byte order mark", MARK)),
        (b"\x7fELF\x80\x00", ("the byte 0x80", UTF_8)),
    ],
)
def test_a_message_definition_that_is_not_utf_8(
    tmp_path: Path, data: bytes, found: tuple[str, str] | None
) -> None:
    files = {"main.yml": MESSAGE.encode(), "cell_msgs/msg/Lamp.msg": data}
    reported = findings(tmp_path, files)
    assert [code for code, _, _ in reported] == ["SM007"] * (found is not None)
    for _, message, help in reported:
        assert found is not None
        assert message.startswith(found[0])
        assert help == found[1]


@pytest.mark.parametrize("kind", ["srv", "action"])
def test_a_service_and_an_action_that_are_not_utf_8(tmp_path: Path, kind: str) -> None:
    state, field = {
        "srv": ("ServiceState", "service"),
        "action": ("SimpleActionState", "action"),
    }[kind]
    script = SCRIPT.replace("Base", "ROSBase").replace("[done]", "[done, failed]", 1)
    call = f"template: {state}, {field}: cell_msgs/{kind}/Lamp, {field}_name: lamp"
    ends = "succeeded: done, aborted: failed, preempted: failed"
    script = script.replace("template: ScriptedState, outcomes: [done]", call)
    script = script.replace("done: done", ends)
    files = {"main.yml": script.encode(), f"cell_msgs/{kind}/Lamp.{kind}": b"---\n# \xf6\n"}
    assert ("SM007", "the byte 0xf6 is not valid in UTF-8", LATIN) in findings(tmp_path, files)


def test_a_bad_definition_warns_and_names_what_is_not_checked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    findings(Path(), {"main.yml": MESSAGE.encode(), "cell_msgs/msg/Lamp.msg": b"# gr\xf6sse\n"})
    assert main(["check", "main.yml"]) == 0
    printed = capsys.readouterr().out
    assert (
        "warning[SM007]: the byte 0xf6 is not valid in UTF-8\n --> cell_msgs/msg/Lamp.msg:1:5"
        in (printed)
    )
    assert "note: the fields of `cell_msgs/Lamp` are not checked" in printed


WRONG_RESULT = "`Wave` returns `off`, which is not one of its outcomes"


@pytest.mark.parametrize(
    ("first", "encoding", "message"),
    [
        ("", "utf-8", WRONG_RESULT),
        ("", "utf-8-sig", WRONG_RESULT),
        ("# -*- coding: latin-1 -*-\n", "latin-1", WRONG_RESULT),
        ("#!/usr/bin/env python\n# vim: set fileencoding=cp1252 :\n", "cp1252", WRONG_RESULT),
        ("# -*- coding: iso-8859-15-unix -*-\n", "iso-8859-15", WRONG_RESULT),
        ("", "latin-1", "the byte 0xf6 is not valid in UTF-8"),
        ("\n\n# coding: latin-1\n", "latin-1", "the byte 0xf6 is not valid in UTF-8"),
        ("", "utf-16", "the byte 0xff is not valid in UTF-8"),
        ("# coding: klingon\n", "utf-8", "the declared encoding `klingon` cannot be read"),
        ("# coding: punycode\n", "utf-8", "the declared encoding `punycode` cannot be read"),
    ],
)
def test_a_class_in_the_encoding_that_its_file_declares(
    tmp_path: Path, first: str, encoding: str, message: str
) -> None:
    files = {
        "main.yml": CALL.encode(),
        "templates/Wave.yml": INTERFACE,
        "waves.py": (first + CLASS).encode(encoding),
    }
    assert [message for _, message, _ in findings(tmp_path, files)] == [message]


@pytest.mark.parametrize("encoding", ["utf-8", "latin-1"])
def test_a_header_with_comments_in_any_encoding(tmp_path: Path, encoding: str) -> None:
    files = {
        "main.yml": CALL.encode(),
        "templates/Wave.yml": b"name: Wave\noutcomes: [done]\n"
        b"code: {cpp: {header: waves.hpp, class: Wave}}\n",
        "waves.hpp": "// größe\nclass Wave {};\n".encode(encoding),
    }
    found = findings(tmp_path, files)
    assert [code for code, _, _ in found] == ["SM609", "SM609"]
    assert found[0][1] == "the class `Wave` has no method `execute`"


def test_a_header_in_utf_16_is_not_text_for_a_compiler(tmp_path: Path) -> None:
    files = {
        "main.yml": CALL.encode(),
        "templates/Wave.yml": b"name: Wave\noutcomes: [done]\n"
        b"code: {cpp: {header: waves.hpp, class: Wave}}\n",
        "waves.hpp": "class Wave {};\n".encode("utf-16"),
    }
    assert ("SM007", "the byte 0xff is not valid in UTF-8", UTF_16) in findings(tmp_path, files)


@pytest.mark.parametrize("encoding", ["utf-8", "ISO-8859-1", "windows-1252", "utf-16"])
def test_a_robot_file_in_the_encoding_that_it_declares(tmp_path: Path, encoding: str) -> None:
    files = {
        "main.yml": ROBOT.encode(),
        "arm.yml": DESCRIPTION.encode(),
        "arm.urdf": URDF.replace("ENCODING", encoding).encode(encoding),
    }
    assert findings(tmp_path, files) == []
    wrong = {"arm.yml": DESCRIPTION.replace("drehung_ä", "drehung_a").encode()}
    assert [code for code, _, _ in findings(tmp_path, wrong)] == ["SM018"]


@pytest.mark.parametrize(
    ("declared", "encoding", "message"),
    [
        ("utf-8", "latin-1", "the byte 0xf6 is not valid in UTF-8"),
        ("x-klingon", "utf-8", "the declared encoding `x-klingon` cannot be read"),
        ("utf-16", "utf-8", "the declared encoding `utf-16` cannot be read"),
        ("punycode", "utf-8", "the declared encoding `punycode` cannot be read"),
    ],
)
def test_a_robot_file_that_declares_another_encoding_than_it_has(
    tmp_path: Path, declared: str, encoding: str, message: str
) -> None:
    files = {
        "main.yml": ROBOT.encode(),
        "arm.yml": DESCRIPTION.encode(),
        "arm.urdf": URDF.replace("ENCODING", declared).encode(encoding),
    }
    assert [item[:2] for item in findings(tmp_path, files)] == [("SM007", message)]


def test_a_simulation_reads_the_encodings_that_the_check_accepts(tmp_path: Path) -> None:
    pytest.importorskip("pybullet")
    from smachac.sim.robot_file import read_robot_file

    for encoding in ("utf-8", "ISO-8859-1", "utf-16"):
        path = tmp_path / f"{encoding}.urdf"
        path.write_bytes(URDF.replace("ENCODING", encoding).encode(encoding))
        assert "drehung_ä" in read_robot_file(path).urdf.text
    path = tmp_path / "arm.yml"
    path.write_bytes(DESCRIPTION.encode("utf-16"))
    assert read_file(path)["name"] == "arm"


def test_a_macro_file_in_the_encoding_that_it_declares(tmp_path: Path) -> None:
    pytest.importorskip("xacro")
    body = URDF.partition("\n")[2]
    included = f'<?xml version="1.0" encoding="ISO-8859-1"?>\n{body}'
    main_file = (
        '<robot name="größe" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:include filename="links.xacro"/></robot>'
    )
    files = {
        "main.yml": ROBOT.encode(),
        "arm.yml": DESCRIPTION.replace("arm.urdf", "arm.urdf.xacro").encode(),
        "arm.urdf.xacro": main_file.encode(),
        "links.xacro": included.encode("latin-1"),
    }
    assert findings(tmp_path, files) == []
    (code, message, help) = findings(tmp_path, {"links.xacro": body.encode("latin-1")})[0]
    assert code == "SM018"
    assert "links.xacro` cannot be read: " in message
    assert help == "save it as UTF-8"


BROKEN = {
    "sub.yml": SCRIPT.replace("template: ScriptedState, outcomes: [done]", "script: sub"),
    "templates/Wave.yml": CALL,
    "templates/Wave.tpl.py": CALL,
    "arm.yml": ROBOT,
    "scene.yml": ROBOT.replace("arm.yml", "panda\nscene: scene.yml"),
    "states.yml": SCRIPT.replace("outcomes", "properties: states.yml\noutcomes", 1),
    "smachac.toml": SCRIPT,
    "pyproject.toml": SCRIPT,
}


@pytest.mark.parametrize("name", BROKEN)
def test_each_file_of_a_project_names_its_wrong_byte(tmp_path: Path, name: str) -> None:
    files = {"main.yml": BROKEN[name].encode(), name: b"# gr\xf6sse\n"}
    assert findings(tmp_path, files) == [("SM007", "the byte 0xf6 is not valid in UTF-8", LATIN)]


def test_a_template_is_utf_8_because_the_program_is() -> None:
    text = "# -*- coding: latin-1 -*-\n# größe\n"
    with pytest.raises(UnicodeDecodeError):
        decoded(text.encode("latin-1"), "Wave.tpl.py")
    assert decoded(text.encode("latin-1"), "wave.py") == text


def test_a_declaration_is_a_name_of_a_known_encoding() -> None:
    for name in ("rot13", "idna", "unicode_escape", "utf-7", "mbcs", "undefined", "."):
        with pytest.raises(EncodingError):
            decoded(f"# coding: {name}\n".encode(), "wave.py")
