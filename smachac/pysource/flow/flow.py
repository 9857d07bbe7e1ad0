"""The control flow of `execute`: returned constants, paths without an outcome, userdata accesses.

Calls of methods of the same object and of functions in modules of the user are followed. The keys
that can be set before a `return` are an upper bound: where the userdata is passed to other code,
they are not known.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable

from smachac.diagnostics.source import Span, Word
from smachac.ir.class_facts import Ending
from smachac.pysource.flow.local_values import assignment_targets, overwritten
from smachac.pysource.flow.path_ends import PathEnds
from smachac.pysource.flow.skipped_writes import Paths, SkippedWrites
from smachac.pysource.modules.constants import entries, member, table
from smachac.pysource.modules.functions import (
    METHODS,
    Access,
    access_of,
    alternatives,
    is_generator,
    is_plain,
    returns_of,
)
from smachac.pysource.modules.modules import (
    Module,
    OwnClass,
    compared,
    constant_node,
    find_function,
    source_module,
)
from smachac.pysource.modules.source import PythonText, name_span
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode
from smachac.records import dataclass, replace

NONE: frozenset[str] = frozenset()

Keys = frozenset[str] | None
"""The keys that can be set; None: not known, or code that no path reaches."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Flow:
    """The control flow of a function; for the fields see ClassFacts.

    `written` are the keys that it can set; None: not known. `passed` are the parameters that it
    returns, each with the keys that can be set before. `skipped` are the keys that a call sets only
    on some paths, each with the place that leads past the assignment. `open_end` is the place of
    the statement after which it ends without `return`, with its kind (see PathEnds.open_end);
    `in_loop` is the `return` at the end of the loop that it ends after. `name` is that of the
    function.
    """

    endings: tuple[Ending, ...] = ()
    complete: bool = False
    silent: bool = False
    always_silent: bool = False
    reads: tuple[Word, ...] = ()
    writes: tuple[Word, ...] = ()
    written: Keys = None
    passed: tuple[tuple[str, Keys], ...] = ()
    skipped: tuple[tuple[str, Word], ...] = ()
    open_end: Word | None = None
    in_loop: Word | None = None
    name: Word | None = None


class Flows:
    """The flows of the methods of a class and of functions, each analysed once."""

    def __init__(self, own: OwnClass, library: UserCode) -> None:
        self.own = own
        self.library = library
        self.assigned = own.assigned().keys()
        self.functions: dict[tuple[str, str], tuple[Module, ast.FunctionDef] | None] = {}
        self._known: dict[tuple[ast.FunctionDef, str], Flow | None] = {}

    def of(self, module: Module, function: ast.FunctionDef, userdata: str) -> Flow | None:
        """The flow of a function whose parameter `userdata` is the userdata; None inside itself."""
        key = (function, userdata)
        if key not in self._known:
            self._known[key] = None
            self._known[key] = _Reader(self, module, function, userdata).flow()
        return self._known[key]


class _Reader:
    """Analyses one function."""

    def __init__(
        self, flows: Flows, module: Module, function: ast.FunctionDef, userdata: str
    ) -> None:
        self.flows = flows
        self.module = module
        self.text = module.text
        self.function = function
        self.userdata = userdata
        self.nodes = list(walk_code(function))
        self.lost: dict[str, frozenset[ast.expr]] = {}
        self.path_ends = PathEnds(module.names, self._never_returns, self._never_exhausted)
        self.own_name = _first_argument(function)
        self.called: dict[ast.Call, Flow | None] = {}
        self.effect: dict[ast.AST, frozenset[str]] = {}
        self.endings: list[Ending] = []
        self.passed: list[tuple[str, Keys]] = []
        self.jumps: list[Keys] = []
        self.carried: dict[ast.stmt, frozenset[str]] = {}
        self.complete = True
        self.paths = SkippedWrites(
            self.path_ends, userdata, self._effects, self._skips, self._first_line
        )

    def flow(self) -> Flow:
        body = self.function.body
        returns = list(returns_of(body))
        filled = bool(self.text.fillings(self.text.span(self.function)))
        rebound = self._is_rebound()
        if not rebound:
            self._follow_calls()
        reads, writes = ((), ()) if rebound else self._accesses()
        known = not rebound and self._is_closed() and not filled
        if known and self._effects(self.function):
            self.paths.read(body)
        self._block(body, NONE)
        endings = self.endings if known else [replace(e, written=None) for e in self.endings]
        written = self._effects(self.function) if known else None
        return Flow(
            endings=tuple(endings),
            complete=self.complete and not filled,
            silent=not filled and not self.path_ends.block(body),
            always_silent=not any(returned.value is not None for returned in returns),
            reads=reads,
            writes=writes,
            written=written,
            skipped=tuple(self.paths.whole().items()),
            open_end=self._open_end() if not self.path_ends.block(body) else None,
            in_loop=self._in_loop() if not self.path_ends.block(body) else None,
            name=Word(self.function.name, name_span(self.text, self.function)),
            passed=tuple(self.passed if known else [(name, None) for name, _ in self.passed]),
        )

    def _open_end(self) -> Word | None:
        """The kind of place from which control gets to the end, and its first line."""
        kind, node = self.path_ends.open_end(self.function.body)
        match node:
            case ast.Expr(value=ast.Call(func=called)):
                found = self._target(called)
                flow = self.flows.of(found[0], found[1], "") if found is not None else None
                makes_one = flow is not None and not flow.silent
                return Word("value", self.text.span(node)) if makes_one else None
            case ast.Expr() if kind:
                return Word(kind, self.text.span(node))
        return self._first_line(kind, node) if kind else None

    def _in_loop(self) -> Word | None:
        """The `return` at the end of the body of a loop after which the function ends."""
        kind, node = self.path_ends.open_end(self.function.body)
        last = node.body[-1] if kind == "loop" and isinstance(node, ast.For | ast.While) else None
        if not isinstance(last, ast.Return):
            return None
        span = self.text.span(last)
        return Word(span.text, span)

    def _first_line(self, kind: str, node: ast.AST) -> Word:
        """The place of the first line of a statement or handler, with its kind."""
        line = getattr(node, "lineno", 1)
        start = self.text.offset(line, getattr(node, "col_offset", 0))
        source = self.text.source
        end = source.line_starts[line - 1] + len(source.line(line).rstrip())
        return Word(kind, Span(source, start, end))

    # --- userdata

    def _is_rebound(self) -> bool:
        """Whether the name of the userdata has another meaning somewhere in the function."""
        name = self.userdata
        own = [*self.function.args.posonlyargs, *self.function.args.args]
        for node in self.nodes:
            match node:
                case ast.Name(id=other, ctx=ast.Store() | ast.Del()) if other == name:
                    return True
                case ast.arg(arg=other) if other == name and node not in own:
                    return True
        return False

    def _follow_calls(self) -> None:
        """The flows of the functions that get the userdata."""
        for node in self.nodes:
            if (
                isinstance(node, ast.Call)
                and self._passes(node)
                and access_of(node, self.userdata) is None
            ):
                self.called[node] = self._call(node)

    def _passes(self, call: ast.Call) -> bool:
        given = [*call.args, *(keyword.value for keyword in call.keywords)]
        return any(isinstance(node, ast.Name) and node.id == self.userdata for node in given)

    def _call(self, call: ast.Call) -> Flow | None:
        """The flow of a call of a method or function of the user; None where it is not known."""
        found = self._target(call.func)
        if found is None:
            return None
        module, function, _ = found
        given = self._arguments(call)
        if given is None:
            return None
        names = [name for name, value in given.items()
                 if isinstance(value, ast.Name) and value.id == self.userdata]  # fmt: skip
        return self.flows.of(module, function, "".join(names)) if len(names) <= 1 else None

    def _arguments(self, call: ast.Call) -> dict[str, ast.expr] | None:
        """The arguments of a call of a method or function of the user, by parameter; None where
        they are not known."""
        found = self._target(call.func)
        if found is None:
            return None
        _, function, bound = found
        parameters = [argument.arg for argument in function.args.args][bound:]
        named = {argument.arg for argument in (*function.args.args, *function.args.kwonlyargs)}
        if function.args.posonlyargs or any(
            isinstance(argument, ast.Starred) for argument in call.args
        ):
            return None
        given = dict(zip(parameters, call.args, strict=False))
        given |= {
            keyword.arg: keyword.value
            for keyword in call.keywords
            if keyword.arg in named and keyword.arg
        }
        return given if len(given) == len(call.args) + len(call.keywords) else None

    def _target(self, called: ast.expr) -> tuple[Module, ast.FunctionDef, int] | None:
        """The method or function that a call runs, and the number of arguments it has already."""
        match called:
            case ast.Attribute(value=ast.Name(id=owner), attr=name) if owner == self.own_name:
                found = self.flows.own.method(name)
                if found is None or name in self.flows.assigned:
                    return None
                module, function = found
                match function.decorator_list:
                    case [ast.Name(id="staticmethod")]:
                        return module, function, 0
                return (module, function, 1) if is_plain(function) else None
            case ast.Name() | ast.Attribute():
                name = next(
                    (name.id for name in walk_code(called) if isinstance(name, ast.Name)), ""
                )
                found = None if self._is_local(name) else self._function(called)
                if found is not None and is_plain(found[1]):
                    return *found, 0
        return None

    def _never_returns(self, called: ast.expr) -> bool:
        """Whether a function of the user raises an exception or loops on each of its paths."""
        found = self._target(called)
        if found is None:
            return False
        module, function, _ = found
        flow = self.flows.of(module, function, "")
        return (
            flow is not None and flow.complete and not (flow.silent or flow.endings or flow.passed)
        )

    def _never_exhausted(self, called: ast.expr) -> bool:
        """Whether a function of the user is a generator that raises an exception or loops on each
        of its paths."""
        match called:
            case ast.Attribute(value=ast.Name(id=owner), attr=name) if owner == self.own_name:
                found = None if name in self.flows.assigned else self.flows.own.method(name)
            case ast.Name(id=name):
                found = None if self._is_local(name) else self._function(called)
            case _:
                return False
        if found is None:
            return False
        _, function = found
        return (
            is_generator(function)
            and not function.decorator_list
            and not any(returns_of(function.body))
            and self.path_ends.block(function.body)
        )

    def _function(self, called: ast.expr) -> tuple[Module, ast.FunctionDef] | None:
        """The function of a module that a call names, found once for each expression."""
        key = (self.module.text.source.name, ast.unparse(called))
        if key not in self.flows.functions:
            self.flows.functions[key] = find_function(self.module, called, self.flows.library)
        return self.flows.functions[key]

    def _is_local(self, name: str) -> bool:
        """Whether the function binds a name itself."""
        return any(
            (isinstance(node, ast.Name) and node.id == name and not isinstance(node.ctx, ast.Load))
            or (isinstance(node, ast.arg) and node.arg == name)
            for node in self.nodes
        )  # fmt: skip

    def _is_closed(self) -> bool:
        """Whether only this function and those it calls can write the userdata."""
        uses = sum(isinstance(node, ast.Name) and node.id == self.userdata for node in self.nodes)
        for node in self.nodes:
            match node:
                case ast.Attribute(value=ast.Name(id=name), attr=key) if name == self.userdata:
                    uses -= key == "keys" or not (key in METHODS or key.startswith("_"))
                case ast.Subscript(value=ast.Name(id=name), slice=key) if name == self.userdata:
                    known = isinstance(key, ast.Constant) or isinstance(node.ctx, ast.Load)
                    uses -= known
                case ast.Compare(ops=[ast.In() | ast.NotIn()], comparators=[ast.Name(id=name)]):
                    uses -= name == self.userdata
                case ast.Call():
                    uses -= access_of(node, self.userdata) is not None
        for flow in self.called.values():
            uses -= flow is not None and flow.written is not None
        return uses == 0

    def _effects(self, node: ast.AST) -> frozenset[str]:
        """The keys that a part of the function can set."""
        if node not in self.effect:
            found: set[str] = set()
            todo = [node]
            while todo:
                each = todo.pop()
                access = access_of(each, self.userdata)
                if access is not None and not access.read:
                    found.add(access.key)
                line = compared(each)
                meant = access_of(line.left, self.userdata) if line is not None else None
                if meant is not None:
                    found.add(meant.key)
                flow = self.called.get(each) if isinstance(each, ast.Call) else None
                found.update(flow.written or () if flow is not None else ())
                todo.extend(ast.iter_child_nodes(each))
            self.effect[node] = frozenset(found)
        return self.effect[node]

    def _skips(self, node: ast.AST) -> dict[str, Word]:
        """The keys that the called functions in an expression set only on some paths."""
        calls = [self.called.get(call) for call in walk_code(node) if isinstance(call, ast.Call)]
        return {key: place for flow in calls if flow is not None for key, place in flow.skipped}

    def _accesses(self) -> tuple[tuple[Word, ...], tuple[Word, ...]]:
        """The keys that are read and written; without keys whose presence the code tests, and
        without code in `try`."""
        reads: list[Word] = []
        writes: list[Word] = []
        tested: set[str] = set()
        tried: set[ast.AST] = set()
        for node in self.nodes:
            match node:
                case ast.Compare(left=ast.Constant(str() as word), ops=[ast.In() | ast.NotIn()]):
                    tested.add(word)
                case ast.Try(handlers=[_, *_]):
                    tried.update(inner for other in node.body for inner in walk_code(other))
        lines = [*map(compared, self.nodes)]
        compared_keys = {line.left for line in lines if line is not None}
        updated = {node.target for node in self.nodes if isinstance(node, ast.AugAssign)}
        for node in self.nodes:
            access = access_of(node, self.userdata) if node not in tried else None
            if access is None or access.key in tested:
                continue
            if node in compared_keys:
                access = replace(access, read=False)
            whole = self.text.span(access.place)
            if self.text.is_filled(whole):
                continue
            span = self._key_span(access)
            if access.read or node in updated:
                reads.append(Word(access.key, span))
            if not access.read:
                writes.append(Word(access.key, span))
        inner = [
            flow for call, flow in self.called.items() if flow is not None and call not in tried
        ]
        reads.sort(key=_start)
        writes.sort(key=_start)
        reads += [word for flow in inner for word in flow.reads if word.text not in tested]
        writes += [word for flow in inner for word in flow.writes if word.text not in tested]
        return tuple(reads), tuple(writes)

    def _key_span(self, access: Access) -> Span:
        """The place of a key: the name in `userdata.key`, the text in `userdata["key"]`."""
        if isinstance(access.place, ast.Subscript):
            return self.text.span(access.place.slice)
        whole = self.text.span(access.place)
        if isinstance(access.place, ast.Attribute):
            return Span(whole.source, whole.end - len(access.key), whole.end)
        return whole

    # --- outcomes

    def _block(self, body: Iterable[ast.stmt], before: Keys) -> Keys:
        """The keys that can be set after statements; None where control does not get there."""
        for statement in body:
            before = self._statement(statement, before)
        return before

    def _statement(self, node: ast.stmt, before: Keys) -> Keys:
        match node:
            case ast.Return():
                self._returned(node, _both(before, self._effects(node)))
                return None
            case ast.Break() | ast.Continue():
                self.jumps.append(before)
                return None
            case ast.Raise():
                return None
            case ast.If():
                head = _both(before, self._effects(node.test))
                return _either(self._block(node.body, head), self._block(node.orelse, head))
            case ast.For() | ast.AsyncFor() | ast.While():
                return self._loop(node, before)
            case ast.With() | ast.AsyncWith():
                # A context manager can suppress an exception.
                self._block(node.body, _both(before, self._all(node.items)))
                return (
                    None if self.path_ends.statement(node) else _both(before, self._effects(node))
                )
            case ast.Try():
                return self._try(node, before)
            case ast.Match():
                head = _both(before, self._effects(node.subject))
                found = [self._block(case.body, head) for case in node.cases]
                return _either(head, *found)
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                return _both(before, self._effects(node))
        return None if self.path_ends.statement(node) else _both(before, self._effects(node))

    def _loop(self, node: ast.For | ast.AsyncFor | ast.While, before: Keys) -> Keys:
        # A round can follow any other one that does not leave the function.
        head = _both(before, self._carried(node) | self._head(node))
        outer, self.jumps = self.jumps, []
        self._block(node.body, head)
        self.jumps = outer
        after = _either(head, self._block(node.orelse, head))
        return None if self.path_ends.statement(node) else after

    def _try(self, node: ast.Try, before: Keys) -> Keys:
        head = _both(before, self._all(node.finalbody))
        after = self._block(node.orelse, self._block(node.body, head))
        failed = _both(head, self._all(node.body))
        after = _either(after, *(self._block(handler.body, failed) for handler in node.handlers))
        self._block(node.finalbody, _both(failed, self._all([*node.handlers, *node.orelse])))
        return None if self.path_ends.statement(node) else after

    def _head(self, node: ast.For | ast.AsyncFor | ast.While) -> frozenset[str]:
        """The keys that the head of a loop can set."""
        parts = [node.test] if isinstance(node, ast.While) else [node.target, node.iter]
        return self._all(parts)

    def _carried(self, loop: ast.For | ast.AsyncFor | ast.While) -> frozenset[str]:
        """The keys that a round of a loop can set on paths that do not leave the function. Judged
        once for each loop: otherwise the time would double with each level of nesting."""
        if loop not in self.carried:
            kept = self.endings, self.passed, self.jumps, self.complete
            self.endings, self.passed, self.jumps = [], [], []
            end = _either(self._block(loop.body, NONE), *self.jumps)
            self.endings, self.passed, self.jumps, self.complete = kept
            self.carried[loop] = end or NONE
        return self.carried[loop]

    def _all(self, parts: Iterable[ast.AST]) -> frozenset[str]:
        return NONE.union(*map(self._effects, parts))

    def _returned(self, node: ast.Return, before: Keys) -> None:
        if node.value is None:
            self.endings.append(Ending(outcome=Word("None", self.text.span(node)), written=before))
            return
        first = len(self.endings)
        for value in alternatives(node.value):
            if not self._constants(value, before):
                self.complete = False
        self._skipped(node, first)

    def _skipped(self, node: ast.Return, first: int) -> None:
        """Adds the skipped keys before a `return` to its ending, from the index `first`. With
        several endings, a condition decides, which can depend on what was skipped."""
        paths = self.paths.returns.get(node, Paths())
        stored = isinstance(node.value, ast.Name) and self._is_local(node.value.id)
        for index, ending in enumerate(self.endings[first:], first):
            skips = dict(ending.skipped)
            if len(self.endings) - first == 1 and not stored:
                skips |= paths.skipped
            left = tuple((key, place) for key, place in skips.items() if key not in paths.sure)
            self.endings[index] = replace(ending, skipped=left)

    def _constants(self, value: ast.expr, before: Keys) -> bool:
        """Adds the endings with the values of an expression; False if it can have others."""
        span = self.text.span(value)
        if self.text.is_filled(span):
            return False
        match value:
            case ast.Constant(value=found):
                return self._add(found if isinstance(found, str) else repr(found), span, before)
            case ast.Name(id=name):
                return self._named(name, span, before)
            case ast.Attribute(value=ast.Name(id=owner), attr=name) if owner == self.own_name:
                return name not in self.flows.assigned and self._of_class(name, span, before)
            case ast.Attribute(value=ast.Name(id=owner), attr=name):
                return not self._is_local(owner) and self._member(owner, name, span, before)
            case ast.Attribute(
                value=ast.Attribute(value=ast.Name(id=owner), attr=name), attr="value"
            ) if not self._is_local(owner):
                one = member(self.module, owner, name, self.flows.library)
                return one is not None and self._add(one.value or one.text, span, before)
            case ast.Subscript(value=kept, slice=key):
                return self._entries(kept, key, before)
            case ast.Call(func=ast.Attribute(value=kept, attr="get"), args=[key, default]):
                return self._entries(kept, key, before) and self._constants(default, before)
            case ast.Call():
                return self._results(value, before)
            case _ if _is_no_text(value):
                return self._add(ast.unparse(value), span, before)
        return False

    def _add(self, text: str | None, span: Span, before: Keys, defined: Span | None = None) -> bool:
        """Adds the ending with a constant, if it is known."""
        if text is not None:
            ending = Ending(outcome=Word(text, span), written=before, defined=defined)
            self.endings.append(ending)
        return text is not None

    def _of_class(self, name: str, span: Span, before: Keys) -> bool:
        """As `_constants` for a constant of the class, `self.FOUND`."""
        own = self.flows.own
        for (module, _), names in zip(own.classes, own.names, strict=True):
            if name in names:
                return self._defined(module.text, constant_node(names, name), span, before)
        return False

    def _defined(
        self, text: PythonText, node: ast.Constant | None, span: Span, before: Keys
    ) -> bool:
        """Adds the ending with a constant that has a name, if it is known."""
        if node is None:
            return False
        return self._add(str(node.value), span, before, text.span(node))

    def _member(self, owner: str, name: str, span: Span, before: Keys) -> bool:
        """As `_constants` for a constant of a class, `Result.GOOD`. A member of an enumeration is
        not equal to its value."""
        found = member(self.module, owner, name, self.flows.library)
        if found is None or found.text is not None:
            return found is not None and self._add(found.text, span, before)
        meant = f"{owner}.{name}.value" if found.value is not None else None
        word = Word(f"{owner}.{name}", span)
        self.endings.append(Ending(outcome=word, written=before, meant=meant))
        return True

    def _entries(self, kept: ast.expr, key: ast.expr, before: Keys) -> bool:
        """As `_constants` for an item of a dictionary. Which one, is known for a constant key."""
        values = None
        match kept:
            case ast.Dict():
                values = entries(kept, key)
            case ast.Name(id=name) if not self._is_local(name):
                found = table(self.module, name)
                values = entries(found, key) if found is not None else None
        if values is None:
            return False
        certain = isinstance(key, ast.Constant)
        first = len(self.endings)
        known = [self._constants(one, before) for value in values for one in alternatives(value)]
        if not certain:
            self.endings[first:] = [
                replace(ending, written=None, possible=True) for ending in self.endings[first:]
            ]
        return all(known)

    def _named(self, name: str, span: Span, before: Keys) -> bool:
        """As `_constants` for a local variable that has only constants, or a constant of the
        module."""
        stores = [node for node in self.nodes if isinstance(node, ast.Name) and node.id == name
                  and not isinstance(node.ctx, ast.Load)]  # fmt: skip
        if not stores and self._is_passed(name):
            self.passed.append((name, before))
            return True
        other = any(isinstance(node, ast.arg) and node.arg == name for node in self.nodes)
        other = other or any(isinstance(node, ast.Global | ast.Nonlocal) for node in self.nodes)
        if other:
            return False
        if not stores:
            imported = self._imported(name)
            if imported is not None:
                return self._add(imported, span, before)
            return self._defined(self.text, constant_node(self.module.names, name), span, before)
        if name not in self.lost:
            self.lost[name] = overwritten(self.nodes, name)
        lost = self.lost[name]
        if lost and any(isinstance(node, ast.Try | ast.TryStar) for node in self.nodes):
            return False  # a handler can see a value that is overwritten
        stores = [node for node in stores if node not in lost]
        given = [(assignment_targets(node), node.value) for node in self.nodes
                 if isinstance(node, ast.Assign | ast.AnnAssign)]  # fmt: skip
        values = [value for targets, value in given for target in targets if target in stores]
        match values:
            case [ast.Call() as call] if len(stores) == 1 and not self._is_examined(name):
                return self._results(call, before)
        found = [one for value in values if value is not None for one in alternatives(value)]
        texts = [isinstance(node, ast.Constant) and isinstance(node.value, str) for node in found]
        if len(values) != len(stores) or None in values or not all(texts):
            return False
        for node in found:
            self._constants(node, before)
        return True

    def _imported(self, name: str) -> str | None:
        """The text of a constant that the module imports from a library."""
        match self.module.names.get(name, ()):
            case (ast.ImportFrom() as node,):
                own = next(part.name for part in node.names if (part.asname or part.name) == name)
                return self.flows.library.constant(source_module(self.module, node), own)
        return None

    def _is_passed(self, name: str) -> bool:
        """Whether a name is a parameter of the function that no condition of it examines."""
        given = self.function.args
        own = [argument.arg for argument in (*given.args, *given.kwonlyargs)]
        every = [node.arg for node in self.nodes if isinstance(node, ast.arg)]
        if own.count(name) != 1 or every.count(name) != 1 or name in (self.own_name, self.userdata):
            return False
        return not self._is_examined(name)

    def _is_examined(self, name: str) -> bool:
        """Whether a condition or a look-up of the function depends on a name."""
        tests: list[ast.AST] = []
        for node in self.nodes:
            match node:
                case ast.If(test=test) | ast.While(test=test) | ast.IfExp(test=test):
                    tests.append(test)
                case ast.Match(subject=test) | ast.Assert(test=test):
                    tests.append(test)
                case ast.Compare() | ast.BoolOp() | ast.comprehension() | ast.Subscript():
                    tests.append(node)
                case ast.Call(func=ast.Attribute(attr="get" | "pop")):
                    tests.append(node)
        names = (name for test in tests for name in walk_code(test) if isinstance(name, ast.Name))
        return any(word.id == name for word in names)

    def _results(self, call: ast.Call, before: Keys) -> bool:
        """As `_constants` for what a method or function of the user returns."""
        flow = self.called.get(call) if call in self.called else self._call(call)
        if flow is None:
            return False
        for ending in flow.endings:
            written = ending.written if call in self.called else NONE
            known = None if written is None else _both(before, written)
            self.endings.append(replace(ending, written=known))
        if flow.silent and flow.name is not None:
            none = Word("None", flow.name.span)
            sometimes = not flow.always_silent
            self.endings.append(Ending(outcome=none, possible=sometimes, silent=flow.name.text))
        given = self._arguments(call) or {}
        complete = flow.complete and not flow.silent
        for name, written in flow.passed:
            value = given.get(name)
            set_before = (written or NONE) if call in self.called else NONE
            known = None if written is None else _both(before, set_before)
            values = [] if value is None else [*alternatives(value)]
            certain = [self._constants(value, known) for value in values]
            complete = complete and certain != [] and all(certain)
        return complete


def _is_no_text(value: ast.expr) -> bool:
    """Whether an expression is a collection or a number, whatever its parts are."""
    if isinstance(value, ast.UnaryOp):
        value = value.operand
        return isinstance(value, ast.Constant) and isinstance(value.value, int | float)
    collections = ast.Tuple | ast.List | ast.Dict | ast.Set
    return isinstance(value, collections | ast.ListComp | ast.DictComp | ast.SetComp)


def _start(word: Word) -> int:
    return word.span.start


def _first_argument(function: ast.FunctionDef) -> str:
    names = [*function.args.posonlyargs, *function.args.args]
    return names[0].arg if names else ""


def _both(some: Keys, more: Keys) -> Keys:
    return None if some is None else some | (more or NONE)


def _either(*several: Keys) -> Keys:
    reached = [frozenset_ for frozenset_ in several if frozenset_ is not None]
    return NONE.union(*reached) if reached else None
