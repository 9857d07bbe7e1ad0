"""The keys that a path skips, against every run of the same function."""

from __future__ import annotations

from itertools import count, product
from textwrap import indent
from types import SimpleNamespace

from hypothesis import given
from hypothesis import strategies as st

from smachac.ir.class_facts import Ending
from tests.pysource.test_class_reader import known

CHOICES = 7
"""The number of conditions and exceptions that a run decides freely; the later ones are false."""


class FailedError(Exception):
    """What the called functions raise."""


def _if(parts: tuple[str, str]) -> str:
    return f"if c(NUMBER):\n{indent(parts[0], ' ')}\nelse:\n{indent(parts[1], ' ')}"


def _loop(parts: tuple[str, str]) -> str:
    return f"for _ in items:\n{indent(parts[0], ' ')}\nelse:\n{indent(parts[1], ' ')}"


def _try(parts: tuple[str, str]) -> str:
    return f"try:\n{indent(parts[0], ' ')}\nexcept FailedError:\n{indent(parts[1], ' ')}"


def _block(statements: list[str]) -> str:
    return "\n".join(statements)


SIMPLE = st.sampled_from(
    ["userdata.a = f(NUMBER)", "userdata.b = 1", "pass", "f(NUMBER)", "return 'NUMBER'"]
)
BLOCKS = st.recursive(
    st.lists(SIMPLE, min_size=1, max_size=3).map(_block),
    lambda inner: st.lists(
        st.one_of(
            SIMPLE,
            st.tuples(inner, inner).map(_if),
            st.tuples(inner, inner).map(_loop),
            st.tuples(inner, inner).map(_try),
            inner.map(lambda body: f"if c(NUMBER):\n{indent(body, ' ')}\n continue"),
            inner.map(lambda body: f"if c(NUMBER):\n{indent(body, ' ')}\n break"),
        ),
        min_size=1,
        max_size=3,
    ).map(_block),
    max_leaves=8,
)


def numbered(text: str) -> str:
    """Each return with an outcome of its own."""
    numbers = count()
    parts = text.split("NUMBER")
    return "".join(part + str(next(numbers)) for part in parts[:-1]) + parts[-1]


def runs(text: str) -> dict[str, list[set[str]]]:
    """The keys that are set at each outcome, in every run. A loop has one round or two."""
    code = compile(f"def execute(userdata):\n{indent(text, ' ')}", "execute", "exec")
    found: dict[str, list[set[str]]] = {}
    for items in ([1], [1, 2]):
        for bits in product([False, True], repeat=CHOICES):
            left = iter(bits)

            def decide(_: int, left: object = left) -> bool:
                return next(left, False)  # type: ignore[call-overload, no-any-return]

            def work(_: int, left: object = left) -> None:
                if next(left, False):  # type: ignore[call-overload]
                    raise FailedError

            names = {"c": decide, "f": work, "items": items, "FailedError": FailedError}
            exec(code, names)
            userdata = SimpleNamespace()
            try:
                outcome = names["execute"](userdata)  # type: ignore[operator]
            except FailedError:
                continue
            found.setdefault(outcome, []).append(set(vars(userdata)))
    return found


def is_python(text: str) -> bool:
    try:
        compile(f"def execute(userdata):\n{indent(text, ' ')}", "execute", "exec")
    except SyntaxError:  # `break` outside a loop
        return False
    return True


def endings(text: str) -> tuple[Ending, ...]:
    return known(text).endings


@given(BLOCKS.map(lambda text: numbered(text + "\nreturn 'NUMBER'")).filter(is_python))
def test_a_run_ends_without_each_skipped_key(text: str) -> None:
    seen = runs(text)
    for ending in endings(text):
        sets = seen.get(ending.outcome.text, [])
        for key, _ in ending.skipped:
            assert any(key not in keys for keys in sets), (key, ending.outcome.text)


@given(BLOCKS.map(lambda text: numbered(text + "\nreturn 'NUMBER'")).filter(is_python))
def test_no_run_sets_a_key_that_the_reader_excludes(text: str) -> None:
    seen = runs(text)
    for ending in endings(text):
        for keys in seen.get(ending.outcome.text, []):
            assert ending.written is not None
            assert keys <= ending.written


def test_the_body_of_a_nested_loop_is_judged_once_for_each_level() -> None:
    """Otherwise the time doubles with each of the sixty levels, and this test does not end."""
    depth = 60
    loops = "".join(f"{' ' * level}for _ in items:\n" for level in range(depth))
    (ending,) = known(f"{loops}{' ' * depth}userdata.a = 1\nreturn 'x'").endings
    assert ending.written == frozenset("a")
    assert ending.skipped == ()
