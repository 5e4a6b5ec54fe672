"""The stiffness map over the organ in the endoscope's image: a palpated phantom, half of it not touched yet.

The simulated room is seen by its stereo endoscope (VTK); without VTK the map is drawn on plain ground.
Needs PyYAML and OpenCV: pip install '.[calibration]'; with VTK: pip install '.[endoscope]'.

python examples/10_overlay_stiffness.py [--plot FILE.png]
"""

import argparse
import sys
from pathlib import Path

import numpy as np

from saras.model import StiffnessMap
from saras.overlay import CameraConfig, StiffnessOverlay
from saras.sim import TissueConfig
from saras.sim.endoscope import Room, StereoRenderer, stereo_camera
from saras.sim.palpation import Phantom, palpate, raster_path

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("--plot", help="write a picture here (needs Pillow, which matplotlib brings)")
arguments = parser.parse_args()

SCENE = Path(__file__).resolve().parents[1] / "config" / "scene.yaml"
#: world_T_left: the left eye over the phantom; world_T_organ: the palpated patch, where the phantom's top is.
WORLD_T_LEFT = np.array(
    [[0.0, -1.0, 0.0, -0.035], [-1.0, 0.0, 0.0, 0.0], [0.0, 0.0, -1.0, 0.255], [0.0, 0.0, 0.0, 1.0]]
)
WORLD_T_ORGAN = np.eye(4)
WORLD_T_ORGAN[:3, 3] = [-0.035, 0.0, 0.14]
SIDE = 41

# %% Palpate three quarters of a patch of 6 x 6 cm; the fourth stays unknown.
phantom, dt = Phantom(TissueConfig(curvature_1_m=3.0, inclusion_x_m=-0.006, inclusion_y_m=0.004)), 2e-3
touched = palpate(phantom, raster_path(0.05, 3e-3, 0.012, dt), dt, position_noise_m=2e-5)
inside = (touched.positions[:, 0] < 0.012) | (touched.positions[:, 1] > 0.0)
model = StiffnessMap().fit(touched.positions[inside], touched.forces[inside], touched.velocities[inside])

# %% Ask at the vertices of a mesh.
side = np.linspace(-0.03, 0.03, SIDE)
vertices = phantom.surface(np.array([(x, y) for y in side for x in side]))
first = np.array([row * SIDE + column for row in range(SIDE - 1) for column in range(SIDE - 1)])
triangles = np.concatenate(
    [np.column_stack([first, first + 1, first + SIDE]), np.column_stack([first + 1, first + SIDE + 1, first + SIDE])]
)
stiffness, std = model.predict(vertices, return_std=True)
known = np.isfinite(stiffness)
print(f"known at {known.mean():.0%} of {len(vertices)} vertices, stiffest {np.nanmax(stiffness):.0f} N/m")

# %% What both eyes see, and the map on it.
pair = stereo_camera()
try:
    seen = StereoRenderer(Room.load(SCENE), pair, seed=1, noise=0.0).render(WORLD_T_LEFT, {})
    images = [np.ascontiguousarray(picture[..., ::-1]) for picture in (seen.left, seen.right)]
except Exception as missing:  # no VTK, or nothing to draw on
    print(f"on plain ground: {missing}", file=sys.stderr)
    images = [np.full((eye.size[1], eye.size[0], 3), (150, 90, 80), np.uint8) for eye in (pair.left, pair.right)]
rectified_T_raw = np.eye(4)
rectified_T_raw[:3, :3] = pair.left.R
left_T_organ = rectified_T_raw @ np.linalg.inv(WORLD_T_LEFT) @ WORLD_T_ORGAN
for eye, image in zip((pair.left, pair.right), images):
    camera = CameraConfig(
        width_px=eye.size[0],
        height_px=eye.size[1],
        K=eye.intrinsics.matrix,
        R=eye.R,
        P=eye.P,
        distortion=[*eye.intrinsics.distortion, 0.0, 0.0, 0.0],
    )
    before = image.copy()
    assert StiffnessOverlay(camera).draw(vertices, stiffness, std, triangles, left_T_organ, image, "rgb8")
    print(f"drawn on {(before != image).any(axis=2).mean():.0%} of the picture")

if arguments.plot:
    from PIL import Image

    gap = np.full((images[0].shape[0], 8, 3), 255, np.uint8)
    sheet = Image.fromarray(np.concatenate([images[0], gap, images[1]], axis=1))
    sheet.quantize(256, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE).save(arguments.plot, optimize=True)
