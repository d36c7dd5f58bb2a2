"""The one place where numba's options are set."""

import functools
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from inspect import Parameter, Signature
from typing import Any, NamedTuple, TypeVar, overload

import numba
import numpy as np
from numba.extending import intrinsic, lower_builtin, register_jitable, type_callable

from contactlaw._arrays import Array
from contactlaw._kept import code_folder, config, warn_once

try:
    from contactlaw import _numba

    private: Any = _numba
except (ImportError, AttributeError):  # another version of numba: public names serve
    private = None
_types: Any = numba.types
carray: Any = numba.carray  # type: ignore[attr-defined]
_F = TypeVar("_F", bound=Callable[..., Any])
_Tuple = TypeVar("_Tuple", bound=NamedTuple)
_cached: list[Any] = []


@overload
def kernel(function: _F) -> _F: ...
@overload
def kernel(*, cache: bool = ..., inline: bool = ..., entry: bool = ...) -> Callable[[_F], _F]: ...
def kernel(
    function: _F | None = None, *, cache: bool = False, inline: bool = False, entry: bool = False
) -> _F | Callable[[_F], _F]:
    """Compile a function on its first call; its type stays the same for type checkers.

    `cache` keeps the machine code on disk, for kernels that Python calls: it contains that of the
    kernels which they call. `entry` is for kernels that Python calls and that cannot be kept.
    `inline` copies the machine code into its callers, even where LLVM finds it too large for that.
    """

    def compiled(python: _F) -> _F:
        # In machine code a symbol is the name, the types and a number that each process counts from
        # the start; of two processes' kernels with one name the linker would use one for both. So a
        # kernel that is made with others is called outer[inner].
        others = (getattr(cell.cell_contents, "__name__", "") for cell in python.__closure__ or ())
        if names := ", ".join(filter(None, others)):
            python.__name__ += f"[{names}]"
            python.__qualname__ += f"[{names}]"
        # error_model "numpy": a division by zero gives inf, which the callers' range tests refuse;
        # the default raises, and a raise in nogil code is costly. Of fastmath only "contract",
        # which fuses a product with a sum: under all of it isnan(nan) is False. Only kernels that
        # users may pass to C need a C function.
        inner = not (cache or entry or switched_off())
        options: dict[str, Any] = {"error_model": "numpy", "nogil": True, "fastmath": {"contract"}}
        if private:
            options |= {"forceinline": inline, "no_cfunc_wrapper": cache or inner}
        elif inner:
            return register_jitable(**options)(python)
        if inner:
            options |= {"nopython": True, "no_cpython_wrapper": True}
            return private.Inner(python, targetoptions=options, pipeline_class=private.InnerCompiler)  # type: ignore[no-any-return]
        dispatcher: Any = numba.njit(**options)(python)
        if cache:
            _cached.append(dispatcher)
            if enable_caching.cache_info().currsize:  # caching is enabled already
                keep(dispatcher)
        return dispatcher  # type: ignore[no-any-return]

    return compiled if function is None else compiled(function)


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
        keep(dispatcher)


def keep(dispatcher: Any) -> None:
    """Give a kernel the disk cache, in our folder."""
    with numbas_cache_in_ours() as is_there:
        if is_there:
            dispatcher.enable_caching()
            if private:
                private.warn_where_not_kept(dispatcher, warn_once)


@contextmanager
def numbas_cache_in_ours() -> Iterator[bool]:
    """Let numba make its caches in our folder of machine code, if there is one."""
    folder = None if config.DISABLE_JIT else code_folder()
    if folder is None:
        yield False
        return
    before, config.CACHE_DIR = config.CACHE_DIR, str(folder)
    try:
        yield True
    finally:
        config.CACHE_DIR = before


def c_function(signature: Any, function: Callable[..., Any], *, cache: bool = False) -> Any:
    """Compile a function for C; its ``address`` is valid as long as the result lives.

    Raises
    ------
    RuntimeError
        If numba is switched off.
    """
    if switched_off():
        raise RuntimeError("numba is switched off (NUMBA_DISABLE_JIT is set), and a C function needs its compiler")
    if not private:
        with numbas_cache_in_ours() as is_there:
            return numba.cfunc(signature, cache=cache and is_there, error_model="numpy")(function)
    made: Any = private.CFunc(function, private.normalize_signature(signature), {}, {"error_model": "numpy"})
    if cache:
        keep(made)
    made.compile()
    return made


def direct(function: Callable[..., Any], signature: str) -> Callable[..., Any]:
    """Compile a kernel for one signature and return its bare entry, as numba's dispatcher calls it.

    The entry does not check the types of the arguments, which takes a third of the half a
    microsecond of a call: every argument has to have the type that the signature says.
    """
    if switched_off() or not private:
        return function
    enable_caching()
    return private.entry_point(function, signature)  # type: ignore[no-any-return]


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


def in_memory(values: Array) -> Callable[[], Array]:
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

        return _types.CPointer(_types.float64)(), generate

    size = values.size

    @kernel(inline=True)
    def array() -> Array:
        found: Array = carray(pointer(), (size,))  # type: ignore[call-arg]
        return found

    return array


def tuple_of(kind: type[_Tuple], source: Any, **fields: Any) -> _Tuple:
    """Make a NamedTuple of the fields of a row, or of another NamedTuple, except those given.

    Kernels may call it, too, which neither ``_replace`` nor a loop over fields can be compiled in.
    """
    return kind(*(fields[name] if name in fields else getattr(source, name) for name in kind._fields))


@type_callable(tuple_of)
def _type_of_tuple(context: Any) -> Any:
    def typed(kind: Any, source: Any, **fields: Any) -> Any:
        parameters = [Parameter(name, Parameter.POSITIONAL_OR_KEYWORD) for name in ("kind", "source", *fields)]
        typed.pysig = Signature(parameters)  # type: ignore[attr-defined]
        names = kind.instance_class._fields
        members = [fields[name] if name in fields else context.resolve_getattr(source, name) for name in names]
        return _types.BaseTuple.from_types(members, kind.instance_class)(kind, source, *fields.values())

    return typed


@lower_builtin(tuple_of, _types.VarArg(_types.Any))  # type: ignore[no-untyped-call]
def _code_of_tuple(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    source, members = signature.args[1], dict(zip(signature.pysig.parameters, arguments, strict=True))
    names = signature.return_type.instance_class._fields
    for name in names:
        if name not in members:
            members[name] = context.get_getattr(source, name)(context, builder, source, arguments[1], name)
    return context.make_tuple(builder, signature.return_type, [members[name] for name in names])


def numbers_at(kind: type[_Tuple], array: Array, begin: int, step: int) -> _Tuple:
    """Make a NamedTuple of numbers of an array, each `step` after the one before; kernels may call it, too."""
    return kind(*array[begin : begin + step * len(kind._fields) : step])


@type_callable(numbers_at)
def _type_of_numbers(_: Any) -> Any:
    def typed(kind: Any, array: Any, begin: Any, step: Any) -> Any:
        return _types.NamedUniTuple(array.dtype, len(kind.instance_class._fields), kind.instance_class)

    return typed


@lower_builtin(numbers_at, *4 * [_types.Any])  # type: ignore[no-untyped-call]
def _code_of_numbers(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    data = context.make_array(signature.args[1])(context, builder, arguments[1]).data
    at, step = (context.cast(builder, arguments[k], signature.args[k], _types.intp) for k in (2, 3))
    members = []
    for _ in range(signature.return_type.count):
        members.append(builder.load(builder.gep(data, [at])))
        at = builder.add(at, step)
    return context.make_tuple(builder, signature.return_type, members)
