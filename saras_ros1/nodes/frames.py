"""frames: the only publisher of world → base frames, from the scene file (or the calibration that replaces it)."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import rospy
import tf2_ros
import yaml
from geometry_msgs.msg import TransformStamped

from saras import ConfigError
from saras.calibration.calibration_file import Calibration
from saras_ros1 import convert
from saras_ros1.base_frames import CalibratedFrame, CalibratedFrames
from saras_ros1.node import Node, run
from saras_ros1.params import Params
from saras_ros1.srv import LoadCalibration, LoadCalibrationResponse


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
    """Publishes latched, and again when a calibration is loaded or ceases to hold."""

    def __init__(self) -> None:
        super().__init__("frames")
        path = self.params.text("scene_file")
        file = self.params.text("calibration_file", empty=True) if self.params.has("calibration_file") else ""
        self.max_age_s = math.inf
        if self.params.has("calibration_max_age_h"):
            self.max_age_s = 3600.0 * self.params.number("calibration_max_age_h", 0.0, 1e6)
        self.params.finish()
        self.transforms = {t.child_frame_id: t for t in read_frames(load_scene(path), rospy.Time.now())}
        self.calibrated: CalibratedFrames | None = None
        self.file = ""
        self.broadcaster = tf2_ros.StaticTransformBroadcaster()
        if file:
            self.load(file)
        self._publish()
        rospy.Service("/frames/load_calibration", LoadCalibration, self._on_load)

    def load(self, file: str) -> None:
        """Takes a calibration's frames in place of the scene's. Raises ConfigError; then nothing has changed."""
        if not Path(file).is_absolute():  # roslaunch starts nodes in a directory of its own
            raise ConfigError(f"calibration_file = {file!r}: must be an absolute path")
        try:
            calibration = Calibration.load(file, max_age_s=self.max_age_s)
        except OSError as error:
            raise ConfigError(f"calibration_file: {error}") from None
        strange = sorted(set(calibration.frames) - set(self.transforms))
        if strange:
            raise ConfigError(f"{file}: frames/{strange[0]}: must be one of {', '.join(sorted(self.transforms))}")
        if self.calibrated is not None:
            self.calibrated.close()
        with self.lock:
            self.calibrated, self.file = CalibratedFrames(calibration, self._on_change), file
        rospy.loginfo(f"base frames of {', '.join(calibration.frames)} from {file}")

    def _on_load(self, request) -> LoadCalibrationResponse:
        try:
            self.load(request.path)
        except ConfigError as error:
            return LoadCalibrationResponse(False, str(error))
        self._publish()
        return LoadCalibrationResponse(True, f"{len(self.calibrated.frames)} frames from {request.path}")

    def _on_change(self, frame: CalibratedFrame) -> None:
        if frame.known:
            rospy.loginfo(f"{frame.name}: known, its joints are where they were calibrated")
        else:
            rospy.logerr(f"{frame.name}: unknown from now on: {frame.reason}; calibrate this arm anew")
        self._publish()

    def _publish(self) -> None:
        with self.lock:
            stamp = rospy.Time.now()
            transforms = dict(self.transforms)
            if self.calibrated is not None:
                transforms.update({name: f.transform(stamp) for name, f in self.calibrated.frames.items()})
        self.broadcaster.sendTransform(list(transforms.values()))

    def report(self) -> dict:
        """How many frames, from which file, and which are unknown."""
        calibrated = self.calibrated.frames.values() if self.calibrated is not None else ()
        unknown = {f"unknown {frame.name}": frame.reason for frame in calibrated if not frame.known}
        return {"frames": len(self.transforms), "calibration": self.file or "none: the scene's numbers", **unknown}


def main() -> int:
    """Runs the node."""
    return run(Frames)
