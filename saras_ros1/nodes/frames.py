"""frames: the only publisher of world → base frames, from the scene file (or the calibration that replaces it)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import rospy
import tf2_ros
import yaml
from geometry_msgs.msg import TransformStamped

from saras import ConfigError
from saras_ros1 import convert
from saras_ros1.node import Node, run
from saras_ros1.params import Params


def rotation_from_rpy(roll: float, pitch: float, yaw: float) -> np.ndarray:
    """(3, 3) Rz(yaw) Ry(pitch) Rx(roll), as in URDF."""
    (cr, cp, cy), (sr, sp, sy) = np.cos([roll, pitch, yaw]), np.sin([roll, pitch, yaw])
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )


def load_scene(path: str) -> dict:
    """The scene file as a dict; ConfigError names the file."""
    try:
        scene = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except (OSError, yaml.YAMLError) as error:
        raise ConfigError(f"scene_file {path}: {error}") from None
    if not isinstance(scene, dict):
        raise ConfigError(f"scene_file {path}: no keys in it")
    return scene


def read_frames(scene: dict, stamp: rospy.Time) -> list[TransformStamped]:
    """All transforms of the scene's `frames`: {child: {parent, xyz_m, rpy_rad}}."""
    frames = Params(scene.get("frames"), "scene/frames")
    transforms = []
    for child in scene["frames"]:
        entry = frames.section(child)
        matrix = np.eye(4)
        matrix[:3, 3] = entry.vector("xyz_m", 3, -10.0, 10.0)
        matrix[:3, :3] = rotation_from_rpy(*entry.vector("rpy_rad", 3, -2.0 * np.pi, 2.0 * np.pi))
        transforms.append(convert.transform_msg(matrix, entry.text("parent"), child, stamp))
    frames.finish()
    return transforms


class Frames(Node):
    """Publishes once, latched."""

    def __init__(self) -> None:
        super().__init__("frames")
        path = self.params.text("scene_file")
        self.params.finish()
        self.transforms = read_frames(load_scene(path), rospy.Time.now())
        self.broadcaster = tf2_ros.StaticTransformBroadcaster()
        self.broadcaster.sendTransform(self.transforms)

    def report(self) -> dict:
        """How many frames."""
        return {"frames": len(self.transforms)}


def main() -> int:
    """Runs the node."""
    return run(Frames)
