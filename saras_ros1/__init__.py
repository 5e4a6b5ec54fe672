"""ROS 1 nodes around the saras core."""

from pkgutil import extend_path

# The generated messages live in devel/…/saras_ros1: without this the source package would shadow them.
__path__ = extend_path(__path__, __name__)
