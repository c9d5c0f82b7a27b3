from itertools import pairwise
from pathlib import Path

import pytest

from mdlcad.datafolder import data_folder
from mdlcad.errors import UsageError
from mdlcad.mechanics import load_process, process_names

GOOD = (data_folder("geometry") / "pom_cut.toml").read_text(encoding="utf-8")


def test_every_process_that_ships_loads_and_cites_its_figures() -> None:
    assert "pom_cut" in process_names()
    for name in process_names():
        assert load_process(name).name == name


def test_plates_lie_on_each_other_with_the_gap_between() -> None:
    process = load_process("pom_cut")
    plates = process.stack.plates
    for below, above in pairwise(plates):
        step = process.z_of(above.name) - process.z_of(below.name)
        assert step == pytest.approx(below.thickness + process.stack.z_gap)


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ("span = 12.5", "span = 'long'", "unit.span"),
        ("span = 12.5", "span = -1.0", "unit.span"),
        ("span = 12.5", "spam = 12.5", "span"),
        ("pair_spacing = 7.0", "pair_spacing = 7.0\nextra = 1", "unit.extra"),
        ("legs = [2, 4, 6]", "legs = [3]", "link.legs"),
        ("rib_width = 4.0", "rib_width = 2.0", "unit.rib_width"),
        ('material = "pom" },       ', 'material = "wood" },       ', "stack.plates.unit.material"),
        ('pin_material = "steel"', 'pin_material = "wood"', "stack.pin_material"),
        ('name = "V", role = "trunk"', 'name = "V", role = "rung"', "stack.plates"),
        ("modulus = 2800.0", "modulus = 0.0", "materials.pom.modulus"),
        ("[unit]", "[unit", "TOML"),
        ("modulus = 2800.0", "modulus = nan", "materials.pom.modulus: must be a number, not nan"),
        ("kerf = 0.2", "kerf = inf", "machine.kerf: must be a number, not inf"),
        ("z_gap = 0.3", "z_gap = -inf", "stack.z_gap: must be a number, not -inf"),
    ],
)
def test_a_fault_is_named_with_file_and_key(tmp_path: Path, old: str, new: str, key: str) -> None:
    assert old in GOOD
    path = tmp_path / "mine.toml"
    path.write_text(GOOD.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(UsageError, match=r"mine\.toml") as caught:
        load_process(path)
    assert key in str(caught.value)


def test_a_folder_is_no_process(tmp_path: Path) -> None:
    (tmp_path / "mine.toml").mkdir()
    with pytest.raises(UsageError, match=r"mine\.toml: cannot be read"):
        load_process(tmp_path / "mine.toml")


def test_an_unknown_name_lists_what_there_is() -> None:
    with pytest.raises(UsageError, match="pom_cut"):
        load_process("granite")
