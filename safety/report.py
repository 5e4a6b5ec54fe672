"""docs/safety.md out of hazards.yaml, safety_notes.md and the results of the last script/test."""

from __future__ import annotations

import argparse
import datetime
import re
import subprocess
import sys
import xml.etree.ElementTree
from pathlib import Path
from typing import NamedTuple

import yaml

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "build" / "test_results"
PAGE = ROOT / "docs" / "safety.md"
NOT_RUN = "not run"


class Hazard(NamedTuple):
    """One row."""

    hazard: str
    required: str
    shown_by: list[str]


def hazards() -> list[Hazard]:
    """All rows of hazards.yaml."""
    rows = yaml.safe_load((ROOT / "safety" / "hazards.yaml").read_text(encoding="utf-8"))
    return [Hazard(**row) for row in rows]


def results(directory: Path) -> dict[tuple[str, str], list[str]]:
    """(file's stem, test) → "passed", "failed" or "skipped", one a run; of JUnit files and of rostest's logs."""
    found: dict[tuple[str, str], list[str]] = {}
    for path in sorted(directory.rglob("*.xml")):
        try:
            root = xml.etree.ElementTree.parse(path).getroot()
        except xml.etree.ElementTree.ParseError:
            continue
        for case in root.iter("testcase"):
            kinds = {child.tag for child in case}
            verdict = "failed" if kinds & {"failure", "error"} else "skipped" if "skipped" in kinds else "passed"
            name = re.sub(r"\[.*\]$", "", case.get("name", "")).split("/")[0]
            found.setdefault((stem_of(case), name), []).append(verdict)
    for path in sorted(directory.rglob("*.log")):
        read_rostest(path, found)
    return found


def read_rostest(path: Path, found: dict[tuple[str, str], list[str]]) -> None:
    """Adds what rostest --text said, in a file named after the test: NAME.log of NAME_test.py. It writes no JUnit."""
    text = path.read_text(encoding="utf-8", errors="replace")
    bad = set(re.findall(r"test_\w+", " ".join(re.findall(r"\* (?:FAILURES|ERRORS): \d+ \[(.*)\]", text))))
    if "* TESTS:" not in text:
        return
    stem = path.stem.removesuffix("_realtime") + "_test"
    for name in sorted(set(re.findall(r"(test_\w+) \(__main__", text))):
        found.setdefault((stem, name), []).append("failed" if name in bad else "passed")


def stem_of(case: xml.etree.ElementTree.Element) -> str:
    """The test file's name without suffix, as far as the runners tell."""
    if case.get("file"):  # gtest
        return Path(case.get("file", "")).stem
    classname = case.get("classname", "")
    parts = [part for part in classname.split(".") if part.startswith("test_") or part.endswith("_test")]
    return parts[-1] if parts else classname


def verdict(shown_by: str, found: dict[tuple[str, str], list[str]]) -> str:
    """What the last runs of one test, or of all tests of a file, said."""
    path, _, name = shown_by.partition("::")
    if path.startswith(("script/", "benchmarks/", "safety/", "tests/fuzz/")):
        return "by command"
    stem = Path(path).stem
    said = [word for (file, test), words in found.items() if file == stem and name in ("", test) for word in words]
    if not said:
        return NOT_RUN
    return "failed" if "failed" in said else "passed" if "passed" in said else "skipped"


def summary(verdicts: list[str]) -> str:
    """One word for a row, the worst first."""
    for word in ("failed", NOT_RUN, "skipped"):
        if word in verdicts:
            return f"**{word}** ({verdicts.count(word)} of {len(verdicts)})"
    return "passed" if "passed" in verdicts else "by command"


def page(found: dict[tuple[str, str], list[str]], about: str) -> str:
    """The whole page."""
    lines = [(ROOT / "safety" / "safety_notes.md").read_text(encoding="utf-8").rstrip(), "", about, ""]
    lines += ["| hazard | required | shown by | result |", "|---|---|---|---|"]
    for row in hazards():
        shown = ", ".join(f"`{name}`" for name in row.shown_by)
        verdicts = [verdict(name, found) for name in row.shown_by]
        lines.append(f"| {row.hazard} | {row.required} | {shown} | {summary(verdicts)} |")
    return "\n".join(lines) + "\n"


def without_results(text: str) -> list[str]:
    """The page's lines but for results and the line about them."""
    rows = [re.sub(r"\| [^|]* \|$", "|", line) for line in text.splitlines()]
    return [row for row in rows if not row.startswith("Results of")]


def main() -> int:
    """0: written, or up to date."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true", help="writes nothing; 1 when the page is not up to date")
    arguments = parser.parse_args()
    found = results(RESULTS)
    commit = subprocess.run(
        ["git", "-C", str(ROOT), "describe", "--always", "--dirty"], capture_output=True, text=True, check=False
    ).stdout.strip()
    runs = sum(len(words) for words in found.values())
    when = datetime.date.today().isoformat()
    text = page(found, f"Results of {runs} test runs on {when}, commit {commit or 'unknown'}.")
    if arguments.check:
        same = PAGE.exists() and without_results(PAGE.read_text(encoding="utf-8")) == without_results(text)
        print("docs/safety.md is up to date" if same else "docs/safety.md is not: script/safety-report", flush=True)
        return 0 if same else 1
    PAGE.write_text(text, encoding="utf-8")
    words = [verdict(name, found) for row in hazards() for name in row.shown_by]
    counts = ", ".join(f"{words.count(word)} {word}" for word in sorted(set(words)))
    print(f"docs/safety.md: {len(hazards())} hazards; tests: {counts}")
    return 1 if "failed" in words else 0


if __name__ == "__main__":
    sys.exit(main())
