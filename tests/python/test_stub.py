"""Checks that __init__.pyi matches the module, name by name and parameter by parameter."""
import ast
import pathlib
import re
import unittest

from small_scene import tessera


def parameters_of(function):
    """The parameters of a function in the stub: name, and whether it has a default."""
    names = [argument.arg for argument in function.args.args if argument.arg != "self"]
    required = len(names) - len(function.args.defaults)
    return [(name, i >= required) for i, name in enumerate(names)]


def parameters_in(docstring):
    """The same for a bound function, from the signature at the start of its docstring."""
    signature = docstring.splitlines()[0].rsplit(" -> ", 1)[0]
    parts = re.split(r"[(,] ?(?=\w+: )", signature)[1:]
    return [(part.split(":")[0], " = " in part) for part in parts if not part.startswith("self:")]


class Stub(unittest.TestCase):
    def setUp(self):
        tree = ast.parse((pathlib.Path(tessera.__file__).parent / "__init__.pyi").read_text())
        self.classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
        self.functions = {node.name: node for node in tree.body if isinstance(node, ast.FunctionDef)}

    def test_the_names_of_the_module(self):
        self.assertEqual(sorted([*self.classes, *self.functions, "__version__"]), sorted(tessera.__all__))

    def test_the_members_of_the_classes(self):
        for name, node in self.classes.items():
            bound = getattr(tessera, name)
            promised = {f.name for f in node.body if isinstance(f, ast.FunctionDef)}
            there = {member for member in vars(bound) if not member.startswith("_")}
            self.assertEqual({member for member in promised if not member.startswith("_")}, there, name)
            self.assertLessEqual(promised, set(dir(bound)), name)

    def test_the_parameters(self):
        checked = 0
        for name, function in self.functions.items():
            self.assertEqual(parameters_of(function), parameters_in(getattr(tessera, name).__doc__), name)
        for name, node in self.classes.items():
            for f in node.body:
                if not isinstance(f, ast.FunctionDef) or f.decorator_list or f.name in ("__len__", "__next__"):
                    continue
                there = getattr(getattr(tessera, name), f.name).__doc__
                self.assertEqual(parameters_of(f), parameters_in(there), f"{name}.{f.name}")
                checked += 1
        self.assertGreater(checked, 8)


if __name__ == "__main__":
    unittest.main()
