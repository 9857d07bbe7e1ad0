"""Values and functions of ROS states against the definitions of their messages."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.files import disk_library
from smachac.frontend.loader import Library, memory_library
from tests.support.typed_machines import BUILT_IN

FILES = {
    "my_msgs/srv/Grip.srv": "float32 width\nint32 count\nBattery battery\nBattery[] spares\n"
    "uint8[] data\nfloat64[3] place\nbool soft\nuint8 level\nstring label\n"
    "---\nbool success\nstring outcome\nBattery[] spares\nBattery battery\n",
    "my_msgs/srv/Pair.srv": "float32 width\nint32 count\n---\n",
    "my_msgs/msg/Battery.msg": "uint8 LOW=1\nHeader header\nfloat32 percentage\n",
    "std_msgs/msg/Header.msg": "builtin_interfaces/Time stamp\nstring frame_id\n",
    "builtin_interfaces/msg/Time.msg": "int32 sec\nuint32 nanosec\n",
    "my_msgs/action/Tidy.action": "float32 x\nint32 y\n---\nint32 total\n---\nfloat32 done\n",
}
STATE = """
name: sm
template: ROSBase
outcomes: [done, failed]
states:
  - STEP:
      template: {template}
      {fields}
      transitions: {{{transitions}}}
"""
CALL = "succeeded: done, aborted: failed, preempted: failed"


def findings(
    template: str, fields: str, transitions: str = CALL, library: Library | None = None
) -> list[tuple[str, str, str, str | None]]:
    """The code, the marked text, the message and the help of the findings of SM512 and SM318."""
    script = STATE.format(template=template, fields=fields, transitions=transitions)
    library = library or memory_library(FILES, BUILT_IN)
    report = analyse(Source("main.yml", script), library, []).report
    found = [item for item in report if item.code in ("SM512", "SM318")]
    return [(e.code, e.span.text, e.finding.message, e.finding.help) for e in found]


def service(field: str, type: str = "my_msgs/srv/Grip") -> list[tuple[str, str, str, str | None]]:
    return findings(
        "ServiceState", f"service_namespace: grip\n      service: {type}\n      {field}"
    )


def action(field: str) -> list[tuple[str, str, str, str | None]]:
    return findings(
        "SimpleActionState",
        f"action_server_namespace: tidy\n      action: my_msgs/action/Tidy\n      {field}",
    )


def watch(code: str, template: str = "MonitorState", type: str = "my_msgs/Battery") -> list[str]:
    name, ends = {
        "MonitorState": ("cond_cb", "valid: done, invalid: failed, preempted: failed"),
        "WaitForMsgState": ("msg_cb", CALL),
    }[template]
    fields = f"topic: /battery\n      msg_type: {type}\n      {name}: '{code}'"
    return [text for _, text, _, _ in findings(template, fields, ends)]


@pytest.mark.parametrize(
    ("values", "marked"),
    [
        ("{width: 'wide', count: 1}", ["'wide'"]),
        ("{width: 1, count: true}", ["true"]),
        ("{width: 0.5, count: 1.5}", ["1.5"]),
        ("{width: 0.5, count: 1}", []),
        ("{width: [0.5]}", ["[0.5]"]),
        ("{level: 256}", ["256"]),
        ("{level: 255}", []),
        ("{soft: 1}", []),
        ("{soft: 2}", ["2"]),
        ("{label: 3}", ["3"]),
        ("{data: abc}", []),
        ("{data: [1, 2]}", []),
        ("{data: [1, 256]}", ["[1, 256]"]),
        ("{place: [1, 2]}", ["[1, 2]"]),
        ("{place: [1, 2, 3.5]}", []),
        ("{battery: 5}", ["5"]),
        ("{width: '`half`', count: null}", []),
        ("{width: ud.width}", []),
    ],
)
def test_values_of_fields(values: str, marked: list[str]) -> None:
    assert [text for _, text, _, _ in service(f"request: {values}")] == marked


def test_the_message_has_the_field_and_its_type() -> None:
    assert service("request: {width: wide}") == [
        (
            "SM512",
            "wide",
            "the value of `width` does not fit: the field of the request of `my_msgs/Grip` is "
            "`float32`",
            "write a value of the type `float32`, such as `1.5`",
        )
    ]
    assert [text for _, text, _, _ in action("goal: {x: far, y: [1]}")] == ["far", "[1]"]
    assert action("goal: {x: 1.5, y: 1}") == []


@pytest.mark.parametrize(
    ("values", "count"), [("[1, 2]", 0), ("[0.5, 1.5]", 1), ("[1, 2, 3]", 1), ("[1]", 1)]
)
def test_a_list_has_the_values_of_all_fields(values: str, count: int) -> None:
    assert len(service(f"request: {values}", "my_msgs/Pair")) == count


def test_look_ups_in_scripts_are_judged_by_their_value_only() -> None:
    assert service("params: {w: 0.5}\n      request: {width: [params, w]}") == []


@pytest.mark.parametrize(
    ("values", "marked"),
    [
        ("{battery: {percent: 0.5}}", ["percent"]),
        ("{battery: {percentage: 0.5}}", []),
        ("{battery: {percentage: much}}", ["much"]),
        ("{spares: [{percentage: 0.5}, {percent: 0.5}]}", ["percent"]),
        ("{battery: {header: {stamp: {secs: 1}}}}", ["secs"]),
        ("{battery: {header: {stamp: 1.5}}}", []),
    ],
)
def test_fields_at_any_depth(values: str, marked: list[str]) -> None:
    assert [text for _, text, _, _ in service(f"request: {values}")] == marked


def test_a_nested_field_has_a_guess() -> None:
    [(_, _, message, help)] = service("request: {battery: {percent: 0.5}}")
    assert message == "`my_msgs/Battery` has no field `percent`"
    assert help == "did you mean `percentage`?"


def test_a_nested_message_without_definition_is_not_judged() -> None:
    files = {name: text for name, text in FILES.items() if not name.endswith("Battery.msg")}
    library = memory_library(files, BUILT_IN)
    fields = (
        "service_namespace: grip\n      service: my_msgs/Grip\n      request: {battery: {a: 1}}"
    )
    assert findings("ServiceState", fields, library=library) == []


@pytest.mark.parametrize(
    ("code", "marked"),
    [
        ("lambda ud, msg: msg.percent > 0.3", ["percent"]),
        ("lambda ud, msg: msg.percentage > 0.3", []),
        ("lambda ud, msg: msg.header.stamp.secs > 3", ["secs"]),
        ("lambda ud, msg: msg.header.stamp.sec > 3", []),
        ("lambda ud, msg: msg.LOW > 3 and msg._type and msg.serialize", []),
        ("lambda ud, msg: hasattr(msg, 'percent') and msg.percent > 1", []),
        ("lambda ud, msg: [msg.percent for msg in ud.old]", []),
        ("lambda ud, msg: ud.percent > 1", []),
        ("lambda ud, msg: msg.percentage.real > 1", []),
        ("lambda msg: msg.percent", []),
    ],
)
def test_fields_that_conditions_read(code: str, marked: list[str]) -> None:
    assert watch(code.replace("'", "''")) == marked


def test_the_order_of_the_arguments_is_that_of_the_state_type() -> None:
    assert watch("lambda msg, ud: msg.percent > 1", "WaitForMsgState") == ["percent"]
    assert watch("lambda msg, ud: msg.percentage > 1", "WaitForMsgState") == []
    assert watch("lambda ud, msg: msg.percent", type="other_msgs/Battery") == []


@pytest.mark.parametrize(
    ("code", "marked"),
    [
        ("\"lambda ud, response: 'done' if response.succes else None\"", ["succes"]),
        ("\"lambda ud, response: 'succeeded' if response.success else None\"", []),
        ('"lambda ud, response: print(response.spares[0].percent)"', ["percent"]),
        ('"lambda ud, response: print(response.spares[0].percentage)"', []),
        ('"lambda ud, response: print(response.spares.percent)"', []),
    ],
)
def test_fields_of_responses(code: str, marked: list[str]) -> None:
    found = service(f"response_cb: {code}")
    assert [text for code, text, _, _ in found if code == "SM512"] == marked


def test_functions_of_requests_goals_and_results() -> None:
    found = service("request_cb: 'lambda ud, request: setattr(request, \"widht\", 1)'")
    assert [(text, help) for _, text, _, help in found] == [('"widht"', "did you mean `width`?")]
    assert service("request_cb: 'lambda ud, request: setattr(request, \"width\", 1)'") == []
    assert [text for _, text, _, _ in action("goal_cb: 'lambda ud, goal: print(goal.z)'")] == ["z"]
    assert action("goal_cb: 'lambda ud, goal: print(goal.x)'") == []
    found = action("result_cb: 'lambda ud, status, result: print(status.x, result.totl)'")
    assert [(text, help) for _, text, _, help in found] == [("totl", "did you mean `total`?")]


def test_a_type_that_its_package_does_not_have() -> None:
    assert service("request: {width: 1}", "my_msgs/srv/Gripp") == [
        (
            "SM512",
            "Gripp",
            "the package `my_msgs` has no service `Gripp`",
            "did you mean `Grip`?",
        )
    ]
    assert service("request: {width: 1}", "other_msgs/srv/Gripp") == []
    assert watch("lambda ud, msg: msg.a", type="my_msgs/msg/Batery") == ["Batery"]
    assert watch("lambda ud, msg: msg.a", type="my_msgs/TidyActionGoal") == []
    library = memory_library({**FILES, "my_msgs/srv/Gripp.idl": ""}, BUILT_IN)
    fields = "service_namespace: grip\n      service: my_msgs/Gripp"
    assert findings("ServiceState", fields, library=library) == []


def test_the_packages_on_the_disk_are_searched(tmp_path: Path) -> None:
    folder = tmp_path / "my_msgs" / "srv"
    folder.mkdir(parents=True)
    (folder / "Grip.srv").write_text("float32 width\n---\n", "utf-8")
    library = replace(disk_library(tmp_path / "main.yml", []), ros=2)
    fields = "service_namespace: grip\n      service: my_msgs/srv/{}"
    found = findings("ServiceState", fields.format("Gripp"), library=library)
    assert [text for _, text, _, _ in found] == ["Gripp"]
    assert findings("ServiceState", fields.format("Grip"), library=library) == []


@pytest.mark.parametrize(
    ("result", "wrong"),
    [
        ("response.success", True),
        ("response.battery.percentage", True),
        ("response.battery", True),
        ("response.outcome", False),
        ("ud.outcome", False),
        ("response.unknown.success", False),
    ],
)
def test_a_field_that_is_no_text_is_no_outcome(result: str, wrong: bool) -> None:
    found = service(
        f"response_cb: 'lambda userdata, response: {result}'".replace("ud.", "userdata.")
    )
    assert [text for code, text, _, _ in found if code == "SM318"] == [result] * wrong


def test_the_message_on_a_wrong_outcome() -> None:
    [(code, _, message, _)] = service("response_cb: 'lambda userdata, response: response.success'")
    assert code == "SM318"
    assert message.endswith(
        "returns `response.success`, a `bool`, which is not an outcome of `STEP`"
    )
