"""Mutations that are kept for judging: nobody develops checks with them. They are other kinds of
damage than those of `text_mutations`, on the same texts.

`python bench/repairs.py` prints them in a table of their own.
"""

from __future__ import annotations

import random
import re

from tests.trust.text_mutations import (
    NAME,
    TextMutant,
    TextMutation,
    indent,
    line_of,
    matches,
    names,
    replaced,
)

KEPT_MUTATIONS: dict[str, TextMutation] = {}
COMPOUND = re.compile(r"\b[a-z]+(?:_[a-z]+)+\b")
TARGET = re.compile(r"(?<=: )([A-Z][A-Z_0-9]*)(?=[,}\n])")


def kept(function: TextMutation) -> TextMutation:
    """Enter a mutation in `KEPT_MUTATIONS` under its name."""
    KEPT_MUTATIONS[function.__name__.replace("_", " ")] = function
    return function


@kept
def write_two_letters_wrongly(text: str, draw: random.Random) -> TextMutant | None:
    """Two other letters in a name of six or more."""
    found = [name for name in names(text) if len(name.group()) > 5]
    if not found:
        return None
    place = draw.choice(found)
    letters = list(place.group())
    for at in draw.sample(range(1, len(letters)), 2):
        if letters[at].isalpha():
            other = draw.choice("aeionrst")
            letters[at] = other.upper() if letters[at].isupper() else other
    return replaced(text, place.span(), "".join(letters), [place.group()])


@kept
def leave_out_a_word_of_a_name(text: str, draw: random.Random) -> TextMutant | None:
    """`grasp_pose` becomes `pose` or `grasp`."""
    found = matches(COMPOUND, text)
    if not found:
        return None
    place = draw.choice(found)
    words = place.group().split("_")
    del words[draw.randrange(len(words))]
    return replaced(text, place.span(), "_".join(words), [place.group()])


@kept
def write_a_name_with_hyphens(text: str, draw: random.Random) -> TextMutant | None:
    found = matches(COMPOUND, text)
    if not found:
        return None
    place = draw.choice(found)
    return replaced(text, place.span(), place.group().replace("_", "-"), [place.group()])


@kept
def lead_to_another_state(text: str, draw: random.Random) -> TextMutant | None:
    """The name of a state that is the value of an entry becomes a plural."""
    found = matches(TARGET, text)
    if not found:
        return None
    place = draw.choice(found)
    return replaced(text, place.span(), f"{place.group()}S", [place.group()])


@kept
def exchange_two_lines(text: str, draw: random.Random) -> TextMutant | None:
    """The first row of a block and the row above all others in it change places."""
    rows = text.split("\n")
    found = [
        at
        for at in range(len(rows) - 1)
        if NAME.search(rows[at]) and NAME.search(rows[at + 1])
        if indent(rows[at]) < indent(rows[at + 1])
    ]
    if not found:
        return None
    at = draw.choice(found)
    rows[at], rows[at + 1] = rows[at + 1], rows[at]
    return TextMutant("\n".join(rows), at + 1, tuple(NAME.findall(rows[at + 1])[:1]), "exchanged")


@kept
def write_a_quote_on_one_side(text: str, draw: random.Random) -> TextMutant | None:
    """A quote before a value that has none."""
    found = matches(re.compile(r"(?<=: )[A-Za-z_]\w*(?=\n)"), text)
    if not found:
        return None
    place = draw.choice(found)
    new = text[: place.start()] + '"' + text[place.start() :]
    return TextMutant(new, line_of(text, place.start()), (place.group(),), "a quote too many")
