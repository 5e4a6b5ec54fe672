"""A weak hand on stiff tissue over a slow network: with and without energy tanks.

python examples/03_what_tanks_do.py [--duration S] [--round-trip-ms MS] [--plot FILE.png]
"""

import argparse

import numpy as np

from saras import sim

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("--duration", type=float, default=15.0, help="simulated seconds")
parser.add_argument("--round-trip-ms", type=float, default=200.0)
parser.add_argument("--plot", help="write a figure here (needs matplotlib)")
arguments = parser.parse_args()

# Mechanical stops far away, so that the oscillation shows its own size.
hand = sim.OperatorConfig.weak()
hand.workspace_radius_m = 0.3
side = sim.Side(
    operator=hand,
    handle_start_m=(0.0, 0.0, 0.4),
    motion=sim.PressAndHold(reach_m=(0.0, 0.0, -0.06)),
    tissue=sim.TissueConfig(stiffness_N_m=500.0, inclusion_stiffness_N_m=500.0),
)
link = sim.ChannelConfig(delay_s=arguments.round_trip_ms / 2000.0)

results = {}
for name, tanks in (("without tanks", False), ("with tanks", True)):
    experiment = sim.Experiment(sides=(side,), duration_s=arguments.duration, tanks=tanks, up=link, down=link)
    result = results[name] = sim.run(experiment)
    late = result.t > 0.7 * arguments.duration
    print(
        f"{name:14s} the hand swings {0.5e3 * np.ptp(result.hand[late, 0, 2]):6.1f} mm to each side in the last 30 %,"
        f" {result.delivered_hand_J[0]:6.2f} J went into it"
    )

if arguments.plot:
    from saras import plot

    title = f"Weak hand, 500 N/m, {arguments.round_trip_ms:.0f} ms round trip"
    plot.comparison(results, title=title).savefig(arguments.plot, dpi=100)
