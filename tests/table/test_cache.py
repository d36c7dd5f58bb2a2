"""The table cache under what happens to caches: races, kills, damage, full and read-only disks."""

import dataclasses
import errno
import functools
import gc
import os
import signal
import time
import warnings
import weakref

import filelock
import numpy as np
import platformdirs
import pytest
from forked import FORK, fill_disk, in_child, lose_home

import contactlaw as cl
from contactlaw import _folder, _kept, laws, table
from contactlaw.table import cache, shapes, slides
from contactlaw.table import file as store

MYC = laws.law("myc")
SMALL, OTHER = (table.Settings(rows=count, columns=8) for count in (9, 5))


@pytest.fixture(scope="module")
def expected():
    return table.build(MYC, SMALL)


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch, expected):
    """Cache folder of one test."""
    monkeypatch.setenv("CONTACTLAW_CACHE_DIR", str(tmp_path / "cache"))
    cache.cached.cache_clear()
    yield tmp_path / "cache"
    cache.cached.cache_clear()


def name_of(law, settings):
    return cache.file_name("table", law.key, dataclasses.asdict(settings))


@pytest.fixture
def path(place):
    return place / name_of(MYC, SMALL)


def same(one, other):
    return np.array_equal(one.packed, other.packed)


def test_a_table_is_built_once_and_kept(path, expected, monkeypatch):
    assert same(cache.cached(MYC, SMALL), expected)
    assert path.parent.stat().st_mode & 0o777 == 0o700
    cache.cached.cache_clear()
    monkeypatch.setattr(table, "build", None)  # a second build would fail
    assert same(cache.cached(MYC, SMALL), expected)


def test_the_name_depends_on_all_that_the_content_does(monkeypatch):
    changed = dataclasses.replace(MYC, data=np.nextafter(MYC.data, 9.0))
    other = dataclasses.replace(MYC, family="theirs", yield_coefficient=0.7)
    given = [(MYC, SMALL), (MYC, OTHER), (changed, SMALL)]
    names = {name_of(*one) for one in [*given, (other, SMALL)]}
    monkeypatch.setattr(store, "SCHEMA", 99)
    names |= {name_of(*one) for one in given}
    monkeypatch.setattr(cache, "fingerprint", lambda: "another solver")
    names |= {name_of(*one) for one in given}
    assert len(names) == 9  # on a law's name the content does not depend


def test_the_folder_may_be_chosen_and_switched_off(place, expected, monkeypatch):
    assert cache.folder() == place
    monkeypatch.delenv("CONTACTLAW_CACHE_DIR")
    assert cache.folder() == platformdirs.user_cache_path("contactlaw", appauthor=False)
    monkeypatch.setenv("CONTACTLAW_NO_CACHE", "1")
    assert cache.folder() is None
    monkeypatch.setenv("CONTACTLAW_CACHE_DIR", str(place))
    assert same(cache.cached(MYC, SMALL), expected)
    assert not place.exists()


def test_tables_of_dropped_models_leave_the_memory(expected, monkeypatch):
    monkeypatch.setenv("CONTACTLAW_NO_CACHE", "1")
    alive, built = weakref.WeakSet(), []

    def build(law, settings):
        built.append(law)
        alive.add(made := dataclasses.replace(expected, certificate=None, law=law, settings=settings))
        return made

    monkeypatch.setattr(table, "build", build)
    monkeypatch.setattr(shapes, "build", lambda *_: np.zeros(9))

    def use(modulus):
        plate = cl.Material("plate", modulus, 0.3, 2700.0, 1e8)
        model = cl.ImpactModel(cl.Pair("gamma-alumina", plate), law="jackson_green")
        assert cache.cached_shapes(model.table).size == 9

    for modulus in np.linspace(6e10, 8e10, 40):
        use(modulus)
    gc.collect()
    assert len(built) == 40 and len(alive) <= 16 + 4
    for modulus in 10 * [1.1e11, 1.2e11, 1.3e11]:  # whoever goes to and fro builds nothing again
        use(modulus)
    assert len(built) == 43


def test_what_nobody_has_read_for_three_months_leaves_the_disk(place, path, expected):
    cache.cached(MYC, SMALL)
    unread = place / name_of(MYC, OTHER)
    cache.cached_slides(expected, 0.8)
    (slides_read,) = place.glob("slides-*.h5")
    cache.cached_slides(expected, 0.9)
    killed = place / f".{unread.name}.abc_123.part"
    theirs = [place / name for name in ("table-of-impacts.h5", f"table-{24 * 'a'}.csv", "slides-1.h5")]
    for one in [unread, killed, *theirs]:
        one.write_bytes(b"")
    (folder := place / f"table-{24 * 'b'}.h5").mkdir()
    for one in place.iterdir():
        os.utime(one, (0, time.time() - 91 * 86400))
    cache.cached.cache_clear()
    cache.cached(MYC, SMALL)
    cache.cached_slides(expected, 0.8)
    other = table.Settings(rows=7, columns=8)
    cache.cached(MYC, other)
    made = place / name_of(MYC, other)
    assert {*place.iterdir()} == {path, slides_read, made, made.with_suffix(".lock"), folder, *theirs}


def become_a_device(path):
    path.unlink()
    path.symlink_to("/dev/zero")


@pytest.mark.parametrize(
    "damage",
    [
        lambda path: path.write_bytes(path.read_bytes().replace(b"\x3f", b"\x40", 1)),
        become_a_device,
        lambda path: store.write(table.build(MYC, OTHER), path),
    ],
    ids=["flipped bits", "device", "of other settings"],
)
def test_a_damaged_file_is_rebuilt(place, path, expected, damage):
    """What else a file is refused for stands in test_file."""
    place.mkdir(0o700)
    store.write(expected, path)
    damage(path)
    with pytest.warns(UserWarning, match=f"{path}.*CONTACTLAW_CACHE_DIR") as caught:
        assert same(cache.cached(MYC, SMALL), expected)
    assert len(caught) == 1
    assert same(store.read(path), expected)  # and the file is whole again


def test_two_processes_build_one_table(place, path, expected, monkeypatch):
    barrier, builds, real = FORK.Barrier(2), FORK.Queue(), table.build

    def counted(*arguments, **options):
        builds.put("built")
        time.sleep(0.2)  # both are inside before either has finished
        return real(*arguments, **options)

    def child():
        barrier.wait()
        builds.put(same(cache.cached(MYC, SMALL), expected))

    monkeypatch.setattr(table, "build", counted)
    children = [FORK.Process(target=child) for _ in range(2)]
    for process in children:
        process.start()
    found = [builds.get(timeout=60) for _ in range(3)]
    for process in children:
        process.join()
    assert found == ["built", True, True] and builds.empty()
    assert {one.name for one in place.iterdir()} == {path.name, path.with_suffix(".lock").name}


def end_here(*_, **__):
    os.kill(os.getpid(), signal.SIGKILL)


@pytest.mark.parametrize("moment", ["fsync", "replace"])
def test_a_writer_that_is_killed_leaves_the_old_file(place, path, expected, monkeypatch, moment):
    place.mkdir(0o700)
    store.write(expected, path)
    with monkeypatch.context() as patch:
        patch.setattr(os, moment, end_here)
        in_child(store.write, table.build(MYC, OTHER), path)
    assert len([*place.glob(".*.part")]) == 1
    assert same(store.read(path), expected)
    path.unlink()
    assert same(cache.cached(MYC, SMALL), expected)
    assert not [*place.glob(".*.part")]  # what the killed one left is gone


def test_a_builder_killed_with_the_lock_does_not_block_the_next(expected, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(table, "build", end_here)
        in_child(cache.cached, MYC, SMALL)
    monkeypatch.setattr(cache, "_PATIENCE", 0.0)  # the lock ended with its process
    assert same(cache.cached(MYC, SMALL), expected)  # without a warning


def give_up_rights(place, _):
    place.mkdir(mode=0o555)
    place.parent.chmod(0o755)
    if os.geteuid() == 0:  # permissions do not bind root
        os.setuid(65534)


def hold_the_lock(place, path):
    place.mkdir(0o700)
    cache._PATIENCE = 0.1
    cache.held = filelock.FileLock(path.with_suffix(".lock"))  # a lock ends with its object
    cache.held.acquire()


@pytest.mark.parametrize(
    ("change", "word", "left"),
    [
        (lambda _, path: path.mkdir(parents=True), "cannot be kept", {".h5"}),
        (lambda place, _: place.write_text("in the way"), "cannot be kept", None),
        (fill_disk, os.strerror(errno.EFBIG), {".lock"}),  # neither a table nor a part of one
        (give_up_rights, "cannot be kept", set()),
        (hold_the_lock, "lock", {".lock"}),
        (lose_home, "home", None),
        (functools.partial(lose_home, CONTACTLAW_CACHE_DIR="~nouser/x"), "home", None),
    ],
    ids=["folder for file", "file for folder", "full", "no rights", "held for ever", "no home", "no user"],
)
def test_what_cannot_be_kept_is_said_once(place, path, expected, change, word, left):
    def warned():
        change(place, path)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            assert all(same(cache.cached(MYC, SMALL), expected) for _ in range(2))
        return [str(one.message) for one in caught]

    (message,) = in_child(warned)
    assert word in message and "CONTACTLAW_CACHE_DIR" in message
    if left is not None:
        assert {one.suffix for one in place.iterdir()} == left


@pytest.mark.parametrize("whose", ["theirs", "everybody's"])
def test_a_folder_that_others_may_write_is_not_used(place, expected, monkeypatch, whose):
    place.mkdir(0o700)
    if whose == "everybody's":
        place.chmod(0o777)
    elif os.geteuid() == 0:  # whose folders everybody trusts
        os.chown(place, 65534, -1)
    else:
        monkeypatch.setattr(os, "geteuid", lambda: 65534)
    monkeypatch.setattr(_kept.config, "CACHE_DIR", "")
    with pytest.warns(UserWarning, match=f"{place} is not used.*chmod go-w") as said:
        assert same(cache.cached(MYC, SMALL), expected)
        assert cache.folder() is None and _kept.code_folder.__wrapped__() is None
    assert len(said) == 1 and list(place.iterdir()) == []


def test_the_folder_of_machine_code_is_the_users_alone(tmp_path, monkeypatch):
    """It may be in one for all, as /tmp, where nobody else can replace it."""
    tmp_path.chmod(0o1777)
    monkeypatch.setattr(_kept.config, "CACHE_DIR", str(tmp_path))
    folder = _kept.code_folder.__wrapped__()
    assert folder.stat().st_mode & 0o777 == 0o700
    folder.chmod(0o770)
    _folder.is_private.cache_clear()
    with pytest.warns(UserWarning, match=f"{folder} is not used"):
        assert _kept.code_folder.__wrapped__() is None


def test_tangential_rebounds_are_kept_and_made_anew_where_damaged(place, expected, monkeypatch):
    built = []
    monkeypatch.setattr(slides, "build", lambda _, kappa: built.append(0) or np.full(9, kappa))

    def check(kappa, builds):
        found = cache.cached_slides(expected, kappa)
        assert (found == kappa).all() and found.flags.writeable and len(built) == builds

    check(0.8, 1)
    check(0.8, 1)
    (path,) = place.glob("slides-*.h5")
    whole = path.read_bytes()
    path.write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]))
    with pytest.warns(UserWarning, match="was damaged"):
        check(0.8, 2)
    assert path.read_bytes() == whole
    check(0.9, 3)
    monkeypatch.setenv("CONTACTLAW_CACHE_DIR", str(path / "file"))  # no folder can be made there
    with pytest.warns(UserWarning, match="cannot be kept"):
        check(0.8, 4)
