"""The constructors of a C++ class, compared with what a program passes: the objects of `with`, then
the variables of the interface.

A class without a constructor, with default arguments, or with one constructor of several that fits,
is left to the compiler.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterator, Sequence
from typing import Literal

from smachac.diagnostics.source import NOWHERE, Word
from smachac.ir.class_facts import ClassFault, FaultKind
from smachac.records import dataclass
from smachac.targets.cpp.cpp_text import Part
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.types import UnportableError
from smachac.targets.cpp.user_classes import REFUSED, ClassCode, parameter_type

WRONG_CONSTRUCTOR = FaultKind(
    name="wrong constructor",
    message="the constructor of `{name}` has other parameters than the variables of its interface",
    help="write `{near}`",
    effect=REFUSED,
)
NO_FIRST_ARGUMENT = FaultKind(
    name="no first argument",
    message="the constructor of `{name}` takes {word} first, which the interface `{type}`"
    " does not provide",
    help='add `with: "{near}"` to `cpp` in the `code` of `{type}.yml`',
    effect=REFUSED,
)
NOT_IN_WITH = FaultKind(
    name="not in with",
    message="the constructor of `{name}` takes {word}, which is neither in `with` nor a"
    " variable of `{type}.yml`",
    help='write `with: "{near}"` in `{type}.yml`, or remove the parameter from the class',
    effect=REFUSED,
)
NO_CONSTRUCTOR_PARAMETER = FaultKind(
    name="no constructor parameter",
    message="the constructor of `{name}` lacks {word} {more}",
    help="write `{near}`",
    effect=REFUSED,
)
EXTRA_PARAMETER = FaultKind(
    name="extra parameter",
    message="the constructor of `{name}` takes `{word}`, which is not a variable of `{type}.yml`",
    help="write `{near}`, or add `{more}` to the `variables` of `{type}.yml`",
    effect=REFUSED,
)
PARAMETER_TYPE = FaultKind(
    name="parameter type",
    message="the constructor of `{name}` takes `{word}`, but the program passes a `{more}`",
    help="write `{near}`",
    effect=REFUSED,
)
PARAMETER_ORDER = FaultKind(
    name="parameter order",
    message="the constructor of `{name}` takes its parameters in another order than {owner}",
    help="write `{near}`",
    effect="{more}",
    accepted=True,
)
REFUSED_ORDER = FaultKind(
    name="refused order",
    message="the constructor of `{name}` takes its parameters in another order than {owner}",
    help="write `{near}`",
    effect=REFUSED,
)

Kind = Literal["number", "text", "items", "object", "other"]
"""The kinds of parameters: two kinds, except `other`, have no conversion between them."""

_NUMBER = re.compile(r"(?:const )?(?:double|float|bool|int|(?:std::)?u?int\d+_t)\b(?! ?[*<])")
_TEXT = re.compile(r"(?:const )?std::string(?: const)?(?: ?&{1,2})?(?= ?\w*$)")
_ITEMS = re.compile(r"(?:const )?std::(?:vector|array|map) ?<.*>(?: const)?(?: ?&{1,2})?(?= ?\w*$)")
_OBJECT = re.compile(r"(?!const\b|std::|smachac::)[\w:]+ ?[&*] ?(?=\w+$)")
_SCALARS = {"double": "float", "float": "float", "bool": "bool", "int": "int"}
"""The types of scripts for types of C++; other numbers are whole ones."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Parameter:
    """A parameter, written on one line: `const std::string &name`."""

    text: str
    start: int = 0
    end: int = 0

    @property
    def name(self) -> str:
        """The last word, without the underscore that keeps it apart from a member."""
        words: list[str] = re.findall(r"\w+", self.text)
        return words[-1].rstrip("_") if words else ""

    @property
    def kind(self) -> Kind:
        if _NUMBER.match(self.text):
            return "number"
        if _TEXT.match(self.text):
            return "text"
        if _ITEMS.match(self.text):
            return "items"
        return "object" if _OBJECT.match(self.text) else "other"

    @property
    def type(self) -> str:
        """The last word of the type: `Arm` of `my_robot::Arm &arm`."""
        words: list[str] = re.findall(r"\w+", self.text)
        return words[-2] if len(words) > 1 else ""


def constructor_faults(code: ClassCode, body: Part) -> Iterator[ClassFault]:
    """The fault of a class of which no constructor takes what a program passes."""
    wanted = _wanted(code)
    name = code.name.rpartition("::")[2]
    heads = list(body.members(re.compile(rf"(?<![~\w:]){re.escape(name)}\s*\(")))
    if wanted is None or not heads or "using" in body.text:
        return
    lists = [_parameters(body, head) for head in heads]
    own = lists[0]
    if own is None or None in lists:
        return
    word = body.word(name, heads[0].start(), heads[0].start() + len(name))
    if len(heads) > 1:
        if len(wanted) not in (len(list_) for list_ in lists if list_ is not None):
            yield ClassFault(kind=WRONG_CONSTRUCTOR, name=word, near=_written(name, wanted))
    elif len(own) == len(wanted):
        yield from _same_number(code, body, word, own, wanted)
    else:
        yield _other_number(code, body, word, own, wanted)


def _wanted(code: ClassCode) -> list[_Parameter] | None:
    """What a program passes: `const std::string &name`; None if it has no type in C++."""
    try:
        variables = [
            f"{parameter_type(variable.type)} {identifier(key)}".replace("& ", "&")
            for key, variable in code.type.variables.items()
        ]
    except UnportableError:
        return None
    texts = [*code.parameters, *variables]
    if any("std::any" in text for text in texts):
        return None
    return [_Parameter(text=text) for text in texts]


def _parameters(body: Part, head: re.Match[str]) -> list[_Parameter] | None:
    """The parameters of a constructor; None if they have defaults or other forms."""
    found = re.compile(r"([^()]*)\)").match(body.text, head.end())
    if found is None or re.search(r"[=\[\]{}]|\.\.\.", found[1]):
        return None
    pieces: list[_Parameter] = []
    start = depth = 0
    for at, letter in enumerate(f"{found[1]},"):
        depth += {"<": 1, ">": -1}.get(letter, 0)
        if letter == "," and depth == 0:
            text = found[1][start:at]
            first = head.end() + start + len(text) - len(text.lstrip())
            line = " ".join(text.split())
            pieces.append(_Parameter(text=line, start=first, end=first + len(text.strip())))
            start = at + 1
    return [] if [piece.text for piece in pieces] in ([""], ["void"]) else pieces


def _written(name: str, parameters: Sequence[_Parameter]) -> str:
    return f"{name}({', '.join(parameter.text for parameter in parameters)})"


def _in_words_of(own: Sequence[_Parameter], wanted: Sequence[_Parameter]) -> list[_Parameter]:
    """The wanted parameters, as the class writes them where it has them."""
    known = {parameter.name: parameter for parameter in own}
    return [
        known[parameter.name]
        if parameter.name in known and _fit(known[parameter.name], parameter)
        else parameter
        for parameter in wanted
    ]


def _fit(one: _Parameter, other: _Parameter) -> bool:
    """Whether two parameters can have the same type."""
    if one.kind == other.kind == "object":
        return one.type == other.type
    return "other" in (one.kind, other.kind) or one.kind == other.kind


def _same_number(
    code: ClassCode, body: Part, name: Word, own: list[_Parameter], wanted: list[_Parameter]
) -> Iterator[ClassFault]:
    """Parameters in another order, or a number in place of a text or of items."""
    pairs = [
        (one, parameter)
        for one, parameter in zip(own, wanted, strict=True)
        if one.name != parameter.name
    ]
    if pairs and sorted(parameter.name for parameter in own) == sorted(
        parameter.name for parameter in wanted
    ):
        near = _written(name.text, _in_words_of(own, wanted))
        name = body.word(name.text, pairs[0][0].start, pairs[-1][0].end)
        order = _order(code, {one.name for one, _ in pairs})
        if not all(_fit(one, parameter) for one, parameter in pairs):
            yield ClassFault(kind=REFUSED_ORDER, name=name, near=near, owner=order)
            return
        gets = " and ".join(
            f"`{one.name}` gets the value of `{parameter.name}`" for one, parameter in pairs
        )
        sure = all("other" not in (one.kind, parameter.kind) for one, parameter in pairs)
        more = f"it compiles, but {gets}" if sure else f"by their places, {gets}"
        yield ClassFault(kind=PARAMETER_ORDER, name=name, near=near, more=more, owner=order)
    for one, parameter in zip(own, wanted, strict=True) if not pairs else ():
        plain = one.kind != parameter.kind and {one.kind, parameter.kind} <= {
            "number",
            "text",
            "items",
        }
        if plain and "bool" not in one.text:
            place = body.word(one.text, one.start, one.end)
            yield ClassFault(
                kind=PARAMETER_TYPE, name=place, near=parameter.text, more=_type(parameter)
            )


def _type(parameter: _Parameter) -> str:
    """The type of a number or text: `std::string`."""
    return re.sub(r"^const | ?&* ?\w+$", "", parameter.text)


def _order(code: ClassCode, names: Collection[str]) -> str:
    """The order in which a program passes parameters."""
    file = f"`{code.type.name}.yml`"
    objects = {_Parameter(text=parameter).name for parameter in code.parameters}
    if objects.issuperset(names):
        return f"`with` in {file} has its objects"
    if objects.isdisjoint(names):
        return f"{file} has its variables"
    return f"the program passes them: first the objects of `with` in {file}, then its variables"


def _other_number(
    code: ClassCode, body: Part, name: Word, own: list[_Parameter], wanted: list[_Parameter]
) -> ClassFault:
    """Parameters that are missing, and those that a program does not pass."""
    names, known = {parameter.name for parameter in own}, {parameter.name for parameter in wanted}
    more = [parameter for parameter in own if parameter.name not in known]
    lacks = [parameter for parameter in wanted if parameter.name not in names]
    near = _written(name.text, _in_words_of(own, wanted))
    file = f"`{code.type.name}.yml`"
    if lacks and not more:
        objects = sum(lack.text in code.parameters for lack in lacks)
        whose = f"which `with` in {file} passes" if objects == len(lacks) else f"of {file}"
        listed = " and ".join(f"`{lack.text}`" for lack in lacks)
        return ClassFault(
            kind=NO_CONSTRUCTOR_PARAMETER, name=name._replace(text=listed), near=near, more=whose
        )
    if not lacks and _objects_before_variables(code, own, more):
        return _not_in_with(code, body, own, more)
    type_ = _script_type(more[0]) if len(more) == 1 and not lacks else ""
    if type_:
        place = body.word(more[0].text, more[0].start, more[0].end)
        variable = f"{more[0].name}: {{type: {type_}}}"
        return ClassFault(kind=EXTRA_PARAMETER, name=place, near=near, more=variable)
    return ClassFault(kind=WRONG_CONSTRUCTOR, name=name, near=near)


def _script_type(parameter: _Parameter) -> str:
    """The type of a script for a number or a text of C++; empty for others."""
    if parameter.kind == "number":
        return _SCALARS.get(parameter.text.removeprefix("const ").split()[0], "int")
    return "str" if parameter.kind == "text" else ""


def _objects_before_variables(
    code: ClassCode, own: list[_Parameter], more: list[_Parameter]
) -> bool:
    """Whether `with` can pass the parameters that it does not pass: they are objects, and all
    others have the order in which a program passes them."""
    given = [_Parameter(text=parameter).name for parameter in code.parameters]
    count = len(given) + len(more)
    variables = [_Parameter(text=identifier(variable)).name for variable in code.type.variables]
    return (
        [parameter.name for parameter in own[count:]] == variables
        and [parameter.name for parameter in own[:count] if parameter not in more] == given
        and all(parameter.kind == "object" for parameter in more)
    )


def _not_in_with(
    code: ClassCode, body: Part, own: list[_Parameter], more: list[_Parameter]
) -> ClassFault:
    """The fault that a constructor takes objects that `with` does not pass. The place is in the
    interface, if the class uses the first of them, and otherwise the parameter."""
    one, spans = more[0], code.type.class_spans
    text = " and ".join(f"`{parameter.text}`" for parameter in more)
    given = {_Parameter(text=parameter).name: parameter for parameter in code.parameters}
    objects = (given.get(parameter.name) or _qualified(parameter.text, code.name)
               for parameter in own[: len(given) + len(more)])  # fmt: skip
    near = ", ".join(re.sub(r" ([&*])", r"\1 ", object_) for object_ in objects)
    here = body.word("the constructor takes it here", one.start, one.end)
    if not given:
        place = Word(text, spans.get(("cpp", "class"), NOWHERE))
        return ClassFault(kind=NO_FIRST_ARGUMENT, name=place, near=near, also=here)
    if len(re.findall(rf"\b{re.escape(one.name)}\b", body.text)) == 1:
        return ClassFault(kind=NOT_IN_WITH, name=here._replace(text=text), near=near)
    place = Word(text, spans.get(("cpp", "with"), here.span))
    return ClassFault(kind=NOT_IN_WITH, name=place, near=near, also=here)


def _qualified(parameter: str, name: str) -> str:
    """A parameter whose type is written with the namespace of a class."""
    space = name.removeprefix("::").rpartition("::")[0]
    return f"{space}::{parameter}" if "::" not in parameter and space else parameter
