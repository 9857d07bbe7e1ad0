"""Code of the user in Python: its depth is bounded, wherever it is read."""

from __future__ import annotations

import ast
import random
from pathlib import Path

import pytest

import smachac
from smachac.commands.cli import main
from smachac.ir import python_code
from smachac.ir.python_code import DEEPEST, TooDeepError, parse_code, parse_module
from tests.support.examples import every

FORMS = {
    "attributes": ("x", ".b", ""),
    "calls": ("f", "()", ""),
    "indices": ("x", "[0]", ""),
    "mixed": ("x", ".b[0]()", ""),
    "sums": ("1", "+1", ""),
    "differences": ("1", "-1", ""),
    "powers": ("1", "**1", ""),
    "signs": ("-", "-", "1"),
    "negations": ("not ", "not ", "1"),
    "brackets": ("", "(", "1"),
    "lists": ("", "[", ""),
    "dictionaries": ("", "{1:", "1"),
    "conditions": ("", "1 if 1 else ", "1"),
    "functions": ("", "lambda ud, a: ", "1"),
    "calls in calls": ("", "f(", "1"),
    "arguments": ("f(", "*", "x)"),
    "loops": ("", "[1 for i in ", "x"),
    "formats": ("f'{x", ".b", "}'"),
    "conjunctions": ("1", " and 1 or 1", ""),
    "comparisons": ("1", "<1", ""),
}
CLOSING = {"(": ")", "[": "]", "{": "}"}


def nested(form: str, count: int) -> str:
    start, piece, end = FORMS[form]
    opened = [CLOSING[sign] for sign in piece if sign in CLOSING]
    closed = [sign for sign in piece if sign in CLOSING.values()]
    missing = opened[: len(opened) - len(closed)]
    return start + piece * count + end + "".join(missing) * count


@pytest.mark.parametrize("form", FORMS)
def test_code_of_20000_levels_is_refused(form: str) -> None:
    code = nested(form, 20_000)
    with pytest.raises(SyntaxError):
        parse_code(code)


@pytest.mark.parametrize("form", every(4, FORMS))
def test_no_depth_of_code_is_a_bug(
    form: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """In a callback, a value, a module of the user and a template."""
    deep = nested(form, 3_000)
    (tmp_path / "templates").mkdir()
    template = '{% extends "State.tpl.py" %}{% block class_defs %}\nclass Own(smach.State):\n'
    (tmp_path / "templates" / "Own.tpl.py").write_text(
        f"{template}    def execute(self, ud):\n        return {deep}\n{{% endblock %}}\n"
    )
    (tmp_path / "templates" / "Own.yml").write_text(
        "name: Own\ncode: {python: Own.tpl.py}\noutcomes: {ok: {}}\n"
    )
    (tmp_path / "templates" / "Mine.yml").write_text(
        "name: Mine\ncode: {python: 'mine:Mine'}\noutcomes: {ok: {}}\n"
    )
    (tmp_path / "mine.py").write_text(
        "import smach\nclass Mine(smach.State):\n"
        "    def __init__(self):\n        smach.State.__init__(self, outcomes=['ok'])\n"
        f"    def execute(self, ud):\n        x = {deep}\n        return 'ok'\n"
    )
    script = tmp_path / "main.yml"
    calls = "".join(
        f"- {name}: {{template: {type_}, {fields}transitions: {{{outcome}: done}}}}\n"
        for name, type_, outcome, fields in (
            ("A", "Own", "ok", ""),
            ("B", "Mine", "ok", ""),
            ("C", "CallbacksState", "succeeded", f'callbacks: {{x: "lambda ud: {deep}"}}, '),
            ("D", "ScriptedState", "ok", f'outcomes: [ok], value: "`{deep}`", '),
        )
    )
    script.write_text(f"name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n{calls}")
    for words in (["check"], ["build", "-t", "python"], ["fmt", "--check"], ["explain"]):
        more = ["C"] if words == ["explain"] else []
        assert main([words[0], str(script), *more, *words[1:]]) in (0, 1)
    shown = capsys.readouterr()
    assert "SM016" in shown.out
    assert "Traceback" not in shown.err


@pytest.mark.parametrize("form", [form for form in FORMS if form != "arguments"])
def test_code_of_an_allowed_depth_is_read(form: str) -> None:
    assert ast.unparse(parse_code(nested(form, 40)))


@pytest.mark.parametrize("text", ["'\ud800'", "x\0", "f'{", "(", "1" * 5000, "x = 1"])
def test_what_python_does_not_read_is_a_syntax_error(text: str) -> None:
    with pytest.raises(SyntaxError):
        parse_code(text)


def test_the_bound_of_a_module_counts_branches_too() -> None:
    code = "if a:\n    pass\n" + "elif a:\n    pass\n" * 1000
    with pytest.raises(SyntaxError, match="nested deeper than 500 levels"):
        parse_module(code)
    assert parse_module("x = [\n" + "    (1, 'a b c', -2),\n" * 5000 + "]\n" + "f(1)\n" * 5000)


def test_the_bound_is_named() -> None:
    with pytest.raises(TooDeepError, match=f"it is nested deeper than {DEEPEST} levels"):
        parse_code(nested("attributes", 300))


def test_nothing_else_parses_code() -> None:
    """Another reader would need the bound as well. Expressions of xacro are read in a process with
    limits of its own."""
    folder = Path(smachac.__file__).parent
    found = {
        path.relative_to(folder).as_posix()
        for path in folder.rglob("*.py")
        if "ast.parse(" in path.read_text("utf-8")
    }
    assert found == {"ir/python_code.py", "robots/xacro_expressions.py"}


def test_the_fast_bound_of_operations_finds_all_that_the_exact_one_finds() -> None:
    pieces = [
        "a",
        ".",
        *"()[]{}",
        ",",
        ";",
        "\n",
        "#",
        "'",
        '"',
        '"""',
        "\\",
        "f'",
        "rb'",
        " ",
        "12",
    ]
    chosen = random.Random(42)
    texts = ("".join(chosen.choices(pieces, k=8_000)) for _ in range(20))
    wrong = [
        text
        for text in (*texts, "f'{" + "a.b" * 1_500 + "}'", "a.b" * 1_500)
        if python_code._has_too_many_operations(text)
        and not python_code._may_have_too_many_operations(text)
    ]
    assert wrong == []


@pytest.mark.parametrize("lines", ["{}", "(\n{}\n)", "if x:\n    y = [\n{}\n]"])
@pytest.mark.parametrize("form", ["-{}", "[{}]", "f(a={})", "lambda: {}", "x.y({}).z"])
def test_levels_are_counted_in_one_line_and_in_several(form: str, lines: str) -> None:
    code = "x"
    for _ in range(60):
        code = form.format(code)
    tree = ast.parse(lines.format(code))
    level: list[ast.AST] = [tree]
    levels = 0
    while level:
        levels += 1
        level = [part for node in level for part in ast.iter_child_nodes(node)]
    assert [python_code._is_deeper(tree, most) for most in (levels - 1, levels)] == [True, False]


def test_attributes_that_others_write_into_nodes_are_no_levels() -> None:
    """Python has one object for each `ast.Load()`, in which pyflakes writes the node around it."""
    load = next(node for node in ast.walk(ast.parse("x")) if isinstance(node, ast.Load))
    load.mark = ast.parse("-" * 2 * DEEPEST + "1")  # type: ignore[attr-defined]
    try:
        assert parse_code("x" + ".a" * (DEEPEST - 50))
    finally:
        del load.mark  # type: ignore[attr-defined]
