"""Which Vulkan driver and loader the package offers where freevoxels-lavapipe is installed, by a package of that name without a driver.

`import freevoxels` runs in processes of its own, as it changes the environment and opens the loader."""

import json
import os
import pathlib
import platform
import subprocess
import sys
import tempfile
import unittest

import freevoxels

PACKAGES = pathlib.Path(freevoxels.__file__).parents[1]
CHOICES = ("VK_ADD_DRIVER_FILES", "VK_DRIVER_FILES", "VK_ICD_FILENAMES")
PROGRAM = """
import json, os, sys
system_loader = sys.argv[1] == "loader"
import ctypes
real = ctypes.CDLL
def opened(name, *rest, **more):
    if name == "libvulkan.so.1" and not system_loader:
        raise OSError(name)
    return real(name if name != "libvulkan.so.1" else None, *rest, **more)
ctypes.CDLL = opened
from freevoxels import _cpu_driver
loader = _cpu_driver.offer()
print(json.dumps([loader and str(loader), {name: os.environ.get(name) for name in %r}]))
""" % (CHOICES,)


class CpuDriverTest(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.scratch = pathlib.Path(scratch.name)
        # The package without its compiled part, which has nothing to do with drivers.
        package = self.scratch / "freevoxels"
        package.mkdir()
        (package / "__init__.py").touch()
        (package / "_cpu_driver.py").write_text((PACKAGES / "freevoxels" / "_cpu_driver.py").read_text())

    def install_driver(self):
        (self.scratch / "freevoxels_lavapipe").mkdir()
        (self.scratch / "freevoxels_lavapipe" / "__init__.py").touch()

    def system_with(self, *manifests):
        folder = self.scratch / "system" / "vulkan" / "icd.d"
        folder.mkdir(parents=True)
        for manifest in manifests:
            (folder / manifest).write_text("{}")

    def offered(self, loader="loader", **variables):
        environment = {name: value for name, value in os.environ.items() if name not in CHOICES}
        for name in ("XDG_CONFIG_HOME", "XDG_DATA_HOME"):
            environment.pop(name, None)
        environment.update(PYTHONPATH=str(self.scratch), XDG_DATA_DIRS=str(self.scratch / "system"), XDG_CONFIG_DIRS=str(self.scratch),
                           HOME=str(self.scratch))
        environment.update(variables)
        ran = subprocess.run([sys.executable, "-c", PROGRAM, loader], env=environment, capture_output=True, text=True)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        return json.loads(ran.stdout)

    def expect(self, offered, loader, **variables):
        self.assertEqual(offered, [loader, {name: variables.get(name) for name in CHOICES}])

    def test_without_the_package_nothing_changes(self):
        self.system_with()
        self.expect(self.offered(), None)
        self.expect(self.offered(loader="none"), None)

    def test_the_driver_is_added_to_those_of_the_system(self):
        self.install_driver()
        self.system_with("nvidia_icd.json")
        manifest = str(self.scratch / "freevoxels_lavapipe" / "lvp_icd.json")
        self.expect(self.offered(), None, VK_ADD_DRIVER_FILES=manifest)
        self.expect(self.offered(loader="none"), str(self.scratch / "freevoxels_lavapipe" / "libvulkan.so.1"), VK_ADD_DRIVER_FILES=manifest)

    def test_a_driver_for_another_processor_is_none(self):
        self.install_driver()
        self.system_with("lvp_icd.i386.json")
        self.expect(self.offered(), None, VK_ADD_DRIVER_FILES=str(self.scratch / "freevoxels_lavapipe" / "lvp_icd.json"))

    def test_a_driver_for_the_cpu_of_the_system_or_the_user_comes_first(self):
        self.install_driver()
        self.system_with("nvidia_icd.json", f"lvp_icd.{platform.machine()}.json")
        self.expect(self.offered(), None)
        self.expect(self.offered(XDG_DATA_DIRS="/nowhere", XDG_DATA_HOME=str(self.scratch / "system")), None)

    def test_variables_of_the_user_stay(self):
        self.install_driver()
        self.system_with()
        for name in CHOICES:
            self.expect(self.offered(**{name: "/mine.json"}), None, **{name: "/mine.json"})
            self.expect(self.offered("none", **{name: "/mine.json"}), str(self.scratch / "freevoxels_lavapipe" / "libvulkan.so.1"),
                        **{name: "/mine.json"})


if __name__ == "__main__":
    unittest.main()
