"""Classes of state types in modules: faults at the right place, and no finding without one."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import Source
from smachac.driver import analyse
from smachac.frontend.files import disk_library
from smachac.frontend.loader import memory_library
from tests.trust.project_text import analysed

SCRIPT = """
name: sm
template: Base
outcomes: [seen, lost, stopped]
output_keys: [pose]
userdata: {tries: 0}
states:
  - FIND:
      template: FindPart
      speed: 0.5
      transitions: {found: seen, lost: lost, preempted: stopped}
"""
INTERFACE = """
name: FindPart
variables: {speed: {type: float}}
input_keys: {tries: int}
output_keys: {pose: Pose}
outcomes: {found: {}, lost: {}, preempted: {}}
writes: {found: [pose]}
blocking: true
code: {python: "cell.find:FindPart"}
"""
CLASS = """\
import smach

import camera
class FindPart(smach.State):
    def __init__(self, speed):
        super().__init__(
            outcomes=["found", "lost", "preempted"], input_keys=["tries"], output_keys=["pose"]
        )
        self.speed = speed

    def execute(self, userdata):
        for _ in range(userdata.tries):
            if self.preempt_requested():
                return "preempted"
            pose = camera.look(self.speed)
            if pose is not None:
                userdata.pose = pose
                return "found"
        return "lost"
"""
BUILT_IN = disk_library(Path("main.yml"), [])
FIRST = "        for _ in range(userdata.tries):\n"
SET = "                userdata.pose = pose\n"
HEAD = "class FindPart(smach.State):\n"
LISTS = CLASS[CLASS.index("        super()") : CLASS.index("        self.speed")]
BODY = CLASS[CLASS.index("    def execute") :]


def findings(
    text: str | None = CLASS, interface: str = INTERFACE, script: str = SCRIPT, **more: str
) -> Report:
    files = {
        "main.yml": script,
        "templates/FindPart.yml": interface,
        "cell/__init__.py": "",
        **more,
    }
    if text is not None:
        files["cell/find.py"] = text
    library = memory_library(files, BUILT_IN)
    report = analyse(Source("main.yml", script), library, []).report
    return [item for item in report if item.severity is not Severity.INFO]


def lines(report: Report) -> list[str]:
    """Code, file, line and marked text of each finding."""
    return [
        f"{item.code} {item.span.source.name}:{item.span.line} {item.span.text}" for item in report
    ]


def changed(*pairs: tuple[str, str]) -> str:
    text = CLASS
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new, 1)
    return text


def test_a_correct_class() -> None:
    assert findings() == []


@pytest.mark.parametrize(
    ("text", "found", "help"),
    [
        (changed(('return "lost"', 'return "lots"')), ['SM309 cell/find.py:19 "lots"'],
         "did you mean `lost`?"),
        (changed(('return "lost"', '"lost"')), ['SM309 cell/find.py:19 "lost"'],
         'write `return "lost"`'),
        (changed(('return "lost"', '"lost" if pose else "preempted"')),
         ['SM309 cell/find.py:19 "lost" if pose else "preempted"'],
         'write `return "lost" if pose else "preempted"`'),
        (changed(('return "lost"', '"lost" if _ else "found"\n        return "lost"')),
         ['SM609 cell/find.py:19 "lost" if _ else "found"'],
         'write `return "lost" if _ else "found"`'),
        (changed(('return "preempted"', 'return "preempt"')),
         ['SM309 cell/find.py:14 "preempt"'], "did you mean `preempted`?"),
        (changed(('        return "lost"\n', "")), ["SM309 cell/find.py:11 execute"],
         'end this path with `return "lost"`, which no other path returns'),
        (changed(('return "lost"', 'end = "lost"\n        end')), ["SM309 cell/find.py:20 end"],
         "write `return end`"),
        (changed(('return "lost"', 'self.end()')) + '\n    def end(self):\n        return "lost"\n',
         ["SM309 cell/find.py:19 self.end()"], "write `return self.end()`"),
        (changed(('return "found"', 'end = "found"\n                end')),
         ["SM609 cell/find.py:19 end"], "write `return end`"),
        (changed((SET, "")), ['SM314 cell/find.py:17 "found"'], None),
        (changed((SET, "                pose = userdata.tries\n")),
         ['SM314 cell/find.py:18 "found"'], None),
        (changed(("userdata.pose =", "userdata.psoe =")), ["SM308 cell/find.py:17 psoe"],
         "did you mean `pose`?"),
        (changed(("range(userdata.tries)", "range(userdata.trys)")),
         ["SM310 cell/find.py:12 trys"], "did you mean `tries`?"),
        (changed((FIRST, "        userdata.tries = 3\n" + FIRST)),
         ["SM308 cell/find.py:12 tries"], None),
        (changed(('                return "preempted"\n', "                pass\n")),
         ["SM315 cell/find.py:11 execute"], None),
        (changed(('return "lost"', 'return "found"')),
         ["SM315 cell/find.py:11 execute", 'SM314 cell/find.py:19 "found"'], None),
        (changed(("class FindPart", "class FindParts")),
         ["SM608 templates/FindPart.yml:9 FindPart"], "did you mean `FindParts`?"),
        (changed(("range(userdata.tries):", "range(userdata.tries)")),
         ["SM608 cell/find.py:12 "], None),
        (changed(("def execute", "def excute")), ["SM609 cell/find.py:11 excute"],
         "rename `excute` to `execute`"),
        (changed((LISTS, "")), ["SM609 cell/find.py:5 __init__"], None),
        (changed((HEAD, "class FindPart:\n")), ["SM609 cell/find.py:4 FindPart"], None),
        (changed(("(self, speed)", "(self)"), ("= speed", "= 1")),
         ["SM609 cell/find.py:4 FindPart"], "add the parameter `speed` to `__init__`"),
        (changed(("(self, speed)", "(self, sped)"), ("= speed", "= sped")),
         ["SM609 cell/find.py:5 sped"],
         "rename the parameter `sped` to `speed`, which the script sets"),
        (changed(("(self, speed)", "(self, speed, robot)")),
         ["SM609 cell/find.py:5 robot"], None),
        (changed(("(self, userdata)", "(self)")), ["SM609 cell/find.py:11 execute"], None),
        (changed(("(self, userdata)", "(self, userdata, robot)")),
         ["SM609 cell/find.py:11 execute"], None),
        (changed(("    def execute", "    async def execute")), ["SM609 cell/find.py:4 FindPart"],
         None),
        (changed((SET, SET + "                yield pose\n")), ["SM609 cell/find.py:11 execute"],
         None),
        (changed(("self.speed = speed", "self.execute = None; self.speed = 1")),
         ["SM609 cell/find.py:9 self.execute"], None),
        (CLASS + "\n" + BODY, ["SM609 cell/find.py:21 execute"], None),
        (CLASS[: CLASS.index("    def __init__")] + BODY, ["SM609 cell/find.py:4 FindPart"] * 2,
         None),
        # through methods, functions, variables and base classes
        (changed(('return "lost"', "return self.end(userdata)")) + "\n    def end(self, data):\n"
         '        data.seen = 1\n        return "lots"\n',
         ["SM308 cell/find.py:22 seen", 'SM309 cell/find.py:23 "lots"'], None),
        (changed((SET, "                self.keep(userdata)\n")) + "\n    def keep(self, data):\n"
         "        self.pose = data.tries\n", ['SM314 cell/find.py:18 "found"'], None),
        (changed(('        return "lost"', '        end = "lots"\n        return end')),
         ['SM309 cell/find.py:19 "lots"'], None),
        (changed(('return "lost"', "return LOST"),
                 ("import smach\n", 'import smach\n\nLOST = "lots"\n')),
         ['SM309 cell/find.py:3 "lots"'], None),
        (changed(("(smach.State)", "(Skill)"), ("import smach\n", "from smach import State\n\n\n"
         "class Skill(State):\n    def stop(self):\n        return 1\n"),
                 ("def execute", "def exec")), ["SM609 cell/find.py:16 exec"], None),
    ],
)  # fmt: skip
def test_a_fault(text: str, found: list[str], help: str | None) -> None:
    report = findings(text)
    assert lines(report) == found
    if help is not None:
        assert report[0].help == help
    for item in report:
        assert any(place.span.source.name == "main.yml" for place in item.related)


@pytest.mark.parametrize(
    "pair",
    [
        # the value of the return is not known
        ('return "lost"', "return OUTCOMES[self.speed]"),
        ('return "lost"', "return self.result"),
        ('return "lost"', 'return "lost" if camera.on else camera.state'),
        ('                return "preempted"\n', "                return self.robot.stop()\n"),
        # the userdata goes elsewhere
        (SET, "                camera.store(userdata)\n"),
        (SET, "                userdata.update(pose=pose)\n"),
        (SET, "                setattr(userdata, 'pose', pose)\n"),
        (SET, "                userdata[KEY] = pose\n"),
        (SET, "                data = userdata\n                data.pose = pose\n"),
        # set in another way
        (SET, "                userdata['pose'] = pose\n"),
        (SET, "                pose, userdata.pose = 1, pose\n"),
        (SET, "                with lock:\n                    userdata.pose = pose\n"),
        (FIRST, "        userdata.pose = None\n" + FIRST),
        # the class is made in another way
        (HEAD, "class FindPart(Skill):\n"),
        (HEAD, "class FindPart(smach.State, Logged):\n"),
        (HEAD, "@registered\n" + HEAD),
        ("    def execute", "    @timed\n    def execute"),
        ("def execute", "def run"),
        (FIRST, "        def each():\n            yield 1\n\n" + FIRST),
        (FIRST, "        def found(ud):\n            return 'nothing'\n\n" + FIRST),
        (FIRST, "        run(lambda: userdata.tries)\n" + FIRST),
        (FIRST, "        Thread(target=camera.look, args=(userdata,)).start()\n" + FIRST),
        (
            "        self.speed = speed\n",
            "        self.speed = speed\n        self.ended = False\n",
        ),
        ("(self, speed)", "(self, *, speed)"),
        ("(self, speed)", "(self, **values)"),
        ("(self, speed)", "(self, speed=1.0, robot=None)"),
        (", userdata)", ", userdata, robot=None)"),
        (", userdata)", ", *data)"),
        ("self.speed = speed", "self.speed = speed; self.execute = make(speed)"),
        ("import smach\n", "from smachac.runtime import smach\n"),
        ("(smach.State)", "(sm.State)"),
    ],
)
def test_what_cannot_be_judged_and_what_is_correct(pair: tuple[str, str]) -> None:
    names = "KEY, OUTCOMES, Logged, Skill, Thread, camera, lock, make, registered, run, timed"
    text = changed(pair).replace("import camera\n", f"from robot import {names}\n")
    if "**values" in text:
        text = text.replace("self.speed = speed", "self.speed = values")
    if pair == ("def execute", "def run"):
        text = text.replace("import smach", "from cell.base import *").replace(
            "smach.State", "Base"
        )
    if "OUTCOMES" in pair[1] or "state" in pair[1] or "self.re" in pair[1]:
        text = text.replace('return "preempted"', "pass")
    if "sm.State" in text:
        text = text.replace("import smach", "import smach as sm")
    if "self.r" in pair[1]:
        text = text.replace(
            "self.speed = speed", "self.speed = speed; self.result = self.robot = 1"
        )
    assert lines(findings(text)) == []


@pytest.mark.parametrize(
    ("pairs", "found", "help"),
    [
        # an outcome that passes through a parameter
        ([('return "lost"', 'return self.end("lots")\n\n    def end(self, outcome):\n'
           "        print(outcome)\n        return outcome")],
         ['SM309 cell/find.py:19 "lots"'], "did you mean `lost`?"),
        ([('return "lost"', 'return end(3, result="lots")'),
          ("import smach\n", "import smach\n\n\ndef end(n, result):\n    return result\n")],
         ['SM309 cell/find.py:23 "lots"'], "did you mean `lost`?"),
        # members of classes and enumerations, entries of tables
        ([('return "lost"', "return Result.LOST"), ("import smach\n", "import enum\nimport smach\n"
           '\n\nclass Result(enum.Enum):\n    LOST = "lost"\n')],
         ["SM309 cell/find.py:24 Result.LOST"], "write `Result.LOST.value`"),
        ([('return "lost"', "return Result.LOST.value"),
          ("import smach\n", "import enum\nimport smach\n"
           '\n\nclass Result(enum.Enum):\n    LOST = "lots"\n')],
         ["SM309 cell/find.py:24 Result.LOST.value"], "did you mean `lost`?"),
        ([('return "lost"', "return Result.LOST"),
          ("import smach\n", 'import smach\n\n\nclass Result:\n    LOST = "lots"\n')],
         ["SM309 cell/find.py:23 Result.LOST"], "did you mean `lost`?"),
        ([('return "lost"', "return ENDS[userdata.tries]"),
          ("import smach\n", 'import smach\n\nENDS = {1: "lost", 2: "lots"}\n')],
         ['SM309 cell/find.py:3 "lots"'], "did you mean `lost`?"),
        ([('return "lost"', 'return {1: "lost"}.get(userdata.tries, "lots")')],
         ['SM309 cell/find.py:19 "lots"'], "did you mean `lost`?"),
        # userdata by name
        ([("userdata.tries", 'getattr(userdata, "trys")')],
         ['SM310 cell/find.py:12 "trys"'], "did you mean `tries`?"),
        ([("userdata.pose = pose", 'setattr(userdata, "psoe", pose)')],
         ['SM308 cell/find.py:17 "psoe"'], "did you mean `pose`?"),
        # constructors
        ([("super().__init__(\n", "super().__init__(self, \n")],
         ["SM609 cell/find.py:6 self"], None),
        ([("super().__init__(\n", "smach.State.__init__(\n")],
         ["SM609 cell/find.py:6 smach.State"], None),
        ([("super()", "super(Other, self)"), ("import smach\n", "import smach\n\n\n"
           "class Other(smach.State):\n    pass\n")], ["SM609 cell/find.py:10 Other"], None),
        ([("import smach\n", "from dataclasses import dataclass\nimport smach\n"),
          (HEAD, "@dataclass\n" + HEAD), ("    def __init__(self, speed):\n" + LISTS
           + "        self.speed = speed\n", "    speed: float\n")],
         ["SM609 cell/find.py:6 FindPart"], None),
        # Python
        ([("            if self.pre", "            time.sleep(1.0)\n            if self.pre")],
         ["SM609 cell/find.py:13 time"], "write `import time` at the top of the file"),
        ([("def execute", "async def execute")], ["SM609 cell/find.py:4 FindPart"], None),
        ([("pose = camera", "pose = await camera")],
         ["SM608 cell/find.py:15 await camera.look(self.speed)"],
         "remove `await`, or write `asyncio.run(...)` in its place"),
    ],
)  # fmt: skip
def test_values_and_calls_of_other_kinds(
    pairs: list[tuple[str, str]], found: list[str], help: str | None
) -> None:
    report = findings(changed(*pairs))
    assert lines(report) == found
    if help is not None:
        assert report[0].help == help


SILENT_PAIRS: list[list[tuple[str, str]]] = [
    # a parameter that the function examines or changes
    [('return "lost"', 'return self.end("again")\n\n    def end(self, outcome):\n'
      '        if outcome == "again":\n            return "lost"\n        return outcome')],
    [('return "lost"', 'return self.end("again")\n\n    def end(self, outcome):\n'
      '        return {"again": "lost"}.get(outcome, outcome)')],
    [('return "lost"', 'return self.end("x")\n\n    def end(self, outcome):\n'
      '        outcome = "lost"\n        return outcome')],
    # a table or a constant that the module changes
    [('return "lost"', "return ENDS[userdata.tries]"),
     ("import smach\n", 'import smach\n\nENDS = {1: "lots"}\nENDS[1] = "lost"\n')],
    [('return "lost"', "return Result.LOST"), ("import smach\n", "import smach\n\n\n"
      'class Result:\n    LOST = "lots"\n\n\nResult.LOST = "lost"\n')],
    # enumerations whose members are texts
    [('return "lost"', "return Result.LOST"), ("import smach\n", "import enum\nimport smach\n\n\n"
      'class Result(str, enum.Enum):\n    LOST = "lost"\n')],
    [('return "lost"', "return Result.LOST"), ("import smach\n", "import enum\nimport smach\n\n\n"
      'class Result(enum.Enum):\n    LOST = "lost"\n    def __eq__(self, other):\n'
      "        return self.value == other\n")],
    [("userdata.tries", "getattr(userdata, NAME)"),
     ("import smach\n", 'import smach\nNAME = "x"\n')],
    [("super()", "super(FindPart, self)")],
    [("super()", "super(Skill, self)"), ("(smach.State)", "(Skill)"),
     ("import smach\n", "import smach\n\n\nclass Skill(smach.State):\n    pass\n")],
    # a constructor of the base class with a parameter for the object
    [("super().__init__(\n", "super().__init__(self,\n"), ("(smach.State)", "(Skill)"),
     ("import smach\n", "import smach\n\n\nclass Skill(smach.State):\n"
      "    def __init__(self, owner, **lists):\n        super().__init__(**lists)\n")],
    [("import smach\n", "from dataclasses import dataclass\nimport smach\n"),
     (HEAD, "@dataclass(eq=False)\n" + HEAD), ("    def __init__(self, speed):\n"
      + LISTS + "        self.speed = speed\n",
      "    speed: float\n\n    def __post_init__(self):\n" + LISTS)],
]  # fmt: skip


@pytest.mark.parametrize("pairs", SILENT_PAIRS)
def test_values_and_calls_that_are_correct(pairs: list[tuple[str, str]]) -> None:
    assert lines(findings(changed(*pairs))) == []


def test_a_function_of_another_module_is_followed() -> None:
    text = changed((SET, "                tools.keep(userdata, pose)\n"),
                   ("import smach\n", "import smach\nfrom cell import tools\n"))  # fmt: skip
    tools = "def keep(data, value):\n    data.{} = value\n"
    files = {"cell/tools.py": tools.format("psoe")}
    assert lines(findings(text, **files)) == ["SM308 cell/tools.py:2 psoe"]
    assert lines(findings(text, **{"cell/tools.py": tools.format("pose")})) == []
    text = changed((SET, "                keep(userdata, pose)\n"),
                   ("import smach\n", "import smach\nfrom .tools import keep\n"))  # fmt: skip
    assert lines(findings(text, **files)) == ["SM308 cell/tools.py:2 psoe"]


def test_the_failure_that_is_meant() -> None:
    text = changed(('"lost"', '"find_failed"'), ('return "lost"', 'return "find_error"'))
    script = SCRIPT.replace("lost: lost", "find_failed: lost")
    report = findings(text, INTERFACE.replace("lost", "find_failed"), script)
    assert [item.help for item in report] == ["did you mean `find_failed`?"]


@pytest.mark.parametrize(
    ("end", "line", "words"),
    [
        ("match self.speed:\n            case 1.0:\n                return 'lost'",
         "match self.speed:", "if no `case` matches, nothing is returned"),
        ("try:\n            return look()\n        except OSError:\n            print(1)",
         "except OSError:", "after this exception, nothing is returned"),
        ("if self.speed:\n            return 'lost'", "if self.speed:",
         "if this is false, nothing is returned"),
        ("print(1)", "", ""),
    ],
)  # fmt: skip
def test_where_no_outcome_is_returned(end: str, line: str, words: str) -> None:
    report = findings(changed(('return "lost"', end)))
    (item,) = [one for one in report if one.code == "SM309"]
    first = item.related[0]
    found = (first.span.text, first.message) if words else ("", "")
    assert found == (line, words)


def test_userdata_is_no_dictionary() -> None:
    report = findings(changed(("userdata.tries", 'userdata.get("tries", 3)')))
    (item,) = report
    assert (item.code, item.span.text) == ("SM310", "get")
    assert item.help == "read a key as `userdata.KEY`; test it with `'KEY' in userdata`"


def test_a_stub_is_not_written_yet() -> None:
    body = (
        '    def execute(self, userdata):\n        userdata.pose = None\n        return "found"\n'
    )
    assert findings(CLASS.replace(BODY, body)) == []


@pytest.mark.parametrize("number", [1, 2])
def test_an_unset_key_counts_where_it_is_read(number: int) -> None:
    """Without `writes:` the class shows which outcomes set a key."""
    target = ["lost", "SHOW"][number - 1]
    script = SCRIPT.replace("lost: lost", f"lost: {target}")
    script += (
        """  - SHOW:
      template: PrintUserdataState
      input_keys: [pose]
      transitions: {succeeded: lost}
"""
        if number == 2
        else ""
    )
    interface = INTERFACE.replace("writes: {found: [pose]}\n", "")
    report = findings(interface=interface, script=script)
    assert [item.code for item in report] == ["SM301"] * (number - 1)


def test_a_key_that_no_outcome_sets() -> None:
    interface = INTERFACE.replace("writes: {found: [pose]}\n", "")
    report = findings(changed((SET, "")), interface)
    assert lines(report) == ["SM314 cell/find.py:11 execute"]
    kept = interface.replace("{tries: int}", "{tries: int, pose: any}")
    report = findings(changed((SET, "")), kept, SCRIPT.replace("{tries: 0}", "{tries: 0, pose: 1}"))
    assert all(item.code != "SM314" for item in report)


@pytest.mark.parametrize(
    ("files", "place", "help"),
    [
        ({"cell/look.py": "class Find: pass\n"}, "cell.find", "write `cell.look:Find`"),
        (
            {"tools/look.py": "\nclass Find(Base):\n    pass\n"},
            "cell.find",
            "write `tools.look:Find`",
        ),
        ({"cell/look.py": "class Find: pass\n", "cell/see.py": "class Find: pass\n"}, "Find", None),
        ({"cell/look.py": "from cell.see import Find\n"}, "Find", None),
        ({"cell/look.py": "    class Find: pass\n"}, "Find", None),
    ],
)
def test_a_class_that_is_in_another_module(
    files: dict[str, str], place: str, help: str | None
) -> None:
    interface = INTERFACE.replace("cell.find:FindPart", "cell.find:Find")
    (item,) = findings("LIMIT = 3\n", interface, **files)
    assert (item.code, item.span.text) == ("SM608", place)
    assert ("but in `" in item.message) == (help is not None)
    assert help is None or item.help == help


def test_a_module_that_does_not_exist() -> None:
    (item,) = findings(None, **{"cell/fund.py": "", "cell/look.py": ""})
    assert lines([item]) == ["SM608 templates/FindPart.yml:9 cell.find"]
    assert item.help == "did you mean `cell.fund`?"
    assert item.severity is Severity.ERROR
    near = INTERFACE.replace("cell.find", "celll.find")
    assert lines(findings(CLASS, near)) == ["SM608 templates/FindPart.yml:9 celll.find"]


def test_an_installed_module_is_not_searched() -> None:
    assert findings(CLASS, INTERFACE.replace("cell.find", "robot_skills.find")) == []


def test_a_class_is_found_through_imports() -> None:
    interface = INTERFACE.replace("cell.find:", "cell:")
    texts = {"cell/__init__.py": "from .find import FindPart\n"}
    assert findings(CLASS, interface, **texts) == []
    wrong = changed(('return "lost"', 'return "lots"'))
    assert lines(findings(wrong, interface, **texts)) == ['SM309 cell/find.py:19 "lots"']
    assert findings(None, interface, **texts) == []


def test_the_state_of_another_module_is_the_base() -> None:
    base = CLASS.replace("FindPart", "Skill")
    derived = (
        "from cell.base import Skill\n\n\nclass FindPart(Skill):\n"
        "    def execute(self, userdata):\n        return super().execute(userdata)\n"
    )
    assert findings(derived, **{"cell/base.py": base}) == []
    assert findings(derived.replace("def execute", "def look"), **{"cell/base.py": base}) == []


def test_an_exception_is_no_outcome_to_return() -> None:
    script = SCRIPT.replace("lost: lost,", "lost: lost, error: lost,")
    (item,) = findings(changed(('        return "lost"\n', "")), script=script)[:1]
    assert item.code == "SM309"
    assert "`error`" not in (item.finding.help or "")


@pytest.mark.parametrize(
    "value", ['"found", 1', '("found",)', '["found"]', '{"found": 1}', "3", "-1", "[x for x in y]"]
)
def test_a_returned_value_that_is_no_text(value: str) -> None:
    report = findings(changed(('return "lost"', f"return {value}")))
    assert "SM309" in [item.code for item in report]


def test_the_opposite_of_an_outcome_is_no_suggestion() -> None:
    report = findings(changed(('return "lost"', 'return "not_found"')))
    (item,) = [item for item in report if item.code == "SM309"]
    assert item.finding.help == (
        'write `return "lost"`, as no path returns `lost`, or add `not_found` to the outcomes of'
        " `FindPart` in its interface and `__init__`"
    )


RETRIED = SCRIPT.replace(
    "      transitions: {found: seen, lost: lost, preempted: stopped}",
    "      retry: {on: [lost], max: 3}\n"
    "      transitions: {found: seen, exhausted: lost, preempted: stopped}",
)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        (CLASS, []),
        (changed((SET, "")), ['SM314 cell/find.py:17 "found"']),
        (
            changed(("userdata.pose =", "userdata.psoe =")),
            ["SM308 cell/find.py:17 psoe"],
        ),
        (
            changed(("range(userdata.tries)", "range(userdata.trys)")),
            ["SM310 cell/find.py:12 trys"],
        ),
        (changed(("userdata.pose = pose", "userdata.pose = 5")), ["SM304 cell/find.py:17 5"]),
    ],
)
def test_a_state_that_is_tried_again_is_checked_like_others(text: str, found: list[str]) -> None:
    assert lines(findings(text, script=RETRIED)) == found


def test_the_item_of_for_each_is_a_key_of_its_state() -> None:
    script = SCRIPT.replace("{tries: 0}", "{tries: 0, places: [1, 2]}").replace(
        "      speed: 0.5\n",
        "      speed: 0.5\n      for_each: {item: at, in: places, on: [found]}\n",
    )
    text = changed(("range(userdata.tries)", "range(userdata.at)"))
    assert "SM310" not in {item.code for item in findings(text, script=script)}
    text = changed(("range(userdata.tries)", "range(userdata.other)"))
    assert "SM310" in {item.code for item in findings(text, script=script)}


HELPER = (
    CLASS[: CLASS.index("    def execute")]
    + """\
    def execute(self, userdata):
        if self.preempt_requested():
            return "preempted"
        userdata.pose = camera.look(self.speed)
        return self.judge(userdata.tries)

    def judge(self, tries):
        if tries > 3:
            return "lost"
        TAIL
"""
)


@pytest.mark.parametrize(
    ("tail", "severity"),
    [
        ('return "found"', None),
        ("raise ValueError(tries)", None),
        ("self.last = tries", Severity.WARNING),
        ('if tries > 1:\n            return "found"', Severity.WARNING),
    ],
)
def test_a_helper_that_ends_without_return(tail: str, severity: Severity | None) -> None:
    files = {"templates/FindPart.yml": INTERFACE, "cell/find.py": HELPER.replace("TAIL", tail)}
    report = analyse(Source("main.yml", SCRIPT), memory_library(files, BUILT_IN), []).report
    found = [item for item in report if item.code == "SM309"]
    assert [item.severity for item in found] == ([severity] if severity is not None else [])
    for item in found:
        assert item.span.text == "judge"
        assert str(item.help).startswith("end each path of `judge` with a `return`")


FIELDS = """
import smach

class Reader(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"], input_keys=["pad", "pads"])

    def execute(self, userdata):
        BODY
        return "done"
"""
FIELD_FILES = {
    "main.yml": """
name: sm
outcomes: [done]
userdata: {pad: {name: a, at: [0, 0, 0]}, pads: [{name: a, at: [0, 0, 0]}]}
states:
  - READ: {template: Reader, transitions: {done: done}}
""",
    "templates/Reader.yml": "{input_keys: {pad: {type: {name: str, at: Point}}, pads: {type:"
    " 'list[{name: str, at: Point}]'}}, outcomes: {done: {}}, code: {python: 'own:Reader'}}",
}


def fields_missed(body: str) -> list[tuple[str, str | None]]:
    text = FIELDS.replace("BODY", body.replace("\n", "\n        "))
    report = analysed(FIELD_FILES | {"own.py": text}).report
    return [(item.span.text, item.help) for item in report if item.code == "SM311"]


@pytest.mark.parametrize(
    "body",
    [
        'print(userdata.pad["volume"])',
        'print(userdata["pad"]["volume"])',
        'print(userdata.pads[0]["volume"])',
        'pad = userdata.pad\nprint(pad["volume"])',
        'for pad in userdata.pads:\n    print(pad["volume"])',
        'for k, pad in enumerate(userdata.pads):\n    print(pad["volume"])',
        'print(sum(pad["volume"] for pad in userdata.pads))',
    ],
)
def test_a_class_reads_a_field_that_a_record_lacks(body: str) -> None:
    assert fields_missed(body) == [('"volume"', "use one of its fields: `at`, `name`")]


@pytest.mark.parametrize(
    "body",
    [
        'print(userdata.pad["name"], userdata.pads[0]["at"])',
        'if "volume" in userdata.pad:\n    print(userdata.pad["volume"])',
        'try:\n    print(userdata.pad["volume"])\nexcept KeyError:\n    pass',
        'userdata.pad["volume"] = 1\nprint(userdata.pad["volume"])',
        'pad = userdata.pad\npad = other()\nprint(pad["volume"])',
        'print(userdata.pad.get("volume"))',
        'if isinstance(userdata.pad, dict):\n    print(userdata.pad["volume"])',
    ],
)
def test_a_class_reads_fields_correctly(body: str) -> None:
    assert fields_missed(body) == []


def test_a_misspelt_field_in_a_class() -> None:
    (found,) = fields_missed('print(userdata.pad["nmae"])')
    assert found == ('"nmae"', "did you mean `name`?")


HELPED = """
import smach

class Reader(smach.State):
    def __init__(self):
        super().__init__(outcomes=["done"], input_keys=["pad", "pads"])

    def execute(self, userdata):
        self.log("pad", userdata.pad)
        return "done"

    def log(self, text, pad):
        BODY
"""


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ('print(pad["volume"])', ['"volume"']),
        ('for each in pad["at"]:\n            print(each, pad["volume"])', ['"volume"']),
        ('print(pad["name"])', []),
        ('pad = {}\n        print(pad["volume"])', []),
        ('if "volume" in pad:\n            print(pad["volume"])', []),
    ],
)
def test_a_helper_reads_a_field_of_its_argument(body: str, found: list[str]) -> None:
    report = analysed(FIELD_FILES | {"own.py": HELPED.replace("BODY", body)}).report
    assert [item.span.text for item in report if item.code == "SM311"] == found


GENERATOR = """
    def tries(self, userdata):
        while True:
            if self.preempt_requested():
                raise Stopped
            yield userdata.tries
"""


@pytest.mark.parametrize(
    ("generator", "found"),
    [
        (GENERATOR, []),
        (GENERATOR.replace("raise Stopped", "return"), ["SM309 cell/find.py:11 execute"]),
        (GENERATOR.replace("while True", "while self.speed"), ["SM309 cell/find.py:11 execute"]),
    ],
)
def test_a_loop_over_a_generator(generator: str, found: list[str]) -> None:
    """A generator that only raises or loops does not end the loop over its items."""
    text = changed((FIRST, "        for _ in self.tries(userdata):\n"))
    text = text.replace('        return "lost"\n', "")
    text = text.replace('"found", "lost", "preempted"', '"found", "preempted"')
    interface = INTERFACE.replace("lost: {}, ", "")
    script = SCRIPT.replace(" lost: lost,", "")
    report = findings(text + generator, interface, script)
    assert [line for line in lines(report) if line.startswith("SM309")] == found


@pytest.mark.parametrize(
    ("use", "found"),
    [
        ("while not self.done.is_set:", ["SM609 cell/find.py:14 self.done.is_set"]),
        ("while not self.done.is_set():", []),
        ("if self.done.flag:", []),
        ("if self.speed.is_set:", []),
    ],
)
def test_a_method_of_an_object_of_the_library(use: str, found: list[str]) -> None:
    text = changed(
        (FIRST, f"        {use}\n"), ("import smach\n", "import smach\nimport threading\n")
    )
    kept = "self.speed = speed\n        self.done = threading.Event()"
    text = text.replace("self.speed = speed", kept)
    assert [line for line in lines(findings(text)) if line.startswith("SM609")] == found


@pytest.mark.parametrize(
    ("module", "line"),
    [("def look():\n    if 1\n        return 2\n", 2), ("def look(:\n    return 2\n", 1)],
)
def test_an_imported_module_that_is_not_python(module: str, line: int) -> None:
    text = changed(("import smach\n", "import smach\n\nfrom cell.camera import look\n"))
    (item,) = findings(text, **{"cell/camera.py": module})
    assert (item.code, item.span.source.name, item.span.line) == ("SM608", "cell/camera.py", line)
    assert item.message.startswith("`cell/camera.py` is not valid Python: ")
    assert findings(text, **{"cell/camera.py": "def look():\n    return 2\n"}) == []


def test_a_package_with_a_module_that_is_not_python() -> None:
    files = {"cell/__init__.py": "from .find import FindPart\n"}
    interface = INTERFACE.replace("cell.find:", "cell:")
    (item,) = findings(changed(("userdata):", "userdata)")), interface, **files)
    assert (item.code, item.span.source.name) == ("SM608", "cell/find.py")
