"""The declared interface of a C++ class: its outcomes, the fields of `In` and `Out`, its hash.

This is not a parser of C++. It reads classes in the form that `smachac new state` writes. A class
in another form (macros, fields with values, inherited members) is left to the compiler.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence

from smachac.diagnostics.source import NOWHERE, Word
from smachac.diagnostics.spelling import guesser
from smachac.frontend.loader import Library
from smachac.ir.class_facts import DID_YOU_MEAN, SUGGESTION, ClassFault, FaultKind
from smachac.ir.nodes import Key, StateType
from smachac.ir.types import STRUCTS, unknown_words
from smachac.pysource.class_reader import NO_EXECUTE
from smachac.pysource.modules.modules import CLASS_ELSEWHERE, NO_CLASS
from smachac.pysource.modules.other_modules import file_with
from smachac.pysource.modules.user_code import Declared, Difference, Words
from smachac.records import dataclass, replace
from smachac.targets.cpp.constructors import (
    EXTRA_PARAMETER,
    NO_CONSTRUCTOR_PARAMETER,
    WRONG_CONSTRUCTOR,
)
from smachac.targets.cpp.cpp_text import LONGEST, Part, class_head, outcome_words, without_literals
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.member_faults import WRONG_PARAMETERS, member_faults, signature_faults
from smachac.targets.cpp.records import project_names
from smachac.targets.cpp.types import UnportableError
from smachac.targets.cpp.user_classes import (
    REFUSED,
    ClassCode,
    class_code,
    field_type,
    interface_hash,
)

_NOT_FOUND = "the C++ compiler does not find it"
NO_HEADER = FaultKind(
    name="no module",
    message="the code of `{type}` is in the header `{word}`, which does not exist",
    help="correct the name in the `code` of `{type}.yml`, or create the header",
    near_help=DID_YOU_MEAN,
    effect=_NOT_FOUND,
    missing=True,
)
NO_CPP_CLASS = replace(NO_CLASS, effect=_NOT_FOUND, unnamed="the header that `{type}` names")
CPP_CLASS_ELSEWHERE = replace(
    CLASS_ELSEWHERE, effect=_NOT_FOUND, unnamed="the header that `{type}` names"
)
NO_CPP_EXECUTE = replace(NO_EXECUTE, effect=REFUSED)
NO_OUTCOME = FaultKind(
    name="no outcome",
    message="`Outcome` of `{name}` has no `{word}`",
    help="write one of {file}, or add it to `Outcome` and to the interface",
    near_help=SUGGESTION,
    effect=REFUSED,
)
NO_NUMBER = FaultKind(
    name="no number",
    message="the class `{name}` does not contain the number of its interface, `smachac_interface`",
    help="write in the class: `static constexpr std::uint32_t smachac_interface = {near};`",
    effect=REFUSED,
)
WRONG_NUMBER = FaultKind(
    name="wrong number",
    message="`{word}` is no number of C++",
    help="write `{near}`, the number of the interface",
    effect=REFUSED,
)

_USED_OUTCOME = re.compile(r"(?<![\w:])Outcome\s*::\s*([A-Za-z_]\w*)")
_STRUCT = r"\bstruct\s+{}\s*\{{"
_NUMBER = (
    r"\bsmachac_interface\s*[={]\s*(0[xX][\da-fA-F']{1,20}|\d[\d']{0,20})[uUlL]*\s*(?:\}\s*)?;"
)
_LITERAL = r"\bsmachac_interface\s*[={]\s*(\d[\w.']*)"
_LAST_WORD = re.compile(r"\b[A-Za-z_]\w*$")
_MACRO = re.compile(r"\b[A-Z][A-Z0-9_]{2,}\s*\(")
"""A call of what is probably a macro."""
_ARGUMENTS = re.compile(r"<[^<>]*>")
_ODD = re.compile(r"[#(){}\[\]=]|\b(?:using|static|template|typedef|mutable)\b")
"""Tokens that a simple list of fields does not contain."""

KNOWN = {"bool", "double", "float", "int", "std::int64_t", "std::string"}
"""Types, beside those of `smachac::`, whose spelling decides whether two of them are the same."""
CONTAINERS = {"std::array", "std::vector", "std::map", "std::optional"}


@dataclass(frozen=True, slots=True, kw_only=True)
class _Field:
    """A field of `In` or `Out`: its name and its type."""

    word: Word
    type: Word


def declared(type_: StateType, library: Library) -> Declared | None:
    """The interface that the class of a state type declares; None where it cannot be read."""
    code = class_code(type_)
    source = library.code(code.header) if code is not None else None
    if code is None:
        return None
    try:
        type_ = project_names(library).state_type(type_)
    except UnportableError:
        return None  # a record without a name: the target refuses the key
    if source is None:
        header = Word(code.header, type_.class_spans.get(("cpp", "header"), NOWHERE))
        return _absent(
            code, absent_header(header, library) or _header_elsewhere(header, code, library)
        )
    if len(source.text) > LONGEST:
        return None
    whole = Part(source=source, text=without_literals(source.text))
    name = code.name.rpartition("::")[2]
    if not re.search(rf"\b{re.escape(name)}\b|^\s*#\s*define\b", whole.text, re.M):
        word = Word(name, type_.class_spans.get(("cpp", "class"), NOWHERE))
        fault = _absent_class(word, whole, code.header)
        pattern = re.compile(class_head(name))
        other = file_with(pattern, code.header, (".hpp", ".h", ".hh"), library) if fault else None
        if fault is not None and other is not None:
            header_span = type_.class_spans.get(("cpp", "header"), word.span)
            fault = ClassFault(kind=CPP_CLASS_ELSEWHERE, name=Word(word.text, header_span),
                               file=fault.file, more=other, help=f"write `{other}`")  # fmt: skip
        return _absent(code, fault)
    head = whole.only(class_head(name))
    body = whole.inside(head)
    if head is None or body is None or "#" in body.text:
        return None
    derived = ":" in head["base"]
    inputs, outputs = (_fields(body, name, derived=derived) for name in ("In", "Out"))
    place = whole.word(name, *head.span("name"))
    outcomes = _outcomes(body, [outcome.name for outcome in type_.outcomes])
    # A misspelt type is reported in the interface; the class can fit the type that is meant.
    unsure = _has_unknown_type(type_)
    stale = _stale(body, interface_hash(type_)) if not unsure else None
    judged = not derived and not unsure
    stepped = method_of(body) == "step"
    judged = judged and not stepped  # the types of a stepped class are left to the compiler
    others = member_faults(code, whole, body, outcomes, library) if judged and not stale else ()
    return Declared(
        name=code.name.removeprefix("::"),
        span=place.span,
        outcomes=outcomes,
        inputs=_names(inputs, type_.input_keys),
        outputs=_names(outputs, type_.output_keys),
        others=(
            *(_other_fields(type_.name, "In", inputs, type_.input_keys) if not stepped else ()),
            *(_other_fields(type_.name, "Out", outputs, type_.output_keys) if not stepped else ()),
            *(_outdated(code, body) if judged and stale else ()),
        ),
        stale=stale,
        faults=(
            *_faults(body, place, outcomes, derived=derived),
            *_without_number(whole, body, place, interface_hash(type_), derived=derived or unsure),
            *others,
        ),
        uses=tuple(
            body.word(match_[1], *match_.span(1)) for match_ in _USED_OUTCOME.finditer(body.text)
        ),
        fields={
            **_new_fields("In", inputs, type_.input_keys),
            **_new_fields("Out", outputs, type_.output_keys),
        },
    )


def method_of(body: Part) -> str:
    """The function of a class that machines call: `execute`, else `step` for stepped machines;
    empty without either."""
    return next((name for name in ("execute", "step") if re.search(rf"\b{name}\b", body.text)), "")


def class_method(code: ClassCode, library: Library) -> str | None:
    """The function of a class that machines call; None where its header is not found or cannot be
    read, and where a base class can have it."""
    source = library.code(code.header)
    if source is None or len(source.text) > LONGEST:
        return None
    whole = Part(source=source, text=without_literals(source.text))
    head = whole.only(class_head(code.name.rpartition("::")[2]))
    body = whole.inside(head)
    if head is None or body is None or ":" in head["base"] or "#" in body.text:
        return None
    return method_of(body)


def _new_fields(
    part: str, fields: Sequence[_Field] | None, keys: Iterable[Key]
) -> dict[tuple[str, str], str]:
    """The help for each key that a struct lacks: its field."""
    found = {}
    what = "input key" if part == "In" else "output key"
    for key in keys if fields else ():
        try:
            text = f"{field_type(part, key.type)} {identifier(key.name)}".replace("& ", "&")
        except UnportableError:
            continue
        found[what, key.name] = f"write `{text};` in `{part}`"
    return found


def _has_unknown_type(type_: StateType) -> bool:
    """Whether the interface has a type that does not exist."""
    types = [variable.type for variable in type_.variables.values()]
    types += [key.type for key in (*type_.input_keys, *type_.output_keys)]
    return any(unknown_words(type_) for type_ in types)


def _absent(code: ClassCode, fault: ClassFault | None) -> Declared | None:
    """A class that does not exist."""
    name = code.name.removeprefix("::")
    return Declared(name=name, span=NOWHERE, faults=(fault,)) if fault is not None else None


def absent_header(header: Word, library: Library) -> ClassFault | None:
    """The fault that a header is in no searched folder; None where it can be an installed one.

    It is certain if its folder has other headers; without a folder, if one of them has nearly the
    same name.
    """
    folder, _, file = header.text.rpartition("/")
    others = [name for name in library.code_names(folder) if name.endswith((".hpp", ".h", ".hh"))]
    near = guesser(others)(file)
    if not others or (not folder and near is None):
        return None
    meant = f"{folder}/{near}" if folder and near is not None else near
    return ClassFault(kind=NO_HEADER, name=header, near=meant)


def _header_elsewhere(header: Word, code: ClassCode, library: Library) -> ClassFault | None:
    """The fault that a header is in no searched folder, where the project has a file of its name in
    one other folder, and that defines the class in its namespace. Without a folder in the name,
    each folder of the project can be one in which the compiler searches, except those in
    `include/`."""
    folder, _, file = header.text.rpartition("/")
    found = []
    for other in ("", *library.code_names("")):
        path = f"{other}/{file}" if other else file
        source = library.code(path) if other != folder else None
        if source is None or len(source.text) > LONGEST or not _defines(source.text, code):
            continue
        included = library.code(f"include/{path}")
        if folder or (included is not None and included.name == source.name):
            found.append(path)
    return ClassFault(kind=NO_HEADER, name=header, near=found[0]) if len(found) == 1 else None


def _defines(text: str, code: ClassCode) -> bool:
    """Whether a header defines a class, with the namespaces of its name."""
    *spaces, name = code.name.removeprefix("::").split("::")
    plain = without_literals(text)
    opened = set(re.findall(r"\w+", " ".join(re.findall(r"\bnamespace\s+([\w:\s]+)\{", plain))))
    pattern = class_head(name)
    return opened.issuperset(spaces) and re.search(pattern, plain) is not None


def _absent_class(name: Word, whole: Part, header: str) -> ClassFault | None:
    """The fault that a header has no class of a name; None if it includes other headers of the
    user, which can define it."""
    included = re.findall(r'^\s*#\s*include\s*"([^"]*)"', whole.source.text, re.M)
    if any(not item.startswith("smachac/") for item in included):
        return None
    classes = re.findall(r"\b(?:class|struct)\s+(\w+)", whole.text)
    return ClassFault(kind=NO_CPP_CLASS, name=name, near=guesser(classes)(name.text), file=header)


def _faults(
    body: Part, name: Word, outcomes: Words | None, *, derived: bool
) -> Iterator[ClassFault]:
    """A missing `execute`, and uses of enumerators that `Outcome` does not have."""
    if not derived and not method_of(body):
        yield ClassFault(kind=NO_CPP_EXECUTE, name=name)
    if outcomes is None:
        return
    known = [identifier(outcome.text) for outcome in outcomes]
    guess = guesser(known)
    used = {found[1] for found in _USED_OUTCOME.finditer(body.text)}
    unused = [text for text in known if text not in used]
    only = unused[0] if len(unused) == len(used.difference(known)) == 1 else None
    for found in _USED_OUTCOME.finditer(body.text):
        if found[1] not in known:
            word = body.word(found[1], *found.span(1))
            listed = ", ".join(f"`{text}`" for text in known)
            near = guess(found[1]) or only
            yield ClassFault(kind=NO_OUTCOME, name=word, near=near, file="" if near else listed)


def _without_number(
    whole: Part, body: Part, name: Word, number: str, *, derived: bool
) -> Iterator[ClassFault]:
    """The fault that a class lacks the interface hash, or has one that is no number; a base class
    and a macro can contain it."""
    literal, known = body.member(_LITERAL), body.member(_NUMBER)
    if literal is not None and (known is None or _number(known[1]) is None):
        word = body.word(literal[1], *literal.span(1))
        yield ClassFault(kind=WRONG_NUMBER, name=word, near=number)
    if derived or "smachac_interface" in whole.text or _MACRO.search(body.text):
        return
    yield ClassFault(kind=NO_NUMBER, name=name, near=number)


def _outdated(code: ClassCode, body: Part) -> Iterator[Difference]:
    """The parameters that a class lacks, or has in vain, in another version of its interface."""
    texts = {
        NO_CONSTRUCTOR_PARAMETER: "its constructor lacks {}",
        EXTRA_PARAMETER: "its constructor takes `{}`, which is no variable now",
        WRONG_CONSTRUCTOR: "its constructor has other parameters",
        WRONG_PARAMETERS: "`execute` has other parameters",
    }
    for fault in signature_faults(code, body):
        text = texts.get(fault.kind, "").format(fault.name.text)
        if not text:
            continue
        help = f"write `{fault.near}`"
        yield Difference(Word(text, fault.name.span), help, change=help)


def _stale(body: Part, wanted: str) -> Word | None:
    """The place of an outdated interface hash, with the present hash as its text; None if the class
    has the present one or none."""
    found = body.member(_NUMBER)
    number = _number(found[1]) if found is not None else None
    if found is None or number is None or number == _number(wanted.rstrip("U")):
        return None
    return body.word(wanted, *found.span(1))


def _number(text: str) -> int | None:
    """The value of an integer literal of C++; None for others."""
    digits = text.lower().replace("'", "")
    base = 16 if digits.startswith("0x") else 8 if digits.startswith("0") else 10
    try:
        return int(digits, base)
    except ValueError:
        return None


def _outcomes(body: Part, names: Iterable[str]) -> Words | None:
    """The outcomes of a class, under the names that its interface gives them."""
    own = {identifier(name): name for name in names}
    words = outcome_words(body)
    return words and tuple([Word(own.get(word.text, word.text), word.span) for word in words])


def _fields(body: Part, name: str, *, derived: bool) -> list[_Field] | None:
    """The fields of a struct; empty if the class does not mention it; None if it cannot be read."""
    if not derived and not re.search(rf"\b{name}\b", body.text):
        return []
    part = body.inside(body.member(_STRUCT.format(name)))
    if part is None or _ODD.search(part.text):
        return None
    fields = []
    for at, piece in part.split(";"):
        text = piece.rstrip()
        found = _LAST_WORD.search(text)
        type_ = text[: found.start()].strip() if found is not None else ""
        if found is None or not type_ or "," in _without_arguments(type_):
            return None
        word = part.word(found.group(), at + found.start(), at + found.end())
        first = at + piece.index(type_)
        fields.append(_Field(word=word, type=part.word(type_, first, first + len(type_))))
    return fields


def _without_arguments(type_: str) -> str:
    """A type without its template arguments."""
    for _ in range(10):
        type_ = _ARGUMENTS.sub("", type_)
    return type_


def _names(fields: Sequence[_Field] | None, keys: Iterable[Key]) -> Words | None:
    """The fields under the key names of the interface."""
    if fields is None:
        return None
    own = {identifier(key.name): key.name for key in keys}
    return tuple(
        field.word._replace(text=own.get(field.word.text, field.word.text)) for field in fields
    )


def _other_fields(
    type_name: str, part: str, fields: Sequence[_Field] | None, keys: Iterable[Key]
) -> Iterator[Difference]:
    """Fields of another type than in the interface, or in another order."""
    if not fields:
        return
    wanted = {identifier(key.name): key for key in keys}
    for field in fields:
        name = field.word.text
        try:
            right = field_type(part, wanted[name].type) if name in wanted else ""
        except UnportableError:
            continue
        if right and _surely_other(field.type.text, right):
            text = f"`{part}::{name}` must be `{right}`"
            change = f"write `{right} {name}`".replace("& ", "&")
            help = f"{change}, or correct the interface in `{type_name}.yml`"
            yield Difference(Word(text, field.type.span), help, change=change)
    have = [field.word.text for field in fields]
    if have != [*wanted] and sorted(have) == sorted(wanted):
        order = ", ".join(f"`{name}`" for name in wanted)
        text = f"the fields of `{part}` must be in the order {order}"
        types = {field.word.text: field.type.text for field in fields}
        right = "; ".join(f"{types[name]} {name}".replace("& ", "&") for name in wanted)
        change = f"write `struct {part} {{ {right}; }};`"
        help = f"{change}, or correct the interface in `{type_name}.yml`"
        yield Difference(Word(text, fields[0].word.span), help, change=change)


def _surely_other(text: str, wanted: str) -> bool:
    """Whether two spellings are certainly two types, whatever aliases there are."""
    one, other = _plain(text), _plain(wanted)
    return one != other and _is_known(one) and _is_known(other)


def _is_known(text: str) -> bool:
    """Whether a type consists of known types and standard containers of them only."""
    words = re.findall(r"[\w:]+", text)
    return all(word in KNOWN or word in CONTAINERS or word.isdigit()
               or word.removeprefix("smachac::") in STRUCTS for word in words)  # fmt: skip


def _plain(text: str) -> str:
    """A type without `const`, reference and `Key`; known short names get their namespace."""
    text = re.sub(r"\bconst\b|[&\s]", " ", text).strip()
    key = re.fullmatch(r"(?:smachac ?:: ?)?Key ?<(.*)>", text)
    text = (key[1] if key else text).replace(" ", "")
    return f"std::{text}" if text in ("string", "int64_t") else text
