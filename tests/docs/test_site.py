"""The documentation as a site: built without a warning, whole, and without any address that a browser would fetch."""

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
from lxml import html

from mdlcad.flow.schemas import ARTEFACTS, schema
from tests.docs.blocks import ROOT


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("site") / "site"
    # the theme's advertisement for its successor is not a warning about our pages
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    assert "WARNING" not in done.stderr
    return folder


def test_every_page_of_the_docs_is_in_it(site):
    wanted = {f"{page.stem}.html" for page in (ROOT / "docs").glob("*.md")} | {"artefacts.html"}
    assert wanted <= {page.name for page in site.glob("*.html")}


def test_no_page_fetches_anything_from_elsewhere(site):
    fetched = []
    for page in site.rglob("*.html"):
        root = html.fromstring(page.read_text(encoding="utf-8"))
        fetched += root.xpath("//@src | //link[not(@rel='canonical')]/@href | //object/@data | //iframe/@src")
    for sheet in site.rglob("*.css"):
        fetched += re.findall(r"(?:@import\s+|url\()[\"']?([^\"')]+)", sheet.read_text(encoding="utf-8"))
    assert len(fetched) > 100
    assert [address for address in fetched if re.match(r"(https?:)?//", address)] == []


def test_every_field_of_every_artefact_is_told(site):
    words = (site / "artefacts.html").read_text(encoding="utf-8")
    told = set(re.findall(r"<code>(\w+)</code>", words))
    for name in ARTEFACTS:
        assert f"{name}.json" in words
        for kind in json.loads(schema(name)).get("$defs", {}).values():
            assert set(kind.get("properties", {})) <= told
