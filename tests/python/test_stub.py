"""The stub says what the module has: names, parameters and defaults; and every public name has a docstring."""

import ast
import inspect
import re
import shutil
import subprocess
from pathlib import Path

import pytest
import trueshade

STUB = Path(trueshade.__file__).with_name("__init__.pyi")
TREE = ast.parse(STUB.read_text())
FUNCTIONS = {node.name: node for node in TREE.body if isinstance(node, ast.FunctionDef)}
CLASSES = {node.name: node for node in TREE.body if isinstance(node, ast.ClassDef)}


def methods_of(node):
    return {f.name: f for f in node.body if isinstance(f, ast.FunctionDef)}


def is_property(function):
    return any(getattr(d, "id", "") == "property" for d in function.decorator_list)


def parameters(arguments):
    """(name, whether by keyword alone, default) of each parameter but self."""
    rows, plain = [], arguments.args
    defaults = [None] * (len(plain) - len(arguments.defaults)) + arguments.defaults
    for argument, default in [*zip(plain, defaults)]:
        rows.append((argument.arg, False, None if default is None else ast.literal_eval(default)))
    for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults):
        rows.append((argument.arg, True, None if default is None else ast.literal_eval(default)))
    return [row for row in rows if row[0] != "self"]


def parameters_told_by_the_binding(call):
    """What pybind11 itself prints of a function when it is called wrongly, which no docstring has a part in."""
    with pytest.raises(TypeError) as caught:
        if inspect.isclass(call):
            call.__init__.__wrapped__(call.__new__(call), no_such_parameter=1)
        call.__wrapped__(no_such_parameter=1)
    line = re.search(r"^    1\. (.*)$", str(caught.value), re.MULTILINE).group(1)
    text = re.sub(r"^\w+(\.\w+)*", "", line)[: line.rfind(")") + 1] if not line.startswith("(") else line
    text = text[: text.rindex(")") + 1]
    text = re.sub(r": [A-Za-z_][\w.]*(\[[^=]*?\])?(?=[,)= ])", "", text)  # types
    return parameters(ast.parse(f"def f{text}: ...").body[0].args)


def test_the_names_are_those_of_the_stub():
    stub = {*FUNCTIONS, *CLASSES, "__version__"}
    assert set(trueshade.__all__) == stub
    public = {name for name in vars(trueshade) if not name.startswith("_") and name != "pytest_plugin"}
    assert public == stub - {"__version__"}
    for name, node in CLASSES.items():
        told = {n for n in methods_of(node) if not n.startswith("__")}
        told |= {n.target.id for n in node.body if isinstance(n, ast.AnnAssign)}
        base = ValueError if name == "Error" else object
        there = {n for n in dir(getattr(trueshade, name)) if not n.startswith("_")} - set(dir(base))
        assert there == told, name


@pytest.mark.parametrize("name", FUNCTIONS)
def test_functions_have_the_parameters_of_the_stub(name):
    told = parameters(FUNCTIONS[name].args)
    assert parameters_told_by_the_binding(getattr(trueshade, name)) == told
    assert list(inspect.signature(getattr(trueshade, name)).parameters) == [row[0] for row in told]


@pytest.mark.parametrize(
    "name, method",
    [(c, m) for c in CLASSES for m, f in methods_of(CLASSES[c]).items() if not is_property(f) and m != "spec"],
)
def test_methods_have_the_parameters_of_the_stub(name, method):
    made = {
        "Scene": trueshade.Scene,
        "Pipeline": trueshade.Pipeline,
        "Frame": lambda: trueshade.render(trueshade.Scene(), trueshade.Pipeline(size=(1, 1))),
    }[name]()
    call = getattr(trueshade, name) if method == "__init__" else getattr(made, method)
    told = parameters(methods_of(CLASSES[name])[method].args)
    assert parameters_told_by_the_binding(call) == told
    assert list(inspect.signature(call).parameters) == [row[0] for row in told]


def test_every_public_name_has_a_docstring():
    for name in trueshade.__all__:
        if name == "__version__":
            continue
        thing = getattr(trueshade, name)
        assert len(inspect.getdoc(thing)) > 30, name
        if inspect.isclass(thing):
            for member in CLASSES[name].body:
                if isinstance(member, ast.FunctionDef) and not member.name.startswith("__"):
                    assert len(inspect.getdoc(getattr(thing, member.name))) > 15, f"{name}.{member.name}"


def test_functions_that_take_arrays_say_shape_type_and_error():
    for thing in (trueshade.Scene.add_mesh, trueshade.Scene.add_texture, trueshade.Scene.add_point_lights,
                  trueshade.shade, trueshade.validate, trueshade.compare, trueshade.write_image):  # fmt: skip
        text = inspect.getdoc(thing)
        assert re.search(r"\((n|height), ", text) and re.search(r"float32|uint8", text) and "Error" in text, thing


def test_mypy_accepts_the_stub_and_a_program_that_uses_it(tmp_path):
    if shutil.which("mypy") is None:
        pytest.skip("mypy is not installed (Debian: apt-get install mypy)")
    program = tmp_path / "program.py"
    program.write_text(
        "import trueshade\n"
        "frame = trueshade.render(trueshade.load_scene('builtin:city'), trueshade.Pipeline(size=(4, 4)))\n"
        "print(frame.planes['depth'].shape)\n"
        "passed: bool = trueshade.compare(frame.color, 'a.png', page='a.html')['pass']\n"
        "trueshade.Scene().add_light('point', range=None)\n"
    )
    package = tmp_path / "trueshade"
    package.mkdir()
    for name in ("__init__.pyi", "py.typed"):
        shutil.copy(STUB.with_name(name), package)
    done = subprocess.run(
        [shutil.which("mypy"), "--strict", "--cache-dir", tmp_path / "cache", "trueshade/__init__.pyi", "program.py"],
        cwd=tmp_path, capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 0, done.stdout + done.stderr
    program.write_text(program.read_text() + "trueshade.render(3)\n")
    wrong = subprocess.run(
        [shutil.which("mypy"), "--strict", "--cache-dir", tmp_path / "cache", "program.py"],
        cwd=tmp_path, capture_output=True, text=True,
    )  # fmt: skip
    assert wrong.returncode == 1 and 'expected "Scene"' in wrong.stdout
