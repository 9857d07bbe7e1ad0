"""How the code makes the states of a machine: the class of each and the arguments, as data.

What YAML cannot hold is code, in which names of the user's modules are attributes of them
(`parcels.LIMITS`). A value that is not known has the text of its code only.
"""

from __future__ import annotations

import ast
import builtins
import copy
import itertools
import math
import re
from collections.abc import Hashable, Iterator, Mapping
from pathlib import PurePath
from typing import TypeAlias

from smachac.diagnostics.source import Span
from smachac.ir.nodes import Concurrence, Data, Expression, Leaf, Node, Struct
from smachac.ir.nodes import Iterator as IteratorNode
from smachac.ir.python_code import parse_code
from smachac.ir.traversal import outcome_names, written_children
from smachac.pysource.machines.dead_code import contains
from smachac.pysource.machines.evaluator import BudgetError, Evaluator
from smachac.pysource.machines.framework import Call, noted_of, userdata_of
from smachac.pysource.machines.graph import Graph
from smachac.pysource.machines.libraries import parameters_of
from smachac.pysource.machines.origins import Origins
from smachac.pysource.machines.project import Repository
from smachac.pysource.machines.smach_library import SMACH, takes_node
from smachac.pysource.machines.values import (
    Adjustable,
    Arguments,
    Class,
    Const,
    DictValue,
    Frame,
    Function,
    Instance,
    ListValue,
    Method,
    ModuleValue,
    TupleValue,
    Unknown,
    Value,
    sequence,
    truth,
)
from smachac.pysource.modules.source import PythonText
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.records import dataclass, field, replace

_FUNCTIONS = ("cb", "callback", "handler")
"""How the names of parameters end that take a function."""

MOST_COMBINATIONS = 256
"""The most combinations of outcomes for which a callback of a concurrence is evaluated."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Argument:
    """An argument of a call. `name` is empty for one that only has a place. `data` is its value,
    with code where YAML has no such value; None with `is_known` False: not known, `text` is its
    code. `has_default`: `data` is its value if nobody changes it. `parameter`: the parameter of the
    container class around it whose value it is. `modules`
    are those that code in it names. `source` identifies a value that is not known, `word` is a
    name for it."""

    name: str
    data: Data
    text: str = ""
    is_known: bool = True
    has_default: bool = False
    parameter: str = ""
    modules: tuple[str, ...] = ()
    source: Hashable = None
    word: str = ""
    span: Span = field(compare=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class ClassPlace:
    """A class, or something else that code can import: its module and its name."""

    module: str
    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Construction:
    """How a state is made. `cls` is its class; None if no other module can import it, for the
    reason `obstacle`. `library` is the name of a class of SMACH that the code uses itself, `short`
    a name for the state type. `types` are the types of ROS in the arguments, by the parameter:
    `std_srvs/SetBool`. `file` has the class, `cls_span` is its place, `doc` the first line of its
    docstring. `node`: the first argument was the node of ROS 2. `parameters` are the values for a
    class that is to be written, where there is an `obstacle`. `code` is the key of the class in the
    `code` of an interface. `calls` is the code of calls that change the state before it runs.
    `refusal`: why no script can have such a state."""

    span: Span
    cls: ClassPlace | None = None
    library: str = ""
    short: str = ""
    obstacle: str = ""
    arguments: tuple[Argument, ...] = ()
    parameters: tuple[Argument, ...] = ()
    types: Mapping[str, str] = field(default_factory=dict)
    file: str = ""
    doc: str = ""
    node: bool = False
    code: str = "python"
    calls: tuple[str, ...] = ()
    refusal: str = ""
    cls_span: Span | None = field(default=None, compare=False)


Names: TypeAlias = "tuple[str, ...]"
"""The names that lead to a state, with that of the machine."""

Outcomes: TypeAlias = "tuple[tuple[str, str], ...]"
"""The outcomes of the states of a concurrence, by state."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Callbacks:
    """What the callbacks of a concurrence do. `decided` are the outcomes that `outcome_cb` selects,
    by those of the states; None: not known. `lost` are callbacks whose results are not known."""

    decided: Mapping[Outcomes, str] | None = None
    lost: tuple[tuple[str, Span], ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Constructions:
    """The constructions of the states of a machine, the values that their userdata has first, the
    items of iterators, and the callbacks of concurrences, each by the path of names. `noted` are
    the calls that have an effect which is no part of a graph, by their names, `shared` the paths of
    states that are one object with the state of an earlier path, and their places. `modules` are
    those that the classes and the code need, each with the folder in which Python has to search
    it. `ros` is the version of ROS of the programs; 0: none. `one_rule`, `write_through`
    and `same_name_exits` are those of the framework."""

    states: Mapping[Names, Construction]
    userdata: Mapping[Names, tuple[Argument, ...]]
    items: Mapping[Names, Argument]
    callbacks: Mapping[Names, Callbacks]
    noted: tuple[tuple[str, Span], ...]
    shared: tuple[tuple[Names, Names, Span], ...]
    modules: Mapping[str, str]
    ros: int = 0
    one_rule: bool = False
    write_through: bool = False
    same_name_exits: bool = True


def constructions(graph: Graph, evaluator: Evaluator, repository: Repository) -> Constructions:
    """The constructions of a machine, as long as its objects are as the code has left them."""
    return _Reader(graph, evaluator, repository).read()


class _Reader:
    def __init__(self, graph: Graph, evaluator: Evaluator, repository: Repository) -> None:
        self.graph = graph
        self.evaluator = evaluator
        self.repository = repository
        self.modules: dict[str, str] = {}
        self.origins = Origins()
        self.names: Names = ()

    def read(self) -> Constructions:
        states: dict[Names, Construction] = {}
        userdata: dict[Names, tuple[Argument, ...]] = {}
        items: dict[Names, Argument] = {}
        callbacks: dict[Names, Callbacks] = {}
        noted: list[tuple[str, Span]] = []
        for names, node in with_names(self.graph.machine.root):
            self.names = names
            made = self.graph.objects.get(names)
            around = self._class_around(names[:-1])
            if isinstance(node, Leaf):
                if not node.synthetic:
                    state = self._of_framework(made, self._state(made, node.span, around))
                    calls = [(call, _call_code(call)) for call in self._calls(made)]
                    written = [] if state.obstacle else [code for _, code in calls if code]
                    states[names] = replace(state, calls=tuple(written))
                    noted += [(call.name, call.span or node.span) for call, code in calls
                              if code not in written]  # fmt: skip
                continue
            if made is None:
                continue
            if isinstance(made.cls, Class):
                states[names] = self._of_framework(made, self._state(made, node.span, around))
            elif isinstance(behavior := made.slots.get("$behavior"), Instance):
                states[names] = self._of_framework(made, self._of_behavior(behavior, node.span))
            inside = made if isinstance(made.cls, Class) else around
            noted += [(call.name, call.span or node.span) for call in noted_of(made)]
            defaults = made.slots.get("$defaults")
            if defaults is not None and "$blackboard" not in made.slots:
                noted.append(("add_input_key", getattr(defaults, "span", None) or node.span))
            userdata[names] = tuple(self._userdata(made, inside))
            if isinstance(node, IteratorNode):
                items[names] = self._items(made, inside, node.items_span)
            if isinstance(node, Concurrence):
                callbacks[names] = self._callbacks(node, made)
        return Constructions(
            states=states, userdata=userdata, items=items, callbacks=callbacks,
            noted=tuple(dict.fromkeys(noted)), shared=tuple(self._shared()),
            modules=dict(sorted(self.modules.items())), one_rule=self.graph.framework.one_rule,
            write_through=self.graph.framework.write_through,
            same_name_exits=self.graph.framework.same_name_exits,
            ros=self.graph.framework.ros or self._ros(states),
        )  # fmt: skip

    def _of_framework(self, made: Instance | None, found: Construction) -> Construction:
        """A construction with what the framework of the machine states of its class."""
        framework = self.graph.framework
        classes = self.evaluator.classes(made.cls) if made is not None else []
        refusals = (framework.parts.get(getattr(cls, "name", "")) for cls in classes)
        refusal = next((text for text in refusals if text is not None), "")
        return replace(found, code=framework.code, refusal=refusal)

    def _calls(self, made: Instance | None) -> list[Call]:
        """The calls that are noted for a state, without those in the code of its class, which the
        programs make too."""
        if made is None:
            return []
        own = [self.evaluator.span(cls.node, cls.frame)
               for cls in self.evaluator.classes(made.cls) if isinstance(cls, Class)]  # fmt: skip
        return [
            call for call in noted_of(made)
            if call.span is None or not any(contains(outer, call.span) for outer in own if outer)
        ]  # fmt: skip

    def _shared(self) -> Iterator[tuple[Names, Names, Span]]:
        """The states that are one object, without those in a container that is."""
        first: dict[Instance, Names] = {}
        found: set[Names] = set()
        for names, node in with_names(self.graph.machine.root):
            made = self.graph.objects.get(names)
            if made is None or names[:-1] in found:
                found |= {names} if names[:-1] in found else set()
                continue
            if first.setdefault(made, names) != names:
                found.add(names)
                yield first[made], names, node.span

    def _ros(self, states: Mapping[Names, Construction]) -> int:
        """The version of ROS: that of the client library which the code imports."""
        file = self.graph.machine.root.span.source.name
        sources = (self.repository.read(name) for name in self.repository.files_of(file))
        texts = [source.text for source in sources if source is not None]
        for version, module in ((2, "rclpy"), (1, "rospy")):
            pattern = re.compile(rf"^\s*(?:import|from) {module}\b", re.MULTILINE)
            if any(map(pattern.search, texts)):
                return version
        return int(any(found.library.startswith("smach_ros.") for found in states.values()))

    def _class_around(self, names: Names) -> Instance | None:
        """The innermost container of a class of the user that has the state of a path."""
        for end in range(len(names), 0, -1):
            made = self.graph.objects.get(names[:end])
            if made is not None and isinstance(made.cls, Class):
                return made
        return None

    # --- states

    def _state(self, made: Instance | None, span: Span, around: Instance | None) -> Construction:
        if made is None:
            return self._unknown_state(span)
        if made.made_by is None:
            return Construction(span=span, obstacle="its class is not known")
        if isinstance(made.cls, Class):
            return self._of_class(made, made.cls, span, around)
        found = self._arguments(made, around)
        module = self.graph.framework.places.get(made.cls.name)
        if module is not None:
            place = ClassPlace(module=module, name=made.cls.short)
            return Construction(span=span, cls=place, short=place.name, arguments=found)
        named = {argument.name: argument for argument in found}
        node = "node" in named and self.graph.framework is SMACH
        if node:
            found = tuple(argument for argument in found if argument.name != "node")
        callback = next((argument for argument in found if argument.name.endswith(_FUNCTIONS)
                         and not argument.is_known), None)  # fmt: skip
        obstacle = "" if callback is None else _no_import(callback.text)
        short = _short(named.get("cb") or named.get("callback"), made.cls.short)
        return Construction(
            span=span, library=made.cls.name, short=short,
            arguments=found, obstacle=obstacle, types=self._types(made), node=node,
        )  # fmt: skip

    def _of_class(
        self, made: Instance, cls: Class, span: Span, around: Instance | None
    ) -> Construction:
        file = cls.frame.module.file
        place, obstacle = self._class_place(cls)
        if made.made_by is not None and made.made_by.arguments.open:
            place, obstacle = None, "the arguments of its constructor are not known"
        return Construction(
            span=span, cls=place, short=cls.name, obstacle=obstacle,
            arguments=self._arguments(made, around), file=file,
            cls_span=self.evaluator.span(cls.node, cls.frame),
            doc=(ast.get_docstring(cls.node) or "").strip().partition("\n")[0].strip(),
        )  # fmt: skip

    def _of_behavior(self, behavior: Instance, span: Span) -> Construction:
        """The construction of the machine of another behavior, without arguments: those of its
        class are values of the states."""
        name = behavior.cls.name if isinstance(behavior.cls, Class) else behavior.cls.short
        return Construction(span=span, short=name)

    def _class_place(self, cls: Class) -> tuple[ClassPlace | None, str]:
        """The place from which a class can be imported; None with the reason."""
        module = cls.frame.module
        name, folder, obstacle = self._module_place(module.file)
        if obstacle:
            return None, obstacle
        if not self._has(module, cls.name, cls.node):
            return None, f"`{cls.name}` is no class at the top of its module"
        self.modules[name] = folder
        return ClassPlace(module=name, name=cls.name), ""

    def _module_place(self, file: str) -> tuple[str, str, str]:
        """The name of a module, the folder in which it is searched, and why it cannot be
        imported."""
        path = PurePath(file)
        parts = [] if path.name == "__init__.py" else [path.stem]
        folder = path.parent
        while self.repository.has(str(folder / "__init__.py")) and folder.name:
            parts.insert(0, folder.name)
            folder = folder.parent
        wrong = [part for part in parts if not part.isidentifier()]
        if wrong or not parts:
            return "", "", f"`{path.name}` is no name for a module: rename the file"
        return ".".join(parts), str(folder), ""

    def _has(self, module: ModuleValue, name: str, node: ast.AST | None) -> bool:
        """Whether a module has a name when another one imports it; that of a definition, if it is
        given."""
        loaded: Value = module
        if module.name == "__main__":
            try:
                loaded = self.repository.module(self.evaluator, module.file)
            except (BudgetError, RecursionError):
                return False
        found = loaded.slots.get(name) if isinstance(loaded, ModuleValue) else None
        if node is None:
            return found is not None
        own = getattr(found, "node", None)
        return own is not None and own.lineno == getattr(node, "lineno", None)

    def _unknown_state(self, span: Span) -> Construction:
        """A state of a class that is not known: what its code shows of it."""
        text = self._text_of(span)
        made = _object_at(text, span) if text is not None else None
        if not isinstance(made, ast.Call) or text is None:
            return Construction(span=span, obstacle="its class is not known")
        place = _imported(text.tree, made.func)
        if place is None or any(isinstance(part, ast.Starred) for part in made.args):
            return Construction(span=span, obstacle="its class is not known")
        given = [("", part) for part in made.args]
        given += [(keyword.arg or "", keyword.value) for keyword in made.keywords]
        arguments = tuple(_literal(name, part, text.span(part)) for name, part in given)
        return Construction(span=span, cls=place, short=place.name, arguments=arguments)

    def _text_of(self, span: Span) -> PythonText | None:
        for module in self.repository.loaded.values():
            text = module.text if isinstance(module, ModuleValue) else None
            if text is not None and text.source is span.source:
                return text
        return None

    # --- arguments

    def _arguments(self, made: Instance, around: Instance | None) -> tuple[Argument, ...]:
        """The arguments of the call that made an object."""
        assert made.made_by is not None
        _, frame, given = made.made_by
        names = self._parameters(made)
        if takes_node(made.cls, given):
            names = ["node", *names]
        place = made.span or self.graph.machine.root.span
        found = []
        written = _written(made)
        if len(given.positional) > len(names):  # `*arguments` takes some of them
            names = [""] * len(given.positional)
        for at, value in enumerate(given.positional):
            name = names[at]
            found.append(self._argument(name, value, written.get(at), frame, around, place))
        for key, value in given.named:
            found.append(self._argument(key, value, written.get(key), frame, around, place))
        return tuple(found)

    def _parameters(self, made: Instance) -> list[str]:
        """The names of the parameters of a constructor that a call can name."""
        maker = self._maker(made)
        if isinstance(maker, Function):
            taken = maker.node.args
            return [] if taken.posonlyargs else [part.arg for part in taken.args[1:]]
        bases = self.evaluator.classes(made.cls)
        return next((names for base in bases if (names := parameters_of(base))), [])

    def _maker(self, made: Instance) -> Function | None:
        for base in self.evaluator.classes(made.cls):
            maker = base.slots.get("__init__") if isinstance(base, Class) else None
            if isinstance(maker, Function):
                return maker
        return None

    def _argument(
        self, name: str, value: Value, node: ast.expr | None, frame: Frame,
        around: Instance | None, place: Span,
    ) -> Argument:  # fmt: skip
        span = self.evaluator.span(node, frame) if node is not None else None
        span = span or place
        text = ast.unparse(node) if node is not None else name
        parameter = self._parameter(value, node, frame, around)
        data = _plain(value, span)
        code = self._code(value, node, frame) if data is UNWRITTEN else None
        found = _with_default(_argument(name, data, code, text, parameter, span), value)
        if found.is_known or found.has_default:
            return found
        if node is None:
            return replace(found, source=(span, name), word=name)
        source, first = self.origins.source(node, frame, (self.names, name))
        word = getattr(first, "id", "") or getattr(first, "attr", "") or name
        return replace(found, source=source, word=word)

    def _parameter(
        self, value: Value, node: ast.expr | None, frame: Frame, around: Instance | None
    ) -> str:
        """The parameter of the constructor of a container that an argument is."""
        if node is None or around is None or around.made_by is None:
            return ""
        maker = self._maker(around)
        bound = self._bound(around)
        for here in self.origins.of(node, frame):
            found = self.origins.parameter(here)
            if found is not None and found.me is around and found.function is maker:
                return found.name if bound.get(found.name) is value else ""
        return ""

    def _bound(self, made: Instance) -> dict[str, Value]:
        """The arguments of a constructor that have a name."""
        if made.made_by is None:
            return {}
        given = made.made_by.arguments
        names = self._parameters(made)
        return dict(zip(names, given.positional, strict=False)) | dict(given.named)

    def _code(
        self, value: Value, node: ast.expr | None, frame: Frame
    ) -> tuple[str, tuple[str, ...]] | None:
        """Code for a value that works in another module, and the modules in it; None: there is
        none."""
        if isinstance(value, Function | Class) and value.frame.module.text is not None:
            name, folder, obstacle = self._module_place(value.frame.module.file)
            if not obstacle and self._has(value.frame.module, value.name, value.node):
                self.modules[name] = folder
                return f"{name}.{value.name}", (name,)
        if node is None:
            return None
        copied = copy.deepcopy(node)
        names = _Names(self, frame)
        found = names.visit(copied)
        return None if names.is_local else (ast.unparse(found), tuple(sorted(names.modules)))

    def imported(self, name: str, frame: Frame) -> ClassPlace | None:
        """How code in another module gets what a name means; a place without a module for names
        of Python, and None if there is none. Of a module the name is empty."""
        at: Frame | None = frame
        module = frame.module
        while at is not None and at.slots is not module.slots:
            if name in at.slots:
                return None
            at = at.around
        if name not in module.slots:
            return ClassPlace(module="", name=name) if hasattr(builtins, name) else None
        value: Value = module.slots[name]
        owner, word, node = module, name, None
        match value:
            case Class() | Function() if value.frame.module.slots.get(value.name) is value:
                owner, word, node = value.frame.module, value.name, value.node
            case ModuleValue(text=PythonText()):
                owner, word = value, ""
        found, folder, obstacle = self._module_place(owner.file)
        if obstacle or (word and not self._has(owner, word, node)):
            return None
        self.modules[found] = folder
        return ClassPlace(module=found, name=word)

    def _types(self, made: Instance) -> Mapping[str, str]:
        """The types of ROS in the arguments, by the parameter: `std_srvs/SetBool`."""
        assert made.made_by is not None
        written = _written(made)
        names = self._parameters(made)
        if takes_node(made.cls, made.made_by.arguments):
            names = ["node", *names]
        given = made.made_by.arguments
        values: list[tuple[int | str, Value]] = [*enumerate(given.positional), *given.named]
        found = {}
        for at, value in values:
            match value, written.get(at):
                case Unknown(reason=reason), ast.Name(id=word) | ast.Attribute(attr=word) if reason:
                    package = reason.partition(".")[0]
                    name = names[at] if isinstance(at, int) and at < len(names) else str(at)
                    found[name] = f"{package}/{word}"
        return found

    # --- containers

    def _userdata(self, made: Instance, around: Instance | None) -> Iterator[Argument]:
        """The userdata that a container has before it starts."""
        value = userdata_of(made)
        pairs = value.items if isinstance(value, DictValue) else {}
        place = made.span or self.graph.machine.root.span
        for key, part in pairs.values() if isinstance(pairs, Mapping) else ():
            if isinstance(key, Const) and isinstance(key.value, str):
                span = getattr(part, "span", None) or place
                yield self._without_code(key.value, part, span, around)

    def _without_code(
        self, name: str, value: Value, span: Span, around: Instance | None
    ) -> Argument:
        """A value that is no argument of a call; of a container class it can be one of its
        constructor."""
        data, code = _plain(value, span), None
        if data is UNWRITTEN and isinstance(value, Function | Class):
            code = self._code(value, None, value.frame)
        bound = self._bound(around) if around is not None else {}
        parameter = next((word for word, part in bound.items() if part is value), "")
        found = _with_default(_argument(name, data, code, name, parameter, span), value)
        is_named = found.is_known or found.has_default
        return found if is_named else replace(found, source=(span, name), word=name)

    def _items(self, made: Instance, around: Instance | None, span: Span) -> Argument:
        """The items of an iterator; those that a function without parameters returns."""
        value = made.slots.get("$it") or Unknown()
        if isinstance(value, Function | Method):
            value = self.evaluator.tried(value, Arguments()) or Unknown()
        items = sequence(value)
        if items is not None and not (isinstance(value, ListValue) and value.kind == "list"):
            value = ListValue({"items": items})
        return self._without_code("it", value, span, around)

    def _callbacks(self, node: Concurrence, made: Instance) -> Callbacks:
        lost: list[tuple[str, Span]] = []
        ending = made.slots.get("$child_termination_cb")
        if ending is not None and not _is_nothing(ending):
            found = self.evaluator.tried(ending, Arguments((Unknown(),)))
            if found is None or truth(found) is None:
                lost.append(("child_termination_cb", made.span or node.span))
        selecting = made.slots.get("$outcome_cb")
        decided = None
        if selecting is not None and not _is_nothing(selecting):
            decided = self._decided(node, selecting)
            if decided is None:
                lost.append(("outcome_cb", made.span or node.span))
        return Callbacks(decided=decided, lost=tuple(lost))

    def _decided(self, node: Concurrence, function: Value) -> dict[Outcomes, str] | None:
        """The outcomes that a function selects, by those of the states; None: not known."""
        cases = [[(child.name, outcome) for outcome in outcome_names(child)]
                 for child in written_children(node)]  # fmt: skip
        if math.prod(map(len, cases)) > MOST_COMBINATIONS:
            return None
        decided: dict[Outcomes, str] = {}
        for case in itertools.product(*cases):
            outcome = self._selected(node, function, case)
            if outcome is None:
                return None
            decided[case] = outcome
        return decided

    def _selected(self, node: Concurrence, function: Value, pairs: Outcomes) -> str | None:
        """The outcome of a concurrence with `outcome_cb`; None if it is not known."""
        items = {name: (Const(name), Const(outcome)) for name, outcome in pairs}
        found = self.evaluator.tried(function, Arguments((DictValue({"items": items}),)))
        if not isinstance(found, Const):
            return None
        if found.value:
            return found.value if found.value in outcome_names(node) else None
        ended = dict(pairs)
        outcome = node.default_outcome
        written = {child.name for child in written_children(node)}
        for rule in node.rules:  # in SMACH the last one that matches counts
            if all(part.child in written and ended[part.child] == part.outcome
                   for part in rule.when):  # fmt: skip
                outcome = rule.outcome
        return outcome


class _Names(ast.NodeTransformer):
    """Replaces names of a module by attributes of it. `is_local`: one has no such place."""

    def __init__(self, reader: _Reader, frame: Frame) -> None:
        self.reader = reader
        self.frame = frame
        self.inner: set[str] = set()
        self.modules: set[str] = set()
        self.is_local = False

    def visit_Lambda(self, node: ast.Lambda) -> ast.AST:
        self.inner |= {part.arg for part in ast.walk(node.args) if isinstance(part, ast.arg)}
        return self.generic_visit(node)

    def visit_comprehension(self, node: ast.comprehension) -> ast.AST:
        names = (part.id for part in ast.walk(node.target) if isinstance(part, ast.Name))
        self.inner.update(names)
        return self.generic_visit(node)

    def visit_Name(self, node: ast.Name) -> ast.AST:
        if node.id in self.inner:
            return node
        place = self.reader.imported(node.id, self.frame)
        if place is None:
            self.is_local = True
        if place is None or not place.module:
            return node
        self.modules.add(place.module)
        return parse_code(f"{place.module}.{place.name}".rstrip("."))


UNWRITTEN = object()
"""In place of the data of a value that YAML cannot hold."""


def _argument(
    name: str, data: Data | object, code: tuple[str, tuple[str, ...]] | None, text: str,
    parameter: str, span: Span,
) -> Argument:  # fmt: skip
    """An argument with its data, or else with code; without both it is not known."""
    modules: tuple[str, ...] = ()
    if code is not None:
        data, modules = Expression(text=code[0], span=span), code[1]
    known = data is not UNWRITTEN
    return Argument(name=name, data=data if known else None, text=text, is_known=known,  # type: ignore[arg-type]
                    parameter=parameter, modules=modules, span=span)  # fmt: skip


def _with_default(argument: Argument, value: Value) -> Argument:
    """An argument with the value that it has if the user of the machine does not change it."""
    if argument.is_known or not isinstance(value, Adjustable):
        return argument
    data = _plain(value.default, argument.span)
    if data is UNWRITTEN:
        return argument
    return replace(argument, data=data, has_default=True, word=value.name,  # type: ignore[arg-type]
                   source=(value.owner, value.name))  # fmt: skip


def _plain(value: Value, span: Span) -> Data | object:
    """A value as data of a script, or UNWRITTEN."""
    match value:
        case Const(value=str() as text) if text.strip()[:1] == "`":
            return Expression(text=repr(text), span=span)
        case Const(value=None | bool() | int() | str() as known):
            return known
        case Const(value=float() as number):
            finite = math.isfinite(number)
            return number if finite else Expression(text=f"float({str(number)!r})", span=span)
        case Const(value=other):
            return Expression(text=repr(other), span=span)
        case ListValue(kind="list", items=tuple() as items):
            found = tuple(_plain(item, span) for item in items)
            return UNWRITTEN if UNWRITTEN in found else found
        case DictValue() if isinstance(value.items, Mapping):
            pairs = [(key, _plain(part, span)) for key, part in value.items.values()]
            texts = [key.value for key, _ in pairs if isinstance(key, Const)]
            if all(isinstance(text, str) for text in texts) and len(texts) == len(pairs):
                known = all(part is not UNWRITTEN for _, part in pairs)
                entries = zip(texts, (part for _, part in pairs), strict=True)
                return Struct(entries=tuple(entries)) if known else UNWRITTEN  # type: ignore[arg-type]
    code = _literal_code(value)
    return UNWRITTEN if code is None else Expression(text=code, span=span)


def _literal_code(value: Value) -> str | None:
    """The literal of a value in Python."""
    match value:
        case Const(value=known):
            return repr(known)
        case TupleValue(items=items):
            parts = [_literal_code(item) for item in items]
            if None in parts:
                return None
            return f"({', '.join(map(str, parts))}{',' if len(parts) == 1 else ''})"
        case ListValue(kind=kind, items=tuple() as contents):
            parts = [_literal_code(item) for item in contents]
            if None in parts:
                return None
            inside = ", ".join(map(str, parts))
            return f"[{inside}]" if kind == "list" else f"{{{inside}}}" if parts else "set()"
        case DictValue() if isinstance(value.items, Mapping):
            keys = [_literal_code(key) for key, _ in value.items.values()]
            parts = [_literal_code(part) for _, part in value.items.values()]
            if None in keys or None in parts:
                return None
            pairs = (f"{key}: {part}" for key, part in zip(keys, parts, strict=True))
            return f"{{{', '.join(pairs)}}}"
    return None


def _literal(name: str, node: ast.expr, span: Span) -> Argument:
    """An argument of a call that was not evaluated."""
    text = ast.unparse(node)
    try:
        value = ast.literal_eval(node)
    except (ValueError, TypeError, SyntaxError, MemoryError, RecursionError):
        word = getattr(node, "id", "") or getattr(node, "attr", "") or name
        return Argument(name=name, data=None, text=text, is_known=False, source=span,
                        word=word or "value", span=span)  # fmt: skip
    if value is None or (isinstance(value, bool | int | str) and not str(value).startswith("`")):
        return Argument(name=name, data=value, text=text, span=span)
    return Argument(name=name, data=Expression(text=repr(value), span=span), text=text, span=span)


def _written(made: Instance) -> dict[int | str, ast.expr]:
    """The code of the arguments of the call that made an object, by place or name, if each of them
    is written in it."""
    if made.made_by is None or not isinstance(made.made_by.node, ast.Call):
        return {}
    node, given = made.made_by.node, made.made_by.arguments
    plain = not any(isinstance(part, ast.Starred) for part in node.args)
    if not plain or len(node.args) != len(given.positional):
        return {}
    found: dict[int | str, ast.expr] = dict(enumerate(node.args))
    return found | {part.arg: part.value for part in node.keywords if part.arg is not None}


def _object_at(text: PythonText, span: Span) -> ast.expr | None:
    """The object of a state: in the call that adds it, or behind its name in a dictionary."""
    for node in walk_code(text.tree):
        if isinstance(node, ast.Call) and text.span(node) == span:
            return _argument_of(node, 1, "state")
        if isinstance(node, ast.Dict):
            for key, value in zip(node.keys, node.values, strict=True):
                if key is not None and text.span(key) == span:
                    return value
    return None


def _argument_of(call: ast.Call, at: int, name: str) -> ast.expr | None:
    named = (part.value for part in call.keywords if part.arg == name)
    return call.args[at] if at < len(call.args) else next(named, None)


def _imported(tree: ast.Module, node: ast.expr) -> ClassPlace | None:
    """The class that an expression names, if an import in the file shows its module."""
    for part in walk_code(tree):
        match part, node:
            case ast.ImportFrom(module=str() as module, level=0, names=names), ast.Name(id=word):
                for alias in names:
                    if word == (alias.asname or alias.name):
                        return ClassPlace(module=module, name=alias.name)
            case ast.Import(names=names), ast.Attribute(value=owner, attr=word):
                for alias in names:
                    if ast.unparse(owner) == (alias.asname or alias.name):
                        return ClassPlace(module=alias.name, name=word)
            case (
                ast.ImportFrom(module=str() as module, level=0, names=names),
                ast.Attribute(value=ast.Name(id=owner), attr=word),
            ):
                for alias in names:
                    if owner == (alias.asname or alias.name):
                        return ClassPlace(module=f"{module}.{alias.name}", name=word)
    return None


def _no_import(text: str) -> str:
    return f"the function `{text}` is not at the top of a module"


def _short(callback: Argument | None, cls: str) -> str:
    """The name of a state type: that of the function it calls, or of its class."""
    name = callback.text.rpartition(".")[2] if callback is not None else ""
    if not name.isidentifier():
        return cls
    return "".join(part[:1].upper() + part[1:] for part in name.split("_")) or cls


def _call_code(call: Call) -> str | None:
    """The code of a call with known arguments; None for another one."""
    parts = [_literal_code(value) for value in call.arguments.positional]
    named = [(name, _literal_code(value)) for name, value in call.arguments.named]
    texts = [*parts, *(text and f"{name}={text}" for name, text in named)]
    known = [text for text in texts if text is not None]
    is_known = len(known) == len(texts) and not call.arguments.open
    return f"{call.name}({', '.join(known)})" if is_known else None


def _is_nothing(value: Value | None) -> bool:
    return value is None or (isinstance(value, Const) and value.value is None)


def with_names(root: Node) -> Iterator[tuple[Names, Node]]:
    """The nodes of a machine, each with the names that lead to it."""
    stack: list[tuple[Names, Node]] = [((root.name,), root)]
    while stack:
        names, node = stack.pop()
        yield names, node
        if not isinstance(node, Leaf):
            stack += [((*names, child.name), child) for child in reversed(node.children)]
