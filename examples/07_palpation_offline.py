"""A recorded palpation, learned offline: stiffness and surface with their deviations, beside the phantom's truth.

python examples/07_palpation_offline.py [RECORDING.npz] [--save RECORDING.npz] [--plot FILE.png]

A recording is an npz file of t (n,) [s], positions (n, 3) [m], forces (n, 3) [N] that the tool exerts on the tissue,
and velocities (n, 3) [m/s]. Without one, a minute on the simulated phantom is recorded first.
"""

import argparse

import numpy as np

from saras.model import StiffnessMap
from saras.sim import TissueConfig
from saras.sim.palpation import Phantom, palpate, raster_path

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("recording", nargs="?", help="npz file; default: record the simulated phantom")
parser.add_argument("--save", help="write the simulated recording here")
parser.add_argument("--plot", help="write a figure here (needs matplotlib)")
arguments = parser.parse_args()

# %% The recording: the slave slides over the phantom at 10 mm/s while its force goes up and down once a second.
phantom = Phantom(TissueConfig(curvature_1_m=6.0, inclusion_x_m=0.006, inclusion_y_m=-0.004))
if arguments.recording:
    with np.load(arguments.recording) as file:
        positions, forces, velocities = (file[name] for name in ("positions", "forces", "velocities"))
else:
    dt = 1e-3
    recorded = palpate(phantom, raster_path(0.04, 3e-3, 0.01, dt), dt, position_noise_m=2e-5)
    positions, forces, velocities = recorded.positions, recorded.forces, recorded.velocities
    if arguments.save:
        np.savez_compressed(arguments.save, t=recorded.t, positions=positions, forces=forces, velocities=velocities)

# %% Learn it.
model = StiffnessMap().fit(positions, forces, velocities)
learned = model.hyperparameters
print(f"{len(positions)} samples are {len(model.grid)} places; refused: {model.refused}")
print(
    f"damping {learned.damping_s_m:.1f} +- {learned.damping_scale_s_m:.1f} s/m, noise {1e3 * learned.noise_N:.0f} mN, "
    f"changes over {1e3 * learned.tangential_length_m:.0f} mm"
)

# %% Ask it, where the prior model has vertices.
side = np.linspace(-0.02, 0.02, 41)
across = np.array([(x, y) for y in side for x in side])
vertices = phantom.surface(across)
found = model.estimate(vertices)
stiffest = int(np.nanargmax(found.stiffness_N_m))
print(f"known at {found.known.mean():.0%} of {len(vertices)} vertices")
print(
    f"stiffest: {found.stiffness_N_m[stiffest]:.0f} +- {found.stiffness_std_N_m[stiffest]:.0f} N/m "
    f"at x = {1e3 * across[stiffest, 0]:.0f} mm, y = {1e3 * across[stiffest, 1]:.0f} mm"
)

# %% Beside the truth, which only a simulation has.
if not arguments.recording:
    known, off = found.known, np.linalg.norm(vertices[stiffest] - phantom.inclusion)
    print(f"the inclusion is found {1e3 * off:.1f} mm off; errors, and how many are within 1 and 2 sigma:")
    for name, error, std, unit in (
        ("stiffness", found.stiffness_N_m - phantom.stiffness(vertices), found.stiffness_std_N_m, "N/m"),
        ("surface", 1e3 * phantom.depth(found.surface_point), 1e3 * found.surface_std_m, "mm"),
    ):
        within = [np.mean(np.abs(error[known]) < sigma * std[known]) for sigma in (1, 2)]
        print(f"  {name}: RMS error {np.sqrt(np.mean(error[known] ** 2)):.3g} {unit}, {within[0]:.0%}, {within[1]:.0%}")

if arguments.plot:
    import matplotlib.pyplot as plt

    shown = {"learned": found.stiffness_N_m, "standard deviation": found.stiffness_std_N_m}
    if not arguments.recording:
        shown = {"truth": phantom.stiffness(vertices), **shown}
    figure, axes = plt.subplots(1, len(shown), figsize=(4.2 * len(shown), 3.6), layout="constrained")
    for axis, (title, values) in zip(axes, shown.items()):
        top = 1600 if title != "standard deviation" else np.nanmax(np.where(np.isfinite(values), values, np.nan))
        image = axis.pcolormesh(1e3 * side, 1e3 * side, values.reshape(len(side), -1), vmin=0, vmax=top, cmap="viridis")
        figure.colorbar(image, ax=axis, label="N/m")
        axis.set(title=title, xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
        axis.plot(*1e3 * across[stiffest], "rx")
    figure.savefig(arguments.plot, dpi=100)
