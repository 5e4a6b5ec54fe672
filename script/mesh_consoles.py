"""Drawn shapes of the hand piece and the Touch, each in the frame of its link [m]."""

from __future__ import annotations

import math

from mesh_primitives import box, cylinder, extrude, lathe, move, slot, sphere, spokes, torus, turn


def console_meshes(geometry):
    """The Simball hand piece and a look-alike of the Touch."""
    touch, drop = geometry["touch"], 0.14
    yield (
        "simball_stand",
        [
            lathe(
                [
                    (0, -drop),
                    (0.075, -drop),
                    (0.072, -drop + 0.014),
                    (0.050, -0.075),
                    (0.040, -0.028),
                    (0.030, -0.012),
                    (0.022, -0.010),
                    (0, -0.010),
                ]
            ),
            *[
                move(cylinder(0.009, 0.004), (0.062 * c, 0.062 * s, -drop + 0.012))
                for _, c, s in spokes(4, math.pi / 4)
            ],
        ],
    )
    yield "simball_ring", [move(torus(0.029, 0.0055), (0, 0, -0.009))]
    yield "simball_ball", [sphere(0.025)]
    # handle: z towards the pivot.
    yield "handle_shaft", [lathe([(0, 0.0), (0.005, 0.0), (0.005, 0.25), (0.003, 0.255), (0, 0.255)])]
    yield (
        "handle_grip",
        [
            lathe(
                [
                    (0, -0.085),
                    (0.012, -0.085),
                    (0.0165, -0.075),
                    (0.0150, -0.050),
                    (0.0175, -0.028),
                    (0.0140, -0.008),
                    (0.0150, 0.004),
                    (0.009, 0.016),
                    (0, 0.016),
                ]
            )
        ],
    )
    yield (
        "handle_trim",
        [
            lathe([(0.0145, -0.012), (0.0162, -0.010), (0.0162, -0.004), (0.0145, -0.002)], closed=True),
            move(box((0.006, 0.009, 0.020), 0.002), (0.0165, 0, -0.034)),
        ],
    )
    shoulder = touch["shoulder_height_m"]
    yield (
        "touch_base",
        [
            lathe(
                [
                    (0, -0.08),
                    (0.085, -0.08),
                    (0.082, -0.066),
                    (0.050, -0.050),
                    (0.042, 0.0),
                    (0.046, 0.02),
                    (0.040, 0.05),
                    (0, 0.05),
                ]
            )
        ],
    )
    yield "touch_trim", [lathe([(0.044, 0.020), (0.0485, 0.024), (0.0475, 0.032), (0.043, 0.036)], closed=True)]
    yield (
        "touch_turret",
        [
            lathe(
                [
                    (0, 0.05 - shoulder),
                    (0.041, 0.05 - shoulder),
                    (0.044, 0.062 - shoulder),
                    (0.036, -0.034),
                    (0, -0.034),
                ]
            ),
            turn(
                lathe([(0, -0.034), (0.034, -0.034), (0.038, -0.028), (0.038, 0.028), (0.034, 0.034), (0, 0.034)]), "x"
            ),
        ],
    )
    for name, length, wide, slim in (
        ("upper_arm", touch["upper_arm_m"], 0.019, 0.013),
        ("forearm", touch["forearm_m"], 0.014, 0.007),
    ):
        bar = extrude(slot(length, wide, slim), 1.3 * wide, 0.004)
        yield f"touch_{name}", [turn(move(bar, (0, 0, -0.65 * wide)), "x")]
    yield (
        "touch_elbow",
        [turn(lathe([(0, -0.017), (0.014, -0.017), (0.016, -0.014), (0.016, 0.014), (0.014, 0.017), (0, 0.017)]), "x")],
    )
    yield "touch_gimbal", [turn(torus(0.019, 0.0035), "y"), move(turn(cylinder(0.006, 0.030), "y"), (-0.034, 0, 0))]
