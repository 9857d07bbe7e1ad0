"""Completion: the words that fit at a place, the most likely one first."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

from smachac.frontend import schema
from smachac.frontend.schema import CONTAINER_DOCS, CONTAINERS
from smachac.frontend.state_types import find_state_type
from smachac.ir.nodes import StateType, VariableType
from smachac.ir.outcome_names import GOOD, GOOD_OUTCOMES, PREEMPTED, SUCCESSES, is_failure
from smachac.ir.types import ANY, WORDS
from smachac.lsp.facts import Facts
from smachac.lsp.place import FIELD, ITEM, KEY, STATE, VALUE, Body, Place, place_at
from smachac.lsp.repair import MARK, with_mark
from smachac.lsp.session import View

WORD = re.compile(r"[\w.<>/-]*")


@dataclass(frozen=True, slots=True, kw_only=True)
class Completion:
    """A word that fits. `kind` is one of KINDS; `detail` is its type, `doc` its description.
    `text` replaces what is typed; empty if it is the word itself."""

    word: str
    kind: str
    detail: str = ""
    doc: str = ""
    text: str = ""


KINDS = ("field", "state", "outcome", "key", "type", "template", "script", "param", "value")
"""The kinds of words."""


def word_range(text: str, offset: int) -> tuple[int, int]:
    """The range of the word at an offset; empty if there is none."""
    start = offset
    while start > 0 and WORD.fullmatch(text[start - 1]):
        start -= 1
    found = WORD.match(text, offset)
    return start, found.end() if found is not None else offset


def complete(text: str, offset: int, path: str, view: View | None) -> list[Completion]:
    """The words that fit at an offset of a text, in the order of their likelihood."""
    start, end = word_range(text, offset)
    marked = with_mark(text, start, end, path)
    if marked is None or view is None:
        return []
    _, tree, at = marked
    place = place_at(tree, at)
    if place is None or MARK not in str(place.word.value):
        return []
    machine = view.machine
    facts = Facts(view.library, path, machine.state_types if machine is not None else {})
    found = _Completer(facts, place, view).words()
    unique = {each.word: each for each in reversed([*found]) if each.word and each.word != MARK}
    return list(reversed(unique.values()))


class _Completer:
    """The words for one place."""

    def __init__(self, facts: Facts, place: Place, view: View) -> None:
        self.facts = facts
        self.place = place
        self.view = view
        self.body = place.body
        self.around = place.around

    def words(self) -> Iterable[Completion]:
        place = self.place
        if place.role == FIELD:
            return self.fields()
        if place.role == STATE:
            return [Completion(word=name, kind="state") for name in self.missing_states()]
        if place.siblings[:1] == ("params",) or self.is_look_up():
            return [Completion(word=each, kind="param") for each in self.facts.params(place.bodies)]
        by_field = {
            "template": self.templates,
            "script": self.scripts,
            "transitions": self.transitions,
            "remapping": self.remapping,
            "input_keys": self.declared_keys,
            "output_keys": self.declared_keys,
            "userdata": self.userdata,
            "outcomes": self.outcomes,
            "outcome_map": self.outcome_map,
            "initial": self.children,
            "on_error": self.on_error,
            "default_outcome": self.default_outcome,
            "connector_outcome": self.connector,
            "exhausted_outcome": self.endings,
            "final_outcome_map": self.final_map,
            "loop_outcomes": self.loop_outcomes,
            "break_outcomes": self.loop_outcomes,
            "it": self.item_keys,
            "it_label": self.label_keys,
            "for_each": self.for_each,
            "retry": self.retry,
            "callbacks": self.callbacks,
            "join": self.choices,
            "robot": self.robots,
            "params": self.params,
        }
        by = by_field.get(place.field, self.variable)
        return by()

    def is_look_up(self) -> bool:
        """Whether the word is alone in two brackets: `[[word]]`."""
        source, start, end = self.place.word.span
        return source.text[max(start - 2, 0) : start] == "[[" and source.text[end : end + 2] == "]]"

    # --- fields

    def fields(self) -> Iterable[Completion]:
        """The fields and variables that the state does not have yet, required ones first."""
        present = {*self.place.siblings}
        calls = "script" in present
        body = self.body
        type_ = self.facts.type_named(body.template)
        variables = dict(type_.variables) if type_ is not None else {}
        known = [*schema.names_for(body.owner)]
        known += ["script"] if body.name is not None else []
        needed = [] if calls else [*schema.REQUIRED[body.owner]]
        if body.name is not None and not calls:
            needed.insert(0, "template")
            needed.insert(1, "script") if "transitions" in present else needed.append("script")
        needed += [name for name, each in variables.items() if each.required]
        order = dict.fromkeys([*needed, *self.likely(type_), *variables, *_usual_order(known)])
        for name in order:
            other = {"template": "script", "script": "template"}.get(name, "")
            if name not in present and other not in present:
                yield self.field_word(name, variables.get(name))

    def likely(self, type_: StateType | None) -> Iterable[str]:
        """The optional fields that the state probably needs."""
        body, around = self.body, self.around
        if type_ is not None and body.name is not None:
            given = [each for each in ("outcomes", "input_keys", "output_keys")
                     if each in type_.given]  # fmt: skip
            code = [name for name, each in type_.variables.items() if each.role == "callbacks"]
            used = self.used_fields()
            if "outcomes" in given and not any(each.name not in type_.optional
                                               for each in type_.outcomes):  # fmt: skip
                yield "outcomes"
            if "callbacks" in body.fields and given:
                yield from (each for each in given if each != "outcomes")
            yield from [each for each in given if used[each]]
            yield from [each for each in code if used[each]]
        if body.owner == "Concurrence":
            yield from ("default_outcome", "outcome_map")
        if body.owner == "Iterator":
            yield from ("outcomes", "input_keys", "it_label", "exhausted_outcome", "loop_outcomes")
        if body.states:
            inside = {*body.names("userdata"), *body.names("input_keys")}
            written: set[str] = set()
            for child in body.states:
                uses = list(self.facts.outer_keys(child))
                if any(not writes and key not in inside | written for key, writes in uses):
                    yield "userdata" if around is None else "input_keys"
                    break
                written |= {key for key, writes in uses if writes}
        if around is not None:
            yield from self.likely_of_state(around)

    def likely_of_state(self, around: Body) -> Iterable[str]:
        body = self.body
        scope = self.facts.keys_in(around)
        own = [*self.facts.inputs(body), *self.facts.outputs(body)]
        renamed = body.pairs("remapping")
        if "script" in body.fields and self.params_of_call():
            yield "params"
        if any(key not in (*around.names("userdata"), *around.names("input_keys"))
               for key in own if key not in renamed) and scope:  # fmt: skip
            yield "remapping"
        if any(to not in scope for to in renamed.values()):
            yield "userdata"
        if around.owner not in ("Concurrence", "Iterator"):
            yield "transitions"
        used = self.used_fields()
        yield from [name for name, _ in used.most_common()]

    def used_fields(self) -> Counter[str]:
        """The fields of the other states of the same type in the text, by number of uses."""
        found: Counter[str] = Counter()
        todo = list(self.place.bodies[:1])
        while todo:
            each = todo.pop()
            todo += each.states
            if each.start != self.body.start and each.template == self.body.template:
                found.update([*each.fields])
        return found

    def field_word(self, name: str, variable: VariableType | None) -> Completion:
        if variable is not None:
            type_ = "" if variable.type == ANY else str(variable.type)
            return Completion(word=name, kind="field", detail=type_, doc=variable.doc,
                              text=f"{name}: ")  # fmt: skip
        doc = schema.FIELD_DOCS.get(name, "")
        return Completion(word=name, kind="field", doc=doc, text=f"{name}: ")

    # --- state types and sub-scripts

    def templates(self) -> Iterable[Completion]:
        """The state types, those first that fit the other fields of the state."""
        wanted = ("base",) if self.body.name is None else ("state", "container")
        names = [*self.facts.library.template_names(), *(CONTAINERS if len(wanted) > 1 else ())]
        used = Counter(self.used_templates())
        ranked: list[tuple[tuple[float, int, int], Completion]] = []
        for number, name in enumerate(dict.fromkeys(names)):
            if name in CONTAINERS:
                word = Completion(word=name, kind="template", doc=CONTAINER_DOCS[CONTAINERS[name]])
                type_ = None
            else:
                type_ = find_state_type(name, self.facts.library, [])
                if type_ is None or type_.kind not in wanted:
                    continue
                own = any(self.facts.library.own_template(f"{name}{end}")
                          for end in (".yml", ".tpl.py", ".tpl"))  # fmt: skip
                if type_.open and not own:
                    continue
                word = Completion(word=name, kind="template", doc=type_.doc)
            fit = self.fit(name, type_)
            ranked.append(((-fit, -used[name], number), word))
        return [word for _, word in sorted(ranked, key=lambda each: each[0])]

    def used_templates(self) -> Iterable[str]:
        todo = list(self.place.bodies[:1])
        while todo:
            body = todo.pop()
            yield body.template
            todo += body.states

    def fit(self, name: str, type_: StateType | None) -> float:
        """How well a type fits the fields that the state has."""
        fields = {*self.body.fields} - {"template"}
        if name in CONTAINERS:
            own = {*schema.names_for(CONTAINERS[name])} - {*schema.names_for("state")}
            score = 2.0 * len(fields & own) - 2.0 * len(fields - {*schema.names_for(name)})
            needed = {*schema.REQUIRED[CONTAINERS[name]]}
            return score - len(needed - fields) - (0.5 if not fields & own else 0)
        if type_ is None:
            return -9.0
        if self.body.name is None:
            return 1.0 * (type_.simulation == self.is_simulated()) + 0.5 * (name == "Base")
        common = {*schema.names_for("state")}
        own = {*type_.variables}
        extra = fields - common - own
        missing = [each for each in type_.variables.values() if each.required]
        score = 2.0 * len(fields & own) - 3.0 * len(extra)
        score -= 2.0 * len([each for each in missing if each.name not in fields])
        outcomes = {each.name for each in type_.outcomes} | {*self.body.names("outcomes")}
        outcomes |= {self.body.text("default_outcome")}
        led = {*self.body.pairs("transitions")} - {"timeout", "exhausted"}
        free = "outcomes" in type_.given
        score -= 2.0 * len(led - outcomes) if not (free and not type_.open) else 0.0
        score += 0.5 * len(led & {each.name for each in type_.outcomes})
        must = {each.name for each in type_.outcomes} - type_.optional
        score -= 0.5 * len(must - led - {PREEMPTED}) if led else 0.0
        keys = {key.name for key in (*type_.input_keys, *type_.output_keys)}
        score += 1.5 * len(keys & {*self.body.pairs("remapping")})
        free_keys = {"input_keys", "output_keys"} & type_.given
        score -= 1.5 * len({*self.body.pairs("remapping")} - keys) if not free_keys else 0.0
        for part in ("outcomes", "input_keys", "output_keys"):
            has, allowed = part in fields, part in type_.given
            score += 0.7 if has and allowed else -2.0 if has else -0.6 if allowed else 0.0
        return score

    def is_simulated(self) -> bool:
        """Whether a state of the script has a type that uses the simulated world."""
        types = map(self.facts.type_named, self.used_templates())
        return any(each.simulation for each in types if each is not None and each.kind == "state")

    def scripts(self) -> Iterable[Completion]:
        """The sub-scripts, one named like the state first."""
        name = str(self.body.name.value).lower() if self.body.name is not None else ""
        known = self.facts.library.script_names(self.facts.caller)
        given = {*self.body.pairs("remapping")} | {*self.body.names("params")}
        ranked = []
        for number, each in enumerate(known):
            found = self.facts.sub_script(each, self.facts.caller)
            if found is None or found[1].name is None:
                continue  # a script of its own
            inner = found[1]
            score = 3 * (each == name) + 2 * (str(inner.name.value).lower() == name)  # type: ignore[union-attr]
            score += len(given & {*inner.names("input_keys"), *inner.names("output_keys")})
            led = {*self.body.pairs("transitions")}
            score += len(led & {*inner.names("outcomes")}) - len(led - {*inner.names("outcomes")})
            ranked.append((-score, number, Completion(word=each, kind="script",
                                                      doc=inner.text("doc"))))  # fmt: skip
        return [word for _, _, word in sorted(ranked, key=lambda each: each[:2])]

    # --- control flow

    def transitions(self) -> Iterable[Completion]:
        place = self.place
        if place.role == VALUE and place.inner and self.around is not None:
            return self.targets(place.inner[0], self.around)
        if place.role in (KEY, VALUE):
            given = [*self.facts.outcomes(self.body)]
            left = [each for each in given if each not in place.siblings]
            return [Completion(word=each, kind="outcome", doc=self.outcome_doc(each))
                    for each in (_success_first(left))]  # fmt: skip
        return []

    def outcome_doc(self, name: str) -> str:
        type_ = self.facts.type_named(self.body.template)
        found = [each.doc for each in type_.outcomes if each.name == name] if type_ else []
        return found[0] if found else ""

    def targets(self, outcome: str, around: Body) -> Iterable[Completion]:
        """The states and outcomes to which an outcome may lead, likely ones first."""
        states = around.states
        mine = next((at for at, each in enumerate(states) if each.start == self.body.start), -1)
        names = [str(each.name.value) for each in states if each.name is not None]
        ends = self.facts.outcomes(around) if around.name is not None else around.names("outcomes")
        others = Counter(
            target
            for at, each in enumerate(states)
            for word, target in each.pairs("transitions").items()
            if at != mine and word == outcome
        )
        targeted = {target for each in states for target in each.pairs("transitions").values()}
        following = names[mine + 1] if 0 <= mine < len(names) - 1 else ""
        own = self.body.pairs("transitions")
        first_way = following and following in own.values()
        bad = is_failure(outcome) or outcome == PREEMPTED or (
            bool(first_way) and outcome not in GOOD_OUTCOMES
        )  # fmt: skip
        alike = self.targets_of_alike(outcome, states, mine)

        def score(name: str) -> float:
            total = 3.0 * alike[name] if bad else 0.0
            if name in ends:
                total += 2.0 * (name == outcome)
                total += (3.0 if bad else -2.0) * is_failure(name)
                total -= (3.0 if bad else 0.0) * (name in GOOD_OUTCOMES)
                total += 1.0 * (not bad and not following)
                total += 0.3 * (name not in targeted)
                total += 4.0 * (name in GOOD_OUTCOMES and not bad and name not in targeted
                                and self.is_recovery(following, states))  # fmt: skip
            else:
                total += 6.0 * (name == following and not bad)
                total += 3.0 * (name == following and not bad and name not in targeted)
                total += (3.5 if bad else 1.5) * (name not in targeted and name != names[0])
                total -= 3.0 * (mine >= 0 and name == names[mine])
                total -= 0.8 * bad + 0.5 * (name in names[: mine + 1])
            if bad:
                total += min(others[name], 4) * 0.5
                total += 1.5 * sum(to == name and (is_failure(by) or by == PREEMPTED)
                                   for by, to in own.items())  # fmt: skip
            return total

        ranked = sorted([*names, *ends], key=lambda name: -score(name))
        kinds = dict.fromkeys(ends, "outcome") | dict.fromkeys(names, "state")
        return [Completion(word=each, kind=kinds[each]) for each in ranked]

    def targets_of_alike(self, outcome: str, states: list[Body], mine: int) -> Counter[str]:
        """Where the outcome leads in the nearest states that are of the same kind, weighted."""
        found: Counter[str] = Counter()
        before = [each for at, each in enumerate(states) if at < mine]
        after = [each for at, each in enumerate(states) if at > mine]
        for each in [*reversed(before[-2:]), *after[:1]]:
            target = each.pairs("transitions").get(outcome)
            if target is not None:
                found[target] += 1
        kind = "script" if "script" in self.body.fields else "template"
        same = [each for each in states if kind in each.fields and each.start != self.body.start]
        if kind == "script":
            for each in same:
                found.update(each.pairs("transitions").get(outcome, "").split())
        return found

    def is_recovery(self, name: str, states: list[Body]) -> bool:
        """Whether only failures lead to a state."""
        ways = [by for each in states for by, to in each.pairs("transitions").items() if to == name]
        return bool(ways) and all(is_failure(by) or by == PREEMPTED for by in ways)

    def missing_states(self) -> list[str]:
        """The names that transitions lead to and that no state has."""
        container = self.place.body if self.place.word is not self.body.name else self.around
        if container is None:
            return []
        names = {str(each.name.value) for each in container.states if each.name is not None}
        ends = {*self.facts.outcomes(container), *container.names("outcomes")}
        wanted = [
            target for each in container.states for target in each.pairs("transitions").values()
        ]
        return [each for each in dict.fromkeys(wanted) if each not in names | ends]

    def children(self) -> Iterable[Completion]:
        return [Completion(word=str(each.name.value), kind="state")
                for each in self.body.states if each.name is not None]  # fmt: skip

    def on_error(self) -> Iterable[Completion]:
        ends = [Completion(word=each, kind="outcome") for each in self.body.names("outcomes")]
        failing = [each for each in ends if is_failure(each.word)]
        return [*failing, *self.children(), *ends]

    def outcomes(self) -> Iterable[Completion]:
        """Outcomes that something leads to and that are not declared yet."""
        known = {*self.place.siblings}
        type_ = self.facts.type_named(self.body.template)
        wanted: list[str] = []
        if self.body.states:
            names = {str(each.name.value) for each in self.body.states if each.name is not None}
            for each in self.body.states:
                wanted += [to for to in each.pairs("transitions").values() if to not in names]
            wanted += self.body.names("outcome_map")
            wanted += self.body.pairs("final_outcome_map").values()
            wanted += [self.body.text("exhausted_outcome")]
        wanted += [*self.body.pairs("transitions")]
        steps = self.body.names("callbacks") if self.body.text("default_outcome") else []
        wanted += steps
        if type_ is not None and "outcomes" not in type_.given:
            wanted += [each.name for each in type_.outcomes]
        usual = ["succeeded", "aborted", PREEMPTED]
        taken = known | {self.body.text("default_outcome")}
        found = [each for each in _success_first(dict.fromkeys(wanted)) if each not in taken]
        return [Completion(word=each, kind="outcome")
                for each in [*found, *(each for each in usual if each not in known)]]  # fmt: skip

    def outcome_map(self) -> Iterable[Completion]:
        """The parts of a concurrence's rules: outcome, child, outcome of the child."""
        place = self.place
        if place.role == KEY and not place.inner:
            left = [each for each in self.body.names("outcomes") if each not in place.siblings]
            default = self.body.text("default_outcome")
            return [Completion(word=each, kind="outcome")
                    for each in sorted(left, key=lambda each: each == default)]  # fmt: skip
        if place.role == KEY and len(place.inner) == 1:
            return [each for each in self.children() if each.word not in place.siblings]
        if place.role == VALUE and len(place.inner) == 2:
            child = self.child(place.inner[1])
            outcomes = self.facts.outcomes(child) if child is not None else []
            bad = is_failure(place.inner[0])
            ranked = sorted(_success_first(outcomes), key=lambda each: is_failure(each) != bad)
            same = [each for each in ranked if each == place.inner[0]]
            return [Completion(word=each, kind="outcome") for each in [*same, *ranked]]
        return []

    def child(self, name: str) -> Body | None:
        return next((each for each in self.body.states
                     if each.name is not None and str(each.name.value) == name), None)  # fmt: skip

    def default_outcome(self) -> Iterable[Completion]:
        declared = self.body.names("outcomes")
        if self.body.owner == "Concurrence":
            mapped = {*self.body.names("outcome_map")}
            ranked = sorted(declared, key=lambda each: (each in mapped, not is_failure(each)))
        else:
            led = [each for each in self.body.pairs("transitions") if each not in declared]
            ranked = [*led, *declared]
        return [Completion(word=each, kind="outcome") for each in ranked]

    def connector(self) -> Iterable[Completion]:
        count = Counter(
            outcome for each in self.body.states for outcome in self.facts.outcomes(each)
        )
        led = Counter(outcome for each in self.body.states for outcome in each.pairs("transitions"))
        ranked = sorted(count, key=lambda each: (led[each] - count[each], is_failure(each)))
        return [Completion(word=each, kind="outcome") for each in ranked]

    def endings(self) -> Iterable[Completion]:
        """What an Iterator can end with."""
        taken = {*self.body.pairs("final_outcome_map").values()}
        inner = [o for each in self.body.states for o in self.facts.outcomes(each)]
        words = [each for each in self.body.names("outcomes") if each not in (*inner, *taken)]
        ranked = [*_success_first(words), *self.body.names("outcomes")]
        return [Completion(word=each, kind="outcome") for each in ranked]

    def inner_outcomes(self) -> list[str]:
        found = [each for child in self.body.states for each in self.facts.outcomes(child)]
        return list(dict.fromkeys(found))

    def loop_outcomes(self) -> Iterable[Completion]:
        own = {*self.body.names("outcomes")}
        ending = self.place.field == "break_outcomes"
        left = [each for each in self.inner_outcomes() if each not in self.place.siblings]
        ranked = sorted(left, key=lambda each: ((each in own) != ending, is_failure(each)))
        return [Completion(word=each, kind="outcome") for each in ranked]

    def final_map(self) -> Iterable[Completion]:
        if self.place.role == KEY:
            looped = self.body.names("loop_outcomes")
            words = [*looped, *self.inner_outcomes(), self.body.text("exhausted_outcome")]
            left = [each for each in words if each not in self.place.siblings]
            return [Completion(word=each, kind="outcome") for each in left]
        inner = {*self.inner_outcomes(), self.body.text("exhausted_outcome")}
        words = self.body.names("outcomes")
        ranked = sorted(words, key=lambda each: each in inner)
        return [Completion(word=each, kind="outcome") for each in ranked]

    def retry(self) -> Iterable[Completion]:
        place = self.place
        if place.role in (ITEM, VALUE) and place.inner[:1] == ("on",):
            known = self.facts.outcomes(self.body)
            left = [each for each in known if each not in (*place.siblings, "exhausted")]
            ranked = sorted(left, key=lambda each: not is_failure(each))
            return [Completion(word=each, kind="outcome") for each in ranked]
        if place.role == KEY:
            left = [each for each in ("on", "max", "delay") if each not in place.siblings]
            return [Completion(word=each, kind="field", text=f"{each}: ") for each in left]
        return []

    # --- userdata

    def key_word(self, name: str) -> Completion:
        """A key of the container around the state, with its type."""
        context = self.view.context
        detail = ""
        if context is not None and self.around is not None:
            root = context.machine.root.name
            path = "/".join([root, *self.place.path[:-1]])
            type_ = context.types.keys.get((path, name), ANY)
            detail = "" if type_ == ANY else str(type_)
        return Completion(word=name, kind="key", detail=detail)

    def remapping(self) -> Iterable[Completion]:
        place, facts = self.place, self.facts
        if self.around is None:
            return []
        own = [*facts.inputs(self.body), *facts.outputs(self.body)]
        known = facts.keys_in(self.around)
        if place.role == KEY:
            there = {*known}
            left = [each for each in dict.fromkeys(own) if each not in place.siblings]
            ranked = sorted(left, key=lambda each: each in there and known[each] > 1)
            return [Completion(word=each, kind="key") for each in ranked]
        if not place.inner:
            return []
        wanted, writes = place.inner[0], place.inner[0] in facts.outputs(self.body)
        mine = {*self.body.names("userdata")}
        taken = {*self.body.pairs("remapping").values()}
        cooperating = Counter(
            to
            for each in self.around.states
            if each.start != self.body.start
            for key, to in each.pairs("remapping").items()
            if key == wanted
        )
        before, after = self.neighbour_keys()
        mine_words = {word for name in self.place.path[-1:] for word in name.lower().split("_")}

        def score(name: str) -> float:
            total = 3.0 * (name in mine) + 1.0 * min(cooperating[name], 3)
            total += 2.0 * (wanted in name or name in wanted)
            total += 1.0 * bool({*wanted.split("_")} & {*name.split("_")})
            total += 1.5 * bool(mine_words & {*name.split("_")})
            total -= 2.0 * (name in taken)
            total += 2.5 * (name in before and not writes)
            total += 2.5 * (name in after and writes)
            return total

        ranked = sorted(dict.fromkeys([*known, wanted]), key=lambda name: -score(name))
        return [self.key_word(each) for each in ranked]

    def neighbour_keys(self) -> tuple[set[str], set[str]]:
        """The keys that the state before writes, and those that the state after reads."""
        assert self.around is not None
        states = self.around.states
        at = next((at for at, each in enumerate(states) if each.start == self.body.start), -1)
        before = states[at - 1 : at] if at > 0 else []
        after = states[at + 1 : at + 2] if at >= 0 else []
        wrote = [each for state in before for each in self.facts.outer_keys(state)]
        reads = [each for state in after for each in self.facts.outer_keys(state)]
        return {key for key, writes in wrote if writes}, {
            key for key, writes in reads if not writes
        }

    def declared_keys(self) -> Iterable[Completion]:
        """The keys that a state may list: those around it, and those that its states use."""
        place = self.place
        if place.role == VALUE and place.inner:
            return self.types()
        known = {*place.siblings}
        found: dict[str, None] = {}
        if self.body.states:
            for child in self.body.states:
                for key, writes in self.facts.outer_keys(child):
                    if writes == (place.field == "output_keys"):
                        found.setdefault(key)
            inside = {*self.body.names("userdata")}
            found = {key: None for key in found if key not in inside}
        if place.field == "output_keys" or not self.body.states:
            found |= dict.fromkeys(self.body.names("callbacks"))
        found |= dict.fromkeys(self.body.pairs("remapping"))
        for text in _expressions(self.body):
            found = dict.fromkeys(re.findall(r"\bud\.(\w+)", text)) | found
        if self.around is not None:
            scope = self.facts.keys_in(self.around)
            back = {to: key for key, to in self.body.pairs("remapping").items()}
            found |= dict.fromkeys(back.get(key, key) for key in scope)
        return [self.key_word(each) for each in found if each not in known]

    def userdata(self) -> Iterable[Completion]:
        """The keys that something reads and nothing presets; or the parts of the long form."""
        place = self.place
        if place.role == VALUE and place.inner[1:] == ("type",):
            return self.types()
        if place.role == KEY and place.inner:
            left = [each for each in ("type", "value", "doc") if each not in place.siblings]
            return [Completion(word=each, kind="field", text=f"{each}: ") for each in left]
        if place.role != KEY:
            return []
        if self.body.states:
            uses = [each for child in self.body.states for each in self.facts.outer_keys(child)]
        else:
            uses = [(to, False) for to in self.body.pairs("remapping").values()]
            uses += [(key, False) for key in self.facts.inputs(self.body)]
        written = {key for key, writes in uses if writes}
        read = [key for key, writes in uses if not writes]
        ranked = sorted(dict.fromkeys(read), key=lambda key: key in written)
        return [Completion(word=each, kind="key") for each in ranked if each not in place.siblings]

    def item_keys(self) -> Iterable[Completion]:
        scope = self.facts.keys_in(self.around) if self.around is not None else {}
        own = self.body.names("input_keys")
        return [self.key_word(each) for each in dict.fromkeys([*own, *scope])]

    def label_keys(self) -> Iterable[Completion]:
        used = [key for child in self.body.states for key, writes in self.facts.outer_keys(child)
                if not writes and key not in self.body.names("input_keys")]  # fmt: skip
        return [self.key_word(each) for each in dict.fromkeys(used)]

    def for_each(self) -> Iterable[Completion]:
        place = self.place
        if place.role == KEY:
            left = [each for each in ("item", "in", "on") if each not in place.siblings]
            return [Completion(word=each, kind="field", text=f"{each}: ") for each in left]
        if place.inner[:1] == ("item",):
            return [self.key_word(each) for each in self.facts.inputs(self.body)]
        if place.inner[:1] == ("in",) and self.around is not None:
            return [self.key_word(each) for each in self.facts.keys_in(self.around)]
        if place.inner[:1] == ("on",):
            return [Completion(word=each, kind="outcome")
                    for each in self.facts.outcomes(self.body)]  # fmt: skip
        return []

    def callbacks(self) -> Iterable[Completion]:
        if self.place.role != KEY:
            return []
        words = [*self.body.names("output_keys"), *self.body.names("outcomes")]
        return [Completion(word=each, kind="key") for each in words
                if each not in self.place.siblings]  # fmt: skip

    # --- values

    def params(self) -> Iterable[Completion]:
        """The params that the sub-script of a call looks up."""
        if self.place.role != KEY or not self.body.text("script"):
            return []
        return [Completion(word=each, kind="param") for each in self.params_of_call()
                if each not in self.place.siblings]  # fmt: skip

    def params_of_call(self) -> list[str]:
        """The params that the called sub-script looks up."""
        found = self.facts.sub_script(self.body.text("script"), self.facts.caller)
        text = found[0].text if found is not None else ""
        words = re.findall(r"\[params, *(\w+)\]|\[\[(\w+)\]\]", text)
        return list(dict.fromkeys(one or other for one, other in words))

    def types(self) -> Iterable[Completion]:
        named = [name for body in self.place.bodies[:1] for name in body.names("types")]
        return [Completion(word=each, kind="type") for each in [*named, *WORDS]]

    def choices(self) -> Iterable[Completion]:
        words = schema.FIELD_CHOICES.get(self.place.field, ())
        return [Completion(word=each, kind="value") for each in words]

    def robots(self) -> Iterable[Completion]:
        return [Completion(word=each, kind="value") for each in ("panda", "baxter")]

    def variable(self) -> Iterable[Completion]:
        """The values of a variable that has few: booleans, names of outcomes and keys, models."""
        type_ = self.facts.type_named(self.facts.called(self.body).template)
        variable = type_.variables.get(self.place.field) if type_ is not None else None
        if self.place.role == KEY and variable is not None and variable.role == "callbacks":
            return self.callbacks()
        if self.place.role == KEY and variable is not None and variable.role == "steps":
            left = [each for each in ("outcome", "set") if each not in self.place.siblings]
            if not self.place.inner:
                return [Completion(word=each, kind="field", text=f"{each}: ") for each in left]
            return [self.key_word(each) for each in self.facts.outputs(self.body)]
        if variable is not None and self.place.inner[-1:] == ("outcome",):
            words = _success_first(self.facts.outcomes(self.body))
            return [Completion(word=each, kind="outcome") for each in words]
        if variable is not None and str(variable.type) in ("bool", "bool?"):
            return [Completion(word=each, kind="value") for each in ("true", "false")]
        if variable is not None and variable.role == "limb":
            return [Completion(word=each, kind="value") for each in ("left", "right")]
        if variable is not None and variable.keys:
            return self.item_keys()
        used = Counter(
            each.text(self.place.field)
            for body in self.place.bodies
            for each in body.states
            if each.template == self.body.template
        )
        return [Completion(word=each, kind="value") for each, _ in used.most_common() if each]


def _usual_order(names: Iterable[str]) -> list[str]:
    """Fields in the order of the formatter, less usual ones last."""
    first = ("doc", "outcomes", "input_keys", "output_keys", "params", "userdata", "remapping",
             "transitions", "states")  # fmt: skip
    known = list(dict.fromkeys(names))
    return [*(name for name in first if name in known), *(n for n in known if n not in first)]


def _success_first(outcomes: Iterable[str]) -> list[str]:
    """Outcomes by their names: success first, failure and preemption last."""

    def rank(name: str) -> int:
        if name.lower() in SUCCESSES | GOOD:
            return 0
        return 3 if name == PREEMPTED else 2 if is_failure(name) else 1

    return sorted(outcomes, key=rank)


def _expressions(body: Body) -> Iterable[str]:
    """The texts of code in the fields of a state."""
    for name in ("callbacks",):
        entry = body.fields.get(name)
        if entry is not None:
            yield entry.value.span.text
