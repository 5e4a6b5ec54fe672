"""The simulated arm's server: ``python -m saras.mesa_link --name mesa_left --port 48020 --scene config/scene.yaml``."""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import gc
import signal
import sys
from collections.abc import Sequence
from pathlib import Path

from saras import Error
from saras.mesa_link.scene import simulated_arm
from saras.mesa_link.server import ArmServer, ArmServerConfig


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(prog="sim_arm_server", description="A simulated SARAS arm behind Socket.IO.")
    parser.add_argument("--name", required=True, help="which arm of the scene: mesa_left or mesa_right")
    parser.add_argument("--port", type=int, required=True, help="TCP port, 0 for a free one")
    parser.add_argument("--host", default="127.0.0.1", help="address to listen on (no authentication: keep it local)")
    parser.add_argument("--scene", required=True, help="scene file (config/scene.yaml)")
    parser.add_argument("--seed", type=int, default=1, help="of the noise")
    parser.add_argument("--state-rate", type=float, default=200.0, help="states a second [Hz]")
    parser.add_argument("--no-tissue", action="store_true", help="free space")
    parser.add_argument("--force-sensor", action="store_true", help="report the wrench at the tip (the arm has none)")
    parser.add_argument("--log", type=Path, metavar="FILE", help="write each command and tick to FILE as JSON lines")
    parser.add_argument("--allow-faults", action="store_true", help="obey the event `inject` (tests)")
    return parser.parse_args(arguments)


async def serve(options: argparse.Namespace) -> None:
    """Serve until SIGINT or SIGTERM."""
    plant = simulated_arm(
        options.scene, options.name, seed=options.seed, tissue=not options.no_tissue, sensor=options.force_sensor
    )
    config = ArmServerConfig(
        options.name,
        options.port,
        options.host,
        state_rate_hz=options.state_rate,
        allow_faults=options.allow_faults,
        log=options.log,
    )
    server = ArmServer(config, plant)
    await server.start()
    print(f"{options.name}: simulated arm at http://{options.host}:{server.port}", flush=True)
    gc.collect()
    gc.freeze()
    stopped = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        with contextlib.suppress(NotImplementedError):  # Windows
            asyncio.get_running_loop().add_signal_handler(number, stopped.set)
    ended = asyncio.create_task(server.wait())
    await asyncio.wait([ended, asyncio.create_task(stopped.wait())], return_when=asyncio.FIRST_COMPLETED)
    await server.stop()
    if ended.done() and not ended.cancelled():
        ended.result()


def main(arguments: Sequence[str] | None = None) -> int:
    """Exit code 0 after a signal, 2 when the start is refused."""
    options = parse(sys.argv[1:] if arguments is None else arguments)
    try:
        asyncio.run(serve(options))
    except (Error, OSError) as error:
        print(f"sim_arm_server: {error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
