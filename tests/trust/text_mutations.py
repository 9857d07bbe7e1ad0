"""Mutations of the text of a correct project, such as hands make them: a letter left out, a line
deleted, a bracket lost, a state indented too far. Files need not be valid YAML after them.

`judged_repairs.py` judges the findings about the mutants.
"""

from __future__ import annotations

import random
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TypeAlias

NAME = re.compile(r"[A-Za-z_]\w{2,}")
ENTRY = re.compile(r"(?<=[\[{,])\s*(\w+)(:\s*[\w./'\"-]+)?\s*(?=[,\]}])")
TWO_PAIRS = re.compile(r"(\w+): ([\w.-]+), (\w+): ([\w.-]+)")
PAIR = re.compile(r"([a-z_]\w*): ([a-z_]\w*)(?=[,}])")
STATE = re.compile(r"\s+- ([A-Z_0-9]+):")
NUMBER = re.compile(r"(?<=[ \[(,:])-?\d+\.?\d*(?=[,\])}\n])")
WORDS_OF_LANGUAGES = {"and", "def", "else", "for", "from", "import", "lambda", "not", "return"}


@dataclass(frozen=True, slots=True)
class TextMutant:
    """The changed text. `lost` are the pieces of the original text that a repair names."""

    text: str
    line: int
    lost: tuple[str, ...]
    what: str


TextMutation: TypeAlias = Callable[[str, random.Random], "TextMutant | None"]
TEXT_MUTATIONS: dict[str, TextMutation] = {}


def text_mutation(function: TextMutation) -> TextMutation:
    """Enter a mutation in `TEXT_MUTATIONS` under its name."""
    TEXT_MUTATIONS[function.__name__.replace("_", " ")] = function
    return function


def replaced(text: str, span: tuple[int, int], new: str, lost: Iterable[str]) -> TextMutant | None:
    """The mutant with `new` in place of the text between two offsets; None if nothing changes."""
    start, end = span
    old = text[start:end]
    if old == new:
        return None
    what = f"{old!r} -> {new!r}"
    return TextMutant(text[:start] + new + text[end:], line_of(text, start), tuple(lost), what)


def line_of(text: str, offset: int) -> int:
    return text.count("\n", 0, offset) + 1


def in_comment(text: str, offset: int) -> bool:
    return "#" in text[text.rfind("\n", 0, offset) + 1 : offset]


def matches(pattern: re.Pattern[str], text: str) -> list[re.Match[str]]:
    """All places of a pattern outside of comments."""
    return [found for found in pattern.finditer(text) if not in_comment(text, found.start())]


def names(text: str) -> list[re.Match[str]]:
    return [found for found in matches(NAME, text) if found.group() not in WORDS_OF_LANGUAGES]


def case_of(name: str) -> str:
    """The kind of a name by its letters: states, classes, and all others."""
    return "state" if name.isupper() else "class" if name[0].isupper() else "key"


@text_mutation
def misspell_a_name(text: str, draw: random.Random) -> TextMutant | None:
    """Leave a letter out, turn two round, or write one twice."""
    found = [name for name in names(text) if len(name.group()) > 3]
    if not found:
        return None
    place = draw.choice(found)
    old = place.group()
    at = draw.randrange(1, len(old) - 1)
    new = draw.choice(
        [
            old[:at] + old[at + 1 :],
            old[:at] + old[at + 1] + old[at] + old[at + 2 :],
            old[: at + 1] + old[at:],
        ]
    )
    return replaced(text, place.span(), new, [old])


@text_mutation
def change_the_case_of_a_name(text: str, draw: random.Random) -> TextMutant | None:
    found = names(text)
    if not found:
        return None
    place = draw.choice(found)
    old = place.group()
    new = old.lower() if old != old.lower() else draw.choice([old.upper(), old.capitalize()])
    return replaced(text, place.span(), new, [old])


@text_mutation
def write_another_name(text: str, draw: random.Random) -> TextMutant | None:
    """A name of the same kind from elsewhere in the file."""
    found = names(text)
    if not found:
        return None
    place = draw.choice(found)
    kind = case_of(place.group())
    others = sorted({item.group() for item in found if case_of(item.group()) == kind})
    return replaced(text, place.span(), draw.choice(others), [place.group()])


@text_mutation
def delete_a_line(text: str, draw: random.Random) -> TextMutant | None:
    """A line without lines below it that are indented further."""
    rows = text.split("\n")
    found = [
        at
        for at, row in enumerate(rows)
        if NAME.search(row) and not row.lstrip().startswith("#")
        if at + 1 == len(rows) or indent(rows[at + 1]) <= indent(row)
    ]
    if not found:
        return None
    at = draw.choice(found)
    lost = NAME.findall(rows[at])[:1]
    return TextMutant("\n".join(rows[:at] + rows[at + 1 :]), at + 1, tuple(lost), rows[at].strip())


def indent(row: str) -> int:
    return len(row) - len(row.lstrip())


@text_mutation
def delete_an_entry(text: str, draw: random.Random) -> TextMutant | None:
    """An item of a list or an entry of a mapping in brackets, with its comma."""
    found = matches(ENTRY, text)
    if not found:
        return None
    place = draw.choice(found)
    start, end = place.span()
    if text[end] == ",":
        end += 1
    elif text[start - 1] == ",":
        start -= 1
    return replaced(text, (start, end), "", [place[1]])


@text_mutation
def swap_two_values(text: str, draw: random.Random) -> TextMutant | None:
    found = matches(TWO_PAIRS, text)
    if not found:
        return None
    place = draw.choice(found)
    one, value, other, second = place.groups()
    new = f"{one}: {second}, {other}: {value}"
    return replaced(text, place.span(), new, [value, second])


@text_mutation
def turn_a_pair_round(text: str, draw: random.Random) -> TextMutant | None:
    """A remapping or a transition, written the wrong way round."""
    found = matches(PAIR, text)
    if not found:
        return None
    place = draw.choice(found)
    return replaced(text, place.span(), f"{place[2]}: {place[1]}", [place.group()])


def block(text: str, draw: random.Random) -> tuple[list[str], list[str], list[str], str] | None:
    """The rows before a state, those of the state, those after it, and its name."""
    rows = text.split("\n")
    found = [at for at, row in enumerate(rows) if STATE.match(row)]
    if not found:
        return None
    first = draw.choice(found)
    last = first + 1
    while last < len(rows) and (not rows[last].strip() or indent(rows[last]) > indent(rows[first])):
        last += 1
    name = STATE.match(rows[first])
    return rows[:first], rows[first:last], rows[last:], name[1] if name else ""


@text_mutation
def delete_a_state(text: str, draw: random.Random) -> TextMutant | None:
    parts = block(text, draw)
    if parts is None:
        return None
    before, _, after, name = parts
    return TextMutant("\n".join(before + after), len(before) + 1, (name,), f"without {name}")


@text_mutation
def write_a_state_twice(text: str, draw: random.Random) -> TextMutant | None:
    parts = block(text, draw)
    if parts is None:
        return None
    before, state, after, name = parts
    rows = before + state + state + after
    return TextMutant("\n".join(rows), len(before + state) + 1, (name,), f"{name} twice")


@text_mutation
def indent_a_state(text: str, draw: random.Random) -> TextMutant | None:
    parts = block(text, draw)
    if parts is None:
        return None
    before, state, after, name = parts
    by = draw.choice([-4, -2, 2, 4])
    moved = [" " * by + row if by > 0 else row[min(-by, indent(row)) :] for row in state]
    rows = before + moved + after
    return TextMutant("\n".join(rows), len(before) + 1, (name,), f"{name} indented by {by:+}")


@text_mutation
def lose_a_mark(text: str, draw: random.Random) -> TextMutant | None:
    """A bracket, a quote, a comma or a colon."""
    found = matches(re.compile(r"[\[\]{}'\":,()]"), text)
    if not found:
        return None
    place = draw.choice(found)
    return replaced(text, place.span(), "", [place.group()])


@text_mutation
def write_a_colon_wrongly(text: str, draw: random.Random) -> TextMutant | None:
    found = matches(re.compile(r"(?<=\w): (?=\S)"), text)
    if not found:
        return None
    return replaced(text, draw.choice(found).span(), draw.choice([":", " ", " = "]), [": "])


@text_mutation
def change_a_number(text: str, draw: random.Random) -> TextMutant | None:
    """Write it as a text, a list or a boolean, with a unit, a comma, a wrong sign, or in mm."""
    found = matches(NUMBER, text)
    if not found:
        return None
    place = draw.choice(found)
    old = place.group()
    forms = [
        f'"{old}"',
        f"[{old}]",
        "true",
        f"{old}s",
        f"{old} m",
        old.replace(".", ","),
        f"-{old.lstrip('-')}",
        str(float(old) * 1000),
    ]
    return replaced(text, place.span(), draw.choice(forms), [old])


@text_mutation
def lose_the_brackets_of_a_list(text: str, draw: random.Random) -> TextMutant | None:
    found = matches(re.compile(r"(?<=: )\[(\w+)\](?=[\n,}])"), text)
    if not found:
        return None
    place = draw.choice(found)
    return replaced(text, place.span(), place[1], [place.group()])
