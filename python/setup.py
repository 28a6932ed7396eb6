"""A wheel of the package `tessera`, from Debian's tools alone:

    /usr/bin/python3 -m pip wheel --no-build-isolation --no-deps --wheel-dir dist python/

The compiled module is taken from TESSERA_BUILD (default: build/release, which `./run build` makes).
"""
import os
import pathlib
import re
import shutil

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent.parent


class TakeBuilt(build_ext):
    def build_extension(self, extension):
        folder = pathlib.Path(os.environ.get("TESSERA_BUILD", ROOT / "build/release")) / "python/tessera"
        built = sorted(folder.glob("_tessera*.so"))
        if not built:
            raise SystemExit(f"{folder}: holds no compiled module; run ./run build first, or set TESSERA_BUILD")
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(built[0], target)


setup(
    name="tessera",
    version=re.search(r"project\(tessera VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())[1],
    description="Dense RGB-D SLAM",
    license="MIT",
    python_requires=">=3.9",
    install_requires=["numpy"],
    packages=["tessera"],
    package_data={"tessera": ["__init__.pyi", "py.typed"]},
    ext_modules=[Extension("tessera._tessera", [])],
    cmdclass={"build_ext": TakeBuilt},
)
