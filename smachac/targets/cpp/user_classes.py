"""Leaves that are C++ classes of the user: their construction, their call and their checks."""

from __future__ import annotations

import zlib
from collections.abc import Iterable, Sequence

from smachac.frontend.text.unquoted import parameters
from smachac.ir.nodes import Data, Key, Leaf, StateType
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.types import Bounds, Type
from smachac.records import dataclass
from smachac.targets.cpp.bounded import bounded, has_bound, loose
from smachac.targets.cpp.builtin_states import STOP, LeafCode
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import ContainerScope, converts
from smachac.targets.cpp.types import (
    UnportableError,
    cpp_literal,
    cpp_type,
    cpp_value,
    plain,
    without_classes,
)

REFUSED = "the C++ compiler refuses the class"
"""The effect of most faults of a class in C++."""

BY_VALUE = ("bool", "int", "float")
"""Types that are passed by value, because a copy is cheaper than a reference."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ClassCode:
    """A class of the user for a state type: its name, the header to include, and the parameters
    that its constructor takes first, such as `my_robot::Arm &arm`."""

    type: StateType
    name: str
    header: str
    parameters: tuple[str, ...] = ()


def argument(parameter: str) -> str:
    """The name of a parameter."""
    return parameter.replace("&", " ").replace("*", " ").split()[-1]


def class_code(type_: StateType) -> ClassCode | None:
    """The class that an interface names for C++; None where it names none."""
    given = type_.classes.get("cpp")
    if given is None:
        return None
    return ClassCode(
        type=type_,
        name=f"::{given['class'].removeprefix('::')}",
        header=given["header"],
        parameters=tuple(
            _parameter(parameter) for parameter in parameters(given.get("with", "")) if parameter
        ),
    )


def _parameter(text: str) -> str:
    """A parameter in the layout of the header: `my_robot::Arm &arm`."""
    spaced = " ".join(text.replace("&", " & ").replace("*", " * ").split())
    return spaced.replace("& ", "&").replace("* ", "*")


def named_classes(code: ClassCode) -> list[str]:
    """The qualified names of a class and of the types of its parameters, `my_robot::Arm`."""
    types = (
        _type_of(parameter).strip("&* ").removeprefix("const ") for parameter in code.parameters
    )
    return [type_.partition("<")[0].strip().removeprefix("::") for type_ in (code.name, *types)]


def named_apart(taken: Sequence[str], others: Iterable[str]) -> tuple[str, ...]:
    """Parameters of which none has the name of another parameter of another type: a number is added
    to its name."""
    types = {argument(other): _type_of(other) for other in others}
    found = []
    for text in taken:
        type_, name = _type_of(text), argument(text)
        new, number = name, 1
        while types.get(new, type_) != type_:
            number += 1
            new = f"{name}_{number}"
        types[new] = type_
        found.append(f"{text.removesuffix(name)}{new}")
    return tuple(found)


def _type_of(parameter: str) -> str:
    return parameter.removesuffix(argument(parameter)).strip()


def left_to_scripts(type_: StateType) -> list[str]:
    """The parts of an interface that a script supplies, which a class cannot have."""
    return sorted(type_.given - {"variables"})


def class_leaf(code: ClassCode, leaf: Leaf, scope: ContainerScope, number: int = 0) -> LeafCode:
    """A leaf that is an object of a class; `number` is that of the leaf in a stepped machine.
    Raises UnportableError."""
    type_ = code.type
    left = left_to_scripts(type_)
    if left:
        what = ", ".join(left)
        message = f"`{type_.name}` leaves its {what} to scripts, which a C++ class cannot"
        raise UnportableError(message)
    state = f"states.{identifier(leaf.name)}"
    names = scope.names(leaf)
    inputs = [_input(scope, key, names[key.name]) for key in type_.input_keys]
    outs = [_output(scope, key, names[key.name]) for key in type_.output_keys]
    arguments = [
        *([f"{{{', '.join(inputs)}}}"] if inputs else []),
        *([f"{{{', '.join(f'run.out({out})' for out in outs)}}}"] if outs else []),
        *([STOP] if stops(type_) else []),
    ]
    call = f"{state}.execute({', '.join(arguments)})"

    def hidden(key: Key) -> str:
        return ", true" if names[key.name] in scope.secret else ""

    made = [*map(argument, code.parameters), *_variables(type_, leaf, scope.bounds)]
    if scope.bounds is not None:
        for part, keys in (("In", type_.input_keys), ("Out", type_.output_keys)):
            step_fields(part, keys, scope.bounds)  # raises the reason
        return LeafCode(
            type=code.name,
            call=_step(code, leaf, scope, inputs, outs, number),
            made_with=", ".join(made),
            parameters=code.parameters,
            uses_userdata=bool(inputs or outs),
            uses_stop=stops(type_),
            bounded_outputs=tuple(
                (out, cpp_literal(key.name))
                for key, out in zip(type_.output_keys, outs, strict=True)
                if has_bound(scope.key(names[key.name]))
            ),
            written=tuple(
                f"{cpp_literal(key.name)}, {out}{hidden(key)}"
                for key, out in zip(type_.output_keys, outs, strict=True)
            ),
        )
    if outs:
        outputs = [
            f"smachac::Output{{{cpp_literal(key.name)}, {out}{hidden(key)}}}"
            for key, out in zip(type_.output_keys, outs, strict=True)
        ]
        call = f"run.wrote({call}, {', '.join(outputs)})"
    return LeafCode(
        type=code.name,
        call=call,
        made_with=", ".join(made),
        parameters=code.parameters,
        uses_userdata=bool(inputs or outs),
        uses_stop=stops(type_),
    )


def _step(
    code: ClassCode,
    leaf: Leaf,
    scope: ContainerScope,
    inputs: Sequence[str],
    outs: Sequence[str],
    number: int,
) -> str:
    """The call of one step of a leaf."""
    names = scope.names(leaf)
    given = [
        *([f"{code.name}::In{{{', '.join(inputs)}}}"] if inputs else []),
        *([f"{code.name}::Out{{{', '.join(f'run.out({out})' for out in outs)}}}"] if outs else []),
    ]
    sure = all(
        names[key.name] in scope.sure and loose(scope.key(names[key.name])) == plain(key.type)
        for key in code.type.input_keys
        if plain(key.type).name != "optional"
    )
    function = "leaf" if sure else "checked_leaf"
    return f"run.{function}({', '.join([str(number), f'states.{identifier(leaf.name)}', *given])})"


def stops(type_: StateType) -> bool:
    """Whether `execute` has a parameter for requests to stop."""
    return type_.blocking or any(outcome.name == PREEMPTED for outcome in type_.outcomes)


def _input(scope: ContainerScope, key: Key, outer: str) -> str:
    given, wanted = scope.key(outer), plain(key.type)
    if not converts(loose(given), wanted):
        raise UnportableError(
            f"the input `{key.name}` is `{wanted}`, but the key `{outer}` is `{loose(given)}`"
        )
    spelt = scope.dialect.resolved(scope.read(outer, key.name).text)
    if scope.dialect.stepped:
        return _bounded_input(scope, key, outer, spelt)
    if wanted.name == "optional" and outer not in scope.sure:
        return f"smachac::maybe<{cpp_type(wanted)}>({scope.object(outer)})"
    return spelt if given == wanted else f"smachac::convert<{cpp_type(wanted)}>({spelt})"


def _bounded_input(scope: ContainerScope, key: Key, outer: str, spelt: str) -> str:
    """The text of an input in a stepped machine."""
    given, wanted = scope.key(outer), plain(key.type)
    maybe = wanted.name == "optional" and outer not in scope.sure
    if loose(given) == wanted and not maybe:
        return spelt
    if wanted.name == "optional":
        stored = given if given.name == "optional" else Type("optional", (given,))
        if loose(stored) == wanted:
            return f"smachac::step::maybe<{cpp_type(stored)}>(run.context, {scope.object(outer)})"
    elif wanted.name in BY_VALUE:
        return f"smachac::step::convert<{cpp_type(wanted)}>(run.context, {spelt})"
    message = f"the input `{key.name}` is `{wanted}`, but the key `{outer}` is `{loose(given)}`"
    raise UnportableError(f"{message}: a stepped machine does not convert it")


def _output(scope: ContainerScope, key: Key, outer: str) -> str:
    given, wanted = plain(key.type), loose(scope.key(outer))
    if given != wanted:
        raise UnportableError(
            f"the output `{key.name}` is `{given}`, but the key `{outer}` is `{wanted}`"
        )
    return scope.object(outer)


def _variables(type_: StateType, leaf: Leaf, bounds: Bounds | None) -> list[str]:
    """The arguments for the variables of the interface, in its order, with its defaults."""
    set_: dict[str, Data] = {variable.name: variable.value.data for variable in leaf.variables}
    found = []
    for name, variable in type_.variables.items():
        if name not in set_ and variable.default is not None:
            set_[name] = variable.default.data
        value = set_.get(name)
        try:
            wanted = (
                variable.type if bounds is None else _constant_type(variable.type, value, bounds)
            )
            found.append(cpp_value(value, wanted))
        except UnportableError as error:
            raise UnportableError(f"the variable `{name}`: {error}", help=error.help) from error
    return found


def _constant_type(type_: Type, value: Data, bounds: Bounds) -> Type:
    """The storage of a constant in a stepped machine: a text or list is as large as its value.
    Raises UnportableError for a type without a bound in it."""
    match type_.name, type_.args, value:
        case "str", _, str():
            return Type("text", (len(value.encode("utf-8", "surrogatepass")),))
        case "list", (Type() as item, *_), tuple():
            return Type("bounded", (bounded(item, bounds), len(value)))
        case "optional", (Type() as item,), _:
            return Type("optional", (_constant_type(item, value, bounds),))
    return bounded(type_, bounds)


def step_field_type(part: str, type_: Type) -> str:
    """The type of a field of `In` or `Out` in a stepped machine, for the storage of a type: texts
    and lists are passed without their bound."""
    match type_.name, type_.args:
        case "text", _:
            text = "std::string_view" if part == "In" else "smachac::step::Text"
        case "bounded", (Type() as item, _):
            text = f"smachac::step::List<{cpp_type(item)}>"
        case _:
            text = cpp_type(type_)
    if part == "Out":
        return f"smachac::step::Key<{text}> &"
    return text if type_.name in (*BY_VALUE, "text") else f"const {text} &"


def step_parameter_type(type_: Type, bounds: Bounds) -> str:
    """The type of a parameter for a constant in a stepped machine. Raises UnportableError."""
    return step_field_type("In", _stored(type_, bounds))


def parameter_type(type_: Type) -> str:
    """The type of a parameter for a value of a type."""
    text = cpp_type(type_)
    return text if plain(type_).name in BY_VALUE else f"const {text} &"


def field_type(part: str, type_: Type) -> str:
    """The type of a field of `In` or `Out`."""
    return parameter_type(type_) if part == "In" else f"smachac::Key<{cpp_type(type_)}> &"


def interface_hash(type_: StateType) -> str:
    """A hash of all parts of an interface that its class depends on."""
    parts = [
        type_.name,
        *(f"var {name} {_written(variable.type)}" for name, variable in type_.variables.items()),
        *(f"in {key.name} {_written(key.type)}" for key in type_.input_keys),
        *(f"out {key.name} {_written(key.type)}" for key in type_.output_keys),
        *(f"outcome {outcome.name}" for outcome in type_.outcomes),
        f"stop {stops(type_)}",
    ]
    return f"0x{zlib.crc32(chr(10).join(parts).encode()):08x}U"


def _written(type_: Type) -> str:
    """A type as the interface has it: records with their fields, whatever the class in C++."""
    return str(plain(without_classes(type_)))


def step_fields(part: str, keys: Iterable[Key], bounds: Bounds) -> dict[str, str]:
    """The fields of `In` or `Out` in a stepped machine and their types. Raises UnportableError for
    a type without a bound."""
    return {identifier(key.name): step_field_type(part, _stored(key.type, bounds)) for key in keys}


def _stored(type_: Type, bounds: Bounds) -> Type:
    """The storage of the type of a key in an interface. The bound of a text or list itself is that
    of the key in the script: here it has none."""
    match type_.name, type_.args:
        case "str", _:
            return Type("text", (1,))
        case "list", (Type() as item, *_):
            return Type("bounded", (bounded(item, bounds), 1))
    return bounded(type_, bounds)


def assertions(code: ClassCode, bounds: Bounds | None = None) -> list[str]:
    """The static assertions for a class; their messages are instructions to the user. `bounds` are
    those of a stepped machine. Raises UnportableError for a type without a bound."""
    type_, name = code.type, code.name
    short, file = name.removeprefix("::"), f"{code.type.name}.yml"
    lines = [
        f"static_assert({name}::smachac_interface == {interface_hash(type_)},",
        f'              "{short} was written for another {file}: compare them, then set '
        f'smachac_interface");',
    ]
    for part, keys in (("In", type_.input_keys), ("Out", type_.output_keys)):
        if bounds is None:
            wanted = {identifier(key.name): field_type(part, key.type) for key in keys}
        else:
            wanted = step_fields(part, keys, bounds)
        for field, text in wanted.items():
            lines += [
                f"static_assert(std::is_same_v<decltype({name}::{part}::{field}), {text}>,",
                f'              "{short}::{part}::{field} must be {text}");',
            ]
        if len(set(wanted.values())) < len(wanted):
            fields = ", ".join(f"keys.{field}" for field in wanted)
            types, order = ", ".join(wanted.values()), ", ".join(wanted)
            lines += [
                f"static_assert(smachac::in_order<{name}::{part}, {types}>(",
                f"                  [](auto keys) {{ return smachac::before_mark({fields}); }}),",
                f'              "{short}::{part} must have its fields in the order {order}");',
            ]
    return lines
