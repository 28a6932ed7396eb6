#!/usr/bin/env python3
"""Installs into an empty folder what was built, and uses it: the program, a consumer of the libraries, the Python
package, the Debian packages. Usage: test_install.py BUILD_DIR"""
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(sys.argv.pop(1))
HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]


def call(*command, **options):
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          **options)
    if done.returncode != 0:
        raise AssertionError(f"{command}: exit code {done.returncode}\n{done.stdout}")
    return done.stdout


class Install(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls._folder = tempfile.TemporaryDirectory()
        cls.prefix = pathlib.Path(cls._folder.name) / "usr"
        call("cmake", "--install", BUILD, "--prefix", cls.prefix)

    @classmethod
    def tearDownClass(cls):
        cls._folder.cleanup()

    def test_the_program_with_its_manual_and_completion(self):
        program = self.prefix / "bin/tessera"
        self.assertRegex(call(program, "--version"), r"tessera \d+\.\d+\.\d+")
        page = (self.prefix / "share/man/man1/tessera.1").read_text()
        self.assertIn(".SS scan merge", page)
        self.assertIn("\\-\\-loop\\-closure", page)
        script = self.prefix / "share/bash-completion/completions/tessera"
        answer = call("bash", "-c", f"source {script}; COMP_WORDS=(tessera run --loop); COMP_CWORD=2; _tessera; "
                                    "echo ${COMPREPLY[@]}")
        self.assertEqual(answer.strip(), "--loop-closure")
        self.assertTrue((self.prefix / "share/doc/tessera/docs/guide.md").exists())

    def test_the_kinects_driver_where_openni2_looks(self):
        if not (BUILD / "drivers/kinect/libTesseraFreenect.so.0").exists():
            self.skipTest("apt-get install libfreenect-dev")
        self.assertEqual(len(list(self.prefix.glob("lib/*-linux-gnu/OpenNI2/Drivers/libTesseraFreenect.so.0"))), 1)

    def test_a_program_finds_the_libraries(self):
        build = pathlib.Path(self._folder.name) / "consumer"
        call("cmake", "-S", HERE / "consumer", "-B", build, "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={self.prefix}",
             "-DCMAKE_BUILD_TYPE=Release")
        call("cmake", "--build", build)
        self.assertEqual(call(build / "consumer").strip(), "5 of 5 tracked")

    def test_the_python_package(self):
        folder = self.prefix / "lib/python3/dist-packages"
        if not folder.exists():
            self.skipTest("this build has no Python module")
        said = call("/usr/bin/python3", "-c", "import tessera, tessera.stream; print(tessera.__version__)",
                    env={**os.environ, "PYTHONPATH": str(folder)}, cwd=self._folder.name)
        self.assertRegex(said, r"^\d+\.\d+\.\d+$")

    def test_a_wheel_in_a_new_environment(self):
        # Imported one after the other, pip and setuptools want two different distutils.
        if not all(importlib.util.find_spec(name) for name in ("ensurepip", "pip", "setuptools", "wheel")):
            self.skipTest("apt-get install python3-venv python3-pip python3-setuptools python3-wheel")
        if not list((BUILD / "python/tessera").glob("_tessera*.so")):
            self.skipTest("this build has no Python module")
        folder = pathlib.Path(self._folder.name)
        # Built from a copy: setuptools leaves files beside its sources.
        sources = folder / "sources"
        shutil.copytree(ROOT / "python", sources / "python", symlinks=True)
        shutil.copy(ROOT / "CMakeLists.txt", sources)
        call(sys.executable, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps", "--no-index", "--wheel-dir",
             folder / "dist", sources / "python", env={**os.environ, "TESSERA_BUILD": str(BUILD)})
        wheels = list((folder / "dist").glob("tessera-*.whl"))
        self.assertEqual(len(wheels), 1)
        self.assertNotIn("none-any", wheels[0].name)
        call(sys.executable, "-m", "venv", "--system-site-packages", folder / "venv")  # NumPy is Debian's
        python = folder / "venv/bin/python"
        call(python, "-m", "pip", "install", "--no-index", "--no-deps", wheels[0])
        said = call(python, "-c", "import time; t = time.monotonic(); import tessera; "
                                  "print(tessera.__version__, tessera.__file__, round(1000 * (time.monotonic() - t)))",
                    cwd=folder, env={k: v for k, v in os.environ.items() if k != "PYTHONPATH"})
        self.assertIn(str(folder / "venv"), said)
        print(f"{wheels[0].name}: {wheels[0].stat().st_size / 2**20:.1f} MB, imported in {said.split()[-1]} ms")

    def test_the_debian_packages(self):
        if not (shutil.which("dpkg-shlibdeps") and shutil.which("file")):
            self.skipTest("apt-get install dpkg-dev file")
        folder = pathlib.Path(self._folder.name)
        call("cpack", "--config", BUILD / "CPackConfig.cmake", "-B", folder / "packages")
        packages = {re.match(r"[a-z0-9-]+", p.name)[0]: p for p in (folder / "packages").glob("*.deb")}
        self.assertIn("tessera", packages)
        self.assertIn("libtessera-dev", packages)
        for name, package in packages.items():
            depends = call("dpkg-deb", "-f", package, "Depends")
            self.assertGreater(len(depends.split(",")), 1, name)
            self.assertIn(f"/usr/share/doc/{name}/copyright\n", call("dpkg-deb", "-c", package))
            print(f"{package.name}: {package.stat().st_size / 2**20:.1f} MB, depends on {len(depends.split(','))}")
        self.assertIn("libopencv-core", call("dpkg-deb", "-f", packages["tessera"], "Depends"))
        searched = call("dpkg-deb", "-f", packages["libtessera-dev"], "Depends")
        self.assertIn("nlohmann-json3-dev", searched)
        for package in ("libclang-rt", "libcli11-dev", "libimgui-dev"):  # not for who links the libraries
            self.assertNotIn(package, searched)
        call("dpkg-deb", "-x", packages["tessera"], folder / "root")
        self.assertIn("tessera", call(folder / "root/usr/bin/tessera", "--version"))


if __name__ == "__main__":
    unittest.main()
