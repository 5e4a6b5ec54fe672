"""Calibrate, step by step in the terminal.

saras calibrate simulation --scene config/scene.yaml           practise in the simulated room, with prompts
saras calibrate simulation --scene config/scene.yaml --yes     the same without prompts
saras calibrate hand-eye gripper.csv target.csv                from two recorded streams (t, x, y, z, qx, qy, qz, qw)
saras calibrate camera left/ right/ --pattern checkerboard --columns 9 --rows 6 --square-m 0.007 --out camera/
saras calibrate camera --bag views.bag --columns 9 --rows 6 --square-m 0.007      the same from recorded images
saras calibrate check calibration.yaml                         read a file as the platform does, and show it

With real arms: roslaunch saras_ros1 calibration.launch, and its services (docs/calibration.md).
"""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import numpy as np

from saras import ConfigError
from saras.calibration.board import Board
from saras.calibration.calibration_file import Calibration

#: Issue: all frames this near to the truth with realistic noise.
BOUND_M, BOUND_DEG = 1e-3, 0.5


def add_guide_arguments(parser: argparse.ArgumentParser) -> None:
    """Of the guided procedure, in simulation and with real arms: --rounds, --known-to-mm, --out, --force."""
    parser.add_argument("--rounds", type=int, default=4, help="least touches of each dot (default %(default)s)")
    parser.add_argument(
        "--known-to-mm",
        type=float,
        default=0.3,
        help="more touches until the base is known to it (default %(default)s)",
    )
    parser.add_argument("--out", type=Path, default=Path("calibration.yaml"), help="default %(default)s")
    parser.add_argument("--force", action="store_true", help="write over an existing file")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds simulation, hand-eye and check."""
    actions = parser.add_subparsers(dest="action", required=True, metavar="ACTION")
    simulated = actions.add_parser(
        "simulation", help="the whole procedure in the simulated room, compared with its truth"
    )
    simulated.add_argument("--scene", type=Path, default=Path("config/scene.yaml"), help="default %(default)s")
    simulated.add_argument("--board", type=Path, help="its YAML (saras board); default: the standard board")
    simulated.add_argument("--seed", type=int, default=1, help="of the simulated noise (default %(default)s)")
    simulated.add_argument("--touch-noise-m", type=float, default=0.5e-3, help="per axis (default %(default)s)")
    simulated.add_argument("--yes", action="store_true", help="no prompts: take everything")
    add_guide_arguments(simulated)
    streams = actions.add_parser("hand-eye", help="of two recorded streams, with their time offset")
    streams.add_argument("robot", type=Path, help="base_T_gripper over time (CSV, or ZIP:MEMBER)")
    streams.add_argument("camera", type=Path, help="camera_T_target over time")
    streams.add_argument("--camera-in-target", action="store_true", help="the camera's file holds target_T_camera")
    streams.add_argument("--parts", type=int, default=1, help="also of so many disjoint parts, compared")
    camera = actions.add_parser("camera", help="stereo camera from two folders of pictures or a bag, without a window")
    camera.add_argument(
        "left", type=Path, nargs="?", help="folder of pictures; left and right are paired by their sorted names"
    )
    camera.add_argument("right", type=Path, nargs="?")
    camera.add_argument("--bag", type=Path, help="a bag with both eyes' images, instead of the folders")
    camera.add_argument("--left-topic", default="/endoscope/left/image_raw", help="(%(default)s)")
    camera.add_argument("--right-topic", default="/endoscope/right/image_raw", help="(%(default)s)")
    camera.add_argument("--every-s", type=float, default=0.5, help="between two views of the bag (%(default)s)")
    camera.add_argument("--pattern", choices=("checkerboard", "charuco"), default="checkerboard")
    camera.add_argument("--columns", type=int, required=True, help="inner corners (charuco: squares) along a row")
    camera.add_argument("--rows", type=int, required=True)
    camera.add_argument("--square-m", type=float, required=True, help="measured on the print")
    camera.add_argument("--marker-m", type=float, help="edge of a charuco's markers")
    camera.add_argument(
        "--out", type=Path, default=Path("camera"), help="folder of left.yaml, right.yaml (%(default)s)"
    )
    camera.add_argument("--force", action="store_true", help="write over existing files")
    check = actions.add_parser("check", help="read a calibration file as the platform does")
    check.add_argument("file", type=Path)
    check.add_argument("--board", type=Path, help="the board in use; default: the standard board")
    check.add_argument("--max-age-h", type=float, default=math.inf, help="refuse an older file")


def run(arguments: argparse.Namespace) -> int:
    """Exit code; refused input is a saras.Error."""
    actions = {"simulation": _simulation, "hand-eye": _hand_eye, "camera": _camera, "check": _check}
    return actions[arguments.action](arguments)


def _simulation(arguments: argparse.Namespace) -> int:
    from rich.console import Console
    from rich.table import Table

    from saras.calibration.guided import Guide, QuitError, errors, save
    from saras.calibration.simulated import ENDOSCOPE, Noise, SimulatedRoom
    from saras.kinematics import scene

    console = Console()
    if arguments.out.exists() and not arguments.force:  # before half an hour of work, not after it
        console.print(f"{arguments.out}: exists; --force writes over it", style="red")
        return 2
    board = Board.load(arguments.board) if arguments.board else Board()
    room = SimulatedRoom(scene.load(arguments.scene), board, arguments.seed, Noise(touch_m=arguments.touch_noise_m))
    try:
        guide = Guide(
            room,
            ENDOSCOPE,
            console,
            automatic=arguments.yes,
            rounds=arguments.rounds,
            known_to_m=1e-3 * arguments.known_to_mm,
        )
        calibration = guide.run()
    except (QuitError, EOFError):
        console.print("ended; nothing was saved", style="yellow")
        return 1
    truth = {room.frame(arm): room.truth(arm) for arm in room.arms}
    table = Table(title="Against the simulation's truth", title_justify="left")
    for heading in ("frame", "off by", "turned by", f"within {1e3 * BOUND_M:g} mm, {BOUND_DEG:g} deg"):
        table.add_column(heading)
    good = True
    for name, (off_m, off_rad) in errors(calibration, truth).items():
        fits = off_m <= BOUND_M and np.rad2deg(off_rad) <= BOUND_DEG
        good = good and fits
        table.add_row(name, f"{1e3 * off_m:.2f} mm", f"{np.rad2deg(off_rad):.3f} deg", "yes" if fits else "[red]no[/]")
    console.print(table)
    save(calibration, arguments.out, arguments.force, console, truth)
    return 0 if good else 1


def _hand_eye(arguments: argparse.Namespace) -> int:
    from saras.calibration.recorded import hand_eye_of_streams, load_stream

    robot, camera = load_stream(arguments.robot), load_stream(arguments.camera)
    camera = camera.inverse if arguments.camera_in_target else camera
    whole = hand_eye_of_streams(robot, camera)
    found, used = whole.result, sum(whole.result.used)
    std = np.sqrt(np.diag(found.covariance))
    print(f"time offset {whole.time_offset_s:.4f} s (std {whole.time_offset_std_s:.4f}): robot time - camera time")
    print(f"pairs {whole.pairs}, left out as gross errors {whole.pairs - used}")
    print(f"residuals {1e3 * found.rms_m:.2f} mm, {np.rad2deg(found.rms_rad):.3f} deg rms")
    print(f"known to {1e3 * np.linalg.norm(std[:3]):.2f} mm, {np.rad2deg(np.linalg.norm(std[3:])):.3f} deg")
    print("gripper_T_camera\n" + np.array2string(found.gripper_T_camera, precision=6, suppress_small=True))
    if arguments.parts > 1:
        from saras.calibration.recorded import disjoint_parts

        for interleaved in (True, False):
            how = "interleaved" if interleaved else "successive"
            parts = disjoint_parts(robot, camera, arguments.parts, whole.time_offset_s, interleaved)
            for i, j, off, deviation in parts:
                sigmas = np.abs(off) / deviation
                print(
                    f"{how} parts {i + 1} and {j + 1} differ by {1e3 * np.linalg.norm(off[:3]):.2f} mm "
                    f"(std of the difference {1e3 * np.linalg.norm(deviation[:3]):.2f}), "
                    f"{np.rad2deg(np.linalg.norm(off[3:])):.3f} deg ({np.rad2deg(np.linalg.norm(deviation[3:])):.3f}); "
                    f"largest component {sigmas.max():.1f} std"
                )
    return 0


def _camera(arguments: argparse.Namespace) -> int:
    from saras.calibration.stereo import Charuco, Checkerboard, stereo
    from saras.calibration.stereo_pictures import from_bag, from_folders

    if arguments.pattern == "charuco" and arguments.marker_m is None:
        raise ConfigError("--marker-m: missing; a charuco needs it")
    pattern = (
        Charuco(arguments.columns, arguments.rows, arguments.square_m, arguments.marker_m)
        if arguments.pattern == "charuco"
        else Checkerboard(arguments.columns, arguments.rows, arguments.square_m)
    )
    if arguments.bag is not None:
        pairs = from_bag(arguments.bag, arguments.left_topic, arguments.right_topic, arguments.every_s)
    elif arguments.left is not None and arguments.right is not None:
        pairs = from_folders(arguments.left, arguments.right)
    else:
        raise ConfigError("left, right: two folders of pictures, or --bag FILE")
    found = stereo(pairs.left, pairs.right, pattern, pairs.names)
    for name, why in found.refused.items():
        print(f"not used  {name}: {why}")
    print(f"views used {len(found.used)}; coverage left {found.coverage[0]:.0%}, right {found.coverage[1]:.0%}")
    print(f"epipolar error {found.epipolar_px:.3f} px rms; baseline {1e3 * found.baseline_m:.3f} mm")
    for side, eye in (("left", found.left), ("right", found.right)):
        print(
            f"{side:<5} fx {eye.matrix[0, 0]:.2f} fy {eye.matrix[1, 1]:.2f} px, "
            f"distortion {np.round(eye.distortion, 4)}"
        )
    print("worst views (left, right, epipolar px rms):")
    for name in found.worst[:3]:
        i = found.used.index(name)
        a, b = found.view_errors_px[i]
        print(f"  {name}: {a:.3f} {b:.3f} {found.view_epipolar_px[i]:.3f}")
    print("saved " + ", ".join(str(path) for path in found.save(arguments.out, arguments.force)))
    return 0


def _check(arguments: argparse.Namespace) -> int:
    from rich.console import Console

    from saras.calibration.guided import summary

    board = Board.load(arguments.board) if arguments.board else Board()
    max_age_s = 3600.0 * arguments.max_age_h
    calibration = Calibration.load(arguments.file, board_hash=board.hash, max_age_s=max_age_s)
    Console().print(summary(calibration))
    print(f"made {calibration.stamp.isoformat()} with board {calibration.board_hash}")
    return 0
