"""Asks ABC for other ways to build the same functions, so that the cover can choose among them."""

from __future__ import annotations

import subprocess
import tempfile
from importlib.util import find_spec
from pathlib import Path

from mdlcad.mapping.subject import FALSE, TRUE, Subject

TIMEOUT_SECONDS = 60

# Each is one more structure of the same functions. The first is kept alone when the graph is not exact.
_SCRIPTS = (
    "strash; balance; rewrite; refactor; balance; rewrite; rewrite -z; balance; refactor -z; rewrite -z; balance; dc2",
    "strash; dc2; dc2; dc2",
    "strash; balance; resub -K 6; rewrite; resub -K 6 -N 2; refactor; resub -K 8; balance; resub -K 8 -N 2; rewrite;"
    " resub -K 10; rewrite -z; resub -K 10 -N 2; balance; resub -K 12; refactor -z; resub -K 12 -N 2; rewrite -z",
    "strash; ifraig; collapse; strash; dc2; rewrite -z; dc2",
    "strash; collapse; sop; fx; strash; dc2; dc2",
    "strash; collapse; bdd; muxes; strash; dc2; resub -K 8; dc2",
    "strash; &get -n; &dc2; &dch -f; &put; rewrite; dc2",
    "strash; if -K 4 -a; strash; mfs2 -a; strash; dc2",
    "strash; if -K 6 -a; mfs2 -a -e; strash; resub -K 10; dc2",
)


def restructure(subject: Subject, roots: list[int]) -> list[list[int]]:
    """Add ABC's structures of ``roots`` (literals) to ``subject``.

    Returns:
        The roots' literals in every structure; the same ones in an exact graph, as equal functions are one node.

    Raises:
        RuntimeError: ABC is missing from the installation of pyosys.
    """
    wanted = sorted({root & ~1 for root in roots if root > TRUE and not subject.is_input(root >> 1)})
    if not wanted:
        return []
    blif = _to_blif(subject, wanted)
    found = []
    for script in _SCRIPTS if subject.exact else _SCRIPTS[:1]:
        text = _run_abc(blif, script)
        if text is None:
            continue
        made = _add_blif(subject, text)
        known = dict(zip(wanted, made, strict=True))
        found.append([known[root & ~1] ^ (root & 1) if root & ~1 in known else root for root in roots])
    return found


def _to_blif(subject: Subject, roots: list[int]) -> str:
    lines = [".model m", ".inputs " + " ".join(f"i{k}" for k in range(len(subject.inputs)))]
    lines.append(".outputs " + " ".join(f"o{k}" for k in range(len(roots))))

    def net(node: int) -> str:
        return f"i{node - 1}" if subject.is_input(node) else f"n{node}"

    stack = [root >> 1 for root in reversed(roots)]
    done: set[int] = set()
    while stack:
        node = stack.pop()
        if node in done or subject.is_input(node):
            continue
        done.add(node)
        a, b, _ = subject.ways[node][0]
        lines += [f".names {net(a >> 1)} {net(b >> 1)} n{node}", f"{1 - (a & 1)}{1 - (b & 1)} 1"]
        stack += [b >> 1, a >> 1]
    for k, root in enumerate(roots):
        lines += [f".names {net(root >> 1)} o{k}", "1 1"]
    return "\n".join([*lines, ".end", ""])


def _run_abc(blif: str, script: str) -> str | None:
    spec = find_spec("pyosys")
    if spec is None or not spec.submodule_search_locations:
        raise RuntimeError("pyosys is not installed")
    binary = Path(next(iter(spec.submodule_search_locations))) / "yosys-abc"
    with tempfile.TemporaryDirectory(prefix="mdlcad-") as folder:
        Path(folder, "in.blif").write_text(blif, encoding="ascii")
        commands = f"read_blif in.blif; {script}; strash; write_blif out.blif"
        try:
            subprocess.run(
                [str(binary), "-q", commands],
                cwd=folder,
                capture_output=True,
                timeout=TIMEOUT_SECONDS,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return None
        out = Path(folder, "out.blif")
        return out.read_text(encoding="ascii") if out.exists() else None


def _add_blif(subject: Subject, text: str) -> list[int]:
    """Literals of the outputs, in order. ABC writes ANDs of two literals, and buffers and inverters at the outputs."""
    nets = {f"i{k}": 2 * (k + 1) for k in range(len(subject.inputs))}
    outputs: list[str] = []
    pins: list[str] | None = None
    for line in text.replace("\\\n", " ").splitlines():
        words = line.split()
        if not words or words[0].startswith("#"):
            continue
        if pins is not None and words[0][0] in "01-":
            nets[pins[-1]] = _cube(subject, [nets[p] for p in pins[:-1]], words)
            pins = None
            continue
        if words[0] == ".outputs":
            outputs += words[1:]
        elif words[0] == ".names":
            pins = words[1:]
            nets[pins[-1]] = FALSE
    return [nets[f"o{k}"] for k in range(len(outputs))]


def _cube(subject: Subject, literals: list[int], words: list[str]) -> int:
    result = TRUE
    for literal, char in zip(literals, words[0] if literals else "", strict=True):
        if char != "-":
            result = subject.conjunction(result, literal ^ (char == "0"))
    return result if words[-1] == "1" else result ^ 1
