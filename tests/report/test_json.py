"""The report for programs: exact text, its schema, any text."""

from __future__ import annotations

import json
from textwrap import dedent

from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.diagnostics.diagnostic import (
    Code,
    Diagnostic,
    Finding,
    Related,
    Severity,
    ended,
    entered,
)
from smachac.diagnostics.repair import Edit
from smachac.diagnostics.source import NOWHERE, Source, Span
from smachac.report.json import render_json
from tests.support.examples import examples
from tests.support.json_schema import faults, load_schema

SCHEMA = load_schema("report")
SCRIPT = Source("main.yml", "name: sm\ntransitions: {a: B}\n")


def diagnostic(finding: Finding, severity: Severity = Severity.ERROR) -> Diagnostic:
    code = Code(code="SM101", name="unknown-target", severity=severity, explanation="")
    return Diagnostic(kind=code, severity=severity, finding=finding)


FULL = diagnostic(
    Finding(
        span=Span(SCRIPT, 26, 27),
        message="`B` is nothing",
        help="did you mean `A`?",
        effect="no program is generated",
        related=(Related(span=Span(SCRIPT, 6, 9), message="of this machine"),),
        path=(entered("sm", "sm"), entered("A", "sm/A"), ended("a")),
        node="sm/A",
    )
)
BARE = diagnostic(Finding(span=NOWHERE, message="x"), Severity.WARNING)


def test_a_report_in_full() -> None:
    assert render_json([FULL]) == dedent("""\
        {
          "clusters": [],
          "counts": {
            "error": 1,
            "info": 0,
            "warning": 0
          },
          "diagnostics": [
            {
              "code": "SM101",
              "edits": [],
              "effect": "no program is generated",
              "help": "did you mean `A`?",
              "message": "`B` is nothing",
              "name": "unknown-target",
              "node": "sm/A",
              "path": [
                "sm",
                "A",
                "(a)"
              ],
              "place": {
                "column": 18,
                "end_column": 19,
                "end_line": 2,
                "end_offset": 27,
                "file": "main.yml",
                "line": 2,
                "offset": 26
              },
              "related": [
                {
                  "message": "of this machine",
                  "place": {
                    "column": 7,
                    "end_column": 1,
                    "end_line": 2,
                    "end_offset": 9,
                    "file": "main.yml",
                    "line": 1,
                    "offset": 6
                  }
                }
              ],
              "repairs": [],
              "severity": "error"
            }
          ],
          "version": 4
        }
        """)


def test_what_is_not_there_is_null() -> None:
    data = json.loads(render_json([BARE]))
    (item,) = data["diagnostics"]
    assert [item[name] for name in ("place", "effect", "help", "node")] == [None] * 4
    assert data["counts"] == {"error": 0, "info": 0, "warning": 1}


def test_edits_have_a_place_and_a_text() -> None:
    edit = Edit(span=Span(SCRIPT, 26, 27), text="A")
    data = json.loads(
        render_json([diagnostic(Finding(span=edit.span, message="x", edits=(edit,)))])
    )
    assert faults(data, SCHEMA) == []
    (item,) = data["diagnostics"]
    assert item["edits"] == [{"place": item["place"], "text": "A"}]
    assert item["repairs"] == [{"certainty": "safe", "operator": "correct", "edits": item["edits"]}]


def test_an_empty_report_is_a_report() -> None:
    data = json.loads(render_json([]))
    assert data["diagnostics"] == []
    assert faults(data, SCHEMA) == []


def test_reports_fit_the_schema_and_others_do_not() -> None:
    data = json.loads(render_json([FULL, BARE]))
    assert faults(data, SCHEMA) == []
    assert faults(data | {"version": 1}, SCHEMA) == ["$.version: not 4"]
    data["diagnostics"][0]["place"]["line"] = 0
    del data["diagnostics"][1]["name"]
    assert faults(data, SCHEMA) == [
        "$.diagnostics[0].place: fits 0 of the possibilities",
        "$.diagnostics[1]: lacks name",
    ]


@settings(max_examples=examples(100))
@given(st.text(), st.text(), st.data())
def test_any_text_gives_a_report_in_ascii(text: str, message: str, data: st.DataObject) -> None:
    source = Source(message, text)
    start = data.draw(st.integers(0, len(text)))
    end = data.draw(st.integers(start, len(text)))
    finding = Finding(span=Span(source, start, end), message=message, path=(entered(text, None),))
    rendered = render_json([diagnostic(finding)])
    assert rendered.isascii()
    assert rendered.endswith("}\n")
    parsed = json.loads(rendered)
    assert faults(parsed, SCHEMA) == []
    place = parsed["diagnostics"][0]["place"]
    lines = text.split("\n")
    before = lines[: place["line"] - 1]
    assert sum(len(line) + 1 for line in before) + place["column"] - 1 == start
