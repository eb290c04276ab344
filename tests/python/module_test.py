"""The module as a user calls it: closed forms, the command line's images, arrays of all kinds, errors."""

import importlib.util
import logging
import math
import os
import pathlib
import subprocess
import tempfile
import threading
import unittest

import freevoxels
import numpy as np

PROGRAM = os.environ["FREEVOXELS_PROGRAM"]
ALONG_Z = dict(camera_position=(9.5, 9.5, 100), look_at=(9.5, 9.5, 0), up=(0, 1, 0), orthographic=20, size=(40, 40))


def blob(shape=(12, 14, 16)):
    """A soft ball with a dent, positive everywhere, so that every voxel is active in any file."""
    z, y, x = np.meshgrid(*[np.linspace(-1, 1, n, dtype="float32") for n in shape], indexing="ij")
    return np.maximum(1 - np.sqrt(x * x + y * y + z * z) + 0.3 * np.sin(5 * x), 1e-3).astype("float32")


class RenderTest(unittest.TestCase):
    def test_homogeneous_box_is_the_law_of_beer_and_lambert(self):
        box = np.ones((12, 20, 20), "float32")
        for extinction in (0.01, 0.1):
            image = freevoxels.render(box, spacing=(1, 1, 2), density_scale=extinction, unlit=True, albedo=(0.8, 0.5, 0.2), **ALONG_Z)
            self.assertEqual((image.shape, image.dtype), ((40, 40, 4), np.float32))
            alpha = 1 - math.exp(-extinction * 12 * 2)
            np.testing.assert_allclose(image[20, 20], [0.8 * alpha, 0.5 * alpha, 0.2 * alpha, alpha], rtol=2e-3)

    def test_rays_end_at_the_depths_of_a_holdout(self):
        box, options = np.ones((12, 20, 20), "float32"), dict(spacing=(1, 1, 2), density_scale=0.1, unlit=True, **ALONG_Z)
        depth = np.full((40, 40), np.inf)
        depth[:, :20] = 100 - 23 + 10  # 10 behind the first face
        image = freevoxels.render(box, holdout=depth, **options)
        np.testing.assert_allclose(image[20, [10, 19, 20, 30], 3], 1 - np.exp(-0.1 * np.array([10, 10, 24, 24])), rtol=2e-3)
        renderer = freevoxels.Renderer(freevoxels.Volume(box, spacing=(1, 1, 2)), density_scale=0.1, unlit=True, **ALONG_Z)
        np.testing.assert_array_equal(renderer.render(holdout=depth.astype("float32")), image)
        self.assertGreater(renderer.render()[20, 10, 3], image[20, 10, 3])
        with tempfile.TemporaryDirectory() as folder:
            freevoxels.save(f"{folder}/depth.exr", image, depth=depth.astype("float32"))
            np.testing.assert_array_equal(renderer.render(holdout=pathlib.Path(folder) / "depth.exr"), image)
        for wrong, kind in ((depth[:-1], freevoxels.UsageError), (depth[0], freevoxels.InputError), (-depth, freevoxels.InputError),
                            (depth * np.nan, freevoxels.InputError)):
            with self.assertRaises(kind) as refusal:
                renderer.render(holdout=wrong)
            self.assertIn("holdout", str(refusal.exception))

    def test_axes_are_z_y_x_and_rows_begin_at_the_top(self):
        corner = np.zeros((4, 20, 20), "float32")
        corner[:, 15:, :5] = 1  # large y, small x: the upper left of a view along -z
        image = freevoxels.render(corner, density_scale=1, unlit=True, **ALONG_Z)
        self.assertGreater(image[5, 5, 3], 0.9)
        self.assertEqual(image[30, 30, 3], 0)

    def test_depth_is_the_distance_to_what_is_seen(self):
        slab = np.zeros((9, 20, 20), "float32")
        slab[4] = 1
        image, depth = freevoxels.render(slab, density_scale=9, unlit=True, depth=True, **ALONG_Z)
        self.assertEqual(depth.shape, image.shape[:2])
        self.assertAlmostEqual(float(depth[20, 20]), 100 - 4, delta=0.01)

    def test_spacing_origin_and_transform_place_the_same_volume(self):
        transform = np.diag([1.0, 1.0, 2.0, 1.0])
        transform[:3, 3] = (3, 4, 5)
        placed = freevoxels.render(blob(), spacing=(1, 1, 2), origin=(3, 4, 5), size=(48, 40))
        np.testing.assert_array_equal(placed, freevoxels.render(blob(), transform=transform, size=(48, 40)))

    def test_nan_and_no_data_hold_nothing(self):
        marked, holed = blob(), blob()
        marked[4:8], holed[4:8] = -999, np.nan
        image = freevoxels.render(marked, no_data=-999, density_scale=1, size=(40, 40))
        np.testing.assert_array_equal(image, freevoxels.render(holed, density_scale=1, size=(40, 40)))

    def test_arrays_of_all_types_and_strides_are_read(self):
        whole = np.round(blob() * 60).astype("float32")
        expected = freevoxels.render(whole, density_scale=0.01, size=(40, 40))
        for kind in ("u1", "u2", "u4", "u8", "i1", "i2", "i4", "i8", "f2", "f8"):
            np.testing.assert_array_equal(freevoxels.render(whole.astype(kind), density_scale=0.01, size=(40, 40)), expected, kind)
        strided = np.zeros((24, 14, 32), "float32")[::2, ::-1, 1::2]
        strided[:] = whole
        np.testing.assert_array_equal(freevoxels.render(strided, density_scale=0.01, size=(40, 40)), expected)
        np.testing.assert_array_equal(freevoxels.render(np.asfortranarray(whole), density_scale=0.01, size=(40, 40)), expected)

    def test_a_file_is_rendered_with_all_options_of_input(self):
        part = dict(resolution=24, clip_box=(0, 0, 0, 23, 23, 15), clip_plane=(12, 12, 12, 1, 0, 0))
        volume = freevoxels.Volume.open("procedural:cloud", **part)
        image = freevoxels.render("procedural:cloud", size=(40, 40), **part)
        np.testing.assert_array_equal(image, freevoxels.render(volume, size=(40, 40)))

    def test_temperatures_shine(self):
        options = dict(temperature=2000 * blob(), density_scale=0.1, unlit=True, size=(40, 40))
        for more in ({"emission": 5}, {}, {"emission": True}):
            image = freevoxels.render(blob(), **options, **more)
            brightest = image.reshape(-1, 4)[image[..., 0].argmax()]
            self.assertGreater(brightest[0], 2 * brightest[2], more)
        cold = freevoxels.render(blob(), **options, emission=False)
        np.testing.assert_array_equal(cold[..., 0], cold[..., 2])
        np.testing.assert_array_equal(cold, freevoxels.render(blob(), **options, emission="none"))

    def test_options_take_the_forms_of_scene_files(self):
        one = freevoxels.render(blob(), density_scale=1, orbit=(10, 20), fov=30, light={"direction": (1, 1, 0), "intensity": 3},
                                size="40x30")
        other = freevoxels.render(blob(), classification={"density-scale": 1}, camera={"orbit": np.array([10, 20]), "fov": 30},
                                  lights=["direction=1,1,0,intensity=3"], size=(np.int64(40), 30))
        np.testing.assert_array_equal(one, other)

    def test_two_halves_of_a_volume_are_the_volume(self):
        cloud = freevoxels.Volume.open("procedural:cloud", resolution=24)
        half = {"volume": "procedural:cloud", "resolution": 24, "density_scale": 10}
        view = dict(size=(48, 40), unlit=True)
        halves = freevoxels.render(cloud, volumes=[half], density_scale=10, **view)
        np.testing.assert_allclose(halves, freevoxels.render(cloud, density_scale=20, **view), atol=0.03)
        with self.assertRaisesRegex(ValueError, "density-scale"):
            freevoxels.render(cloud, volumes=[{**half, "densityscale": 1}])

    def test_volumes_in_memory_are_drawn_together(self):
        soft, view = blob(), dict(size=(32, 24), unlit=True, density_scale=2)
        first, second = freevoxels.Volume(soft), freevoxels.Volume(soft, origin=(6, 1, 0))
        named = [{"volume": second, "density_scale": 2}]
        together = freevoxels.render(first, volumes=named, **view)
        renderer = freevoxels.Renderer(first, volumes=[{"volume": freevoxels.Volume(soft, origin=(6, 1, 0)), "density_scale": 2}], **view)
        np.testing.assert_array_equal(renderer.render(), together)
        np.testing.assert_array_equal(freevoxels.render([first, named[0]], **view), together)
        np.testing.assert_array_equal(freevoxels.render((second, {"volume": first, "density_scale": 2}), **view), together)
        self.assertFalse(np.array_equal(freevoxels.render(first, **view), together))
        moved = {"volume": first, "density_scale": 2, "transform": (6, 1, 0)}
        np.testing.assert_allclose(freevoxels.render([first, moved], **view), together, atol=1e-6)
        freevoxels.render([first, soft], **view)
        with self.assertRaisesRegex(ValueError, "memory:77777"):
            freevoxels.render(first, volumes=["memory:77777"], **view)

    def test_labels_are_solids_of_their_colours(self):
        parts = np.zeros((12, 12, 14), "int16")
        parts[2:10, 2:10, 2:7], parts[2:10, 2:10, 7:12] = 4, -1
        image = freevoxels.render(parts, labels="4=red,-1=#0000ff", size=(40, 32), orbit=(0, 0), unlit=True)
        seen = image[image[..., 3] > 0.95]
        self.assertGreater(len(seen), 200)
        self.assertEqual(seen[:, 1].max(), 0)
        self.assertTrue((seen[:, 0] > 0.9).sum() > 60 < (seen[:, 2] > 0.9).sum(), "both parts are seen")
        alone = freevoxels.render(freevoxels.Volume(parts, labels=[4]), size=(40, 32), orbit=(0, 0), unlit=True)
        self.assertGreater((image[..., 3] - alone[..., 3]).max(), 0.9)
        with self.assertRaisesRegex(ValueError, "labels"):
            freevoxels.Renderer(freevoxels.Volume(parts), labels="all").render()

    def test_channels_add_up(self):
        dyes = np.stack([blob(), np.roll(blob(), 3, axis=2)])
        options = dict(size=(40, 32), unlit=True, emission=0.2)
        both = freevoxels.render(dyes, channel=["0:red:0,1:emission", "1:#00ff00:0,1:emission"], **options)
        red = freevoxels.render(dyes, channel="0:red:0,1:emission", **options)
        self.assertGreater(both[..., 0].max(), 0.05)
        self.assertGreater(both[..., 1].max(), 0.05)
        self.assertEqual(red[..., 1].max(), 0)
        mixed = freevoxels.render(dyes, channel=["0:red:0,1:emission", "1:#00ff00:0,1"], **options)
        self.assertGreater(mixed[..., 0].max(), 0.05)
        self.assertGreater(mixed[..., 1].max(), 0.05)
        self.assertGreater(mixed[..., 3].max(), both[..., 3].max() + 0.1, "what emits nothing dims")
        with self.assertRaisesRegex(ValueError, "2 channels"):
            freevoxels.render(dyes, channel=["2"])
        with self.assertRaisesRegex(ValueError, "channel"):
            freevoxels.render(dyes)

    @unittest.skipUnless(importlib.util.find_spec("pyopenvdb"), "pyopenvdb is not there for this NumPy")
    def test_layers_of_channels_add_up_to_the_image(self):
        import pyopenvdb

        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "dyes.vdb")
            grids = []
            for name, values in (("dapi", blob()), ("gfp", np.roll(blob(), 3, axis=2))):
                grids.append(pyopenvdb.FloatGrid())
                grids[-1].copyFromArray(values)
                grids[-1].name = name
            pyopenvdb.write(file, grids)
            for channels, second, more in ((["dapi:blue:0,1:emission", "gfp:#00ff00:emission"], "gfp", dict(unlit=True)),
                                           (["dapi:blue", "1:red@2"], "channel1", dict(scattering=1))):
                image, layers = freevoxels.render(file, channels=channels, aov="channels", size=(32, 24), **more)
                self.assertEqual(set(layers), {"dapi", second})
                np.testing.assert_allclose(sum(layers.values()), image[..., :3], atol=1e-6)
                self.assertGreater(min(layer.max() for layer in layers.values()), 0.05)
                plain = freevoxels.render(file, channels=channels, size=(32, 24), **more)
                np.testing.assert_allclose(plain, image, atol=0.01, err_msg="colours of voxels have nine bits")
            with self.assertRaisesRegex(ValueError, "scattering"):
                freevoxels.render(file, channels=["dapi"], aov="channels")

    def test_layers_of_lights_add_up_to_the_image(self):
        cloud = freevoxels.Volume.open("procedural:cloud", resolution=12)
        lights = [{"direction": (1, 1, 0)}, {"direction": (-1, 0, 1), "color": (0, 0.5, 1)}]
        image, layers = freevoxels.render(cloud, size=(24, 20), light=lights, ambient=0.2, aov="lights")
        self.assertEqual(set(layers), {"light1", "light2", "ambient"})
        np.testing.assert_allclose(sum(layers.values()), image[..., :3], atol=1e-6)
        self.assertEqual(layers["light2"][..., 0].max(), 0)

    def test_transfer_function_may_be_a_dictionary(self):
        points = {"opacity": [[0, 0], [1, 0.5]], "color": [[0, 1, 0, 0], [1, 1, 0, 0]]}
        image = freevoxels.render(blob(), transfer_function=points, unlit=True, size=(40, 40))
        self.assertGreater(image[20, 20, 0], 0.3)
        self.assertEqual(image[..., 1:3].max(), 0)

    def test_presets_and_maps_of_other_programs_with_windows(self):
        draw = lambda **options: freevoxels.render(blob(), unlit=True, size=(40, 40), **options)
        own = {"range": [0.2, 0.8], "opacity": [[0, 0], [1, 0.5]], "color": [[0, 0, 0, 1], [1, 1, 0, 0]], "unit_distance": 0.5}
        turned = {"range": [0, 1], "opacity": [[0, 0], [1, 0.5]], "color": [[0, 1, 0, 0], [1, 0, 0, 1]], "unit_distance": 1}
        np.testing.assert_array_equal(draw(transfer_function=turned, window=(0.5, 0.6), opacity=2, invert=True), draw(transfer_function=own))
        np.testing.assert_array_equal(draw(transfer_function="Viridis", window="0..1"), draw(transfer_function="viridis", window=(0.5, 1)))
        np.testing.assert_array_equal(draw(window=(0.5, 1)), draw(transfer_function="grey", window=[0.5, 1]))
        paraview = {"Name": "red", "RGBPoints": [0, 1, 0, 0, 1, 1, 0, 0]}
        self.assertEqual(draw(transfer_function=paraview)[..., 1:3].max(), 0)
        with self.assertRaisesRegex(freevoxels.InputError, "did you mean 'viridis'"):
            draw(transfer_function="viridid")

    def test_scenes_keep_presets_and_windows(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "scene.json"
            freevoxels.save_scene(file, volume="procedural:cloud", transfer_function="ct-bone", window=(40, 400), invert=True)
            self.assertEqual(freevoxels.load_scene(file)["classification"],
                             {"transfer-function": "ct-bone", "window": "-160..240", "invert": True})


class RendererTest(unittest.TestCase):
    def test_frames_are_those_of_separate_renders(self):
        volume = freevoxels.Volume(blob())
        renderer = freevoxels.Renderer(volume, size=(48, 40), density_scale=0.5)
        own = {"size": (48, 40), "density_scale": 0.5}
        for options in ({}, {"orbit": (90, 10)}, {"density_scale": 2}, {"unlit": True}, {"directions": 98, "draw": "splats"}, {}):
            image = renderer.render(**options)
            # The view is the renderer's, which a frame's orbit turns: it is not framed and lit anew.
            expected = freevoxels.Renderer(volume, **own).render(**options)
            np.testing.assert_array_equal(image, expected, str(options))
            same = freevoxels.render(volume, **{**own, **options})
            if "orbit" in options:
                same = freevoxels.Renderer(volume, **own, **options).render()
                np.testing.assert_array_equal(same, freevoxels.render(volume, **own, **options))
            else:
                np.testing.assert_array_equal(image, same, str(options))

    def test_keeps_the_table_between_frames(self):
        renderer = freevoxels.Renderer(freevoxels.Volume(blob()), size=(40, 40), draw="splats")
        stages = []
        for azimuth in (0, 90):
            renderer.render(orbit=(azimuth, 0))
            stages.append({stage for stage, milliseconds in renderer.timings if milliseconds >= 0})
        self.assertIn("attenuation sweeps", stages[0] - stages[1])

    def test_an_exception_of_progress_abandons_the_frame_alone(self):
        volume = freevoxels.Volume.open("procedural:cloud", resolution=64)
        renderer = freevoxels.Renderer(volume, size=(900, 900), draw="splats")  # long enough to be reported

        def stop(stage, fraction):
            self.assertTrue(0 <= fraction <= 1)
            raise InterruptedError(stage)

        with self.assertRaises(InterruptedError):
            renderer.render(progress=stop)
        np.testing.assert_array_equal(renderer.render(size=(40, 40)), freevoxels.render(volume, size=(40, 40), draw="splats"))

    def test_threads_may_share_a_renderer(self):
        renderer = freevoxels.Renderer(freevoxels.Volume(blob()), size=(40, 40))
        expected = [renderer.render(orbit=(90 * k, 0)) for k in range(3)]
        images = [None] * 3

        def render(k):
            images[k] = renderer.render(orbit=(90 * k, 0))

        threads = [threading.Thread(target=render, args=(k,)) for k in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        np.testing.assert_array_equal(images, expected)


class FilesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def command(self, *words):
        return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)

    @unittest.skipUnless(importlib.util.find_spec("pyopenvdb"), "pyopenvdb is not there for this NumPy")
    def test_file_array_and_command_make_the_same_image(self):
        import pyopenvdb

        grid = pyopenvdb.FloatGrid()
        grid.name = "density"
        grid.copyFromArray(np.ascontiguousarray(blob().transpose(2, 1, 0)))
        file = self.folder / "blob.vdb"
        pyopenvdb.write(str(file), grid)
        volume = freevoxels.Volume.open(file, grid="density")
        self.assertEqual((volume.shape, volume.active_voxels), (blob().shape, blob().size))
        np.testing.assert_allclose(volume.range, (blob().min(), blob().max()))
        options = dict(density_scale=1, orbit=(20, 30), size=(48, 40))
        image, depth = freevoxels.render(file, depth=True, **options)
        np.testing.assert_array_equal(image, freevoxels.render(volume, **options))
        np.testing.assert_array_equal(image, freevoxels.render(blob(), **options))

        ours, theirs = self.folder / "ours.exr", self.folder / "theirs.exr"
        freevoxels.save(ours, image, depth=depth, float=True)
        made = self.command("render", file, theirs, "--float", "--aov", "depth", "--density-scale", 1, "--orbit", "20,30", "--size", "48x40")
        self.assertEqual(made.returncode, 0, made.stderr)
        compared = self.command("compare", ours, theirs, "--json")
        self.assertEqual(compared.returncode, 0, compared.stderr)
        self.assertIn('"difference": 0.0', compared.stdout)

    def test_scene_file_decides_which_grids_are_read(self):
        scene = self.folder / "fire.json"
        scene.write_text('{"input": {"volume": "procedural:cloud", "resolution": 90}, "emission": {"emission": 5}, "camera": {"fov": 30}}')
        image = freevoxels.render("procedural:fire", resolution=24, scene=scene, size=(48, 40))
        expected = freevoxels.render("procedural:fire", resolution=24, emission=5, fov=30, size=(48, 40))
        np.testing.assert_array_equal(image, expected)

    def test_scenes_are_exchanged_with_the_command_line(self):
        file = self.folder / "scene.json"
        scene = {"input": {"volume": "procedural:cloud", "resolution": 24}, "camera": {"orbit": (10, 20), "size": (48, 40), "fov": 20},
                 "light": {"lights": [{"direction": (1, 1, 0), "intensity": 3}]}, "output": {"background": (0.1, 0.2, 0.3)}}
        freevoxels.save_scene(file, fov=30, **scene)
        loaded = freevoxels.load_scene(file)
        self.assertEqual(loaded["camera"], {"orbit": [10, 20], "size": [48, 40], "fov": 30})
        freevoxels.save(self.folder / "ours.png", freevoxels.render(**loaded), **loaded)
        made = self.command("render", "--scene", file, self.folder / "theirs.png", "--save-scene", self.folder / "resolved.json")
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertEqual((self.folder / "ours.png").read_bytes(), (self.folder / "theirs.png").read_bytes())

        resolved = freevoxels.load_scene(self.folder / "resolved.json")
        renderer = freevoxels.Renderer(freevoxels.Volume.open(**resolved), **resolved)
        np.testing.assert_array_equal(renderer.render(), freevoxels.render(**loaded))

    def test_keys_of_earlier_versions_are_read_with_a_warning(self):
        file = self.folder / "scene.json"
        file.write_text('{"light": {"scattering": 2, "scattering-scale": 0.4}}')
        with self.assertLogs("freevoxels", "WARNING") as logs:
            self.assertEqual(freevoxels.load_scene(file)["light"], {"scattering": 2})
        self.assertIn("scattering-scale", logs.output[0])
        with self.assertLogs("freevoxels", "WARNING"):
            freevoxels.Renderer(freevoxels.Volume.open("procedural:cloud", resolution=16)).render(scene=file, size=16)

    def test_wrong_scenes_are_named(self):
        file = self.folder / "scene.json"
        file.write_text('{"camera": {"fob": 3}}')
        with self.assertRaisesRegex(freevoxels.InputError, 'no key "camera.fob"; did you mean "camera.fov"'):
            freevoxels.load_scene(file)
        with self.assertRaisesRegex(freevoxels.UsageError, "did you mean 'fov'"):
            freevoxels.save_scene(file, fob=3)
        with self.assertRaisesRegex(freevoxels.UsageError, "there is no volume to open"):
            freevoxels.render(camera={"fov": 30})

    def test_png_is_that_of_the_command(self):
        options = dict(resolution=24, size=(48, 40))
        freevoxels.save(self.folder / "ours.png", freevoxels.render("procedural:fire", emission=True, **options), background=(0.1, 0.2, 0.3), exposure=-1)
        made = self.command("render", "procedural:fire", self.folder / "theirs.png", "--emission", "--resolution", 24, "--size", "48x40",
                            "--background", "0.1,0.2,0.3", "--exposure", -1)
        self.assertEqual(made.returncode, 0, made.stderr)
        self.assertEqual((self.folder / "ours.png").read_bytes(), (self.folder / "theirs.png").read_bytes())


class ErrorsTest(unittest.TestCase):
    def refused(self, kind, sentence, *arguments, **options):
        with self.assertRaisesRegex(kind, sentence) as caught:
            freevoxels.render(*arguments, **options)
        self.assertIsInstance(caught.exception, freevoxels.Error)
        self.assertNotIn("\n", str(caught.exception))

    def test_wrong_options_are_named(self):
        self.refused(freevoxels.UsageError, "'densty_scale'; did you mean 'density_scale'", blob(), densty_scale=1)
        self.refused(ValueError, "'orbit' and 'camera_position' exclude", blob(), camera_position=(1, 2, 3), orbit=(1, 2))
        self.refused(ValueError, "'size' takes WxH", blob(), size="big")
        self.refused(ValueError, "'up' takes", blob(), up=object())
        self.refused(ValueError, "'exposure'", blob(), exposure=1)

    def test_errors_list_the_keywords_that_they_name(self):
        with self.assertRaises(freevoxels.UsageError) as caught:
            freevoxels.render(blob(), camera_position=(1, 2, 3), look_at=(1, 2, 3))
        self.assertEqual(str(caught.exception), "the camera stands at its look-at point; change 'camera_position' or 'look_at'")
        self.assertEqual(caught.exception.parameters, ("camera_position", "look_at"))
        self.refused(freevoxels.UsageError, "use draw='splats'", blob(), draw="gather", attenuation="bilinear")
        self.refused(freevoxels.OutOfMemoryError, "'memory_limit' is 1 MiB", np.ones((80, 80, 80), np.float32), memory_limit=1, size=(16, 16))

    def test_wrong_arrays_are_named(self):
        self.refused(freevoxels.InputError, "2 dimensions", blob()[0])
        self.refused(ValueError, "complex128", blob().astype(complex))
        self.refused(ValueError, "at least 1", np.zeros((0, 3, 3)))
        self.refused(ValueError, "all its values are NaN", blob() * np.nan)
        self.refused(ValueError, "spacing along each axis", blob(), spacing=(1, 1, 0))
        self.refused(ValueError, "last row is 0, 0, 0, 1", blob(), transform=np.ones((4, 4)))
        self.refused(ValueError, "must be the same", blob(), temperature=blob()[1:], emission=True)

    def test_wrong_files_devices_and_sizes_are_named(self):
        self.refused(freevoxels.InputError, "there is no file '/none/x.vdb'", "/none/x.vdb")
        self.refused(freevoxels.DeviceError, "no device matches", blob(), device="none such")
        self.refused(MemoryError, "needs .* MiB", blob(), memory_limit=1)
        with self.assertRaisesRegex(OSError, "there is no folder '/none'"):
            freevoxels.save("/none/a.png", np.zeros((4, 4, 4)))
        with self.assertRaisesRegex(freevoxels.InputError, "height, width, 4"):
            freevoxels.save("a.png", np.zeros((4, 4, 3)))

    def test_infinite_values_are_reported_to_the_logger(self):
        infinite = blob()
        infinite[0, 0, 0] = np.inf
        with self.assertLogs("freevoxels", logging.WARNING) as logs:
            freevoxels.Volume(infinite)
        self.assertIn("1 voxel of the array whose value is NaN or infinite holds no data", logs.output[0])


if __name__ == "__main__":
    unittest.main()
