"""Explanation of a code: the docstring of its problem or rule, as text and as docs/rules.md."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator, Mapping
from textwrap import dedent, fill, indent

from smachac.diagnostics.diagnostic import Code
from smachac.records import dataclass, field

MAIN = "main.yml"
MAIN_IN_PYTHON = "machine.py"

WIDTH = 88
"""Width of prose on a terminal, in columns."""

GROUPS: Mapping[str, str] = {
    "SM0": "Text and shape",
    "SM1": "Names and outcomes",
    "SM2": "The graph",
    "SM3": "Userdata",
    "SM4": "Concurrences",
    "SM5": "The robot",
    "SM6": "Targets",
    "SM7": "Properties",
    "SM8": "Machines in Python",
}
"""The subject of the codes of each hundred."""

_HEADINGS = re.compile(r"^(Wrong|Right):$", re.MULTILINE)
_FILE = re.compile(r"^== (\S+) ==\n", re.MULTILINE)


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """The parts of a code's docstring; examples are texts by file name, the script first."""

    summary: str
    reason: str
    wrong: Mapping[str, str] = field(default_factory=dict)
    right: Mapping[str, str] = field(default_factory=dict)


def explanation(code: Code) -> Explanation:
    """The parts of the docstring of a code."""
    text = inspect.cleandoc(code.explanation)
    prose, *sections = _HEADINGS.split(text)
    main = MAIN_IN_PYTHON if code.code.startswith("SM8") else MAIN
    texts = [_files(section, main) for section in sections[1::2]]
    examples = dict(zip(sections[::2], texts, strict=True))
    summary, _, reason = prose.strip().partition("\n\n")
    return Explanation(
        summary=" ".join(summary.split()),
        reason="\n\n".join(" ".join(part.split()) for part in reason.split("\n\n")).strip(),
        wrong=examples.get("Wrong", {}),
        right=examples.get("Right", {}),
    )


def _files(block: str, main: str) -> dict[str, str]:
    first, *others = _FILE.split(dedent(block.strip("\n")))
    texts = {main: first, **dict(zip(others[::2], others[1::2], strict=True))}
    return {name: text.strip("\n") + "\n" for name, text in texts.items()}


def render_code(code: Code) -> str:
    """The output of `smachac explain` for a code, without a line feed at the end."""
    parts = explanation(code)
    prose = [parts.summary, *parts.reason.split("\n\n")]
    mark = ", unsuppressible" if code.unsuppressible else ""
    lines = [f"{code.code} {code.name} ({code.severity.value}{mark})"]
    lines += [fill(text, WIDTH, break_on_hyphens=False) for text in prose]
    for title, files in (("Wrong", parts.wrong), ("Right", parts.right)):
        for name, text in files.items():
            head = f"{title}, {name}:" if len(files) > 1 else f"{title}:"
            lines.append(f"{head}\n\n{indent(text, '    ').rstrip()}")
    return "\n\n".join(lines)


def render_rules(known: Mapping[str, Code]) -> str:
    """Codes as one Markdown document, by hundreds, with a table of contents."""
    return "\n\n".join([_PREFACE, _contents(known), *_sections(known)]) + "\n"


_PREFACE = """# What smachac finds

Generated from the docstrings of the rules: `make docs` writes this file, a test compares it.

An error stops a build, a warning stops it under `--strict`, an info never stops it. Some findings
have another severity than their code; then the text describes when. After an error of an
*unsuppressible* code nothing can be generated, so no comment, setting or option silences it. Each
example under "Wrong" gives exactly its code, and each example under "Right" gives nothing above an
info; the tests run all of them. A line `# --- name` begins another file."""


def _groups(known: Mapping[str, Code]) -> Iterator[tuple[str, list[Code]]]:
    for prefix, title in GROUPS.items():
        codes = [known[name] for name in sorted(known) if name.startswith(prefix)]
        if codes:
            yield f"{prefix}xx {title}", codes


def _anchor(title: str) -> str:
    return re.sub(r"[^a-z0-9 -]", "", title.lower()).replace(" ", "-")


def _contents(known: Mapping[str, Code]) -> str:
    lines = []
    for title, codes in _groups(known):
        lines.append(f"- [{title}](#{_anchor(title)})")
        for code in codes:
            heading = f"{code.code} {code.name}"
            summary = explanation(code).summary
            lines.append(f"    - [{heading}](#{_anchor(heading)}): {summary}")
    return "\n".join(lines)


def _sections(known: Mapping[str, Code]) -> Iterator[str]:
    for title, codes in _groups(known):
        yield f"## {title}"
        yield from (f"### {code.code} {code.name}\n\n{render_section(code)}" for code in codes)


def render_section(code: Code) -> str:
    """The explanation of a code as Markdown, without its heading."""
    parts = explanation(code)
    mark = ", unsuppressible" if code.unsuppressible else ""
    lines = [f"*{code.severity.value}{mark}*: {parts.summary}", parts.reason]
    for title, files in (("Wrong:", parts.wrong), ("Right:", parts.right)):
        if files:
            lines += [title, _fenced(files)]
    return "\n\n".join(filter(None, lines))


def _fenced(files: Mapping[str, str]) -> str:
    mains = (MAIN, MAIN_IN_PYTHON)
    texts = [text if name in mains else f"# --- {name}\n{text}" for name, text in files.items()]
    language = "python" if MAIN_IN_PYTHON in files else "yaml"
    return f"```{language}\n{''.join(texts)}```"
