"""A build in a notebook."""

import base64
import html
import io
import re
from pathlib import Path

import pytest
from PIL import Image

import mdlcad
from mdlcad.errors import UsageError


@pytest.fixture(scope="module")
def build(voter: Path):
    return mdlcad.open_build(str(voter))


def test_it_shows_itself_with_a_picture_and_its_figures(build) -> None:
    shown = build._repr_html_()
    picture = re.search(r'src="data:image/png;base64,([^"]+)"', shown)
    image = Image.open(io.BytesIO(base64.b64decode(picture[1])))
    assert image.size == (900, 640) and len(image.convert("RGB").getcolors(10**6)) > 100
    for words in ("<h3>voter</h3>", "units", "pom_cut", "all hold"):
        assert words in shown
    assert repr(build).startswith("<build of voter: cells parametron")


def test_the_viewer_runs_inline_with_no_server(build) -> None:
    shown = build.show(colour="state", find="verdict[0]", height=500)._repr_html_()
    inside = html.unescape(re.search(r'<iframe srcdoc="([^"]*)"', shown)[1])
    assert inside.startswith("<!doctype html>") and '"find":"verdict[0]"' in inside and "height: 500px" in shown


def test_what_is_not_there_is_told(build, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="nothing in voter"):
        build.show(find="nobody")
    with pytest.raises(ValueError, match="'taste' is not a valid ColourBy"):
        build.show(colour="taste")
    with pytest.raises(UsageError, match="no such build folder"):
        mdlcad.open_build(tmp_path / "nowhere")
