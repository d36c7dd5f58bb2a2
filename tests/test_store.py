"""Table files: what is written comes back, and nothing else is accepted."""

import h5py
import numpy as np
import pytest

from contactlaw import store, table

SMALL = table.Settings(inelasticity_nodes=9, log_overload_step=0.5, elastic_nodes=9)


@pytest.fixture(scope="module")
def built():
    return table.build("myc", SMALL)


@pytest.fixture
def path(built, tmp_path):
    store.write(built, tmp_path / "myc.h5")
    return tmp_path / "myc.h5"


def test_round_trip_is_exact(built, path):
    read = store.read(path)
    assert (read.law, read.settings) == (built.law, built.settings)
    for ours, theirs in zip(read.segments, built.segments, strict=True):
        np.testing.assert_array_equal(ours, theirs)
    np.testing.assert_array_equal(read.elastic_compression, built.elastic_compression)
    for name, values in built.fields.items():
        np.testing.assert_array_equal(read.fields[name], values)


def test_file_explains_itself(path):
    with h5py.File(path) as file:
        assert file.attrs["law"] == "myc"
        assert "Majeed" in file.attrs["law_source"]
        assert file.attrs["rtol"] == SMALL.rtol
        assert file.attrs["contactlaw_version"]
        for name in table.FIELDS:
            assert "[" in file[f"fields/{name}"].attrs["description"]  # a unit


def edit(path, change):
    with h5py.File(path, "r+") as file:
        change(file)


def put_nan(file):
    file["fields/restitution"][2, 2] = np.nan


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda f: f.attrs.pop("complete"), "complete"),
        (lambda f: f.attrs.modify("schema", 99), "schema"),
        (lambda f: f.attrs.modify("format", "something"), "format"),
        (lambda f: f.pop("fields/contact_time"), "contact_time"),
        (put_nan, "not finite"),
        (lambda f: f.attrs.modify("inelasticity_nodes", 10), "shape"),
    ],
)
def test_a_wrong_file_is_refused(path, change, message):
    edit(path, change)
    with pytest.raises(ValueError, match=message) as error:
        store.read(path)
    assert "contactlaw table build" in str(error.value)


def test_not_hdf5_is_refused(tmp_path):
    (tmp_path / "x.h5").write_text("no table")
    with pytest.raises(ValueError, match="cannot use"):
        store.read(tmp_path / "x.h5")


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="nothing.h5"):
        store.read(tmp_path / "nothing.h5")


def test_a_failed_write_leaves_the_old_file_and_nothing_else(built, path, monkeypatch):
    before = path.read_bytes()

    def fail(file, table):
        file["half"] = np.zeros(10)
        raise KeyboardInterrupt

    monkeypatch.setattr(store, "_fill", fail)
    with pytest.raises(KeyboardInterrupt):
        store.write(built, path)
    assert [p.name for p in path.parent.iterdir()] == ["myc.h5"]
    assert path.read_bytes() == before


def test_a_law_without_a_packaged_table_is_built(monkeypatch, tmp_path):
    monkeypatch.setattr(store.resources, "files", lambda package: tmp_path)
    monkeypatch.setattr(table, "build", lambda law: f"built {law}")
    store.packaged.cache_clear()
    assert store.packaged("myc") == "built myc"
    store.packaged.cache_clear()
