"""The map as a PLY file: what is written is read, by us and by VTK; what is not understood is refused by name."""

from __future__ import annotations

import numpy as np
import pytest

import saras
from saras.model import StiffMesh
from saras.sim.organ import organ

VERTICES, TRIANGLES = organ(1, subdivisions=2)


@pytest.fixture
def learned():
    rng = np.random.default_rng(1)
    stiffness, std = rng.uniform(200, 1500, len(VERTICES)), rng.uniform(5, 50, len(VERTICES))
    stiffness[::7], std[::7] = np.nan, np.inf
    return StiffMesh(VERTICES, TRIANGLES, stiffness, std)


def test_what_is_saved_is_loaded(learned, tmp_path):
    path = tmp_path / "organ.ply"
    learned.save(path)
    again = StiffMesh.load(path)
    np.testing.assert_allclose(again.vertices, learned.vertices, atol=1e-8)
    np.testing.assert_array_equal(again.triangles, learned.triangles)
    np.testing.assert_array_equal(again.stiffness_N_m, learned.stiffness_N_m)
    np.testing.assert_array_equal(again.stiffness_std_N_m, learned.stiffness_std_N_m)


def test_vtk_reads_the_same_mesh_and_colours(learned, tmp_path):
    vtk_io = pytest.importorskip("vtkmodules.vtkIOPLY")
    from vtkmodules.util.numpy_support import vtk_to_numpy

    path = tmp_path / "organ.ply"
    learned.save(path)
    reader = vtk_io.vtkPLYReader()
    reader.SetFileName(str(path))
    reader.Update()
    data = reader.GetOutput()
    np.testing.assert_allclose(vtk_to_numpy(data.GetPoints().GetData()), VERTICES, atol=1e-8)
    assert data.GetNumberOfPolys() == len(TRIANGLES)
    colours = vtk_to_numpy(data.GetPointData().GetArray("RGBA"))
    np.testing.assert_array_equal(colours, learned.colours())


def test_unknown_is_grey_and_stiffer_is_brighter(learned):
    colours = learned.colours().astype(int)
    assert (colours[::7, :3] == 160).all()
    known = np.isfinite(learned.stiffness_N_m)
    order = np.argsort(learned.stiffness_N_m[known])
    assert (np.diff(colours[known][order][:, 1]) >= 0).all()
    assert not (np.ptp(colours[known][:, :3], axis=1) == 0).any()  # no known vertex looks unknown


def test_bad_files_and_arrays_are_refused_by_name(learned, tmp_path):
    path = tmp_path / "organ.ply"
    learned.save(path)
    whole = path.read_bytes()
    for content, said in (
        (b"", "PLY file"),
        (b"no mesh at all", "PLY file"),
        (whole[: len(whole) // 2], "PLY file"),
        (whole.replace(b"stiffness_std_N_m", b"stiffness_xyz_N_m"), "without stiffness_std_N_m"),
    ):
        path.write_bytes(content)
        with pytest.raises(saras.ModelError, match=said):
            StiffMesh.load(path)
    with pytest.raises(FileNotFoundError):
        StiffMesh.load(tmp_path / "none.ply")
    with pytest.raises(saras.ModelError, match=r"stiffness_N_m: shape \(3,\)"):
        StiffMesh(VERTICES, TRIANGLES, np.zeros(3), np.zeros(len(VERTICES)))
    with pytest.raises(saras.ModelError, match="must be >= 0"):
        StiffMesh(VERTICES, TRIANGLES, np.zeros(len(VERTICES)), np.full(len(VERTICES), -1.0))
    with pytest.raises(saras.ModelError, match="millimetres"):
        StiffMesh(1e3 * VERTICES, TRIANGLES, np.zeros(len(VERTICES)), np.zeros(len(VERTICES)))
