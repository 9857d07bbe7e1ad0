"""Reader of message definitions of ROS: files `.msg`, `.srv` and `.action`, as data.

The format is that of ROS 1 (wiki.ros.org/msg) with the extensions of ROS 2
(docs.ros.org, Interfaces): bounds, default values, `wstring`. Nothing is imported. A file that is
not valid gives no definition, because its package does not build either.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import NamedTuple

from smachac.diagnostics.diagnostic import Report, Severity
from smachac.diagnostics.source import NOWHERE, Source, Span
from smachac.frontend.errors.script import unreadable_file
from smachac.frontend.loader import Library
from smachac.frontend.messages.standard_messages import (
    packages_by_message,
    packages_with,
    standard_package,
)
from smachac.frontend.resolved_script import State
from smachac.ir.leaf import given_fields, type_text
from smachac.ir.message_types import (
    PARTS,
    PRIMITIVES,
    TEXTS,
    Definition,
    DefinitionKind,
    Definitions,
    FieldType,
    Message,
    MessageConstant,
    MessageField,
    Missing,
    MissingDefinitions,
    OtherTypes,
)
from smachac.ir.nodes import DEFINITION_KINDS, Expression
from smachac.records import replace

TYPE_CHECKING = False  # annotations only: most machines have no classes
if TYPE_CHECKING:
    from smachac.ir.class_facts import ClassFacts

LONGEST = 1_000_000
"""The longest file that is read, in characters."""

MOST_CODE = 10_000
"""The longest code in which calls of messages are searched, in characters."""

MOST_OTHERS = 100
"""Limit on the types of a package that are searched for fields."""

_NAME = r"[A-Za-z]\w*"
_TYPE = (
    r"(?P<name>[A-Za-z]\w*(?:/[A-Za-z]\w*){0,2})(?:<=(?P<longest>\d{1,9}))?"
    r"(?P<array>\[(?:(?P<size>\d{1,9})|<=(?P<most>\d{1,9}))?\])?"
)


_CALLED = re.compile(r"(?<![\w.])(?:[a-z]\w*\.msg\.)?[A-Z]\w*(?=\()", re.ASCII)
"""The call of a class, such as that of a message: `Bool(`, `std_msgs.msg.Bool(`."""

_MADE = r"(Action|ActionGoal|ActionResult|ActionFeedback|Goal|Result|Feedback)\Z"
"""The names of messages that ROS 1 makes of an action."""


class TypeName(NamedTuple):
    """The name of a definition: `std_srvs/Trigger`."""

    package: str
    name: str

    def __str__(self) -> str:
        return f"{self.package}/{self.name}"


def type_name(text: str, kind: DefinitionKind) -> TypeName | None:
    """The name that a text means: `std_srvs/Trigger`, `std_srvs/srv/Trigger` or
    `std_srvs.srv.Trigger`; None for any other text."""
    parts = re.split(r"[/.]", text.strip())
    if not all(re.fullmatch(_NAME, part, re.ASCII) for part in parts):
        return None
    match parts:
        case [package, name]:
            return TypeName(package, name)
        case [package, folder, name] if folder == kind:
            return TypeName(package, name)
        case [package, "msg", name] if kind == "action":  # ROS 1: the message `TestAction`
            return TypeName(package, name)
    return None


def find_definitions(
    text: str, kind: DefinitionKind, library: Library, report: Report | None = None
) -> tuple[Definition, ...]:
    """All definitions of a name, in the order of the searched folders; none if the text is not a
    name or a file of that name is not valid, which is reported.

    ROS 1 names an action after its message: `actionlib/TestAction` is in `Test.action`.
    """
    word = type_name(text, kind)
    if word is None:
        return ()
    names = [word.name]
    if kind == "action" and word.name.endswith("Action"):
        names.append(word.name.removesuffix("Action"))
    if not library.definition_names(f"{word.package}/{kind}"):
        common = _standard(word.package, names, kind, library)
        if common:
            return common
    for name in names:
        path = f"{word.package}/{kind}/{name}.{kind}"
        unread: Report = []
        sources = library.definitions(path, unread)
        if report is not None:
            effect = f"the fields of `{word}` are not checked, and ROS does not build its package"
            for problem in unread:
                finding = replace(problem.finding, severity=Severity.WARNING, effect=effect)
                problem = replace(problem, severity=Severity.WARNING, finding=finding)
                report += [problem] if problem not in report else []
        if sources:
            own = TypeName(word.package, name)
            read = [read_definition(source, own, kind, report) for source in sources]
            found = tuple(definition for definition in read if definition is not None)
            return found if len(found) == len(read) else ()
    return ()


def _standard(
    package: str, names: Sequence[str], kind: DefinitionKind, library: Library
) -> tuple[Definition, ...]:
    """The definitions of a type of a common package with one of some names. They are in no file of
    the user, so their parts have no places."""
    texts = standard_package(package, library.ros).texts
    for name in names:
        path = f"{package}/{kind}/{name}.{kind}"
        sources = [Source(path, text) for text in texts.get(f"{kind}/{name}", ())]
        read = [read_definition(source, TypeName(package, name), kind) for source in sources]
        if read:
            return tuple(
                _without_places(definition) for definition in read if definition is not None
            )
    return ()


def _without_places(definition: Definition) -> Definition:
    messages = [
        replace(message, fields=tuple(replace(one, span=NOWHERE) for one in message.fields))
        for message in definition.messages
    ]
    return replace(definition, messages=tuple(messages), span=NOWHERE)


def with_values(base: State) -> list[State]:
    """The states of a script that have values, which can name types of ROS: variables or
    userdata."""
    found: list[State] = []
    todo = [base]
    while todo:
        state = todo.pop()
        if state.states:
            todo += state.states
        if state.variables or state.userdata:
            found.append(state)
    return found


def definitions_of(
    base: State,
    states: Sequence[State],
    classes: Iterable[ClassFacts],
    library: Library,
    report: Report,
) -> Definitions:
    """The definitions of the types that the states of a script and the classes of their types name,
    and those of the messages in their fields. `states`: see `with_values`. A file that is not valid
    is reported."""
    found: dict[tuple[DefinitionKind, str], tuple[Definition, ...]] = {}
    todo: list[tuple[DefinitionKind, str]] = list(_named_types(states))
    for facts in classes:
        for kind, text, _ in _readings(facts):
            todo.append((kind, text))
    for text, name in _called_messages(base, states, library).items():
        found["msg", text] = find_definitions(name, "msg", library, report)
        for definition in found["msg", text]:
            todo.extend(("msg", nested) for nested in _nested(definition))
    while todo:
        kind, text = todo.pop()
        if (kind, text) not in found:
            found[kind, text] = find_definitions(text, kind, library, report)
            for definition in found[kind, text]:
                todo.extend(("msg", name) for name in _nested(definition))
    return {key: row for key, row in found.items() if row}


def with_fields(
    definition: Definition, part: str, fields: Collection[str], library: Library
) -> Definition | None:
    """The only other type of the same package and kind whose message `part` has some fields; None
    if there are none or several, or a definition of the package cannot be read."""
    kind = definition.kind
    names = {*_names_in(definition.package, kind, library)} - {definition.name}
    if not fields or len(names) > MOST_OTHERS:
        return None
    fitting: list[Definition] = []
    for name in sorted(names):
        found = find_definitions(f"{definition.package}/{name}", kind, library)
        if not found:
            return None
        if all(definition.part(part).field(field) for definition in found for field in fields):
            fitting.append(found[0])
    return fitting[0] if len(fitting) == 1 else None


def other_types_of(states: Iterable[State], found: Definitions, library: Library) -> OtherTypes:
    """The types that some states can mean in place of those whose messages do not have the fields
    that they give."""
    others: dict[tuple[str, tuple[str, ...]], str] = {}
    for state in states:
        for named in state.variables:
            kind = DEFINITION_KINDS.get(named.role)
            if kind is None:
                continue
            text = type_text(named)
            definitions = found.get((kind, text))
            for part in PARTS[kind] if definitions else ():
                fields = given_fields(state.variables, part)
                known = [
                    definition.part(part).field(one)
                    for definition in definitions or ()
                    for one in fields
                ]
                if all(known) or not definitions or (text, fields) in others:
                    continue
                other = with_fields(definitions[0], part, fields, library)
                if other is not None:
                    head = text.removesuffix(definitions[0].name)
                    others[text, fields] = f"{head}{other.name}" if head != text else other.name
    return others


def _named_types(states: Iterable[State]) -> dict[tuple[DefinitionKind, str], None]:
    """The kinds and names of the types of ROS that some states name."""
    found: dict[tuple[DefinitionKind, str], None] = {}
    for state in states:
        for held in state.variables:
            kind = DEFINITION_KINDS.get(held.role)
            if kind is not None:
                found[kind, type_text(held)] = None
        for preset in state.userdata:
            text = preset.value.data if preset.key.endswith("type") else None
            if isinstance(text, str) and type_name(text, "msg") is not None:
                found["msg", text] = None
    return found


def _called_messages(base: State, states: Sequence[State], library: Library) -> dict[str, str]:
    """The names of the messages whose classes the code of a script calls, by the words of the call:
    `std_msgs.msg.Bool(data=True)`, or `Bool(data=True)`, which a program imports from the only
    common package that has it, unless a type of the script or a base of the user has its name."""
    words: dict[str, None] = {}
    for state in states:
        data = [held.value.data for held in state.variables]
        data += [preset.value.data for preset in state.userdata]
        codes = [value.text if isinstance(value, Expression) else value for value in data]
        texts = [code for code in codes if isinstance(code, str) and len(code) <= MOST_CODE]
        words |= dict.fromkeys(word for text in texts for word in _CALLED.findall(text))
    found = {word: word for word in words if "." in word}
    code = base.type.code.get("python", f"{base.type.name}.tpl.py")
    if len(found) < len(words) and library.own_template(code) is None:
        named = {re.split(r"[/.]", text)[-1] for _, text in _named_types(states)}
        packages = packages_by_message(library.ros)
        for word in words:
            if word not in named and len(packages.get(word, ())) == 1:
                found[word] = f"{packages[word][0]}/{word}"
    return found


def _nested(definition: Definition) -> list[str]:
    """The names of the messages in the fields of a definition."""
    fields = [field for message in definition.messages for field in message.fields]
    return [field.type.name for field in fields if field.type.name not in PRIMITIVES]


def _readings(facts: ClassFacts) -> Iterator[tuple[DefinitionKind, str, str]]:
    """The types and messages that a class can mean."""
    if facts.messages is not None:
        for ref, _ in facts.messages.named:
            yield from ref.readings()


def missing_definitions_of(
    states: Iterable[State], classes: Iterable[ClassFacts], found: Definitions, library: Library
) -> MissingDefinitions:
    """The types in some states, or in the classes of their types, whose package has
    types of their kind, but not these, or types of these names, but of another kind.

    Types that ROS 1 makes of an action, such as `TestActionGoal`, and those with a definition in
    the format of the OMG (`.idl`) are not missing.
    """
    missing: dict[tuple[DefinitionKind, str], Missing] = {}
    for kind, text in _named_types(states):
        word = type_name(text, kind)
        if (kind, text) in found or word is None:
            continue
        absent = missing_type(word, kind, library)
        if absent is not None:
            missing[kind, text] = absent
    for facts in classes:
        for ref, _ in facts.messages.named if facts.messages is not None else ():
            readings = ref.readings()
            if not any((kind, text) in found for kind, text, _ in readings):
                kind, text, _ = readings[0]
                absent = missing_type(TypeName(ref.package, ref.name), kind, library)
                if absent is not None:
                    missing[kind, text] = absent
    return missing


def missing_type(word: TypeName, kind: DefinitionKind, library: Library) -> Missing | None:
    """What is known about a type that its package does not have; None if it can exist."""
    made = re.search(_MADE, word.name) if kind != "srv" else None
    names = _names_in(word.package, kind, library)
    if made is not None:
        action = TypeName(word.package, word.name[: made.start()])
        if not is_listed(word.package, library) or find_definitions(str(action), "action", library):
            return None
        names += [f"{name}{made[1]}" for name in _names_in(word.package, "action", library)]
    files = library.definition_names(f"{word.package}/{kind}")
    if word.name in names or f"{word.name}.idl" in files:
        return None
    kinds: list[DefinitionKind] = [
        part for part in PARTS if find_definitions(str(word), part, library)
    ]
    other = kinds[0] if kinds else None
    if not names and other is None and not is_listed(word.package, library):
        return None
    packages = packages_with(word.name, kind, library.ros) if other is None else []
    packages = [package for package in packages if package != word.package]
    return Missing(tuple(sorted(names)), other, tuple(packages))


def is_listed(package: str, library: Library) -> bool:
    """Whether all types of a package are known: it is a common one, and no folder of the user or of
    an installation has a package of its name."""
    if not standard_package(package, library.ros).is_complete:
        return False
    return not any(library.definition_names(f"{package}/{kind}") for kind in PARTS)


def _names_in(package: str, kind: DefinitionKind, library: Library) -> list[str]:
    """The names of the types of a kind in a package, all of them or none."""
    files = library.definition_names(f"{package}/{kind}")
    if files:
        return [file.removesuffix(f".{kind}") for file in files if file.endswith(f".{kind}")]
    return standard_package(package, library.ros).names(kind) if is_listed(package, library) else []


class _BadDefinitionError(Exception):
    """A text is no definition; `span` is the line, `help` what to write."""

    def __init__(self, span: Span, message: str, help: str) -> None:
        super().__init__(message)
        self.span, self.help = span, help


def read_definition(
    source: Source, name: TypeName, kind: DefinitionKind, report: Report | None = None
) -> Definition | None:
    """The definition in a text; None if the text is not valid, with SM007 at the first wrong line
    in the report."""
    try:
        return _definition(source, name, kind)
    except _BadDefinitionError as error:
        if report is not None:
            place = ("definition", source.name)
            found = unreadable_file(error.span, str(error), error.help, arguments=place,
                                    severity=Severity.WARNING)  # fmt: skip
            report += [found] if found not in report else []
    return None


def _definition(source: Source, name: TypeName, kind: DefinitionKind) -> Definition:
    if len(source.text) > LONGEST:
        help = "write a shorter definition"
        raise _BadDefinitionError(Span(source, 0, 0), f"the `.{kind}` file is too long", help)
    if source.text.startswith("\ufeff"):
        help = "save the file as UTF-8 without a byte order mark: ROS does not accept it"
        message = "the file begins with a byte order mark"
        raise _BadDefinitionError(Span(source, 0, 1), message, help)
    parts: list[list[tuple[str, Span]]] = [[]]
    for line, span in _lines(source):
        if line == "---":
            parts.append([])
        elif line and not line.startswith("#"):
            parts[-1].append((line, span))
    if len(parts) != len(PARTS[kind]):
        number = f"{len(parts)} part{'s' * (len(parts) > 1)}"
        message = f"the file has {number}; a `.{kind}` file has {len(PARTS[kind])}"
        help = "write `---` on a line of its own between the parts"
        raise _BadDefinitionError(Span(source, 0, 0), message, help)
    messages = [
        _message(str(name) if kind == "msg" else f"{name}.{part}", name.package, lines)
        for part, lines in zip(PARTS[kind], parts, strict=True)
    ]
    return Definition(
        package=name.package,
        name=name.name,
        kind=kind,
        messages=tuple(messages),
        span=Span(source, 0, 0),
    )


def _lines(source: Source) -> Iterator[tuple[str, Span]]:
    """The lines of a text without the space around them, and their spans."""
    for start in source.line_starts:
        end = source.text.find("\n", start)
        line = source.text[start : end if end >= 0 else len(source.text)]
        begin = start + len(line) - len(line.lstrip())
        yield line.strip(), Span(source, begin, begin + len(line.strip()))


def _message(name: str, package: str, lines: list[tuple[str, Span]]) -> Message:
    """The message of some lines. Raises _BadDefinitionError."""
    fields: list[MessageField] = []
    constants: list[MessageConstant] = []
    names: set[str] = set()
    for line, span in lines:
        item = _declaration(line, span, package)
        if item is None:
            help = "write `TYPE NAME`, such as `float64 width`, or a constant `TYPE NAME=VALUE`"
            raise _BadDefinitionError(span, "this line declares no field and no constant", help)
        if item.name in names:
            message = f"`{item.name}` is declared twice"
            raise _BadDefinitionError(item.span, message, "write another name")
        names.add(item.name)
        if isinstance(item, MessageField):
            fields.append(item)
        else:
            constants.append(item)
    return Message(name=name, fields=tuple(fields), constants=tuple(constants))


def _declaration(line: str, span: Span, package: str) -> MessageField | MessageConstant | None:
    """The field `type name [default]` or the constant `type NAME=value` of a line."""
    word, _, rest = line.replace("\t", " ").partition(" ")
    wanted = _field_type(word, package)
    rest = rest.lstrip()
    named = re.match(_NAME, rest, re.ASCII)
    if wanted is None or named is None:
        return None
    start = span.start + len(line) - len(rest)
    place = Span(span.source, start, start + named.end())
    after = rest[named.end() :]
    if after.lstrip().startswith("=") and not wanted.array and wanted.name in PRIMITIVES:
        value = after.lstrip()[1:].strip()
        # In ROS 1 the value of a text is the rest of the line, also after a `#`.
        if wanted.name not in TEXTS or value[:1] in ("'", '"'):
            value = _without_comment(value)
        return MessageConstant(name=named[0], type=wanted, value=value, span=place)
    if after and after[0] not in " #":
        return None
    default = _without_comment(after)
    return MessageField(name=named[0], type=wanted, default=default, span=place)


def _without_comment(text: str) -> str:
    """A text up to the first `#` outside of quotes."""
    quote = ""
    before = ""
    for at, character in enumerate(text):
        if quote:
            if character == quote and before != "\\":
                quote = ""
        elif character in ("'", '"'):
            quote = character
        elif character == "#":
            return text[:at].strip()
        before = character
    return text.strip()


def _field_type(word: str, package: str) -> FieldType | None:
    """The type of a text; the name of a message gets the package around it if it has none."""
    found = re.fullmatch(_TYPE, word, re.ASCII)
    if found is None:
        return None
    name: str = found["name"]
    if found["longest"] is not None and name not in TEXTS:
        return None
    parts = name.split("/")
    if len(parts) == 3:
        if parts[1] != "msg":
            return None
        name = f"{parts[0]}/{parts[2]}"
    elif name == "Header":
        name = "std_msgs/Header"  # ROS 1 needs no package before it
    elif len(parts) == 1 and name not in PRIMITIVES:
        name = f"{package}/{name}"
    return FieldType(
        name=name,
        array=found["array"] is not None,
        size=_number(found["size"]),
        most=_number(found["most"]),
        longest=_number(found["longest"]),
    )


def _number(text: str | None) -> int | None:
    return int(text) if text is not None else None
