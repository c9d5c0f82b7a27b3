"""The viewer as one self-contained page: geometry, cards and a simulation packed into it, drawn by WebGL 2.

Beside this file are the page's own scripts (``*.js``), its style and its frame (``page.html``); nothing is fetched.
"""

from mdlcad.view.page.write import page

__all__ = ["page"]
