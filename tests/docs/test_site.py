"""The site of docs/: mkdocs builds it without a warning, and it needs nothing from the web."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
LOADED = re.compile(r'<(?:script|img|link|iframe)\b[^>]*?(?:src|href)="?([^" >]+)')
"""What a browser loads with a page."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    pytest.importorskip("material", reason="needs mkdocs-material")
    folder = tmp_path_factory.mktemp("site")
    call = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--strict", "-d", str(folder)]
    done = subprocess.run(call, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


@pytest.mark.slow
def test_every_page_is_in_the_site(site: Path) -> None:
    pages = [path.relative_to(ROOT / "docs") for path in (ROOT / "docs").glob("*.md")]
    pages += [path.relative_to(ROOT) for path in (ROOT / "examples").glob("**/README.md")]
    found = [page.parent / ("index" if page.stem == "README" else page.stem) for page in pages]
    assert [page for page in found if not (site / f"{page}.html").is_file()] == []


@pytest.mark.slow
def test_the_navigation_begins_with_the_tutorial(site: Path) -> None:
    text = (site / "index.html").read_text("utf-8")
    links = re.findall(r'<a href="?([^" >]+)"? class="?md-nav__link', text)
    pages = [link for link in links if not link.startswith("#")]
    assert pages[:3] == ["index.html", "tutorial.html", "examples/index.html"]
    assert pages.index("robots.html") < pages.index("language.html") < pages.index("trust.html")
    assert pages[-1] == "CHANGELOG.html"


@pytest.mark.slow
def test_the_site_needs_nothing_from_the_web(site: Path) -> None:
    loaded = {
        target
        for page in site.rglob("*.html")
        for target in LOADED.findall(page.read_text("utf-8"))
    }
    assert any(target.endswith(".css") for target in loaded)
    assert [target for target in loaded if re.match(r"[a-z]+:|//", target)] == []


@pytest.mark.slow
def test_search_finds_rules_and_the_files_of_examples(site: Path) -> None:
    index = json.loads((site / "search" / "search_index.json").read_text("utf-8"))
    places = {entry["location"] for entry in index["docs"]}
    assert {"rules.html#sm101-unknown-target", "tutorial.html#2-the-first-script"} <= places
    assert "examples/11_baxter_stacking/index.html#pick_blockyml" in places


@pytest.mark.slow
@pytest.mark.parametrize("link", ["no.md", "semantics.md#no-such-heading", "../no/folder"])
def test_a_broken_link_stops_the_build(link: str, site: Path, tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "docs" / "README.md").write_text(f"# Start\n\n[link]({link})\n", "utf-8")
    (tmp_path / "docs" / "semantics.md").write_text("# Semantics\n", "utf-8")
    config = (ROOT / "mkdocs.yml").read_text("utf-8")
    (tmp_path / "mkdocs.yml").write_text(re.sub(r"^(hooks|extra_css):.*\n", "", config, flags=re.M))
    call = [sys.executable, "-m", "mkdocs", "build", "--strict"]
    done = subprocess.run(call, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert link.removeprefix("../") in done.stderr
