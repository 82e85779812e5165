"""Makes of the stub a table of docstrings for the binding: name, and signature and text as CPython's `inspect` reads them.

Usage: make_docs.py __init__.pyi docs.cpp
"""

import ast
import inspect
import sys


def signature(name, arguments):
    """`name(a, b=1)` with the marker after it that tells `inspect` where it ends."""
    bare = ast.parse(f"def f({ast.unparse(arguments)}): ...").body[0].args
    for argument in (*bare.posonlyargs, *bare.args, *bare.kwonlyargs):
        argument.annotation = None
    return f"{name}({ast.unparse(bare)})\n--\n\n"


def is_property(function):
    return any(getattr(d, "id", "") == "property" for d in function.decorator_list)


def docs_of_class(node):
    constructor = [n for n in node.body if isinstance(n, ast.FunctionDef) and n.name == "__init__"]
    text = inspect.cleandoc(ast.get_docstring(node) or "")
    head = ""
    for function in constructor:
        yield f"{node.name}.__init__", signature("__init__", function.args) + "See the class."
        function.args.args.pop(0)  # self
        head = signature(node.name, function.args)
    yield node.name, head + text
    for before, after in zip(node.body, node.body[1:] + [None]):
        if isinstance(before, ast.AnnAssign) and isinstance(after, ast.Expr):
            yield f"{node.name}.{before.target.id}", inspect.cleandoc(after.value.value)
        if isinstance(before, ast.FunctionDef) and not before.name.startswith("__"):
            head = "" if is_property(before) else signature(before.name, before.args)
            yield f"{node.name}.{before.name}", head + inspect.cleandoc(ast.get_docstring(before) or "")


def docs_of(tree):
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            yield node.name, signature(node.name, node.args) + inspect.cleandoc(ast.get_docstring(node) or "")
        elif isinstance(node, ast.ClassDef):
            yield from docs_of_class(node)


def main():
    stub, out = sys.argv[1:]
    with open(stub, encoding="utf-8") as file:
        rows = list(docs_of(ast.parse(file.read())))
    text = '// Made by python/make_docs.py from the stub.\n#include "python/binding/bindings.h"\n\n'
    text += "namespace trueshade::python {\n\nconst char* doc_of(std::string_view name) {\n"
    for name, doc in rows:
        text += f'  if (name == "{name}") return R"doc({doc})doc";\n'
    text += '  throw bad_argument(std::string(name), "the stub does not have it", "describe it in __init__.pyi");\n'
    text += "}\n\n}  // namespace trueshade::python\n"
    with open(out, "w", encoding="utf-8") as file:
        file.write(text)


main()
