"""What a viewer says of a body: its name and the numbers of the unit, net, coupling or plate that it is part of."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from mdlcad.mechanics.leaves import LeafSize
from mdlcad.mechanics.process import PlateRole
from mdlcad.network.model import Coupling, Mass
from mdlcad.parts.body import Body, BodyKind
from mdlcad.view.built import Built


@dataclass(frozen=True, slots=True)
class Card:
    """A body's name, what it belongs to ("unit NAME", "net NAME", "coupling A->B", "plate NAME"), and its numbers."""

    name: str
    subject: str
    facts: tuple[tuple[str, str], ...]

    def __str__(self) -> str:
        wide = max((len(key) for key, _ in self.facts), default=0)
        return "\n".join([self.name, *(f"{key:<{wide}}  {value}" for key, value in self.facts)])


class Catalogue:
    """Writes the cards of one device."""

    def __init__(self, built: Built) -> None:
        self._built = built
        self._masses = {mass.name: mass for mass in built.network.masses}
        self._couplings = {coupling.name: coupling for coupling in built.network.couplings}
        self._units = {unit.mass: unit for unit in built.sizing.units}
        self._parts = {item.coupling: item for item in built.sizing.couplers}
        self._biases = {item.mass: item for item in built.sizing.biases}
        self._carriers = {item.coupling: item for item in built.carriers}
        self._places = {place.mass: place for place in built.placement.masses}
        process = built.process
        self._unit_limit = process.material(process.plates(PlateRole.UNIT)[0]).strain_limit
        self._leaf_limit = process.material(process.plates(PlateRole.RUNG)[0]).strain_limit
        self._writers: dict[BodyKind, Callable[[Body], Card]] = {
            BodyKind.UNIT: self._unit,
            BodyKind.COUPLER: self._coupling,
            BodyKind.ROCKER: self._coupling,
            BodyKind.BIAS: self._bias,
        }

    def card(self, body: Body) -> Card:
        """The card of a body of the device."""
        writer = self._writers.get(body.kind)
        if writer is not None:
            return writer(body)
        ref = body.moves_with[0]
        if ref.startswith("mass:"):
            return self._net(body)
        if ref.startswith("clock:"):
            return self._clock(body)
        return Card(body.name, f"plate {body.plate}", tuple(self._sheet(body)))

    def margin(self, body: Body) -> float | None:
        """1 - strain / limit of the material, of the body's worst flexure; None if nothing of it is meant to bend."""
        if body.kind is BodyKind.UNIT:
            return 1.0 - self._unit_strain(_mass_of(body)) / self._unit_limit
        leaf = self._leaf(body)
        return None if leaf is None else 1.0 - leaf.strain / self._leaf_limit

    def mass(self, body: Body) -> Mass | None:
        """The mass whose signal a body carries: its own, or that at the source of its coupling; None if none."""
        refs = [ref for ref in body.moves_with if ref.startswith("mass:")]
        return self._masses[refs[0].partition(":")[2]] if refs else None

    def _unit_strain(self, mass: str) -> float:
        return max(self._units[mass].strain, self._built.sizing.series.strain_settled)

    def _leaf(self, body: Body) -> LeafSize | None:
        name = body.name.partition(".")[2]
        if body.kind in (BodyKind.COUPLER, BodyKind.ROCKER) and name in self._parts:
            return self._parts[name].leaf
        if body.kind is BodyKind.BIAS and name in self._biases:
            return self._biases[name].leaf
        return None

    def _unit(self, body: Body) -> Card:
        mass = self._masses[_mass_of(body)]
        unit, place, series = self._units[mass.name], self._places[mass.name], self._built.sizing.series
        facts = [
            *self._mass(mass),
            ("preload", f"{unit.preload:.3f} mm of the clock block, for {unit.compensation:+.3f} of springs"),
            ("throw seen", f"{unit.amplitude:.2f} mm"),
            ("strain", f"beams {_percent(unit.strain)}, series spring {_percent(series.strain_settled)}"),
            self._margin_of(self._unit_strain(mass.name), self._unit_limit),
            ("place", f"column {place.column}, row {place.row}, at ({place.x:.1f}, {place.y:.1f}) mm"),
        ]
        return Card(body.name, f"unit {mass.name}", tuple(facts))

    def _mass(self, mass: Mass) -> Iterator[tuple[str, str]]:
        """The numbers of the network's mass."""
        yield "mass", f"{mass.kind.value}{f', port {mass.port}' if mass.port else ''}"
        yield "phase", str(mass.phase)
        yield "polarity", "+1 (1 is at +y)" if mass.polarity > 0 else "-1 (1 is at -y)"
        yield "k", f"{mass.k0:g} {'-' if mass.k1 < 0 else '+'} {abs(mass.k1):g} p"
        yield "bias q", f"{mass.bias:+g}" if mass.bias else "none"
        for words, own, other in (("from", "target", "source"), ("to", "source", "target")):
            found = [item for item in self._couplings.values() if getattr(item, own) == mass.name]
            nets = [f"{getattr(item, other)} ({item.strength:+g})" for item in found]
            yield words, ", ".join(nets) if nets else "nothing"

    def _coupling(self, body: Body) -> Card:
        name = body.name.partition(".")[2]
        if name not in self._couplings:
            return Card(body.name, f"plate {body.plate}", tuple(self._sheet(body)))
        coupling, part = self._couplings[name], self._parts[name]
        facts = [
            ("coupling", f"{coupling.source} to {coupling.target}"),
            ("sign", "positive (coupler)" if coupling.strength > 0 else "negative (rocker)"),
            ("strength c", f"{part.strength:+.3f} (asked for {coupling.strength:+g})"),
            ("stiffness", f"{part.leaf.coupling:.3f} N/mm between its ends, {part.leaf.own:.3f} N/mm of its own"),
            ("strain", _percent(part.leaf.strain)),
            self._margin_of(part.leaf.strain, self._leaf_limit),
            *self._carrier(coupling),
            ("flexure", f"{part.leaf.shape.legs} legs of {part.leaf.shape.wall:g} mm, {part.leaf.reach:.1f} mm long"),
        ]
        return Card(body.name, f"coupling {name}", tuple(facts))

    def _carrier(self, coupling: Coupling) -> Iterator[tuple[str, str]]:
        if coupling.name in self._carriers:
            found = self._carriers[coupling.name]
            yield "carrier", f"{found.ratio:.1f} times as stiff ({found.stiffness:.2f} N/mm)"
            yield "lean", f"takes {100.0 * found.leaned:.0f} %"

    def _bias(self, body: Body) -> Card:
        name = _mass_of(body)
        if name not in self._biases:
            return Card(body.name, f"plate {body.plate}", tuple(self._sheet(body)))
        bias = self._biases[name]
        facts = (
            ("bias of", name),
            ("bias q", f"{bias.bias:+g}"),
            ("stiffness", f"{bias.leaf.own:.3f} N/mm, post {bias.offset:+.2f} mm off the row"),
            ("strain", _percent(bias.leaf.strain)),
            self._margin_of(bias.leaf.strain, self._leaf_limit),
        )
        return Card(body.name, f"unit {name}", facts)

    def _net(self, body: Body) -> Card:
        """A carrier, or a pin of one."""
        name = _mass_of(body)
        mass = self._masses[name]
        facts = [("net of", name), *self._mass(mass)]
        driven = [item for item in self._couplings.values() if item.source == name and item.name in self._carriers]
        if driven:
            driven.sort(key=lambda item: self._carriers[item.name].ratio)
            ratios = [f"{self._carriers[item.name].ratio:.1f} to {item.target}" for item in driven]
            facts.append(("stiffness", f"{', '.join(ratios)} (times that of its coupler, weakest first)"))
        return Card(body.name, f"net {name}", tuple(facts))

    def _clock(self, body: Body) -> Card:
        phase = int(body.moves_with[0].partition(":")[2])
        units = sum(mass.phase == phase for mass in self._built.network.masses)
        rules, law = self._built.sizing.rules, self._built.sizing.law
        facts = (
            ("clock", f"phase {phase} of {self._built.network.dynamics.phases}, drives {units} units"),
            ("stroke", f"+-{rules.clock_throw:.2f} mm in x, {law.stroke_per_k:.3f} mm per unit of k"),
        )
        return Card(body.name, f"clock {phase}", facts)

    def _sheet(self, body: Body) -> Iterator[tuple[str, str]]:
        yield "kind", body.kind.value
        yield "height", f"z {body.z:g} to {body.z + body.thickness:g} mm"
        for plate in self._built.process.stack.plates:
            if plate.name == body.plate:
                yield "material", f"{plate.material}, {plate.thickness:g} mm"

    @staticmethod
    def _margin_of(strain: float, limit: float) -> tuple[str, str]:
        return "margin", f"{_percent(1.0 - strain / limit)} to the limit of {_percent(limit)}"


def _mass_of(body: Body) -> str:
    return next(ref.partition(":")[2] for ref in body.moves_with if ref.startswith("mass:"))


def _percent(value: float) -> str:
    return f"{100.0 * value:.3g} %"
