"""Where force control begins to swing: K_g k T swept across the bound 0.5 that a system file is held to.

T is the controller's period plus the lags of arm and sensor. A PSM presses on a spring of 1000 N/m with 2 N.

python examples/09_force_stability.py [--plot FILE.png]
"""

import argparse

import numpy as np

from saras import csa
from saras.csa.simulation import HOME, SimulatedJoints
from saras.kinematics import dvrk

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("--plot", help="write a figure here (needs matplotlib)")
arguments = parser.parse_args()

PERIOD_S, OMEGA, SENSOR_LAG_S, STIFFNESS_N_M, SECONDS = 0.001, 150.0, 0.002, 1000.0, 3.0
LAG_S = PERIOD_S + 2.0 / OMEGA + SENSOR_LAG_S
FACTORS = (0.1, 0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 6.0)
psm = dvrk.psm()
limits = np.asarray(psm.limits)


def press(factor: float) -> np.ndarray:
    """Force [N] over time. The gain is set by an estimate of the stiffness that is too low by 0.5 / factor."""
    motion = csa.ConstrainedMotionConfig(
        lower=limits[:, 0], upper=limits[:, 1], speed=[1, 1, 0.2, 3, 3, 3], lead=[0.1, 0.1, 0.02, 0.5, 0.5, 0.5]
    )
    config = csa.SlaveMlcConfig(
        motion=motion,
        period_s=PERIOD_S,
        arm_lag_s=2.0 / OMEGA,
        sensor_lag_s=SENSOR_LAG_S,
        admittance_m_Ns=1.0,
        stiffness_min_N_m=1.0,
        approach_speed_m_s=0.05,
    )
    law = csa.SlaveMlc(config)
    q, arm = np.array(HOME), SimulatedJoints(HOME, OMEGA)
    desired, forces = psm.forward(q), []
    for _ in range(int(SECONDS / PERIOD_S)):
        force = STIFFNESS_N_M * max(0.0, desired[2, 3] - psm.forward(arm.measured)[2, 3])
        output = law.step(
            q, psm.jacobian(q), psm.forward(q), desired, PERIOD_S, tissue_wrench=[0, 0, -force, 0, 0, 0],
            mode=csa.SlaveMode.HYBRID, desired_force_N=2.0, normal=[0.0, 0.0, 1.0],
            stiffness_N_m=STIFFNESS_N_M * 0.5 / factor,
        )  # fmt: skip
        q = np.array(output.motion.q)
        arm.advance(q, PERIOD_S)
        forces.append(force)
    return np.array(forces)


runs = {factor: press(factor) for factor in FACTORS}
print(" K_g k T   overshoot [N]   swing at the end, peak to peak [N]")
for factor, forces in runs.items():
    print(f"{factor:8.2f}   {forces.max() - 2.0:13.3f}   {np.ptp(forces[-500:]):13.4f}")

if arguments.plot:
    import matplotlib.pyplot as plt

    figure, (left, right) = plt.subplots(1, 2, figsize=(10.0, 4.0), layout="constrained")
    for factor in (0.25, 0.5, 2.0, 4.0, 6.0):
        left.plot(np.arange(len(runs[factor])) * PERIOD_S, runs[factor], label=f"{factor:g}")
    left.set_xlabel("time [s]")
    left.set_ylabel("force on a spring of 1000 N/m [N]")
    left.legend(title="K_g k T")
    right.semilogy(
        FACTORS, [max(1e-6, np.ptp(forces[-500:])) for forces in runs.values()], "o-", label="swing at the end"
    )
    right.semilogy(FACTORS, [max(1e-6, forces.max() - 2.0) for forces in runs.values()], "s-", label="overshoot")
    right.axvline(0.5, color="k", ls=":", label="bound at load")
    right.set_xlabel("K_g k (period + arm + sensor)")
    right.set_ylabel("[N]")
    right.legend()
    figure.savefig(arguments.plot, dpi=100)
