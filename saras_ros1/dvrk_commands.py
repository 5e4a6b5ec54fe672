"""What a simulated da Vinci arm listens to, under CRTK's names and under the older ones; its services and states."""

from __future__ import annotations

import threading
from typing import Any, Callable

import numpy as np
import rospy
from crtk_msgs.msg import OperatingState, StringStamped
from crtk_msgs.srv import (
    QueryForwardKinematics,
    QueryForwardKinematicsResponse,
    QueryInverseKinematics,
    QueryInverseKinematicsResponse,
    TriggerOperatingState,
    TriggerOperatingStateResponse,
)
from geometry_msgs.msg import (
    Point,
    Pose,
    PoseStamped,
    Quaternion,
    TransformStamped,
    TwistStamped,
    Wrench,
    WrenchStamped,
)
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, Empty, Header, String

from saras import Error
from saras.crtk import SimulatedCrtkArm
from saras_ros1 import convert
from saras_ros1.dvrk_settings import Settings

# Before CRTK: topic under /dvrk/<arm>/ → command. Poses came as Pose, PoseStamped or TransformStamped.
OLD_COMMANDS = {
    "set_position_joint": "servo_jp",
    "set_position_goal_joint": "move_jp",
    "set_effort_joint": "servo_jf",
    "set_position_cartesian": "servo_cp",
    "set_position_goal_cartesian": "move_cp",
    "set_wrench_body": "servo_cf",
    "set_wrench_spatial": "servo_cf",
}
OLD_JAW = {"set_position_jaw": "servo_jp", "set_effort_jaw": "servo_jf"}
# Words for set_desired_state, CRTK's and those of the years before.
OLD_STATES = {
    "ENABLED": "enable",
    "DISABLED": "disable",
    "PAUSED": "pause",
    "READY": "home",
    "HOMED": "home",
    "DVRK_READY": "home",
    "UNINITIALIZED": "disable",
    "DVRK_UNINITIALIZED": "disable",
}
LOG = {"error": rospy.logerr, "warning": rospy.logwarn, "status": rospy.loginfo}
DECODERS = {c._type: c for c in (Pose, PoseStamped, TransformStamped, Wrench, WrenchStamped)}


def pose_of(message: Any) -> np.ndarray:
    """(4, 4) of a Pose, PoseStamped or TransformStamped. Raises ValueError."""
    if isinstance(message, TransformStamped):
        return convert.transform(message)
    return convert.pose(message if hasattr(message, "pose") else PoseStamped(pose=message))


def wrench_of(message: Any) -> np.ndarray:
    """(6,) of a Wrench or WrenchStamped. Raises ValueError."""
    return convert.wrench(message if hasattr(message, "wrench") else WrenchStamped(wrench=message))


class Commands:
    """The subscribers, services and events of one arm. lock: held while the arm is touched.

    frame(): the frame_id that a command may name; an empty one means it.
    """

    def __init__(
        self,
        arm: SimulatedCrtkArm,
        lock: threading.RLock,
        frame: Callable[[], str],
        set_base: Callable,
        old_names: bool,
    ) -> None:
        self.arm, self._lock, self._frame, self._set_base = arm, lock, frame, set_base
        self._prefixes = [f"/{arm.name}/"] + ([f"/dvrk/{arm.name}/"] if old_names else [])
        new = self._prefixes[0]
        self._operating_state = rospy.Publisher(new + "operating_state", OperatingState, queue_size=20, latch=True)
        self._current_state = [
            rospy.Publisher(prefix + name, String, queue_size=20, latch=True)
            for prefix in self._prefixes[1:]
            for name in ("current_state", "desired_state")
        ]
        self._goal_reached = [
            rospy.Publisher(prefix + "goal_reached", Bool, queue_size=20) for prefix in self._prefixes
        ]
        self._texts = {
            level: [rospy.Publisher(prefix + level, String, queue_size=20, latch=False) for prefix in self._prefixes]
            for level in LOG
        }
        self._subscribe(new + "state_command", StringStamped, lambda m: self.state_command(m.string))
        for verb in ("servo", "interpolate", "move"):
            for what in ("jp", "jr"):
                self._motion(new + f"{verb}_{what}", JointState, f"{verb}_{what}", lambda m: m.position)
            for what in ("cp", "cr"):
                self._motion(new + f"{verb}_{what}", PoseStamped, f"{verb}_{what}", self._pose)
        self._motion(new + "servo_jv", JointState, "servo_jv", lambda m: m.velocity)
        self._motion(new + "servo_jf", JointState, "servo_jf", lambda m: m.effort)
        self._motion(new + "servo_cv", TwistStamped, "servo_cv", convert.twist)
        for name in ("servo_cf", "body/servo_cf", "spatial/servo_cf"):
            self._motion(new + name, WrenchStamped, "servo_cf", convert.wrench)
        for name in ("hold", "free"):
            self._motion(new + name, Empty, name, lambda _: None)
        self._subscribe(new + "set_base_frame", PoseStamped, self._on_base_frame)
        if arm.jaw is not None:
            for name in ("servo_jp", "move_jp"):
                self._jaw(new + f"jaw/{name}", name)
            self._jaw(new + "jaw/servo_jf", "servo_jf")
        if old_names:
            self._listen_to_old_names(self._prefixes[1])
        Settings(arm, self._subscribe)
        rospy.Service(new + "forward_kinematics", QueryForwardKinematics, self._forward)
        rospy.Service(new + "local/forward_kinematics", QueryForwardKinematics, self._local_forward)
        rospy.Service(new + "operating_state", TriggerOperatingState, self._tell_state)
        rospy.Service(new + "inverse_kinematics", QueryInverseKinematics, self._inverse)

    def _listen_to_old_names(self, prefix: str) -> None:
        for topic, name in OLD_COMMANDS.items():
            if name.endswith(("jp", "jf")):
                read = (lambda m: m.position) if name.endswith("jp") else (lambda m: m.effort)
                self._motion(prefix + topic, JointState, name, read)
            else:
                read = self._pose if name.endswith("cp") else wrench_of
                self._motion(prefix + topic, rospy.AnyMsg, name, lambda m, read=read: read(decode(m)))
        for topic, name in OLD_JAW.items():
            if self.arm.jaw is not None:
                self._jaw(prefix + topic, name)
        self._subscribe(
            prefix + "set_desired_state", String, lambda m: self.state_command(OLD_STATES.get(m.data, m.data))
        )

    def _subscribe(self, topic: str, message_class: type, callback: Callable[[Any], None]) -> None:
        def on_message(message: Any) -> None:
            with self._lock:
                callback(message)
                self.publish_events()

        rospy.Subscriber(topic, message_class, on_message, queue_size=10, tcp_nodelay=True)

    def _motion(self, topic: str, message_class: type, name: str, read: Callable[[Any], Any]) -> None:
        def obey(message: Any) -> None:
            try:
                value = read(message)
            except ValueError as error:
                self.arm.refuse(f"{name} refused: {error}")
                return
            self.arm.command(name, value)

        self._subscribe(topic, message_class, obey)

    def _jaw(self, topic: str, name: str) -> None:
        read = (lambda m: m.effort) if name.endswith("jf") else (lambda m: m.position)
        self._subscribe(topic, JointState, lambda m: self.arm.jaw_command(name, read(m)))

    def _pose(self, message: Any) -> np.ndarray:
        header = getattr(message, "header", None)
        frame = "" if header is None else header.frame_id.lstrip("/")
        if frame not in ("", self._frame()):
            raise ValueError(f"frame_id '{frame}': must be '{self._frame()}' or empty")
        return pose_of(message)

    def _on_base_frame(self, message: PoseStamped) -> None:
        try:
            self._set_base(convert.pose(message), message.header.frame_id.lstrip("/"))
        except ValueError as error:
            self.arm.refuse(f"set_base_frame refused: {error}")

    def state_command(self, text: str) -> None:
        """By name; anything that the table does not have is refused and reported."""
        self.arm.state_command(text)

    def publish_events(self) -> None:
        """What has changed or gone wrong since the last call. Called under the lock."""
        for reached in self.arm.take_ends():
            for publisher in self._goal_reached:
                publisher.publish(Bool(reached))
        for state, homed, busy in self.arm.take_states():
            header = Header(stamp=rospy.Time.now())
            self._operating_state.publish(OperatingState(header, state, homed, busy))
            for publisher in self._current_state:
                publisher.publish(String(state))
        for level, text in self.arm.take_events():
            LOG[level](text)
            for publisher in self._texts[level]:
                publisher.publish(String(text))

    # ---- services, in the frame of measured_cp, local/ in that of the remote centre

    def _tell_state(self, _: Any) -> TriggerOperatingStateResponse:
        with self._lock:
            machine = self.arm.machine
            header = Header(stamp=rospy.Time.now())
            state = OperatingState(header, machine.state, machine.is_homed, machine.is_busy)
        return TriggerOperatingStateResponse(state)

    def _forward(self, request: Any) -> QueryForwardKinematicsResponse:
        return self._pose_response(request, self.arm.forward)

    def _local_forward(self, request: Any) -> QueryForwardKinematicsResponse:
        return self._pose_response(request, self.arm.kinematics.forward)

    def _pose_response(self, request: Any, forward: Callable[[Any], Any]) -> QueryForwardKinematicsResponse:
        response = QueryForwardKinematicsResponse()
        try:
            with self._lock:
                pose = forward(_joints(request.jp, self.arm))
        except (ValueError, Error) as error:
            response.message, response.cp.orientation.w = str(error), 1.0
            return response
        response.cp = Pose(Point(*pose[:3, 3].tolist()), Quaternion(*convert.quaternion(pose)))
        response.result = True
        return response

    def _inverse(self, request: Any) -> QueryInverseKinematicsResponse:
        response = QueryInverseKinematicsResponse()
        try:
            with self._lock:
                near = _joints(request.jp, self.arm) if request.jp else self.arm.joints.q
                base_T_tip = np.linalg.inv(self.arm.reference_T_base) @ pose_of(request.cp)
                response.jp = self.arm.kinematics.inverse(base_T_tip, near).tolist()
        except (ValueError, Error) as error:
            response.message = str(error)
            return response
        response.result = True
        return response


def _joints(values: Any, arm: SimulatedCrtkArm) -> np.ndarray:
    if len(values) != len(arm.joints.q):
        raise ValueError(f"jp has {len(values)} values: must be {len(arm.joints.q)}")
    return np.array(values, dtype=float)


def decode(message: rospy.AnyMsg) -> Any:
    """The message behind an AnyMsg of one of the types that these topics have had. Raises ValueError."""
    kind = message._connection_header.get("type", "")
    if kind not in DECODERS:
        raise ValueError(f"type {kind}: must be one of {', '.join(DECODERS)}")
    return DECODERS[kind]().deserialize(message._buff)
