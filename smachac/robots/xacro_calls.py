"""The calls of macros that xacro expands, and what is wrong with the innermost of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from difflib import get_close_matches
from typing import Any, NamedTuple

from smachac.robots.xml_tree import Element, TextPlace, XmlError, parse

_PREFIX = "xacro:"


class CallFault(NamedTuple):
    """What is wrong with a call: the message, the help, and the attribute that is wrong, if it is
    one."""

    message: str
    help: str
    attribute: str = ""


class _Call(NamedTuple):
    """A call: its tag and attributes as they are in the file, and what is defined there."""

    tag: str
    attributes: Mapping[str, str]
    macros: Any
    symbols: Any


class MacroCalls:
    """Stands in the place of `xacro.handle_macro_call`: keeps the calls that have not ended.

    xacro empties the attributes of a call while it expands it, so they are kept from before.
    """

    def __init__(self, xacro: Any) -> None:
        self._xacro, self._expand = xacro, xacro.handle_macro_call
        self._open: list[_Call] = []

    def __call__(self, node: Any, macros: Any, symbols: Any) -> bool:
        self._open.append(_Call(node.tagName, dict(node.attributes.items()), macros, symbols))
        done: bool = self._expand(node, macros, symbols)
        self._open.pop()
        return done

    def fault(self, error: Any) -> CallFault | None:
        """What is wrong with the innermost call, if it is the cause of an error."""
        if not self._open or not isinstance(error, self._xacro.XacroException):
            return None
        call = self._open[-1]
        name = call.tag.removeprefix(_PREFIX)
        if error.macros:
            return _wrong_attributes(name, error.macros[0], call.attributes)
        try:
            self._xacro.resolve_macro(name, call.macros, call.symbols)
        except KeyError:
            help = "define it with `<xacro:macro name=...>`, or include the file that does"
            help = _similar(name, _names(call.macros)) or help
            return CallFault(f"the macro `{name}` is not defined", help)
        return None

    def place(
        self, texts: Iterable[tuple[str, str]], attribute: str
    ) -> tuple[str, TextPlace] | None:
        """The file and the place of the innermost call that is found in the texts of files, or of
        its attribute."""
        trees = [(file, text, root) for file, text in texts if (root := _tree(text)) is not None]
        for call in reversed(self._open):
            for file, text, root in trees:
                for element in _elements(root):
                    if element.tag == call.tag and element.attributes == call.attributes:
                        return file, element.place(text, attribute, whole=True)
        return None


def _wrong_attributes(name: str, macro: Any, attributes: Mapping[str, str]) -> CallFault | None:
    """The fault of a call that gives a parameter too many or too few. A parameter that begins with
    `*` is an element inside the call."""
    for attribute in attributes:
        if attribute not in macro.params:
            message = f"the macro `{name}` has no parameter `{attribute}`"
            free = [word for word in macro.params if word not in attributes]
            help = _similar(attribute, free) or "remove it, or add it to `params` of the macro"
            return CallFault(message, help, attribute)
    needed = [word for word in macro.params if word not in macro.defaultmap and word[0] != "*"]
    if missing := [word for word in needed if word not in attributes]:
        words = " and ".join(f"`{word}`" for word in missing)
        help = f'write `{missing[0]}="..."` in the call, or give it a default: `{missing[0]}:=...`'
        return CallFault(f"the macro `{name}` needs {words}", help)
    return None


def _similar(name: str, names: Iterable[str]) -> str:
    near = get_close_matches(name, [*names], n=1)
    return f"did you mean `{near[0]}`?" if near else ""


def _names(macros: Any) -> Iterator[str]:
    """The names in a table of xacro and in those around it."""
    while macros is not None:
        yield from macros
        macros = getattr(macros, "parent", None)


def _tree(text: str) -> Element | None:
    """The elements of a text; None for a file of `load_yaml`."""
    try:
        return parse(text)
    except XmlError:
        return None


def _elements(root: Element) -> Iterator[Element]:
    waiting = [root]
    while waiting:
        element = waiting.pop()
        yield element
        waiting += reversed(element.children)
