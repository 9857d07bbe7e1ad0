"""The two dialects of generated code: blocking machines and stepped machines.

Expressions and states are printed once, for both. Where the dialects differ, the text of an
expression contains a mark, a character of Unicode's private use area; text of the script is
escaped to ASCII (`cpp_literal`), so it cannot contain one. `Dialect.resolved` replaces the marks.
"""

from __future__ import annotations

from smachac.records import dataclass
from smachac.targets.cpp.types import UnportableError

OPERATIONS = "\ue000"
"""The namespace of the operations of Python."""

FAULT = "\ue001"
"""The first argument of an operation that can fail."""

TEXT = "\ue002"
"""The type of a text in an expression."""

CONVERT = "\ue003"
"""The function that converts a value, before its template arguments."""

UNBOUNDED = "\ue004"
"""A value of a text, list or mapping that is computed and has no bound: it needs the heap."""

NO_BOUND = "a stepped machine has no memory for a text, list or mapping that an expression makes"


@dataclass(frozen=True, slots=True, kw_only=True)
class Dialect:
    """The texts of one kind of machine. `marks` are the replacements of the marks. `stop_requested`
    is the test for a request to stop, `service` the statement that answers it."""

    stepped: bool
    namespace: str
    marks: tuple[tuple[str, str], ...]
    stop_requested: str
    service: str

    def resolved(self, text: str) -> str:
        """The text of an expression. Raises UnportableError if it needs the heap and may not."""
        if self.stepped and UNBOUNDED in text:
            raise UnportableError(NO_BOUND)
        for mark, replacement in self.marks:
            text = text.replace(mark, replacement)
        return text

    def may_fail(self, text: str) -> bool:
        """Whether an expression with marks can fail without an exception."""
        return self.stepped and (FAULT in text or CONVERT in text)


BLOCKING = Dialect(
    stepped=False,
    namespace="smachac::",
    marks=(
        (OPERATIONS, "smachac::py::"),
        (FAULT, ""),
        (TEXT, "std::string"),
        (CONVERT, "smachac::convert"),
        (UNBOUNDED, ""),
    ),
    stop_requested="stop.requested()",
    service="stop.service();",
)
STEPPED = Dialect(
    stepped=True,
    namespace="smachac::step::",
    marks=(
        (OPERATIONS, "smachac::step::py::"),
        (FAULT, "run.context, "),
        (TEXT, "std::string_view"),
        (CONVERT, "smachac::step::convert"),
    ),
    stop_requested="run.context.stop_requested()",
    service="run.context.service();",
)
