"""How often completion offers the right word first, where words of the examples are deleted.

    python bench/lsp_completion.py [positions [typed]]

The places are drawn with a fixed seed from all words that are names: fields, states, outcomes,
keys, templates, sub-scripts. `typed`: the first characters of the word that stay.
"""

from __future__ import annotations

import random
import sys
from collections import Counter
from pathlib import Path

from smachac.diagnostics.source import Source
from smachac.frontend.text.yaml_tree import Map, Scalar, Seq, Tree, parse
from smachac.lsp.completion import complete
from smachac.lsp.place import FIELD, STATE, VALUE, Place, place_at
from smachac.lsp.session import Session

ROOT = Path(__file__).parents[1]

NAMED = frozenset(
    [
        *(
            "template",
            "script",
            "transitions",
            "remapping",
            "input_keys",
            "output_keys",
            "outcomes",
        ),
        *("outcome_map", "initial", "default_outcome", "connector_outcome"),
        "exhausted_outcome",
        *("loop_outcomes", "final_outcome_map", "it", "it_label", "join"),
    ]
)
"""The fields whose words are names; those of others are values of the user."""


def scalars(tree: Tree) -> list[Scalar]:
    match tree:
        case Scalar():
            return [tree]
        case Seq(items=items):
            return [scalar for item in items for scalar in scalars(item)]
        case Map(entries=entries):
            pairs = [part for entry in entries for part in (entry.key, entry.value)]
            return [scalar for part in pairs for scalar in scalars(part)]
    return []


def is_name(place: Place | None) -> bool:
    """Whether the word refers to something: new names of states and keys cannot be offered."""
    if place is None or place.role == STATE or not isinstance(place.word.value, str):
        return False
    if place.role == FIELD:
        return place.word.value not in ("name", "doc")
    if place.field == "input_keys" and place.role == VALUE and place.inner:
        return False
    return place.field in NAMED


def places() -> list[tuple[Path, Scalar, Place]]:
    found = []
    for path in sorted((ROOT / "examples").rglob("*.yml")):
        tree = parse(Source(str(path), path.read_text("utf-8")), [])
        for word in scalars(tree) if tree is not None else ():
            place = place_at(tree, word.start)
            if place is not None and is_name(place):
                found.append((path, word, place))
    return found


def main(number: int = 200, typed: int = 0) -> None:
    chosen = random.Random(0).sample(places(), number)
    first = within = 0
    by, total = Counter[str](), Counter[str]()
    for path, word, place in chosen:
        session = Session([path.parent])
        whole = path.read_text("utf-8")
        text = whole[: word.start + typed] + whole[word.end :]
        session.change(str(path), text)
        offset = word.start + typed
        offered = complete(text, offset, str(path), session.view(str(path)))
        begin = whole[word.start : offset]
        words = [item.word for item in offered if item.word.startswith(begin)]
        kind = f"{place.field or place.role}{'.' + place.role if place.field else ''}"
        total[kind] += 1
        first += words[:1] == [word.value]
        within += word.value in words[:3]
        if words[:1] != [word.value]:
            by[kind] += 1
    for kind, count in sorted(total.items()):
        print(f"{kind:<28} {count - by[kind]:>4} of {count}")
    print(f"first: {first} of {number}; among the first three: {within}")


if __name__ == "__main__":
    main(*(int(word) for word in sys.argv[1:3]))
