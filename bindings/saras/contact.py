"""Force of a tool on tissue from how deep it presses in, as a camera sees it.

Depth is that of the tip under the undisturbed surface, direction the outward normal of the tissue.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from saras._core.contact import ContactForce, ContactForceConfig, ContactForceOutput, ContactForceState


def contact_force(depth: float, direction: npt.ArrayLike, stiffness: float) -> npt.NDArray[np.float64] | None:
    """(3,) force on the tool [N] of a spring: +stiffness * max(0, depth) * n. None: no estimate, which is not zero.

    depth [m], direction (3,) outward normal of any length but 0, stiffness [N/m]. Raises ConfigError: stiffness <= 0.
    """
    no_limit = ContactForceConfig(stiffness_N_m=stiffness, depth_limit_m=1e9, force_limit_N=1e300)
    out = ContactForce(no_limit).step(no_limit.dt_max_s, depth, np.asarray(direction, dtype=float))
    return np.asarray(out.reaction) if out.has_estimate else None


__all__ = ["ContactForce", "ContactForceConfig", "ContactForceOutput", "ContactForceState", "contact_force"]
