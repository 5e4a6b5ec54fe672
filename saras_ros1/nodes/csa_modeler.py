"""csa_modeler: learns stiffness and surface from the slave's touch, lays a prior mesh to it, says where to go next.

Subscribes /csa/slave/measured_cp, measured_cv, measured_cf (equal stamps) and /csa/modeler/roi; gives
/csa/modeler/state, stiffness and mesh (all vertices), touched (those near the tip, faster) and next_location.
"""

from __future__ import annotations

import math
import os
import threading
from typing import Callable

import numpy as np
import rospy
from geometry_msgs.msg import PointStamped, PolygonStamped
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger, TriggerResponse
from visualization_msgs.msg import Marker

from saras import ConfigError, ModelError
from saras.model import StiffnessGpConfig
from saras.model.live import Bending, LiveMap, Snapshot
from saras.model.region import Region
from saras.runtime import ModelHostConfig, VertexMapConfig
from saras_ros1 import modeler_messages as messages
from saras_ros1.csa_node import CsaNode, vector
from saras_ros1.modeler_explorer import Explorer
from saras_ros1.modeler_keeping import Keeping
from saras_ros1.modeler_prior import prior_mesh
from saras_ros1.modeler_samples import Samples
from saras_ros1.modeler_status import Pace, SampleStatus
from saras_ros1.msg import CsaModelerState
from saras_ros1.node import run
from saras_ros1.params import Params
from saras_ros1.srv import KeepModel, SetRegion, SetRegionResponse

HYPER_GROWTH = 1.3  #: places since the last time, above which hyper-parameters are learned again


class CsaModeler(CsaNode):
    """Two C++ threads learn and ask; a thread each here shows, bends and plans, by C++ without the GIL."""

    def __init__(self) -> None:
        os.nice(5)  # when the processor is short, control goes before maps
        super().__init__("csa_modeler")
        p = self.params
        rates = p.section("rates")
        config = ModelHostConfig(
            law=p.build(StiffnessGpConfig, "law"),
            vertices=p.build(VertexMapConfig, "vertices"),
            free_m=p.number("free_m", 0.0, 0.1),
            near_m=p.number("touched_radius_m", 1e-4, 0.05),
            touched_hz=rates.number("touched_hz", 1e-1, 200.0),
            map_hz=rates.number("map_hz", 1e-3, 200.0),
            room=p.integer("room", 10, 100_000),
        )
        prior = p.section("prior")
        mesh = prior_mesh(self.setup, prior.number("half_width_m", 2e-3, 0.5), prior.integer("vertices", 9, 200_000))
        self.live = LiveMap(mesh, config, _bending(p.section("bending")))
        self.samples = Samples(self, p.text("source"), self.frame, p.number("stale_s", 0.05, 10.0), self.live.push)
        self.said = SampleStatus(config.law)
        colours = p.section("colours")
        self.colours = tuple(colours.number(n, 1e-3, 1e6) for n in ("low_N_m", "high_N_m", "faded_std_N_m"))
        if self.colours[0] >= self.colours[1]:
            raise ConfigError(f"{self.name}/colours/low_N_m = {self.colours[0]:g}: must be below high_N_m")
        self._exploring(p.section("exploring"))
        self.known: Snapshot | None = None
        self.bent_rms_m, self.learned_places = math.nan, 0
        self.fault, self.status = "", "STALE: nothing yet"
        self.pace, self.touched_hz = Pace(), 0.0
        self.region: Region | None = None
        self.keeping = threading.Lock()
        self._set_region(np.zeros((0, 3)))
        self._outputs()
        self.idle: list[threading.Lock] = []
        for period_s, callback in (
            (1.0 / config.touched_hz, self._show_touched),
            (1.0 / config.map_hz, self._show_all),
            (1.0 / rates.number("bend_hz", 1e-3, 200.0), self._bend),
            (1.0 / rates.number("plan_hz", 1e-3, 200.0), self._plan),
            (1.0 / rates.number("hyperparameters_hz", 1e-3, 200.0), self._hyperparameters),
            (1.0 / rates.number("state_hz", 1e-3, 200.0), self._tell),
        ):
            self._work(period_s, callback)
        self.live.start()

    def _work(self, period_s: float, callback: Callable[[], None]) -> None:
        idle = threading.Lock()
        self.idle.append(idle)

        def work() -> None:
            with idle:
                callback()

        self.every(period_s, work)

    def run(self) -> None:
        """Ends only when no thread computes: the interpreter must not go away under one."""
        super().run()
        self.live.stop()
        for idle in self.idle:
            idle.acquire(timeout=5.0)

    def _exploring(self, p: Params) -> None:
        options = {
            "cost": p.text("cost"),
            "corners": p.integer("corners", 1, 10),
            "step_m": p.number("step_m", 1e-3, 0.2),
            "spacing_m": p.number("spacing_m", 1e-4, 0.1),
            "time_limit_s": p.number("time_limit_s", 1e-3, 60.0),
            "seed": p.integer("seed", 1, 2**31),
        }
        self.cost = options["cost"]
        self.border_m = p.number("border_m", 0.0, 0.1)
        self.explorer = Explorer(self.live, p.number("reach_m", 1e-4, 0.05), p.number("timeout_s", 0.1, 600.0), options)
        # Refuses an unknown cost now, not when the first path is drawn.
        from saras.model.exploring import find_cost

        find_cost(self.cost)

    def _outputs(self) -> None:
        self.state_out = self.output("/csa/modeler/state", CsaModelerState)
        self.cloud_out = self.output("/csa/modeler/stiffness", PointCloud2)
        self.touched_out = self.output("/csa/modeler/touched", PointCloud2)
        self.mesh_out = self.output("/csa/modeler/mesh", Marker)
        self.next_out = self.output("/csa/modeler/next_location", PointStamped)
        rospy.Subscriber("/csa/modeler/roi", PolygonStamped, self._on_region, queue_size=5)
        rospy.Service("/csa/modeler/set_region", SetRegion, self._on_set_region)
        rospy.Service("/csa/modeler/reset", Trigger, self._on_reset)
        keeping = Keeping(self.live, self.keeping, self._forgotten)
        rospy.Service("/csa/modeler/save", KeepModel, keeping.save)
        rospy.Service("/csa/modeler/load", KeepModel, keeping.load)

    # ---- threads

    def _show_touched(self) -> None:
        touched = self.live.wait_touched(0.0)
        if touched is not None:
            known = touched.stiffness_N_m, touched.stiffness_std_N_m
            now = rospy.Time.now()
            self.touched_out.publish(messages.cloud(self.frame, now, touched.vertices, *known, touched.indices))

    def _show_all(self) -> None:
        laid = self.live.laid
        now, known = rospy.Time.now(), (laid.stiffness_N_m, laid.stiffness_std_N_m)
        self.cloud_out.publish(messages.cloud(self.frame, now, laid.vertices, *known))
        painted = messages.colours(*known, *self.colours)
        self.mesh_out.publish(messages.mesh_marker(self.frame, now, laid.vertices, laid.mesh.triangles, painted))

    def _bend(self) -> None:
        self.known = known = self.live.snapshot()
        if not len(known.grid):
            return
        try:
            rms_m = self.live.bend(known)
        except ModelError as error:
            self.fault = f"NOT_LAID: {error}"
            return
        self.fault = ""
        if rms_m is not None:
            self.bent_rms_m = rms_m

    def _plan(self) -> None:
        if not self.samples.tip.fresh:
            return
        there = self.explorer.next(self.region, self.known, self.samples.tip.value[:3, 3])
        if there is None:
            return
        message = PointStamped()
        message.header.stamp, message.header.frame_id = rospy.Time.now(), self.frame
        vector(message.point, there)
        self.next_out.publish(message)

    def _hyperparameters(self) -> None:
        places = self.live.statistics().places
        if places < HYPER_GROWTH * self.learned_places or places < 100:
            return
        try:
            self.live.learn_hyperparameters()
        except (ModelError, ImportError) as error:
            rospy.logwarn_throttle(60.0, f"{self.name}: hyper-parameters stay as they are: {error}")
        self.learned_places = places

    def _tell(self) -> None:
        now = self.live.statistics()
        self.said.count(now.verdicts)
        well, status = self.said.text(self.samples.missing(), float(np.linalg.norm(now.bias_N)), now.disagreement)
        if self.live.failure:
            well, status = False, f"FAILED: {self.live.failure}"
        if well and self.fault:
            well, status = False, self.fault
        self.status = status
        laid = self.live.laid
        message = CsaModelerState(status=status, well=well, samples=self.samples.heard, places=now.places)
        message.header.stamp, message.header.frame_id = rospy.Time.now(), self.frame
        message.learned, message.refused = self.said.learned, self.said.refused
        message.known_share = float(np.isfinite(laid.stiffness_N_m).mean())
        message.disagreement, message.bent_rms_m = now.disagreement, self.bent_rms_m
        vector(message.bias_N, now.bias_N)
        self.touched_hz = message.touched_hz = self.pace.rate_hz(now.refreshes)
        message.oldest_s_p99 = now.waits.quantile_ns(0.99) * 1e-9
        message.learning_s_p99 = now.learning.quantile_ns(0.99) * 1e-9
        message.waiting_dropped = now.dropped
        message.region, message.cost, message.cost_error = self.region is not None, self.cost, self.explorer.error
        self._tell_stiffest(message, laid)
        self.state_out.publish(message)
        if not well:
            rospy.logwarn_throttle(5.0, f"{self.name}: {status}")

    def _tell_stiffest(self, message: CsaModelerState, laid) -> None:
        message.stiffest_N_m = message.stiffest_std_N_m = math.nan
        vector(message.stiffest, np.full(3, np.nan))
        best = laid.stiffest(self.region)
        if best is not None:
            vector(message.stiffest, laid.vertices[best])
            message.stiffest_N_m = float(laid.stiffness_N_m[best])
            message.stiffest_std_N_m = float(laid.stiffness_std_N_m[best])

    # ---- what is asked for

    def _on_region(self, message: PolygonStamped) -> None:
        try:
            self._set_region(self._corners(message))
        except ConfigError as error:
            rospy.logerr(f"{self.name}: region refused: {error}")

    def _on_set_region(self, request) -> SetRegionResponse:
        try:
            self._set_region(self._corners(request.region))
        except ConfigError as error:
            return SetRegionResponse(False, str(error))
        return SetRegionResponse(True, f"{len(request.region.polygon.points)} points")

    def _corners(self, message: PolygonStamped) -> np.ndarray:
        points = np.array([(p.x, p.y, p.z) for p in message.polygon.points], dtype=float).reshape(-1, 3)
        if len(points) and message.header.frame_id.lstrip("/") != self.frame:
            raise ConfigError(f"frame_id '{message.header.frame_id}', must be '{self.frame}'")
        return points

    def _set_region(self, corners: np.ndarray) -> None:
        """No corners: the whole of an open mesh; nothing of a closed one."""
        mesh = self.live.laid.mesh
        self.region = Region(corners, mesh) if len(corners) else Region.whole(mesh, self.border_m)

    def _on_reset(self, _) -> TriggerResponse:
        with self.keeping:
            self.live.reset()
            self._forgotten()
        return TriggerResponse(True, "nothing is known")

    def _forgotten(self) -> None:
        self.said.reset()
        self.samples.heard = 0
        self.bent_rms_m, self.learned_places, self.known = math.nan, 0, None

    def report(self) -> dict:
        """What became of the samples, and how fast the map follows."""
        now = self.live.statistics()
        counts = {f"samples {name}": number for name, number in sorted(self.said.total.items())}
        return {
            "samples": self.status,
            **counts,
            **self.samples.counts,
            "waiting_dropped": now.dropped,
            "places": now.places,
            "touched_hz": f"{self.touched_hz:.1f}",
            "oldest_s_p99": f"{now.waits.quantile_ns(0.99) * 1e-9:.3f}",
            "learning_s_p99": f"{now.learning.quantile_ns(0.99) * 1e-9:.6f}",
            "plans": self.explorer.plans,
            "cost": self.explorer.error or self.cost,
        }


def _bending(p: Params) -> Bending:
    return Bending(
        shift_m=p.number("shift_m", 0.0, 1.0),
        turn_rad=p.number("turn_rad", 1e-4, 3.2),
        bent_m=p.number("bent_m", 1e-6, 0.1),
        spacing_m=p.number("spacing_m", 1e-3, 0.5),
        strain=p.number("strain", 1e-4, 10.0),
        travel_m=p.number("travel_m", 1e-5, 1.0),
        slide_m=p.number("slide_m", 1e-6, 0.1),
        points=p.integer("points", 10, 10_000),
        min_points=p.integer("min_points", 3, 10_000),
        surface_std_m=p.number("surface_std_m", 1e-6, 0.1),
    )


def main() -> int:
    """Runs the node."""
    return run(CsaModeler)
