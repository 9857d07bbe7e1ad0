"""Names in the methods of a class that nothing defines: names of the module, as pyflakes finds
them, with what was probably meant, and attributes of `self`.

Where a name can come from elsewhere, such as a star import or a base class that is not read, none
is found.
"""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterable, Iterator, Mapping, Sequence, Set
from typing import TypeAlias

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind
from smachac.pysource.modules.functions import caught
from smachac.pysource.modules.modules import AttributeUse, Module, OwnClass, of_other_objects
from smachac.pysource.modules.syntax_tree import walk_code

UNDEFINED_NAME = FaultKind(
    name="undefined name",
    message="`{word}` is used in `{name}`, but nothing defines it",
    help="define it in the module, or import it",
    near_help=SUGGESTION,
    effect="the code raises NameError when it runs: the machine stops",
)
OTHER_SCOPE = FaultKind(
    name="other scope",
    message="`{word}` is not visible here: only another function of the file defines it",
    help="write `self.{word}` in both places, or define `{word}` in this method",
    effect="the code raises NameError when it runs: the machine stops",
)
OTHER_USERDATA = FaultKind(
    name="other userdata",
    message="the parameter of `execute` is `{word}`, but its code uses `{near}`",
    help="write `def execute(self, {near}):`",
    effect="the code raises NameError when it runs: the machine stops",
)
LOST_ARGUMENT = FaultKind(
    name="lost argument",
    message="`{word}` is a parameter of `__init__`, which this method cannot use",
    help="write `self.{word} = {word}` in `__init__`, and `self.{word}` here",
    effect="the code raises NameError when it runs: the machine stops",
)
LOST_USERDATA = FaultKind(
    name="lost userdata",
    message="`{word}` is a parameter of `execute`, which this method cannot use",
    help="write `{near}`, and pass `{word}` in `execute`",
    effect="the code raises NameError when it runs: the machine stops",
)
EARLY_USERDATA = FaultKind(
    name="early userdata",
    message="`{word}` is a parameter of `execute`, but `{more}` runs when the program makes"
    " the state",
    help="a state has no userdata before it runs: write `{near}` in `execute`",
    effect="the code raises NameError when the program makes the state",
)
NO_SELF_PARAMETER = FaultKind(
    name="no self parameter",
    message="the method `{word}` uses `self`, but has no parameter `self`",
    help="write `{near}`",
    effect="the call raises TypeError when it runs: the machine stops",
)
NO_IMPORT = FaultKind(
    name="no import",
    message="`{word}` is used in this file, but not imported",
    help="write `import {word}` at the top of the file",
    effect="the code raises NameError when it runs: the machine stops",
)
NO_ROSPY_IMPORT = FaultKind(
    name="no rospy import",
    message="`{word}` is used in this file, but not imported",
    help="in ROS 1 write `import rospy` at the top of the file; ROS 2 has no `rospy`:"
    " there write `time.sleep(...)` for `rospy.sleep(...)`",
    effect="the code raises NameError when it runs: the machine stops",
)
WRONG_IMPORT = FaultKind(
    name="wrong import",
    message="the file imports `{word}`, but uses `{near}`",
    help="write `import {near}`",
    effect="the code raises NameError when it runs: the machine stops",
)
UNDEFINED_METHOD = FaultKind(
    name="undefined method",
    message="neither `{name}` nor `smach.State` defines `{word}`",
    help="define `{word}` in the class, or correct the name",
    near_help=SUGGESTION,
    effect="the code raises AttributeError when it runs: the machine stops",
)
UNSET_ATTRIBUTE = FaultKind(
    name="unset attribute",
    message="`self.{word}` of `{name}` is never set",
    help="write `self.{word} = {word}` in `__init__`",
    effect="the code raises AttributeError when it runs: the machine stops",
)
NEVER_SET = FaultKind(
    name="never set",
    message="`self.{word}` of `{name}` is never set",
    help="write `self.{word} = {near}` in `__init__`",
    effect="the code raises AttributeError when it runs: the machine stops",
)

BUILT_IN = frozenset([*dir(builtins), "__file__", "__builtins__", "__path__", "__class__", "_"])
"""Names that a module has without a definition; `_` is that of gettext."""

MAKE_NAMES = frozenset(["exec", "globals"])
"""Functions that can define a name of a module at run time."""

DYNAMIC = frozenset(["exec", "eval", "globals", "locals", "vars", "setattr", "__import__"])
"""Functions that can define an attribute at run time."""

USUAL_MODULES = frozenset([
    "collections", "copy", "datetime", "functools", "itertools", "json", "logging", "math", "os",
    "random", "re", "rospy", "smach", "subprocess", "sys", "threading", "time",
])  # fmt: skip
"""Modules whose names nobody uses for something else that a sketch leaves out."""

STATE_METHODS = frozenset([
    "execute", "request_preempt", "service_preempt", "recall_preempt", "preempt_requested",
    "register_outcomes", "get_registered_outcomes", "register_io_keys", "register_input_keys",
    "get_registered_input_keys", "register_output_keys", "get_registered_output_keys",
])  # fmt: skip
"""The methods of `smach.State` that containers call (smachac/runtime/smach/state.py)."""

INHERITED = STATE_METHODS.union(
    dir(object), ["_outcomes", "_input_keys", "_output_keys", "_preempt_requested", "__name__"]
)
"""The attributes of a state of SMACH."""

SMACH_CLASSES = frozenset([
    "State", "CBState", "StateMachine", "Concurrence", "Iterator", "Sequence", "Container",
    "UserData", "Remapper",
])  # fmt: skip
"""The classes that the package `smach` exports."""

CONSTANTS = {"null": "None", "nil": "None", "true": "True", "false": "False"}
"""Constants of YAML and of other languages, with those of Python."""

USUAL_OUTCOMES = frozenset(["succeeded", "aborted", "preempted"])
"""The outcomes of the states of SMACH."""

LATE = frozenset(["__getattr__", "__getattribute__", "__dict__", "__slots__"])
"""Names in a class that can have attributes without a definition."""


def undefined_names(
    own: OwnClass, module: Module, node: ast.ClassDef, lists: Mapping[str, Iterable[str]]
) -> list[ClassFault]:
    """The names in a class, one of `own.classes`, that nothing defines where they are used, each
    once. In a template, whose names other templates can define, only those of another scope, and
    those with a name that was certainly meant.

    `lists` are the outcomes and keys of the class, by parameter of `smach.State.__init__`."""
    if module.dynamic or not any(True for _ in _unbound(node, {*module.names, *BUILT_IN})):
        return []
    every, names = module.nodes, module.identifiers
    if not MAKE_NAMES.isdisjoint(names):
        return []
    anywhere = {name for node in every for name in _bound(node)} | BUILT_IN
    inner = node not in module.names.get(node.name, ())  # in a function: its names are visible
    shared = anywhere if inner else {*module.names, *BUILT_IN, *_declared_global(every)}
    near = _Near(own, module, every, anywhere, lists)
    found, done = [], set[str]()
    if not module.name:
        outcomes = USUAL_OUTCOMES.union(lists.get("outcomes", ()))
        shared = anywhere | names - CONSTANTS.keys() - STATE_METHODS - outcomes
    for name, method in _unbound(node, shared):
        if name.id in done:
            continue
        fault = near.fault(name, method)
        if fault is not None:
            done.add(name.id)
            found.append(fault)
    return found


Method: TypeAlias = ast.FunctionDef | ast.AsyncFunctionDef


def _unbound(node: ast.ClassDef, shared: Set[str]) -> Iterator[tuple[ast.Name, Method | None]]:
    """The names in a class that pyflakes does not find bound, each with its method; `shared` are
    those that the module binds."""
    from pyflakes.checker import Checker
    from pyflakes.messages import UndefinedLocal, UndefinedName

    tree = ast.Module(body=[node], type_ignores=[])
    places = {(message.lineno, message.col)
              for message in Checker(tree, builtins=shared, withDoctest=False).messages
              if isinstance(message, UndefinedName | UndefinedLocal)}  # fmt: skip
    methods = {part: method for method in node.body if isinstance(method, Method)
               for body in method.body for part in walk_code(body)}  # fmt: skip
    for part in _evaluated(node) if places else ():
        if isinstance(part, ast.Name) and (part.lineno, part.col_offset) in places:
            yield part, methods.get(part)


def _before_execute(own: OwnClass) -> set[str]:
    """The names of `__init__` and of the methods that it uses and `execute` does not."""
    return _reached(own, "__init__") - _reached(own, "execute")


def _reached(own: OwnClass, method: str) -> set[str]:
    """The names of the methods of a class that one of them uses, and its own name."""
    found, todo = set[str](), [method]
    while todo:
        name = todo.pop()
        function = own.method(name)
        if name in found or function is None:
            continue
        found.add(name)
        todo += [attribute.attr for attribute in walk_code(function[1])
                 if isinstance(attribute, ast.Attribute) and isinstance(attribute.value, ast.Name)
                 and attribute.value.id == "self"]  # fmt: skip
    return found


class _Near:
    """What was probably meant by a name that nothing defines where it is used."""

    def __init__(
        self, own: OwnClass, module: Module, every: Sequence[ast.AST], anywhere: set[str],
        lists: Mapping[str, Iterable[str]],
    ) -> None:  # fmt: skip
        self.module, self.every, self.anywhere = module, every, anywhere
        self.outcomes = {*lists.get("outcomes", ())}
        self.inputs = {*lists.get("input_keys", ()), *lists.get("io_keys", ())}
        self.attributes = {*own.assigned(), *(name for names in own.names for name in names)}
        self.early = _before_execute(own)
        constructor = own.method("__init__")
        self.given = _arguments(constructor[1]) if constructor is not None else set()
        self.kept = {
            assignment.value
            for assignment in every
            if isinstance(assignment, ast.Assign) and isinstance(assignment.value, ast.Name)
            for target in assignment.targets
            if isinstance(target, ast.Attribute) and target.attr == assignment.value.id
        }
        execute = own.method("execute")
        positional = execute[1].args.args[1:] if execute is not None else []
        self.userdata = positional[0].arg if len(positional) == 1 else None
        self.owners = {
            attribute.value for attribute in every if isinstance(attribute, ast.Attribute)
        }
        self.called = {call.func for call in every if isinstance(call, ast.Call)}
        self.texts = USUAL_OUTCOMES.union(
            node.value
            for module, _ in own.classes
            for node in module.nodes
            if isinstance(node, ast.Constant) and isinstance(node.value, str)
        )
        self.is_state = own.root == "state"

    def fault(self, node: ast.Name, method: Method | None) -> ClassFault | None:
        """The fault of a name; None if another finding covers it, or if another template can
        define it."""
        word = Word(node.id, self.module.text.span(node))
        bound = node.id in self.anywhere
        if node in self.owners and node.id in USUAL_MODULES and not bound:
            return self._not_imported(node.id)
        if method is not None and node.id in ("self", "userdata", "ud", self.userdata):
            if method.name in self.early and node.id != "self":
                return self._early(node, word, method.name)
            return self._no_parameter(word, method)
        runs = method is not None and method.name == "execute"
        if node.id in self.outcomes:
            near: str | None = f'"{node.id}"'
        elif node.id in CONSTANTS and not bound:
            near = CONSTANTS[node.id]
        elif self._is_inherited(node, method) or (
            node.id in self.attributes and node not in self.kept
        ):
            near = f"self.{node.id}"
        elif node.id in SMACH_CLASSES and "smach" in self.module.names:
            near = f"smach.{node.id}"
        elif node.id in self.given and bound:
            return ClassFault(kind=LOST_ARGUMENT, name=word)
        elif node.id in self.inputs and self.userdata is not None and runs:
            near = f"{self.userdata}.{node.id}"
        elif self._is_text(node, bound):
            near = f'"{node.id}"'
        else:
            local = {name for part in walk_code(method) for name in _bound(part)} if method else ()
            known = {*self.module.names, *local} if bound else self.anywhere - BUILT_IN
            near = guesser(sorted(known)).unique_match(node.id)
        if near is None and not bound and not self.module.name:
            return None
        if near is None and bound:
            return ClassFault(kind=OTHER_SCOPE, name=word)
        return ClassFault(kind=UNDEFINED_NAME, name=word, near=near)

    def _is_text(self, node: ast.Name, bound: bool) -> bool:
        """Whether a name that nothing binds is probably a text without its quotes: the code has the
        same text at another place."""
        used = node in self.owners or node in self.called
        return not bound and not used and node.id in self.texts

    def _is_inherited(self, node: ast.Name, method: Method | None) -> bool:
        """Whether a function that a method calls is a method of `smach.State`."""
        first = method.args.args[0].arg if method is not None and method.args.args else ""
        called = self.is_state and first == "self" and node in self.called
        return called and node.id in STATE_METHODS

    def _early(self, node: ast.Name, word: Word, method: str) -> ClassFault:
        """The fault of the userdata in a method that runs before the state."""
        attributes = (
            attribute.attr
            for attribute in self.every
            if isinstance(attribute, ast.Attribute) and attribute.value is node
        )
        key = next(attributes, None)
        near = self.userdata or word.text
        near = f"{near}.{key}" if key is not None else near
        return ClassFault(kind=EARLY_USERDATA, name=word, near=near, more=method)

    def _no_parameter(self, word: Word, method: Method) -> ClassFault | None:
        """The fault of `self` or the userdata in a method that has no such parameter."""
        text = self.module.text
        given = [argument.arg for argument in method.args.args]
        if method.name == "execute":
            if word.text == "self" or len(given) != 2:
                return None  # a fault of the parameters of `execute`
            parameter = method.args.args[1]
            names = (part.id for part in walk_code(method) if isinstance(part, ast.Name))
            if parameter.arg in names:
                return ClassFault(kind=UNDEFINED_NAME, name=word, near=parameter.arg)
            start = text.offset(parameter.lineno, parameter.col_offset)
            place = Span(text.source, start, start + len(parameter.arg))
            return ClassFault(kind=OTHER_USERDATA, name=Word(parameter.arg, place), near=word.text)
        rest = text.source.text[: text.span(method.body[0]).start]
        if method.decorator_list or f"({', '.join(given)})" not in rest:
            return ClassFault(kind=OTHER_SCOPE, name=word)
        if word.text == "self":
            near = f"def {method.name}({', '.join(['self', *given])}):"
            start = text.source.text.find(method.name, text.span(method).start)
            place = Span(text.source, start, start + len(method.name))
            return ClassFault(kind=NO_SELF_PARAMETER, name=Word(method.name, place), near=near)
        near = f"def {method.name}({', '.join([*given, word.text])}):"
        return ClassFault(kind=LOST_USERDATA, name=word, near=near)

    def _not_imported(self, name: str) -> ClassFault:
        """A module that is not imported, at its first use in the file, or at the import of a module
        that nothing uses and whose name is one slip away."""
        text = self.module.text
        used = {name.id for name in self.every if isinstance(name, ast.Name)}
        for node in self.every:
            for alias in node.names if isinstance(node, ast.Import) else ():
                written = alias.asname or alias.name
                if written not in used and guesser([name]).unique_match(written) is not None:
                    start = text.offset(alias.lineno, alias.col_offset)
                    span = Span(text.source, start, start + len(alias.name))
                    return ClassFault(kind=WRONG_IMPORT, name=Word(alias.name, span), near=name)
        uses = (text.span(owner) for owner in self.owners
                if isinstance(owner, ast.Name) and owner.id == name)  # fmt: skip
        kind: FaultKind = NO_ROSPY_IMPORT if name == "rospy" else NO_IMPORT
        return ClassFault(kind=kind, name=Word(name, min(uses, key=lambda use: use.start)))


def _arguments(function: ast.FunctionDef) -> set[str]:
    """The names of the parameters of a function."""
    return {argument.arg for argument in walk_code(function.args) if isinstance(argument, ast.arg)}


def _declared_global(every: Iterable[ast.AST]) -> Iterator[str]:
    for node in every:
        if isinstance(node, ast.Global):
            yield from node.names


def _bound(node: ast.AST) -> Iterator[str]:
    """The names that a node binds, in any scope."""
    match node:
        case ast.Name(id=name, ctx=ast.Store() | ast.Del()) | ast.arg(arg=name):
            yield name
        case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name) | ast.ClassDef(name=name):
            yield name
        case ast.Import() | ast.ImportFrom():
            for alias in node.names:
                yield alias.asname or alias.name.partition(".")[0]
        case ast.Global() | ast.Nonlocal():
            yield from node.names
        case ast.ExceptHandler(name=str(name)) | ast.MatchAs(name=str(name)):
            yield name
        case ast.MatchStar(name=str(name)) | ast.MatchMapping(rest=str(name)):
            yield name
    for item in getattr(node, "type_params", ()):
        yield item.name


def _evaluated(node: ast.AST) -> Iterator[ast.AST]:
    """The nodes in a class without annotations, in their order."""
    todo: list[ast.AST] = [node]
    while todo:
        each = todo.pop()
        yield each
        skipped = {"annotation", "returns", "type_comment", "type_params"}
        parts: list[ast.AST] = []
        for name, value in ast.iter_fields(each):
            if name not in skipped:
                parts += [part for part in (value if isinstance(value, list) else [value])
                          if isinstance(part, ast.AST)]  # fmt: skip
        todo += reversed(parts)


def undefined_methods(own: OwnClass) -> list[ClassFault]:
    """The methods that a class calls on `self` and that neither it nor its bases define, each
    once; also the attributes that nothing sets."""
    modules = [*{id(module): module for module, _ in own.classes}.values()]
    defined = {name for names in own.names for name in names}
    if own.root == "unknown" or not LATE.isdisjoint(defined):
        return []
    if any(not DYNAMIC.isdisjoint(module.identifiers)
           or not LATE.isdisjoint(module.attributes["any"]) for module in modules):  # fmt: skip
        return []
    defined |= {
        attribute.attr
        for _, node in own.classes
        for attribute in walk_code(node)
        if isinstance(attribute, ast.Attribute) and isinstance(attribute.ctx, ast.Store)
    }
    use: AttributeUse = "outside" if own.root == "state" else "stored"
    elsewhere = [names for module in modules
                 for names in (module.attributes[use], module.compared)]  # fmt: skip
    usual = [*STATE_METHODS, *defined]
    defined |= INHERITED
    found, unread = list[ClassFault](), _only_unread(own, modules)
    constructor = own.method("__init__")
    arguments = walk_code(constructor[1].args) if constructor is not None else ()
    given = {argument.arg for argument in arguments if isinstance(argument, ast.arg)}
    for module, node in own.classes:
        others = of_other_objects(node)
        for inner in _evaluated(node):
            if not isinstance(inner, ast.Attribute) or not _of_self(inner) or inner in others:
                continue
            if inner.attr in defined or any(inner.attr in names for names in elsewhere):
                continue
            span = module.text.span(inner)
            quoted = any(inner.attr in one.constants for one in modules)
            if quoted or module.text.is_filled(span):
                continue
            word = Word(inner.attr, _end_of(span, inner.attr))
            defined.add(inner.attr)
            if inner.attr in given:
                found.append(ClassFault(kind=UNSET_ATTRIBUTE, name=word))
                continue
            known = {*usual, *(name for names in elsewhere for name in names)}
            near = guesser(sorted(name for name in known if not name.startswith("__")
                                  or name in STATE_METHODS))(inner.attr)  # fmt: skip
            calls = any(inner in one.called for one in modules)
            if near is None and not calls:
                near = unread
            if near is not None or calls:
                found.append(ClassFault(kind=UNDEFINED_METHOD, name=word, near=near))
            elif isinstance(inner.ctx, ast.Load) and constructor and inner not in caught(node):
                near = _suggested_value(module, inner.attr)
                found.append(ClassFault(kind=NEVER_SET, name=word, near=near))
    return found


def _suggested_value(module: Module, attribute: str) -> str:
    """The value that another class of a module gives to an attribute of the same name, or the call
    of a class with that name; `...` without one."""
    given = {
        " ".join(module.text.span(node.value).text.split())
        for node in module.nodes
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Attribute)
        and node.targets[0].attr == attribute and isinstance(node.value, ast.Call)
    }  # fmt: skip
    if len(given) == 1:
        return min(given)
    plain = attribute.replace("_", "").casefold()
    names = [name for name, bound in module.names.items()
             if name.casefold() == plain and isinstance(bound[-1], ast.ImportFrom)]  # fmt: skip
    return f"{names[0]}(...)" if len(names) == 1 else "..."


def _only_unread(own: OwnClass, modules: Iterable[Module]) -> str | None:
    """The only attribute that the constructor of a class sets and that no code of its modules
    reads."""
    found = own.method("__init__")
    if found is None:
        return None
    kept = {
        attribute.attr
        for attribute in walk_code(found[1])
        if isinstance(attribute, ast.Attribute)
        and _of_self(attribute)
        and isinstance(attribute.ctx, ast.Store)
    }
    unread = [name for name in kept
              if not any(name in module.attributes["read"] for module in modules)]  # fmt: skip
    return unread[0] if len(unread) == 1 else None


def undefined_in_base(own: OwnClass) -> Iterator[ClassFault]:
    """The methods that a class calls on `super()` and that no base class defines."""
    if own.root != "state" or any(not LATE.isdisjoint(names) for names in own.names):
        return
    for at, (module, node) in enumerate(own.classes):
        defined = INHERITED.union(*own.names[at + 1 :])
        usual = sorted(STATE_METHODS.union(*own.names[at + 1 :]))
        others = of_other_objects(node)
        for inner in _evaluated(node):
            match inner:
                case _ if inner in others:
                    continue
                case ast.Attribute(value=ast.Call(func=ast.Name(id="super"), args=[]), attr=name):
                    span = module.text.span(inner)
                case _:
                    continue
            if name in defined or module.text.is_filled(span):
                continue
            plain = name.strip("_") in ("init", "int")
            near = "__init__" if plain else guesser(usual)(name)
            word = Word(name, _end_of(span, name))
            yield ClassFault(kind=UNDEFINED_METHOD, name=word, near=near)


def _of_self(node: ast.Attribute) -> bool:
    return isinstance(node.value, ast.Name) and node.value.id == "self"


def _end_of(span: Span, name: str) -> Span:
    """The place of the last name in an expression such as `self.name`."""
    return Span(span.source, span.end - len(name), span.end)
