"""Values of Python classes: results that are None, texts for lists, values of helpers, loops."""

from __future__ import annotations

import pytest

from tests.checks.test_class_faults import CLASS, only, report

PART = "userdata.part = userdata.parts[0]"
BOTH = ("output_keys: {part: str}", 'output_keys: {part: str, parts: "list[str]"}')
LISTS = ('output_keys=["part"]', 'output_keys=["part", "parts"]')


def test_the_result_of_a_method_that_changes_a_list() -> None:
    wrong = f"{PART}\n        userdata.parts = userdata.parts.append(self.tries)"
    item = only(BOTH, LISTS, (PART, wrong))
    assert (item.code, item.span.text) == ("SM318", "userdata.parts.append(self.tries)")
    assert item.help == "write `userdata.parts + [self.tries]`"


@pytest.mark.parametrize(
    "value",
    [
        "userdata.parts + [1]",
        "userdata.parts.copy()",
        "userdata.parts.pop()",
        "self.tracker.append(userdata.parts)",
    ],
)
def test_results_that_are_values(value: str) -> None:
    changes = [BOTH, LISTS, ("self.camera = Camera()", "self.camera = self.tracker = Camera()")]
    line = f"{PART}\n        userdata.parts = {value}"
    assert [item.code for item in report(*changes, (PART, line)) if item.code == "SM318"] == []


@pytest.mark.parametrize(
    ("lines", "help"),
    [
        (
            "names = list(userdata.parts); names = names.sort(); print(names)",
            "write `names.sort()`",
        ),
        (
            "names = []; other = names.append(1); print(other)",
            "write `names.append(1)`, and then `other = names`",
        ),
        ("names = sorted(userdata.parts); names = names.sort()", None),
        ("names = open(0); names = names.sort(); print(names)", None),
        ("names = []; names = self; names = names.sort(); print(names)", None),
        ("names = []; names.sort(); print(names)", None),
    ],
)
def test_local_lists(lines: str, help: str | None) -> None:
    found = report((PART, f"{PART}\n        {lines}"))
    assert [(item.code, item.help) for item in found] == ([("SM609", help)] if help else [])


CONSTANT = ("class FindPart(smach.State):\n", "class FindPart(smach.State):\n    OUT = {}\n\n")


@pytest.mark.parametrize(
    ("constant", "use", "found"),
    [
        ('("part")', "list(self.OUT)", ['("part")']),
        ('("part")', "[*self.OUT]", ['("part")']),
        ('("part")', "self.OUT", ['("part")']),
        ('("part",)', "list(self.OUT)", []),
        ('"part"', "[self.OUT]", []),
        ('("part")', "[self.OUT]", []),
    ],
)
def test_a_text_in_parentheses_is_no_tuple(constant: str, use: str, found: list[str]) -> None:
    head = (CONSTANT[0], CONSTANT[1].format(constant))
    items = report(head, ('output_keys=["part"]', f"output_keys={use}"))
    assert [item.span.text for item in items if item.code == "SM609"] == found


# --- outcomes and values of helpers

HELPER = """\
        outcome = self.work(userdata)
        print(outcome)
        return outcome

    def work(self, userdata):
        if not userdata.parts:
            return "nothing"
        userdata.part = userdata.parts[0]
        return {}
"""


def with_helper(value: str, *changes: tuple[str, str]) -> list[tuple[str, str]]:
    head = CLASS.partition("        if not userdata.parts")[0]
    text = head + HELPER.format(value)
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return [(item.code, item.span.text) for item in report(files={"cell/find.py": text})]


def test_an_outcome_in_a_local_variable_is_that_of_the_helper() -> None:
    assert with_helper("FOUND") == []
    assert with_helper("True") == [("SM309", "True")]
    examined = ("print(outcome)", 'if outcome is True:\n            return "found"')
    assert with_helper("True", examined) == []
    replaced = with_helper("True", ("print(outcome)", 'outcome = "found"'))
    assert [code for code, _ in replaced] == ["SM315"]  # no path returns what the helper returns


@pytest.mark.parametrize(
    ("side", "found"),
    [('"rigth"', ['"rigth"']), ('"right"', []), ("name", []), ("None", [])],
)
def test_texts_that_a_helper_returns_are_values(side: str, found: list[str]) -> None:
    helper = f'def side_of(name):\n    return "left" if name else {side}\n\n\n'
    items = report(
        ("output_keys: {part: str}", 'output_keys: {part: "one_of[left, right]"}'),
        ("class FindPart", f"{helper}class FindPart"),
        (PART, "userdata.part = side_of(userdata.parts)"),
    )
    assert [item.span.text for item in items if item.code == "SM304"] == found


# --- loops

LOOP = "        for _ in self.tries:\n            pass\n        if not userdata.parts:"


def test_a_loop_over_a_number() -> None:
    item = only(("        if not userdata.parts:", LOOP))
    assert (item.code, item.span.text) == ("SM304", "self.tries")
    assert item.help == "write `range(self.tries)`"


def test_a_loop_over_what_the_script_sets() -> None:
    open_ = ("variables: {tries: {type: int, default: 2}}", "variables: {tries: {doc: all}}")
    loop = ("        if not userdata.parts:", LOOP)
    assert report(loop, open_, ("template: Find\n", "template: Find\n      tries: [1]\n")) == []
    item = only(loop, open_, ("template: Find\n", "template: Find\n      tries: 3\n"))
    assert (item.code, item.help) == ("SM304", "write `range(3)`, or a list")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("self.tries = tries", "self.tries = range(tries)"),
        ("self.tries = tries", "tries = range(tries)\n        self.tries = tries"),
        ("def execute", "def prepare(self):\n        self.tries = []\n\n    def execute"),
        (
            "for _ in self.tries",
            "if isinstance(self.tries, list): print()\n        for _ in self.tries",
        ),
        ("variables: {tries: {type: int, default: 2}}", 'variables: {tries: {type: "list[int]"}}'),
    ],
)
def test_a_loop_over_what_may_be_a_list(old: str, new: str) -> None:
    set_ = (
        [("template: Find\n", "template: Find\n      tries: [1]\n")] if "list[int]" in new else []
    )
    assert report(("        if not userdata.parts:", LOOP), (old, new), *set_) == []
