"""System files: which arms, which teleoperations between them, with which forces and fixtures. JSON, in the manner of
the dVRK's console files; the schema is data/csa_system.schema.json, an example config/csa/simulated.json.

An error names the file and the path in it: ``simulated.json: $.teleops[0].scale = 0: …``.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Any, cast

from saras import ConfigError, sim
from saras.csa import arms
from saras.csa.setup import Setup
from saras.csa.simulation import CsaExperiment
from saras.csa.udp import udp_settings

#: Bytes of a file; a hundred times what four teleoperations need.
MAX_BYTES = 1 << 20

#: What a role needs: any one of each row, and what it is for.
NEEDS = {
    "master": ((("measured_cp",), "its position"), (("servo_jf", "servo_cf"), "its torque")),
    "slave": (
        (("servo_jp", "servo_cp"), "joint positions"),
        (("measured_cf",), "a source of force"),
        (("measured_js",), "its joints"),
    ),
}

Json = dict[str, Any]


def schema() -> Json:
    """The JSON schema (draft 2020-12)."""
    text = (resources.files("saras") / "data" / "csa_system.schema.json").read_text(encoding="utf-8")
    return cast(Json, json.loads(text))


@dataclass(frozen=True)
class System:
    """A file that was understood."""

    path: Path
    document: Json

    @property
    def teleops(self) -> list[str]:
        """Names, in the order of the file."""
        return [teleop["name"] for teleop in self.document["teleops"]]

    def setup(self, teleop: str | None = None) -> Setup:
        """One teleoperation, the first by default. Raises ConfigError for a name that is none."""
        names = self.teleops
        if teleop is not None and teleop not in names:
            raise ConfigError(f"{self.path}: teleop {teleop!r}: must be one of {', '.join(names)}")
        found = self.document["teleops"][names.index(teleop) if teleop else 0]
        by_name = {arm["name"]: arm for arm in self.document["arms"]}
        io = self.document.get("io", {})
        return Setup(
            path=self.path,
            name=found["name"],
            teleop=found,
            master=by_name[found["master"]],
            slave=by_name[found["slave"]],
            period_s=io.get("period_s", 0.001),
            timeout_s=io.get("timeout_s", 0.1),
            latency_s=io.get("latency_s", 0.002),
            start_timeout_s=io.get("start_timeout_s", 10.0),
            master_model=arms.master_model(by_name[found["master"]]),
            slave_model=arms.slave_model(by_name[found["slave"]]),
        )

    def experiment(self, teleop: str | None = None, duration_s: float = 12.0) -> CsaExperiment:
        """The simulation of one teleoperation of a hand and a PSM, the first by default. Raises ConfigError."""
        setup = self.setup(teleop)
        for arm, known in ((setup.master, "simulated_hand"), (setup.slave, "simulated_psm")):
            if arm["type"] != known:
                raise ConfigError(
                    f"{self.path}: {arm['name']} is a {arm['type']}: saras csa run simulates a {known}; "
                    "roslaunch saras_ros1 csa.launch has the others"
                )
        made = CsaExperiment(duration_s=duration_s)
        made.dt_s = setup.period_s
        made.arm_frequency_rad_s = setup.slave.get("frequency_rad_s", made.arm_frequency_rad_s)
        made.hand = getattr(sim.OperatorConfig, setup.master.get("grip", "firm"))()
        made.teleop = setup.teleop_config()
        made.admittance_m_Ns = setup.teleop.get("admittance_m_Ns", made.admittance_m_Ns)
        made.palpation = setup.palpation()
        regions = [fixture for fixture in setup.teleop.get("fixtures", []) if fixture["type"] == "region"]
        made.region_m = regions[0]["half_width_m"] if regions else None
        phantom = setup.phantom()
        made.height_m = phantom.get("height_m", made.height_m)
        made.model_error_m = phantom.get("model_error_m", made.model_error_m)
        made.stiffness_known = phantom.get("stiffness_known", made.stiffness_known)
        made.tissue = setup.tissue_config()
        return made


def load(path: str | Path) -> System:
    """Reads and checks a system file. Raises ConfigError naming file, path in it, value and bound."""
    path = Path(path)
    try:
        if path.stat().st_size > MAX_BYTES:
            raise ConfigError(f"{path}: size = {path.stat().st_size} bytes: must be at most {MAX_BYTES}")
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise ConfigError(f"{path}: cannot be read: {error}") from error
    try:
        document = json.loads(text, object_pairs_hook=_once, parse_constant=_no_constant)
    except (json.JSONDecodeError, ValueError, RecursionError) as error:
        raise ConfigError(f"{path}: no JSON: {error}") from error
    _check_schema(path, document)
    _check_roles(path, document)
    _check_links(path, document)
    system = System(path, document)
    for index, name in enumerate(system.teleops):
        try:
            system.setup(name).check()
        except ConfigError as error:  # what only the controllers know
            raise ConfigError(f"{path}: $.teleops[{index}]: {error}") from error
    return system


def _once(pairs: list[tuple[str, Any]]) -> Json:
    """A key that is given twice is a mistake, and the last one must not win unseen."""
    made: Json = {}
    for key, value in pairs:
        if key in made:
            raise ValueError(f"the key {key!r} is given twice")
        made[key] = value
    return made


def _no_constant(text: str) -> float:
    raise ValueError(f"{text} is no number")


def _place(parts: Any) -> str:
    return "$" + "".join(f"[{part}]" if isinstance(part, int) else f".{part}" for part in parts)


def _check_schema(path: Path, document: Any) -> None:
    from jsonschema import Draft202012Validator

    errors = sorted(Draft202012Validator(schema()).iter_errors(document), key=lambda error: list(map(str, error.path)))
    if not errors:
        return
    error = errors[0]
    while error.context:  # of an arm: the branch that its type chooses, where there is one
        deeper = [e for e in error.context if e.validator != "const"]
        branches = {e.schema_path[0] for e in error.context}
        wrong_type = {e.schema_path[0] for e in error.context if e.validator == "const"}
        if branches == wrong_type:  # none has this type
            known = ", ".join(sorted({str(e.validator_value) for e in error.context if e.validator == "const"}))
            at = next(e for e in error.context if e.validator == "const")
            raise ConfigError(f"{path}: {_place(at.absolute_path)} = {json.dumps(at.instance)}: must be one of {known}")
        chosen = [e for e in deeper if e.schema_path[0] in branches - wrong_type]
        error = (chosen or deeper or list(error.context))[0]
    value = json.dumps(error.instance)
    shown = value if len(value) <= 60 else value[:57] + "..."
    raise ConfigError(f"{path}: {_place(error.absolute_path)} = {shown}: {error.message}")


def _check_links(path: Path, document: Json) -> None:
    """What the schema cannot know of UDP slaves."""
    for index, arm in enumerate(document["arms"]):
        if arm["type"] != "udp":
            continue
        try:
            udp_settings(arm, len(arms.slave_model(arm).joint_names), path.parent)
        except ConfigError as error:
            raise ConfigError(f"{path}: $.arms[{index}].{error}") from error


def _check_roles(path: Path, document: Json) -> None:
    """Names, and whether each arm can do what its role asks."""
    by_name: dict[str, tuple[int, Json]] = {}
    for index, arm in enumerate(document["arms"]):
        if arm["name"] in by_name:
            raise ConfigError(f"{path}: $.arms[{index}].name = {arm['name']!r}: two arms have this name")
        by_name[arm["name"]] = (index, arm)
    names: set[str] = set()
    busy: dict[str, str] = {}
    for index, teleop in enumerate(document["teleops"]):
        where = f"{path}: $.teleops[{index}]"
        if teleop["name"] in names:
            raise ConfigError(f"{where}.name = {teleop['name']!r}: two teleoperations have this name")
        names.add(teleop["name"])
        for role, needs in NEEDS.items():
            name = teleop[role]
            if name not in by_name:
                raise ConfigError(f"{where}.{role} = {name!r}: must be one of the arms {', '.join(by_name)}")
            if name in busy:
                raise ConfigError(f"{where}.{role} = {name!r}: is taken by the teleoperation {busy[name]}")
            busy[name] = teleop["name"]
            arm_index, arm = by_name[name]
            if arm["type"] not in arms.ROLES[role]:
                known = " or ".join(arms.ROLES[role])
                raise ConfigError(f"{where}.{role} = {name!r}: is a {arm['type']}; must be {known}")
            can = arms.capabilities(arm) + (["measured_cf"] if "topic" in arm.get("force", {}) else [])
            for any_of, purpose in needs:
                if not set(any_of) & set(can):
                    raise ConfigError(
                        f"{path}: $.arms[{arm_index}].capabilities = {json.dumps(can)}: the {role} of "
                        f"{teleop['name']} needs {purpose}: {' or '.join(any_of)}"
                    )
