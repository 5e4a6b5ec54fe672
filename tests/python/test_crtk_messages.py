"""The generated crtk_msgs are the real ones: name, checksum, fields."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("rospy")
genmsg = pytest.importorskip("genmsg")
import crtk_msgs.msg
import crtk_msgs.srv
from genmsg.gentools import compute_md5

ROOT = Path(__file__).resolve().parents[2]
# As the package crtk_msgs has them.
MD5 = {"OperatingState": "b1bd4021", "StringStamped": "5e3e4608", "TriggerOperatingState": "d941a2d0"}
CLASSES = {
    **{name: getattr(crtk_msgs.msg, name) for name in ("OperatingState", "StringStamped")},
    **{
        name: getattr(crtk_msgs.srv, name)
        for name in ("TriggerOperatingState", "QueryForwardKinematics", "QueryInverseKinematics")
    },
}


@pytest.mark.parametrize("name", CLASSES)
def test_checksum_is_what_genmsg_computes_and_what_crtk_has(name):
    context = genmsg.MsgContext.create_default()
    path = {
        "crtk_msgs": [str(ROOT / "msg" / "crtk_msgs")],
        "std_msgs": ["/usr/share/std_msgs/msg"],
        "geometry_msgs": ["/usr/share/geometry_msgs/msg"],
    }
    message = ROOT / "msg" / "crtk_msgs" / f"{name}.msg"
    if message.is_file():
        spec = genmsg.msg_loader.load_msg_from_file(context, str(message), f"crtk_msgs/{name}")
    else:
        service = ROOT / "srv" / "crtk_msgs" / f"{name}.srv"
        spec = genmsg.msg_loader.load_srv_from_file(context, str(service), f"crtk_msgs/{name}")
    genmsg.msg_loader.load_depends(context, spec, path)
    assert CLASSES[name]._md5sum == compute_md5(context, spec)
    assert CLASSES[name]._md5sum.startswith(MD5.get(name, ""))
    assert CLASSES[name]._type == f"crtk_msgs/{name}"
