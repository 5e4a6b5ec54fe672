"""Tracking in free space: one hand moves one arm.

python examples/01_free_motion.py [--duration S] [--plot FILE.png]
"""

import argparse

from saras import sim

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("--duration", type=float, default=20.0, help="simulated seconds")
parser.add_argument("--plot", help="write a figure here (needs matplotlib)")
arguments = parser.parse_args()

# An Experiment holds everything; its defaults are those of the platform. Side() is one hand, one handle, one arm.
result = sim.run(sim.Experiment(duration_s=arguments.duration))
m = result.metrics()

print(f"{result.faster_than_real_time:.0f} times real time")
print(f"the tip is {1e3 * m.lag_s:.0f} ms behind the hand; without that lag {1e3 * m.tracking_rms_m:.3f} mm RMS")
print(f"set-point against scale x handle: at most {1e3 * m.set_point_error_m:.3f} mm")
print(f"the shaft stays within {1e6 * m.rcm_deviation_m:.1f} micrometres of the trocar")

if arguments.plot:
    from saras import plot

    plot.tracking(result).savefig(arguments.plot, dpi=100)
