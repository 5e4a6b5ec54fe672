"""
What touch tells of stiffness and shape
"""

from __future__ import annotations
import numpy
import numpy.typing
import saras._core
import typing

__all__: list[str] = [
    "CrossEntropy",
    "Deformation",
    "DeformationGrid",
    "EstimateStatus",
    "GpHyperparameters",
    "GpLearning",
    "GpPrediction",
    "HashGrid",
    "HashGridConfig",
    "LocalGp",
    "LocalModelConfig",
    "Mesh",
    "Registration",
    "SampleVerdict",
    "StiffnessGp",
    "StiffnessGpConfig",
    "StiffnessGpOutput",
    "StiffnessGpState",
    "SurfaceEstimate",
    "TouchBelief",
    "estimate_surfaces",
    "learn_hyperparameters",
    "register_rigid",
]

class HashGridConfig:
    """
    Cells of the samples, and how many of them.
    """

    _fields: typing.ClassVar[list] = ["cell_m", "samples_per_cell", "max_cells", "max_weight"]
    def __copy__(self) -> HashGridConfig: ...
    def __deepcopy__(self, arg0: dict) -> HashGridConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Cells of the samples, and how many of them.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def cell_m(self) -> float:
        """
        edge of a cell [m]
        """
    @cell_m.setter
    def cell_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def max_cells(self) -> int:
        """
        then the cell that was touched longest ago is forgotten
        """
    @max_cells.setter
    def max_cells(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def max_weight(self) -> float:
        """
        of a place; above it the oldest part is forgotten
        """
    @max_weight.setter
    def max_weight(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def samples_per_cell(self) -> int:
        """
        places in a cell; further samples are merged
        """
    @samples_per_cell.setter
    def samples_per_cell(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...

class HashGrid:
    """
    Touch samples in a hash grid of bounded size.
    """
    def __init__(self, config: HashGridConfig = ...) -> None:
        """
        Raises ConfigError.
        """
    def __len__(self) -> int: ...
    def clear(self) -> None: ...
    def forget(
        self,
        point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        radius_m: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None:
        """
        Forgets the cells around the point (3,).
        """
    def insert(
        self,
        positions: typing.Any,
        forces: typing.Any,
        speeds: typing.Annotated[numpy.typing.ArrayLike, numpy.float64] | None = None,
    ) -> numpy.typing.NDArray[numpy.int32]:
        """
        Takes (n, 3) positions [m], (n, 3) forces that the tool exerts [N] and (n,) speeds along them [m/s].
        (n,) places; -1: not finite, too far.
        """
    def within(
        self,
        point: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        radius_m: typing.SupportsFloat | typing.SupportsIndex,
    ) -> list[int]:
        """
        Places within radius_m of the point (3,), in no order.
        """
    @property
    def cells(self) -> int: ...
    @property
    def config(self) -> HashGridConfig: ...
    @property
    def evicted(self) -> int:
        """
        cells forgotten for want of room
        """
    @property
    def places(self) -> int: ...
    @property
    def samples(
        self,
    ) -> tuple[
        numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]
    ]:
        """
        positions (n, 3) [m], forces (n, 3) [N], weights (n,) of all places
        """
    @property
    def taken(self) -> int:
        """
        samples taken
        """

class GpHyperparameters:
    """
    Prior and noise of the normal force.
    """

    _fields: typing.ClassVar[list] = [
        "force_scale_N",
        "stiffness_scale_N_m",
        "bend_scale_N_m2",
        "tangential_length_m",
        "damping_s_m",
        "damping_scale_s_m",
        "noise_N",
    ]
    def __copy__(self) -> GpHyperparameters: ...
    def __deepcopy__(self, arg0: dict) -> GpHyperparameters: ...
    def __init__(self, **kwargs) -> None:
        """
        Prior and noise of the normal force.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def bend_scale_N_m2(self) -> float:
        """
        of half the second derivative of the force over depth [N/m^2]
        """
    @bend_scale_N_m2.setter
    def bend_scale_N_m2(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def damping_s_m(self) -> float:
        """
        share of the force that goes with the speed of pressing [s/m]
        """
    @damping_s_m.setter
    def damping_s_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def damping_scale_s_m(self) -> float:
        """
        standard deviation of damping_s_m [s/m]
        """
    @damping_scale_s_m.setter
    def damping_scale_s_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_scale_N(self) -> float:
        """
        standard deviation of the prior of the force [N]
        """
    @force_scale_N.setter
    def force_scale_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def noise_N(self) -> float:
        """
        standard deviation of one sample's error, all other causes [N]
        """
    @noise_N.setter
    def noise_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_scale_N_m(self) -> float:
        """
        standard deviation of the prior of the stiffness [N/m]
        """
    @stiffness_scale_N_m.setter
    def stiffness_scale_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def tangential_length_m(self) -> float:
        """
        over which the tissue changes along its surface [m]
        """
    @tangential_length_m.setter
    def tangential_length_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class LocalModelConfig:
    """
    The samples around a point, and what is asked of them.
    """

    _fields: typing.ClassVar[list] = [
        "hyperparameters",
        "neighbours",
        "min_samples",
        "radius_m",
        "surface_force_N",
        "search_m",
        "model_error_share",
    ]
    def __copy__(self) -> LocalModelConfig: ...
    def __deepcopy__(self, arg0: dict) -> LocalModelConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        The samples around a point, and what is asked of them.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def hyperparameters(self) -> GpHyperparameters:
        """
        GpHyperparameters
        """
    @hyperparameters.setter
    def hyperparameters(self, arg1: GpHyperparameters) -> None: ...
    @property
    def min_samples(self) -> int:
        """
        fewer places: unknown
        """
    @min_samples.setter
    def min_samples(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def model_error_share(self) -> float:
        """
        of stiffness and of extrapolated depth, always added
        """
    @model_error_share.setter
    def model_error_share(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def neighbours(self) -> int:
        """
        places in one Gaussian process
        """
    @neighbours.setter
    def neighbours(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def radius_m(self) -> float:
        """
        places further away are left out [m]
        """
    @radius_m.setter
    def radius_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def search_m(self) -> float:
        """
        farthest from the samples that a surface is looked for [m]
        """
    @search_m.setter
    def search_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def surface_force_N(self) -> float:
        """
        the surface is where the mean force falls to this [N]
        """
    @surface_force_N.setter
    def surface_force_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class EstimateStatus:
    """
    What is known at a point.

    Members:

      OK

      TOO_FEW_SAMPLES

      NO_SURFACE
    """

    NO_SURFACE: typing.ClassVar[EstimateStatus]
    OK: typing.ClassVar[EstimateStatus]
    TOO_FEW_SAMPLES: typing.ClassVar[EstimateStatus]
    __members__: typing.ClassVar[dict[str, EstimateStatus]]
    @typing.overload
    def __eq__(self, other: EstimateStatus) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: EstimateStatus) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class SurfaceEstimate:
    """
    Surface and stiffness at a point; NaN with an infinite deviation: not known.
    """

    _fields: typing.ClassVar[list] = [
        "surface_point",
        "surface_std_m",
        "stiffness_N_m",
        "stiffness_std_N_m",
        "force_N",
        "force_std_N",
        "normal",
        "samples",
        "status",
    ]
    def __copy__(self) -> SurfaceEstimate: ...
    def __deepcopy__(self, arg0: dict) -> SurfaceEstimate: ...
    def __init__(self, **kwargs) -> None:
        """
        Surface and stiffness at a point; NaN with an infinite deviation: not known.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def force_N(self) -> float:
        """
        normal force at the point itself [N]
        """
    @force_N.setter
    def force_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_std_N(self) -> float:
        """
        [N]
        """
    @force_std_N.setter
    def force_std_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def normal(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) outward, base frame
        """
    @normal.setter
    def normal(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def samples(self) -> int:
        """
        places in the Gaussian process
        """
    @samples.setter
    def samples(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def status(self) -> EstimateStatus:
        """
        EstimateStatus
        """
    @status.setter
    def status(self, arg1: EstimateStatus) -> None: ...
    @property
    def stiffness_N_m(self) -> float:
        """
        [N/m]
        """
    @stiffness_N_m.setter
    def stiffness_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def stiffness_std_N_m(self) -> float:
        """
        [N/m]
        """
    @stiffness_std_N_m.setter
    def stiffness_std_N_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def surface_point(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) along the normal through the point, base frame [m]
        """
    @surface_point.setter
    def surface_point(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def surface_std_m(self) -> float:
        """
        along the normal [m]
        """
    @surface_std_m.setter
    def surface_std_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class GpPrediction:
    """
    Posterior of the force and its gradient at a point.
    """
    @property
    def gradient(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) [N/m]
        """
    @property
    def gradient_covariance(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        (3, 3) [N^2/m^2]
        """
    @property
    def mean(self) -> float:
        """
        [N]
        """
    @property
    def variance(self) -> float:
        """
        without the noise of a sample [N^2]
        """

class LocalGp:
    """
    Gaussian process that grows and shrinks one sample at a time, up to its capacity.
    """
    def __init__(
        self, capacity: typing.SupportsInt | typing.SupportsIndex = 64, hyperparameters: GpHyperparameters = ...
    ) -> None:
        """
        Raises ConfigError.
        """
    def __len__(self) -> int: ...
    def append(
        self,
        position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        value_N: typing.SupportsFloat | typing.SupportsIndex,
        noise_variance_N2: typing.SupportsFloat | typing.SupportsIndex,
        power_W: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> bool:
        """
        One sample at (3,) [m]. False, and nothing changed: full, or no number.
        """
    def mean_and_slope(
        self, at: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]
    ) -> tuple[float, float]:
        """
        mean [N] and its derivative along the normal [N/m] at (3,) [m]
        """
    def predict(
        self,
        at: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        power_W: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> GpPrediction:
        """
        GpPrediction at (3,) [m]; power_W: 0 for tissue at rest.
        """
    def remove(self, i: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def restart(
        self,
        origin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        normal: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    ) -> None:
        """
        Empties it; origin (3,) [m], normal (3,) unit, outward.
        """
    @property
    def capacity(self) -> int: ...
    @property
    def log_marginal_likelihood(self) -> float: ...
    @property
    def work(self) -> int:
        """
        covariances and multiplications so far
        """

class StiffnessGpConfig:
    """
    Bounds and gates of StiffnessGp.
    """

    _fields: typing.ClassVar[list] = [
        "grid",
        "local",
        "recenter_m",
        "contact_force_N",
        "force_limit_N",
        "workspace_m",
        "speed_limit_m_s",
        "outlier_sigma",
        "outlier_patience",
        "bias_time_constant_s",
        "bias_limit_N",
        "agreement_time_constant_s",
        "agreement_limit",
        "dt_max_s",
    ]
    def __copy__(self) -> StiffnessGpConfig: ...
    def __deepcopy__(self, arg0: dict) -> StiffnessGpConfig: ...
    def __init__(self, **kwargs) -> None:
        """
        Bounds and gates of StiffnessGp.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def agreement_limit(self) -> float:
        """
        mean deviation [sigma] above which map and tissue disagree
        """
    @agreement_limit.setter
    def agreement_limit(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def agreement_time_constant_s(self) -> float:
        """
        over which disagreement is averaged [s]
        """
    @agreement_time_constant_s.setter
    def agreement_time_constant_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def bias_limit_N(self) -> float:
        """
        a greater offset is a sensor that drifted [N]
        """
    @bias_limit_N.setter
    def bias_limit_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def bias_time_constant_s(self) -> float:
        """
        of the sensor's offset, taken in free air [s]
        """
    @bias_time_constant_s.setter
    def bias_time_constant_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def contact_force_N(self) -> float:
        """
        below it nothing is touched [N]
        """
    @contact_force_N.setter
    def contact_force_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def dt_max_s(self) -> float:
        """
        longest time step [s]
        """
    @dt_max_s.setter
    def dt_max_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def force_limit_N(self) -> float:
        """
        above it no tissue was meant [N]
        """
    @force_limit_N.setter
    def force_limit_N(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def grid(self) -> HashGridConfig:
        """
        HashGridConfig
        """
    @grid.setter
    def grid(self, arg1: HashGridConfig) -> None: ...
    @property
    def local(self) -> LocalModelConfig:
        """
        LocalModelConfig
        """
    @local.setter
    def local(self, arg1: LocalModelConfig) -> None: ...
    @property
    def outlier_patience(self) -> int:
        """
        so many in a row: the tissue is another one
        """
    @outlier_patience.setter
    def outlier_patience(self, arg1: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    @property
    def outlier_sigma(self) -> float:
        """
        further from the prediction is an outlier; infinite: nothing is
        """
    @outlier_sigma.setter
    def outlier_sigma(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def recenter_m(self) -> float:
        """
        the local model is built anew this far from its centre [m]
        """
    @recenter_m.setter
    def recenter_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def speed_limit_m_s(self) -> float:
        """
        of a tip between two samples [m/s]
        """
    @speed_limit_m_s.setter
    def speed_limit_m_s(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def workspace_m(self) -> float:
        """
        greatest |coordinate| of a tip [m]
        """
    @workspace_m.setter
    def workspace_m(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...

class TouchBelief:
    """
    What somebody else knows of the tip.

    Members:

      UNKNOWN

      FREE

      TOUCHING
    """

    FREE: typing.ClassVar[TouchBelief]
    TOUCHING: typing.ClassVar[TouchBelief]
    UNKNOWN: typing.ClassVar[TouchBelief]
    __members__: typing.ClassVar[dict[str, TouchBelief]]
    @typing.overload
    def __eq__(self, other: TouchBelief) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: TouchBelief) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class SampleVerdict:
    """
    What became of a sample.

    Members:

      LEARNED

      NOT_TOUCHING

      OUTLIER

      RELEARNED

      SENSOR_DRIFT

      IMPLAUSIBLE_POSITION

      IMPLAUSIBLE_FORCE

      INVALID
    """

    IMPLAUSIBLE_FORCE: typing.ClassVar[SampleVerdict]
    IMPLAUSIBLE_POSITION: typing.ClassVar[SampleVerdict]
    INVALID: typing.ClassVar[SampleVerdict]
    LEARNED: typing.ClassVar[SampleVerdict]
    NOT_TOUCHING: typing.ClassVar[SampleVerdict]
    OUTLIER: typing.ClassVar[SampleVerdict]
    RELEARNED: typing.ClassVar[SampleVerdict]
    SENSOR_DRIFT: typing.ClassVar[SampleVerdict]
    __members__: typing.ClassVar[dict[str, SampleVerdict]]
    @typing.overload
    def __eq__(self, other: SampleVerdict) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: SampleVerdict) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class StiffnessGpOutput:
    """
    Result of StiffnessGp.step.
    """

    _fields: typing.ClassVar[list] = ["estimate", "verdict", "disagrees", "disagreement", "bias_N", "status"]
    def __copy__(self) -> StiffnessGpOutput: ...
    def __deepcopy__(self, arg0: dict) -> StiffnessGpOutput: ...
    def __init__(self, **kwargs) -> None:
        """
        Result of StiffnessGp.step.
        """
    def __repr__(self) -> str: ...
    def _numbers(self) -> list[float]:
        """
        All numbers in field order, as saras.law_trace records them.
        """
    @property
    def bias_N(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        (3,) the sensor's offset that was subtracted [N]
        """
    @bias_N.setter
    def bias_N(self, arg1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"]) -> None: ...
    @property
    def disagreement(self) -> float:
        """
        mean deviation of the samples from the map [sigma]
        """
    @disagreement.setter
    def disagreement(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def disagrees(self) -> bool:
        """
        the tissue is not, or no longer, what the map says
        """
    @disagrees.setter
    def disagrees(self, arg1: bool) -> None: ...
    @property
    def estimate(self) -> SurfaceEstimate:
        """
        SurfaceEstimate under the tip
        """
    @estimate.setter
    def estimate(self, arg1: SurfaceEstimate) -> None: ...
    @property
    def status(self) -> saras._core.Status:
        """
        WAITING: nothing known here; LIMITED: known, this sample was not learned
        """
    @status.setter
    def status(self, arg1: saras._core.Status) -> None: ...
    @property
    def verdict(self) -> SampleVerdict:
        """
        SampleVerdict
        """
    @verdict.setter
    def verdict(self, arg1: SampleVerdict) -> None: ...

class StiffnessGpState:
    """
    All that StiffnessGp remembers; copyable.
    """
    def __init__(self, other: StiffnessGpState) -> None: ...
    @property
    def bias_N(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]: ...
    @property
    def disagreement(self) -> float: ...
    @property
    def grid(self) -> HashGrid:
        """
        a copy of the HashGrid
        """
    @property
    def refused(self) -> int:
        """
        samples that should have been learned and were not
        """

class StiffnessGp:
    """
    Stiffness and surface from what the tool feels, one sample at a time.
    """
    def __init__(self, config: StiffnessGpConfig = ...) -> None:
        """
        Raises ConfigError.
        """
    def adopt(self, hyperparameters: GpHyperparameters) -> None:
        """
        Takes over what was learned off the control thread. Raises ConfigError.
        """
    @typing.overload
    def reset(self) -> None: ...
    @typing.overload
    def reset(self, state: StiffnessGpState) -> None: ...
    def step(
        self,
        tip_position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        force: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        dt: typing.SupportsFloat | typing.SupportsIndex,
        tip_velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] = ...,
        belief: TouchBelief = ...,
    ) -> StiffnessGpOutput:
        """
        One sample: (3,) tip [m], (3,) force that the tool exerts on the tissue [N], (3,) velocity [m/s] (zero: not
        known), in the base frame.
        """
    def steps(
        self,
        positions: typing.Any,
        forces: typing.Any,
        dt: typing.SupportsFloat | typing.SupportsIndex,
        velocities: typing.Any = None,
    ) -> tuple[numpy.typing.NDArray[numpy.uint8], dict]:
        """
        A recording at a fixed rate, (n, 3) each: verdicts (n,) as numbers of SampleVerdict, and estimates as
        estimate_surfaces gives them.
        """
    @property
    def config(self) -> StiffnessGpConfig: ...
    @property
    def grid(self) -> HashGrid:
        """
        the live HashGrid, not a copy
        """
    @property
    def state(self) -> StiffnessGpState:
        """
        a copy
        """
    @property
    def work(self) -> int:
        """
        covariances and multiplications so far
        """

class Mesh:
    """
    Triangles with a tree for closest points.
    """
    def __init__(self, vertices: typing.Any, triangles: typing.Any) -> None:
        """
        vertices (n, 3) [m], triangles (m, 3) counter-clockwise from outside. Raises ModelError: empty, not finite, an
        index out of range, no area, not manifold, another unit than metres.
        """
    def closest(self, points: typing.Any) -> tuple:
        """
        The closest points of the surface, as `likely`; squared distances [m^2].
        """
    def likely(self, points: typing.Any, covariances: typing.Any) -> tuple:
        """
        Where (n, 3) points with (n, 3, 3) covariances of their errors most likely came from: points (n, 3), triangles
        (n,), barycentric weights (n, 3), squared deviations (n,).
        """
    @property
    def closed(self) -> bool: ...
    @property
    def triangles(self) -> numpy.typing.NDArray[numpy.int32]:
        """
        (m, 3)
        """
    @property
    def vertex_normals(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) outward, area-weighted
        """
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) [m]
        """

class Registration:
    """
    Where a mesh lies, and how well that is known.
    """
    @property
    def base_T_mesh(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (4, 4)
        """
    @property
    def converged(self) -> bool: ...
    @property
    def covariance(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (6, 6) of saras.displacement(estimate, truth) at the points' middle: [m, rad]
        """
    @property
    def iterations(self) -> int: ...
    @property
    def matches(self) -> tuple:
        """
        as Mesh.likely gives them, mesh frame
        """
    @property
    def rms_m(self) -> float:
        """
        distance of the used points from the mesh [m]
        """
    @property
    def used(self) -> list[bool]:
        """
        n flags; False: left out by the gate
        """

class CrossEntropy:
    """
    Minimum of a cost by the cross-entropy method: ask for candidates, tell their costs.
    """
    def __init__(
        self,
        mean: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        deviation: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        low: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        high: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        *,
        candidates: typing.SupportsInt | typing.SupportsIndex = 48,
        elites: typing.SupportsInt | typing.SupportsIndex = 8,
        smoothing: typing.SupportsFloat | typing.SupportsIndex = 0.7,
        least_deviation: typing.SupportsFloat | typing.SupportsIndex = 0.01,
        seed: typing.SupportsInt | typing.SupportsIndex = 1,
    ) -> None:
        """
        mean, deviation, low, high: (d,) of the first candidates, and bounds. Raises ConfigError.
        """
    def ask(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (candidates, d), the first one is the mean
        """
    def tell(self, costs: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> bool:
        """
        (candidates,) costs; not finite: no candidate. False: none was finite, nothing changed.
        """
    @property
    def best(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (d,) the cheapest so far
        """
    @property
    def best_cost(self) -> float:
        """
        infinite: none yet
        """
    @property
    def deviation(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (d,)
        """
    @property
    def mean(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (d,)
        """
    @property
    def rounds(self) -> int: ...
    @property
    def settled(self) -> bool:
        """
        every deviation is below least_deviation of its first one
        """

class Deformation:
    """
    How a mesh is bent.
    """
    @property
    def converged(self) -> bool: ...
    @property
    def displacements(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, 3) of the grid's corners [m]
        """
    @property
    def rms_m(self) -> float:
        """
        distance of the used points from the bent mesh [m]
        """
    @property
    def rounds(self) -> int:
        """
        of matching and solving
        """
    @property
    def used(self) -> list[bool]:
        """
        flags of the points; False: left out by the gate
        """
    @property
    def vertices(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) of the bent mesh, mesh frame [m]
        """

class DeformationGrid:
    """
    Cubes around a mesh whose corners carry displacements.
    """
    def __init__(self, mesh: Mesh, spacing_m: typing.SupportsFloat | typing.SupportsIndex = 0.02) -> None:
        """
        Raises ModelError, ConfigError.
        """
    def apply(self, displacements: typing.Any) -> numpy.typing.NDArray[numpy.float64]:
        """
        (n, 3) vertices moved by (k, 3) displacements of the corners.
        """
    def deform(
        self,
        points: typing.Any,
        covariances: typing.Any = None,
        base_T_mesh: numpy.typing.ArrayLike = ...,
        *,
        strain: typing.SupportsFloat | typing.SupportsIndex = 0.1,
        travel_m: typing.SupportsFloat | typing.SupportsIndex = 0.05,
        gate: typing.SupportsFloat | typing.SupportsIndex = 7.81,
        max_rounds: typing.SupportsInt | typing.SupportsIndex = 20,
        tolerance_m: typing.SupportsFloat | typing.SupportsIndex = 2e-05,
        start: typing.Any = None,
    ) -> Deformation:
        """
        Bends the mesh to (n, 3) points [m] in the base frame, with (n, 3, 3) covariances [m^2] (None: 1 mm). strain:
        standard deviation of neighbouring corners' difference per spacing; travel_m: of a corner's way. start:
        displacements of the last call. Raises ModelError.
        """
    @property
    def corners(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, 3) [m]
        """

class GpLearning:
    """
    Result of learn_hyperparameters.
    """
    @property
    def converged(self) -> bool: ...
    @property
    def hyperparameters(self) -> GpHyperparameters:
        """
        GpHyperparameters
        """
    @property
    def log_likelihood(self) -> float: ...
    @property
    def log_likelihood_before(self) -> float:
        """
        of all neighbourhoods, without the prior
        """
    @property
    def neighbourhoods(self) -> int: ...
    @property
    def samples(self) -> int:
        """
        places used, with repetition
        """

def estimate_surfaces(grid: HashGrid, config: LocalModelConfig, points: typing.Any, normals: typing.Any = None) -> dict:
    """
    What is known at (n, 3) points [m]: a dict of arrays by the names of SurfaceEstimate. normals: (n, 3) outward, or
    None for the mean reaction of the samples around. The grid must not change meanwhile. Raises ConfigError.
    """

def learn_hyperparameters(
    grid: HashGrid,
    config: LocalModelConfig,
    *,
    neighbourhoods: typing.SupportsInt | typing.SupportsIndex = 24,
    prior_log_std: typing.SupportsFloat | typing.SupportsIndex = 1.0,
    max_iterations: typing.SupportsInt | typing.SupportsIndex = 60,
    seed: typing.SupportsInt | typing.SupportsIndex = 1,
) -> GpLearning:
    """
    Most probable hyper-parameters over neighbourhoods drawn from the grid, from those of config. Tenths of a second
    without the GIL; the grid must not change meanwhile. Raises ModelError when nothing can be learned from.
    """

def register_rigid(
    mesh: Mesh,
    points: typing.Any,
    covariances: typing.Any = None,
    base_T_mesh: numpy.typing.ArrayLike = ...,
    *,
    gate: typing.SupportsFloat | typing.SupportsIndex = 7.81,
    mesh_noise_m: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    max_iterations: typing.SupportsInt | typing.SupportsIndex = 100,
    tolerance_m: typing.SupportsFloat | typing.SupportsIndex = 1e-06,
    most_likely: bool = True,
    base_T_prior: numpy.typing.ArrayLike = ...,
    prior_shift_m: typing.SupportsFloat | typing.SupportsIndex = ...,
    prior_turn_rad: typing.SupportsFloat | typing.SupportsIndex = ...,
) -> Registration:
    """
    Iterative most likely point registration (Billings, Boctor, Taylor 2015). points (n, 3) [m] on the surface,
    covariances (n, 3, 3) of their errors [m^2] (None: 1 mm), base_T_mesh (4, 4) to start from. gate: squared deviation
    above which a point is left out; most_likely=False: plain ICP. prior_shift_m, prior_turn_rad: standard deviations of
    how far from base_T_prior (4, 4) the mesh is believed to lie. Raises ModelError.
    """
