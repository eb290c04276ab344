"""Mesa's Vulkan driver for the CPU in the package freevoxels-lavapipe, for systems that have none."""

import ctypes
import importlib.util
import os
import pathlib
import platform

_CHOICES = ("VK_ADD_DRIVER_FILES", "VK_DRIVER_FILES", "VK_ICD_FILENAMES")  # by which a user names drivers


def _manifest_folders():
    """Where Vulkan loaders look for the drivers of the system and of the user."""
    bases = [os.environ.get("XDG_CONFIG_HOME") or os.path.expanduser("~/.config"),
             *(os.environ.get("XDG_CONFIG_DIRS") or "/etc/xdg").split(":"), "/etc",
             os.environ.get("XDG_DATA_HOME") or os.path.expanduser("~/.local/share"),
             *(os.environ.get("XDG_DATA_DIRS") or "/usr/local/share:/usr/share").split(":")]
    return [pathlib.Path(base) / "vulkan" / "icd.d" for base in bases]


def _system_has_one():
    names = ("lvp_icd.json", f"lvp_icd.{platform.machine()}.json")
    return any((folder / name).exists() for folder in _manifest_folders() for name in names)


def _system_has_a_loader():
    try:
        ctypes.CDLL("libvulkan.so.1")
    except OSError:
        return False
    return True


def offer():
    """Adds the packaged driver to those of the system, where it has no driver for the CPU and the user named none. A device is chosen when
    the first image is drawn, and a GPU comes before the CPU. Returns the packaged Vulkan loader where the system has none, else None."""
    package = importlib.util.find_spec("freevoxels_lavapipe")
    if package is None:
        return None
    folder = pathlib.Path(package.origin).parent
    if not any(os.environ.get(name) for name in _CHOICES) and not _system_has_one():
        os.environ["VK_ADD_DRIVER_FILES"] = str(folder / "lvp_icd.json")
    return None if _system_has_a_loader() else folder / "libvulkan.so.1"
