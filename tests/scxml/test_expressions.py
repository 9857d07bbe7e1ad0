"""Portable expressions have in JavaScript the values that they have in Python."""

from __future__ import annotations

import json
import math
import random
import shutil
import subprocess
from types import SimpleNamespace
from typing import Any

import pytest

from smachac.diagnostics.source import NOWHERE
from smachac.interpreter.evaluator import EvaluationError, evaluate
from smachac.ir.expressions import print_expression
from smachac.ir.nodes import Expression
from smachac.targets.cpp.types import script_data
from smachac.targets.scxml.document import functions
from smachac.targets.scxml.expressions import (
    Reads,
    UnsupportedError,
    js_function,
    js_member,
    js_value,
)
from tests.strategies.typed_expressions import TYPES, expression, key_type, userdata

LIMITS = ("an integer beyond 53 bits", "JavaScript sorts keys that are numbers")
"""The errors where Python has a value that JavaScript cannot represent."""

LARGEST = 2**53 - 1

PROGRAM = """
const given = JSON.parse(require("fs").readFileSync(0, "utf-8"));
const shown = value => {
  if (typeof value === "number" && !Number.isFinite(value)) return {number: String(value)};
  if (Array.isArray(value)) return value.map(shown);
  if (value && typeof value === "object") {
    return {entries: Object.keys(value).sort().map(key => [key, shown(value[key])])};
  }
  return value;
};
for (const [values, code] of given) {
  const ud = userdata(values());
  try { console.log(JSON.stringify([shown(code(ud))])); }
  catch (error) { console.log(JSON.stringify({error: error.message})); }
}
"""


def reads() -> Reads:
    keys = {name: (js_member("ud", name), key_type(name)) for name in TYPES}
    return Reads(keys=keys, other=lambda key: f"undeclared('{key}')")


def js(text: str) -> str:
    return js_function(Expression(text=text, span=NOWHERE), reads()).text


def computed(cases: list[tuple[dict[str, object], str]]) -> list[Any]:
    """The values of expressions over userdata in Node; a dict for an error."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is not there: make test-browser")
    pairs = ",\n".join(
        f"[() => ({js_value(script_data(values))}), ud => ({text})]" for values, text in cases
    )
    program = PROGRAM.replace('JSON.parse(require("fs").readFileSync(0, "utf-8"))', f"[{pairs}]")
    found = subprocess.run(
        [node, "-"],
        input="\n".join([*functions().values(), program]),
        capture_output=True,
        encoding="utf-8",
    )
    assert found.returncode == 0, found.stderr[:2000]
    return [json.loads(line, parse_int=number_of) for line in found.stdout.splitlines()]


def number_of(text: str) -> float:
    """A number that JavaScript printed without a point: of an integer beyond 53 bits, a float."""
    value = int(text)
    return value if abs(value) <= LARGEST else float(value)


def shown(value: object) -> object:
    """A value of Python in the form that the program prints."""
    if isinstance(value, float) and not math.isfinite(value):
        name = "NaN" if value != value else "Infinity" if value > 0 else "-Infinity"
        return {"number": name}
    if isinstance(value, list | range):
        return [shown(item) for item in value]
    if isinstance(value, dict):
        return {"entries": sorted([key, shown(item)] for key, item in value.items())}
    return value


def fits(value: object) -> bool:
    if isinstance(value, dict):
        return all(map(fits, value.values()))
    if isinstance(value, list):
        return all(map(fits, value))
    return not isinstance(value, int) or abs(value) <= LARGEST


def difference(text: str, values: dict[str, object], theirs: Any) -> str | None:
    try:
        ours = evaluate_text(text, values)
    except EvaluationError:
        return None if isinstance(theirs, dict) else f"an error in Python, here {theirs}"
    if isinstance(theirs, dict):
        beyond = theirs["error"] in LIMITS
        return None if beyond else f"{ours} in Python, here the error {theirs['error']}"
    same = json.dumps(shown(ours)) == json.dumps(theirs[0]) or shown(ours) == theirs[0]
    return None if same else f"{ours} in Python, here {theirs[0]}"


def evaluate_text(text: str, values: dict[str, object]) -> object:
    from smachac.ir.expressions import parse_expression

    tree = parse_expression(text)
    assert tree is not None
    return evaluate(tree, {"ud": SimpleNamespace(**values)})


@pytest.mark.browser
@pytest.mark.parametrize(
    "number", [1, *(pytest.param(seed, marks=pytest.mark.nightly) for seed in range(2, 20))]
)
def test_random_expressions(number: int) -> None:
    rng = random.Random(number)
    cases: list[tuple[str, dict[str, object], str]] = []
    while len(cases) < 2000:
        text = print_expression(expression(rng))
        try:
            code = js(text)
        except UnsupportedError:
            continue
        values = userdata(rng)
        if all(map(fits, values.values())):
            cases.append((text, values, code))
    found = computed([(values, code) for _, values, code in cases])
    wrong = [
        f"{text}: {problem}\n    {code}\n    {values}"
        for (text, values, code), theirs in zip(cases, found, strict=True)
        if (problem := difference(text, values, theirs)) is not None
    ]
    assert not wrong, f"{len(wrong)} of {len(cases)}\n" + "\n".join(wrong[:15])
