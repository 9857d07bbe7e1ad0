"""What comments allow, what a project makes of codes, and what neither can silence."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from smachac.diagnostics.diagnostic import Code, Finding, Report, Severity
from smachac.diagnostics.diagnostic import Diagnostic as Item
from smachac.diagnostics.severities import Policy, apply_severities, select_findings
from smachac.diagnostics.source import NOWHERE, Source
from smachac.driver import CODES, Analysis, analyse, build
from smachac.frontend.files import disk_library, read_source
from smachac.frontend.text.suppressions import MARK, suppressions_in
from smachac.report.explain_code import MAIN, explanation
from smachac.targets import load_target, target_names

HEAD = "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
PICK = "  - PICK: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}\n"
LOST = "  - LOST: {template: ScriptedState, outcomes: [ok], transitions: {ok: done}}"


def judged(text: str, folder: Path, **others: str) -> Analysis:
    for name, content in {MAIN: text, **others}.items():
        (folder / name.replace("__", ".")).write_text(content, "utf-8")
    report: Report = []
    source = read_source(folder / MAIN, report)
    assert source is not None
    return analyse(source, disk_library(folder / MAIN, report, codes=CODES), report)


def found(analysis: Analysis) -> list[str]:
    return [f"{item.code}:{item.span.line}" for item in analysis.report]


@pytest.mark.parametrize(
    ("states", "expected"),
    [
        (PICK + LOST, ["SM201:6"]),
        (PICK + LOST + "  # smachac: allow SM201 by hand", []),
        (PICK + LOST + "  #smachac:allow sm201: by hand", []),
        (PICK + LOST + "  # so far. # smachac: allow SM201 by hand", []),
        (PICK + "  # smachac: allow SM201 by hand\n  # and more\n\n" + LOST, []),
        (PICK + LOST + "  # smachac: allow SM204, SM201 by hand", ["SM021:6"]),
        (PICK + LOST + "  # smachac: allow SM201", ["SM022:6"]),
        (PICK + LOST + "  # smachac: allow SM201 --", ["SM022:6"]),
        (PICK + LOST + "  # smachac: allow by hand", ["SM201:6", "SM022:6"]),
        (PICK + LOST + "  # smachac: allow SM299 by hand", ["SM201:6", "SM022:6"]),
        (PICK + LOST + "  # smachac: alow SM201 by hand", ["SM201:6", "SM022:6"]),
        (PICK + LOST + "\n  # smachac: allow SM201 too late", ["SM201:6", "SM021:7"]),
        (PICK + "  # smachac: allow SM201 wrong line\n" + PICK.replace("PICK", "B") + LOST,
         ["SM201:8"]),
        (PICK.replace("ok: done}}", "ok: done}}  # smachac: allow SM101 x"), ["SM021:5"]),
        (
            PICK.replace("done}}", "doen}}  # smachac: allow SM101 x"),
            ["SM101:5", "SM022:5"],
        ),
        (PICK + "  #\n" + LOST.replace("LOST", "smachac"), ["SM201:7"]),
        (PICK + "  # smachac:\n" + LOST, ["SM022:6", "SM201:7"]),
        (PICK.replace("outcomes", "doc: ' # smachac: allow SM201 x', outcomes"), []),
    ],
)  # fmt: skip
def test_comments(states: str, expected: list[str], tmp_path: Path) -> None:
    shown = found(judged(HEAD + states + "\n", tmp_path))
    assert shown == expected


def test_a_script_that_cannot_be_read_has_no_unused_suppressions(tmp_path: Path) -> None:
    text = HEAD + PICK + "  # smachac: allow SM305 not judged\n  - [\n"
    assert [item.code for item in judged(text, tmp_path).report] == ["SM001"]


def test_a_comment_ends_with_its_line() -> None:
    report: Report = []
    assert suppressions_in(Source("main.yml", "#\nsmachac: allow SM201 x\n"), report, CODES) == []
    assert report == []


def test_text_in_a_block_is_no_comment(tmp_path: Path) -> None:
    block = (
        "  - PICK:\n      template: ScriptedState\n      doc: |\n        # smachac: allow SM201 x\n"
    )
    block += "      outcomes: [ok]\n      transitions: {ok: done}\n"
    assert found(judged(HEAD + block, tmp_path)) == []


def test_an_allowed_error_does_not_stop_a_build(tmp_path: Path) -> None:
    text = HEAD + PICK + LOST
    assert judged(text, tmp_path).checked is None
    assert judged(text + "  # smachac: allow SM201 by hand\n", tmp_path).checked is not None


def test_comments_in_sub_scripts_count_there_and_may_serve_another(tmp_path: Path) -> None:
    call = "  - PICK: {script: pick, transitions: {ok: done}}\n"
    sub = (
        "- PICK:\n    template: StateMachine\n    outcomes: [ok]\n    states:\n"
        "      - A: {template: ScriptedState, outcomes: [ok], transitions: {ok: ok}}\n"
        "      - B: {template: ScriptedState, outcomes: [ok], transitions: {ok: ok}}"
    )
    comment = "  # smachac: allow SM201, SM204 by hand\n"
    analysis = judged(HEAD + call, tmp_path, pick__yml=sub + comment)
    assert found(analysis) == []
    assert [fit.code for fit in analysis.unused] == ["SM204"]
    assert [fit.code for fit in analysis.given] == ["SM201", "SM204"]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ('SM201 = "warning"', ["warning"]),
        ('SM2 = "info"', ["info"]),
        ('SM2 = "info"\nSM201 = "off"', []),
        ('"SM20" = "off"\nSM201 = "error"', ["error"]),
    ],
)
def test_severities_of_a_project(line: str, expected: list[str], tmp_path: Path) -> None:
    (tmp_path / "smachac.toml").write_text(f"[severity]\n{line}\n")
    analysis = judged(HEAD + PICK + LOST + "\n", tmp_path)
    assert [item.severity.value for item in analysis.report] == expected
    assert (analysis.checked is None) == (expected == ["error"])
    (tmp_path / "smachac.toml").unlink()
    (tmp_path / "pyproject.toml").write_text(f"[tool.smachac.severity]\n{line}\n")
    analysis = judged(HEAD + PICK + LOST + "\n", tmp_path)
    assert [item.severity.value for item in analysis.report] == expected


def test_firm_errors_outlast_a_project(tmp_path: Path) -> None:
    (tmp_path / "smachac.toml").write_text('[severity]\nSM = "off"\n')
    assert found(judged(HEAD + PICK.replace("ok: done", "ok: doen"), tmp_path)) == ["SM101:5"]


@pytest.mark.parametrize(
    ("text", "place", "help"),
    [
        ('[severity]\nXY = "off"', (2, 1), "use one of"),
        ('[severity]\nSM201 = "of"', (2, 9), "did you mean `off`?"),
        ("[severity]\nSM201 = 3", (2, 9), "write one of"),
        ('severity = "off"', (1, 1), "[severity]"),
        ('[severity]\n"SM101" = "warning"', (2, 1), "remove the line"),
        ("[severities]\nSM201 = 1", (1, 2), "did you mean `severity`?"),
        ("\nexclude = 'x'", (2, 11), "write it as `exclude = "),
    ],
)  # fmt: skip
def test_wrong_settings_are_told_at_their_place(
    text: str, place: tuple[int, int], help: str, tmp_path: Path
) -> None:
    (tmp_path / "smachac.toml").write_text(text)
    (item,) = judged(HEAD + PICK, tmp_path).report
    assert item.code == "SM007"
    assert (item.span.line, item.span.column) == place
    assert help in (item.finding.help or "")


def item(code: str, severity: Severity | None = None) -> Item:
    finding = Finding(span=NOWHERE, message="x")
    return Item(kind=CODES[code], severity=severity or CODES[code].severity, finding=finding)


@pytest.mark.parametrize(
    ("select", "ignore", "expected"),
    [
        ([], [], "SM101 SM105 SM201 SM204"),
        (["SM2"], [], "SM101 SM201 SM204"),
        (["SM2"], ["SM204"], "SM101 SM201"),
        (["SM204"], ["SM2"], "SM101 SM204"),
        ([], ["SM"], "SM101"),
        (["SM2"], ["SM2"], "SM101"),
    ],
)
def test_selecting_and_ignoring(select: list[str], ignore: list[str], expected: str) -> None:
    report = [item(code) for code in ("SM101", "SM105", "SM201", "SM204")]
    kept = [finding.code for finding in select_findings(report, select, ignore)]
    assert kept == expected.split()


def test_a_mild_finding_of_a_firm_code_can_be_silenced() -> None:
    mild = item("SM101", Severity.WARNING)
    assert apply_severities([mild], Policy(severities={"SM1": None})) == []
    assert select_findings([mild], [], ["SM101"]) == []


SOFT = [
    code
    for code in CODES.values()
    if not code.unsuppressible
    and code.severity is Severity.ERROR
    and MAIN in explanation(code).wrong
]


@pytest.mark.parametrize("code", SOFT, ids=lambda code: code.code)
def test_what_can_be_allowed_can_be_built(code: Code, tmp_path: Path) -> None:
    for name, text in explanation(code).wrong.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    (tmp_path / "smachac.toml").write_text(f'[severity]\n{code.code} = "info"\n')
    report: Report = []
    source = read_source(tmp_path / MAIN, report)
    assert source is not None
    library = disk_library(tmp_path / MAIN, report, codes=CODES)
    checked = analyse(source, library, report).checked
    assert checked is not None
    for name in target_names():
        target = load_target(name)
        assert target is not None
        problems: Report = []
        files = build(checked, target, library, problems)
        for file, text in files.items():
            if file.endswith(".py"):
                compile(text, file, "exec")
        # A target may lack what the finding is about; that for Python lacks nothing.
        assert {problem.code for problem in problems} <= {"SM601", "SM602"}
        assert bool(files) == (problems == [])
        assert files or name != "python"


def test_a_concurrence_without_an_answer_is_never_built(tmp_path: Path) -> None:
    """No default, and not every combination ruled: whatever is printed would be made up."""
    (tmp_path / MAIN).write_text(
        """name: sm
outcomes: [succeeded]
states:
  - BOTH:  # smachac: allow SM401 it will not happen
      template: Concurrence
      outcomes: [succeeded]
      transitions: {succeeded: succeeded}
      states:
        - A: {template: ScriptedState, outcomes: [done, lost]}
"""
    )
    (tmp_path / "smachac.toml").write_text('[severity]\nSM203 = "info"\n')
    report: Report = []
    source = read_source(tmp_path / MAIN, report)
    assert source is not None
    analysis = analyse(source, disk_library(tmp_path / MAIN, report, codes=CODES), report)
    assert analysis.checked is None
    assert "SM401" in {one.code for one in analysis.report}


WORDS = st.sampled_from(
    ["#", " ", "\n", f"# {MARK} allow ", "SM201", "SM999", ",", "why", "- 'x ", "'", "|\n  ", "a: "]
)


@given(st.lists(WORDS, max_size=25).map("".join))
def test_any_text_with_comments_is_read(text: str) -> None:
    report: Report = []
    source = Source("main.yml", text)
    for fit in suppressions_in(source, report, CODES):
        assert fit.code == fit.span.text
        assert 1 <= fit.line <= len(source.line_starts)
    assert {one.code for one in report} <= {"SM022"}
