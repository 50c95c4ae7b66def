"""Eight chains in one register: a vector number for the code that Numba compiles.

Numba is taught the type, and what the functions of `physics.lanes` and Python's operators are for it
(`arithmetic`): the compiler need not discover the vectors, the type is explicit.
"""

import operator

from numba import types
from numba.core.typing.templates import AbstractTemplate, infer_global, signature
from numba.extending import lower_builtin, models, register_model

from sonicvacuum.physics import lanes
from sonicvacuum.physics.arithmetic import FUNCTIONS, LANES_KIND, OPERATORS, splat
from sonicvacuum.physics.lanes import LANES


class LaneType(types.Type):
    """Numba type of `LANES` float64 numbers held in registers."""

    def __init__(self):
        super().__init__(name=f"lanes{LANES}")


lane = LaneType()
_NUMBERS = (LaneType, types.Float, types.Integer)


@register_model(LaneType)
class _LaneModel(models.PrimitiveModel):
    def __init__(self, manager, fe_type):
        super().__init__(manager, fe_type, LANES_KIND)


def _teach(function, emit, among=_NUMBERS):
    """Make `function` known to Numba: `emit(builder, *values)` writes its code for doubles or lanes alike."""
    arity = emit.__code__.co_argcount - 1

    class Template(AbstractTemplate):
        def generic(self, args, kws):
            if len(args) == arity and not kws and all(isinstance(a, _NUMBERS) for a in args):
                kinds = [a if a is lane else types.float64 for a in args]
                if lane in args or among is _NUMBERS:
                    return signature(lane if lane in args else types.float64, *kinds)
            return None

    infer_global(function)(Template)

    def lower(context, builder, sig, args):
        if sig.return_type is lane:
            pairs = zip(sig.args, args, strict=True)
            args = [value if kind is lane else splat(builder, value) for kind, value in pairs]
        return emit(builder, *args)

    if among is _NUMBERS:
        lower_builtin(function, *[types.Any] * arity)(lower)
    elif arity == 1:
        lower_builtin(function, LaneType)(lower)
    else:
        for kinds in ((LaneType, LaneType), (LaneType, types.Float), (types.Float, LaneType)):
            lower_builtin(function, *kinds)(lower)


for _name, _emit in OPERATORS.items():
    # Python's own operators are new only where a lane is among the operands.
    _teach(getattr(operator, _name), _emit, among=(LaneType,))

for _name, _emit in FUNCTIONS.items():
    _teach(getattr(lanes, _name), _emit)
