"""The processor as LLVM knows it: what code is made for, and where it is put to be run."""

import os
from functools import lru_cache

import llvmlite.binding as llvm


@lru_cache(maxsize=1)
def processor() -> tuple[str, str, str]:
    """System, name and features of the processor: this one, or what Numba's own variables say instead."""
    name, features = (os.environ.get(f"NUMBA_CPU_{what}") for what in ("NAME", "FEATURES"))
    return (
        llvm.get_process_triple(),
        llvm.get_host_cpu_name() if name is None else name,
        llvm.get_host_cpu_features().flatten() if features is None else features,
    )


def has(feature: str) -> bool:
    """Whether the processor has a feature, by LLVM's name of it."""
    return f"+{feature}" in processor()[2].split(",")


def target() -> llvm.TargetMachine:
    """What makes code for this processor."""
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    triple, name, features = processor()
    made_for = llvm.Target.from_triple(triple)
    # Addresses relative to the code's own are wrong on x86 once several object files are loaded.
    addresses = "static" if made_for.name.startswith("x86") else "default"
    return made_for.create_target_machine(cpu=name, features=features, opt=3, reloc=addresses, jit=True)


@lru_cache(maxsize=1)
def _engine():
    return llvm.create_mcjit_compiler(llvm.parse_assembly(""), target())


def address_of(name: str, code: bytes) -> int:
    """Where a function of an object file lies in memory, its code now loaded; each name once."""
    engine = _engine()
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return engine.get_function_address(name)
