"""Build folders made from the small device that is laid out by hand: no build has to run."""

from functools import cache
from pathlib import Path

from mdlcad.artefact import to_json
from mdlcad.language import Actuator, Device, Place, Sensor
from mdlcad.language.device import Line, Value
from mdlcad.parts.bom import bill_of_materials
from mdlcad.proof.outcome import Mismatch, Proof
from mdlcad.report.make import behaviour_of, extent_of, hashes_of, mechanics_of
from mdlcad.report.report import Lvs, Report, StageRecord, Stopped
from mdlcad.routing.drawing import draw_layout
from mdlcad.signoff.drc import Finding
from mdlcad.signoff.lvs import LvsResult
from mdlcad.signoff.summary import DesignRules
from tests.parts.device import Device as SmallDevice
from tests.parts.device import small_device


def proof(wrong: int = 0) -> Proof:
    mismatches = tuple(Mismatch(i, 3, "q=1", "a[0]=0", "b[0]=1", "b[0]=?") for i in range(wrong))
    peaks = {f"m{i}": 1.8 for i in range(6)}
    return Proof(
        "small", "parametron", 8, 8 - wrong, 0, wrong, True, mismatches, 1, 1, 99, 4, -1, 1, 400, 9.0, 0, 1.62, "m3",
        peaks, "walks",
    )  # fmt: skip


RULES = DesignRules({"bed": 0, "min_wall": 0, "overlap": 0, "carrier_stiffness": 0}, (), ("carrier_stiffness",))
BROKEN = DesignRules(
    {"min_wall": 0, "overlap": 1, "carrier_stiffness": 2},
    (
        Finding("overlap", ("rung.a", "rung.b"), 1.0, 2.0, 0.75, 0.0, "they share 0.750 mm2 as assembled"),
        Finding("carrier_stiffness", ("coupler.x",), 1.0, 2.0, 8.5, 10.0, "8.5 times"),
        Finding("carrier_stiffness", ("coupler.<y>",), 1.0, 2.0, 3.25, 10.0, "3.2 times"),
    ),
    ("carrier_stiffness",),
)


def device() -> Device:
    corners = ((0, 0), (0, 9), (9, 9), (9, 0))
    lines = tuple(Line(f"l{i}", corners[i], corners[(i + 1) % 4]) for i in range(4))
    return Device(
        "small",
        lines,
        (Sensor("a", (Place("l0", 0.5),), (Value("0", "off & on"), Value("1", "<b>on</b>"))),),
        (Actuator("b", "flap", (Place("l2", 0.5),), (Value("0", "down"), Value("1", "up"))),),
        "module m(input a, output b); assign b = a; endmodule\n",
        "small.mdl",
    )


@cache
def _small() -> SmallDevice:
    return small_device()


def folder(
    at: Path,
    *,
    rules: DesignRules | None = RULES,
    network_proof: Proof | None = None,
    stopped: Stopped | None = None,
    failures: tuple[str, ...] = (),
    seconds: float = 1.5,
) -> Path:
    """A whole build; with ``rules`` None, one that ended before there was a layout."""
    small = _small()
    network_proof = network_proof or proof()
    at.mkdir(parents=True, exist_ok=True)

    def put(name: str, artefact: object) -> None:
        (at / name).write_bytes(to_json(artefact))

    bodies = small.bodies() if rules else None
    put("process.json", small.process)
    put("device.json", device())
    put("network.json", small.network)
    put("proof.json", network_proof)
    if bodies and rules:
        put("sizing.json", small.sizing)
        put("drc.json", rules)
        put("extraction.json", (LvsResult(True, 6, 2, 1, ()), network_proof))
        (at / "views").mkdir(exist_ok=True)
        drawn = draw_layout(small.network, small.placement, small.layout, small.sizing.rules)
        (at / "views" / "layout.svg").write_bytes(drawn)
    report = Report(
        design="small",
        cells="parametron",
        process=small.process.name,
        seed=0,
        version="0",
        masses=6,
        couplings=2,
        gates=4,
        cycles_per_tick=1,
        period=10.0,
        behaviour=behaviour_of(network_proof),
        extracted=behaviour_of(network_proof) if bodies else None,
        lvs=Lvs(True) if bodies else None,
        drc=rules.counts if rules else None,
        mechanics=mechanics_of(small.sizing, ()) if bodies else None,
        drive=None,
        extent_mm=extent_of(bodies) if bodies else None,
        plates=("unit",) if bodies else (),
        tiles=1 if bodies else None,
        bom=bill_of_materials(bodies, small.process) if bodies else None,
        stages=(StageRecord("device", seconds, "0" * 64), StageRecord("network", 2 * seconds, "0" * 64)),
        stopped=stopped,
        failures=failures,
        files=hashes_of(at),
    )
    put("report.json", report)
    return at
