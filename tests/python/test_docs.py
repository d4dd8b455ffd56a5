"""Every example of every docstring is run; every public name has one, with the names' types."""

import ast
import doctest
import inspect
import os
import re
from pathlib import Path

import pytest

import radiosity as rad


def documented():
    """Names with their docstrings: the package, its functions, classes and their members."""
    yield "radiosity", rad
    for name in rad.__all__:
        thing = getattr(rad, name)
        yield name, thing
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            for member, value in vars(thing).items():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    yield f"{name}.{member}", value


NAMES = dict(documented())


@pytest.mark.parametrize("name", NAMES)
def test_every_name_has_a_docstring_whose_examples_run(name):
    text = NAMES[name].__doc__
    assert text, f"{name} has no docstring"
    test = doctest.DocTestParser().get_doctest(text, {"rad": rad}, name, name, 0)
    told = []
    doctest.DocTestRunner(optionflags=doctest.ELLIPSIS, verbose=False).run(test, out=told.append)
    assert not told, "".join(told)


def test_the_code_of_the_page_runs(tmp_path, monkeypatch):
    page = "src/python/README.md"
    root = Path(os.environ["RADIOSITY_SOURCE_DIR"])
    blocks = re.findall(r"^```python\n(.*?)^```", (root / page).read_text(), re.DOTALL | re.MULTILINE)
    assert len(blocks) == 1
    (tmp_path / "data").symlink_to(root / "data")
    monkeypatch.chdir(tmp_path)  # it may write files
    made = {}
    exec(compile(blocks[0], page, "exec"), made)
    assert made["image"].shape == (512, 512, 4) and made["light"].summary["status"] == "converged"


def test_every_function_that_computes_has_an_example():
    without = [name for name, thing in NAMES.items()
               if inspect.isfunction(thing) and "." not in name and ">>>" not in thing.__doc__]
    assert without == ["from_trimesh"]  # Debian has no trimesh; test_foreign.py has a stand-in


def test_arguments_and_results_are_annotated():
    for name, thing in NAMES.items():
        function = thing.fget if isinstance(thing, property) else thing
        if inspect.isfunction(function):
            signature = inspect.signature(function)
            assert signature.return_annotation is not inspect.Signature.empty, name
            for parameter in signature.parameters.values():
                assert parameter.name == "self" or parameter.annotation is not inspect.Parameter.empty, name


def test_the_stub_of_the_extension_module_is_complete():
    from radiosity import _core

    stub = ast.parse((Path(rad.__file__).parent / "_core.pyi").read_text())
    said = {node.name: node for node in stub.body if isinstance(node, (ast.ClassDef, ast.FunctionDef))}
    there = {name for name in vars(_core) if not name.startswith("_")} - {"version"}
    assert set(said) == there
    for name, node in said.items():
        if isinstance(node, ast.ClassDef) and not name.endswith("Error"):
            members = {m.name for m in node.body if isinstance(m, ast.FunctionDef)}
            assert members == {m for m in vars(getattr(_core, name)) if not m.startswith("_")}, name


def test_annotations_fit_each_other():
    mypy = pytest.importorskip("mypy.api")
    cache = Path(os.environ["RADIOSITY_BUILD_DIR"]) / "python/mypy"
    said, _, code = mypy.run(["--ignore-missing-imports", f"--cache-dir={cache}",
                              os.environ["RADIOSITY_SOURCE_DIR"] + "/src/python/radiosity"])
    assert code == 0, said
