"""The declared interfaces of the user's classes against their state types: SM603 and SM604."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from smachac.analysis.context import Context
from smachac.checks.rule import rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import renamed_name
from smachac.ir.nodes import StateType
from smachac.pysource.modules.user_code import Declared, Difference, StateClass, Words
from smachac.records import replace


@rule(
    "SM603",
    "interfaces-differ",
    Severity.ERROR,
    unsuppressible=True,
    effect="the robot runs the class, not the interface: SMACH can stop the machine with an error",
    about_code=True,
)
def interfaces_differ(context: Context) -> Iterator[Finding]:
    """The class of a state type and its interface have different outcomes or keys.

    The rules check the interface, but the robot runs the class: an outcome that only the class has
    leads nowhere.

    Exactly: a class is read and never run: in Python the lists that `__init__` passes to
    `smach.State`, itself or through the constructor of a base class of the project, in C++ the
    names in `Outcome`, `In` and `Out`. A part that cannot be read does not count. `check` reports a
    warning; a build for the language of the class fails.

    Wrong:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}
        code: {python: "robot_states.grasp:Grasp"}
        == robot_states/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self):
                super().__init__(outcomes=["done", "missed"])

            def execute(self, userdata):
                return "done"

    Right:
        name: sm
        outcomes: [done, lost]
        states:
          - GRASP: {template: Grasp, transitions: {missed: lost}}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}, missed: {}}
        code: {python: "robot_states.grasp:Grasp"}
        == robot_states/grasp.py ==
        import smach


        class Grasp(smach.State):
            def __init__(self):
                super().__init__(outcomes=["done", "missed"])

            def execute(self, userdata):
                return "done"
    """
    for of in context.code_facts.classes:
        differences = (
            [*_differences(of.type, _judged(of, context))] if not of.declared.stale else []
        )
        if differences:
            yield _difference_finding(of, differences, _severity(context))


@rule(
    "SM604",
    "stale-code",
    Severity.ERROR,
    unsuppressible=True,
    effect="a C++ compiler refuses the class: it has the number of another interface",
    about_code=True,
)
def stale_code(context: Context) -> Iterator[Finding]:
    """A C++ class was written for another version of its interface.

    The class may lack an outcome or a key that the interface now has.

    Exactly: `smachac_interface` in the class is the number of the interface that it was written
    for, and the interface now has another number. `check` reports a warning; `build --target cpp`
    fails, as the compiler would.

    Wrong:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}
        code: {cpp: {header: robot_states/grasp.hpp, class: "robot_states::Grasp"}}
        == include/robot_states/grasp.hpp ==
        #include "smachac/smachac.hpp"
        namespace robot_states {
        class Grasp {
        public:
          enum class Outcome { done };
          static constexpr std::uint32_t smachac_interface = 0x12345678U;
          Outcome execute() { return Outcome::done; }
        };
        }

    Right:
        name: sm
        outcomes: [done]
        states:
          - GRASP: {template: Grasp}
        == templates/Grasp.yml ==
        name: Grasp
        outcomes: {done: {}}
        code: {cpp: {header: robot_states/grasp.hpp, class: "robot_states::Grasp"}}
        == include/robot_states/grasp.hpp ==
        #include "smachac/smachac.hpp"
        namespace robot_states {
        class Grasp {
        public:
          enum class Outcome { done };
          static constexpr std::uint32_t smachac_interface = 0xfad787a6U;
          Outcome execute() { return Outcome::done; }
        };
        }
    """
    for of in context.code_facts.classes:
        number = of.declared.stale
        if number is not None:
            differences = [*_differences(of.type, of.declared)]
            yield _stale_finding(of, number, differences, _severity(context))


def _severity(context: Context) -> Severity:
    """An error for a program in the language of the class; a script alone needs no class."""
    project = context.project
    return Severity.ERROR if project is not None and project.target else Severity.WARNING


def _difference_finding(
    of: StateClass, differences: Sequence[Difference], severity: Severity
) -> Finding:
    name, type_name, language = of.declared.name, of.type.name, of.language
    place = of.type.class_spans.get((language, "" if language == "python" else "class"))
    named = [] if place is None else [Related(span=place, message="the class is named here")]
    others = f" (and {len(differences) - 1} more)" if differences[1:] else ""
    first = differences[0].word
    return Finding(
        span=first.span,
        message=f"the class `{name}` does not match `{type_name}.yml`: {first.text}{others}",
        arguments=(language, type_name, name),
        related=(*_places(differences[1:]), *named, of.user),
        help=differences[0].help,
        effect="the program does not compile" if language == "cpp" else differences[0].effect,
        severity=severity,
    )


def _stale_finding(
    of: StateClass, number: Word, differences: Sequence[Difference], severity: Severity
) -> Finding:
    name, type_name, leaf = of.declared.name, of.type.name, of.leaf
    used = Related(span=leaf.span, message=f"this state is of the type `{type_name}`")
    cause = differences[0].word if differences else None
    known = Related(span=number.span, message=f"the number of this version is {number.text}")
    return Finding(
        span=cause.span if cause is not None else number.span,
        message=f"the class `{name}` was written for another version of `{type_name}.yml`"
        + (f": {cause.text}" if cause is not None else ""),
        arguments=(type_name, name),
        related=(*_places(differences[1:]), *([known] if cause is not None else []), used),
        help=f"{_changes(differences)}, then set `smachac_interface` to {number.text}",
        severity=severity,
    )


def _changes(differences: Sequence[Difference]) -> str:
    """What to change in a class that was written for another version of its interface."""
    changes = dict.fromkeys(
        difference.change for difference in differences[:3] if difference.change
    )
    return "; ".join(changes) or "adapt the class to the interface"


def _places(differences: Sequence[Difference]) -> tuple[Related, ...]:
    return tuple(
        Related(span=difference.word.span, message=difference.word.text)
        for difference in differences
    )


def _judged(of: StateClass, context: Context) -> Declared:
    """The interface that a class declares. In a check, without what other rules report that its
    Python code does beyond its interface: returned outcomes (SM309), reads (SM310) and writes
    (SM308)."""
    type_, found = of.type, of.declared
    project, facts = context.project, type_.class_facts
    if facts is None or of.language != "python" or project is None or project.target:
        return found
    outcomes = [outcome.name for outcome in type_.outcomes]
    inputs = [key.name for key in type_.input_keys]
    outputs = [key.name for key in type_.output_keys]
    return replace(
        found,
        outcomes=_without(found.outcomes, facts.returns, outcomes),
        inputs=_without(found.inputs, facts.reads, inputs),
        outputs=_without(found.outputs, facts.writes, outputs),
    )


def _without(words: Words | None, used: Words, known: Sequence[str]) -> Words | None:
    """The names that a class declares, without those that its code uses and its interface lacks:
    in place of each is the name that is probably meant."""
    if words is None:
        return None
    reported = {word.text for word in used}.difference(known)
    guess, renamed = guesser(known), renamed_name(words, known)

    def near(name: str) -> str | None:
        return renamed[1] if renamed is not None and renamed[0].text == name else guess(name)

    meant = (Word(near(word.text) or "", word.span) for word in words if word.text in reported)
    kept = (word for word in words if word.text not in reported)
    return (*kept, *(word for word in meant if word.text))


def _differences(type_: StateType, found: Declared) -> Iterator[Difference]:
    parts = (
        ("outcome", found.outcomes, type_.outcomes),
        ("input key", found.inputs, type_.input_keys),
        ("output key", found.outputs, type_.output_keys),
    )
    for what, words, wanted in parts:
        left_to_the_script = f"{what.replace(' ', '_')}s" in type_.given
        if words is None or left_to_the_script or (what == "outcome" and type_.optional):
            continue
        names = [item.name for item in wanted]
        yield from _unlike(f"`{type_.name}.yml`", what, words, names, found)
    yield from found.others


_LACKED = {
    "outcome": "SMACH accepts only the outcomes of the class: the machine stops with an error",
    "input key": "SMACH lets the state read only the input keys of the class: the machine stops"
    " with an error",
    "output key": "SMACH discards the value of a key that is not an output key of the class",
}
"""What happens where a class lacks a part of its interface, in Python."""


def _whole_list(what: str, name: str, words: Words) -> str:
    """The help that adds a name to the list of a class in Python, if the list is written there."""
    added = f"add `{name}` to the {what}s of the class"
    if not words or len({word.span.line for word in words}) > 1:
        return added
    for word in words:
        if word.span.text not in (f"'{word.text}'", f'"{word.text}"'):
            return added
    quote = words[0].span.text[0]
    first, last = words[0].span, words[-1].span
    text = first.source.text
    if text[first.start - 1 : first.start] != "[" or text[last.end : last.end + 1] != "]":
        return added
    return f"write `{text[first.start - 1 : last.end]}, {quote}{name}{quote}]`"


def _unlike(
    file: str, what: str, words: Words, wanted: Sequence[str], found: Declared
) -> Iterator[Difference]:
    names = [word.text for word in words]
    missing = [name for name in wanted if name not in names]
    more = [word for word in words if word.text not in {*wanted}]
    if len(missing) == len(more) == 1:  # probably two names of the same thing
        text = f"it has the {what} `{more[0].text}`, the interface has `{missing[0]}`"
        uses = [word.span.line for word in found.uses if word.text == more[0].text]
        lines = ", ".join(map(str, dict.fromkeys(uses))) if what == "outcome" else ""
        also = f", also in line {lines}" if lines else ""
        change = f"write `{missing[0]}` in place of `{more[0].text}`{also}"
        help = f"{change}, or correct {file}"
        yield Difference(Word(text, more[0].span), help, change=change)
        return
    for name in missing:
        change = found.fields.get((what, name)) or _whole_list(what, name, words)
        place = Word(f"the {what} `{name}` is missing", words[0].span if words else found.span)
        help = f"{change}, or remove `{name}` from {file}"
        yield Difference(place, help, _LACKED[what], change)
    for word in more:
        change = f"remove `{word.text}` from the {what}s of the class"
        help = f"add `{word.text}` to the {what}s in {file}, or remove it from the class"
        text = f"the {what} `{word.text}` is not in the interface"
        yield Difference(Word(text, word.span), help, change=change)
