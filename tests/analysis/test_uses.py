"""The index of the uses of userdata keys against a naive walk over the states."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from hypothesis import given, settings

from smachac.analysis.context import Context
from smachac.analysis.uses import KeyUses, items_read, place_of
from smachac.diagnostics.source import Source, Span
from smachac.ir import nodes
from smachac.ir.nodes import Container, Key, Leaf, Machine, Node, Remap
from smachac.ir.traversal import (
    containers,
    inputs_from,
    outer_inputs,
    outer_outputs,
    outputs_to,
    remapping,
)
from tests.strategies.machines import machines, valid_machines
from tests.strategies.userdata_machines import data_machines
from tests.support.examples import examples
from tests.support.ir_machines import iterator, leaf, machine


def outer_name(node: Node, key: str) -> str:
    """The name that a key has in the container, by the definition: the last entry counts."""
    found = key
    for remap in node.remaps:
        if remap.key == key:
            found = remap.to
    return found


def naive_uses(path: str, container: Container) -> Iterator[tuple[str, str, str, str]]:
    """The path, kind, own and outer name of each use."""
    yield from ((path, "presets", preset.key, preset.key) for preset in container.userdata)
    if isinstance(container, nodes.Iterator):
        yield path, "items", container.item_key, container.item_key
        yield from ((path, "reads", key, key) for key in items_read(container))
    for child in container.children:
        kinds = ("reads", "writes") if isinstance(child, Leaf) else ("copies in", "copies out")
        for kind, keys in zip(kinds, (child.inputs, child.outputs), strict=True):
            for key in keys:
                yield f"{path}/{child.name}", kind, key.name, outer_name(child, key.name)


def check_uses(root: Container) -> None:
    for path, container in containers(root):
        uses = KeyUses(path=path, container=container)
        naive = [*naive_uses(path, container)]
        assert [(use.path, use.kind, use.key, use.outer) for use in uses.all] == naive
        reads = {outer for _, kind, _, outer in naive if kind in ("reads", "copies in")}
        writes = {outer for _, kind, _, outer in naive if kind in ("writes", "copies out")}
        given_ = {outer for _, kind, _, outer in naive if kind in ("presets", "items")}
        given_ |= {key.name for key in container.inputs}
        assert uses.read == reads
        assert uses.written == writes
        assert uses.given == given_
        assert uses.provided == writes | given_
        for key in {outer for _, _, _, outer in naive} | {"a key that nothing uses"}:
            of_key = [use for use in uses.all if use.outer == key]
            assert uses.of(key) == of_key
            assert uses.readers(key) == [use for use in of_key if use.reads]
            assert uses.writers(key) == [use for use in of_key if use.writes]


@settings(max_examples=examples(150))
@given(machines())
def test_the_index_is_what_a_naive_walk_finds(machine: Machine) -> None:
    check_uses(machine.root)


@settings(max_examples=examples(50))
@given(valid_machines())
def test_the_index_of_machines_without_faults(machine: Machine) -> None:
    check_uses(machine.root)


@settings(max_examples=examples(100))
@given(data_machines())
def test_the_names_of_keys_in_a_container(machine: Machine) -> None:
    for _, container in containers(machine.root):
        for child in container.children:
            names = remapping(child)
            for keys, outer in (
                (child.inputs, outer_inputs(child)),
                (child.outputs, outer_outputs(child)),
            ):
                assert outer == [outer_name(child, key.name) for key in keys]
                assert outer == [names[key.name] for key in keys]
            for key in (*outer_inputs(child), *outer_outputs(child), "zzz"):
                read = [own for own in child.inputs if outer_name(child, own.name) == key]
                written = [own for own in child.outputs if outer_name(child, own.name) == key]
                assert (inputs_from(child, key), outputs_to(child, key)) == (read, written)


def test_a_key_that_is_read_and_written_has_two_uses() -> None:
    node = leaf("A", {"ok": "=ok"}, ins="n", outs="n", remaps={"n": "count"})
    uses = KeyUses(path="sm", container=machine("sm", "ok", node))
    assert [(use.kind, use.key, use.reads, use.writes) for use in uses.of("count")] == [
        ("reads", "n", True, False),
        ("writes", "n", False, True),
    ]
    assert uses.of("n") == []


def test_an_iterator_reads_its_list_and_sets_its_item() -> None:
    loop = iterator("A", "ok", leaf("B", {"ok": "=ok"}), items_key="parts", item_key="part")
    uses = KeyUses(path="sm/A", container=loop)
    assert [(use.kind, use.outer, use.declared) for use in uses.all] == [
        ("items", "part", None),
        ("reads", "parts", None),
    ]
    assert uses.read == {"parts"}
    assert not uses.written


def test_the_uses_of_an_unchanged_container_are_kept() -> None:
    inner = machine("C", "ok", leaf("R", {"ok": "=ok"}), to={"ok": "ok"})
    before = Context(Machine(root=machine("sm", "ok", inner)))
    kept = before.absorbed_flow.scopes["sm/C"].uses
    other = machine("sm", "ok", inner, leaf("NEW", {"ok": "=ok"}))
    after = Context(Machine(root=other), before)
    assert after.absorbed_flow.scopes["sm/C"].uses is kept
    assert after.absorbed_flow.scopes["sm"].uses.container is other


def test_the_place_of_a_key_is_its_list_or_its_remap_or_its_state() -> None:
    text = Source("main.yml", "name of the state, key, entry of the remapping")
    interface = Source("Type.yml", "n m")
    state, own, entry = Span(text, 0, 4), Span(text, 19, 22), Span(text, 24, 29)
    node = replace(
        leaf("A", {"ok": "=ok"}), span=state, remaps=(Remap(key="n", to="count", span=entry),)
    )
    assert place_of(node, Key(name="n", span=own)) == own
    assert place_of(node, Key(name="n", span=Span(interface, 0, 1))) == entry
    assert place_of(node, Key(name="m", span=Span(interface, 2, 3))) == state
