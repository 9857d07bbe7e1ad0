"""Python files that build machines: their findings, and answers about the states in them.

A file is read again after each change of it or of a module that it imports. A text with a syntax
error keeps the answers of the last one without.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path

from smachac.analysis.context import Context
from smachac.diagnostics.source import Source, Span
from smachac.driver.python_machines import (
    PythonFile,
    PythonProject,
    builds_machines,
    drawn,
    graphs_by_name,
)
from smachac.frontend.files import Disk
from smachac.ir.nodes import Container, Leaf, Machine, Node
from smachac.ir.recursion import deep_recursion
from smachac.ir.traversal import walk
from smachac.lsp.symbols import Symbol
from smachac.pysource.machines.graph import Graph
from smachac.pysource.machines.values import Class
from smachac.pysource.modules.source import name_span, python_text
from smachac.report.explain_state import explain_state, state_text
from smachac.report.outline import paragraphs

MOST_SHOWN = 3
"""The most states of one place in a hover: a loop or a function can add several."""

QUOTES = ('"', "'")


class PythonView:
    """The machines of a Python file. `source` is the text in which their places are."""

    def __init__(self, source: Source, graphs: Mapping[str, Graph]) -> None:
        self.source = source
        self.graphs = graphs
        self.contexts: dict[str, Context] = {}

    @cached_property
    def machines(self) -> Mapping[str, Machine]:
        """The machines by name, as pictures show them."""
        return {name: drawn(graph, name) for name, graph in self.graphs.items()}

    def context(self, name: str) -> Context:
        """The facts of a machine."""
        if name not in self.contexts:
            self.contexts[name] = Context(self.machines[name])
        return self.contexts[name]

    def is_here(self, span: Span) -> bool:
        """Whether a place is in the text of the file."""
        return span.source == self.source

    def nodes(self) -> Iterator[tuple[str, str, Node, Container | None]]:
        """The states of all machines: the name of the machine, the path, the state and the
        container around it."""
        for name, machine in self.machines.items():
            around: dict[str, Node] = {}
            for path, node in walk(machine.root):
                around[path] = node
                container = around.get(path.rpartition("/")[0])
                yield name, path, node, container if not isinstance(container, Leaf) else None


class PythonFiles:
    """The Python files of a session: each is read once for each state of its modules."""

    def __init__(self, disk: Disk) -> None:
        self.disk = disk
        self.project = PythonProject(disk)
        self.read: dict[str, tuple[PythonFile, frozenset[str]]] = {}
        self.views: dict[str, PythonView] = {}

    def forget(self, changed: Iterable[str]) -> None:
        """Forget what was computed from some files, by real path."""
        gone = frozenset(changed)
        self.project.forget(gone)
        for path in [path for path, (_, uses) in self.read.items() if path in gone or uses & gone]:
            del self.read[path]

    def list_again(self) -> None:
        """Forget everything but the last views: files can be new or gone."""
        self.project.list_again()
        self.read.clear()

    def close(self, path: str) -> None:
        self.views.pop(path, None)

    def file(self, path: str) -> tuple[PythonFile, frozenset[str]] | None:
        """The machines of a file, and the real paths of the files it was read from; None if its
        text names no container of a framework."""
        source = self.disk.read(Path(path), [])
        if source is None or not builds_machines(source):
            self.views.pop(path, None)
            return None
        if path not in self.read:
            self.disk.searched.clear()
            with deep_recursion():
                file = self.project.read(Path(path))
            self.read[path] = file, self.disk.searched_files()
            if file.coverage is not None and file.source is not None:
                self.views[path] = PythonView(file.source, graphs_by_name(file))
        return self.read[path]

    def view(self, path: str) -> PythonView | None:
        """The machines of a file, or those of its last text without a syntax error."""
        return self.views.get(path) if self.file(path) is not None else None


def name_place(node: Node) -> Span:
    """The place of the name of a state: its text in the call that adds it, or the begin of this."""
    text, span = node.span.text, node.span
    for quote in QUOTES:
        at = text.find(f"{quote}{node.name}{quote}")
        if at >= 0:
            start = span.start + at + 1
            return Span(span.source, start, start + len(node.name))
    end = text.find("(")
    return Span(span.source, span.start, span.start + end if end > 0 else span.end)


def symbols(view: PythonView) -> list[Symbol]:
    """The machines of the file with their states; those that other files add have no symbol."""
    children: dict[str, list[Symbol]] = {}
    found: list[Symbol] = []
    for machine, path, node, _ in reversed([*view.nodes()]):
        inner = tuple(reversed(children.pop(path, [])))
        if not view.is_here(node.span):
            continue
        where = name_place(node)
        is_root = "/" not in path
        symbol = Symbol(
            name=machine if is_root else node.name,
            detail=node.type if isinstance(node, Leaf) else type(node).__name__,
            is_container=not isinstance(node, Leaf),
            start=min([node.span.start, *(child.start for child in inner)]),
            end=max([node.span.end, *(child.end for child in inner)]),
            name_start=where.start,
            name_end=where.end,
            children=inner,
        )
        if is_root:
            found.append(symbol)
        else:
            children.setdefault(path.rpartition("/")[0], []).append(symbol)
    return found[::-1]


def _has(span: Span, view: PythonView, offset: int) -> bool:
    return view.is_here(span) and span.start <= offset <= span.end


def _word(place: Span) -> str:
    return place.text.strip("".join(QUOTES))


def _is_outcome(node: Node, target: Span) -> bool:
    """Whether a target leads to an outcome of a container, and not to the state itself."""
    name = _word(target)
    return node.name != name and any(outcome.name == name for outcome in node.outcomes)


def _target_at(view: PythonView, offset: int) -> Iterator[tuple[str, str, Node, Span]]:
    """The states, or the container, that the target at an offset names: the name of the machine,
    the path and the node, with the place of the target."""
    for machine, path, node, around in view.nodes():
        if around is None:
            continue
        for edge in node.transitions:
            if edge.origin == "written" and _has(edge.target_span, view, offset):
                above = path.rpartition("/")[0]
                siblings = [child for child in around.children if child.name == edge.target]
                for child in siblings:
                    yield machine, f"{above}/{child.name}", child, edge.target_span
                if not siblings:
                    yield machine, above, around, edge.target_span


def hover(view: PythonView, offset: int) -> tuple[str, int, int] | None:
    """What is known of the state whose name is at an offset, or to which the target there leads,
    and the range of the word."""
    named = [(machine, path, node, where) for machine, path, node, _ in view.nodes()
             if _has(where := name_place(node), view, offset)]  # fmt: skip
    found = named or [*_target_at(view, offset)]
    texts: dict[str, None] = {}
    for machine, path, node, where in found:
        if not named and _is_outcome(node, where):
            texts[f"outcome `{_word(where)}` of {path}"] = None
        elif "/" in path:
            texts[_explained(view, machine, path)] = None
        else:
            texts[_machine_text(view, machine, node)] = None
    if not texts:
        return None
    shown = [*texts][:MOST_SHOWN]
    more = [f"and {len(texts) - MOST_SHOWN} more states"] if len(texts) > MOST_SHOWN else []
    where = found[0][3]
    return "\n\n".join([*shown, *more]), where.start, where.end


def _explained(view: PythonView, machine: str, path: str) -> str:
    context = view.context(machine)
    unknown = context.machine.unknown.get(path)
    title, parts = state_text(explain_state(context, path, []))
    parts = [part for part in parts if part[0] != "found"]
    if unknown is not None:
        parts.append(("unknown", [unknown]))
    return _block(paragraphs(title, parts))


def _machine_text(view: PythonView, name: str, node: Node) -> str:
    unknown = view.machines[name].unknown
    parts = [
        ("is", [f"a {type(node).__name__}"]),
        ("ends", [outcome.name for outcome in node.outcomes] or ["never: it has no outcome"]),
    ]
    if unknown:
        parts.append(("unknown", [f"{path}: {reason}" for path, reason in unknown.items()]))
    return _block(paragraphs(f"machine {name}", parts))


def _block(text: str) -> str:
    return f"```text\n{text.rstrip()}\n```"


def definitions(view: PythonView, offset: int) -> list[Span]:
    """The places that the word at an offset names: of the target of a transition the call that adds
    the state, or the declaration of the outcome; of the class of a state that class."""
    found: dict[Span, None] = {}
    for _, _, node, where in _target_at(view, offset):
        own = [outcome.span for outcome in node.outcomes if outcome.name == _word(where)]
        found |= dict.fromkeys(own if _is_outcome(node, where) else [name_place(node)])
    if not found:
        found |= dict.fromkeys(_class_at(view, offset))
    return [*found]


def _class_at(view: PythonView, offset: int) -> Iterator[Span]:
    """The class of the state whose object is made, or named, at an offset of a call that adds
    it; or which the call at an offset makes, as in the dictionary of a concurrence."""
    for machine, path, node, _ in view.nodes():
        graph = view.graphs[machine]
        made = graph.objects.get((graph.machine.root.name, *path.split("/")[1:]))
        is_added = _has(node.span, view, offset) and _is_in_object(node.span, offset)
        if made is None or not (is_added or _is_callee(made.span, view, offset)):
            continue
        text = made.cls.frame.module.text if isinstance(made.cls, Class) else None
        if isinstance(made.cls, Class) and text is not None:
            yield name_span(text, made.cls.node)
        elif made.span is not None:
            yield made.span


def _is_callee(call: Span | None, view: PythonView, offset: int) -> bool:
    """Whether an offset is in what a call calls."""
    if call is None or not _has(call, view, offset):
        return False
    return offset - call.start <= max(call.text.find("("), 0)


def _is_in_object(call: Span, offset: int) -> bool:
    """Whether an offset is in the argument of a call that is the object of a state: the second, or
    that with the name `state`, or `sm` for a region of YASMIN."""
    source = Source(call.source.name, f"({call.text})", "python")
    text = python_text(source, template=False)
    if text is None:
        return False
    at = offset - call.start + 1
    for node in ast.walk(text.tree):
        if isinstance(node, ast.Call):
            named = [keyword.value for keyword in node.keywords if keyword.arg in ("state", "sm")]
            for value in [*node.args[1:2], *named]:
                place = text.span(value)
                if place.start <= at <= place.end:
                    return True
            return False
    return False


def machine_at(view: PythonView, line: int | None) -> Machine | None:
    """The machine of which the call before a line, counted from 1, makes a part; without a line
    the first."""
    nearest: tuple[int, Machine] | None = None
    for name, _, node, _ in view.nodes():
        if not view.is_here(node.span) or line is None or node.span.line > line:
            continue
        if nearest is None or node.span.line > nearest[0]:
            nearest = node.span.line, view.machines[name]
    return nearest[1] if nearest is not None else next(iter(view.machines.values()), None)
