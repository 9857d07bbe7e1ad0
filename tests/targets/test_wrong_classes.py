"""An interface that names the class of another one, as after a copy: one finding at the name."""

from __future__ import annotations

import pytest

from tests.trust.project_text import analysed

MAIN = """\
name: sm
template: Base
outcomes: [done, failed]
userdata: {pose: 3}
states:
  - HOLD: {template: Hold, transitions: {held: RELEASE, missed: failed}}
  - RELEASE: {template: Release, transitions: {released: done}}
"""
HOLD = """\
name: Hold
input_keys: {pose: int}
outcomes: {held: {}, missed: {failure: true}}
code: {python: "arms:Hold"}
"""
RELEASE = """\
name: Release
outcomes: {released: {}}
code: {python: "arms:Hold"}
"""
CODE = """\
import smach


class Hold(smach.State):
    def __init__(self):
        super().__init__(outcomes=["held", "missed"], input_keys=["pose"])

    def execute(self, userdata):
        return "missed" if userdata.pose < 3 else "held"


class Release(smach.State):
    def __init__(self):
        super().__init__(outcomes=["released"])

    def execute(self, userdata):
        return "released"
"""
HEADER = """\
#include "smachac/smachac.hpp"
namespace arms {
class Hold {
public:
  enum class Outcome { held, missed };
  Outcome execute() { return closed() ? Outcome::held : Outcome::missed; }
};
class Release {
public:
  enum class Outcome { released };
  Outcome execute() { return Outcome::released; }
};
}
"""


def found(main: str = MAIN, **files: str) -> list[tuple[str, str, str]]:
    texts = {"Hold.yml": HOLD, "Release.yml": RELEASE}
    texts |= {name.replace("_yml", ".yml"): text for name, text in files.items() if "_yml" in name}
    project = {f"templates/{name}": text for name, text in texts.items()}
    project |= {"main.yml": main, "arms.py": files.get("code", CODE)}
    project |= {"arms.hpp": files.get("header", HEADER)}
    report = analysed(project).report
    return [(item.code, f"{item.span} {item.span.text}", item.help or "") for item in report]


def test_the_class_of_another_interface() -> None:
    assert found() == [("SM603", "templates/Release.yml:3:22 Hold", "write `arms:Release`")]


def test_a_class_of_cpp() -> None:
    code = 'code: {cpp: {header: arms.hpp, class: "arms::Hold"}}'
    (one,) = [each for each in found(Release_yml=RELEASE.replace('code: {python: "arms:Hold"}',
                                     code)) if "Release" in each[1]]  # fmt: skip
    assert one == ("SM603", "templates/Release.yml:3:46 Hold", "write `arms::Release`")


@pytest.mark.parametrize(
    "files",
    [
        {"Release_yml": RELEASE.replace("arms:Hold", "arms:Release")},
        {"Release_yml": "name: Release\n" + HOLD.partition("\n")[2],
         "main": MAIN.replace("{released: done}", "{held: done, missed: failed}")},
    ],
)  # fmt: skip
def test_a_class_that_fits(files: dict[str, str]) -> None:
    assert found(**files) == []


def test_no_class_of_its_own_name() -> None:
    codes = {code for code, *_ in found(code=CODE.replace("class Release", "class Free"))}
    assert codes == {"SM309", "SM603"}
