"""Random programs that build machines for SMACH, run by Python with a small stand-in of SMACH.

A program gets what is not known from the module `vendor`: `flag(0)` is a truth value, `risky(0)`
may raise, `items(0)` is a list, `more(0)` is true some times. One choice of all of these is a run.
"""

from __future__ import annotations

import itertools
import types
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

UNKNOWNS = 3
"""The number of conditions that are not known."""

_HEAD = """\
import smach
import vendor

a, b, c = "a", "b", "c"
names = ["a"]
table = {"o": "a"}


class Part:
    p = "class"

    def __init__(self):
        self.q = "own"

    @property
    def twice(self):
        return self.q + self.q

    @twice.setter
    def twice(self, value):
        self.q = value


def take(x, *more, y="y", **named):
    return (named.get("z") or y or x) + str(len(more))


def counter():
    total = 0

    def count():
        nonlocal total
        total += 1
        return f"n{total}"

    return count


def put(label, target, **table):
    smach.StateMachine.add(label, smach.State(outcomes=["o"]), {"o": target, **table})


count = counter()
other = part = Part()
sm = smach.StateMachine(outcomes=["end"])
"""

_TAIL = """\
with sm:
    smach.StateMachine.add("A_END", smach.State(outcomes=list(names)), {"o": a, "p": b, "q": c})
    smach.StateMachine.add("B_END", smach.State(outcomes=["o"]), table)
    smach.StateMachine.add("C_END", smach.State(outcomes=["o"]), {"o": part.p, "p": part.q,
                                                                  "q": part.twice})
"""

Pick = Callable[[int], int]
"""Draws a number below another one."""


class Writer:
    """Writes a program; `pick` draws the choices."""

    def __init__(self, pick: Pick) -> None:
        self.pick = pick
        self.functions: list[str] = []
        self.labels = 0

    def program(self) -> str:
        functions = [self.function(number) for number in range(self.pick(3))]
        body = self.block(0, in_loop=False, in_function=False)
        return "\n".join([_HEAD, *functions, *body, _TAIL])

    def function(self, number: int) -> str:
        body = self.block(1, in_loop=False, in_function=True)
        name = f"f{number}"
        self.functions.append(name)
        lines = [f"def {name}(x, y='default', *rest, **named):",
                 "    global a, b, names, table", *body,
                 f"    return {self.text()}", "", ""]  # fmt: skip
        return "\n".join(lines)

    def one(self, *choices: str) -> str:
        return choices[self.pick(len(choices))]

    def name(self) -> str:
        return self.one("a", "b", "c")

    def unknown(self) -> int:
        return self.pick(UNKNOWNS)

    def text(self) -> str:
        name = self.name()
        kind = self.pick(12)
        match kind:
            case 0 | 1 | 2:
                return repr(self.one("a", "b", "d", "e"))
            case 3 | 4:
                return name
            case 5:
                return f"({name} if {self.condition()} else {self.one('a', 'b', 'c')})"
            case 6:
                return f"({self.one('part.p', 'part.q', 'part.twice')})"
            case 7:
                return f"(vendor.flag({self.unknown()}) and 'd' or {name})"
            case 8:
                return f"f'{{{name}}}x'[:3]"
            case 9:
                return f"(lambda z, w={name}: z + w)('l')[:3]"
            case 10:
                return f"table.get('o', {name})"
        return f"('%s-%d' % ({name}, 1))[:3]"

    def condition(self) -> str:
        name, other = self.name(), self.one("'a'", "'b'", "b", "c")
        return self.one(
            f"vendor.flag({self.unknown()})", f"vendor.flag({self.unknown()})",
            f"not vendor.flag({self.unknown()})", f"{name} == {other}", f"{name} != {other}",
            f"{name} in ('a', 'd')", f"(vendor.flag({self.unknown()}) or {name} == {other})",
            f"(vendor.flag({self.unknown()}) and {name} is not None)", "True", "names", "table",
            f"(c := {name}) == {other}", f"len(names) > {self.pick(3)}",
        )  # fmt: skip

    def block(self, depth: int, *, in_loop: bool, in_function: bool) -> list[str]:
        indent = "    " * (depth if depth else 0)
        lines: list[str] = []
        for _ in range(1 + self.pick(4)):
            lines += self.statement(depth, indent, in_loop, in_function)
        return lines

    def statement(self, depth: int, at: str, in_loop: bool, in_function: bool) -> list[str]:
        kind = self.pick(24 if depth >= 3 else 34)
        name = self.name()
        number = self.unknown()

        def inner(*, loop: bool = in_loop) -> list[str]:
            return self.block(depth + 1, in_loop=loop, in_function=in_function)

        match kind:
            case 0 | 1 | 2:
                return [f"{at}{name} = {self.text()}"]
            case 3:
                return [f"{at}{name} += {self.one(chr(39) + 'z' + chr(39), name)}",
                        f"{at}{name} = {name}[-2:]"]  # fmt: skip
            case 4:
                return [f"{at}names.append({self.text()})"]
            case 5:
                return [f"{at}table[{self.one(chr(39) + 'o' + chr(39), name)}] = {self.text()}"]
            case 6 | 7:
                self.labels += 1
                return [f"{at}with sm:",
                        f"{at}    smach.StateMachine.add('S{self.labels}', "
                        f"smach.State(outcomes=['o']), {{'o': {self.text()}}})"]  # fmt: skip
            case 8:
                return [f"{at}part.{self.one('p', 'q', 'twice')} = {self.text()}"]
            case 9:
                return [f"{at}vendor.risky({number})"] if depth else [f"{at}pass"]
            case 10 if in_loop:
                return [f"{at}if {self.condition()}:", f"{at}    {self.one('break', 'continue')}"]
            case 11 if in_function:
                return [f"{at}if {self.condition()}:", f"{at}    return {self.text()}"]
            case 12 if self.functions and not in_function:
                call = f"{self.functions[self.pick(len(self.functions))]}({self.text()})"
                return [f"{at}{name} = {call}"]
            case 13:
                return [f"{at}names = [n + 'y' for n in names if {self.condition()}][:4]"]
            case 14:
                return [f"{at}table = {{**table, 'p': {self.text()}}}"]
            case 15:
                return [f"{at}[names.append(n) for n in vendor.items({number})]"]
            case 16:
                return [f"{at}{self.change()}"]
            case 17:
                return [f"{at}{name}, *_ = [{self.text()}, {self.text()}]"]
            case 18:
                return [f"{at}for {name} in table.values():", f"{at}    names.append({name})"]
            case 19:
                return [f"{at}if {self.condition()}:", f"{at}    raise vendor.Error"]
            case 20:
                return [f"{at}part = {self.one('part', 'Part()', 'other')}"]
            case 21:
                return [f"{at}{name} = take({self.text()}, *names, {self.one('y', 'z')}="
                        f"{self.text()})"]  # fmt: skip
            case 22:
                return [f"{at}{name} = count()"]
            case 23:
                return [f"{at}with sm:",
                        f"{at}    put('T', {name}, **table)"]  # fmt: skip
            case 24 | 25:
                lines = [f"{at}if {self.condition()}:", *inner()]
                return [*lines, f"{at}else:", *inner()] if self.pick(2) else lines
            case 26 | 27:
                items = self.one("('a', 'b')", f"vendor.items({number})", "list(names)", "()")
                lines = [f"{at}for {name} in {items}:", *inner(loop=True)]
                return [*lines, f"{at}else:", *inner()] if self.pick(3) == 0 else lines
            case 28:
                return [f"{at}while vendor.more({number}):", *inner(loop=True)]
            case 29 | 30:
                lines = [f"{at}try:", *inner(), f"{at}except vendor.Error:", *inner()]
                return [*lines, f"{at}finally:", f"{at}    {name} = {name}[:3]"]
            case 31:
                return [f"{at}at_{depth} = 0", f"{at}while at_{depth} < 2:",
                        f"{at}    at_{depth} += 1", *inner(loop=True)]  # fmt: skip
            case 32:
                return [f"{at}try:", *inner(), f"{at}finally:", f"{at}    {name} = {name}[:2]"]
            case 33:
                return [f"{at}match {name}:", f"{at}    case 'a' | 'd':",
                        *self.deeper(depth, in_loop, in_function), f"{at}    case 'b':",
                        *self.deeper(depth, in_loop, in_function), f"{at}    case other:",
                        f"{at}        {self.name()} = other"]  # fmt: skip
        return [f"{at}pass"]

    def change(self) -> str:
        """A call that changes a collection."""
        return self.one(
            f"table.update(p={self.text()})", f"table.setdefault('q', {self.text()})",
            "table.pop('p', None)", "names.reverse()", "names.sort()", "names.extend(names[:1])",
            f"names.insert(0, {self.text()})", "names.clear()", "del table['o']",
            "names[0] = 'x' if names else names.append('x')", "vendor.use(names)",
            f"names = sorted(set(names) | {{{self.text()}}})", "names = [*names, *table]",
        )  # fmt: skip

    def deeper(self, depth: int, in_loop: bool, in_function: bool) -> list[str]:
        return self.block(depth + 2, in_loop=in_loop, in_function=in_function)


class RealState(NamedTuple):
    """A state that a run adds."""

    label: str
    outcomes: tuple[str, ...]
    transitions: Mapping[str, str]


def runs(program: str) -> Iterator[tuple[RealState, ...]]:
    """The states that a program adds to `sm`, for each choice of what is not known; runs that end
    with an error are left out."""
    code = compile(program, "machine.py", "exec")
    for choice in itertools.product((False, True), repeat=UNKNOWNS):
        found = _run(code, choice)
        if found is not None:
            yield found


def _run(code: Any, choice: Sequence[bool]) -> tuple[RealState, ...] | None:
    added: list[RealState] = []
    modules = {"smach": _smach(added), "vendor": _vendor(choice)}

    def load(name: str, *rest: object) -> types.ModuleType:
        return modules[name]

    builtins = {**vars(__import__("builtins")), "__import__": load}
    try:
        exec(code, {"__name__": "__main__", "__builtins__": builtins})
    except Exception:  # a run that fails builds no machine
        return None
    return tuple(added)


def _smach(added: list[RealState]) -> types.ModuleType:
    module = types.ModuleType("smach")

    class State:
        def __init__(self, outcomes: Sequence[str] = ()) -> None:
            self.outcomes = tuple(outcomes)

    class StateMachine(State):
        def __enter__(self) -> None:
            pass

        def __exit__(self, *rest: object) -> None:
            pass

        @staticmethod
        def add(label: str, state: State, transitions: Mapping[str, str]) -> None:
            added.append(RealState(label, state.outcomes, dict(transitions)))

    vars(module).update(State=State, StateMachine=StateMachine)
    return module


def _vendor(choice: Sequence[bool]) -> types.ModuleType:
    module = types.ModuleType("vendor")
    turns = [2 * value for value in choice]

    class Error(Exception):
        pass

    def risky(number: int) -> None:
        if choice[number]:
            raise Error

    def more(number: int) -> bool:
        turns[number] -= 1
        return turns[number] >= 0

    vars(module).update(
        Error=Error, risky=risky, use=list.clear, more=more, flag=lambda number: choice[number],
        items=lambda number: ["d", "e"] if choice[number] else [],
    )  # fmt: skip
    return module
