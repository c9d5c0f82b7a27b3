"""An artefact as lines, one a record, for git to compare: ``python -m mdlcad.compare.lines FILE``.

Records are named where they have a name and sorted by it, so that a mass that came or went is one line, wherever the
file keeps it. See ``docs/compare.md`` for how to tell git.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec

from mdlcad.compare.fields import flat

# what the records of artefacts are known by, the first that a record has
_NAMES = ("name", "mass", "coupling", "bit", "net", "rule")
_JOINED = ("source", "target")


def lines(value: Any) -> Iterator[str]:
    """The lines of a decoded artefact."""
    if not isinstance(value, dict):
        value = {"": value}
    for key, part in value.items():
        if isinstance(part, list) and part and all(isinstance(item, dict) for item in part):
            yield from sorted(f"{key} {_name(item)}: {_fields(item)}" for item in part)
        else:
            for name, plain in flat({key: part}).items():
                yield f"{name} = {plain}"


def _name(record: dict[str, Any]) -> str:
    if all(name in record for name in _JOINED):
        return "->".join(str(record[name]) for name in _JOINED)
    return next((str(record[name]) for name in _NAMES if name in record), "")


def _fields(record: dict[str, Any]) -> str:
    return " ".join(f"{name}={plain}" for name, plain in flat(record).items())


def main(path: Path) -> int:
    """Print the lines of a file; a file that is no JSON as it is."""
    data = path.read_bytes()
    try:
        text = "".join(f"{line}\n" for line in lines(msgspec.json.decode(data)))
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError):
        text = data.decode(errors="replace")
    sys.stdout.write(text)
    return 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
