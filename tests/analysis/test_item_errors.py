"""Faults in code that runs for each item of a list, and code that is correct."""

from __future__ import annotations

import pytest

from smachac.analysis.item_errors import item_faults
from smachac.analysis.type_lattice import mapping
from smachac.ir.types import Type

POINT, STR, FLOAT = Type("Point"), Type("str"), Type("float")
PAD = Type("record", ("name", STR, "at", POINT, "amount", FLOAT))
USERDATA = mapping(
    [
        ("pads", Type("list", (PAD,))),
        ("trays", Type("dict", (PAD,))),
        ("rows", Type("list", (Type("list", (PAD,)),))),
        ("maybe", Type("optional", (Type("list", (PAD,)),))),
        ("n", Type("int")),
    ]
)


def faults(code: str) -> list[str]:
    return [fault.what for fault in item_faults(f"lambda ud: {code}", USERDATA)]


LACKS = "reads the field `volume`, which"


@pytest.mark.parametrize(
    "code",
    [
        '[p["volume"] for p in ud.pads]',
        'sum(p["volume"] for p in ud.pads)',
        'any(p["volume"] > 3 for p in ud.pads if p["amount"] > 1)',
        '{p["name"]: p["volume"] for p in ud["pads"]}',
        'max(ud.pads, key=lambda p: p["volume"])',
        'sorted(ud.pads, key=lambda p: -p["volume"])[0]',
        'list(filter(lambda p: p["volume"] > 1, ud.pads))',
        '[p["volume"] for row in ud.rows for p in row]',
        '[[p["volume"] for p in row] for row in ud.rows]',
        '[i * p["volume"] for i, p in enumerate(ud.pads)]',
        '[p["volume"] for _, p in ud.trays.items()]',
        "[f\"{p['volume']} ml\" for p in sorted(ud.pads, key=len)]",
        '[p["volume"] for p in ud.pads if ud.n > 0]',
    ],
)
def test_a_field_that_the_items_lack(code: str) -> None:
    (found,) = faults(code)
    assert LACKS in found


@pytest.mark.parametrize(
    "code",
    [
        '[p["amount"] for p in ud.pads]',
        '[p["volume"] if "volume" in p else 0 for p in ud.pads]',
        '[p["volume"] for p in ud.pads if "volume" in p]',
        '["volume" in p and p["volume"] for p in ud.pads]',
        '[p.get("volume") for p in ud.pads]',
        '[p["volume"] for p in ud.maybe]',
        '[p["volume"] for p in other(ud.pads)]',
        '[p["volume"] for p in ud.pads for p in other]',
        '[(lambda p: p["volume"])(other) for q in ud.pads]',
        'max(ud.n, key=lambda p: p["volume"])',
        "[n + 1 for n in range(ud.n)]",
        '[k["volume"] for k in ud.unknown]',
        '{**{p["name"]: 1 for p in ud.pads}}',
    ],
)
def test_code_that_is_correct_or_not_known(code: str) -> None:
    assert faults(code) == []


def test_an_operation_on_an_item() -> None:
    (found,) = faults('[p["name"] + 1 for p in ud.pads]')
    assert found.startswith("`p['name'] + 1` adds")
