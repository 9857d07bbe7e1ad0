"""Leaves of the built-in state types: structs whose bodies are printed from the script."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from smachac.analysis.accesses import callbacks
from smachac.diagnostics.source import Span
from smachac.ir.leaf import default_outcome, variable
from smachac.ir.nodes import Data, Expression, Iterator, Leaf, Struct
from smachac.ir.traversal import PREEMPTED, own_outcomes
from smachac.ir.types import Type
from smachac.targets.cpp.expressions import Spelling, cpp_condition, cpp_expression, cpp_function
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import Scope, place
from smachac.targets.cpp.types import UnportableError, cpp_literal, cpp_value

FLOAT = Type("float")
LARGEST_WORD = 2**32


Refuse = Callable[[Span, UnportableError], None]
"""Notes what C++ cannot say, and where."""

STOP = "run.stop_for(places, state)"
"""What hands a state the requests to stop."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LeafCode:
    """A leaf in C++: its type, the call that runs it, and the definition of the type if it is ours.

    `made_with` are the arguments of its constructor; `parameter` is what the `States` around have
    to be made with for that."""

    type: str
    call: str
    definition: tuple[str, ...] = ()
    made_with: str = ""
    parameter: str = ""

    def outcome(self, name: str) -> str:
        return f"{self.type}::Outcome::{identifier(name)}"


@dataclass(frozen=True, slots=True, kw_only=True)
class _Body:
    """What a leaf does: statements, and members beside `execute`."""

    lines: tuple[str, ...]
    members: tuple[str, ...] = ()


def is_built_in(type_: str) -> bool:
    """Whether leaves of a type are printed from the script."""
    return type_ in _BODIES


def builtin_behaviour(leaf: Leaf, scope: Scope, refuse: Refuse) -> LeafCode | None:
    """The struct of a leaf of a built-in type; None for other types. What is wrong in one of its
    expressions is refused there, and the struct lacks it. Raises UnportableError."""
    make = _BODIES.get(leaf.type)
    if make is None:
        return None
    body = make(_Code(leaf=leaf, scope=scope, refuse=refuse))
    return LeafCode(
        type=f"types::{identifier(leaf.name)}",
        call=f"states.{identifier(leaf.name)}.execute({', '.join(_parameters(body).values())})",
        definition=_definition(leaf, body),
    )


def _parameters(body: _Body) -> dict[str, str]:
    """The parameters that a body needs, with what is given for each."""
    text = "\n".join(body.lines)
    watched = "run.write(" in text
    return {
        **({"Userdata &ud": "ud"} if "ud." in text else {}),
        **({"Run &run": "run"} if watched else {}),
        **({"smachac::Stop &stop": STOP} if "stop." in text else {}),
    }


def _definition(leaf: Leaf, body: _Body) -> tuple[str, ...]:
    parameters = _parameters(body)
    head = ["  template <class Run>"] if "Run &run" in parameters else []
    return (
        *((f"/// {place(leaf)}",) if place(leaf) else ()),
        f"struct {identifier(leaf.name)} {{",
        *(f"  {line}" for line in enumeration(own_outcomes(leaf))),
        "",
        *head,
        f"  Outcome execute({', '.join(parameters)}) {{",
        *(f"    {line}" for line in body.lines),
        "  }",
        *(("",) if body.members else ()),
        *(f"  {line}" for line in body.members),
        "};",
    )


def enumeration(names: tuple[str, ...]) -> list[str]:
    """The outcomes of a state."""
    size = 8 if len(names) <= 2**8 else 16 if len(names) <= 2**16 else 32
    head = f"enum class Outcome : std::uint{size}_t {{"
    return [head, *(f"  {identifier(each)}," for each in names), "};"]


@dataclass(frozen=True, slots=True, kw_only=True)
class _Code:
    """A leaf and the userdata it works on."""

    leaf: Leaf
    scope: Scope
    refuse: Refuse

    @property
    def raw(self) -> bool:
        """Whether the leaf sees every key of its container, as the child of an iterator does."""
        return isinstance(self.scope.node, Iterator)

    def bound(self, key: str) -> str:
        return self.scope.names(self.leaf).get(key, key)

    def reads(self) -> dict[str, Spelling]:
        """The keys that its functions may read."""
        inputs = [key.name for key in self.leaf.inputs]
        return {key: self.read(key) for key in (self.scope.keys if self.raw else inputs)}

    def read(self, key: str) -> Spelling:
        return self.scope.read(self.bound(key), key)

    def writes(self, key: str) -> bool:
        return self.raw or any(each.name == key for each in self.leaf.outputs)

    def write(self, key: str, make: Callable[[Type], str]) -> str:
        """The statement that writes what `make` prints for the type of the key."""
        outer = self.bound(key)
        value = make(self.scope.key(outer))
        return f"run.write({cpp_literal(key)}, ud.{identifier(outer)}, {value});"

    def function(self, code: Expression, wanted: Type | None = None) -> str:
        """What a function of the script gives, as a value of the wanted type or else a truth."""
        try:
            body, names = cpp_function(code.text, self.reads())
            if wanted is None:
                return cpp_condition(body, names)
            return cpp_expression(body, names, wanted).text
        except UnportableError as error:
            self.refuse(code.span, error)
            return ""

    def end(self, outcome: str) -> str:
        if outcome not in own_outcomes(self.leaf):
            raise UnportableError(f"it ends with `{outcome}`, which is not one of its outcomes")
        return f"return Outcome::{identifier(outcome)};"

    def stopping(self) -> tuple[str, ...]:
        """What answers a request to stop, where the leaf can."""
        if PREEMPTED not in own_outcomes(self.leaf):
            return ()
        return ("if (stop.requested()) {", "  stop.service();", f"  {self.end(PREEMPTED)}", "}")

    def functions(self) -> Mapping[str, Expression]:
        found = callbacks(self.leaf)
        data = variable(self.leaf, "callbacks")
        if found is None or (isinstance(data, Struct) and len(found) < len(data.entries)):
            raise UnportableError("`callbacks` is no mapping of names to functions")
        return found


def _callbacks(code: _Code) -> _Body:
    return _Body(lines=(*_calls(code), code.end(default_outcome(code.leaf))))


def _calls(code: _Code) -> list[str]:
    """The statements that call the functions of the script, each for the key of its name."""
    lines = []
    functions = code.functions()
    for key in sorted(functions):
        if not code.writes(key):
            raise UnportableError(f"it writes `{key}`, which is not one of its outputs")
        lines.append(code.write(key, lambda type_, f=functions[key]: code.function(f, type_)))  # type: ignore[misc]
    return lines


def _conditional(code: _Code) -> _Body:
    functions = code.functions()
    if code.leaf.outputs:
        raise UnportableError("it writes its outcome under a key")
    lines = []
    for outcome in own_outcomes(code.leaf):
        if outcome in functions:
            holds = code.function(functions[outcome])
            lines += [f"if ({holds}) {{", f"  {code.end(outcome)}", "}"]
    otherwise = variable(code.leaf, "default_outcome")
    if not isinstance(otherwise, str):
        raise UnportableError("it has no `default_outcome`")
    return _Body(lines=(*lines, code.end(otherwise)))


def _scripted(code: _Code) -> _Body:
    data = variable(code.leaf, "steps")
    steps = [_step(code, step) for step in data] if isinstance(data, tuple) else []
    if not steps:
        return _Body(lines=(*code.stopping(), code.end(own_outcomes(code.leaf)[0])))
    if len(steps) == 1:
        return _Body(lines=(*code.stopping(), *steps[0]))
    lines = ["++visits_;", *code.stopping(), "switch (visits_) {"]
    for number, step in enumerate(steps, 1):
        lines.append(f"case {number}:" if number < len(steps) else "default:")
        lines += [f"  {line}" for line in step]
    return _Body(lines=(*lines, "}"), members=("std::uint64_t visits_ = 0;",))


def _step(code: _Code, step: Data) -> list[str]:
    told = dict(step.entries) if isinstance(step, Struct) else None
    if told is None:
        raise UnportableError("a step is no mapping of `outcome` and `set`")
    sets = told.get("set")
    lines = []
    for key, value in sets.entries if isinstance(sets, Struct) else ():
        if code.writes(key):
            lines.append(code.write(key, lambda type_, v=value: cpp_value(v, type_)))  # type: ignore[misc]
    return [*lines, code.end(str(told.get("outcome") or default_outcome(code.leaf)))]


def _sleep(code: _Code) -> _Body:
    time = variable(code.leaf, "time")
    seconds = code.function(time, FLOAT) if isinstance(time, Expression) else cpp_value(time, FLOAT)
    if PREEMPTED not in own_outcomes(code.leaf):
        return _Body(lines=(f"smachac::sleep({seconds});", code.end(default_outcome(code.leaf))))
    lines = (f"if (stop.wait({seconds})) {{", "  stop.service();", f"  {code.end(PREEMPTED)}", "}")
    return _Body(lines=(*lines, code.end(default_outcome(code.leaf))))


def _random(code: _Code) -> _Body:
    if {key.name for key in code.leaf.outputs} - {*code.functions()}:
        raise UnportableError("it writes its outcome under a key")
    seed = variable(code.leaf, "seed")
    number = abs(seed) if isinstance(seed, int) else 0
    words: list[str] = []
    while number or not words:
        words.append(f"{number % LARGEST_WORD}U")
        number //= LARGEST_WORD
    names = own_outcomes(code.leaf)
    draw = f"return static_cast<Outcome>(draws_.below({len(names)}));"
    return _Body(
        lines=(*_calls(code), draw), members=(f"smachac::Draws draws_{{{', '.join(words)}}};",)
    )


def _print(code: _Code) -> _Body:
    keys = sorted(key.name for key in code.leaf.inputs)
    lines = [f"smachac::print({cpp_literal(key)}, {code.read(key).text});" for key in keys]
    return _Body(
        lines=(*code.stopping(), *lines, code.end(default_outcome(code.leaf))),
    )


_BODIES: dict[str, Callable[[_Code], _Body]] = {
    "CallbacksState": _callbacks,
    "ConditionalOutcomeState": _conditional,
    "ScriptedState": _scripted,
    "SleepState": _sleep,
    "RandomOutcomeState": _random,
    "PrintUserdataState": _print,
}
