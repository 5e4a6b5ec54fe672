"""A host whose clock is wrong, for Python programs: with this directory on PYTHONPATH the time of day is
SARAS_CLOCK_AHEAD_S seconds ahead. Monotonic clocks are untouched, as they are when somebody sets a clock.
"""

import os
import time

_ahead_ns = round(1e9 * float(os.environ.get("SARAS_CLOCK_AHEAD_S", "0")))
_time_ns = time.time_ns
time.time_ns = lambda: _time_ns() + _ahead_ns
time.time = lambda: 1e-9 * time.time_ns()
