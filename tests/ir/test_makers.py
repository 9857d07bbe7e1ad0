"""Objects of a quick maker are those of the frozen dataclass."""

from __future__ import annotations

import pickle
from dataclasses import FrozenInstanceError, dataclass, field, fields, replace

import pytest

from smachac.diagnostics.source import Source, Span
from smachac.ir.makers import make_leaf, make_outcome, make_transition, maker_of
from smachac.ir.nodes import Leaf, Outcome, Transition

HERE = Span(Source("a.yml", "text"), 0, 4)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Named:
    name: str
    known: dict[str, int] = field(default_factory=dict)


make_named = maker_of(_Named)


def test_a_made_object_is_one_of_the_class() -> None:
    made = make_transition(outcome="done", target="END", span=HERE)
    assert type(made) is Transition
    assert made == Transition(outcome="done", target="END", span=HERE)
    assert hash(made) == hash(Transition(outcome="done", target="END", span=HERE))
    assert repr(made) == repr(Transition(outcome="done", target="END", span=HERE))


def test_every_field_has_its_value_or_its_default() -> None:
    made = make_leaf(name="A", type="T", span=HERE, outcomes=(make_outcome(name="x", span=HERE),))
    own = Leaf(name="A", type="T", span=HERE, outcomes=(Outcome(name="x", span=HERE),))
    for each in fields(Leaf):
        assert getattr(made, each.name) == getattr(own, each.name)


def test_a_made_object_is_frozen() -> None:
    made = make_leaf(name="A", type="T", span=HERE)
    with pytest.raises(FrozenInstanceError):
        made.name = "B"  # type: ignore[misc]
    with pytest.raises(FrozenInstanceError):
        del made.name


def test_a_made_object_can_be_replaced_and_pickled() -> None:
    made = make_named(name="a", known={"b": 1})
    assert replace(made, name="c") == _Named(name="c", known={"b": 1})
    copy = pickle.loads(pickle.dumps(made))
    assert type(copy) is _Named
    assert copy == made


def test_each_object_has_a_default_of_its_own() -> None:
    assert make_named(name="a").known is not make_named(name="a").known


def test_wrong_arguments_are_errors() -> None:
    with pytest.raises(TypeError, match="span"):
        make_outcome(name="x")  # type: ignore[call-arg]
    with pytest.raises(TypeError, match="colour"):
        make_outcome(name="x", span=HERE, colour="red")  # type: ignore[call-arg]
