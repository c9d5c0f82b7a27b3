"""Pictures and animations, without a screen."""

import io
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import mdlcad.view.animate
from mdlcad.cli import HOLDS, UNUSABLE, main
from mdlcad.view.animate import animate
from mdlcad.view.camera import VIEW_ANGLE, Preset, pose
from mdlcad.view.caption import caption
from mdlcad.view.colours import ColourBy, Key
from mdlcad.view.scene import Look, Scene
from mdlcad.view.stage import hidden_stage
from mdlcad.view.still import still

SMALL = Look(size=(320, 240))


def pixels(data: bytes) -> np.ndarray:
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB")).astype(int)


def inked(data: bytes) -> int:
    return int((pixels(data).sum(axis=2) < 740).sum())


@pytest.fixture(scope="module")
def plain(scene: Scene) -> bytes:
    return still(scene, SMALL)


def test_a_picture_shows_the_device_in_its_colours(scene: Scene, plain: bytes) -> None:
    found = pixels(plain)
    assert found.shape == (240, 320, 3)
    assert inked(plain) > 0.15 * 320 * 240
    blue = (found[..., 2] > found[..., 0] + 50).sum()  # units of phase 0 and their clock plate
    assert blue > 200


def test_the_same_bytes_again(scene: Scene, plain: bytes) -> None:
    assert still(scene, SMALL) == plain


def test_plates_are_switched(scene: Scene, plain: bytes) -> None:
    base = still(scene, replace(SMALL, plates=("base",), camera=Preset.TOP))
    unit = still(scene, replace(SMALL, plates=("unit",), camera=Preset.TOP))
    assert inked(unit) < 0.7 * inked(base)


def test_what_is_found_is_marked_and_has_its_card_beside_it(scene: Scene, plain: bytes) -> None:
    def marked(data: bytes) -> int:
        found = pixels(data)[:, :210]
        return int(((found[..., 0] > 110) & (found[..., 1] < 60) & (found[..., 2] > 50)).sum())

    found = still(scene, replace(SMALL, find="unit.verdict[0]"))
    assert marked(found) > 400 > 40 > marked(plain)
    assert (pixels(found)[:, 215:].sum(axis=2) < 500).sum() > 200  # letters


@pytest.mark.long
def test_a_moment_of_a_simulation_is_another_picture(scene: Scene) -> None:
    states = [still(scene, replace(SMALL, colour=ColourBy.STATE, at=at, camera=Preset.TOP)) for at in (0.3, 0.8)]
    assert states[0] != states[1]


@pytest.mark.parametrize("preset", Preset)
def test_every_camera_just_holds_all_of_the_device(scene: Scene, preset: Preset) -> None:
    points = np.concatenate([group.placed(0.5 * scene.model.apart, None) for group in scene.model.groups])
    aspect = 1.5
    found = pose(preset, points, aspect)
    towards = np.array(found.position) - np.array(found.focus)
    distance = np.linalg.norm(towards)
    towards /= distance
    right = np.cross(found.up, towards)
    right /= np.linalg.norm(right)
    above = np.cross(towards, right)
    local = points - np.array(found.focus)
    depth = distance - local @ towards
    half = np.tan(np.radians(VIEW_ANGLE / 2)) * depth if found.half_height is None else found.half_height
    across, along = np.abs(local @ right) / (half * aspect), np.abs(local @ above) / half
    assert depth.min() > 0.0
    assert across.max() <= 1.0 and along.max() <= 1.0
    assert max(across.max(), along.max()) > 0.9  # it fills the picture one way


def test_an_animation_has_its_frames_and_they_move(scene: Scene) -> None:
    data = animate(scene, replace(SMALL, colour=ColourBy.STATE), 0.5, ".gif")
    film = Image.open(io.BytesIO(data))
    assert film.n_frames == 5
    frames = []
    for number in range(film.n_frames):
        film.seek(number)
        frames.append(np.asarray(film.convert("RGB")).astype(int)[30:])
    assert all((np.abs(after - before).sum(axis=2) > 60).sum() > 30 for before, after in pairwise(frames))


def test_a_clock_plate_and_a_unit_are_seen_to_move(scene: Scene) -> None:
    """What ``animate`` draws: the same stage, stood at two moments."""
    from mdlcad.view.motion import displacements

    stage = hidden_stage(scene.model, (200, 150))
    built = scene.built
    try:
        rest = {name: stage.points([numbers(scene, name)]) for name in ("clock-0", "unit.verdict[0]", "base")}
        stage.stand(
            explode=0.0, displacements=displacements(built, np.ones(len(built.network.masses)), np.full(3, 2.0))
        )
        by = {name: np.abs(stage.points([numbers(scene, name)]) - points).max(axis=0) for name, points in rest.items()}
    finally:
        stage.plotter.close()
    assert by["clock-0"][0] == pytest.approx(built.sizing.rules.clock_throw, abs=0.06) and by["clock-0"][1] == 0.0
    assert by["unit.verdict[0]"][1] == pytest.approx(built.process.unit.throw_unit, abs=1e-4)
    assert np.all(by["base"] == 0.0)


def numbers(scene: Scene, name: str) -> int:
    return next(number for number, body in enumerate(scene.built.bodies) if body.name == name)


def test_a_film_without_ffmpeg_is_refused_in_words(
    voter: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(mdlcad.view.animate.shutil, "which", lambda name: None)
    assert main(["view", str(voter), "--animate", str(tmp_path / "a.mp4")]) == UNUSABLE
    assert (
        "a.mp4: a film needs ffmpeg, which is not on this machine; install it, or write a .gif"
        in capsys.readouterr().err
    )


def test_the_command_writes_what_was_asked_for(voter: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.png"
    arguments = ["--size", "200x150", "--explode", "0.6", "--colour", "margin", "--camera", "front", "--plates", "all"]
    assert main(["view", str(voter), "--screenshot", str(path), *arguments]) == HOLDS
    assert Image.open(path).size == (200, 150)
    assert "written" in capsys.readouterr().out
    assert list(tmp_path.iterdir()) == [path]


KEYS = [Key("#2b6cd4", f"what number {number} stands for") for number in range(9)]


@pytest.mark.parametrize("size", [(960, 720), (640, 640), (400, 300), (320, 240), (100, 100)])
@pytest.mark.parametrize("title", ["short", "a title of so many words that it takes several lines of any picture " * 3])
def test_words_cover_nothing_of_what_is_shown(size: tuple[int, int], title: str) -> None:
    words = caption(size, ["short", title], KEYS)
    black = np.zeros((words.room[1], words.room[0], 3), np.uint8)
    picture = np.asarray(words.around(black, title))
    assert picture.shape == (size[1], size[0], 3)
    assert words.room[0] == size[0]
    assert words.room[1] >= size[1] // 2
    shown = picture[words.above : words.above + words.room[1]]
    if words.above:
        assert (shown == 0).all()
    else:
        assert size[1] <= 300, "a title lies over a small picture alone"
    assert [key for row in words.rows for key in row] in (KEYS, [])


def test_small_pictures_leave_out_the_keys_and_large_ones_show_them_all() -> None:
    small, large = caption((200, 150), ["a"], KEYS), caption((960, 720), ["a"], KEYS)
    assert small.rows == ()
    assert [key for row in large.rows for key in row] == KEYS
    picture = np.asarray(large.around(np.full((large.room[1], large.room[0], 3), 255, np.uint8), "a"))
    blue = (picture == (0x2B, 0x6C, 0xD4)).all(axis=2)
    assert blue.sum() > 9 * 100
    assert not blue[: large.above + large.room[1]].any()
