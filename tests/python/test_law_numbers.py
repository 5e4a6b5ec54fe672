"""The core's `_numbers` of a struct is what numpy makes of its fields."""

import numpy as np
import pytest

import saras.console
import saras.kinematics
import saras.sim
import saras.teleop
from saras.law_trace import _append, flatten


def by_fields(value):
    numbers = []
    for field in value._fields:
        _append(getattr(value, field), numbers)
    return numbers


def structs():
    for room in (saras.teleop, saras.sim, saras.console):
        for name in dir(room):
            kind = getattr(room, name)
            if hasattr(kind, "_fields") and name.endswith(("Output", "State")):
                yield pytest.param(kind, id=f"{room.__name__}.{name}")


@pytest.mark.parametrize("kind", structs())
def test_outputs_and_states_of_all_laws_flatten_field_by_field(kind):
    try:
        value = kind()
    except TypeError:
        pytest.skip("made by its law only")
    rng = np.random.default_rng(1)
    for field in kind._fields:
        if isinstance(getattr(value, field), float):
            setattr(value, field, rng.normal())
    numbers = by_fields(value)
    np.testing.assert_array_equal(flatten(value), numbers)
    assert all(isinstance(number, float) for number in flatten(value))
