"""The Python class of a state type: from its text to ClassFacts. The class is never run.

The class is in a template of the state type, or in a module of the user. In a template, parts that
Jinja replaces are not judged.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator

from smachac.diagnostics.source import Source, Span, Word
from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import STATE_PARAMETERS, ClassFacts, ClassFault, FaultKind, Parameter
from smachac.pysource.faults.base_calls import arguments_to_base, base_call_faults, copied
from smachac.pysource.faults.call_slips import call_slips
from smachac.pysource.faults.class_members import missing_constants
from smachac.pysource.faults.class_names import (
    OTHER_USERDATA,
    STATE_METHODS,
    UNDEFINED_NAME,
    undefined_in_base,
    undefined_methods,
    undefined_names,
)
from smachac.pysource.faults.class_slips import (
    is_uncalled_super,
    joined_texts,
    missing_comma,
    slips,
    unknown_argument,
    wrong_base,
)
from smachac.pysource.faults.instance_members import missing_members, uncalled_members
from smachac.pysource.faults.module_members import module_slips
from smachac.pysource.faults.void_calls import void_calls
from smachac.pysource.flow.flow import Flow, Flows
from smachac.pysource.flow.life_cycle import EXECUTE_ONLY, LifeCycle, in_cycle
from smachac.pysource.flow.local_values import local_values, text_of, unused_values
from smachac.pysource.flow.lost_outcomes import lost_outcomes
from smachac.pysource.modules.functions import is_generator, is_plain
from smachac.pysource.modules.imports import missing_imports
from smachac.pysource.modules.library_names import missing_attributes
from smachac.pysource.modules.modules import (
    CLASS_ELSEWHERE,
    SYNTAX,
    Module,
    OwnClass,
    absent_module,
    file_of,
    find_class,
    is_smach_state,
    load_module,
    names_of,
    template_module,
    with_bases,
)
from smachac.pysource.modules.other_modules import module_with
from smachac.pysource.modules.source import PythonText, name_span
from smachac.pysource.modules.syntax_tree import walk_code
from smachac.pysource.modules.user_code import UserCode
from smachac.pysource.values.class_messages import class_messages
from smachac.pysource.values.class_operations import compared_texts, operation_facts, table_look_ups
from smachac.pysource.values.class_values import (
    kept_parameters,
    loops,
    lost_results,
    texts_as_lists,
    written_values,
)
from smachac.pysource.values.userdata_parts import parts_of_arguments, parts_read
from smachac.records import replace

NO_STATE = FaultKind(
    name="no state",
    message="the class `{name}` is not derived from `smach.State`",
    help="write `class {word}(smach.State):`",
    effect="SMACH uses attributes of `smach.State` that the object does not have",
    stops=True,
)
NO_EXECUTE = FaultKind(
    name="no execute",
    message="the class `{name}` has no method `execute`",
    help="add the method `execute`, which returns an outcome",
    near_help="rename `{near}` to `execute`",
    effect="`execute` of `smach.State` raises a NotImplementedError when the state runs",
    stops=True,
)
NO_METHOD = FaultKind(
    name="no method",
    message="`execute` of `{name}` returns a generator, not an outcome",
    help="write `return` in place of `yield`",
    effect="SMACH needs the name of an outcome: the machine stops with an error",
    stops=True,
)
COROUTINE = FaultKind(
    name="coroutine",
    message="`execute` of `{name}` returns a coroutine, not an outcome",
    help="write `def execute(self, userdata):`, and `asyncio.run(...)` for what it awaits",
    effect="SMACH needs the name of an outcome: the machine stops with an error",
    stops=True,
)
ARGUMENTS = FaultKind(
    name="arguments",
    message="`execute` of `{name}` must accept exactly one argument: the userdata",
    help="write `def execute(self, userdata):`",
    effect="SMACH calls `execute` with the userdata alone: the call raises a TypeError",
    stops=True,
)
NO_CONSTRUCTOR_CALL = FaultKind(
    name="no constructor call",
    message="`__init__` of `{name}` does not call `__init__` of `smach.State`",
    help="write `super().__init__({lists})` as the first line of `__init__`",
    effect="the outcomes and keys of the state are missing: the program stops",
    stops=True,
)
NO_BASE_CONSTRUCTOR_CALL = FaultKind(
    name="no base constructor call",
    message="`__init__` of `{name}` does not call `__init__` of its base class",
    help="write `{near}` as the first line of `__init__`",
    effect="what the base class sets is missing, also the outcomes and keys: the program stops",
    stops=True,
)
NO_OUTCOMES = FaultKind(
    name="no outcomes",
    message="the class `{name}` has no `__init__`, so the state has no outcomes",
    help="add `def __init__(self):` with the line `super().__init__({lists})`",
    effect="SMACH raises InvalidTransitionError for an undeclared outcome: the machine stops",
    stops=True,
)
DATA_CLASS = FaultKind(
    name="data class",
    message="the `__init__` that `@dataclass` makes for `{name}` does not call that of"
    " `smach.State`",
    help="add `def __post_init__(self):` with the line `super().__init__({lists})`",
    stops=True,
)
SELF_TWICE = FaultKind(
    name="self twice",
    message="`super()` passes `{word}` already: here it is passed twice",
    help="remove `{word}`: write `super().__init__({lists})`",
)
NO_SELF = FaultKind(
    name="no self",
    message="`smach.State.__init__` is called without `{word}`",
    help="write `super().__init__({lists})`",
)
OTHER_CLASS = FaultKind(
    name="other class",
    message="`super({word}, ...)` is in the class `{near}`, which is not derived from `{word}`",
    help="write `super().__init__({lists})`",
)
HIDDEN_METHOD = FaultKind(
    name="hidden method",
    message="`self.{word}` hides the method `{word}` of `smach.State`, which SMACH calls",
    help="give the attribute another name, such as `self.own_{word}`",
)
DEFINED_TWICE = FaultKind(
    name="defined twice",
    message="`{word}` is defined twice: only the last definition counts",
    help="remove one of them, or give it another name",
    effect="",
)
NO_LIST = FaultKind(
    name="no list",
    message="`{word}` of `{name}` must be a list: SMACH cannot use another collection",
    help="write `{word}=[...]`",
    near_help="write `{near}`",
)

REGISTERS = re.compile(r"\.(register)?_(outcomes|(io|input|output)_keys)\b")
"""Methods and attributes that change the declared interface; a class that has one is not read."""

Words = tuple[Word, ...]


def read_template(source: Source, name: str, library: UserCode) -> ClassFacts | None:
    """The facts about the class in the template of a state type; None if there is no such class.

    The class has the name of the type, or is the only one with an `execute`, or the only one.
    """
    try:
        module = template_module(source)
        node = _in_template(module, re.sub(r"\W+", "_", name)) if module is not None else None
        return _facts(module, node, library) if module is not None and node is not None else None
    except (RecursionError, MemoryError, ValueError):  # ValueError: a name in full-width letters
        return None


def _in_template(module: Module, name: str) -> ast.ClassDef | None:
    classes = [node for node in module.text.tree.body if isinstance(node, ast.ClassDef)]
    named = [node for node in classes if node.name == name]
    running = [node for node in classes if any(_is_execute(inner) for inner in walk_code(node))]
    for some in (named, running, classes):
        if some:
            return some[0] if len(some) == 1 else None
    return None


def _is_execute(node: ast.AST) -> bool:
    return getattr(node, "name", "") == "execute"


def read_module(word: Word, library: UserCode) -> ClassFacts | None:
    """The facts about a class of a module, `my_robot.states:Grasp`; None if nothing is known."""
    path, _, name = word.text.partition(":")
    at = word.span.text.find(path)
    start = word.span.start + max(at, 0)
    place = Word(path, Span(word.span.source, start, min(start + len(path), word.span.end)))
    try:
        module = load_module(path, library)
        if module is None:
            module = absent_module(place, library)
        if not isinstance(module, Module):
            if module is not None and module.kind is SYNTAX:
                module = replace(module, file="")
            return ClassFacts(faults=(module,)) if module is not None else None
        found = find_class(module, name, library)
        if isinstance(found, ClassFault) and found.kind is SYNTAX:
            return ClassFacts(faults=(found,))
        if isinstance(found, ClassFault):
            file = file_of(module)
            other = module_with(found.name.text, file, library)
            if other is not None:
                missing = Word(found.name.text, place.span)
                fault = ClassFault(kind=CLASS_ELSEWHERE, name=missing, file=file,
                                   more=f"{other.replace('.', '/')}.py",
                                   help=f"write `{other}:{missing.text}`")  # fmt: skip
                return ClassFacts(faults=(fault,))
            fault = replace(found, file=file)
            return ClassFacts(faults=(_at_the_name(fault, word),))
        return _facts(*found, library) if found is not None else None
    except (RecursionError, MemoryError, ValueError):
        return None


def facts_of(
    module: Module, node: ast.ClassDef, library: UserCode, *, whole: bool = True,
    cycle: LifeCycle = EXECUTE_ONLY,
) -> ClassFacts | None:  # fmt: skip
    """The facts about a class of a module; None if it cannot be read. If it is not `whole`, only
    those about its structure and about what it returns, reads and writes. `cycle` are the methods
    that its framework calls."""
    try:
        if whole:
            return _facts(module, node, library, cycle)
        return _structure(module, node, library, cycle)
    except (RecursionError, MemoryError, ValueError):
        return None


def facts_of_callback(
    module: Module, function: ast.FunctionDef, userdata: str, library: UserCode
) -> ClassFacts | None:
    """The facts about a function that works as a state; `userdata` is its parameter."""
    nothing = OwnClass(classes=(), names=(), root="object")
    try:
        flow = Flows(nothing, library).of(module, function, userdata)
    except (RecursionError, MemoryError, ValueError):
        return None
    if flow is None or is_generator(function):
        return None
    name = Word(function.name, name_span(module.text, function))
    return ClassFacts(
        name=name,
        is_function=True,
        endings=flow.endings,
        complete=flow.complete and not flow.passed,
        execute=name.span,
        silent=flow.silent,
        always_silent=flow.always_silent,
        open_end=flow.open_end,
        in_loop=flow.in_loop,
        reads=flow.reads,
        writes=flow.writes,
        closed=bool(flow.endings) and all(ending.written is not None for ending in flow.endings),
    )


def _at_the_name(fault: ClassFault, word: Word) -> ClassFault:
    """A fault at the name of the class in the interface."""
    at = word.span.text.rfind(fault.name.text)
    start = word.span.start + max(at, 0)
    span = Span(word.span.source, start, min(start + len(fault.name.text), word.span.end))
    return replace(fault, name=Word(fault.name.text, span))


def _structure(
    module: Module, node: ast.ClassDef, library: UserCode, cycle: LifeCycle
) -> ClassFacts:
    """The facts about the structure of a class and the flow of `execute`."""
    own = with_bases(module, node, library)
    flow, _, place = _execute(own, library)
    flow = in_cycle(flow, own, library, cycle)
    name = Word(node.name, name_span(module.text, node))
    return _facts_of_flow(name, (*_faults(own, module, node), *slips(own)), flow, place)


def _facts_of_flow(
    name: Word, faults: tuple[ClassFault, ...], flow: Flow, place: Span | None
) -> ClassFacts:
    """The facts about a class with its faults and the flow of `execute`, which is at `place`."""
    return ClassFacts(
        name=name,
        faults=faults,
        endings=flow.endings,
        complete=flow.complete and not flow.passed,
        execute=place,
        silent=flow.silent,
        always_silent=flow.always_silent,
        open_end=flow.open_end,
        in_loop=flow.in_loop,
        reads=flow.reads,
        writes=flow.writes,
        closed=bool(flow.endings) and all(ending.written is not None for ending in flow.endings),
    )


def _facts(
    module: Module, node: ast.ClassDef, library: UserCode, cycle: LifeCycle = EXECUTE_ONLY
) -> ClassFacts:
    """The facts about a class."""
    own = with_bases(module, node, library)
    lists = _declared(own)
    whole = not any(piece.startswith("{%") for piece in _fillings(module, node))
    undefined = (*_undefined(own, lists, library),) if whole else ()
    flow, execute, place = _execute(own, library)
    if execute is not None and any(_is_userdata(fault, execute) for fault in undefined):
        flow = Flow()  # its code uses another name for the userdata
    flow = in_cycle(flow, own, library, cycle)
    name = Word(node.name, name_span(module.text, node))
    faults = (*_faults(own, module, node), *undefined) if whole else ()
    return replace(
        _facts_of_flow(name, faults, flow, place),
        parameters=_parameters(own) if whole else None,
        outcomes=lists.get("outcomes", ()) if lists is not None else None,
        inputs=_together(lists, "input_keys"),
        outputs=_together(lists, "output_keys"),
        passed=tuple(_passed(module.text, node)) if own.root == "state" else (),
        stub=execute is not None and all(map(_does_nothing, execute.body)),
        checks_stop=any(_checks_stop(class_) for _, class_ in own.classes),
        values=written_values(own, execute, library) if execute is not None else (),
        unused=unused_values(own, execute) if execute is not None else (),
        local=local_values(text_of(own, execute), execute) if execute is not None else (),
        loops=loops(own) if whole else (),
        compared=tuple(compared_texts(own, kept_parameters(own), execute)) if whole else (),
        tables=tuple(table_look_ups(own, kept_parameters(own), execute)) if whole else (),
        hooks=_hooks(own),
        messages=class_messages(own),
        parts=(*parts_read(text_of(own, execute), execute), *parts_of_arguments(own, execute))
        if execute is not None and flow.reads
        else (),
        **operation_facts(own, execute if flow.reads or flow.writes else None),
    )


HOOKS = ("on_enter", "on_exit", "on_start", "on_stop", "on_pause", "on_resume")
"""The methods that FlexBE calls around `execute`."""


def _hooks(own: OwnClass) -> tuple[str, ...]:
    """The methods with a name of FlexBE's that no code of the class uses."""
    found = [name for name in HOOKS if own.method(name) is not None]
    if not found or own.root != "state":
        return ()
    used = {attribute.attr for _, node in own.classes for attribute in walk_code(node)
            if isinstance(attribute, ast.Attribute)}  # fmt: skip
    return tuple(name for name in found if name not in used)


def _undefined(
    own: OwnClass, lists: dict[str, Words | None] | None, library: UserCode
) -> Iterator[ClassFault]:
    """The names and attributes that nothing defines, and other slips in the code."""
    modules = {module.name: module for module, _ in own.classes if module.name}.values()
    imports = [import_ for module in modules
               for import_ in missing_imports(module, library)]  # fmt: skip
    yield from imports
    absent = {import_.name.text for import_ in imports}
    names = {key: [word.text for word in words or ()] for key, words in (lists or {}).items()}
    for module, node in own.classes:
        found = undefined_names(own, module, node, names)
        yield from (fault for fault in found if fault.near not in absent)
        yield from missing_attributes(module, node, library)
    yield from undefined_methods(own)
    yield from undefined_in_base(own)
    yield from slips(own)
    yield from lost_results(own)
    yield from lost_outcomes(own, library)
    yield from missing_members(own, library)
    yield from uncalled_members(own, library)
    yield from missing_constants(own, library)
    yield from module_slips(own, library)
    yield from texts_as_lists(own)
    yield from void_calls(own, library)
    yield from call_slips(own, library)


def _is_userdata(fault: ClassFault, execute: ast.FunctionDef) -> bool:
    """Whether a fault is another name for the userdata in `execute`."""
    parameter = execute.args.args[1].arg
    return fault.kind is OTHER_USERDATA or (
        fault.kind is UNDEFINED_NAME and fault.near == parameter
    )


def _fillings(module: Module, node: ast.stmt) -> list[str]:
    return module.text.fillings(module.text.span(node))


# --- execute


def _execute(own: OwnClass, library: UserCode) -> tuple[Flow, ast.FunctionDef | None, Span | None]:
    """The flow of `execute`, its definition, and the place of its name."""
    found = own.method("execute")
    if found is None:
        return Flow(), None, None
    module, function = found
    named = sum(_is_execute(inner) for _, node in own.classes for inner in walk_code(node))
    plain = is_plain(function) and len(function.args.args) == 2 and not function.args.posonlyargs
    tags = any(piece.startswith("{%") for piece in _fillings(module, function))
    overridden = sum("execute" in names for names in own.names)
    if not plain or tags or named != overridden:
        return Flow(), None, None
    flow = Flows(own, library).of(module, function, function.args.args[1].arg)
    return flow or Flow(), function, name_span(module.text, function)


def _does_nothing(node: ast.stmt) -> bool:
    """Whether a statement of `execute` is one of a stub: a constant that is kept or returned, also
    as the answer to a request to stop."""
    match node:
        case ast.If(test=ast.Call(func=ast.Attribute(attr="preempt_requested")), orelse=[]):
            return all(map(_does_nothing, node.body))
        case ast.Expr(value=ast.Call(func=ast.Attribute(attr="service_preempt"))):
            return True
        case ast.Pass() | ast.Expr(value=ast.Constant()):
            return True
        case ast.Assign(value=value) | ast.Return(value=value):
            return isinstance(value, ast.Constant)
    return False


def _checks_stop(node: ast.ClassDef) -> bool:
    """Whether a class uses a method with a name such as `preempt_requested`."""
    attributes = (
        attribute.attr for attribute in walk_code(node) if isinstance(attribute, ast.Attribute)
    )
    return any("preempt" in name for name in attributes)


# --- the structure of the class


def _faults(own: OwnClass, module: Module, node: ast.ClassDef) -> list[ClassFault]:
    """The certain faults of a class."""
    found = _twice(module, node)
    if own.root == "unknown":
        return [*found, *_data_class_fault(module, node), *wrong_base(*own.classes[-1])]
    if own.root == "object":
        certain = not own.binds("get_registered_outcomes")
        return [*found, _at_class(NO_STATE, module, node)] if certain else found
    return [*found, *_execute_faults(own, module, node), *_constructor_faults(own), *_hidden(own),
            *_call_faults(own), *base_call_faults(own), *_list_faults(own)]  # fmt: skip


def _at_class(
    kind: FaultKind, module: Module, node: ast.ClassDef, near: str | None = None
) -> ClassFault:
    return ClassFault(kind=kind, name=Word(node.name, name_span(module.text, node)), near=near)


def _at_method(kind: FaultKind, module: Module, node: ast.FunctionDef) -> ClassFault:
    return ClassFault(kind=kind, name=Word(node.name, name_span(module.text, node)))


def _twice(module: Module, node: ast.ClassDef) -> list[ClassFault]:
    """The later ones of two definitions of the class, and of two plain methods of one name."""
    found = []
    same = [inner for inner in module.text.tree.body if getattr(inner, "name", "") == node.name]
    if len(same) > 1 and same[-1] is node:
        found.append(_at_class(DEFINED_TWICE, module, node))
    methods: dict[str, ast.FunctionDef] = {}
    for inner in node.body:
        if isinstance(inner, ast.FunctionDef) and not inner.decorator_list:
            if inner.name in methods:
                found.append(_at_method(DEFINED_TWICE, module, inner))
            methods[inner.name] = inner
    return found


def _execute_faults(own: OwnClass, module: Module, node: ast.ClassDef) -> list[ClassFault]:
    if not own.binds("execute"):
        if "execute" in own.assigned() or any("__getattr__" in names for names in own.names):
            return []
        methods = [name for name in own.names[0] if own.method(name) is not None]
        near = guesser(methods)("execute")
        found = own.method(near) if near is not None else None
        if found is not None and found[1] in node.body:
            name = Word(found[1].name, name_span(module.text, found[1]))
            return [ClassFault(kind=NO_EXECUTE, name=name, near=near)]
        return [_at_class(NO_EXECUTE, module, node, near)]
    bound = own.names[0].get("execute", ())
    if bound and isinstance(bound[-1], ast.AsyncFunctionDef) and not bound[-1].decorator_list:
        return [_at_class(COROUTINE, module, node)]
    found = own.method("execute")
    if found is None or found[1].decorator_list:
        return []
    module, function = found
    if not is_plain(function):
        return [_at_method(NO_METHOD, module, function)]
    taken = function.args
    positional = len(taken.posonlyargs) + len(taken.args)
    few = positional < 2 and taken.vararg is None
    many = positional - len(taken.defaults) > 2 or None in taken.kw_defaults
    return [_at_method(ARGUMENTS, module, function)] if few or many else []


def _names_super(node: ast.AST) -> bool:
    return isinstance(node, ast.Name) and node.id == "super"


def _constructor_faults(own: OwnClass) -> list[ClassFault]:
    """A constructor that does not call the one of `smach.State`, or none at all."""
    module, node = own.classes[0]
    if own.binds("__new__") or any(_registers(class_) for _, class_ in own.classes):
        return []
    if not own.binds("__init__"):
        return [_at_class(NO_OUTCOMES, module, node)]
    found = own.method("__init__")
    if found is None:
        return []
    owner = next(class_ for (_, class_), names in zip(own.classes, own.names, strict=True)
                 if "__init__" in names)  # fmt: skip
    calls = any(
        (isinstance(node, ast.Call) and _names_super(node.func))
        or (
            isinstance(node, ast.Attribute)
            and node.attr == "__init__"
            and not _names_super(node.value)
        )
        for node in walk_code(owner)
    )
    calls = calls or any(map(is_uncalled_super, walk_code(owner)))  # "super not called"
    return [] if calls else [_without_call(own, *found)]


def _without_call(own: OwnClass, module: Module, maker: ast.FunctionDef) -> ClassFault:
    """The fault of a constructor that does not call that of its base class, with the call where it
    is one of the user's classes."""
    at = next(index for index, (_, node) in enumerate(own.classes) if maker in node.body)
    bases = [names["__init__"][-1] for names in own.names[at + 1 :] if "__init__" in names]
    if not bases or not isinstance(bases[0], ast.FunctionDef):
        return _at_method(NO_CONSTRUCTOR_CALL, module, maker)
    taken, known = bases[0].args, {argument.arg for argument in maker.args.args[1:]}
    positional = [*taken.posonlyargs, *taken.args]
    required = positional[1 : len(positional) - len(taken.defaults)]
    required += [
        argument
        for argument, default in zip(taken.kwonlyargs, taken.kw_defaults, strict=True)
        if default is None
    ]
    given = [
        f"{argument.arg}={argument.arg if argument.arg in known else '...'}"
        for argument in required
    ]
    name = Word(maker.name, name_span(module.text, maker))
    near = f"super().__init__({', '.join(given)})"
    return ClassFault(kind=NO_BASE_CONSTRUCTOR_CALL, name=name, near=near)


def _data_class_fault(module: Module, node: ast.ClassDef) -> Iterator[ClassFault]:
    """A `@dataclass` derived from `smach.State`: the `__init__` that it makes does not call that of
    its base."""
    if len(node.decorator_list) != 1:
        return
    (decorator,) = node.decorator_list
    if isinstance(decorator, ast.Call) and all(
        keyword.arg != "init" for keyword in decorator.keywords
    ):
        decorator = decorator.func
    if ast.unparse(decorator) not in ("dataclass", "dataclasses.dataclass"):
        return
    names, _ = names_of(node.body)
    own = {"__init__", "__post_init__", "__new__"}.isdisjoint(names)
    if own and len(node.bases) == 1 and is_smach_state(module, node.bases[0]):
        yield _at_class(DATA_CLASS, module, node)


def _call_faults(own: OwnClass) -> Iterator[ClassFault]:
    """Calls of the `__init__` of the base class with the wrong `self`, or of another class."""
    found = own.method("__init__")
    if found is None or not found[1].args.args:
        return
    module, maker = found
    owner = next(class_ for _, class_ in own.classes if maker in class_.body)
    names = {class_.name for _, class_ in own.classes}
    others = own.root != "state" or sum("__init__" in name for name in own.names) != 1
    me = maker.args.args[0].arg
    for call in walk_code(maker):
        match call:
            case ast.Call(func=ast.Attribute(value=base, attr="__init__")):
                span = module.text.span(call)
            case _:
                continue
        if module.text.is_filled(span):
            continue
        first = call.args[0] if call.args else None
        passes = isinstance(first, ast.Name) and first.id == me
        match base:
            case ast.Call(func=ast.Name(id="super"), args=[ast.Name(id=name) as place, *_]):
                bound = module.names.get(name, ())
                alone = len(bound) == 1 and isinstance(bound[0], ast.ClassDef)
                if name not in names and alone and own.root == "state":
                    word = Word(name, module.text.span(place))
                    yield ClassFault(kind=OTHER_CLASS, name=word, near=owner.name)
                    continue
            case ast.Call(func=ast.Name(id="super")):
                pass
            case _ if is_smach_state(module, base):
                lists = ast.List | ast.Tuple | ast.Constant | ast.Set
                if isinstance(first, lists) or (first is None and call.keywords):
                    yield ClassFault(kind=NO_SELF, name=Word(me, module.text.span(base)))
                continue
            case _:
                continue
        if passes and first is not None and not others:
            yield ClassFault(kind=SELF_TWICE, name=Word(me, module.text.span(first)))


def _list_faults(own: OwnClass) -> Iterator[ClassFault]:
    """The arguments of `smach.State.__init__` that do not exist or are no lists, as SMACH joins the
    lists of keys, and items of lists without a comma between them."""
    found = own.method("__init__")
    if found is None or len(own.classes) > 1:
        return
    module, maker = found
    for call in walk_code(maker):
        if not isinstance(call, ast.Call) or not _is_super(call):
            continue
        for keyword in call.keywords:
            if (
                keyword.arg is not None
                and keyword.arg not in STATE_PARAMETERS
                and own.root == "state"
            ):
                yield unknown_argument(module.text, keyword, STATE_PARAMETERS)
        for key, value in (_given(call) or {}).items():
            span = module.text.span(value)
            for item in value.elts if isinstance(value, ast.List | ast.Tuple | ast.Set) else ():
                if isinstance(item, ast.Constant) and isinstance(item.value, str):
                    yield from missing_comma(module.text, item)
            kinds = ast.Tuple | ast.Set | ast.Dict | ast.SetComp | ast.GeneratorExp
            text = value.value if isinstance(value, ast.Constant) else None
            wrong = isinstance(text, str) or (key != "outcomes" and isinstance(value, kinds))
            if key not in STATE_PARAMETERS or not wrong or module.text.is_filled(span):
                continue
            items = [word.text for word in _words(module.text, value) or ()]
            items = [text] if isinstance(text, str) else items
            listed = ", ".join(f'"{item}"' for item in items)
            near = f"{key}=[{listed}]" if items else None
            yield ClassFault(kind=NO_LIST, name=Word(key, span), near=near)


def _registers(node: ast.ClassDef) -> bool:
    return REGISTERS.search(ast.unparse(node)) is not None


def _hidden(own: OwnClass) -> list[ClassFault]:
    """The methods of `smach.State` that an attribute of the object hides."""
    return [
        ClassFault(kind=HIDDEN_METHOD, name=Word(name, span))
        for name, entries in own.assigned().items()
        if name in STATE_METHODS
        for _, value, span in entries
        if isinstance(value, ast.Constant | ast.Compare | ast.List | ast.Dict | ast.Tuple)
        or _is_text(own, value)
    ]


def _is_text(own: OwnClass, value: ast.expr | None) -> bool:
    """Whether an expression is a parameter of `__init__` whose default is a text or a number."""
    found = own.method("__init__")
    if not isinstance(value, ast.Name) or found is None:
        return False
    given = found[1].args
    pairs = zip(reversed([*given.posonlyargs, *given.args]), reversed(given.defaults), strict=False)
    constants = {name.arg for name, default in pairs
                 if isinstance(default, ast.Constant) and default.value is not None}  # fmt: skip
    return value.id in constants


# --- the constructor


def _parameters(own: OwnClass) -> tuple[Parameter, ...] | None:
    """The parameters of the constructor that can be passed by name."""
    if own.binds("__new__"):
        return None
    if not own.binds("__init__"):
        place = name_span(own.classes[0][0].text, own.classes[0][1])
        fixed = (Parameter(word=Word(name, place), required=False) for name in STATE_PARAMETERS)
        return tuple(fixed) if own.root == "state" else None
    found = own.method("__init__")
    if found is None or found[1].decorator_list or found[1].args.kwarg is not None:
        return None
    module, function = found
    given = function.args
    positional = [*given.posonlyargs, *given.args]
    first = len(positional) - len(given.defaults)
    required = set(positional[:first])
    required |= {
        argument
        for argument, default in zip(given.kwonlyargs, given.kw_defaults, strict=True)
        if default is None
    }
    named = [
        argument for argument in [*given.args, *given.kwonlyargs] if argument is not positional[0]
    ]
    words = {argument: Word(argument.arg, _place(module.text, argument)) for argument in named}
    if any(module.text.is_filled(word.span) for word in words.values()):
        return None
    uses: dict[str, tuple[Span, ...]] = {}
    for node in walk_code(function):
        if isinstance(node, ast.Name):
            uses[node.id] = (*uses.get(node.id, ()), module.text.span(node))
    return tuple(
        Parameter(word=word, required=name in required, uses=uses.get(word.text, ()))
        for name, word in words.items()
    )


def _place(text: PythonText, node: ast.arg) -> Span:
    start = text.offset(node.lineno, node.col_offset)
    return Span(text.source, start, start + len(node.arg))


def _declared(own: OwnClass) -> dict[str, Words | None] | None:
    """The lists that a class passes to `smach.State`, itself or through the constructor of a base
    class of the project; None if that is not known."""
    found = _base_call(own.classes[0][0].text, own.classes[0][1])
    if found is not None:
        return {key: _words(own.classes[0][0].text, value) for key, value in found[1].items()}
    last, node = own.classes[-1]
    made = _base_call(last.text, node) if len(own.classes) > 1 else None
    passed = arguments_to_base(own) if made is not None else None
    if made is None or passed is None or any(_registers(class_) for _, class_ in own.classes):
        return None
    lists: dict[str, Words | None] = {}
    for key, value in made[1].items():
        name = copied(value)
        known = (last.text, value)
        if isinstance(name, ast.Name):
            known = passed.get(name.id, known)
        lists[key] = _words(*known)
    return lists


def _passed(text: PythonText, node: ast.ClassDef) -> Iterator[tuple[str, tuple[str, ...]]]:
    """The lists that a constructor passes to `smach.State` as it gets them, by parameter, each with
    the names in the default value."""
    found = _base_call(text, node)
    if found is None or "io_keys" in found[1]:
        return
    maker, given = found
    arguments = maker.args.args
    pairs = zip(reversed(arguments), reversed(maker.args.defaults), strict=False)
    defaults = {argument.arg: default for argument, default in pairs}
    changed = {
        node.id if isinstance(node, ast.Name) else ast.unparse(node.value)
        for node in walk_code(maker)
        if (isinstance(node, ast.Name) and not isinstance(node.ctx, ast.Load))
        or isinstance(node, ast.Attribute)
    }
    for key in ("outcomes", "input_keys", "output_keys"):
        value = given.get(key)
        if not isinstance(value, ast.Name) or value.id in changed:
            continue
        default = defaults.get(value.id)
        none = default is None or (isinstance(default, ast.Constant) and default.value is None)
        words = () if none else _words(text, default) if default is not None else ()
        if words is not None and value.id in {argument.arg for argument in arguments}:
            yield key, tuple(word.text for word in words)


def _base_call(
    text: PythonText, node: ast.ClassDef
) -> tuple[ast.FunctionDef, dict[str, ast.expr]] | None:
    """The constructor of a class and the arguments by name that it passes to `smach.State`; None if
    it is more than one `__init__` of a plain `smach.State`."""
    bases = [ast.unparse(base) for base in node.bases]
    makers = [inner for inner in node.body if getattr(inner, "name", "") == "__init__"]
    plain = bases in (["smach.State"], ["State"]) and not node.keywords and not node.decorator_list
    if not plain or len(makers) != 1 or _registers(node):
        return None
    (maker,) = makers
    if not isinstance(maker, ast.FunctionDef) or maker.decorator_list:
        return None
    if any(piece.startswith("{%") for piece in text.fillings(text.span(maker))):
        return None
    calls = [call for call in walk_code(maker) if isinstance(call, ast.Call) and _is_super(call)]
    alone = [node.value for node in maker.body if isinstance(node, ast.Expr)]
    if len(calls) != 1 or calls[0] not in alone:
        return None
    given = _given(calls[0])
    return (maker, given) if given is not None else None


def _is_super(call: ast.Call) -> bool:
    """Whether a call is that of the `__init__` of the base class."""
    match call.func:
        case ast.Attribute(value=ast.Call(func=ast.Name(id="super")), attr="__init__"):
            return True
        case ast.Attribute(value=owner, attr="__init__"):
            return ast.unparse(owner) in ("smach.State", "State")
    return False


def _given(call: ast.Call) -> dict[str, ast.expr] | None:
    """The arguments by name; None where some are in `*args` or `**kwargs`."""
    arguments = list(call.args)
    if isinstance(call.func, ast.Attribute) and not isinstance(call.func.value, ast.Call):
        arguments = arguments[1:]  # the first one is `self`
    if any(isinstance(argument, ast.Starred) for argument in arguments):
        return None
    found: dict[str, ast.expr] = dict(zip(STATE_PARAMETERS, arguments, strict=False))
    for keyword in call.keywords:
        if keyword.arg is None:
            return None
        meant = (
            keyword.arg
            if keyword.arg in STATE_PARAMETERS
            else guesser(STATE_PARAMETERS)(keyword.arg)
        )
        if meant is None:
            return None
        found.setdefault(meant, keyword.value)
    return found


def _words(text: PythonText, value: ast.expr) -> Words | None:
    """The names in a list of string literals; None for other expressions."""
    if not isinstance(value, ast.List | ast.Tuple | ast.Set):
        return None
    found = []
    for elt in value.elts:
        span = text.span(elt)
        if not (isinstance(elt, ast.Constant) and isinstance(elt.value, str)):
            return None
        if text.is_filled(span):
            return None
        found += joined_texts(text, elt)
    return None if text.is_filled(text.span(value)) else tuple(found)


def _together(lists: dict[str, Words | None] | None, key: str) -> Words | None:
    """The names in a list of the constructor, and those in the list of both kinds of keys."""
    if lists is None:
        return None
    some, both = lists.get(key, ()), lists.get("io_keys", ())
    return None if some is None or both is None else (*some, *both)
