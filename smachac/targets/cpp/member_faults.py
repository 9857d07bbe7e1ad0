"""Faults in the members of a C++ class that its header shows: `execute` and the constructors.

What a header can express in another form, such as inherited members, templates, default arguments
and code in other files, is left to the compiler.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from smachac.diagnostics.source import NOWHERE, Word
from smachac.ir.class_facts import ClassFault
from smachac.ir.traversal import PREEMPTED
from smachac.targets.cpp.header_text import Part
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.types import UnportableError
from smachac.targets.cpp.user_classes import ClassCode, left_to_scripts, parameter_type, stops

_EXECUTE = re.compile(r"\bexecute\s*\(([^()]*)\)")
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
_NUMBER = re.compile(r"(?:const\s+)?(?:double|float|bool|int|(?:std::)?u?int\d+_t)\b")
_ANSWER = re.compile(r"\.\s*service\s*\(\s*\)\s*;\s*(return\s+Outcome\s*::\s*(\w+))\s*;")
"""A stop request that is answered, and the outcome that is returned then."""
_IF = re.compile(r"\bif\s*\([^{};]*\)\s*$")

Words = tuple[Word, ...]


def member_faults(
    code: ClassCode, whole: Part, body: Part, outcomes: Words | None
) -> Iterator[ClassFault]:
    """The faults of a class that is not derived from another one."""
    if "template" in body.text or left_to_scripts(code.type):
        return
    yield from _constructor_faults(code, body)
    found = list(_members(body, _EXECUTE))
    if len(found) != 1:
        return
    (head,) = found
    before = re.split(r"[;{}]", body.text[: head.start()])[-1]
    result = _RESULTS.fullmatch(_ACCESS.sub(" ", before).strip())
    place = (head.start(), head.start() + len("execute"))
    wanted = f"Outcome execute({', '.join(_arguments(code))})"
    if result is not None:
        at = body.text.rfind(result["type"], 0, head.start())
        word = body.word(result["type"], at, at + len(result["type"]))
        yield ClassFault(kind="wrong result", name=word, near=wanted)
        return
    if _count(head[1]) not in (None, len(_arguments(code))):
        yield ClassFault(kind="wrong parameters", name=body.word("execute", *place), near=wanted)
        return
    run = _body_of(body, head.end())
    if run is not None and outcomes is not None:
        yield from _unused(whole, body, run, outcomes)
        yield from _unset(code, body, run, head[1])
        yield from _skipped(code, run, head[1])


def _members(body: Part, pattern: re.Pattern[str]) -> Iterator[re.Match[str]]:
    """The matches of a pattern outside the braces in a class."""
    at = depth = 0
    for found in pattern.finditer(body.text):
        depth += body.text.count("{", at, found.start()) - body.text.count("}", at, found.start())
        at = found.start()
        if depth == 0:
            yield found


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
    pieces = [each.strip() for each in text.split(",")]
    return 0 if pieces in ([""], ["void"]) else len(pieces)


def _body_of(body: Part, at: int) -> Part | None:
    """The body of a function whose list of parameters ends at a place; None if it is elsewhere."""
    head = re.compile(r"\s*(?:const\s*)?(?:noexcept\s*)?\{").match(body.text, at)
    return body.inside(head)


def _constructor_faults(code: ClassCode, body: Part) -> Iterator[ClassFault]:
    """Constructors none of which takes the variables of the interface."""
    name = code.name.rpartition("::")[2]
    made = re.compile(rf"(?<![~\w:]){re.escape(name)}\s*\(")
    heads = list(_members(body, made))
    try:
        variables = [
            f"{parameter_type(each.type)} {identifier(key)}".replace("& ", "&")
            for key, each in code.type.variables.items()
        ]
    except UnportableError:
        return
    wanted = [*code.parameters, *variables]
    if not heads or "using" in body.text or any(not _is_plain(each) for each in wanted):
        return
    for head in heads:
        found = re.compile(r"([^()]*)\)").match(body.text, head.end())
        count = _count(found[1]) if found is not None else None
        if found is None or count is None:
            return
        if count == len(wanted):
            names = [_parameter_name(each) for each in found[1].split(",")]
            own = [_parameter_name(each) for each in wanted]
            if len(heads) == 1 and names != own and sorted(names) == sorted(own):
                word = body.word(name, head.start(), head.start() + len(name))
                near = f"{name}({', '.join(wanted)})"
                more = _exchanged(names, wanted)
                yield ClassFault(kind="parameter order", name=word, near=near, more=more)
            return
    first = _first_argument(code, heads, body, len(wanted)) if not code.parameters else None
    if first is not None:
        place = code.type.class_spans.get(("cpp", "class"), NOWHERE)
        near = _qualified(first, code.name)
        yield ClassFault(kind="no first argument", name=Word(first, place), near=near)
        return
    word = body.word(name, heads[0].start(), heads[0].start() + len(name))
    near = f"{name}({', '.join(wanted)})"
    yield ClassFault(kind="wrong constructor", name=word, near=near)


def _exchanged(names: list[str], wanted: list[str]) -> str:
    """What happens with parameters of these names, to which a program passes the wanted ones."""
    pairs = [(name, each) for name, each in zip(names, wanted, strict=True)
             if name != _parameter_name(each)]  # fmt: skip
    gets = " and ".join(
        f"`{name}` gets the value of `{_parameter_name(each)}`" for name, each in pairs
    )
    if all(_NUMBER.match(each) for _, each in pairs):
        return f"it compiles, but {gets}"
    return f"the program passes the variables in the order of the interface: {gets}"


def _first_argument(
    code: ClassCode, heads: list[re.Match[str]], body: Part, wanted: int
) -> str | None:
    """The reference or pointer that the only constructor takes before the variables, which have
    the names of the interface."""
    found = re.compile(r"([^()]*)\)").match(body.text, heads[0].end()) if len(heads) == 1 else None
    if found is None:
        return None
    first, *others = (" ".join(each.split()) for each in found[1].split(","))
    names = [each.split()[-1].lstrip("&*") for each in others if each]
    if len(names) != wanted or names != [identifier(key) for key in code.type.variables]:
        return None
    return first if re.fullmatch(r"[\w:]+(?: const)? ?[&*] ?\w+", first) else None


def _qualified(parameter: str, name: str) -> str:
    """A parameter whose type is written with the namespace of a class."""
    space = name.removeprefix("::").rpartition("::")[0]
    plain = "::" not in parameter and bool(space)
    return f"{space}::{parameter}" if plain else parameter


def _parameter_name(parameter: str) -> str:
    """The last word of a parameter, without the underscore that keeps it apart from a member."""
    words: list[str] = re.findall(r"\w+", parameter)
    return words[-1].rstrip("_") if words else ""


def _is_plain(parameter: str) -> bool:
    return "std::any" not in parameter


def _unused(whole: Part, body: Part, run: Part, outcomes: Words) -> Iterator[ClassFault]:
    """The outcomes that no code in the header names, if every `return` of `execute` names one. A
    class with one outcome in use is not written yet."""
    returned = [each[1] for each in _RETURN.finditer(run.text)]
    known = {identifier(each.text) for each in outcomes}
    if not known.issuperset(re.findall(r"\bOutcome\s*::\s*(\w+)", body.text)):
        return  # a misspelt outcome is reported: it is probably the one that is not returned
    functions = _outcome_functions(body)
    if _ELSEWHERE.search(body.text) or functions is None:
        return
    for each in returned:
        called = re.fullmatch(r"\s*(\w+)\s*\(.*\)\s*", each, re.DOTALL)
        inner = called is not None and called[1] in functions
        if "Outcome::" not in each.replace(" ", "") and not inner:
            return
    names = {each: identifier(each.text) for each in outcomes}
    used = {each for each, name in names.items()
            if len(re.findall(rf"\b{re.escape(name)}\b", whole.text)) > 1}  # fmt: skip
    if len(used) < 2:
        return
    for word in outcomes:
        if word not in used:
            stop = word.text == PREEMPTED
            answer = _ANSWER.search(run.text) if stop else None
            if answer is not None:
                place = run.word(answer[2], *answer.span(1))
                yield ClassFault(kind="other answer", name=place, near=identifier(word.text))
                continue
            yield ClassFault(kind="no answer to stops" if stop else "unused outcome", name=word)


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
            promised = _promised(code, run, key.name)
            if promised is not None:
                yield promised
                continue
            yield ClassFault(kind="unset output", name=fields.word(key.name, *inside.span()))


def _promised(code: ClassCode, run: Part, key: str) -> ClassFault | None:
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
    return ClassFault(kind="skipped output", name=place, near=outcome)


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
                    each.start()
                    for each in re.finditer(rf"\b{out}\s*\.\s*{identifier(key)}\b", run.text)
                ]
                before = [at for at in set_ if at < end.start()]
                if set_ and (not before or (len(before) == 1 and _only_if(run, before[0], end))):
                    place = run.word(key, end.start(), end.end() - 1)
                    yield ClassFault(kind="skipped output", name=place, near=outcome)


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
                yield ClassFault(kind="early return", name=place, near=outcome.name)


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
