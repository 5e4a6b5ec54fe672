"""The pipeline gives the numbers of its laws stepped one by one in the order of the separate nodes."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from saras import displacement
from saras.collision import ProximityMonitor, RepulsiveForce
from saras.csa import Fixture, FixtureForce, FixtureIntegrator, TeleopFixture
from saras.net import ChannelState
from saras.pipeline import DistancesConfig, NearnessInput, Pipeline, PipelineConfig, PipelineInput
from saras.sim.exchange import TankNode
from saras.teleop import (
    DisturbanceObserver,
    FrameMapping,
    FrameMappingConfig,
    Transparency,
    TransparencyMode,
    TwistEstimator,
    VelocityIntegratorConfig,
)

SIDES = ("left", "right")
ROUNDING = 1e-9
TOLD = (
    "tracked_pose", "tracked_twist", "tracked_twist_filtered", "handle_twist", "desired_wrench", "desired_twist",
    "base_wrench", "touch_wrench", "twist", "set_point", "fixture_wrench", "fixture_distance_m",
)  # fmt: skip


def pose(random, size):
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.random(random_state=random).as_matrix()
    matrix[:3, 3] = random.uniform(-size, size, 3)
    return matrix


def walls(random):
    """Around the tips' paths, so that each is met by some."""
    tip, out = np.array([0.18, 0.0, -0.18]), random.normal(size=(3, 3))
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    made = [Fixture.plane(f"wall {i}", tip - random.uniform(0.0, 0.006) * n, n) for i, n in enumerate(out)]
    made.append(Fixture.path("guide", [tip - 0.02 * out[0], tip, tip + 0.02 * out[1]], 0.001, soft=True))
    return [TeleopFixture(fixture=fixture, start_m=random.uniform(0.0, 0.01)) for fixture in made]


def configuration(random, distances, fixtures):
    config = PipelineConfig(
        left_mapping=FrameMappingConfig(base_T_console=pose(random, 0.5), touch_T_console=pose(random, 0.1)),
        right_mapping=FrameMappingConfig(base_T_console=pose(random, 0.5), touch_T_console=pose(random, 0.1)),
        left_integrator=VelocityIntegratorConfig(shaft_through_rcm=True, dt_max_s=0.1),
        right_integrator=VelocityIntegratorConfig(dt_max_s=0.1),
        proximity_force=True,
        proximity_slowdown=True,
        observe=bool(random.integers(2)),
        session=1,
    )
    config.transparency.mode = list(TransparencyMode.__members__.values())[random.integers(3)]
    config.transparency.slave_lag_s = random.uniform(0.0, 0.05)
    config.tank_master.damping_min = config.tank_master.damping_max = np.zeros(6)
    config.tank_master.initial_J = random.uniform(0.03, 0.45)
    config.tank_slave.initial_J = random.uniform(0.03, 0.45)
    config.tank_slave.damping_min = 1e-3 * np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    config.tank_slave.damping_max = 3e-3 * np.array([1.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    config.tank_slave.conjugate_rate = np.full(6, 400.0)
    config.tank_slave.applied_limit = np.array([0.1, 0.1, 0.1, 1.0, 1.0, 1.0])
    config.tank_master.hold_s = config.tank_slave.hold_s = 0.012
    config.tank_master.dt_max_s = config.tank_slave.dt_max_s = 0.1
    if fixtures:
        config.left_fixtures, config.right_fixtures = walls(random), walls(random)
        config.fixture_force.ramp_s = random.uniform(0.01, 0.2)
    if distances:
        box = np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1], [0, 1, 0], [1, 1, 0], [1, 1, 1], [0, 1, 1.0]])
        config.distances = DistancesConfig(enabled=True, other_tools=1, regions=[0.1 * box - [0.0, 0.0, 0.3]])
    return config


class ReferenceSide:
    def __init__(self, config, side):
        self.config, self.side = config, side
        self.mapping = FrameMapping(getattr(config, f"{side}_mapping"))
        self.transparency, self.estimator = Transparency(config.transparency), TwistEstimator(config.slave_twist)
        self.observer, self.integrator = (
            DisturbanceObserver(config.observer),
            FixtureIntegrator(getattr(config, f"{side}_integrator"), getattr(config, f"{side}_fixtures")),
        )
        self.repulsion = RepulsiveForce(config.repulsion)
        self.fixtures = FixtureForce(config.fixture_force, getattr(config, f"{side}_fixtures"))
        self.hand_ahead = np.zeros(3)
        law = self.mapping.config
        self.touch_R_base = law.touch_T_console[:3, :3] @ law.base_T_console[:3, :3].T
        self.tracked = None
        self.twists = [np.zeros(6)] * 3
        self.observed = None
        self.slave_twist = np.zeros(6)
        self.desired_wrench, self.desired_twist = np.zeros(6), np.zeros(6)
        self.port = None
        self.mean_wrench, self.measured = None, np.zeros(6)
        self.set_point = None
        self.seen = 0
        self.since_command = 0.0

    def engage(self, channel):
        self.engaged = channel.state == ChannelState.ENGAGED and channel.age_s <= self.config.channel_timeout_s
        if self.engaged and channel.engagement != self.seen:
            self.seen = channel.engagement
            self.transparency.reset()
            self.integrator.reset()
            return True
        return False

    def observe(self, arm):
        """Work of the tip; None: nothing is known of it."""
        if arm.is_new:
            self.slave_twist = self.estimator.step(base_T_body=arm.base_T_tip, dt=arm.interval_s).twist_filtered
            if self.config.observe:
                out = self.observer.step(set_point=arm.target, measured=arm.base_T_tip[:3, 3], dt=arm.interval_s)
                self.observed = out.wrench if out.has_wrench else None
        self.wrench = self.observed if self.config.observe else arm.exerted_wrench
        if self.wrench is None or arm.age_s > self.config.arm_timeout_s:
            self.port, self.mean_wrench = None, None
            return None
        if self.port is None:
            self.port = (arm.base_T_tip, self.wrench)
            return None
        if not arm.is_new:
            return 0.0 if self.mean_wrench is not None else None
        moved = displacement(self.port[0], arm.base_T_tip)
        self.mean_wrench, self.measured = 0.5 * (self.port[1] + self.wrench), moved / arm.interval_s
        self.port = (arm.base_T_tip, self.wrench)
        return float(self.mean_wrench @ moved)

    def command(self, handle, arm, clutch, near, word, dt):
        self.since_command += dt
        fresh = arm.age_s <= self.config.arm_timeout_s
        self.felt = self.fixtures.step(
            base_T_tip=arm.base_T_tip,
            dt=dt,
            hand_ahead=self.hand_ahead,
            fixtures_on=word.on,
            fixtures_known=word.known and fresh,
        )
        out = self.mapping.step(console_T_handle=handle.simball_T_handle, dt=dt, clutch=handle.clutch)
        if out.has_pose:
            self.tracked = out.tracked_pose
            self.twists = [out.tracked_twist, out.tracked_twist_filtered, out.handle_twist]
        if self.tracked is None or not (out.has_pose or not self.engaged):
            return
        interval, self.since_command = self.since_command, 0.0
        push = self.repulsion.step(distance_m=near.distance_m, normal=near.approach_direction, dt=interval).wrench
        asked = self.transparency.step(
            master_pose=self.tracked,
            master_twist=self.twists[0],
            master_twist_filtered=self.twists[1],
            slave_pose=arm.base_T_tip,
            slave_twist=self.slave_twist,
            tissue_wrench=np.full(6, np.nan) if self.port is None else self.wrench,
            rcm=arm.rcm,
            clutch=clutch or handle.clutch,
            guidance_wrench=push + self.felt.wrench,
            stale=not self.engaged or arm.age_s > self.config.arm_timeout_s,
            dt=interval,
        )
        self.desired_wrench, self.desired_twist = asked.desired_wrench, asked.desired_twist
        self.hand_ahead = -asked.error[:3]

    def move(self, twist, arm, near, word, dt):
        if self.engaged and arm.age_s <= self.config.arm_timeout_s:
            out = self.integrator.step(
                twist=twist,
                measured_pose=arm.base_T_tip,
                rcm=arm.rcm,
                dt=dt,
                max_speed_scale=near.max_speed_scale,
                approach_direction=near.approach_direction,
                approach_speed_limit_m_s=near.approach_speed_limit_m_s,
                fixtures_on=word.on,
                fixtures_known=word.known,
            )
            self.set_point = out.set_point if out.has_set_point else None


class Reference:
    """All of it, as the nodes do it, in one process."""

    def __init__(self, config):
        self.config = config
        self.sides = [ReferenceSide(config, side) for side in SIDES]
        self.master = TankNode(config.tank_master, 2, 3, config.peer_timeout_s)
        self.slave = TankNode(config.tank_slave, 2, 1, config.peer_timeout_s)
        self.master.tank.reset()
        self.slave.tank.reset()
        distances = config.distances
        self.monitor = ProximityMonitor(distances.monitor, 3, distances.regions) if distances.enabled else None

    def near(self, values):
        if self.monitor is None:
            return [values.left.nearness, values.right.nearness]
        scene, tools = values.scene, []
        for side in SIDES:
            arm, world_T_base = getattr(values, side).arm, getattr(scene, f"{side}_world_T_base")
            ends = [world_T_base[:3, :3] @ p + world_T_base[:3, 3] for p in (arm.base_T_tip[:3, 3], arm.rcm)]
            known = arm.age_s <= self.config.arm_timeout_s
            tools.append((*ends, self.config.distances.radius_m) if known else None)
        other = scene.others[0]
        tools.append((other[:3], other[3:6], other[6]))
        out = self.monitor.step(tools=tools, dt=1e-3, base_T_regions=scene.world_T_regions).tools
        return [
            NearnessInput(
                max_speed_scale=tool.max_speed_scale,
                approach_direction=getattr(scene, f"{side}_world_T_base")[:3, :3].T @ tool.approach_direction,
                approach_speed_limit_m_s=tool.approach_speed_limit_m_s,
                distance_m=tool.known.distance,
            )
            for side, tool in zip(SIDES, out)
        ]

    def step(self, values, dt):
        inputs = [values.left, values.right]
        if any([side.engage(i.channel) for side, i in zip(self.sides, inputs)]):
            for node in (self.master, self.slave):
                node.tank.grant(max(0.0, node.tank.config.initial_J - node.tank.state.energy_J))
        nearness = self.near(values)
        work = []
        for k, (side, i) in enumerate(zip(self.sides, inputs)):
            work.append(side.observe(i.arm))
            side.command(i.handle, i.arm, i.channel.clutch, nearness[k], i.fixtures, dt)
            peer = self.master.peers[k]
            ledger = i.handle.ledger
            peer._credit_J += peer._receiver.credit(ledger.session, ledger.seq, ledger.sent_J)
            peer._requesting, peer._has_room, peer._heard_at = ledger.requesting, ledger.has_room, 0.0
        known = [side.tracked is not None for side in self.sides]
        zero = np.zeros(6)
        out = self.master.step(
            np.array([side.desired_wrench if k else zero for side, k in zip(self.sides, known)]),
            np.array([side.twists[2] if k else zero for side, k in zip(self.sides, known)]),
            dt,
            0.0,
            work_J=0.0,
            stale=not any(known),
        )
        self.slave.peers[0].receive(self.master.messages()[-1], 0.0)
        live = [w is not None and side.engaged for side, w in zip(self.sides, work)]
        passed = self.slave.step(
            np.array([side.desired_twist if a else zero for side, a in zip(self.sides, live)]),
            np.array([side.mean_wrench if a else zero for side, a in zip(self.sides, live)]),
            dt,
            0.0,
            work_J=sum(w for w in work if w is not None),
            measured=np.array([side.measured if a else zero for side, a in zip(self.sides, live)]),
            stale=not any(live),
        )
        self.master.peers[-1].receive(self.slave.messages()[0], 0.0)
        told = []
        for k, (side, i) in enumerate(zip(self.sides, inputs)):
            twist = passed.applied[k] if live[k] else zero
            side.move(twist, i.arm, nearness[k], i.fixtures, dt)
            wrench = out.applied[k]
            told.append(
                {
                    "tracked_pose": side.tracked,
                    "tracked_twist": side.twists[0],
                    "tracked_twist_filtered": side.twists[1],
                    "handle_twist": side.twists[2],
                    "desired_wrench": side.desired_wrench,
                    "desired_twist": side.desired_twist,
                    "base_wrench": wrench,
                    "touch_wrench": np.concatenate((side.touch_R_base @ wrench[:3], side.touch_R_base @ wrench[3:])),
                    "twist": twist,
                    "set_point": side.set_point,
                    "fixture_wrench": side.felt.wrench,
                    "fixture_distance_m": side.felt.distance_m,
                }
            )
        return told


def told_by(side, field):
    """A field of the pipeline's output."""
    return getattr(side.fixtures, field[8:]) if field.startswith("fixture_") else getattr(side, field)


def drive(values, random, k, rates):
    """The inputs of tick k: hands on smooth paths, arms somewhere near, forces, ledgers, words of the supervisor."""
    t = 0.01 * k
    for n, name in enumerate(SIDES):
        side = getattr(values, name)
        handle, arm, channel = side.handle, side.arm, side.channel
        matrix = np.eye(4)
        matrix[:3, :3] = Rotation.from_rotvec([0.2 * np.sin(t + n), 0.1 * np.cos(2 * t), 0.3 * np.sin(t)]).as_matrix()
        matrix[:3, 3] = [0.02 * np.cos(3 * t), 0.02 * np.sin(2 * t + n), -0.2 + 0.01 * np.sin(t)]
        handle.simball_T_handle, handle.is_new, handle.age_s = matrix, True, 0.0
        handle.clutch = k % 50 > 45
        ledger = handle.ledger
        ledger.session, ledger.seq = 5, k + 1
        ledger.sent_J += random.uniform(0.0, 1e-3)
        ledger.requesting, ledger.has_room = bool(random.integers(2)), bool(random.integers(2))
        arm.is_new = k % rates[n] == 0
        if arm.is_new:
            tip = np.diag([1.0, -1.0, -1.0, 1.0])
            tip[:3, 3] = [0.18 + 0.005 * np.sin(t), 0.005 * np.cos(t), -0.18 + 0.004 * np.sin(2 * t)]
            arm.base_T_tip, arm.interval_s = tip, 0.01 * rates[n]
            arm.target = tip[:3, 3] + random.uniform(-1e-3, 1e-3, 3)
            arm.exerted_wrench = random.uniform(-2.0, 2.0, 6)
        arm.age_s, arm.wrench_age_s = (0.0, 0.0) if k % 40 < 36 or n else (0.3, 0.3)
        arm.has_rcm, arm.rcm = True, np.array([0.18, 0.0, -0.10])
        channel.age_s = 0.0
        channel.state = ChannelState.ENGAGED if k % 60 > 5 else ChannelState.HOLD
        channel.engagement, channel.clutch = 1 + k // 60, k % 50 > 46
        near = random.normal(size=3)
        side.nearness = NearnessInput(
            age_s=0.0,
            max_speed_scale=random.uniform(0.2, 1.0),
            approach_direction=near / np.linalg.norm(near),
            approach_speed_limit_m_s=random.uniform(0.0, 0.1),
            distance_m=random.uniform(0.0, 0.02),
        )
        side.fixtures.on, side.fixtures.known = k % 30 < 25, k % 70 < 65
    values.scene.age_s = 0.0


@given(st.integers(0, 2**32 - 1), st.booleans(), st.booleans())
def test_pipeline_equals_its_laws(seed, distances, fixtures):
    random = np.random.default_rng(seed)
    config = configuration(random, distances, fixtures)
    values = PipelineInput()
    scene = values.scene
    scene.left_base_known = scene.right_base_known = scene.regions_known = True
    scene.left_world_T_base, scene.right_world_T_base = pose(random, 0.3), pose(random, 0.3)
    scene.world_T_regions = pose(random, 0.3)
    scene.others = np.array([[0.1, 0.1, -0.2, 0.1, 0.1, 0.0, 0.004]])
    pipeline, reference = Pipeline(config), Reference(config)
    rates = random.integers(1, 5, 2)
    engaged = False
    for k in range(75):
        drive(values, random, k, rates)
        dt = random.uniform(0.002, 0.012)
        out, told = pipeline.step(values, dt), reference.step(values, dt)
        for name, wanted in zip(SIDES, told):
            got = getattr(out, name)
            engaged |= got.state == ChannelState.ENGAGED and bool(np.any(got.twist))
            for field in TOLD:
                if wanted[field] is None:
                    continue
                np.testing.assert_allclose(
                    told_by(got, field), wanted[field], atol=ROUNDING, rtol=ROUNDING, err_msg=f"{name}.{field} at {k}"
                )
        for tank, node in ((out.tank_master, reference.master), (out.tank_slave, reference.slave)):
            np.testing.assert_allclose(tank.energy_J, node.tank.state.energy_J, atol=ROUNDING)
            np.testing.assert_allclose(tank.sent_J, node.tank.state.sent_J, atol=ROUNDING)
    assert engaged
