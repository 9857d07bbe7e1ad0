"""Slips in what a class passes to calls and gets from them (SM609)."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [ok, failed]
userdata: {n: 1}
states:
  - MARK:
      template: Mark
      transitions: {done: SHOW, bad: failed}
  - SHOW:
      template: PrintUserdataState
      input_keys: [labels]
      transitions: {succeeded: ok}
"""
TYPE = """\
name: Mark
input_keys: {n: int}
output_keys: {labels: "list[str]"}
outcomes: {done: {}, bad: {failure: true}}
code: {python: "cell.mark:Mark"}
"""
CLASS = """\
import enum
import signal
import threading
import time
import smach


class Result(enum.Enum):
    GOOD = 1
    BAD = 2


class Arm:
    def halt(self):
        print("halt")


class Base(smach.State):
    def __init__(self, speed, outcomes, inputs, outputs):
        smach.State.__init__(self, outcomes=outcomes, input_keys=inputs, output_keys=outputs)
        self.speed = speed


class Mark(Base):
    def __init__(self):
        super().__init__(1.0, ["done", "bad"], ["n"], ["labels"])
        self.stopped = False
        self.arm = Arm()

    def stop(self):
        self.stopped = True

    def handler(self):
        return self.stop

    def look(self):
        if self.speed > 3:
            return Result.BAD, [1, 2]
        return Result.GOOD, [1, 2]

    def execute(self, userdata):
        labels = []
        for number in range(userdata.n):
            labels.append("x %d" % number)
        BODY
        userdata.labels = labels
        return "done" if labels else "bad"
"""
OK = "pass"


def reported(body: str, *changes: tuple[str, str]) -> list[tuple[str, str, str]]:
    text = CLASS.replace("BODY", body.replace("\n", "\n        "))
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    files = {"main.yml": MAIN, "templates/Mark.yml": TYPE, "cell/__init__.py": "",
             "cell/mark.py": text}  # fmt: skip
    return [(each.code, each.span.text, each.help or "") for each in analysed(files).report]


@pytest.mark.parametrize(
    ("body", "place", "help"),
    [
        ("threading.Timer(2.0, self.stop()).start()", "self.stop()", "write `self.stop`"),
        ("threading.Thread(target=self.arm.halt()).start()", "self.arm.halt()",
         "write `self.arm.halt`"),
        ("signal.signal(signal.SIGINT, self.stop())", "self.stop()", "write `self.stop`"),
        ("userdata.n.add_done_callback(self.stop())", "self.stop()", "write `self.stop`"),
    ],
)  # fmt: skip
def test_a_call_in_place_of_a_function(body: str, place: str, help: str) -> None:
    assert reported(body) == [("SM609", place, help)]


@pytest.mark.parametrize(
    "body",
    ["threading.Timer(2.0, self.stop).start()", "threading.Timer(2.0, self.handler()).start()",
     "threading.Thread(target=lambda: self.stop()).start()"],
)  # fmt: skip
def test_a_function_that_is_passed(body: str) -> None:
    assert reported(body) == []


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ('print("%s %s" % (userdata.n,))', ['"%s %s" % (userdata.n,)']),
        ('print("%s of %d" % (userdata.n, 3, 4))', ['"%s of %d" % (userdata.n, 3, 4)']),
        ('print("{} {}".format(userdata.n))', ['"{} {}".format(userdata.n)']),
        ('print("%d%% of %*d" % (1, 2, 3))', []),
        ('print("%s %s" % (*labels,))', []),
        ('print("{0} {0}".format(userdata.n))', []),
        ('print("{} {{}}".format(userdata.n))', []),
        ('print("{}".format(userdata.n, 2))', []),
        ('try:\n    print("%s" % (1, 2))\nexcept TypeError:\n    print(1)', []),
    ],
)
def test_the_number_of_values_of_a_text(body: str, found: list[str]) -> None:
    help = "write one value for each place"
    assert reported(body) == [("SM609", each, help) for each in found]


def test_a_function_in_place_of_its_module() -> None:
    change = ("import time\n", "from time import time\n")
    (one,) = reported("time.sleep(0.1)", change)
    assert one == ("SM609", "time", "write `import time` in place of `from time import time`")
    (one,) = reported("print(time())\ntime.sleep(0.1)", change)
    assert one[2] == "write `from time import sleep, time`, and here `sleep`"
    assert reported("time.sleep(0.1)") == []
    change = ("import time\n", "from datetime import datetime\n")
    (one,) = reported("print(datetime.datetime.now())", change)
    assert one[2] == "write `datetime` in place of `datetime.datetime`"
    assert reported("print(datetime.now())", change) == []


def test_a_result_that_is_none() -> None:
    change = ("userdata.labels = labels", 'userdata.labels = labels.append("z")')
    help = 'write `labels.append("z")`, and then `userdata.labels = labels`'
    assert reported(OK, change) == [("SM609", change[1], help)]
    assert [each[0] for each in reported("self.kept = labels.sort()")] == ["SM609"]


def test_outcomes_that_are_passed_as_keys() -> None:
    lists = '1.0, ["done", "bad"], ["n"], ["labels"]'
    call = '1.0, ["n"], ["done", "bad"], ["labels"]'
    found = reported(OK, (f"super().__init__({lists})", f"super().__init__({call})"))
    help = "pass them in the order of its parameters: `speed`, `outcomes`, `inputs`, `outputs`"
    assert found[0] == ("SM609", '["done", "bad"]', help)


def test_the_collected_items_of_an_output_key() -> None:
    change = ("userdata.labels = labels", "userdata.labels.extend(labels)")
    assert reported(OK, change) == [("SM310", "labels", "write `userdata.labels = labels`")]
