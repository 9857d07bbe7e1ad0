"""What is told of the Python code of a state type without running it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from textwrap import indent

import pytest
from hypothesis import given
from hypothesis import strategies as st

import smachac.stdlib
from smachac.diagnostics.diagnostic import Report
from smachac.diagnostics.source import Source
from smachac.frontend.files import disk_library
from smachac.frontend.types.state_types import find_state_type
from smachac.ir.class_facts import ClassFacts
from smachac.pysource.class_reader import read_template
from tests.trust.project_text import analysed

TEMPLATE = """{{% block class_defs %}}
class Pick(smach.State):
    '''Größe {{{{ not_code }}}}'''
    def __init__(self):
        super().__init__(outcomes=["done"])

    def execute(self, userdata):
{}
{{% endblock %}}
"""


LIBRARY = disk_library(Path("main.yml"), [])


def body(code: str) -> ClassFacts | None:
    return read_template(
        Source("Pick.tpl.py", TEMPLATE.format(indent(code, " " * 8))), "Pick", LIBRARY
    )


def known(code: str) -> ClassFacts:
    found = body(code)
    assert found is not None
    return found


@pytest.mark.parametrize(
    ("code", "returns"),
    [
        ("return 'done'", ["done"]),
        ("return 'a' if x else 'b' if y else z", ["a", "b"]),
        ("return", ["None"]),
        ("return None", ["None"]),
        ("return True", ["True"]),
        ("return outcome_of(self)", []),
        ("return '{{ outcome }}'", []),
        ("return 'a' if {{ x }} else 'b'", ["a", "b"]),
        ("def inner():\n    return 'a'\nf = lambda: 'c'\nreturn 'b'", ["b"]),
        ("for x in y:\n    return 'a'\nwith z:\n    return 'b'", ["a", "b"]),
        ("try:\n    pass\nexcept E:\n    return 'a'\nreturn 'b'", ["a", "b"]),
        ("match x:\n    case 1:\n        return 'a'\nreturn 'b'", ["a", "b"]),
    ],
)
def test_constants_that_are_returned(code: str, returns: list[str]) -> None:
    found = known(code)
    assert [word.text for word in found.returns] == returns
    for word in found.returns:
        assert word.span.text in (f"'{word.text}'", word.text, "return")


@pytest.mark.parametrize(
    ("code", "silent"),
    [
        ("return 'a'", False),
        ("pass", True),
        ("if x:\n    return 'a'", True),
        ("if x:\n    return 'a'\nelse:\n    raise E", False),
        ("if x:\n    return 'a'\nelif y:\n    return 'b'", True),
        ("while True:\n    if x:\n        return 'a'", False),
        ("while 1:\n    if x:\n        break", True),
        ("while True:\n    for x in y:\n        break", False),
        ("while True:\n    for x in y:\n        pass\n    else:\n        break", True),
        ("while x:\n    return 'a'", True),
        ("while x:\n    pass\nelse:\n    return 'a'", False),
        ("for x in y:\n    return 'a'", True),
        ("for x in y:\n    break\nelse:\n    return 'a'", True),
        ("with x:\n    return 'a'", False),
        ("try:\n    return 'a'\nexcept E:\n    pass", True),
        ("try:\n    return 'a'\nexcept E:\n    return 'b'", False),
        ("try:\n    x()\nexcept E:\n    return 'b'\nelse:\n    return 'a'", False),
        ("try:\n    x()\nfinally:\n    return 'b'", False),
        ("match x:\n    case 1:\n        return 'a'\n    case _:\n        return 'b'", False),
        ("match x:\n    case 1:\n        return 'a'\n    case _ if y:\n        return 'b'", True),
        ("match x:\n    case 1:\n        return 'a'", True),
        ("sys.exit(1)", False),
        ("assert False, 'never'", False),
        ("for x in itertools.count():\n    if x:\n        return 'a'", False),
        ("for x in itertools.count():\n    break", True),
        ("for n, x in enumerate(itertools.repeat(1), 2):\n    return 'a'", False),
        ("for x in itertools.repeat(1, 3):\n    return 'a'", True),
        ("for x in count():\n    return 'a'", True),
        ("if x:\n    return 'a'\nraise_error(x)", False),
        ("if x:\n    return 'a'\nassert_never(x)", False),
        (
            "match x:\n    case True:\n        return 'a'\n    case False:\n        return 'b'",
            False,
        ),
        ("match x:\n    case True:\n        return 'a'\n    case None:\n        return 'b'", True),
        ("match x:\n    case True | False:\n        pass", True),
        (
            "match x:\n    case Found(y):\n        raise A\n    case Lost():\n        return b",
            False,
        ),
        ("match x:\n    case Found(1):\n        return 'a'", True),
        ("match x:\n    case other.A:\n        return 'a'", False),
        (
            "match x, y:\n    case 1, _:\n        return 'a'\n    case _, z:\n        return 'b'",
            False,
        ),
        ("match x:\n    case 1, _:\n        return 'a'\n    case _, z:\n        return 'b'", True),
        # What Jinja fills in may be a return.
        ("{{ body }}", False),
    ],
)
def test_ways_without_an_outcome(code: str, silent: bool) -> None:
    found = known(code)
    assert found.silent == silent
    assert found.execute is not None
    if found.silent:
        assert found.execute.text == "execute"
        assert found.always_silent == ("return" not in code)


HELPERS = """
class Mode(enum.Enum):
    FAST = enum.auto()
    SLOW = "slow"

def give_up(why):
    print(why)
    raise RuntimeError(why)

def perhaps(why):
    if why:
        raise RuntimeError(why)

from itertools import count, cycle

{% endblock %}
"""


@pytest.mark.parametrize(
    ("code", "silent"),
    [
        ("match x:\n    case Mode.FAST:\n     raise A\n    case Mode.SLOW:\n     raise B", False),
        ("match x:\n    case Mode.FAST | Mode.SLOW:\n        return 'a'", False),
        ("match x:\n    case Mode.FAST:\n        return 'a'", True),
        ("match x:\n    case Mode.FAST:\n     return\n    case Mode.SLOW if y:\n     return", True),
        ("if x:\n    return 'a'\ngive_up(x)", False),
        ("if x:\n    return 'a'\nperhaps(x)", True),
        ("if x:\n    return 'a'\nself.never(x)", False),
        ("if x:\n    return 'a'\nself.later(x)", True),
        ("for x in count(1):\n    return 'a'", False),
        ("for x in cycle(y):\n    pass", False),
    ],
)  # fmt: skip
def test_helpers_that_never_return_and_cases_that_are_all(code: str, silent: bool) -> None:
    methods = """
    def never(self, why):
        while True:
            give_up(why)

    def later(self, why):
        return give_up
"""
    text = TEMPLATE.format(indent(code, " " * 8)).replace("{% endblock %}\n", methods + HELPERS)
    found = read_template(Source("Pick.tpl.py", text), "Pick", LIBRARY)
    assert found is not None
    assert found.silent == silent


@pytest.mark.parametrize(
    ("code", "reads", "writes"),
    [
        ("x = userdata.a + userdata['b']", ["a", "'b'"], []),
        ("userdata.a = userdata['b'] = 1", [], ["a", "'b'"]),
        ("userdata.a += 1", ["a"], ["a"]),
        ("userdata.a.append(userdata.b[0])", ["a", "b"], []),
        ("f = lambda: userdata.a", ["a"], []),
        ("f = lambda userdata: userdata.a", [], []),
        ("userdata = {}\nuserdata['a'] = 1", [], []),
        ("userdata[key] = userdata.keys() + optional(userdata, 'c')", [], []),
        ("if 'a' in userdata:\n    x = userdata.a", [], []),
        ("try:\n    x = userdata.a\nexcept KeyError:\n    userdata.b = 1", [], ["b"]),
        ("x = userdata.{{ key }} + userdata['{{ key }}']", [], []),
        ("x = 'ß'; y = userdata.ä", ["ä"], []),
    ],
)
def test_keys(code: str, reads: list[str], writes: list[str]) -> None:
    found = known(f"{code}\nreturn 'done'")
    assert [word.span.text for word in found.reads] == reads
    assert [word.span.text for word in found.writes] == writes


@pytest.mark.parametrize(
    "text",
    [
        "",
        "def execute(self, userdata): pass",
        "class A:\n  def execute(self): pass",
        "class A:\n  @timed\n  def execute(self, ud): pass",
        "class A:\n  async def execute(self, ud): pass",
        "class A:\n  def execute(self, ud): yield 1",
        "class A:\n  execute = other\nclass B: pass",
        "class A:\n  def execute(self, ud): pass\nclass B:\n  def execute(self, ud): pass",
        "class A:\n  if x:\n    def execute(self, ud): pass",
        "class Pick:\n  def execute(self, ud):\n    {% if x %}\n    return 1\n    {% endif %}",
        "class Pick:\n  def execute(self, ud):\n    {% raw %}\n    return '{{'\n    {% endraw %}",
        "{% for x in y %}\nclass Pick:\n{% endfor %}\n  def execute(self, ud) return",
        "class Pick:\r  def execute(self, ud):\r    return 1",
        "class Pick:\n  def execute(self, ud):\n    return " + "(" * 5000,
    ],
)
def test_what_cannot_be_told(text: str) -> None:
    found = read_template(Source("Pick.tpl.py", text), "Pick", LIBRARY)
    assert found is None or found.execute is None


def test_one_class_of_several_is_that_of_the_name() -> None:
    text = "".join(
        f"class {name}:\n  def execute(self, ud):\n    return '{name}'\n" for name in ("A", "Pick")
    )
    found = read_template(Source("Pick.tpl.py", text), "Pick", LIBRARY)
    assert found is not None
    assert [word.text for word in found.returns] == ["Pick"]


@given(st.text(alphabet="{%}#\n\r \"'():=ü", max_size=40), st.text(max_size=10))
def test_any_text_is_read(code: str, name: str) -> None:
    found = read_template(Source("x", code), name, LIBRARY)
    body(code)
    assert found is None or {word.span.source.name for word in found.returns} <= {"x"}


def test_our_own_state_types_are_read() -> None:
    import smachac

    folder = Path(smachac.__file__).parent / "stdlib"
    found = {
        path.name.removesuffix(".tpl.py"): read_template(
            Source(path.name, path.read_text("utf-8")), path.name.removesuffix(".tpl.py"), LIBRARY
        )
        for path in folder.glob("*State.tpl.py")
        if "def execute(" in path.read_text("utf-8") and "block body" not in path.read_text("utf-8")
    }
    assert len(found) > 10
    assert None not in found.values()


def _built_in_types() -> list[str]:
    folder = Path(smachac.stdlib.__path__[0])
    return sorted(path.stem for path in folder.glob("*.yml"))


@pytest.mark.parametrize("name", _built_in_types())
def test_the_classes_of_built_in_types_do_what_their_interfaces_state(name: str) -> None:
    """A check does not read these classes, so this test does: the interface is made one of the
    user."""
    unread = find_state_type(name, LIBRARY, [])
    assert unread is not None
    assert unread.class_facts is None
    own = replace(LIBRARY, own_template=lambda file: LIBRARY.template(file))
    report: Report = []
    found = find_state_type(name, own, report)
    assert found is not None
    assert report == []
    facts = found.class_facts
    if facts is None:
        return
    assert facts.faults == ()
    outcomes = {each.name for each in found.outcomes} | found.optional
    if "outcomes" not in found.given:
        assert {word.text for word in facts.returns} <= outcomes
    if "output_keys" not in found.given:
        assert {word.text for word in facts.writes} <= {key.name for key in found.output_keys}


def test_the_classes_of_most_built_in_types_can_be_read() -> None:
    own = replace(LIBRARY, own_template=lambda file: LIBRARY.template(file))
    types = [find_state_type(name, own, []) for name in _built_in_types()]
    assert sum(each is not None and each.class_facts is not None for each in types) >= 10


@pytest.mark.parametrize(
    "body",
    [
        '{% block body %}{{ add("Say") }}{% endblock %}',
        '{% block body %}\n{{ add("Say") }}\n{% endblock %}',
        "{% if a %}{% set b = 1 %}x = 1{% endif %}",
        "",
    ],
)
def test_a_class_is_read_beside_a_block_in_one_line(body: str) -> None:
    text = (
        '{% extends "State.tpl.py" %}\n{% block class_defs %}\nclass Say(smach.State):\n'
        '    def execute(self, userdata):\n        return "sad"\n{% endblock %}\n'
    )
    files = {
        "main.yml": "name: sm\noutcomes: [said]\nstates:\n  - SAY: {template: Say}\n",
        "templates/Say.tpl.py": text + body,
        "templates/Say.yml": "name: Say\noutcomes: {said: {}}\n",
    }
    found = [each for each in analysed(files).report if each.code == "SM309"]
    assert [each.span.text for each in found] == ['"sad"']
