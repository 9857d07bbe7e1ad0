"""The class behind a state type: the facts about its Python class, as far as they do not depend on
what a script declares, and the template that makes the state."""

from __future__ import annotations

import re

from smachac.diagnostics.source import NOWHERE, Word
from smachac.frontend.loader import Library
from smachac.frontend.types import smacha_meta
from smachac.records import replace

TYPE_CHECKING = False  # annotations only: most state types have no class
if TYPE_CHECKING:
    from smachac.ir.class_facts import ClassFacts, StateCall

ALL_GIVEN = frozenset(["variables", "input_keys", "output_keys", "outcomes"])


def class_facts(
    name: str, word: Word | None, given: frozenset[str], library: Library
) -> ClassFacts | None:
    """The facts about the Python class, without parts that depend on what a script declares."""
    if word is None:
        return None
    from smachac.pysource.class_reader import read_module, read_template  # few scripts have classes

    if ":" in word.text:
        facts = read_module(word, library)
    else:
        template = library.template(word.text)
        facts = read_template(template, name, library) if template is not None else None
        if facts is not None and (body := _file_with_body(word.text, library)):
            call = _state_call(facts, word.text, body, library)
            facts = replace(facts, parameters=None, state_call=call)
    if facts is None:
        return None
    return _with_script(facts, given)


def _with_script(facts: ClassFacts, given: frozenset[str]) -> ClassFacts:
    """The facts about a class for which a script gives some parts of the interface. Outcomes and
    keys can be judged if the constructor passes on what the script gives."""
    passed = {part for part, _ in facts.passed}
    free = not given.isdisjoint(["outcomes", "optional"])
    judged = not free or ("outcomes" in passed and "optional" not in given)
    unknown = given - passed
    return replace(
        facts,
        endings=facts.endings if judged else (),
        complete=facts.complete and not free,
        reads=() if "input_keys" in unknown else facts.reads,
        writes=() if {"input_keys", "output_keys"} & unknown else facts.writes,
    )


def facts_without_interface(name: str, file: str, library: Library) -> ClassFacts | None:
    """The facts about the class of a template without an interface: nothing but the script declares
    its keys, and their names in the template's own block `body` count as declared."""
    facts = class_facts(name, Word(file, NOWHERE), frozenset(), library)
    if facts is None or facts.name is None or facts.name.text != re.sub(r"\W+", "_", name):
        return None
    written = tuple(smacha_meta.body_words(file, library.template))
    fixed = facts.outcomes is not None
    unlisted = _unlisted(facts.reads, facts.inputs), _unlisted(facts.writes, facts.outputs)
    facts = _with_script(facts, ALL_GIVEN - {"outcomes"} if fixed else ALL_GIVEN)
    return replace(
        facts,
        outcomes=None,
        inputs=None,
        outputs=None,
        passed=tuple((part, (*names, *written)) for part, names in facts.passed),
        endings=tuple(replace(ending, written=None) for ending in facts.endings),
        values=(),
        unlisted_reads=unlisted[0],
        unlisted_writes=unlisted[1],
    )


def _unlisted(used: tuple[Word, ...], listed: tuple[Word, ...] | None) -> tuple[Word, ...]:
    """The keys that code uses and the constructor does not list; none if its list is not known."""
    if listed is None:
        return ()
    names = {word.text for word in listed}
    return tuple(word for word in used if word.text not in names)


def prints_itself(file: str, library: Library) -> bool:
    """Whether a template, or one that it extends, has a block `body`."""
    return bool(_file_with_body(file, library))


def _file_with_body(file: str, library: Library) -> str:
    """The first one of a template and those that it extends that has a block `body`; empty if none
    has one."""
    seen: set[str] = set()
    while file and ":" not in file and file not in seen:
        seen.add(file)
        source = library.template(file) or library.template(f"{file}.py")
        if source is None:
            return ""
        if smacha_meta.makes_state(source):
            return file
        file = smacha_meta.extended(source)
    return ""


_STATE_TEMPLATE = "State.tpl.py"


def _state_call(facts: ClassFacts, file: str, body: str, library: Library) -> StateCall | None:
    """The call of the constructor in the block `body` of the built-in `State.tpl.py`; None where
    another template makes the state."""
    template = library.template(file)
    own = library.own_template(_STATE_TEMPLATE) is not None
    if facts.parameters is None or template is None or body != _STATE_TEMPLATE or own:
        return None
    from smachac.ir.class_facts import StateCall

    return StateCall(place=smacha_meta.extended_span(template), parameters=facts.parameters)
