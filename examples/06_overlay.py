"""What the surgeons see: the overlay of both eyes while all is clear, near, touching, and not known.

Four tools in the simulated room, seen by its stereo endoscope (VTK); without VTK they are drawn on plain ground.
Needs PyYAML and OpenCV: pip install '.[calibration]'; with VTK: pip install '.[endoscope]'.

python examples/06_overlay.py [--plot FILE.png]
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from saras.collision import ProximityMonitor, ProximityMonitorConfig
from saras.kinematics import scene as scenes
from saras.overlay import CameraConfig, OverlayPainter, OverlayTool, ToolOverlay, color_of
from saras.sim.endoscope import Room, StereoRenderer, ToolState, stereo_camera

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("--plot", help="write a picture here (needs matplotlib)")
arguments = parser.parse_args()

SCENE = Path(__file__).resolve().parents[1] / "config" / "scene.yaml"
NAMES = ("mesa_left", "mesa_right", "PSM1", "PSM2")
RADII = (0.0025, 0.0025, 0.0042, 0.0042)
#: Tips in world over the phantom [m]; then the right SARAS tool moves to the left one.
TIPS = np.array([[-0.056, 0.022, 0.140], [-0.058, -0.026, 0.142], [-0.012, 0.014, 0.146], [-0.012, -0.040, 0.146]])
SITUATIONS = {"clear": 0.0, "warning": 0.035, "collision": 0.0424, "unknown": 0.0}  # so far [m]
#: world_T_left: the left eye over the phantom, its image's top towards the head.
WORLD_T_LEFT = np.array(
    [[0.0, -1.0, 0.0, -0.035], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.255], [0.0, 0.0, 0.0, 1.0]]
)


def trocars() -> np.ndarray:
    """(4, 3) in world."""
    room, found = scenes.load(SCENE), []
    for name in NAMES:
        if name in room.arms:
            found.append((room.world_T(f"{name}/sbs_world") @ [*room.arms[name].rcm, 1.0])[:3])
        else:
            found.append(room.world_T(name)[:3, 3])
    return np.array(found)


def camera_configs() -> list[CameraConfig]:
    """Both eyes of the simulated endoscope."""
    pair = stereo_camera()
    return [
        CameraConfig(
            width_px=eye.size[0],
            height_px=eye.size[1],
            K=eye.intrinsics.matrix,
            R=eye.R,
            P=eye.P,
            distortion=[*eye.intrinsics.distortion, 0.0, 0.0, 0.0],
        )
        for eye in (pair.left, pair.right)
    ]


def renderer():
    """A function of the tips that gives both eyes' pictures (RGB)."""
    try:
        draw = StereoRenderer(Room.load(SCENE), stereo_camera(), seed=1, noise=0.0)
    except Exception as missing:  # no VTK, or nothing to draw on
        print(f"on plain ground: {missing}", file=sys.stderr)
        return lambda tips: [np.full((480, 640, 3), (150, 90, 80), np.uint8) for _ in range(2)]

    def pictures(tips: np.ndarray) -> list[np.ndarray]:
        tools = {}
        for name, tip, trocar in zip(NAMES, tips, trocars()):
            z = (tip - trocar) / np.linalg.norm(tip - trocar)
            x = np.cross([0.0, 1.0, 0.0], z)
            x /= np.linalg.norm(x)
            pose = np.eye(4)
            pose[:3, :3], pose[:3, 3] = np.column_stack([x, np.cross(z, x), z]), tip
            tools[name] = ToolState(pose, trocar, jaw=0.3)
        pair = draw.render(WORLD_T_LEFT, tools)
        return [np.ascontiguousarray(picture[..., ::-1]) for picture in (pair.left, pair.right)]

    return pictures


def overlay_tools(tips: np.ndarray, known: bool) -> list[OverlayTool]:
    """What colliding_regions would say of the four tools."""
    capsules = np.column_stack([tips, trocars(), RADII])
    if not known:
        capsules[2] = np.nan  # nobody knows where PSM1 is: no other tool is clear either
    found = ProximityMonitor(ProximityMonitorConfig(), len(NAMES)).step(capsules, dt=0.01).tools
    return [
        OverlayTool(
            name=name.upper().replace("_", " "),
            tip=capsule[:3],
            trocar=capsule[3:6],
            distance_m=tool.distance_m,
            state=tool.state,
            known_distance_m=tool.known.distance,
            on_tool=tool.known.point_a,
            on_partner=tool.known.point_b,
        )
        for name, capsule, tool in zip(NAMES, capsules, found)
    ]


cameras = camera_configs()
painters, pictures = [OverlayPainter(camera) for camera in cameras], renderer()
rectified_T_raw = np.eye(4)
rectified_T_raw[:3, :3] = cameras[0].R
camera_T_world = rectified_T_raw @ np.linalg.inv(WORLD_T_LEFT)
columns = []
print("state       " + "".join(f"{name:>24s}" for name in NAMES))
for situation, moved_m in SITUATIONS.items():
    tips = TIPS.copy()
    tips[1, 1] += moved_m
    fresh = {"distances_age_s": 0.01, "tools_age_s": 0.01, "camera_age_s": 0.01, "dt": 0.04}
    marks = ToolOverlay().step(overlay_tools(tips, situation != "unknown"), camera_T_world=camera_T_world, **fresh)
    images = pictures(tips)
    for painter, image in zip(painters, images):
        painter.draw(marks, image, "rgb8")
    columns.append(np.concatenate(images))
    print(f"{situation:12s}" + "".join(f"{m.level.name:>14s} {1e3 * m.distance_m:6.1f} mm" for m in marks.tools))
    for mark in marks.tools:
        assert (images[0].reshape(-1, 3) == color_of(mark.level)[:3]).all(axis=1).any(), (
            f"{mark.name} is not to be seen"
        )

if arguments.plot:
    from PIL import Image  # matplotlib brings it

    gap = np.full((len(columns[0]), 8, 3), 255, dtype=np.uint8)
    parts = [part for column in columns for part in (gap, column)][1:]
    sheet = Image.fromarray(np.concatenate(parts, axis=1))
    sheet = sheet.resize((sheet.width * 5 // 8, sheet.height * 5 // 8), Image.Resampling.LANCZOS)
    sheet.quantize(256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(arguments.plot, optimize=True)
