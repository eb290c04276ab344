"""apps/python/freevoxels/__init__.pyi names exactly the package's functions, classes, parameters and keywords.

Usage: stub_test.py SOURCE_FOLDER"""

import ast
import inspect
import pathlib
import re
import sys
import unittest

import freevoxels

SOURCE = pathlib.Path(sys.argv.pop())
STUB = pathlib.Path(freevoxels.__file__).with_name("__init__.pyi")
TREE = ast.parse(STUB.read_text())


def public(names):
    return {name for name in names if not name.startswith("_") or name in ("__init__", "__version__")}


def declared(body):
    """The public names of a module or class of the stub, with their nodes; overloads of a function are a list."""
    names = {}
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.setdefault(node.name, []).append(node)
        elif isinstance(node, ast.AnnAssign):
            names.setdefault(node.target.id, []).append(node)
    return {name: nodes for name, nodes in names.items() if public([name])}


def parameters(function):
    """Names of parameters by kind, in their order, and which of them have defaults."""
    arguments = function.args
    return (
        [argument.arg for argument in arguments.posonlyargs + arguments.args],
        [argument.arg for argument in arguments.kwonlyargs],
        arguments.kwarg is not None,
        len(arguments.defaults),
    )


def compiled(function):
    """The signature that inspect finds of the module's function."""
    return ast.parse(f"def f{str(inspect.signature(function)).replace('/, ', '')}: ...").body[0]


def keywords(name):
    """The keywords of a TypedDict of the stub and its bases, but for sections of scenes."""
    node = next(node for node in TREE.body if isinstance(node, ast.ClassDef) and node.name == name)
    own = {field.target.id for field in node.body if isinstance(field, ast.AnnAssign)}
    return own.union(*(keywords(base.id) for base in node.bases if base.id.startswith("_")))


class StubTest(unittest.TestCase):
    def expect_parameters(self, nodes, function):
        for node in nodes:
            self.assertEqual(parameters(node)[:3], parameters(compiled(function))[:3], node.name)
        self.assertIn(parameters(compiled(function))[3], {parameters(node)[3] for node in nodes}, nodes[0].name)

    def test_names_are_those_of_the_module(self):
        self.assertEqual(set(declared(TREE.body)), public(vars(freevoxels)))
        self.assertEqual(set(declared(TREE.body)) - {"__version__"}, set(freevoxels.__all__))

    def test_names_are_those_of_the_package_and_not_of_its_compiled_part(self):
        for name in freevoxels.__all__:
            self.assertEqual(getattr(freevoxels, name).__module__, "freevoxels", name)
        self.assertTrue(STUB.with_name("py.typed").exists())

    def test_functions_have_their_parameters(self):
        for name, nodes in declared(TREE.body).items():
            if isinstance(nodes[0], ast.FunctionDef):
                self.expect_parameters(nodes, getattr(freevoxels, name))

    def test_classes_have_their_members_and_bases(self):
        for name, (node, *_) in declared(TREE.body).items():
            if not isinstance(node, ast.ClassDef):
                continue
            cls = getattr(freevoxels, name)
            bases = [base.id for base in node.bases]
            if issubclass(cls, BaseException):
                self.assertEqual(bases, [base.__name__ for base in cls.__bases__])
                continue
            members = declared(node.body)
            self.assertEqual(set(members), public(vars(cls)), name)
            for member, nodes in members.items():
                value = inspect.getattr_static(cls, member)
                if member == "__init__":
                    of_class = inspect.signature(cls)
                    self.assertEqual(list(of_class.parameters), list(inspect.signature(cls.__init__).parameters)[1:])
                    self.expect_parameters(nodes, cls.__init__)
                    continue
                if isinstance(value, property):
                    self.assertEqual(ast.unparse(nodes[0].decorator_list[0]), "property", member)
                else:
                    self.expect_parameters(nodes, getattr(cls, member))

    def test_objects_say_what_they_are(self):
        volume = freevoxels.Volume([[[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]])
        self.assertEqual(repr(volume), "<freevoxels.Volume of the array: 1 x 2 x 3 voxels along z, y, x>")
        renderer = freevoxels.Renderer(volume)
        self.assertEqual(repr(renderer), f"<freevoxels.Renderer on {renderer.device}>")

    def test_documentation_has_no_signature_twice(self):
        for item in (freevoxels.render, freevoxels.save, freevoxels.Volume, freevoxels.Renderer, freevoxels.Renderer.render, freevoxels.Volume.open,
                     freevoxels.Sequence, freevoxels.Sequence.render, freevoxels.render_sequence):
            self.assertNotIn("--", item.__doc__.splitlines()[0])
            self.assertFalse(item.__doc__.startswith(item.__name__ + "("), item.__doc__)

    def test_keywords_are_those_of_the_list_of_scene_keys(self):
        text = (SOURCE / "apps" / "scenes" / "README.md").read_text()
        for section, table in re.findall(r"^## (\w+)$(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL):
            listed = {key.replace("-", "_") for key in re.findall(r"^\| `([\w-]+)` \|", table, re.MULTILINE)}
            # A section's own name is a keyword for all of it, and "light" one for a single light.
            self.assertEqual(keywords(f"_{section.capitalize()}") - {section} | listed & {section}, listed, section)


if __name__ == "__main__":
    unittest.main()
