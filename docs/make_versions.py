"""Builds the site of each version, with links between them: `python docs/make_versions.py SITE`.

    python docs/make_versions.py SITE [REVISION ...]

Each revision, by default all tags and `main`, is built from its own sources into SITE/REVISION,
with the packages that are installed. A line on top of each page names its version and leads to the
same page of the others, or to their first page. SITE/index.html leads to the newest version.
"""

from __future__ import annotations

import argparse
import html
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from urllib.parse import quote

ROOT = Path(__file__).resolve().parent.parent
_OPEN = "<body>"
_OF_SPHINX = "documentation_options.js"
"""What pages of the site load, but the viewers in it do not."""


def revisions(repository: Path) -> list[str]:
    """All tags, the newest first, then `main`."""
    command = ["git", "-C", str(repository), "tag", "--sort=-version:refname"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return [*done.stdout.split(), "main"]


def folder(revision: str) -> str:
    """The name of the folder of a version."""
    return revision.replace("/", "-")


def build(repository: Path, revision: str, site: Path) -> None:
    """Builds one version; its sources go before the installed package."""
    with tempfile.TemporaryDirectory() as place:
        archive = ["git", "-C", str(repository), "archive", "--format=tar", revision]
        content = subprocess.run(archive, capture_output=True, check=True).stdout
        subprocess.run(["tar", "-x", "-C", place], input=content, check=True)
        sphinx = [sys.executable, "-m", "sphinx", "-q", "-b", "html", "docs", "site/html"]
        subprocess.run(sphinx, cwd=place, env={**os.environ, "PYTHONPATH": place}, check=True)
        target = site / folder(revision)
        shutil.rmtree(target, ignore_errors=True)
        shutil.copytree(Path(place, "site", "html"), target)


def link(site: Path, versions: list[str]) -> None:
    """Writes the line on top of each page, and the first page of the site."""
    versions = list(map(folder, versions))
    for version in versions:
        for page in sorted((site / version).rglob("*.html")):
            text = page.read_text(encoding="utf-8")
            if _OPEN in text and _OF_SPHINX in text:
                line = _line(site, page, version, versions)
                page.write_text(text.replace(_OPEN, f"{_OPEN}\n{line}", 1), encoding="utf-8")
    first = f"{quote(versions[0])}/index.html"
    (site / "index.html").write_text(
        f'<!doctype html><meta charset="utf-8"><title>exactfold</title>'
        f'<meta http-equiv="refresh" content="0; url={first}"><a href="{first}">exactfold</a>\n',
        encoding="utf-8",
    )


def _line(site: Path, page: Path, version: str, versions: list[str]) -> str:
    inside = page.relative_to(site / version)
    up = "../" * len(inside.parts)
    links = []
    for other in versions:
        if other != version:
            same = inside if (site / other / inside).exists() else Path("index.html")
            address = f"{up}{quote(other)}/{quote(same.as_posix())}"
            links.append(f'<a href="{address}">{html.escape(other)}</a>')
    others = f"; others: {', '.join(links)}" if links else ""
    return f'<p class="versions">Version {html.escape(version)}{others}</p>'


def main(arguments: list[str] | None = None) -> None:
    """Builds and links the sites."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split(":")[0])
    parser.add_argument("site", type=Path, help="the folder into which all is written")
    parser.add_argument("revisions", nargs="*", help="tags, branches or commits, the newest first")
    parser.add_argument("--repository", type=Path, default=ROOT)
    options = parser.parse_args(arguments)
    chosen = options.revisions or revisions(options.repository)
    for revision in chosen:
        build(options.repository, revision, options.site)
    link(options.site, chosen)


if __name__ == "__main__":
    main()
