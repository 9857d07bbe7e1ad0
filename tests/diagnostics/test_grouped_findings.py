"""Findings of one group are shown as one."""

from __future__ import annotations

from smachac.diagnostics.diagnostic import Report, fingerprint
from tests.trust.project_text import analysed

HEAD = "name: sm\ntemplate: Base\noutcomes: [done, failed]\nstates:\n"
STATE = "  - A{0}: {{template: ScriptedState, outcomes: [ok, failed], transitions: {{ok: {1}}}}}"


def main(count: int, comment: str = "") -> str:
    states = [STATE.format(at, f"A{at + 1}" if at + 1 < count else "done") for at in range(count)]
    states[1:2] = [states[1] + comment]
    return HEAD + "\n".join(states) + "\n"


def exits(text: str) -> Report:
    return [item for item in analysed({"main.yml": text}).report if item.code == "SM105"]


def test_a_hundred_implicit_exits_are_one_finding_with_a_list() -> None:
    (item,) = exits(main(100))
    assert item.span.text == "A0"
    assert item.message == (
        "outcome `failed` of `A0` has no transition, so `sm` ends with `failed`; the same holds"
        " for `A1`, `A10`, `A11`, `A12`, `A13`, `A14`, `A15`, `A16`, `A17`, `A18`, `A19`, `A2` and"
        " 87 more"
    )
    assert [one.span.text for one in item.related] == ["A1", "A2", "A3", "A4", "A5"]
    assert item.finding.arguments == ("sm", "failed")


def test_a_comment_allows_one_state_of_a_group() -> None:
    (item,) = exits(main(3, "  # smachac: allow SM105 it may fail"))
    assert item.message.endswith("the same holds for `A2`")


def test_a_group_of_one_is_a_finding_about_its_state() -> None:
    text = main(2, "  # smachac: allow SM105 it may fail")
    (item,) = exits(text)
    assert item.finding.arguments == ("A0", "failed")
    assert "the same" not in item.message


def test_a_baseline_knows_a_group_that_has_become_smaller() -> None:
    (more,), (fewer,) = exits(main(9)), exits(main(5))
    assert fingerprint(more) == fingerprint(fewer)


def test_notes_and_warnings_are_two_groups() -> None:
    last = "[ok, failed], transitions: {ok: done}"
    text = main(3).replace(last, "[done, failed]")
    assert [len(item.related) for item in exits(text)] == [1, 0, 0]
