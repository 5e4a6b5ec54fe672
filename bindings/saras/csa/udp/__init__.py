"""A slave arm elsewhere on the network, by CSA UDP (docs/protocols.md): both ends, in Python.

``SlaveLink`` and ``SlaveGate`` are the slave's end: the socket, and what of the set-points may be followed.
``PlatformLink`` and ``RemoteSlave`` are the platform's end: the socket, and an arm with CRTK's states and a named hold.
No ROS. A slave in C that needs nothing of this package: examples/udp_slave.
"""

from saras.csa.udp.gate import GateConfig, SlaveGate
from saras.csa.udp.link import PlatformLink, SlaveLink
from saras.csa.udp.remote import HoldReason, RemoteSlave, RemoteSlaveConfig
from saras.csa.udp.settings import UdpSettings, udp_settings

__all__ = [
    "GateConfig",
    "HoldReason",
    "PlatformLink",
    "RemoteSlave",
    "RemoteSlaveConfig",
    "SlaveGate",
    "SlaveLink",
    "UdpSettings",
    "udp_settings",
]
