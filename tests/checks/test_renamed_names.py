"""A name of an interface that has changed there, and not in the class: one finding."""

from __future__ import annotations

import pytest

from tests.checks.test_class_code import INTERFACE, SCRIPT, changed, findings, lines


def of(interface: tuple[str, str], *pairs: tuple[str, str]) -> list[tuple[str, str]]:
    old, new = interface
    script = SCRIPT.replace("lost: lost", f"{new}: lost") if "lost" in old else SCRIPT
    script = SCRIPT.replace("found: seen", f"{new}: seen") if "found" in old else script
    for word in ("tries", "pose"):
        script = script.replace(word, new) if old == f"{word}:" else script
    text = INTERFACE.replace(old, f"{new}:")
    text = text.replace("[pose]", f"[{new}]") if old == "pose:" else text
    text = text.replace("{found: [", f"{{{new}: [") if old == "found:" else text
    report = findings(changed(*pairs), text, script)
    return [(line, each.help or "") for line, each in zip(lines(report), report, strict=True)]


@pytest.mark.parametrize(
    ("interface", "place", "old", "new"),
    [
        (("lost:", "vanished"), 'SM309 cell/find.py:19 "lost"', "lost", "vanished"),
        (("found:", "visible"), 'SM309 cell/find.py:18 "found"', "found", "visible"),
        (("tries:", "rounds"), "SM310 cell/find.py:12 tries", "tries", "rounds"),
        (("pose:", "place"), "SM308 cell/find.py:17 pose", "pose", "place"),
    ],
)
def test_a_name_that_has_changed(
    interface: tuple[str, str], place: str, old: str, new: str
) -> None:
    help = f"write `{new}` in place of `{old}`, also where `FindPart` declares it, or write `{old}`"
    found = of(interface)
    assert found == [(place, f"{help} in place of `{new}` in `FindPart.yml`")]


def test_the_opposite_is_no_other_name() -> None:
    assert all("in place of `found`" not in help for _, help in of(("found:", "not_found")))


def test_two_names_that_have_changed() -> None:
    text = INTERFACE.replace("found:", "visible:").replace("lost:", "vanished:")
    assert all("in place of" not in (finding.help or "") for finding in findings(interface=text))
