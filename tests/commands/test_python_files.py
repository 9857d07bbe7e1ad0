"""Commands with Python files: check, build, explain, diff and view of machines for SMACH."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import jsonschema
import pytest

from smachac.commands.cli import main
from smachac.commands.schema import schema_text
from tests.support.viewed import Viewed, starter

STATES = """\
import smach


class Weigh(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["light", "heavy"])

    def execute(self, userdata):
        return "light"
"""
MACHINE = """\
import smach
from states import Weigh
from vendor_states import Speak

sm = smach.StateMachine(outcomes=["done", "lost"])
with sm:
    smach.StateMachine.add("WEIGH", Weigh(),
                           transitions={"light": "SPEAK", "heavy": "lost"})
    smach.StateMachine.add("SPEAK", Speak(), transitions={"ok": "done"})
"""
BROKEN = MACHINE.replace('"heavy": "lost"', '"heavy": "LOST"')
TWO = """\
import sys

import smach

sm = smach.StateMachine(outcomes=["done"])
with sm:
    smach.StateMachine.add("A", smach.State(outcomes=["ok"]),
                           {"ok": "B" if len(sys.argv) > 1 else "C"})
    if len(sys.argv) > 1:
        smach.StateMachine.add("B", smach.State(outcomes=["ok"]), {"ok": "C"})
    smach.StateMachine.add("C", smach.State(outcomes=["ok"]), {"ok": "done"})

top = smach.StateMachine(outcomes=["done"])
with top:
    smach.StateMachine.add("A", smach.State(outcomes=["ok"]), {"ok": "done"})
"""
EXACT = "import smach\n\n" + TWO[TWO.index("top = ") :]


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder: a repository with a machine and its states."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / ".git").mkdir()
    write("states.py", STATES)
    write("machine.py", MACHINE)
    return tmp_path


def write(name: str, text: str) -> None:
    Path(name).parent.mkdir(parents=True, exist_ok=True)
    Path(name).write_text(text, "utf-8")


Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def run(capsys: pytest.CaptureFixture[str]) -> Run:
    def run(*words: str) -> tuple[int, str, str]:
        code = main(words)
        found = capsys.readouterr()
        return code, found.out, found.err

    return run


# Coverage


def test_coverage_of_one_file(run: Run) -> None:
    code, out, _ = run("check", "machine.py")
    assert code == 0
    assert out.splitlines() == [
        "1 of 2 states exact; 1 unknown: machine.py:9: package vendor_states not found",
        "no findings",
    ]
    write("machine.py", EXACT)
    assert run("check", "machine.py")[1] == "1 of 1 states exact\nno findings\n"
    assert run("check", "states.py")[1] == "no state machine found in states.py\nno findings\n"


def test_coverage_of_several_files(run: Run) -> None:
    write("exact.py", EXACT)
    out = run("check", ".", "--python")[1]
    words = "2 of 3 states exact in 2 Python files; 1 unknown"
    assert out.splitlines() == [
        f"{words} (--notes lists them)",
        "no findings; 2 files checked",
    ]
    out = run("check", ".", "--python", "--notes")[1]
    assert out.splitlines()[:2] == [
        words,
        "unknown: machine.py:9: package vendor_states not found",
    ]


def test_many_unknown_places(run: Run) -> None:
    adds = [f'    smach.StateMachine.add("S{n}", Speak(), {{"ok": "done"}})\n' for n in range(5)]
    write("machine.py", MACHINE + "".join(adds))
    out = run("check", "machine.py", "--ignore", "SM201")[1].splitlines()[0]
    assert out.startswith("1 of 7 states exact; 6 unknown: machine.py:9: package")
    assert out.endswith("; 3 more (--notes lists them)")
    assert run("check", "machine.py", "--notes")[1].count("unknown: machine.py:") == 6


def test_a_place_with_an_unknown_number_of_states_counts_once(run: Run) -> None:
    loop = "    for name in sys.argv:\n"
    loop += '        smach.StateMachine.add(name, smach.State(outcomes=["ok"]), {"ok": "done"})\n'
    write("machine.py", f"import sys\n{EXACT}{loop}")
    out = run("check", "machine.py")[1]
    assert out.startswith("1 of 2 states exact; 1 unknown: machine.py:8: its name is not known")


def test_coverage_in_json(run: Run) -> None:
    out = run("check", "machine.py", "--format", "json")[1]
    data = json.loads(out)
    jsonschema.validate(data, json.loads(schema_text("report")))
    (found,) = data["coverage"]
    (unknown,) = found.pop("unknown")
    assert found == {"file": "machine.py", "states": 2, "exact": 1}
    assert unknown["reason"] == "package vendor_states not found"
    assert (unknown["place"]["file"], unknown["place"]["line"]) == ("machine.py", 9)
    write("main.yml", "name: sm\ntemplate: Base\noutcomes: [done]\nstates: []\n")
    assert "coverage" not in json.loads(run("check", "main.yml", "--format", "json")[1])


def test_a_file_that_cannot_be_read_has_no_coverage(run: Run) -> None:
    write("machine.py", f"{MACHINE}def (\n")
    code, out, _ = run("check", "machine.py")
    assert (code, "SM805" in out, "states exact" in out) == (0, True, False)
    assert "coverage" not in json.loads(run("check", "machine.py", "--format", "json")[1])


# Formats


def test_formats_of_findings(run: Run) -> None:
    write("machine.py", BROKEN)
    code, out, _ = run("check", "machine.py", "--format", "github")
    assert code == 1
    assert "::error file=machine.py,line=8" in out
    (result,) = json.loads(run("check", "machine.py", "--format", "sarif")[1])["runs"][0]["results"]
    place = result["locations"][0]["physicalLocation"]
    assert (result["ruleId"], place["artifactLocation"]["uri"]) == ("SM101", "machine.py")
    assert place["region"]["startLine"] == 8
    (suite,) = ET.fromstring(run("check", "machine.py", "--format", "junit")[1])
    (case,) = suite.iter("testcase")
    assert case.get("name") == "machine.py"
    assert case.find("failure") is not None


# Options of `check`


def test_fixes_never_edit_python(run: Run) -> None:
    write("machine.py", BROKEN)
    assert "fixable" not in run("check", "machine.py")[1]
    code, out, _ = run("check", "machine.py", "--fix")
    assert code == 1
    assert "--fix does not edit Python files" in out
    assert Path("machine.py").read_text() == BROKEN
    code, out, _ = run("check", "machine.py", "--fix", "--diff")
    assert (code, out) == (1, "")
    finding = json.loads(run("check", "machine.py", "--format", "json")[1])["diagnostics"][0]
    assert (finding["edits"], finding["repairs"]) == ([], [])


def test_scripts_are_fixed_beside_python_files(run: Run) -> None:
    write("machine.py", BROKEN)
    script = (
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        "  - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: doen}}\n"
    )
    write("main.yml", script)
    assert "1 fixed" in run("check", ".", "--python", "--fix")[1]
    assert Path("main.yml").read_text() == script.replace("doen", "done")
    assert Path("machine.py").read_text() == BROKEN


def test_any_finding_can_be_allowed_or_known(run: Run) -> None:
    """In a script, a target that does not exist cannot: it has no program."""
    write("machine.py", BROKEN)
    run("check", "machine.py", "--baseline", "known.json", "--write-baseline")
    code, out, _ = run("check", "machine.py", "--baseline", "known.json")
    assert (code, "1 in the baseline" in out) == (0, True)
    write("machine.py", BROKEN.replace('"LOST"})', '"LOST"})  # smachac: allow SM101 it is new'))
    assert run("check", "machine.py")[0] == 0


def test_links_out_of_the_folder_are_not_followed(run: Run, folder: Path) -> None:
    outside = folder / "outside"
    write("outside/other.py", EXACT)
    write("outside/states.py", STATES)
    write("inside/machine.py", MACHINE)
    (folder / "inside" / ".git").mkdir()
    (folder / "inside" / "other.py").symlink_to(outside / "other.py")
    (folder / "inside" / "states.py").symlink_to(outside / "states.py")
    out = run("check", "inside", "--python", "--notes")[1]
    assert "0 of 2 states exact; 2 unknown" in out
    assert "other.py" not in out
    (folder / "inside" / "own.py").symlink_to(folder / "inside" / "machine.py")
    assert run("check", "inside/own.py")[0] == 0


def test_baseline(run: Run) -> None:
    write("states.py", STATES.replace('return "light"', 'return "ligth"'))
    write("machine.py", MACHINE)
    assert run("check", "machine.py")[0] == 1
    run("check", "machine.py", "--baseline", "known.json", "--write-baseline")
    write("states.py", "\n\n" + STATES.replace('return "light"', 'return "ligth"'))
    code, out, _ = run("check", "machine.py", "--baseline", "known.json")
    assert (code, "1 in the baseline" in out) == (0, True)


UNREACHED = (
    EXACT + '    smach.StateMachine.add("IDLE", smach.State(outcomes=["ok"]), {"ok": "done"})'
)


@pytest.mark.parametrize(
    ("before", "after", "found"),
    [
        ("", "", ["SM201"]),
        ("", "  # smachac: allow SM201 by hand", []),
        ("    # smachac: allow SM201 by hand\n", "", []),
        ("    x = '# smachac: allow SM201 by hand'\n", "", ["SM201"]),
        ('    x = """\n    # smachac: allow SM201 by hand\n"""\n', "", ["SM201"]),
        ("", "  # smachac: allow SM201", ["SM022"]),
        ("", "  # smachac: allow SM201, SM202 by hand", ["SM021"]),
        ("", "  # smachac: allow SM2001 by hand", ["SM201", "SM022"]),
    ],
)
def test_suppressions(before: str, after: str, found: list[str], run: Run) -> None:
    *rest, last = UNREACHED.splitlines()
    write("machine.py", "\n".join([*rest, f"{before}{last}{after}", ""]))
    out = run("check", "machine.py", "--format", "json")[1]
    assert sorted(item["code"] for item in json.loads(out)["diagnostics"]) == sorted(found)


def test_suppression_in_a_module_of_the_states(run: Run) -> None:
    wrong = STATES.replace('return "light"', 'return "ligth"')
    write("states.py", wrong)
    assert run("check", "machine.py")[0] == 1
    write("states.py", wrong.replace('"ligth"', '"ligth"  # smachac: allow SM309 tried later'))
    assert run("check", "machine.py")[0] == 0


def test_a_suppression_of_a_finding_that_is_shown_with_all_is_used(run: Run) -> None:
    text = EXACT.replace('outcomes=["done"])', 'outcomes=["done", "never"])')
    write("machine.py", text)
    assert "no findings" in run("check", "machine.py")[1]
    data = json.loads(run("check", "machine.py", "--all", "--format", "json")[1])["diagnostics"]
    (code,) = {item["code"] for item in data}
    allowed = f'"never"])  # smachac: allow {code} it is for later'
    write("machine.py", text.replace('"never"])', allowed))
    assert "no findings" in run("check", "machine.py")[1]
    assert "no findings" in run("check", "machine.py", "--all")[1]


def test_changed_since(run: Run, folder: Path) -> None:
    shutil.rmtree(".git")
    write("machine.py", MACHINE)
    write("other/machine2.py", EXACT)
    write("other/machine1.py", MACHINE)
    git("init", "-q")
    git("add", "-A")
    git("commit", "-qm", "1")
    every = ("check", ".", "--python", "--changed-since", "HEAD")
    assert "0 files" in run(*every)[1] or "0 scripts" in run(*every)[1]
    write("states.py", f"{STATES}# changed\n")
    out = run(*every)[1]
    assert "2 of 4 states exact in 2 Python files" in out  # both import states.py
    write("other/machine2.py", f"{EXACT}# changed\n")
    assert "3 of 5 states exact in 3 Python files" in run(*every)[1]


def git(*words: str) -> None:
    names = {f"GIT_{who}_{what}": "x@example.org" for who in ("AUTHOR", "COMMITTER")
             for what in ("NAME", "EMAIL")}  # fmt: skip
    subprocess.run(["git", *words], env={**os.environ, **names}, check=True, capture_output=True)


# Pictures


def test_each_machine_is_drawn(run: Run) -> None:
    write("machine.py", TWO)
    for target, suffix in (("dot", "dot"), ("mermaid", "mmd"), ("html", "html")):
        code, out, _ = run("build", "machine.py", "--target", target, "-o", "out")
        assert code == 0
        assert out == f"wrote out/sm.{suffix}\nwrote out/top.{suffix}\n"
        assert run("build", "machine.py", "--target", target, "-o", "out", "--check")[0] == 0


def test_machines_of_one_name_are_numbered(run: Run) -> None:
    write("machine.py", TWO + TWO.replace("top", "sm").replace("import smach\n", "", 1))
    out = run("build", "machine.py", "--target", "dot", "-o", "out")[1]
    names = [line.partition("out/")[2] for line in out.splitlines()]
    assert names == ["sm.dot", "top.dot", "sm_2.dot", "sm_3.dot"]
    assert 'digraph "sm_2"' in Path("out/sm_2.dot").read_text()


def test_one_machine_is_chosen(run: Run) -> None:
    write("machine.py", TWO)
    code, out, _ = run("build", "machine.py", "--target", "dot", "-o", "-", "--machine", "top")
    assert (code, 'digraph "top"' in out) == (0, True)
    code, _, err = run("build", "machine.py", "--target", "dot", "-o", "-")
    assert (code, "--machine NAME" in err, "known: sm, top" in err) == (2, True, True)
    code, _, err = run("build", "machine.py", "--target", "dot", "--machine", "tpo")
    assert (code, "did you mean `top`?" in err) == (2, True)
    write("many.py", TWO + TWO[TWO.index("top =") :] * 30)
    err = run("build", "many.py", "--target", "dot", "-o", "-")[2]
    assert "top_19, and 12 more\n" in err
    assert run("build", "states.py", "--target", "dot")[0] == 2
    write("main.yml", "name: sm\ntemplate: Base\noutcomes: [done]\nstates: []\n")
    for command in (["build", "main.yml", "-t", "dot"], ["explain", "main.yml", "x"],
                    ["view", "main.yml"]):  # fmt: skip
        assert run(*command, "--machine", "sm")[::2] == (
            2, "smachac: error: --machine is for Python files\n",
        )  # fmt: skip


@pytest.mark.parametrize("target", ["python", "cpp", "json", "ir"])
def test_programs_are_refused(target: str, run: Run) -> None:
    code, _, err = run("build", "machine.py", "--target", target)
    assert (code, "pictures, such as dot, mermaid and html" in err) == (2, True)


def test_machines_with_errors_are_drawn(run: Run) -> None:
    write("machine.py", BROKEN)
    code, out, err = run("build", "machine.py", "--target", "html")
    assert (code, out) == (1, "wrote sm.html\n")
    assert "error[SM101]" in err
    data = model(Path("sm.html").read_text())
    (weigh,) = [node for node in data["nodes"] if node["path"] == "sm/WEIGH"]
    assert [data["findings"][at]["code"] for at in weigh["findings"]] == ["SM101"]
    write("machine.py", "def (")
    code, out, err = run("build", "machine.py", "--target", "html")
    assert (code, out, "SM805" in err) == (1, "", True)


def model(page: str) -> dict[str, Any]:
    """The model in a page."""
    begin = page.index('id="smachac-model">') + len('id="smachac-model">')
    found: dict[str, Any] = json.loads(page[begin : page.index("</script>", begin)])
    return found


def test_findings_belong_to_their_machine(run: Run) -> None:
    text = TWO.replace('"ok": "C"}', '"ok": "X"}') + TWO[TWO.index("top = ") :].replace(
        "top", "other"
    ).replace('"ok": "done"', '"ok": "dnoe"')
    write("machine.py", text)
    run("build", "machine.py", "--target", "html")
    codes = {
        name: [item["code"] for item in model(Path(f"{name}.html").read_text())["findings"]]
        for name in ("sm", "top", "other")
    }
    assert codes == {"sm": ["SM101"], "top": [], "other": ["SM101"]}


def test_what_is_not_known_is_dashed(run: Run) -> None:
    write("machine.py", TWO)
    for target in ("dot", "mermaid", "html"):
        run("build", "machine.py", "--target", target)
    dashed = {"B": "a condition that is not known adds it", "A ok?": "one of several states"}
    lines = Path("sm.dot").read_text().splitlines()
    for name in ("A", "B", "C", "A ok?"):
        (box,) = [line for line in lines if f"<B>{name}</B>" in line and "digraph" not in line]
        assert ('style="rounded,filled,dashed"' in box) == (name in dashed)
        assert dashed.get(name, "") in box
    assert any("dashed: not known exactly" in line for line in lines)
    text = Path("sm.mmd").read_text()
    assert "classDef unknown stroke-dasharray: 4 3" in text
    assert text.endswith("  class legend,sm__B,sm__A_ok_ unknown\n")
    nodes = {node["path"]: node for node in model(Path("sm.html").read_text())["nodes"]}
    assert {path: node["unknown"] for path, node in nodes.items() if "unknown" in node} == {
        "sm/B": "a condition that is not known adds it",
        "sm/A ok?": "one of several states comes next",
    }
    for name in ("top.dot", "top.mmd"):
        assert "dashed" not in Path(name).read_text()
    assert all("unknown" not in node for node in model(Path("top.html").read_text())["nodes"])


def test_states_lead_to_the_lines_of_python(run: Run) -> None:
    run("build", "machine.py", "--target", "html")
    nodes = {node["path"]: node for node in model(Path("sm.html").read_text())["nodes"]}
    weigh = nodes["sm/WEIGH"]
    assert (weigh["file"], weigh["line"]) == ("machine.py", 7)
    assert weigh["snippet"].splitlines() == [
        'smach.StateMachine.add("WEIGH", Weigh(),',
        '                       transitions={"light": "SPEAK", "heavy": "lost"})',
    ]
    assert nodes["sm"]["snippet"] == 'sm = smach.StateMachine(outcomes=["done", "lost"])'


def test_a_call_that_ends_at_its_own_indentation_is_shown_whole(run: Run) -> None:
    text = MACHINE.replace('"SPEAK", Speak(), transitions={"ok": "done"})',
                           '\n        "SPEAK",\n        Speak(),\n    )')  # fmt: skip
    write("machine.py", text)
    run("build", "machine.py", "--target", "html")
    nodes = {node["path"]: node for node in model(Path("sm.html").read_text())["nodes"]}
    assert nodes["sm/SPEAK"]["snippet"].splitlines()[-1] == ")"


def test_names_with_a_slash(run: Run) -> None:
    write("machine.py", MACHINE.replace("WEIGH", "IN/WEIGH"))
    run("build", "machine.py", "--target", "html")
    nodes = {node["path"]: node for node in model(Path("sm.html").read_text())["nodes"]}
    assert nodes["sm/IN/WEIGH"]["parent"] == "sm"
    assert run("build", "machine.py", "--target", "dot")[0] in (0, 1)


def test_a_picture_of_another_program_is_not_overwritten(run: Run) -> None:
    write("sm.dot", "digraph mine {}")
    assert run("build", "machine.py", "--target", "dot")[0] == 1
    assert Path("sm.dot").read_text() == "digraph mine {}"


# Explanations


def test_explain(run: Run) -> None:
    code, out, err = run("explain", "machine.py", "WEIGH")
    assert (code, err) == (0, "")
    assert "on heavy" in out
    assert "machine.py:7" in out
    code, out, _ = run("explain", "machine.py", "--failures")
    assert (code, "WEIGH" in out or "no failure" in out.lower() or out.startswith("sm")) == (
        0,
        True,
    )
    write("machine.py", TWO)
    assert run("explain", "machine.py", "A")[::2][0] == 2
    assert run("explain", "machine.py", "A", "--machine", "top")[0] == 0
    code, _, err = run("explain", "machine.py", "AX", "--machine", "top")
    assert (code, "did you mean `A`?" in err) == (2, True)
    write("machine.py", BROKEN)
    assert "the file has errors" in run("explain", "machine.py", "WEIGH")[2]
    write("machine.py", "def (")
    assert run("explain", "machine.py", "WEIGH")[0] == 1


# Differences


def test_differences_of_two_files(run: Run) -> None:
    write("new.py", MACHINE.replace('"WEIGH"', '"SCALE"'))
    code, out, _ = run("diff", "machine.py", "new.py")
    assert (code, "state sm/SCALE: renamed from sm/WEIGH" in out) == (1, True)
    assert run("diff", "machine.py", "machine.py")[0] == 0
    for form in ("json", "markdown", "dot", "html"):
        assert run("diff", "machine.py", "new.py", "--format", form)[0] == 1


def test_differences_of_two_revisions(run: Run) -> None:
    shutil.rmtree(".git")
    write("two.py", TWO)
    git("init", "-q")
    git("add", "-A")
    git("commit", "-qm", "1")
    assert run("diff", "two.py")[0] == 0
    write("states.py", STATES.replace('"heavy"]', '"heavy", "none"]'))
    code, out, _ = run("diff", "machine.py")  # of a module that it imports
    assert (code, "outcome none" in out) == (1, True)
    write("two.py", TWO.replace('"A", smach', '"AA", smach').replace('"C"', '"CC"'))
    out = run("diff", "two.py")[1]
    assert "two.py (sm): " in out
    assert "sm/AA: renamed from sm/A" in out
    assert "two.py (top): 1 state renamed" in out
    assert "two.py (top): 1 state renamed" in out
    out = run("diff", "two.py", "--machine", "top")[1]
    assert "(top)" in out
    assert "(sm)" not in out
    assert run("diff", "two.py", "--machine", "top", "--format", "dot")[0] == 1
    code, _, err = run("diff", "two.py", "--format", "dot")
    assert (code, "--machine" in err) == (2, True)
    code, _, err = run("diff", "two.py", "--machine", "tpo")
    assert (code, "did you mean `top`?" in err) == (2, True)
    assert run("diff")[0] == 2  # there is no script
    out = run("diff", "--python")[1]
    assert "machine.py" in out
    assert "two.py (sm)" in out


def test_machines_that_are_new_or_gone(run: Run) -> None:
    write("old.py", EXACT)
    write("new.py", TWO)
    out = run("diff", "old.py", "new.py")[1]
    assert out.startswith("new.py (sm): new script\n")
    assert "(top)" not in out
    code, out, err = run("diff", "states.py", "states.py")
    assert (code, "there is no state machine in `states.py`" in err) == (2, True)
    write("new.py", "def (")
    code, out, err = run("diff", "old.py", "new.py")
    assert (code, "cannot be read" in out, "SM805" in err) == (1, True, True)


# The view


@pytest.fixture
def start() -> Iterator[Callable[..., Viewed]]:
    with starter() as start:
        yield start


def test_view(start: Callable[..., Viewed], run: Run) -> None:
    write("machine.py", TWO)
    code, _, err = run("view", "machine.py")
    assert (code, "known: sm, top" in err) == (2, True)
    view = start("view", "machine.py", "--machine", "top", "--no-browser")
    data = model(view.page())
    assert [node["path"] for node in data["nodes"]] == ["top", "top/A"]
    assert "editable" not in data
    write("machine.py", TWO.replace('"A", smach', '"Z", smach'))
    assert view.until(
        lambda message: (
            message["kind"] == "model"
            and [node["path"] for node in message["model"]["nodes"]] == ["top", "top/Z"]
        )
    )
    write("machine.py", "def (")
    assert view.until(lambda message: message["kind"] == "report" and message["outdated"])


# Other commands, and changes


@pytest.mark.parametrize("command", ["run", "verify", "sweep"])
def test_commands_that_need_a_script(command: str, run: Run) -> None:
    code, out, err = run(command, "machine.py")
    assert code in (1, 2)
    assert "a script is expected; this is a Python file" in out + err


def test_watch(folder: Path) -> None:
    process = subprocess.Popen(
        [sys.executable, "-m", "smachac", "check", "--python", ".", "--watch"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=folder,
    )  # fmt: skip
    assert process.stdout is not None

    def summary() -> str:
        """The last line of a round; read until it waits."""
        last = ""
        for line in process.stdout or ():
            if line.startswith("watching"):
                return last
            last = line.strip("\n") and line
        raise AssertionError(process.communicate()[1])

    try:
        assert summary() == "no findings\n"
        write("states.py", STATES.replace('return "light"', 'return "ligth"'))
        assert summary() == "1 error in states.py\n"
        write("states.py", STATES)
        assert summary() == "no findings\n"
        write("new.py", EXACT)
        assert summary() == "no findings; 2 files checked\n"
    finally:
        process.kill()
        process.communicate()


def test_a_folder_without_scripts(run: Run) -> None:
    """The option for Python files is named where it finds some."""
    code, _, err = run("check", ".")
    assert (code, "there is no script in `.`" in err) == (2, True)
    assert "`--python` checks the Python files" in err
    Path("machine.py").unlink()
    assert "--python" not in run("check", ".")[2]
    assert "no script and no Python file with a state machine" in run("check", "--python", ".")[2]
