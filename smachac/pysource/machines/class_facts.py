"""The facts about the state classes of machines in Python files: what `execute` returns, reads and
writes. A class is found by its name in the modules of the repository, and read as that of a state
type is (class_reader.py)."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from pathlib import PurePath

from smachac.diagnostics.source import Source, Span
from smachac.ir.class_facts import ClassFacts
from smachac.pysource.class_reader import NO_EXECUTE, facts_of, facts_of_callback
from smachac.pysource.machines.dead_code import Choice, choices, live_facts, unknown_places
from smachac.pysource.machines.libraries import framework_of, library_constant
from smachac.pysource.machines.project import Repository
from smachac.pysource.machines.proven_reads import doubtful_places
from smachac.pysource.machines.state_comments import StateComments
from smachac.pysource.machines.values import Class, Function, Instance, ModuleValue, Value
from smachac.pysource.modules.modules import Module, module_of
from smachac.pysource.modules.user_code import UserCode
from smachac.records import replace


class ClassReader:
    """Reads classes of a repository, each once; `whole`: with all facts, which takes longer."""

    def __init__(self, repository: Repository, *, whole: bool = True) -> None:
        self.repository = repository
        self.whole = whole
        self.library = UserCode(
            template=lambda file: None, code=self._code, constant=library_constant
        )
        self.comments = StateComments()
        self.modules: dict[str, Module] = {}
        self.files: dict[str, str | None] = {}
        self.facts: dict[int, tuple[Class, ClassFacts | None]] = {}
        self.choices: dict[ast.ClassDef, tuple[Choice, ...]] = {}
        self.places: dict[ast.ClassDef, tuple[Span, ...]] = {}

    def forget(self, file: str) -> None:
        """Forgets the classes and comments of a file that has another text now."""
        gone = {cls.node for cls, _ in self.facts.values() if cls.frame.module.file == file}
        self.facts = {key: known for key, known in self.facts.items() if known[0].node not in gone}
        for node in gone:
            self.choices.pop(node, None)
            self.places.pop(node, None)
        self.modules.pop(file, None)
        self.comments.forget(file)

    def of_callback(
        self, function: Function, *, bound: bool, given: frozenset[str] = frozenset()
    ) -> ClassFacts | None:
        """The facts about a function that works as a state; `bound`: it is a method. `given` are
        the parameters that get other values than the userdata, by name.

        A method with `cb_interface` is not bound in SMACH before 2.5: its first parameter is the
        userdata if the second one gets another value.
        """
        module = self._module(function.frame.module)
        node = function.node
        if module is None or not isinstance(node, ast.FunctionDef):
            return None
        parameters = [part.arg for part in (*node.args.posonlyargs, *node.args.args)]
        if bound and not given.isdisjoint(parameters[1:2]):
            bound = False
        if len(parameters) <= bound:
            return None
        return facts_of_callback(module, node, parameters[bound], self.library)

    def of_class(self, cls: Class) -> ClassFacts | None:
        """The facts about a class."""
        known = self.facts.get(id(cls.node))
        if known is None:
            module = self._module(cls.frame.module)
            facts = None
            if module is not None:
                cycle = framework_of(cls.order).life_cycle
                facts = facts_of(module, cls.node, self.library, whole=self.whole, cycle=cycle)
            known = self.facts[id(cls.node)] = cls, facts
        facts = known[1]
        if facts is not None and any(fault.kind is NO_EXECUTE for fault in facts.faults):
            return self._without_execute(facts)
        return facts

    def _without_execute(self, facts: ClassFacts) -> ClassFacts:
        """The facts about a class without a method `execute`: no fault if other code sets it."""
        if not self.repository.sets("execute"):
            return facts
        return replace(facts, faults=tuple(f for f in facts.faults if f.kind is not NO_EXECUTE))

    def of_instance(self, instance: Instance, classes: Sequence[Value]) -> ClassFacts | None:
        """The facts about the class of an instance, without its dead code. `classes` are the class
        and its bases."""
        cls = instance.cls
        facts = self.of_class(cls) if isinstance(cls, Class) else None
        if facts is None or not isinstance(cls, Class):
            return None
        if cls.node not in self.choices:
            self.choices[cls.node] = choices(facts, classes)
        return live_facts(facts, self.choices[cls.node], instance)

    def doubtful(self, instance: Instance, classes: Sequence[Value]) -> tuple[Span, ...]:
        """The places in the code of an instance at which reads of userdata need not happen."""
        cls = instance.cls
        if not isinstance(cls, Class):
            return ()
        if cls.node not in self.places:
            self.places[cls.node] = doubtful_places(classes)
        found = self.choices.get(cls.node, ())
        return (*self.places[cls.node], *unknown_places(found, instance))

    def _module(self, value: ModuleValue) -> Module | None:
        if value.text is None:
            return None
        if value.file not in self.modules:
            path = PurePath(value.file)
            package = path.name == "__init__.py"
            name = ".".join(path.parent.parts if package else (*path.parent.parts, path.stem))
            self.modules[value.file] = module_of(value.text, name, package=package)
        return self.modules[value.file]

    def _code(self, file: str) -> Source | None:
        """A module by a path such as `my_robot/states.py`."""
        if file not in self.files:
            stem = PurePath(file).with_suffix("")
            user = ModuleValue("", {}, file=file)
            self.files[file] = self.repository.file_of(".".join(stem.parts), user)
        found = self.files[file]
        return self.repository.read(found) if found is not None else None
