"""Scripts with what is expected of them: report, IR, every target. `make golden` rewrites it."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.targets import target_names
from tests.support.golden import compare_folder, outputs

ROOT = Path(__file__).parents[1]
CASES = sorted(path.parent for path in (ROOT / "cases").glob("*/main.yml"))
EXAMPLES = sorted(path.parent for path in (ROOT.parent / "examples").glob("*/main.yml"))


def expected_folder(case: Path) -> Path:
    """Beside the script; for examples, which users read, among the cases."""
    if case in EXAMPLES:
        return ROOT / "cases" / "examples" / case.name / "expected"
    return case / "expected"


TARGETS = [name for name in target_names() if name not in ("flexbe", "html", "yasmin")]
"""Those with expected files. A page of `html` has 1.7 MB; tests/targets/test_html.py compares its
data with the machine. The files of `flexbe` and `yasmin` contain those of
`python`; tests/flexbe and tests/yasmin run them."""


@pytest.mark.parametrize("case", [*CASES, *EXAMPLES], ids=lambda case: case.name)
def test_golden(case: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(case)
    compare_folder(outputs(TARGETS), expected_folder(case))
