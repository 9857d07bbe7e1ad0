"""The file of the project that defines a name which another one lacks."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from smachac.pysource.modules.user_code import UserCode

MOST_FILES = 200
"""The most files that are read for a name."""


def module_with(name: str, lacking: str, library: UserCode) -> str | None:
    """The only other module that defines a class or a function at its top, by the file of the
    module that lacks it: a module of the same package, or of another one of the project."""
    pattern = re.compile(rf"^(?:class|def|async[ ]+def)[ ]+{re.escape(name)}\b", re.M)
    found = file_with(pattern, lacking, (".py",), library)
    return found.removesuffix(".py").removesuffix("/__init__").replace("/", ".") if found else None


def file_with(
    pattern: re.Pattern[str], lacking: str, suffixes: tuple[str, ...], library: UserCode
) -> str | None:
    """The only other file of the project that matches a pattern; None for several."""
    found: dict[str, str] = {}
    for count, file in enumerate(_files(lacking, suffixes, library)):
        source = library.code(file) if file != lacking else None
        if count >= MOST_FILES:
            return None
        if source is not None and pattern.search(source.text):
            found[source.name] = file
    return next(iter(found.values())) if len(found) == 1 else None


def _files(lacking: str, suffixes: tuple[str, ...], library: UserCode) -> Iterator[str]:
    """The files in the folder of a file, in the folders around it, and in those of the project."""
    folder = lacking.rpartition("/")[0]
    every: Sequence[str] = [name for name in library.code_names("") if "." not in name]
    around = ["/".join(folder.split("/")[:end]) for end in range(1, folder.count("/") + 2)]
    for fromkey in dict.fromkeys([folder, *around, *every, ""]):
        for name in library.code_names(fromkey):
            if name.endswith(suffixes):
                yield f"{fromkey}/{name}" if fromkey else name
