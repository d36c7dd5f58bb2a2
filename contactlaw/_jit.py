"""The one place where numba's options are set, and where compiled code is kept.

Machine code goes into a folder whose name is a hash of all sources of the package, numba's version
and the CPU: numba itself notices an edit only in a function's own file, and would keep the old code
of functions that it calls in other files. Laws are data, so no kernel takes a function from
outside, and each of them is compiled once on a machine.
"""

from __future__ import annotations

import functools
import hashlib
import io
import os
import shutil
import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any, TypeVar, overload

import numba
import numba.core.config
import numpy as np
from numba.core.caching import IndexDataCacheFile
from numba.core.ccallback import CFunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.registry import CPUDispatcher
from numba.extending import intrinsic
from numpy.typing import NDArray

from contactlaw import _folder
from contactlaw._version import VERSION

config: Any = numba.core.config
normalize_signature: Any = numba.core.sigutils.normalize_signature
carray: Any = numba.carray  # type: ignore[attr-defined]
_F = TypeVar("_F", bound=Callable[..., Any])
_cached: list[Any] = []
_UNUSED = 30 * 86400.0  # [s] after which unused code of another version is deleted


@overload
def kernel(function: _F) -> _F: ...
@overload
def kernel(
    *, cache: bool = False, inline: bool = False, entry: bool = False
) -> Callable[[_F], _F]: ...
def kernel(
    function: _F | None = None, *, cache: bool = False, inline: bool = False, entry: bool = False
) -> _F | Callable[[_F], _F]:
    """Compile a function on its first call; its type stays the same for type checkers.

    `cache` keeps the machine code on disk, for kernels that Python calls: it contains that of the
    kernels which they call. `entry` is for kernels that Python calls and that cannot be kept.
    `inline` copies the machine code into its callers, even where LLVM finds it too large for that.
    """

    def compiled(python_function: _F) -> _F:
        # error_model "numpy": a division by zero gives inf, which the callers' range tests refuse;
        # the default raises, and a raise in nogil code is costly. Of fastmath only "contract",
        # which fuses a product with a sum: under all of it isnan(nan) is False.
        _name_uniquely(python_function)
        options: dict[str, Any] = {
            "error_model": "numpy", "nogil": True, "fastmath": {"contract"}, "forceinline": inline,
        }  # fmt: skip
        if not (cache or entry or switched_off()):
            options |= {"nopython": True, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
            return _Inner(  # type: ignore[return-value]
                python_function, targetoptions=options, pipeline_class=_InnerCompiler
            )
        # only kernels that users may pass to C need a C function
        options["no_cfunc_wrapper"] = cache
        dispatcher: Any = numba.njit(**options)(python_function)
        if cache:
            _cached.append(dispatcher)
            if enable_caching.cache_info().currsize:  # caching is enabled already
                _cache_on_disk(dispatcher)
        return dispatcher  # type: ignore[no-any-return]

    return compiled if function is None else compiled(function)


class _InnerCode(JITCodeLibrary):
    """The code of a kernel, simplified for its callers but not translated to machine code.

    Each caller optimizes it together with its own. Numba would optimize and translate every kernel
    also by itself, which took a fifth of the time of all compilations.
    """

    def _optimize_final_module(self) -> None:
        codegen: Any = self._codegen
        made = codegen._module_pass_manager(loop_vectorize=False, cost="cheap")
        # numba 0.61 has no builder beside the passes
        passes, *builder = made if isinstance(made, tuple) else (made,)
        passes.run(self._final_module, *builder)

    def _finalize_final_module(self) -> None:
        self._finalize_dynamic_globals()  # type: ignore[no-untyped-call]
        self._verify_declare_only_symbols()  # type: ignore[no-untyped-call]
        self._finalized = True


class _InnerCompiler(Compiler):
    """Compiles a kernel into `_InnerCode`."""

    def define_pipelines(self) -> Any:
        state: Any = self.state
        codegen, name = state.targetctx.codegen(), state.func_id.func_qualname
        state.library = _InnerCode(codegen, name)  # type: ignore[no-untyped-call]
        state.flags.no_compile = True
        return super().define_pipelines()  # type: ignore[no-untyped-call]


class _Inner(CPUDispatcher):
    """A kernel that only other kernels call; a call from Python runs the Python function.

    An entry for Python takes as long to compile as a small kernel itself. Without it a kernel
    cannot print, nor raise an error whose arguments it computes.
    """

    def __call__(self, *arguments: Any) -> Any:
        return self.py_func(*arguments)

    def compile(self, signature: Any) -> Any:
        """Compile for the types of arguments, not anew for each constant among them."""
        arguments, _ = normalize_signature(signature)
        return super().compile(tuple(map(numba.types.unliteral, arguments)))

    def add_overload(self, result: Any) -> None:
        # Callers find the code by this object; other kernels have their entry for Python here.
        result = result._replace(entry_point=object())
        self.overloads[tuple(result.signature.args)] = result
        target: Any = self.targetctx
        target.insert_user_function(result.entry_point, result.fndesc, [result.library])


def _name_uniquely(function: Callable[..., Any]) -> None:
    """Add the names of the kernels that a kernel was made with to its own, as outer[inner].

    In machine code its symbol is its name, the types and a number that every process counts from
    the start. If another process's disk cache has a kernel of the same name, both may have the same
    symbol, and the linker uses one for both.
    """
    made_with = (getattr(cell.cell_contents, "__name__", "") for cell in function.__closure__ or ())
    if names := ", ".join(filter(None, made_with)):
        function.__name__ += f"[{names}]"
        function.__qualname__ += f"[{names}]"


def switch_off() -> None:
    """Leave the kernels of this process as Python; call it before the first one is defined.

    The environment variable of numba would do so in child processes too.
    """
    config.DISABLE_JIT = 1
    np.seterr(divide="ignore", over="ignore", invalid="ignore")  # as compiled kernels do


def switched_off() -> bool:
    """Whether the kernels are Python, by `switch_off` or by ``NUMBA_DISABLE_JIT=1``."""
    return bool(config.DISABLE_JIT)


@functools.cache
def enable_caching() -> None:
    """Let the kernels with ``cache=True`` use the disk cache, from now on.

    This cannot be done where they are defined: numba makes a cache folder, or raises where none is
    writable, and an import should do neither.
    """
    for dispatcher in _cached:
        _cache_on_disk(dispatcher)


def c_function(signature: Any, function: Callable[..., Any], *, cache: bool = False) -> Any:
    """Compile a function for C; its ``address`` is valid as long as the result lives.

    Raises
    ------
    RuntimeError
        If numba is switched off.
    """
    if switched_off():
        raise RuntimeError(
            "numba is switched off (NUMBA_DISABLE_JIT is set), and a C function needs its compiler"
        )
    types = normalize_signature(signature)
    made: Any = CFunc(function, types, {}, {"error_model": "numpy"})
    if cache:
        _cache_on_disk(made)
    made.compile()
    return made


def direct(function: Callable[..., Any], signature: str) -> Callable[..., Any]:
    """Compile a kernel for one signature and return its bare entry, as numba's dispatcher calls it.

    The entry does not check the types of the arguments, which takes a third of the half a
    microsecond of a call: every argument has to have the type that the signature says.
    """
    if switched_off():
        return function
    enable_caching()
    dispatcher: Any = function
    types, _ = normalize_signature(signature)
    # by types, as from other kernels: with a string numba's cache would have it twice
    dispatcher.compile(types)
    entry: Callable[..., Any] = dispatcher.overloads[types].entry_point
    return entry


def as_python(function: _F) -> _F:
    """Return the Python function of a kernel, for work that takes less time than compiling."""
    return getattr(function, "py_func", function)


def at_first_as_python(function: _F, seconds: float) -> _F:
    """Run a kernel as Python, until others have compiled it or its runs have taken so long [s].

    A compiler may fuse a product with a sum, so that answers differ in the last digits.
    """
    if switched_off():
        return function
    dispatcher: Any = function
    taken = 0.0

    @functools.wraps(dispatcher.py_func)
    def called(*arguments: Any) -> Any:
        nonlocal taken
        if dispatcher.overloads or taken > seconds:
            return dispatcher(*arguments)
        begun = time.perf_counter()
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            found = dispatcher.py_func(*arguments)
        taken += time.perf_counter() - begun
        return found

    return called  # type: ignore[return-value]


def _cache_on_disk(dispatcher: Any) -> None:
    """Give a kernel the disk cache, in files with checksums."""
    if switched_off():
        return
    with _into_folder() as folder:
        if folder is None:
            return
        dispatcher.enable_caching()
    store = dispatcher._cache
    store.save_overload = functools.partial(_save, store.save_overload)
    plain = store._cache_file
    store._cache_file = _SealedFiles(  # type: ignore[no-untyped-call]
        plain._cache_path, plain._index_name.removesuffix(".nbi"), plain._source_stamp
    )


class _SealedFiles(IndexDataCacheFile):
    """Numba's index and data files, each with the checksum of its content at its end.

    Numba executes whatever bytes it reads. A damaged file counts as missing here: the kernel is
    compiled again, and the file written anew. Unpickling ends where the content does, so that
    numba reads a sealed file as if the checksum were not there.
    """

    @contextmanager
    def _open_for_write(self, filepath: str) -> Iterator[IO[bytes]]:
        content = io.BytesIO()
        yield content
        with super()._open_for_write(filepath) as file:
            file.write(content.getvalue() + _seal(content.getbuffer()))

    def _load_index(self) -> Any:
        if not _is_whole(self._index_path):
            return {}
        return super()._load_index()  # type: ignore[no-untyped-call]

    def _load_data(self, name: str) -> Any:
        path = self._data_path(name)  # type: ignore[no-untyped-call]
        if not _is_whole(path):
            raise OSError(f"{path} is damaged")  # which numba takes for a missing file
        return super()._load_data(name)  # type: ignore[no-untyped-call]


def _seal(content: bytes | memoryview) -> bytes:
    return hashlib.sha256(content).digest()


def _is_whole(path: str) -> bool:
    try:
        content = memoryview(Path(path).read_bytes())
    except OSError:
        return False
    size = hashlib.sha256().digest_size
    return _seal(content[:-size]) == content[-size:]


def _save(save: Callable[[Any, Any], None], signature: Any, data: Any) -> None:
    """Keep machine code, or warn if that fails; numba would raise, and no answer be given."""
    try:
        save(signature, data)
    except OSError as error:
        _warn_once(str(error))


@contextmanager
def _into_folder() -> Iterator[Path | None]:
    """Within this block numba makes its caches in our folder; gives None if there is no folder."""
    folder, before = _code_folder(), config.CACHE_DIR
    try:
        if folder is not None:
            config.CACHE_DIR = str(folder)
        yield folder
    finally:
        config.CACHE_DIR = before


@functools.cache
def _code_folder() -> Path | None:
    """Folder of the machine code, made if missing: in NUMBA_CACHE_DIR if set, else in ours."""
    try:
        home = Path(config.CACHE_DIR) if config.CACHE_DIR else _folder.folder()
        if home is None:
            return None
        # a process may change its working folder, and numba does not expand ~
        home = home.expanduser().absolute()
        folder = home / f"contactlaw-{fingerprint()}"
        if not folder.is_dir():
            home.mkdir(0o700, parents=True, exist_ok=True)
            folder.mkdir(0o700, exist_ok=True)
            _sweep(home)
            if sys.stderr is not None and sys.stderr.isatty():
                print(
                    "contactlaw: the first use of this version compiles it, for about half a "
                    f"minute; kept in {home}",
                    file=sys.stderr,
                )
        if not (_folder.is_private(home, sticky=True) and _folder.is_private(folder)):
            return None
        os.utime(folder)  # marks it as used; raises if it is not ours to write
        return folder
    except (OSError, RuntimeError) as error:
        _warn_once(str(error))
        return None


@functools.cache
def fingerprint() -> str:
    """Hash of all that machine code and tables depend on: every source, numba and the CPU."""
    import llvmlite.binding as llvm

    digest = hashlib.sha256(f"{VERSION} {numba.__version__} {llvm.get_host_cpu_name()} ".encode())
    digest.update(llvm.get_host_cpu_features().flatten().encode())
    package = Path(__file__).parent
    for path in sorted(package.rglob("*.py")):
        digest.update(path.relative_to(package).as_posix().encode() + path.read_bytes())
    return digest.hexdigest()[:16]


def _sweep(home: Path) -> None:
    """Remove the code of other versions that nobody has used for a month."""
    for other in home.glob("contactlaw-*"):
        if time.time() - other.stat().st_mtime > _UNUSED:
            shutil.rmtree(other, ignore_errors=True)


@functools.cache
def _warn_once(reason: str) -> None:
    warnings.warn(
        f"numba cannot keep compiled code on disk ({reason}), so each process compiles it anew; "
        "set NUMBA_CACHE_DIR to a writable folder with some megabytes left",
        stacklevel=2,
    )


def in_memory(values: NDArray[np.float64]) -> Callable[[], NDArray[np.float64]]:
    """Make a kernel that returns this array by its address, for kernels that read only this array.

    An array that a kernel holds as a constant has another type in numba, for which everything that
    it is passed to is compiled anew. Numba does not cache callers of the kernel made here. Their
    sources are the same whatever the array is, so a user's own ``@njit(cache=True)`` loop would
    read the array of an earlier process.
    """
    if switched_off():
        return lambda: values

    @intrinsic
    def pointer(typing_context: Any) -> Any:
        def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            address = values.ctypes.data  # values live as long as this function
            where = context.add_dynamic_addr(builder, address, info="contactlaw: a table in memory")
            return builder.bitcast(where, context.get_value_type(signature.return_type))

        return numba.types.CPointer(numba.types.float64)(), generate  # type: ignore[no-untyped-call]

    size = values.size

    @kernel(inline=True)
    def array() -> NDArray[np.float64]:
        found: NDArray[np.float64] = carray(pointer(), (size,))  # type: ignore[call-arg]
        return found

    return array
