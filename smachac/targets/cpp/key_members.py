"""Uses of members that the structs `In` and `Out` of a C++ class do not have."""

from __future__ import annotations

import re
from collections.abc import Iterator

from smachac.diagnostics.spelling import guesser
from smachac.ir.class_facts import SUGGESTION, ClassFault, FaultKind
from smachac.targets.cpp.cpp_text import Part
from smachac.targets.cpp.identifiers import identifier
from smachac.targets.cpp.user_classes import REFUSED, ClassCode

NO_KEY_MEMBER = FaultKind(
    name="no key member",
    message="`{more}` of `{name}` has no `{word}`",
    help="write one of {file}, or add it to `{more}` and to the interface",
    near_help=SUGGESTION,
    effect=REFUSED,
)


def unknown_members(
    code: ClassCode, body: Part, run: Part, parameters: str
) -> Iterator[ClassFault]:
    """The members of the parameters `In in` and `Out out` that the body `run` of `execute` uses and
    that appear nowhere in their struct; each with the key that is meant: the nearest, or the only
    one that `run` does not use."""
    for struct, keys in (("In", code.type.input_keys), ("Out", code.type.output_keys)):
        named = re.search(rf"\b{struct}\s*&?\s*(\w+)", parameters)
        fields = body.inside(body.member(rf"\bstruct\s+{struct}\s*\{{"))
        if named is None or fields is None:
            continue
        known = set(re.findall(r"\w+", fields.text))
        uses = list(re.finditer(rf"(?<![\w.>]){re.escape(named[1])}\s*\.\s*(\w+)", run.text))
        used = {use[1] for use in uses}
        own = [name for name in (identifier(key.name) for key in keys) if name in known]
        left = [name for name in own if name not in used]
        for use in uses:
            if use[1] in known:
                continue
            near = guesser(own)(use[1])
            near = near or (left[0] if len(left) == len(used - known) == 1 else None)
            word = run.word(use[1], *use.span(1))
            names = ", ".join(f"`{name}`" for name in own)
            yield ClassFault(kind=NO_KEY_MEMBER, name=word, near=near, more=struct,
                             file="" if near else names)  # fmt: skip
