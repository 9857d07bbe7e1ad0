"""The files of the user's code and templates, by functions: reading works without a disk."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from smachac.diagnostics.source import Source
from smachac.records import dataclass, field


@dataclass(frozen=True, slots=True, kw_only=True)
class UserCode:
    """`code(file)` returns a module or header of the user by path (`my_robot/grasp.hpp`);
    `code_names(folder)` the names of files and folders in a folder of such code; `template(file)`
    an interface or a template by file name (`MoveTo.yml`, `MoveTo.tpl.py`); `own_template(file)`
    the same, but no built-in one. `modules` are the modules of Python that were read, by path and
    text (`modules.load_module`)."""

    template: Callable[[str], Source | None]
    own_template: Callable[[str], Source | None] = lambda file: None
    code: Callable[[str], Source | None] = lambda file: None
    code_names: Callable[[str], Sequence[str]] = lambda folder: ()
    modules: dict[tuple[str, Source], object] = field(
        default_factory=dict, compare=False, repr=False
    )
