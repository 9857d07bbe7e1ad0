"""The values that a class of a state type writes to userdata keys, and what it does with those that
it gets or that Python does not return."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from smachac.diagnostics.source import Span, Word
from smachac.ir.class_facts import ClassFault, FaultKind
from smachac.pysource.modules.functions import alternatives, is_plain, returns_of, tried_code
from smachac.pysource.modules.modules import Module, OwnClass, find_function, of_other_objects
from smachac.pysource.modules.source import PythonText
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode
from smachac.pysource.values.class_operations import bound_once

NO_TUPLE = FaultKind(
    name="no tuple",
    message="`{word}` is a text, but `{name}` uses it as a list of names: only a comma"
    " makes a tuple",
    help="write `{near}`",
    effect="each letter of the text counts as a name",
)
NO_RESULT = FaultKind(
    name="no result",
    message="`{word}` changes a collection and returns None: `{owner}` becomes None",
    help="write `{near}`",
    effect="",
    accepted=True,
)

NOTHING_RETURNED = frozenset(
    ["append", "extend", "insert", "remove", "sort", "reverse", "clear", "update", "add", "discard"]
)
"""The methods of lists, dictionaries and sets that change them and return None."""

Written = tuple[tuple[str, Word], ...]


def written_values(own: OwnClass, execute: ast.FunctionDef, library: UserCode) -> Written:
    """The expressions that a class writes to userdata keys: `userdata.key = value`, in `execute`
    and in its other methods that have the userdata. Of a call of a function of the user, the texts
    that it returns are added; of a local variable with the result of one, the values that it can
    have, at the place of the variable."""
    found = []
    for module, function, userdata in _with_userdata(own, execute):
        for node in walk_code(function):
            key = _written_key(node, userdata)
            if key is None or not isinstance(node, ast.Assign):
                continue
            span = module.text.span(node.value)
            if not module.text.is_filled(span):
                found.append((key, Word(span.text, span)))
                found += [(key, word) for word in _results(own, module, node.value, library)]
                result = _result_in_local(own, module, function, node.value, library)
                found += [(key, Word(text, span)) for text in result]
    return tuple(found)


def _with_userdata(
    own: OwnClass, execute: ast.FunctionDef
) -> Iterator[tuple[Module, ast.FunctionDef, str]]:
    """The methods of a class that have the userdata, each with its name there."""
    parameter = execute.args.args[1].arg
    for name in dict.fromkeys(name for names in own.names for name in names):
        found = own.method(name)
        if found is None:
            continue
        given = [argument.arg for argument in found[1].args.args[1:]]
        if found[1] is execute:
            yield *found, parameter
        elif is_plain(found[1]):
            meant = [text for text in ("userdata", "ud", parameter) if text in given]
            yield from ((*found, text) for text in meant[:1])


def _written_key(node: ast.AST, userdata: str) -> str | None:
    """The key that a statement writes."""
    match node:
        case ast.Assign(targets=[ast.Attribute(value=ast.Name(id=name), attr=key)]):
            return key if name == userdata else None
        case ast.Assign(
            targets=[ast.Subscript(value=ast.Name(id=name), slice=ast.Constant(value=str(key)))]
        ):
            return key if name == userdata else None
    return None


def _results(own: OwnClass, module: Module, value: ast.expr, library: UserCode) -> Iterator[Word]:
    """The texts that a function or method of the user returns, if a value is a call of one."""
    for text, node in _returned(own, module, value, library):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            span = text.span(node)
            if not text.is_filled(span):
                yield Word(span.text, span)


def _returned(
    own: OwnClass, module: Module, value: ast.expr, library: UserCode
) -> Iterator[tuple[PythonText, ast.expr]]:
    """The values that a function or method of the user returns, if a value is a call of one."""
    if not isinstance(value, ast.Call):
        return
    match value.func:
        case ast.Attribute(value=ast.Name(id="self"), attr=name):
            found = None if name in own.assigned() else own.method(name)
        case ast.Name() | ast.Attribute():
            found = find_function(module, value.func, library)
        case _:
            return
    if found is None or not is_plain(found[1]):
        return
    for one in returns_of(found[1].body):
        for alternative in alternatives(one.value) if one.value is not None else ():
            yield found[0].text, alternative


def _result_in_local(
    own: OwnClass, module: Module, function: ast.FunctionDef, value: ast.expr, library: UserCode
) -> list[str]:
    """The values of a local variable that is bound once, to the result of a function or method of
    the user: texts, or lists. Empty if it can have other values beside None, or if `function`
    tests which one it has."""
    if not isinstance(value, ast.Name):
        return []
    every = [*walk_code(function)]
    result = dict(bound_once(every)).get(value.id)
    if result is None or _is_tested(every, value.id):
        return []
    returned = [
        (text.span(node), node)
        for text, node in _returned(own, module, result, library)
        if not (isinstance(node, ast.Constant) and node.value is None)
        and not text.is_filled(text.span(node))
    ]
    kinds = {
        "text" if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value
        else "list" if isinstance(node, ast.List) and node.elts
        else "other"
        for _, node in returned
    }  # fmt: skip
    return [span.text for span, _ in returned] if kinds in ({"text"}, {"list"}) else []


def _is_tested(every: list[ast.AST], name: str) -> bool:
    """Whether code compares a variable with more than None, uses its attributes, or passes it to
    `isinstance`: then some of its values may not be written."""

    def is_it(node: ast.AST) -> bool:
        return isinstance(node, ast.Name) and node.id == name

    for inner in every:
        match inner:
            case ast.Compare(left=left, comparators=others):
                sides = [left, *others]
                constants = [side for side in sides if not is_it(side)]
                is_none = all(isinstance(side, ast.Constant) and side.value is None
                              for side in constants)  # fmt: skip
                if any(map(is_it, sides)) and not is_none:
                    return True
            case ast.Attribute(value=owner) | ast.Match(subject=owner) if is_it(owner):
                return True
            case ast.Call(func=ast.Name(id="isinstance" | "type"), args=[first, *_]):
                if is_it(first):
                    return True
    return False


# --- loops over what the constructor gets


def loops(own: OwnClass) -> Written:
    """The attributes that a class loops over and that are a parameter of its constructor for ever,
    each with that parameter."""
    kept = kept_parameters(own)
    return tuple(_loops(own, kept)) if kept else ()


def kept_parameters(own: OwnClass) -> dict[str, str]:
    """The attributes that are a parameter of the constructor for ever, each with the parameter."""
    found = own.method("__init__")
    if found is None:
        return {}
    maker = found[1]
    changed = {name.id for name in walk_code(maker)
               if isinstance(name, ast.Name) and not isinstance(name.ctx, ast.Load)}  # fmt: skip
    given = {argument.arg for argument in (*maker.args.args[1:], *maker.args.kwonlyargs)} - changed
    kept: dict[str, str] = {}
    for name, entries in own.assigned().items():
        match entries:
            case [(_, ast.Name(id=parameter), _)] if parameter in given:
                kept[name] = parameter
    return kept


def _loops(own: OwnClass, kept: dict[str, str]) -> Iterator[tuple[str, Word]]:
    for module, node in own.classes:
        others = of_other_objects(node)
        every = [inner for inner in walk_code(node) if inner not in others]
        tried = tried_code(every)
        tested = any(isinstance(node, ast.Name) and node.id in ("isinstance", "type", "hasattr")
                     for node in every)  # fmt: skip
        for inner in every:
            match inner:
                case ast.For(iter=value) | ast.comprehension(iter=value):
                    pass
                case _:
                    continue
            match value:
                case ast.Attribute(value=ast.Name(id="self"), attr=name) if name in kept:
                    span = module.text.span(value)
                    if not (tested or value in tried or module.text.is_filled(span)):
                        yield kept[name], Word(span.text, span)


# --- results that are None


def lost_results(own: OwnClass) -> Iterator[ClassFault]:
    """A local variable or an attribute that becomes None: `names = names.sort()`, and
    `userdata.names = names.sort()`."""
    for module, node in own.classes:
        for function in node.body:
            if isinstance(function, ast.FunctionDef):
                yield from _lost(module, function)


def _lost(module: Module, function: ast.FunctionDef) -> Iterator[ClassFault]:
    every = [*walk_code(function)]
    assigns = [
        assignment
        for assignment in every
        if isinstance(assignment, ast.Assign) and len(assignment.targets) == 1
    ]
    for node in assigns:
        match node:
            case ast.Assign(
                targets=[ast.Name() | ast.Attribute() | ast.Subscript() as target],
                value=ast.Call(func=ast.Attribute(value=ast.Name(id=owner), attr=method)),
            ) if method in NOTHING_RETURNED:
                name = module.text.span(target).text
            case _:
                continue
        values = [assign.value for assign in assigns
                  if isinstance(assign.targets[0], ast.Name) and assign.targets[0].id == owner
                  and assign is not node]  # fmt: skip
        stores = [name for name in every if isinstance(name, ast.Name) and name.id == owner
                  and isinstance(name.ctx, ast.Store)]  # fmt: skip
        used = not isinstance(target, ast.Name)
        used = used or any(isinstance(inner, ast.Name) and inner.id == name
                   and isinstance(inner.ctx, ast.Load)
                   and (inner.lineno, inner.col_offset) > (node.end_lineno, node.end_col_offset)
                   for inner in every)  # fmt: skip
        known = values and len(values) + (owner == name) == len(stores)
        span = module.text.span(node)
        if known and used and all(map(_is_collection, values)) and not module.text.is_filled(span):
            near = _changed(name, owner, method, node.value, module)
            yield ClassFault(kind=NO_RESULT, name=Word(method, span), near=near, owner=name)


def _changed(name: str, owner: str, method: str, call: ast.expr, module: Module) -> str:
    """What was meant by the assignment of a result that is None."""
    text = module.text.span(call).text
    return text if name == owner else f"{text}`, and then `{name} = {owner}"


def _is_collection(value: ast.expr) -> bool:
    """Whether an expression is certainly a list, a dictionary or a set of Python."""
    match value:
        case ast.List() | ast.Dict() | ast.Set() | ast.ListComp() | ast.DictComp() | ast.SetComp():
            return True
        case ast.Call(func=ast.Name(id="list" | "dict" | "set" | "sorted")):
            return True
    return False


# --- tuples without their comma


def texts_as_lists(own: OwnClass) -> Iterator[ClassFault]:
    """A constant of the class that is a text in parentheses, `KEYS = ("part")`, where the class
    uses it as a list of names."""
    used = {name for _, node in own.classes for name in _used_as_list(node)}
    for (module, _), names in zip(own.classes, own.names, strict=True):
        for name, bound in names.items():
            match bound:
                case (ast.Assign(targets=[ast.Name()], value=ast.Constant(value=str()) as value),):
                    span = _in_parentheses(module, value)
                case _:
                    continue
            if name in used and span is not None and name not in own.assigned():
                near = f"({module.text.span(value).text},)"
                yield ClassFault(kind=NO_TUPLE, name=Word(name, span), near=near)


def _in_parentheses(module: Module, node: ast.expr) -> Span | None:
    """The place of an expression with the parentheses around it; None without them."""
    span = module.text.span(node)
    text = span.source.text
    start, end = len(text[: span.start].rstrip()) - 1, span.end
    while end < len(text) and text[end].isspace():
        end += 1
    if module.text.is_filled(span) or text[start] != "(" or text[end : end + 1] != ")":
        return None
    return Span(span.source, start, end + 1)


def _used_as_list(node: ast.ClassDef) -> Iterator[str]:
    """The attributes of the object that a class uses as lists."""
    for inner in walk_code(node):
        match inner:
            case ast.Call(func=ast.Name(id="list" | "tuple" | "set" | "sorted"), args=[value]):
                pass
            case ast.Starred(value=value):
                pass
            case ast.keyword(
                arg="outcomes" | "input_keys" | "output_keys" | "io_keys", value=value
            ):
                pass
            case _:
                continue
        match value:
            case ast.Attribute(value=ast.Name(), attr=name):
                yield name
