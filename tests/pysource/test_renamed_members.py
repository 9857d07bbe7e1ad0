"""Names that a module of the project no longer has, because a definition was renamed."""

from __future__ import annotations

import pytest

from tests.pysource.test_call_slips import CLASS, MAIN, TYPE
from tests.trust.project_text import analysed

HELPERS = """\
LIMIT = 3


def sharp_enough(image, threshold):
    return image > threshold


def moisture_of(image):
    return image / 2


def _hidden(image, threshold):
    return image
"""
USED = "from cell.helpers import moisture_of, {name}"
CALL = "print(moisture_of(userdata.n), {name}(userdata.n, 2))"


def help_of(name: str, helpers: str = HELPERS, call: str = CALL, **others: str) -> list[str]:
    text = CLASS.replace("import enum", f"import enum\n{USED.format(name=name)}")
    files = {"main.yml": MAIN, "templates/Mark.yml": TYPE, "cell/__init__.py": "",
             "cell/mark.py": text.replace("BODY", call.format(name=name)),
             "cell/helpers.py": helpers,
             **{f"cell/{file}.py": each for file, each in others.items()}}  # fmt: skip
    return [f"{each.code} {each.help}" for each in analysed(files).report]


@pytest.mark.parametrize("name", ["is_sharp", "sharpness_test", "in_focus", "enough_light"])
def test_the_function_that_nothing_uses(name: str) -> None:
    (help,) = help_of(name)
    line = CLASS.split("BODY")[0].count("\n") + 2
    assert help == f"SM608 did you mean `sharp_enough`? Write it here and in line {line}"


CORRECT = "SM608 correct the name, or define it in `cell/helpers.py`"


@pytest.mark.parametrize(
    ("name", "helpers", "call", "others"),
    [
        ("in_focus", HELPERS, "print(moisture_of(userdata.n), {name}(userdata.n))", {}),
        ("is_sharp", HELPERS, CALL, {"other": "from cell.helpers import sharp_enough"}),
        ("in_focus", f"{HELPERS}\n\ndef other(one, two):\n    return one\n", CALL, {}),
        ("not_sharp_enough_x", HELPERS, CALL, {}),
        ("top_limit", HELPERS.replace("sharp_enough", "_sharp"), CALL, {}),
    ],
)
def test_no_certain_function(name: str, helpers: str, call: str, others: dict[str, str]) -> None:
    assert help_of(name, helpers, call, **others) == [CORRECT]


def test_python_cannot_import_it() -> None:
    text = CLASS.replace("import enum", f"import enum\n{USED.format(name='is_sharp')}")
    files = {"main.yml": MAIN, "templates/Mark.yml": TYPE, "cell/__init__.py": "",
             "cell/mark.py": text.replace("BODY", "return None"),
             "cell/helpers.py": HELPERS}  # fmt: skip
    for module, error in (("helpers", "ImportError"), ("helprs", "ModuleNotFoundError")):
        code = files["cell/mark.py"].replace("cell.helpers", f"cell.{module}")
        report = analysed({**files, "cell/mark.py": code}).report
        (found,) = [each for each in report if each.code == "SM608"]
        assert found.effect == f"Python raises {error}: the program stops when it starts"
