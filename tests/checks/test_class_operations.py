"""Operations on keys in the Python class of a state type, against the types in its interface, and
results of functions that return nothing."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done]
userdata:
  count: 0
  order: {type: "list[str]", value: [bolt]}
  offset: {type: "float<m>[2]", value: [0.1, 0.2]}
  points: {type: "list[float[2]]", value: [[0.1, 0.2]]}
output_keys: [out]
states:
  - WORK:
      template: Work
      input_keys: [count, order, offset, points]
      output_keys: [out]
      transitions: {worked: done}
"""
INTERFACE = """\
input_keys: {count: int, order: "list[str]", offset: "float<m>[2]", points: "list[float[2]]"}
output_keys: {out: OUT}
outcomes: {worked: {}}
code: {python: "cell.states:Work"}
"""
CLASS = """\
import math

import smach

from cell import tools


class Work(smach.State):
    def __init__(self):
        super().__init__(
            outcomes=["worked"],
            input_keys=["count", "order", "offset", "points"],
            output_keys=["out"],
        )
        self.scale = 2.0

    def execute(self, userdata):
        userdata.out = OUT
CODE
        return "worked"
"""
TOOLS = """\
MASSES = {"bolt": 0.1}


def mass_of(name):
    MASSES.get(name)


def log(name):
    print(name)


def later(name):
    raise NotImplementedError


def good(name):
    return MASSES.get(name)
"""


def reported(code: str, out: str = "None", type_: str = "any") -> list[tuple[str, str, str]]:
    body = "\n".join(f"        {line}" for line in code.split("\n"))
    files = {
        "main.yml": MAIN,
        "templates/Work.yml": INTERFACE.replace("OUT", type_),
        "cell/__init__.py": "",
        "cell/states.py": CLASS.replace("CODE", body).replace("OUT", out),
        "cell/tools.py": TOOLS,
    }
    return [
        (item.code, item.span.text, item.help or "")
        for item in analysed(files).report
        if item.code not in ("SM305", "SM306")
    ]


# --- operations


@pytest.mark.parametrize(
    ("code", "expression", "help"),
    [
        ("if userdata.count >= userdata.order:\n    pass", "userdata.count >= userdata.order",
         "write `userdata.count >= len(userdata.order)`"),
        ("if userdata.order < 3 and self.scale:\n    pass", "userdata.order < 3",
         "write `len(userdata.order) < 3`"),
        ("if userdata.offset > 0.1:\n    pass", "userdata.offset > 0.1",
         "write `len(userdata.offset) > 0.1`"),
    ],
)  # fmt: skip
def test_a_comparison_of_a_number_and_a_list(code: str, expression: str, help: str) -> None:
    assert reported(code) == [("SM311", expression, help)]


def test_a_sum_of_a_number_and_a_text() -> None:
    found = reported('print(userdata.count + "bolts")')
    assert [item[:2] for item in found] == [("SM311", 'userdata.count + "bolts"')]


@pytest.mark.parametrize(
    "code",
    [
        "if userdata.count >= len(userdata.order):\n    pass",
        "if userdata.order[0] > 'bolt':\n    pass",
        "if isinstance(userdata.order, int) and userdata.count > userdata.order:\n    pass",
        "try:\n    print(userdata.count > userdata.order)\nexcept TypeError:\n    pass",
        "order = tools.good(userdata.order)\nif userdata.count > order:\n    pass",
        "print(userdata.offset * 2.0)",  # perhaps an array of numpy
        "if tools.good(userdata.offset > 0.1):\n    pass",
    ],
)
def test_an_operation_that_fits_or_is_not_known(code: str) -> None:
    assert reported(code) == []


# --- unpacking


@pytest.mark.parametrize(
    ("code", "names"),
    [
        ("x, y, z = userdata.offset", "x, y, z"),
        ("[x] = userdata.offset", "[x]"),
        ("for x, y, z in userdata.points:\n    print(x, y, z)", "x, y, z"),
        ("x, y, z = userdata.points[0]", "x, y, z"),
        ("print([x for at, (x, y, z) in enumerate(userdata.points)])", "(x, y, z)"),
    ],
)
def test_another_number_of_names(code: str, names: str) -> None:
    help = "write 2 names, or correct the type in the interface"
    assert reported(code) == [("SM311", names, help)]


@pytest.mark.parametrize(
    "code",
    [
        "x, y = userdata.offset",
        "x, *more = userdata.offset",
        "a, b, c = userdata.order",
        "for x, y in userdata.points:\n    print(x, y)",
        "try:\n    x, y, z = userdata.offset\nexcept ValueError:\n    pass",
        "x, y, z = (*userdata.offset, 0.0)",
    ],
)
def test_names_that_fit_or_are_not_known(code: str) -> None:
    assert reported(code) == []


# --- one number in place of a list


@pytest.mark.parametrize(
    ("code", "out", "found"),
    [
        ("", "-1.0 * math.hypot(*userdata.offset)", True),
        ("sign = -1.0 if self.scale else 1.0\nuserdata.out = sign * math.pi", "[1.0, 2.0]", True),
        ("", "abs(-3 + len(userdata.order))", True),
        ("", "self.scale * math.pi", False),  # perhaps an array
        ("", "[math.pi, math.tau]", False),
        ("sign = 1.0\nsign = tools.good(sign)\nuserdata.out = sign", "[1.0, 2.0]", False),
    ],
)
def test_one_number_for_a_list(code: str, out: str, found: bool) -> None:
    codes = [item[0] for item in reported(code, out, '"float<m>[2]"')]
    assert codes == (["SM304"] if found else [])


@pytest.mark.parametrize("type_", ["float", "int", '"float?"', "any"])
def test_one_number_for_a_number(type_: str) -> None:
    assert reported("", "2 * math.hypot(*userdata.offset)", type_) == []


@pytest.mark.parametrize(
    ("code", "out", "type_", "help"),
    [
        ("masses = []\nmasses.append(self.scale)\nuserdata.out = masses", "1.0", "float",
         'write `out: "list[float]"` in the interface, or write one item of the list'),
        ("", "[tools.good(each) for each in userdata.order]", "str",
         'write `out: "list[str]"` in the interface, or write one item of the list'),
        ("masses = {}\nuserdata.out = masses", "[1.0]", '"list[float]"',
         "write a value of the type `list[float]`, such as `[1.5, 1.5]`, or correct the interface"),
        ("masses = []\nuserdata.out = masses", "[1.0]", '"list[float]"', ""),
        ("masses = []\nuserdata.out = masses[0]", "1.0", "float", ""),
        ("masses = []\nmasses = tools.good(masses)\nuserdata.out = masses", "1.0", "float", ""),
        ("masses = {}\nuserdata.out = masses", "{}", "{a: float}", ""),
    ],
)  # fmt: skip
def test_a_collection_for_one_value(code: str, out: str, type_: str, help: str) -> None:
    found = [item for item in reported(code, out, type_) if item[0] == "SM304"]
    assert [item[2] for item in found] == ([help] if help else [])


@pytest.mark.parametrize(
    ("out", "type_", "help"),
    [
        ('{"mass": self.scale, "sise": 1.0}', "{type: {mass: float, size: float}}",
         'write `"size"` in place of `"sise"`'),
        ('{"mass": self.scale}', "{type: {mass: float, size: float}}",
         'add `"size": ...` to the dictionary'),
        ('{"mass": self.scale, "size": self.scale}', "{type: {mass: float, size: float}}", ""),
        ('{**self.scale, "size": 1.0}', "{type: {mass: float, size: float}}", ""),
        ("[self.scale, 1.0, 2.0]", '"float[2]"', "write a value of the type `float[2]`"),
        ("[self.scale, 1.0]", '"float[2]"', ""),
        ("[*self.scale, 1.0, 2.0]", '"float[2]"', ""),
    ],
)  # fmt: skip
def test_a_collection_with_wrong_parts(out: str, type_: str, help: str) -> None:
    found = [item for item in reported("", out, type_) if item[0] == "SM304"]
    assert [item[2][: len(help)] for item in found] == ([help] if help else [])


# --- comparisons with words


@pytest.mark.parametrize(
    ("code", "word", "help"),
    [
        ('if self.side == "lift":\n    pass', '"lift"', 'write `"left"`, or correct the interface'),
        ('if "up" != self.side:\n    pass', '"up"',
         'write `"left"` or `"right"`, or correct the interface'),
        ('if self.side == "left" or self.side == "up":\n    pass', '"up"',
         'write `"right"`, or correct the interface'),
        ("if self.side in ('up', 'left', 'right'):\n    pass", "'up'",
         "write `'left'` or `'right'`, or correct the interface"),
        ('match self.side:\n    case "left" | "up":\n        pass', '"up"',
         'write `"right"`, or correct the interface'),
        ('if userdata.order == "bolts":\n    pass', '"bolts"',
         'write `"bolt"`, or correct the interface'),
        ('if userdata.order == "bolt" or self.side == "right":\n    pass', "", ""),
        ('if self.side == "none":\n    pass', "", ""),  # the default value
        ('self.side = self.side.upper()\nif self.side == "LEFT":\n    pass', "", ""),
        ('userdata.order = "x"\nif userdata.order == "x":\n    pass', "", ""),
        ('if other(self.side) == "up":\n    pass', "", ""),
    ],
)  # fmt: skip
def test_a_comparison_with_a_word(code: str, word: str, help: str) -> None:
    body = "\n".join(f"        {line}" for line in code.split("\n"))
    head = '    def __init__(self, side="none"):\n        self.side = side'
    interface = INTERFACE.replace("OUT", "any").replace('order: "list[str]"',
                                                        'order: "one_of[bolt, nut]"')  # fmt: skip
    files = {
        "main.yml": MAIN.replace('"list[str]", value: [bolt]', '"one_of[bolt, nut]", value: bolt'),
        "templates/Work.yml": f"variables: {{side: {{one_of: [left, right]}}}}\n{interface}",
        "cell/__init__.py": "",
        "cell/states.py": CLASS.replace("    def __init__(self):", head)
        .replace("CODE", body).replace("OUT", "None"),
    }  # fmt: skip
    files["main.yml"] = files["main.yml"].replace(
        "template: Work", "template: Work\n      side: left"
    )
    report = [item for item in analysed(files).report if item.code == "SM312"]
    assert [(item.span.text, item.help) for item in report] == ([(word, help)] if help else [])


# --- words that a dictionary lacks


@pytest.mark.parametrize(
    ("table", "code", "found"),
    [
        ('{"left": 1, "rihgt": 2}', "print(SIDES[self.side])",
         [('"rihgt"', 'write `"right"` in place of `"rihgt"` in `SIDES`')]),
        ('{"right": 1}', "print(SIDES[self.side])",
         [("SIDES[self.side]", 'add `"left": ...` to `SIDES`')]),
        ('{"left": 1}', "print(SIDES[self.side])", []),  # no state is at the right
        ('{"left": 1, "right": 2}', "print(SIDES[self.side])", []),
        ('{"right": 1}', "if self.side != 'left':\n    print(SIDES[self.side])", []),
        ('{"right": 1}', "try:\n    print(SIDES[self.side])\nexcept KeyError:\n    pass", []),
        ('{"right": 1}', "print(SIDES.get(self.side))", []),
        ('{"right": 1}', "if self.side in SIDES:\n    print(SIDES[self.side])", []),
        ('{"right": 1}', "print(SIDES[self.side])\nSIDES['left'] = 1", []),
        ("{}", "print(SIDES[self.side])", []),
    ],
)  # fmt: skip
def test_a_word_that_a_dictionary_lacks(
    table: str, code: str, found: list[tuple[str, str]]
) -> None:
    body = "\n".join(f"        {line}" for line in code.split("\n"))
    head = f"SIDES = {table}\n\n\nclass Work"
    init = "    def __init__(self, side):\n        self.side = side"
    interface = INTERFACE.replace("OUT", "any")
    files = {
        "main.yml": MAIN.replace("template: Work", "template: Work\n      side: left"),
        "templates/Work.yml": f"variables: {{side: {{one_of: [left, right]}}}}\n{interface}",
        "cell/__init__.py": "",
        "cell/states.py": CLASS.replace("class Work", head)
        .replace("    def __init__(self):", init)
        .replace("CODE", body)
        .replace("OUT", "None"),
    }
    report = [item for item in analysed(files).report if item.code == "SM311"]
    assert [(item.span.text, item.help) for item in report] == found


# --- angles in degrees


@pytest.mark.parametrize(
    ("code", "help"),
    [
        ("if userdata.turn > 90:\n    pass", "write `1.571`, which is 90 degrees in radians"),
        ("if -90.0 < userdata.turn:\n    pass", "write `-1.571`, which is -90 degrees in radians"),
        ("if userdata.turn > 3:\n    pass", ""),
        ("if userdata.turn > 6.5:\n    pass", ""),
        ("if math.degrees(userdata.turn) > 90:\n    pass", ""),
        ("if userdata.count > 90:\n    pass", ""),
    ],
)
@pytest.mark.parametrize("in_class", [True, False])
def test_an_angle_in_degrees(code: str, help: str, in_class: bool) -> None:
    body = "\n".join(f"        {line}" for line in code.split("\n")) if in_class else ""
    condition = code.split("\n")[0].removeprefix("if ").removesuffix(":")
    condition = condition.replace("userdata", "ud") if not in_class else "ud.count > 1"
    main = MAIN.replace("count: 0", 'count: 0\n  turn: {type: "float<rad>", value: 0.5}')
    main = main.replace("[count, order", "[turn, count, order").replace("worked: done", "worked: B")
    main += f"""\
  - B:
      template: ConditionalOutcomeState
      input_keys: [turn, count]
      outcomes: [yes]
      callbacks: {{yes: 'lambda ud: {condition}'}}
      default_outcome: no
      transitions: {{yes: done, no: done}}
"""
    files = {
        "main.yml": main.replace("[yes]", "[high]").replace("{yes:", "{high:").replace("no", "low"),
        "templates/Work.yml": INTERFACE.replace("OUT", "any")
        .replace("keys: {count", "keys: {turn: float<rad>, count"),
        "cell/__init__.py": "",
        "cell/states.py": CLASS.replace("CODE", body).replace("OUT", "None")
        .replace('input_keys=["count"', 'input_keys=["turn", "count"'),
    }  # fmt: skip
    found = [item.help for item in analysed(files).report if item.code == "SM522"]
    assert found == ([help] if help else [])


# --- entries of mappings of the script


@pytest.mark.parametrize(
    ("code", "main", "found"),
    [
        ('print(userdata.door["widt"])', "", [("SM311", '"widt"', "did you mean `width`?")]),
        ('door = userdata.door\nprint(door["x"])', "",
         [("SM311", '"x"', "use one of its entries: `name`, `width`")]),
        ("", "ud.door['widt'] > 1", [("SM311", "ud.door['widt']", "did you mean `width`?")]),
        ("", "ud.door.get('widt') == 1", []),
        ("", "'widt' in ud.door and ud.door['widt'] > 1", []),
        ('print(userdata.door["width"])', "ud.door['width'] > 1", []),
        ('if "x" in userdata.door:\n    print(userdata.door["x"])', "", []),
        ('userdata.door["x"] = 1', "ud.door['x'] > 1", []),
        ("userdata.door[self.scale] = 1", "ud.door['x'] > 1", []),
        ("door = userdata.door\ndoor.update(x=1)", "ud.door['x'] > 1", []),
        ("tools.good(userdata.door)", "ud.door['x'] > 1", []),
        ('print(userdata.door["name"])', "ud.door['widt'] > 1",
         [("SM311", "ud.door['widt']", "did you mean `width`?")]),
    ],
)  # fmt: skip
def test_an_entry_of_a_mapping(code: str, main: str, found: list[tuple[str, str, str]]) -> None:
    body = "\n".join(f"        {line}" for line in code.split("\n"))
    text = MAIN.replace("count: 0", "count: 0\n  door: {name: front, width: 0.9}")
    text = text.replace("[count, order", "[door, count, order").replace("worked: done", "worked: B")
    text += f"""\
  - B:
      template: ConditionalOutcomeState
      input_keys: [door]
      outcomes: [wide]
      callbacks:
        wide: "lambda ud: {main or "ud.door['width'] > 1"}"
      default_outcome: small
      transitions: {{wide: done, small: done}}
"""
    interface = INTERFACE.replace("OUT", "any").replace("keys: {count", "keys: {door: any, count")
    files = {
        "main.yml": text,
        "templates/Work.yml": interface,
        "cell/__init__.py": "",
        "cell/states.py": CLASS.replace("CODE", body).replace("OUT", "None")
        .replace('input_keys=["count"', 'input_keys=["door", "count"'),
        "cell/tools.py": TOOLS,
    }  # fmt: skip
    report = [item for item in analysed(files).report if item.code == "SM311"]
    assert [(item.code, item.span.text, item.help) for item in report] == found


# --- results of functions that return nothing

RETURN = "write `return MASSES.get(name)`"


@pytest.mark.parametrize(
    "code",
    [
        'userdata.out = [{"mass": tools.mass_of("bolt")}]',
        'parts = []\nparts.append(tools.mass_of("bolt"))\nuserdata.out = parts',
        'mass = tools.mass_of("bolt")\nuserdata.out = {"mass": mass}',
        'if tools.mass_of("bolt") > 0.1:\n    pass',
        'userdata.out = tools.mass_of("bolt")',
    ],
)
def test_a_result_that_is_none(code: str) -> None:
    assert reported(code) == [("SM609", "MASSES.get(name)", RETURN)]


def test_a_function_whose_last_line_is_no_value() -> None:
    found = reported('userdata.out = [tools.log("bolt")]')
    assert found == [("SM609", "log", "end `log` with `return ...`")]


@pytest.mark.parametrize(
    "code",
    [
        'userdata.out = [tools.good("bolt")]',
        'userdata.out = [tools.later("bolt")]',  # not written yet
        'tools.mass_of("bolt")',
        "[tools.log(name) for name in userdata.order]",
        '[tools.log("bolt"), tools.log("nut")]',
        'done = tools.log("bolt")',
        'tools = self.scale\nuserdata.out = [tools.log("bolt")]',
    ],
)
def test_a_result_that_nothing_uses_or_that_is_a_value(code: str) -> None:
    assert [item for item in reported(code) if item[0] == "SM609"] == []
