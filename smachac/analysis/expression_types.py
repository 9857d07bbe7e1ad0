"""Types of values and of portable expressions, inferred without evaluation.

An unknown type is `any`. The types of literals are exact (see type_lattice.py), so that `[x, y, z]`
fits every type that three numbers can be written for.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping

from smachac.analysis.type_lattice import (
    BOOL,
    DEEPEST,
    DICT,
    FLOAT,
    INT,
    LIST,
    POINT,
    QUATERNION,
    STR,
    fields,
    inside,
    item_of,
    items,
    joined,
    mapping,
    mapping_type,
    plain,
    present,
    tuple_type,
    type_of_literal,
    unit_of,
    widened,
)
from smachac.diagnostics.source import assert_never
from smachac.ir.expressions import (
    Attribute,
    Binary,
    Boolean,
    Call,
    Compare,
    Conditional,
    Constant,
    DictDisplay,
    Expr,
    Index,
    Lambda,
    ListDisplay,
    Name,
    TupleDisplay,
    Unary,
    dotted,
    parts,
)
from smachac.ir.nodes import Expression
from smachac.ir.script_code import script_code
from smachac.ir.types import ANY, Type

Names = Mapping[str, Type]
"""What names stand for; userdata is a record."""

METRES = Type("float", ("m",))


def type_of(expr: Expr, names: Names) -> Type:
    """The type of an expression over names; `any` if it is unknown.

    Total: code that would fail has the type `any`. A lambda is `any`; its body has a type.
    """
    match expr:
        case Constant(value):
            return type_of_literal(value)
        case Name(name):
            return names.get(name, ANY)
        case Attribute(value, name):
            return _attribute(type_of(value, names), name)
        case Index(value, index):
            return _item(type_of(value, names), type_of(index, names))
        case Call():
            return _call(expr, names)
        case Lambda():
            return ANY
        case Conditional(_, then, otherwise):
            # The test may well be whether there is anything: what is there counts.
            return joined(present(type_of(branch, names)) for branch in (then, otherwise))
        case ListDisplay(found) | TupleDisplay(found):
            return tuple_type((type_of(item, names) for item in found), len(found))
        case DictDisplay(entries):
            return _display(entries, names)
        case Unary(word, operand):
            return _unary(word, operand, names)
        case Binary(word, left, right):
            return _binary(word, type_of(left, names), type_of(right, names))
        case Compare():
            return BOOL
        case Boolean(word, operands):
            *first, last = (type_of(operand, names) for operand in operands)
            return joined([*(map(present, first) if word == "or" else first), last])
    return assert_never(expr)


def type_of_call(expression: Expression, userdata: Names) -> Type:
    """The type of what a function of the script returns, over the types of the keys it reads."""
    tree = script_code(expression.text).portable
    if tree is None:
        return STR if _is_format(expression.text) else ANY
    body, parameters = body_of(tree)
    keys = mapping(userdata.items())
    return limited(type_of(body, dict.fromkeys(parameters, keys)))


def _is_format(text: str) -> bool:
    """Whether code is a function that returns an f-string, which is not portable."""
    tree = script_code(text).tree if "{" in text else None
    return isinstance(tree, ast.Lambda) and isinstance(tree.body, ast.JoinedStr)


def keys_read(expression: Expression) -> frozenset[str]:
    """The keys of the userdata that a function of the script names."""
    tree = script_code(expression.text).portable
    if tree is None:
        return frozenset()
    body, parameters = body_of(tree)
    return frozenset(keys_named(body, parameters))


def keys_named(expr: Expr, parameters: tuple[str, ...]) -> tuple[str, ...]:
    """The keys that an expression reads of userdata, which has these names, each once."""
    found: dict[str, None] = {}
    todo = [expr]
    while todo:
        expr = todo.pop()
        match expr:
            case Attribute(Name(name), key) if name in parameters:
                found[key] = None
            case Index(Name(name), Constant(str(key))) if name in parameters:
                found[key] = None
        todo.extend(reversed(parts(expr)))
    return tuple(found)


def body_of(tree: Expr) -> tuple[Expr, tuple[str, ...]]:
    """The body of a function over userdata, and the names of its parameter (see `called`)."""
    if isinstance(tree, Lambda):
        return tree.body, (tree.parameter,) if tree.parameter else ()
    return tree, ("ud", "userdata")


def limited(type_: Type, depth: int = DEEPEST) -> Type:
    """A type cut off where it is too deep, so that `xs = [xs]` comes to an end."""
    if depth == 0:
        return ANY
    args = (limited(arg, depth - 1) if isinstance(arg, Type) else arg for arg in type_.args)
    return Type(type_.name, tuple(args)) if type_.args else type_


def _attribute(owner: Type, name: str) -> Type:
    if owner.name == "mapping":
        return fields(owner).get(name, ANY)
    return ATTRIBUTES.get(owner.name, {}).get(name, ANY)


ATTRIBUTES: Mapping[str, Mapping[str, Type]] = {
    "Point": dict.fromkeys("xyz", METRES),
    "Quaternion": dict.fromkeys("xyzw", FLOAT),
    "Pose": {"position": POINT, "orientation": QUATERNION},
    "Transform": {"translation": ANY, "rotation": QUATERNION},
    "PoseStamped": {"header": ANY, "pose": Type("Pose")},
    "JointState": {
        "header": ANY,
        "name": Type("list", (STR,)),
        **dict.fromkeys(("position", "velocity", "effort"), Type("list", (FLOAT,))),
    },
}
"""The attributes of the structs, as in ROS (geometry_msgs, sensor_msgs)."""

POSE = {0: POINT, 1: QUATERNION}


def _item(owner: Type, index: Type) -> Type:
    """What stands at a place of a list, or under a name of a mapping."""
    (known,) = index.args if index.name == "literal" and len(index.args) == 1 else (None,)
    match owner.name:
        case "tuple" if isinstance(known, int):
            found = items(owner)
            return found[known] if -len(found) <= known < len(found) else ANY
        case "tuple" | "list" | "array":
            return item_of(owner)
        case "mapping" | "record":
            return fields(owner).get(known, ANY) if isinstance(known, str) else ANY
        case "dict":
            return inside(owner)
        case "str":
            return STR
        case "Point" | "Quaternion":
            return METRES if owner == POINT else FLOAT
        case "Pose" if isinstance(known, int):
            return POSE.get(known, ANY)
    return ANY


def _display(entries: tuple[tuple[Expr, Expr], ...], names: Names) -> Type:
    found = [(key, type_of(value, names)) for key, value in entries]
    if all(isinstance(key, Constant) and isinstance(key.value, str) for key, _ in found):
        return mapping_type(
            (str(key.value), type_) for key, type_ in found if isinstance(key, Constant)
        )
    return DICT


def _unary(word: str, operand: Expr, names: Names) -> Type:
    if word == "not":
        return BOOL
    if isinstance(operand, Constant) and type(operand.value) is int:
        return Type("literal", (-operand.value if word == "-" else operand.value,))
    return _number(type_of(operand, names))


def _number(type_: Type) -> Type:
    """A number as arithmetic sees it; `any` where it is none."""
    if type_ == BOOL:
        return INT
    found = plain(type_)
    return found if found.name in ("int", "float") else ANY


def _binary(word: str, left: Type, right: Type) -> Type:
    one, other = _number(left), _number(right)
    if ANY not in (one, other):
        return _arithmetic(word, one, other)
    first, second = plain(left), plain(right)
    match word, first.name, second.name:
        case "+", "str", "str":
            return STR
        case "+", "list" | "array", "list" | "array":
            both = [item_of(type_) for type_ in (left, right) if type_.args]
            return Type("list", (widened(joined(both)),)) if both else LIST
        case ("*", "str", "int") | ("*", "int", "str") | ("%", "str", _):
            return STR
        case "*", "list" | "array", "int":
            return Type("list", (widened(inside(first)),))
    return ANY


def _arithmetic(word: str, one: Type, other: Type) -> Type:
    whole = one.name == other.name == "int"
    if word in ("+", "-", "%"):
        units = {unit_of(one), unit_of(other)} - {""}
        return Type("int" if whole else "float", tuple(units) if len(units) == 1 else ())
    if word == "**" and whole:
        # A negative power of a whole number is none.
        return ANY
    return INT if whole and word != "/" else FLOAT


def _call(expr: Call, names: Names) -> Type:
    match expr.function:
        case Attribute(Constant(str()), "format" | "join"):
            return STR
    text = dotted(expr.function)
    given = [type_of(argument, names) for argument in expr.arguments]
    if text is None or text.partition(".")[0] in names or text not in RESULTS:
        return ANY
    return RESULTS[text](given)


def _list_of(given: list[Type]) -> Type:
    item = item_of(given[0]) if given else ANY
    return LIST if item == ANY else Type("list", (widened(item),))


def _extreme(given: list[Type]) -> Type:
    return item_of(given[0]) if len(given) == 1 else widened(joined(given))


def _sum(given: list[Type]) -> Type:
    return _number(item_of(given[0])) if len(given) == 1 else ANY


RESULTS: Mapping[str, Callable[[list[Type]], Type]] = {
    "abs": lambda given: _number(given[0]) if given else ANY,
    "bool": lambda given: BOOL,
    "dict": lambda given: DICT,
    "float": lambda given: FLOAT,
    "int": lambda given: INT,
    "len": lambda given: INT,
    "list": _list_of,
    "max": _extreme,
    "min": _extreme,
    "range": lambda given: Type("list", (INT,)),
    "round": lambda given: INT if len(given) == 1 else RESULTS["abs"](given),
    "sorted": _list_of,
    "str": lambda given: STR,
    "sum": _sum,
    "tuple": _list_of,
}
"""What the functions that every expression may call return."""
