"""Reads the exported package with pymoca, a parser of Modelica, puts deflections and velocities into the equations of its law,
and prints their rate and force: the equations are looked up by what they define, whatever their order. Reads lines of a
deflection and a velocity."""
import copy
import math
import sys

from pymoca import ast, parser, tree

PACKAGE = sys.argv[1]

with open(PACKAGE + ".mo") as file:
    parsed = parser.parse(file.read())
assert parsed is not None, "not parsed"
package = parsed.classes[PACKAGE]
assert list(package.classes) == ["Law", "Friction"], package.classes
flanged = package.classes["Friction"]
bases = [str(base.component) for base in flanged.extends]
assert len(bases) == 1 and bases[0].startswith("Modelica.Mechanics.") and len(flanged.equations) == 2, bases
name = ast.ComponentRef(name=PACKAGE, child=[ast.ComponentRef(name="Law")])
law = tree.flatten(copy.deepcopy(parsed), name).classes[PACKAGE + ".Law"]

parameters = {}
for symbol in law.symbols.values():
    if "parameter" in symbol.prefixes:
        parameters[symbol.name] = symbol.value
unknown = [s.name for s in law.symbols.values() if "parameter" not in s.prefixes and "input" not in s.prefixes]
assert sorted(n for n, s in law.symbols.items() if "input" in s.prefixes) == ["v"]
assert [n for n, s in law.symbols.items() if "output" in s.prefixes] == ["force"]
defined = {}
for equation in law.equations:
    left = equation.left
    if isinstance(left, ast.Expression):
        assert str(left.operator) == "der" and str(left.operands[0]) == "z"
        key = "der(z)"
    else:
        key = str(left)
    assert key not in defined, key
    defined[key] = equation.right
# as many equations as unknowns, and z by its derivative
assert sorted(defined) == sorted(["der(z)"] + [n for n in unknown if n != "z"]), (sorted(defined), unknown)

BINARY = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": lambda a, b: a / b if b else math.copysign(math.inf, a) if a else math.nan,
    "^": lambda a, b: a**b,
    ">=": lambda a, b: a >= b,
    "<=": lambda a, b: a <= b,
    "<": lambda a, b: a < b,
    ">": lambda a, b: a > b,
}
CALLS = {"exp": math.exp, "sin": math.sin, "sqrt": math.sqrt, "abs": abs, "min": min, "max": max, "noEvent": lambda x: x}


def value(node, known):
    """The value of an expression; what it refers to is worked out and remembered."""
    if isinstance(node, ast.Primary):
        return node.value
    if isinstance(node, ast.ComponentRef):
        key = str(node)
        if key not in known:
            known[key] = value(parameters[key] if key in parameters else defined[key], known)
        return known[key]
    if isinstance(node, ast.IfExpression):
        for condition, branch in zip(node.conditions, node.expressions):
            if value(condition, known):
                return value(branch, known)
        return value(node.expressions[-1], known)
    if isinstance(node, ast.Expression):
        operator = str(node.operator)
        if operator == "der":
            if "der(z)" not in known:
                known["der(z)"] = value(defined["der(z)"], known)
            return known["der(z)"]
        operands = [value(operand, known) for operand in node.operands]
        if operator == "-" and len(operands) == 1:
            return -operands[0]
        return CALLS[operator](*operands) if operator in CALLS else BINARY[operator](*operands)
    raise TypeError(type(node))


for line in sys.stdin:
    z, v = (float(x) for x in line.split())
    known = {"z": z, "v": v}
    force = value(defined["force"], known)
    print(repr(known["der(z)"]), repr(force))
