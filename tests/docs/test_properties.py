"""docs/properties.md shows what is printed."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from smachac.commands.cli import main
from tests.support.golden import REWRITE

PAGE = Path(__file__).parents[2] / "docs" / "properties.md"
TEXT = PAGE.read_text("utf-8")
FILES = {
    block.split("\n", 1)[0].removeprefix("# "): block
    for block in re.findall(r"^```yaml\n(.*?)^```$", TEXT, re.MULTILINE | re.DOTALL)
}
SHOWN = re.findall(r"^\$ smachac (.*)\n((?:(?!\$ |```).*\n)*)", TEXT, re.MULTILINE)


@pytest.mark.parametrize(("command", "shown"), SHOWN)
def test_golden_commands_print_what_is_shown(
    command: str,
    shown: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    for name, text in FILES.items():
        (tmp_path / name).write_text(text, "utf-8")
    monkeypatch.chdir(tmp_path)
    main(shlex.split(command))
    found = capsys.readouterr().out
    if REWRITE:
        head = f"$ smachac {command}\n"
        PAGE.write_text(PAGE.read_text("utf-8").replace(head + shown, head + found), "utf-8")
        shown = found
    assert found == shown
