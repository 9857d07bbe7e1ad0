"""The modules of a repository, found by name, each loaded once."""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Callable, Iterable
from pathlib import PurePath
from typing import Protocol

from smachac.diagnostics.source import Source
from smachac.pysource.machines.evaluator import BudgetError, Evaluator
from smachac.pysource.machines.libraries import (
    library_module,
    method_of,
    misplaced,
    new_object,
    of_framework,
    signature_of_method,
)
from smachac.pysource.machines.values import (
    Arguments,
    Const,
    Frame,
    LibraryClass,
    ModuleValue,
    Native,
    Unknown,
    UseFault,
    Value,
)
from smachac.pysource.machines.wrong_calls import Signature
from smachac.pysource.modules.python2 import NotInstalledError, python2_text
from smachac.pysource.modules.source import PythonText, python_text


class ModuleParser(Protocol):
    """Parses the text of a module, as `module_text` does."""

    def __call__(self, source: Source, *, compiled: bool) -> PythonText | None: ...


class Repository:
    """The Python files of a repository by name. `read(file)` returns the text of one, `parse` its
    tree, as `module_text` does.

    A module `a.b` is the file whose path ends with `a/b.py` or `a/b/__init__.py`; of several, the
    one that shares the most folders with the file that imports it.
    """

    def __init__(
        self,
        files: Iterable[str],
        read: Callable[[str], Source | None],
        parse: ModuleParser | None = None,
    ) -> None:
        self.read = read
        self.parse = parse or module_text
        self.by_stem: dict[str, list[str]] = {}
        for file in files:
            self.by_stem.setdefault(_stem(file), []).append(file)
        self.loaded: dict[str, ModuleValue | Unknown] = {}
        self.libraries: dict[str, ModuleValue] = {}
        self.imported: dict[str, dict[str, None]] = {}
        self.set_names: dict[str, bool] = {}

    def method_of(self, cls: str, name: str) -> Native | None:
        return method_of(cls, name)

    def signature_of(self, method: Native) -> Signature | None:
        return signature_of_method(method)

    def is_of_framework(self, cls: Value) -> bool:
        return of_framework(cls) is not None

    def new_object(self, evaluator: Evaluator, cls: LibraryClass, arguments: Arguments) -> Value:
        return new_object(evaluator, cls, arguments)

    def has(self, file: str) -> bool:
        """Whether a file is one of the repository."""
        return file in self.by_stem.get(_stem(file), ())

    def load(self, evaluator: Evaluator, name: str, user: ModuleValue) -> Value:
        """A module by its dotted name; unknown, with its name, if the repository has none."""
        if not name:
            return Unknown(reason="")
        known = library_module(self.libraries, name)
        if known is not None:
            return known
        file = self.file_of(name, user)
        if file is None:
            return Unknown(reason=name)
        self.imported.setdefault(user.file, {})[file] = None
        return self.module(evaluator, file)

    def files_of(self, file: str) -> Iterable[str]:
        """The files of the modules that a file imports, and of those that these import."""
        found = {file: None}
        todo = [file]
        while todo:
            new = self.imported.get(todo.pop(), {}).keys() - found.keys()
            found |= dict.fromkeys(sorted(new))
            todo += sorted(new)
        return found

    def misplaced(self, module: ModuleValue, name: str) -> tuple[Value, str]:
        """The value of a name that a module of a framework lacks, and the module that has it."""
        return misplaced(module.name, name)

    def is_certain(self, name: str, user: ModuleValue) -> bool:
        """Whether a module can be no other file: it is the only one of its name, or beside the file
        that imports it."""
        found = self.file_of(name, user)
        beside = found is not None and PurePath(found).parent == PurePath(user.file).parent
        return beside or len(self._files_named(name)) == 1

    def faults_of(self, file: str) -> list[UseFault]:
        """The faults in the main parts of the modules that a file imports."""
        modules = (self.loaded.get(other) for other in self.files_of(file) if other != file)
        return [fault for part in modules if isinstance(part, ModuleValue) for fault in part.faults]

    def file_of(self, name: str, user: ModuleValue) -> str | None:
        """The file of a module. In Python 2, a package can import a module in it of its own name
        without a dot; only the main script imports itself."""
        found = self._files_named(name)
        if not found:
            return None
        folders = PurePath(user.file).parent.parts

        def order(file: str) -> tuple[bool, int, int, str]:
            return file == user.file, -_shared(folders, PurePath(file).parts), len(file), file

        return min(found, key=order)

    def _files_named(self, name: str) -> list[str]:
        """The files that can be a module."""
        path = name.replace(".", os.sep)
        endings = (f"{path}.py", os.path.join(path, "__init__.py"))  # noqa: PTH118 (fast)
        return [
            file
            for file in self.by_stem.get(name.rpartition(".")[2], ())
            if any(file == end or file.endswith(os.sep + end) for end in endings)
        ]

    def module(self, evaluator: Evaluator, file: str, *, main: bool = False) -> Value:
        """The module of a file, loaded with the first use."""
        key = f"{file}:main" if main else file
        if key in self.loaded:
            return self.loaded[key]
        source = self.read(file)
        text = self.parse(source, compiled=main) if source is not None else None
        if text is None:
            found = Unknown(reason=file)
            self.loaded[key] = found
            return found
        path = PurePath(file)
        folder = ".".join(part for part in path.parent.parts if part not in (path.anchor, ".."))
        name = folder if path.name == "__init__.py" else f"{folder}.{path.stem}".strip(".")
        if main:
            name = "__main__"
        module = ModuleValue(name, {}, text, folder, file=file)
        module.slots["__name__"] = Const(name)
        module.slots["__file__"] = Const(file)
        self.loaded[key] = module
        frame = Frame(module.slots, module)
        if main:
            evaluator.block(text.tree.body, frame)
        else:
            try:
                module.dynamic = evaluator.load(text.tree.body, frame) or module.dynamic
            except (BudgetError, RecursionError):
                self.loaded[key] = Unknown(reason=file)  # its names are not known as a whole
                raise
        module.is_loaded = True
        return module

    def end_of_main(self, file: str) -> None:
        """Forgets a file that was loaded as the main module."""
        self.loaded.pop(f"{file}:main", None)

    def sets(self, name: str) -> bool:
        """Whether any code of the repository sets an attribute of this name, or examines whether
        there is one."""
        if name not in self.set_names:
            files = (file for some in self.by_stem.values() for file in some)
            pattern = _setting(name)
            self.set_names[name] = any(
                pattern.search(source.text) for file in files if (source := self.read(file))
            )
        return self.set_names[name]

    def may_set(self, name: str) -> bool:
        """Whether code that was loaded sets an attribute of this name of anything, or examines
        whether there is one."""
        sets = _setting(name)
        texts = (module.text for module in self.loaded.values() if isinstance(module, ModuleValue))
        return any(text is not None and sets.search(text.source.text) for text in texts)


def _stem(file: str) -> str:
    """The last name of a module, or of a package."""
    folder, name = os.path.split(file)
    return os.path.basename(folder) if name == "__init__.py" else name.removesuffix(".py")  # noqa: PTH119 (fast)


def _setting(name: str) -> re.Pattern[str]:
    """Code that sets an attribute, or examines whether there is one."""
    word = re.escape(name)
    return re.compile(rf"\.{word}\b\s*(?:=[^=]|:)|(?:set|has)attr\([^,]*,\s*[\"']{word}[\"']")


def module_text(source: Source, *, compiled: bool = True) -> PythonText | None:
    """The text of a module for Python 3 or 2; None if it cannot be read. `compiled`: nor if the
    compiler of Python refuses it, which takes as long as parsing it."""
    text = python_text(source, template=False, compiled=compiled)
    if text is None:
        with contextlib.suppress(NotInstalledError):
            text = python2_text(source)
    return text


def _shared(one: tuple[str, ...], other: tuple[str, ...]) -> int:
    count = 0
    for left, right in zip(one, other, strict=False):
        if left != right:
            break
        count += 1
    return count
