"""``python -m mdlcad.cli``."""

import sys

from mdlcad.cli.main import main

sys.exit(main())
