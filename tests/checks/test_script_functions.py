"""Functions of the user that a script names as code: their arguments, results and reads."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: BinBase
outcomes: [done, none]
userdata: {parts: [{name: bolt, score: 0.5}]}
states:
  - CHOOSE:
      template: CallbacksState
      input_keys: [parts]
      output_keys: [best]
      callbacks: {best: best_part}
      transitions: {succeeded: SURE}
  - SURE:
      template: ConditionalOutcomeState
      input_keys: [best]
      outcomes: [sure]
      callbacks: {sure: rules.is_sure}
      default_outcome: none
      transitions: {sure: done, none: none}
"""
BASE = """\
{% extends "Base.tpl.py" %}
{% block imports %}
{{ super() }}
from bin import rules
from bin.rules import best_part
{% endblock imports %}
"""
RULES = """\
def best_part(userdata):
    return max(userdata.parts, key=lambda part: part["score"])


def is_sure(userdata, limit=0.3):
    return userdata.best["score"] > limit
"""


def findings(rules: str, main: str = MAIN, base: str = BASE) -> list[tuple[str, str, str]]:
    """Code, marked place and help of each finding above an info."""
    files = {
        "main.yml": main,
        "bin/__init__.py": "",
        "bin/rules.py": rules,
        "templates/BinBase.tpl.py": base,
    }
    found = analysed(files).report
    return [
        (item.code, f"{item.span.source.name}:{item.span.line} {item.span.text}", item.help or "")
        for item in found
        if item.severity.value != "info"
    ]


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("    return max", "    max",
         ("SM318", "bin/rules.py:1 best_part", "end `best_part` with `return ...`")),
        ("    return userdata.best", "    userdata.best",
         ("SM318", "bin/rules.py:5 is_sure", "end `is_sure` with `return ...`")),
        ("best_part(userdata)", "best_part(userdata, parts)",
         ("SM317", "bin/rules.py:1 best_part", "write `def best_part(userdata):`")),
        ("userdata, limit=0.3", "userdata, limit",
         ("SM317", "bin/rules.py:5 is_sure", "give `limit` a default value, or write"
          " `lambda userdata: rules.is_sure(userdata, ...)`")),
        ("is_sure(userdata, limit=0.3)", "is_sure()",
         ("SM317", "bin/rules.py:5 is_sure", "write `def is_sure(ud):`")),
        ("userdata.parts", "userdata.partz",
         ("SM310", "bin/rules.py:2 partz", "did you mean `parts`?")),
        ("userdata.best[", "userdata.choice[",
         ("SM310", "bin/rules.py:6 choice", "did you mean `best`?")),
    ],
)  # fmt: skip
def test_a_fault_in_a_function(old: str, new: str, expected: tuple[str, str, str]) -> None:
    assert old in RULES
    assert findings(RULES.replace(old, new)) == [expected]


RETURN = '    return max(userdata.parts, key=lambda part: part["score"])\n'
TESTED = "    if 'other' in userdata:\n        return userdata.other\n"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("", ""),
        (RETURN, '    raise ValueError("not written yet")\n'),
        (RETURN, '    """Not written yet."""\n'),
        (RETURN, TESTED + RETURN),
        (RETURN, "    yield max(userdata.parts)\n"),
        ("def best_part", "@cached\ndef best_part"),
        ("(userdata):\n    return max(userdata.", "(*given, **more):\n    return max(given[0]."),
    ],
)
def test_functions_that_are_right_or_cannot_be_judged(old: str, new: str) -> None:
    assert old in RULES
    assert findings(RULES.replace(old, new, 1)) == []


def test_a_function_for_two_states_with_different_keys() -> None:
    main = (
        MAIN.replace("transitions: {succeeded: SURE}", "transitions: {succeeded: AGAIN}")
        .replace(
            "  - SURE:",
            "  - AGAIN:\n      template: CallbacksState\n      input_keys: [parts, other]\n"
            "      output_keys: [best]\n      callbacks: {best: best_part}\n"
            "      transitions: {succeeded: SURE}\n  - SURE:",
        )
        .replace("userdata: {", "userdata: {other: 1, ")
    )
    rules = RULES.replace("userdata.parts, key", "[userdata.parts, userdata.other], key")
    assert "SM310" not in [finding[0] for finding in findings(rules, main)]


def test_a_function_in_the_template_itself() -> None:
    base = BASE.replace("from bin.rules import best_part\n", "").replace(
        "{% endblock imports %}\n",
        "{% endblock imports %}\n{% block defs %}\ndef best_part(ud):\n    max(ud.parts)\n"
        "{% endblock defs %}\n",
    )
    assert findings(RULES, base=base) == [
        ("SM318", "templates/BinBase.tpl.py:7 best_part", "end `best_part` with `return ...`")
    ]


def test_a_key_that_a_function_reads_is_no_dead_key() -> None:
    main = MAIN.replace("      input_keys: [parts]\n", "      input_keys: []\n")
    ((code, place, help),) = findings(RULES, main)
    assert (code, place) == ("SM310", "bin/rules.py:2 parts")
    assert help == "write `input_keys: [parts]` in `CHOOSE`"


@pytest.mark.parametrize(
    ("body", "found"),
    [
        ("userdata.best = userdata.parts[0]", ["end `best_part` with `return ...`"]),
        ("userdata.best = 1; return userdata.parts[0]", []),
    ],
)
def test_a_callback_that_sets_the_key_of_its_own_result(body: str, found: list[str]) -> None:
    old = 'return max(userdata.parts, key=lambda part: part["score"])'
    helps = [help for code, _, help in findings(RULES.replace(old, body)) if code == "SM318"]
    assert helps == found


def test_a_function_of_a_module_from_which_a_template_imports_others() -> None:
    main = MAIN.replace("rules.is_sure", "is_sure")
    assert findings(RULES, main) == [
        ("SM019", "main.yml:16 is_sure",
         "write `from bin.rules import best_part, is_sure` in `templates/BinBase.tpl.py`")
    ]  # fmt: skip
    ((code, _, help),) = findings(RULES.replace("def is_sure", "def is_good"), main)
    assert (code, "`from MODULE import is_sure`" in help) == ("SM019", True)
    base = BASE.replace("import best_part", "import best_part, is_sure")
    assert findings(RULES, main, base) == []


WEIGH = """\
name: sm
template: Base
outcomes: [done]
userdata: {grams: 500.0}
states:
  - COMPUTE:
      template: CallbacksState
      input_keys: [grams]
      output_keys: [mass]
      callbacks: {mass: 'lambda ud: CODE'}
      transitions: {succeeded: WEIGH}
  - WEIGH: {template: Weigh, transitions: {weighed: done}}
"""


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ('"%.1f" % ud.grams', ["SM304"]),
        ('"{:.1f}".format(ud.grams)', ["SM304"]),
        ('f"{ud.grams:.1f}"', ["SM304"]),
        ("ud.grams % 2.0", []),
        ("ud.grams", []),
    ],
)
def test_a_callback_that_formats_a_number(code: str, found: list[str]) -> None:
    files = {
        "main.yml": WEIGH.replace("CODE", code),
        "templates/Weigh.yml": "input_keys: {mass: float}\noutcomes: {weighed: {}}\n",
    }
    report = analysed(files).report
    assert [item.code for item in report if item.severity.value == "error"] == found
