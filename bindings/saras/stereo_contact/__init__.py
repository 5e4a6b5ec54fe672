"""Contact from the stereo endoscope: how deep a tip is under undisturbed tissue, and where outward is. Needs OpenCV.

    estimator = StereoContact(StereoContactConfig(), left, right)            # saras.calibration.camera_info.Eye
    found = estimator.estimate(left_image, right_image, world_T_left, {"mesa_left": Tool(tip, trocar, 0.0025)}, now_s)
    if found["mesa_left"].known: force = stiffness * max(0.0, found["mesa_left"].depth_m)

What is seen of the tissue around the tip, and what was seen of it before something pressed on it, gives the surface;
the tip is where the arm says it is. Unknown, with the reason, is what cannot be seen; it is never shown as no contact.
"""

from saras.stereo_contact.estimator import ContactEstimate, StereoContact, Tool
from saras.stereo_contact.settings import StereoContactConfig

__all__ = ["ContactEstimate", "StereoContact", "StereoContactConfig", "Tool"]
