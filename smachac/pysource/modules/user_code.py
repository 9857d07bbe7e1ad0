"""The code of the user as the compiler gets it: files by functions, so that reading works without a
disk; the interface that a class declares; and a fault in the code of a state type."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeAlias

from smachac.diagnostics.diagnostic import Related
from smachac.diagnostics.source import Source, Span, Word
from smachac.ir.nodes import Leaf, Machine, StateType
from smachac.ir.traversal import walk
from smachac.pysource.modules.ros_names import DEFAULT_ROS, Ros
from smachac.records import dataclass, field

TYPE_CHECKING = False  # annotations only: most machines have no classes
if TYPE_CHECKING:
    from smachac.ir.class_facts import ClassFault

Words: TypeAlias = "tuple[Word, ...]"


@dataclass(frozen=True, slots=True, kw_only=True)
class UserCode:
    """`code(file)` returns a module or header of the user by path (`my_robot/grasp.hpp`);
    `code_names(folder)` the names of files and folders in a folder of such code;
    `constant(module, name)` a text that a module of a library has under a name; `template(file)`
    an interface or a template by file name (`MoveTo.yml`, `MoveTo.tpl.py`); `own_template(file)`
    the same, but no built-in one; `template_names()` the names of all, for messages. `ros` is the
    version of ROS of the project. `modules` are the modules of Python that were read, by path and
    text (`modules.load_module`)."""

    template: Callable[[str], Source | None]
    own_template: Callable[[str], Source | None] = lambda file: None
    code: Callable[[str], Source | None] = lambda file: None
    code_names: Callable[[str], Sequence[str]] = lambda folder: ()
    constant: Callable[[str, str], str | None] = lambda module, name: None
    template_names: Callable[[], Sequence[str]] = lambda: ()
    ros: Ros = DEFAULT_ROS
    modules: dict[tuple[str, Source], object] = field(
        default_factory=dict, compare=False, repr=False
    )


class Difference(NamedTuple):
    """A difference between a class and its interface, at its place, and what to do; `change` is
    what to do where the interface is right."""

    word: Word
    help: str
    effect: str | None = None
    change: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Declared:
    """The interface that a class declares, with the names of the state type where they correspond.

    A part that could not be read is None. `others` are further differences.
    `stale` is the place of an outdated interface hash in the class, with the present hash.
    `faults` are those of a class that does not exist or does not work as a state. `uses` are the
    places where its code names outcomes. `fields` are the declarations of keys, by their part and
    name, where they can be added to those that the class has.
    """

    name: str
    span: Span
    outcomes: Words | None = None
    inputs: Words | None = None
    outputs: Words | None = None
    others: tuple[Difference, ...] = ()
    stale: Word | None = None
    faults: tuple[ClassFault, ...] = ()
    uses: Words = ()
    fields: Mapping[tuple[str, str], str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class ProjectCode:
    """The code of a project around a machine, for the rules about it: `library` gives access to its
    files; `declared(language, type)` is the interface that the class of a state type in a language
    declares, None if it cannot be read. `target` is the language of the program for which the code
    is checked: only that language counts, and what such a program cannot use is an error. It is
    empty for the check of a script."""

    library: UserCode
    declared: Callable[[str, StateType], Declared | None]
    target: str = ""


class StateFault(NamedTuple):
    """A fault in the code of a state type in a language: of the class `class_name`, or of the
    template that makes it. `related` are the other places, such as the first state of the type;
    `lists` are the arguments of the constructor of `smach.State` that fit the interface."""

    fault: ClassFault
    language: str
    type_name: str
    class_name: str
    related: tuple[Related, ...]
    lists: str = "outcomes=[...]"


class StateClass(NamedTuple):
    """The class of a state type in one language, with the first state of the type."""

    leaf: Leaf
    type: StateType
    language: str
    declared: Declared

    @property
    def user(self) -> Related:
        """The place of the first state."""
        text = f"`{self.leaf.name}` is of the type `{self.type.name}`"
        return Related(span=self.leaf.span, message=text)


class TemplateBody(NamedTuple):
    """The block `body` of a template of the user, with the first state of its type. `block[1]` is
    the text in the block, `call` the start of a call in it of the class with the name of the
    type."""

    template: Source
    block: re.Match[str]
    call: re.Match[str] | None
    type: StateType
    leaf: Leaf


class CodeFacts(NamedTuple):
    """The facts about the code of the state types of a machine: the classes that were read, the
    blocks `body` of templates, the faults, and the files of these in the order in which the states
    use them."""

    classes: tuple[StateClass, ...] = ()
    bodies: tuple[TemplateBody, ...] = ()
    faults: tuple[StateFault, ...] = ()
    files: tuple[Source, ...] = ()


def languages(type_: StateType) -> tuple[str, ...]:
    """The languages that an interface names code in."""
    return tuple(dict.fromkeys((*type_.code, *type_.classes)))


def user_types(machine: Machine, library: UserCode) -> Iterator[tuple[Leaf, StateType]]:
    """The state types of the user whose interface or class is known, each with its first state."""
    seen: set[str] = set()
    for _, node in walk(machine.root):
        if isinstance(node, Leaf) and node.type not in seen:
            seen.add(node.type)
            type_ = machine.state_types.get(node.type)
            if type_ is None:
                continue
            declared = not type_.open and library.own_template(f"{node.type}.yml") is not None
            if declared or type_.class_facts is not None:
                yield node, type_
