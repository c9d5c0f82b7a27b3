"""Where the cell libraries (``cells/``) and processes (``geometry/``) are, in a checkout and in an installed wheel."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from mdlcad.errors import UsageError

_PACKAGE = Path(__file__).resolve().parent


def data_folder(kind: str) -> Path:
    """The folder of ``kind`` ("cells" or "geometry").

    A checkout (and an editable install) has it beside the package; a wheel carries a copy inside it.

    Raises:
        UsageError: the installation is broken and neither is there.
    """
    for folder in (_PACKAGE.parent / kind, _PACKAGE / "data" / kind):
        if folder.is_dir():
            return folder
    raise UsageError(f"the folder {kind}/ is missing from this installation of mdlcad; install it again")


def find_data(kind: str, name_or_path: str, suffix: str) -> Path:
    """The file or folder called ``name_or_path``: a path if it looks like one, else a name known in ``kind``.

    Args:
        suffix: what a name lacks to be an entry of the folder (".toml" for files, "" for folders).

    Raises:
        UsageError: nothing of that name; the message lists what there is.
    """
    given = Path(name_or_path)
    if given.suffix or "/" in name_or_path:  # of "./name", a Path keeps the name alone
        if given.exists():
            return given
        raise UsageError(f"{name_or_path}: no such file or folder")
    folder = data_folder(kind)
    found = folder / (name_or_path + suffix)
    if found.exists():
        return found
    known = ", ".join(list_data(kind, suffix))
    raise UsageError(f"no entry '{name_or_path}' in {kind}/; known: {known}; or give a path")


def list_data(kind: str, suffix: str) -> list[str]:
    """Names of all entries of ``kind``, sorted."""
    return sorted(
        item.name.removesuffix(suffix)
        for item in data_folder(kind).iterdir()
        if (item.suffix == suffix if suffix else item.is_dir()) and not item.name.startswith((".", "_"))
    )


def refuse_non_numbers(where: str, table: Any, key: str = "") -> None:
    """Refuse nan and inf, which TOML knows as numbers and nothing here can have.

    Args:
        where: what to call the file; table: what was read of it; key: where in it, dotted.

    Raises:
        UsageError: there is one; names the file and the key.
    """
    if isinstance(table, dict | list):
        for inner, value in table.items() if isinstance(table, dict) else enumerate(table):
            refuse_non_numbers(where, value, f"{key}.{inner}" if key else str(inner))
    elif isinstance(table, float) and not math.isfinite(table):
        raise UsageError(f"{where}: {key}: must be a number, not {table}")
