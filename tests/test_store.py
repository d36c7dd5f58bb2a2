"""Table files: what is written comes back, and nothing else is accepted."""

import io

import h5py
import numpy as np
import pytest

from contactlaw import laws, table
from contactlaw.equation.outcome import STORED
from contactlaw.table import file as store

MYC = laws.law("myc")
SMALL = table.Settings(inelasticity_nodes=9, log_overload_step=0.5)


@pytest.fixture(scope="module")
def built():
    return table.with_shapes(table.build(MYC, SMALL))


@pytest.fixture
def path(built, tmp_path):
    store.write(built, tmp_path / "myc.h5")
    return tmp_path / "myc.h5"


def test_round_trip_is_exact(built, path):
    read = store.read(path)
    assert (read.law, read.settings) == (built.law, built.settings)
    for ours, theirs in zip(read.grid.segments, built.grid.segments, strict=True):
        for one, other in zip(ours, theirs, strict=True):
            np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(read.grid.elastic_compression, built.grid.elastic_compression)
    np.testing.assert_array_equal(read.states, built.states)
    for name, values in built.fields.items():
        np.testing.assert_array_equal(read.fields[name], values)


def test_file_explains_itself(path):
    with h5py.File(path) as file:
        assert file.attrs["law"] == "myc"
        assert "Majeed" in file.attrs["law_source"]
        assert file.attrs["rtol"] == SMALL.rtol
        assert file.attrs["contactlaw_version"]
        for name in STORED:
            assert "[" in file[f"fields/{name}"].attrs["description"]  # a unit


def edit(path, change):
    """Change a file as a program of another version would: with a checksum that fits."""
    image = io.BytesIO(path.read_bytes())
    with h5py.File(image, "r+") as file:
        change(file)
    path.write_bytes(store._sign(image.getvalue()[store._BLOCK :]))


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
        (
            lambda f: f["fields/restitution"].write_direct(
                np.full(f["fields/restitution"].shape, 7.0)
            ),
            "outside 0 to 1",
        ),
        (lambda f: f["law"].attrs.modify("outcome_kinks", [1.0, 2.0]), "kinks"),
        (lambda f: f["inelasticity"].write_direct(np.linspace(0, 5, 9)), "axes"),
        (lambda f: f.attrs.modify("stretch", 3.0), "axes"),
    ],
)
def test_a_wrong_file_is_refused(path, change, message):
    edit(path, change)
    with pytest.raises(ValueError, match=message) as error:
        store.read(path)
    assert "contactlaw table build" in str(error.value)


@pytest.mark.parametrize("content", [b"", b"no table", b"\x89HDF\r\n\x1a\n" * 100])
def test_what_is_no_table_is_refused(tmp_path, content):
    (tmp_path / "x.h5").write_bytes(content)
    with pytest.raises(store.DamagedTableError, match="cannot use .*x.h5: it is not a table"):
        store.read(tmp_path / "x.h5")


def test_any_altered_byte_is_found(path):
    content = path.read_bytes()
    rng = np.random.default_rng(3)
    for place in rng.integers(len(content), size=300):
        altered = bytearray(content)
        altered[place] ^= int(rng.integers(1, 256))
        path.write_bytes(altered)
        try:
            read = store.read(path)
        except store.DamagedTableError:
            continue
        # the padding behind the checksum, which says nothing, is all that may change
        assert 93 < place < store._BLOCK
        assert read.law == MYC


def test_any_truncation_is_found(path):
    content = path.read_bytes()
    for length in [*range(0, len(content), 997), len(content) - 1]:
        path.write_bytes(content[:length])
        with pytest.raises(store.DamagedTableError):
            store.read(path)


def test_hdf5_programs_read_it(path):
    with h5py.File(path) as file:
        assert file.attrs["complete"]
        assert file["fields/restitution"].shape == (
            SMALL.inelasticity_nodes,
            sum(segment["shares"].size for segment in file["segments"].values()),
        )


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


def test_a_folder_that_is_not_there(built, tmp_path):
    with pytest.raises(FileNotFoundError, match="missing"):
        store.write(built, tmp_path / "missing" / "t.h5")


def test_packaged(monkeypatch, path):
    store.packaged.cache_clear()
    (path.parent / "data").mkdir()
    monkeypatch.setattr(store.resources, "files", lambda package: path.parent)
    assert store.packaged(laws.law("thornton")) is None
    path.rename(path.parent / "data" / "myc.h5")
    assert store.packaged(MYC).law == MYC
    store.packaged.cache_clear()
    (path.parent / "data" / "myc.h5").write_bytes(b"damaged")
    with pytest.raises(store.DamagedTableError, match="reinstall contactlaw"):
        store.packaged(MYC)
    store.packaged.cache_clear()
