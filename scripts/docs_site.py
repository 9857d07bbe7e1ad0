"""Hooks of mkdocs: the navigation from docs/README.md, and the pages outside of docs/.

A page has the same path in the site as in the repository, without `docs/`. The page of an example
shows its files, too.
"""

from __future__ import annotations

import posixpath
import re
from pathlib import Path
from typing import Any

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).parents[1]
EXAMPLES = sorted(path.relative_to(ROOT).as_posix() for path in ROOT.glob("examples/*/README.md"))
OUTSIDE = ["CONTRIBUTING.md", "CHANGELOG.md", "bench/README.md", "examples/README.md", *EXAMPLES]
DATA = ["smachac/grammars/report.schema.json"]
LANGUAGES = {".yml": "yaml", ".toml": "toml", ".py": "python", ".cpp": "cpp", ".hpp": "cpp"}
CODE = re.compile(r"(^```.*?^```$|`[^`\n]*`)", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"(?<=\]\()([^)\s]+)(?=\))")


def on_config(config: MkDocsConfig) -> None:
    """The navigation: the sections of docs/README.md and their links."""
    index = (ROOT / "docs" / "README.md").read_text("utf-8")
    config.nav = ["README.md"]
    for section in re.split(r"^## ", index, flags=re.MULTILINE)[1:]:
        title = section.split("\n", 1)[0]
        links = re.findall(r"^- \[[^]]*\]\(([^)]+)\)", section, re.MULTILINE)
        config.nav.append({title: [_entry(_site_path("docs/README.md", item)) for item in links]})


def on_files(files: Files, config: MkDocsConfig) -> None:
    """Add the pages and the data that are outside of docs/."""
    for name in OUTSIDE:
        files.append(File.generated(config, name, content=_text(name)))
    for name in DATA:
        files.append(File.generated(config, name, abs_src_path=str(ROOT / name)))


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """The page with links that lead to pages of the site."""
    here = page.file.src_uri
    source = here if here in OUTSIDE else f"docs/{here}"

    def link(match: re.Match[str]) -> str:
        name, hash_, fragment = match[1].partition("#")
        if not name or re.match(r"[a-z]+:", name):
            return match[1]
        path, _, shown = _site_path(source, name).partition("#")
        relative = posixpath.relpath(path, posixpath.dirname(here) or ".")
        return f"{relative}{hash_ or (shown and '#')}{fragment or shown}"

    parts = CODE.split(markdown)
    return "".join(part if index % 2 else LINK.sub(link, part) for index, part in enumerate(parts))


def _entry(path: str) -> Any:
    """One page of the navigation; the list of the examples contains their pages."""
    return {"Examples": [path, *EXAMPLES]} if path == "examples/README.md" else path


def _site_path(source: str, target: str) -> str:
    """The page of the site for a link in the file `source`; a file of an example is a section."""
    name = posixpath.normpath(posixpath.join(posixpath.dirname(source), target))
    if name.startswith("docs/"):
        return name.removeprefix("docs/")
    if name in OUTSIDE or name in DATA:
        return name
    folder = next(
        parent for parent in (ROOT / name / "_").parents if (parent / "README.md").is_file()
    )
    page = f"{folder.relative_to(ROOT).as_posix()}/README.md"
    section = (ROOT / name).relative_to(folder).as_posix() if (ROOT / name).is_file() else ""
    return f"{page}#{re.sub(r'[^a-z0-9_-]', '', section.lower())}".rstrip("#")


def _text(name: str) -> str:
    """A page outside of docs/; that of an example with its files."""
    text = (ROOT / name).read_text("utf-8")
    if name in EXAMPLES:
        folder = (ROOT / name).parent
        for path in sorted(folder.rglob("*"), key=lambda path: (len(path.parts), path)):
            if language := LANGUAGES.get(path.suffix):
                code = f"```{language}\n{path.read_text('utf-8')}```"
                text += f"\n## {path.relative_to(folder).as_posix()}\n\n{code}\n"
    return text
