"""Values of Python as YAML on one line, as a script needs them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from smachac.diagnostics.spelling import is_plain
from smachac.ir.nodes import Data, Expression, Struct

_ESCAPES = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}


def quoted(text: str) -> str:
    """A text in double quotes."""
    return '"' + "".join(_ESCAPES.get(letter) or _escaped(letter) for letter in text) + '"'


def _escaped(letter: str) -> str:
    if letter.isprintable() or letter == " ":
        return letter
    code = ord(letter)
    if code < 0x100:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code < 0x10000 else f"\\U{code:08x}"


def name_text(name: str) -> str:
    """A name, in quotes where it needs them."""
    return name if is_plain(name) else quoted(name)


def names_text(names: Iterable[str]) -> str:
    """A list of names."""
    return f"[{', '.join(map(name_text, names))}]"


def mapping_text(entries: Mapping[str, str]) -> str:
    """A mapping of names to texts of YAML."""
    return f"{{{', '.join(f'{name_text(key)}: {text}' for key, text in entries.items())}}}"


def data_text(data: Data, *, inside: bool = False) -> str:
    """A value; `inside` a list, where a word without quotes can be a look-up of a param."""
    match data:
        case None:
            return "null"
        case bool():
            return "true" if data else "false"
        case int() | float():
            return repr(data)
        case str():  # a word with a dot would be code
            return quoted(data) if inside or "." in data else name_text(data)
        case Expression(text=code):
            return quoted(f"`{code}`")
        case Struct(entries=entries):
            return mapping_text({key: data_text(part, inside=True) for key, part in entries})
    return f"[{', '.join(data_text(item, inside=True) for item in data)}]"
