"""Errors of texts and fields: YAML, duplicate keys, unknown and missing variables, shapes, types.

The arguments of a code with several faults begin with a word for the fault, which is never printed.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from typing import NamedTuple

from smachac.diagnostics.diagnostic import (
    Diagnostic,
    Finding,
    Problem,
    Related,
    Severity,
    did_you_mean,
    problem,
)
from smachac.diagnostics.meanings import by_words
from smachac.diagnostics.repair import Certainty, Edit, Repair
from smachac.diagnostics.source import Span, Word
from smachac.diagnostics.spelling import guesser_of, respelt
from smachac.diagnostics.wording import listed, possible


class Owner(NamedTuple):
    """The owner of variables: its name in the language or in the script, its name in messages, such
    as `MoveArm` and "state type `MoveArm`", and the word for what it has."""

    name: str
    text: str
    part: str = "variable"


@problem(
    "SM001",
    "yaml-syntax",
    Severity.ERROR,
    effect="smachac cannot read the text as YAML, so no program is generated",
)
def yaml_syntax(
    span: Span,
    message: str,
    help: str | None = None,
    *,
    arguments: tuple[str, ...] = (),
    related: tuple[Related, ...] = (),
    effect: str | None = None,
    repairs: tuple[Repair, ...] = (),
) -> Finding:
    """The text is not YAML.

    A text that cannot be parsed has no meaning. A parser that guesses could move the robot to
    a wrong place.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}

    Right:
        name: sm
        template: Base
        outcomes: [succeeded]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
    """
    return Finding(
        span=span,
        message=message,
        arguments=arguments,
        help=help or "check the brackets, quotes and indentation before this place",
        related=related,
        effect=effect,
        repairs=repairs,
    )


@problem(
    "SM002",
    "duplicate-key",
    Severity.ERROR,
    effect="most YAML parsers keep only the last entry: the first one has no effect",
)
def duplicate_key(key: Word, first: Span) -> Finding:
    """A mapping or a list of names has the same name twice.

    Most YAML parsers keep the last entry and drop the first one without a message. A recovery
    transition in the first entry would then never be taken.

    Wrong:
        name: sm
        template: Base
        outcomes: [picked, empty]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, nothing]
              transitions: {done: picked, nothing: LOOK}
              transitions: {done: LOOK, nothing: empty}
          - LOOK:
              template: ScriptedState
              outcomes: [seen, nothing]
              transitions: {seen: picked, nothing: empty}

    Right:
        name: sm
        template: Base
        outcomes: [picked, empty]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done, nothing]
              transitions: {done: picked, nothing: LOOK}
          - LOOK:
              template: ScriptedState
              outcomes: [seen, nothing]
              transitions: {seen: picked, nothing: empty}
    """
    return Finding(
        span=key.span,
        message=f"`{key.text}` is given twice",
        arguments=(key.text,),
        help="remove one of the two, or merge them",
        related=(Related(span=first, message="first given here"),),
    )


FOREIGN = {
    "autonomy": "remove it: smachac has no levels of autonomy",
    "child_termination_cb": "write `join: any` if the first branch that ends must stop the others",
    "base": "name the base with `template:`",
    "children": "write `states:`",
    "class": "name the state type with `template:`",
    "initial_state": "write `initial:`",
    "io_keys": "list the keys in `input_keys` and in `output_keys`",
    "item": "write `it_label:` at an Iterator for the name of one item",
    "items": "write `it:` at an Iterator for the items, and `it_label:` for the name of one",
    "max_retries": "write `retry: {on: [OUTCOME], max: NUMBER}`",
    "next": "write `transitions: {OUTCOME: STATE}`",
    "outcome_cb": "write rules in `outcome_map`",
    "parameters": "write each parameter as a variable of the state, or constants in `params`",
    "retries": "write `retry: {on: [OUTCOME], max: NUMBER}`",
    "substates": "write `states:`",
    "values": "write initial values in `userdata`",
}
"""Fields of other tools that scripts lack, each with the help for it."""

ELSEWHERE = {
    "on_error": (
        "only a StateMachine, a Sequence and the script itself have `on_error`: it has no effect"
        " here",
        "remove it here; write `on_error: TARGET` at the StateMachine around it, or `error: TARGET`"
        " in the `transitions` of a state in a StateMachine",
    ),
}
"""Fields that only some owners have, each with the effect of another place and the help for it."""


class Choice(NamedTuple):
    """What can be meant by an unknown name. `meant` is certainly meant, `likely` probably;
    `required` is one of them that is required and missing. `own` are the variables of a state type,
    which come before other names; `free` the names that are not given yet; `proposed` those that
    only a new check can choose from. `owners` are the only ones that have a field of the name."""

    meant: str | None = None
    likely: str | None = None
    required: str | None = None
    own: Collection[str] = ()
    free: Collection[str] = ()
    proposed: Sequence[str] = ()
    owners: Collection[str] = ()


ANY_NAME = Choice()
"""Nothing is known of what is meant."""


@problem(
    "SM003",
    "unknown-variable",
    Severity.ERROR,
    effect="no code reads a field of this name: the program runs without its value",
)
def unknown_variable(
    word: Word,
    owner: Owner,
    known: Iterable[str],
    choice: Choice = ANY_NAME,
    *,
    help: str | None = None,
    message: str | None = None,
    severity: Severity | None = None,
) -> Finding:
    """A script sets a variable that neither the language nor the state type has.

    The value would be ignored: a speed, a limit or a transition would have no effect on the robot.
    A template of SMACHA's kind accepts any variable; one that it does not use is a warning.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transition: {done: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    own = sorted(choice.own)
    names = sorted({*known, *own})
    spelt = guesser_of(tuple(names)).unique_match(word.text)
    sure = choice.meant or spelt or choice.likely
    number = number_before(word)
    if number:
        help = f"a decimal comma? write `{number}.{word.text}`"
    is_known = help is not None
    lacks = f"no code reads a field of this name, and `{choice.required}`, which is required, is"
    effect = f"{lacks} missing" if choice.required else None
    if not is_known:
        foreign = None if sure else FOREIGN.get(word.text)
        effect = "other tools have such a field, smachac has not" if foreign else effect
        if word.text in ELSEWHERE and not sure:
            effect, foreign = ELSEWHERE[word.text]
        if not (sure or foreign) and owner.part == "variable":
            foreign = _misplaced(word.text, choice.owners)
        listed = f"use one of its {owner.part}s{possible(names, choice.free)}"
        others = listed if names else f"remove it: {owner.text} has no other {owner.part}s"
        help = foreign or _variable_help(word.text, sure, names, own) or others
    return Finding(
        span=word.span,
        message=message or f"`{word.text}` is not a {owner.part} of {owner.text}",
        arguments=(word.text, owner.name),
        help=help,
        edits=() if is_known else respelt(word, choice.meant or spelt),
        repairs=tuple(
            Repair(
                edits=edits,
                certainty=Certainty.LIKELY if sure else Certainty.POSSIBLE,
                operator="write another name",
            )
            for name in ([sure] if sure else choice.proposed)
            if not is_known and (edits := respelt(word, name))
        ),
        severity=severity,
        effect=effect,
    )


def unused_variable(word: Word, owner: Owner, known: Iterable[str]) -> Diagnostic:
    """SM003 for a variable that a template, which accepts any, does not use."""
    sure = guesser_of(tuple(sorted({*known}))).unique_match(word.text)
    return unknown_variable(
        word,
        owner,
        (),
        help=f"did you mean `{sure}`?" if sure else "remove it, or use it in the template",
        message=f"the template of {owner.text} does not use the variable `{word.text}`",
        severity=Severity.WARNING,
    )


def one_of_many(word: Word, owner: Owner) -> Diagnostic:
    """SM003 for one of very many unknown variables: without a search for what is meant."""
    help = f"remove it, or correct all fields of {owner.text}"
    return unknown_variable(word, owner, (), help=help)


def _misplaced(word: str, owners: Collection[str]) -> str | None:
    """The help for a variable of the language that only other owners have."""
    if not owners:
        return None
    names = [f"`{owner}`" for owner in sorted(owners) if owner != "base"]
    if not names:
        return f"write it at the top of the script: no state has `{word}`"
    names += ["the script itself"] if "base" in owners else []
    return f"remove it here, or move it: only {' and '.join(names)} can have `{word}`"


def _variable_help(word: str, sure: str | None, names: list[str], own: list[str]) -> str | None:
    """The help for an unknown variable: `own` are those of the state type, which come before the
    others among `names`."""
    if sure is not None:
        return f"did you mean `{sure}`?"
    meant = by_words(word, own or names)
    near = did_you_mean(word, own or names)
    if near is not None or meant is not None:
        return near or f"did you mean `{meant}`?"
    is_one = len(own) == 1
    return f"its variable{' is' if is_one else 's are'} {listed(own)}" if own else None


_LONGEST_NUMBER = 20


_DECIMALS = r"[0-9]+ ?[A-Za-zµ%]*"
"""The digits of a number after its decimal comma, with a unit."""


def number_before(word: Word) -> str:
    """The digits before a comma in front of a word of digits, also with a unit: `0` in
    `{time: 0,5s}`, where YAML reads an entry `5s`. Empty without them."""
    start = word.span.start
    text = word.span.source.text[max(0, start - _LONGEST_NUMBER) : start]
    before = text.removesuffix(",")
    digits = before[len(before.rstrip("0123456789")) :]
    return digits if re.fullmatch(_DECIMALS, word.text) and before != text else ""


@problem(
    "SM004",
    "wrong-shape",
    Severity.ERROR,
    effect="smachac cannot read a value of this form here, so no program is generated",
)
def wrong_shape(
    span: Span,
    message: str,
    help: str | None = None,
    related: tuple[Related, ...] = (),
    *,
    arguments: tuple[str, ...] = (),
    edits: tuple[Edit, ...] = (),
    effect: str | None = None,
) -> Finding:
    """A value has a shape that the language does not allow at this place.

    An empty block, or a list in place of a mapping, has no defined meaning. With a guessed meaning
    the robot could take a transition that nobody wrote.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done]
              transitions:

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK:
              template: ScriptedState
              outcomes: [done]
              transitions: {done: done}
    """
    return Finding(
        span=span,
        message=message,
        arguments=arguments,
        help=help,
        related=related,
        edits=edits,
        effect=effect,
    )


@problem(
    "SM005",
    "missing-variable",
    Severity.ERROR,
    effect="the state is incomplete without it, so no program is generated",
)
def missing_variable(
    span: Span,
    name: str,
    owner: Owner,
    related: tuple[Related, ...] = (),
    example: str = "",
    *,
    help: str | None = None,
    edits: tuple[Edit, ...] = (),
) -> Finding:
    """A variable is missing that the language or the state type requires.

    Without it the state has no meaning, or a skill would start without a value that it needs.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {outcomes: [done], transitions: {done: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    help = help or f"add `{name}: {example or MISSING.get(name, '...')}`"
    return Finding(
        span=span,
        message=f"the {owner.part} `{name}` is missing: {owner.text} requires it",
        arguments=(name, owner.name),
        help=help,
        related=related,
        edits=edits,
    )


MISSING: Mapping[str, str] = {
    "name": "my_task",
    "template": "TYPE",
    "outcomes": "[succeeded, aborted]",
    "states": "[...]",
    "time": "1.5",
}
"""An example value of each field that can be missing."""

OTHER_NAMES = {
    "array": "list",
    "bytes": "str",
    "char": "str",
    "callable": "any",
    "dictionary": "dict",
    "double": "float",
    "enum": "one_of[a, b]",
    "function": "any",
    "map": "dict",
    "nothing": "none",
    "null": "none",
    "number": "float",
    "object": "any",
    "real": "float",
    "string": "str",
    "text": "str",
    "tuple": "list",
}
"""The names of other languages, with the types that correspond to them."""


def _word_in(span: Span, word: str) -> Span:
    """The place of a word in a text; the whole text, if it is not written there as it is."""
    found = re.search(rf"(?<!\w){re.escape(word)}(?!\w)", span.text)
    if found is None:
        return span
    return Span(span.source, span.start + found.start(), span.start + found.end())


@problem("SM017", "bad-type", Severity.ERROR)
def bad_type(
    place: Word,
    known: Iterable[str],
    unknown: str = "",
    *,
    help: str | None = None,
    where: str = "`types:`",
) -> Finding:
    """A type cannot be parsed, or contains the name of an unknown type.

    Without a type, values are not checked, and a wrong value can reach the robot. An unknown name
    is a warning: it counts as `any`.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {width: {type: "float<m", value: 0.05}}
        states:
          - PICK:
              template: ScriptedState
              input_keys: [width]
              outcomes: [done]
              transitions: {done: done}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        userdata: {width: {type: "float<m>", value: 0.05}}
        states:
          - PICK:
              template: ScriptedState
              input_keys: [width]
              outcomes: [done]
              transitions: {done: done}
    """
    word = unknown or place.text
    meant = OTHER_NAMES.get(word.casefold())
    help = help or (f"write `{meant}`" if meant else None)
    if word.isidentifier():
        help = help or did_you_mean(word, known)
    if unknown:
        return Finding(
            span=_word_in(place.span, unknown),
            message=f"`{unknown}` is not a known type: its values are not checked",
            arguments=(place.text, unknown),
            help=help or f"declare it under {where}, or write a type of ROS as `pkg/Name`",
            severity=Severity.WARNING,
        )
    closed = _closed_type(place.text)
    if closed and not meant:
        help = f"close the bracket, as in `{closed}`"
    return Finding(
        span=place.span,
        message=f"`{place.text}` is not a valid type",
        arguments=(place.text,),
        help=help or "write it like `float`, `float<rad>[7]`, `list[Pose]`, `one_of[open, close]`",
        effect="values of an unknown type cannot be checked, so no program is generated",
    )


def _closed_type(text: str) -> str:
    """A type whose last bracket is not closed, with the bracket; empty for any other text."""
    for opening, closing, examples in (
        ("[", "]", {"list": "Pose", "dict": "str, float", "one_of": "open, close"}),
        ("<", ">", {}),
    ):
        before, found, inside = text.rpartition(opening)
        if found and before.isidentifier() and closing not in inside:
            inner = inside.strip() or examples.get(before, "7" if opening == "[" else "rad")
            return f"{before}{opening}{inner}{closing}"
    return ""


@problem(
    "SM006",
    "too-big",
    Severity.ERROR,
    effect="the limit keeps every check short; no program is generated beyond it",
)
def too_big(span: Span, message: str, help: str, *, arguments: tuple[str, ...]) -> Finding:
    """The text, its nesting, or its aliases and look-ups exceed a limit of smachac.

    A check must end for every text, also for one from an unknown author. The limits are larger
    than any real script needs.

    Wrong:
        name: sm
        template: Base
        outcomes: [done]
        userdata:
          a: &a [0, 0, 0, 0, 0, 0, 0, 0, 0, 0]
          b: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a, *a]
          c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b, *b]
          d: &d [*c, *c, *c, *c, *c, *c, *c, *c, *c, *c]
          e: &e [*d, *d, *d, *d, *d, *d, *d, *d, *d, *d]
          f: &f [*e, *e, *e, *e, *e, *e, *e, *e, *e, *e]
          g: &g [*f, *f, *f, *f, *f, *f, *f, *f, *f, *f]
          h: &h [*g, *g, *g, *g, *g, *g, *g, *g, *g, *g]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: done}}

    Right:
        name: sm
        template: Base
        outcomes: [done]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: done}}
    """
    return Finding(span=span, message=message, arguments=arguments, help=help)


@problem(
    "SM007",
    "unreadable-file",
    Severity.ERROR,
    effect="smachac cannot use the file, so no program is generated",
)
def unreadable_file(
    span: Span,
    message: str,
    help: str | None = None,
    *,
    arguments: tuple[str, ...],
    severity: Severity | None = None,
) -> Finding:
    """A file cannot be read, or the project file has a wrong setting.

    A robot must not start with a part of its script, so nothing is compiled. A file is unreadable
    if it is missing, is a folder, is not text, or if its permissions forbid it. A search folder of
    the project file that does not exist is a warning.

    Wrong:
        name: sm
        template: Base
        outcomes: [succeeded]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
        == smachac.toml ==
        scripts: [no, toml]

    Right:
        name: sm
        template: Base
        outcomes: [succeeded]
        states:
          - PICK: {template: ScriptedState, outcomes: [done], transitions: {done: succeeded}}
        == smachac.toml ==
        scripts = ["sub_scripts"]
        == sub_scripts/wait.yml ==
        - WAIT: {template: SleepState, time: 1}
    """
    return Finding(
        span=span,
        message=message,
        arguments=arguments,
        help=help or "check the path, and check that the file is text in UTF-8",
        effect=None if severity is None else "",
        severity=severity,
    )


PROBLEMS: tuple[Problem[...], ...] = (
    yaml_syntax,
    duplicate_key,
    unknown_variable,
    wrong_shape,
    missing_variable,
    too_big,
    unreadable_file,
    bad_type,
)
"""The problems of this module, in the order of their codes."""
