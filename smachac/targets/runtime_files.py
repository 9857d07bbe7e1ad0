"""The files of `runtime/` that generated code needs beside it."""

from __future__ import annotations

from collections.abc import Mapping


def runtime_files(paths: Mapping[str, str]) -> dict[str, str]:
    """The texts of support files, by their file names in the output.

    `paths` maps each name to the path of its file below `runtime/`.
    """
    from importlib import resources

    return {
        name: resources.files("smachac.runtime").joinpath(path).read_text("utf-8")
        for name, path in paths.items()
    }
