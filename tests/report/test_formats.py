"""The reports for other tools: SARIF by its schema, lines for GitHub, JUnit's XML; any text."""

from __future__ import annotations

import json
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any
from urllib.parse import unquote
from xml.etree import ElementTree as ET

import jsonschema
from hypothesis import given
from hypothesis import strategies as st

import smachac
from smachac.diagnostics.diagnostic import (
    Diagnostic,
    Finding,
    Related,
    Report,
    Severity,
    ended,
    entered,
)
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import NOWHERE, Source, Span
from smachac.driver import CODES
from smachac.report.explain_code import MAIN, explanation
from smachac.report.github import render_github
from smachac.report.junit import render_junit
from smachac.report.sarif import render_sarif
from smachac.report.text import render_text

STANDARD = Path(__file__).parents[1] / "standards" / "sarif-2.1.0-rtm.5.json"
SCRIPT = Source("a b/main.yml", "name: sm\ntransitions: {\U0001f916: B}\n")


@cache
def schema() -> Any:
    return jsonschema.Draft4Validator(json.loads(STANDARD.read_text("utf-8")))


def diagnostic(finding: Finding, severity: Severity = Severity.ERROR) -> Diagnostic:
    return Diagnostic(kind=CODES["SM204"], severity=severity, finding=finding)


FULL = diagnostic(
    Finding(
        span=Span(SCRIPT, 26, 27),
        message="`B` is [nothing](x)",
        arguments=("B",),
        help="100 %: did you mean `A`?",
        related=(
            Related(span=Span(SCRIPT, 6, 10), message="of this machine"),
            Related(span=NOWHERE, message="and of none"),
        ),
        path=(entered("A", "sm/A"), ended("a"), entered("B", "sm/B")),
        node="sm/A",
        edits=(Edit(span=Span(SCRIPT, 26, 27), text="A"),),
    )
)


def log(report: Report) -> Any:
    data = json.loads(render_sarif(report))
    assert [error.message for error in schema().iter_errors(data)] == []
    return data["runs"][0]


def test_the_schema_refuses_what_is_wrong() -> None:
    data = json.loads(render_sarif([FULL]))
    data["runs"][0]["results"][0]["level"] = "grave"
    del data["runs"][0]["tool"]
    assert len(list(schema().iter_errors(data))) == 2


def test_sarif_has_places_rules_flows_and_fixes() -> None:
    run = log([FULL])
    (rule,) = run["tool"]["driver"]["rules"]
    assert rule["id"] == "SM204"
    assert "```yaml" in rule["help"]["markdown"]
    (result,) = run["results"]
    assert result["message"]["text"] == "`B` is \\[nothing\\](x)\n100 %: did you mean `A`?"
    place = result["locations"][0]["physicalLocation"]
    assert place["artifactLocation"] == {"uri": "a%20b/main.yml", "uriBaseId": "%SRCROOT%"}
    # The robot before it is one character, and two UTF-16 units.
    assert place["region"] == {"startLine": 2, "startColumn": 19, "endLine": 2, "endColumn": 20}
    assert result["relatedLocations"][0]["physicalLocation"]["region"]["endLine"] == 2
    assert result["relatedLocations"][1] == {"id": 2, "message": {"text": "and of none"}}
    flow = result["codeFlows"][0]["threadFlows"][0]["locations"]
    assert [step["location"]["message"]["text"] for step in flow] == ["A -(a)->", "B"]
    (change,) = result["fixes"][0]["artifactChanges"]
    assert change["replacements"][0]["insertedContent"] == {"text": "A"}


def test_the_steps_of_a_path_stand_where_their_states_are(tmp_path: Path) -> None:
    lines = explanation(CODES["SM204"]).wrong[MAIN].splitlines()
    (tmp_path / MAIN).write_text("\n".join(lines))
    run = log(smachac.check(tmp_path / MAIN))
    (result,) = [result for result in run["results"] if result["ruleId"] == "SM204"]
    flow = result["codeFlows"][0]["threadFlows"][0]["locations"]
    assert len(flow) > 1
    for step in flow:
        state = step["location"]["message"]["text"].split(" -(")[0]
        region = step["location"]["physicalLocation"]["region"]
        assert lines[region["startLine"] - 1][region["startColumn"] - 1 :].startswith(state)


def test_fingerprints_follow_a_finding_and_tell_twins_apart() -> None:
    moved = Source(SCRIPT.name, "# a comment\n" + SCRIPT.text)
    later = diagnostic(
        Finding(span=Span(moved, 38, 39), message="reworded", arguments=("B",), node="sm/A")
    )
    other = diagnostic(replace(FULL.finding, arguments=("C",)))

    def marks(report: Report) -> list[str]:
        return [item["partialFingerprints"]["smachac/v2"] for item in log(report)["results"]]

    assert marks([FULL]) == marks([later])
    assert marks([FULL]) != marks([other])
    first, second = marks([FULL, later])
    assert first.endswith(":1")
    assert second == f"{first[:-1]}2"


def test_files_elsewhere_have_no_base() -> None:
    uris = []
    for name in ("../x.yml", "/abs/x.yml"):
        place = Span(Source(name, ""), 0, 0)
        (result,) = log([diagnostic(Finding(span=place, message="x"))])["results"]
        uris.append(result["locations"][0]["physicalLocation"]["artifactLocation"])
    assert uris == [{"uri": "../x.yml"}, {"uri": "file:///abs/x.yml"}]


def test_github_lines_are_exact() -> None:
    assert render_github([FULL]) == (
        "::error file=a b/main.yml,line=2,endLine=2,col=18,endColumn=19,title=SM204 unbounded-loop"
        "::`B` is [nothing](x)%0Aa b/main.yml:1:7: of this machine%0Anote: and of none"
        "%0Apath: A -(a)-> B%0Ahelp: 100 %25: did you mean `A`?\n"
    )
    over_lines = diagnostic(Finding(span=Span(SCRIPT, 0, 12), message="x"), Severity.WARNING)
    line = "::warning file=a b/main.yml,line=1,endLine=2,title=SM204 unbounded-loop::x\n"
    assert render_github([over_lines]) == line


def test_junit_has_a_test_for_each_script() -> None:
    mild = diagnostic(Finding(span=NOWHERE, message="mild"), Severity.WARNING)
    text = render_junit({"a.yml": [FULL, mild], "b.yml": []}, {"a.yml": [FULL], "b.yml": []})
    whole = ET.fromstring(text)
    (suite,) = whole
    assert (suite.get("tests"), suite.get("failures")) == ("2", "1")
    bad, good = suite
    assert [child.tag for child in bad] == ["failure", "system-out"]
    assert "help: 100 %" in (bad[0].text or "")
    assert "mild" in (bad[1].text or "")
    assert list(good) == []


JENKINS = {
    "testsuites": ({"name", "time", "tests", "failures", "errors"}, {"testsuite"}),
    "testsuite": (
        {"name", "tests", "failures", "errors", "group", "time", "skipped", "timestamp", "hostname",
         "id", "package", "file", "log", "url"},
        {"testsuite", "properties", "testcase", "system-out", "system-err"},
    ),
    "testcase": (
        {"name", "time", "classname", "group"},
        {"skipped", "error", "failure", "rerunFailure", "rerunError", "flakyFailure", "flakyError",
         "system-out", "system-err"},
    ),
    "failure": ({"type", "message"}, set[str]()),
    "system-out": (set[str](), set[str]()),
}  # fmt: skip
"""The attributes and the children that an element may have, of those that we write: the structure
of junit-10.xsd in github.com/jenkinsci/xunit-plugin. No order of children is required."""

REQUIRED = {"testsuite": {"name", "tests", "failures", "errors"}, "testcase": {"name"}}
"""The attributes that an element must have."""

WITH_TEXT = {"failure", "system-out"}


def faults_for_jenkins(element: ET.Element) -> list[str]:
    """What Jenkins' schema does not allow in an element."""
    attributes, children = JENKINS[element.tag]
    given = set(element.attrib)
    found = [f"{element.tag}: attribute {name}" for name in sorted(given - attributes)]
    found += [f"{element.tag}: no {name}" for name in REQUIRED.get(element.tag, set()) - given]
    texts = [element.text, *(child.tail for child in element)]
    if element.tag not in WITH_TEXT and any((text or "").strip() for text in texts):
        found.append(f"{element.tag}: text")
    for child in element:
        if child.tag in children:
            found += faults_for_jenkins(child)
        else:
            found.append(f"{element.tag}: {child.tag}")
    return found


def test_junit_is_valid_for_jenkins() -> None:
    mild = diagnostic(Finding(span=NOWHERE, message="mild"), Severity.WARNING)
    text = render_junit({"a.yml": [FULL, mild], "b.yml": []}, {"a.yml": [FULL], "b.yml": []})
    assert faults_for_jenkins(ET.fromstring(text)) == []


def test_what_jenkins_refuses_is_found() -> None:
    text = (
        "<testsuites skipped='0'><testsuite name='x'><testcase file='f'/>a</testsuite></testsuites>"
    )
    assert sorted(faults_for_jenkins(ET.fromstring(text))) == [
        "testcase: attribute file",
        "testcase: no name",
        "testsuite: no errors",
        "testsuite: no failures",
        "testsuite: no tests",
        "testsuite: text",
        "testsuites: attribute skipped",
    ]


ANY = st.text(st.characters(), max_size=30)  # lone surrogates and controls as well


@given(ANY, ANY, ANY, st.data())
def test_any_text_survives_every_form(
    name: str, text: str, message: str, data: st.DataObject
) -> None:
    source = Source(name, text)
    start = data.draw(st.integers(0, len(text)))
    span = Span(source, start, data.draw(st.integers(start, len(text))))
    finding = Finding(
        span=span,
        message=message,
        help=text,
        related=(Related(span=span, message=text),),
        path=(entered(message, None), ended(text)),
        node=text,
        edits=(Edit(span=span, text=message),),
    )
    report = [diagnostic(finding)]

    sarif = render_sarif(report)
    assert sarif.isascii()
    (result,) = log(report)["results"]
    location = result["locations"][0]["physicalLocation"]
    assert result["message"]["text"].replace("\\", "").startswith(message.replace("\\", ""))
    assert location["region"]["startLine"] == source.position(start)[0]
    uri = location["artifactLocation"]["uri"]
    assert ":" not in uri.removeprefix("file://")
    path = unquote(uri.removeprefix("file://"), errors="surrogatepass")
    assert path.strip("/.") in name or name.startswith("//")

    line = render_github(report)
    assert line.count("\n") == 1
    assert "\r" not in line
    head, _, words = line[2:].partition("::")
    assert head.startswith("error file=")
    assert len(head.split(",")) in (4, 6)
    assert words.isprintable() or words[:-1].isprintable()

    suite = ET.fromstring(render_junit({name: report}, {name: report}).encode())
    assert "SM204" in ("".join(suite.itertext()))


def test_no_name_begins_a_line_or_controls_a_terminal() -> None:
    name = "a\n::error::x\n##[error]y\r::add-mask::z\x1b[31m\x9b31m\u2028::warning::w"
    source = Source(f"{name}.yml", f"name: sm\n# {name}\n")
    span = Span(source, 0, 4)
    related = (Related(span=span, message=name), Related(span=NOWHERE, message=name))
    finding = Finding(
        span=span, message=name, help=name, related=related, path=(entered(name, None), ended(name))
    )
    item = Diagnostic(kind=CODES["SM101"], finding=finding, severity=Severity.ERROR)
    texts = [
        render_text([item]),
        render_github([item]),
        render_junit({source.name: [item]}, {source.name: [item]}),
    ]
    for text in texts:
        assert not any(mark in text for mark in "\x1b\x9b\r\u2028")
        lines = [line.lstrip() for line in text.split("\n")]
        commands = [line for line in lines if line.startswith(("::", "##["))]
        assert all(line.startswith("::error file=") for line in commands)
        assert len(commands) == (text is texts[1])
