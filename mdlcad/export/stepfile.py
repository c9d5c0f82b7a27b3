"""A canonical form of STEP files, so that the same assembly is the same bytes.

The writer lists styles in the order of addresses in memory. Here entities are named by their content (a hash over the
entity and all it refers to), equal pieces of geometry and style are merged, lists whose order has no meaning are
sorted, and everything is numbered again by a walk from the roots.
"""

from __future__ import annotations

import hashlib
import re

from mdlcad.errors import SignoffError

_ENTITY = re.compile(r"#(\d+)\s*=\s*(.*)", re.DOTALL)
_REFERENCE = re.compile(r"#(\d+)")
_STRING = re.compile(r"('(?:[^']|'')*')")
# Sets whose order the writer takes from memory.
_UNORDERED = "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION"
# Merged when equal: geometry and style carry no identity of their own. Topology (vertices, edges, faces) is left
# alone, since two solids that touch must stay two solids.
_MERGED = (
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
)


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
    digests = _digests(entities)
    _sort_unordered(entities, digests)
    representative = _merge(entities, digests)
    order = _walk(entities, digests, representative)
    number = {old: new for new, old in enumerate(order, start=1)}
    lines = []
    for old in order:
        parts = _STRING.split(entities[old])
        parts[::2] = [
            _REFERENCE.sub(lambda match: f"#{number[representative[int(match[1])]]}", part) for part in parts[::2]
        ]
        lines.append(f"#{number[old]}={''.join(parts)};\n")
    return head + mark + "".join(lines) + end_mark + tail


def _entities(data: str) -> dict[int, str]:
    found: dict[int, str] = {}
    for statement in _statements(data):
        match = _ENTITY.fullmatch(statement.strip())
        if match is None:
            raise SignoffError(f"not a STEP entity: {statement.strip()[:60]}")
        parts = _STRING.split(match[2])
        parts[::2] = [re.sub(r"\s+", "", part) for part in parts[::2]]
        parts[1::2] = [part.replace("\n", "") for part in parts[1::2]]
        found[int(match[1])] = "".join(parts)
    return found


def _references(body: str) -> list[int]:
    """Entities that ``body`` refers to, in order; a "#1" inside a string is text."""
    return [int(ref) for part in _STRING.split(body)[::2] for ref in _REFERENCE.findall(part)]


def _statements(data: str) -> list[str]:
    if "'" not in data:
        return [part for part in data.split(";") if part.strip()]
    pieces: list[str] = []
    current: list[str] = []
    for index, part in enumerate(_STRING.split(data)):
        if index % 2:
            current.append(part)
            continue
        first, *others = part.split(";")
        current.append(first)
        for other in others:
            pieces.append("".join(current))
            current = [other]
    pieces.append("".join(current))
    return [piece for piece in pieces if piece.strip()]


def _digests(entities: dict[int, str]) -> dict[int, bytes]:
    """Content hash of every entity over all it refers to (references have no cycles in STEP geometry)."""
    digests: dict[int, bytes] = {}
    for root in entities:
        stack = [root]
        while stack:
            current = stack[-1]
            if current in digests:
                stack.pop()
                continue
            references = _references(entities[current])
            missing = [ref for ref in references if ref not in digests]
            if missing:
                stack.extend(missing)
                continue
            stack.pop()
            body = entities[current]
            hashed = [digests[ref] for ref in references]
            if body.startswith(_UNORDERED):
                hashed.sort()
            parts = _STRING.split(body)
            parts[::2] = [_REFERENCE.sub("#", part) for part in parts[::2]]
            shape = "".join(parts).encode()
            digests[current] = hashlib.blake2b(shape + b"".join(hashed), digest_size=16).digest()
    return digests


def _sort_unordered(entities: dict[int, str], digests: dict[int, bytes]) -> None:
    for key, body in entities.items():
        if body.startswith(_UNORDERED):
            before, _, rest = body.partition("(#")
            items, _, after = rest.partition(")")
            references = sorted((int(ref) for ref in _REFERENCE.findall("#" + items)), key=lambda ref: digests[ref])
            entities[key] = f"{before}({','.join(f'#{ref}' for ref in references)}){after}"


def _merge(entities: dict[int, str], digests: dict[int, bytes]) -> dict[int, int]:
    first: dict[bytes, int] = {}
    representative: dict[int, int] = {}
    for key, body in entities.items():
        if body.partition("(")[0] in _MERGED:
            representative[key] = first.setdefault(digests[key], key)
        else:
            representative[key] = key
    return representative


def _walk(entities: dict[int, str], digests: dict[int, bytes], representative: dict[int, int]) -> list[int]:
    """Entities in the order of a depth-first walk from the roots: the product structure as written, then the styles.

    Only what hangs below the style root is written in the order of addresses; it is ordered by content.
    """
    referenced = {ref for body in entities.values() for ref in _references(body)}
    unreferenced = [key for key in entities if key not in referenced]
    styles = [key for key in unreferenced if entities[key].startswith(_UNORDERED)]
    roots = [key for key in unreferenced if key not in styles] + sorted(styles, key=lambda key: digests[key])
    order: list[int] = []
    seen: set[int] = set()
    stack = [representative[root] for root in reversed(roots)]
    while stack:
        current = stack.pop()
        if current in seen:
            continue
        seen.add(current)
        order.append(current)
        references = [representative[ref] for ref in _references(entities[current])]
        stack.extend(ref for ref in reversed(references) if ref not in seen)
    return order
