"""The pipeline as one flat list: every producer is followed by its checker.

A step takes the state so far and returns a new one. It declares the artefacts it needs and the ones it makes; a test
holds the list to that.
"""

from __future__ import annotations

from dataclasses import replace

from mdlcad.artefact import load, to_json
from mdlcad.flow.design import behaviour_words, gates, masses, proved, read, refuted, sized, with_device
from mdlcad.flow.device import (
    built_parts,
    compensated_units,
    compensation_words,
    draw_placed,
    driven,
    how_placed,
    placed,
    restore_compensation,
    restore_parts,
    restore_placed,
    write_layout,
)
from mdlcad.flow.outcome import (
    checked,
    export,
    extract,
    find_the_margins,
    find_the_mixtures,
    restore_extraction,
    write_built,
    write_guide,
    write_pictures,
)
from mdlcad.flow.state import need
from mdlcad.flow.step import Step, from_artefact
from mdlcad.language import Device
from mdlcad.mechanics import Sizing
from mdlcad.mechanics.drive import DriveLoads
from mdlcad.network.model import Network
from mdlcad.parts.store import Parts, records_of
from mdlcad.proof.outcome import Proof
from mdlcad.signoff.margins import Margins
from mdlcad.signoff.mixtures import Mixtures
from mdlcad.signoff.summary import DesignRules
from mdlcad.synthesis.netlist import Netlist

STEPS: tuple[Step, ...] = (
    Step(
        "device",
        (),
        ("device", "outline"),
        read,
        lambda s: f"{len(need(s.device).sensors)} sensors, {len(need(s.device).actuators)} actuators",
        lambda s: to_json(s.device),
        lambda job, state, files: with_device(state, load(job.folder, "device.json", Device)),
        ("source",),
    ),
    Step(
        "netlist",
        ("device",),
        ("netlist",),
        gates,
        lambda s: f"{len(need(s.netlist).gates)} gates, {len(need(s.netlist).registers)} registers",
        lambda s: to_json(s.netlist),
        from_artefact("netlist", Netlist),
    ),
    Step(
        "network",
        ("netlist",),
        ("network",),
        masses,
        lambda s: (
            f"{len(need(s.network).masses)} masses, {len(need(s.network).couplings)} couplings, "
            f"{need(s.network).cycles_per_tick} cycles a tick"
        ),
        lambda s: to_json(s.network),
        from_artefact("network", Network),
        ("cells", "like"),
    ),
    Step(
        "proof",
        ("device", "network"),
        ("proof",),
        proved,
        behaviour_words,
        lambda s: to_json(s.proof),
        from_artefact("proof", Proof),
        ("seed",),
        objection=refuted,
    ),
    Step(
        "sizing",
        ("network", "proof"),
        ("sizing",),
        sized,
        lambda s: f"throw {need(s.sizing).rules.throw:.2f} mm, row pitch {need(s.sizing).rules.row_pitch:.2f} mm",
        lambda s: to_json(s.sizing),
        from_artefact("sizing", Sizing),
        ("process",),
    ),
    Step(
        "placement",
        ("outline", "network", "sizing"),
        ("placement", "layout", "search"),
        placed,
        lambda s: f"{len(need(s.placement).column_x)} columns x {len(need(s.placement).row_y)} rows{how_placed(s)}",
        lambda s: to_json(s.placement),
        restore_placed,
        ("process", "seed", "size", "placer", "seeds", "like"),
        ("device",),
        draw_placed,
    ),
    Step(
        "layout",
        ("network", "placement", "layout", "sizing"),
        (),
        lambda job, state, progress: state,
        lambda s: (
            f"{len(need(s.layout).rungs)} rungs, {len(need(s.layout).trunks)} trunks, "
            f"{len(need(s.layout).couplers)} couplers"
        ),
        lambda s: to_json(s.layout),
        lambda job, state, files: state,
        draw=write_layout,
    ),
    Step(
        "compensation",
        ("network", "placement", "layout", "sizing"),
        ("compensation", "sizing", "carriers"),
        compensated_units,
        compensation_words,
        lambda s: to_json(s.compensation),
        restore_compensation,
        ("process",),
    ),
    Step(
        "drive",
        ("network", "proof", "sizing", "placement"),
        ("drive",),
        driven,
        lambda s: (
            f"clock plates up to {max(p.force_most_n for p in need(s.drive).plates):.0f} N, shaft up to "
            f"{need(s.drive).torque_most_nmm:.0f} N mm"
        ),
        lambda s: to_json(s.drive),
        from_artefact("drive", DriveLoads),
        ("process", "seed"),
    ),
    Step(
        "parts",
        ("network", "placement", "layout", "sizing", "carriers", "drive"),
        ("bodies",),
        built_parts,
        lambda s: f"{len(need(s.bodies))} bodies",
        lambda s: to_json(Parts(records_of(need(s.bodies)), s.carriers)),
        restore_parts,
        ("process",),
    ),
    Step(
        "drc",
        ("network", "placement", "layout", "sizing", "bodies", "carriers", "drive"),
        ("rules",),
        checked,
        lambda s: f"{len(need(s.rules).errors)} errors, {len(need(s.rules).findings)} findings",
        lambda s: to_json(s.rules),
        from_artefact("rules", DesignRules, "drc"),
        ("process",),
    ),
    Step(
        "guide",
        ("network", "sizing", "placement", "bodies", "drive"),
        ("guide",),
        write_guide,
        lambda s: "how to make it, put it together and start it",
        None,
        lambda job, state, files: replace(state, guide=files),
        ("process",),
    ),
    Step(
        "files",
        ("network", "placement", "bodies"),
        ("files",),
        export,
        lambda s: f"{len(s.files)} files",
        None,
        lambda job, state, files: replace(state, files=files),
        ("process", "kerf_mm"),
    ),
    Step(
        "extraction",
        ("device", "network", "sizing", "placement", "carriers", "files"),
        ("lvs", "extracted", "tilting", "built"),
        extract,
        lambda s: (
            f"layout {'matches' if need(s.lvs).matched else 'DIFFERS FROM'} the network; as built "
            f"{need(s.extracted).transitions_checked} transitions, {need(s.extracted).mismatches} mismatches; "
            f"shuttles tilting {need(s.tilting).proof.mismatches}"
        ),
        lambda s: to_json([s.lvs, s.extracted]),
        restore_extraction,
        ("process", "seed"),
        draw=write_built,
    ),
    Step(
        "mixtures",
        ("device", "network", "sizing", "placement", "carriers", "tilting", "built"),
        ("mixtures",),
        find_the_mixtures,
        lambda s: need(s.mixtures).words(),
        lambda s: to_json(s.mixtures),
        from_artefact("mixtures", Mixtures),
        ("process", "seed"),
    ),
    Step(
        "margins",
        ("device", "network", "sizing", "carriers", "built"),
        ("margins",),
        find_the_margins,
        lambda s: (
            f"walls +{need(s.margins).thicker_um:.0f} -{need(s.margins).thinner_um:.0f} um, at random "
            f"{need(s.margins).random_um:.0f} um; the machine repeats to {need(s.margins).repeatability_um:.0f} um"
        ),
        lambda s: to_json(s.margins),
        from_artefact("margins", Margins),
        ("process", "seed"),
    ),
    Step(
        "views",
        ("bodies",),
        ("pictures",),
        write_pictures,
        lambda s: "pictures",
        None,
        lambda job, state, files: replace(state, pictures=files),
        beside="extraction",
    ),
)
