"""The built-in functions of Python that the partial evaluator models, and the methods of texts and
collections."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from typing import Any

from smachac.diagnostics.source import Span
from smachac.pysource.machines.operations import (
    LONGEST_TEXT,
    MOST_BITS,
    MOST_ITEMS,
    bounded,
    has_width,
)
from smachac.pysource.machines.values import (
    NONE,
    UNKNOWN,
    Arguments,
    Class,
    Const,
    DictValue,
    Function,
    Instance,
    Interpreter,
    LibraryClass,
    ListValue,
    Method,
    Native,
    OneOf,
    OpenText,
    TupleValue,
    Unknown,
    Value,
    alternatives,
    one_of,
    open_text,
    sequence,
    truth,
)

_PURE = ("rospy", "rclpy", "logging", "time", "tf", "tf2_ros", "math", "os", "sys", "json", "re",
         "threading", "signal", "actionlib", "smach_viewer", "roslaunch", "argparse", "random",
         "copy", "numpy", "typing", "datetime", "pprint")  # fmt: skip
"""Packages whose functions do not change lists and dictionaries that they get."""


def is_pure(reason: str) -> bool:
    """Whether an unknown value belongs to a package whose functions change no argument."""
    return reason.partition(".")[0] in _PURE


def _range(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    bounds = [value.value for value in arguments.positional if isinstance(value, Const)]
    if len(bounds) != len(arguments.positional) or not all(isinstance(b, int) for b in bounds):
        return UNKNOWN
    try:
        found = range(*bounds)  # type: ignore[arg-type]
    except (TypeError, ValueError):
        return UNKNOWN
    return UNKNOWN if len(found) > MOST_ITEMS else TupleValue(tuple(Const(n) for n in found))


def _made(kind: str) -> Callable[[Interpreter, Arguments, Span | None], Value]:
    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        items = sequence(arguments.positional[0]) if arguments.positional else ()
        if items is None or arguments.open:
            return UNKNOWN if kind == "tuple" else ListValue({"items": UNKNOWN}, span, kind)
        if kind == "tuple":
            return TupleValue(items, span)
        if kind == "set":
            items = tuple(dict.fromkeys(items))
        return ListValue({"items": items}, span, kind)

    return run


def _dict(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    made = DictValue({"items": {}}, span)
    for value in arguments.positional[:1]:
        if isinstance(value, DictValue):
            evaluator.update(made, value)
            continue
        pairs: dict[Any, tuple[Value, Value]] | None = {}
        for item in sequence(value) or ():
            both = sequence(item)
            if both is None or len(both) != 2 or not isinstance(both[0], Const) or pairs is None:
                pairs = None
            else:
                pairs[both[0].value] = both[0], both[1]
        known = pairs is not None and sequence(value) is not None
        evaluator.heap.set(made.slots, "items", pairs if known else UNKNOWN)
    named = {name: (Const(name, span), value) for name, value in arguments.named}
    if named:
        evaluator.update(made, DictValue({"items": named}))
    if arguments.open:
        evaluator.heap.set(made.slots, "items", UNKNOWN)
    return made


def _enumerate(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    items = sequence(arguments.get(0, "iterable"))
    start = arguments.get(1, "start", Const(0))
    if items is None or not isinstance(start, Const) or not isinstance(start.value, int):
        return UNKNOWN
    first = start.value
    return TupleValue(tuple(TupleValue((Const(first + i), item)) for i, item in enumerate(items)))


def _zip(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    rows = [sequence(value) for value in arguments.positional]
    if arguments.open or any(row is None for row in rows):
        return UNKNOWN
    known = [row for row in rows if row is not None]
    return TupleValue(tuple(TupleValue(items) for items in zip(*known, strict=False)))


def _len(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    items = sequence(arguments.get(0, "obj"))
    return UNKNOWN if items is None else Const(len(items))


def _text(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    if not arguments.positional:
        return Const("", span)
    if isinstance(arguments.positional[0], OpenText):
        return arguments.positional[0]
    return one_of(
        Const(str(value.value), value.span or span) if isinstance(value, Const) else UNKNOWN
        for value in alternatives(arguments.positional[0])
    )


def _number(make: Callable[[Any], Any]) -> Callable[[Interpreter, Arguments, Span | None], Value]:
    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        value = arguments.get(0, "x")
        if not isinstance(value, Const) or len(arguments.positional) > 1 or arguments.named:
            return UNKNOWN
        if isinstance(value.value, str) and len(value.value) > MOST_BITS // 4:
            return UNKNOWN
        try:
            return bounded(make(value.value), span)
        except (TypeError, ValueError, OverflowError):
            return UNKNOWN

    return run


def _bool(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    known = truth(arguments.positional[0]) if arguments.positional else False
    return UNKNOWN if known is None else Const(known)


def _sorted(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    items = sequence(arguments.get(0, "iterable"))
    if items is None or arguments.named or not all(isinstance(item, Const) for item in items):
        return UNKNOWN
    keyed = [(item.value, item) for item in items if isinstance(item, Const)]
    try:
        ordered = sorted(keyed, key=lambda pair: pair[0])  # type: ignore[arg-type, return-value]
    except TypeError:
        return UNKNOWN
    return evaluator.new_list([item for _, item in ordered])


def _reversed(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    items = sequence(arguments.get(0, "sequence"))
    return UNKNOWN if items is None else TupleValue(items[::-1])


def _getattr(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    owner, name = arguments.get(0, "object"), arguments.get(1, "name")
    if owner is None or not isinstance(name, Const) or not isinstance(name.value, str):
        return UNKNOWN
    if isinstance(owner, Instance | Class | LibraryClass):
        found = evaluator.attribute(owner, name.value, ast.Name("x", ast.Load()), _no_frame())
        if isinstance(found, Unknown) and len(arguments.positional) > 2:
            return UNKNOWN
        return found
    return UNKNOWN


def _no_frame() -> Any:
    from smachac.pysource.machines.values import Frame, ModuleValue

    return Frame({}, ModuleValue("", {}))


def _setattr(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    owner, name = arguments.get(0, "object"), arguments.get(1, "name")
    value = arguments.get(2, "value", UNKNOWN)
    if owner is not None and isinstance(name, Const) and isinstance(name.value, str):
        evaluator.set_attribute(owner, name.value, value or UNKNOWN)
    return NONE


def _isinstance(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    value, kinds = arguments.get(0, "obj"), arguments.get(1, "cls")
    wanted = kinds.items if isinstance(kinds, TupleValue) else (kinds,)
    names = [kind.short for kind in wanted if isinstance(kind, LibraryClass)]
    if len(names) != len(wanted):
        if isinstance(value, Instance) and all(isinstance(k, Class | LibraryClass) for k in wanted):
            order = evaluator.classes(value.cls)
            if any(isinstance(base, Unknown | OneOf) for base in order):
                return UNKNOWN
            return Const(any(base is k or base == k for base in order for k in wanted))
        return UNKNOWN
    match value:
        case Const(value=known):
            return Const(any(type(known).__name__ == name for name in names))
        case ListValue():
            return Const(value.kind in names)
        case TupleValue():
            return Const("tuple" in names)
        case DictValue():
            return Const("dict" in names)
    return UNKNOWN


def _type(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    match arguments.positional:
        case (Const(value=known),) if known is not None:
            return LibraryClass(f"builtins.{type(known).__name__}")
        case (ListValue(kind=kind),):
            return LibraryClass(f"builtins.{kind}")
        case (TupleValue(),):
            return LibraryClass("builtins.tuple")
        case (DictValue(),):
            return LibraryClass("builtins.dict")
        case (Instance(cls=cls),):
            return cls
    return UNKNOWN


def _hasattr(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    """True if the attribute is known; else not known."""
    found = _getattr(evaluator, arguments, span)
    return UNKNOWN if isinstance(found, Unknown | OneOf) else Const(True)


def _map(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    if len(arguments.positional) != 2:
        return UNKNOWN
    items = sequence(arguments.positional[1])
    if items is None:
        return UNKNOWN
    frame = _no_frame()
    return evaluator.new_list(
        [evaluator.call(arguments.positional[0], Arguments((item,)), None, frame) for item in items]
    )


def _nothing(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    return NONE


def _unknown(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    return UNKNOWN


def native(name: str, run: Callable[[Interpreter, Arguments, Span | None], Value]) -> Native:
    return Native(name, run)


BUILTINS: Mapping[str, Value] = {
    **{name: native(name, run) for name, run in {
        "range": _range, "xrange": _range, "enumerate": _enumerate, "zip": _zip, "len": _len,
        "sorted": _sorted, "reversed": _reversed, "getattr": _getattr, "setattr": _setattr,
        "isinstance": _isinstance, "map": _map, "print": _nothing, "iter": lambda e, a, s: (
            a.positional[0] if a.positional else UNKNOWN),
        "abs": _unknown, "min": _unknown, "max": _unknown, "sum": _unknown, "input": _unknown,
        "repr": _unknown, "format": _unknown, "hasattr": _hasattr, "any": _unknown, "all": _unknown,
        "id": _unknown, "hash": _unknown, "type": _type, "open": _unknown, "next": _unknown,
        "callable": _unknown, "issubclass": _unknown, "round": _unknown, "vars": _unknown,
        "filter": _unknown, "chr": _unknown, "ord": _unknown, "dir": _unknown, "divmod": _unknown,
        "pow": _unknown, "eval": _unknown, "globals": _unknown, "locals": _unknown,
        "exit": _nothing, "quit": _nothing,
    }.items()},
    **{name: LibraryClass(f"builtins.{name}") for name in (
        "list", "tuple", "set", "frozenset", "dict", "str", "int", "float", "bool", "object",
        "Exception", "ValueError", "RuntimeError", "KeyError", "TypeError", "unicode",
    )},
}  # fmt: skip
"""The built-in names by name. Those of which nothing is known change none of their arguments."""

MAKERS: Mapping[str, Callable[[Interpreter, Arguments, Span | None], Value]] = {
    "builtins.list": _made("list"),
    "builtins.tuple": _made("tuple"),
    "builtins.set": _made("set"),
    "builtins.frozenset": _made("set"),
    "builtins.dict": _dict,
    "builtins.str": _text,
    "builtins.unicode": _text,
    "builtins.int": _number(int),
    "builtins.float": _number(float),
    "builtins.bool": _bool,
    "collections.OrderedDict": _dict,
    "collections.defaultdict": lambda e, a, s: DictValue({"items": UNKNOWN}),
    "collections.deque": _made("list"),
}
"""What a call of a class of Python makes."""


_TEXT_METHODS = frozenset(
    [
        "upper",
        "lower",
        "title",
        "capitalize",
        "strip",
        "lstrip",
        "rstrip",
        "replace",
        "split",
        "rsplit",
        "partition",
        "rpartition",
        "startswith",
        "endswith",
        "join",
        "format",
        "removeprefix",
        "removesuffix",
        "swapcase",
        "zfill",
        "isdigit",
        "isupper",
        "islower",
        "splitlines",
        "count",
        "find",
        "index",
        "casefold",
        "isalpha",
    ]
)


def attribute_of_value(evaluator: Interpreter, owner: Value, name: str) -> Value:
    """A method of a text or a collection."""
    match owner:
        case Const(value=str()) if name in _TEXT_METHODS:
            return Method(Native(f"str.{name}", _text_method(name)), owner)
        case OpenText(text=text) if name in _CHANGES and text.startswith("{") and text[-1] == "}":
            return Native(name, lambda e, a, s: _changed_text(text, name, a))
        case ListValue() if name in _LIST_METHODS:
            return Method(Native(f"list.{name}", _LIST_METHODS[name]), owner)
        case DictValue():
            if owner.slots.get("$userdata") and name not in _DICT_METHODS:
                return evaluator.item(owner, Const(name))
            if name in _DICT_METHODS:
                return Method(Native(f"dict.{name}", _DICT_METHODS[name]), owner)
        case Function() if name == "__name__":
            return Const(owner.name)
    return UNKNOWN


def _plain(value: Value, opened: list[OpenText]) -> Any:
    """The data of a known value, and of a text with an open part, which `opened` then has. Raises
    ValueError."""
    match value:
        case Const(value=known):
            return known
        case OpenText(text=text):
            opened.append(value)
            return text
        case TupleValue() | ListValue():
            items = sequence(value)
            if items is not None:
                return [_plain(item, opened) for item in items]
    raise ValueError


def _as_value(data: Any, span: Span | None) -> Value:
    if isinstance(data, tuple):
        return TupleValue(tuple(_as_value(item, span) for item in data))
    if isinstance(data, list):
        return ListValue({"items": tuple(_as_value(item, span) for item in data)}, span)
    return Const(data, span)


_CHANGES = frozenset(["upper", "lower", "title", "capitalize", "strip", "swapcase", "casefold"])
"""The methods of a text that make another one."""


def _changed_text(text: str, name: str, arguments: Arguments) -> Value:
    """What a method makes of a parameter."""
    plain = arguments == Arguments() and "{" not in text[1:]
    return open_text(f"{text[:-1]}.{name}()}}") if plain else UNKNOWN


def _text_method(name: str) -> Callable[[Interpreter, Arguments, Span | None], Value]:
    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.positional[0]
        if not isinstance(me, Const) or not isinstance(me.value, str) or arguments.open:
            return UNKNOWN
        try:
            opened: list[OpenText] = []
            given = [_plain(value, opened) for value in arguments.positional[1:]]
            named = {key: _plain(value, opened) for key, value in arguments.named}
            long = _is_long([me.value, *given, *named.values()])
            if long or (name == "format" and has_width(me.value)):
                return UNKNOWN
            found = getattr(me.value, name)(*given, **named)
        except (ValueError, TypeError, LookupError, AttributeError):
            return UNKNOWN
        if isinstance(found, str) and len(found) > LONGEST_TEXT:
            return UNKNOWN
        if opened:
            return open_text(found) if name in ("format", "join") else UNKNOWN
        return _as_value(found, span or me.span)

    return run


def _is_long(parts: list[Any]) -> bool:
    """Whether the result of a method with these texts, lists and numbers can be long."""
    numbers = any(isinstance(part, int) and abs(part) > 1_000 for part in parts)
    return numbers or sum(len(str(part)) for part in parts) > MOST_ITEMS


def _changed(run: Callable[[list[Value], Arguments], Any]) -> Any:
    """A method that changes a list: `run` changes a copy of its items, and returns the result."""

    def method(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        me = arguments.positional[0]
        assert isinstance(me, ListValue)
        items = me.items
        if not isinstance(items, tuple) or arguments.open:
            evaluator.heap.set(me.slots, "items", UNKNOWN)
            return UNKNOWN
        copy = [*items]
        try:
            found = run(copy, arguments.without_first())
        except (ValueError, IndexError, TypeError):
            evaluator.heap.set(me.slots, "items", UNKNOWN)
            return UNKNOWN
        evaluator.heap.set(me.slots, "items", tuple(copy) if len(copy) <= MOST_ITEMS else UNKNOWN)
        return found if found is not None else NONE

    return method


def _index(value: Value | None) -> int:
    if not isinstance(value, Const) or not isinstance(value.value, int):
        raise ValueError
    return value.value


def _append(items: list[Value], arguments: Arguments) -> None:
    items.append(arguments.positional[0])


def _add(items: list[Value], arguments: Arguments) -> None:
    if arguments.positional[0] not in items:
        items.append(arguments.positional[0])


def _extend(items: list[Value], arguments: Arguments) -> None:
    more = sequence(arguments.positional[0])
    if more is None:
        raise ValueError
    items.extend(more)


def _pop(items: list[Value], arguments: Arguments) -> Value:
    return items.pop(_index(arguments.get(0, "index", Const(-1))))


def _known_index(items: list[Value], value: Value) -> int:
    if not isinstance(value, Const) or not all(isinstance(item, Const) for item in items):
        raise ValueError
    return items.index(value)


def _copy(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = arguments.positional[0]
    if isinstance(me, ListValue):
        return ListValue({"items": me.items}, me.span, me.kind)
    return DictValue({"items": me.items}, me.span) if isinstance(me, DictValue) else UNKNOWN


_LIST_METHODS: Mapping[str, Callable[[Interpreter, Arguments, Span | None], Value]] = {
    "append": _changed(_append),
    "add": _changed(_add),
    "extend": _changed(_extend),
    "update": _changed(_extend),
    "insert": _changed(lambda i, a: i.insert(_index(a.positional[0]), a.positional[1])),
    "remove": _changed(lambda i, a: i.__delitem__(_known_index(i, a.positional[0]))),
    "pop": _changed(_pop),
    "clear": _changed(lambda i, a: i.clear()),
    "reverse": _changed(lambda i, a: i.reverse()),
    "sort": lambda e, a, s: _sort(e, a),
    "copy": _copy,
    "index": lambda e, a, s: UNKNOWN,
    "count": lambda e, a, s: UNKNOWN,
    "union": lambda e, a, s: UNKNOWN,
    "difference": lambda e, a, s: UNKNOWN,
    "intersection": lambda e, a, s: UNKNOWN,
}


def _sort(evaluator: Interpreter, arguments: Arguments) -> Value:
    me = arguments.positional[0]
    found = _sorted(evaluator, arguments, None)
    if isinstance(me, ListValue):
        items = sequence(found)
        evaluator.heap.set(me.slots, "items", UNKNOWN if items is None else items)
    return NONE


def _pairs(arguments: Arguments) -> Mapping[Any, tuple[Value, Value]] | None:
    me = arguments.positional[0]
    items = me.items if isinstance(me, DictValue) else None
    return items if isinstance(items, Mapping) else None


def _get(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    pairs, key = _pairs(arguments), arguments.get(1, "key")
    if pairs is None or not isinstance(key, Const):
        return UNKNOWN
    if key.value in pairs:
        return pairs[key.value][1]
    return arguments.get(2, "default", NONE) or NONE


def _set_default(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    pairs, key = _pairs(arguments), arguments.get(1, "key")
    me, value = arguments.positional[0], arguments.get(2, "default", NONE) or NONE
    if pairs is not None and isinstance(key, Const) and isinstance(me, DictValue):
        if key.value in pairs:
            return pairs[key.value][1]
        evaluator.heap.set(me.slots, "items", {**pairs, key.value: (key, value)})
        return value
    if isinstance(me, DictValue):
        evaluator.heap.set(me.slots, "items", UNKNOWN)
    return UNKNOWN


def _set_key(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    pairs, key = _pairs(arguments), arguments.get(1, "key")
    me, value = arguments.positional[0], arguments.get(2, "value", UNKNOWN) or UNKNOWN
    if isinstance(me, DictValue):
        known = pairs is not None and isinstance(key, Const)
        items = {**pairs, key.value: (key, value)} if known else UNKNOWN  # type: ignore[union-attr,dict-item]
        evaluator.heap.set(me.slots, "items", items)
    return NONE


def _update(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    me = arguments.positional[0]
    if isinstance(me, DictValue):
        evaluator.update(me, _dict(evaluator, arguments.without_first(), span))
    return NONE


def _pop_key(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
    pairs, key = _pairs(arguments), arguments.get(1, "key")
    me = arguments.positional[0]
    if pairs is None or not isinstance(key, Const) or not isinstance(me, DictValue):
        if isinstance(me, DictValue):
            evaluator.heap.set(me.slots, "items", UNKNOWN)
        return UNKNOWN
    rest = {k: v for k, v in pairs.items() if k != key.value}
    evaluator.heap.set(me.slots, "items", rest)
    return (
        pairs[key.value][1]
        if key.value in pairs
        else arguments.get(2, "default", UNKNOWN) or UNKNOWN
    )


def _parts(which: int | None) -> Callable[[Interpreter, Arguments, Span | None], Value]:
    def run(evaluator: Interpreter, arguments: Arguments, span: Span | None) -> Value:
        pairs = _pairs(arguments)
        if pairs is None:
            return UNKNOWN
        if which is None:
            return TupleValue(tuple(TupleValue(pair) for pair in pairs.values()))
        return TupleValue(tuple(pair[which] for pair in pairs.values()))

    return run


_DICT_METHODS: Mapping[str, Callable[[Interpreter, Arguments, Span | None], Value]] = {
    "get": _get,
    "setdefault": _set_default,
    "update": _update,
    "pop": _pop_key,
    "set": _set_key,  # of YASMIN's blackboard, as `remove` is
    "remove": _pop_key,
    "keys": _parts(0),
    "values": _parts(1),
    "items": _parts(None),
    "iterkeys": _parts(0),
    "itervalues": _parts(1),
    "iteritems": _parts(None),
    "copy": _copy,
    "clear": lambda e, a, s: _clear(e, a),
}


def _clear(evaluator: Interpreter, arguments: Arguments) -> Value:
    me = arguments.positional[0]
    if isinstance(me, DictValue):
        evaluator.heap.set(me.slots, "items", {})
    return NONE
