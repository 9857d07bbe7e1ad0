"""The blocks `body` of the user's templates of SMACHA's kind, and faults of the line in them that
makes the state."""

from __future__ import annotations

import ast
import builtins
import keyword
import re
from collections.abc import Iterator, Sequence

from smachac.diagnostics.diagnostic import Related
from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind
from smachac.ir.leaf import variable
from smachac.ir.nodes import Leaf, Machine
from smachac.ir.traversal import walk
from smachac.pysource.faults.base_calls import TOO_MANY_ARGUMENTS
from smachac.pysource.faults.class_names import UNDEFINED_NAME
from smachac.pysource.modules.modules import template_module
from smachac.pysource.modules.source import PythonText
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import StateFault, TemplateBody, UserCode

ARGUMENT_ORDER = FaultKind(
    name="argument order",
    message="the template passes its arguments in another order than `__init__` of `{name}`"
    " has its parameters",
    help="write `{near}`",
    effect="{more}",
)
NO_KEYWORD = FaultKind(
    name="no keyword",
    message="the template passes `{word}`, but `__init__` of `{name}` has no parameter `{word}`",
    help="its parameters are {more}",
    near_help=SUGGESTION,
    effect="the call raises a TypeError when the program makes the state",
    stops=True,
)
NO_ARGUMENT_HERE = FaultKind(
    name="no argument here",
    message="the template does not pass `{word}`, which `__init__` of `{name}` requires",
    help="add `{word}={{{{ {word} }}}}` to the call, or give `{word}` a default value in"
    " `__init__`",
    effect="the call raises a TypeError when the program makes the state",
    stops=True,
)
NO_QUOTES = FaultKind(
    name="no quotes",
    message="the template prints the text of `{word}` without quotes: here the name"
    " `{more}`, which nothing defines",
    help="write `{near}`",
    effect="the program stops with a NameError when it makes the state",
    stops=True,
)

_BODY = re.compile(r"\{%[-+]?\s*block\s+body\b[^%]*%\}(.*?)\{%[-+]?\s*endblock\b", re.DOTALL)
_ARGUMENT = re.compile(
    r"(?P<quote>['\"]?)\{\{\s*(?P<name>\w+)\s*(?P<filter>\|[\s\w|]+)?\}\}(?P=quote)"
    r"\s*(?P<end>[,)]|(?=\{%))\s*"
)
_CLASS_NAME = r"\{\{-?\s*class_name\s*-?\}\}"
_WORD = re.compile(r"[^\W\d]\w*")


def template_bodies(machine: Machine, library: UserCode) -> Iterator[TemplateBody]:
    """The blocks `body` of the user's templates, at the first state of each type."""
    done = set[str]()
    for _, leaf in walk(machine.root):
        if not isinstance(leaf, Leaf) or leaf.type in done:
            continue
        done.add(leaf.type)
        type_ = machine.state_types.get(leaf.type)
        file = type_.code.get("python", "") if type_ is not None else ""
        template = library.own_template(file) if file and ":" not in file else None
        block = _BODY.search(template.text) if template is not None else None
        if type_ is not None and template is not None and block is not None:
            call = _callee(leaf.type, leaf).search(block[1])
            yield TemplateBody(template, block, call, type_, leaf)


def body_faults(
    machine: Machine, library: UserCode, bodies: Sequence[TemplateBody]
) -> Iterator[StateFault]:
    """The faults of the line that makes the state, in the blocks `body` of a machine."""
    names = _names(machine, library) if bodies else set()
    for template, block, _, _, leaf in bodies:
        fault = _call_fault(template, block, leaf, names)
        if fault is not None:
            used = Related(span=leaf.span, message=f"`{leaf.name}` is of the type `{leaf.type}`")
            yield StateFault(fault[0], "python", leaf.type, fault[1], (used,))


def _names(machine: Machine, library: UserCode) -> set[str]:
    """The names that the Python in the user's templates binds."""
    found = {*dir(builtins), *keyword.kwlist}
    for type_ in machine.state_types.values():
        file = type_.code.get("python", "") if not type_.built_in else ""
        template = library.own_template(file) if file and ":" not in file else None
        if template is None:
            continue
        try:
            module = template_module(template)
        except (RecursionError, MemoryError, ValueError):
            module = None
        found.update(module.names if module is not None else _WORD.findall(template.text))
    return found


def _call_fault(
    template: Source, body: re.Match[str], leaf: Leaf, names: set[str]
) -> tuple[ClassFault, str] | None:
    """The fault of the call that makes the state, with the name of its class."""
    made = _maker(template)
    if made is None:
        return None
    name, maker, text = made
    unknown = _unknown_class(text, body, name, leaf, names)
    if unknown is not None:
        return ClassFault(kind=UNDEFINED_NAME, name=unknown, near=name), name
    parameters = [argument.arg for argument in maker.args.args[1:]]
    start = _callee(name, leaf)
    unfit = _argument_fault(text, body, name, maker, leaf)
    if unfit is not None:
        return unfit, name
    calls = [*start.finditer(template.text, *body.span(1))]
    if len(calls) != 1:
        return None
    (call,) = calls
    given: list[re.Match[str]] = []
    at = call.end()
    while (found := _ARGUMENT.match(template.text, at)) is not None:
        given.append(found)
        at = found.end()
        if found["end"] != ",":
            break
    order = [match_["name"] for match_ in given]
    due = parameters[: len(order)]
    if order != due and sorted(order) == sorted(due) and len({*order}) == len(order):
        by_name = {match_["name"]: match_[0].rstrip(" ,)\n\t") for match_ in given}
        near = ", ".join(by_name[text] for text in due)
        near = f"{call[0]}{near})" if given[-1]["end"] == ")" else near
        place = Span(template, given[0].start(), given[-1].start("end"))
        gets = [f"`{wanted}` gets the value of `{name_}`"
                for wanted, name_ in zip(due, order, strict=True) if wanted != name_]  # fmt: skip
        word = Word(place.text, place)
        more = ", and ".join(gets[:2])
        return ClassFault(kind=ARGUMENT_ORDER, name=word, near=near, more=more), name
    for match_ in given:
        value = (
            variable(leaf, match_["name"]) if not (match_["quote"] or match_["filter"]) else None
        )
        if isinstance(value, str) and value.isidentifier() and value not in names:
            place = Span(template, match_.start(), match_.start("end"))
            word = Word(place.text.rstrip(), place)
            near = f"'{word.text}'"
            return ClassFault(kind=NO_QUOTES, name=word, near=near, more=value), name
    return None


def _unknown_class(
    text: PythonText, body: re.Match[str], name: str, leaf: Leaf, names: set[str]
) -> Word | None:
    """The only call of a class in the block `body`, of a name that is like that of the only class
    of the template, and that no template of the user binds."""
    if _callee(name, leaf).search(text.source.text, *body.span(1)):
        return None
    guess = guesser([name])
    found = [
        Word(node.func.id, span)
        for node in walk_code(text.tree)
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name)
        if (span := text.span(node.func)) and body.start(1) <= span.start < body.end(1)
        if node.func.id not in names and not text.is_filled(span)
    ]
    return found[0] if len(found) == 1 and guess.unique_match(found[0].text) else None


def _callee(name: str, leaf: Leaf) -> re.Pattern[str]:
    """The start of a call of a class, also under the name `class_name` that each template has."""
    written = rf"\b{re.escape(name)}"
    own = name == re.sub(r"\W+", "_", leaf.type)
    return re.compile(rf"(?:{written}|{_CLASS_NAME})\(" if own else rf"{written}\(")


def _maker(template: Source) -> tuple[str, ast.FunctionDef, PythonText] | None:
    """The only class in a template, with its constructor and the Python of the template."""
    try:
        module = template_module(template)
    except (RecursionError, MemoryError, ValueError):
        return None
    classes = [class_ for class_ in module.text.tree.body if isinstance(class_, ast.ClassDef)
               ] if module is not None else []  # fmt: skip
    if module is None or len(classes) != 1:
        return None
    makers = [function for function in classes[0].body
              if isinstance(function, ast.FunctionDef) and function.name == "__init__"]  # fmt: skip
    if len(makers) != 1:
        return None
    return classes[0].name, makers[0], module.text


def _argument_fault(
    text: PythonText, body: re.Match[str], name: str, maker: ast.FunctionDef, leaf: Leaf
) -> ClassFault | None:
    """An argument of the call of the constructor that this does not have, or lacks."""
    call = _only_call(text, body, _callee(name, leaf))
    taken = maker.args
    known = [argument.arg for argument in (*taken.args[1:], *taken.kwonlyargs)]
    if call is None or maker.decorator_list or text.is_filled(text.span(maker)):
        return None
    positional = [argument.arg for argument in (*taken.posonlyargs, *taken.args)][1:]
    given = {other.arg for other in call.keywords}
    passed = {*positional[: len(call.args)], *given}
    for argument in call.keywords:
        word = argument.arg
        if word is None or word in known or taken.kwarg is not None:
            continue
        start = text.offset(argument.lineno, argument.col_offset)
        span = Span(text.source, start, start + len(word))
        left = [text for text in known if text not in passed]
        near = left[0] if len(left) == 1 else guesser(left)(word)
        more = ", ".join(f"`{text}`" for text in known) or "only `self`"
        if not text.is_filled(span):
            return ClassFault(kind=NO_KEYWORD, name=Word(word, span), near=near, more=more)
    if None in given or not _is_counted(text, call, {*known, *positional}):
        return None
    if len(call.args) > len(positional) and taken.vararg is None:
        span = text.span(call.args[len(positional)])
        more = ", ".join(f"`{text}`" for text in positional) or "only `self`"
        return ClassFault(kind=TOO_MANY_ARGUMENTS, name=Word(span.text, span), owner=name,
                          more=more)  # fmt: skip
    due = positional[: len(positional) - len(taken.defaults)]
    due += [
        argument.arg
        for argument, default in zip(taken.kwonlyargs, taken.kw_defaults, strict=True)
        if default is None
    ]
    unused = {other.name for other in (*leaf.written, *leaf.variables)}  # SM003
    missing = [text for text in due if text not in passed and text not in unused]
    span = text.span(call.func)
    if not text.is_filled(Span(span.source, span.end - 1, span.end)):
        span = Span(span.source, span.end - len(name), span.end)
    return ClassFault(kind=NO_ARGUMENT_HERE, name=Word(missing[0], span)) if missing else None


def _only_call(text: PythonText, body: re.Match[str], start: re.Pattern[str]) -> ast.Call | None:
    """The only call of a class in the block `body`, also behind an expression of Jinja that prints
    nothing: `{{ '' }}Measure(...)`."""
    starts = {match_.end() - 1 for match_ in start.finditer(text.source.text, *body.span(1))}
    found = [call for call in walk_code(text.tree)
             if isinstance(call, ast.Call) and isinstance(call.func, ast.Name)
             and text.span(call.func).end in starts]  # fmt: skip
    return found[0] if len(found) == 1 else None


def _is_counted(text: PythonText, call: ast.Call, known: set[str]) -> bool:
    """Whether each argument of a call is one argument in the program, whatever Jinja prints."""
    if any(isinstance(argument, ast.Starred) for argument in call.args):
        return False
    whole = text.span(call)
    for filling in text.fillings(Span(whole.source, text.span(call.func).end, whole.end)):
        word = filling.removeprefix("{{").removesuffix("}}").strip()
        if not filling.startswith("{{") or word not in known:
            return False
    return True
