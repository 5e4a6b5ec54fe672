"""config/saras_overlay.rviz is config/saras.rviz with both eyes: a change of one is made in the other too."""

from pathlib import Path

import yaml

CONFIG = Path(__file__).parents[2] / "config"


def test_only_the_two_images_are_added():
    plain, overlay = (
        yaml.safe_load((CONFIG / name).read_text(encoding="utf-8")) for name in ("saras.rviz", "saras_overlay.rviz")
    )
    shown = overlay["Visualization Manager"]["Displays"]
    images = [display for display in shown if display["Class"] == "rviz/Image"]
    overlay["Visualization Manager"]["Displays"] = [display for display in shown if display not in images]
    assert overlay == plain
    topics = {display["Image Topic"] for display in images}
    assert topics == {f"/endoscope/{eye}/image_overlay_view" for eye in ("left", "right")}
