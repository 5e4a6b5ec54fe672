"""``python -m saras`` is the command ``saras``."""

import sys

from saras.cli import main

sys.exit(main())
