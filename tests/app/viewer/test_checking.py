"""Pages that contain a certificate and the checker."""

import base64
import functools
import http.server
import io
import os
import subprocess
import sys
import threading
import zipfile
from pathlib import Path

import pytest
from browser import chromium
from running import run

import exactfold
from exactfold.app.viewer.checking import MOST_BYTES, page_checker, policy_source
from exactfold.app.viewer.document import view_document
from exactfold.app.viewer.page import view_page
from exactfold.certificates.entries import certificate_text
from exactfold.errors import NotApplicableError, UsageError

PYODIDE = Path(os.environ.get("NODE_PATH", ""), "pyodide")


def certificate():
    return certificate_text(exactfold.count("single-vertex-4").certificate())


def policy_of(page):
    return page.split('Policy" content="')[1].split('"')[0]


def test_the_checker_in_a_page_is_that_of_the_package(tmp_path):
    """Its archive runs by itself, without exactfold, and verifies the certificate of the page."""
    checker = page_checker(certificate(), "pyodide")
    archive, file = tmp_path / "checker.zip", tmp_path / "certificate"
    archive.write_bytes(base64.b64decode(checker["source"]))
    file.write_text(checker["certificate"])
    words = [sys.executable, "-I", str(archive), str(file)]
    done = subprocess.run(words, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout.split(":")[0]) == (0, "VALID")
    names = zipfile.ZipFile(io.BytesIO(base64.b64decode(checker["source"]))).namelist()
    assert "command.py" in names
    assert all(name.endswith(".py") for name in names)


def test_a_page_without_the_checker_may_load_nothing():
    policy = policy_of(view_page(view_document("single-vertex-4", frames=2)))
    assert "connect-src 'none'" in policy
    assert "wasm" not in policy
    assert "'self'" not in policy


@pytest.mark.parametrize(
    ("address", "source"),
    [
        ("pyodide", "'self'"),
        ("../lib/pyodide/", "'self'"),
        ("https://example.org/pyodide/v1/", "https://example.org"),
        ("http://localhost:8000/pyodide", "http://localhost:8000"),
    ],
)
def test_a_page_may_load_python_from_the_named_place_only(address, source):
    assert policy_source(address) == source
    page = view_page(
        view_document("single-vertex-4", frames=2), page_checker(certificate(), address)
    )
    policy = policy_of(page)
    assert f"connect-src {source};" in policy
    assert f"'wasm-unsafe-eval' {source};" in policy


@pytest.mark.parametrize(
    "address",
    [
        "",
        "a b",
        "x;y",
        "x'y",
        "//example.org",
        "ftp://example.org",
        "javascript:alert(1)",
        "file:///x",
    ],
)
def test_other_addresses_are_refused(address):
    with pytest.raises(UsageError, match="--with-checker"):
        page_checker("{}", address)


def test_a_certificate_that_is_too_long_for_a_page_is_refused():
    with pytest.raises(UsageError, match="exactfold check"):
        page_checker(" " * (MOST_BYTES + 1), "pyodide")


def test_a_count_without_a_certificate_is_refused_by_the_name_of_the_option(tmp_path, monkeypatch):
    monkeypatch.setattr("exactfold.app.commands.view.count", lambda *_, **__: Uncertified())
    page = tmp_path / "page.html"
    result = run("view", "single-vertex-4", "--with-checker", "pyodide", "-o", page)
    assert "--with-checker: nothing is proved; without it" in " ".join(result.stderr.split())
    assert result.exit_code == 2
    assert not page.exists()


class Uncertified:
    """A count of which nothing is proved."""

    def certificate(self):
        raise NotApplicableError("nothing is proved")


@pytest.mark.slow
@pytest.mark.skipif(
    not (PYODIDE / "pyodide.mjs").exists(),
    reason="the npm package pyodide (in NODE_PATH) is not installed",
)
def test_a_browser_checks_the_certificate(tmp_path):
    (tmp_path / "pyodide").symlink_to(PYODIDE)
    valid = certificate()
    texts = {"valid": valid, "false": valid.replace('"distinct":2', '"distinct":3')}
    for name, text in texts.items():
        document = view_document("single-vertex-4", name=name, frames=2)
        (tmp_path / f"{name}.html").write_text(view_page(document, page_checker(text, "pyodide")))
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=str(tmp_path))
    with (
        http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server,
        chromium(tmp_path) as browser,
    ):
        threading.Thread(target=server.serve_forever, daemon=True).start()
        said = {}
        for name in ("valid", "false"):
            browser.open(f"http://127.0.0.1:{server.server_port}/{name}.html")
            browser.run("document.getElementById('check').click()")
            browser.until("document.getElementById('checked').className")
            said[name] = browser.run("document.getElementById('checked').textContent")
        server.shutdown()
    for name, text in texts.items():
        (tmp_path / name).write_text(text)
        words = [sys.executable, "-m", "exactfold.checker", str(tmp_path / name)]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        assert said[name] == (done.stdout + done.stderr).strip()
    assert [text.split(":")[0] for text in said.values()] == ["VALID", "not a certificate"]
