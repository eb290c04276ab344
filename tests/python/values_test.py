"""Values of keywords and of arrays of all kinds: what they mean, or one sentence that names the keyword."""

import array
import collections
import decimal
import enum
import fractions
import functools
import logging
import os
import pathlib
import tempfile
import types
import unittest

import freevoxels
import numpy as np

logging.getLogger("freevoxels").setLevel(logging.ERROR)  # infinite values are meant
BOX = np.arange(6 * 7 * 5, dtype="float32").reshape(6, 7, 5) / 210
SMALL = dict(size=(8, 6))


class Listed:
    """Something that says how it is as a list."""

    def __init__(self, work):
        self.tolist = work


class KeywordTest(unittest.TestCase):
    @staticmethod
    @functools.cache
    def image_of(*options):
        """Drawn once, as many values mean the same."""
        return freevoxels.render(BOX, **{**SMALL, **dict(options)})

    def expect_image(self, expected, **options):
        image = freevoxels.render(BOX, **{**SMALL, **options})
        np.testing.assert_array_equal(image, self.image_of(*expected.items()), str(options))

    def refused(self, kind, sentence, **options):
        with self.assertRaisesRegex(kind, sentence) as caught:
            freevoxels.render(BOX, **{**SMALL, **options})
        self.assertIsInstance(caught.exception, freevoxels.Error)
        self.assertNotIn("\n", str(caught.exception))
        return caught.exception

    def test_what_contains_itself_is_refused(self):
        itself, inner, both = [], {}, {"fov": 30}
        itself.append(itself)
        inner["orbit"] = inner
        both["orbit"] = [both]
        sentence = "'{}' holds something that contains itself, or is nested more than 16 deep"
        for name, value in (("orbit", itself), ("orbit", (itself,)), ("orbit", [1, itself]), ("camera", inner),
                            ("camera", {"orbit": itself}), ("camera", both), ("light", [{"direction": itself}])):
            self.assertEqual(self.refused(freevoxels.InputError, sentence.format(name), **{name: value}).parameters, (name,))
        again = Listed(None)
        again.tolist = lambda: again
        self.refused(freevoxels.InputError, sentence.format("orbit"), orbit=again)
        image, volume = np.zeros((2, 2, 4)), freevoxels.Volume(BOX)
        for call in (lambda: freevoxels.save_scene("none.json", camera=inner),
                     lambda: freevoxels.save("none.png", image, background=itself),
                     lambda: freevoxels.Volume.open("procedural:cloud", clip_box=itself),
                     lambda: freevoxels.Renderer(volume, up=itself)):
            with self.assertRaisesRegex(freevoxels.InputError, "contains itself"):
                call()

    def test_depth_is_limited(self):
        value = 1
        for _ in range(100000):
            value = [value]
        self.refused(freevoxels.InputError, "'orbit' holds .* nested more than 16 deep", orbit=value)
        while isinstance(value[0], list) and isinstance(value, list):  # freed level by level
            value = value[0]
        deep = '{"opacity":' * 100000 + "1" + "}" * 100000
        self.refused(freevoxels.InputError, "nested more than 64 deep", transfer_function=deep)
        with self.assertRaisesRegex(freevoxels.InputError, "nested more than 64 deep"):
            freevoxels.save_scene("none.json", transfer_function=deep)

    def test_whole_numbers_beyond_64_bits_are_refused(self):
        for number in (2**63, 2**64, -(2**63) - 1, 10**30, 10**5000, np.uint64(2**64 - 1)):
            error = self.refused(freevoxels.InputError, "'density_scale' takes no whole number of more than 64 bits", density_scale=number)
            self.assertEqual(error.parameters, ("density_scale",))
        self.refused(freevoxels.InputError, "'camera.fov' takes no whole number of more than 64 bits", camera={"fov": 2**70})
        self.refused(freevoxels.UsageError, "'scattering' takes", scattering=2**63 - 1)
        self.expect_image({"density_scale": 1e18}, density_scale=10**18)

    def test_numbers_of_all_kinds_are_numbers(self):
        for three in (3, 3.0, np.int8(3), np.uint64(3), np.float16(3), np.float64(3), np.longdouble(3), np.array(3),
                      np.array(3.0), np.array([3]), fractions.Fraction(6, 2), enum.IntEnum("Number", {"THREE": 3}).THREE, "3"):
            self.expect_image({"density_scale": 3}, density_scale=three)
        for yes in (True, np.True_, np.array(True)):
            self.expect_image({"unlit": True}, unlit=yes)

    def test_numbers_are_finite(self):
        for number, name in ((float("nan"), "nan"), (np.float32("inf"), "inf"), (-np.inf, "-inf"), (np.array(np.nan), "nan")):
            self.refused(freevoxels.InputError, f"'density_scale' takes finite numbers, not {name}", density_scale=number)
        self.refused(freevoxels.InputError, "'light.direction' takes finite numbers, not nan", light={"direction": (1, 1, np.nan)})
        self.refused(freevoxels.InputError, "'orbit' takes finite numbers, not nan", orbit=np.array([1, np.nan]))

    def test_lists_of_all_kinds_are_lists(self):
        class Pair(collections.UserList):
            pass

        for pair in ((1, 2), [1, 2], range(1, 3), np.array([1, 2]), np.array([1, 2], object), collections.deque([1, 2]), Pair([1, 2]),
                     array.array("f", [1, 2]), memoryview(array.array("d", [1, 2])), collections.namedtuple("P", "a b")(1, 2), "1,2"):
            self.expect_image({"orbit": (1, 2)}, orbit=pair)
        for mapping in (types.MappingProxyType({"orbit": (1, 2)}), collections.OrderedDict(orbit=(1, 2)),
                        collections.UserDict(orbit=(1, 2)), collections.ChainMap({"orbit": (1, 2)}), {"orbit": (1, 2), "fov": None}):
            self.expect_image({"orbit": (1, 2)}, camera=mapping)
        self.expect_image({}, orbit=None, camera=None, lights=None)

    def test_other_values_are_named(self):
        for value, name in ((3 + 1j, "complex"), (np.complex64(3), "complex"), (b"3", "bytes"), (bytearray(b"3"), "bytearray"),
                            ({1, 2}, "set"), ((x for x in (1, 2)), "generator"), (decimal.Decimal(3), "Decimal"), (object(), "object"),
                            (len, "builtin_function_or_method"),
                            (np.datetime64("2020-01-01"), "date"), ([1, None], "None"), (np.ma.masked_equal([1, 2], 2), "None"),
                            (np.array([b"1", b"2"]), "bytes"), (slice(1), "slice"), (Ellipsis, "ellipsis")):
            self.refused(freevoxels.InputError, f"'orbit' takes numbers, text, lists and dictionaries, not {name}", orbit=value)
        self.refused(freevoxels.InputError, "'camera' takes keys that are text, not int", camera={1: 2})
        self.refused(freevoxels.InputError, "'camera.orbit' takes numbers, .* not set", camera={"orbit": {1, 2}})
        self.refused(freevoxels.InputError, "'density_scale' takes S, not true", density_scale=True)
        self.refused(freevoxels.InputError, "'unlit' takes true or false, not 1", unlit=1)

    def test_long_values_are_quoted_in_part(self):
        wide, text = np.arange(40000.0).reshape(200, 200), "x" * 5000
        for name in ("size", "orbit", "fov", "up", "look_at", "density_scale", "albedo", "ambient", "shading", "draw", "directions", "scattering",
                     "clip_box", "clip_plane", "extinction_tint", "emission", "unlit", "lod", "code", "transfer_function", "environment", "light"):
            for value in (range(100000), wide, wide.ravel(), {"direction": wide}, {"opacity": wide}, {text: 1}, {"a": text}, [text] * 3, [[1, 2], text]):
                error = self.refused(freevoxels.Error, "", **{name: value})
                self.assertLess(len(str(error)), 500, (name, type(value)))
        for name in ("size", "orbit", "albedo", "shading", "directions", "clip_box", "light", "lod"):
            self.assertLess(len(str(self.refused(freevoxels.Error, f"not 'x.*\\.\\.\\.'", **{name: text}))), 300)
        for name in ("direction", "position", "color", "intensity", text):
            error = self.refused(freevoxels.Error, "light", light={"direction": (1, 1, 1), name: wide})
            self.assertLess(len(str(error)), 500, name)

    def test_objects_are_no_images(self):
        for value in ({"opacity": [[0, 0]]}, {}, [1, 2]):
            self.refused(freevoxels.InputError, "'environment' takes FILE.exr, not", environment=value)

    def test_keywords_that_do_not_fit_are_named(self):
        for options, sentence, parameters in (
            ({"camera": 5}, "'camera' is a group of options", ("camera",)),
            ({"light": {"dir": (1, 1, 1)}}, "a single 'light' has a 'direction' or a 'position'", ("light.dir", "light", "direction", "position")),
            ({"lights": [{"direction": (1, 1, 1)}], "light": {"direction": (1, 0, 0)}}, "'light' is given twice", ("light",)),
            ({"emission": True}, "the array has not: give 'temperature', an array of the same shape", ("emission", "temperature")),
            ({"spacing": 2, "transform": np.eye(4)}, "'spacing' and 'transform' exclude each other", ("spacing", "transform")),
            ({"origin": (1, 2, 3), "transform": np.eye(4)}, "'origin' and 'transform' exclude each other", ("origin", "transform")),
            ({"spacing": (1, 2)}, "'spacing' takes one number, or three along .x, y, z., not 2 numbers", ("spacing",)),
            ({"spacing": "wide"}, "'spacing' takes one number, or three", ("spacing",)),
            ({"origin": 5}, "'origin' takes three numbers .x, y, z., not 1 number", ("origin",)),
            ({"transform": np.eye(3)}, "'transform' takes a matrix of 4 x 4 numbers, not 9 numbers", ("transform",)),
            ({"depth": "yes"}, "'depth' takes True or False, not str", ("depth",)),
            ({"volume": BOX}, "render.. takes one volume, and options by name", ()),
        ):
            self.assertEqual(self.refused(freevoxels.Error, sentence, **options).parameters, parameters)

    def test_options_of_arrays_are_refused_for_files_and_volumes(self):
        volume = freevoxels.Volume(BOX)
        for call, what in ((lambda **o: freevoxels.render("procedural:cube", **o), "a file"), (lambda **o: freevoxels.Volume.open("procedural:cube", **o), "a file"),
                           (lambda **o: freevoxels.Renderer(volume, **o), "a volume"), (lambda **o: freevoxels.render(volume, **o), "a volume"),
                           (lambda **o: freevoxels.Renderer(volume).render(**o), "a volume")):
            for name, value in (("spacing", 2), ("origin", (1, 2, 3)), ("transform", np.eye(4)), ("no_data", 0), ("temperature", BOX)):
                if name in ("no_data", "spacing") and what == "a file":
                    continue  # files have them, too
                with self.assertRaisesRegex(freevoxels.UsageError, f"'{name}' is an option of arrays, and {what} has its own") as caught:
                    call(**{name: value})
                self.assertEqual(caught.exception.parameters, (name,))

    def test_arguments_of_wrong_types_are_named_without_their_values(self):
        volume = freevoxels.Volume(BOX)
        renderer = freevoxels.Renderer(volume, **SMALL)
        for call, sentence in ((lambda: freevoxels.Volume(BOX, BOX), "Volume.. takes one array"), (lambda: freevoxels.Volume(BOX, size=(3, 3)), "has no option 'size'"),
                               (lambda: freevoxels.Volume(BOX, spacng=2), "has no option 'spacng'; did you mean 'spacing'"), (lambda: freevoxels.Volume(), "the array is of the type None"),
                               (lambda: freevoxels.Renderer(BOX), "takes a Volume, not ndarray"), (lambda: freevoxels.Renderer(), "takes a Volume, not None"),
                               (lambda: renderer.render((1, 2)), "render.. takes nothing without a name"), (lambda: freevoxels.render(BOX, BOX), "render.. takes one volume"),
                               (lambda: freevoxels.Volume.open(5), "'file' takes the name of a file, not int"), (lambda: freevoxels.save(BOX, BOX), "'file' takes the name of a file, not ndarray"),
                               (lambda: freevoxels.load_scene(None), "'file' takes the name of a file, not None")):
            with self.assertRaisesRegex(freevoxels.Error, sentence) as caught:
                call()
            self.assertLess(len(str(caught.exception)), 250)

    def test_arrays_are_clipped_as_files_are(self):
        whole = np.arange(12 * 10 * 8, dtype="f4").reshape(12, 10, 8)
        box = (1, 2, 3, 5, 7, 9)
        expected = freevoxels.Volume(whole, clip_box=box)
        self.assertEqual(expected.shape, (7, 6, 5))
        self.assertEqual(expected.active_voxels, 7 * 6 * 5)
        self.assertEqual(expected.range, (0, 959))  # of the whole, so that clipping changes no colours
        image = freevoxels.render(expected, **SMALL)
        for options in ({"clip_box": box}, {"input": {"clip-box": box}}, {"input": {"volume": "none.vdb", "clip_box": np.array(box)}}):
            np.testing.assert_array_equal(freevoxels.render(whole, **options, **SMALL), image)
        plane = freevoxels.Volume(whole, clip_plane=(4, 5, 6, 1, 0, 0))
        self.assertLess(plane.active_voxels, whole.size)
        with self.assertRaisesRegex(freevoxels.UsageError, "'clip_box' takes"):
            freevoxels.Volume(whole, clip_box=(1, 2, 3))

    def test_binary_files_are_no_scenes_or_functions(self):
        with tempfile.TemporaryDirectory() as folder:
            for content in (b"\x89PNG\r\n\xff\xfe{", b"\xff", b"{\"camera\": \"\xff\"}", bytes(range(256))):
                file = pathlib.Path(folder) / "file"
                file.write_bytes(content)
                for call in (lambda: freevoxels.load_scene(file), lambda: freevoxels.render(BOX, scene=file), lambda: freevoxels.render(BOX, transfer_function=file)):
                    with self.assertRaises(freevoxels.InputError) as caught:
                        call()
                    self.assertIn(str(file), str(caught.exception))

    def test_scenes_that_name_files_that_are_no_unicode_are_not_written(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "s.json"
            with self.assertRaisesRegex(freevoxels.InputError, r"the volume '.*\\xff.vdb' is not"):
                freevoxels.save_scene(file, volume=os.fsdecode(b"\xff.vdb"))
            self.assertFalse(file.exists())

    def test_exceptions_of_values_reach_the_caller(self):
        def wrong():
            raise KeyError("mine")

        with self.assertRaisesRegex(KeyError, "mine"):
            freevoxels.render(BOX, orbit=Listed(wrong))

    def test_mappings_may_change_while_they_are_read(self):
        camera = {"orbit": None, "fov": 30, "up": (0, 1, 0), "look_at": (1, 2, 3)}
        camera["orbit"] = Listed(lambda: camera.clear() or [1, 2])
        freevoxels.render(BOX, camera=camera, **SMALL)
        lights = [Listed(lambda: lights.clear() or {"direction": (1, 1, 1)}), {"direction": (0, 1, 0)}]
        freevoxels.render(BOX, lights=lights, **SMALL)

    def test_texts_that_are_not_unicode_are_file_names_or_refused(self):
        of_bytes = type("OfBytes", (), {"__fspath__": lambda self: b"/none/\xff.exr"})
        for name in (os.fsdecode(b"/none/\xff.exr"), pathlib.Path(os.fsdecode(b"/none/\xff.exr")), of_bytes()):
            error = self.refused(freevoxels.InputError, "there is no such file", environment=name)
            self.assertIn(r"/none/\xff.exr", str(error))
        self.refused(freevoxels.InputError, "'environment' is text with characters that Unicode does not have", environment="\ud800")
        self.refused(freevoxels.InputError, "'camera' is text with characters", camera={"\ud800": 1})
        self.refused(freevoxels.UsageError, "no option whose name has characters", **{"\ud800": 1})
        self.refused(freevoxels.Error, "transfer function", transfer_function={"opacity": os.fsdecode(b"\xff")})
        self.refused(freevoxels.Error, "device", device={"a": os.fsdecode(b"\xff")})
        with self.assertRaisesRegex(freevoxels.InputError, r"\\xff"):
            freevoxels.Volume.open(os.fsdecode(b"/none/\xff.vdb"))

    def test_messages_have_no_control_characters(self):
        for text in ("\x1b]0;title\x07", "\x9b31m", "\u202e", "a\nb"):
            for refuse in (lambda: freevoxels.Volume.open(f"/none/{text}.vdb"), lambda: freevoxels.render(BOX, environment=f"/none/{text}.exr"),
                           lambda: freevoxels.render(BOX, orbit=text), lambda: freevoxels.render(BOX, **{text: 1})):
                with self.assertRaises(freevoxels.Error) as raised:
                    refuse()
                self.assertTrue(str(raised.exception).isprintable(), repr(str(raised.exception)))


class NoDataTest(unittest.TestCase):
    def expect_removed(self, values, no_data, dtype, removed):
        """Of `values`, at the places of a box that fills no brick, these hold no data, and what a float cannot hold."""
        box = np.resize(np.array(values, dtype), (3, 9, 5))
        with np.errstate(over="ignore"):
            kept = np.isfinite(box.astype("f4")) & ~np.isin(box, np.array(removed, dtype))
        self.assertEqual(freevoxels.Volume(box, no_data=no_data).active_voxels, np.count_nonzero(kept), f"{no_data!r} of {dtype}")

    def test_whole_numbers_are_compared_exactly(self):
        for kind in ("i4", "i8", "u4", "u8"):
            values = [16777215, 16777216, 16777217]
            for value in values:
                for no_data in (value, float(value), np.int64(value), np.float64(value), np.array(value)):
                    self.expect_removed(values, no_data, kind, [value])
        for kind, value in (("i8", 2**62 + 1), ("u8", 2**64 - 2), ("i8", -(2**63))):
            self.expect_removed([value, value + 1, 5], value, kind, [value])
            self.expect_removed([value, value + 1, 5], value + 1, kind, [value + 1])
        for kind, value in (("u1", 255), ("i1", -128), ("u2", 65535), ("i2", -32768), ("u1", 0), ("?", True), ("?", False)):
            self.expect_removed([value, 0, 1], value, kind, [value])
        self.expect_removed([0, 1, 2], True, "u1", [1])

    def test_floats_are_compared_after_rounding_to_the_type_of_the_array(self):
        for kind in ("f2", "f4", "f8"):
            for no_data in (-9999, -9999.0, np.float16(-9999), np.float32(-9999), np.int32(-9999), 0.1, -9988, 9996, 5e-8, 1e-320, 65519.9,
                            -1, 0):
                with np.errstate(all="ignore"):
                    stored = np.array(no_data).astype(kind)[()]
                    below, above = np.nextafter(stored, np.array(-7e4, kind)[()]), np.nextafter(stored, np.array(7e4, kind)[()])
                self.expect_removed([stored, below, above, 1], no_data, kind, [stored])
        self.expect_removed([1.0, 1.0 + 2**-52, 3.0], 1.0, "f8", [1.0])
        self.expect_removed([0.1, 0.5], np.float32(0.1), "f8", [])  # the float of 32 bits is another number

    def test_infinities_and_numbers_beyond_the_type_are_what_astype_makes_of_them(self):
        for no_data, kind in ((np.inf, "f4"), (-np.inf, "f8"), (1e300, "f4"), (-99999, "f2"), (65520, "f2"), (1e39, "f4")):
            with np.errstate(all="ignore"):
                stored = np.array(float(no_data)).astype(kind)[()]
            self.assertTrue(np.isinf(stored))
            self.expect_removed([stored, 1, 2], no_data, kind, [stored])
        self.expect_removed([1e300, 2e300, 1, 2], 1, "f8", [1])

    def test_nan_is_no_data_in_any_case(self):
        for no_data in (np.nan, np.float32("nan"), None):
            for kind in ("f2", "f4", "f8"):
                box = np.ones((3, 9, 5), kind)
                box[1] = np.nan
                self.assertEqual(freevoxels.Volume(box, no_data=no_data).active_voxels, 90)
            self.expect_removed([1, 2, 3], no_data, "u1", [])
            self.expect_removed([1, 2, 3], no_data, "i8", [])

    def test_all_voxels_of_bricks_are_compared(self):
        # Boxes that end with a group of 4 voxels, a brick, a chunk, and elsewhere, strided and reversed.
        for shape in ((4, 4, 4), (8, 16, 8), (32, 9, 33), (2, 7, 5)):
            whole = np.ones(tuple(2 * n for n in shape), "i4")
            box = whole[::2, ::-2, 1::2]
            box[..., 0] = box[0] = -1
            self.assertEqual(freevoxels.Volume(box, no_data=-1).active_voxels, np.count_nonzero(box == 1))

    def test_what_no_voxel_can_be_is_refused(self):
        for kind, no_data, text in (("u1", -9999, "-9999"), ("u1", 256, "256"), ("i2", 1.5, "1.5"), ("i8", 2**63, "9.22"), ("u8", -1, "-1"),
                                    ("?", 2, "2"), ("i4", np.inf, "inf")):
            sentence = f"'no_data' is {text}.*, which no {np.dtype(kind).name} can be: leave it out"
            with self.assertRaisesRegex(freevoxels.InputError, sentence) as caught:
                freevoxels.Volume(np.ones((3, 4, 5), kind), no_data=no_data)
            self.assertEqual(caught.exception.parameters, ("no_data",))
        for value, name in (("0", "str"), (b"0", "bytes"), ([0], "list"), (1j, "complex"), (np.array([0, 1]), "ndarray"),
                            (object(), "object")):
            with self.assertRaisesRegex(freevoxels.InputError, f"'no_data' takes a number, not {name}"):
                freevoxels.Volume(np.ones((3, 4, 5)), no_data=value)
        with self.assertRaisesRegex(freevoxels.InputError, "'no_data' is a whole number that is too large"):
            freevoxels.Volume(np.ones((3, 4, 5)), no_data=10**400)

    def test_temperatures_are_compared_in_their_own_type(self):
        box, heat = np.ones((3, 9, 5), "f4"), np.full((3, 9, 5), 1000, "u2")
        box[0] = -9999
        self.assertEqual(freevoxels.Volume(box, no_data=-9999, temperature=heat).active_voxels, 90)
        heat[1] = 65535
        freevoxels.Volume(np.ones((3, 9, 5), "u1"), no_data=65535, temperature=heat)
        with self.assertRaisesRegex(freevoxels.InputError, "no uint8 can be"):
            freevoxels.Volume(np.ones((3, 9, 5), "u1"), no_data=-1, temperature=heat)


if __name__ == "__main__":
    unittest.main()
