"""Table files: what is written comes back, and nothing else is accepted."""

import io
import json
import os
from pathlib import Path

import h5py
import numpy as np
import pytest

from contactlaw import laws, table
from contactlaw.equation import force
from contactlaw.table import file as store
from contactlaw.table import lookup

MYC = laws.law("myc")
SMALL = table.Settings(rows=9, columns=8)


@pytest.fixture(scope="module")
def built():
    return table.with_shapes(table.build(MYC, SMALL))


@pytest.fixture
def path(built, tmp_path):
    store.write(built, tmp_path / "myc.h5")
    return tmp_path / "myc.h5"


def test_round_trip_is_exact(built, path):
    (path.parent / "link.h5").symlink_to(path)
    read = store.read(path.parent / "link.h5")
    assert (read.law, read.settings) == (built.law, built.settings)
    store.write(read, path.parent / "again.h5")
    assert (path.parent / "again.h5").read_bytes() == path.read_bytes()
    np.testing.assert_array_equal(read.packed, built.packed)
    np.testing.assert_array_equal(read.histories, built.histories)
    assert read.certificate == built.certificate


def test_file_explains_itself(path):
    with h5py.File(path) as file:
        about = json.loads(file.attrs["about"])
        assert about["law"]["family"] == "myc" and "Majeed" in about["law"]["source"]
        assert about["settings"]["rtol"] == SMALL.rtol and file.attrs["contactlaw_version"]
        for name in ("law", "table", "histories"):
            assert "[" in file[name].attrs["description"]  # a unit


def edit(path, change):
    """Change a file as a program of another version would: with a checksum that fits."""
    image = io.BytesIO(path.read_bytes())
    with h5py.File(image, "r+") as file:
        change(file)
    content = image.getvalue()[store._BLOCK :]
    path.write_bytes(store._signature(content) + content)


def put(name, value, *place):
    """Change that puts one value into a dataset."""

    def change(file):
        file[name][place or (2,) * file[name].ndim] = value

    return change


def store_anew(name, **options):
    """Change that stores a dataset in another way, or another one."""

    def change(file):
        values = file[name][()].astype(options.get("dtype"))
        del file[name]
        file.create_dataset(name, **({} if "shape" in options else {"data": values}), **options)

    return change


def about(text, other):
    """Change that replaces a text in what is known about a table."""
    return lambda file: file.attrs.modify("about", file.attrs["about"].replace(text, other))


def put_group(file):
    del file["law"]
    file.create_group("law")


HUGE = {"shape": (10**13,), "chunks": (1024,), "dtype": "f8"}
AXES = lookup.Axes._fields


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda f: f.attrs.modify("schema", 99), "schema 99, not 9: another version of contactlaw made it"),
        (lambda f: f.pop("table"), "table"),
        (put("table", np.nan, 500), "table holds nan"),
        (put("table", np.inf, 500), "does not fit its axes"),
        (put("table", 10.5, AXES.index("rows")), "does not fit its axes"),
        (put("table", 10.0, AXES.index("rows")), "does not fit its axes"),
        (put("table", 3.0, AXES.index("rungs")), "does not fit its axes"),
        (put("histories", 30.0, AXES.index("stride")), "does not fit its axes"),
        (about('"rows": 9', '"rows": 3'), "rows: got 3"),
        (about('"rows"', '"lines"'), "unexpected keyword argument 'lines'"),
        (store_anew("table", **HUGE), "table has 80000000000000 bytes, above"),
        (store_anew("table", dtype="c16"), "holds complex128 .* not a row of float64"),
        (store_anew("histories", dtype="f4"), "holds float32 .* not a row of float64"),
        (put_group, "'Group' object has no attribute"),
        (put("law", 2.5, 0), "there is a whole number up to"),
        (put("law", 500, 1), "ends within its"),
        (put("law", 1e5, force.HEADER + 3 + force.AT), "whole number up to"),
        (put("law", -1.0, force.HEADER + 1), "do not follow each other"),
        (lambda f: f.attrs.create("about", 3), "JSON"),
        (lambda f: f.attrs.create("about", "[" * 60_000), "recursion"),
    ],
)
def test_a_wrong_file_is_refused(path, change, message):
    edit(path, change)
    with pytest.raises(store.DamagedTableError, match=message) as error:
        store.read(path)
    assert "contactlaw table build" in str(error.value)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (os.mkfifo, "no regular file"),  # opening a pipe waits for a writer
        (lambda path: path.symlink_to("/dev/zero"), "no regular file"),  # a file without an end
        (lambda path: path.symlink_to(path), "no regular file"),
        (lambda path: path.mkdir(), "no regular file"),
        (lambda path: path.touch() or os.truncate(path, 1 << 40), "1099511627776 bytes, and no"),
    ],
    ids=["pipe", "device", "cycle", "folder", "sparse"],
)
def test_what_is_no_file_of_bounded_size_is_refused(tmp_path, make, message):
    make(tmp_path / "x.h5")
    with pytest.raises(store.DamagedTableError, match=f"cannot use .*x.h5: .*{message}.* Build it"):
        store.read(tmp_path / "x.h5")


def test_any_altered_byte_and_any_truncation_is_found(path):
    content = path.read_bytes()
    places = np.random.default_rng(3).integers(store._BLOCK, len(content), size=30)
    lengths = [0, 50, store._BLOCK, *places[:10], len(content) - 1]
    damaged = [content[:length] for length in lengths]
    for place in [0, 60, 80, *places]:  # the rest of the block is padding
        damaged.append(content[:place] + bytes([content[place] ^ 4]) + content[place + 1 :])
    for one in damaged:
        path.write_bytes(one)
        with pytest.raises(store.DamagedTableError, match=f"cannot use .*{path.name}: "):
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


def test_a_file_of_this_format_is_read_by_all_later_versions():
    """The first version of the format wrote it, for gamma-alumina on glass; it may not be made anew."""
    found = store.read(Path(__file__).parent / "schema_9.h5")
    assert (found.law.family, found.settings.rows, found.grid.axes.rungs) == ("fem", 8, 1)
    assert max(table.certify(found, 300).largest.values()) < 2e-2
