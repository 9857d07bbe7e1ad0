"""Slips of Python in the class of a state type that the parser accepts: a method without `()`, `is`
with a constant, `==` in place of `=`, a missing comma, a misspelt argument of `smach.State`.
"""

from __future__ import annotations

import ast
import io
import tokenize
from collections.abc import Iterable, Iterator, Mapping

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind
from smachac.pysource.faults.class_names import SMACH_CLASSES, STATE_METHODS
from smachac.pysource.modules.functions import tried_code
from smachac.pysource.modules.library_names import methods_of_objects
from smachac.pysource.modules.modules import Module, OwnClass, compared, of_other_objects
from smachac.pysource.modules.source import PythonText
from smachac.pysource.modules.syntax_tree import walk_code

SUPER_NOT_CALLED = FaultKind(
    name="super not called",
    message="`super` without `()` is not the base class of `{name}`",
    help="write `super()`",
    effect="the call raises an error when it runs: the program stops",
)
NO_COMMA = FaultKind(
    name="no comma",
    message="a comma is missing: Python joins the two texts to `{word}`",
    help="write `{near}`",
    effect="SMACH knows the joined name only: the machine stops with an error",
)
NO_ARGUMENT = FaultKind(
    name="no argument",
    message="`smach.State.__init__` has no argument `{word}`",
    help="its arguments are `outcomes`, `input_keys`, `output_keys` and `io_keys`",
    near_help=SUGGESTION,
    effect="the call raises a TypeError when the program makes the state",
    stops=True,
)
NO_STATE_CLASS = FaultKind(
    name="no state class",
    message="`{word}` is not a class of SMACH",
    help="write `{near}`",
    effect="the definition of the class raises an error when the program starts",
    stops=True,
)
NOT_CALLED = FaultKind(
    name="not called",
    message="`{word}` without `()` does not call the method",
    help="write `{near}`",
    effect="the value is the method itself, which is true in every condition",
    accepted=True,
)
NO_EFFECT = FaultKind(
    name="no effect",
    message="the line `{word}` does nothing: without `()` a method is not called",
    help="write `{near}`, or remove the line",
    effect="",
    accepted=True,
)
NO_ANSWER = FaultKind(
    name="no answer",
    message="the line `{word}` does nothing: without `()` a method is not called",
    help="write `{near}`",
    effect="the request stays set: when the state runs again, it is stopped at once",
    accepted=True,
)
IDENTITY = FaultKind(
    name="identity",
    message="`is` compares objects, not values: two equal values can be two objects",
    help="write `{near}`",
    effect="the comparison can be false for equal values",
    accepted=True,
)
COMPARISON = FaultKind(
    name="comparison",
    message="`==` compares, and nothing uses the result: `{word}` is not set",
    help="write `{near}`",
    effect="the line has no effect: the old value stays, or there is none",
    accepted=True,
)

SMACH_MODULES = frozenset(
    ["state", "state_machine", "concurrence", "iterator", "sequence", "container", "user_data"]
)
"""The modules of the package `smach` with the names of its classes in lower case."""


METHODS = frozenset(
    name for kind in (list, dict, set, str) for name in dir(kind) if not name.startswith("_")
)
"""The methods of the collections and of texts."""


def slips(own: OwnClass) -> Iterator[ClassFault]:
    """The slips in the code of a class and of its base classes."""
    methods = _methods(own)
    objects = methods_of_objects(own)
    for module, node in own.classes:
        others = of_other_objects(node)
        every = [inner for inner in walk_code(node) if inner not in others]
        found = [*_uncalled(module.text, every, methods, objects), *_compared(module.text, every)]
        if "super" not in module.names:
            found += _uncalled_super(module.text, every)
        yield from (fault for fault in found if not module.text.is_filled(fault.name.span))


def _methods(own: OwnClass) -> set[str]:
    """The names that are methods of the class, and nothing else."""
    methods = {*STATE_METHODS} if own.root == "state" else set[str]()
    methods |= {name for names in own.names for name in names if own.method(name) is not None}
    plain = {name for name in methods if _is_undecorated(own, name)}
    return plain - own.assigned().keys()


def _is_undecorated(own: OwnClass, name: str) -> bool:
    found = own.method(name)
    return not found[1].decorator_list if found is not None else not own.binds(name)


# --- methods that are not called


def _uncalled(
    text: PythonText,
    every: Iterable[ast.AST],
    methods: set[str],
    objects: Mapping[str, frozenset[str]],
) -> Iterator[ClassFault]:
    """Methods of `self` and of its objects in a condition, and attributes alone in a line, without
    `()`."""

    def is_method(node: ast.expr) -> bool:
        match node:
            case ast.Attribute(value=ast.Name(id="self"), attr=name):
                return name in methods
            case ast.Attribute(value=ast.Attribute(value=ast.Name(id="self"), attr=owner)):
                return node.attr in objects.get(owner, ())
        return False

    tried = tried_code(every)
    for inner in every:
        if isinstance(inner, ast.If | ast.While | ast.IfExp | ast.Assert):
            for part in operands(inner.test):
                if isinstance(part, ast.Attribute) and is_method(part):
                    yield _without_call(NOT_CALLED, text, part)
        elif isinstance(inner, ast.Assign):
            if isinstance(inner.value, ast.Attribute) and _is_method_of_key(inner.value):
                yield _without_call(NOT_CALLED, text, inner.value)
        elif isinstance(inner, ast.Expr) and inner not in tried:
            value = inner.value
            if isinstance(value, ast.Attribute) and (is_method(value) or _is_method_of_key(value)):
                answer = value.attr == "service_preempt"
                yield _without_call(NO_ANSWER if answer else NO_EFFECT, text, value)


def _uncalled_super(text: PythonText, every: Iterable[ast.AST]) -> Iterator[ClassFault]:
    """The calls of methods of `super` without `()`."""
    for node in every:
        match node:
            case ast.Call(func=ast.Attribute(value=owner)) if is_uncalled_super(node):
                yield ClassFault(kind=SUPER_NOT_CALLED, name=Word("super", text.span(owner)))


def is_uncalled_super(node: ast.AST) -> bool:
    """Whether code calls a method of the class `super` itself: `super.__init__()`."""
    match node:
        case ast.Call(func=ast.Attribute(value=ast.Name(id="super"), attr=name)):
            return name == "__init__" or name not in {*dir(super), *dir(type)}
    return False


def operands(test: ast.expr) -> Iterator[ast.expr]:
    """The parts of a condition whose truth it uses."""
    match test:
        case ast.BoolOp(values=values):
            for value in values:
                yield from operands(value)
        case ast.UnaryOp(op=ast.Not(), operand=inner):
            yield from operands(inner)
        case ast.Compare(left=left, comparators=[ast.Constant(bool() | str() | int())]):
            yield left
        case _:
            yield test


def _is_method_of_key(node: ast.Attribute) -> bool:
    """Whether an expression is a method of a list, a dictionary or a text in the userdata. Other
    attributes alone in a line can be properties with an effect."""
    match node.value:
        case ast.Attribute(value=ast.Name(id="userdata" | "ud")):
            return node.attr in METHODS
    return False


def _without_call(kind: FaultKind, text: PythonText, node: ast.Attribute) -> ClassFault:
    span = text.span(node)
    return ClassFault(kind=kind, name=Word(span.text, span), near=f"{span.text}()")


# --- comparisons


def _compared(text: PythonText, every: Iterable[ast.AST]) -> Iterator[ClassFault]:
    """`is` with a text or a number, and `==` as a statement."""
    for node in every:
        line = compared(node)
        if line is not None:
            left, right = text.span(line.left), text.span(line.comparators[0])
            sign = _between(text, left, right, "==")
            if sign is not None:
                near = f"{left.text} = {right.text}"
                yield ClassFault(kind=COMPARISON, name=Word(left.text, sign), near=near)
        match node:
            case ast.Compare(left=one, ops=[ast.Is() | ast.IsNot() as sort], comparators=[other]):
                if not (_is_value(one) or _is_value(other)):
                    continue
                left, right = text.span(one), text.span(other)
                sign = _between(text, left, right, "is not" if _negates(sort) else "is")
                if sign is not None:
                    near = f"{left.text} {'!=' if _negates(sort) else '=='} {right.text}"
                    yield ClassFault(kind=IDENTITY, name=Word(sign.text, sign), near=near)


def _negates(sort: ast.cmpop) -> bool:
    return isinstance(sort, ast.IsNot)


def _is_value(node: ast.expr) -> bool:
    """Whether an expression is a text or a number."""
    return (
        isinstance(node, ast.Constant)
        and isinstance(node.value, str | bytes | int | float)
        and not isinstance(node.value, bool)
    )


def _between(text: PythonText, left: Span, right: Span, sign: str) -> Span | None:
    """The place of an operator between two expressions; None where it is written otherwise."""
    start = text.source.text.find(sign, left.end, right.start)
    return Span(text.source, start, start + len(sign)) if start >= 0 else None


# --- the constructor of smach.State


def wrong_base(module: Module, node: ast.ClassDef) -> Iterator[ClassFault]:
    """A base class `smach.state`, which is a module."""
    for base in node.bases:
        match base:
            case ast.Attribute(value=ast.Name(id="smach"), attr=name) if name in SMACH_MODULES:
                named = name.replace("_", "").casefold()
                near = next(
                    class_ for class_ in sorted(SMACH_CLASSES) if class_.casefold() == named
                )
                word = Word(f"smach.{name}", module.text.span(base))
                yield ClassFault(kind=NO_STATE_CLASS, name=word, near=f"smach.{near}")


def unknown_argument(
    text: PythonText, keyword: ast.keyword, parameters: Iterable[str]
) -> ClassFault:
    """An argument that `smach.State.__init__` does not have."""
    name = keyword.arg or ""
    start = text.offset(keyword.lineno, keyword.col_offset)
    span = Span(text.source, start, start + len(name))
    return ClassFault(kind=NO_ARGUMENT, name=Word(name, span), near=guesser(parameters)(name))


def joined_texts(text: PythonText, node: ast.Constant) -> list[Word]:
    """The texts of a constant, each at its place: several where a comma is missing between them."""
    span = text.span(node)
    if span.text.count('"') + span.text.count("'") <= 2:
        return [Word(str(node.value), span)]
    lines = io.StringIO(f"({span.text})")
    try:
        tokens = [token for token in tokenize.generate_tokens(lines.readline)
                  if token.type == tokenize.STRING]  # fmt: skip
        values = [ast.literal_eval(token.string) for token in tokens]
    except (tokenize.TokenError, SyntaxError, ValueError):
        return [Word(str(node.value), span)]
    if len(tokens) < 2:
        return [Word(str(node.value), span)]
    found, at = [], span.start
    for token, value in zip(tokens, values, strict=True):
        start = span.source.text.find(token.string, at, span.end)
        at = start + len(token.string)
        found.append(Word(str(value), Span(span.source, start, at)))
    return found


def missing_comma(text: PythonText, node: ast.Constant) -> Iterator[ClassFault]:
    """Two texts of a list without a comma between them, which Python joins."""
    words = joined_texts(text, node)
    if len(words) > 1:
        near = ", ".join(word.span.text for word in words)
        yield ClassFault(kind=NO_COMMA, name=Word(str(node.value), text.span(node)), near=near)
