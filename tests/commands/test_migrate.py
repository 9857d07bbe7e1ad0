"""`smachac migrate`: what works, what means something else than for SMACHA, what must be edited."""

# ruff: noqa: E501
from __future__ import annotations

import json
from pathlib import Path

import pytest

from smachac.commands.cli import main
from smachac.diagnostics.source import Source
from smachac.frontend.files import disk_library
from smachac.frontend.text.yaml_tree import parse
from smachac.refactor.smacha.report import render_migration
from smachac.refactor.smacha.script_differences import script_differences
from smachac.refactor.smacha.template_differences import template_differences, top_level_sets

SMACHA = Path(__file__).parents[1] / "smacha"

STATE = """\
name: sm
template: Base
outcomes: [done]
states:
  - A: {{template: ScriptedState, outcomes: [done], transitions: {{done: done}}, {more}}}
"""

QUIRKS = {
    "key-renamed": ("userdata: {p: 1}", "p"),
    "key-renamed in a value": ("userdata: {x: {t: 1}}", "t"),
    "variable-look-up": ("speed: fast, input_keys: [speed]", "[speed]"),
    "variable-look-up of a part": ("userdata: {a: 1}, other: [userdata, a]", "[userdata, a]"),
    "deep-look-up": ("params: {x: 1}, userdata: {a: {b: [params, x]}}", "[params, x]"),
    "key-case": ("userdata: {Pose: 1}", "Pose"),
    "null-as-text": ("userdata: {x: null}", "null"),
    "code-in-userdata": ('userdata: {x: "`1 + 1`"}', '"`1 + 1`"'),
    "text-as-code": ("userdata: {x: 'a.b'}", "'a.b'"),
    "text-as-code of a number": ("userdata: {x: '12'}", "'12'"),
    "text-as-code of a file": ("userdata: {x: block.urdf}", "block.urdf"),
    "text-as-code of brackets": ("userdata: {x: hi (there)}", "hi (there)"),
    "text-with-quote": ("userdata: {x: it's}", "it's"),
}

NONE = [
    "userdata: {x: 1, y: hello, z: Point(1), w: rospy.Time(0), v: [1, 2]}",
    "params: {x: 1}, name_param: [params, x], userdata: {a: [params, x]}",
    "params: {x: 1}, callbacks: {a: ['a_', [params, x], '_b'], b: [[x]]}",
    "input_keys: [x], output_keys: [y]",
    "p: {x: 1}, ud: {x: 1}, ik: [x]",
    "userdata: {x: \"'a.b'\"}",
]


def found(text: str) -> list[tuple[str, str]]:
    return [
        (quirk.name, quirk.span.text)
        for quirk in script_differences(parse(Source("main.yml", text), []))
    ]


@pytest.mark.parametrize("name", QUIRKS)
def test_each_quirk_is_found_at_its_place(name: str) -> None:
    more, place = QUIRKS[name]
    assert found(STATE.format(more=more)) == [(name.partition(" ")[0], place)]


@pytest.mark.parametrize("more", NONE)
def test_what_means_the_same_is_no_quirk(more: str) -> None:
    assert found(STATE.format(more=more)) == []


def test_quirks_of_names_calls_and_concurrences() -> None:
    text = """\
- TOP:
    template: Concurrence
    outcomes: [done]
    default_outcome: done
    states:
      - T: {template: ScriptedState, userdata: {x: 1}}
      - CALL: {script: other, outcomes: [done], params: {a: 1}, transitions: {done: done}}
"""
    assert found(text) == [
        ("state-renamed", "T"),
        ("userdata-in-concurrence", "{x: 1}"),
        ("call-variable", "outcomes"),
    ]


def test_a_manifest_is_told() -> None:
    text = "name: sm\nm: my_robot\ntemplate: Base\nstates:\n  - A: {template: T, manifest: x}\n"
    assert found(text) == [("manifest", "m")]


@pytest.mark.parametrize("text", ["", "[]", "a", "{}", "- a", "- {}", "states: 1", "states: [1]"])
def test_texts_that_are_no_scripts_have_no_quirks(text: str) -> None:
    assert found(text) == []


BODY = "{% block body %}smach.{{ parent_type }}.add('{{ name }}', T()){% endblock %}\n"

TEMPLATES = {
    "python-2": (
        "{% block defs %}\nfor k in d.iteritems(): pass\n{% endblock %}",
        "edit",
        "for k in d.iteritems(): pass",
    ),
    "python-2 of a name": (
        "{% block defs %}\nx = xrange(3)\n{% endblock %}",
        "edit",
        "x = xrange(3)",
    ),
    "python-2 of a statement": (
        "{% block defs %}\nraise A, b\n{% endblock %}",
        "note",
        "raise A, b",
    ),
    "python-2 of an exception": (
        "{% block defs %}\n    except A, e:\n{% endblock %}",
        "note",
        "except A, e:",
    ),
    "lost-block": ("{% block class_def %}x = 1{% endblock %}", "changed", "class_def"),
    "unknown-name": ("{% block defs %}{{ sped }}{% endblock %}", "changed", "sped"),
    "leaked-set": ("{% block defs %}{{ shared }}{% endblock %}", "changed", "shared"),
    "leaked-set of a container": (
        "{% block defs %}{{ sm_name }}{% endblock %}",
        "changed",
        "sm_name",
    ),
    "own-params": ("{% block defs %}{{ params }}{% endblock %}", "changed", "params"),
    "stable-uuid": ("{% block defs %}x_{{ uuid }} = 1{% endblock %}", "note", "uuid"),
    "old-style": ('{% include "State.tpl" %}', "note", '{% include "State.tpl" %}'),
    "text-outside": ("\n# said\n{% block defs %}x = 1{% endblock %}", "changed", "# said"),
}

SAME = [
    "{% block defs %}{{ speed }}{{ slots }}{% endblock %}",
    "{% block defs %}{% if x is defined %}{{ x }}{% endif %}{{ y | default(1) }}{% endblock %}",
    "{% set x = 1 %}{% macro m(a) %}{{ a }}{% endmacro %}{% block defs %}{{ x }}{{ m(1) }}{% endblock %}",
    "{% block meta %}\nvariables:\n- x: {}\n{% endblock %}{% block defs %}{{ x }}{% endblock %}",
    "{% block defs %}{% block part %}x = 1{% endblock %}{% for a in [1] %}{{ a }}{{ loop.index }}{% endfor %}{% endblock %}",
    "{% block defs %}{% for k, v in userdata.iteritems() %}{{ k }}{% endfor %}\nprint('x')\n# for i in xrange\n{% endblock %}",
    '{% extends "Parent.tpl.py" %}{% block part %}{{ made }}{% endblock %}',
    '{% extends "Base.tpl.py" %}{% block more %}{{ body }}{% endblock %}',
    "{% block defs %}{% if %}{% endblock %}",
    '{% extends "Parent.tpl.py" %}\n# said\n{% block defs %}x = 1{% endblock %}',
    "{% block meta %}\nname: T\n{% endblock %}\n# of macros\n{% macro m(a) %}{{ a }}{% endmacro %}",
    "{% block defs %}{% if not x and (y or z) %}{{ y }}{{ z }}{{ 1 if x else 2 }}{% endif %}{% endblock %}",
    '{% extends "State.tpl.py" %}{% block defs %}{{ render_transitions({}) }}{% endblock %}',
]

OTHERS = {
    "Parent.tpl.py": "{% set made = 1 %}{% block defs %}{% block part %}{% endblock %}{% endblock %}",
    "Base.tpl.py": "{% block main %}{% endblock %}",
    "State.tpl.py": disk_library(Path("main.yml"), []).template("State.tpl").text,  # type: ignore[union-attr]
}


def test_imported_names_and_those_of_loops_are_not_handed_on() -> None:
    text = '{% from "Utils.tpl.py" import a %}{% set b = 1 %}{% macro c() %}{% endmacro %}'
    text += "{% for d in [1] %}{% set e = d %}{% endfor %}{% set _f = 1 %}"
    assert top_level_sets(Source("T.tpl.py", text)) == ("b", "c")


def test_variables_of_a_template_that_no_script_uses_are_not_known() -> None:
    source = Source("T.tpl.py", "{% block defs %}{{ sped }}{% endblock %}")
    assert [*template_differences(source, lambda file: None, frozenset(), {}, used=False)] == []


def told_of(text: str) -> list[tuple[str, str, str]]:
    sources = {name: Source(name, each) for name, each in OTHERS.items()}
    source, sets = Source("T.tpl.py", text), {"sm_name": "Base.tpl.py", "shared": "Shared.tpl.py"}
    told = template_differences(source, sources.get, frozenset(["speed", "slots"]), sets)
    return [(quirk.name, quirk.what, quirk.span.text) for quirk in told]


@pytest.mark.parametrize("name", TEMPLATES)
def test_each_quirk_of_a_template_is_found_at_its_place(name: str) -> None:
    text, what, place = TEMPLATES[name]
    assert told_of(text + BODY) == [(name.partition(" ")[0], what, place)]


@pytest.mark.parametrize("text", SAME)
def test_templates_that_mean_the_same_have_no_quirks(text: str) -> None:
    assert told_of(text) == []


def test_quirks_of_templates_are_in_the_report(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "A.tpl.py").write_text("{% set side = 1 %}" + BODY)
    (tmp_path / "B.tpl.py").write_text(
        "{% block defs %}\n{{ side }}\nfor i in xrange(3): pass\n{% endblock %}" + BODY
    )
    (tmp_path / "C.tpl").write_text('{% include "State.tpl" %}' + BODY)
    code, text = migrated(capsys, str(tmp_path))
    assert code == 1
    assert "B.tpl.py:3:1: edit: `xrange` is Python 2: " in text
    assert "B.tpl.py:2:4: changed: SMACHA took `side` from `A.tpl.py`, which sets it, " in text
    assert "C.tpl     template    works  1 noted" in text
    data = json.loads(migrated(capsys, str(tmp_path), "--format", "json")[1])
    assert [[item["name"] for item in file["items"]] for file in data["files"]] == [
        [], ["leaked-set", "python-2"], ["old-style"],
    ]  # fmt: skip


def migrated(capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str]:
    code = main(["migrate", *words])
    return code, capsys.readouterr().out


@pytest.mark.slow
def test_a_folder_that_works(capsys: pytest.CaptureFixture[str]) -> None:
    code, text = migrated(capsys, str(SMACHA))
    assert code == 0
    assert "two_arms.yml         " in text
    assert "OldMove.tpl         " in text
    assert "0 have to be edited; " in text


@pytest.mark.slow
def test_json_has_every_file_and_place(capsys: pytest.CaptureFixture[str]) -> None:
    code, text = migrated(capsys, str(SMACHA), "--format", "json")
    data = json.loads(text)
    assert code == 0
    kinds = {Path(file["name"]).name: (file["kind"], file["state"]) for file in data["files"]}
    assert kinds["told_twice.yml"] == ("sub-script", "works")
    assert kinds["whole.yml"] == ("script", "works")
    assert kinds["OldBase.tpl"] == ("template", "works")
    assert data["edit"] == 0
    assert data["works"] == len(kinds)
    (old,) = (file for file in data["files"] if file["name"].endswith("OldMove.tpl"))
    assert [item["name"] for item in old["items"]] == ["old-style", "SM606", "SM606"]


def test_what_must_be_edited_fails(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "scripts").mkdir()
    (tmp_path / "templates").mkdir()
    (tmp_path / "scripts" / "main.yml").write_text(
        "name: sm\node_name: n\ntemplate: Base\noutcomes: [done]\nstates:\n"
        "  - A: {template: Bad, transitions: {done: NOWHERE}}\n"
    )
    (tmp_path / "scripts" / "fine.yml").write_text(
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        "  - A: {template: Bad, transitions: {done: done}}\n"
    )
    (tmp_path / "templates" / "Bad.tpl.py").write_text("{% block body %}{{ gone }}{% endblock %}")
    (tmp_path / "templates" / "Unused.tpl").write_text("{% block body %}{% if %}")
    code, text = migrated(capsys, str(tmp_path))
    assert code == 1
    for words in (
        "main.yml:2:1: edit: `ode_name` is not a variable of the script [SM003]",
        "[SM101]",
        "Bad.tpl.py:1:20: edit: the template uses `gone`, which is not defined [SM605]",
        "Unused.tpl:1:",
        "0 of 4 files work as they are, 4 have to be edited",
    ):
        assert words in text
    code, table = migrated(capsys, str(tmp_path), "--format", "md")
    assert code == 1
    assert "| edit | SM003 | `ode_name` is not a variable of the script |" in table


def test_an_error_covers_the_name_that_it_is_about_and_no_other(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "main.yml").write_text(
        "name: sm\ntemplate: Base\noutcomes: [done]\nstates:\n"
        "  - A: {template: Bad, transitions: {done: done}}\n"
    )
    template = "{% block body %}{{ gone }}\n{{ go }}{% endblock %}"
    (tmp_path / "Bad.tpl.py").write_text(template)
    text = migrated(capsys, str(tmp_path))[1]
    assert "Bad.tpl.py:1:20: edit: the template uses `gone`, which is not defined [SM605]" in text
    assert "no script gives `go`" in text
    assert "no script gives `gone`" not in text


@pytest.mark.slow
def test_the_same_report_each_time(capsys: pytest.CaptureFixture[str]) -> None:
    assert migrated(capsys, str(SMACHA)) == migrated(capsys, str(SMACHA))


def test_no_folder_and_nothing_in_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert migrated(capsys, str(tmp_path / "gone"))[0] == 2
    assert migrated(capsys, str(tmp_path))[0] == 2


def test_a_file_is_no_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "main.yml").write_text("name: sm\n")
    assert main(["migrate", str(tmp_path / "main.yml")]) == 2
    assert "is a file: name its folder" in capsys.readouterr().err


def test_a_report_on_nothing() -> None:
    assert render_migration([], "text").endswith("0 places mean something else here\n")


def test_a_project_of_smacha_is_for_ros_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / ".git").mkdir()
    (tmp_path / "main.yml").write_text("name: sm\noutcomes: [a]\nstates: []\n", encoding="utf-8")
    main(["migrate", str(tmp_path)])
    assert "smachac.toml (ros = 1)" in capsys.readouterr().err
    settings = tmp_path / "smachac.toml"
    assert "\nros = 1\n" in settings.read_text("utf-8")
    settings.write_text("ros = 2\n", encoding="utf-8")
    main(["migrate", str(tmp_path)])
    assert capsys.readouterr().err == ""
    assert settings.read_text("utf-8") == "ros = 2\n"


def test_a_sub_script_of_a_relative_folder_is_read_through_its_caller(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The call replaces the template, which alone would be reported as missing."""
    folder = tmp_path / "robot"
    folder.mkdir()
    call = "{script: part, template: ScriptedState, outcomes: [done], transitions: {done: done}}"
    main_script = f"name: sm\noutcomes: [done]\nstates:\n  - A: {call}\n"
    (folder / "main.yml").write_text(main_script)
    (folder / "part.yml").write_text("- PART: {template: Nothing}\n")
    monkeypatch.chdir(tmp_path)
    _, text = migrated(capsys, "robot")
    assert "2 of 2 files work as they are" in text
