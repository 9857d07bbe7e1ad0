"""UserData and Remapper: rules U1 to U5 and R1 to R10."""

from __future__ import annotations

import copy
import enum
import pickle
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from smachac.runtime import smach
from tests.support.examples import examples

KEYS = st.sampled_from(["a", "b", "c", "d", "keys"])


def store(**values: object) -> smach.UserData:
    ud = smach.UserData()
    for key, value in values.items():
        ud[key] = value
    return ud


def content(ud: smach.UserData) -> dict[str, object]:
    return dict(ud)


def test_items_and_attributes_are_the_same_store() -> None:
    ud = smach.UserData()
    ud.a, ud["b"] = 1, 2
    assert (ud["a"], ud.b) == (1, 2)
    assert "a" in ud
    assert "z" not in ud
    assert ud.keys() == ["a", "b"]
    ud.update(store(b=3, c=4))
    assert content(ud) == {"a": 1, "b": 3, "c": 4}


def test_a_store_is_no_mapping() -> None:
    ud = store(a=1)
    misuses: list[Callable[[Any], object]] = [len, iter]
    for misuse in misuses:
        with pytest.raises(TypeError):
            misuse(ud)
    with pytest.raises(AttributeError):
        del ud["a"]
    for name in ("get", "items", "values"):
        with pytest.raises(KeyError):
            getattr(ud, name)


def test_names_of_methods_are_readable_by_item_only() -> None:
    ud = smach.UserData()
    ud.keys = "mine"  # type: ignore[method-assign, assignment]
    assert ud["keys"] == "mine"
    assert ud.keys() == ["keys"]


def test_absent_keys_raise_key_error(monkeypatch: pytest.MonkeyPatch) -> None:
    errors: list[str] = []
    monkeypatch.setattr(smach, "logerr", errors.append)
    ud = smach.UserData()
    reads: list[Callable[[], object]] = [
        lambda: ud["k"],
        lambda: ud.k,
        lambda: hasattr(ud, "k"),
        lambda: getattr(ud, "k", 0),
    ]
    for read in reads:
        with pytest.raises(KeyError) as caught:
            read()
        assert str(caught.value) == "userdata key 'k' is absent; present: []"
    assert not errors
    monkeypatch.setattr(smach, "compat", True)
    for read in reads:
        with pytest.raises(KeyError):
            read()
    assert len(errors) == 4
    assert all("'k'" in error for error in errors)


def test_underscore_names_belong_to_the_object() -> None:
    ud = smach.UserData()
    ud._hidden = 1
    assert ud._hidden == 1
    assert ud.keys() == []
    with pytest.raises(AttributeError):
        _ = ud._other


def test_extract_and_merge_rename_and_copy() -> None:
    ud = store(outer=[1], same=2)
    inner = ud.extract(["outer", "same"], {"inner": "outer"})
    assert content(inner) == {"inner": [1], "same": 2}
    assert inner.inner is not ud.outer
    ud.merge(inner, ["inner"], {"inner": "back"})
    assert ud.back == [1]
    with pytest.raises(KeyError):
        ud.extract(["absent"], {})


def test_extract_logs_a_map_that_has_no_inverse(monkeypatch: pytest.MonkeyPatch) -> None:
    errors: list[str] = []
    monkeypatch.setattr(smach, "logerr", errors.append)
    store(x=1).extract(["x"], {"a": "x", "b": "x"})
    assert len(errors) == 1


def test_copy_shares_the_store_and_deep_copy_and_pickle_do_not() -> None:
    ud = store(a=[1])
    copy.copy(ud).b = 2
    assert ud.b == 2
    for other in (copy.deepcopy(ud), pickle.loads(pickle.dumps(ud))):
        other.a.append(5)
        assert ud.a == [1]
        assert other.b == 2


def test_a_view_reads_inputs_and_writes_outputs() -> None:
    ud = store(x=1, y=2, both=3)
    view = smach.Remapper(ud, ["x", "both"], ["out", "both"], {})
    assert (view.x, view["x"], view.both) == (1, 1, 3)
    view.out, view["both"] = 4, 5
    assert (ud.out, ud.both, view.both) == (4, 5, 5)
    reads: list[Callable[[], object]]
    reads = [lambda: view.out, lambda: view["y"], lambda: hasattr(view, "y")]
    for read in reads:
        with pytest.raises(smach.InvalidUserCodeError):
            read()


def test_undeclared_writes_are_logged_and_dropped(monkeypatch: pytest.MonkeyPatch) -> None:
    errors: list[str] = []
    monkeypatch.setattr(smach, "logerr", errors.append)
    ud = store(x=1)
    view = smach.Remapper(ud, ["x"], ["y"], {})
    view.x = 5
    view["z"] = 6
    assert content(ud) == {"x": 1}
    assert len(errors) == 2


def test_absent_inputs_raise_key_error() -> None:
    view = smach.Remapper(store(), ["a"], [], {"a": "x"})
    assert "a" not in view
    reads: list[Callable[[], object]] = [lambda: view.a, lambda: view["a"]]
    for read in reads:
        with pytest.raises(KeyError):
            read()


def test_remapping_is_followed_one_step_both_ways() -> None:
    ud = store(a=1, b=2)
    view = smach.Remapper(ud, ["a", "b"], ["a", "b"], {"a": "b", "b": "a"})
    assert (view.a, view.b) == (2, 1)
    view.a = 7
    assert content(ud) == {"a": 1, "b": 7}


def test_keys_and_update_obey_the_remapping() -> None:
    ud = store(x=1, a=2)
    view = smach.Remapper(ud, ["a", "b"], ["o"], {"a": "x", "o": "z"})
    assert view.keys() == ["a"]
    view.update(store(o=9, stray=8))
    assert content(ud) == {"x": 1, "a": 2, "z": 9}


class Colour(enum.Enum):
    RED = 1


def test_values_are_never_wrapped() -> None:
    def function() -> int:
        return 3

    ud = store(colour=Colour.RED, function=function)
    view = smach.Remapper(ud, ["colour", "function"], [], {})
    assert view.colour is Colour.RED
    assert view.function is function


def test_a_view_can_be_copied() -> None:
    ud = store(x=1)
    view = copy.copy(smach.Remapper(ud, ["a"], ["a"], {"a": "x"}))
    view.a = 2
    assert ud.x == 2
    assert copy.deepcopy(view).a == 2
    assert pickle.loads(pickle.dumps(view)).a == 2


def test_private_attributes_stay_on_the_view() -> None:
    ud = store()
    view = smach.Remapper(ud, [], [], {})
    view._note = 1
    assert view._note == 1
    assert content(ud) == {}


@settings(max_examples=examples(60))
@given(
    held=st.dictionaries(KEYS, st.integers()),
    inputs=st.lists(KEYS),
    outputs=st.lists(KEYS),
    remapping=st.dictionaries(KEYS, KEYS),
    key=KEYS,
    value=st.integers(),
    by_item=st.booleans(),
)
def test_a_view_is_the_store_behind_its_declarations(
    held: dict[str, int],
    inputs: list[str],
    outputs: list[str],
    remapping: dict[str, str],
    key: str,
    value: int,
    by_item: bool,
) -> None:
    ud, model = store(**held), dict(held)
    view = smach.Remapper(ud, inputs, outputs, remapping)
    outer = remapping.get(key, key)
    assert (key in view) == (key in inputs and outer in model)
    assert set(view.keys()) == {k for k in inputs if remapping.get(k, k) in model}
    if by_item or key == "keys":
        view[key] = value
    else:
        setattr(view, key, value)
    if key in outputs:
        model[outer] = value
    assert content(ud) == model
    if key in inputs and outer in model:
        assert view[key] == model[outer]
        assert key == "keys" or getattr(view, key) == model[outer]
    else:
        with pytest.raises(KeyError if key in inputs else smach.InvalidUserCodeError):
            view[key]
