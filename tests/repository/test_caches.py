"""What a process keeps beyond a call: the caches and growing collections of modules, with reasons.

A fact belongs to the value that it is about: as a field, a cached property or an entry of a
`Context`. A module may keep only what CONTRIBUTING.md, Caches, allows.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

from tests.repository.test_layout import modules, name

LATE = "a constant that is made at its first use"
TEXT = "a function of texts, names or types alone, with a bound; its readers share no value"
RUN = "of generated programs and the simulation: what a process may have once"

KEPT: Mapping[str, str] = {
    "smachac/grammars/__init__.py: parser_of": LATE,
    "smachac/sim/physics.py: pybullet": LATE,
    "smachac/ir/script_code.py: script_code": TEXT,
    "smachac/ir/types.py: parse_type": TEXT,
    "smachac/analysis/type_lattice.py: misfit": TEXT,
    "smachac/diagnostics/diagnostic.py: _nearest": TEXT,
    "smachac/diagnostics/spelling.py: guesser_of": TEXT,
    "smachac/runtime/smach/user_data.py: _with_properties": RUN,
    "smachac/runtime/tracing/instrument.py: _traced_userdata_class": RUN,
    "smachac/runtime/smach_ros/messages.py: message": RUN,
    "smachac/runtime/smach_ros2/transform_states.py: _LISTENERS": RUN,
    "smachac/runtime/signals.py: received": RUN,
    "smachac/sim/world.py: _open_worlds": RUN,
    "smachac/sim/loading.py: _tried": RUN,
}
"""Each cache of a function and each collection that grows, by module and name."""

CACHES = {"cache", "lru_cache"}
GROWING = {"dict", "list", "set", "deque", "defaultdict", "Counter"}


def kept_in(tree: ast.Module) -> Iterator[str]:
    """The functions and methods with a cache, and the empty collections, of a module."""
    for statement in tree.body:
        match statement:
            case ast.FunctionDef() if is_cached(statement):
                yield statement.name
            case ast.ClassDef(name=owner, body=body):
                for method in body:
                    if isinstance(method, ast.FunctionDef) and is_cached(method):
                        yield f"{owner}.{method.name}"
            case ast.Assign(targets=[ast.Name(id=variable)], value=value):
                if is_cache(value) or is_empty(value):
                    yield variable
            case ast.AnnAssign(target=ast.Name(id=variable), value=ast.expr() as value):
                if is_cache(value) or is_empty(value):
                    yield variable


def is_cached(function: ast.FunctionDef) -> bool:
    return any(called(decorator) in CACHES for decorator in function.decorator_list)


def is_cache(value: ast.expr) -> bool:
    """Whether a value is a function with a cache: `cache(f)` or `lru_cache(maxsize=9)(f)`."""
    return isinstance(value, ast.Call) and called(value.func) in CACHES


def is_empty(value: ast.expr) -> bool:
    """Whether a value is a collection without entries, which only later calls can fill."""
    match value:
        case ast.Dict(keys=[]) | ast.List(elts=[]):
            return True
        case ast.Call(args=[], keywords=[]):
            word = called(value)
            return word in GROWING or word.startswith("Weak")
    return False


def called(value: ast.expr) -> str:
    """The last word of a name, or of what is called."""
    return ast.unparse(value.func if isinstance(value, ast.Call) else value).rpartition(".")[2]


def test_modules_keep_only_what_is_listed() -> None:
    found = [
        f"{name(path)}: {kept}"
        for path in modules()
        for kept in kept_in(ast.parse(path.read_text("utf-8")))
    ]
    assert sorted(found) == sorted(KEPT)


def test_contributing_names_the_kinds_of_caches() -> None:
    page = (Path(__file__).parents[2] / "CONTRIBUTING.md").read_text("utf-8")
    assert "tests/repository/test_caches.py" in page


@pytest.mark.parametrize(
    "text",
    [
        "@cache\ndef kept(): ...",
        "@functools.lru_cache(maxsize=9)\ndef kept(): ...",
        "kept = functools.cache(work)",
        "kept = lru_cache(maxsize=9)(work)",
        "kept: dict[str, int] = {}",
        "kept = defaultdict()",
        "kept: WeakKeyDictionary[Node, int] = weakref.WeakKeyDictionary()",
    ],
)
def test_what_a_module_keeps_is_found(text: str) -> None:
    assert list(kept_in(ast.parse(text))) == ["kept"]
    assert list(kept_in(ast.parse("class A:\n    @cache\n    def f(self): ..."))) == ["A.f"]


@pytest.mark.parametrize(
    "text",
    [
        "class A:\n    @cached_property\n    def f(self): ...",
        "def f():\n    known = cache(work)\n    found = {}",
        "TABLE = {'a': 1}",
        "NONE: frozenset[str] = frozenset()",
    ],
)
def test_what_a_value_or_a_call_keeps_is_fine(text: str) -> None:
    assert list(kept_in(ast.parse(text))) == []
