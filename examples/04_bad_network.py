"""Two hands, two arms, and a network that loses, doubles, delays and reorders; a tank dies on the way.

The books of energy must balance whatever happens.

python examples/04_bad_network.py [--duration S] [--plot FILE.png]
"""

import argparse

from saras import sim

parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("--duration", type=float, default=12.0, help="simulated seconds")
parser.add_argument("--plot", help="write a figure here (needs matplotlib)")
arguments = parser.parse_args()

bad = sim.ChannelConfig(delay_s=0.1, jitter_s=0.03, loss=0.2, duplicate=0.1, reorder=0.1, burst_rate_hz=0.1)
left = sim.Side(motion=sim.Palpate(), tissue=sim.TissueConfig())
right = sim.Side(operator=sim.OperatorConfig.weak(), motion=sim.SumOfSines(seed=2), tissue=sim.TissueConfig())
experiment = sim.Experiment(
    sides=(left, right),
    duration_s=arguments.duration,
    up=bad,
    down=bad,
    exchange=bad,
    guard_jitter=0.2,
    restarts=(sim.Restart(0.5 * arguments.duration, "tank_master"),),
)
result = sim.run(experiment)

print("tank            level  granted  delivered  received   sent  vented   lost  [J]")
for name, book in zip(result.tanks, result.final_books):
    print(
        f"{name:13s} {book.energy_J:7.3f} {book.granted_J:8.3f} {book.work_out_J:10.4f} {book.received_J:9.3f}"
        f" {book.sent_J:6.3f} {book.vented_J:7.3f} {book.lost_J:6.3f}"
    )
m = result.metrics()
print(f"in flight {m.in_flight_J:.4f} J (never below {m.in_flight_min_J:.1e}), residual {m.ledger_residual_J:.1e} J")

if arguments.plot:
    from saras import plot

    plot.energy(result).savefig(arguments.plot, dpi=100)
