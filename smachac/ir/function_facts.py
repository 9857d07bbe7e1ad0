"""Facts about functions of the user that a script names as code, or has as lambdas."""

from __future__ import annotations

from typing import NamedTuple

from smachac.diagnostics.source import Span, Word
from smachac.records import dataclass


class Part(NamedTuple):
    """A part of an argument in the code of a function: `goal.poses[0].x` of the parameter `goal`.

    `steps` are the names of the fields that lead to it, None for an item of a list. `name` is the
    last name, at its place; `text` is the whole part.
    """

    parameter: str
    steps: tuple[str | None, ...]
    name: Word
    text: str


class Comparison(NamedTuple):
    """A comparison of a part of an argument with a constant text or number; `operator` is
    that of Python: `==`."""

    part: Part
    operator: str
    value: str | int | float
    span: Span


class Operand(NamedTuple):
    """A part of an argument, at its place, with which code calculates, which it compares, or of
    which a function makes a number: `text` is the code of the operation."""

    part: Part
    span: Span
    text: str


class Result(NamedTuple):
    """A value that a function can return, at its place: `text` is its code.

    `kind`: a constant, whose `value` is known; a part of an argument; `truth` for a comparison or a
    negation; empty for any other code.
    """

    text: str
    span: Span
    kind: str = ""
    value: object = None
    part: Part | None = None


class ArgumentUses(NamedTuple):
    """What the code of a function does with parts of its arguments, in the order of the code."""

    parts: tuple[Part, ...] = ()
    comparisons: tuple[Comparison, ...] = ()
    operands: tuple[Operand, ...] = ()


NO_USES = ArgumentUses()


@dataclass(frozen=True, slots=True, kw_only=True)
class FunctionFacts:
    """A function in a module or template of the user.

    `word` is its name at the definition, `head` the place of its parameters. It accepts from
    `least` to `most` positional arguments; `most` is None if it accepts any number. `parameters`
    are the names of these. `silent`: no path returns a value. `results` are those of its return
    statements with a value. `used` are the parameters that its body reads. `reads` and `writes` are
    the userdata keys that it accesses if its first argument is the userdata. `uses` are the parts
    of its arguments; none of an argument whose class or fields the function tests.
    """

    word: Word
    head: Span
    parameters: tuple[str, ...]
    least: int
    most: int | None
    silent: bool
    results: tuple[Result, ...] = ()
    reads: tuple[Word, ...] = ()
    writes: tuple[Word, ...] = ()
    used: tuple[str, ...] = ()
    uses: ArgumentUses = NO_USES

    @property
    def texts(self) -> tuple[Word, ...]:
        """The texts that it returns, if it returns nothing but constant texts that are not
        empty."""
        found = [
            Word(result.value, result.span)
            for result in self.results
            if result.kind == "constant" and isinstance(result.value, str) and result.value
        ]
        return tuple(found) if len(found) == len(self.results) else ()

    def accepts(self, count: int) -> bool:
        """Whether a call can pass that number of positional arguments."""
        return self.least <= count and (self.most is None or count <= self.most)
