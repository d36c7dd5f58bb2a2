"""Table files: what is written comes back, and nothing else is accepted."""

import io
import os
import socket

import h5py
import numpy as np
import pytest

import contactlaw as cl
from contactlaw import laws, table
from contactlaw.equation import force
from contactlaw.equation.outcome import STORED
from contactlaw.physical.scaling import law_of
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
    for ours, theirs in zip(read.grid.axes, built.grid.axes, strict=True):
        assert (ours.name, ours.stretch) == (theirs.name, theirs.stretch)
        for pair in zip(ours.segments, theirs.segments, strict=True):
            for one, other in zip(*pair, strict=True):
                np.testing.assert_array_equal(one, other)
    np.testing.assert_array_equal(read.grid.elastic_compression, built.grid.elastic_compression)
    np.testing.assert_array_equal(read.states, built.states)
    for name, values in built.fields.items():
        np.testing.assert_array_equal(read.fields[name], values)


def test_parameters_of_a_law_are_numbers_in_its_file_and_keep_their_order(tmp_path):
    """The law's name lists them in order, but HDF5 sorts attributes by name by default."""
    law = law_of(cl.Pair("gamma-alumina", "glass"), "fem")
    assert list(law.parameters) != sorted(law.parameters)
    store.write(table.build(law, SMALL), tmp_path / "t.h5")
    with h5py.File(tmp_path / "t.h5") as file:
        assert file.attrs["law"] == "fem"
        assert dict(file["law/parameters"].attrs) == law.parameters
    read = store.read(tmp_path / "t.h5").law
    assert (read.family, read.name) == (law.family, law.name)
    assert list(read.parameters.items()) == list(law.parameters.items())


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


def put(name, value, *place):
    """Change that puts one value into a dataset."""

    def change(file):
        file[name][place or (2,) * file[name].ndim] = value

    return change


def store_anew(name, **options):
    """Change that stores a dataset in another way."""

    def change(file):
        values = file[name][()].astype(options.get("dtype"))
        del file[name]
        file.create_dataset(name, data=values, **options)

    return change


def declare_huge(file):
    del file["fields/restitution"]
    file.create_dataset("fields/restitution", (10**6, 10**6), "f8")


def declare_a_huge_row(file):
    del file["law/loading_kinks"]
    file.create_dataset("law/loading_kinks", (10**13,), "f8", chunks=(1024,))


def other_law(place, value):
    """Change of the law's data that would lead a kernel astray."""

    def change(file):
        file["law/data"][place] = value

    return change


def put_group(file):
    del file["law/data"]
    file.create_group("law/data")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda f: f.attrs.pop("complete"), "complete"),
        (lambda f: f.attrs.modify("schema", 99), "schema"),
        (lambda f: f.attrs.modify("format", "something"), "format"),
        (lambda f: f.pop("fields/contact_time"), "contact_time"),
        (put("fields/restitution", np.nan), "restitution holds nan, outside 0 to 1"),
        (lambda f: f.attrs.modify("inelasticity_nodes", 10), "axes are not those of its settings"),
        (put("law/outcome_kinks", 1.5, 0), "kinks"),
        (put("axes/inelasticity/0/shares", 0.4, 2), "axes along inelasticity do not rise"),
        (put("axes/log_overload/0/shares", 0.0, 1), "axes along log_overload do not rise"),
        (put("axes/log_overload/1/start", 1.0, ...), "along log_overload do not meet"),
        (put("axes/log_overload/1/end", 3.0, ...), "axes are not those of its settings"),
        (lambda f: f["axes/inelasticity"].pop("0"), "along inelasticity do not meet"),
        (lambda f: f["axes/log_overload"].attrs.modify("stretch", 9.0), "axes are not those"),
        (put("fields/wave_rate", -0.5), "wave_rate holds -0.5"),
        (put("fields/contact_time", 1e300), r"contact_time holds 1e\+300"),
        (put("fields/contact_time", 0.0), "contact_time holds 0"),
        (put("fields/compression_ratio", -1.0), "compression_ratio holds -1"),
        (put("elastic_compression", np.inf), "elastic_compression holds inf"),
        (put("shapes/states", -1.0, 0, 0, 0, 5), "times that do not grow"),
        (put("shapes/states", np.inf, 0, 0, 1, 5), "shapes/states holds inf"),
        (put("shapes/states", 9e3, 0, 0, 0, 5), "times that do not grow"),
        (declare_huge, r"shape \(1000000, 1000000\), not float64 of shape \(9, "),
        (declare_a_huge_row, "law/loading_kinks has 80000000000000 bytes, above"),
        (store_anew("fields/restitution", dtype="c16"), "holds complex128 .* not float64"),
        (store_anew("fields/restitution", dtype="i1"), "holds int8 .* not float64"),
        (store_anew("shapes/states", dtype="f8"), "holds float64 .* not float32"),
        (put_group, "'Group' object has no attribute"),
        (store_anew("law/waves", dtype="f4"), "law/waves holds float32"),
        (lambda f: f.attrs.create("stretch", np.nan), "stretch"),
        (lambda f: f.attrs.create("inelasticity_nodes", 48.5), "axes are not those"),
        (other_law(0, 2.5), "there is a whole number up to"),
        (other_law(1, 500), "ends within its"),
        (other_law(force.HEADER + 3 + force.AT, 1e5), "whole number up to"),
        (other_law(force.HEADER + 1, -1.0), "do not follow each other"),
        (other_law(force.HEADER + 4, np.nan), "law/data holds nan"),
        (lambda f: f.attrs.create("certificate", 3), "JSON"),
        (lambda f: f.attrs.create("certificate", "[" * 60_000), "recursion"),
    ],
)
def test_a_wrong_file_is_refused(path, change, message):
    edit(path, change)
    with pytest.raises(store.DamagedTableError, match=message) as error:
        store.read(path)
    assert "contactlaw table build" in str(error.value)


def make_socket(path):
    with socket.socket(socket.AF_UNIX) as end:
        end.bind(path.name)  # a socket's path may not be long


def make_sparse(path):
    with path.open("wb") as file:
        file.truncate(1 << 40)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (os.mkfifo, "no regular file"),  # opening a pipe waits for a writer
        (lambda path: path.symlink_to("/dev/zero"), "no regular file"),  # a file without an end
        (lambda path: path.symlink_to(path), "no regular file"),
        (lambda path: path.symlink_to("nowhere"), "no regular file"),
        (lambda path: path.symlink_to(path.parent), "no regular file"),
        (lambda path: path.mkdir(), "no regular file"),
        (make_socket, "no regular file"),
        (make_sparse, "1099511627776 bytes, and no such file more than"),
    ],
    ids=["pipe", "device", "cycle", "lost link", "link to a folder", "folder", "socket", "sparse"],
)
def test_what_is_no_file_of_bounded_size_is_refused(tmp_path, monkeypatch, make, message):
    monkeypatch.chdir(tmp_path)
    make(tmp_path / "x.h5")
    with pytest.raises(store.DamagedTableError, match=f"cannot use .*x.h5: .*{message}.* Build it"):
        store.read(tmp_path / "x.h5")


def test_a_link_to_a_table_is_followed(path, tmp_path):
    (tmp_path / "link.h5").symlink_to(path)
    assert store.read(tmp_path / "link.h5").law == MYC


def test_no_file_is_written_that_would_not_be_read(built, tmp_path, monkeypatch):
    monkeypatch.setattr(store, "LARGEST", 10_000)
    with pytest.raises(OSError, match="above the limit of 10000: take coarser"):
        store.write(built, tmp_path / "t.h5")
    assert list(tmp_path.iterdir()) == []


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
        # Only the meaningless padding behind the checksum may change.
        assert 93 < place < store._BLOCK
        assert read.law == MYC


def test_any_truncation_is_found(path):
    content = path.read_bytes()
    for length in [*range(0, len(content), 997), len(content) - 1]:
        path.write_bytes(content[:length])
        with pytest.raises(store.DamagedTableError, match=f"cannot use .*{path.name}: "):
            store.read(path)


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


def test_what_is_not_there_is_named(built, tmp_path):
    for act in (lambda path: store.write(built, path), store.read):
        with pytest.raises(FileNotFoundError, match="missing"):
            act(tmp_path / "missing" / "t.h5")


def test_a_file_of_another_numpy_is_read(monkeypatch, path):
    """Sines and powers of another numpy version differ in the last digit."""
    monkeypatch.setattr(store.shapes, "SHARES", store.shapes.SHARES * (1 + 4e-16))
    store.read(path)
    monkeypatch.setattr(store.shapes, "SHARES", store.shapes.SHARES * (1 + 1e-9))
    with pytest.raises(store.DamagedTableError, match="shapes/shares are not those"):
        store.read(path)


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
