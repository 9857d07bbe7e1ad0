"""SM311: a key that begins as null and that no state sets, beside an output that nothing reads."""

from __future__ import annotations

import pytest

from tests.checks.test_first_scripts import reported

MAIN = """\
name: rack
template: Base
outcomes: [light, heavy]
userdata:
  rack_mass: PRESET
states:
  - LIFT:
      template: Lift
      transitions: {lifted: CHECK}
  - CHECK:
      template: ConditionalOutcomeState
      outcomes: [too_heavy]
      input_keys: [rack_mass]
      callbacks: {too_heavy: 'lambda ud: CODE'}
      default_outcome: ok
      transitions: {too_heavy: heavy, ok: light}
"""
LIFT = "output_keys: {OUT: float<kg>}\noutcomes: {lifted: {}}\n"
NULL = "{type: float<kg>?, value: null}"
HEAVY = "ud.rack_mass > 600.0"
HELP = "write `remapping: {mass: rack_mass}` in `LIFT`, whose `mass` nothing reads"


def found(preset: str = NULL, code: str = HEAVY, out: str = "mass", old: str = "", new: str = "") \
        -> list[tuple[str, str, str | None]]:  # fmt: skip
    text = MAIN.replace("PRESET", preset).replace("CODE", code)
    text = text.replace(old, new) if old else text
    return reported({"main.yml": text, "templates/Lift.yml": LIFT.replace("OUT", out)})


@pytest.mark.parametrize(
    ("preset", "help"),
    [(NULL, HELP), ("null", "give it a value: the script sets it only to nothing (`null`)")],
)
def test_a_key_that_is_always_null(preset: str, help: str) -> None:
    assert found(preset) == [("SM311", HEAVY, help)]


@pytest.mark.parametrize(
    ("preset", "code", "out", "old", "new"),
    [
        ("{type: float<kg>?, value: 2.0}", HEAVY, "mass", "", ""),
        (NULL, "ud.rack_mass is not None and ud.rack_mass > 6.0", "mass", "", ""),
        (NULL, HEAVY, "weight", "", ""),  # another word
        (NULL, HEAVY, "mass", "template: Lift\n",
         "template: Lift\n      remapping: {mass: rack_mass}\n"),
        (NULL, HEAVY, "mass", "userdata:", "input_keys: [rack_mass]\nuserdata:"),
        (NULL, "ud.rack_mass > ud.mass", "mass", "[rack_mass]", "[rack_mass, mass]"),
    ],
)  # fmt: skip
def test_a_key_that_can_have_a_value(preset: str, code: str, out: str, old: str, new: str) -> None:
    assert [item for item in found(preset, code, out, old, new) if item[0] == "SM311"] == []


INSIDE = """\
name: rack
template: Base
outcomes: [light, heavy]
userdata:
  rack_mass: {type: float<kg>?, value: null}
states:
  - LIFT:
      template: Lift
      transitions: {lifted: JUDGE}
  - JUDGE:
      template: StateMachine
      outcomes: [light, heavy]
      input_keys: [weight]
      remapping: {weight: rack_mass}
      states:
        - KNOWN:
            template: ConditionalOutcomeState
            outcomes: [known]
            input_keys: [weight]
            callbacks: {known: 'lambda ud: FIRST'}
            default_outcome: open
            transitions: {known: CHECK, open: CHECK}
        - CHECK:
            template: ConditionalOutcomeState
            outcomes: [too_heavy]
            input_keys: [weight]
            callbacks: {too_heavy: 'lambda ud: ud.weight > 600.0'}
            default_outcome: ok
            transitions: {too_heavy: heavy, ok: light}
"""


@pytest.mark.parametrize(
    ("first", "expected"),
    [("True", [("SM311", "ud.weight > 600.0", HELP)]), ("ud.weight is not None", [])],
)
def test_a_key_of_a_container_around(first: str, expected: list[tuple[str, str, str]]) -> None:
    files = {"main.yml": INSIDE.replace("FIRST", first),
             "templates/Lift.yml": LIFT.replace("OUT", "mass")}  # fmt: skip
    assert [item for item in reported(files) if item[0] == "SM311"] == expected
