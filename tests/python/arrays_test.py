"""Arrays of every type, order and memory, in and out, under whatever NumPy there is."""

import functools
import pathlib
import tempfile
import unittest

import freevoxels
import numpy as np

KINDS = ("?", "u1", "u2", "u4", "u8", "i1", "i2", "i4", "i8", "f2", "f4", "f8")
SHAPES = ((1, 1, 1), (3, 5, 2), (9, 8, 17))


def values(shape, kind="f4"):
    """Different whole numbers from 0 to 100, which every type but bool has."""
    return (np.arange(np.prod(shape)).reshape(shape) * 7 % 101).astype(kind)


def image_of(array, **options):
    """In the colours of the voxels: light takes twice as long as the rest, and shows no more of them."""
    return freevoxels.render(array, size=(40, 32), density_scale=0.01, unlit=True, **options)


@functools.cache
def image_of_floats(shape, values):
    """Drawn once, as many arrays have the same values."""
    return image_of(np.frombuffer(values, "f4").reshape(shape))


class ReadingTest(unittest.TestCase):
    def expect_same(self, array, expected, what):
        volume, other = freevoxels.Volume(array), freevoxels.Volume(expected)
        self.assertEqual((volume.shape, volume.range, volume.active_voxels), (other.shape, other.range, other.active_voxels), what)
        floats = np.ascontiguousarray(expected, "f4")
        np.testing.assert_array_equal(image_of(volume), image_of_floats(floats.shape, floats.tobytes()), str(what))

    def test_all_types_in_both_byte_orders(self):
        for shape in SHAPES:
            for kind in KINDS:
                whole = values(shape, kind)
                for order in "<>=":
                    array = whole.astype(np.dtype(kind).newbyteorder(order))
                    self.expect_same(array, whole.astype("f4"), (shape, kind, order))
                    self.assertEqual(freevoxels.Volume(array).range, (whole.min(), whole.max()), (shape, kind, order))

    def test_types_of_c_have_their_sizes(self):
        for kind in "bBhHiIlLqQefd?":
            self.expect_same(values((3, 5, 7), kind), values((3, 5, 7), kind).astype("f4"), kind)

    def test_extreme_values_keep_their_sign_and_size(self):
        for kind in KINDS[1:9]:
            low, high = np.iinfo(kind).min, np.iinfo(kind).max
            for order in "<>":
                array = np.array([low, high], np.dtype(kind).newbyteorder(order)).reshape(1, 1, 2)
                self.assertEqual(freevoxels.Volume(array).range, (np.float32(low), np.float32(high)), (kind, order))

    def test_all_layouts(self):
        for kind in ("u1", "i2", "f4", ">f8"):
            for shape in SHAPES:
                whole = values(shape, kind)
                doubled = np.zeros([2 * n for n in shape], kind)
                doubled[::2, 1::2, ::2] = whole
                unaligned = np.zeros(whole.nbytes + 1, "u1")[1:].view(kind).reshape(shape)
                unaligned[...] = whole
                locked = whole.copy()
                locked.setflags(write=False)
                fields = np.zeros(shape, [("skip", "u1"), ("value", kind)])
                fields["value"] = whole
                for name, array in (("Fortran", np.asfortranarray(whole)), ("reversed", whole[::-1, ::-1, ::-1].copy()[::-1, ::-1, ::-1]),
                                    ("slices", doubled[::2, 1::2, ::2]), ("unaligned", unaligned), ("read-only", locked),
                                    ("field", fields["value"]), ("transposed", whole.transpose(2, 0, 1).copy().transpose(1, 2, 0)),
                                    ("broadcast", np.broadcast_to(whole, (1, *shape))[0])):
                    self.assertTrue((array == whole).all())
                    self.expect_same(array, whole, (kind, shape, name))
        row = np.broadcast_to(np.arange(7, dtype="f4"), (4, 5, 7))  # strides of 0
        self.expect_same(row, row.copy(), "strides of 0")

    def test_mapped_files(self):
        with tempfile.TemporaryDirectory() as folder:
            for kind in ("u1", ">i2", "f4"):
                file = pathlib.Path(folder) / "array.npy"
                np.save(file, values((9, 8, 17), kind))
                self.expect_same(np.load(file, mmap_mode="r"), values((9, 8, 17), kind), kind)
                self.expect_same(np.load(file, mmap_mode="r")[1:, ::2, ::-1], values((9, 8, 17), kind)[1:, ::2, ::-1].copy(), kind)

    def test_what_numpy_converts(self):
        whole = values((3, 4, 5))

        class Wrapped:
            def __array__(self, dtype=None, copy=None):
                return whole

        for other in (whole.tolist(), Wrapped(), memoryview(whole), tuple(whole)):
            self.expect_same(other, whole, type(other))
        self.expect_same(whole.astype("i8").tolist(), whole, "whole numbers")

    def refused(self, array, sentence, kind=freevoxels.InputError):
        for call in (freevoxels.Volume, freevoxels.render, lambda a: freevoxels.Volume(values((3, 4, 5)), temperature=a)):
            with self.assertRaisesRegex(kind, sentence) as caught:
                call(array)
            self.assertNotIn("\n", str(caught.exception))
            self.assertLess(len(str(caught.exception)), 300)

    def test_types_that_are_not_known_are_refused_by_name(self):
        box = values((3, 4, 5))
        for kind, name in (("c8", "complex64"), ("c16", "complex128"), ("M8[s]", "datetime64"), ("m8[s]", "timedelta64"), ("S3", "bytes24"),
                           ("U3", "str96"), ("V4", "void32"), ([("a", "f4"), ("b", "u1")], "void40")):
            self.refused(np.zeros((3, 4, 5), kind), f"arrays of {name}.* cannot be used: convert it with array.astype")
        if np.dtype("g").itemsize > 8:
            self.refused(box.astype("g"), "arrays of (long|float)")
        self.refused(box.astype(object), "holds no numbers")
        if hasattr(np, "dtypes") and hasattr(np.dtypes, "StringDType"):
            self.refused(np.zeros((3, 4, 5), np.dtypes.StringDType()), "StringDType.* cannot be used")

    def test_masked_voxels_hold_no_data(self):
        for kind, shape in (("f4", (3, 5, 7)), (">i2", (9, 8, 17)), ("u1", (1, 1, 5)), ("f8", (33, 20, 9))):
            box = values(shape, kind)
            for masked in (np.ma.masked_equal(box, 3), np.ma.masked_greater(box, 40)[:, ::-1, :], np.ma.array(box, mask=box % 5 == 2, fill_value=9),
                           np.ma.masked_greater(box, 40).transpose(2, 1, 0)):
                want = masked.astype("f4").filled(np.nan)
                self.assertEqual(freevoxels.Volume(masked).active_voxels, masked.count(), kind)
                np.testing.assert_array_equal(freevoxels.render(masked, size=(24, 24)), freevoxels.render(want, size=(24, 24)))
            self.assertEqual(freevoxels.Volume(np.ma.array(box)).active_voxels, box.size, "nothing is masked")
        heat = np.ma.masked_less(values((3, 5, 7)), 50)
        np.testing.assert_array_equal(freevoxels.render(values((3, 5, 7)), temperature=heat, emission=1.0, size=(24, 24)),
                                      freevoxels.render(values((3, 5, 7)), temperature=heat.filled(np.nan), emission=1.0, size=(24, 24)))
        with self.assertRaisesRegex(freevoxels.InputError, "holds no data"):
            freevoxels.Volume(np.ma.array(values((3, 4, 5)), mask=True))
        image = freevoxels.render(values((3, 5, 7)), size=(24, 24))
        with self.assertRaisesRegex(freevoxels.InputError, "has a mask, which images have not"):
            freevoxels.save("masked.png", np.ma.masked_less(image, 0.5))

    def test_shapes_that_are_no_volume_are_refused(self):
        for shape, sentence in (((), "0 dimensions"), ((4,), "1 dimension:"), ((4, 4), "2 dimensions"), ((2, 3, 4, 1), "4 dimensions"),
                                ((0, 4, 4), "shape 0 x 4 x 4"), ((4, 4, 0), "shape 4 x 4 x 0")):
            with self.assertRaisesRegex(freevoxels.InputError, sentence):
                freevoxels.Volume(np.zeros(shape))
        for other, sentence in ((5, "0 dimensions"), (None, "of the type None"), (object(), "of the type object"), ({}, "of the type dict"),
                                ("smoke.vdb", "name of a file"), (pathlib.Path("a"), "name of a file"), ([[1], [1, 2]], "list")):
            with self.assertRaisesRegex(freevoxels.InputError, sentence):
                freevoxels.Volume(other)

    def test_no_data_in_both_byte_orders(self):
        for kind in KINDS[1:]:
            for order in "<>":
                box = values((3, 5, 7), np.dtype(kind).newbyteorder(order))
                self.assertEqual(freevoxels.Volume(box, no_data=7).active_voxels, np.count_nonzero(box != 7), (kind, order))

    def test_arguments_of_a_place_are_any_numbers(self):
        box = values((3, 5, 7))
        expected = image_of(box, spacing=(1, 2, 3), origin=(4, 5, 6))
        for spacing in ([1, 2, 3], np.array([1, 2, 3]), np.array([1.0, 2.0, 3.0], ">f4")):
            np.testing.assert_array_equal(image_of(box, spacing=spacing, origin=np.array([4, 5, 6], "i2")), expected)
        matrix = np.diag([1.0, 2.0, 3.0, 1.0])
        matrix[:3, 3] = (4, 5, 6)
        for transform in (matrix, matrix.astype(">f4"), matrix.tolist(), np.asfortranarray(matrix)):
            np.testing.assert_array_equal(image_of(box, transform=transform), expected)
        np.testing.assert_array_equal(image_of(box, spacing=2), image_of(box, spacing=(2, 2, 2)))

    def test_temperatures_of_all_types(self):
        box, heat = values((4, 5, 6)), 1000 + 10 * values((4, 5, 6))
        expected = image_of(box, temperature=heat, emission=5)
        for kind in ("u2", ">i4", "f8", ">f4"):
            np.testing.assert_array_equal(image_of(box, temperature=np.asfortranarray(heat.astype(kind)), emission=5), expected, kind)


class ImageTest(unittest.TestCase):
    def test_images_are_arrays_of_their_own(self):
        for width, height in ((1, 1), (7, 5), (64, 33)):
            image, depth = freevoxels.render(values((9, 8, 17)), size=(width, height), depth=True)
            for array, shape in ((image, (height, width, 4)), (depth, (height, width))):
                self.assertEqual((array.shape, array.dtype, array.strides[-1]), (shape, np.dtype("f4"), 4))
                self.assertTrue(array.flags.c_contiguous and array.flags.writeable)
            kept = image.copy()
            again = freevoxels.render(values((9, 8, 17)), size=(width, height))
            again[...] = 5
            np.testing.assert_array_equal(image, kept)
            self.assertTrue(np.isfinite(kept).all())
        self.assertGreater(kept[..., 3].max(), 0)

    def test_saved_images_are_those_that_were_given(self):
        with tempfile.TemporaryDirectory() as folder:
            image = freevoxels.render(values((9, 8, 17)), size=(33, 20))
            files = []
            for name, array in (("plain", image), ("f8", image.astype("f8")), ("f2", image.astype("f2").astype("f4")), ("Fortran", np.asfortranarray(image)),
                                ("big", image.astype(">f4")), ("reversed", image[::-1].copy()[::-1]), ("list", image.tolist())):
                files.append(pathlib.Path(folder) / f"{name}.png")
                freevoxels.save(files[-1], array)
            for file in files[1:2] + files[3:]:
                self.assertEqual(file.read_bytes(), files[0].read_bytes(), file.name)
            self.assertGreater(len(files[0].read_bytes()), 300)
            exr = [pathlib.Path(folder) / f"{kind}.exr" for kind in ("f4", "f8")]
            for file, kind in zip(exr, ("f4", ">f8")):
                freevoxels.save(file, image, depth=np.ones((20, 33), kind), float=True)
            self.assertEqual(exr[0].read_bytes(), exr[1].read_bytes())

    def test_what_cannot_be_saved_is_refused(self):
        for image, sentence in ((np.zeros((4, 4, 4), "u1"), "linear colours as floats, 1 is white, and not uint8"), (np.zeros((4, 4, 3)), "height, width, 4"),
                                (np.zeros((0, 4, 4)), "height, width, 4"), (np.full((3, 4, 4), np.nan), "NaN. at row 0, column 0"), (None, "type None"),
                                (np.zeros((4, 4, 4), complex), "complex128")):
            with self.assertRaisesRegex(freevoxels.InputError, sentence):
                freevoxels.save("none.png", image)
        image = np.zeros((3, 4, 4), "f4")
        image[1, 2, 0] = np.nan
        for name in ("none.png", "none.exr"):
            with self.assertRaisesRegex(freevoxels.InputError, "NaN. at row 1, column 2"):
                freevoxels.save(name, image)


class SliceTest(unittest.TestCase):
    RED = {"range": [0, 31], "opacity": [[0, 0], [1, 0.5]], "color": [[0, 0, 0, 0], [1, 1, 0, 0]]}

    def test_slices_are_arrays_of_the_values_colours(self):
        ramp = np.broadcast_to(np.arange(32, dtype="f4") - 0.0, (8, 16, 32))
        volume = freevoxels.Volume(ramp, spacing=(1, 1, 2))
        for where in ("z:50%", ("z", "50%"), ("z", 8), "z:8"):
            image = freevoxels.render(volume, slice=where, size=(32, 16), transfer_function=self.RED)
            np.testing.assert_allclose(image[:, :, 0], np.broadcast_to(np.arange(32) / 31, (16, 32)), atol=1e-5, err_msg=str(where))
            np.testing.assert_array_equal(image[:, :, 3], 1)

    def test_frames_of_a_renderer_are_slices_or_views(self):
        renderer = freevoxels.Renderer(freevoxels.Volume(values((9, 8, 17))), size=(33, 20), orbit=(20, 10))
        view = renderer.render()
        slices = [renderer.render(slice=f"y:{part}%") for part in (20, 70)]
        self.assertFalse(np.array_equal(*slices))
        np.testing.assert_array_equal(renderer.render(), view)
        np.testing.assert_array_equal(renderer.render(slice="y:20%"), slices[0])
        self.assertFalse(np.array_equal(renderer.render(slice="y:20%", annotate=True), slices[0]))

    def test_what_a_slice_has_not_is_refused(self):
        renderer = freevoxels.Renderer(freevoxels.Volume(values((9, 8, 17))), size=(33, 20))
        for options, sentence in (({"slice": "z:50"}, "along z"), ({"slice": "w:1"}, "AXIS:POSITION"), ({"slice": "z:1", "depth": True}, "no depth"),
                                  ({"slice": "z:1", "mode": "mip"}, "exclude each other")):
            with self.assertRaisesRegex(freevoxels.Error, sentence):
                renderer.render(**options)
        with self.assertRaisesRegex(freevoxels.Error, "one image"):
            list(renderer.turntable(2, slice="z:50%"))


if __name__ == "__main__":
    unittest.main()
