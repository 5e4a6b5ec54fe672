"""Unequal joint dynamics bend the remote centre of motion; this sweep shows how much.

One joint's natural frequency is lowered; the others stay at 60 rad/s.

python examples/05_remote_centre.py [--duration S] [--plot FILE.png]
"""

import argparse

import numpy as np

from saras import sim
from saras.kinematics import mesa

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("--duration", type=float, default=8.0, help="simulated seconds of each run")
parser.add_argument("--plot", help="write a figure here (needs matplotlib)")
arguments = parser.parse_args()

RATIOS = (1.0, 0.9, 0.8, 0.65, 0.5)
JOINTS = (0, 1, 2, 3, 4)

print("largest deviation of the shaft from the trocar [mm]; row: slower joint, column: its frequency / the others'")
print("            " + "".join(f"{ratio:8.2f}" for ratio in RATIOS))
deviation_mm = np.zeros((len(JOINTS), len(RATIOS)))
for row, joint in enumerate(JOINTS):
    for column, ratio in enumerate(RATIOS):
        frequency = np.full(6, 60.0)
        frequency[joint] *= ratio
        side = sim.Side(arm=sim.ServoArmConfig(natural_frequency_rad_s=frequency))
        result = sim.run(sim.Experiment(sides=(side,), duration_s=arguments.duration))
        deviation_mm[row, column] = 1e3 * result.metrics().rcm_deviation_m
    print(f"{mesa.JOINT_NAMES[joint]:12s}" + "".join(f"{value:8.4f}" for value in deviation_mm[row]))

if arguments.plot:
    import matplotlib.pyplot as plt

    figure, ax = plt.subplots(figsize=(8.0, 4.5), layout="constrained")
    for joint, row in zip(JOINTS, deviation_mm):
        ax.semilogy(RATIOS, row, "o-", label=mesa.JOINT_NAMES[joint])
    ax.axhline(0.1, color="k", ls=":", label="0.1 mm")
    ax.invert_xaxis()
    ax.set_xlabel("natural frequency of one joint / that of the others")
    ax.set_ylabel("largest deviation of the remote centre [mm]")
    ax.grid(alpha=0.3)
    ax.legend()
    figure.savefig(arguments.plot, dpi=100)
