"""How generated C++ is laid out."""

from __future__ import annotations

CLANG_FORMAT = "BasedOnStyle: LLVM\nColumnLimit: 0\n"
"""The `.clang-format` that leaves generated code as it is: LLVM's, where the printer breaks lines
and long expressions stay on one. The headers of the runtime hold to LLVM's with 100 columns."""
