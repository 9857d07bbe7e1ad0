"""Fields of messages against their definitions; silence where a definition does not decide."""

from __future__ import annotations

import pytest

from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.loader import memory_library
from tests.support.typed_machines import BUILT_IN
from tests.trust.judged_repairs import printed

GRASP = "cell_msgs/srv/Grasp.srv"
TIDY = "cell_msgs/action/Tidy.action"
FILES = {
    GRASP: "geometry_msgs/Pose pose\nfloat64 width\nint32[] fingers\nbool soft\nuint8[] data\n"
    "---\nbool held\n",
    TIDY: "string room\n---\nint32 count\n---\nfloat32 done\n",
}

SERVICE = """
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {{{data}}}
states:
  - GRASP:
      template: ServiceState
      service_namespace: gripper
      service: {type}
      {fields}
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""
ACTION = """
name: sm
template: ROSBase
outcomes: [done, failed]
states:
  - TIDY:
      template: SimpleActionState
      action_server_namespace: tidy
      action: {type}
      goal: {goal}
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""


def faults(script: str, files: dict[str, str] = FILES) -> list[tuple[str, str, str | None]]:
    """The marked text, the message and the help of each finding of SM512."""
    report = analyse(Source("main.yml", script), memory_library(files, BUILT_IN), []).report
    found = [item for item in report if item.code == "SM512"]
    return [(item.span.text, item.finding.message, item.finding.help) for item in found]


def service(fields: str, data: str = "", type: str = "cell_msgs/Grasp") -> str:
    return SERVICE.format(fields=fields, data=data, type=type)


@pytest.mark.parametrize("type", ["cell_msgs/Grasp", "cell_msgs/srv/Grasp", "cell_msgs.srv.Grasp"])
def test_a_misspelt_slot_is_found_in_every_spelling_of_the_type(type: str) -> None:
    slots = "request_slots: [widht]\n      input_keys: [widht]"
    assert faults(service(slots, "widht: 0.1", type)) == [
        (
            "widht",
            "the request of `cell_msgs/Grasp` has no field `widht`",
            "did you mean `width`? Write it here, in the `input_keys`, and remap it:"
            " `remapping: {width: widht}`",
        )
    ]


def test_slots_of_the_response_are_those_of_the_second_part() -> None:
    slots = "response_slots: [width]\n      output_keys: [width]"
    assert faults(service(slots)) == [
        (
            "width",
            "the response of `cell_msgs/Grasp` has no field `width`",
            "write `held`, its only field, in place of `width`",
        )
    ]
    assert faults(service("response_slots: [held]\n      output_keys: [held]")) == []


@pytest.mark.parametrize(
    ("goal", "marked"),
    [
        ("TidyGoal(room='hall')", []),
        ("TidyGoal(rom='hall')", ["rom"]),
        ("Tidy.Goal(rom='hall', room='rom')", ["rom"]),
        ("msg.TidyGoal(rom = 1)", ["rom"]),
        ("make_goal(rom='hall')", []),
        ("TidyGoal('hall')", []),
        ("TidyGoal(**rooms)", []),
        ("goal", []),
    ],
)
@pytest.mark.parametrize("type", ["cell_msgs/TidyAction", "cell_msgs/action/Tidy"])
def test_arguments_of_the_class_of_a_message(goal: str, marked: list[str], type: str) -> None:
    found = faults(ACTION.format(type=type, goal=goal))
    assert [text for text, _, _ in found] == marked


@pytest.mark.parametrize(
    ("key", "value", "wrong"),
    [
        ("width", "'wide'", True),
        ("width", "1", False),
        ("width", "[1.0]", True),
        ("fingers", "[1, 2]", False),
        ("fingers", "[1.5]", True),
        ("fingers", "3", True),
        ("soft", "1", False),
        ("data", "[1, 2]", False),
        ("data", "abc", False),
        ("pose", "[[0.0, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]", False),
        ("pose", "0.1", True),
        ("pose", "{position: {x: 0.1}}", False),
    ],
)
def test_types_of_values(key: str, value: str, wrong: bool) -> None:
    slots = f"request_slots: [{key}]\n      input_keys: [{key}]"
    assert bool(faults(service(slots, f"{key}: {value}"))) == wrong


def test_a_type_that_is_not_known_is_not_judged() -> None:
    slots = 'request_slots: [width]\n      input_keys: {width: "any"}\n      remapping: {width: w}'
    assert faults(service(slots, "w: 0.1")) == []
    slots = 'request_slots: [width]\n      input_keys: {width: "float?"}'
    assert faults(service(slots, "width: 0.1")) == []


@pytest.mark.parametrize("files", [{}, {GRASP: "not a definition\n"}])
def test_without_a_valid_definition_nothing_is_checked(files: dict[str, str]) -> None:
    slots = "request_slots: [widht]\n      input_keys: [widht]"
    assert faults(service(slots, "widht: 0.1"), files) == []


def test_of_several_definitions_one_may_have_the_field() -> None:
    from dataclasses import replace

    one = Source("one/Grasp.srv", "float64 width\n---\n")
    two = Source("two/Grasp.srv", "float64 opening\n---\n")
    library = replace(memory_library({}, BUILT_IN), definitions=lambda path, report: [one, two])
    slots = "request_slots: [{key}]\n      input_keys: [{key}]"
    for key, count in (("width", 0), ("opening", 0), ("force", 1)):
        script = service(slots.format(key=key), f"{key}: 0.1")
        report = analyse(Source("main.yml", script), library, []).report
        assert [item.code for item in report].count("SM512") == count


MESSAGE = """
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {{command: {message}, kind: std_msgs/Bool}}
states:
  - SAY:
      template: {type}
      action: {action}
      input_keys: [{keys}]
      remapping: {{msg: command, msg_type: kind}}
      transitions: {{succeeded: done, aborted: failed}}
"""


def untyped(script: str) -> list[tuple[str, str]]:
    """The marked text and the message of each finding of SM515."""
    report = analyse(Source("main.yml", script), memory_library({}, BUILT_IN), []).report
    found = [item for item in report if item.code == "SM515"]
    return [(item.span.text, item.finding.message) for item in found]


@pytest.mark.parametrize(
    ("type", "action"), [("PublishMsgState", "start"), ("PublishObserverMsgState", "add")]
)
def test_a_mapping_as_a_message_needs_its_type(type: str, action: str) -> None:
    script = MESSAGE.format(type=type, action=action, keys="msg", message="{data: true}")
    words = "`SAY` gets a mapping as its message, but no type: it lacks the key `msg_type`"
    assert untyped(script) == [("{data: true}", words)]
    script = script.replace("[msg]", "[msg, msg_type]")
    assert untyped(script) == []


@pytest.mark.parametrize("message", ["Bool(data=True)", "[1.0, 2.0, 3.0]", "null"])
def test_other_messages_need_no_type(message: str) -> None:
    script = MESSAGE.format(type="PublishMsgState", action="start", keys="msg", message=message)
    assert untyped(script) == []


@pytest.mark.parametrize("action", ["stop", "stop_all"])
def test_a_state_that_reads_no_message_needs_no_type(action: str) -> None:
    script = MESSAGE.format(
        type="PublishMsgState", action=action, keys="msg", message="{data: true}"
    )
    assert untyped(script) == []


def test_null_is_no_type() -> None:
    script = service("request: {soft: true}", type="null")
    assert untyped(script) == [("null", "`service` of `GRASP` is null: it names no type")]
    script = ACTION.format(type="null", goal="{room: a}")
    assert untyped(script) == [("null", "`action` of `TIDY` is null: it names no type")]


LAMP = {"cell_msgs/msg/Lamp.msg": "bool on\n", **FILES}


@pytest.mark.parametrize(
    ("type", "files", "found"),
    [
        ("cell_msgs/Lamp", LAMP, ("Lamp", "`cell_msgs/Lamp` is a message, not a service")),
        ("cell_msgs/Tidy", LAMP, ("Tidy", "`cell_msgs/Tidy` is an action, not a service")),
        ("std_msgs/msg/Bool", {}, ("msg/Bool", "`std_msgs/msg/Bool` is a message, not a service")),
        ("std_msgs/Bool", {}, ("Bool", "`std_msgs/Bool` is a message, not a service")),
        ("std_msgs/Header", {}, ("Header", "`std_msgs/Header` is a message, not a service")),
        ("cell_msgs/Grasp", LAMP, None),
    ],
)
def test_a_type_of_another_kind(
    type: str, files: dict[str, str], found: tuple[str, str] | None
) -> None:
    lines = [fault[:2] for fault in faults(service("request: null", type=type), files)]
    assert lines == ([found] if found is not None else [])


PUBLISH = """
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {speed: DATA, msg_type: TYPE}
states:
  - GO:
      template: PublishMsgState
      action: once
      input_keys: [msg, msg_type]
      remapping: {msg: speed}
      transitions: {succeeded: done, aborted: failed}
"""
SPEED = {
    "cell_msgs/msg/Speed.msg": "Axis linear\nAxis angular\nstring frame\n",
    "cell_msgs/msg/Axis.msg": "float64 x\nfloat64 y\n",
}


@pytest.mark.parametrize(
    ("data", "found"),
    [
        ("{linear: {x: 0.1}, angular: {yaw: 0.2}}", ["yaw"]),
        ("{liner: {x: 0.1}}", ["liner"]),
        ("{linear: {x: fast}}", ["fast"]),
        ("{linear: {x: 1}, frame: map}", []),
        ("[[0.1, 0.0], [0.0, 0.0], map]", []),
    ],
)
def test_a_published_mapping(data: str, found: list[str]) -> None:
    script = PUBLISH.replace("DATA", data).replace("TYPE", "cell_msgs/msg/Speed")
    assert [fault[0] for fault in faults(script, SPEED)] == found
    assert faults(script.replace("cell_msgs/msg/Speed", "other_msgs/Speed"), SPEED) == []


def test_a_published_mapping_of_an_unknown_type() -> None:
    script = PUBLISH.replace("DATA", "{liner: 1}").replace("TYPE", "cell_msgs/Speed")
    script = script.replace("userdata: {", "input_keys: [msg_type]\nuserdata: {")
    assert faults(script.replace(", msg_type: cell_msgs/Speed", ""), SPEED) == []


@pytest.mark.parametrize(
    ("condition", "found"),
    [
        ("result.count == 'OK'", "result.count == 'OK'"),
        ("'OK' != result.count", "'OK' != result.count"),
        ("result.count > 3", ""),
        ("status == 'OK'", ""),
        ("result.count in (1, 2)", ""),
        ("str(result.count) == '3'", ""),
    ],
)
def test_a_number_compared_with_a_text(condition: str, found: str) -> None:
    function = f"lambda ud, status, result: 'succeeded' if {condition} else 'aborted'"
    script = ACTION.format(type="cell_msgs/Tidy", goal="{room: hall}")
    script = script.replace("      goal", f'      result_cb: "{function}"\n      goal')
    assert [fault[0] for fault in faults(script)] == ([found] if found else [])


STOP = """
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {{stop_msg: {msg}, stop_type: geometry_msgs/Twist}}
states:
  - HALT:
      template: PublishMsgState
      action: once
      input_keys: {keys}
      remapping: {remapping}
      transitions: {{succeeded: done, aborted: failed}}
"""
TYPED = ("[msg, msg_type]", "{msg: stop_msg, msg_type: stop_type}")


def test_the_unread_key_with_a_type_is_the_missing_one() -> None:
    script = STOP.format(msg="{linear: {x: 0.0}}", keys="[msg]", remapping="{msg: stop_msg}")
    report = analyse(Source("main.yml", script), memory_library({}, BUILT_IN), []).report
    codes = [code for code, *_ in printed({"main.yml": script})]
    assert "SM515" in codes
    assert "SM305" not in codes
    (found,) = [item for item in report if item.code == "SM515"]
    assert "`msg_type: stop_type` to its `remapping`" in (found.help or "")


@pytest.mark.parametrize(
    ("msg", "help"),
    [
        ("{x: 0.0, angular: {z: 0.0}}", "write `linear: {x: 0.0}`"),
        ("{linear: {x: 0.0}, z: 0.5}", "write `angular: {z: 0.5}`"),
        ("{x: 0.0, z: 0.5}", "write `linear: {x: 0.0, z: 0.5}` in place of `x` and `z`"),
        ("{spin: 0.5}", "use one of its fields"),
        ("{linear: {x: 0.0}}", None),
    ],
)
def test_a_field_one_level_too_high(msg: str, help: str | None) -> None:
    script = STOP.format(msg=msg, keys=TYPED[0], remapping=TYPED[1])
    found = [text or "" for _, _, text in faults(script, {})]
    assert len(found) == (help is not None)
    assert all(item.startswith(help or "") for item in found)


@pytest.mark.parametrize(
    ("request_", "found"),
    [
        ("[false, 0.0]", [("[false, 0.0]", "write `[0.0, false]`")]),
        ("[a, 0.0]", [("a", "write a value of the type `float32`, such as `1.5`"),
                      ("0.0", "write a value of the type `bool`, such as `true`")]),
        ("[0.0, false]", []),
        ("[0, 1]", []),
    ],
)  # fmt: skip
def test_a_list_gives_the_fields_in_their_order(
    request_: str, found: list[tuple[str, str]]
) -> None:
    files = {"cell_msgs/srv/Clamp.srv": "float32 force\nbool close\n---\nbool held\n"}
    script = service(f"request: {request_}", type="cell_msgs/Clamp")
    assert [(text, help) for text, _, help in faults(script, files)] == found


@pytest.mark.parametrize(
    ("goal", "help"),
    [
        ("{via: corridor}", "write a list: `[corridor]`"),
        ("{via: 3}", "write a value of the type `string[]`"),
        ("{exposure: 50ms}", "write the seconds as a number: `0.05`"),
        ("{exposure: soon}", "write a value of the type `duration`"),
        ("{exposure: 0.05, via: [corridor]}", None),
    ],
)
def test_the_help_for_a_list_and_for_a_time(goal: str, help: str | None) -> None:
    files = {TIDY: "string room\nstring[] via\nduration exposure\n---\n---\n"}
    report = analyse(
        Source("main.yml", ACTION.format(type="cell_msgs/Tidy", goal=goal)),
        memory_library(files, BUILT_IN),
        [],
    ).report
    found = [item for item in report if item.code == "SM512"]
    assert [item.help for item in found] == ([help] if help else [])
    name = goal.strip("{").partition(":")[0]
    assert all(item.related[0].span.text == name for item in found)


@pytest.mark.parametrize(
    ("value", "type", "number"),
    [
        ("12.5", "builtin_interfaces/Duration", 0),
        ("12", "builtin_interfaces/Time", 0),
        ("12", "duration", 0),
        ("[1.0, 2.0]", "builtin_interfaces/Duration[]", 0),
        ("soon", "builtin_interfaces/Duration", 1),
        ("12.5", "builtin_interfaces/Other", 1),
    ],
)
def test_a_number_of_seconds_in_a_slot(value: str, type: str, number: int) -> None:
    files = {"cell_msgs/srv/Wait.srv": f"{type} limit\n---\n"}
    slots = "request_slots: [limit]\n      input_keys: [limit]"
    script = service(slots, data=f"limit: {value}", type="cell_msgs/Wait")
    assert len(faults(script, files)) == number


def other_type(request: str, type: str, files: dict[str, str]) -> list[str | None]:
    return [help for _, _, help in faults(service(f"request: {request}", type=type), files)]


def test_another_type_of_the_package_with_the_fields() -> None:
    assert other_type("{data: false}", "std_srvs/srv/Trigger", {}) == [
        "remove it: it has no fields, or correct the type: `std_srvs/srv/SetBool` has `data`"
    ]
    files = {
        "cell_msgs/srv/Grasp.srv": "float64 width\n---\n",
        "cell_msgs/srv/Place.srv": "float64 height\nfloat64 force\n---\n",
        "cell_msgs/srv/Lift.srv": "float64 force\n---\n",
    }
    both = "or correct the type: `cell_msgs/Place` has `force` and `height`"
    field = "use one of its fields: `width`, "
    given = "{force: 1.0, height: 2.0}"
    assert other_type(given, "cell_msgs/Grasp", files) == [f"{field}{both}"] * 2
    helps = other_type("{force: 1.0}", "cell_msgs/Grasp", files)
    assert helps == ["write `width`, its only field, in place of `force`"]


@pytest.mark.parametrize(("word", "meant"), [("off", "false"), ("yes", "true")])
def test_a_word_of_yaml_1_1_for_a_bool(word: str, meant: str) -> None:
    script = service(f"request: {{data: {word}}}", type="std_srvs/SetBool")
    ((text, _, help),) = faults(script, {})
    assert (text, help) == (word, f"write `{meant}`: in YAML 1.2, `{word}` is a text")


@pytest.mark.parametrize(
    ("pose", "expected"),
    [
        ("{position: {x: 1.0}, orientation: {w: 1.0}}", []),
        ("{position: {x: 1.0}, turn: {w: 1.0}}", [("turn", "write `orientation`")]),
        ("{position: {x: 1.0}, oreintation: {w: 1.0}}",
         [("oreintation", "did you mean `orientation`?")]),
        ("{position: {x: left}}", [("left", "write a value of the type `float64`, such as `1.5`")]),
        ("[[0.5, 0.0, 0.1], [0.0, 0.0, 0.0, 1.0]]", []),
    ],
)  # fmt: skip
def test_a_mapping_in_a_slot(pose: str, expected: list[tuple[str, str]]) -> None:
    script = SERVICE.format(
        type="cell_msgs/Grasp",
        data=f"grip: {pose}",
        fields="request_slots: [pose]\n      input_keys: [pose]\n      remapping: {pose: grip}",
    )
    assert [fault[0::2] for fault in faults(script)] == expected


BOUNDED = {
    "cell_msgs/action/Pick.action": "string<=4 label\nstring<=2[] tags\nwstring<=3 note\n"
    "int32[<=2] few\nfloat32 speed\nfloat64 force\n---\n---\n",
}


@pytest.mark.parametrize(
    ("goal", "marked", "help"),
    [
        ("{note: abcd}", "abcd", "shorten the text: it has 4 characters, the limit is 3"),
        ("{label: '12345'}", "'12345'", "shorten the text: it has 5 characters, the limit is 4"),
        ("{tags: [ab, abc]}", "[ab, abc]", "write a value of the type `string<=2[]`"),
        ("{few: [1, 2, 3]}", "[1, 2, 3]", "shorten the list: it has 3 values, the limit is 2"),
        ("{speed: 1.0e+39}", "1.0e+39", "write a value of the type `float32`, such as `1.5`"),
        (
            f"{{force: 1{'0' * 400}}}",
            f"1{'0' * 400}",
            "write a value of the type `float64`, such as `1.5`",
        ),
        ("Pick.Goal(note='abcd')", "note", "shorten the text: it has 4 characters, the limit is 3"),
        ("Pick.Goal(few=[1, 2.5])", "few", "write a value of the type `int32[<=2]`"),
        ("PickGoal(speed=-1e39)", "speed", "write a value of the type `float32`, such as `1.5`"),
    ],
)
def test_limits_of_texts_lists_and_numbers_hold(goal: str, marked: str, help: str) -> None:
    found = faults(ACTION.format(type="cell_msgs/Pick", goal=goal), BOUNDED)
    assert [(text, cure) for text, _, cure in found] == [(marked, help)]


@pytest.mark.parametrize(
    "goal",
    [
        "{label: abcd, tags: [ab, ''], note: äöü, few: [], speed: .inf, force: 1.0e+39}",
        "Pick.Goal(label='abcd', tags=['ab'], few=(1, 2), speed=float('nan'), check_fields=True)",
        "Pick.Goal(force=1, speed=-3, note=name)",
        "Pick.Goal(*values, note='abcd')",
    ],
)
def test_values_up_to_the_limits_fit(goal: str) -> None:
    assert faults(ACTION.format(type="cell_msgs/Pick", goal=goal), BOUNDED) == []


PUBLISHED = """
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {{msg: "`{code}`"}}
states:
  - SAY:
      template: PublishMsgState
      action: start
      input_keys: [msg]
      transitions: {{succeeded: done, aborted: failed}}
"""


@pytest.mark.parametrize(
    ("code", "marked"),
    [
        ("String(date='x')", ["date"]),
        ("std_msgs.msg.String(date='x')", ["date"]),
        ("std_msgs.msg.String(data=5)", ["data"]),
        ("Bool(data='yes')", ["data"]),
        ("Bool(data=2)", ["data"]),
        ("Float64(data='1')", ["data"]),
        ("Int8(data=200)", ["data"]),
        ("PoseStamped(pose=Pose(position=Point(x='far', z=1)))", ["x"]),
        ("PoseArray(poses=[Pose(), Pose(postion=Point())])", ["postion"]),
        ("(lambda: Bool(date=True))()", ["date"]),
        ("Float64(data=1)", []),
        ("Bool(data=1)", []),
        ("Bool(data=True, check_fields=True)", []),
        ("Point(1, 2, 3)", []),
        ("Bool(**fields)", []),
        ("Float64(data=compute())", []),
        ("PoseStamped(pose=pose)", []),
        ("Unknown(date='x')", []),
        ("own.String(date='x')", []),
        ("Bool(", []),
    ],
)
def test_the_arguments_of_classes_of_messages_are_checked(code: str, marked: list[str]) -> None:
    assert [text for text, _, _ in faults(PUBLISHED.format(code=code))] == marked


def test_a_class_of_the_script_or_of_its_base_is_no_common_message() -> None:
    script = PUBLISHED.format(code="Path(length=1)")
    assert [text for text, _, _ in faults(script)] == ["length"]
    own = script.replace("input_keys: [msg]", "input_keys: [msg, msg_type]").replace(
        "userdata: {", "userdata: {msg_type: cell_msgs/Path, "
    )
    assert faults(own, {"cell_msgs/msg/Path.msg": "float64 length\n"}) == []
    assert faults(script, {"templates/ROSBase.tpl.py": "from cell_msgs.msg import Path\n"}) == []


LOOP = """
name: sm
template: ROSBase
outcomes: [done, failed]
userdata: {{places: {places}}}
states:
  - GRASP:
      template: ServiceState
      service_namespace: gripper
      service: cell_msgs/Reach
      request_slots: [place]
      input_keys: [place]
      for_each: {{item: place, in: places}}
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""
REACH = {
    "cell_msgs/srv/Reach.srv": "Place place\n---\n",
    "cell_msgs/msg/Place.msg": "float64 x\nfloat64 angle\n",
}


@pytest.mark.parametrize(
    ("places", "found"),
    [
        ("[{x: 1.0, angle: 0.0}, {x: 2.0, angle: 1.0}]", []),
        ("[{x: 1.0, angle: 0.0}, {x: 2.0, angel: 1.0}]", [("angel", "did you mean `angle`?")]),
        ("[{x: 1.0, angel: 0.0}, {x: 2.0}, {y: 1.0, angle: 1.0}]",
         [("angel", "did you mean `angle`?"), ("y", "write `x`")]),
        ("[{x: 1.0, angle: far}]", [("far", "write a value of the type `float64`, such as `1.5`")]),
    ],
)  # fmt: skip
def test_the_items_of_a_loop_are_messages(places: str, found: list[tuple[str, str]]) -> None:
    marked = faults(LOOP.format(places=places), REACH)
    assert [(text, help) for text, _, help in marked] == found


SCAN = """
name: sm
template: ROSBase
outcomes: [done, failed]
states:
  - SCAN:
      template: WaitForMsgState
      topic: scan
      msg_type: cell_msgs/Scan
      msg_cb: 'lambda message, userdata: {code}'
      transitions: {{succeeded: done, aborted: failed, preempted: failed}}
"""


@pytest.mark.parametrize(
    ("code", "help"),
    [
        ("message.ranges > 100",
         "write `len(message.ranges) > 100` for the number of its items, or compare one item"),
        ("100 <= message.ranges and message.ok",
         "write `100 <= len(message.ranges)` for the number of its items, or compare one item"),
        ("message.names < 1",
         "write `len(message.names) < 1` for the number of its items, or compare one item"),
        ("len(message.ranges) > 100", None),
        ("message.ranges[0] > 100", None),
        ("message.ok == 1 and message.ranges is not None", None),
    ],
)  # fmt: skip
def test_the_order_of_a_list_and_a_number(code: str, help: str | None) -> None:
    files = {"cell_msgs/msg/Scan.msg": "float32[] ranges\nstring[3] names\nbool ok\n"}
    found = faults(SCAN.format(code=code), files)
    assert [item[2] for item in found] == ([help] if help else [])
