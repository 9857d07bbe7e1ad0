"""Slips in what a class passes to calls and gets from them: a call in place of a function, results
in another order, a wrong number of values in a text, a function in place of its module."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from inspect import isbuiltin, isclass, isfunction

from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind
from smachac.pysource.class_members import enumeration_of
from smachac.pysource.functions import is_plain, returns_of
from smachac.pysource.library_names import MODULES, is_shadowed, module_of_library
from smachac.pysource.modules import Module, OwnClass, of_other_objects
from smachac.pysource.own_objects import Objects
from smachac.pysource.silent_results import called_function, is_silent
from smachac.pysource.swapped_arguments import (
    MethodCode,
    called_code,
    swapped_arguments,
    takes_self,
)
from smachac.pysource.user_code import UserCode
from smachac.pysource.userdata_parts import tried_code

EXTRA_ARGUMENT = FaultKind(
    name="extra argument",
    message="`{owner}` has no parameter for `{word}`",
    help="its parameters are those of `{near}`",
    effect="the call raises TypeError when it runs: the machine stops",
)
LACKING_ARGUMENT = FaultKind(
    name="lacking argument",
    message="this call of `{word}` does not pass `{more}`",
    help="write `{near}`",
    effect="the call raises TypeError when it runs: the machine stops",
)
UNKNOWN_KEYWORD = FaultKind(
    name="unknown keyword",
    message="`{owner}` has no parameter `{word}`",
    help="remove it, or add it to the parameters",
    near_help=SUGGESTION,
    effect="the call raises TypeError when it runs: the machine stops",
)
CALLED_EARLY = FaultKind(
    name="called early",
    message="`{word}` is called here: `{more}` gets its result, None, in place of the function",
    help="write `{near}`",
    effect="the function runs at once, and not later",
    accepted=True,
)
OTHER_ORDER = FaultKind(
    name="other order",
    message="`{owner}` returns its results in another order: the code compares `{word}`"
    " with values that only the {more} result has",
    help="write `{near}`",
    effect="the comparison has the same result in every run",
    accepted=True,
)
NUMBER_OF_VALUES = FaultKind(
    name="number of values",
    message="the text has {more}, but gets {file}",
    help="write one value for each place",
    effect="the code raises {word} when it runs: the machine stops",
)
NO_MODULE_HERE = FaultKind(
    name="no module here",
    message="`{word}` is a {owner} here, not the module `{word}`: it has no `{more}`",
    help="write `{near}`",
    effect="the code raises AttributeError when it runs: the machine stops",
)

TAKERS: Mapping[str, tuple[int, str]] = {
    "Timer": (1, "function"),
    "Thread": (1, "target"),
    "signal": (1, "handler"),
    "add_done_callback": (0, "fn"),
    "on_shutdown": (0, "h"),
    "Subscriber": (2, "callback"),
    "create_timer": (1, "callback"),
    "create_subscription": (2, "callback"),
}
"""Functions that call another one later: the position and the name of their parameter for it."""

WITHOUT_ARGUMENTS = frozenset(["Timer", "Thread", "on_shutdown", "create_timer"])
"""Those of them that pass no arguments. `rospy.Timer` passes one."""

_PLACE = re.compile(r"%(?:\((\w+)\))?[#0\- +]*(\*|\d+)?(?:\.(\*|\d+))?[hlL]?([diouxXeEfFgGcrsa%])")
_FIELD = re.compile(r"\{\{|\}\}|\{([^{}]*)\}")


def call_slips(own: OwnClass, library: UserCode) -> Iterator[ClassFault]:
    """The slips in the calls of a class and of its base classes."""
    objects = Objects(own, library)
    for module, node in own.classes:
        others = of_other_objects(node)
        for method in node.body:
            if not isinstance(method, ast.FunctionDef):
                continue
            every = [each for each in ast.walk(method) if each not in others]
            tried = tried_code(every)
            every = [each for each in every if each not in tried]
            code = MethodCode(own, module, node, method, every, objects)
            found = [
                *_called_early(code),
                *_in_other_order(own, module, method, every, library),
                *_wrong_numbers(module, every),
                *_no_modules(module, method, every, library),
                *swapped_arguments(code),
                *_wrong_counts(code),
            ]
            yield from (each for each in found if not module.text.is_filled(each.name.span))


# --- a call in place of a function


def _called_early(code: MethodCode) -> Iterator[ClassFault]:
    """The calls of functions without a result that are passed where the function is needed."""
    own, module, node, method, every, objects = code
    for each in every:
        match each:
            case ast.Call(func=ast.Attribute(attr=name) | ast.Name(id=name)) if name in TAKERS:
                pass
            case _:
                continue
        at, keyword = TAKERS[name]
        given = [value.value for value in each.keywords if value.arg in (keyword, "callback")]
        given += each.args[at : at + 1]
        for call in given:
            if not isinstance(call, ast.Call) or isinstance(call.func, ast.Call):
                continue
            found = called_function(own, module, method, call.func, objects.library)
            called = found[1] if found is not None else objects.method(module, node, call.func)
            if called is None or not is_silent(called):
                continue
            span = module.text.span(call)
            text = " ".join(span.text.split())
            near = module.text.span(call.func).text
            if call.args or call.keywords:
                near = f"lambda{'' if name in WITHOUT_ARGUMENTS else ' *_'}: {text}"
            more = module.text.span(each.func).text
            yield ClassFault(kind=CALLED_EARLY, name=Word(text, span), near=near, more=more)


# --- results in another order


def _in_other_order(
    own: OwnClass,
    module: Module,
    method: ast.FunctionDef,
    every: Sequence[ast.AST],
    library: UserCode,
) -> Iterator[ClassFault]:
    """The names that get the results of a function in another order: one of them is compared with
    values of a kind that only another result has."""
    unpacked = [each for each in every if isinstance(each, ast.Assign)
                and len(each.targets) == 1 and isinstance(each.targets[0], ast.Tuple)
                and isinstance(each.value, ast.Call)]  # fmt: skip
    if not unpacked:
        return
    names = [each for each in ast.walk(method) if isinstance(each, ast.Name)]
    bound = Counter(each.id for each in names if not isinstance(each.ctx, ast.Load))
    for each in unpacked:
        target, call = each.targets[0], each.value
        assert isinstance(target, ast.Tuple)
        assert isinstance(call, ast.Call)
        local = [one.id if isinstance(one, ast.Name) else "" for one in target.elts]
        if not all(local) or any(bound[name] != 1 for name in local):
            continue
        found = called_function(own, module, method, call.func, library)
        kinds = _kinds(*found, len(local), library) if found is not None else None
        if kinds is None:
            continue
        for at, kind in enumerate(_compared_kinds(module, every, local, library)):
            fits = [place for place, other in enumerate(kinds) if other == {kind}]
            if kind is None or "" in kinds[at] or kind in kinds[at] or len(fits) != 1:
                continue
            right = list(local)
            right[at], right[fits[0]] = right[fits[0]], right[at]
            span = module.text.span(target)
            rest = " ".join(module.text.span(call).text.split())
            yield ClassFault(
                kind=OTHER_ORDER,
                name=Word(local[at], span),
                near=f"{', '.join(right)} = {rest}",
                owner=found[1].name if found is not None else "",
                more=f"{_ORDINALS[fits[0]]}" if fits[0] < len(_ORDINALS) else "another",
            )
            break


_ORDINALS = ("first", "second", "third", "fourth")


def _kinds(
    module: Module, function: ast.FunctionDef, number: int, library: UserCode
) -> list[set[str]] | None:
    """The kinds of the results of a function at each position, empty for one that is not known;
    None if it returns anything but tuples of that length."""
    returns = [*returns_of(function.body)] if is_plain(function) else []
    values = [each.value for each in returns]
    found: list[set[str]] = [set() for _ in range(number)]
    for value in values:
        if not isinstance(value, ast.Tuple) or len(value.elts) != number:
            return None
        for kinds, each in zip(found, value.elts, strict=True):
            kinds.add(_kind(module, each, library))
    return found if values else None


def _compared_kinds(
    module: Module, every: Sequence[ast.AST], local: Sequence[str], library: UserCode
) -> list[str | None]:
    """For each name the one kind of the values with which code compares it; None without one."""
    found: dict[str, set[str]] = {}
    for each in every:
        match each:
            case ast.Compare(
                left=ast.Name(id=name),
                ops=[ast.Is() | ast.IsNot() | ast.Eq() | ast.NotEq()],
                comparators=[other],
            ) if name in local:
                found.setdefault(name, set()).add(_kind(module, other, library))
    kinds = [[*found.get(name, ())] for name in local]
    return [each[0] if len(each) == 1 and each[0] else None for each in kinds]


def _kind(module: Module, node: ast.expr, library: UserCode) -> str:
    """The kind of a value: an enumeration, or a type of Python. Empty if it is not known; None is
    of no kind that can be compared."""
    match node:
        case ast.Constant(value=bool()):
            return "bool"
        case ast.Constant(value=str()) | ast.JoinedStr():
            return "str"
        case ast.Constant(value=int() | float()):
            return "number"
        case ast.List() | ast.ListComp():
            return "list"
        case ast.Dict() | ast.DictComp():
            return "dict"
        case ast.Attribute(value=ast.Name(id=name)) if name[0].isupper():
            found = enumeration_of(module, name, library)
            return f"enum {found.name}" if found is not None else ""
    return ""


# --- too few or too many arguments


def _wrong_counts(code: MethodCode) -> Iterator[ClassFault]:
    """The calls of functions and methods of the project that lack an argument, or pass one that the
    function does not have."""
    module, method = code.module, code.method
    for call in code.nodes:
        if not isinstance(call, ast.Call) or any(each.arg is None for each in call.keywords):
            continue
        if any(isinstance(each, ast.Starred) for each in call.args):
            continue
        called = called_code(code, call)
        if called is None:
            continue
        taken = called.args
        names = [each.arg for each in (*taken.posonlyargs, *taken.args)]
        due = names[: len(names) - len(taken.defaults)]
        if takes_self(call, called):
            names, due = names[1:], due[1:]
        pairs = zip(taken.kwonlyargs, taken.kw_defaults, strict=True)
        due += [each.arg for each, default in pairs if default is None]
        passed = {*names[: len(call.args)], *(each.arg for each in call.keywords)}
        missing = [name for name in due if name not in passed]
        span = module.text.span(call)
        head = " ".join(module.text.span(call.func).text.split())
        by_name = [each.arg for each in (*taken.args, *taken.kwonlyargs)]
        unknown = [each.arg for each in call.keywords if each.arg and each.arg not in by_name]
        is_base = called.name == "__init__" and isinstance(call.func, ast.Attribute)
        if unknown and taken.kwarg is None and not is_base:
            free = [name for name in by_name if name not in passed and name != "self"]
            near = guesser(free)(unknown[0]) or (free[0] if len(free) == 1 else None)
            keyword = next(each for each in call.keywords if each.arg == unknown[0])
            start = module.text.offset(keyword.lineno, keyword.col_offset)
            place = Span(module.text.source, start, start + len(unknown[0]))
            word = Word(unknown[0], place)
            yield ClassFault(kind=UNKNOWN_KEYWORD, name=word, near=near, owner=head)
            continue
        if len(call.args) > len(names) and taken.vararg is None:
            more = module.text.span(call.args[len(names)])
            near = ", ".join([*names, *(each.arg for each in taken.kwonlyargs)])
            word = Word(" ".join(more.text.split()), more)
            yield ClassFault(kind=EXTRA_ARGUMENT, name=word, near=f"{head}({near})", owner=head)
        elif missing and not is_base:
            near, lacking = _completed(module, method, call, names, missing[0])
            yield ClassFault(kind=LACKING_ARGUMENT, name=Word(head, span), more=lacking, near=near)


def _completed(
    module: Module, method: ast.FunctionDef, call: ast.Call, names: Sequence[str], missing: str
) -> tuple[str, str]:
    """The text of a call with one more argument, and its parameter: the one before an argument that
    has the name of the next parameter, if there is one."""
    head = " ".join(module.text.span(call.func).text.split())
    given = [" ".join(module.text.span(each).text.split()) for each in call.args]
    more = [f"{each.arg}={' '.join(module.text.span(each.value).text.split())}"
            for each in call.keywords]  # fmt: skip
    local = {each.id for each in ast.walk(method) if isinstance(each, ast.Name)}
    local |= {each.arg for each in ast.walk(method.args) if isinstance(each, ast.arg)}
    for at, (name, value) in enumerate(zip(names, call.args, strict=False)):
        own = getattr(value, "attr", None) or getattr(value, "id", None)
        if own in names[at + 1 : at + 2]:
            given.insert(at, name if name in local else "...")
            return f"{head}({', '.join([*given, *more])})", name
    added = f"{missing}={missing if missing in local else '...'}"
    return f"{head}({', '.join([*given, *more, added])})", missing


# --- values in a text


def _wrong_numbers(module: Module, every: Sequence[ast.AST]) -> Iterator[ClassFault]:
    """The texts with another number of places than values: `"%s of %s" % (a,)`."""
    for each in every:
        match each:
            case ast.BinOp(
                op=ast.Mod(), left=ast.Constant(value=str() as text), right=ast.Tuple(elts=values)
            ):
                places, exact = _places(text), True
            case ast.Call(
                func=ast.Attribute(value=ast.Constant(value=str() as text), attr="format"),
                args=values,
                keywords=[],
            ):
                places, exact = _fields(text), False
            case _:
                continue
        if places is None or any(isinstance(value, ast.Starred) for value in values):
            continue
        given = len(values)
        if given == places or (given > places and not exact):
            continue
        error = "TypeError" if exact else "IndexError"
        span = module.text.span(each)
        yield ClassFault(
            kind=NUMBER_OF_VALUES,
            name=Word(error, span),
            more=f"{places} place{'s' * (places != 1)} for values",
            file=f"{given} value{'s' * (given != 1)}",
        )


def _places(text: str) -> int | None:
    """The number of values that `%` needs for a text; None if it has names, or is not valid."""
    count, at = 0, text.find("%")
    while at >= 0:
        found = _PLACE.match(text, at)
        if found is None or found[1]:
            return None
        count += (found[4] != "%") + (found[2] == "*") + (found[3] == "*")
        at = text.find("%", found.end())
    return count


def _fields(text: str) -> int | None:
    """The number of values that `format` needs for a text, all of whose fields have no name and no
    number; None for another text."""
    inner = [found[1] for found in _FIELD.finditer(text) if found[1] is not None]
    plain = all(re.match(r"(?:$|[.\[!:])", each) for each in inner)
    rest = _FIELD.sub("", text)
    return len(inner) if plain and "{" not in rest and "}" not in rest else None


# --- a function in place of its module


def _no_modules(
    module: Module, method: ast.FunctionDef, every: Sequence[ast.AST], library: UserCode
) -> Iterator[ClassFault]:
    """The names of modules of Python's library under which the file imports a function or class of
    the module: `from time import time`, and then `time.sleep(1)`."""
    done = set[str]()
    for each in every:
        match each:
            case ast.Attribute(value=ast.Name(id=name) as head, attr=attribute) if name in MODULES:
                pass
            case _:
                continue
        match module.names.get(name, ()):
            case (ast.ImportFrom(module=source, level=0, names=names),) if source == name:
                pass
            case _:
                continue
        if name in done or module.dynamic or all((one.asname or one.name) != name or one.name
                                                 != name for one in names):  # fmt: skip
            continue
        if _is_local(method, name) or is_shadowed(name, library):
            continue
        found = module_of_library(name)
        kept = getattr(found, name, None)
        if found is None or not (isclass(kept) or isfunction(kept) or isbuiltin(kept)):
            continue
        if hasattr(kept, attribute) or not hasattr(found, attribute):
            continue
        done.add(name)
        calls = any(isinstance(one, ast.Call) and isinstance(one.func, ast.Name)
                    and one.func.id == name for one in ast.walk(module.text.tree))  # fmt: skip
        near = f"import {name}` in place of `from {name} import {name}"
        if attribute == name:
            near = f"{name}` in place of `{name}.{name}"
        elif calls or isclass(kept):
            near = f"from {name} import {', '.join(sorted([attribute, name]))}`, and here `"
            near += attribute
        what = "class" if isclass(kept) else "function"
        yield ClassFault(kind=NO_MODULE_HERE, name=Word(name, module.text.span(head)), near=near,
                         owner=what, more=attribute)  # fmt: skip


def _is_local(method: ast.FunctionDef, name: str) -> bool:
    """Whether a method binds a name itself."""
    return any(
        (isinstance(each, ast.arg) and each.arg == name)
        or (isinstance(each, ast.Name) and each.id == name and not isinstance(each.ctx, ast.Load))
        for each in ast.walk(method)
    )
