"""Two ways to the images of a case of cases.json: the command line, and the Python module. Each writes them as files, all of which are
returned: channels of an .exr, and the bytes of a .png. A case that is refused raises Refused with the sentence."""

import json
import os
import pathlib
import re
import subprocess

import exr_reader
import freevoxels
import numpy as np

FORMS = ("exr", "png")
NOT_OF_FORM = {"exr": ("background", "exposure", "tone_map", "png_bits"), "png": ("aov",)}  # which a save of this form alone refuses
PROGRAM = os.environ["FREEVOXELS_PROGRAM"]


class Refused(Exception):
    pass


def drawn(folder):
    """What was written into a folder, by the names of the files."""
    return {file.name: exr_reader.read(file) if file.suffix == ".exr" else file.read_bytes() for file in sorted(folder.iterdir())}


def run(words):
    # The module is run with the validation layers; the program has tests of its own for that, and starts in half the time without.
    environment = {name: value for name, value in os.environ.items() if name != "FREEVOXELS_VALIDATION"}
    done = subprocess.run([PROGRAM, *words], capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        raise Refused(done.stderr.strip().splitlines()[-1].removeprefix("freevoxels: "))


class Files:
    def __init__(self, files):
        self.files = files

    def path(self, name):
        return name if name.startswith("procedural:") else str(self.files / name)

    def options(self, case):
        """The case's options, with the names of files where these are."""
        return {name: self.path(value) if name in ("environment", "holdout") else value for name, value in case["options"].items()}


class CommandLine(Files):
    @staticmethod
    def text(name, value):
        """The text of an option's value."""
        if isinstance(value, dict):
            if name in ("transfer-function", "add", "flight"):
                return json.dumps(value)
            return ",".join(f"{key}={CommandLine.text(key, one)}" for key, one in value.items())
        if isinstance(value, list):
            return ("x" if name in ("size", "resolution") else ",").join(map(str, value))
        return str(value)

    def words(self, options):
        for name, value in options.items():
            if isinstance(value, bool):
                yield f"--{name}" if value else f"--no-{name}"
            elif isinstance(value, list) and any(isinstance(one, (dict, str)) for one in value):
                yield from (f"--{name}={self.text(name, one)}" for one in value)
            else:
                yield f"--{name}={self.text(name, value)}"

    def draw(self, case, folder):
        options = {**self.options(case), **case["output"]}
        names, forms = case.get("names", "a"), case.get("forms", FORMS)
        run([case.get("command", "render"), self.path(case["volume"]), *(str(folder / f"{names}.{form}") for form in forms), "--quiet",
             *(["--float"] if "exr" in forms and not options.get("sums") else []), *self.words(options)])
        return drawn(folder)

    @staticmethod
    def spelled(sentence):
        """A sentence of the table, in which {name} and {name=value} are options."""
        return re.sub(r"\{([a-z-]+)(=([^}]*))?\}", lambda found: f"--{found[1]}" + (f" {found[3]}" if found[2] else ""), sentence)


class Module(Files):
    @staticmethod
    def keywords(options):
        return {name.replace("-", "_"): value for name, value in options.items()}

    def save(self, case, output, file, image, depth):
        for form in case.get("forms", FORMS):
            of_form = {name: value for name, value in output.items() if name not in NOT_OF_FORM[form]}
            freevoxels.save(f"{file}.{form}", image, depth=depth, **of_form, **({"float": True} if form == "exr" else {}))

    def draw_one(self, case, folder, options, output):
        depth = "depth" in output.get("aov", "")
        image = freevoxels.render(self.path(case["volume"]), depth=depth, **options)
        self.save(case, output, folder / "a", *(image if depth else (image, None)))
        return {"a": image if depth else (image, None)}

    def draw_turn(self, case, folder, options, output):
        depth = "depth" in output.get("aov", "")
        of_file = {name: options.pop(name) for name in ("resolution", "grid") if name in options}
        volume = freevoxels.Volume.open(self.path(case["volume"]), **of_file)
        frames = options.pop("frames")
        images = {}
        for number, image in enumerate(freevoxels.Renderer(volume, **options).turntable(frames, depth=depth)):
            images[case["names"].replace("#", str(number))] = image if depth else (image, None)
            self.save(case, output, folder / case["names"].replace("#", str(number)), *(image if depth else (image, None)))
        return images

    def draw_sequence(self, case, folder, options, output):
        volume = self.path(case["volume"])
        files = [folder / f"{case['names']}.{form}" for form in case.get("forms", FORMS)]
        written = freevoxels.render_sequence(volume, files, **options, **output, float=True)
        assert sorted(written) == sorted(str(file) for file in folder.iterdir())
        sequence = freevoxels.Sequence(volume, **options)
        images = {}
        for place in reversed(range(len(sequence))):  # in another order
            image, depth = (sequence.render(place), None) if "slice" in options else sequence.render(place, depth=True)
            images[pathlib.Path(written[2 * place]).stem] = image, depth if "depth" in output.get("aov", "") else None
        return images

    def draw(self, case, folder):
        options, output = self.keywords(self.options(case)), self.keywords(case["output"])
        is_sequence = "#" in case["volume"] or "%" in case["volume"]
        drawn_so = self.draw_turn if case.get("command") == "turntable" else self.draw_sequence if is_sequence else self.draw_one
        try:
            images = drawn_so(case, folder, options, output)
        except freevoxels.Error as error:
            raise Refused(str(error)) from error
        files = drawn(folder)
        for name, (image, depth) in images.items():
            if f"{name}.exr" not in files or "crop" in output:
                continue
            stored = files[f"{name}.exr"]
            np.testing.assert_array_equal(np.stack([stored[channel] for channel in "RGBA"], axis=-1), image)
            if depth is not None:
                np.testing.assert_array_equal(stored["Z"], depth)
        return files

    @staticmethod
    def spelled(sentence):
        def keyword(found):
            name = found[1].replace("-", "_")
            return f"{name}='{found[3]}'" if found[2] else f"'{name}'"

        return re.sub(r"\{([a-z-]+)(=([^}]*))?\}", keyword, sentence)
