"""Declarations of outcomes and states that lack or misspell a name which several places use.

The side that is wrong is the one with fewer uses: if a class returns `done` and a transition is for
`done`, but the interface has `doe`, which nothing uses, then the interface means `done`. The script
is corrected before it is lowered, so that the fault is one finding, without its consequences.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple, TypeAlias

from smachac.diagnostics.diagnostic import Diagnostic, Report
from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import Guesser, guesser
from smachac.frontend.cpp_text import LONGEST, Part, class_head, outcome_words, without_literals
from smachac.frontend.loader import Library
from smachac.frontend.script import ANY_OUTCOME, ERROR, EXHAUSTED, TIMEOUT, Script, State
from smachac.ir.nodes import DeclarationKind, Expression, Misdeclared, Outcome, StateType, Struct
from smachac.ir.outcome_names import GOOD_OUTCOMES, PREEMPTED
from smachac.ir.properties import atoms

Place: TypeAlias = "tuple[int, ...]"
"""The place of a state in a script: its number in each container, outermost first."""


_COMMON = frozenset(["succeeded", "aborted", PREEMPTED])
"""The outcomes of SMACH: a declared name that is one slip away, which nothing uses, means them."""


MOST_UNKNOWN = 100
"""With more unknown names in one container, no name of its list counts as misspelt: each one that
does costs a look at all others."""


@dataclass(slots=True)
class _Declarer:
    """A state, container or state type that declares names, and the uses of its names.

    `declared` are the names that it has, `listed` those of them that can be misspelt, with their
    places; `used` are the uses of names by what uses them. `path` is that of its first state. For a
    container, `others` are the names of its states, `outer` the outcomes of the container around.
    """

    kind: DeclarationKind
    name: str
    path: str
    declared: Mapping[str, None]
    listed: tuple[Word, ...]
    place: Span | None
    here: Span
    via: tuple[Span, ...]
    others: Mapping[str, None] = field(default_factory=dict)
    outer: frozenset[str] = frozenset()
    used: dict[str, dict[str, list[Word]]] = field(default_factory=dict)

    def use(self, by: str, word: Word) -> None:
        """Add a use of a name."""
        if word.text:
            self.used.setdefault(word.text, {}).setdefault(by, []).append(word)

    def places(self, name: str) -> list[Word]:
        """The places that use a name, each once."""
        every = [word for some in self.used[name].values() for word in some]
        return list({word.span: word for word in every}.values())


@dataclass(slots=True)
class _Repairs:
    """The faults that were found, and the correct names by state type and by state.

    `reported` is what was reported before, by text; `loops` are the places of the loops over states
    with corrected outcomes.
    """

    reported: Mapping[Source, Report]
    found: list[Misdeclared] = field(default_factory=list)
    loops: set[Span] = field(default_factory=set)
    types: dict[str, StateType] = field(default_factory=dict)
    outcomes: dict[Place, tuple[Outcome, ...]] = field(default_factory=dict)
    names: dict[Place, str] = field(default_factory=dict)


class _Whole(NamedTuple):
    """A script, its states by place, their names, and the words about each state in the fields of
    its container, by the place of the container and the name of the state."""

    script: Script
    states: Mapping[Place, State]
    names: frozenset[str]
    about: Mapping[Place, Mapping[str, list[Word]]]


def _whole(script: Script) -> _Whole:
    states = dict(_walk(script.base))
    about = {place: _words_about(state) for place, state in states.items() if state.states}
    return _Whole(script, states, frozenset(each.name.text for each in states.values()), about)


def with_meant_declarations(script: Script, library: Library, report: Report) -> Script:
    """The script with its misspelt and incomplete declarations corrected, and these faults. What
    was reported about uses of their names is removed."""
    if not _has_unknown(script.base) and not _has_unknown_atom(script):
        return script
    whole = _whole(script)
    reported: dict[Source, Report] = {}
    for item in report:
        reported.setdefault(item.span.source, []).append(item)
    repairs = _Repairs(reported)
    _judge_types(whole, library, repairs)
    for place, state in whole.states.items():
        _judge_state(whole, place, state, repairs)
    if not (repairs.types or repairs.outcomes or repairs.names):
        return script
    uses = {word.span: word.text for fault in repairs.found for word in fault.uses}
    report[:] = [item for item in report if not _follows(item, uses, repairs)]
    base = _corrected(script.base, (), repairs, uses)
    types = dict(script.state_types) | repairs.types
    return replace(script, base=base, state_types=types, misdeclared=tuple(repairs.found))


def _follows(item: Diagnostic, uses: Mapping[Span, str], repairs: _Repairs) -> bool:
    """Whether a finding is about the use of a name that is correct: an outcome of a field `on`, or
    one in the `writes` of an interface; or about a loop without `on`."""
    given = item.finding.arguments
    if given == ("on",):
        return item.span in repairs.loops
    return given[:1] in (("outcome",), ("outcomes",)) and item.span in uses


def _walk(base: State) -> Iterator[tuple[Place, State]]:
    """All states with their places, containers before the states in them."""
    stack: list[tuple[Place, State]] = [((), base)]
    while stack:
        place, state = stack.pop()
        yield place, state
        inner = [((*place, at), each) for at, each in enumerate(state.states)]
        stack.extend(reversed(inner))


# --- the names that states use


def _has_unknown(base: State) -> bool:
    """Whether some name of a script is probably unknown: nothing else needs to be judged."""
    known_of: dict[int, frozenset[str]] = {}
    stack = [base]
    while stack:
        state = stack.pop()
        if state.states:
            stack.extend(state.states)
        elif state.owner == "state" and _is_plain(state, known_of):
            continue  # most states; the rest of this loop would take 5 % of a check
        ends = {name for name, _ in _ends(state)}
        if not state.type.open and any(word.text not in ends for word in _own_words(state)):
            return True
        if state.owner == "state" and _misspells_implied(state, ends):
            return True
        names = {each.name.text for each in state.states}
        exits = {each.name for each in state.outcomes}
        for word in _inner_words(state):
            if word.text not in exits and word.text not in names:
                return True
        if state.owner in ("Concurrence", "Iterator"):
            about = _words_about(state)
            for child in state.states:
                known = {name for name, _ in _ends(child)}
                words = about[child.name.text] if not child.type.open else ()
                if any(word.text not in known for word in words):
                    return True
        named = {word.text for _, rows in state.outcome_map for word, _ in rows}
        if not named <= names:
            return True
        facts = state.type.class_facts
        if facts is not None and any(word.text not in ends for word in facts.returns):
            return True
    return False


def _has_unknown_atom(script: Script) -> bool:
    """Whether a property of the script names a state that does not exist."""
    parts = {name for each in script.properties for atom in atoms(each.form)
             if atom.subject == "path" for name in atom.name.split("/")}  # fmt: skip
    return bool(parts) and not parts <= {state.name.text for _, state in _walk(script.base)}


def _misspells_implied(state: State, ends: set[str]) -> bool:
    """Whether an outcome in the list of a state that its transitions do not use is like one that it
    has without its list."""
    listed = {each.name for each in state.outcomes}
    unused = listed.difference(word.text for word in _own_words(state))
    guess = guesser(ends - listed) if unused else None
    return guess is not None and any(guess.sure(name) for name in unused)


def _is_plain(state: State, known_of: dict[int, frozenset[str]]) -> bool:
    """Whether a state without sugar uses its own outcomes and those of its type only. `known_of`
    are those of the types by their identities."""
    type_ = state.type
    known = known_of.get(id(type_))
    if known is None:
        known = frozenset(each.name for each in type_.outcomes)
        known_of[id(type_)] = known
    facts, sugar = type_.class_facts, state.sugar
    if sugar.retry is not None or sugar.for_each is not None:
        return False
    if facts is not None and any(word.text not in known for word in facts.returns):
        return False
    own = {each.name for each in state.outcomes} if state.outcomes else known
    for word, _ in state.transitions:
        if word.text not in own and word.text not in known:
            return False
    return True


def _ends(state: State) -> Iterator[tuple[str, Span]]:
    """The outcomes with which a state can end, each with its place."""
    if state.owner == "state":
        for each in state.type.outcomes:
            yield each.name, each.span
    for each in state.outcomes:
        yield each.name, each.span
    here = state.name.span
    default = state.type.variables.get("default_outcome")
    if state.owner == "state" and state.default_outcome is not None:
        yield state.default_outcome
    elif state.owner == "state" and default is not None:
        given = [each.value.data for each in state.variables if each.name == default.name]
        if not given and default.default is not None:
            given = [default.default.data]
        yield from ((name, here) for name in given if isinstance(name, str))
    yield from ((name, here) for name in _added(state))


def _added(state: State) -> Iterator[str]:
    """The outcomes that the sugar of a state, and the exceptions in it, can add."""
    yield ERROR
    if state.owner == "Iterator":
        words = {key.text: to.text for key, to in state.final_outcome_map}
        end = state.exhausted_outcome.text if state.exhausted_outcome is not None else EXHAUSTED
        yield words.get(end, end)
    if state.sugar.timeout is not None:
        yield TIMEOUT
    if state.sugar.retry is not None:
        yield EXHAUSTED
    if any((state.sugar.timeout, state.sugar.retry, state.sugar.for_each)):
        yield PREEMPTED


def _own_words(state: State) -> Iterator[Word]:
    """The names of outcomes of a state in its own fields."""
    yield from (key for key, _ in state.transitions)
    for part in (state.sugar.retry, state.sugar.for_each):
        for word in part.on if part is not None else ():
            written = word.span.text
            # An unknown outcome in `on` was reported, and replaced with the nearest one.
            yield Word(written, word.span) if written.isidentifier() else word


def _words_about(parent: State) -> Mapping[str, list[Word]]:
    """The names of outcomes of each state of a container in the fields of the container."""
    end = parent.exhausted_outcome.text if parent.exhausted_outcome is not None else EXHAUSTED
    of_loop = [*parent.loop_outcomes, *parent.break_outcomes]
    of_loop += (key for key, _ in parent.final_outcome_map if key.text != end)
    found = {child.name.text: [*of_loop] for child in parent.states}
    for _, rows in parent.outcome_map:
        for name, ending in rows:
            if name.text in found and ending.text != ANY_OUTCOME:
                found[name.text].append(ending)
    return found


def _inner_words(state: State) -> Iterator[Word]:
    """The names of outcomes and states in a container, by which it continues or ends."""
    if state.owner == "Concurrence":
        yield from (name for name, _ in state.outcome_map)
        if state.default_outcome is not None:
            yield state.default_outcome
    elif state.owner == "Iterator":
        yield from (to for _, to in state.final_outcome_map)
    elif state.owner != "state":
        yield from [target for child in state.states for _, target in child.transitions]
        if state.on_error is not None:
            yield state.on_error
        if state.initial is not None:
            yield state.initial


def _code_words(script: Script, state: State) -> Iterator[Word]:
    """The names of outcomes of a state in the values of its variables."""
    for each in state.variables:
        data = each.value.data
        known = state.type.variables.get(each.name)
        if each.role == "conditions" and isinstance(data, Struct):
            yield from (Word(name, each.span) for name, _ in data.entries)
        elif each.role == "steps" and isinstance(data, tuple):
            ends = [dict(step.entries).get("outcome") for step in data if isinstance(step, Struct)]
            yield from (Word(end, each.span) for end in ends if isinstance(end, str))
        elif known is not None and known.returns == "outcome":
            text = data.text if isinstance(data, Expression) else str(data)
            facts = script.functions.get(text)
            yield from facts.texts if facts is not None else ()


# --- interfaces of state types


def _judge_types(whole: _Whole, library: Library, repairs: _Repairs) -> None:
    """The faults in the outcomes of interfaces of the user."""
    declarers: dict[str, _Declarer] = {}
    type_of: dict[str, StateType] = {}
    for place, state in whole.states.items():
        type_ = state.type
        type_of.setdefault(type_.name, type_)
        fixed = not (type_.open or type_.built_in or "outcomes" in type_.given)
        if state.owner != "state" or not fixed or type_.outcomes_place is None:
            continue
        found = declarers.get(type_.name)
        if found is None:
            words = tuple(Word(each.name, each.span) for each in type_.outcomes)
            names = dict.fromkeys(each.name for each in type_.outcomes)
            at = _path(whole.states, place)
            here = type_.outcomes_place
            found = _Declarer("interface", type_.name, at, names, words, here, here, ())
            declarers[type_.name] = found
        added = {*_added(state)} - {*found.declared}
        about = whole.about[place[:-1]][state.name.text]
        for word in (*_own_words(state), *about):
            if word.text not in added:
                found.use("the script", word)
    for name, each in declarers.items():
        type_ = type_of[name]
        for word in _words_of_writes(type_, repairs.reported):
            each.use("`writes`", word)
        for word in (*_class_words(type_), *_header_words(type_, library)):
            each.use("its class", word)
        fault = _fault(each, repairs)
        if fault is not None:
            renamed = dict(fault.renamed)
            writes = tuple((renamed.get(end, end), keys) for end, keys in type_.writes)
            outcomes = _outcomes(type_.outcomes, fault)
            repairs.types[name] = replace(type_, outcomes=outcomes, writes=writes)


def _class_words(type_: StateType) -> Iterator[Word]:
    """The outcomes that the class of a type returns or declares."""
    facts = type_.class_facts
    if facts is not None:
        yield from (each.outcome for each in facts.endings)
        yield from facts.outcomes or ()


def _words_of_writes(type_: StateType, reported: Mapping[Source, Report]) -> list[Word]:
    """The outcomes in the `writes` of an interface; only those that it does not declare, if some
    were reported, because the others can stand for them."""
    place = type_.outcomes_place
    unknown = [
        Word(item.span.text, item.span)
        for item in (reported.get(place.source, ()) if place is not None else ())
        if item.finding.arguments == ("outcomes", item.span.text)
    ]
    ends = {end for end, _ in type_.writes}
    return unknown or [Word(each.name, each.span) for each in type_.outcomes if each.name in ends]


def _header_words(type_: StateType, library: Library) -> Iterator[Word]:
    """The outcomes in the header of a type's class in C++."""
    code = type_.classes.get("cpp", {})
    header = library.code(code.get("header", "")) if code else None
    if header is None or len(header.text) > LONGEST:
        return
    whole = Part(source=header, text=without_literals(header.text))
    body = whole.inside(whole.only(class_head(code.get("class", "").rpartition("::")[2])))
    yield from (outcome_words(body) or ()) if body is not None else ()


# --- outcomes and states of the script


def _judge_state(whole: _Whole, place: Place, state: State, repairs: _Repairs) -> None:
    """The faults in the outcomes that a state declares, and in the names of its states."""
    if state.owner == "state" and (state.type.open or "outcomes" not in state.type.given):
        return
    path = _path(whole.states, place)
    words = tuple(Word(each.name, each.span) for each in state.outcomes)
    names = dict.fromkeys(name for name, _ in _ends(state))
    kind: DeclarationKind = "state" if state.owner == "state" else "container"
    others = dict.fromkeys(each.name.text for each in state.states)
    found = _Declarer(
        kind,
        state.name.text,
        path,
        names,
        words,
        state.outcomes_place,
        state.name.span,
        state.via,
        others,
    )
    for word in _own_words(state):
        found.use("its transitions", word)
    if place:
        parent = whole.states[place[:-1]]
        if parent.owner in ("base", "StateMachine", "Sequence"):
            found.outer = frozenset(each.name for each in parent.outcomes)
        for word in whole.about[place[:-1]][state.name.text]:
            found.use(f"`{parent.name.text}`", word)
    for word in _code_words(whole.script, state):
        found.use("its code", word)
    if kind == "container":
        by = "its outcome map" if state.owner == "Concurrence" else "its states"
        for word in _inner_words(state):
            if word.text not in others:
                found.use(by, word)
        _use_implied(found, state)
        _judge_children(found, whole, place, repairs)
    for name in [name for name in found.used if name in whole.names]:
        del found.used[name]
    fault = _fault(found, repairs)
    if fault is not None:
        repairs.outcomes[place] = _outcomes(state.outcomes, fault)
        if state.sugar.for_each is not None and not set(fault.meant).isdisjoint(GOOD_OUTCOMES):
            repairs.loops.add(state.sugar.for_each.span)


def _use_implied(found: _Declarer, state: State) -> None:
    """Add the uses of outcomes of a container by states that end with the same outcome."""
    loops = {word.text for word in state.loop_outcomes}
    mapped = {key.text: to for key, to in state.final_outcome_map}
    for child in state.states:
        handled = {key.text for key, _ in child.transitions}
        for part in (child.sugar.retry, child.sugar.for_each):
            handled.update(word.text for word in (part.on if part is not None else ()))
        for name, span in _ends(child):
            if state.owner == "Iterator":
                if not state.break_outcomes and name not in loops and name != ERROR:
                    found.use(f"`{child.name.text}`", mapped.get(name, Word(name, span)))
            elif name not in handled and (name in found.used or name in found.declared):
                found.use("its states", Word(name, span))


def _judge_children(outer: _Declarer, whole: _Whole, place: Place, repairs: _Repairs) -> None:
    """The states of a container with a misspelt name: several places use a similar name."""
    state = whole.states[place]
    names = [each.name for each in state.states]
    texts = tuple(each.text for each in names)
    at = {name: number for number, name in enumerate(texts)}
    if state.owner == "Iterator" or len(at) < len(texts):
        return
    found = _Declarer(
        "child",
        outer.name,
        outer.path,
        dict.fromkeys((*texts, *outer.declared)),
        tuple(names),
        None,
        outer.here,
        state.via,
    )
    if state.owner == "Concurrence":
        for _, rows in state.outcome_map:
            for word, _ in rows:
                found.use("its outcome map", word)
    else:
        for word in _inner_words(state):
            found.use("transitions", word)
        if state.owner == "Sequence":
            return
    if all(name in found.used for name in texts):
        return
    for each in whole.script.properties:
        for atom in atoms(each.form):
            for name in atom.name.split("/") if atom.subject == "path" else ():
                if name not in whole.names or name in at:
                    found.use("properties", Word(name, atom.span))
    renamed, _ = _meant(found, pairs=False)
    for old, new in renamed.items():
        if new in whole.names:
            continue
        repairs.names[(*place, at[old])] = new
        repairs.found.append(_finding(found, names[at[old]], (new,), ""))
        outer.used.pop(new, None)


# --- which name is meant


def _fault(found: _Declarer, repairs: _Repairs) -> Misdeclared | None:
    """The fault of a declarer of outcomes, which is added to those that were found, unless another
    fault of its list was reported."""
    renamed, added = _meant(found, pairs=True)
    fault: Misdeclared | None = None
    if (added or renamed) and _was_reported(found, repairs.reported):
        return _finding(found, Word("", found.here), added, "")
    if added:
        place, last = found.place or found.here, found.listed[-1:]
        if last and "\n" in place.text:
            place = last[0].span
        fault = _finding(found, Word("", place), added, _list_with(found, added))
        repairs.found.append(fault)
    words = {each.text: each for each in reversed(found.listed)}
    for old, new in renamed.items():
        word = words[old]
        one = _finding(found, word, (new,), "")
        repairs.found.append(one)
        fault = one if fault is None else fault
    return fault._replace(renamed=tuple(renamed.items())) if fault is not None else None


def _was_reported(found: _Declarer, reported: Mapping[Source, Report]) -> bool:
    """Whether the list of a declarer has a wrong shape, or an interface without one has a field of
    another name."""
    place = found.place
    if place is None:
        return False
    return any(
        place.start <= item.span.start <= place.end
        or (found.kind == "interface" and not found.listed and item.code in ("SM002", "SM003"))
        for item in reported.get(place.source, ())
    )


def _list_with(found: _Declarer, added: tuple[str, ...]) -> str:
    """The list of outcomes in the script with more names."""
    written = found.place.text if found.place is not None else ""
    if written[:1] == "{" and written[-1:] == "}" and "\n" not in written:
        parts = [written[1:-1].strip(), *(f"{name}: {{}}" for name in added)]
        return f"outcomes: {{{', '.join(filter(None, parts))}}}"
    names = [*(word.text for word in found.listed), *added]
    return f"outcomes: [{', '.join(names)}]"


def _meant(found: _Declarer, *, pairs: bool) -> tuple[dict[str, str], tuple[str, ...]]:
    """The names that are meant by misspelt ones of a declarer, and the names that it lacks.
    `pairs`: names that are not alike can belong together."""
    unknown = [name for name in found.used if name not in found.declared and name.isidentifier()]
    unused = [word.text for word in found.listed if word.text not in found.used]
    renamed = _implied(found, unused)
    if not unknown:
        return renamed, ()
    unused = [name for name in unused if name not in renamed]
    guess = guesser(unused)
    for name in unknown if len(unknown) <= MOST_UNKNOWN else ():
        near = guess(name) if unused and _is_strong(found, name) else None
        if near is None and name in _COMMON:
            near = guess.sure(name)
        if near is not None:
            renamed[near] = name
            unused.remove(near)
            guess = guesser(unused)
    if not pairs:
        return renamed, ()
    meant = {*renamed.values()}
    left = [name for name in unknown if name not in meant]
    shouted = any(each.isupper() for each in found.others)
    known = guesser((*found.declared, *found.others)) if shouted else None
    strong = [name for name in left if _is_certain(found, name, known)]
    unused = [name for name in unused if name != PREEMPTED or found.kind == "container"]
    if len(strong) == len(left) == len(unused) == 1:
        return renamed | {unused[0]: left[0]}, ()
    empty = not found.declared or {*found.declared} <= {ERROR}
    return renamed, tuple(left if empty else strong)


def _implied(found: _Declarer, unused: Iterable[str]) -> dict[str, str]:
    """The outcomes in the list of a state that nothing uses, and that misspell one that the state
    has without its list, such as its default outcome."""
    if found.kind != "state":
        return {}
    listed = {word.text for word in found.listed}
    names = [name for name in found.declared if name not in listed and name in found.used]
    guess = guesser(names)
    near = {name: guess.sure(name) for name in unused} if names else {}
    return {name: meant for name, meant in near.items() if meant is not None}


def _is_strong(found: _Declarer, name: str) -> bool:
    """Whether several places use a name."""
    return len(found.used[name]) > 1 or len(found.places(name)) > 1


def _is_certain(found: _Declarer, name: str, known: Guesser | None) -> bool:
    """Whether a name is certainly meant to be declared: two sides use it, or several places in a
    container with states in upper case, whose known names are not like it."""
    if len(found.used[name]) > 1:
        return True
    if found.kind != "container" or len(found.places(name)) < 2:
        return False
    if "/" in found.path and name not in found.outer:
        return False
    return known is not None and name.islower() and known(name) is None


def _finding(found: _Declarer, word: Word, meant: tuple[str, ...], text: str) -> Misdeclared:
    users = tuple(dict.fromkeys(by for name in meant for by in found.used[name]))
    uses = tuple(word for name in meant for word in found.places(name))
    return Misdeclared(
        found.kind, found.name, word, meant, users, uses, text, found.path, found.via
    )


# --- the corrected script


def _outcomes(outcomes: Iterable[Outcome], fault: Misdeclared) -> tuple[Outcome, ...]:
    """The outcomes of a declarer without its fault."""
    renamed = dict(fault.renamed)
    kept = [replace(each, name=renamed.get(each.name, each.name)) for each in outcomes]
    names = {each.name for each in kept}
    places = {word.text: word.span for word in reversed(fault.uses)}
    more = (Outcome(name=name, span=places[name]) for name in fault.meant if name not in names)
    return (*kept, *more)


def _corrected(state: State, place: Place, repairs: _Repairs, uses: Mapping[Span, str]) -> State:
    states = tuple(
        _corrected(each, (*place, at), repairs, uses) for at, each in enumerate(state.states)
    )
    sugar = state.sugar
    if sugar.retry is not None:
        sugar = replace(sugar, retry=replace(sugar.retry, on=_respelt(sugar.retry.on, uses)))
    if sugar.for_each is not None:
        on = _respelt(sugar.for_each.on, uses)
        sugar = replace(sugar, for_each=replace(sugar.for_each, on=on))
    name = state.name._replace(text=repairs.names.get(place, state.name.text))
    type_ = state.type
    if type_.name in repairs.types and not type_.open:
        type_ = repairs.types[type_.name]
    outcomes = repairs.outcomes.get(place, state.outcomes)
    return state._replace(name=name, type=type_, outcomes=outcomes, sugar=sugar, states=states)


def _respelt(words: tuple[Word, ...], uses: Mapping[Span, str]) -> tuple[Word, ...]:
    """Words, of which some are names that were not known."""
    return tuple(Word(uses.get(word.span, word.text), word.span) for word in words)


def _path(states: Mapping[Place, State], place: Place) -> str:
    """The path of a state at a place."""
    return "/".join(states[place[:end]].name.text for end in range(len(place) + 1))
