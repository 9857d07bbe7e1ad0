"""What templates of SMACHA's kind may hold, one by one: blocks and where they go, variables, other
templates, macros, tests and filters, meta blocks.

Each test makes its templates itself; `docs/smacha.md` names the tests.
"""

# ruff: noqa: E501
from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

import smachac
from smachac.frontend.files import disk_library
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.nodes import StateType
from smachac.targets.python.smacha_context import FILTERS, TESTS, ScriptText, is_not_string
from smachac.targets.templates.engine import Blocks

Built = Callable[..., str]

MAIN = """\
name: SM
template: Base
outcomes: [done]
states:
  - A: {template: T, transitions: {done: B}}
  - B: {template: T, transitions: {done: done}}
"""

CLASS = """\
{% block class_defs %}
{% if 'class_T' not in defined_headers %}
class T(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['done'])

    def execute(self, userdata):
        return 'done'

{% do defined_headers.append('class_T') %}
{% endif %}
{% endblock %}
"""

ADDED = """\
{% from "Utils.tpl.py" import render_transitions %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', T(){% if transitions is defined %},
{{ render_transitions(transitions) }}{% endif %})
{% endblock body %}
"""

NESTED = """\
name: SM
template: Base
outcomes: [done]
states:
  - A: {template: T, transitions: {done: BOX}}
  - BOX:
      template: StateMachine
      outcomes: [done]
      transitions: {done: done}
      states:
        - B: {template: T, transitions: {done: done}}
"""

APPENDED = ("base_header", "imports", "defs", "class_defs", "cb_defs", "main_def", "body")
PREPENDED = ("footer", "execute", "base_footer", "main")
KEYED = ("header", "header_userdata")

LABELLED = "".join(
    f"{{% block {name} %}}\n# {name}:\n{{{{ {name} }}}}\n{{% endblock %}}\n"
    for name in (*APPENDED, *PREPENDED)
)
"""A base that prints what it is given under the name of the block."""


@pytest.fixture
def built(tmp_path: Path) -> Built:
    """The program of a script, with templates by file name."""

    def build(script: str = MAIN, /, **templates: str) -> str:
        (tmp_path / "main.yml").write_text(script)
        (tmp_path / "templates").mkdir(exist_ok=True)
        for name, text in templates.items():
            (tmp_path / "templates" / f"{name}.tpl.py").write_text(text)
        (text,) = smachac.compile(tmp_path / "main.yml", "python").values()
        return text

    return build


def errors(build: Built, script: str = MAIN, /, **templates: str) -> list[str]:
    """What is said of templates that cannot be printed."""
    with pytest.raises(smachac.ScriptError) as caught:
        build(script, **templates)
    return [item.finding.message for item in caught.value.report]


# Blocks and where they go.


def between(text: str, name: str) -> str:
    """What LABELLED printed for a block."""
    return re.split(r"# [a-z_]+:\n", text.partition(f"# {name}:\n")[2])[0]


@pytest.mark.parametrize("block", [*APPENDED, *PREPENDED])
def test_a_block_goes_to_the_variable_of_its_name(built: Built, block: str) -> None:
    mark = f"{{% block {block} %}}\nof_{{{{ name | lower }}}} = 1\n{{% endblock %}}\n"
    text = built(Base=LABELLED, T=mark if block == "body" else mark + ADDED)
    order = re.findall(r"of_([ab]) = 1", between(text, block))
    assert order == (["b", "a"] if block in PREPENDED else ["a", "b"])
    assert text.count("of_a = 1") == text.count("of_b = 1") == 1


@pytest.mark.parametrize("block", KEYED)
def test_a_header_goes_to_the_container_around(built: Built, block: str) -> None:
    mark = f"{{% block {block} %}}\nof_{{{{ name }}}} = 1\n{{% endblock %}}\n"
    text = built(NESTED, T=CLASS + mark + ADDED)
    order = ["    sm = ", "of_A = 1", "with sm:", "sm_box = ", "of_B = 1", "with sm_box:"]
    places = [text.index(part) for part in order]
    assert places == sorted(places)
    own = "{% block body %}\n# %s\n{{ %s[name] }}\n# the states\n{{ body }}\n{% endblock %}"
    text = built(NESTED, T=CLASS + mark + ADDED, Base=own.replace("%s", block))
    assert "of_A = 1" in text.partition("# the states")[0]
    assert "of_B = 1" in text.partition("# the states")[2]


def test_what_a_container_has_no_block_for_goes_on_to_the_one_around(built: Built) -> None:
    box = "{% block body %}\n# {{ name }}\n{{ body }}\n{% endblock %}"
    mark = "{% block defs %}\nof_{{ name | lower }} = 1\n{% endblock %}\n"
    text = built(NESTED, T=mark + ADDED, StateMachine=box, Base=LABELLED)
    assert re.findall(r"of_\w", between(text, "defs")) == ["of_a", "of_b"]


def test_what_a_container_has_a_block_for_is_its_to_print(built: Built) -> None:
    box = (
        "{% block body %}\n# {{ name }}\n{{ body }}\n{% endblock %}"
        "{% block defs %}\nfirst = 1\n{{ defs }}\nlast = 1\n{% endblock %}"
    )
    mark = "{% block defs %}\nof_{{ name | lower }} = 1\n{% endblock %}\n"
    text = built(NESTED, T=mark + ADDED, StateMachine=box, Base=LABELLED)
    words = re.findall(r"^\w+ = 1$", between(text, "defs"), re.MULTILINE)
    assert words == ["of_a = 1", "first = 1", "of_b = 1", "last = 1"]


def test_a_block_that_prints_nothing_of_the_states_loses_nothing(built: Built) -> None:
    box = "{% block body %}\n{{ body }}\n{% endblock %}{% block defs %}\nown = 1\n{% endblock %}"
    mark = "{% block defs %}\nof_{{ name | lower }} = 1\n{% endblock %}\n"
    text = built(NESTED, T=mark + ADDED, StateMachine=box, Base=LABELLED)
    words = re.findall(r"^\w+ = 1$", between(text, "defs"), re.MULTILINE)
    assert words == ["of_a = 1", "of_b = 1", "own = 1"]


@pytest.mark.parametrize("name", ["StateMachine", "Base"])
def test_a_container_that_does_not_print_its_states_is_told(built: Built, name: str) -> None:
    lost = "{% block body %}\n# no body\n{% endblock %}"
    (message,) = errors(built, NESTED, T=CLASS + ADDED, **{name: lost})
    assert message == "the block `body` does not print `{{ body }}`, so the states are missing"


def test_once_only_code_by_defined_headers(built: Built) -> None:
    text = built(T=CLASS + ADDED)
    assert text.count("class T(smach.State)") == 1
    twice = CLASS.replace("class T", "class T_{{ name }}").replace("'class_T'", "name")
    text = built(T=twice + ADDED.replace("T()", "T_{{ name }}()"))
    assert re.findall(r"class (\w+)\(smach.State\)", text) == ["T_A", "T_B"]


def test_a_base_is_rendered_whole(built: Built) -> None:
    base = "{% set word = 'two' %}one = 1\n{% block defs %}{{ word }} = 2{% endblock %}\n{{ body }}\nend = 3"
    lines = built(Base=base, T=CLASS + ADDED).splitlines()
    assert lines[1:3] + lines[-1:] == ["one = 1", "two = 2", "end = 3"]


# The variables.


def test_every_variable_that_smacha_gave_to_a_state(built: Built) -> None:
    asked = (
        "name class_name parent_name parent_sm_name parent_type parent_template speed slots "
        "userdata input_keys output_keys outcomes remapping transitions callbacks params"
    )
    said = "".join(f"# {word}={{{{ {word} }}}}\n" for word in asked.split())
    script = """\
name: SM
template: Base
outcomes: [done]
params: {side: left}
states:
  - BOX:
      template: StateMachine
      outcomes: [done]
      transitions: {done: done}
      states:
        - A:
            template: T
            params: {own: 1}
            speed: fast
            slots: [1, 2]
            userdata: {k: text}
            input_keys: [k]
            output_keys: [k]
            outcomes: [done]
            remapping: {k: k}
            callbacks: {k: "`lambda ud: 1`"}
            transitions: {done: done}
"""
    text = built(script, T=CLASS + ADDED.replace("smach.{{", f"{said}smach.{{{{", 1))
    found = dict(re.findall(r"# (\w+)=(.*)", text))
    assert found == {
        "name": "A", "class_name": "T", "parent_name": "BOX", "parent_sm_name": "sm_box",
        "parent_type": "StateMachine", "parent_template": "StateMachine", "speed": "fast",
        "slots": "[1, 2]", "userdata": "{'k': 'text'}", "input_keys": "['k']",
        "output_keys": "['k']", "outcomes": "['done']", "remapping": "{'k': 'k'}",
        "transitions": "{'done': 'done'}", "callbacks": "{'k': '`lambda ud: 1`'}",
        "params": "{'side': 'left', 'own': 1}",
    }  # fmt: skip


def test_a_container_and_a_base_see_what_the_script_says_of_them(built: Built) -> None:
    asked = "name outcomes userdata transitions parent_type parent_sm_name"
    said = "".join(f"# box {word}={{{{ {word} }}}}\n" for word in asked.split())
    box = f"{{% block body %}}\n{said}{{{{ body }}}}\n{{% endblock %}}"
    script = NESTED.replace("template: StateMachine", "template: StateMachine\n      ud: {k: 1}")
    script = script.replace("name: SM", "name: SM\nnode_name: n\nmanifest: m\nfunction_name: go")
    words = "name node_name manifest function_name outcomes userdata"
    base = "".join(f"# base {word}={{{{ {word} }}}}\n" for word in words.split()) + LABELLED
    text = built(script + "userdata: {top: 2}\n", T=CLASS + ADDED, StateMachine=box, Base=base)
    assert dict(re.findall(r"# box (\w+)=(.*)", text)) == {
        "name": "BOX", "outcomes": "['done']", "userdata": "{'k': 1}",
        "transitions": "{'done': 'done'}", "parent_type": "StateMachine", "parent_sm_name": "sm",
    }  # fmt: skip
    assert dict(re.findall(r"# base (\w+)=(.*)", text)) == {
        "name": "SM", "node_name": "n", "manifest": "m", "function_name": "go",
        "outcomes": "['done']", "userdata": "{'top': 2}",
    }  # fmt: skip


def test_a_uuid_is_that_of_the_path_in_each_build(built: Built) -> None:
    said = ADDED.replace("smach.{{", "# uuid {{ uuid }}\nsmach.{{", 1)
    first = re.findall(r"# uuid (\w+)", built(T=CLASS + said))
    assert [len(item) for item in first] == [32, 32]
    assert len({*first}) == 2
    assert re.findall(r"# uuid (\w+)", built(T=CLASS + said)) == first
    renamed = re.findall(
        r"# uuid (\w+)",
        built(MAIN.replace("- B", "- C").replace("done: B", "done: C"), T=CLASS + said),
    )
    assert (renamed[0] == first[0], renamed[1] == first[1]) == (True, False)


def test_no_transitions_in_a_concurrence(built: Built) -> None:
    script = """\
name: SM
template: Base
outcomes: [done]
states:
  - ALL:
      template: Concurrence
      outcomes: [done]
      default_outcome: done
      outcome_map: {done: {A: done, BOX: done}}
      transitions: {done: done}
      states:
        - A: {template: T}
        - BOX:
            template: StateMachine
            outcomes: [done]
            states:
              - B: {template: T, transitions: {done: done}}
"""
    said = ADDED.replace("smach.{{", "# {{ name }} {{ transitions is defined }}\nsmach.{{", 1)
    text = built(script, T=CLASS + said)
    assert re.findall(r"# (\w) (True|False)", text) == [("A", "False"), ("B", "True")]
    assert 'smach.Concurrence.add("BOX", sm_box)' in text


def test_a_set_at_the_top_of_a_template_is_its_own(built: Built) -> None:
    top = "{% if name == 'A' %}{% set speed = 'of_a' %}{% endif %}{% set local_vars = ['x'] %}\n"
    said = ADDED.replace("smach.{{", "# {{ name }} {{ speed | default('none') }}\nsmach.{{", 1)
    text = built(T=top + CLASS + said)
    assert re.findall(r"# (\w) (\w+)\n", text) == [("A", "of_a"), ("B", "none")]


# What templates use of one another.


def test_extends_and_super(built: Built) -> None:
    child = '{% extends "T.tpl.py" %}{% block defs %}\n{{ super() }}\nmore = 2\n{% endblock %}'
    parent = "{% block defs %}\nfirst = 1\n{% endblock %}\n"
    text = built(MAIN.replace("template: T", "template: U"), T=parent + CLASS + ADDED, U=child)
    assert re.search(r"first = 1\n+more = 2", text)
    assert text.count("first = 1") == 1


def test_include_brings_the_blocks_of_a_template(built: Built) -> None:
    shared = (
        "{% block imports %}\nimport heapq\n{% endblock %}{% block defs %}\nx = 1\n{% endblock %}"
    )
    text = built(T='{% include "Shared.tpl.py" %}' + CLASS + ADDED, Shared=shared)
    assert text.count("import heapq") == text.count("x = 1") == 1


def test_import_and_from_import(built: Built) -> None:
    macros = "{% macro said(word) %}word_{{ word }}{% endmacro %}"
    used = (
        '{% import "M.tpl.py" as m %}{% from "M.tpl.py" import said %}'
        "{% block defs %}\n{{ m.said('a') }} = {{ said('b') | length }}\n{% endblock %}"
    )
    assert "word_a = 6" in built(T=used + CLASS + ADDED, M=macros)


def test_do_is_there_and_text_outside_of_blocks_is_not_printed(built: Built) -> None:
    loose = "loose = 1\n{% set words = [] %}{% do words.append('said') %}\n"
    mark = "{% block defs %}\n{{ words[0] }} = 1\n{% endblock %}\n"
    text = built(T=loose + mark + CLASS + ADDED)
    assert "said = 1" in text
    assert "loose" not in text


def test_lines_of_statements_are_stripped_and_no_others(built: Built) -> None:
    mark = (
        "{% block defs %}\nif True:\n    {% if name %}\n    x = 1\n    {% endif %}\n{% endblock %}"
    )
    assert "if True:\n\n    x = 1\n" in built(T=mark + CLASS + ADDED)


def test_what_the_user_has_comes_before_what_is_built_in(built: Built, tmp_path: Path) -> None:
    own = "{% block body %}\nown_{{ name }} = {{ time }}\n{% endblock %}"
    script = MAIN.replace("template: T", "template: SleepState, time: 1").replace(
        "done: B", "succeeded: B"
    )
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "SleepState.tpl.py").write_text(own.replace("own", "other"))
    assert "class SleepState(" in built(script.replace("{done: done}", "{succeeded: done}"))
    assert "own_A = 1" in built(script, SleepState=own)
    text = smachac.compile(tmp_path / "main.yml", "python", templates=[tmp_path / "other"])
    assert "other_A = 1" in text["SM.py"]


@pytest.mark.parametrize("include", ['{% include "State.tpl" %}', '{% include "State.tpl.py" %}'])
def test_old_templates_include_state_and_print_their_own_body(built: Built, include: str) -> None:
    script = MAIN.replace("template: T", "template: T, userdata: {k: 1}")
    text = built(script, T=include + CLASS + ADDED)
    assert text.count("smach.StateMachine.add('A'") == 1
    assert text.count('.add("A"') == 0
    assert "sm.userdata.k = 1" in text


def test_state_adds_a_state_with_its_callbacks(built: Built) -> None:
    script = MAIN.replace(
        "template: T",
        "template: T, input_keys: [k], userdata: {k: 1}, callbacks: {k: '`lambda ud: 2`'}",
    )
    init = CLASS.replace("__init__(self)", "__init__(self, input_keys=[], callbacks={})")
    text = built(script, T='{% extends "State.tpl.py" %}' + init)
    assert text.count("_lambda_cb(userdata):") == 2
    assert re.findall(r'callbacks=\{"(k_[ab])_\w{32}_lambda_cb": \1_\w{32}_lambda_cb\}', text) == [
        "k_a",
        "k_b",
    ]


def test_a_name_that_nobody_defines_is_told(built: Built) -> None:
    (message,) = errors(built, T=CLASS + ADDED.replace("'{{ name }}'", "'{{ nmae }}'"))
    assert message == "the template uses `nmae`, which is not defined"


# Utils.

MACROS = {
    "render_userdata('SM', {'b': 1, 'a': 'it'})": 'sm.userdata.a = "it"\nsm.userdata.b = 1',
    "render_outcomes(['b', 'a'])": 'outcomes=["b", "a"]',
    "render_input_keys(['a'], indent=0)": 'input_keys=["a"]',
    "render_output_keys(['a'], indent=0)": 'output_keys=["a"]',
    "render_goal_slots(['a'], indent=0)": 'goal_slots=["a"]',
    "render_result_slots(['a'], indent=0)": 'result_slots=["a"]',
    "render_request_slots(['a'], indent=0)": 'request_slots=["a"]',
    "render_response_slots(['a'], indent=0)": 'response_slots=["a"]',
    "render_transitions({'b': 'B', 'a': 'A'}, indent=0)": 'transitions={"a": "A",\n"b": "B"}',
    "render_remapping({'b': 'B', 'a': 'A'}, indent=0)": 'remapping={"a": "A",\n"b": "B"}',
    "render_outcome_map({'b': {'X': 'x', 'Y': 'y'}, 'a': 'd'}, indent=0)":
        'outcome_map={"a": "d",\n"b": {"X": "x", "Y": "y"}}',
    "render_callbacks('A', 'u', {'k': '`lambda ud: 1`', 'l': 'named'}, indent=0)":
        'callbacks={"k_a_u_lambda_cb": k_a_u_lambda_cb, "named": "named"}',
    "render_def_lambda_callbacks(heads, 'T', 'A', 'u', ['i'], outcomes, {'k': '`lambda ud: 1`', 'l': 'named'})":
        '@smach.cb_interface(input_keys=["i"], output_keys=["k"], outcomes=["succeeded"])\n'
        'def k_a_u_lambda_cb(userdata):\nuserdata["k"] = (lambda ud: 1)(userdata)\nreturn "succeeded"',
    "import_module(heads, 'm')": "import m",
    "import_module_as(heads, 'm', 'n')": "import m as n",
    "from_import(heads, 'm', 'n')": "from m import n",
    "from_import_as(heads, 'm', 'n', 'o')": "from m import n as o",
}  # fmt: skip
"""Calls of macros, and the lines that they print."""


@pytest.mark.parametrize("call", MACROS)
def test_the_macros_of_utils(call: str, tmp_path: Path) -> None:
    name = call.partition("(")[0]
    used = f'{{% from "Utils.tpl.py" import {name} %}}{{% block body %}}{{{{ {call} }}}}{{% endblock %}}'
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "T.tpl.py").write_text(used)
    blocks = Blocks(disk_library(tmp_path / "main.yml", []).template, filters=FILTERS, tests=TESTS)
    heads: list[str] = []
    text = blocks.render("T.tpl.py", "body", {"heads": heads})
    lines = [" ".join(line.split()) for line in text.splitlines() if line.strip()]
    assert "\n".join(lines) == MACROS[call]
    again = blocks.render("T.tpl.py", "body", {"heads": heads})
    assert again.strip() == ("" if "heads" in call else text)


@pytest.mark.parametrize(
    ("value", "answer"),
    [("3", True), ("2.5", True), ("a.b.c", True), ("f(1)", True), ("hi", False), ("'a.b'", False)],
)
def test_not_string_tells_what_is_printed_as_it_is(value: str, answer: bool) -> None:
    assert is_not_string(value) is answer
    assert not is_not_string(ScriptText(value))
    assert is_not_string([1])
    assert is_not_string({"a": 1})


def test_expression_and_exptostr(built: Built) -> None:
    asked = "{% block defs %}\n{% if f is expression %}f = {{ f | exptostr }}{% else %}f = '{{ f }}'{% endif %}\n{% endblock %}"
    for value, line in (("`1 + 1`", "f = 1 + 1"), ("plain", "f = 'plain'")):
        script = MAIN.replace("template: T", f"template: T, f: '{value}'")
        assert line in built(script, T=asked + CLASS + ADDED)


# Meta blocks.


def state_type(tmp_path: Path, meta: str) -> StateType:
    (tmp_path / "templates").mkdir(exist_ok=True)
    code = CLASS.replace("['done']", "outcomes")  # computed, so that the meta block decides
    text = f"{{% block meta %}}\n{meta}{{% endblock meta %}}\n{code}{ADDED}"
    (tmp_path / "templates" / "T.tpl.py").write_text(text)
    library = disk_library(tmp_path / "main.yml", [])
    found = find_state_type("T", library, [])
    assert found is not None
    return found


def test_a_meta_block_is_the_interface(tmp_path: Path) -> None:
    meta = """\
name: T
description: Drives.
language: Python
framework: SMACH
type: State
tags: [core]
includes: [State]
extends: []
variables:
- speed: {description: How fast., type: float, units: m/s, values: [1, 2]}
- - slow:
      description: Whether it crawls.
      type: [bool, str]
- - goal: {description: Where to., type: str}
  - goal_cb: {description: What makes it., type: function}
input_keys:
- pose: {description: Where., type: list of float}
- - frame: {description: In what., type: str}
- tools:
  - left: {type: str}
  - right: {type: str}
output_keys:
- - output: {type: str}
  - msg: {type: str}
outcomes:
- succeeded
- aborted
"""
    found = state_type(tmp_path, meta)
    assert (found.name, found.kind, found.doc) == ("T", "state", "Drives.")
    assert [*found.variables] == ["speed", "slow", "goal", "goal_cb"]
    assert [key.name for key in found.input_keys] == ["pose", "left", "right"]
    assert [key.name for key in found.output_keys] == []
    assert {"input_keys", "output_keys"} <= found.given
    assert [outcome.name for outcome in found.outcomes] == ["succeeded", "aborted"]
    types = {name: str(each.type) for name, each in found.variables.items()}
    # A template prints a number as a text; a type in words is none.
    assert types == {"speed": "float", "slow": "any", "goal": "any", "goal_cb": "any"}
    assert [str(key.type) for key in found.input_keys] == ["list[float]", "str", "str"]


@pytest.mark.parametrize(
    ("kind", "ours"),
    [("Base", "base"), ("Container", "state"), ("State", "state"), ("None", "state")],
)
def test_the_kinds_of_templates(tmp_path: Path, kind: str, ours: str) -> None:
    assert state_type(tmp_path, f"name: T\ntype: {kind}\n").kind == ours


@pytest.mark.parametrize(
    "meta", ["", "nothing", "- a", "variables: 1\n", "outcomes: [{a: {}}, [b]]\n", "input_keys:\n"]
)
def test_a_loose_meta_block_is_read_as_far_as_it_goes(tmp_path: Path, meta: str) -> None:
    assert state_type(tmp_path, meta).name == "T"


@pytest.mark.parametrize(
    "variables",
    ["- a: {default: 2}\n- b: {default: x}", "  {a: {default: 2}, b: {default: x}, c: {default: null}}",
     "- - a: {default: 2}\n- two:\n  - b: {default: x}\n  - c: {type: str}"],
)  # fmt: skip
def test_a_template_gets_the_defaults_of_its_meta_block(built: Built, variables: str) -> None:
    meta = f"{{% block meta %}}\nname: T\nvariables:\n{variables}\n{{% endblock %}}\n"
    body = ADDED.replace("T()", "T({{ a }}, '{{ b }}', {{ c | default(3) }})")
    program = built(MAIN.replace("- B: {template: T,", "- B: {template: T, a: 5,"), T=meta + body)
    assert "T(2, 'x', 3)" in program
    assert "T(5, 'x', 3)" in program


# Sugar around states that their templates add.

META = "{% block meta %}\nname: T\ntype: State\noutcomes: [done, aborted]\n{% endblock %}\n"
FAILING = CLASS.replace("outcomes=['done']", "outcomes=['done', 'aborted']").replace(
    "['done', 'aborted'])\n\n    def execute(self, userdata):\n        return 'done'\n",
    "['done', 'aborted'])\n        self.visits = 0\n\n"
    "    def execute(self, userdata):\n        self.visits += 1\n"
    "        raise_or_say(self.visits)\n"
    "        return 'done' if self.visits == 3 else 'aborted'\n",
)
SAYS = "{% block defs %}\ndef raise_or_say(visits):\n    print('visit', visits)\n{% endblock %}\n"
RAISES = "{% block defs %}\ndef raise_or_say(visits):\n    raise ValueError('no')\n{% endblock %}\n"


def ran(text: str) -> str:
    """The outcome of a program."""
    module = ModuleType("program")
    exec(compile(text, "program.py", "exec"), module.__dict__)
    outcome: str = module.__dict__["main"]()
    return outcome


@pytest.mark.parametrize(
    ("more", "transitions", "outcome"),
    [
        ("retry: {on: [aborted], max: 3}", "done: good, exhausted: bad, preempted: bad", "good"),
        ("retry: {on: [aborted], max: 2}", "done: good, exhausted: bad, preempted: bad", "bad"),
        (
            "retry: {on: [aborted], max: 3, delay: 1ms}",
            "done: good, exhausted: bad, preempted: bad",
            "good",
        ),
        ("timeout: 10s", "done: good, aborted: bad, timeout: good, preempted: bad", "bad"),
        (
            "for_each: {item: x, in: three, on: [aborted]}",
            "done: good, aborted: bad, preempted: bad",
            "good",
        ),
        ("doc: as it is", "done: good, aborted: A", "good"),
    ],
)
def test_sugar_around_a_state_that_its_template_adds(
    built: Built, more: str, transitions: str, outcome: str
) -> None:
    script = (
        "name: SM\ntemplate: Base\noutcomes: [good, bad]\nuserdata: {three: [1, 2, 3]}\nstates:\n"
        f"  - A: {{template: T, {more}, transitions: {{{transitions}}}}}\n"
    )
    assert ran(built(script, T=META + SAYS + FAILING + ADDED)) == outcome


@pytest.mark.parametrize("added", [ADDED, '{% extends "State.tpl.py" %}', "keywords"])
@pytest.mark.parametrize("on", ["on_error: FIX", "error: FIX"])
def test_a_state_that_its_template_adds_catches(built: Built, added: str, on: str) -> None:
    script = f"""\
name: SM
template: Base
outcomes: [good, bad]
{on if on.startswith("on_error") else "doc: no"}
states:
  - A: {{template: T, transitions: {{done: bad, aborted: bad{", error: FIX" if on == "error: FIX" else ""}}}}}
  - FIX: {{template: ScriptedState, outcomes: [done], transitions: {{done: good}}}}
"""
    if added == "keywords":
        added = ADDED.replace("add('{{ name }}', T()", "add(state=T(), label='{{ name }}'")
    extends = added if "extends" in added else ""
    text = built(script, T=extends + META + RAISES + FAILING + ("" if extends else added))
    assert ran(text) == "good"


@pytest.mark.parametrize("inner", ["", ", error: done"], ids=["alone", "and a state in it"])
def test_a_container_that_its_template_adds_catches(built: Built, inner: str) -> None:
    box = (
        "{% from 'Utils.tpl.py' import render_outcomes, render_transitions %}"
        "{% block body %}\nsm_box = smach.StateMachine({{ render_outcomes(outcomes) }})\n"
        "with sm_box:\n    {{ body | indent(4) }}\n\n"
        "smach.{{ parent_type }}.add('{{ name }}', sm_box,\n{{ render_transitions(transitions) }})\n{% endblock %}"
    )
    script = NESTED.replace("{done: done}\n      states", "{done: A, error: done}\n      states")
    script = script.replace(
        "- A: {template: T, transitions: {done: BOX}}",
        "- A: {template: ScriptedState, outcomes: [done], transitions: {done: BOX}}",
    )
    script = script.replace(
        "template: T, transitions: {done: done}",
        f"template: T, transitions: {{done: done, aborted: done{inner}}}",
    )
    text = built(script, T=META + RAISES + FAILING + ADDED, StateMachine=box)
    assert "error_as_outcome(sm_box, " in text
    assert inner or ran(text) == "done"


@pytest.mark.parametrize(
    ("body", "words"),
    [
        (
            "state = T()\nsmach.StateMachine.add(*['A', state])",
            "prints no line `smach.{{ parent_type }}.add('{{ name }}', ...)`",
        ),
        (
            "smach.StateMachine.add('A', T(), transitions={'done': 'done'})",
            "does not print the transition of `error`",
        ),
    ],
)
def test_what_cannot_be_wrapped_is_told(built: Built, body: str, words: str) -> None:
    script = MAIN.replace("transitions: {done: B}", "transitions: {done: B, aborted: B, error: B}")
    script = script.replace("B: {template: T,", "B: {template: ScriptedState, outcomes: [done],")
    (message,) = errors(
        built, script, T=f"{META}{FAILING}{{% block body %}}\n{body}\n{{% endblock %}}"
    )
    assert (
        message == f"the template of `T` {words}, so `A` cannot have an outcome for its exceptions"
    )


# Callbacks.


CALLED = """\
{% extends "State.tpl.py" %}
{% from "Utils.tpl.py" import render_init_callbacks, render_execute_callbacks %}
{% block defs %}
{% if 'callbacks_of_T' not in defined_headers %}
@smach.cb_interface(input_keys=["n"], output_keys=["n"], outcomes=["done"])
def with_state(self, userdata):
    userdata.n = userdata.n + self.step

def plain_with_state(self, userdata):
    userdata["n"] = userdata["n"] + self.step
{% do defined_headers.append('callbacks_of_T') %}
{% endif %}
{% endblock defs %}
{% block class_defs %}
class T(smach.State):
    def __init__(self, callbacks=(), step=10, input_keys=(), output_keys=()):
        smach.State.__init__(self, ['done'], list(input_keys), list(output_keys))
        self.step = step
        {{ render_init_callbacks() }}

    def method(self, userdata):
        userdata["n"] = userdata["n"] + self.step

    @smach.cb_interface(input_keys=["n"], output_keys=["n"], outcomes=["done"])
    def declared(self, userdata):
        userdata.n = userdata.n + self.step

    def execute(self, userdata):
        {{ render_execute_callbacks() }}
        return 'done'
{% endblock class_defs %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', T({{ render_callbacks(name, uuid, callbacks, indent=0) }},
{{ render_input_keys(input_keys) }},
{{ render_output_keys(output_keys) }}),
{{ render_transitions(transitions) }}{% if remapping is defined %},
{{ render_remapping(remapping) }}{% endif %})
{% endblock body %}
"""

CALLING = """\
name: SM
template: Base
outcomes: [done]
userdata: {n: 1}
states:
  - A:
      template: T
      outcomes: [done]
      input_keys: [n]
      output_keys: [n]
      callbacks: {n: %s}
      transitions: {done: done}
"""


@pytest.mark.parametrize(
    ("callback", "result"),
    [
        ("with_state", 11),
        ("plain_with_state", 11),
        ("method", 11),
        ("declared", 11),
        ("'`lambda ud: ud.n + 5`'", 6),
        ("'lambda ud: ud.n + 6'", 7),
    ],
)
def test_callbacks_of_each_kind_are_called(built: Built, callback: str, result: int) -> None:
    """State.tpl hands its macros on, and the outcomes of a lambda are those of its state."""
    text = built(CALLING % callback, T=CALLED)
    module: dict[str, object] = {"__name__": "sm"}
    exec(text, module)
    machine = module["build"]()  # type: ignore[operator]
    assert machine.execute() == "done"
    assert machine.userdata.n == result
    assert machine["A"].get_registered_outcomes() == ("done",)


# Classes and their meta blocks.


DOCUMENTED = """\
{% block meta %}
name: T
type: State
input_keys: []
output_keys: []
outcomes:
- succeeded
{% endblock meta %}
{% block class_defs %}
class T(smach.State):
    def __init__(self, interfaces=None, input_keys=['limb', 'pose'], output_keys=['seen']):
        smach.State.__init__(self, outcomes=['succeeded', 'preempted'], input_keys=input_keys,
                             output_keys=output_keys)

    def execute(self, userdata):
        return 'preempted' if self.preempt_requested() else 'succeeded'
{% endblock %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', T({% if input_keys is defined %}input_keys={{ input_keys }}{% endif %}), transitions={{ transitions }})
{% endblock %}
"""


def test_a_class_is_believed_where_its_meta_block_differs(tmp_path: Path) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "T.tpl.py").write_text(DOCUMENTED)
    path = tmp_path / "main.yml"
    head = "name: SM\ntemplate: Base\noutcomes: [done]\nuserdata: {pose: 1}\nstates:\n"
    path.write_text(head + "  - A: {template: T, transitions: {succeeded: done}}\n")
    found = [(item.code, item.span.line, item.span.source.name) for item in smachac.check(path)]
    assert found == [("SM104", 6, str(path)), ("SM301", 6, str(path))]
    path.write_text(
        head
        + "  - A: {template: T, input_keys: [pose], transitions: {succeeded: done, preempted: done}}\n"
    )
    assert [item.code for item in smachac.check(path) if item.code == "SM301"] == []
    type_ = find_state_type("T", disk_library(path, []), [])
    assert type_ is not None
    assert [outcome.name for outcome in type_.outcomes] == ["succeeded", "preempted"]


PLAIN = """\
{% block class_defs %}
class Go(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=['ok'], input_keys=['pose'])

    def execute(self, userdata):
        return 'ok' if userdata.pose else 'ok'
{% endblock class_defs %}
{% block body %}
smach.{{ parent_type }}.add('{{ name }}', Go()PARTS)
{% endblock body %}
"""


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ("", ["remapping", "transitions"]),
        (", transitions={{ transitions }}", ["remapping"]),
        (", transitions={{ transitions }}, remapping={{ remapping }}", []),
        (", transitions={'ok': 'done'}, remapping={'pose': 'at'}", []),
    ],
)
def test_a_template_that_does_not_print_what_the_script_has(
    tmp_path: Path, parts: str, words: list[str]
) -> None:
    (tmp_path / "templates").mkdir()
    (tmp_path / "templates" / "Go.tpl.py").write_text(PLAIN.replace("PARTS", parts))
    path = tmp_path / "main.yml"
    path.write_text(
        "name: SM\ntemplate: Base\noutcomes: [done]\nuserdata: {at: 1}\nstates:\n"
        "  - A: {template: Go, remapping: {pose: at}, transitions: {ok: done}}\n"
    )
    found = [item.finding.arguments[0] for item in smachac.check(path) if item.code == "SM605"]
    assert found == words
