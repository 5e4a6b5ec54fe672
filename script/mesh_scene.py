"""Drawn shapes of what does not move, in world [m]."""

from __future__ import annotations

import numpy as np
from mesh_primitives import box, loft, move, superellipse


def scene_meshes(scene):
    """Table, desk, torso, phantom; in world, except that the torso's origin is on the table."""
    table, desk, phantom, torso = (scene[key] for key in ("table", "desk", "phantom", "torso"))
    (length, width, thick), top = table["size_m"], table["center_m"][2] + table["size_m"][2] / 2
    centre, floor = np.array(table["center_m"]), table["floor_m"]
    pads = ((-0.30, 0.40), (0.12, 0.44), (0.425, 0.15))
    yield (
        "table_pads",
        [
            move(
                box((share * length - 0.01, width, 0.6 * thick), 0.015), (centre[0] + at * length, 0, top - 0.3 * thick)
            )
            for at, share in pads
        ],
    )
    under = top - 0.6 * thick
    yield (
        "table_frame",
        [
            move(box((length - 0.04, width - 0.04, 0.4 * thick), 0.008), (centre[0], 0, under - 0.2 * thick)),
            *[
                move(box((length - 0.1, 0.012, 0.026), 0.003), (centre[0], side * (width / 2 + 0.016), under))
                for side in (-1, 1)
            ],
            move(box((0.30, 0.22, under - floor - 0.10), 0.03), (centre[0], 0, (under + floor + 0.06) / 2)),
            move(box((0.90, 0.40, 0.08), 0.03), (centre[0], 0, floor + 0.04)),
        ],
    )
    yield "desk_top", [move(box(desk["size_m"], 0.012), desk["center_m"])]
    x, _, z = desk["center_m"]
    wide = desk["size_m"][1]
    yield (
        "desk_legs",
        [
            *[
                move(box((0.06, 0.05, z - floor), 0.012), (x, side * (wide / 2 - 0.12), (z + floor) / 2))
                for side in (-1, 1)
            ],
            *[move(box((0.42, 0.07, 0.03), 0.01), (x, side * (wide / 2 - 0.12), floor + 0.015)) for side in (-1, 1)],
            move(box((0.03, wide - 0.3, 0.10), 0.008), (x, 0, z - 0.12)),
        ],
    )
    yield "phantom", [move(box(phantom["size_m"], 0.012), phantom["center_m"])]
    yield "torso", [torso_shell(torso)]


# (part of the length, part of the half width, part of the height, exponent), from the thighs to the neck
TORSO_SECTIONS = [
    (-0.555, 0.30, 0.20, 2.4),
    (-0.545, 0.52, 0.38, 2.4),
    (-0.52, 0.70, 0.53, 2.5),
    (-0.48, 0.84, 0.65, 2.6),
    (-0.43, 0.94, 0.74, 2.6),
    (-0.36, 0.99, 0.84, 2.6),
    (-0.24, 0.98, 0.95, 2.5),
    (-0.08, 0.95, 1.00, 2.5),
    (0.08, 0.96, 0.99, 2.5),
    (0.20, 1.00, 0.95, 2.5),
    (0.31, 1.03, 0.91, 2.6),
    (0.38, 1.00, 0.83, 2.6),
    (0.43, 0.84, 0.70, 2.4),
    (0.455, 0.52, 0.56, 2.2),
    (0.47, 0.34, 0.46, 2.0),
    (0.53, 0.30, 0.42, 2.0),
    (0.55, 0.20, 0.30, 2.0),
]


def torso_shell(torso):
    """A body lying on its back, from the thighs to the neck: superellipses along x."""
    half, height, length = torso["half_width_m"], torso["height_m"], torso["length_m"]
    sections = np.array(TORSO_SECTIONS)
    fine = np.linspace(sections[0, 0], sections[-1, 0], 37)
    smooth = [np.interp(fine, sections[:, 0], sections[:, k]) for k in (1, 2, 3)]
    rings = []
    for s, w, h, n in zip(fine, *smooth):
        ring = superellipse(w * half, 0.5 * h * height, n)
        rings.append(
            np.column_stack([np.full(len(ring), s * length), ring[:, 0], (0.45 + 0.05 * h) * h * height + ring[:, 1]])
        )
    return move(loft(rings), torso["center_m"])
