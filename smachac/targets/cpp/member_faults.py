"""Faults in the members of a C++ class that its header shows: `execute` and the constructors.

What a header can express in another form, such as inherited members, templates, default arguments
and code in other files, is left to the compiler.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from smachac.diagnostics.source import Word
from smachac.diagnostics.spelling import words_of
from smachac.frontend.loader import Library
from smachac.ir.class_facts import ClassFault, FaultKind
from smachac.ir.outcome_names import PREEMPTED, is_failure
from smachac.targets.cpp.constructors import constructor_faults
from smachac.targets.cpp.cpp_text import Part
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.key_members import unknown_members
from smachac.targets.cpp.unused_calls import UnusedCall, unused_call
from smachac.targets.cpp.user_classes import REFUSED, ClassCode, left_to_scripts, stops

WRONG_RESULT = FaultKind(
    name="wrong result",
    message="`execute` of `{name}` returns `{word}`, not an outcome",
    help="write `{near}`",
    effect=REFUSED,
)
WRONG_PARAMETERS = FaultKind(
    name="wrong parameters",
    message="`execute` of `{name}` {more}",
    help="write `{near}`",
    effect=REFUSED,
)
UNUSED_OUTCOME = FaultKind(
    name="unused outcome",
    message="`execute` of `{name}` never returns `Outcome::{word}`",
    help="return it where it is meant, or remove it from `Outcome`, from the interface,"
    " and from the transitions of the script",
    effect="a transition for this outcome is never taken",
    accepted=True,
)
UNUSED_CALL = FaultKind(
    name="unused call",
    message="`execute` of `{name}` never returns `Outcome::{more}`: the result of `{word}`"
    " is not used",
    help="write `{near}`",
    effect="the state ends with the same outcome whatever the call returns",
    accepted=True,
)
NO_ANSWER_TO_STOPS = FaultKind(
    name="no answer to stops",
    message="`execute` of `{name}` never returns `Outcome::{word}`: a time limit or a stop"
    " cannot end it",
    help="add where it waits: `if (stop.requested()) {{ stop.service(); return"
    " Outcome::{word}; }}`",
    effect="a transition for this outcome is never taken",
    accepted=True,
)
OTHER_ANSWER = FaultKind(
    name="other answer",
    message="`execute` of `{name}` returns `Outcome::{word}` after a stop request",
    help="write `return Outcome::{near};`",
    effect="a stop or a time limit counts as `{word}`: a transition for `{near}` is never taken",
    accepted=True,
)
UNSET_OUTPUT = FaultKind(
    name="unset output",
    message="`execute` of `{name}` never sets its output key `{word}`",
    help="write `out.{word} = ...` before a `return`, or remove the key from the"
    " interface and from `Out`",
    effect="a state that reads the key afterwards gets an old value, or fails",
    accepted=True,
)
SKIPPED_OUTPUT = FaultKind(
    name="skipped output",
    message="`execute` of `{name}` can return `Outcome::{near}` without setting its output"
    " key `{word}`",
    help="write `out.{word} = ...` before this `return`, or remove `{word}` from"
    " `{near}` in the `writes:` of `{type}.yml`",
    effect="a state that reads the key afterwards gets an old value, or fails",
    accepted=True,
)
EARLY_RETURN = FaultKind(
    name="early return",
    message="`execute` of `{name}` returns `Outcome::{near}` here before its output key"
    " `{word}` is set",
    help="write `out.{word} = ...` before this `return`, or lead `{near}` to a state"
    " that does not read `{word}`",
    effect="a state that reads the key afterwards gets an old value, or fails",
    accepted=True,
    early=True,
)

_EXECUTE = re.compile(r"\bexecute\s*\(([^()]*)\)")
_STOP_COPY = re.compile(r"(?:^|,)\s*((?:const\s+)?(?:smachac\s*::\s*)?Stop\s+(\w+))\s*(?=,|$)")
"""A parameter for requests to stop by value: `Stop` has no copies."""
_ACCESS = re.compile(r"\b(?:public|private|protected)\s*:(?!:)")
_RESULTS = re.compile(
    r"(?:\[\[\w+\]\]\s*)?(?:(?:virtual|inline)\s+)*"
    r"(?P<type>void|bool|int|double|float|(?:std::)?(?:string|u?int\d+_t|size_t))"
)
_ELSEWHERE = re.compile(
    r"\busing\b|\btypedef\b|\bauto\b|<\s*Outcome\s*>|(?<!class )(?<!struct )\bOutcome\s*[({]"
    r"|\bOutcome\s+\w+\s*[=;,)]"
)
"""Text after which an outcome can be returned without its name: conversions, aliases, variables."""
_RETURN = re.compile(r"\breturn\b([^;]*);")
_JUMP = re.compile(r"\b(?:for|while|do|goto|try|switch)\b|#|\[[&=\w, ]*\]\s*[({]")
"""Code whose paths are not read: loops, jumps, exceptions, and functions inside."""
_BRANCH = re.compile(r"\b(?:if|else)\b")
_ANSWER = re.compile(r"\.\s*service\s*\(\s*\)\s*;\s*(return\s+Outcome\s*::\s*(\w+))\s*;")
"""A stop request that is answered, and the outcome that is returned then."""
_IF = re.compile(r"\bif\s*\([^{};]*\)\s*$")

Words = tuple[Word, ...]


def member_faults(
    code: ClassCode, whole: Part, body: Part, outcomes: Words | None, library: Library
) -> Iterator[ClassFault]:
    """The faults of a class that is not derived from another one."""
    found = [*signature_faults(code, body)]
    yield from found
    head = _execute(code, body)
    if head is None or any(fault.kind in (WRONG_RESULT, WRONG_PARAMETERS) for fault in found):
        return
    run = _body_of(body, head.end())
    unknown = [*unknown_members(code, body, run, head[1])] if run is not None else []
    yield from unknown
    if run is not None and outcomes is not None and not unknown:
        for fault in _unused(whole, body, run, outcomes):
            yield _at_execute(code, body, run, fault, head, library)
        yield from _unset(code, body, run, head[1])
        yield from _skipped(code, run, head[1])


def signature_faults(code: ClassCode, body: Part) -> Iterator[ClassFault]:
    """The faults in the parameters of the constructors and of `execute`, and in its result."""
    if "template" in body.text or left_to_scripts(code.type):
        return
    yield from constructor_faults(code, body)
    head = _execute(code, body)
    if head is None:
        return
    before = re.split(r"[;{}]", body.text[: head.start()])[-1]
    result = _RESULTS.fullmatch(_ACCESS.sub(" ", before).strip())
    wanted = f"Outcome execute({', '.join(_arguments(code))})"
    if result is not None:
        at = body.text.rfind(result["type"], 0, head.start())
        word = body.word(result["type"], at, at + len(result["type"]))
        yield ClassFault(kind=WRONG_RESULT, name=word, near=wanted)
        return
    if _count(head[1]) not in (None, len(_arguments(code))):
        marked = head.span(1) if head[1].strip() else (head.start(), head.start() + len("execute"))
        types = {argument: argument.split()[0].rpartition(":")[2] for argument in _arguments(code)}
        lacks = [text for text, name in types.items() if not re.search(rf"\b{name}\b", head[1])]
        more = "has other parameters than its interface needs"
        if (_count(head[1]) or 0) + len(lacks) == len(_arguments(code)):
            named = " and ".join(f"`{lack}`" for lack in lacks)
            more = f"lacks the parameter{'s' if len(lacks) > 1 else ''} {named}"
        place = body.word("execute", *marked)
        yield ClassFault(kind=WRONG_PARAMETERS, name=place, near=wanted, more=more)
        return
    copied = _STOP_COPY.search(head[1])
    if copied is not None:
        start = head.start(1) + copied.start(1)
        place = body.word(copied[1], start, start + len(copied[1]))
        near = f"smachac::Stop &{copied[2]}"
        more = f"takes `{copied[1]}` as a copy, which `Stop` does not have"
        yield ClassFault(kind=WRONG_PARAMETERS, name=place, near=near, more=more)


def _execute(code: ClassCode, body: Part) -> re.Match[str] | None:
    """The head of `execute`, from its name to the end of its parameters."""
    if "template" in body.text or left_to_scripts(code.type):
        return None
    found = [*body.members(_EXECUTE)]
    return found[0] if len(found) == 1 else None


def _arguments(code: ClassCode) -> list[str]:
    """The parameters that `execute` needs."""
    type_ = code.type
    given = (
        ("In in", bool(type_.input_keys)),
        ("Out out", bool(type_.output_keys)),
        ("smachac::Stop &stop", stops(type_)),
    )
    return [text for text, needed in given if needed]


def _count(parameters: str) -> int | None:
    """The number of parameters in a list; None if it has defaults or other forms."""
    text = parameters
    while (shorter := re.sub(r"<[^<>]*>", "", text)) != text:
        text = shorter
    if re.search(r"[=<>\[\]{}]|\.\.\.", text):
        return None
    pieces = [part.strip() for part in text.split(",")]
    return 0 if pieces in ([""], ["void"]) else len(pieces)


def _body_of(body: Part, at: int) -> Part | None:
    """The body of a function whose list of parameters ends at a place; None if it is elsewhere."""
    head = re.compile(r"\s*(?:const\s*)?(?:noexcept\s*)?\{").match(body.text, at)
    return body.inside(head)


def _unused(whole: Part, body: Part, run: Part, outcomes: Words) -> Iterator[ClassFault]:
    """The outcomes that no code in the header names, if every `return` of `execute` names one. A
    class with one outcome in use is not written yet."""
    returned = [match_[1] for match_ in _RETURN.finditer(run.text)]
    known = {identifier(outcome.text) for outcome in outcomes}
    if not known.issuperset(re.findall(r"\bOutcome\s*::\s*(\w+)", body.text)):
        return  # a misspelt outcome is reported: it is probably the one that is not returned
    functions = _outcome_functions(body)
    if _ELSEWHERE.search(body.text) or functions is None:
        return
    for value in returned:
        called = re.fullmatch(r"\s*(\w+)\s*\(.*\)\s*", value, re.DOTALL)
        inner = called is not None and called[1] in functions
        if "Outcome::" not in value.replace(" ", "") and not inner:
            return
    names = {outcome: identifier(outcome.text) for outcome in outcomes}
    used = {word for word, name in names.items()
            if len(re.findall(rf"\b{re.escape(name)}\b", whole.text)) > 1}  # fmt: skip
    if len(used) < 2:
        return
    for word in outcomes:
        if word not in used:
            stop = word.text == PREEMPTED
            answer = _ANSWER.search(run.text) if stop else None
            if answer is not None:
                place = run.word(answer[2], *answer.span(1))
                yield ClassFault(kind=OTHER_ANSWER, name=place, near=identifier(word.text))
                continue
            yield ClassFault(kind=NO_ANSWER_TO_STOPS if stop else UNUSED_OUTCOME, name=word)


def _at_execute(
    code: ClassCode,
    body: Part,
    run: Part,
    fault: ClassFault,
    head: re.Match[str],
    library: Library,
) -> ClassFault:
    """The fault that an outcome is never returned, at the call whose result decides it, or at
    `execute`."""
    if fault.kind is not UNUSED_OUTCOME:
        return fault
    name = fault.name.text
    declared = fault.name._replace(text=f"`{name}` is declared here")
    call = unused_call(body, run, library)
    if call is not None:
        written = _with_outcome(code, call, name)
        if written:
            return ClassFault(kind=UNUSED_CALL, name=call.word, near=written, more=name)
    place = body.word(name, head.start(), head.start() + len("execute"))
    return ClassFault(kind=UNUSED_OUTCOME, name=place, also=declared)


def _with_outcome(code: ClassCode, call: UnusedCall, outcome: str) -> str:
    """The statement that returns an outcome by the result of a call; empty if it is not known for
    which result: a failure is meant for false, unless it has the name of the method."""
    failures = {
        outcome.name
        for outcome in code.type.outcomes
        if outcome.failure or (outcome.failure is None and is_failure(outcome.name))
    }
    named = call.method in (outcome, f"is_{outcome}", f"has_{outcome}")
    other = next((outcome.name for outcome in code.type.outcomes
                  if identifier(outcome.name) == call.outcome), "")  # fmt: skip
    if not named and (outcome not in failures or other in failures):
        return ""
    wanted, text = f"Outcome::{identifier(outcome)}", call.word.text
    if not call.outcome:
        return f"if ({'' if named else '!'}{text}) return {wanted};"
    first, second = (wanted, f"Outcome::{call.outcome}")[:: 1 if named else -1]
    return f"return {text} ? {first} : {second};"


def _outcome_functions(body: Part) -> set[str] | None:
    """The methods that return outcomes; None if the body of one is elsewhere."""
    found = set()
    for head in re.finditer(r"\bOutcome\s+(\w+)\s*\([^()]*\)", body.text):
        if _body_of(body, head.end()) is None:
            return None
        found.add(head[1])
    return found


def _unset(code: ClassCode, body: Part, run: Part, parameters: str) -> Iterator[ClassFault]:
    """The output keys that `execute` does not name, if it passes `Out` to no other function."""
    named = re.search(r"\bOut\s*&?\s*(\w+)", parameters)
    if named is None:
        return
    uses = re.findall(rf"\b{re.escape(named[1])}\b\s*(\.?)", run.text)
    unused = len(re.findall(rf"\(\s*void\s*\)\s*{re.escape(named[1])}\b", run.text))
    if uses.count("") > unused:
        return
    fields = body.inside(body.member(r"\bstruct\s+Out\s*\{"))
    if fields is None:
        return
    for key in code.type.output_keys:
        name = identifier(key.name)
        inside = re.search(rf"\b{re.escape(name)}\b", fields.text)
        used = re.search(rf"\b{re.escape(named[1])}\s*\.\s*{re.escape(name)}\b", run.text)
        if inside is not None and used is None:
            promised = _promised(code, run, key.name, named[1])
            if promised is not None:
                yield promised
                continue
            value = _local_value(run, key.name, len(run.text), named[1])
            place = fields.word(key.name, *inside.span())
            help = f"write `{value}` before the `return`" if value else ""
            yield ClassFault(kind=UNSET_OUTPUT, name=place, help=help)


_LOCAL = re.compile(r"(?:^|[;{}])\s*(?:const\s+)?[A-Za-z_][\w:]*(?:<[\w:<>, ]*>)?\s+(\w+)\s*[={]")
"""The declaration of a local variable with a value."""


def _local_value(run: Part, key: str, at: int, out: str) -> str:
    """The assignment of the local variable with the name of an output key, or of the only one with
    a word of it, that has a value at a place; empty if there is none."""
    known = {match_[1] for match_ in _LOCAL.finditer(_open_blocks(run.text[:at]))} - {"return"}
    words = words_of(key)
    near = [key] if key in known else [value for value in known if words & words_of(value)]
    return f"{out}.{identifier(key)} = {near[0]};" if len(near) == 1 else ""


def _open_blocks(text: str) -> str:
    """Code without the blocks that it closes."""
    shorter = ""
    while text != shorter:
        text, shorter = re.sub(r"\{[^{}]*\}", ";", text), text
    return text


def _promised(code: ClassCode, run: Part, key: str, out: str) -> ClassFault | None:
    """The only `return` of an outcome that promises an output key in `writes:`."""
    found = [
        (outcome, end)
        for outcome, keys in code.type.writes
        if key in keys
        for end in re.finditer(
            rf"\breturn\s+Outcome\s*::\s*{re.escape(identifier(outcome))}\s*;", run.text
        )
    ]
    if len(found) != 1:
        return None
    ((outcome, end),) = found
    place = run.word(key, end.start(), end.end() - 1)
    value = _local_value(run, key, end.start(), out)
    help = f"write `{value}` before this `return`" if value else ""
    return ClassFault(kind=SKIPPED_OUTPUT, name=place, near=outcome, help=help)


def _skipped(code: ClassCode, run: Part, parameters: str) -> Iterator[ClassFault]:
    """The returns of an outcome that promises an output key in `writes:`, where the key is set
    nowhere before them, or only in one `if` that ends before them and has no branch after it."""
    named = re.search(r"\bOut\s*&?\s*(\w+)", parameters)
    if named is None or _JUMP.search(run.text):
        return
    out = re.escape(named[1])
    if re.search(rf"\b{out}\b(?!\s*\.)", run.text):
        return  # other code gets it
    yield from _early(code, run, out)
    for outcome, keys in code.type.writes:
        returned = rf"\breturn\s+Outcome\s*::\s*{re.escape(identifier(outcome))}\s*;"
        for end in re.finditer(returned, run.text):
            for key in keys:
                set_ = [
                    match_.start()
                    for match_ in re.finditer(rf"\b{out}\s*\.\s*{identifier(key)}\b", run.text)
                ]
                before = [at for at in set_ if at < end.start()]
                if set_ and (not before or (len(before) == 1 and _only_if(run, before[0], end))):
                    place = run.word(key, end.start(), end.end() - 1)
                    later = _later(run, out, key, end.start()) if not before else None
                    yield ClassFault(kind=SKIPPED_OUTPUT, name=place, near=outcome,
                                     help=_moved(later), also=_set_here(later))  # fmt: skip


def _early(code: ClassCode, run: Part, out: str) -> Iterator[ClassFault]:
    """The returns before the first place that sets an output key without `writes:`, by outcome.
    Only a script that reads the key after that outcome makes them a fault."""
    listed = {key for _, keys in code.type.writes for key in keys}
    for key in code.type.output_keys:
        set_ = re.search(rf"\b{out}\s*\.\s*{re.escape(identifier(key.name))}\b", run.text)
        if key.name in listed or set_ is None:
            continue
        for outcome in code.type.outcomes:
            name = re.escape(identifier(outcome.name))
            end = re.search(rf"\breturn\s+Outcome\s*::\s*{name}\s*;", run.text)
            if outcome.name != PREEMPTED and end is not None and end.start() < set_.start():
                place = run.word(key.name, end.start(), end.end() - 1)
                later = _later(run, out, key.name, end.start())
                yield ClassFault(kind=EARLY_RETURN, name=place, near=outcome.name,
                                 help=_moved(later), also=_set_here(later))  # fmt: skip


def _moved(later: Word | None) -> str:
    """The help to set a key before a `return` too, if it is set after it; otherwise empty."""
    return f"write `{later.text}` before this `return` too" if later is not None else ""


def _later(run: Part, out: str, key: str, at: int) -> Word | None:
    """The only assignment of an output key, if it is after a place and could be before it: all that
    its value needs is known there."""
    name = re.escape(identifier(key))
    found = [*re.finditer(rf"\b{out}\s*\.\s*{name}\s*=(?!=)([^;{{}}]*);", run.text)]
    if len(found) != 1 or found[0].start() < at:
        return None
    before = _open_blocks(run.text[:at])
    words = re.findall(r"(?<![\w.>])[A-Za-z_]\w*", found[0][1])
    if not words or any(re.search(rf"\b{word}\b", before) is None for word in words):
        return None
    start = run.start + found[0].start()
    text = " ".join(run.source.text[start : run.start + found[0].end()].split())
    return run.word(text, *found[0].span())


def _set_here(later: Word | None) -> Word | None:
    return later._replace(text="the key is set here") if later is not None else None


def _only_if(run: Part, at: int, end: re.Match[str]) -> bool:
    """Whether the code at `at` is in the block of an `if`, after which no branch is before
    `end`."""
    inside = run.text[at : end.start()]
    depth = 0
    for found in re.finditer(r"[{}]", inside):
        depth += 1 if found.group() == "{" else -1
        if depth < 0:
            head = _enclosing(run.text[:at])
            # An `if` that follows can end `execute` where the first one was not entered.
            return bool(_IF.search(head)) and not _BRANCH.search(inside[found.end() :])
    return False


def _enclosing(text: str) -> str:
    """The text before the brace that is open at the end of a text, from the last statement on."""
    depth = 0
    for at in range(len(text) - 1, -1, -1):
        depth += {"}": 1, "{": -1}.get(text[at], 0)
        if depth < 0:
            return re.split(r"[;{}]", text[:at])[-1]
    return ""
