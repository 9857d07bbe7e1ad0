"""Facts about the class of a state type, as far as its text shows them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal, NamedTuple

from smachac.diagnostics.source import Span, Word
from smachac.ir.function_facts import ArgumentUses
from smachac.ir.message_types import PARTS, DefinitionKind
from smachac.records import dataclass

STATE_PARAMETERS = ("outcomes", "input_keys", "output_keys", "io_keys")
"""The parameters of `smach.State.__init__` with lists of names, in their order."""

ANY = "*"
"""In place of outcomes that are not known."""


DID_YOU_MEAN = "did you mean `{near}`?"
"""The `near_help` of kinds of which `near` is a name."""

SUGGESTION = "{suggestion}"
"""The `near_help` of kinds of which `near` is a name or other code."""


@dataclass(frozen=True, slots=True, kw_only=True)
class FaultKind:
    """A kind of fault of a class, with its words. The module that finds such faults defines it.

    `name` is a part of fingerprints, so it never changes. `message`, `help` and `effect` are
    templates; their fields are those of a `ClassFault`, `{word}` for the text of its `name`,
    `{name}` for the class, `{type}` for the state type, `{lists}` for the arguments of the
    constructor of `smach.State` that fit the interface, and `{place}` for the file of the fault, or
    `unnamed` if it has none. `near_help` is the help where `near` is known, if `help` does not
    contain it. `effect` is what happens if that differs from most faults; empty if the message
    contains it.

    `missing`: the code does not exist, or does not load (SM608). `stops`: the program certainly
    stops when it makes the state, or the first time that the state runs: an error of a check.
    `accepted`: a compiler or Python accepts the code, so that a build does not fail. `early`: only
    a state that reads the key `{word}` after the outcome `{near}` makes it a fault.
    """

    name: str
    message: str
    help: str
    near_help: str = ""
    effect: str | None = None
    unnamed: str = ""
    missing: bool = False
    stops: bool = False
    accepted: bool = False
    early: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class ClassFault:
    """A certain fault in the structure of a class, at the name that it is about.

    `near` is the name, or the code, that was probably meant. `file` is the module that lacks the
    name, `owner` the class that lacks it, and `more` another part of the words. `help` takes the
    place of that of the kind, if it is not empty. `variable` is the variable of the interface for
    which a parameter has another name. `outcomes` are those that `execute` does not
    return because of the fault, or ANY. `also` is another place that the fault is about, with the
    words for it.
    """

    kind: FaultKind
    name: Word
    near: str | None = None
    file: str = ""
    more: str = ""
    owner: str = ""
    help: str = ""
    variable: str = ""
    outcomes: tuple[str, ...] = ()
    also: Word | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """A parameter of a constructor that can be passed by its name, with its uses there."""

    word: Word
    required: bool
    uses: tuple[Span, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class StateCall:
    """The call of a constructor in the built-in `State.tpl.py`, with the lists and callbacks of the
    script: the place where a template extends it, and the parameters of the constructor."""

    place: Span
    parameters: tuple[Parameter, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Ending:
    """A constant that `execute` returns, and the userdata keys that the code before it can set;
    None: not known. `possible`: an entry of a table, which may be one that is never used, or a path
    that may be impossible. `meant` is the expression that was probably meant; `silent` the helper
    that ends without `return`, and so returns None. `skipped` are the keys that a path to it does
    not set, each with the place that leads past the assignment (pysource/flow/skipped_writes.py).
    `defined` is the place of the text of a constant that has a name in the code."""

    outcome: Word
    written: frozenset[str] | None = None
    possible: bool = False
    skipped: tuple[tuple[str, Word], ...] = ()
    meant: str | None = None
    silent: str = ""
    defined: Span | None = None


Step = tuple[Literal["attribute", "item", "each", "names"], str | int]
"""A step to a part of a value: the name of an attribute, an index or field in brackets, or, with an
empty name, any item in a loop. `names` is the last step: the number of names to which a value is
unpacked."""


class Part(NamedTuple):
    """A part of the value of a userdata key: the steps to it, and its text and place in the code:
    `userdata.pose.x`, `userdata.pads[0]["at"]`, and `pad["at"]` in a loop over `userdata.pads`."""

    key: str
    steps: tuple[Step, ...]
    text: str
    span: Span


class Compared(NamedTuple):
    """A text with which code compares a variable or an input key, at its place; `owner` is the text
    of the other side: `self.action`."""

    kind: Literal["variable", "key"]
    name: str
    owner: str
    word: Word


class TableLookUp(NamedTuple):
    """A look-up of a variable or an input key in the dictionary `table` of a module, with the keys
    of the dictionary, and the text and place of the look-up."""

    kind: Literal["variable", "key"]
    name: str
    table: str
    keys: tuple[Word, ...]
    word: Word


class MessageRef(NamedTuple):
    """A type of ROS that code names: `SetBool` of `std_srvs.srv`. `part` is the message of it that
    is meant: `request`; empty for the type itself."""

    kind: DefinitionKind
    package: str
    name: str
    part: str = ""

    def readings(self) -> tuple[tuple[DefinitionKind, str, str], ...]:
        """The types and messages that can be meant: in ROS 1 `TidyGoal` of `cell_msgs.msg` is the
        goal of the action `Tidy`, and `SetBoolRequest` the request of a service."""
        own = self.part or ("message" if self.kind == "msg" else "")
        found: list[tuple[DefinitionKind, str, str]] = [
            (self.kind, f"{self.package}/{self.name}", own)
        ]
        kinds: dict[DefinitionKind, DefinitionKind] = {"msg": "action", "srv": "srv"}
        other = kinds.get(self.kind) if not self.part else None
        for part in PARTS[other] if other is not None else ():
            if other is not None and self.name.endswith(part.capitalize()):
                name = self.name.removesuffix(part.capitalize())
                found.append((other, f"{self.package}/{name}", part))
        return tuple(found)


class ClassMessages(NamedTuple):
    """What a class does with types of ROS: those that its modules name, each at its place; for each
    method the types of its variables, and what it does with them; and the names of the arguments in
    calls of their classes."""

    named: tuple[tuple[MessageRef, Word], ...] = ()
    uses: tuple[tuple[tuple[tuple[str, MessageRef], ...], ArgumentUses], ...] = ()
    calls: tuple[tuple[MessageRef, tuple[Word, ...]], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class ClassFacts:
    """Facts about the class of a state type; declarations of a script are not included.

    `name` is the class name in its file; `is_function`: the code is a function, which has that
    name, as the callback of a CBState. `faults` are certain faults of its structure.
    `parameters` are those of its constructor; None: not known, or it accepts any.
    `outcomes`, `inputs` and `outputs` are the names that the constructor declares; None: not known.
    `passed` are the lists of these that are its parameters, `outcomes`, `input_keys` and
    `output_keys`, each with the names of its default value: a script gives them.

    `endings` are the constants that `execute` returns; `complete`: it returns nothing else.
    `execute` is the place of its name. `silent`: some path through it returns nothing,
    `always_silent`: every path. `open_end` is the place after which it returns nothing, with its
    kind: `if`, `match`, `except`, `loop`, or `text` and `value` for a text or another value alone,
    without its `return`;
    `in_loop` the `return` at the end of that loop.
    `reads` and `writes` are the userdata keys that it accesses, each at its name; `closed`: no
    other code accesses its userdata.
    `stub`: it only returns one constant. `checks_stop`: the class checks for preempt requests.
    `values` are the expressions that the class writes, each with its key; of a call of a function,
    also the texts that it returns. `loops` are the attributes that it loops over, each with the
    parameter of the constructor that it is. `unused` are the local variables, and the attributes of
    `self`, that it assigns and does not use, each with the userdata key of that name. `local` are
    its local variables, each with the code in which it has a value. `parts` are the parts of
    userdata keys that it reads itself: `userdata.pose.x`. `state_call`: the built-in
    `State.tpl.py` makes the state. `unlisted_reads` and `unlisted_writes` are the accesses of a
    class without an interface to keys that the constants in its constructor do not list. `hooks`
    are the methods of FlexBE's states, such as `on_enter`, that nothing in the class calls.
    `operations` are the comparisons and calculations of `execute` over userdata keys, whose name
    is `userdata`; `numbers` are the places of written values that are one number, `collections`
    those that are a list or a dictionary, with that type. `compared` are the texts with which it
    compares variables and keys. `entries` are those that it can add to mappings; None: not known.
    `tables` are its look-ups in dictionaries. `messages` are those of ROS; None if it has none.
    """

    name: Word | None = None
    is_function: bool = False
    faults: tuple[ClassFault, ...] = ()
    parameters: tuple[Parameter, ...] | None = None
    outcomes: tuple[Word, ...] | None = None
    inputs: tuple[Word, ...] | None = None
    outputs: tuple[Word, ...] | None = None
    passed: tuple[tuple[str, tuple[str, ...]], ...] = ()
    endings: tuple[Ending, ...] = ()
    complete: bool = False
    execute: Span | None = None
    silent: bool = False
    always_silent: bool = False
    open_end: Word | None = None
    in_loop: Word | None = None
    reads: tuple[Word, ...] = ()
    writes: tuple[Word, ...] = ()
    closed: bool = False
    stub: bool = False
    checks_stop: bool = False
    values: tuple[tuple[str, Word], ...] = ()
    unused: tuple[tuple[str, Word], ...] = ()
    local: tuple[Word, ...] = ()
    parts: tuple[Part, ...] = ()
    loops: tuple[tuple[str, Word], ...] = ()
    state_call: StateCall | None = None
    unlisted_reads: tuple[Word, ...] = ()
    unlisted_writes: tuple[Word, ...] = ()
    messages: ClassMessages | None = None
    hooks: tuple[str, ...] = ()
    operations: tuple[Word, ...] = ()
    userdata: str = ""
    numbers: tuple[Span, ...] = ()
    collections: tuple[tuple[Span, Literal["list", "dict"]], ...] = ()
    compared: tuple[Compared, ...] = ()
    entries: frozenset[str] | None = None
    tables: tuple[TableLookUp, ...] = ()

    @property
    def returns(self) -> tuple[Word, ...]:
        """The constants that `execute` returns."""
        return tuple(ending.outcome for ending in self.endings)


def renamed_name(declared: Iterable[Word] | None, known: Iterable[str]) -> tuple[Word, str] | None:
    """The only name that a class declares and its interface does not have, with the only one that
    the interface has and the class does not: probably two names of the same thing."""
    words, names = [*(declared or ())], [*known]
    more = [word for word in words if word.text not in names]
    missing = {*names}.difference(word.text for word in words)
    if len(more) != 1 or len(missing) != 1:
        return None
    return more[0], min(missing)
