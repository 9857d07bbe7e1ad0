"""Partial evaluation of Python: statements and expressions over known and unknown values.

Nothing of the project is run. At an unknown condition both branches are evaluated, each on the same
state, and the states are joined. `try` is such a condition: its handlers may run after its body.
"""

from __future__ import annotations

import ast
import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import PurePath
from typing import Any, Literal, Protocol

from smachac.diagnostics.source import Span
from smachac.pysource.machines.bound_names import KNOWN_NAMES, bound_names, star_imports
from smachac.pysource.machines.builtins import BUILTINS, attribute_of_value, is_pure
from smachac.pysource.machines.heap import ABSENT, Changes, Children, Heap, present
from smachac.pysource.machines.lasting import Lasting
from smachac.pysource.machines.operations import (
    MOST_BITS,
    MOST_ITEMS,
    ORDERS,
    calculated,
    filled_in,
    formatted,
    same,
)
from smachac.pysource.machines.values import (
    NONE,
    UNKNOWN,
    Arguments,
    Class,
    Const,
    Creation,
    DictValue,
    Frame,
    Function,
    Instance,
    LibraryClass,
    ListValue,
    Method,
    ModuleValue,
    Native,
    OneOf,
    OpenText,
    OwnSlots,
    Partial,
    Slots,
    Super,
    TupleValue,
    Unknown,
    UseFault,
    Value,
    alternatives,
    newest,
    one_of,
    sequence,
    text_of,
    truth,
)
from smachac.pysource.machines.wrong_calls import Signature, signature_of, wrong_call
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.records import dataclass, field, replace

MOST_STEPS, MOST_TIMES = 150_000, 2
"""The most statements and expressions that are evaluated for the main part of a file, or for one of
its functions and classes, and how many times as many for all of them."""
DEEPEST_CALL, MOST_RECURSIVE = 60, 2
"""The most calls inside one another, and of one function under an unknown condition."""
MOST_BASES = 200
"""The most classes from which a class is derived that are known."""
MOST_TURNS, MOST_WIDENINGS = 1_000, 8
"""The most turns of a `while` loop, and the most times that a loop with an unknown number of turns
is evaluated until a turn changes nothing more."""

Completion = tuple[Literal["return", "break", "continue", "raise"], Value]
"""The end of a block other than after its last statement."""


class BudgetError(Exception):
    """The evaluation takes too long: what is known then is incomplete."""


class Project(Protocol):
    """The modules of the project and of the libraries that the evaluator models."""

    def load(self, evaluator: Evaluator, name: str, user: ModuleValue) -> Value: ...
    def method_of(self, cls: str, name: str) -> Native | None: ...
    def new_object(
        self, evaluator: Evaluator, cls: LibraryClass, arguments: Arguments
    ) -> Value: ...
    def is_of_framework(self, cls: Value) -> bool: ...
    def signature_of(self, method: Native) -> Signature | None: ...
    def may_set(self, name: str) -> bool: ...
    def misplaced(self, module: ModuleValue, name: str) -> tuple[Value, str]: ...
    def is_certain(self, name: str, user: ModuleValue) -> bool: ...


@dataclass(slots=True)
class _Region:
    """A function, a loop, or a turn of a loop: the state at its start, and the states in which
    unknown conditions may have left it, each with the value."""

    kind: str
    mark: int
    left: list[tuple[Value, Changes]] = field(default_factory=list)


class Evaluator:
    """Evaluates modules, functions and classes; `made` are the objects of the classes of frameworks
    in the order in which they were made, `called` the functions that were called, `generators`
    whether one of them is a generator. `exhausted`: a part of the file took too many steps.
    `assumed` are the values of conditions that are not known, by their code, `used` those that were
    needed. `unsure`, `tries`, `managers` and `guesses` count the conditions, the `try` statements,
    the `with` statements of objects that are not known, and the calls of one of several functions
    that the evaluation is in."""

    def __init__(self, project: Project, assumed: Mapping[str, bool] | None = None) -> None:
        self.project = project
        self.assumed = assumed or {}
        self.used: set[str] = set()
        self.heap = Heap()
        self.steps = 0
        self.limit = MOST_STEPS
        self.calls: list[tuple[Function, int]] = []
        self.adds = 0
        self.regions: list[_Region] = []
        self.made: list[Instance] = []
        self.called: set[ast.AST] = set()
        self.generators: dict[ast.AST, bool] = {}
        self.opened: list[Value] = []
        self.unsure = 0
        self.orphans = 0
        self.sees_opened = False
        self.tries = 0
        self.guesses = 0
        self.managers = 0
        self.exhausted = False
        self.faults: list[UseFault] = []
        self.missed: set[tuple[int, str]] = set()

    # --- statements

    def block(self, body: Sequence[ast.stmt], frame: Frame) -> Completion | None:
        for statement in body:
            end = self.statement(statement, frame)
            if end is not None:
                return end
        return None

    def statement(self, node: ast.stmt, frame: Frame) -> Completion | None:
        self._step()
        match node:
            case ast.Expr(value=value):
                self.value(value, frame)
                if _exits(value):
                    return "raise", NONE
            case ast.Assign(targets=targets, value=value):
                found = self.value(value, frame)
                for target in targets:
                    self.assign(target, found, frame)
            case ast.AnnAssign(target=target, value=value):
                if value is not None:
                    self.assign(target, self.value(value, frame), frame)
            case ast.AugAssign(target=target, op=op, value=value):
                self._augment(target, op, self.value(value, frame), frame, node)
            case ast.If(test=test, body=body, orelse=orelse):
                return self._branch(test, body, orelse, frame)
            case ast.For(target=target, iter=items, body=body, orelse=orelse):
                return self._for(target, self.value(items, frame), body, orelse, frame)
            case ast.While(test=test, body=body, orelse=orelse):
                return self._while(test, body, orelse, frame)
            case ast.With(items=items, body=body):
                return self._with(items, body, frame)
            case ast.Try() | ast.TryStar():
                return self._try(node, frame)
            case ast.Return(value=value):
                return "return", NONE if value is None else self.value(value, frame)
            case ast.Break():
                return "break", NONE
            case ast.Continue():
                return "continue", NONE
            case ast.Raise(exc=exc):
                if exc is not None:
                    self.value(exc, frame)
                return "raise", NONE
            case ast.FunctionDef() | ast.AsyncFunctionDef():
                self.bind(node.name, self._function(node, frame), frame)
            case ast.ClassDef():
                self.bind(node.name, self._class(node, frame), frame)
            case ast.Import(names=names):
                self._import(names, frame)
            case ast.ImportFrom():
                self._import_from(node, frame)
            case ast.Global(names=names):
                frame.global_names |= frozenset(names)
            case ast.Nonlocal(names=names):
                frame.outer_names |= frozenset(names)
            case ast.Delete(targets=targets):
                for target in targets:
                    self._delete(target, frame)
            case ast.Match(subject=subject, cases=cases):
                return self._match(self.value(subject, frame), cases, frame)
            case _:
                pass
        return None

    def _step(self) -> None:
        self.steps += 1
        if self.steps + self.heap.work > self.limit:
            raise BudgetError

    def renew(self) -> None:
        """Gives the next function or class of a file new steps, if the file has some left."""
        self.limit = min(self.steps + self.heap.work + MOST_STEPS, MOST_TIMES * MOST_STEPS)

    def reset(self) -> None:
        """Ends what is being evaluated after a BudgetError."""
        self.opened.clear()
        self.regions.clear()
        self.calls.clear()
        self.unsure = self.tries = self.guesses = self.managers = 0
        self.exhausted = True
        self.heap.reset()

    def load(self, body: Sequence[ast.stmt], frame: Frame) -> bool:
        """Evaluates a module that another one imports; whether it ends with an error. What it
        writes stays, also if the import is under a condition; the faults in it are its own."""
        around = self.opened, self.regions, self.unsure, self.faults
        self.opened, self.regions, self.unsure, self.faults = [], [], 0, []
        try:
            return self.heap.apart(lambda: self.block(body, frame)) is not None
        finally:
            frame.module.faults = self.faults
            self.opened, self.regions, self.unsure, self.faults = around

    def tried(self, function: Value, arguments: Arguments) -> Value | None:
        """The result of a call, all changes of which are undone; None if it takes too long."""
        around = self.opened, self.regions, self.calls, self.unsure, self.tries
        others = [*self.heap.others]

        def called() -> Value | None:
            try:
                return self.call(function, arguments, None, Frame({}, ModuleValue("", {})))
            except (BudgetError, RecursionError):
                return None
            finally:
                self.heap.undo(0)

        self.opened, self.regions, self.calls, self.unsure, self.tries = [], [], [], 0, 0
        try:
            return self.heap.apart(called)
        finally:
            self.opened, self.regions, self.calls, self.unsure, self.tries = around
            self.heap.others[:] = others

    def begin(self) -> None:
        """Begins the evaluation of a file, with all steps left. What the code of the one before
        has changed in modules that both import is undone."""
        self.heap.reset()
        self.heap.undo(0)
        self.made.clear()
        self.faults.clear()
        self.steps = self.heap.work = 0
        self.renew()
        self.exhausted = False

    def _branch(
        self, test: ast.expr, body: Sequence[ast.stmt], orelse: Sequence[ast.stmt], frame: Frame
    ) -> Completion | None:
        known = self._truth(test, frame)
        if known is not None:
            return self.block(body if known else orelse, frame)
        return self.choice([lambda: self.block(body, frame), lambda: self.block(orelse, frame)])

    def _truth(self, test: ast.expr, frame: Frame) -> bool | None:
        """The truth value of a condition, or that which is assumed; None: not known."""
        known = truth(self.value(test, frame))
        if known is not None or not self.assumed:
            return known
        code = ast.unparse(test)
        if code in self.assumed:
            self.used.add(code)
        return self.assumed.get(code)

    def choice(self, branches: Sequence[Callable[[], Completion | None]]) -> Completion | None:
        """Evaluates branches of which one is taken, and joins the states after them."""
        mark = self.heap.mark()
        states: list[Changes] = []
        last: Completion | None = None
        opened, others = [*self.opened], len(self.heap.others)
        self.unsure += 1
        for branch in branches:
            start = newest()
            end = branch()
            self.opened[:] = opened
            if end is not None:
                self._leave(end)
                last = end if last is None or last[0] == "raise" else last
                self.heap.undo(mark)
            else:
                states.append(self.heap.undo(mark))
            self.heap.others.append((start, newest()))
        self.unsure -= 1
        del self.heap.others[others:]
        self.heap.join(states)
        self.heap.release(mark)
        if states:
            return None
        return ("raise", NONE) if last is None or last[0] == "raise" else _left(last)

    def _leave(self, end: Completion) -> None:
        """Notes the state in which an unknown condition may leave a function or a loop."""
        if end[1] is LEFT:
            return
        kinds = {"return": "call", "break": "loop", "continue": "turn"}
        for region in reversed(self.regions):
            if region.kind == kinds.get(end[0]):
                region.left.append((end[1], self.heap.changes(region.mark)))
                return
            if region.kind == "call":
                return

    def _region(self, kind: str, run: Callable[[], Completion | None]) -> Completion | None:
        """Runs a part of code, and joins its end with the states in which it was left."""
        region = _Region(kind, self.heap.mark())
        self.regions.append(region)
        try:
            end = run()
        finally:
            self.regions.pop()
        kinds = {"call": "return", "loop": "break", "turn": "continue"}
        own = end is not None and end[0] == kinds[kind]
        if not region.left:
            self.heap.release(region.mark)
            return end
        values = [value for value, _ in region.left]
        states = [state for _, state in region.left]
        if end is not None and not own:
            self._leave(end)
        now = self.heap.undo(region.mark)
        reaches = end is None or (own and end[1] is not LEFT)
        if reaches:
            states.append(now)
            values.append(end[1] if end is not None else NONE)
        self.heap.join(states)
        self.heap.release(region.mark)
        return ("return", one_of(values)) if kind == "call" else None

    def _for(
        self,
        target: ast.expr,
        items: Value,
        body: Sequence[ast.stmt],
        orelse: Sequence[ast.stmt],
        frame: Frame,
    ) -> Completion | None:
        known = sequence(items)
        if known is None:

            def turn() -> Completion | None:
                self.assign(target, UNKNOWN, frame)
                return self._region("turn", lambda: self.block(body, frame))

            return self._unknown_loop(turn, body, orelse, frame)

        def loop() -> Completion | None:
            for item in known:
                self.assign(target, item, frame)
                end = self._region("turn", lambda: self.block(body, frame))
                if end is not None and end[0] != "continue":
                    return end
            return self.block(orelse, frame)

        end = self._region("loop", loop)
        return None if end is not None and end[0] == "break" else end

    def _while(
        self, test: ast.expr, body: Sequence[ast.stmt], orelse: Sequence[ast.stmt], frame: Frame
    ) -> Completion | None:

        def turn() -> Completion | None:
            end = self._region("turn", lambda: self.block(body, frame))
            if end is None or end[0] == "continue":
                self.value(test, frame)
            return end

        def loop() -> Completion | None:
            turns = 0
            while True:
                known = truth(self.value(test, frame))
                turns += 1
                if known is None or turns > MOST_TURNS:
                    return self._unknown_loop(turn, body, orelse, frame)
                if not known:
                    return self.block(orelse, frame)
                end = self._region("turn", lambda: self.block(body, frame))
                if end is not None and end[0] != "continue":
                    return end

        end = self._region("loop", loop)
        return None if end is not None and end[0] == "break" else end

    def _unknown_loop(
        self,
        turn: Callable[[], Completion | None],
        body: Sequence[ast.stmt],
        orelse: Sequence[ast.stmt],
        frame: Frame,
    ) -> Completion | None:
        """A loop with an unknown number of turns, of which `turn` runs one."""
        end = self.maybe_repeated(turn)
        if end is not None:
            return end
        if not orelse or not any(isinstance(part, ast.Break) for part in _parts(body)):
            return self.block(orelse, frame)
        return self.choice([lambda: self.block(orelse, frame), lambda: None])

    def maybe_repeated(self, turn: Callable[[], Completion | None]) -> Completion | None:
        """Code that runs an unknown number of times: what one run changes is not known in the
        next one."""

        def once() -> Completion | None:
            end = turn()
            return None if end is not None and end[0] == "continue" else end

        def some() -> Completion | None:
            end = self._region("loop", once)
            return end if end is not None and end[0] in ("return", "raise") else None

        for _ in range(MOST_WIDENINGS):
            made, faults = len(self.made), len(self.faults)
            orphans, opened = self.orphans, [*self.opened]
            left = [len(region.left) for region in self.regions]
            mark, start = self.heap.mark(), newest()
            self.missed.clear()
            end = self.choice([some, lambda: None])
            written = [*self.heap.since(mark)]
            lasting = Lasting(start, written)
            changed = [
                (slots, key)
                for slots, key, before, now in written
                if (before is ABSENT and (id(slots), key) in self.missed)
                or (_is_other(present(slots, key, before), now) and slots in lasting)
            ]
            if not changed:
                self.heap.release(mark)
                return end
            self.heap.undo(mark)
            self.heap.release(mark)
            del self.made[made:], self.faults[faults:]
            self.orphans, self.opened[:] = orphans, opened
            for region, count in zip(self.regions, left, strict=True):
                del region.left[count:]
            for slots, key in changed:
                self.heap.set(slots, key, UNKNOWN)
        return self.choice([some, lambda: None])

    def _with(
        self, items: Sequence[ast.withitem], body: Sequence[ast.stmt], frame: Frame
    ) -> Completion | None:
        opened = len(self.opened)
        leave: list[Value] = []
        managers = self.managers
        for item in items:
            found = self.value(item.context_expr, frame)
            container = self._opens(found)
            bound = UNKNOWN if container is None else found
            if container is not None:
                self.opened.append(container)
            elif isinstance(found, Instance):
                enter = self.of_class(found.cls, "__enter__", found)
                bound = self.call(enter, Arguments(), None, frame)
                leave.append(self.of_class(found.cls, "__exit__", found))
            else:
                self.managers += 1
            if item.optional_vars is not None:
                self.assign(item.optional_vars, bound, frame)
        end = self.block(body, frame)
        self.managers = managers
        for method in reversed(leave):
            self.call(method, Arguments((NONE, NONE, NONE)), None, frame)
        del self.opened[opened:]
        return end

    def _opens(self, value: Value) -> Value | None:
        """The container that `with` opens; None for anything else, UNKNOWN if it can be one."""
        if isinstance(value, Instance) and "$children" in value.slots:
            return value
        return UNKNOWN if isinstance(value, OneOf) else None

    def _try(self, node: ast.Try | ast.TryStar, frame: Frame) -> Completion | None:
        end = self._tried(node, frame) if node.handlers else self.block(node.body, frame)
        if not node.handlers and end is None:
            end = self.block(node.orelse, frame)
        return self.block(node.finalbody, frame) or end

    def _tried(self, node: ast.Try | ast.TryStar, frame: Frame) -> Completion | None:
        """A body whose statements can fail, each of them: the handlers may run after any."""

        def body() -> Completion | None:
            self.tries += 1
            end = self.block(node.body, frame)
            self.tries -= 1
            return end

        mark, opened = self.heap.mark(), [*self.opened]
        end, seen = self.heap.watch(body)
        # A container that an exception has left half built is not the machine that is meant.
        between = {which: change for which, change in seen.items() if change[1] != "$children"}
        at_end = self.heap.changes(mark)
        raised = end is not None and end[0] == "raise"
        states: list[Changes] = []
        if end is None:
            end = self.block(node.orelse, frame)
        if end is None:
            states.append(self.heap.changes(mark))
        elif not raised:
            self._leave(end)
        self.unsure += 1
        for handler in node.handlers:
            self.heap.undo(mark)
            self.heap.apply(at_end)
            self.heap.apply(between)
            self.opened[:] = opened
            if handler.name is not None:
                self.bind(handler.name, UNKNOWN, frame)
            left = self.block(handler.body, frame)
            if left is None:
                states.append(self.heap.changes(mark))
            elif left[0] != "raise":
                self._leave(left)
                end = left if end is None or end[0] == "raise" else end
        self.unsure -= 1
        self.heap.undo(mark)
        self.heap.join(states)
        self.heap.release(mark)
        if states:
            return None
        return end if end is None or end[0] == "raise" else _left(end)

    def _match(
        self, subject: Value, cases: Sequence[ast.match_case], frame: Frame
    ) -> Completion | None:
        branches: list[Callable[[], Completion | None]] = []

        def branch(case: ast.match_case) -> Callable[[], Completion | None]:
            def run() -> Completion | None:
                self._capture(subject, case.pattern, frame)
                if case.guard is not None:
                    self.value(case.guard, frame)
                return self.block(case.body, frame)

            return run

        for case in cases:
            found = self._fits(subject, case.pattern, frame)
            if found is False:
                continue
            branches.append(branch(case))
            if found and case.guard is None:
                break
        else:
            branches.append(lambda: None)
        return branches[0]() if len(branches) == 1 else self.choice(branches)

    def _fits(self, subject: Value, pattern: ast.pattern, frame: Frame) -> bool | None:
        match pattern:
            case ast.MatchAs(pattern=None):
                return True
            case ast.MatchValue(value=value):
                return truth(self._compare(subject, ast.Eq(), self.value(value, frame)))
            case ast.MatchOr(patterns=patterns):
                found = [self._fits(subject, part, frame) for part in patterns]
                return True if True in found else None if None in found else False
        return None

    def _capture(self, subject: Value, pattern: ast.pattern, frame: Frame) -> None:
        """Binds the names of a pattern."""
        for part in walk_code(pattern):
            name = getattr(part, "name", None) or getattr(part, "rest", None)
            if isinstance(name, str):
                self.bind(name, subject if part is pattern else UNKNOWN, frame)

    # --- names

    def bind(self, name: str, value: Value, frame: Frame) -> None:
        if name in frame.global_names:
            self.heap.set(frame.module.slots, name, value)
            return
        if name in frame.outer_names:
            outer = frame.around
            while outer is not None and (name not in outer.slots or outer.kind == "class"):
                outer = outer.around
            if outer is not None:
                self.heap.set(outer.slots, name, value)
            return
        if (
            isinstance(value, Instance)
            and "$children" in value.slots
            and "$name" not in value.slots
        ):
            self.heap.set(value.slots, "$name", Const(name))
        self.heap.set(frame.slots, name, value)

    def look_up(self, name: str, frame: Frame, node: ast.expr | None = None) -> Value:
        at: Frame | None = frame
        while at is not None:
            if name in at.slots and (at is frame or at.kind != "class"):
                found: Value = at.slots[name]
                return found
            at = at.around
        if name in frame.module.slots:
            return frame.module.slots[name]  # type: ignore[no-any-return]
        if name in BUILTINS:
            return BUILTINS[name]
        self.missed |= {(id(frame.slots), name), (id(frame.module.slots), name)}
        return self._undefined(name, node, frame)

    def _undefined(self, name: str, node: ast.expr | None, frame: Frame) -> Value:
        """The value of a name that has none. If nothing in the file can bind it, it is a fault;
        else a module that was not found can."""
        module = frame.module
        span = self.span(node, frame) if node is not None else None
        text = module.text
        if span is None or text is None:
            return UNKNOWN
        if module.bound is None:
            module.bound = bound_names(text.tree)
        if name in module.bound:
            return UNKNOWN
        for part in star_imports(text.tree):
            found = self.project.load(self, self._full_name(part, module), module)
            if isinstance(found, Unknown):
                return found
            if not isinstance(found, ModuleValue) or found.dynamic:
                return UNKNOWN
        known = name in KNOWN_NAMES or any(word in text.source.text for word in _BINDING)
        if not (known or self.tries):
            self.faults.append(UseFault("missing member", span, (name, module.file, "")))
        return UNKNOWN

    def assign(self, target: ast.expr, value: Value, frame: Frame) -> None:
        match target:
            case ast.Name(id=name):
                self.bind(name, value, frame)
            case ast.Tuple(elts=parts) | ast.List(elts=parts):
                self._unpack(parts, value, frame)
            case ast.Starred(value=inner):
                self.assign(inner, value, frame)
            case ast.Attribute(value=owner, attr=name):
                self.set_attribute(self.value(owner, frame), name, value)
            case ast.Subscript(value=owner, slice=ast.Slice() as index):
                self._set_slice(self.value(owner, frame), index, value, frame)
            case ast.Subscript(value=owner, slice=index):
                self._set_item(self.value(owner, frame), self.value(index, frame), value)

    def _unpack(self, parts: Sequence[ast.expr], value: Value, frame: Frame) -> None:
        items = sequence(value)
        star = next((i for i, p in enumerate(parts) if isinstance(p, ast.Starred)), None)
        if items is None or (star is None and len(items) != len(parts)):
            for part in parts:
                self.assign(part, UNKNOWN, frame)
            return
        if star is None:
            for part, item in zip(parts, items, strict=True):
                self.assign(part, item, frame)
            return
        after = len(parts) - star - 1
        rest = items[star : len(items) - after]
        whole = [*items[:star], self.new_list(rest), *items[len(items) - after :]]
        for part, item in zip(parts, whole, strict=False):
            self.assign(part, item, frame)

    def set_attribute(self, owner: Value, name: str, value: Value) -> None:
        for part in alternatives(owner):
            sure = not isinstance(owner, OneOf)
            match part:
                case Instance():
                    if "$children" in part.slots and name == "userdata":
                        own = isinstance(value, DictValue) and value.slots.get("$userdata")
                        if not own:
                            self.heap.set(part.slots, "$exposed", Const(True))
                            continue
                    own_name = isinstance(value, Instance) and "$children" in value.slots
                    if own_name and isinstance(value, Instance) and "$name" not in value.slots:
                        self.heap.set(value.slots, "$name", Const(name))
                    self._set_own(part, name, value if sure else UNKNOWN)
                case Class() | ModuleValue():
                    self.heap.set(part.slots, name, value if sure else UNKNOWN)
                case DictValue() if part.slots.get("$userdata"):
                    self._set_item(part, Const(name), value)

    def _set_own(self, owner: Instance, name: str, value: Value) -> None:
        """Sets an attribute of an object, with the setter of its class if it has one."""
        of_class = self.of_class(owner.cls, name, None)
        if isinstance(of_class, Function) and of_class.kind == "property":
            if of_class.setter is not None:
                self.run(of_class.setter, Arguments((owner, value)))
            return
        if isinstance(owner.cls, Class) and "__setattr__" in owner.cls.slots:
            value = UNKNOWN
        self.heap.set(owner.slots, name, value)

    def _set_item(self, owner: Value, index: Value, value: Value) -> None:
        match owner, index:
            case DictValue(), Const(value=key):
                items = owner.items
                if isinstance(items, Mapping) and len(items) < MOST_ITEMS:
                    self.heap.set(owner.slots, "items", {**items, key: (index, value)})
                    return
            case ListValue(), Const(value=int() as at):
                found = owner.items
                if isinstance(found, tuple) and -len(found) <= at < len(found):
                    at %= len(found)
                    self.heap.set(owner.slots, "items", (*found[:at], value, *found[at + 1 :]))
                    return
        for part in alternatives(owner):
            if isinstance(part, DictValue | ListValue):
                self.heap.set(part.slots, "items", UNKNOWN)

    def _delete(self, target: ast.expr, frame: Frame) -> None:
        match target:
            case ast.Name(id=name):
                self.heap.delete(frame.slots, name)
            case ast.Subscript(value=owner, slice=index):
                found, key = self.value(owner, frame), self.value(index, frame)
                match found, key:
                    case DictValue(), Const(value=known) if isinstance(found.items, Mapping):
                        rest = {k: v for k, v in found.items.items() if k != known}
                        self.heap.set(found.slots, "items", rest)
                    case ((DictValue() | ListValue()), _):
                        self.heap.set(found.slots, "items", UNKNOWN)

    def _augment(
        self, target: ast.expr, op: ast.operator, value: Value, frame: Frame, node: ast.stmt
    ) -> None:
        before = self.value(target, frame)
        if isinstance(before, ListValue) and isinstance(op, ast.Add | ast.BitOr):
            self.extend(before, value)
            return
        if isinstance(before, DictValue) and isinstance(op, ast.BitOr):
            self.update(before, value)
            return
        self.assign(target, self._operation(before, op, value, self.span(node, frame)), frame)

    def extend(self, owner: ListValue, value: Value) -> None:
        own, more = owner.items, sequence(value)
        whole: object = UNKNOWN
        if isinstance(own, tuple) and more is not None and len(own) + len(more) <= MOST_ITEMS:
            whole = (*own, *more)
        self.heap.set(owner.slots, "items", whole)

    def update(self, owner: DictValue, value: Value) -> None:
        own = owner.items
        more = value.items if isinstance(value, DictValue) else None
        whole: object = UNKNOWN
        if isinstance(own, Mapping) and isinstance(more, Mapping):
            whole = {**own, **more} if len(own) + len(more) <= MOST_ITEMS else UNKNOWN
        self.heap.set(owner.slots, "items", whole)

    # --- imports

    def _import(self, names: Sequence[ast.alias], frame: Frame) -> None:
        for alias in names:
            found = self.project.load(self, alias.name, frame.module)
            head, _, rest = alias.name.partition(".")
            if alias.asname is None and rest:
                top = self.project.load(self, head, frame.module)
                self.bind(head, top if isinstance(top, ModuleValue) else UNKNOWN, frame)
            else:
                self.bind(alias.asname or alias.name, found, frame)

    def _import_from(self, node: ast.ImportFrom, frame: Frame) -> None:
        name = self._full_name(node, frame.module)
        found = self.project.load(self, name, frame.module)
        for alias in node.names:
            if alias.name == "*":
                if isinstance(found, ModuleValue):
                    for key, value in [*found.slots.items()]:
                        if not key.startswith("_"):
                            self.bind(key, value, frame)
                if not isinstance(found, ModuleValue) or found.dynamic:
                    frame.module.dynamic = True
                continue
            self.bind(alias.asname or alias.name, self._imported(found, name, alias, frame), frame)

    def _imported(self, found: Value, module: str, alias: ast.alias, frame: Frame) -> Value:
        """A name that a module has, or a module in it."""
        name = alias.name
        if isinstance(found, ModuleValue) and name in found.slots:
            return found.slots[name]  # type: ignore[no-any-return]
        whole = f"{module}.{name}".strip(".")
        inner = self.project.load(self, whole, frame.module)
        if inner is not found and not (isinstance(inner, Unknown) and inner.reason == whole):
            return inner
        if not isinstance(found, ModuleValue):
            return found if isinstance(found, Unknown) else UNKNOWN
        span = self.span(alias, frame)
        place = Span(span.source, span.start, span.start + len(name)) if span else None
        sure = not self.unsure and (
            found.text is None or self.project.is_certain(module, frame.module)
        )
        return self._missing(found, name, place, sure=sure)

    def _full_name(self, node: ast.ImportFrom, module: ModuleValue) -> str:
        """The module of an import, which can be relative to that of the import."""
        package = module.package
        for _ in range(node.level - 1):
            package = package.rpartition(".")[0]
        name = node.module or ""
        return f"{package}.{name}".strip(".") if node.level else name

    # --- functions and classes

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef, frame: Frame) -> Value:
        found: Value = self._plain_function(node, frame)
        for decorator in reversed(node.decorator_list):
            found = self._decorated(decorator, found, frame)
        return found

    def _plain_function(
        self, node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda, frame: Frame
    ) -> Function:
        taken = node.args
        defaults = tuple(self.value(value, frame) for value in taken.defaults)
        named = {
            argument.arg: self.value(value, frame)
            for argument, value in zip(taken.kwonlyargs, taken.kw_defaults, strict=True)
            if value is not None
        }
        return Function(node, frame, defaults, named)

    def _decorated(self, decorator: ast.expr, value: Value, frame: Frame) -> Value:
        match decorator:
            case ast.Name(id="staticmethod" | "classmethod" | "property" as kind):
                if isinstance(value, Function):
                    value.kind = kind
                    return value
            case ast.Attribute(value=ast.Name(id=name), attr="setter"):
                getter = frame.slots.get(name)
                if isinstance(getter, Function) and isinstance(value, Function):
                    return replace(getter, setter=value)
                return UNKNOWN
            case ast.Attribute(attr="getter" | "deleter"):
                return UNKNOWN
        found = self.value(decorator, frame)
        if isinstance(found, Native):
            return found.run(self, Arguments((value,)), self.span(decorator, frame))
        return self.call(found, Arguments((value,)), decorator, frame)

    def _class(self, node: ast.ClassDef, frame: Frame) -> Value:
        bases = [self.value(base, frame) for base in node.bases]
        for keyword in node.keywords:
            meta = self.value(keyword.value, frame)
            if not isinstance(meta, Unknown) or meta.reason.partition(".")[0] != "abc":
                bases.append(UNKNOWN)  # a metaclass can change all
        slots: Slots = {}
        made = Class(node, frame, self._order(bases), slots)
        inner = Frame(slots, frame.module, frame, frame.function, frame.me, kind="class")
        self.block(node.body, inner)
        for value in slots.values():
            for function in (value, getattr(value, "setter", None)):
                if isinstance(function, Function) and function.owner is None:
                    function.owner = made
        found: Value = made
        for decorator in reversed(node.decorator_list):
            if _is_dataclass(decorator):
                made.is_dataclass = True
            else:
                found = self._decorated(decorator, found, frame)
        if self.is_enumeration(made):
            self._make_members(made)
        return found

    def _order(self, bases: Sequence[Value]) -> tuple[Value, ...]:
        """The classes in which Python searches a name after the class with these bases: C3, as in
        "A Monotonic Superclass Linearization for Dylan" (Barrett et al., 1996)."""
        kinds = Class | LibraryClass | Unknown
        known = [base if isinstance(base, kinds) else UNKNOWN for base in bases]
        rows = [[base, *self.classes(base)[1:]] for base in known] + [[*known]]
        if sum(map(len, rows)) > MOST_BASES:
            return (*rows[0][:MOST_BASES], UNKNOWN)
        found: list[Value] = []
        while rows := [row for row in rows if row]:
            tails = [base for row in rows for base in row[1:]]
            head = next((row[0] for row in rows if row[0] not in tails), None)
            if head is None:
                return (*found, UNKNOWN)
            found.append(head)
            rows = [row[1:] if row[0] == head else row for row in rows]
        return tuple(found)

    def is_enumeration(self, cls: Class) -> bool:
        return any(
            isinstance(base, LibraryClass) and base.name.startswith("enum.")
            for base in self.classes(cls)
        )

    def _make_members(self, cls: Class) -> None:
        texts = any(base == LibraryClass("builtins.str") or base == LibraryClass("enum.StrEnum")
                    for base in self.classes(cls))  # fmt: skip
        for name, value in [*cls.slots.items()]:
            if name.startswith("_") or isinstance(value, Function | Native):
                continue
            if texts and isinstance(value, Const):
                continue  # the member is the text
            member = Instance(cls, {"name": Const(name), "value": value})
            self.heap.set(cls.slots, name, member)

    def classes(self, cls: Value) -> list[Value]:
        """The classes in which an attribute is searched, the derived one first. A base class that
        is not known is UNKNOWN."""
        return [cls, *cls.order] if isinstance(cls, Class) else [cls]

    # --- expressions

    def span(self, node: ast.AST, frame: Frame) -> Span | None:
        text = frame.module.text
        return text.span(node) if text is not None and hasattr(node, "lineno") else None  # type: ignore[arg-type]

    def value(self, node: ast.expr, frame: Frame) -> Value:
        self._step()
        match node:
            case ast.Constant(value=known):
                is_large = isinstance(known, int) and known.bit_length() > MOST_BITS
                if is_large or not isinstance(known, float | complex | int | str | bytes | None):
                    return UNKNOWN
                return Const(known, self.span(node, frame))
            case ast.Name(id=name):
                return self.look_up(name, frame, node)
            case ast.Attribute(value=owner, attr=name):
                return self.attribute(self.value(owner, frame), name, node, frame)
            case ast.Call():
                return self._call(node, frame)
            case ast.List(elts=parts):
                return self._collection(parts, frame, node, "list")
            case ast.Set(elts=parts):
                return self._collection(parts, frame, node, "set")
            case ast.Tuple(elts=parts):
                items = self._items(parts, frame)
                return UNKNOWN if items is None else TupleValue(items, self.span(node, frame))
            case ast.Dict():
                return self._dict(node, frame)
            case ast.JoinedStr(values=parts):
                return self._formatted(parts, node, frame)
            case ast.BinOp():
                return self._sum(node, frame)
            case ast.UnaryOp(op=op, operand=operand):
                return self._unary(op, self.value(operand, frame), node, frame)
            case ast.BoolOp(op=op, values=values):
                return self._logical(isinstance(op, ast.And), values, frame)
            case ast.Compare():
                return self._comparison(node, frame)
            case ast.IfExp(test=test, body=body, orelse=orelse):
                known = self._truth(test, frame)
                if known is not None:
                    return self.value(body if known else orelse, frame)
                return self._either([body, orelse], frame)
            case ast.Subscript(value=owner, slice=index):
                return self._item(self.value(owner, frame), index, node, frame)
            case ast.Lambda():
                return self._plain_function(node, frame)
            case ast.ListComp() | ast.SetComp() | ast.GeneratorExp():
                items = self._comprehended(node.generators, node.elt, frame)
                kind = "set" if isinstance(node, ast.SetComp) else "list"
                return UNKNOWN if items is None else self.new_list(items, kind)
            case ast.DictComp():
                pair = ast.Tuple([node.key, node.value], ast.Load())
                ast.copy_location(pair, node)
                items = self._comprehended(node.generators, pair, frame)
                return self._dict_of_pairs(items)
            case ast.NamedExpr(target=target, value=inner):
                found = self.value(inner, frame)
                around = frame
                while around.kind == "comprehension" and around.around is not None:
                    around = around.around
                self.assign(target, found, around)
                return found
            case ast.Starred(value=inner):
                return self.value(inner, frame)
            case ast.Await() | ast.Yield() | ast.YieldFrom():
                if node.value is not None:
                    self.value(node.value, frame)
        return UNKNOWN

    def _either(self, nodes: Sequence[ast.expr], frame: Frame) -> Value:
        found: list[Value] = []

        def branch(node: ast.expr) -> Callable[[], None]:
            return lambda: found.append(self.value(node, frame))

        self.choice([branch(node) for node in nodes])
        return one_of(found)

    def new_list(self, items: Sequence[Value], kind: str = "list") -> ListValue:
        return ListValue({"items": tuple(items)}, None, kind)

    def new_dict(self, pairs: Mapping[Any, tuple[Value, Value]] | None = None) -> DictValue:
        return DictValue({"items": {**(pairs or {})}})

    def _items(self, parts: Sequence[ast.expr], frame: Frame) -> tuple[Value, ...] | None:
        found: list[Value] = []
        for part in parts:
            if isinstance(part, ast.Starred):
                inner = sequence(self.value(part.value, frame))
                if inner is None:
                    return None
                found.extend(inner)
            else:
                found.append(self.value(part, frame))
        return tuple(found) if len(found) <= MOST_ITEMS else None

    def _collection(
        self, parts: Sequence[ast.expr], frame: Frame, node: ast.expr, kind: str
    ) -> Value:
        items = self._items(parts, frame)
        contents = UNKNOWN if items is None else items
        return ListValue({"items": contents}, self.span(node, frame), kind)

    def _dict(self, node: ast.Dict, frame: Frame) -> Value:
        pairs: dict[Any, tuple[Value, Value]] | None = {}
        repeated: list[tuple[Const, bool]] = []
        written: set[object] = set()  # a key replaces that of a `**` dictionary on purpose
        for key, value in zip(node.keys, node.values, strict=True):
            found = self.value(value, frame)
            if key is None:
                more = found.items if isinstance(found, DictValue) else None
                pairs = (
                    {**pairs, **more} if pairs is not None and isinstance(more, Mapping) else None
                )
                continue
            name = self.value(key, frame)
            if isinstance(name, Const) and pairs is not None:
                name = Const(name.value, self.span(key, frame))  # the entry, not the constant
                if name.value in written:
                    repeated.append((name, bool(same(pairs[name.value][1], found))))
                written.add(name.value)
                pairs[name.value] = name, found
            else:
                pairs = None
        whole = UNKNOWN if pairs is None else pairs
        return DictValue({"items": whole}, self.span(node, frame), tuple(repeated))

    def _dict_of_pairs(self, items: Sequence[Value] | None) -> Value:
        pairs: dict[Any, tuple[Value, Value]] = {}
        for item in items or ():
            both = sequence(item)
            if both is None or len(both) != 2 or not isinstance(both[0], Const):
                return DictValue({"items": UNKNOWN})
            pairs[both[0].value] = both[0], both[1]
        return DictValue({"items": pairs if items is not None else UNKNOWN})

    def _comprehended(
        self, generators: Sequence[ast.comprehension], element: ast.expr, frame: Frame
    ) -> tuple[Value, ...] | None:
        """The items of a comprehension; None: not known."""
        found: list[Value] = []
        slots = OwnSlots({})
        inner = Frame(slots, frame.module, frame, frame.function, frame.me, kind="comprehension")
        is_known = True

        def visit(at: int) -> None:
            nonlocal is_known
            if at == len(generators):
                found.append(self.value(element, inner))
                return
            items = sequence(self.value(generators[at].iter, inner if at else frame))
            if items is None:
                is_known = False
                self.maybe_repeated(lambda: turn(at, UNKNOWN))
            for item in items or ():
                turn(at, item)

        def turn(at: int, item: Value) -> None:
            nonlocal is_known
            self.assign(generators[at].target, item, inner)
            for test in generators[at].ifs:
                known = truth(self.value(test, inner))
                if known is None:
                    is_known = False
                    self.choice([lambda: visit(at + 1), lambda: None])
                if not known:
                    return
            visit(at + 1)

        visit(0)
        return tuple(found) if is_known and len(found) <= MOST_ITEMS else None

    def _formatted(self, parts: Sequence[ast.expr], node: ast.expr, frame: Frame) -> Value:
        found: list[Value] = []
        for part in parts:
            if isinstance(part, ast.FormattedValue):
                value = self.value(part.value, frame)
                plain = part.format_spec is None and part.conversion == -1
                found.append(value if plain else UNKNOWN)
            else:
                found.append(self.value(part, frame))
        return self._spent(formatted(found, self.span(node, frame)))

    def _sum(self, node: ast.BinOp, frame: Frame) -> Value:
        """A sum of many terms is read in a loop: Python's own parser reads thousands."""
        chain: list[ast.BinOp] = []
        at: ast.expr = node
        while isinstance(at, ast.BinOp):
            chain.append(at)
            at = at.left
        found = self.value(at, frame)
        for term in reversed(chain):
            self._step()
            found = self._operation(
                found, term.op, self.value(term.right, frame), self.span(term, frame)
            )
        return found

    def _operation(self, left: Value, op: ast.operator, right: Value, span: Span | None) -> Value:
        if isinstance(left, OneOf) or isinstance(right, OneOf):
            return one_of(
                self._operation(a, op, b, span)
                for a in alternatives(left)
                for b in alternatives(right)
            )
        if isinstance(left, Const) and isinstance(op, ast.Mod) and isinstance(left.value, str):
            return self._spent(filled_in(left.value, right, span))
        if isinstance(left, Const) and isinstance(right, Const):
            return self._spent(calculated(left, op, right, span))
        texts = text_of(left), text_of(right)
        if isinstance(op, ast.Add) and None not in texts and Const in (type(left), type(right)):
            return formatted((left, right), span)
        own, other = sequence(left), sequence(right)
        lists = isinstance(left, ListValue | TupleValue) and isinstance(
            right, ListValue | TupleValue
        )
        if lists and isinstance(op, ast.Add) and own is not None and other is not None:
            if len(own) + len(other) > MOST_ITEMS:
                return UNKNOWN
            whole = (*own, *other)
            return TupleValue(whole, span) if isinstance(left, TupleValue) else self.new_list(whole)
        if (
            isinstance(left, DictValue)
            and isinstance(right, DictValue)
            and isinstance(op, ast.BitOr)
        ):
            joined = self.new_dict()
            self.update(joined, left)
            self.update(joined, right)
            return joined
        repeated = isinstance(left, ListValue) and isinstance(right, Const)
        if repeated and isinstance(op, ast.Mult) and own is not None and isinstance(right, Const):
            times = right.value
            if isinstance(times, int) and len(own) * max(times, 0) <= MOST_ITEMS:
                return self.new_list(own * times)
        return UNKNOWN

    def _unary(self, op: ast.unaryop, value: Value, node: ast.expr, frame: Frame) -> Value:
        if isinstance(op, ast.Not):
            known = truth(value)
            return UNKNOWN if known is None else Const(not known)
        number = value.value if isinstance(value, Const) else None
        if isinstance(op, ast.USub) and isinstance(number, int | float):
            return Const(-number, self.span(node, frame))
        return UNKNOWN

    def _logical(self, is_and: bool, values: Sequence[ast.expr], frame: Frame) -> Value:
        first = self.value(values[0], frame)
        known = truth(first)
        if len(values) == 1 or known is (not is_and):
            return first
        if known is is_and:
            return self._logical(is_and, values[1:], frame)
        rest: list[Value] = []
        self.choice([lambda: rest.append(self._logical(is_and, values[1:], frame)), lambda: None])
        return one_of([*(v for v in alternatives(first) if truth(v) is not is_and), *rest])

    def _comparison(self, node: ast.Compare, frame: Frame) -> Value:
        left = self.value(node.left, frame)
        known: bool | None = True
        for op, right_node in zip(node.ops, node.comparators, strict=True):
            right = self.value(right_node, frame)
            found = truth(self._compare(left, op, right))
            known = None if found is None or known is None else known and found
            left = right
        return UNKNOWN if known is None else Const(known)

    def _compare(self, left: Value, op: ast.cmpop, right: Value) -> Value:
        match op:
            case ast.Is() | ast.Eq() if isinstance(left, Instance) and isinstance(right, Instance):
                return Const(left is right) if self.is_member(left) else UNKNOWN
            case ast.Is() | ast.IsNot() | ast.Eq() | ast.NotEq():
                known = same(left, right)
                if isinstance(op, ast.Is | ast.IsNot) and known and _are_other_types(left, right):
                    known = False
                negated = isinstance(op, ast.IsNot | ast.NotEq)
                return UNKNOWN if known is None else Const(known is not negated)
            case ast.In() | ast.NotIn():
                if isinstance(left, Const) and isinstance(right, Const):
                    if isinstance(left.value, str) and isinstance(right.value, str):
                        inside = left.value in right.value
                        return Const(inside is not isinstance(op, ast.NotIn))
                    return UNKNOWN
                items = sequence(right)
                if items is None:
                    return UNKNOWN
                found = [same(left, item) for item in items]
                inside_ = True if True in found else None if None in found else False
                return (
                    UNKNOWN if inside_ is None else Const(inside_ is not isinstance(op, ast.NotIn))
                )
        compare = ORDERS.get(type(op))
        if compare is not None and isinstance(left, Const) and isinstance(right, Const):
            try:
                return Const(bool(compare(left.value, right.value)))
            except TypeError:
                return UNKNOWN
        return UNKNOWN

    def is_member(self, value: Instance) -> bool:
        return isinstance(value.cls, Class) and self.is_enumeration(value.cls)

    def _item(self, owner: Value, index: ast.expr, node: ast.expr, frame: Frame) -> Value:
        if isinstance(index, ast.Slice):
            return self._slice(owner, index, frame)
        return self.item(owner, self.value(index, frame))

    def item(self, owner: Value, key: Value) -> Value:
        """The item of a collection."""
        if isinstance(owner, OneOf) or isinstance(key, OneOf):
            return one_of(self.item(a, b) for a in alternatives(owner) for b in alternatives(key))
        if isinstance(owner, DictValue):
            items = owner.items
            if isinstance(items, Mapping) and isinstance(key, Const) and key.value in items:
                return items[key.value][1]
            return UNKNOWN
        if isinstance(owner, Class) and isinstance(key, Const) and isinstance(key.value, str):
            return owner.slots.get(key.value, UNKNOWN) if self.is_enumeration(owner) else UNKNOWN
        found = sequence(owner) or ()
        match key:
            case Const(value=int() as at) if -len(found) <= at < len(found):
                return found[at]
        return UNKNOWN

    def _slice(self, owner: Value, index: ast.Slice, frame: Frame) -> Value:
        bounds = self._bounds(index, frame)
        if bounds is None:
            return UNKNOWN
        match owner:
            case Const(value=str() as text, span=span):
                return Const(text[bounds], span)
            case TupleValue(items=items):
                return TupleValue(items[bounds])
            case ListValue():
                items_ = owner.items
                return self.new_list(items_[bounds]) if isinstance(items_, tuple) else UNKNOWN
        return UNKNOWN

    def _bounds(self, index: ast.Slice, frame: Frame) -> slice | None:
        """A slice; None if it is not known, or wrong."""
        bounds: list[int | None] = []
        for part in (index.lower, index.upper, index.step):
            found = self.value(part, frame) if part is not None else NONE
            if not isinstance(found, Const) or not isinstance(found.value, int | None):
                return None
            bounds.append(found.value)
        return None if bounds[2] == 0 else slice(*bounds)

    def _set_slice(self, owner: Value, index: ast.Slice, value: Value, frame: Frame) -> None:
        bounds, more = self._bounds(index, frame), sequence(value)
        for part in alternatives(owner):
            if isinstance(part, ListValue):
                whole: object = UNKNOWN
                known = part.items if part is owner else UNKNOWN
                if isinstance(known, tuple) and bounds is not None and more is not None:
                    items = [*known]
                    with contextlib.suppress(ValueError):  # an extended slice of another size
                        items[bounds] = more
                        whole = tuple(items) if len(items) <= MOST_ITEMS else UNKNOWN
                self.heap.set(part.slots, "items", whole)

    # --- attributes

    def attribute(self, owner: Value, name: str, node: ast.expr, frame: Frame) -> Value:
        """An attribute of a value; UNKNOWN if it is not known."""
        match owner:
            case OneOf(values=values):
                objects = (part for part in values if part != NONE)
                return one_of(self.attribute(part, name, node, frame) for part in objects)
            case OpenText():
                return attribute_of_value(self, owner, name)
            case Unknown():
                return owner
            case ModuleValue():
                if name in owner.slots:
                    return owner.slots[name]  # type: ignore[no-any-return]
                found = self.project.load(self, f"{owner.name}.{name}", owner)
                if isinstance(found, ModuleValue) and found is not owner:
                    return found
                span = self.span(node, frame)
                place = Span(span.source, span.end - len(name), span.end) if span else None
                return self._missing(owner, name, place)
            case Instance():
                return self._of_instance(owner, name, node, frame)
            case Class() | LibraryClass():
                if name == "__name__":
                    return Const(owner.name if isinstance(owner, Class) else owner.short)
                return self.of_class(owner, name, None)
            case Super(owner=cls, me=me):
                start = me.cls if isinstance(me, Instance) else cls
                order = self.classes(start)
                at = next((i for i, c in enumerate(order) if c is cls), -1)
                return self._search(order[at + 1 :], name, me)
        return attribute_of_value(self, owner, name)

    def _missing(
        self, owner: ModuleValue, name: str, place: Span | None, *, sure: bool = True
    ) -> Value:
        """The value of a name that a module lacks: for a module of a framework, that of the module
        that has it. It is a fault if no code can bind the name; `sure`: it is always read."""
        meant, home = self.project.misplaced(owner, name)
        if place is None or not sure or self.tries or name.startswith("__"):
            return meant
        if home or self._lacks(owner, name):
            names = (name, owner.file or owner.name, home)
            self.faults.append(UseFault("missing member", place, names))
        return meant

    def _lacks(self, owner: ModuleValue, name: str) -> bool:
        """Whether no code can bind a name of a module of the project."""
        if owner.text is None or not owner.is_loaded or owner.dynamic:
            return False
        path = PurePath(owner.file)
        generated = _GENERATED.intersection((path.stem, path.parent.name))
        if generated or name in bound_names(owner.text.tree):
            return False
        inner = self.project.load(self, f"{owner.package}.{name}".strip("."), owner)
        if owner.file.endswith("__init__.py") and not isinstance(inner, Unknown):
            return False  # any import of a module binds its name in its package
        binds = any(word in owner.text.source.text for word in _BINDING)
        return not (binds or "__getattr__" in owner.slots or self.project.may_set(name))

    def _of_instance(self, owner: Instance, name: str, node: ast.expr, frame: Frame) -> Value:
        if name in owner.slots:
            return owner.slots[name]  # type: ignore[no-any-return]
        if name == "__class__":
            return owner.cls
        found = self.of_class(owner.cls, name, owner)
        if found is UNKNOWN:
            self.missed.add((id(owner.slots), name))
        function = found.function if isinstance(found, Method) else None
        if isinstance(function, Function) and function.kind == "property":
            return self.call(function, Arguments((owner,)), node, frame)
        return found

    def of_class(self, cls: Value, name: str, me: Value | None) -> Value:
        return self._search(self.classes(cls), name, me)

    def _search(self, order: Sequence[Value], name: str, me: Value | None) -> Value:
        for cls in order:
            match cls:
                case Class():
                    if name in cls.slots:
                        found: Value = cls.slots[name]
                        return self._bound(found, me, cls)
                case LibraryClass():
                    native = self.project.method_of(cls.name, name)
                    if native is not None:
                        return native if me is None or native.is_static else Method(native, me)
                case _:
                    return UNKNOWN
        return UNKNOWN

    def _bound(self, value: Value, me: Value | None, cls: Class) -> Value:
        if not isinstance(value, Function) or value.kind == "staticmethod":
            return value
        if value.kind == "classmethod":
            return Method(value, me.cls if isinstance(me, Instance) else cls)
        return value if me is None else Method(value, me)

    # --- calls

    def arguments(self, node: ast.Call, frame: Frame) -> Arguments:
        positional: list[Value] = []
        named: list[tuple[str, Value]] = []
        is_open = False
        for part in node.args:
            if isinstance(part, ast.Starred):
                items = sequence(self.value(part.value, frame))
                is_open = is_open or items is None
            else:
                items = (self.value(part, frame),)
            if not is_open:
                positional.extend(items or ())
        for keyword in node.keywords:
            found = self.value(keyword.value, frame)
            if keyword.arg is not None:
                named.append((keyword.arg, found))
            elif isinstance(found, DictValue) and isinstance(found.items, Mapping):
                named.extend((str(key), pair[1]) for key, pair in found.items.items())
            else:
                is_open = True
        return Arguments(tuple(positional), tuple(named), is_open)

    def _call(self, node: ast.Call, frame: Frame) -> Value:
        if isinstance(node.func, ast.Name) and node.func.id == "super":
            return self._super(node, frame)
        function = self.value(node.func, frame)
        return self.call(function, self.arguments(node, frame), node, frame)

    def _super(self, node: ast.Call, frame: Frame) -> Value:
        at: Frame | None = frame
        while at is not None and (at.function is None or at.function.owner is None):
            at = at.around
        owner = at.function.owner if at is not None and at.function is not None else None
        named = isinstance(node.args[0], ast.Name) if node.args else False
        if node.args and not (named and owner is not None and node.args[0].id == owner.name):  # type: ignore[attr-defined]
            found = self.value(node.args[0], frame)
            me = self.value(node.args[1], frame) if len(node.args) > 1 else UNKNOWN
            return Super(found, me) if isinstance(found, Class) else UNKNOWN
        if at is None or at.function is None or at.function.owner is None or at.me is None:
            return UNKNOWN
        return Super(at.function.owner, at.me)

    def call(
        self, function: Value, arguments: Arguments, node: ast.expr | None, frame: Frame
    ) -> Value:
        """The result of a call."""
        self._step()
        span = self.span(node, frame) if node is not None else None
        match function:
            case OneOf(values=values):
                found: list[Value] = []

                def branch(part: Value) -> Callable[[], None]:
                    return lambda: found.append(self.call(part, arguments, node, frame))

                self.guesses += 1
                self.choice([branch(part) for part in values])
                self.guesses -= 1
                return one_of(found)
            case Native():
                signature = self.project.signature_of(function)
                if signature is not None:
                    name = function.name.partition(".")[2].removesuffix(".__init__")
                    if self._judge(name, signature, arguments, span):
                        arguments = replace(arguments, open=True)  # one of them is misspelt
                return self._spent(function.run(self, arguments, span))
            case Method(function=inner, me=me):
                return self.call(inner, arguments.with_first(me), node, frame)
            case Partial(function=inner, arguments=before):
                return self.call(inner, before.followed_by(arguments), node, frame)
            case Function():
                self._judge(_name_of(function), signature_of(function), arguments, span)
                return self.run(function, arguments, Creation(node, frame, arguments))
            case Class() | LibraryClass():
                return self.make(function, arguments, span, frame, node)
            case Instance():
                inner = self.of_class(function.cls, "__call__", function)
                if isinstance(inner, Method):
                    return self.call(inner, arguments, node, frame)
        self._escape(arguments, function)
        return function if isinstance(function, Unknown) and function.reason else UNKNOWN

    @property
    def is_certain(self) -> bool:
        """Whether an exception would end the program here."""
        return not (self.tries or self.guesses or self.unsure)

    def _judge(
        self, name: str, signature: Signature, arguments: Arguments, span: Span | None
    ) -> bool:
        """Whether Python refuses a call, which is noted."""
        found = wrong_call(signature, arguments)
        if found is not None and span is not None and self.is_certain:
            kind, names = found
            self.faults.append(UseFault(kind, span, (name, *names)))
        return found is not None

    def partial(self, function: Value, arguments: Arguments) -> Value:
        """`functools.partial`; that of another one is one with the arguments of both."""
        if isinstance(function, Partial):
            arguments = function.arguments.followed_by(arguments)
            function = function.function
        self.steps += len(arguments.positional) // 4
        return Partial(function, arguments)

    def _escape(self, arguments: Arguments, function: Value) -> None:
        """Values that unknown code gets can be changed by it."""
        if isinstance(function, Unknown) and is_pure(function.reason):
            return
        for value in (*arguments.positional, *(value for _, value in arguments.named)):
            self._lose(value)

    def _lose_in(self, arguments: Arguments, *, adds: bool) -> None:
        """Notes what a call can have changed that is not evaluated; `adds`: it can add states."""
        values = (*arguments.positional, *(value for _, value in arguments.named))
        for value in (*values, *self.opened):
            if adds or not isinstance(value, Instance):
                self._lose(value)

    def _lose(self, value: Value) -> None:
        """Notes that unknown code can have changed a value."""
        for part in alternatives(value):
            match part:
                case DictValue() | ListValue():
                    self.heap.set(part.slots, "items", UNKNOWN)
                case Instance() if isinstance(children := part.slots.get("$children"), Children):
                    self.heap.set(part.slots, "$exposed", Const(True))
                    self.heap.set(part.slots, "$children", Children(children.added, False))
                    self.sees_opened = False

    def _spent(self, value: Value) -> Value:
        """A new value, whose size counts as steps."""
        match value:
            case Const(value=str() as text):
                self.steps += len(text) // 256
            case TupleValue(items=items):
                self.steps += len(items) // 4
            case ListValue() | DictValue():
                contents = value.items
                self.steps += len(contents) // 4 if isinstance(contents, tuple | Mapping) else 0
        return value

    def run(
        self, function: Function, arguments: Arguments, made_by: Creation | None = None
    ) -> Value:
        """The result of a call of a function of the project."""
        node = function.node
        self.called.add(node)
        before = [adds for called, adds in self.calls if called is function]
        if len(self.calls) >= DEEPEST_CALL or (self.unsure and len(before) >= MOST_RECURSIVE):
            self._lose_in(arguments, adds=len(before) < 2 or self.adds > before[0])
            return UNKNOWN
        if node not in self.generators:
            self.generators[node] = isinstance(node, ast.AsyncFunctionDef) or _yields(node)
        if self.generators[node]:
            return UNKNOWN
        is_root = made_by is None or made_by.node is None
        slots = self._parameters(function, arguments, is_open=arguments.open or is_root)
        me = arguments.positional[0] if arguments.positional else None
        frame = Frame(slots, function.frame.module, function.frame, function, me, made_by=made_by)
        self.calls.append((function, self.adds))
        try:
            if isinstance(node, ast.Lambda):
                return self.value(node.body, frame)
            end = self._region("call", lambda: self.block(node.body, frame))
        finally:
            self.calls.pop()
        if end is None:
            return NONE
        return end[1] if end[0] == "return" and end[1] is not LEFT else UNKNOWN

    def _parameters(self, function: Function, arguments: Arguments, *, is_open: bool) -> Slots:
        """The values of the parameters; `is_open`: further arguments, for `*args` and `**others`,
        are not known."""
        taken = function.node.args
        positional = [*taken.posonlyargs, *taken.args]
        slots: Slots = OwnSlots({})
        given = arguments.positional
        for argument, value in zip(positional, given, strict=False):
            slots[argument.arg] = value
        named = dict(arguments.named)
        rest: dict[Any, tuple[Value, Value]] = {}
        known = {argument.arg for argument in (*taken.args, *taken.kwonlyargs)}
        for name, value in named.items():
            if name in known:
                slots[name] = value
            else:
                rest[name] = Const(name), value
        for argument, value in zip(reversed(positional), reversed(function.defaults), strict=False):
            if argument.arg not in slots:
                slots[argument.arg] = UNKNOWN if arguments.open else value
        for argument in taken.kwonlyargs:
            if argument.arg not in slots:
                default = function.keyword_defaults.get(argument.arg, UNKNOWN)
                slots[argument.arg] = UNKNOWN if arguments.open else default
        for argument in positional:
            slots.setdefault(argument.arg, UNKNOWN)
        if taken.vararg is not None:
            more = TupleValue(tuple(given[len(positional) :]))
            slots[taken.vararg.arg] = UNKNOWN if is_open else more
        if taken.kwarg is not None:
            whole = DictValue({"items": UNKNOWN}) if is_open else self.new_dict(rest)
            slots[taken.kwarg.arg] = whole
        return slots

    def make(
        self, cls: Class | LibraryClass, arguments: Arguments, span: Span | None, frame: Frame,
        node: ast.expr | None = None,
    ) -> Value:  # fmt: skip
        """A new object of a class."""
        if isinstance(cls, LibraryClass) and not self.project.is_of_framework(cls):
            return self.project.new_object(self, cls, arguments)
        if isinstance(cls, Class) and self.is_enumeration(cls):
            return self._member(cls, arguments)
        order = self.classes(cls)
        opaque = any(isinstance(base, Unknown | OneOf) for base in order)
        made = Instance(cls, {}, span, opaque, Creation(node, frame, arguments))
        if any(map(self.project.is_of_framework, order)):
            self.made.append(made)
        if isinstance(cls, Class) and cls.is_dataclass and "__init__" not in cls.slots:
            self._fill(made, cls, arguments, frame)
            return made
        if any(isinstance(base, Class) and "__new__" in base.slots for base in order):
            return UNKNOWN
        maker = self._search(order, "__init__", made)
        if isinstance(maker, Method):
            self.call(maker, arguments, node, frame)
        return made

    def _member(self, cls: Class, arguments: Arguments) -> Value:
        given = arguments.get(0, "value", UNKNOWN) or UNKNOWN
        members = (value for value in cls.slots.values() if isinstance(value, Instance))
        fitting = (member for member in members if same(member.slots.get("value", UNKNOWN), given))
        return next(fitting, UNKNOWN)

    def _fill(self, made: Instance, cls: Class, arguments: Arguments, frame: Frame) -> None:
        """Sets the fields of a dataclass."""
        at = 0
        for base in reversed(self.classes(cls)):
            if not isinstance(base, Class):
                continue
            for line in base.node.body:
                if isinstance(line, ast.AnnAssign) and isinstance(line.target, ast.Name):
                    name = line.target.id
                    default = base.slots.get(name, UNKNOWN) if line.value is not None else UNKNOWN
                    value = arguments.get(at, name, default)
                    self.heap.set(made.slots, name, value if value is not None else UNKNOWN)
                    at += 1
        after = self._search(self.classes(cls), "__post_init__", made)
        if isinstance(after, Method):
            self.call(after, Arguments(), None, frame)


_GENERATED = frozenset(["msg", "srv", "action", "cfg"])
"""Packages to which the build of a ROS package adds modules."""

_BINDING = ("globals", "exec(", "setattr", "sys.modules", "vars(", "locals(", "__dict__")
"""The words in a module that can bind names which its assignments do not show."""

LEFT: Value = Unknown(reason="left")
"""In place of the value of a completion that was noted already."""


def _left(end: Completion) -> Completion:
    return end[0], LEFT


def _is_other(before: object, now: object) -> bool:
    """Whether the next turn of a loop can find another value. Of a container, joining keeps the
    states of both."""
    if before is ABSENT or before is UNKNOWN or isinstance(before, Children):
        return False
    return now is not before and now != before


def _name_of(function: Function) -> str:
    """The name that a call contains: of a constructor, the name of its class."""
    owner = function.owner
    return owner.name if owner is not None and function.name == "__init__" else function.name


def _yields(node: ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda) -> bool:
    """Whether a function is a generator."""
    todo: list[ast.AST] = [*(node.body if isinstance(node.body, list) else [node.body])]
    while todo:
        here = todo.pop()
        if isinstance(here, ast.Yield | ast.YieldFrom):
            return True
        if not isinstance(here, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda | ast.ClassDef):
            todo.extend(ast.iter_child_nodes(here))
    return False


def _are_other_types(left: Value, right: Value) -> bool:
    """Whether two equal values are of two types, such as 1 and True."""
    values = [value.value for value in (left, right) if isinstance(value, Const)]
    return len({type(value) for value in values}) > 1


def _parts(body: Sequence[ast.stmt]) -> Iterator[ast.AST]:
    for statement in body:
        yield from walk_code(statement)


def _exits(node: ast.expr) -> bool:
    """Whether an expression ends the program."""
    if not isinstance(node, ast.Call):
        return False
    match node.func:
        case ast.Name(id="exit" | "quit"):
            return True
        case ast.Attribute(value=ast.Name(id="sys"), attr="exit"):
            return True
        case ast.Attribute(value=ast.Name(id="os"), attr="_exit"):
            return True
    return False


def _is_dataclass(decorator: ast.expr) -> bool:
    node = decorator.func if isinstance(decorator, ast.Call) else decorator
    name = node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")
    return name == "dataclass"
