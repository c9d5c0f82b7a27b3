"""How much of a device stays when its program is edited: with --like the earlier build, and without.

    ./run python -m tests.benchmarks.bench_like [FOLDER [WORDS]]

Every edit is made to an example, which is built as far as its layout three times: as it was, edited, and edited with
``--like`` the first. A mass has *changed itself* if it is new, or of another phase or bias, or has other inputs. Of
those that have not, the table tells how many are elsewhere, by slot and in mm, and how much of the routing (trunks and
rungs) of the unchanged nets is where it was; where a device has grown, against the shift of its unchanged masses.
``FOLDER`` keeps the builds; what is there already is not built again. ``WORDS`` picks the edits whose names hold them.
"""

from __future__ import annotations

import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from mdlcad.artefact import load
from mdlcad.flow.build import Request, build
from mdlcad.mapping import MappingRequest
from mdlcad.network.model import Network
from mdlcad.placement.placement import Placement
from mdlcad.routing.layout import Layout

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


@dataclass(frozen=True, slots=True)
class Edit:
    """One edit: replacements in the text of a design's program; ``condition`` if it changes one condition only."""

    name: str
    design: str
    replacements: tuple[tuple[str, str], ...]
    condition: bool = False

    def apply(self, text: str) -> str:
        """The edited program."""
        for old, new in self.replacements:
            if old not in text:
                raise ValueError(f"{self.name}: the program does not have {old!r}")
            text = text.replace(old, new)
        return text


MAZE, TURNSTILE = "mazerobot", "turnstile"
_LEFT = "LEFT:  chosen = first_open(DOWN,  wall_back,  LEFT,  wall_left,  UP,    wall_front, RIGHT);"
_UP = "UP:    chosen = first_open(LEFT,  wall_left,  UP,    wall_front, RIGHT, wall_right, DOWN);"
_RIGHT = "RIGHT: chosen = first_open(UP,    wall_front, RIGHT, wall_right, DOWN,  wall_back,  LEFT);"
_DOWN = "DOWN:  chosen = first_open(RIGHT, wall_right, DOWN,  wall_back,  LEFT,  wall_left,  UP);"

EDITS = (
    Edit("a comment is renamed", MAZE, (("counted clockwise, so", "numbered clockwise, so"),)),
    Edit("a wire is renamed", MAZE, (("chosen", "selected"),)),
    Edit("written with if instead of ?:", MAZE, (
        ("first_open = !wall_1 ? way_1 : !wall_2 ? way_2 : !wall_3 ? way_3 : way_back;",
         "if (!wall_1) first_open = way_1; else if (!wall_2) first_open = way_2; "
         "else if (!wall_3) first_open = way_3; else first_open = way_back;"),)),
    Edit("it starts upwards", MAZE, (("initial drive = LEFT", "initial drive = UP"),)),
    Edit("going up, its right counts as free", MAZE, ((_UP, _UP.replace("wall_right", "1'b0")),), True),
    Edit("going left, its left counts as a wall", MAZE, ((_LEFT, _LEFT.replace("wall_back", "1'b1")),), True),
    Edit("going right, blocked only by front and right", MAZE,
         ((_RIGHT, _RIGHT.replace("RIGHT, wall_right", "RIGHT, wall_right & wall_front")),), True),
    Edit("going down, the last way is left", MAZE, ((_DOWN, _DOWN.replace(" UP);", " LEFT);")),), True),
    Edit("going up, straight on comes first", MAZE, (
        (_UP, _UP.replace("LEFT,  wall_left,  UP,    wall_front,", "UP,    wall_front, LEFT,  wall_left,")),), True),
    Edit("walls all round: it stays", MAZE, (
        ("drive <= chosen;", "if (!(wall_left & wall_front & wall_right & wall_back)) drive <= chosen;"),), True),
    Edit("a sensor moves along its wall", MAZE, (("{(right, 0.5)}", "{(right, 0.6)}"),)),
    Edit("an actuator moves along its wall", MAZE, (("(bottom, 0.85)", "(bottom, 0.8)"),)),
    Edit("the count is cleared only at rest", TURNSTILE, (("if (clear)", "if (clear & ~arm)"),), True),
    Edit("full at four", TURNSTILE, (("people[2] & people[0];", "people[2];"),), True),
)  # fmt: skip


@dataclass(frozen=True, slots=True)
class Stayed:
    """Masses that did not change themselves, those of them in another slot and elsewhere in mm, masses that changed,
    and the share of the unchanged nets' trunks and rungs that are as they were."""

    unchanged: int
    moved: int
    moved_mm: int
    changed: int
    routed: float


def compare(before: Path, after: Path) -> Stayed:
    """What stayed from one build to the next; masses are known by their names alone."""
    networks = [load(folder, "network.json", Network) for folder in (before, after)]
    whats = [_natures(network) for network in networks]
    same = [name for name, nature in whats[1].items() if whats[0].get(name) == nature]
    places = [{u.mass: u for u in load(folder, "placement.json", Placement).masses} for folder in (before, after)]
    steps = {n: (places[1][n].column - places[0][n].column, places[1][n].row - places[0][n].row) for n in same}
    # on a lattice of another size all may stand some rows further, which moves none against another
    usual = Counter(steps.values()).most_common(1)[0][0] if steps else (0, 0)
    moved = [n for n in same if steps[n] != usual]
    apart, by = _apart([(places[1][n].x - places[0][n].x, places[1][n].y - places[0][n].y) for n in same])
    targets = [_targets(network) for network in networks]
    nets = {name for name in same if targets[0].get(name) == targets[1].get(name)}
    shifts = ((0.0, 0.0), by)
    pieces = [_pieces(load(f, "layout.json", Layout), nets, s) for f, s in zip((before, after), shifts, strict=True)]
    routed = len(pieces[0] & pieces[1]) / len(pieces[1]) if pieces[1] else 1.0
    return Stayed(len(same), len(moved), apart, len(whats[1]) - len(same), routed)


def _apart(steps: list[tuple[float, float]]) -> tuple[int, tuple[float, float]]:
    """How many of ``steps`` (mm) are not the usual one, and that: a device that has grown may stand elsewhere whole."""
    rounded = [(round(x, 2), round(y, 2)) for x, y in steps]
    usual, count = Counter(rounded).most_common(1)[0] if rounded else ((0.0, 0.0), 0)
    return len(rounded) - count, usual


def _natures(network: Network) -> dict[str, object]:
    inputs: dict[str, list[tuple[str, float]]] = {mass.name: [] for mass in network.masses}
    polarity = {mass.name: mass.polarity for mass in network.masses}
    for item in network.couplings:
        sign = polarity[item.source] * polarity[item.target]
        inputs[item.target].append((item.source, item.strength * sign))
    return {m.name: (m.phase, m.kind, m.bias * m.polarity, sorted(inputs[m.name])) for m in network.masses}


def _targets(network: Network) -> dict[str, set[str]]:
    found: dict[str, set[str]] = {mass.name: set() for mass in network.masses}
    for item in network.couplings:
        found[item.source].add(item.target)
    return found


def _pieces(layout: Layout, nets: set[str], by: tuple[float, float]) -> set[tuple[object, ...]]:
    """Trunks and rungs of ``nets``, moved back by ``by`` (mm)."""

    def x(at: float) -> float:
        return round(at - by[0], 1)

    def y(at: float) -> float:
        return round(at - by[1], 1)

    trunks = {(t.net, x(t.x), y(t.y_low), y(t.y_high)) for t in layout.trunks if t.net in nets}
    return trunks | {(r.net, r.plate, y(r.y), x(r.left.x), x(r.right.x)) for r in layout.rungs if r.net in nets}


def made(source: Path, place: Path, like: Path | None, last: str, say: Callable[[str], None]) -> Path:
    """The build of ``source``, made if it is not there yet."""
    if not (place / "report.json").exists():
        request = Request(source, place, None, MappingRequest(), "pom_cut", 0, None, last, 1, like=like)
        _, broken = build(request, say)
        if broken:
            print(f"{place.name}: {'; '.join(broken)}", flush=True)
    return place


def main(folder: Path, wanted: str) -> None:
    """Print the table of the edits whose names hold ``wanted``."""
    print(f"{'edit':<46} {'design':<10} {'':<7} {'changed':>7} {'same':>5} {'moved':>6} {'share':>6} {'in mm':>6} "
          f"{'routes kept':>11}  {'mm a unit':>9}")  # fmt: skip
    for edit in EDITS:
        if wanted not in edit.name:
            continue
        slug = edit.name.replace(" ", "_").replace(":", "").replace("?", "").replace(",", "")
        source = EXAMPLES / f"{edit.design}.mdl"
        changed = folder / slug / f"{edit.design}.mdl"
        changed.parent.mkdir(parents=True, exist_ok=True)
        changed.write_text(edit.apply(source.read_text(encoding="utf-8")), encoding="utf-8")
        first = made(source, folder / f"{edit.design}.first", None, "layout", lambda line: None)
        for label, like in (("like", first), ("without", None)):
            after = made(changed, folder / slug / label, like, "layout", lambda line: None)
            if not (after / "layout.json").exists():
                print(f"{edit.name:<46} {edit.design:<10} {label:<7} not routed", flush=True)
                continue
            stayed = compare(first, after)
            share = stayed.moved / max(1, stayed.unchanged)
            print(f"{edit.name:<46} {edit.design:<10} {label:<7} {stayed.changed:7} {stayed.unchanged:5} "
                  f"{stayed.moved:6} {share:6.0%} {stayed.moved_mm:6} {stayed.routed:11.0%}  "
                  f"{load(after, 'placement.json', Placement).mm_per_grid:9.3f}", flush=True)  # fmt: skip


if __name__ == "__main__":
    chosen = sys.argv[2] if len(sys.argv) > 2 else ""
    if len(sys.argv) > 1:
        main(Path(sys.argv[1]), chosen)
    else:
        with tempfile.TemporaryDirectory() as made_here:
            main(Path(made_here), chosen)
