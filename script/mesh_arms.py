"""Drawn shapes of the SARAS arm and its positioning arm, each in the frame of its link [m]."""

from __future__ import annotations

from mesh_primitives import box, cylinder, dome, extrude, lathe, move, slot, spokes, torus, turn


def arm_meshes(geometry):
    """The SARAS endoscope robot, white and teal parts apart."""
    arm = geometry["arm"]
    l1, l2 = arm["scara_link_1_m"], arm["scara_link_2_m"]
    flange = geometry["passive"]["flange_to_base_m"]
    # The shoulder hangs under the positioning arm's flange; link 1 runs just above the SCARA plane, link 2 in it.
    yield (
        "base_housing",
        [
            lathe([(0, 0.048), (0.040, 0.048), (0.046, 0.054), (0.046, 0.108), (0.030, flange), (0, flange)]),
            move(box((0.052, 0.060, 0.050), 0.010), (-0.040, 0, 0.080)),
        ],
    )
    yield "base_ring", [lathe([(0.0462, 0.062), (0.0478, 0.064), (0.0478, 0.072), (0.0462, 0.074)], closed=True)]
    yield (
        "scara_link_1",
        [
            move(extrude(slot(l1, 0.036, 0.028), 0.026, 0.006), (0, 0, 0.018)),
            move(cylinder(0.034, 0.012), (0, 0, 0.040)),
        ],
    )
    yield (
        "scara_link_1_cap",
        [move(lathe(dome(0.024, 0.012)), (l1, 0, 0.044)), move(cylinder(0.020, 0.016), (l1, 0, 0.006))],
    )
    ring = 0.034
    yield (
        "scara_link_2",
        [
            move(extrude(slot(l2 - ring - 0.006, 0.026, 0.013), 0.022, 0.005), (0, 0, -0.012)),
            move(torus(ring, 0.0085), (l2, 0, 0)),
        ],
    )
    yield "scara_link_2_cap", [move(lathe(dome(0.018, 0.008)), (0, 0, -0.012), flip=True)]
    yield (
        "universal_fork",
        [
            torus(0.0225, 0.0055),
            *[move(turn(cylinder(0.0045, 0.012), "y"), (side * 0.0275, 0, 0)) for side in (-1, 1)],
        ],
    )
    # The linear axis stands on the universal joint: a rail beside the shaft, as long as the stroke.
    top = arm["instrument_m"] - arm["tip_offset_m"] + 0.035
    yield (
        "linear_axis",
        [
            move(box((0.016, 0.030, top + 0.02), 0.004), (-0.030, 0, top / 2 + 0.002)),
            move(box((0.044, 0.022, 0.016), 0.004), (-0.012, 0, 0.012)),
            *[move(turn(cylinder(0.0045, 0.012), "x"), (0, side * 0.0165, 0)) for side in (-1, 1)],
            move(box((0.036, 0.040, 0.034), 0.008), (-0.034, 0, top + 0.018)),
        ],
    )
    yield (
        "linear_axis_trim",
        [
            move(box((0.003, 0.018, top - 0.03), 0.001), (-0.0212, 0, top / 2 + 0.012)),
            lathe([(0.0035, -0.016), (0.007, -0.016), (0.011, 0.002), (0.011, 0.020), (0.0035, 0.020)], closed=True),
        ],
    )
    # The carriage carries the adapter with the instrument's flange in its origin; z runs down the shaft.
    yield (
        "carriage",
        [
            move(box((0.034, 0.036, 0.046), 0.007), (-0.014, 0, -0.010)),
            lathe(
                [
                    (0, -0.052),
                    (0.012, -0.052),
                    (0.017, -0.046),
                    (0.019, -0.030),
                    (0.019, 0.012),
                    (0.013, 0.020),
                    (0, 0.020),
                ]
            ),
        ],
    )
    yield (
        "carriage_trim",
        [lathe([(0.0192, -0.024), (0.0206, -0.022), (0.0206, -0.016), (0.0192, -0.014)], closed=True)],
    )
    length, radius = arm["instrument_m"], arm["shaft_radius_m"]
    yield (
        "instrument_hub",
        [
            lathe(
                [
                    (0, 0.016),
                    (0.0105, 0.016),
                    (0.0125, 0.024),
                    (0.0105, 0.040),
                    (0.0048, 0.056),
                    (0.0048, 0.066),
                    (0, 0.066),
                ]
            ),
            *[
                move(box((0.006, 0.0025, 0.020), 0.001), (0.0115 * c, 0.0115 * s, 0.030), yaw=a)
                for a, c, s in spokes(6)
            ],
        ],
    )
    yield (
        "instrument_shaft",
        [
            lathe(
                [
                    (0, 0.05),
                    (radius, 0.05),
                    (radius, length - 0.020),
                    (radius * 0.8, length - 0.017),
                    (0, length - 0.017),
                ]
            )
        ],
    )
    jaw = [(0, 0), (0.0018, 0), (0.0021, 0.006), (0.0016, 0.015), (0.0007, 0.018), (0, 0.018)]
    yield "jaw", [lathe(jaw, segments=16)]
    yield (
        "trocar",
        [
            lathe(
                [
                    (0.0035, -0.008),
                    (0.013, -0.008),
                    (0.015, -0.003),
                    (0.009, 0.010),
                    (0.005, 0.014),
                    (0.0042, 0.055),
                    (0.0035, 0.055),
                ],
                closed=True,
            )
        ],
    )


def passive_meshes():
    """The positioning arm: a foot, tapered links in two lengths, joint caps."""
    yield (
        "passive_foot",
        [
            move(box((0.120, 0.100, 0.030), 0.008), (0, 0, 0.015)),
            lathe([(0, 0.03), (0.046, 0.03), (0.040, 0.060), (0.038, 0.08), (0, 0.08)]),
        ],
    )
    for name, height in (("stub", 0.06), ("short", 0.10), ("wrist", 0.14), ("long", 0.16)):
        yield (
            f"passive_link_{name}",
            [
                lathe(
                    [
                        (0, 0),
                        (0.036, 0),
                        (0.037, 0.012),
                        (0.030, 0.35 * height),
                        (0.029, 0.62 * height),
                        (0.034, height - 0.022),
                        (0.030, height),
                        (0, height),
                    ]
                )
            ],
        )
    yield (
        "passive_joint",
        [
            turn(
                lathe(
                    [
                        (0, -0.042),
                        (0.026, -0.042),
                        (0.033, -0.036),
                        (0.034, 0),
                        (0.033, 0.036),
                        (0.026, 0.042),
                        (0, 0.042),
                    ]
                ),
                "x",
            )
        ],
    )
    yield (
        "passive_cap",
        [
            turn(
                lathe([(0, -0.0435), (0.020, -0.0435), (0.022, -0.042), (0.022, 0.042), (0.020, 0.0435), (0, 0.0435)]),
                "x",
            )
        ],
    )
    yield (
        "passive_tool",
        [lathe([(0, 0), (0.030, 0), (0.031, 0.006), (0.027, 0.024), (0.032, 0.046), (0.032, 0.05), (0, 0.05)])],
    )
