"""A CRTK client as the stock Python one behaves, written anew from its documented interface.

Same names, topics, message types and waiting: `ral` gives publishers and subscribers of a namespace, `utils.add_…` puts
methods into a class, `move_…` returns a handle whose `wait()` looks for an operating state that came after the command.
It imports crtk_msgs by name and knows nothing of saras.
"""

from __future__ import annotations

import threading
import time

import crtk_msgs.msg
import crtk_msgs.srv
import geometry_msgs.msg
import numpy
import PyKDL
import rospy
import sensor_msgs.msg
import std_msgs.msg


def frame_from_pose(pose):
    p, q = pose.position, pose.orientation
    return PyKDL.Frame(PyKDL.Rotation.Quaternion(q.x, q.y, q.z, q.w), PyKDL.Vector(p.x, p.y, p.z))


def pose_from_frame(frame):
    pose = geometry_msgs.msg.Pose()
    pose.position.x, pose.position.y, pose.position.z = frame.p
    q = pose.orientation
    q.x, q.y, q.z, q.w = frame.M.GetQuaternion()
    return pose


class Ral:
    """Publishers and subscribers below one namespace."""

    def __init__(self, namespace):
        self.namespace, self._all = namespace.strip("/"), []

    def publisher(self, topic, kind, latch=False, queue_size=10):
        self._all.append(rospy.Publisher(f"{self.namespace}/{topic}", kind, latch=latch, queue_size=queue_size))
        return self._all[-1]

    def subscriber(self, topic, kind, callback, queue_size=10):
        self._all.append(rospy.Subscriber(f"{self.namespace}/{topic}", kind, callback, queue_size=queue_size))
        return self._all[-1]

    def service(self, name, kind):
        return rospy.ServiceProxy(f"{self.namespace}/{name}", kind)

    def check_connections(self, timeout_seconds=10.0):
        end = time.monotonic() + timeout_seconds
        while time.monotonic() < end:
            lacking = [link.name for link in self._all if link.get_num_connections() == 0]
            if not lacking:
                return
            time.sleep(0.01)
        raise TimeoutError(f"no connection on {', '.join(lacking)}")


class WaitMoveHandle:
    def __init__(self, instance):
        self._instance, self._start = instance, rospy.Time.now()

    def wait(self, is_busy=False, timeout=30.0):
        return self._instance.wait_for_busy(is_busy=is_busy, start_time=self._start, timeout=timeout)


class _Topic:
    """The newest message, and an event for the next one."""

    def __init__(self, ral, name, kind):
        self.data, self.event = kind(), threading.Event()
        ral.subscriber(name, kind, self._on_message)

    def _on_message(self, message):
        self.data = message
        self.event.set()

    def valid(self, interval, age, wait):
        """A message younger than age [s], or one that comes within wait [s]; both default to the interval."""
        self.event.clear()
        age = interval if age is None else age
        if age != 0.0 and rospy.Time.now() - self.data.header.stamp <= rospy.Duration(age):
            return self.data
        if self.event.wait(interval if wait is None else wait):
            return self.data
        raise RuntimeWarning("unable to get data")


class _State(_Topic):
    """The operating state, and when it last said busy. A state that is not younger than the one before is dropped."""

    def __init__(self, ral):
        self.busy_time = rospy.Time.now()
        super().__init__(ral, "operating_state", crtk_msgs.msg.OperatingState)

    def _on_message(self, message):
        stamp = message.header.stamp
        if message.is_busy:
            self.busy_time = max(self.busy_time, stamp)
        if stamp > self.data.header.stamp:
            self.data = message
        self.event.set()


class Utils:
    """Adds CRTK methods to class_instance."""

    def __init__(self, class_instance, ral, expected_interval=0.02):
        self._to, self._ral, self._interval = class_instance, ral, expected_interval

    def add_operating_state(self):
        topic = _State(self._ral)
        commands = self._ral.publisher("state_command", crtk_msgs.msg.StringStamped, latch=True)

        def wait_until(true, timeout):
            end = time.monotonic() + timeout
            while True:
                topic.event.clear()
                if true():
                    return True
                left = end - time.monotonic()
                if left <= 0.0 or not topic.event.wait(left):
                    return true()

        def state_command(text):
            topic.event.clear()
            commands.publish(crtk_msgs.msg.StringStamped(string=text))

        def wait_for_busy(is_busy=False, start_time=None, timeout=30.0):
            # As since 1.2: the device must have said busy after the command, even if it was busy before.
            start = start_time or rospy.Time.now()

            def reached():
                was_busy = topic.busy_time > start
                return was_busy if is_busy else was_busy and not topic.data.is_busy

            return wait_until(reached, timeout)

        def go(text, state, timeout):
            state_command(text)
            return wait_until(lambda: topic.data.state == state, timeout)

        def home(timeout=0):
            state_command("home")
            return wait_until(lambda: topic.data.is_homed and not topic.data.is_busy, timeout)

        self._to.operating_state = lambda: topic.data.state
        self._to.state_command = state_command
        self._to.wait_for_busy = wait_for_busy
        self._to.wait_for_operating_state = lambda state, timeout: wait_until(
            lambda: topic.data.state == state, timeout
        )
        self._to.enable = lambda timeout=0: go("enable", "ENABLED", timeout)
        self._to.disable = lambda timeout=0: go("disable", "DISABLED", timeout)
        self._to.home = home
        self._to.is_homed = lambda: topic.data.is_homed
        self._to.is_busy = lambda: topic.data.is_busy

    def _add_js(self, name):
        topic = _Topic(self._ral, name, sensor_msgs.msg.JointState)
        for suffix, field in (("jp", "position"), ("jv", "velocity"), ("jf", "effort")):

            def read(age=None, wait=None, field=field):
                return numpy.array(getattr(topic.valid(self._interval, age, wait), field))

            setattr(self._to, name.replace("js", suffix), read)
        setattr(self._to, name, lambda age=None, wait=None: topic.valid(self._interval, age, wait))

    def _add_cp(self, name):
        topic = _Topic(self._ral, name, geometry_msgs.msg.PoseStamped)
        setattr(
            self._to, name, lambda age=None, wait=None: frame_from_pose(topic.valid(self._interval, age, wait).pose)
        )

    def add_measured_js(self):
        self._add_js("measured_js")

    def add_setpoint_js(self):
        self._add_js("setpoint_js")

    def add_measured_cp(self):
        self._add_cp("measured_cp")

    def add_setpoint_cp(self):
        self._add_cp("setpoint_cp")

    def add_jacobian(self):
        latest = []
        self._ral.subscriber("jacobian", std_msgs.msg.Float64MultiArray, lambda m: latest.__setitem__(slice(None), [m]))

        def jacobian():
            message = latest[0]
            return numpy.array(message.data).reshape(message.layout.dim[0].size, message.layout.dim[1].size)

        self._to.jacobian = jacobian

    def _add_joint_command(self, name, waits):
        publisher = self._ral.publisher(name, sensor_msgs.msg.JointState)

        def command(values):
            handle = WaitMoveHandle(self._to) if waits else None
            publisher.publish(sensor_msgs.msg.JointState(position=numpy.asarray(values).tolist()))
            return handle

        setattr(self._to, name.replace("/", "_"), command)

    def _add_pose_command(self, name, waits):
        publisher = self._ral.publisher(name, geometry_msgs.msg.PoseStamped)

        def command(frame):
            handle = WaitMoveHandle(self._to) if waits else None
            publisher.publish(geometry_msgs.msg.PoseStamped(pose=pose_from_frame(frame)))
            return handle

        setattr(self._to, name, command)

    def add_servo_jp(self):
        self._add_joint_command("servo_jp", waits=False)

    def add_servo_jr(self):
        self._add_joint_command("servo_jr", waits=False)

    def add_servo_cp(self):
        self._add_pose_command("servo_cp", waits=False)

    def add_move_jp(self):
        self._add_joint_command("move_jp", waits=True)

    def add_move_jr(self):
        self._add_joint_command("move_jr", waits=True)

    def add_move_cp(self):
        self._add_pose_command("move_cp", waits=True)

    def add_measured_cf(self):
        topic = _Topic(self._ral, "measured_cf", geometry_msgs.msg.WrenchStamped)
        self._to.measured_cf = lambda age=None, wait=None: topic.valid(self._interval, age, wait).wrench

    def add_servo_cf(self):
        publisher = self._ral.publisher("servo_cf", geometry_msgs.msg.WrenchStamped)
        self._to.servo_cf = lambda wrench: publisher.publish(geometry_msgs.msg.WrenchStamped(wrench=wrench))

    def add_forward_kinematics(self):
        service = self._ral.service("forward_kinematics", crtk_msgs.srv.QueryForwardKinematics)

        def forward(jp):
            request = crtk_msgs.srv.QueryForwardKinematicsRequest(jp=numpy.asarray(jp).tolist())
            response = service.call(request)
            return frame_from_pose(response.cp), response.result, response.message

        self._to.forward_kinematics = forward

    def add_inverse_kinematics(self):
        service = self._ral.service("inverse_kinematics", crtk_msgs.srv.QueryInverseKinematics)

        def inverse(jp, cp):
            request = crtk_msgs.srv.QueryInverseKinematicsRequest(jp=numpy.asarray(jp).tolist(), cp=pose_from_frame(cp))
            response = service.call(request)
            return numpy.array(response.jp), response.result, response.message

        self._to.inverse_kinematics = inverse


class Arm:
    """What a user's script makes of it."""

    def __init__(self, name, expected_interval=0.02):
        self.ral = Ral(name)
        utils = Utils(self, self.ral, expected_interval)
        for add in [getattr(utils, name) for name in dir(utils) if name.startswith("add_")]:
            add()


class DvrkArm(Arm):
    """The same with what dvrk_python expects of a dVRK beside CRTK; jaw: as its PSMs have."""

    def __init__(self, name, expected_interval=0.02, *, jaw=True):
        super().__init__(name, expected_interval)
        self.rals = [self.ral]
        self.local = self._part(name, "local", ("measured_cp", "setpoint_cp", "forward_kinematics"), expected_interval)
        for space in ("body", "spatial"):
            setattr(self, space, self._part(name, space, ("measured_cf", "servo_cf", "jacobian"), expected_interval))
        switches = ["body/set_cf_orientation_absolute", "use_gravity_compensation"]
        if jaw:
            parts = ("measured_js", "setpoint_js", "servo_jp", "move_jp")
            self.jaw = self._part(name, "jaw", parts, expected_interval)
            self.jaw.wait_for_busy = self.wait_for_busy
            switches.append("emulate_tool_present")
        self.switches = {topic: self.ral.publisher(topic, std_msgs.msg.Bool, latch=True) for topic in switches}
        self.ratio = None
        self.ral.subscriber("trajectory_j/ratio", std_msgs.msg.Float64, lambda m: setattr(self, "ratio", m.data))
        self._set_ratio = self.ral.publisher("trajectory_j/set_ratio", std_msgs.msg.Float64, latch=True)

    def _part(self, name, space, adds, expected_interval):
        part = type("Part", (), {})()
        self.rals.append(Ral(f"{name}/{space}"))
        utils = Utils(part, self.rals[-1], expected_interval)
        for add in adds:
            getattr(utils, f"add_{add}")()
        return part

    def check_connections(self, timeout_seconds=10.0):
        for ral in self.rals:
            ral.check_connections(timeout_seconds)

    def trajectory_j_set_ratio(self, ratio):
        self._set_ratio.publish(ratio)
