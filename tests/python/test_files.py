"""Files of matrices, read back by other programs' readers."""
import csv

import numpy as np
import pytest
import scipy.io
import scipy.sparse

import eigengrain


@pytest.fixture(scope="module")
def exported(small, tmp_path_factory):
    folder = tmp_path_factory.mktemp("matrices")
    system = small.system()
    files = system.export(folder, ["mtx", "petsc", "h5", "csv"])
    assert {file.name for file in files} == {"K.mtx", "M.mtx", "B.mtx", "D.mtx", "K.petsc", "M.petsc", "B.petsc",
                                             "D.petsc", "matrices.h5", "contacts.csv", "bodies.csv", "unknowns.csv"}
    return small, system, folder


@pytest.mark.parametrize("name", ["K", "M", "B", "D"])
def test_matrix_market(exported, name):
    _, system, folder = exported
    read = scipy.io.mmread(folder / f"{name}.mtx").tocsr()
    assert (read != system.matrix(name)).nnz == 0  # 17 digits are all of a double


@pytest.mark.parametrize("name", ["K", "M", "B", "D"])
def test_petsc(exported, name):
    PETSc = pytest.importorskip("petsc4py.PETSc")
    _, system, folder = exported
    viewer = PETSc.Viewer().createBinary(str(folder / f"{name}.petsc"), "r", comm=PETSc.COMM_SELF)
    offsets, columns, values = PETSc.Mat().load(viewer).getValuesCSR()
    read = scipy.sparse.csr_matrix((values, columns, offsets), shape=getattr(system, name).shape)
    assert (read != system.matrix(name)).nnz == 0


def test_hdf5_in_five_lines(exported):
    h5py = pytest.importorskip("h5py")
    state, system, folder = exported
    with h5py.File(folder / "matrices.h5") as file:
        group = file["K"]
        shape = group.attrs["rows"], group.attrs["columns"]
        blocks = group["data"][:].reshape(-1, 3, 3)
        read = scipy.sparse.bsr_matrix((blocks, group["indices"][:], group["indptr"][:]), shape=shape)
        assert (read != system.K).nnz == 0
        for name in ("M", "B", "D"):
            assert file[name].attrs["rows"] == getattr(system, name).shape[0]
        np.testing.assert_array_equal(file["unknowns/row"][:], system.body)
        np.testing.assert_array_equal(file["unknowns/free"][:], system.free)
        np.testing.assert_array_equal(file["bodies/position"][:], state.bodies.position)
        np.testing.assert_array_equal(file["elements/normal"][:], system.elements.normal)
        np.testing.assert_array_equal(file["unknowns/ball"][:], state.bodies.identity[system.body])


def test_tables(exported):
    state, system, folder = exported
    with open(folder / "contacts.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    contacts, identity = state.contacts, state.bodies.identity
    assert [int(row["ball a"]) for row in rows] == identity[contacts.a].tolist()
    np.testing.assert_array_equal([float(row["force z [N]"]) for row in rows], contacts.force[:, 2])
    np.testing.assert_array_equal([float(row["overlap [m]"]) for row in rows], contacts.overlap)
    with open(folder / "unknowns.csv", newline="") as file:
        unknowns = list(csv.DictReader(file))
    assert len(unknowns) == system.size
    assert unknowns[3]["component"] == ("tx" if system.is_rotation[1] else "ux")
    np.testing.assert_array_equal([float(row["mass [kg or kg m2]"]) for row in unknowns], system.mass)
    with open(folder / "bodies.csv", newline="") as file:
        bodies = list(csv.DictReader(file))
    np.testing.assert_array_equal([float(row["x [m]"]) for row in bodies], state.bodies.position[:, 0])


def test_unknown_formats_and_folders(small, tmp_path):
    with pytest.raises(eigengrain.InputError, match='did you mean "petsc"'):
        small.system().export(tmp_path, ["petcs"])
    (tmp_path / "file").write_text("")
    with pytest.raises(eigengrain.InputError, match="file"):
        small.system().export(tmp_path / "file" / "below", ["csv"])
