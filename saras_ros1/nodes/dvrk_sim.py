"""dvrk_sim: stands in for PSM1, PSM2 and the ECM of a dVRK, its console and its pedals. config/dvrk.yaml, docs/dvrk.md.

One thread steps and publishes all arms; commands come in by their subscribers' threads and take the lock.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np
import rospy
from geometry_msgs.msg import PoseStamped

from saras import ConfigError
from saras.crtk import MODES, MotionLimits, SimulatedCrtkArm, StateMachine, Surgeon
from saras.crtk.playback import Playback
from saras.crtk.surgeon import joints_for_tip
from saras.kinematics import dvrk
from saras.kinematics import scene as scenes
from saras.recording.bag import Bag
from saras_ros1 import convert
from saras_ros1.channel import SIDES
from saras_ros1.dvrk_commands import Commands
from saras_ros1.dvrk_console import Console
from saras_ros1.dvrk_feedback import Feedback
from saras_ros1.latest import Latest
from saras_ros1.node import Node, run
from saras_ros1.params import Params

REFERENCES = ("base", "world", "ecm")
DT_MAX_S = 0.1
LOOK_EVERY = 10  # ticks between two looks at where the assistant's tools are


class Arm:
    """One simulated arm with its topics."""

    def __init__(self, node: DvrkSim, name: str, params: Params) -> None:
        kind = params.text("kind", ("psm", "ecm"))
        body = params.text("body", ("classic", "si"))
        jaw = None
        if kind == "psm":
            tool = dvrk.tool(params.text("tool"))
            kinematics: Any = dvrk.psm(f"{tool.name}:{tool.model}", body)
            jaw = (tool.jaw_lower_rad, tool.jaw_upper_rad)
        else:
            kinematics = dvrk.ecm(params.text("endoscope"), body)
        count = len(kinematics.limits)
        self.kind, self.reference = kind, params.text("reference", REFERENCES)
        self.world_T_base = node.scene.world_T(name)
        self.base_T_world = np.linalg.inv(self.world_T_base)
        self.home = params.vector("home_m", 3, -10.0, 10.0)
        limits = MotionLimits(
            params.vector("speed", count, 1e-3, 100.0), params.vector("acceleration", count, 1e-3, 1e4)
        )
        try:
            start = joints_for_tip(kinematics, self.base_T_world, self.home)
        except ValueError as error:
            raise ConfigError(f"{node.name}/{name}/home_m: {error}") from None
        if violation := kinematics.limit_violation(start):
            raise ConfigError(f"{node.name}/{name}/home_m = {self.home.tolist()}: out of reach: {violation}")
        machine = StateMachine("ENABLED", is_homed=True) if node.enabled else StateMachine()
        self.sim = SimulatedCrtkArm(name, kinematics, start, limits, jaw=jaw, machine=machine)
        self.frame = {"base": name, "world": "world", "ecm": "ECM_tool_tip"}[self.reference]
        self.playback: Playback | None = None
        self.feedback = Feedback(self.sim, node.old_names, node.display_every)
        self.commands = Commands(self.sim, node.lock, lambda: self.frame, self.set_base, node.old_names)

    def set_base(self, pose: np.ndarray, frame: str) -> None:
        """From now on measured_cp is in this frame; pose: frame_T_base."""
        self.reference, self.frame, self.sim.reference_T_base = "set", frame or self.sim.name, pose

    def update_reference(self, tip_T_world: np.ndarray | None) -> None:
        """tip_T_world: of the endoscope."""
        if self.reference == "world":
            self.sim.reference_T_base = self.world_T_base
        elif self.reference == "ecm" and tip_T_world is not None:
            self.sim.reference_T_base = tip_T_world @ self.world_T_base


class DvrkSim(Node):
    """All arms, stepped and published by one thread."""

    def __init__(self) -> None:
        super().__init__("dvrk_sim")
        rate_hz = self.params.number("rate_hz", 10.0, 1000.0)
        self.display_every = max(1, round(rate_hz / self.params.number("display_hz", 1.0, 60.0)))
        self.old_names = self.params.flag("old_names")
        self.enabled = self.params.text("state", ("ENABLED", "DISABLED")) == "ENABLED"
        self.scene = load_scene(self.params.text("scene_file"))
        names = self.params.texts("arms")
        self.arms = {name: Arm(self, name, self.params.section(name)) for name in names}
        for name in ("PSM1", "PSM2", "PSM3", "ECM"):  # the file may describe more arms than are wanted
            if name not in names and self.params.has(name):
                self.params.skip(name)
        self.ecm = next((arm for arm in self.arms.values() if arm.kind == "ecm"), None)
        for name, arm in self.arms.items():
            if arm.reference == "ecm" and (self.ecm is None or arm.kind == "ecm"):
                raise ConfigError(f"{self.name}/{name}/reference = 'ecm': needs another arm of kind ecm in arms")
        surgeon = self.params.section("surgeon")
        mode, seed = surgeon.text("mode", MODES), surgeon.integer("seed", 0, 2**31)
        homes = {name: arm.home for name, arm in self.arms.items()}
        self.surgeon = Surgeon(mode, seed, homes, surgeon.number("closest_m", 0.0, 0.1))
        self.resume_s = surgeon.number("resume_s", 0.0, 3600.0)
        self._load_bag(surgeon.text("bag", empty=True))
        self.console = Console(self, self.params.number("teleop_scale", 1e-3, 1.0), self.old_names)
        self.params.finish()
        self.tools: dict[str, Latest] = {}
        if mode == "meet":
            self.tools = {side: Latest(f"/mesa_{side}/ee_pose", PoseStamped) for side in SIDES}
        self._targets: dict[str, np.ndarray | None] = {}
        self._ticks, self._ticks_at_report, self._busy_s, self._worst_s = 0, 0, 0.0, 0.0
        self._time_s, self._last_s = 0.0, time.monotonic()
        with self.lock:
            self._update_references()
        self.console.press("console/operator_present", 1 if self.enabled else 0)
        self.every(1.0 / rate_hz, self.tick)

    def command_all(self, text: str) -> None:
        """A state command for all arms, as the console has for powering and homing."""
        with self.lock:
            for arm in self.arms.values():
                arm.commands.state_command(text)
                arm.commands.publish_events()

    def _load_bag(self, path: str) -> None:
        if not path:
            return
        bag = Bag(path)
        for name, arm in self.arms.items():
            arm.playback = Playback(bag, name, arm.sim.kinematics)
            rospy.loginfo(f"{self.name}: {name} plays {arm.playback.topic} of {path}")
        bag.close()

    def tick(self) -> None:
        """One step of all arms and what they publish."""
        begin = time.perf_counter()
        now = time.monotonic()
        with self.lock:
            dt, self._last_s = min(now - self._last_s, DT_MAX_S), now
            self._time_s = time.time() if self.surgeon.mode == "clap" else self._time_s + dt
            if self._ticks % LOOK_EVERY == 0 and self.surgeon.mode == "meet":
                self._look()
            for name, arm in self.arms.items():
                self._guide(name, arm)
                arm.sim.step(dt)
            self._update_references()
            stamp = rospy.Time.now()
            for arm in self.arms.values():
                arm.feedback.publish(arm.frame, stamp)
                arm.commands.publish_events()
        self._ticks += 1
        took = time.perf_counter() - begin
        self._busy_s += took
        self._worst_s = max(self._worst_s, took)

    def _guide(self, name: str, arm: Arm) -> None:
        """The surgeon's hands, unless someone else commands the arm."""
        sim = arm.sim
        commanded = sim.commanded_s > float("-inf")
        alone_s = sim.time_s - sim.commanded_s
        if sim.machine.is_busy or (commanded and (self.resume_s == 0.0 or alone_s < self.resume_s)):
            return
        if arm.playback is not None:
            sim.follow(arm.playback.joints(self._time_s))
            return
        tip = self.surgeon.tip(name, self._time_s, self._targets.get(name), self._targets.get("bones"))
        q = joints_for_tip(sim.kinematics, arm.base_T_world, tip)
        if self.surgeon.mode == "clap":
            sim.joints.put(q)  # a step: nothing follows behind
        elif not np.array_equal(q, sim.joints.q):
            sim.follow(q)

    def _look(self) -> None:
        """Where the assistant's tips are now, in world: the first PSM goes to the left one, the second to the right."""
        for name, side in (("PSM1", "left"), ("PSM2", "right")):
            message = self.tools[side].value()
            point = None
            if message is not None:
                world_T_sbs = self.scene.world_T(f"mesa_{side}/sbs_world")
                point = (world_T_sbs @ convert.pose(message))[:3, 3]
            self._targets[name] = point
        if "bones" not in self._targets:
            box = self.scene.bones
            top = np.append(box.center + box.size * [-0.1, 0.0, 0.5], 1.0)
            self._targets["bones"] = (self.scene.world_T("bones_marker_frame") @ top)[:3]

    def _update_references(self) -> None:
        tip_T_world = None
        if self.ecm is not None and any(arm.reference == "ecm" for arm in self.arms.values()):
            ecm = self.ecm
            tip_T_world = np.linalg.inv(ecm.world_T_base @ ecm.sim.kinematics.forward(ecm.sim.joints.q))
        for arm in self.arms.values():
            arm.update_reference(tip_T_world)

    def report(self) -> dict[str, Any]:
        """Rate and cost of a tick, and the arms' states."""
        ticks, self._ticks_at_report = self._ticks - self._ticks_at_report, self._ticks
        states = {name: arm.sim.machine.state for name, arm in self.arms.items()}
        mean_ms = 1e3 * self._busy_s / max(1, self._ticks)
        return {
            "rate_hz": ticks,
            "step_mean_ms": round(mean_ms, 3),
            "step_worst_ms": round(1e3 * self._worst_s, 3),
            **states,
        }


def load_scene(path: str) -> scenes.Scene:
    """The operating room; ConfigError names the file."""
    try:
        return scenes.load(path)
    except (OSError, ConfigError) as error:
        raise ConfigError(f"scene_file {path}: {error}") from None


def main() -> int:
    """Runs the node."""
    return run(DvrkSim)
