"""A canonical form of STEP files, so that the same assembly is the same bytes.

The writer lists styles in the order of addresses in memory. Here entities are named by their content (a hash over the
entity and all it refers to), equal pieces of geometry and style are merged, lists whose order has no meaning are
sorted, and everything is numbered again by a walk from the roots.
"""

from __future__ import annotations

import hashlib
import re
from dataclasses import dataclass

from mdlcad.errors import SignoffError

_REFERENCE = re.compile(r"#(\d+)")
# Stand in for what strings may hold, while statements and references are found by their marks.
_HIDDEN = str.maketrans({"#": "\x01", ";": "\x02"})
_SHOWN = str.maketrans({"\x01": "#", "\x02": ";"})
# Sets whose order the writer takes from memory.
_UNORDERED = "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"
_OCCURRENCE = "NEXT_ASSEMBLY_USAGE_OCCURRENCE"
# Merged when equal: geometry and style carry no identity of their own. Topology (vertices, edges, faces) is left
# alone, since two solids that touch must stay two solids.
_MERGED = frozenset(
    {
        "CARTESIAN_POINT",
        "DIRECTION",
        "VECTOR",
        "LINE",
        "CIRCLE",
        "AXIS2_PLACEMENT_3D",
        "PLANE",
        "CYLINDRICAL_SURFACE",
        "COLOUR_RGB",
        "DRAUGHTING_PRE_DEFINED_COLOUR",
        "DRAUGHTING_PRE_DEFINED_CURVE_FONT",
        "FILL_AREA_STYLE_COLOUR",
        "FILL_AREA_STYLE",
        "SURFACE_STYLE_FILL_AREA",
        "SURFACE_SIDE_STYLE",
        "SURFACE_STYLE_USAGE",
        "CURVE_STYLE",
        "PRESENTATION_STYLE_ASSIGNMENT",
    }
)


@dataclass(slots=True)
class _Entity:
    """One entity: its type, the text between its references, and the references, in order."""

    kind: str
    texts: list[str]
    references: list[int]


def canonical_step(text: str) -> str:
    """``text`` with its entities merged, sorted and numbered canonically.

    Raises:
        SignoffError: the text is not a STEP file of one DATA section.
    """
    head, mark, rest = text.partition("DATA;\n")
    data, end_mark, tail = rest.rpartition("ENDSEC;\nEND-ISO-10303-21;")
    if not mark or not end_mark:
        raise SignoffError("the STEP writer gave a file without a DATA section")
    entities = _entities(data)
    _number_occurrences(entities)
    digests = _digests(entities)
    for entity in entities.values():
        if entity.kind == _UNORDERED:
            _sort_unordered(entity, digests)
    representative = _merge(entities, digests)
    order = _walk(entities, digests, representative)
    own = {old: f"#{new}" for new, old in enumerate(order, start=1)}
    name = {old: own[same] for old, same in representative.items() if same in own}
    lines: list[str] = []
    for old in order:
        entity = entities[old]
        lines += (own[old], "=", entity.texts[0])
        for reference, text in zip(entity.references, entity.texts[1:], strict=True):
            lines += (name[reference], text)
        lines.append(";\n")
    return head + mark + "".join(lines).translate(_SHOWN) + end_mark + tail


def _entities(data: str) -> dict[int, _Entity]:
    found: dict[int, _Entity] = {}
    for statement in _tight(data).split(";"):
        if not statement:
            continue
        label, equals, value = statement.partition("=")
        if not equals or label[0] != "#" or not label[1:].isdigit():
            raise SignoffError(f"not a STEP entity: {statement[:60]}")
        pieces = _REFERENCE.split(value)
        kind = pieces[0].partition("(")[0]
        found[int(label[1:])] = _Entity(kind, pieces[0::2], [int(piece) for piece in pieces[1::2]])
    return found


def _tight(data: str) -> str:
    """Without the white space between tokens; in strings, whose other spaces stay, marks are hidden.

    Between apostrophes there is a string and what is no string by turns, as one within a string is written twice.
    """
    pieces = data.split("'")
    pieces[0::2] = ["".join(piece.split()) for piece in pieces[0::2]]
    pieces[1::2] = [piece.replace("\n", "").translate(_HIDDEN) if piece else piece for piece in pieces[1::2]]
    return "'".join(pieces)


def _number_occurrences(entities: dict[int, _Entity]) -> None:
    """Number the assembly's members from 1: the writer goes on counting from the file it wrote before."""
    members = (entity for entity in entities.values() if entity.kind == _OCCURRENCE)
    for number, entity in enumerate(members, start=1):
        entity.texts[0] = re.sub(r"^(\w+\(')\d+'", rf"\g<1>{number}'", entity.texts[0])


def _digests(entities: dict[int, _Entity]) -> dict[int, bytes]:
    """Content hash of every entity over all it refers to (references have no cycles in STEP geometry)."""
    digests: dict[int, bytes] = {}
    for root in entities:
        stack = [root]
        while stack:
            current = stack[-1]
            if current in digests:
                stack.pop()
                continue
            entity = entities[current]
            hashed = [digests.get(ref, b"") for ref in entity.references]
            if b"" in hashed:
                stack.extend(ref for ref in entity.references if ref not in digests)
                continue
            stack.pop()
            if entity.kind == _UNORDERED:
                hashed.sort()
            content = "#".join(entity.texts).encode() + b"".join(hashed)
            digests[current] = hashlib.blake2b(content, digest_size=16).digest()
    return digests


def _sort_unordered(entity: _Entity, digests: dict[int, bytes]) -> None:
    """Sort the set of items: all references but the last, which is the context."""
    *items, context = entity.references
    entity.references = [*sorted(items, key=lambda ref: digests[ref]), context]


def _merge(entities: dict[int, _Entity], digests: dict[int, bytes]) -> dict[int, int]:
    first: dict[bytes, int] = {}
    return {
        key: first.setdefault(digests[key], key) if entity.kind in _MERGED else key for key, entity in entities.items()
    }


def _walk(entities: dict[int, _Entity], digests: dict[int, bytes], representative: dict[int, int]) -> list[int]:
    """Entities in the order of a depth-first walk from the roots: the product structure as written, then the styles.

    Only what hangs below the style root is written in the order of addresses; it is ordered by content.
    """
    referenced = {ref for entity in entities.values() for ref in entity.references}
    unreferenced = [key for key in entities if key not in referenced]
    styles = [key for key in unreferenced if entities[key].kind == _UNORDERED]
    roots = [key for key in unreferenced if entities[key].kind != _UNORDERED]
    roots += sorted(styles, key=lambda key: digests[key])
    order: list[int] = []
    seen: set[int] = set()
    stack = [representative[root] for root in reversed(roots)]
    while stack:
        current = stack.pop()
        if current in seen:
            continue
        seen.add(current)
        order.append(current)
        stack.extend(
            ref for ref in (representative[ref] for ref in reversed(entities[current].references)) if ref not in seen
        )
    return order
