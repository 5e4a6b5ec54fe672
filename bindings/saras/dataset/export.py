"""Many bags to one data set: a Parquet file a session, a data card, calibration, nominal trajectories."""

from __future__ import annotations

import platform
import shutil
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import numpy as np

import saras
from saras import ConfigError, Error
from saras.dataset.annotations import read_annotations
from saras.dataset.card import write_card
from saras.dataset.nominal import Execution, executions, nominal
from saras.dataset.speech import ENDINGS, Spoken, by_action, spoken
from saras.dataset.table import Options, Table, make_table
from saras.dataset.validation import validate
from saras.recording import Session
from saras.recording.beside import beside


@dataclass(frozen=True)
class Job:
    """One session to export; all of it can be sent to another process."""

    bag: str
    out: str
    options: Options
    calibration: tuple[str, ...] = ()


@dataclass
class Exported:
    """What came of one session."""

    name: str
    facts: dict[str, Any]
    executions: list[Execution] = field(default_factory=list)
    spoken: Spoken | None = None


def export(
    bags: Sequence[str | Path],
    out: str | Path,
    options: Options | None = None,
    calibration: Sequence[str | Path] = (),
    workers: int = 1,
    scheduler: str | None = None,
    phase: str = "time",
    videos: bool = False,
    progress: Callable[[str], None] | None = None,
) -> dict[str, Any]:
    """Writes the data set into the directory ``out``; returns its card.

    ``workers`` > 1 or the address of a dask ``scheduler`` (whose workers see the same paths) need dask. ``progress`` is
    called with the name of each finished session. Raises saras.Error when a bag is refused; nothing is written then.
    """
    software = versions()  # names a missing library before any work
    target = Path(out)
    if target.exists() and any(target.iterdir()):
        raise Error(f"{target}: is not empty: a data set begins in a directory of its own")
    if not bags:
        raise ConfigError("bags = []: must name at least one")
    if phase not in ("time", "path"):
        raise ConfigError(f"phase = {phase!r}: must be time or path")
    options = options or Options()
    if options.frame_index is not None and len(bags) > 1:
        raise ConfigError("frame_index: goes with one bag only")
    part = target.with_name(target.name + ".part")
    shutil.rmtree(part, ignore_errors=True)
    (part / "sessions").mkdir(parents=True)
    names = session_names(bags)
    sources = tuple(str(Path(file).resolve()) for file in calibration)
    jobs = [
        Job(str(Path(bag).resolve()), str((part / "sessions" / f"{name}.parquet").resolve()), options, sources)
        for bag, name in zip(bags, names)
    ]
    try:
        done: dict[str, Exported] = {}
        for one in _run(jobs, workers, scheduler):
            done[one.name] = one
            if progress is not None:
                progress(one.name)
        every = [done[name] for name in names]
        if videos:
            _copy_videos(part / "videos", bags, every)
        if calibration:
            (part / "calibration").mkdir()
            for file in calibration:
                shutil.copy2(file, part / "calibration" / Path(file).name)
        trajectories = nominal([row for one in every for row in one.executions], phase)
        if trajectories:
            _write_nominal(part / "nominal.parquet", trajectories)
        words = by_action(one.spoken for one in every if one.spoken is not None)
        if words["word"]:
            _write_words(part / "speech_by_action.parquet", words)
        card = {
            "format": "saras data set",
            "version": 1,
            "made": datetime.now(timezone.utc).isoformat(timespec="seconds"),
            "software": software,
            "licence": "not yet chosen: ask the owners of the recordings before passing this on",
            "options": asdict(options),
            "calibration": [Path(file).name for file in calibration],
            "nominal": [
                {"tool": row.tool, "action": row.label, "executions": row.executions, "mean_duration_s": row.duration_s}
                for row in trajectories
            ],
            "phase": phase,
            "sessions": [one.facts for one in every],
        }
        write_card(part, card)
        if target.exists():
            target.rmdir()
        part.rename(target)
    except BaseException:
        shutil.rmtree(part, ignore_errors=True)
        raise
    return card


def session_names(bags: Sequence[str | Path]) -> list[str]:
    """A name a bag: of the file, or of its directory where that says more; numbered when they repeat."""
    names: list[str] = []
    for bag in map(Path, bags):
        stem = bag.name.removesuffix(".bag").removesuffix(".repaired")
        base = bag.resolve().parent.name if stem == "session" else stem
        name, number = base, 2
        while name in names:
            name, number = f"{base}_{number}", number + 1
        names.append(name)
    return names


def videos_of(bag: Path) -> list[Path]:
    """Videos and sound that were recorded beside a bag, with their indices."""
    names = [f"{side}.{ending}" for side in ("left", "right") for ending in ("mkv", "frames.csv")]
    names += [f"audio.{ending}" for ending in ("flac", "samples.csv", *ENDINGS)]
    return [beside(bag, name) for name in names if beside(bag, name).is_file()]


def _copy_videos(directory: Path, bags: Sequence[str | Path], every: list[Exported]) -> None:
    for bag, one in zip(bags, every):
        for file in videos_of(Path(bag)):
            (directory / one.name).mkdir(parents=True, exist_ok=True)
            shutil.copy2(file, directory / one.name / file.name)


def versions() -> dict[str, str]:
    """Of what made the data set."""
    from importlib.metadata import version

    import pyarrow

    return {
        "saras": saras.__version__,
        "python": platform.python_version(),
        "numpy": np.__version__,
        "pyarrow": pyarrow.__version__,
        "rosbags": version("rosbags"),
    }


def _run(jobs: list[Job], workers: int, scheduler: str | None) -> Iterator[Exported]:
    """Here, in processes of this machine, or on a cluster: the same jobs, in the order they finish."""
    if scheduler is None and (workers <= 1 or len(jobs) == 1):
        yield from map(export_session, jobs)
        return
    import dask

    tasks = [dask.delayed(export_session, pure=False)(job) for job in jobs]
    if scheduler is None:
        # A fork would copy the locks of pyarrow's threads.
        with dask.config.set({"multiprocessing.context": "spawn"}):
            yield from dask.compute(*tasks, scheduler="processes", num_workers=min(workers, len(jobs)), chunksize=1)
        return
    from dask.distributed import Client, as_completed

    try:
        client = Client(scheduler, timeout="10s")
    except (OSError, ValueError) as error:
        raise Error(f"scheduler = {scheduler}: no dask cluster answers there: {error}") from error
    with client:
        for future in as_completed(client.compute(tasks)):
            yield future.result()


def export_session(job: Job) -> Exported:
    """Writes one session's Parquet file. Raises saras.Error when the bag or a calibration is refused."""
    from saras.dataset.calibration import check_calibration

    with Session.open(job.bag) as session:
        table = make_table(session, job.options)
        for file in job.calibration:
            table.notes += check_calibration(file, session)
        write_parquet(Path(job.out), table)
        marks = read_annotations(session.topic("/recorder/annotations"), session.start_ns, [])
        facts = {
            "name": Path(job.out).stem,
            "file": f"sessions/{Path(job.out).name}",
            "bag": Path(job.bag).name,
            "start": session.start.isoformat(),
            "duration_s": session.duration_s,
            "rows": len(table),
            "row": table.rows,
            "info": session.info,
            "columns": [asdict(info) for info in table.infos],
            "sources": [asdict(source) for source in table.sources],
            "videos": [file.name for file in videos_of(Path(job.bag))],
            "absent": table.absent,
            "notes": table.notes,
            "validation": validate(session, job.options),
        }
    said = None
    if table.speech is not None:
        facts["speech"] = {"transcript": table.speech.file, "utterances": len(table.speech.utterances)}
        said = spoken(table.speech, marks, session.duration_s)
    return Exported(Path(job.out).stem, facts, executions(table.columns), said)


def write_parquet(path: Path, table: Table) -> None:
    """One file; each column's metadata holds unit, frame, topic and method."""
    import pyarrow as pa
    import pyarrow.parquet as pq

    fields, arrays = [], []
    for info in table.infos:
        values = table.columns[info.name]
        array = pa.array(values, type=pa.string()) if values.dtype == object else pa.array(values)
        meta = {key: value for key, value in asdict(info).items() if key != "name" and value}
        fields.append(pa.field(info.name, array.type, metadata=meta))
        arrays.append(array)
    pq.write_table(pa.Table.from_arrays(arrays, schema=pa.schema(fields)), path, compression="zstd")


def _write_words(path: Path, words: dict[str, list[Any]]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    table = pa.table({**words, "action": pa.array(words["action"], type=pa.string())})
    pq.write_table(table, path, compression="zstd")


def _write_nominal(path: Path, rows: list[Any]) -> None:
    import pyarrow as pa
    import pyarrow.parquet as pq

    tables = []
    for row in rows:
        columns: dict[str, Any] = {
            "tool": [row.tool] * len(row.phase),
            "action": [row.label] * len(row.phase),
            "executions": [row.executions] * len(row.phase),
            "known": row.known,
            "phase": row.phase,
        }
        for number, axis in enumerate("xyz"):
            columns[f"{axis}_m"] = row.position[:, number]
            columns[f"{axis}_std_m"] = row.position_std[:, number]
        for number, axis in enumerate("xyzw"):
            columns[f"q{axis}"] = row.quaternion[:, number]
        columns["rotation_std_rad"] = row.rotation_std
        tables.append(pa.table(columns))
    pq.write_table(pa.concat_tables(tables), path, compression="zstd")
