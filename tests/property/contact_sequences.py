"""Seeded sequences in which an instrument presses on simulated tissue, for stereo_contact's tests and benchmark."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from saras.sim.endoscope import Room, StereoPair, StereoRenderer, ToolState
from saras.stereo_contact import ContactEstimate, StereoContact, StereoContactConfig, Tool

FRAME_S = 0.1
FRAMES = 26
STIFFNESS_N_M = 300.0  # of the phantom away from its inclusion: config/tissue, docs/figures
RANGE_M = 0.010  # the deepest that the sequences press: the range of the force is that times the stiffness
RADII = {"mesa_left": 0.0025, "mesa_right": 0.0025, "PSM1": 0.0042, "PSM2": 0.0042}


@dataclass(frozen=True)
class Moment:
    """One frame and what is true in it."""

    time_s: float
    pair: StereoPair
    world_T_left: np.ndarray
    tools: dict[str, ToolState]
    depth_m: float
    normal: np.ndarray


def looking(at: np.ndarray, distance: float, elevation: float, azimuth: float, roll: float) -> np.ndarray:
    """(4, 4) camera that looks at a point from a distance, elevation over the horizon."""
    c, s = np.cos(elevation), np.sin(elevation)
    away = np.array([c * np.cos(azimuth), c * np.sin(azimuth), s])
    z = -away
    x = np.cross(z, [0.0, 0.0, 1.0])
    x /= np.linalg.norm(x)
    y = np.cross(z, x)
    turn = np.column_stack([np.cos(roll) * x + np.sin(roll) * y, np.cos(roll) * y - np.sin(roll) * x, z])
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = turn, at + distance * away
    return pose


def moments(renderer: StereoRenderer, seed: int) -> Iterator[Moment]:
    """Come near, press up to 10 mm, slide a little, come away; three other tools stand about. The camera drifts."""
    rng = np.random.default_rng([seed, 77])
    surface = renderer.room.surface
    to_world = surface.world_T_surface
    spot = np.array([*(rng.uniform(-0.35, 0.35, 2) * surface.size_m), 0.0])
    azimuth = rng.uniform(-0.6, 0.6)
    distance, elevation = rng.uniform(0.07, 0.15), rng.uniform(0.5, 1.2)
    aside = np.append(rng.uniform(-0.012, 0.012, 2), 0.0)
    roll, drift = rng.uniform(-0.3, 0.3), rng.normal(0.0, 0.02, 3)
    lean = rng.uniform(0.3, 0.8)
    # From where the assistant stands: not out of the camera's own direction, where the shaft would hide its tip.
    side = azimuth + rng.choice([-1.0, 1.0]) * rng.uniform(1.2, 2.8)
    trocar = spot + 0.12 * np.array([np.sin(lean) * np.cos(side), np.sin(lean) * np.sin(side), np.cos(lean)])
    deepest, slide = rng.uniform(0.004, RANGE_M), np.append(rng.uniform(-0.006, 0.006, 2), 0.0)
    others = {}
    for name in ("mesa_right", "PSM1", "PSM2"):
        angle = azimuth + rng.uniform(1.0, 5.2)
        tip = (
            spot
            + rng.uniform(0.025, 0.05) * np.array([np.cos(angle), np.sin(angle), 0.0])
            + np.array([0.0, 0.0, 0.012])
        )
        others[name] = ToolState.straight(
            place(to_world, tip), place(to_world, tip + 0.08 * np.array([np.cos(angle), np.sin(angle), 1.0]))
        )
    for i in range(FRAMES):
        share = i / (FRAMES - 1)
        press = np.clip(np.sin(np.pi * np.clip((share - 0.15) / 0.75, 0.0, 1.0)), 0.0, 1.0)
        depth = -0.006 + (deepest + 0.006) * press
        over = spot + share * slide
        tip = over + np.array([0.0, 0.0, float(surface.height(over[None, :2])[0]) - depth])
        world_tip = place(to_world, tip)
        camera = to_world @ looking(
            spot + aside,
            distance + 0.1 * share * drift[0],
            elevation + share * drift[1],
            azimuth + share * drift[2],
            roll,
        )
        tools = {"mesa_left": ToolState.straight(world_tip, place(to_world, trocar)), **others}
        pair = renderer.render(camera, tools)
        yield Moment(i * FRAME_S, pair, camera, tools, surface.depth(world_tip), surface.normal(world_tip))


def place(frame_T: np.ndarray, point: np.ndarray) -> np.ndarray:
    return (frame_T @ [*point, 1.0])[:3]


@dataclass(frozen=True)
class Seen:
    """An estimate beside the truth."""

    estimate: ContactEstimate
    depth_m: float
    normal: np.ndarray

    @property
    def force_error(self) -> float:
        """Share of the range; NaN: unknown."""
        return (max(0.0, self.estimate.depth_m) - max(0.0, self.depth_m)) / RANGE_M if self.estimate.known else np.nan


def watch(
    renderer: StereoRenderer, sequence: list[Moment], offset: np.ndarray, config: StereoContactConfig | None = None
) -> list[Seen]:
    """What the estimator says of the left arm when its calibration puts all its tips off by offset (3,) [m]."""
    camera = renderer.camera
    estimator = StereoContact(config or StereoContactConfig(), camera.left, camera.right)
    seen = []
    for moment in sequence:
        tools = {
            name: Tool(state.tip + offset, state.trocar + offset, RADII[name]) for name, state in moment.tools.items()
        }
        found = estimator.estimate(
            moment.pair.left, moment.pair.right, moment.world_T_left, tools, moment.time_s, ("mesa_left",)
        )
        seen.append(Seen(found["mesa_left"], moment.depth_m, moment.normal))
    return seen


def curved(room: Room, curvature_1_m: float) -> Room:
    """The same room with a surface that bulges (> 0) or hollows."""
    return replace(room, surface=replace(room.surface, curvature_1_m=curvature_1_m))
