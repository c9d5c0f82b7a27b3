"""Vectors of doubles as values in compiled code.

LLVM turns a loop over lanes into SIMD only if it can prove that no two arrays overlap, and keeps a sum over several
loops in memory. A kernel that says what it wants instead, ``f = f + c * load(work, at)``, gets one instruction for
each: numba is taught a type for a vector of ``width`` doubles with + - * and load and store. Every element goes through
IEEE operations in the order written; nothing is fused or reordered, so results do not depend on the width, nor on
the processor.
"""

from __future__ import annotations

import operator
from collections.abc import Callable
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AbstractTemplate, infer_global
from numba.extending import intrinsic, lower_builtin, register_model

_DOUBLE = ir.DoubleType()


class Vector(types.Type):  # type: ignore[misc] # numba ships no types
    """The numba type of ``width`` doubles."""

    def __init__(self, width: int) -> None:
        self.width = width
        super().__init__(name=f"Vector({width})")


@register_model(Vector)
class _VectorModel(models.PrimitiveModel):  # type: ignore[misc] # numba ships no types
    def __init__(self, manager: Any, kind: Vector) -> None:
        super().__init__(manager, kind, ir.VectorType(_DOUBLE, kind.width))


def _spread(builder: Any, kind: Any, value: Any, width: int) -> Any:
    """``value`` of numba type ``kind``, a vector or a number, as a vector."""
    if isinstance(kind, Vector):
        return value
    vector = ir.VectorType(_DOUBLE, width)
    first = builder.insert_element(ir.Constant(vector, ir.Undefined), value, ir.Constant(ir.IntType(32), 0))
    return builder.shuffle_vector(
        first, ir.Constant(vector, ir.Undefined), ir.Constant(ir.VectorType(ir.IntType(32), width), [0] * width)
    )


def _arithmetic(operation: Callable[[Any, Any], Any], instruction: str) -> None:
    """Teach numba ``operation`` for two vectors, or a vector and a number."""

    class Template(AbstractTemplate):  # type: ignore[misc] # numba ships no types
        def generic(self, arguments: tuple[Any, ...], _: Any) -> Any:
            widths = {kind.width for kind in arguments if isinstance(kind, Vector)}
            others = {kind for kind in arguments if not isinstance(kind, Vector)}
            if len(widths) != 1 or not others <= {types.float64}:
                return None
            return Vector(widths.pop())(*arguments)

    def emit(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        width = signature.return_type.width
        kinds = zip(signature.args, arguments, strict=True)
        return getattr(builder, instruction)(*(_spread(builder, kind, value, width) for kind, value in kinds))

    infer_global(operation)(Template)
    for kinds in ((Vector, Vector), (types.Float, Vector), (Vector, types.Float)):
        lower_builtin(operation, *kinds)(emit)


for _operation, _instruction in ((operator.add, "fadd"), (operator.sub, "fsub"), (operator.mul, "fmul")):
    _arithmetic(_operation, _instruction)


def _pointer(context: Any, builder: Any, kind: Any, array: Any, index: Any, width: int) -> Any:
    """Address of ``width`` doubles from ``array[index]`` on; nothing is checked."""
    data = context.make_array(kind)(context, builder, array).data
    return builder.bitcast(builder.gep(data, [index]), ir.VectorType(_DOUBLE, width).as_pointer())


def loader(width: int) -> Any:
    """``load(array, index)`` for compiled code: ``width`` doubles from ``array[index]`` on, unchecked."""

    @intrinsic
    def load(context: Any, array: Any, index: Any) -> Any:
        def emit(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return builder.load(
                _pointer(context, builder, signature.args[0], arguments[0], arguments[1], width), align=8
            )

        return Vector(width)(array, types.uint64), emit

    return load


@intrinsic
def store(context: Any, array: Any, index: Any, value: Any) -> Any:
    """Put vector ``value`` at ``array[index]`` and after, unchecked."""

    def emit(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        place = _pointer(context, builder, signature.args[0], arguments[0], arguments[1], value.width)
        builder.store(arguments[2], place, align=8)
        return context.get_dummy_value()

    return types.void(array, types.uint64, value), emit


@intrinsic
def larger(context: Any, known: Any, value: Any) -> Any:
    """Element by element, the larger of ``known`` and the magnitude of ``value``; ``known`` where that is NaN."""

    def emit(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        vector = ir.VectorType(_DOUBLE, known.width)

        def call(name: str, *values: Any) -> Any:
            kind = ir.FunctionType(vector, [vector] * len(values))
            function = cgutils.get_or_insert_function(builder.module, kind, f"llvm.{name}.v{known.width}f64")
            return builder.call(function, values)

        # not compare and select: LLVM makes a masked store of that, which some processors take 12 cycles for
        return call("maxnum", arguments[0], call("fabs", arguments[1]))

    return known(known, value), emit


def _shuffle(width: int, order: list[int]) -> Callable[..., Any]:
    def emit(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        source = ir.VectorType(_DOUBLE, signature.args[0].width)
        second = arguments[1] if len(arguments) == 2 else ir.Constant(source, ir.Undefined)
        mask = ir.Constant(ir.VectorType(ir.IntType(32), width), order)
        return builder.shuffle_vector(arguments[0], second, mask)

    return emit


@intrinsic
def evens(context: Any, pairs: Any) -> Any:
    """Elements 0, 2, 4 ... of a vector."""
    half = pairs.width // 2
    return Vector(half)(pairs), _shuffle(half, [2 * i for i in range(half)])


@intrinsic
def odds(context: Any, pairs: Any) -> Any:
    """Elements 1, 3, 5 ... of a vector."""
    half = pairs.width // 2
    return Vector(half)(pairs), _shuffle(half, [2 * i + 1 for i in range(half)])


@intrinsic
def paired(context: Any, first: Any, second: Any) -> Any:
    """a0, b0, a1, b1 ... of vectors a and b."""
    width = 2 * first.width
    return Vector(width)(first, second), _shuffle(width, [i // 2 + i % 2 * first.width for i in range(width)])
