"""Formulas of scenarios: triggers, measures and stopping rules as text, as in "distance(rov, diver) < 2 and time > 5".

Numbers, comparisons, and / or / not, + - * / **, min and max of numbers, and the functions of SIGNALS on participants' names.
Nothing else is evaluated. World axes: east, north, up.

NaN is what is not known, as a number that nobody has told yet. It says neither yes nor no: a comparison with it is NaN, and so are
"not", "and" and "or" unless their other values decide (Kleene 1952, 64).
"""
import ast
import math
import warnings

import numpy as np

from scenario import Refused, short

_BINARY = {ast.Add: lambda a, b: a + b, ast.Sub: lambda a, b: a - b, ast.Mult: lambda a, b: a * b,
           ast.Div: lambda a, b: a / b if b else math.nan, ast.Pow: lambda a, b: _power(a, b)}
_COMPARE = {ast.Lt: lambda a, b: a < b, ast.LtE: lambda a, b: a <= b, ast.Gt: lambda a, b: a > b,
            ast.GtE: lambda a, b: a >= b, ast.Eq: lambda a, b: a == b, ast.NotEq: lambda a, b: a != b}


def says_yes(value):
    """Whether a formula's value says yes: any number but 0. NaN does not."""
    return value == value and value != 0


def _decided(values, decisive):
    """The "or" (decisive: True) or "and" (False) of values: NaN where none decides and one is not known. Later ones are not asked
    for once one decides."""
    known = True
    for value in values:
        if value != value:
            known = False
        elif says_yes(value) == decisive:
            return decisive
    return not decisive if known else math.nan


def _power(a, b):
    """NaN where no real number is the power, as where something is divided by zero."""
    try:
        value = a ** b
    except (ZeroDivisionError, OverflowError):
        return math.nan
    return math.nan if isinstance(value, complex) else value


def _of_numbers(choose):
    """min or max; NaN where one of them is none."""
    return lambda values: math.nan if any(math.isnan(v) for v in values) else float(choose(values))


_NUMBERS = {"min": _of_numbers(min), "max": _of_numbers(max)}


def _facing(m, a, b):
    """Degrees between the way that a faces and the line from a to b."""
    x, y, z, w = m.truth(a).orientation
    ahead = np.array([1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)])
    line = m.place(b) - m.place(a)
    return math.degrees(math.acos(max(-1.0, min(1.0, float(ahead @ line) / max(float(np.linalg.norm(line)), 1e-9)))))


def _beside(m, a, b, c):
    line = m.place(c) - m.place(b)
    along = float((m.place(a) - m.place(b)) @ line / max(float(line @ line), 1e-12))
    return float(np.linalg.norm(m.place(a) - m.place(b) - along * line))


def _along(m, a, b, c):
    line = m.place(c) - m.place(b)
    return float((m.place(a) - m.place(b)) @ line / max(float(line @ line), 1e-12))


# The kinds of names that a signal takes: something with a place, a thing that moves, a diver with a human's body.
PLACE, THING, BODY = "place", "thing", "body"
# name: (function of the moment and the names, what each name has to be, what it is)
SIGNALS = {
    "distance": (lambda m, a, b: float(np.linalg.norm(m.place(a) - m.place(b))), (PLACE, PLACE), "m between two"),
    "level_distance": (lambda m, a, b: float(np.hypot(*(m.place(a) - m.place(b))[:2])), (PLACE, PLACE), "m between two, level"),
    "depth": (lambda m, a: -float(m.place(a)[2]), (PLACE,), "m below the surface"),
    "east": (lambda m, a: float(m.place(a)[0]), (PLACE,), "m"),
    "north": (lambda m, a: float(m.place(a)[1]), (PLACE,), "m"),
    "speed": (lambda m, a: float(np.linalg.norm(m.truth(a).linear_velocity)), (THING,), "m/s over ground"),
    "facing": (_facing, (THING, PLACE), "degrees between the first's way ahead and the second"),
    "along": (_along, (PLACE,) * 3, "projection of the first on the line from the second to the third, a share of it"),
    "beside": (_beside, (PLACE,) * 3, "m from the first to the line through the second and the third"),
    "breath": (lambda m, a: m.body(a, "breath_bpm"), (BODY,), "true breaths a minute of a diver with a human's body"),
    "heart": (lambda m, a: m.body(a, "heart_bpm"), (BODY,), "true beats of its heart a minute"),
    "touched": (lambda m, a: float(m.truth(a).touched_steps), (THING,), "steps in which it touched something"),
}


class Formula:
    """A checked text. Plain data but for its syntax tree, which is made anew in each process."""

    def __init__(self, where, text, names, numbers, places=()):
        """names: the participants; places: names of fixed points; numbers: words that stand for numbers (settings, time, what the player
        tells). bodies: [(signal, name)], of which a signal needs a human's body."""
        self.where, self.text, self.bodies, self._places = where, text, [], set(places)
        if not isinstance(text, str):
            raise Refused(f"{where}: found {short(repr(text))}; accepted: a formula in quotes")
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", SyntaxWarning)  # is raised as a SyntaxError: "1or 2"
                self._tree = ast.parse(text, mode="eval").body
        except (SyntaxError, ValueError, RecursionError):
            raise Refused(f"{where}: found \"{short(text)}\"; accepted: a formula, as \"distance(rov, diver) < 2\"") from None
        try:
            self._check(self._tree, set(names), set(numbers))
        except RecursionError:
            raise Refused(f"{where}: found \"{short(text)}\", whose parts are nested too deep; accepted: a shorter formula") from None

    def _refuse(self, found, accepted):
        raise Refused(f"{self.where}: found {short(found)} in \"{short(self.text)}\"; accepted: {accepted}")

    def _check(self, node, names, numbers):
        if isinstance(node, ast.Constant) and isinstance(node.value, (int, float)):
            return
        if isinstance(node, ast.Name):
            if node.id not in numbers:
                self._refuse(f"\"{node.id}\"", ", ".join(sorted(numbers)))
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.Not)):
            self._check(node.operand, names, numbers)
        elif isinstance(node, ast.BinOp) and type(node.op) in _BINARY:
            self._check(node.left, names, numbers)
            self._check(node.right, names, numbers)
        elif isinstance(node, ast.BoolOp):
            for value in node.values:
                self._check(value, names, numbers)
        elif isinstance(node, ast.Compare) and all(type(op) in _COMPARE for op in node.ops):
            for value in (node.left, *node.comparators):
                self._check(value, names, numbers)
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
            if node.func.id in _NUMBERS:
                if len(node.args) < 2:
                    self._refuse(f"{node.func.id} of {len(node.args)}", "two numbers or more")
                for value in node.args:
                    self._check(value, names, numbers)
                return
            if node.func.id not in SIGNALS:
                self._refuse(f"\"{node.func.id}\"", ", ".join([*SIGNALS, *_NUMBERS]))
            roles = SIGNALS[node.func.id][1]
            told = [a.id for a in node.args if isinstance(a, ast.Name)]
            if len(told) != len(node.args) or len(told) != len(roles) or not set(told) <= names | self._places:
                self._refuse(f"{node.func.id}({', '.join(told)})", f"{len(roles)} of {', '.join(sorted(names | self._places))}")
            for name, role in zip(told, roles):
                if role != PLACE and name in self._places:
                    self._refuse(f"{node.func.id}({', '.join(told)}), whose {name} is a place",
                                 f"one of {', '.join(sorted(names)) or 'no participants'}")
                if role == BODY:
                    self.bodies.append((node.func.id, name))
        else:
            self._refuse(type(node).__name__, "numbers, comparisons, and, or, not, + - * / **, functions")

    def __getstate__(self):
        return self.where, self.text

    def __setstate__(self, state):
        self.where, self.text = state
        self._tree = ast.parse(self.text, mode="eval").body

    def constant(self):
        """Its value where it names nothing; else None."""
        return None if any(isinstance(n, ast.Name) for n in ast.walk(self._tree)) else self._value(self._tree, None)

    def value(self, moment):
        return self._value(self._tree, moment)

    def _value(self, node, m):
        if isinstance(node, ast.Constant):
            return float(node.value)
        if isinstance(node, ast.Name):
            return m.number(node.id)
        if isinstance(node, ast.UnaryOp):
            value = self._value(node.operand, m)
            return -value if isinstance(node.op, ast.USub) else math.nan if value != value else not value
        if isinstance(node, ast.BinOp):
            return _BINARY[type(node.op)](self._value(node.left, m), self._value(node.right, m))
        if isinstance(node, ast.BoolOp):
            values = (self._value(v, m) for v in node.values)
            return _decided(values, isinstance(node.op, ast.Or))
        if isinstance(node, ast.Compare):
            return _decided(self._compared(node, m), False)
        if node.func.id in _NUMBERS:
            return _NUMBERS[node.func.id]([float(self._value(a, m)) for a in node.args])
        return SIGNALS[node.func.id][0](m, *(a.id for a in node.args))

    def _compared(self, node, m):
        """Of "a < b < c": whether a < b, and whether b < c; NaN where a side is not known."""
        left = self._value(node.left, m)
        for op, right in zip(node.ops, node.comparators):
            right = self._value(right, m)
            yield math.nan if left != left or right != right else _COMPARE[type(op)](left, right)
            left = right
