"""Values of keywords of all kinds: what they mean, or one sentence that names the keyword."""

import array
import collections
import decimal
import enum
import fractions
import os
import pathlib
import types
import unittest

import freevoxels
import numpy as np

BOX = np.arange(6 * 7 * 5, dtype="float32").reshape(6, 7, 5) / 210
SMALL = dict(size=(8, 6))


class Listed:
    """Something that says how it is as a list."""

    def __init__(self, work):
        self.tolist = work


class KeywordTest(unittest.TestCase):
    def expect_image(self, expected, **options):
        np.testing.assert_array_equal(freevoxels.render(BOX, **{**SMALL, **options}), freevoxels.render(BOX, **{**SMALL, **expected}), str(options))

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
        for name, value in (("orbit", itself), ("orbit", (itself,)), ("orbit", [1, itself]), ("camera", inner), ("camera", {"orbit": itself}),
                            ("camera", both), ("light", [{"direction": itself}])):
            self.assertEqual(self.refused(freevoxels.InputError, sentence.format(name), **{name: value}).parameters, (name,))
        again = Listed(None)
        again.tolist = lambda: again
        self.refused(freevoxels.InputError, sentence.format("orbit"), orbit=again)
        for save in (lambda: freevoxels.save_scene("none.json", camera=inner), lambda: freevoxels.save("none.png", np.zeros((2, 2, 4)), background=itself),
                     lambda: freevoxels.Volume.open("procedural:cloud", clip_box=itself), lambda: freevoxels.Renderer(freevoxels.Volume(BOX), up=itself)):
            with self.assertRaisesRegex(freevoxels.InputError, "contains itself"):
                save()

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
        for three in (3, 3.0, np.int8(3), np.uint64(3), np.float16(3), np.float64(3), np.longdouble(3), np.array(3), np.array(3.0), np.array([3]),
                      fractions.Fraction(6, 2), enum.IntEnum("Number", {"THREE": 3}).THREE, "3"):
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
        for mapping in (types.MappingProxyType({"orbit": (1, 2)}), collections.OrderedDict(orbit=(1, 2)), collections.UserDict(orbit=(1, 2)),
                        collections.ChainMap({"orbit": (1, 2)}), {"orbit": (1, 2), "fov": None}):
            self.expect_image({"orbit": (1, 2)}, camera=mapping)
        self.expect_image({}, orbit=None, camera=None, lights=None)

    def test_other_values_are_named(self):
        for value, name in ((3 + 1j, "complex"), (np.complex64(3), "complex"), (b"3", "bytes"), (bytearray(b"3"), "bytearray"), ({1, 2}, "set"),
                            ((x for x in (1, 2)), "generator"), (decimal.Decimal(3), "Decimal"), (object(), "object"), (len, "builtin_function_or_method"),
                            (np.datetime64("2020-01-01"), "date"), ([1, None], "None"), (np.ma.masked_equal([1, 2], 2), "None"),
                            (np.array([b"1", b"2"]), "bytes"), (slice(1), "slice"), (Ellipsis, "ellipsis")):
            self.refused(freevoxels.InputError, f"'orbit' takes numbers, text, lists and dictionaries, not {name}", orbit=value)
        self.refused(freevoxels.InputError, "'camera' takes keys that are text, not int", camera={1: 2})
        self.refused(freevoxels.InputError, "'camera.orbit' takes numbers, .* not set", camera={"orbit": {1, 2}})
        self.refused(freevoxels.InputError, "'density_scale' takes S, not true", density_scale=True)
        self.refused(freevoxels.InputError, "'unlit' takes true or false, not 1", unlit=1)

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
        for name in (os.fsdecode(b"/none/\xff.exr"), pathlib.Path(os.fsdecode(b"/none/\xff.exr")), type("P", (), {"__fspath__": lambda self: b"/none/\xff.exr"})()):
            error = self.refused(freevoxels.InputError, "there is no such file", environment=name)
            self.assertIn(r"/none/\xff.exr", str(error))
        self.refused(freevoxels.InputError, "'environment' is text with characters that Unicode does not have", environment="\ud800")
        self.refused(freevoxels.InputError, "'camera' is text with characters", camera={"\ud800": 1})
        self.refused(freevoxels.UsageError, "no option whose name has characters", **{"\ud800": 1})
        self.refused(freevoxels.Error, "transfer function", transfer_function={"opacity": os.fsdecode(b"\xff")})
        self.refused(freevoxels.Error, "device", device={"a": os.fsdecode(b"\xff")})
        with self.assertRaisesRegex(freevoxels.InputError, r"\\xff"):
            freevoxels.Volume.open(os.fsdecode(b"/none/\xff.vdb"))


if __name__ == "__main__":
    unittest.main()
