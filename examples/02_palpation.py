"""Press on soft tissue with a stiff inclusion and feel it through the console, the force estimated by the arm itself.

python examples/02_palpation.py [--duration S] [--plot FILE.png]
"""

import argparse

import numpy as np

from saras import sim

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("--duration", type=float, default=16.0, help="simulated seconds")
parser.add_argument("--plot", help="write a figure here (needs matplotlib)")
arguments = parser.parse_args()

# 300 N/m everywhere, 1500 N/m in the inclusion 20 mm beside the start. Slave metres are half of the hand's.
side = sim.Side(
    operator=sim.OperatorConfig.firm(),
    motion=sim.Palpate(approach_m=(0.0, 0.0, -0.02), press_m=0.014, step_m=(0.02, 0.0, 0.0)),
    tissue=sim.TissueConfig(),
    slave_wrench="observer",
)
result = sim.run(sim.Experiment(sides=(side,), duration_s=arguments.duration))

force = np.linalg.norm(result.tissue_force[:, 0], axis=1)
depth = np.maximum(result.depth[:, 0], 0.0)
for begin in np.arange(1.5, arguments.duration - 2.9, 3.0):
    press = (result.t >= begin) & (result.t < begin + 3.0)
    deepest = int(np.argmax(np.where(press, depth, -1.0)))
    if depth[deepest] > 1e-4:
        x = result.tip[deepest, 0, 0] - result.tip[0, 0, 0]
        stiffness = force[deepest] / depth[deepest]
        felt = np.linalg.norm(result.hand_force[deepest, 0])
        print(
            f"x = {1e3 * x:5.1f} mm: {1e3 * depth[deepest]:4.1f} mm deep, {force[deepest]:4.2f} N on the tissue,"
            f" {stiffness:5.0f} N/m, {felt:4.2f} N on the hand"
        )

if arguments.plot:
    from saras import plot

    plot.session(result).savefig(arguments.plot, dpi=100)
