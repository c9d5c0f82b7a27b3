"""Netlist to network: the stage's one entry."""

from __future__ import annotations

from dataclasses import dataclass, replace

from mdlcad.mapping.build import build_network, invert, with_ring
from mdlcad.mapping.candidates import find_candidates
from mdlcad.mapping.cell_library import Library
from mdlcad.mapping.cover import best_cover
from mdlcad.mapping.familiar import strangeness
from mdlcad.mapping.greedy import plain_taste, search
from mdlcad.mapping.mend import Before, mended
from mdlcad.mapping.names import name_masses
from mdlcad.mapping.options import OptionGraph
from mdlcad.mapping.plan import Plan, Role
from mdlcad.mapping.registers import Wanted, exact_choices, structural_choices
from mdlcad.mapping.relieve import relieve
from mdlcad.mapping.restructure import restructure
from mdlcad.mapping.selection import make_plan, selection_cost
from mdlcad.mapping.subject import FALSE, TRUE, Subject
from mdlcad.network.model import Network
from mdlcad.synthesis.netlist import Netlist

_SEED = 1


@dataclass(frozen=True, slots=True)
class Effort:
    """How long to look for a small network; in work done, not in seconds.

    Attributes:
        masses_made: by all passes of the first, annealing search.
        deterministic_time: of CP-SAT in the second, exact search; none if 0.
        options: most ways to make masses for which the exact search is tried; it finds nothing in larger graphs.
    """

    masses_made: int = 150_000
    deterministic_time: float = 1.0
    options: int = 40_000


def map_netlist(netlist: Netlist, library: Library, effort: Effort = Effort(), before: Before | None = None) -> Network:
    """Map ``netlist`` to masses and springs of ``library``: if there is an earlier network, to that with a few masses
    changed, or else preferably to masses that it had.

    The result is a function of the arguments alone.

    Raises:
        UsageError: the device needs a fan-out that the library does not allow.
    """
    subject, nets = _make_subject(netlist)
    if before is not None:
        same = mended(netlist, library, subject, nets, before)
        if same is not None:
            return same
    earlier = None if before is None else before.network
    plan = _make_plan(netlist, library, subject, nets, effort, earlier)
    masses, tick = with_ring(plan)
    masses = relieve(masses, library.gates.load_limit, library.gates.echo_limit)
    names, upside_down = name_masses(replace(plan, masses=masses), subject, netlist, nets)
    carried = frozenset(
        mass.key
        for mass in masses
        if mass.key.role is Role.LOGIC and mass.key.of[0] in upside_down and mass.key not in plan.carriers
    )
    return build_network(netlist, library, plan, invert(masses, carried), names, tick)


def _make_subject(netlist: Netlist) -> tuple[Subject, dict[str, int]]:
    subject = Subject([*netlist.inputs, *(register.bit for register in netlist.registers)])
    nets = {"0": FALSE, "1": TRUE} | {name: subject.input(name) for name in subject.inputs}
    for gate in netlist.gates:
        nets[gate.net] = subject.add_gate(gate, nets)
    return subject, nets


def _make_plan(
    netlist: Netlist,
    library: Library,
    subject: Subject,
    nets: dict[str, int],
    effort: Effort,
    earlier: Network | None,
) -> Plan:
    wanted = []
    for register in netlist.registers:
        output, data = nets[register.bit], nets[register.data]
        enable = None if register.enable is None else nets[register.enable]
        following = data if enable is None else subject.choose(output, data, enable)
        wanted.append(Wanted(register, output, following, data, enable))
    outputs = [nets[output.net] for output in netlist.outputs]
    roots = list(outputs)
    for item in wanted:
        roots += [item.following, item.data]
        if item.enable is not None:
            roots.append(item.enable)
        if subject.exact:
            # what sets the register if it is 0, and what keeps it if it is 1
            node = item.output >> 1
            roots += [subject.cofactor(item.following, node, value) for value in (False, True)]
    restructure(subject, roots)
    limit = library.gates.weight_limit
    candidates = find_candidates(subject, limit)
    choices = [
        exact_choices(subject, candidates, item) if subject.exact else structural_choices(item) for item in wanted
    ]
    graph = OptionGraph(subject, candidates, choices, outputs, library.gates)
    if earlier is not None:
        graph.strange = strangeness(graph, earlier, library)
    start = search(graph, plain_taste(graph, [item.following for item in wanted]), effort.masses_made, _SEED)
    if not effort.deterministic_time or graph.size > effort.options:
        return make_plan(graph, start)
    found = best_cover(graph, start, effort.deterministic_time, _SEED)
    # the exact search knows nothing of twins
    return make_plan(graph, min(found, start, key=lambda selection: selection_cost(graph, selection)))
