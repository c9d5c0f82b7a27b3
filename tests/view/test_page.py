"""The page: whole in itself, the same bytes, and a browser without a network draws the device from it."""

import base64
import json
import re
import subprocess
import sys
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mdlcad.view.colours import ColourBy
from mdlcad.view.page import page
from mdlcad.view.scene import Look, Scene
from tests.browser import BROWSER
from tests.browser import browse as run_browser

needs_browser = pytest.mark.skipif(
    BROWSER is None, reason="NO BROWSER: chromium is not on this machine, so the page was not tried in one"
)


@pytest.fixture(scope="module")
def written(scene: Scene) -> bytes:
    return page(scene, Look())


def facts_of(data: bytes) -> dict:
    found = re.search(rb'<script id="facts"[^>]*>(.*?)</script>', data, re.DOTALL)
    return json.loads(found[1])


def arrays_of(data: bytes) -> dict[str, np.ndarray]:
    block = re.search(rb'<script id="block"[^>]*>(.*?)</script>', data, re.DOTALL)
    raw = zlib.decompress(base64.b64decode(block[1]))
    found, start = {}, 0
    for name, (kind, count) in facts_of(data)["arrays"].items():
        dtype = np.dtype(kind).newbyteorder("<")
        found[name] = np.frombuffer(raw, dtype, count, start)
        start += count * dtype.itemsize
    assert start == len(raw)
    return found


def test_nothing_is_fetched(written: bytes) -> None:
    text = written.decode("utf-8")
    assert not re.search(r"https?:|//[a-z]+\.|@import|url\(|<link|<img|<script[^>]+src|fetch\(|XMLHttp|import\(", text)
    assert text.count("<script") == 3 and text.count("</script>") == 3


def test_what_is_sent_is_the_device(scene: Scene, written: bytes) -> None:
    facts, arrays = facts_of(written), arrays_of(written)
    points = np.cumsum(arrays["points"].reshape(-1, 2), axis=0) * facts["grid"]
    wanted = np.concatenate([outline.points for outline in scene.model.outlines])
    assert np.abs(points - wanted).max() <= 0.5001 * facts["grid"]
    assert [body["name"] for body in facts["bodies"]] == [body.name for body in scene.built.bodies]
    cards = [facts["facts"][body["facts"]] for body in facts["bodies"]]
    assert cards == [[list(pair) for pair in card.facts] for card in scene.cards]
    assert set(facts["legends"]) == {by.value for by in ColourBy}


def test_the_simulation_is_sent_within_its_steps(written: bytes, scene: Scene) -> None:
    from mdlcad.view.playback import play

    facts, arrays = facts_of(written), arrays_of(written)
    x = play(scene.built, None).x[::2]
    steps = np.cumsum(arrays["trace"].reshape(len(x), -1).astype(np.int64), axis=0) & 255
    found = np.where(steps > 127, steps - 256, steps) * facts["run"]["step"]
    assert np.abs(found - x).max() <= 0.5001 * facts["run"]["step"]


def test_names_cannot_end_the_script(scene: Scene) -> None:
    bad = "</script><script>alert(1)</script>"
    built = replace(scene.built, report=replace(scene.built.report, design=bad))
    data = page(replace(scene, built=built), Look())
    assert b"alert(1)</script>" not in data.replace(b"&lt;", b"<").split(b'<script id="facts"')[1]
    assert data.count(b"<script") == 3
    assert facts_of(data)["design"] == bad


@pytest.mark.long
def test_the_same_bytes_in_another_process(voter: Path, written: bytes, tmp_path: Path) -> None:
    subprocess.run(
        [sys.executable, "-m", "mdlcad.cli", "view", str(voter), "--html", str(tmp_path / "a.html")],
        env={"PYTHONHASHSEED": "4711", "PATH": "/usr/bin:/bin"},
        check=True,
        capture_output=True,
        timeout=300,
    )
    assert (tmp_path / "a.html").read_bytes() == written


def browse(folder: Path, *arguments: str) -> str:
    """Run the browser with no network; what it printed."""
    return run_browser(folder, "1000,700", *arguments)


# goes over the canvas with the mouse until a card says what is there
_POINT = """
<script>
const timer = setInterval(() => {
  if (!document.documentElement.dataset.bodiesSeen) return;
  clearInterval(timer);
  const canvas = document.getElementById('canvas'), names = new Set();
  for (let y = 100; y < 600; y += 25) {
    for (let x = 300; x < 980; x += 20) {
      canvas.dispatchEvent(new PointerEvent('pointermove', { clientX: x, clientY: y, pointerId: 1 }));
      const card = document.querySelector('#card:not([hidden]) h2');
      if (card) names.add(card.textContent);
    }
  }
  document.documentElement.dataset.pointed = [...names].join(' ');
}, 50);
</script>
"""


@needs_browser
def test_a_browser_draws_it_and_pointing_names_the_parts(scene: Scene, written: bytes, tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    path.write_bytes(written.replace(b"</body>", _POINT.encode() + b"</body>"))
    dom = browse(tmp_path, "--dump-dom", path.as_uri())
    trouble = re.search(r'<p id="trouble"([^>]*)>', dom)
    assert "hidden" in trouble[1], dom[-2000:]
    seen = int(re.search(r'data-bodies-seen="(\d+)"', dom)[1])
    assert 20 < seen <= len(scene.built.bodies)
    triangles = sum(len(group.faces) for group in scene.model.groups)
    assert int(re.search(r'data-triangles="(\d+)"', dom)[1]) == triangles
    pointed = set(re.search(r'data-pointed="([^"]*)"', dom)[1].replace("&gt;", ">").split())
    assert len(pointed) > 8 and pointed <= {body.name for body in scene.built.bodies}
    assert any(name.startswith("rung.") for name in pointed)
    for plate in scene.model.plates:
        assert f"> {plate}</label>" in dom


@pytest.mark.long
@needs_browser
def test_the_address_finds_a_unit_and_shows_its_card_and_its_colour(written: bytes, tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    path.write_bytes(written)
    address = f"{path.as_uri()}#find=verdict%5B0%5D&colour=polarity&camera=top"
    dom = browse(tmp_path, "--dump-dom", f"--screenshot={tmp_path / 'a.png'}", address)
    if not (tmp_path / "a.png").exists():  # some versions do one of the two
        browse(tmp_path, f"--screenshot={tmp_path / 'a.png'}", address)
    card = re.search(r'<div id="card"[^>]*>(.*?)</div>', dom, re.DOTALL)[1]
    assert "<h2>unit.verdict[0]</h2>" in card and "3.5 - 3 p" in card and "margin" in card
    assert 'id="legend"' in dom and "+1: logic 1 is at +y" in dom
    pixels = np.asarray(Image.open(tmp_path / "a.png").convert("RGB")).astype(int)
    # the colour of what was found, lit from above
    marked = (pixels[..., 0] > 180) & (pixels[..., 1] < 60) & (pixels[..., 2] > 80) & (pixels[..., 2] < 150)
    assert marked[:, 300:].sum() > 1500
