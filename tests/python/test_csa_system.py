"""System files: the shipped ones, refusals that name the path in the file, and the command."""

from __future__ import annotations

import copy
import json
from pathlib import Path

import numpy as np
import pytest

import saras
from saras import cli, csa
from saras.kinematics import dvrk, mesa
from saras.net import keys

jsonschema = pytest.importorskip("jsonschema")
from saras.csa import system

SHIPPED = sorted((Path(__file__).parents[2] / "config" / "csa").glob("*.json"))
SIMULATED = Path(__file__).parents[2] / "config" / "csa" / "simulated.json"
GOOD = json.loads(SIMULATED.read_text())


def changed(change) -> dict:
    document = copy.deepcopy(GOOD)
    change(document)
    return document


def saved(tmp_path: Path, document: object) -> Path:
    path = tmp_path / "system.json"
    path.write_text(document if isinstance(document, str) else json.dumps(document))
    return path


def test_the_schema_is_one() -> None:
    jsonschema.Draft202012Validator.check_schema(system.schema())


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_shipped_files_are_understood(path: Path) -> None:
    loaded = system.load(path)
    made, teleop = loaded.setup(loaded.teleops[0]), loaded.document["teleops"][0]
    assert made.teleop_config().scale == teleop["scale"]
    assert made.palpation().amplitude == teleop["palpation"].get("amplitude", 0.0)
    assert made.slave_config().arm_lag_s == 2.0 / made.slave["frequency_rad_s"]
    for outcome in (made.surface().touch(made.start()), made.compliance_config(), made.fixtures()):
        assert outcome is not None


def test_each_kind_of_fixture_is_built_from_a_file(tmp_path: Path) -> None:
    trimesh = pytest.importorskip("trimesh")
    trimesh.creation.icosphere(radius=0.01).export(tmp_path / "vessel.stl")
    box = [[x, y, z] for x in (0.0, 0.1) for y in (0.0, 0.1) for z in (-0.3, 0.0)]
    kinds = [
        {"type": "region", "half_width_m": 0.01},
        {"type": "plane", "name": "floor", "point_m": [0, 0, -0.2], "normal": [0, 0, 2], "margin_m": 0.001},
        {"type": "line", "name": "needle", "point_m": [0, 0, 0], "direction": [0, 1, 1], "radius_m": 0.002},
        {"type": "path", "name": "cut", "points_m": [[0, 0, 0], [0.01, 0, 0], [0.01, 0.01, 0]]},
        {"type": "remote_centre", "name": "trocar", "centre_m": [0, 0, 0], "soft": True},
        {"type": "hull", "name": "room", "points_m": box},
        {"type": "mesh", "name": "vessel", "file": "vessel.stl", "xyz_m": [0, 0, -0.1], "margin_m": 0.002},
    ]
    loaded = system.load(saved(tmp_path, changed(lambda d: d["teleops"][0].update(fixtures=kinds))))
    made = csa.FixtureSet(loaded.setup().fixtures())
    assert made.names == ["region", "floor", "needle", "cut", "trocar", "room", "vessel"]
    pose = np.eye(4)
    pose[:3, 3] = [0.0, 0.0, -0.085]
    distance = made.step(pose, 0.01, shaft=[0.0, 0.0, -1.0]).distance_m
    assert distance[1] == pytest.approx(-0.085 + 0.2 - 0.001)
    assert distance[2] == pytest.approx(0.002 - 0.085 / np.sqrt(2.0))
    assert distance[6] == pytest.approx(0.015 - 0.01 - 0.002, abs=1e-4)
    assert loaded.experiment().region_m == 0.01


UDP = json.loads((Path(__file__).parents[2] / "config" / "csa" / "udp.json").read_text())


def test_a_udp_slave_has_the_kinematics_that_the_file_names(tmp_path: Path) -> None:
    assert system.load(SIMULATED).setup().udp() is None
    psm = system.load(saved(tmp_path, UDP)).setup()
    np.testing.assert_allclose(psm.slave_model.forward(np.full(6, 0.1)), dvrk.psm().forward(np.full(6, 0.1)))
    settings = psm.udp()
    assert (settings.bind.port, settings.slave.port, settings.key_file) == (48030, 48031, None)
    assert settings.remote.gate.joint_reach == (0.3, 0.3, 0.02, 0.3, 0.3, 0.3)
    document, trocar = copy.deepcopy(UDP), [0.18, 0.0, -0.1]
    key = tmp_path / "link.keys"
    keys.save(key, keys.draw())
    document["arms"][1]["kinematics"] = {"type": "saras_arm", "trocar_m": trocar}
    document["arms"][1]["link"] = {"key_file": "link.keys", "bind_host": "0.0.0.0", "state_timeout_s": 0.5}
    document["arms"][1]["joint_reach"] = [0.1, 0.2, 0.3, 0.4, 0.05, 0.6]
    saras_arm = system.load(saved(tmp_path, document)).setup()
    assert saras_arm.slave_model.joint_names == mesa.JOINT_NAMES
    assert [f.name for f in saras_arm.slave_model.fixtures] == ["trocar"]
    settings = saras_arm.udp()
    assert settings.key_file == key and settings.remote.state_timeout_s == 0.5
    assert settings.remote.gate.joint_reach == (0.1, 0.2, 0.3, 0.4, 0.05, 0.6)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda a: a.pop("kinematics"), r"\$\.arms\[1\] = .*'kinematics' is a required property"),
        (
            lambda a: a["kinematics"].update(type="robot"),
            r"\$\.arms\[1\]\.kinematics\.type = \"robot\": must be one of dvrk_",
        ),
        (lambda a: a["kinematics"].update(side="left"), r"\$\.arms\[1\]\.kinematics = .*'side'"),
        (lambda a: a["kinematics"].update(tool="123"), r"\$\.arms\[1\]\..*123"),
        (lambda a: a.update(joint_reach=[0.3] * 7), r"\$\.arms\[1\]\.joint_reach = .*7 numbers: must be 6.*dvrk_psm"),
        (lambda a: a.update(joint_reach=[0.0] * 6), r"\$\.arms\[1\]\.joint_reach\[0\] = 0"),
        (lambda a: a["link"].update(slave_port=0), r"\$\.arms\[1\]\.link\.slave_port = 0"),
        (lambda a: a["link"].update(state_timeout_s=5), r"\$\.arms\[1\]\.link\.state_timeout_s = 5"),
        (lambda a: a["link"].update(key="x"), r"\$\.arms\[1\]\.link = .*'key'"),
        (lambda a: a["link"].update(key_file="no.keys"), r"\$\.arms\[1\]\.link\.key_file = 'no.keys': no file"),
        (lambda a: a["link"].update(bind_host="0.0.0.0"), r"\$\.arms\[1\]\.link\.bind_host = 0\.0\.0\.0:.*key file"),
        (lambda a: a.update(capabilities=["servo_jp"]), r"\$\.arms\[1\]\.capabilities = .*its joints"),
    ],
)
def test_refusals_of_a_udp_slave_name_the_path_in_the_file(tmp_path: Path, change, words: str) -> None:
    document = copy.deepcopy(UDP)
    change(document["arms"][1])
    with pytest.raises(saras.ConfigError, match=words) as refused:
        system.load(saved(tmp_path, document))
    assert "system.json" in str(refused.value)


def test_a_file_is_simulated_as_it_says() -> None:
    made, teleop = system.load(SIMULATED).experiment(), GOOD["teleops"][0]
    assert made.teleop.scale == teleop["scale"] and made.dt_s == GOOD["io"]["period_s"]
    assert made.palpation.amplitude == teleop["palpation"]["amplitude"]
    assert made.tissue.inclusion_x_m == teleop["phantom"]["inclusion_m"][0]
    assert made.region_m == teleop["fixtures"][0]["half_width_m"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda d: d.pop("arms"), r"\$ = .*'arms' is a required property"),
        (lambda d: d.update(version=2), r"\$\.version = 2"),
        (lambda d: d.update(extra=1), r"\$ = .*'extra'"),
        (lambda d: d["io"].update(period_s=0), r"\$\.io\.period_s = 0"),
        (lambda d: d["arms"][1].update(frequency_rad_s="fast"), r"\$\.arms\[1\]\.frequency_rad_s = \"fast\""),
        (lambda d: d["arms"][1].update(colour="red"), r"\$\.arms\[1\] = .*'colour'"),
        (lambda d: d["arms"][1].update(type="robot"), r"\$\.arms\[1\]\.type = \"robot\""),
        (lambda d: d["arms"][1].update(name="MTML"), r"\$\.arms\[1\]\.name = 'MTML': two arms"),
        (lambda d: d["teleops"][0].update(scale=0), r"\$\.teleops\[0\]\.scale = 0"),
        (lambda d: d["teleops"][0].update(slave="PSM9"), r"\$\.teleops\[0\]\.slave = 'PSM9': must be one of"),
        (lambda d: d["teleops"][0].update(slave="MTML"), r"\$\.teleops\[0\]\.slave = 'MTML': is taken"),
        (lambda d: d["teleops"][0].update(master="PSM1", slave="MTML"), r"\.master = 'PSM1': is a simulated_psm"),
        (lambda d: d["teleops"].append(dict(d["teleops"][0])), r"\$\.teleops\[1\]\.name = .*two teleoperations"),
        (lambda d: d["teleops"][0]["palpation"].update(kind="rub"), r"\$\.teleops\[0\]\.palpation\.kind = \"rub\""),
        (lambda d: d["teleops"][0]["fixtures"][0].update(type="cage"), r"fixtures\[0\]\.type = \"cage\": must be"),
        (
            lambda d: d["teleops"][0]["fixtures"].append(
                {"type": "plane", "name": "w", "point_m": [0, 0, 0], "normal": [0, 0, 0]}
            ),
            r"\$\.teleops\[0\]: fixtures\[1\]: .*normal",
        ),
        (lambda d: d["teleops"][0]["fixtures"][0].pop("half_width_m"), r"\$\.teleops\[0\]\.fixtures\[0\] = "),
        (lambda d: d["teleops"][0].update(desired_force_N=9.0), r"\$\.teleops\[0\]: desired_force_N = 9"),
        (lambda d: d["arms"][0].update(capabilities=["measured_cp"]), r"\$\.arms\[0\]\.capabilities = .*its torque"),
        (lambda d: d["arms"][0].update(capabilities=["servo_jf"]), r"\$\.arms\[0\]\.capabilities = .*its position"),
        (lambda d: d["arms"][1].update(capabilities=["servo_jp"]), r"\.arms\[1\]\.capabilities = .*a source of force"),
        (lambda d: d["arms"][1].update(capabilities=["measured_cf"]), r"\.arms\[1\]\.capabilities = .*joint positions"),
        (lambda d: d["arms"][1].update(capabilities=["servo_jp", "measured_cf"]), r"\.capabilities = .*its joints"),
        (lambda d: d["arms"][1].update(tool="spoon"), r"\$\.teleops\[0\]: .*spoon"),
        (lambda d: d["arms"][1].update(force={"topic": "no topic"}), r"\$\.arms\[1\]\.force\.topic = \"no topic\""),
        (lambda d: d["teleops"][0].update(scheduled=False), r"\$\.teleops\[0\]: admittance_m_Ns = 0\.05"),
        (lambda d: d["teleops"][0].pop("phantom"), r"\$\.teleops\[0\]: model: is needed"),
        (lambda d: d["teleops"][0].update(model={"type": "plane"}), r"\$\.teleops\[0\]\.model = .*'point_m'"),
        (lambda d: d["teleops"][0].update(model={"type": "cloud"}), r"\$\.teleops\[0\]\.model\.type = \"cloud\""),
        (lambda d: d["teleops"][0].update(model={"type": "mesh", "file": "no.stl"}), r"\$\.teleops\[0\]: .*no\.stl"),
    ],
)  # fmt: skip
def test_refusals_name_the_path_in_the_file(tmp_path: Path, change, words: str) -> None:
    with pytest.raises(saras.ConfigError, match=words) as told:
        system.load(saved(tmp_path, changed(change)))
    assert "system.json" in str(told.value)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("{", "no JSON"),
        ('{"version": 1, "version": 1}', "given twice"),
        ('{"version": NaN}', "NaN is no number"),
        ("[" * 100_000, "no JSON"),
        ("[]", r"\$ = \[\]"),
    ],
)
def test_what_is_no_json_is_refused(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(saras.ConfigError, match=words):
        system.load(saved(tmp_path, text))
    with pytest.raises(saras.ConfigError, match="cannot be read"):
        system.load(tmp_path / "nowhere.json")


def test_the_command_checks_and_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.main(["csa", "check", str(SIMULATED)]) == 0
    assert "MTML -> PSM1" in capsys.readouterr().out
    arrays = tmp_path / "run.npz"
    assert cli.main(["csa", "run", str(SIMULATED), "--duration", "5", "--npz", str(arrays)]) == 0
    out = capsys.readouterr().out
    assert "FULL_CONTACT" in out and "holds: none" in out
    result = np.load(arrays)
    assert len(result["t"]) == 5000 and np.isfinite(result["normal_force_N"]).all()
    assert cli.main(["csa", "run", str(SIMULATED), "--duration", "1"]) == 2
    assert "[5, 600]" in capsys.readouterr().err
