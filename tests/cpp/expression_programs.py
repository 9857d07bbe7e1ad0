"""Expressions evaluated by Python and by one C++ program, and the differences.

`python -m tests.cpp.expression_programs COUNT [SEED]` compares COUNT expressions in batches and
prints what was rejected and why.
"""

from __future__ import annotations

import collections
import json
import math
import random
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

from smachac.interpreter.evaluator import EvaluationError, _Budget, _Evaluation
from smachac.ir.expressions import Expr, print_expression
from smachac.ir.types import Type
from smachac.targets.cpp.expressions import Spelling, cpp_expression, lowered
from smachac.targets.cpp.terms import has, inside, present
from smachac.targets.cpp.types import EXACT, UnportableError, cpp_type, cpp_value, script_data
from tests.cpp.compilers import SANITIZED, Compiler, compilers
from tests.strategies.typed_expressions import TYPES, expression, key_type, userdata

NAMES = {f"ud.{name}": Spelling(text=f"in.{name}", type=key_type(name)) for name in TYPES}

LIMITS = ("64 bits", "no float holds")
"""Parts of the messages about numbers that Python alone can hold."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Case:
    """An expression with its type and text in C++."""

    expr: Expr
    type: Type
    text: str

    @property
    def python(self) -> str:
        return print_expression(self.expr)


def portable(expr: Expr) -> Case:
    """The case of an expression. Raises UnportableError."""
    printed = cpp_expression(expr, NAMES)
    return Case(expr=expr, type=lowered(expr, NAMES).type, text=printed.text)


def cases(count: int, seed: int, refused: dict[str, list[str]] | None = None) -> Iterator[Case]:
    rng = random.Random(seed)
    seen: set[str] = set()
    while len(seen) < count:
        expr = expression(rng)
        if print_expression(expr) in seen:
            continue
        try:
            found = portable(expr)
        except UnportableError as error:
            if refused is not None:
                refused.setdefault(str(error).rpartition("`: ")[2], []).append(str(error))
            continue
        seen.add(found.python)
        yield found


PROGRAM = """\
#include <smachac/values.hpp>

struct In {{
{members}
}};

{functions}
template <class F> void show(F function, const In &in) {{
  try {{
    const std::string text = function(in);
    std::printf("=%s\\n", text.c_str());
  }} catch (const smachac::Error &error) {{
    std::printf("!%s\\n", error.what());
  }}
}}

using Function = std::string (*)(const In &);
static const Function functions[] = {{{table}}};

int main() {{
  const std::vector<In> inputs = {{{inputs}}};
  for (const Function function : functions) {{
    for (const In &in : inputs) {{
      show(function, in);
    }}
  }}
}}
"""


def program(batch: Sequence[Case], inputs: Sequence[Mapping[str, object]]) -> str:
    """One translation unit that prints each value over each input."""
    functions = [
        f"static std::string case_{i}([[maybe_unused]] const In &in) {{\n"
        f"  const auto value = [&]() -> {_cpp(case)} {{ return {case.text}; }}();\n"
        f"  return smachac::json(value);\n}}\n"
        for i, case in enumerate(batch)
    ]
    made = [
        f"In{{{', '.join(cpp_value(script_data(input_[name]), key_type(name)) for name in TYPES)}}}"
        for input_ in inputs
    ]
    return PROGRAM.format(
        members="\n".join(f"  {cpp_type(key_type(name))} {name};" for name in TYPES),
        functions="\n".join(functions),
        table=", ".join(f"case_{i}" for i in range(len(batch))),
        inputs=",\n".join(made),
    )


def _cpp(case: Case) -> str:
    return cpp_type(cpp_expression(case.expr, NAMES).type)


def _sum(items: Sequence[float], start: float = 0) -> float:
    # Since 3.12 Python's own keeps what each addition rounds away.
    total = start
    for item in items:
        if isinstance(item, (str, list, tuple)) or isinstance(start, (str, list, tuple)):
            raise TypeError("no number")
        total = total + item
    return total


class Watched(_Evaluation):
    """An evaluation that keeps whether it met numbers that C++ has not, or has no order for."""

    huge = False
    odd = False

    def value(self, expr: Expr) -> object:
        found = super().value(expr)
        todo = [found]
        while todo:
            each = todo.pop()
            if isinstance(each, (list, tuple, range)):
                todo.extend(each)
            elif isinstance(each, dict):
                todo.extend(each.values())
            elif isinstance(each, int):
                # Sums of a list are met halfway: that each part is small says nothing.
                Watched.huge |= abs(each) > EXACT
            elif isinstance(each, complex) or (isinstance(each, float) and math.isnan(each)):
                Watched.odd = True
        return found


def python_value(case: Case, values: Mapping[str, object]) -> str:
    """What C++ should print: `=` and the value, or `!` and why there is none."""
    Watched.huge = Watched.odd = False
    names = {"ud": SimpleNamespace(**values), "sum": _sum}
    try:
        value = Watched(names, {}, _Budget()).value(case.expr)
    except EvaluationError as error:
        return f"!{error}"
    return f"={shown(value, case.type)}"


def shown(value: object, type_: Type) -> str:
    """A value as a trace shows it, its numbers those of the type."""
    if isinstance(value, complex):
        return "complex"
    typed = _typed(value, type_)
    try:
        return json.dumps(typed, allow_nan=False, sort_keys=True, default=repr)
    except ValueError:
        return json.dumps(repr(typed))


def _typed(value: object, type_: Type) -> object:
    if value is None:
        return None
    type_ = present(type_)
    if type_.name in ("float", "number") and isinstance(value, int | float):
        return float(value)
    if isinstance(value, (list, tuple, range)):
        inner = inside(type_) if type_.args or type_.name == "range" else Type("float")
        inner = Type("Point") if type_.name == "Pose" else inner
        return [_typed(item, inner) for item in value]
    if isinstance(value, dict):
        return {key: _typed(value[key], inside(type_)) for key in sorted(value)}
    return value


@dataclass(slots=True)
class Tally:
    """How often what was seen."""

    equal: int = 0
    errors: int = 0
    limits: int = 0
    nan: int = 0


def differences(
    batch: Sequence[Case],
    inputs: Sequence[Mapping[str, object]],
    lines: Sequence[str],
    tally: Tally,
) -> Iterator[str]:
    """Where a program's lines are not what Python says."""
    assert len(lines) == len(batch) * len(inputs), lines[-1:]
    rest = iter(lines)
    for case in batch:
        for values in inputs:
            ours, theirs = next(rest), python_value(case, values)
            if has(case.type, "number"):
                # A zero without a sign in Python may have been a whole number.
                ours, theirs = (item.replace("-0.0", "0.0") for item in (ours, theirs))
            if ours == theirs:
                tally.equal += 1
            elif ours[0] == theirs[0] == "!":
                tally.errors += 1
            elif ours[0] == "!" and Watched.huge and any(limit in ours for limit in LIMITS):
                tally.limits += 1
            elif Watched.odd or "=complex" in theirs:
                tally.nan += 1
            else:
                yield f"{case.python}\n  {case.text}\n  {values}\n  C++ {ours}, Python {theirs}"


def compare(
    compiler: Compiler, folder: Path, batch: Sequence[Case], seed: int, tally: Tally, *flags: str
) -> list[str]:
    """The differences of a batch over six inputs."""
    rng = random.Random(seed)
    inputs = [userdata(rng) for _ in range(6)]
    output = compiler.run(program(batch, inputs), folder, *flags)
    return list(differences(batch, inputs, output.splitlines(), tally))


def main(count: int, seed: int = 0, size: int = 500) -> None:
    refused: dict[str, list[str]] = {}
    tally, found = Tally(), 0
    source = cases(count, seed, refused)
    with tempfile.TemporaryDirectory() as name:
        for start in range(0, count, size):
            batch = [next(source) for _ in range(min(size, count - start))]
            which = compilers()[start // size % len(compilers())]
            try:
                faults = compare(which, Path(name), batch, start, tally, "-O0", *SANITIZED)
            except AssertionError as error:
                faults = [str(error)]
            found += len(faults)
            print(f"{start + len(batch)} {which.name}: {tally}", *faults[:5], sep="\n", flush=True)
    counts = collections.Counter({reason: len(all_) for reason, all_ in refused.items()})
    for reason, number in counts.most_common(40):
        print(number, reason, "|", refused[reason][0])
    print(f"{count} expressions, {sum(counts.values())} rejected, {found} differences, {tally}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
