"""The real-time host: one C++ loop at 1 kHz from the console's datagrams to the set-points and back (docs/realtime.md).

Python starts, configures and observes it; the loop runs without the interpreter.
"""

try:
    from saras._core.runtime import (
        ConsoleSocketConfig,
        FlightRecord,
        FlightReplay,
        FlightTick,
        Histogram,
        HostConfig,
        HostSnapshot,
        HostStatistics,
        LoopConfig,
        LoopStatistics,
        ModelHost,
        ModelHostConfig,
        ModelHostStatistics,
        Pacing,
        RealtimeReport,
        RealtimeRequest,
        TeleopHost,
        VertexMapConfig,
        monotonic_ns,
        read_flight,
        replay_flight,
    )
except ModuleNotFoundError as missing:
    raise ImportError("saras.runtime was left out of this build: it needs Linux and OpenSSL (libssl-dev)") from missing

__all__ = [
    "ConsoleSocketConfig",
    "FlightRecord",
    "FlightReplay",
    "FlightTick",
    "Histogram",
    "HostConfig",
    "HostSnapshot",
    "HostStatistics",
    "LoopConfig",
    "LoopStatistics",
    "ModelHost",
    "ModelHostConfig",
    "ModelHostStatistics",
    "Pacing",
    "RealtimeReport",
    "RealtimeRequest",
    "TeleopHost",
    "VertexMapConfig",
    "monotonic_ns",
    "read_flight",
    "replay_flight",
]
