"""Sweep a PSM over a phantom: the system keeps 2 N, palpates, and keeps the tip in a region; the hand feels the model.

python examples/08_situational_awareness.py [--duration S] [--plot FILE.png]
"""

import argparse
from pathlib import Path

from saras.csa.command import draw, summary
from saras.csa.simulation import CsaExperiment, simulate

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("--duration", type=float, default=12.0, help="simulated seconds")
parser.add_argument("--plot", help="write a figure here (needs matplotlib)")
arguments = parser.parse_args()

# 300 N/m, and 1500 N/m in a lump 20 mm beside the start; the model's surface is 1 mm too high.
result = simulate(CsaExperiment(duration_s=arguments.duration, model_error_m=0.001, region_m=0.010))
print("\n".join(summary(result)))
if arguments.plot:
    draw(result, Path(arguments.plot))
