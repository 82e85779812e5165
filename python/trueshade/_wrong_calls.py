"""What a wrong call says: one line that names the argument, in the place of pybind11's list of all there are."""

import difflib
import functools
import inspect
import re

_TYPES = {
    "str": (lambda value: isinstance(value, (str, bytes)), "a str"),
    "bool": (lambda value: isinstance(value, bool) or type(value).__name__ in ("bool_", "bool"), "True or False"),
    "int": (lambda value: hasattr(value, "__index__"), "a whole number"),
    "float": (lambda value: hasattr(value, "__float__") or hasattr(value, "__index__"), "a number"),
    "dict": (lambda value: isinstance(value, dict), "a dict"),
}


def _signature(function):
    """Parameters and defaults, as the docstring begins with them; without `self`."""
    signature = inspect.signature(function)
    return signature.replace(parameters=[p for n, p in signature.parameters.items() if n != "self"])


def _wrong_keyword(name, known):
    close = difflib.get_close_matches(name, known, 1, 0.5)
    if close:
        return f"there is no argument {name!r} (did you mean {close[0]!r}?)"
    return f"there is no argument {name!r} (" + ("it has " + ", ".join(known) if known else "it has none") + ")"


def _described(value):
    kind = type(value).__name__
    return "None" if value is None else f"an {kind}" if kind[0] in "aeiou" else f"a {kind}"


def _wrong_type(bound, told):
    """The first argument whose type is not the one that pybind11 tells of: `flat: bool = False` and the like."""
    wanted = dict(re.findall(r"(\w+): ([\w.]+(?:\[[\w.]+\])?)", told))
    for name, value in bound.arguments.items():
        kind = wanted.get(name, "object")
        optional = re.fullmatch(r"Optional\[(.*)\]", kind)
        if optional and value is None:
            continue
        kind = optional.group(1) if optional else kind
        is_right, expected = _TYPES.get(kind, (lambda v, k=kind: type(v).__name__ == k.split(".")[-1], f"a {kind}"))
        if kind != "object" and not is_right(value):
            return f"{name} is {_described(value)}, and has to be {expected}"
    return "an argument is out of the range of its type"


def _account(function, told, args, kwargs):
    signature = _signature(function)
    known = list(signature.parameters)
    for name in kwargs:
        if name not in known:
            return _wrong_keyword(name, known)
    try:
        bound = signature.bind(*args, **kwargs)
    except TypeError as error:
        return str(error)
    return _wrong_type(bound, told)


def one_line(function, name, is_method=False):
    """The function, whose TypeError for a wrong call begins with `name` and is one line."""

    @functools.wraps(function)
    def call(*args, **kwargs):
        try:
            return function(*args, **kwargs)
        except TypeError as error:
            told = str(error)
            if "The following argument types are supported" not in told:
                raise
            text = _account(function, told, args[1:] if is_method else args, kwargs)
        raise TypeError(f"{name}: {text}")

    return call


def tell_in_one_line(kind):
    """Replaces the methods of a class by such functions."""
    for name, method in list(vars(kind).items()):
        if callable(method) and (not name.startswith("_") or name == "__init__") and inspect.isroutine(method):
            full = kind.__name__ if name == "__init__" else f"{kind.__name__}.{name}"
            setattr(kind, name, one_line(method, full, is_method=True))
