"""Recorded sessions as aligned tables for learning; ``saras dataset``. Needs ``saras[dataset]``.

>>> card = export(["session.bag"], "set")                       # doctest: +SKIP
>>> pandas.read_parquet("set/sessions/session.parquet")         # doctest: +SKIP
"""

from saras.dataset.export import export
from saras.dataset.nominal import Execution, Nominal, nominal
from saras.dataset.table import Options, Table, make_table
from saras.dataset.validation import validate

__all__ = ["Execution", "Nominal", "Options", "Table", "export", "make_table", "nominal", "validate"]
