"""The frameworks and the modules of Python's library that the evaluator models, by name."""

from __future__ import annotations

from collections.abc import Iterable

from smachac.pysource.machines import python_library, yasmin_runtime
from smachac.pysource.machines.builtins import MAKERS
from smachac.pysource.machines.flexbe_library import FLEXBE
from smachac.pysource.machines.framework import Framework
from smachac.pysource.machines.smach_library import SMACH
from smachac.pysource.machines.values import (
    UNKNOWN,
    Arguments,
    Const,
    Instance,
    Interpreter,
    LibraryClass,
    ModuleValue,
    Native,
    Unknown,
    Value,
)
from smachac.pysource.machines.wrong_calls import Signature
from smachac.pysource.machines.yasmin_library import YASMIN

FRAMEWORKS: tuple[Framework, ...] = (SMACH, YASMIN, FLEXBE)
"""The frameworks whose machines are read."""

_OF_PACKAGE = {package: framework for framework in FRAMEWORKS for package in framework.packages}


def of_framework(cls: Value) -> Framework | None:
    """The framework of a class; None for other classes."""
    if not isinstance(cls, LibraryClass):
        return None
    return _OF_PACKAGE.get(cls.name.partition(".")[0])


def framework_of(order: Iterable[Value]) -> Framework:
    """The framework of a state; `order` are its class and the base classes."""
    return next((found for cls in order if (found := of_framework(cls)) is not None), SMACH)


def is_container_class(cls: Value) -> bool:
    """Whether a class is a container of a framework."""
    framework = of_framework(cls)
    return framework is not None and cls.name in framework.containers  # type: ignore[union-attr]


def is_container(value: Value) -> bool:
    """Whether a value is a container."""
    return isinstance(value, Instance) and "$children" in value.slots


def parameters_of(cls: Value) -> list[str]:
    """The names of the parameters of a class of a framework; empty for other ones."""
    framework = of_framework(cls)
    return [*framework.parameters.get(cls.name, ())] if framework is not None else []  # type: ignore[union-attr]


def method_of(cls: str, name: str) -> Native | None:
    """A method of a class of a library, by their names; None if it has none of that name."""
    framework = _OF_PACKAGE.get(cls.partition(".")[0])
    methods = framework.methods if framework is not None else python_library.METHODS
    run = methods.get(cls, {}).get(name)
    is_static = framework is not None and name in framework.static
    return Native(f"{cls}.{name}", run, is_static) if run is not None else None


def signature_of_method(method: Native) -> Signature | None:
    """The parameters of a method of a framework; None if they are not known."""
    framework = _OF_PACKAGE.get(method.name.partition(".")[0])
    return framework.signatures.get(method.name) if framework is not None else None


def new_object(evaluator: Interpreter, cls: LibraryClass, arguments: Arguments) -> Value:
    """An object of a class of Python's library."""
    make = MAKERS.get(cls.name)
    return make(evaluator, arguments, None) if make is not None else UNKNOWN


def library_module(known: dict[str, ModuleValue], name: str) -> Value | None:
    """A module that the evaluator models; None for any other. `known` are those of one run."""
    if not known:
        every = {name: names for framework in FRAMEWORKS
                 for name, names in framework.modules.items()}  # fmt: skip
        for module, names in (*every.items(), *python_library.MODULES.items()):
            known[module] = ModuleValue(module, {**names})
    if name.rpartition(".")[2] == yasmin_runtime.NAME:  # it lies beside the programs
        name = yasmin_runtime.NAME
    if name in known:
        return known[name]
    if name in python_library.UNREAD:
        return Unknown(reason=name)
    top, dot, _ = name.partition(".")
    if top in _OF_PACKAGE:
        return known.get(top)
    return known.get(f".{name.rpartition('.')[2]}") if dot else None


def misplaced(module: str, name: str) -> tuple[Value, str]:
    """The value of a name that a module of a framework lacks, and the other module that has it; an
    empty name: there is none."""
    for framework in FRAMEWORKS:
        other = framework.lacking.get(module, "")
        if name in framework.modules.get(other, {}):
            return framework.modules[other][name], other
    return UNKNOWN, ""


def library_constant(module: str, name: str) -> str | None:
    """The text that a module of a framework has under a name; None for anything else."""
    for framework in FRAMEWORKS:
        match framework.modules.get(module, {}).get(name):
            case Const(value=str() as text):
                return text
    return None
