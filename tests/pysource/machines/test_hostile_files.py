"""Python files that nobody wrote for a robot: a finding or none, in bounded time and memory."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from smachac.driver.python_machines import PythonFile, PythonProject
from smachac.frontend.files import Disk
from smachac.pysource.machines import evaluator
from tests.support.hostile_python import HOSTILE

STEPS = 20_000
"""The bound of steps in these tests: the memory tests have the real one."""

LARGEST = ("nested ranges", "long texts in a list", "changes of a large dict", "nested partials",
           "many appends", "doubled tuple", "5000 states", "machines nested 100 times")  # fmt: skip
"""Texts that need the most memory."""


def read(path: Path) -> PythonFile:
    return PythonProject(Disk()).read(path)


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_gives_findings_or_none(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(evaluator, "MOST_STEPS", STEPS)
    path = tmp_path / "machine.py"
    path.write_text(HOSTILE[name], "utf-8")
    found = read(path)
    assert {item.code for item in found.report} <= {"SM104", "SM805"}


@pytest.mark.slow
@pytest.mark.parametrize("name", LARGEST)
def test_a_hostile_file_takes_little_memory(name: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.py"
    path.write_text(HOSTILE[name], "utf-8")
    limit = "import resource; resource.setrlimit(resource.RLIMIT_DATA, (500 << 20, 500 << 20))"
    code = f"{limit}; import runpy; runpy.run_module('smachac', run_name='__main__')"
    done = subprocess.run(
        [sys.executable, "-c", code, "check", str(path)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode in (0, 1), done.stderr) == (True, ""), done.stdout[-500:]


TEXTS = {
    "byte order mark": b"\xef\xbb\xbfimport smach\nsm = smach.StateMachine('done')\n",
    "line ends of Windows": b"import smach\r\nsm = smach.StateMachine('done')\r\nsm.execute()\r\n",
    "old line ends": b"import smach\rsm = smach.StateMachine('done')\r",
    "latin-1": "# -*- coding: latin-1 -*-\nimport smach\nx = 'größe'\n".encode("latin-1"),
    "not UTF-8": b"import smach\nx = '\xff\xfe'\n",
    "surrogates": b"import smach\nx = '\xed\xa0\x80'\ny = '\\ud800' + 'a'\n",
    "surrogate as a name": b"import smach\nsm = smach.StateMachine(outcomes=['\\ud800'])\n"
    b"with sm:\n    smach.StateMachine.add('\\udfff', smach.State(outcomes=['a']), {})\n",
    "NUL": b"import smach\nx = '\0'\n",
    "form feed": b"import smach\n\x0csm = smach.StateMachine(outcomes=[])\n",
    "empty": b"",
    "syntax error": b"import smach\nsm = smach.StateMachine(\n",
    "tabs and spaces": b"import smach\nif 1:\n\tx = 1\n        y = 2\n",
    "return outside": b"import smach\nreturn 1\n",
    "long line": b"import smach\nx = '" + b"a" * 150_000 + b"'\n",
    "10 MB": b"import smach\n" + b"x = smach.StateMachine(outcomes=[])\n" * 290_000,
    "many brackets": b"import smach\nx = " + b"(" * 5_000 + b")" * 5_000,
    "digits": b"import smach\nx = " + b"9" * 5_000 + b"\n",
    "names": "import smach\nsm = smach.StateMachine(outcomes=['\u202e', '\\n', ''])\nwith sm:\n"
    "    smach.StateMachine.add('\u202eA\\x1b[31m', smach.State(outcomes=['\\n']), {})\n".encode(),
}


@pytest.mark.parametrize("name", TEXTS)
def test_any_text_gives_findings_or_none(name: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.py"
    path.write_bytes(TEXTS[name])
    done = subprocess.run(
        [sys.executable, "-m", "smachac", "check", str(path)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode in (0, 1), done.stderr) == (True, ""), done.stderr[-2000:]


@pytest.mark.parametrize("before", ["\f\n", "\f", "# \f\v\n", "x = '\f'\n", "# more\n" * 100_000])
def test_a_place_is_right_after_form_feeds_and_in_a_long_file(before: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.py"
    path.write_text(f"import smach\n{before}sm = smach.StateMachine('d')\nsm.execute()\n", "utf-8")
    assert [(item.code, item.span.text) for item in read(path).report] == [("SM801", "'d'")]


def test_a_folder_and_a_file_that_nobody_may_read(tmp_path: Path) -> None:
    folder = tmp_path / "x.py"
    folder.mkdir()
    (tmp_path / "link.py").symlink_to(tmp_path / "nowhere")
    (tmp_path / "loop.py").symlink_to(tmp_path / "loop.py")
    (tmp_path / "a.py").write_text("import smach\nimport x, link, loop\nx.y = link.z\n")
    assert [item.code for item in read(tmp_path / "a.py").report] == []
    for name in ("x.py", "link.py", "loop.py"):
        assert [item.code for item in read(tmp_path / name).report] != []


@pytest.mark.parametrize("deep", ["1" + " + 1" * 20_000, "-" * 3_000 + "1", "x" + ".a" * 4_000])
def test_code_that_is_nested_too_deeply_is_not_called_invalid(deep: str, tmp_path: Path) -> None:
    path = tmp_path / "machine.py"
    path.write_text(f"import smach\nx = {deep}\nsm = smach.StateMachine(outcomes=['a'])\n")
    (item,) = read(path).report
    assert item.code == "SM805"
    assert "not valid" not in item.finding.message


LONG = "def work(n):\n    work(n)\n    work(n)\n\nwork(0)\n"


def test_a_file_that_takes_too_many_steps_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(evaluator, "MOST_STEPS", STEPS)
    path = tmp_path / "machine.py"
    head = "import smach\nsm = smach.StateMachine(outcomes=['a'])\n"
    add = "sm.open()\nsm.add('A', smach.State(outcomes=['a']), {'a': 'B'})\n"
    path.write_text(f"import smach\n{LONG}{head}{add}")
    assert [item.code for item in read(path).report] == ["SM805"]
    path.write_text(f"{head}{add}{LONG}")
    found = read(path)
    assert [item.code for item in found.report] == []
    assert found.coverage is not None
    assert "not all of its states are known" in {place.reason for place in found.coverage.unknown}


def test_a_file_is_read_as_before_after_one_that_takes_too_many_steps(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(evaluator, "MOST_STEPS", STEPS)
    good = "import smach\nimport names\nsm = smach.StateMachine(outcomes=['a'])\nwith sm:\n"
    good += "    sm.add('A', smach.State(outcomes=['a']), {'a': names.NEXT})\n"
    (tmp_path / "names.py").write_text("NEXT = 'B'\n")
    (tmp_path / "good.py").write_text(good)
    bad = f"import names\nnames.NEXT = 'a'\n{LONG}"
    (tmp_path / "bad.py").write_text(bad)
    project = PythonProject(Disk())
    reports = [project.read(tmp_path / name).report for name in ("good.py", "bad.py", "good.py")]
    assert [[item.code for item in report] for report in reports] == [
        ["SM101"],
        ["SM805"],
        ["SM101"],
    ]


def test_a_function_is_read_after_one_that_takes_too_many_steps(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(evaluator, "MOST_STEPS", STEPS)
    build = "    sm = smach.StateMachine(outcomes=['a'])\n    with sm:\n"
    build += "        sm.add('A', smach.State(outcomes=['a']), {'a': 'B'})\n    return sm\n"
    work = LONG.replace("work(0)\n", "")
    path = tmp_path / "machine.py"
    path.write_text(f"import smach\n{work}\ndef one():\n    work(0)\n{build}\ndef two():\n{build}")
    assert [item.code for item in read(path).report] == ["SM101"]
