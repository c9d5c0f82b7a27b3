"""mdlcad: from a mechanical description language to devices that can be made and are proved to compute."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mdlcad.view.notebook import Build

__version__ = "0.1.0"


def open_build(folder: str | os.PathLike[str]) -> Build:
    """Open a finished build, to be looked at in a notebook: ``open_build("exports/mazerobot")`` shows itself.

    Raises:
        mdlcad.errors.UsageError: it is not a whole build; the message names the file.
    """
    from mdlcad.view.notebook import Build  # VTK takes seconds to load, and few who import mdlcad look at anything

    return Build(Path(folder))
