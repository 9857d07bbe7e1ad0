"""How certain a repair is: which of two names is misspelt, and what a repair may not explain."""

from __future__ import annotations

import pytest

from smachac.diagnostics.clusters import Cluster
from smachac.diagnostics.repair import Certainty
from smachac.repair.search import again, clusters
from tests.repair.slips import slip
from tests.trust.judged_repairs import shown
from tests.trust.project_text import MAIN, analysed

FILES = {
    MAIN: """\
name: sm
template: Base
outcomes: [put, motor_failed, sensor_failed]
userdata: {place: shelf, parts: [1, 2]}
initial: FIND
states:
  - FIND:
      template: Find
      speed: 0.5
      transitions: {found: CHECK, lost: sensor_failed}
  - AGAIN:
      template: Find
      speed: 0.1
      transitions: {found: CHECK, lost: motor_failed}
  - CHECK:
      template: ScriptedState
      outcomes: [ok, sensor_error]
      input_keys: [parts]
      transitions: {ok: put, sensor_error: AGAIN}
""",
    "templates/Find.yml": """\
variables: {speed: {type: float, min: 0}}
input_keys: {place: str}
outcomes: {found: {}, lost: {failure: true}}
code: {python: "find:Find"}
""",
    "find.py": """\
import smach


class Find(smach.State):
    def __init__(self, speed):
        super().__init__(outcomes=["found", "lost"], input_keys=["place"])
        self.speed = speed

    def execute(self, userdata):
        return "found" if userdata.place and self.speed else "lost"
""",
}


def found_in(right: str, wrong: str) -> list[Cluster]:
    """The clusters of the project with a slip in its first file that has the right text."""
    file = next(name for name, text in FILES.items() if right in text)
    analysis = analysed({**FILES, file: FILES[file].replace(right, wrong, 1)})
    return clusters(analysis, analysis.report, again(analysis))


def test_the_project_is_correct() -> None:
    assert shown(analysed(FILES))[0] == ()


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        # Several uses agree, and the only declaration differs.
        ("variables: {speed:", "variables: {sped:"),
        ("variables: {speed:", "variables: {Speed:"),
        ("outcomes: {found:", "outcomes: {fuond:"),
        # There is one use: a word of the name is in other names too.
        ("[put, motor_failed, sensor_failed]", "[put, motor_failed, senosr_failed]"),
        ("lost: sensor_failed", "lost: senosr_failed"),
        # There is one use: names of keys and outcomes are in lower case, those of states are not.
        ("userdata: {place", "userdata: {Place"),
        ("parts: [1, 2]", "PARTS: [1, 2]"),
        ("input_keys: [parts]", "input_keys: [PARTS]"),
        ("sensor_error: AGAIN", "sensor_error: again"),
        ("- AGAIN:", "- again:"),
        # A name of the language is right, however often it is used.
        ("failure: true", "Failure: true"),
        ("code: {python", "code: {pyton"),
    ],
)
def test_the_rarer_of_two_names_is_the_misspelt_one(right: str, wrong: str) -> None:
    found = slip(FILES, right, wrong)
    assert found.is_restored
    assert len(found.items) == 1


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        # The state CHECK is missing.
        (FILES[MAIN][FILES[MAIN].index("  - CHECK") :], ""),
        # A declaration is missing of which the rest of the project has the names.
        ("      outcomes: [ok, sensor_error]\n", ""),
        ("outcomes: {found: {}, lost: {failure: true}}\n", ""),
        ("variables: {speed: {type: float, min: 0}}\n", ""),
    ],
)
def test_a_repair_beside_a_missing_part_is_not_likely(right: str, wrong: str) -> None:
    assert all(cluster.repair.certainty is Certainty.POSSIBLE for cluster in found_in(right, wrong))


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ("outcomes: {found: {}, lost:", "outcomes: {lost: {}, lost:"),
        ("lost: {failure: true}}", "found: {failure: true}}"),
    ],
)
def test_which_of_two_equal_names_is_wrong_is_not_known(right: str, wrong: str) -> None:
    assert all(cluster.repair.certainty is Certainty.POSSIBLE for cluster in found_in(right, wrong))


def test_independent_faults_do_not_weaken_a_repair() -> None:
    """Both repairs are proven: after both no finding is left."""
    text = FILES[MAIN].replace("ok: put", "ok: putt").replace("parts: [1, 2]", "prats: [1, 2]")
    analysis = analysed({**FILES, MAIN: text})
    found = clusters(analysis, analysis.report, again(analysis))
    assert len(found) == 2
    assert all(cluster.repair.certainty is not Certainty.POSSIBLE for cluster in found)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        # The finding is at another place, and about a name that is in the text only once.
        ("outcomes: [ok, sensor_error]", "outcomes: [ok, senosr_error]"),
        # With the right name more is understood, and the finding of another slip appears.
        ("template: ScriptedState", "template: ScritpedState"),
    ],
)
def test_a_slip_beside_another_one_has_its_repair(right: str, wrong: str) -> None:
    text = FILES[MAIN].replace("ok: put", "okk: put").replace(right, wrong)
    analysis = analysed({**FILES, MAIN: text})
    found = clusters(analysis, analysis.report, again(analysis))
    texts = {edit.text for cluster in found for edit in cluster.repair.edits}
    assert right.partition(": ")[2].strip("[]").rpartition(", ")[2] in texts
