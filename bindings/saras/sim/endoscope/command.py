"""Draws what the simulated stereo endoscope sees of the operating room, both eyes side by side, without ROS.

saras endoscope --scene config/scene.yaml --out endoscope.png            four instruments, one of them presses
saras endoscope --scene config/scene.yaml --out truth.png --truth        below each eye its depth and labels
saras endoscope --scene config/scene.yaml --out board.png --board        the calibration board instead
saras endoscope --scene config/scene.yaml --measure 100                  how long a pair of pictures takes
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

import numpy as np
import numpy.typing as npt

from saras import ConfigError
from saras.crtk.surgeon import joints_for_tip
from saras.kinematics import dvrk, scene
from saras.kinematics.scene import Scene, pose_from_xyz_rpy
from saras.sim.endoscope.camera import StereoCamera, stereo_camera
from saras.sim.endoscope.renderer import StereoPair, StereoRenderer, Truth
from saras.sim.endoscope.room import Room
from saras.sim.endoscope.tools import ToolState

Array = npt.NDArray[np.float64]
Image = npt.NDArray[np.uint8]

#: Where the calibration board lies in config/calibration.yaml, and how the endoscope sits on the ECM.
BOARD = [-0.01, -0.01, 0.09]
#: Tips over the middle of the phantom's face [m]: the left SARAS arm presses 6 mm deep.
TIPS = {
    "mesa_left": (-0.004, 0.022, -0.006),
    "mesa_right": (-0.010, -0.030, 0.008),
    "PSM1": (0.020, 0.052, 0.020),
    "PSM2": (0.030, -0.048, 0.018),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Of saras endoscope."""
    parser.add_argument("--scene", type=Path, required=True, help="scene file, as config/scene.yaml")
    parser.add_argument("--out", type=Path, help="picture to write: .png or .jpg")
    parser.add_argument("--size", default="640x480", help="WIDTHxHEIGHT of each eye (default: %(default)s)")
    parser.add_argument("--tip", type=float, nargs=3, default=[0.075, 0.0, 0.190], help="of the ECM in world [m]")
    parser.add_argument("--render-scale", type=float, default=1.0, help="pixels drawn for one shown")
    parser.add_argument("--noise", type=float, default=2.0, help="of the pictures, grey levels")
    parser.add_argument("--seed", type=int, default=1, help="of textures and noise")
    parser.add_argument("--truth", action="store_true", help="depth and labels, too")
    parser.add_argument("--board", action="store_true", help="the calibration board instead of tissue")
    parser.add_argument("--measure", type=int, default=0, metavar="N", help="time N pairs")


def run(arguments: argparse.Namespace) -> int:
    """Exit code."""
    import cv2

    if arguments.out is None and not arguments.measure:
        raise ConfigError("nothing to do: give --out or --measure")
    board = pose_from_xyz_rpy(BOARD, [0.0, 0.0, 0.0]) if arguments.board else None
    renderer = StereoRenderer(
        Room.load(arguments.scene, board),
        _camera(arguments.size),
        seed=arguments.seed,
        noise=arguments.noise,
        render_scale=arguments.render_scale,
    )
    place = scene.load(arguments.scene)
    view = world_T_left(place, np.array(arguments.tip))
    tools = {} if arguments.board else instruments(place)
    pair = renderer.render(view, tools)
    if arguments.out is not None:
        picture = collage(pair, renderer.truth() if arguments.truth else None)
        if not cv2.imwrite(str(arguments.out), picture):
            raise ConfigError(f"--out {arguments.out}: cannot be written")
        print(f"{arguments.out}: {picture.shape[1]}x{picture.shape[0]}")
    if arguments.measure:
        wall, busy = time.perf_counter(), time.process_time()
        for _ in range(arguments.measure):
            renderer.render(view, tools)
        wall, busy = time.perf_counter() - wall, time.process_time() - busy
        ms = 1e3 / arguments.measure
        print(f"{arguments.size}, both eyes: {ms * wall:.1f} ms a pair, {ms * busy:.1f} ms of processor time")
    return 0


def world_T_left(place: Scene, tip: Array) -> Array:
    """(4, 4) left eye of an ECM whose tip is at (3,) in world, mounted as in config/endoscope.yaml.

    Raises ConfigError: out of its reach.
    """
    ecm, world_T_base = dvrk.ecm(), place.world_T("ECM")
    try:
        q = joints_for_tip(ecm, np.linalg.inv(world_T_base), tip)
    except ValueError as error:
        raise ConfigError(f"--tip: {error}") from None
    mount = pose_from_xyz_rpy([0.0026, 0.0, 0.0], [0.0, 0.0, np.pi])
    return np.asarray(world_T_base @ ecm.forward(q) @ mount)


def instruments(place: Scene) -> dict[str, ToolState]:
    """The four tools with their tips as in TIPS."""
    middle = place.phantom.center + 0.5 * place.phantom.size * np.array([0.0, 0.0, 1.0])
    tools = {}
    for name, offset in TIPS.items():
        tip = middle + np.array(offset)
        if name.startswith("mesa"):
            base = place.world_T(f"{name}/sbs_world")
            trocar = (base @ [*place.arms[name].rcm, 1.0])[:3]
            tools[name] = ToolState.straight(tip, trocar, jaw=0.0 if offset[2] < 0.0 else 0.5)
        else:
            base, psm = place.world_T(name), dvrk.psm()
            q = joints_for_tip(psm, np.linalg.inv(base), tip)
            q[4] = 0.5
            wrist = (base @ [*psm.wrist_position(q), 1.0])[:3]
            tools[name] = ToolState(base @ psm.forward(q), base[:3, 3], 0.6, wrist)
    return tools


def collage(pair: StereoPair, truth: Truth | None) -> Image:
    """Both eyes side by side; below them, where there is truth, near is bright, and labels are colours."""
    import cv2

    rows = [np.hstack([pair.left, pair.right])]
    if truth is not None:
        shown = []
        for depth, labels in ((truth.left_depth, truth.left_labels), (truth.right_depth, truth.right_labels)):
            near = np.nan_to_num(np.nanmin(depth) / depth)
            grey = np.repeat((255.0 * near).astype(np.uint8)[..., None], 3, axis=2)
            colours = np.array(
                [(40, 30, 30), (90, 90, 220), (200, 230, 240), (255, 255, 255), (220, 160, 60)], np.uint8
            )
            half = depth.shape[1] // 2, depth.shape[0] // 2
            both = [cv2.resize(grey, half), cv2.resize(colours[labels], half, interpolation=cv2.INTER_NEAREST)]
            shown.append(np.hstack(both)[:, : depth.shape[1]])
        rows.append(np.hstack(shown))
    return np.asarray(np.vstack(rows), dtype=np.uint8)


def _camera(size: str) -> StereoCamera:
    parts = size.split("x")
    if len(parts) != 2 or not all(part.isdigit() for part in parts):
        raise ConfigError(f"--size {size!r}: must be WIDTHxHEIGHT")
    return stereo_camera(int(parts[0]), int(parts[1]))
