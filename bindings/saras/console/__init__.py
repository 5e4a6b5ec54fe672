"""The console program: two handles, a port guard at each, Touchball UDP to the platform. Needs no ROS.

``saras console`` runs it. To write a device of your own: subclass :class:`HandleDevice` and name a factory
``make(side, options)`` in the entry point group ``saras.console_devices``.
"""

from saras.console.device import HandleDevice, HandleReading, open_device

__all__ = ["HandleDevice", "HandleReading", "open_device"]
