"""A stereo endoscope in the simulated room, drawn by VTK without a display. Needs VTK 9, OpenCV, PyYAML.

    renderer = StereoRenderer(Room.load("config/scene.yaml"), stereo_camera(), seed=1)
    pair = renderer.render(world_T_left, tools)          # pair.left, pair.right: (height, width, 3) BGR
    truth = renderer.truth()                             # depth and labels of what was rendered last

A pixel is where `cv2.projectPoints` with the camera's K and D puts the point, to hundredths of a pixel.
"""

from saras.sim.endoscope.camera import StereoCamera, stereo_camera
from saras.sim.endoscope.renderer import Label, StereoPair, StereoRenderer, Truth
from saras.sim.endoscope.room import Room, Surface
from saras.sim.endoscope.tools import ToolState

__all__ = [
    "Label",
    "Room",
    "StereoCamera",
    "StereoPair",
    "StereoRenderer",
    "Surface",
    "ToolState",
    "Truth",
    "stereo_camera",
]
