"""A browser without a screen and without a network, which shows a page as a person would see it."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

BROWSER = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome") if (found := shutil.which(name))), None
)
"""Its path; None if this machine has none."""


def browse(folder: Path, size: str, *arguments: str) -> str:
    """Open a page; what the browser printed.

    Args:
        folder: where it may keep what it has to keep.
        size: of the window, "WIDTH,HEIGHT" in pixels.
        arguments: what to do, as the browser's own options, and the address.
    """
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader", "--no-first-run"]
    options += ["--hide-scrollbars", "--host-resolver-rules=MAP * ~NOTFOUND", f"--user-data-dir={folder / 'profile'}"]
    options += [f"--window-size={size}", "--virtual-time-budget=6000"]
    command = [str(BROWSER), *options, *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=240, check=True).stdout
