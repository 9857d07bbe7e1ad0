"""Message definitions of ROS 1 and ROS 2: what is read of them, where they are searched."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from smachac.diagnostics.source import Source
from smachac.frontend.files import disk_library
from smachac.frontend.loader import Library, memory_library
from smachac.frontend.messages.message_definitions import (
    TypeName,
    find_definitions,
    read_definition,
    type_name,
)
from smachac.ir.message_types import (
    PRIMITIVES,
    Definition,
    DefinitionKind,
    FieldType,
    Message,
    userdata_type,
)
from smachac.robots.files import installed_packages

NOTHING = Library(script=lambda name, caller: None, template=lambda name: None)


def read(text: str, kind: DefinitionKind = "msg") -> Definition | None:
    return read_definition(Source("Grasp", text), TypeName("cell_msgs", "Grasp"), kind)


def message(text: str) -> Message:
    found = read(text)
    assert found is not None
    return found.part("message")


@pytest.mark.parametrize(
    ("text", "kind", "name"),
    [
        ("std_srvs/Trigger", "srv", "std_srvs/Trigger"),
        ("std_srvs/srv/Trigger", "srv", "std_srvs/Trigger"),
        ("std_srvs.srv.Trigger", "srv", "std_srvs/Trigger"),
        (" geometry_msgs/msg/Pose ", "msg", "geometry_msgs/Pose"),
        ("actionlib.msg.TestAction", "action", "actionlib/TestAction"),
        ("std_srvs/msg/Trigger", "srv", None),
        ("Trigger", "srv", None),
        ("std_srvs/srv/more/Trigger", "srv", None),
        ("std_srvs/{{ kind }}", "srv", None),
        ("../std_srvs/Trigger", "srv", None),
        ("std_srvs//Trigger", "srv", None),
        ("", "msg", None),
    ],
)
def test_names_in_all_spellings(text: str, kind: DefinitionKind, name: str | None) -> None:
    found = type_name(text, kind)
    assert (str(found) if found is not None else None) == name


def test_fields_of_all_types() -> None:
    found = message(
        "# a grasp\n"
        "Header header   # ROS 1\n"
        "bool held\n"
        "\tuint8  number\n"
        "float64[] joints\n"
        "float64[9] turn\n"
        "string<=10 label\n"
        "string<=5[<=3] labels\n"
        "Contact[] contacts\n"
        "geometry_msgs/Pose pose\n"
        "geometry_msgs/msg/Pose other_pose\n"
        "time stamp"
    )
    assert [(field.name, str(field.type)) for field in found.fields] == [
        ("header", "std_msgs/Header"),
        ("held", "bool"),
        ("number", "uint8"),
        ("joints", "float64[]"),
        ("turn", "float64[9]"),
        ("label", "string<=10"),
        ("labels", "string<=5[<=3]"),
        ("contacts", "cell_msgs/Contact[]"),
        ("pose", "geometry_msgs/Pose"),
        ("other_pose", "geometry_msgs/Pose"),
        ("stamp", "time"),
    ]
    assert [field.span.text for field in found.fields] == [field.name for field in found.fields]
    turn = found.field("turn")
    assert turn is not None
    assert turn.type == FieldType(name="float64", array=True, size=9)
    assert found.field("absent") is None


def test_constants_and_default_values() -> None:
    found = message(
        "uint8 OPEN=0 # open\n"
        "uint8 CLOSED = 1\n"
        "string MOTTO=never # stop\n"
        "string QUOTED='a # b' # comment\n"
        "int32 count 5 # default\n"
        'string name "none # at all"\n'
        "float64[] angles [0.0, 1.5]\n"
    )
    assert [(constant.name, constant.value) for constant in found.constants] == [
        ("OPEN", "0"),
        ("CLOSED", "1"),
        ("MOTTO", "never # stop"),
        ("QUOTED", "'a # b'"),
    ]
    assert [(field.name, field.default) for field in found.fields] == [
        ("count", "5"),
        ("name", '"none # at all"'),
        ("angles", "[0.0, 1.5]"),
    ]


def test_services_and_actions_have_parts() -> None:
    service = read("geometry_msgs/Pose pose\n---\nbool success\nstring message\n", "srv")
    assert service is not None
    assert [field.name for field in service.part("request").fields] == ["pose"]
    assert [field.name for field in service.part("response").fields] == ["success", "message"]
    assert service.part("response").name == "cell_msgs/Grasp.response"
    action = read("int32 order\n---\n---\nint32 done\n", "action")
    assert action is not None
    assert [len(item.fields) for item in action.messages] == [1, 0, 1]
    with pytest.raises(ValueError, match="not in tuple"):
        service.part("feedback")


@pytest.mark.parametrize(
    "text",
    [
        "float64",
        "float64 2nd",
        "float<=3 x",
        "a/srv/B field",
        "a/b/c/D field",
        "float64[ joints",
        "float64[-1] joints",
        "int32 x\nint32 x",
        "int32 x\n---\nint32 y",
        "int32[] X=1",
        "cell_msgs/Contact X=1",
        "int32 x.y",
    ],
)
def test_a_text_that_is_not_valid_gives_nothing(text: str) -> None:
    assert read(text) is None


@pytest.mark.parametrize("text", ["", "---\n---", "\n"])
def test_a_service_has_two_parts(text: str) -> None:
    assert read(text, "srv") is None


@given(st.text(alphabet="abz_AZ09 \t\r\n#=<>[]/'\"-.", max_size=80))
def test_no_text_makes_the_reader_fail(text: str) -> None:
    found = read(text, "srv")
    assert found is None or len(found.messages) == 2


@pytest.mark.parametrize(
    ("field", "wanted"),
    [
        ("float32 x", "float"),
        ("uint64 x", "int"),
        ("wstring x", "str"),
        ("bool[3] x", "bool[3]"),
        ("float64[<=3] x", "list[float]"),
        ("Contact x", "cell_msgs/Contact"),
        ("uint8[] x", "any"),
        ("time x", "any"),
    ],
)
def test_the_type_of_userdata_for_a_field(field: str, wanted: str) -> None:
    assert str(userdata_type(message(field).fields[0].type)) == wanted


def test_each_primitive_type_has_a_type_of_userdata() -> None:
    kinds = {str(userdata_type(FieldType(name=name))) for name in PRIMITIVES}
    assert kinds == {"bool", "int", "float", "str", "any"}


def test_definitions_in_memory() -> None:
    files = {
        "cell_msgs/srv/Grasp.srv": "---\nbool held\n",
        "cell_msgs/action/Tidy.action": "---\n---\n",
        "cell_msgs/msg/Broken.msg": "int32\n",
    }
    library = memory_library(files, NOTHING)

    def names(text: str, kind: DefinitionKind) -> list[str]:
        return [definition.name for definition in find_definitions(text, kind, library)]

    assert names("cell_msgs/Grasp", "srv") == ["Grasp"]
    assert names("cell_msgs/msg/TidyAction", "action") == ["Tidy"]
    assert names("cell_msgs/action/Tidy", "action") == ["Tidy"]
    assert names("cell_msgs/Grasp", "msg") == []
    assert names("cell_msgs/Broken", "msg") == []
    assert names("Grasp", "srv") == []


def write(folder: Path, file: str, text: str) -> Path:
    path = folder / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, "utf-8")
    return path


def found(main: Path, text: str = "cell_msgs/Grasp") -> list[str]:
    library = disk_library(main, [])
    return [
        definition.part("request").fields[0].name
        for definition in find_definitions(text, "srv", library)
    ]  # fmt: skip


@pytest.fixture(autouse=True)
def _no_workspace(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in ("AMENT_PREFIX_PATH", "ROS_PACKAGE_PATH"):
        monkeypatch.delenv(name, raising=False)


def test_packages_beside_the_script_and_around_it(tmp_path: Path) -> None:
    write(tmp_path, "work/.git/config", "")
    main = write(tmp_path, "work/cell_msgs/scripts/deep/main.yml", "")
    write(tmp_path, "work/cell_msgs/srv/Grasp.srv", "int32 around\n---\n")
    write(tmp_path, "work/other_msgs/srv/Place.srv", "int32 neighbour\n---\n")
    write(tmp_path, "outer_msgs/srv/Place.srv", "int32 outside\n---\n")
    assert found(main) == ["around"]
    assert found(main, "other_msgs/Place") == ["neighbour"]
    assert found(main, "outer_msgs/Place") == []


def test_a_link_out_of_the_project_is_not_followed(tmp_path: Path) -> None:
    outside = write(tmp_path, "outside/Grasp.srv", "int32 outside\n---\n").parent
    main = write(tmp_path, "work/main.yml", "")
    write(tmp_path, "work/.git/config", "")
    (tmp_path / "work/cell_msgs").mkdir()
    (tmp_path / "work/cell_msgs/srv").symlink_to(outside)
    assert found(main) == []


def test_installed_packages_of_both_versions_of_ros(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    main = write(tmp_path, "work/main.yml", "")
    write(tmp_path, "two/share/cell_msgs/srv/Grasp.srv", "int32 two\n---\n")
    write(tmp_path, "one/share/cell_msgs/srv/Grasp.srv", "int32 one\n---\n")
    write(tmp_path, "src/repository/cell_msgs/srv/Grasp.srv", "int32 nested\n---\n")
    assert found(main) == []
    monkeypatch.setenv("AMENT_PREFIX_PATH", os.pathsep.join([str(tmp_path / "two"), ""]))
    assert found(main) == ["two"]
    folders = [str(tmp_path / item) for item in ("one/share", "absent", "src")]
    monkeypatch.setenv("ROS_PACKAGE_PATH", os.pathsep.join(folders))
    assert found(main) == ["two", "one", "nested"]
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(tmp_path / "src/repository/cell_msgs"))
    assert found(main) == ["two", "nested"]


def test_a_watch_sees_definitions_that_come_later(tmp_path: Path) -> None:
    from smachac.frontend.files import Disk

    disk = Disk()
    library = disk_library(write(tmp_path, "main.yml", ""), [], disk=disk)
    assert library.definitions("cell_msgs/srv/Grasp.srv", []) == []
    assert os.path.realpath(tmp_path / "cell_msgs/srv/Grasp.srv") in disk.searched_files()


def test_packages_beside_this_python_come_last() -> None:
    folders = [*installed_packages("cell_msgs", {"AMENT_PREFIX_PATH": "/opt/two"})]
    assert folders[0].as_posix() == "/opt/two/share/cell_msgs"
    assert folders[-1].as_posix().endswith("/share/cell_msgs")
