"""The table cache under what happens to caches: races, kills, damage, full and read-only disks."""

import dataclasses
import errno
import multiprocessing
import os
import pwd
import resource
import signal
import time
import warnings

import filelock
import numpy as np
import platformdirs
import pytest
import tqdm

from contactlaw import _folder, _kept, laws, table
from contactlaw.table import cache, slides
from contactlaw.table import file as store

MYC = laws.law("myc")
SMALL, OTHER = (table.Settings(inelasticity_nodes=count, log_overload_step=0.5) for count in (9, 5))
# children are forked, so that they need not compile the solver again; what they import lazily is
# loaded here, since a child that gave up its rights may not read the packages any more
FORK = multiprocessing.get_context("fork")
LOADED = filelock, platformdirs, tqdm


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


@pytest.fixture
def path(place):
    return place / cache.file_name(MYC, SMALL)


def same(one, other):
    return all(np.array_equal(one.fields[name], other.fields[name]) for name in other.fields)


def in_child(function, *arguments):
    """Run a function in a forked process and return what it returned, or raise what it raised."""
    receive, send = FORK.Pipe(duplex=False)

    def run():
        try:
            send.send(function(*arguments))
        except BaseException as error:
            send.send(error)

    process = FORK.Process(target=run)
    process.start()
    result = receive.recv()
    process.join()
    if isinstance(result, BaseException):
        raise result
    return result


def test_a_table_is_built_once_and_kept(path, expected, monkeypatch):
    assert same(cache.cached(MYC, SMALL), expected)
    assert path.exists() and path.parent.stat().st_mode & 0o777 == 0o700
    cache.cached.cache_clear()
    monkeypatch.setattr(table, "build", None)  # a second build would fail
    assert same(cache.cached(MYC, SMALL), expected)


def test_the_name_depends_on_all_that_the_content_does(monkeypatch):
    names = {cache.file_name(MYC, SMALL), cache.file_name(MYC, table.Settings())}
    monkeypatch.setattr(store, "SCHEMA", 99)
    names.add(cache.file_name(MYC, SMALL))
    changed = dataclasses.replace(MYC, data=np.nextafter(MYC.data, 9.0))
    names.add(cache.file_name(changed, SMALL))
    monkeypatch.setattr(cache, "fingerprint", lambda: "another solver")
    names.add(cache.file_name(MYC, SMALL))
    other = dataclasses.replace(MYC, family="theirs", yield_coefficient=0.7)
    names.add(cache.file_name(other, SMALL))  # these the content does not depend on
    assert len(names) == 5


def test_the_folder_may_be_chosen_and_switched_off(place, expected, monkeypatch):
    assert cache.folder() == place
    monkeypatch.delenv("CONTACTLAW_CACHE_DIR")
    assert cache.folder() == platformdirs.user_cache_path("contactlaw", appauthor=False)
    monkeypatch.setenv("CONTACTLAW_NO_CACHE", "1")
    assert cache.folder() is None
    monkeypatch.setenv("CONTACTLAW_CACHE_DIR", str(place))
    assert same(cache.cached(MYC, SMALL), expected)
    assert not place.exists()


def in_its_place(make):
    def damage(path):
        path.unlink()
        make(path)

    return damage


# What else a file is refused for stands in test_file.
@pytest.mark.parametrize(
    "damage",
    [
        lambda path: path.write_bytes(path.read_bytes().replace(b"\x3f", b"\x40", 1)),
        in_its_place(os.mkfifo),
        in_its_place(lambda path: path.symlink_to("/dev/zero")),
        in_its_place(lambda path: path.symlink_to(path)),
        lambda path: os.truncate(path, 1 << 40),
        lambda path: store.write(table.build(MYC, OTHER), path),
    ],
    ids=["flipped bits", "pipe", "device", "cyclic link", "sparse", "of other settings"],
)
def test_a_damaged_file_is_rebuilt(place, path, expected, damage):
    place.mkdir(0o700)
    store.write(expected, path)
    damage(path)
    with pytest.warns(UserWarning, match=f"{path}.*CONTACTLAW_CACHE_DIR") as caught:
        assert same(cache.cached(MYC, SMALL), expected)
    assert len(caught) == 1
    assert same(store.read(path), expected)  # and the file is whole again
    cache.cached.cache_clear()
    assert same(cache.cached(MYC, SMALL), expected)  # without a warning


def test_two_processes_build_one_table(place, path, expected):
    barrier, builds = FORK.Barrier(2), FORK.Value("i", 0)
    real = table.build

    def counted(*arguments, **options):
        with builds.get_lock():
            builds.value += 1
        time.sleep(0.2)  # both are inside before either has finished
        return real(*arguments, **options)

    def child(results):
        table.build = counted
        barrier.wait()
        results.put(same(cache.cached(MYC, SMALL), expected))

    results = FORK.Queue()
    children = [FORK.Process(target=child, args=(results,)) for _ in range(2)]
    for process in children:
        process.start()
    assert [results.get(timeout=60) for _ in children] == [True, True]
    for process in children:
        process.join()
    assert builds.value == 1
    assert {p.name for p in place.iterdir()} == {path.name, path.with_suffix(".lock").name}


def test_a_writer_killed_at_any_moment_leaves_a_whole_file_or_none(place, path, expected):
    place.mkdir(0o700)
    rng = np.random.default_rng(1)

    def write_for_ever():
        while True:
            store.write(expected, path)

    def unfinished():
        return [*place.glob("*.part"), *place.glob(".*.part")]

    interrupted = 0
    for n in range(30):
        writer = FORK.Process(target=write_for_ever)
        before = path.stat().st_mtime_ns if path.exists() else None
        writer.start()
        while not path.exists() or path.stat().st_mtime_ns == before:
            time.sleep(0.0005)  # until it has written once, however slow the machine
        left = len(unfinished())
        while n % 2 and len(unfinished()) == left:
            time.sleep(0.0002)  # every other one, until it writes again
        time.sleep(rng.uniform(0.0, 0.03 if n % 2 == 0 else 0.001))
        os.kill(writer.pid, signal.SIGKILL)
        writer.join()
        assert same(store.read(path), expected)
        interrupted += len(unfinished()) > left
    assert interrupted > 2  # the kills did hit writes
    path.unlink(missing_ok=True)
    assert same(cache.cached(MYC, SMALL), expected)
    assert not list(place.glob(".*.part"))  # what the killed ones left is gone


def test_a_builder_killed_with_the_lock_does_not_block_the_next(place, path, expected):
    started = FORK.Event()

    def child():
        table.build = lambda *a, **k: (started.set(), time.sleep(60))
        cache.cached(MYC, SMALL)

    builder = FORK.Process(target=child)
    builder.start()
    assert started.wait(30)
    os.kill(builder.pid, signal.SIGKILL)
    builder.join()
    before = time.monotonic()
    assert same(cache.cached(MYC, SMALL), expected)
    assert time.monotonic() - before < 30  # the lock ended with its process


def warned(change, expected):
    """Messages of the warnings of two lookups after a change of the process's circumstances."""
    change()
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        assert all(same(cache.cached(MYC, SMALL), expected) for _ in range(2))
    return [str(w.message) for w in caught]


def check_one_warning(messages, word):
    (message,) = messages
    assert word in message and "CONTACTLAW_CACHE_DIR" in message


def limit_files(*_):
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))


def damage_a_file_of_a_full_disk(place, path):
    place.mkdir(0o700)
    path.write_bytes(b"")
    limit_files()


def give_up_rights(place, _):
    place.mkdir(mode=0o555)
    place.parent.chmod(0o755)
    if os.geteuid() == 0:  # permissions do not bind root
        os.setuid(65534)


def lose_home(chosen):
    def lose(*_):
        for name in ("HOME", "XDG_CACHE_HOME", "CONTACTLAW_CACHE_DIR"):
            os.environ.pop(name, None)
        os.environ.update(chosen)
        if os.geteuid() == 0:
            os.setuid(54321)  # as in a container that was started with --user 54321
        else:  # no rights to become a user without an entry
            pwd.getpwuid = pwd.getpwnam = {}.__getitem__

    return lose


@pytest.mark.parametrize(
    ("change", "word", "left"),
    [
        (lambda _, path: path.mkdir(parents=True), "cannot be kept", {".h5", ".lock"}),
        (lambda place, _: place.write_text("in the way"), "cannot be kept", None),
        (damage_a_file_of_a_full_disk, "cannot be kept", {".h5", ".lock"}),
        (limit_files, os.strerror(errno.EFBIG), {".lock"}),  # neither a table nor a part of one
        (give_up_rights, "cannot be kept", set()),
        (lose_home({}), "home", None),
        (lose_home({"CONTACTLAW_CACHE_DIR": "~nouser/x"}), "home", None),
        (lose_home({"CONTACTLAW_CACHE_DIR": "~"}), "home", None),
    ],
    ids=["folder for file", "file for folder", "damaged and full", "full", "no rights", "no home",
         "no user", "home of none"],
)  # fmt: skip
def test_what_cannot_be_kept_is_said_once(place, path, expected, change, word, left):
    """Also where two things are wrong: the warning names the one that matters."""
    messages = in_child(warned, lambda: change(place, path), expected)
    check_one_warning(messages, word)
    if left is not None:
        assert {one.suffix for one in place.iterdir()} == left


@pytest.mark.parametrize("whose", ["theirs", "everybody's"])
def test_a_folder_that_others_may_write_is_not_used(place, expected, monkeypatch, whose):
    place.mkdir(0o700)
    if whose != "theirs":
        place.chmod(0o777)
    elif os.geteuid() == 0:
        os.chown(place, 65534, -1)
    else:
        monkeypatch.setattr(os, "geteuid", lambda: 65534)
    monkeypatch.setattr(_kept.config, "CACHE_DIR", "")
    with pytest.warns(UserWarning, match=f"{place} is not used.*chmod go-w") as said:
        assert same(cache.cached(MYC, SMALL), expected)
        assert cache.folder() is None and _kept._code_folder.__wrapped__() is None
    assert len(said) == 1 and list(place.iterdir()) == []


def test_the_folder_of_machine_code_is_the_users_alone(tmp_path, monkeypatch):
    """It may be in one for all, as /tmp, where nobody else can replace it."""
    tmp_path.chmod(0o1777)
    monkeypatch.setattr(_kept.config, "CACHE_DIR", str(tmp_path))
    folder = _kept._code_folder.__wrapped__()
    assert folder.stat().st_mode & 0o777 == 0o700
    folder.chmod(0o770)
    _folder.is_private.cache_clear()
    with pytest.warns(UserWarning, match=f"{folder} is not used"):
        assert _kept._code_folder.__wrapped__() is None


def test_a_lock_that_is_held_for_ever(place, path, expected, monkeypatch):
    monkeypatch.setattr(cache, "_PATIENCE", 0.2)
    place.mkdir(0o700)
    with filelock.FileLock(path.with_suffix(".lock")):
        check_one_warning(in_child(warned, lambda: None, expected), "lock")


def test_progress_is_quiet_without_a_terminal(capfd):
    assert list(cache.progress_bar(iter([1, 2]), 2)) == [1, 2]
    assert capfd.readouterr() == ("", "")


def test_tangential_rebounds_are_kept_and_made_anew_where_damaged(place, expected, monkeypatch):
    made = cache.cached_slides(expected, 0.8)
    (path,) = place.glob("slides-*")
    whole = path.read_bytes()
    calls, build = [], slides.build
    monkeypatch.setattr(slides, "build", lambda *given: calls.append(given) or build(*given))
    again = cache.cached_slides(expected, 0.8)
    assert np.array_equal(again, made) and again.flags.writeable and not calls
    path.write_bytes(whole[:-1] + bytes([whole[-1] ^ 1]))
    assert np.array_equal(cache.cached_slides(expected, 0.8), made)
    assert len(calls) == 1 and path.read_bytes() == whole
    assert not np.array_equal(cache.cached_slides(expected, 0.9), made)
    monkeypatch.setenv("CONTACTLAW_CACHE_DIR", str(path / "file"))  # no folder can be made there
    assert np.array_equal(cache.cached_slides(expected, 0.8), made)
