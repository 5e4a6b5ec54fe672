"""What the surgeons see: the overlay of both eyes while all is clear, near, touching, and not known.

Four tools in the scene of a stereo endoscope with distortion; the picture behind them is only a stand-in for tissue.

python examples/06_overlay.py [--plot FILE.png]
"""

import argparse

import numpy as np

from saras.collision import ProximityMonitor, ProximityMonitorConfig
from saras.overlay import CameraConfig, OverlayPainter, OverlayTool, ToolOverlay, color_of

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("--plot", help="write a picture here (needs matplotlib)")
arguments = parser.parse_args()

WIDTH, HEIGHT = 640, 480
NAMES = ("MESA LEFT", "MESA RIGHT", "PSM1", "PSM2")
RADII = (0.0025, 0.0025, 0.0042, 0.0042)
#: Tips and trocars in the frame of the endoscope (z forward, y down) [m]; the second tool moves.
TIPS = np.array([[-0.016, 0.012, 0.105], [0.022, 0.016, 0.110], [-0.028, -0.012, 0.120], [0.024, -0.024, 0.125]])
TROCARS = np.array([[-0.09, 0.08, 0.02], [0.09, 0.08, 0.02], [-0.11, -0.03, 0.03], [0.11, -0.03, 0.03]])
SITUATIONS = {"clear": 0.0, "warning": 0.025, "collision": 0.0365, "unknown": 0.0}  # so far to the left [m]


def eyes() -> list[CameraConfig]:
    """Left and right: 560 px focal length, barrel distortion, 5 mm apart, as calibrated."""
    k = np.array([[560.0, 0.0, 322.0], [0.0, 558.0, 243.0], [0.0, 0.0, 1.0]])
    p = np.column_stack([np.array([[540.0, 0.0, 320.0], [0.0, 540.0, 240.0], [0.0, 0.0, 1.0]]), np.zeros(3)])
    common = {"width_px": WIDTH, "height_px": HEIGHT, "K": k, "distortion": [-0.22, 0.08, 5e-4, -4e-4, 0, 0, 0, 0]}
    right = p.copy()
    right[0, 3] = -540.0 * 0.005
    return [CameraConfig(P=p, **common), CameraConfig(P=right, **common)]


def tissue() -> np.ndarray:
    """(height, width, 3) RGB: smooth reddish noise, darker to the border."""
    rng = np.random.default_rng(1)
    y, x = np.mgrid[0:HEIGHT, 0:WIDTH]
    clouds = np.zeros((HEIGHT, WIDTH))
    for _ in range(60):
        wave = rng.normal(0.0, 0.03, 2)
        clouds += np.cos(wave[0] * x + wave[1] * y + rng.uniform(0.0, 6.3)) / (1.0 + 40.0 * np.linalg.norm(wave))
    clouds = (clouds - clouds.min()) / np.ptp(clouds)
    light = 1.0 - 0.6 * np.hypot((x - WIDTH / 2) / WIDTH, (y - HEIGHT / 2) / HEIGHT)
    rgb = (light * (0.55 + 0.45 * clouds))[..., None] * [190, 105, 90]
    return np.clip(rgb + rng.normal(0.0, 2.0, rgb.shape), 0, 255).astype(np.uint8)


def tools(left_m: float, known: bool) -> list[OverlayTool]:
    """What colliding_regions would say of the four tools, the camera being the world."""
    capsules = np.column_stack([TIPS, TROCARS, RADII])
    capsules[1, 0] -= left_m
    if not known:
        capsules[2] = np.nan  # nobody knows where PSM1 is
    found = ProximityMonitor(ProximityMonitorConfig(), len(NAMES)).step(capsules, dt=0.01).tools
    return [
        OverlayTool(
            name=name,
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


background, painters = tissue(), [OverlayPainter(camera) for camera in eyes()]
columns = []
print("state       " + "".join(f"{name:>24s}" for name in NAMES))
for situation, left_m in SITUATIONS.items():
    fresh = {"distances_age_s": 0.01, "tools_age_s": 0.01, "camera_age_s": 0.01, "dt": 0.04}
    marks = ToolOverlay().step(tools(left_m, situation != "unknown"), camera_T_world=np.eye(4), **fresh)
    images = [background.copy() for _ in painters]
    for painter, image in zip(painters, images):
        painter.draw(marks, image, "rgb8")
    columns.append(np.concatenate(images))
    print(f"{situation:12s}" + "".join(f"{m.level.name:>14s} {1e3 * m.distance_m:6.1f} mm" for m in marks.tools))
    for mark in marks.tools:
        red, green, blue, _ = color_of(mark.level)
        assert (images[0].reshape(-1, 3) == [red, green, blue]).all(axis=1).any(), f"{mark.name} is not to be seen"

if arguments.plot:
    import matplotlib.image

    gap = np.full((2 * HEIGHT, 8, 3), 255, dtype=np.uint8)
    parts = [part for column in columns for part in (gap, column)][1:]
    matplotlib.image.imsave(arguments.plot, np.concatenate(parts, axis=1))
