"""Complementary situational awareness: check a system file, run its simulation, look at what runs as arrays.

saras csa check config/csa/simulated.json
saras csa run config/csa/simulated.json --plot csa.png --npz csa.npz
saras csa shell                                   # needs ROS: a prompt whose arrays follow /csa/...
"""

from __future__ import annotations

import argparse
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from saras import ConfigError, csa
from saras.csa import shell
from saras.csa.simulation import CsaResult, simulate
from saras.csa.system import load

NAMES = {int(state): name for name, state in csa.ContactState.__members__.items()}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds check, run and shell."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    check = actions.add_parser("check", help="read a system file and say what is in it")
    run_ = actions.add_parser("run", help="simulate a teleoperation of a system file: the sweep over the phantom")
    shell.add_arguments(actions.add_parser("shell", help="a Python prompt whose arrays follow the topics (needs ROS)"))
    for action in (check, run_):
        action.add_argument("system", type=Path, help="system file (JSON)")
    run_.add_argument("--teleop", help="name; the first of the file by default")
    run_.add_argument("--duration", type=float, default=12.0, metavar="S", help="simulated seconds, 5 to 600")
    run_.add_argument("--plot", type=Path, metavar="FILE", help="write a figure (needs matplotlib)")
    run_.add_argument("--npz", type=Path, metavar="FILE", help="write all arrays")


def run(arguments: argparse.Namespace) -> int:
    """Exit code; refused input is a saras.Error."""
    if arguments.action == "shell":
        return shell.run(arguments)
    system = load(arguments.system)
    if arguments.action == "check":
        for teleop in system.document["teleops"]:
            print(f"{teleop['name']}: {teleop['master']} -> {teleop['slave']}")
        return 0
    if not 5.0 <= arguments.duration <= 600.0:
        raise ConfigError(f"--duration = {arguments.duration}: must be in [5, 600] s")
    result = simulate(system.experiment(arguments.teleop, arguments.duration))
    print("\n".join(summary(result)))
    if arguments.npz:
        np.savez_compressed(arguments.npz, **asdict(result))
    if arguments.plot:
        draw(result, arguments.plot)
    return 0


def summary(result: CsaResult) -> list[str]:
    """What a reader wants to know first, a line each."""
    changes = np.flatnonzero(np.diff(result.state, prepend=-1))
    lines = ["states: " + ", ".join(f"{result.t[i]:.2f} s {NAMES[int(result.state[i])]}" for i in changes)]
    if result.tracked().any():
        lines.append(f"force in contact: RMS error {result.force_rms_N():.3f} N, palpation included")
    else:
        lines.append("force in contact: none was controlled")
    lines.append(f"largest force on the hand: {np.linalg.norm(result.hand_force_N, axis=1).max():.2f} N")
    if np.isfinite(result.fixture_m).any():
        lines.append(f"region left by at most {1e6 * max(0.0, -float(np.nanmin(result.fixture_m))):.1f} um")
    lines.append(f"joints at most at {100.0 * result.joint_speed_share.max():.0f} % of their speed")
    reasons = {int(reason): name for name, reason in csa.MotionReason.__members__.items()}
    held = [reasons[int(r)] for r in np.unique(result.reason) if csa.is_hold(csa.MotionReason(int(r)))]
    lines.append("holds: " + (", ".join(held) or "none"))
    return lines


def draw(result: CsaResult, path: Path) -> None:
    """Force, sideways motion and states over time."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(3, 1, figsize=(9.0, 7.0), sharex=True, layout="constrained")
    force, side, state = axes
    curves: list[tuple[Any, Any, str]] = [
        (force, result.normal_force_N, "on the tissue"),
        (force, result.desired_force_N, "wanted, with palpation"),
        (force, result.hand_force_N[:, 2], "on the hand"),
        (side, 1e3 * result.proxy[:, 0], "proxy, where the hand is"),
        (side, 1e3 * result.tip[:, 0], "tip, kept in the region"),
    ]
    for axis, values, label in curves:
        axis.plot(result.t, values, "k:" if "wanted" in label else "-", label=label)
    force.set_ylabel("force [N]")
    side.set_ylabel("sideways [mm]")
    force.legend()
    side.legend()
    state.step(result.t, result.state, where="post")
    state.set_yticks(sorted(NAMES), [NAMES[i] for i in sorted(NAMES)])
    state.set_xlabel("time [s]")
    figure.savefig(path, dpi=100)
    plt.close(figure)
