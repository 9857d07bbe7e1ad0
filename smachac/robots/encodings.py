"""The encodings of text files: YAML, XML, Python and C++ state theirs in different ways."""

from __future__ import annotations

import codecs
import re

_XML = (".urdf", ".xacro", ".xml", ".scxml")
_PYTHON = ".py"
_TEMPLATE = ".tpl.py"
_CPP = (".h", ".hh", ".hpp", ".hxx")
_DEFINITIONS = (".msg", ".srv", ".action")

_MARKS = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16", b"\xef\xbb\xbf": "utf-8-sig"}
_XML_DECLARATION = re.compile(rb"<\?xml\s[^<>]*?\bencoding\s*=\s*[\"']([^\"'<>]*)[\"']")
_PYTHON_DECLARATION = re.compile(
    rb"(?:[ \t\f]*(?:#[^\r\n]*)?(?:\r\n|\r|\n))?[ \t\f]*#[^\r\n]*?coding[:=][ \t]*([-\w.]+)"
)
_LINE_ENDS = r"-(unix|dos|mac)\Z"
"""The end of a name of Emacs: `utf-8-unix`."""
_KNOWN = (
    r"utf-8|ascii|iso8859-\d+|cp125\d|koi8-[rtu]|shift_jis|euc_(?:jp|kr)|gb(?:k|2312|18030)|big5"
)
"""The names that Python has for the encodings that can be declared."""


class EncodingError(ValueError):
    """A file declares an encoding that is not read; `declared` is its name, `start` its offset."""

    def __init__(self, declared: str, start: int) -> None:
        super().__init__(f"the declared encoding `{declared}` cannot be read")
        self.declared, self.start = declared, start


def decoded(data: bytes, name: str) -> str:
    """The text of a file of this name. Raises EncodingError and UnicodeDecodeError.

    XML (1.0, section 4.3.3) and Python (PEP 263) declare the encoding in the text. A compiler of
    C++ reads comments in any encoding that contains ASCII. Message definitions of ROS are UTF-8,
    and begin with no byte order mark. All other files are UTF-8, or UTF-16 with a byte order mark
    (YAML 1.2.2, section 5.2).
    """
    name = name.lower()
    if name.endswith(_DEFINITIONS):
        return data.decode("utf-8")
    mark = next((mark for start, mark in _MARKS.items() if data.startswith(start)), "")
    if name.endswith(_XML):
        return data.decode(mark or _declared(_XML_DECLARATION, data))
    if name.endswith(_PYTHON) and not name.endswith(_TEMPLATE):
        return data.decode("utf-8-sig" if mark else _declared(_PYTHON_DECLARATION, data))
    if name.endswith(_CPP):
        try:
            return data.decode("utf-8-sig")
        except UnicodeDecodeError:
            if mark == "utf-16":
                raise
            return data.decode("latin-1")
    return data.decode(mark or "utf-8")


def _declared(declaration: re.Pattern[bytes], data: bytes) -> str:
    """The encoding that a text declares at its beginning; UTF-8 without one. Raises
    EncodingError."""
    found = declaration.match(data)
    if found is None:
        return "utf-8"
    declared = found[1].decode("ascii", "replace")
    try:
        known = codecs.lookup(re.sub(_LINE_ENDS, "", declared)).name
    except (LookupError, ValueError):  # a name with a NUL
        known = ""
    if re.fullmatch(_KNOWN, known) is None:
        raise EncodingError(declared, found.start(1))
    return known
