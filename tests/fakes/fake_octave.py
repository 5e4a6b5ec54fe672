#!/usr/bin/env python3
"""Speaks to OctaveCost as its Octave worker does; what it answers is said by the first line of the .m file, after %."""

import os
import sys
import time
from pathlib import Path

import numpy as np

name = os.environ["SARAS_COST_FUNCTION"]
does = (Path(os.environ["SARAS_COST_FOLDER"]) / f"{name}.m").read_text().splitlines()[0].lstrip("% ")
fields = os.environ["SARAS_COST_FIELDS"].split(",")
if does == "never starts":
    time.sleep(600)
with open(os.environ["SARAS_COST_REQUESTS"], "rb") as requests, open(os.environ["SARAS_COST_ANSWERS"], "wb") as answers:  # noqa: PTH123

    def answer(failed, values):
        answers.write(np.array([failed, len(values), *values], dtype=float).tobytes())
        answers.flush()

    def letters(text):
        return [float(ord(letter)) for letter in text]

    if does == "is broken":
        answer(1, letters("parse error"))
        sys.exit(1)
    answer(0, [])
    while shape := requests.read(16):
        rows, count = (int(value) for value in np.frombuffer(shape))
        values = {}
        for field in ("points", *fields):
            columns = int(np.frombuffer(requests.read(8))[0])
            values[field] = np.frombuffer(requests.read(8 * rows * count * columns)).reshape(
                (rows, count, columns), order="F"
            )
        if does == "raises":
            answer(1, letters("out of memory or dimension too large"))
        elif does == "hangs":
            time.sleep(600)
        elif does == "exits":
            sys.exit(3)
        else:
            answer(0, values[does].sum(axis=(1, 2)))
