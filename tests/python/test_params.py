import math

import numpy as np
import pytest

pytest.importorskip("rospy")
from saras import ConfigError
from saras.teleop import TwistEstimatorConfig
from saras_ros1.params import Params

GOOD = {"law": {"cutoff_hz": 20.0, "dt_max_s": 0.1}, "period_s": 0.01, "mode": "static", "on": True, "v": [1, 2, 3]}


def read(values):
    params = Params(values, "/node")
    law = params.build(TwistEstimatorConfig, "law")
    period_s = params.number("period_s", 0.001, 1.0)
    mode = params.text("mode", ("static", "endoscope"))
    on = params.flag("on")
    v = params.vector("v", 3, 0.0, 10.0)
    params.finish()
    return law, period_s, mode, on, v


def test_a_good_file_is_read():
    law, period_s, mode, on, v = read(GOOD)
    assert (law.cutoff_hz, law.dt_max_s, period_s, mode, on) == (20.0, 0.1, 0.01, "static", True)
    np.testing.assert_array_equal(v, [1.0, 2.0, 3.0])


def changed(path, value):
    values = {k: dict(v) if isinstance(v, dict) else v for k, v in GOOD.items()}
    target = values
    for key in path[:-1]:
        target = target[key]
    if value is KeyError:
        del target[path[-1]]
    else:
        target[path[-1]] = value
    return values


@pytest.mark.parametrize(
    ("path", "value", "names"),
    [
        (("law",), KeyError, ["/node/law", "missing"]),
        (("law", "cutoff_hz"), KeyError, ["/node/law/cutoff_hz", "missing"]),
        (("law", "cutoff_hz"), math.nan, ["/node/law/cutoff_hz", "nan", "finite"]),
        (("law", "cutoff_hz"), -1.0, ["/node/law", "cutoff_hz", "-1"]),
        (("law", "cutoff_hz"), "20", ["/node/law/cutoff_hz", "'20'", "number"]),
        (("law", "cutoff_hz"), True, ["/node/law/cutoff_hz", "number"]),
        (("law", "cutof_hz"), 20.0, ["/node/law/cutof_hz", "unknown"]),
        (("period_s",), 2.0, ["/node/period_s", "2", "[0.001, 1]"]),
        (("period_s",), math.inf, ["/node/period_s", "inf", "finite"]),
        (("mode",), "other", ["/node/mode", "'other'", "static, endoscope"]),
        (("on",), 1, ["/node/on", "1", "true or false"]),
        (("v",), [1, 2], ["/node/v", "3 numbers"]),
        (("v",), [1, 2, 11], ["/node/v[2]", "11", "[0, 10]"]),
        (("extra",), 1, ["/node/extra", "unknown"]),
    ],
)
def test_a_bad_value_is_refused_by_name_value_and_bound(path, value, names):
    with pytest.raises(ConfigError) as refusal:
        read(changed(path, value))
    for name in names:
        assert name in str(refusal.value)


def test_an_empty_namespace_says_which_file_to_load():
    with pytest.raises(ConfigError, match=r"/node: no parameters"):
        Params({}, "/node")
