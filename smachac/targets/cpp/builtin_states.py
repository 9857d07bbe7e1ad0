"""Leaves of the built-in state types: structs whose `execute` is made from the script."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Protocol

from smachac.diagnostics.source import Span
from smachac.ir.leaf import default_outcome, functions, variable, variable_of
from smachac.ir.nodes import Data, Expression, Iterator, Leaf, StateType, Struct, VariableRole
from smachac.ir.outcome_names import PREEMPTED
from smachac.ir.traversal import own_outcomes
from smachac.ir.types import Type
from smachac.records import dataclass, replace
from smachac.targets.cpp.bounded import is_loose, loose
from smachac.targets.cpp.dialect import Dialect
from smachac.targets.cpp.expressions import (
    Printed,
    Spelling,
    cpp_bounded,
    cpp_condition,
    cpp_expression,
    cpp_function,
)
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.plan import ContainerScope, place
from smachac.targets.cpp.terms import BOOL
from smachac.targets.cpp.types import UnportableError, cpp_literal, cpp_value

FLOAT = Type("float")
LARGEST_WORD = 2**32


class Refuse(Protocol):
    """Reports what C++ cannot express, with its place in the script and the names it is about."""

    def __call__(self, span: Span, error: UnportableError, *names: str) -> None: ...


STOP = "run.stop_for(places, state)"
"""The argument that passes the requests to stop to a state."""


@dataclass(frozen=True, slots=True, kw_only=True)
class LeafCode:
    """A leaf in C++: its type, the call that runs it, and the definition of the type if the header
    has to contain it.

    `made_with` are the arguments of its constructor; `parameters` are those that the `States` of
    its container need for them. `uses_userdata`: the call uses the userdata of the container.
    `uses_stop`: the state receives requests to stop. In a stepped machine the call returns the code
    of the result of a step; `bounded_outputs` are the names and objects of outputs with a bound,
    `written` the arguments for the events of writes.
    """

    type: str
    call: str
    definition: tuple[str, ...] = ()
    made_with: str = ""
    parameters: tuple[str, ...] = ()
    uses_userdata: bool
    uses_stop: bool

    bounded_outputs: tuple[tuple[str, str], ...] = ()
    written: tuple[str, ...] = ()

    @property
    def outcome_type(self) -> str:
        return f"{self.type}::Outcome"


@dataclass(frozen=True, slots=True, kw_only=True)
class _Statements:
    """Statements of `execute`, and the parameters of `execute` that they use."""

    lines: tuple[str, ...] = ()
    uses_userdata: bool = False
    uses_run: bool = False
    uses_stop: bool = False

    def __add__(self, other: _Statements) -> _Statements:
        return _Statements(
            lines=(*self.lines, *other.lines),
            uses_userdata=self.uses_userdata or other.uses_userdata,
            uses_run=self.uses_run or other.uses_run,
            uses_stop=self.uses_stop or other.uses_stop,
        )

    def within(self, head: str, end: str = "") -> _Statements:
        """The statements one level deeper, after a head and before an end."""
        inner = (f"  {line}" for line in self.lines)
        return replace(self, lines=(head, *inner, *((end,) if end else ())))

    def parameters(self, scope: ContainerScope) -> Mapping[str, str]:
        """The parameters of `execute` or `step`, with the argument for each."""
        if scope.dialect.stepped:
            run = "run" if self.uses_run or self.uses_stop else ""
            userdata = {f"{scope.userdata_type}ud": "ud"} if self.uses_userdata else {}
            return {f"Run &{run}": "run", **userdata}
        return {
            **({f"{scope.userdata_type}ud": "ud"} if self.uses_userdata else {}),
            **({"Run &run": "run"} if self.uses_run else {}),
            **({"smachac::Stop &stop": STOP} if self.uses_stop else {}),
        }


def is_built_in(type_: StateType) -> bool:
    """Whether the code of leaves of a type is made from the script."""
    return type_.built_in in _STATEMENTS


def built_in(leaf: Leaf, scope: ContainerScope, refuse: Refuse, number: int = 0) -> LeafCode | None:
    """The struct of a leaf of a built-in type; None for other types. `number` is that of the leaf
    in a stepped machine.

    An expression that C++ cannot express is refused at its place, and the struct lacks it. Raises
    UnportableError for other faults.
    """
    make = _STATEMENTS.get(leaf.built_in)
    if make is None:
        return None
    given = _BuiltInLeaf(leaf=leaf, scope=scope, refuse=refuse, number=number)
    statements, member = make(given)
    parameters = statements.parameters(scope)
    call = f"states.{identifier(leaf.name)}.execute({', '.join(parameters.values())})"
    if scope.dialect.stepped:
        _, *others = parameters.values()
        call = (
            f"run.built_in({', '.join([str(number), f'states.{identifier(leaf.name)}', *others])})"
        )
    return LeafCode(
        type=f"types::{identifier(leaf.name)}",
        call=call,
        definition=_definition(given, statements, parameters, member),
        uses_userdata=statements.uses_userdata,
        uses_stop=statements.uses_stop,
    )


def _definition(
    given: _BuiltInLeaf, statements: _Statements, parameters: Iterable[str], member: str
) -> tuple[str, ...]:
    leaf, stepped = given.leaf, given.scope.dialect.stepped
    head = "smachac::step::Result<Outcome> step" if stepped else "Outcome execute"
    return (
        *((f"/// {place(leaf)}",) if place(leaf) else ()),
        f"struct {identifier(leaf.name)} {{",
        *(f"  {line}" for line in enumeration(own_outcomes(leaf))),
        "",
        *(("  template <class Run>",) if statements.uses_run or stepped else ()),
        f"  {head}({', '.join(parameters)}) {{",
        *(f"    {line}" for line in statements.lines),
        "  }",
        *(("", f"  {member}") if member else ()),
        "};",
    )


def enumeration(names: tuple[str, ...]) -> list[str]:
    """The enumeration of the outcomes of a state."""
    size = 8 if len(names) <= 2**8 else 16 if len(names) <= 2**16 else 32
    head = f"enum class Outcome : std::uint{size}_t {{"
    return [head, *(f"  {identifier(name)}," for name in names), "};"]


@dataclass(frozen=True, slots=True, kw_only=True)
class _BuiltInLeaf:
    """A leaf of a built-in type, the container around it, and its number in a stepped machine."""

    leaf: Leaf
    scope: ContainerScope
    refuse: Refuse
    number: int

    @property
    def dialect(self) -> Dialect:
        return self.scope.dialect

    @property
    def in_iterator(self) -> bool:
        """Whether the leaf reads and writes every key of its container, without remapping."""
        return isinstance(self.scope.node, Iterator)

    def bound(self, key: str) -> str:
        """The key of the container to which a key of the leaf is remapped."""
        return self.scope.names(self.leaf)[key]

    def reads(self) -> dict[str, Spelling]:
        """The keys that functions of the leaf may read."""
        inputs = [key.name for key in self.leaf.inputs]
        return {key: self.read(key) for key in (self.scope.keys if self.in_iterator else inputs)}

    def read(self, key: str) -> Spelling:
        return self.scope.read(self.bound(key), key)

    def writes(self, key: str) -> bool:
        return self.in_iterator or any(output.name == key for output in self.leaf.outputs)

    def write(self, key: str, make: Callable[[Type], Printed]) -> _Statements:
        """The statements that write a key; `make` gives the value for the type of the key."""
        outer = self.bound(key)
        type_ = self.scope.key(outer)
        value = make(type_)
        hidden = ", true" if outer in self.scope.secret else ""
        first = f"{self.number}, " if self.dialect.stepped else ""
        given = f"{cpp_literal(key)}, {self.scope.object(outer)}, {value.text}{hidden}"
        line = f"run.write({first}{given});"
        written = _Statements(lines=(line,), uses_userdata=True, uses_run=True)
        return written + self.checked(value.may_fail or is_loose(type_))

    def checked(self, may_fail: bool) -> _Statements:
        """The statements that end a step after a fault; none where the code before cannot fail."""
        if not may_fail:
            return _Statements()
        lines = ("if (run.context.has_failed()) {", "  return smachac::step::failed;", "}")
        return _Statements(lines=lines, uses_run=True)

    def function(self, code: Expression, wanted: Type | None = None) -> Printed:
        """The result of a function of the script, as a value of the wanted type or else as a truth
        value; without text where it is refused."""
        try:
            body, names = cpp_function(code.text, self.reads())
            if wanted is None:
                return cpp_condition(body, names, self.dialect)
            if is_loose(wanted):
                return cpp_bounded(body, names, loose(wanted))
            return cpp_expression(body, names, wanted, self.dialect)
        except UnportableError as error:
            self.refuse(code.span, error, self.leaf.name)
            return Printed(text="", type=BOOL, uses_names=False)

    def end(self, outcome: str) -> _Statements:
        if outcome not in own_outcomes(self.leaf):
            raise UnportableError(
                f"the state ends with `{outcome}`, which is not one of its outcomes"
            )
        return _Statements(lines=(f"return Outcome::{identifier(outcome)};",))

    def stopping(self) -> _Statements:
        """The statements that answer a request to stop; none for a leaf without that outcome."""
        if PREEMPTED not in own_outcomes(self.leaf):
            return _Statements()
        return self.preempted(self.dialect.stop_requested)

    def preempted(self, test: str) -> _Statements:
        """The statements that end the leaf as preempted where a test of `stop` holds."""
        service = _Statements(lines=(self.dialect.service,), uses_stop=True)
        return (service + self.end(PREEMPTED)).within(f"if ({test}) {{", "}")

    def functions(self, role: VariableRole) -> Mapping[str, Expression]:
        """The functions of the variable with a role, by name."""
        found, held = functions(self.leaf, role), variable_of(self.leaf, role)
        data = held.value.data if held is not None else None
        if found is None or (isinstance(data, Struct) and len(found) < len(data.entries)):
            raise UnportableError(
                f"`{held.name if held else role}` is not a mapping of names to functions"
            )
        return found

    def calls(self) -> _Statements:
        """The statements that call the functions of the script and write each result to the key of
        its name."""
        found = _Statements()
        callbacks = self.functions("callbacks")
        for key in sorted(callbacks):
            if not self.writes(key):
                raise UnportableError(
                    f"the state writes `{key}`, which is not one of its output keys",
                    help=f"add `{key}` to its `output_keys`",
                )
            code = callbacks[key]
            found += self.write(key, lambda type_, code=code: self.function(code, type_))  # type: ignore[misc]
        return found


Code = tuple[_Statements, str]
"""The statements of a leaf, and the member that it has beside `execute`, if any."""


def _callbacks(leaf: _BuiltInLeaf) -> Code:
    return leaf.calls() + leaf.end(default_outcome(leaf.leaf)), ""


def _conditional(leaf: _BuiltInLeaf) -> Code:
    conditions = leaf.functions("conditions")
    if leaf.leaf.outputs:
        raise UnportableError("the state writes its outcome to a key")
    found = _Statements()
    for outcome in own_outcomes(leaf.leaf):
        if outcome in conditions:
            holds = leaf.function(conditions[outcome])
            end = leaf.end(outcome)
            if holds.may_fail:
                name = f"is_{identifier(outcome)}"
                found += _Statements(lines=(f"const bool {name} = {holds.text};",), uses_run=True)
                found += leaf.checked(True)
                test = end.within(f"if ({name}) {{", "}")
            else:
                test = end.within(f"if ({holds.text}) {{", "}")
            found += replace(test, uses_userdata=holds.uses_names)
    otherwise = variable(leaf.leaf, "default_outcome")
    if not isinstance(otherwise, str):
        raise UnportableError("the state has no `default_outcome`")
    return found + leaf.end(otherwise), ""


def _scripted(leaf: _BuiltInLeaf) -> Code:
    data = variable(leaf.leaf, "steps")
    steps = [_step(leaf, step) for step in data] if isinstance(data, tuple) else []
    if not steps:
        return leaf.stopping() + leaf.end(own_outcomes(leaf.leaf)[0]), ""
    if len(steps) == 1:
        return leaf.stopping() + steps[0], ""
    found = _Statements(lines=("++visits_;",)) + leaf.stopping()
    found += _Statements(lines=("switch (visits_) {",))
    for number, step in enumerate(steps, 1):
        found += step.within(f"case {number}:" if number < len(steps) else "default:")
    return found + _Statements(lines=("}",)), "std::uint64_t visits_ = 0;"


def _step(leaf: _BuiltInLeaf, step: Data) -> _Statements:
    given = dict(step.entries) if isinstance(step, Struct) else None
    if given is None:
        raise UnportableError("a step is not a mapping with `outcome` and `set`")
    sets = given.get("set")
    found = _Statements()
    for key, value in sets.entries if isinstance(sets, Struct) else ():
        if leaf.writes(key):
            found += leaf.write(key, lambda type_, value=value: _constant(value, type_))  # type: ignore[misc]
    return found + leaf.end(str(given.get("outcome") or default_outcome(leaf.leaf)))


def _constant(value: Data, type_: Type) -> Printed:
    """A constant as a value of a type."""
    return Printed(text=cpp_value(value, type_), type=type_, uses_names=False)


def _sleep(leaf: _BuiltInLeaf) -> Code:
    time = variable(leaf.leaf, "time")
    seconds = leaf.function(time, FLOAT) if isinstance(time, Expression) else _constant(time, FLOAT)
    if leaf.dialect.stepped:
        return _wait(leaf, seconds), "smachac::step::Nanoseconds until_ = 0;"
    if PREEMPTED in own_outcomes(leaf.leaf):
        sleep = leaf.preempted(f"stop.wait({seconds.text})")
    else:
        sleep = _Statements(lines=(f"smachac::sleep({seconds.text});",))
    sleep = replace(sleep, uses_userdata=seconds.uses_names)
    return sleep + leaf.end(default_outcome(leaf.leaf)), ""


def _wait(leaf: _BuiltInLeaf, seconds: Printed) -> _Statements:
    """The statements of a step of a state that waits."""
    until = f"until_ = run.context.now + smachac::step::nanoseconds({seconds.text});"
    start = _Statements(lines=(until,), uses_run=True, uses_userdata=seconds.uses_names)
    start += leaf.checked(seconds.may_fail)
    running = ("if (run.context.now < until_) {", "  return smachac::step::running;", "}")
    return (
        leaf.stopping()
        + start.within("if (run.context.first) {", "}")
        + _Statements(lines=running, uses_run=True)
        + leaf.end(default_outcome(leaf.leaf))
    )


def _random(leaf: _BuiltInLeaf) -> Code:
    if leaf.dialect.stepped:
        raise UnportableError("the random numbers of Python need 2.5 kB of memory in each state")
    if {key.name for key in leaf.leaf.outputs} - {*leaf.functions("callbacks")}:
        raise UnportableError("the state writes its outcome to a key")
    seed = variable(leaf.leaf, "seed")
    number = abs(seed) if isinstance(seed, int) else 0
    words: list[str] = []
    while isinstance(seed, int) and (number or not words):
        words.append(f"{number % LARGEST_WORD}U")
        number //= LARGEST_WORD
    names = own_outcomes(leaf.leaf)
    draw = f"return static_cast<Outcome>(draws_.below({len(names)}));"
    member = f"smachac::Draws draws_{{{', '.join(words)}}};"  # without a seed: by chance
    return leaf.calls() + _Statements(lines=(draw,)), member


def _print(leaf: _BuiltInLeaf) -> Code:
    if leaf.dialect.stepped:
        raise UnportableError("a stepped machine has no output to print to")
    keys = sorted(key.name for key in leaf.leaf.inputs)
    lines = [f"smachac::print({cpp_literal(key)}, {leaf.read(key).text});" for key in keys]
    prints = _Statements(lines=tuple(lines), uses_userdata=bool(lines))
    return leaf.stopping() + prints + leaf.end(default_outcome(leaf.leaf)), ""


_STATEMENTS: Mapping[str, Callable[[_BuiltInLeaf], Code]] = {
    "CallbacksState": _callbacks,
    "ConditionalOutcomeState": _conditional,
    "ScriptedState": _scripted,
    "SleepState": _sleep,
    "RandomOutcomeState": _random,
    "PrintUserdataState": _print,
}
