"""All of contactlaw that uses private names of numba, which any version of numba may change.

If numba lacks one of the names, or is newer than the versions that the tests have run with, this
module cannot be imported, and public names serve instead (see `private` in `contactlaw._jit`). A
first process then takes 34 s of CPU for 23 s, time steps take up to 1.5 times as long, and a full disk
is an error.
"""

from collections.abc import Callable
from typing import Any

import numba
from llvmlite import binding as llvm
from numba.core.ccallback import CFunc
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.compiler_machinery import AnalysisPass, register_pass
from numba.core.extending import _Intrinsic
from numba.core.registry import CPUDispatcher
from numba.core.sigutils import normalize_signature
from numba.core.typed_passes import NopythonTypeInference
from numba.np.arrayobj import np_cfarray

__all__ = ["CFunc", "Inner", "InnerCompiler", "entry_point", "normalize_signature", "np_cfarray", "warn_where_not_kept"]
_TESTED = 0, 68  # last version of numba that all tests have run with: another may change meanings
if numba.version_info.short > _TESTED:
    raise ImportError(f"numba {numba.__version__} is newer than contactlaw was tested with")
# Methods that are overridden below; by another name numba would no longer call them.
JITCodeLibrary.finalize, JITCodeLibrary._get_module_for_linking  # noqa: B018
_VIEWS = "getitem", "static_getitem", "getiter", "iternext"  # of arrays that others keep alive


class _InnerCode(JITCodeLibrary):
    """The code of one kernel that only kernels call: as written, without that of those it calls.

    Numba would optimize it, and translate it to machine code, together with all that it calls, at
    each level of calls. Here the kernel that Python calls links each of them once.
    """

    def finalize(self) -> None:
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        if self._shared_module is None:
            module, parts = self._final_module.clone(), [self]
            for part in parts:  # which grows; the libraries of numba have what they call
                calls = part._linking_libraries if isinstance(part, _InnerCode) else []
                parts += [one for one in dict.fromkeys(calls) if one not in parts]
            for part in sorted(parts[1:], key=lambda one: not isinstance(one, _InnerCode)):
                inner = isinstance(part, _InnerCode)
                code = part._final_module if inner else part._get_module_for_linking()
                module.link_in(code, preserve=True)
            for function in module.functions:  # as numba does: one of several copies is used
                if not function.is_declaration and function.linkage == llvm.Linkage.external:
                    function.linkage = "linkonce_odr"
            self._shared_module = module
        return self._shared_module


@register_pass(mutates_CFG=False, analysis_only=True)  # type: ignore[no-untyped-call]
class _Uncounted(AnalysisPass):
    """Disable reference counting in kernels that neither create nor return arrays.

    Callers keep alive all arrays that such a kernel reads. Numba counts a reference whenever an
    array, or a tuple that has one, is passed to a kernel. With the dozen arrays of a bead and its
    walls, counting took as long as their contact. Intrinsics that are called by name, such as
    `array_at`, return arrays that others keep alive.
    """

    _name = "contactlaw_uncounted"

    def __init__(self) -> None:
        super().__init__()  # type: ignore[no-untyped-call]

    def run_pass(self, state: Any) -> bool:
        models, kinds, results = state.targetctx.data_model_manager, state.typemap, [state.return_type]
        for one, signature in state.calltypes.items():
            operation = getattr(one, "op", "")
            called = kinds[one.func.name] if operation == "call" else None
            intrinsic = isinstance(getattr(called, "typing_key", None), _Intrinsic)
            view = operation in _VIEWS or intrinsic or isinstance(called, numba.types.NamedTupleClass)
            if not view and signature is not None:
                results.append(signature.return_type)
        if not any(models[kind].contains_nrt_meminfo() for kind in results):
            state.targetctx.enable_nrt = False
        return False


class InnerCompiler(Compiler):
    """Compiles a kernel into `_InnerCode`."""

    def define_pipelines(self) -> Any:
        codegen, name = self.state.targetctx.codegen(), self.state.func_id.func_qualname
        self.state.library = _InnerCode(codegen, name)  # type: ignore[no-untyped-call]
        self.state.flags.no_compile = True
        pipelines = super().define_pipelines()  # type: ignore[no-untyped-call]
        for one in pipelines:
            one.add_pass_after(_Uncounted, NopythonTypeInference)
            one.finalize()
        return pipelines


class Inner(CPUDispatcher):
    """A kernel that only other kernels call; a call from Python runs the Python function.

    An entry for Python takes as long to compile as a small kernel itself. Without it a kernel
    cannot print, nor raise an error whose arguments it computes.
    """

    def __call__(self, *arguments: Any) -> Any:
        return self.py_func(*arguments)

    def compile(self, types: Any) -> Any:
        """Compile for the types of arguments, not anew for each constant among them."""
        return super().compile(tuple(map(numba.types.unliteral, types)))

    def add_overload(self, result: Any) -> None:
        # Callers find the code by this object; other kernels have their entry for Python here.
        result = result._replace(entry_point=object())
        self.overloads[tuple(result.signature.args)] = result
        target: Any = self.targetctx
        target.insert_user_function(result.entry_point, result.fndesc, [result.library])


def entry_point(dispatcher: Any, signature: str) -> Any:
    """Compile a kernel for a signature and return its bare entry, as numba's dispatcher calls it."""
    types, _ = normalize_signature(signature)  # type: ignore[no-untyped-call]
    # by types, as from other kernels: with a string numba's cache would have it twice
    dispatcher.compile(types)
    return dispatcher.overloads[types].entry_point


def warn_where_not_kept(dispatcher: Any, warn: Callable[[str], None]) -> None:
    """Warn where the machine code of a kernel cannot be kept; numba would raise, and no answer be given."""
    cache = dispatcher._cache
    save = cache.save_overload

    def save_or_warn(signature: Any, data: Any) -> None:
        try:
            save(signature, data)
        except OSError as error:
            warn(str(error))

    cache.save_overload = save_or_warn
