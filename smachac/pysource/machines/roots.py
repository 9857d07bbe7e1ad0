"""The machines of a file: what its main part builds, and what functions and classes build that
nothing calls, with unknown arguments."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator
from typing import TypeVar

from smachac.diagnostics.source import Span
from smachac.pysource.machines.evaluator import BudgetError, Evaluator
from smachac.pysource.machines.heap import Added, Children
from smachac.pysource.machines.libraries import (
    FRAMEWORKS,
    framework_of,
    is_container,
    is_container_class,
)
from smachac.pysource.machines.project import Repository
from smachac.pysource.machines.values import (
    UNKNOWN,
    Arguments,
    Class,
    Const,
    Frame,
    Function,
    Instance,
    LibraryClass,
    ModuleValue,
    OpenText,
    Value,
    alternatives,
)
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.records import dataclass

T = TypeVar("T")
Candidate = Callable[[bool], object]
"""Calls a function or class with unknown arguments; if True, also for parameters with a default."""

_WORDS = frozenset(
    word
    for framework in FRAMEWORKS
    for word in (*(name.rpartition(".")[2] for name in framework.containers), *framework.adds)
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Roots:
    """Containers that are in no other one, with those that were made for them. `closed`: no code
    outside the repository can change their userdata. `complete`: the evaluation came to its end."""

    containers: tuple[Instance, ...]
    closed: bool
    complete: bool


def variants_of(
    repository: Repository, evaluator: Evaluator, file: str, read: Callable[[Roots], T]
) -> list[T]:
    """What `read` makes of the machines that the functions and classes of a file build if no
    argument is known: other code can call each of them with any."""
    module = repository.module(evaluator, file, main=True)
    if not isinstance(module, ModuleValue):
        return []
    return [*_built(evaluator, module, file, read, variants=True)]


def machines_of(
    repository: Repository, evaluator: Evaluator, file: str, read: Callable[[Roots], T]
) -> list[T]:
    """What `read` makes of the machines of a file. It is called while the objects are as the code
    has left them; changes by one function are undone before the next one is called."""
    evaluator.begin()
    repository.end_of_main(file)
    before = len(evaluator.made)
    complete = True
    module: Value = UNKNOWN
    evaluator.sees_opened = True
    try:
        module = repository.module(evaluator, file, main=True)
    except (BudgetError, RecursionError):
        complete = False
        evaluator.reset()
    evaluator.sees_opened = False
    evaluator.opened.clear()
    found = [read(_roots(evaluator, before, file, closed=True, complete=complete))]
    if isinstance(module, ModuleValue):
        found += _built(evaluator, module, file, read, variants=False)
    return found


def _built(
    evaluator: Evaluator, module: ModuleValue, file: str, read: Callable[[Roots], T], *,
    variants: bool,
) -> Iterator[T]:  # fmt: skip
    """What `read` makes of the machines that single functions and classes build. Those that build
    none with their default values, which can be refused, get unknown values for these too."""
    for candidate in _candidates(evaluator, module, variants=variants):
        for unknown in (True,) if variants else (False, True):
            mark, before = evaluator.heap.mark(), len(evaluator.made)
            orphans = evaluator.orphans
            complete = True
            evaluator.renew()
            try:
                candidate(unknown)
            except (BudgetError, RecursionError):
                complete = False
                evaluator.reset()
            evaluator.opened.clear()
            found = _roots(evaluator, before, file, closed=False, complete=complete)
            is_own = evaluator.orphans == orphans
            if is_own and found.containers:
                yield read(found)
            evaluator.heap.undo(mark)
            if complete:  # else all marks are given up
                evaluator.heap.release(mark)
            del evaluator.made[before:]
            if found.containers or not (is_own and complete):
                break


def _roots(evaluator: Evaluator, before: int, file: str, *, closed: bool, complete: bool) -> Roots:
    """The containers that were made since then, by code or as an object of a class of this file,
    and are in no other one."""
    containers = [made for made in evaluator.made[before:] if is_container(made)]
    inside = {
        id(part)
        for container in containers
        for added in _children(container)
        for part in alternatives(added.state)
    }
    own = [
        container
        for container in containers
        if id(container) not in inside
        and _is_of(container, file)
        and (_children(container) or "$executed" in container.slots)
    ]
    return Roots(containers=tuple(own), closed=closed, complete=complete)


def _is_of(container: Instance, file: str) -> bool:
    """Whether a container belongs to a file. A function of another file can have made it, from a
    class that this one passes to it: its place is then the class."""
    if container.span is not None and container.span.source.name == file:
        return True
    cls = container.cls
    if not isinstance(cls, Class) or cls.frame.module.file != file:
        return False
    container.span = _place(cls.frame.module, cls)
    return container.span is not None


def _children(container: Instance) -> tuple[Added, ...]:
    children = container.slots.get("$children")
    return children.added if isinstance(children, Children) else ()


def _candidates(
    evaluator: Evaluator, module: ModuleValue, *, variants: bool
) -> Iterator[Candidate]:
    """The functions and classes of a module that can build containers: those that nothing calls,
    functions that others call last, because they may be called by then; for `variants` all."""
    frame = Frame(module.slots, module)
    called = _called_names(module)
    for first in (True, False):
        for value in [*module.slots.values()]:
            name = getattr(value, "name", "")
            if (name in called) is first:
                continue
            match value:
                case Function() if value.frame.module is module:
                    is_new = variants or value.node not in evaluator.called
                    if is_new and _builds(value.node, module):
                        evaluator.called.add(value.node)
                        yield lambda unknown, value=value: evaluator.run(  # type: ignore[misc]
                            value, _unknown(value, variants=unknown)
                        )
                case Class() if value.frame.module is module:
                    yield from _of_class(evaluator, value, module, frame, variants=variants)


def _of_class(
    evaluator: Evaluator, cls: Class, module: ModuleValue, frame: Frame, *, variants: bool
) -> Iterator[Candidate]:
    """Builds an object, and calls those of its methods that nothing calls. Of a class of which the
    main part of the file has made an object, only the methods count."""
    order = evaluator.classes(cls)
    is_own = any(map(is_container_class, order))
    maker = cls.slots.get("__init__")
    is_made = isinstance(maker, Function) and maker.node in evaluator.called and not variants
    if not (is_own or _builds(cls.node, module)):
        return
    methods = [
        value
        for value in cls.slots.values()
        if isinstance(value, Function) and value.owner is cls and not value.name.startswith("__")
        and (variants or value.node not in evaluator.called) and _builds(value.node, module)
    ]  # fmt: skip
    if is_made and (is_own or not methods):
        return

    def build(unknown: bool) -> None:
        arguments = Arguments()
        if isinstance(maker, Function):
            arguments = _unknown(maker, variants=unknown).without_first()
        before = len(evaluator.made)
        made = evaluator.make(cls, arguments, _place(module, cls), frame)
        if is_made:
            del evaluator.made[before:]
        for method in methods:
            if unknown or method.node not in evaluator.called:
                given = _unknown(method, variants=unknown, once=False)
                result = evaluator.run(method, given.without_first().with_first(made))
                if method.name in framework_of(order).entries and is_container(result):
                    _run_by_framework(evaluator, result, cls)

    yield build


def _run_by_framework(evaluator: Evaluator, machine: Value, cls: Class) -> None:
    """Notes that a framework runs a machine, and that it has the name of the class."""
    if isinstance(machine, Instance):
        evaluator.heap.set(machine.slots, "$executed", Const(True))
        evaluator.heap.set(machine.slots, "$name", Const(cls.name))


def _place(module: ModuleValue, cls: Class) -> Span | None:
    return module.text.span(cls.node) if module.text is not None else None


def _unknown(function: Function, *, variants: bool, once: bool = True) -> Arguments:
    """Unknown arguments for the parameters that have no default value; for `variants` for all. If
    it is called `once` for an object, each of them is one text in all names."""
    taken = function.node.args
    positional = [*taken.posonlyargs, *taken.args]
    known = 0 if variants else len(function.defaults)
    given = (
        OpenText(text=f"{{{argument.arg}}}") if once else UNKNOWN
        for argument in positional[: len(positional) - known]
    )
    named = [(argument.arg, UNKNOWN) for argument in taken.kwonlyargs] if variants else []
    return Arguments(tuple(given), tuple(named))


def _builds(node: ast.AST, module: ModuleValue) -> bool:
    """Whether code names a container class of a framework, or one of the module that is derived
    from one, or a method that adds states to any container."""
    for part in walk_code(node):
        name = part.attr if isinstance(part, ast.Attribute) else getattr(part, "id", None)
        if name in _WORDS:
            return True
        value = module.slots.get(name) if isinstance(part, ast.Name) else None
        if isinstance(value, LibraryClass) and is_container_class(value):
            return True
        if isinstance(value, Class) and any(map(is_container_class, value.order)):
            return True
    return False


def _called_names(module: ModuleValue) -> frozenset[str]:
    """The names that the functions of a module call."""
    if module.text is None:
        return frozenset()
    found = set()
    for node in walk_code(module.text.tree):
        if isinstance(node, ast.Call):
            match node.func:
                case ast.Name(id=name) | ast.Attribute(attr=name):
                    found.add(name)
    return frozenset(found)
