"""Types in messages: a type in words, and a value of a type as a script writes it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from smachac.analysis.type_lattice import (
    FLOAT,
    fields,
    fits,
    inside,
    is_unknown,
    items,
    length_of,
    present,
    widened,
)
from smachac.ir.types import EXAMPLES, Type, parse_type

FORMS = {
    "Pose": "[[x, y, z], [qx, qy, qz, qw]]",
    "Transform": "[[x, y, z], [qx, qy, qz, qw]]",
    "Point": "[x, y, z]",
    "Quaternion": "[qx, qy, qz, qw]",
}
"""How a script writes a value of a type, with names in place of numbers."""

NOUNS = {"Pose": "pose", "Transform": "transform", "Point": "point", "Quaternion": "rotation"}

HELP = {name: f"write a {NOUNS[name]} as `{form}`" for name, form in FORMS.items()} | {
    "Quaternion": "write a rotation as the 4 numbers of a quaternion, `[qx, qy, qz, qw]`, not as"
    " 3 angles"
}


def in_words(type_: Type) -> str:
    """A type as part of a message; literals as in the script."""
    match type_.name:
        case "literal":
            texts = (
                f'"{argument}"' if isinstance(argument, str) else str(argument)
                for argument in type_.args
            )
            return " or ".join(f"`{text}`" for text in texts)
        case "none":
            return "nothing (`null`)"
        case "tuple" if all(fits(item, FLOAT) and not is_unknown(item) for item in items(type_)):
            count = len(type_.args)
            return f"a list of {count} number{'s' if count != 1 else ''}"
    return f"`{widened(type_)}`"


def named(type_: Type, aliases: Mapping[str, str]) -> str:
    """A type as text, with the names that the script gives to the records in it."""
    text = str(type_)
    for name, alias in sorted(aliases.items(), key=lambda pair: -len(pair[1])):
        record = parse_type(alias)
        if record is not None and record.name == "record":
            text = text.replace(str(record), name)
    return text


_ORDINALS = ("first", "second", "third")


def place_in_words(key: str, steps: Sequence[int | str]) -> str:
    """The place of a part of a literal, as part of a message: "`floor` of the second item of
    `stops`"."""
    words = [f"`{key}`"]
    for step in steps:
        if isinstance(step, str):
            words.append(f"`{step}`")
        else:
            words.append(f"the {_ORDINALS[step]} item" if step < 3 else f"item {step + 1}")
    return " of ".join(reversed(words))


MOST_ITEMS = 8
"""The most items of a list that is shown as an example."""


def example(wanted: Type) -> str:
    """A value of a type as a script writes it; empty if there is no short one."""
    wanted = present(wanted)
    if wanted.name in EXAMPLES:
        return EXAMPLES[wanted.name]
    if wanted.name == "one_of":
        return str(wanted.args[0])
    if wanted.name in ("list", "array"):
        count, item = length_of(wanted), example(inside(wanted))
        count = 2 if count is None else count
        return f"[{', '.join([item] * count)}]" if item and count <= MOST_ITEMS else ""
    if wanted.name == "record":
        parts = {name: example(type_) for name, type_ in fields(wanted).items()}
        whole = ", ".join(f"{name}: {part}" for name, part in parts.items())
        return f"{{{whole}}}" if all(parts.values()) and len(parts) <= MOST_ITEMS else ""
    return ""


def placeholder(wanted: Type) -> str:
    """A value of a type as a script writes it; `...` if there is no short one."""
    return FORMS.get(present(wanted).name) or example(wanted) or "..."
