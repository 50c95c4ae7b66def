"""Formulas written as LLVM's code: the same arithmetic as with numpy, for one chain and for eight."""

import ctypes
import itertools
import math

import numpy as np
import pytest
from llvmlite import binding, ir

from sonicvacuum.effects import IDS, Setup, effect
from sonicvacuum.effects.trial import sample
from sonicvacuum.physics import cubic, lanes
from sonicvacuum.physics.arithmetic import LANES_KIND
from sonicvacuum.physics.laws import SLOTS
from sonicvacuum.physics.linking import object_file
from sonicvacuum.physics.machine import address_of
from sonicvacuum.physics.tracing import FormulaError, Number, worked_out

_numbered = itertools.count()
# Powers of lanes are good to 1e-13, their square roots to 6e-13; sums of a few that cancel lose two digits.
ROUNDING = 1e-10


def written(formula, width, values):
    """What the code of a formula makes of values, one array (n,) for each argument, `width` at a time."""
    kind = LANES_KIND if width == lanes.LANES else ir.DoubleType()
    pointer, module = kind.as_pointer(), ir.Module()
    name = f"formula_{next(_numbered)}"
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), [pointer, pointer]), name)
    builder, (given, found) = ir.IRBuilder(function.append_basic_block()), function.args
    rows = [builder.gep(given, [ir.Constant(ir.IntType(64), k)]) for k in range(len(values))]
    result = worked_out(formula, *(Number(builder, builder.load(row, align=8)) for row in rows))
    builder.store(result.value, found, align=8)
    builder.ret_void()
    compiled = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(
        address_of(name, object_file(binding.parse_assembly(str(module)), name))
    )
    out = np.empty(values.shape[1])
    for at in range(0, len(out), width):
        row, made = np.ascontiguousarray(values[:, at : at + width]), np.empty(width)
        compiled(row.ctypes.data, made.ctypes.data)
        out[at : at + width] = made
    return out


def coefficients(term, setup):
    """A number for each coefficient of a term in a changed chain, of its first contact."""
    chain = setup.chain
    laws = chain.laws(True)
    table = chain.coefficients(laws, 3)
    start = laws.first_coefficient[term.name]
    return table[1, start : start + term.coefficients, 0]


def terms():
    """Term → its coefficients, of every effect of the catalogue that changes what acts in a chain."""
    for name in IDS:
        one = effect(name)
        setup = next((s for s in (sample(), sample(coated=True)) if one.why_not(s) is None), None)
        if setup is None:
            continue
        values = {p.name: p.at(1.0, setup) for p in one.parameters}
        place = {one.places: one.candidates(setup)[0]} if one.places else {}
        changed: Setup = one.apply(setup, **values, **place)
        for term in changed.chain.laws(True).terms:
            yield pytest.param(term, coefficients(term, changed), id=f"{name}-{term.name}")


@pytest.mark.parametrize("width", [1, lanes.LANES])
@pytest.mark.parametrize(("term", "given"), list(terms()))
def test_a_law_is_the_same_in_compiled_code(term, given, width):
    random = np.random.default_rng(1)
    for formula in filter(None, (term.formula, term.growth, term.energy)):
        own = {term.growth: 2, term.energy: 1}.get(formula, SLOTS[term.slot])
        # Compressions of micrometres, rates of millimetres per second, forces of newtons, and none of them.
        values = random.choice([-1.0, 0.0, 1.0], (own, 64)) * 10.0 ** random.uniform(-7.0, 0.5, (own, 64))
        many = np.vstack([values, np.repeat(given[:, None], values.shape[1], axis=1)])
        with np.errstate(all="ignore"):
            expected = np.broadcast_to(formula(*many), values.shape[1])
        found = written(formula, width, many)
        scale = np.abs(expected[np.isfinite(expected)]).max(initial=1e-300)
        np.testing.assert_allclose(found, expected, rtol=ROUNDING, atol=1e-15 * scale)


@pytest.mark.parametrize("width", [1, lanes.LANES])
@pytest.mark.parametrize("formula", [cubic.hermite, cubic.highest])
def test_cubics_are_the_same_in_compiled_code(formula, width):
    count = formula.__code__.co_argcount
    values = np.random.default_rng(2).uniform(-1.0, 1.0, (count, 64))
    np.testing.assert_allclose(written(formula, width, values), formula(*values), rtol=ROUNDING, atol=1e-12)


def test_the_highest_value_is_that_of_the_cubic():
    v, w, gain = np.random.default_rng(3).uniform(-1.0, 1.0, (3, 200))
    curve = cubic.hermite(0.0, v, gain, w, np.linspace(0.0, 1.0, 2001)[:, None])
    found, humped = cubic.highest(v, w, gain), (v > 0.0) & (w < 0.0)
    # The top lies within 1e-6 of the nearest of 2001 points.
    np.testing.assert_allclose(found[humped], curve.max(axis=0)[humped], atol=1e-6)


def numbers(count=2):
    function = ir.Function(ir.Module(), ir.FunctionType(ir.VoidType(), [ir.DoubleType()] * count), "f")
    builder = ir.IRBuilder(function.append_basic_block())
    return [Number(builder, a) for a in function.args]


@pytest.mark.parametrize(
    ("formula", "words"),
    [
        (lambda x, y: x if x > y else y, "see select"),
        (lambda x, y: max(x, y), "see select"),
        (lambda x, y: x and y, "see select"),
        (lambda x, y: x * math.exp(y), "must be real number"),
        (lambda x, y: x + "1", "str where a number belongs"),
        (lambda x, y: None, "NoneType where a number belongs"),
        (lambda x, y: np.exp(x), "Number"),
        (lambda x, y: x.real, "no attribute 'real'"),
    ],
)
def test_what_is_no_plain_arithmetic_is_refused(formula, words):
    with pytest.raises(FormulaError, match=words):
        worked_out(formula, *numbers())


def test_numbers_of_numpy_and_whole_ones_are_constants():
    def formula(x, y):
        return np.float64(2.0) * x - 1 + y / np.int64(4) - lanes.select(1.0, x, y)

    found = written(formula, 1, np.array([[3.0], [8.0]]))
    assert found == 6.0 - 1.0 + 2.0 - 3.0
