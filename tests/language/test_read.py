"""What a right program becomes, and how freely it may be written."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import pytest

from mdlcad.artefact import from_json, to_json
from mdlcad.errors import InputError
from mdlcad.language import Actuator, Device, Line, Place, Sensor, Value, Where, parse_device, read_device
from tests.language.good import GOOD

ROOT = Path(__file__).parents[2]
PAPER = ROOT.parent / "shared" / "paper"
EXAMPLES = sorted((ROOT / "examples").glob("*.mdl"))


def test_every_attribute() -> None:
    assert parse_device(GOOD, "some/folder/x.mdl") == Device(
        name="m",
        boundary=(
            Line("a", (0, 0), (0, 9), Where(3, 8)),
            Line("b", (0, 9), (9, 9), Where(4, 8)),
            Line("c", (9, 9), (9, 0), Where(5, 8)),
            Line("d", (9, 0), (0, 0), Where(6, 8)),
        ),
        sensors=(
            Sensor("s", (Place("a", 0.5, Where(8, 24)),), (Value("0", "off"), Value("1", "on")), where=Where(8, 8)),
        ),
        actuators=(
            Actuator(
                "t",
                "flag",
                (Place("c", 0.2, Where(9, 41)), Place("c", 0.8, Where(9, 51))),
                (Value("00", "x"),),
                Where(9, 10),
            ),
        ),
        verilog="\n" * 9 + GOOD[GOOD.index("module v") : GOOD.index("endmechanicalmodule")],
        file="x.mdl",
        where=Where(1, 18),
    )


def test_bits_and_labels_come_as_pairs() -> None:
    sensor = parse_device(GOOD, "x.mdl").sensors[0]
    assert [(bits, label) for bits, label in sensor.values] == [("0", "off"), ("1", "on")]


def test_json_round_trip_is_exact_and_says_nothing_of_folders() -> None:
    device = parse_device(GOOD, "/somewhere/else/x.mdl")
    data = to_json(device)
    assert from_json(data, Device) == device
    assert to_json(from_json(data, Device)) == data
    assert b"somewhere" not in data
    assert parse_device(GOOD, "C:\\somewhere\\x.mdl") == device


@pytest.mark.parametrize("before", ["", "\n\n", "/* é */ ", "   `define X 1\n"])
def test_verilog_keeps_every_line_and_column(before: str) -> None:
    text = GOOD.replace("};\nmodule v", "}; " + before + "module v")
    verilog = parse_device(text, "x.mdl").verilog
    source, kept = text.split("\n"), verilog.split("\n")
    start = len(text[: text.index("module v")].split("\n")) - 1
    for line, (written, seen) in enumerate(zip(source, kept[:-1], strict=False)):
        if line > start:
            assert seen == written
        for column, char in enumerate(seen):
            assert char == " " or char == written[column]
    assert kept[start].index("module v") == source[start].index("module v")
    assert verilog.endswith("endmodule\n")


@pytest.mark.parametrize(
    "variant",
    [
        GOOD.replace("\n", "\r\n"),
        "\ufeff" + GOOD,
        "\ufeff" + GOOD.replace("\n", "\r\n"),
        GOOD.replace("\n", "\r"),
    ],
    ids=["CRLF", "BOM", "both", "CR"],
)
def test_line_ends_and_byte_order_marks_make_no_difference(variant: str, tmp_path: Path) -> None:
    path = tmp_path / "x.mdl"
    path.write_bytes(variant.encode())
    assert read_device(path) == parse_device(GOOD, "x.mdl")


def without_places(device: Device) -> bytes:
    return re.sub(rb'"(line|column)": \d+', b"", to_json(device)).replace(b"\\n", b"").replace(b" ", b"")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("mechanicalmodule m();", "mechanicalmodule m()"),
        ("mechanicalmodule m();", "mechanicalmodule m ( ) ; ;"),
        ("};\nsensor", "}\nsensor"),
        ("};\nsensor", "},;\nsensor"),
        ("(0,0)}\n}", "(0,0)},\n}"),
        ("(0,0)}\n}", "(0,0)};\n}"),
        ("(0,9)},", "(0,9)}"),
        ("(0,9)},", "(0,9),},"),
        ("0.5)},", "0.5)}"),
        ("0.5)},", "0.5)};"),
        ("0.5)},", "0.5),},"),
        ("0.5)},", "+5e-1)},"),
        ("0.5)},", ".5)},"),
        ('"on"}', '"on",}'),
        ('"on"}', '"on"},'),
        ("(0,9), (9,9)", "(0,+9), /* b */ ( 9 , 9 ) // c\n"),
        ("sensor s", "sensor // }\n /* { * ** */ s"),
        ("endmechanicalmodule", "endmechanicalmodule; // the end"),
    ],
)
def test_separators_and_comments_are_free(old: str, new: str) -> None:
    assert GOOD.count(old) == 1
    assert without_places(parse_device(GOOD.replace(old, new), "x.mdl")) == without_places(parse_device(GOOD, "x.mdl"))


def test_negative_coordinates_several_modules_and_no_sensor() -> None:
    text = GOOD.replace("(0,0)", "(-7,-3)").replace("module v", "module w(input x);\nendmodule\n(* top *)\nmodule v")
    text = "\n".join(line for line in text.split("\n") if not line.startswith("sensor"))
    device = parse_device(text, "x.mdl")
    assert device.boundary[0].start == (-7, -3)
    assert device.sensors == ()
    assert device.verilog.count("endmodule") == 2


def test_fields_may_be_left_out_or_shuffled() -> None:
    text = GOOD.replace('values = {"0b0": "off", "0b1": "on"}', "values = {}").replace('type = "flag", ', "")
    device = parse_device(text, "x.mdl")
    assert (device.sensors[0].values, device.sensors[0].type, device.actuators[0].type) == ((), "", "")
    text = GOOD.replace("{ location = {(a, 0.5)}, ", '{ type = "switch", ').replace(
        '"on"} };', '"on"}, location = {(a, 0.5)} };'
    )
    sensor = parse_device(text, "x.mdl").sensors[0]
    assert (sensor.type, sensor.places[0].line, len(sensor.values)) == ("switch", "a", 2)


def test_single_digit_keys_label_each_bit_of_several() -> None:
    device = parse_device(GOOD.replace('{"0b00": "x"}', '{"0b0": "down", "0b1": "up"}'), "x.mdl")
    assert device.actuators[0].values == (("0", "down"), ("1", "up"))


@pytest.mark.parametrize("name", ["house_lock", "lock", "maze_solver_robot", "mazerobot"])
def test_the_listings_of_the_paper(name: str) -> None:
    path = PAPER / f"{name}.mdl"
    if not path.is_file():
        warnings.warn(f"{path.name} is not beside the checkout; the paper's listing was NOT tested", stacklevel=1)
        pytest.skip(f"the paper's listing {path.name} is not beside the checkout")
    device = read_device(path)
    text = path.read_text(encoding="utf-8")
    assert device.name == name
    assert device.verilog.lstrip() == text[text.index("module", 20) :].split("endmechanicalmodule")[0].rstrip() + "\n"
    assert from_json(to_json(device), Device) == device
    bits = [sum(len(port.places) for port in ports) for ports in (device.sensors, device.actuators)]
    assert bits == ([4, 2] if "maze" in name else [6, 1])
    assert len(device.boundary) == (4 if "maze" in name else 5)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_examples_are_named_as_their_files(path: Path) -> None:
    assert read_device(path).name == path.stem


def test_missing_file(tmp_path: Path) -> None:
    for path in (tmp_path / "none.mdl", tmp_path, Path("a\0b")):
        with pytest.raises(InputError, match="the file cannot be read"):
            read_device(path)


def test_bytes_that_are_not_text(tmp_path: Path) -> None:
    path = tmp_path / "x.mdl"
    path.write_bytes(b"mechanicalmodule m();\n  caf\xe9")
    with pytest.raises(InputError) as caught:
        read_device(path)
    (finding,) = caught.value.diagnostics
    assert (finding.line, finding.column) == (2, 6)
    assert finding.message == "the byte 0xe9 is not UTF-8 text"
