"""States with code for YASMIN or FlexBE alone, in a project with templates of its own."""

from __future__ import annotations

from pathlib import Path

import pytest

from smachac.commands.cli import main

FILES = {
    "main.yml": "name: sm\ntemplate: Own\noutcomes: [done]\n"
    "states:\n- A: {template: Grasp, speed: 1.0, transitions: {done: done}}\n",
    "templates/Own.yml": "name: Own\nkind: base\ncode: {python: Own.tpl.py}\n",
    "templates/Own.tpl.py": '{% extends "Program.tpl.py" %}\n'
    "{%- block imports %}{{ super() }}\nimport math\n{%- endblock %}\n",
    "templates/Grasp.yml": "name: Grasp\nvariables: {speed: {}}\noutcomes: {done: {}}\n"
    'code: {FRAMEWORK: "arm:Grasp"}\n',
}


@pytest.mark.parametrize("framework", ["flexbe", "yasmin"])
def test_the_check_renders_the_templates_with_them(
    framework: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    (tmp_path / "templates").mkdir()
    for name, text in FILES.items():
        (tmp_path / name).write_text(text.replace("FRAMEWORK", framework))
    monkeypatch.chdir(tmp_path)
    assert main(["check", "main.yml"]) == 0, capsys.readouterr()
    assert main(["build", "main.yml", "--target", framework, "-o", "out"]) == 0
    assert main(["build", "main.yml", "--target", "python", "-o", "other"]) == 1
    assert f"build it with `--target {framework}`" in capsys.readouterr().err
    assert not Path("other").exists()
    base = Path("templates/Own.tpl.py")
    base.write_text(base.read_text().replace("math", "{{ unknown_word }}"))
    assert main(["check", "main.yml"]) == 1
    assert "unknown_word" in capsys.readouterr().out
