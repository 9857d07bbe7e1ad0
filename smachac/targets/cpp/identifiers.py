"""Names of a script as identifiers of C++."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

_KEYWORDS = """
    alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t
    char32_t class compl concept const consteval constexpr constinit const_cast continue co_await
    co_return co_yield decltype default delete do double dynamic_cast else enum explicit export
    extern false float for friend goto if inline int long mutable namespace new noexcept not not_eq
    nullptr operator or or_eq private protected public register reinterpret_cast requires return
    short signed sizeof static static_assert static_cast struct switch template this thread_local
    throw true try typedef typeid typename union unsigned using virtual void volatile wchar_t while
    xor xor_eq"""
KEYWORDS = frozenset(_KEYWORDS.split())
"""The words of C++20."""

MACROS = re.compile(
    r"NULL|EOF|errno|assert|std(in|out|err)|unix|linux|i386|offsetof|va_\w+|BUFSIZ|NAN|INFINITY"
    r"|EXIT_(SUCCESS|FAILURE)|RAND_MAX|FILENAME_MAX|FOPEN_MAX|TMP_MAX|SEEK_\w+|L_tmpnam|HUGE_VAL\w*"
    r"|CLOCKS_PER_SEC|TIME_UTC|TIMER_ABSTIME|(CLOCK|PTHREAD|FP|LC|SCHED|CLONE|ADJ|STA|MOD)_\w+"
    r"|MB_\w+|W(EXIT|TERM|STOP)\w*|WNOHANG|WUNTRACED|WNOWAIT|M_\w+|MATH_\w+|MAXFLOAT|major|minor"
    r"|makedev|alloca|strdupa|EPERM|ENOENT|EINTR|EIO|EBUSY|EEXIST|EINVAL|EDOM|ERANGE|EAGAIN|ENOMEM"
    r"|EACCES|EFAULT|EPIPE|ETIME|ETIMEDOUT|ECANCELED|EDEADLK|EALREADY|EINPROGRESS|ECONNREFUSED"
    r"|(U?(CHAR|SHRT|INT|LONG|LLONG)|SIZE|PTRDIFF|INTMAX|WCHAR|FLT|DBL|LDBL)_(MIN|MAX|EPSILON)"
)
"""Macros of the system headers that smachac's headers include, as far as scripts may use them."""

_SYSTEM = """
    abort abs accept access acct alarm basename bind brk canonicalize ceil clock clone close connect
    crypt daemon daylight div dup environ exit exp fabs finite floor fork free gamma index kill link
    listen log mount nan nice open pause pipe poll pow printf profil puts raise rand random read
    recv remainder remove rename revoke rewind rindex rint round scalb select send shutdown signal
    significand sin sleep socket stat swab sync system tan time times timezone tm trunc truncate
    uint ulong umount unlink unshare ushort wait write"""
SYSTEM = frozenset(_SYSTEM.split())
"""Functions and variables of C and POSIX in the global namespace, as far as machines may have the
names."""

_OURS = """
    Userdata UserdataView States Outcome State In Out Run execute run name places types main std
    smachac"""
OURS = frozenset(_OURS.split())
"""The header's own names in the namespaces that hold names of the script."""


def identifier(name: str) -> str:
    """The identifier for a name: ASCII letters, digits and single underscores.

    Letters lose their accents; other letters become their Unicode numbers. Two names may get one
    identifier; `clashes` finds them.
    """
    word = member_identifier(name)
    return f"{word}_" if word in OURS else word


def member_identifier(name: str) -> str:
    """The identifier for the field of a record: beside the fields there are no names of ours."""
    text = name if name.isascii() else "".join(map(_ascii, name))
    word = re.sub(r"[^0-9A-Za-z]+", "_", text)
    word = word.strip("_") or "_"
    if word[0].isdigit():
        word = f"n{word}"
    taken = word in KEYWORDS or MACROS.fullmatch(word)
    return f"{word}_" if taken else word


def _ascii(letter: str) -> str:
    """A letter in ASCII: `ö` is `o`, `ß` is `ss`, `抓` is `u6293`."""
    parts = unicodedata.normalize("NFKD", "ss" if letter == "ß" else letter)
    plain = "".join(part for part in parts if not unicodedata.combining(part))
    if plain.isascii():
        return plain
    return f"u{ord(letter):04x}" if letter.isalnum() else "_"


def outermost(name: str) -> str:
    """The identifier of a machine as a namespace at global scope."""
    word = identifier(name)
    return f"{word}_" if word in SYSTEM else word


def clashes(names: Iterable[str]) -> list[tuple[str, str]]:
    """Each name whose identifier an earlier name has, with that earlier name."""
    first: dict[str, str] = {}
    found = []
    for name in dict.fromkeys(names):
        other = first.setdefault(identifier(name), name)
        if other != name:
            found.append((name, other))
    return found
