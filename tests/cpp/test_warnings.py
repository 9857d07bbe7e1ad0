"""Generated headers give no warnings, with all warnings that a careful project turns on."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cpp.compiled_traces import ROOT
from tests.cpp.compilers import COMPILERS, STRICT, Compiler, compilers
from tests.cpp.test_machines import drawn
from tests.cpp.test_vectors import CHUNK, NAMES, made

GOLDEN = sorted((ROOT / "tests" / "cases").glob("**/expected/cpp/*.hpp"))
CLASSES = ROOT / "tests" / "cases" / "code_in_both" / "include"


HEADERS_BY_COMPILER = [
    pytest.param(
        path,
        compiler,
        id=f"{path.parents[2].name}-{compiler.name}",
        marks=pytest.mark.nightly if at else (),
    )
    for number, path in enumerate(GOLDEN)
    for at, compiler in enumerate(compilers())
    if at == 0 or number % 3 == at % 3
]
"""Every header with the first compiler, a third of them with each of the others."""


@pytest.mark.slow
@pytest.mark.parametrize(("path", "compiler"), HEADERS_BY_COMPILER)
def test_headers_of_scripts(path: Path, compiler: Compiler, tmp_path: Path) -> None:
    text = f'#include "{path.name}"\nint main() {{}}\n'
    folders = (f"-I{path.parent}", "-isystem", str(CLASSES))
    assert compiler.compile(text, tmp_path, *STRICT, *folders, "-pthread", "-c").exists()


@pytest.mark.slow
@COMPILERS
def test_headers_of_random_machines(compiler: Compiler, tmp_path: Path) -> None:
    parts = [part for part, _ in drawn(5, 20)]
    text = "\n".join(text.replace("#pragma once\n", "") for _, text, _ in parts)
    text += "int main() {}\n"
    assert compiler.compile(text, tmp_path, *STRICT, "-pthread", "-c").exists()


@pytest.mark.slow
@COMPILERS
def test_headers_of_recorded_machines(compiler: Compiler, tmp_path: Path) -> None:
    """Every tenth machine. The host that the other tests use is left out."""
    parts = [made(name) for name in NAMES[:: CHUNK // 10]]
    classes = "\n".join(part.classes for part in parts)
    text = f"""
#include "smachac/smachac.hpp"
namespace vectors {{
struct Host {{
  template <class... T> int act(const char *, smachac::Stop &, std::initializer_list<int>) {{
    return 0;
  }}
}};
template <class T> int view(const char *, const T &) {{ return 0; }}
{classes}
}} // namespace vectors
"""
    text += "\n".join(part.header for part in parts) + "\nint main() {}\n"
    assert "UserdataView" in text
    assert compiler.compile(text, tmp_path, *STRICT, "-pthread", "-c").exists()
