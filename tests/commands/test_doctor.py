"""`smachac doctor` and `smachac completion`."""

from __future__ import annotations

import hashlib
import json
import os
import re
import subprocess
import sys
from base64 import urlsafe_b64encode
from importlib.metadata import distributions, version
from pathlib import Path

import pytest

from smachac.commands import doctor
from smachac.commands.cli import COMMANDS, main
from smachac.commands.ros2_distributions import installed_distributions

ROOT = Path(__file__).parents[2]


def test_what_is_installed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor"]) == 0
    shown = capsys.readouterr().out
    assert re.search(r"^  networkx +\d+\.\d+", shown, re.MULTILINE)
    assert main(["doctor", "--format", "json"]) == 0
    parts = {part["name"]: part for part in json.loads(capsys.readouterr().out)["parts"]}
    assert parts["PyYAML"]["found"] == version("PyYAML")
    assert Path(parts["PyYAML"]["file"]).is_file()
    assert all(part["mixed"] == [] for part in parts.values())
    assert parts["g++"]["found"] in ("g++", "clang++", "c++")


def write_package(folder: Path, name: str, release: str, text: str) -> None:
    """Install a distribution that consists of jinja2/__init__.py, as pip does."""
    module = folder / "jinja2" / "__init__.py"
    module.parent.mkdir(exist_ok=True)
    module.write_text(text)
    digest = urlsafe_b64encode(hashlib.sha256(text.encode()).digest()).decode().rstrip("=")
    notes = folder / f"{name}-{release}.dist-info"
    notes.mkdir()
    (notes / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: {release}\n")
    (notes / "RECORD").write_text(f"jinja2/__init__.py,sha256={digest},{len(text)}\n")


@pytest.mark.parametrize("order", [("first", "second"), ("second", "first")])
def test_a_mixture_is_named_with_the_version_that_is_imported(
    order: tuple[str, str], tmp_path: Path
) -> None:
    """Two distributions write the same file: the last one counts."""
    for name in order:
        write_package(tmp_path, name, {"first": "1.0", "second": "2.0"}[name], f"name = {name!r}\n")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])}
    command = [sys.executable, "-m", "smachac", "doctor"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120)
    used = {"first": "1.0", "second": "2.0"}[order[1]]
    other = {"first": "1.0", "second": "2.0"}[order[0]]
    assert re.search(rf"^  Jinja2 +{used} ", done.stdout, re.MULTILINE)
    place = tmp_path / "jinja2" / "__init__.py"
    written = f"{place} is of {order[1]} {used}, and also written by {order[0]} {other}:"
    assert written in done.stderr
    assert done.returncode == 1


@pytest.mark.parametrize(
    "text", ["from_source = True\n", "class YAMLError(Exception): pass\n", "import yaml._yaml\n"]
)
def test_a_package_yaml_without_its_parser_is_named(text: str, tmp_path: Path) -> None:
    """PyYAML built from its source without libyaml, or a module `yaml` of the project."""
    (tmp_path / "yaml").mkdir()
    (tmp_path / "yaml" / "__init__.py").write_text(text)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(tmp_path), str(ROOT)])}
    results = [
        subprocess.run(
            [sys.executable, "-m", "smachac", *command],
            cwd=ROOT, env=environment, capture_output=True, text=True, timeout=120,
        )
        for command in (["check", "examples/01_sequence/main.yml"], ["doctor"])
    ]  # fmt: skip
    assert [done.returncode for done in results] == [1, 1]
    assert results[0].stderr.startswith("a package that smachac requires is missing or broken: ")
    assert results[0].stderr.count("\n") == 1
    assert results[1].stderr == "\nsmachac cannot work without PyYAML\n"


def test_a_missing_package_is_named_with_its_remedy(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    missing = ("no_such_module", "nothing", "a test", "pip install nothing", True)
    monkeypatch.setattr(doctor, "MODULES", (missing,))
    assert main(["doctor"]) == 1
    shown = capsys.readouterr()
    assert re.search(r"^  nothing +missing +a test: pip install nothing$", shown.out, re.MULTILINE)
    assert shown.err == "\nsmachac cannot work without nothing\n"


def test_the_required_packages_are_those_of_the_project() -> None:
    text = (ROOT / "pyproject.toml").read_text("utf-8")
    stated = re.search(r"^dependencies = \[\n(.*?)^\]", text, re.MULTILINE | re.DOTALL)
    assert stated is not None
    names = {name.lower() for name in re.findall(r'^    "([\w.-]+)', stated[1], re.MULTILINE)}
    required = {name.lower() for _, name, *_, needed in doctor.MODULES if needed}
    assert required == names - {"tomli"}


def installed(folder: Path, *packages: str) -> dict[str, list[str]]:
    """Write the metadata of installed packages such as `ros-rclpy 9.1.2`; their distributions."""
    for package in packages:
        name, version = package.split()
        metadata = folder / f"{name.replace('-', '_')}-{version}.dist-info" / "METADATA"
        metadata.parent.mkdir()
        text = f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        metadata.write_text(text, "utf-8")
    return installed_distributions(distributions(path=[str(folder)]))


MIXTURES = [
    (["ros-rclpy 7.1.6", "ros-std-srvs 5.5.1"],
     "Jazzy (ros-rclpy 7.1.6) and Kilted (ros-std-srvs 5.5.1)"),
    (["ros-rclpy 9.1.2", "ros-std-msgs 5.5.1", "ros-test-msgs 2.0.3", "ros-std-srvs 5.3.6"],
     "Jazzy (ros-std-srvs 5.3.6, ros-test-msgs 2.0.3) and "
     "Kilted (ros-rclpy 9.1.2, ros-std-msgs 5.5.1)"),
    (["ros-rclpy 3.3.16", "ros-rmw-fastrtps-cpp 8.4.3", "ros-rosidl-parser 4.9.5"],
     "Humble (ros-rclpy 3.3.16), Jazzy (ros-rmw-fastrtps-cpp 8.4.3) and "
     "Kilted (ros-rosidl-parser 4.9.5)"),
]  # fmt: skip


@pytest.mark.parametrize(("packages", "named"), MIXTURES)
def test_packages_of_two_distributions_of_ros_2_are_named(
    packages: list[str], named: str, tmp_path: Path
) -> None:
    found = installed(tmp_path, *packages)
    assert doctor.mixture(found).startswith(f"packages of {named} are installed, and nodes of")
    assert sorted(package for names in found.values() for package in names) == sorted(packages)


def test_a_mixture_of_distributions_is_an_error(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    packages, named = MIXTURES[0]
    found = installed(tmp_path, *packages)
    monkeypatch.syspath_prepend(tmp_path)
    assert main(["doctor"]) == 1
    assert f"packages of {named} are installed" in capsys.readouterr().err
    assert main(["doctor", "--format", "json"]) == 1
    assert json.loads(capsys.readouterr().out)["ros2_distributions"] == found


@pytest.mark.parametrize(
    "packages",
    [
        ["ros-rclpy 9.1.2", "ros-std-msgs 5.5.9", "ros-kilted-rclpy 9.1.2"],
        ["ros-rclpy 7.1.6", "ros-std-msgs 5.3.0", "ros-other 5.5.1", "ros-wheels-bootstrapper 0.1"],
        ["ros-rclpy 11.0.0", "ros-std-msgs 6.0"],
        ["roslibpy 9.1", "rclpy 9.1.2"],
    ],
)
def test_packages_of_one_distribution_of_ros_2(packages: list[str], tmp_path: Path) -> None:
    assert len(installed(tmp_path, *packages)) <= 1


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completions_have_every_command_and_its_options(
    shell: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["completion", shell]) == 0
    script = capsys.readouterr().out
    assert all(command in script for command in COMMANDS)
    assert "--schedule" in script or "-l schedule" in script


def test_bash_completes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["completion", "bash"]) == 0
    (tmp_path / "smachac.bash").write_text(capsys.readouterr().out, "utf-8")
    (tmp_path / "main.yml").write_text("", "utf-8")
    typed = (
        "source ./smachac.bash\n"
        'COMP_WORDS=(smachac "$@"); COMP_CWORD=$#; _shtab_smachac; echo "${COMPREPLY[@]}"\n'
    )

    def completed(*words: str) -> list[str]:
        command = ["bash", "-c", typed, "bash", *words]
        ended = subprocess.run(
            command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=True
        )
        return ended.stdout.split()

    assert completed("ver") == ["verify"]
    assert completed("run", "--sch") == ["--schedule"]
    assert "main.yml" in completed("check", "ma")
