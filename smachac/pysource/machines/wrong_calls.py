"""Calls that fail: arguments that do not fit the parameters of a function, or of a method of a
framework."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

from smachac.pysource.machines.values import Arguments, Function, UseKind


class Signature(NamedTuple):
    """The parameters of a function: those that take an argument by its place, in their order, those
    that take one by its name, and those without a default value. `rest`, `others`: it takes any
    further arguments, by their places and by their names."""

    positional: list[str]
    named: Collection[str]
    required: Sequence[str]
    rest: bool = False
    others: bool = False


def signature(required: str, optional: str = "") -> Signature:
    """The parameters of a method, of which each takes an argument by its place or its name."""
    every = [*required.split(), *optional.split()]
    return Signature(positional=every, named=every, required=required.split())


def signature_of(function: Function) -> Signature:
    """The parameters of a function of the project."""
    taken = function.node.args
    positional = [argument.arg for argument in (*taken.posonlyargs, *taken.args)]
    own = [argument.arg for argument in taken.kwonlyargs]
    without = positional[: len(positional) - len(function.defaults)]
    return Signature(
        positional=positional,
        named=[argument.arg for argument in taken.args] + own,
        required=[*without, *(name for name in own if name not in function.keyword_defaults)],
        rest=taken.vararg is not None,
        others=taken.kwarg is not None,
    )


def wrong_call(
    signature: Signature, arguments: Arguments
) -> tuple[UseKind, tuple[str, ...]] | None:
    """Why Python refuses a call, with the names in it: an argument without a parameter, followed by
    the names of the parameters; the arguments that are missing; or how many can be given by their
    places, and how many are. None if it does not, or if not all arguments are known."""
    if arguments.open:
        return None
    given = {name for name, _ in arguments.named}
    count, most = len(arguments.positional), len(signature.positional)
    unknown = [] if signature.others else [name for name in given if name not in signature.named]
    if unknown:
        return "unknown argument", (min(unknown), *signature.named)
    if count > most and not signature.rest:
        own = signature.positional[:1] == ["self"]  # the caller does not write it
        return "too many arguments", (str(most - own), str(count - own))
    given.update(signature.positional[:count])
    missing = [name for name in signature.required if name not in given]
    return ("missing argument", (*missing,)) if missing else None
