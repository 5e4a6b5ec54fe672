"""The SARAS arm's link: protocol, driver plug-in interface, our Socket.IO driver, the simulated arm's server.

Needs python-socketio and aiohttp (``pip install saras[arm]``). The server is in ``saras.mesa_link.server``.
"""

from saras.mesa_link.client import SocketIoArmDriver
from saras.mesa_link.connection import LinkTimes
from saras.mesa_link.driver import ArmDriver, ArmLinkError, LinkStats, Received, load_driver
from saras.mesa_link.fields import MessageError
from saras.mesa_link.protocol import MaxVelocity, Reason, State, Target, Tool, Truth

__all__ = [
    "ArmDriver",
    "ArmLinkError",
    "LinkStats",
    "LinkTimes",
    "MaxVelocity",
    "MessageError",
    "Reason",
    "Received",
    "SocketIoArmDriver",
    "State",
    "Target",
    "Tool",
    "Truth",
    "load_driver",
]
