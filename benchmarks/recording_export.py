"""One export, timed: ours, or the loop over rosbag and pandas that one would write first. Run by recording.py.

python recording_export.py ours|rosbag WORKERS OUT BAG …        prints the seconds it took, without imports
"""

from __future__ import annotations

import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import numpy as np

RATE_HZ = 25.0
GAP_S = 0.05


def flatten(message, prefix=""):
    """All numbers and texts of a message, by dotted name."""
    row = {}
    for name in message.__slots__:
        value = getattr(message, name)
        if hasattr(value, "to_sec"):
            row[prefix + name] = value.to_sec()
        elif hasattr(value, "__slots__"):
            row.update(flatten(value, f"{prefix}{name}."))
        elif isinstance(value, (tuple, list, np.ndarray)):
            for place, item in enumerate(value):
                if isinstance(item, (int, float)):
                    row[f"{prefix}{name}.{place}"] = item
        else:
            row[prefix + name] = value
    return row


def topics_of_ours(names):
    """What our data set reads: the peer reads the same, and no more."""
    from saras.dataset.sources import sources

    wanted = {next((topic for topic in source.topics if topic in names), None) for source in sources()}
    return sorted(wanted - {None})


def frames_by_rosbag(path):
    """A data frame a topic, by stamp; and the times of the rows."""
    import pandas
    import rosbag

    with rosbag.Bag(str(path)) as bag:
        start = bag.get_start_time()
        names = bag.get_type_and_topic_info().topics
        rows = {name: [] for name in topics_of_ours(names)}
        for topic, message, received in bag.read_messages(topics=list(rows)):
            row = flatten(message)
            row["t"] = row.get("header.stamp", received.to_sec()) - start
            rows[topic].append(row)
        grid = np.arange(0.0, bag.get_end_time() - start, 1.0 / RATE_HZ)
    return {name: pandas.DataFrame(each).sort_values("t") for name, each in rows.items()}, grid


def by_rosbag(job):
    """The newest message before each row: no interpolation, no slerp, no check of gaps but one tolerance."""
    import pandas

    path, out = job
    frames, grid = frames_by_rosbag(path)
    table = pandas.DataFrame({"t": grid})
    for name, frame in frames.items():
        named = frame.rename(columns={column: f"{name}.{column}" for column in frame if column != "t"})
        table = pandas.merge_asof(table, named, on="t", tolerance=GAP_S)
    table.to_parquet(Path(out) / f"{Path(path).stem}.parquet")


def main():
    who, workers, out, bags = sys.argv[1], int(sys.argv[2]), Path(sys.argv[3]), sys.argv[4:]
    if who == "ours":
        import pyarrow.parquet
        import rosbags.rosbag1  # noqa: F401

        from saras.dataset import Options, export

        begin = time.monotonic()
        export(bags, out, Options(rate_hz=RATE_HZ), workers=workers)
    else:
        import pandas  # noqa: F401
        import pyarrow.parquet  # noqa: F401
        import rosbag  # noqa: F401

        out.mkdir(parents=True)
        begin = time.monotonic()
        jobs = [(bag, str(out)) for bag in bags]
        if workers == 1:
            list(map(by_rosbag, jobs))
        else:
            with ProcessPoolExecutor(workers) as pool:
                list(pool.map(by_rosbag, jobs))
    print(time.monotonic() - begin)


if __name__ == "__main__":
    main()
