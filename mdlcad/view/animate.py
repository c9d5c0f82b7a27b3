"""A simulation played on the geometry, as a GIF or a film."""

from __future__ import annotations

import io
import shutil
import subprocess
import tempfile
from itertools import pairwise
from pathlib import Path

import numpy as np
from PIL import Image

from mdlcad.errors import UsageError
from mdlcad.view.caption import caption
from mdlcad.view.playback import Playback, play
from mdlcad.view.scene import Look, Scene
from mdlcad.view.stage import hidden_stage
from mdlcad.view.still import arrange, moment_of

_FRAMES_PER_CYCLE = 10
_FRAMES_PER_SECOND = 10
_DECISIONS = 3
_MOST_FRAMES = 600
_COLOURS = 128


def need_encoder(path: Path) -> None:
    """A film needs ffmpeg.

    Raises:
        UsageError: there is none.
    """
    if path.suffix.lower() == ".mp4" and shutil.which("ffmpeg") is None:
        raise UsageError(f"{path}: a film needs ffmpeg, which is not on this machine; install it, or write a .gif")


def animate(scene: Scene, look: Look, cycles: float | None, suffix: str) -> bytes:
    """The file: ``cycles`` clock cycles (None: of three decisions) from ``look.at`` (None: power-up) on.

    Args:
        suffix: ".gif" or ".mp4".

    Raises:
        UsageError: the scenario cannot be played, it has no such cycles, or ffmpeg fails.
    """
    playback = play(scene.built, look.scenario)
    pictures = _pictures(scene, look, playback, _times(playback, look.at or 0.0, cycles))
    return _gif(pictures) if suffix.lower() == ".gif" else _film(pictures)


def _times(playback: Playback, start: float, cycles: float | None) -> list[float]:
    """The moments to draw, in clock cycles."""
    end = min(start + (playback.cycles * _DECISIONS if cycles is None else cycles), playback.length)
    count = round((end - start) * _FRAMES_PER_CYCLE)
    if count < 2:
        raise UsageError(
            f"--at {start:g}: the run of {playback.scenario} is {playback.length:g} clock cycles long; nothing is left "
            "to animate"
        )
    if count > _MOST_FRAMES:
        raise UsageError(f"--cycles: at most {_MOST_FRAMES // _FRAMES_PER_CYCLE} clock cycles make an animation")
    return [start + number / _FRAMES_PER_CYCLE for number in range(count)]


def _pictures(scene: Scene, look: Look, playback: Playback, times: list[float]) -> list[Image.Image]:
    moments = [moment_of(scene, playback, playback.frame(time)) for time in times]
    words = caption(look.size, [now.title for now in moments], scene.painter.legend(look.colour))
    stage = hidden_stage(scene.model, words.room, smooth="msaa")
    pictures = []
    try:
        arrange(stage, scene, look, moments[0])
        for now in moments:
            stage.stand(explode=look.explode, displacements=now.moved)
            stage.paint(scene.painter.paint(look.colour, now.x, now.waves))
            pictures.append(words.around(stage.picture(), now.title))
    finally:
        stage.plotter.close()
    return pictures


def _gif(pictures: list[Image.Image]) -> bytes:
    """One palette for all frames, so that nothing that stands still flickers; what stands still is left out."""
    sample = pictures[:: max(1, len(pictures) // 6)]
    width, height = sample[0].size
    sheet = Image.new("RGB", (width, height * len(sample)))
    for number, picture in enumerate(sample):
        sheet.paste(picture, (0, number * height))
    palette = sheet.quantize(_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    whole = [np.asarray(picture.quantize(palette=palette, dither=Image.Dither.NONE)) for picture in pictures]
    clear = np.uint8(_COLOURS)  # no colour of the palette: what was there before is seen through it
    changes = [whole[0], *(np.where(now == before, clear, now) for before, now in pairwise(whole))]
    colours = [*(palette.getpalette() or [])[: 3 * _COLOURS], 255, 255, 255]
    frames = []
    for change in changes:
        frame = Image.fromarray(change)
        frame.putpalette(colours)
        frames.append(frame)
    stream = io.BytesIO()
    frames[0].save(
        stream,
        "GIF",
        save_all=True,
        append_images=frames[1:],
        duration=1000 // _FRAMES_PER_SECOND,
        loop=0,
        optimize=False,
        transparency=int(clear),
        disposal=1,
    )
    return stream.getvalue()


def _film(pictures: list[Image.Image]) -> bytes:
    """H.264, with everything off that would write the machine or the time into the file."""
    # the encoder wants even sides
    width, height = (side - side % 2 for side in pictures[0].size)
    with tempfile.TemporaryDirectory() as folder:
        target = Path(folder) / "film.mp4"
        command = ["ffmpeg", "-y", "-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}"]
        command += ["-r", str(_FRAMES_PER_SECOND), "-i", "-", "-threads", "1", "-c:v", "libx264", "-pix_fmt", "yuv420p"]
        command += ["-fflags", "+bitexact", "-flags:v", "+bitexact", "-map_metadata", "-1", "-movflags", "+faststart"]
        frames = b"".join(np.asarray(picture.crop((0, 0, width, height))).tobytes() for picture in pictures)
        done = subprocess.run([*command, str(target)], input=frames, capture_output=True, check=False)
        if done.returncode != 0 or not target.exists():
            last = done.stderr.decode(errors="replace").strip().rpartition("\n")[2]
            raise UsageError(f"ffmpeg failed ({last}); write a .gif instead")
        return target.read_bytes()
