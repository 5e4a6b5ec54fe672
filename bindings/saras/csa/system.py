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

from saras import ConfigError, csa, sim
from saras.csa.simulation import CsaExperiment

#: Bytes of a file; a hundred times what four teleoperations need.
MAX_BYTES = 1 << 20

#: What the simulated arms can do when the file does not list it.
CAPABILITIES = {
    "simulated_hand": ["measured_cp", "servo_cf"],
    "simulated_psm": ["measured_js", "measured_cp", "measured_cf", "servo_jp"],
}
#: What a role needs: any one of each row, and what it is for.
NEEDS = {
    "master": ((("measured_cp",), "its position"), (("servo_jf", "servo_cf"), "its torque")),
    "slave": ((("servo_jp",), "joint positions"), (("measured_cf",), "a source of force")),
}
ROLES = {"master": ("simulated_hand",), "slave": ("simulated_psm",)}

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

    def experiment(self, teleop: str | None = None, duration_s: float = 12.0) -> CsaExperiment:
        """The simulation of one teleoperation, the first by default. Raises ConfigError for a name that is none."""
        names = self.teleops
        if teleop is not None and teleop not in names:
            raise ConfigError(f"{self.path}: teleop {teleop!r}: must be one of {', '.join(names)}")
        found = self.document["teleops"][names.index(teleop) if teleop else 0]
        arms = {arm["name"]: arm for arm in self.document["arms"]}
        made = CsaExperiment(duration_s=duration_s)
        made.dt_s = self.document.get("io", {}).get("period_s", made.dt_s)
        made.arm_frequency_rad_s = arms[found["slave"]].get("frequency_rad_s", made.arm_frequency_rad_s)
        made.hand = getattr(sim.OperatorConfig, arms[found["master"]].get("grip", "firm"))()
        made.teleop = csa.CsaTeleopConfig(
            **{
                name: found[name]
                for name in ("scale", "desired_force_N", "stiffness_N_m", "mismatch_tolerance_m")
                if name in found
            }
        )
        made.admittance_m_Ns = found.get("admittance_m_Ns", made.admittance_m_Ns)
        palpation = found.get("palpation", {"kind": "none"})
        made.palpation = csa.Palpation(
            kind=getattr(csa.PalpationKind, palpation["kind"].upper()),
            amplitude=palpation.get("amplitude", 0.0),
            frequency_hz=palpation.get("frequency_hz", 1.0),
        )
        fixtures = found.get("fixtures", [])
        made.region_m = fixtures[0]["half_width_m"] if fixtures else None
        phantom = found.get("phantom", {})
        made.height_m = phantom.get("height_m", made.height_m)
        made.model_error_m = phantom.get("model_error_m", made.model_error_m)
        tissue = {name: phantom[name] for name in ("stiffness_N_m", "inclusion_stiffness_N_m") if name in phantom}
        if "inclusion_m" in phantom:
            tissue["inclusion_x_m"], tissue["inclusion_y_m"] = phantom["inclusion_m"]
        made.tissue = sim.TissueConfig(**tissue)
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
    system = System(path, document)
    for index, name in enumerate(system.teleops):
        try:
            system.experiment(name)
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


def _check_roles(path: Path, document: Json) -> None:
    """Names, and whether each arm can do what its role asks."""
    arms: dict[str, tuple[int, Json]] = {}
    for index, arm in enumerate(document["arms"]):
        if arm["name"] in arms:
            raise ConfigError(f"{path}: $.arms[{index}].name = {arm['name']!r}: two arms have this name")
        arms[arm["name"]] = (index, arm)
    names: set[str] = set()
    busy: dict[str, str] = {}
    for index, teleop in enumerate(document["teleops"]):
        where = f"{path}: $.teleops[{index}]"
        if teleop["name"] in names:
            raise ConfigError(f"{where}.name = {teleop['name']!r}: two teleoperations have this name")
        names.add(teleop["name"])
        for role, needs in NEEDS.items():
            name = teleop[role]
            if name not in arms:
                raise ConfigError(f"{where}.{role} = {name!r}: must be one of the arms {', '.join(arms)}")
            if name in busy:
                raise ConfigError(f"{where}.{role} = {name!r}: is taken by the teleoperation {busy[name]}")
            busy[name] = teleop["name"]
            arm_index, arm = arms[name]
            if arm["type"] not in ROLES[role]:
                raise ConfigError(f"{where}.{role} = {name!r}: is a {arm['type']}; must be {' or '.join(ROLES[role])}")
            can = arm.get("capabilities", CAPABILITIES[arm["type"]])
            for any_of, purpose in needs:
                if not set(any_of) & set(can):
                    raise ConfigError(
                        f"{path}: $.arms[{arm_index}].capabilities = {json.dumps(can)}: the {role} of "
                        f"{teleop['name']} needs {purpose}: {' or '.join(any_of)}"
                    )
