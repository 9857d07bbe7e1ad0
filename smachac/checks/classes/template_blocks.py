"""Blocks `body` of the user's templates that do not print a part of a state (SM605)."""

from __future__ import annotations

import re
from collections.abc import Iterator

from smachac.analysis.context import Context
from smachac.checks.rule import Rule
from smachac.diagnostics.diagnostic import Finding, Related, Severity
from smachac.diagnostics.source import Span
from smachac.diagnostics.spelling import guesser
from smachac.frontend.errors.references import template_error
from smachac.pysource.modules.jinja_tags import tags
from smachac.pysource.modules.user_code import TemplateBody
from smachac.records import replace

_TEST = re.compile(
    r"\{%[-+]?\s*if\s+(\w+)\s+is\s+defined\s*[-+]?%\}(.*?)\{%[-+]?\s*endif\b", re.DOTALL
)
_WORD = re.compile(r"[^\W\d]\w*")


def _unprinted_parts(context: Context) -> Iterator[Finding]:
    for body in context.code_facts.bodies:
        yield from _tests(body)
        yield from _not_printed(body)


unprinted_parts = Rule(code=template_error.code, function=_unprinted_parts, about_code=True)
"""The warnings of SM605: what a template can print, and does not."""


def _not_printed(of: TemplateBody) -> Iterator[Finding]:
    """The remapping and the transitions of a state that its template does not print."""
    template, body, leaf = of.template, of.block, of.leaf
    inside = body[1]
    printed = [template.text[start:end] for start, end in tags(template.text, "%{")]
    in_body = [inside[start:end] for start, end in tags(inside, "%{")]
    # Code that another template prints can use the names of this one.
    hidden = any(re.search(r"\bsuper\b|\bself\b|\*\*", code) for code in in_body)
    hidden = hidden or any(re.search(r"\binclude\b|with context", code) for code in printed)
    call = of.call
    if call is None or hidden:
        return
    words = {word for code in (*printed, inside) for word in _WORD.findall(code)}
    if "name" not in words:
        return  # the template adds one state of its own
    leads = [transition for transition in leaf.transitions
             if transition.origin == "written"
             and transition.target != transition.outcome]  # fmt: skip
    for name, used, effect in (
        ("remapping", bool(leaf.remaps), "uses its keys under its own names"),
        ("transitions", bool(leads), "leads to no other state"),
    ):
        if not used or name in words:
            continue
        start = body.start(1) + call.start()
        place = Span(template, start, body.start(1) + call.end() - 1)
        code = f"{{% if {name} is defined %}}, {{{{ render_{name}({name}) }}}}{{% endif %}}"
        help = f"add `{code}` behind `{call[0]}...)`"
        if f"render_{name}" not in words:
            help += f', and import it: `{{% from "Utils.tpl.py" import render_{name} %}}`'
        message = f"the template does not print the `{name}` that `{leaf.name}` has in the script"
        yield replace(
            template_error.function(place, message, help, (name, leaf.type)),
            related=(Related(span=leaf.span, message=f"`{leaf.name}` has the `{name}`"),),
            effect=f"the program ignores it: `{leaf.name}` {effect}",
            severity=Severity.WARNING,
        )


def _tests(of: TemplateBody) -> Iterator[Finding]:
    """Tests `is defined` of a name that stands nowhere else, one slip away from a name that the
    tested part uses."""
    template, leaf = of.template, of.leaf
    words: dict[str, int] = {}
    for start, end in tags(template.text, "%{"):
        for word in _WORD.findall(template.text[start + 2 : end - 2]):
            words[word] = words.get(word, 0) + 1
    known = {*of.type.variables, *(field.name for field in leaf.written)}
    known |= {variable.name for variable in leaf.variables}
    for found in _TEST.finditer(template.text, *of.block.span(1)):
        name, inside = found[1], found[2]
        if words.get(name) != 1 or name in known:
            continue
        used = {word for start, end in tags(inside, "%{")
                for word in _WORD.findall(inside[start + 2 : end - 2])}  # fmt: skip
        near = guesser(sorted(used)).unique_match(name)
        if near is not None:
            message = f"`{name}` is tested here, but nothing defines it: the part is never printed"
            place = Span(template, *found.span(1))
            yield replace(
                template_error.function(place, message, f"did you mean `{near}`?", (name,)),
                effect=f"the program of `{leaf.name}` lacks what the template prints here",
                severity=Severity.WARNING,
            )
