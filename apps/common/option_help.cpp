#include "apps/common/option_help.h"

#include <fmt/format.h>

#include "engine/description/scene_description.h"
#include "engine/volume/blackbody.h"

namespace freevoxels {

namespace {

const std::vector<OptionHelp> kVolumeHelp{
    {"volume",
     "OpenVDB file, scan (.nrrd, .nii.gz, .mha, .vti, .vtk, .tif, .zarr, .raw, a DICOM folder or file), baked volume (.fvx), or "
     "procedural:NAME "
     "('freevoxels generate --list' has the names); may be left "
     "out where a --scene has it"},
    {"resolution", fmt::format("Voxels of a procedural volume, one number for a cube [{}]", kDefaultResolution)},
    {"grid",
     "Grid of the file, NAME[k] if several have the name; of a .vti the array, of a scan with channels the one that is drawn alone "
     "[density, smoke or a like name, or the only float grid]"},
    {"raw",
     "The file has values without a header: their number along x, y and z, and their type, u8, i8, u16, i16, u32, i32, u64, i64, f32 or "
     "f64 [as in "
     "the name NAME_256x256x128_uint16.raw]"},
    {"series", "Series of a DICOM folder, by its UID [the only one]"},
    {"time-step", "Time step of a scan with several, from 0 [0]"},
    {"pyramid-level",
     "Level of an OME-Zarr with several resolutions, from 0, the finest; --clip-box then counts its voxels [the finest with at most 1.5 "
     "voxels a pixel that fits in a quarter of the memory]"},
    {"spacing", "Millimetres between the voxels of a scan along the axes of its box [as its file says]"},
    {"no-data", "Value of voxels that hold no data [of scans the value that they are filled up with around what was measured]"},
    {"clip-box",
     "Draw only these voxels: the first and the last ones along x, y and z, inclusive, in the volume's box, whose voxels "
     "'freevoxels info' counts"},
    {"add",
     "Another volume in the same image, with its own look and place: a file, behind it KEY=VALUE with commas between them, of the keys "
     "grid, transfer-function, density-scale, albedo, emission, shading and others of this list, and transform=X,Y,Z or 12 numbers; or the "
     "same as JSON. May be given several times; the order of the volumes does not matter"},
    {"clip-plane", "Draw only the voxels behind the plane through the world position X,Y,Z: the side away from its normal NX,NY,NZ"},

    {"background", "Colour behind the volume in a .png or .jpg, linear, or transparent [a dark gradient]"},
    {"exposure", "Stops that a .png or .jpg is brightened by [0]"},
    {"tone-map", "How bright light is brought into the range of a .png or .jpg [none: it is clipped]"},
    {"float", "Write 32-bit floats to an .exr [16-bit]"},
    {"png-bits", "Bits a channel in a .png [8]"},
    {"aov",
     "Adds channels to an .exr, of depth, position, normal, transmittance, lights and channels, with commas between them: Z, the mean "
     "distance "
     "along the viewing axis; P, the point there in the world; N, its normal; transmittance.Y, 1 - alpha; a layer for each light, light1.R "
     "and so on, or for each channel of --channel, of which the colours are the sum"},
    {"crop", "Writes only these pixels of the image: column and row of the top left one, width and height; the whole image is drawn"},

    {"density-scale",
     "Extinction per world unit at density 1 [chosen so that the volume's mean optical depth suits an image; level sets are opaque]"},
    {"albedo", "Colour of the volume, linear [0.9,0.9,0.9; of volumes with emission 0.5,0.5,0.5]"},
    {"albedo-grid",
     "Grid of vectors of the file with the colours, linear, 0..1; none for none [Cd, color or a like name, if there is one]"},
    {"transfer-function",
     "Colour and opacity by scalar, instead of the above: a preset's name ('freevoxels presets' lists them), a file of FreeVoxels, "
     "ParaView, "
     "VolView, 3D Slicer, ImageVis3D, Inviwo or Voreen, FILE:NAME of a file of several, or JSON that begins with { [for scans one made "
     "from "
     "the histogram]"},
    {"iso",
     "Draws the surface in front of all values from VALUE on, in place of a transfer function, with its colour: R,G,B, "
     "linear, #rrggbb or a basic CSS name [0.8,0.8,0.8]"},
    {"window",
     "Values at which the transfer function begins and ends, by their middle and width or as LO..HI; without a --transfer-function it is "
     "the preset grey [as the function says]"},
    {"opacity", "Factor of the extinction: an opacity o becomes 1 - (1 - o)^FACTOR [1]"},
    {"invert",
     "Turns the colours of the transfer function round: the lowest value has the colour of the highest; opacities stay as they are"},
    {"channel",
     "Draws several grids or channels of the file together, each by a channel option: its name or number from 0, its colour, a weight of "
     "its density, "
     "the "
     "values at which it begins and is full, and whether it sends out light, as dyes do, in place of scattering it: "
     "dapi:blue:100,4000:emission"},
    {"labels",
     "The values are labels, which are drawn as solids, each with its colour: all, none, or which of them, with colours and opacities of a "
     "voxel: 1,2=#d0a080,7=red@0.3; 0 is empty [all, of grids of whole numbers, booleans and masks]"},
    {"classification",
     "What a transfer function is applied to: interpolated scalars (post), or voxels (pre), as always for splats and volumes "
     "with emission [post]"},

    {"emission",
     fmt::format("Emission by temperature: luminance per world unit at {:g} K; without a number it must not be followed by a file "
                 "name [chosen to suit an image, where a volume has temperatures of which some shine]",
                 kReferenceTemperature)},
    {"temperature-grid", "Grid of the temperatures [temperature, heat, flame, fire, burn or a like name]"},
    {"temperature-scale", fmt::format("Kelvin per unit of the grid [1; if no value is above {:g}, the scale that makes the largest {:g} K]",
                                      kMinKelvinMaximum, kReferenceTemperature)},
    {"temperature-offset", fmt::format("Kelvin at value 0 of the grid [0; with such an automatic scale {:g}]", kEmberTemperature)},

    {"camera-position", "Position of the eye in world units [around the volume, see --orbit]"},
    {"orbit", fmt::format("Direction of the eye around the volume in degrees: azimuth about the up direction (if +y is up, from +z "
                          "towards +x), elevation; the volume fills the image [{},{}]",
                          kDefaultAzimuth, kDefaultElevation)},
    {"look-at", "Point in the middle of the image [the middle of the visible volume]"},
    {"up", "Up direction of the image [0,1,0; for scans and files of Blender 0,0,1]"},
    {"fov", fmt::format("Vertical field of view [{}]", Camera{}.verticalFov)},
    {"orthographic", "Orthographic projection; the image is HEIGHT world units high [perspective]"},
    {"flight",
     "Key frames of the camera and of lights, in place of the above: a file, or JSON that begins with {. A turntable draws the flight "
     "through them in place of a turn, and one image shows the first of them [none]"},
    {"size",
     fmt::format("Image size in pixels, or one number for a square [{}x{}]", CameraDescription{}.size.x, CameraDescription{}.size.y)},
    {"holdout",
     "Image of what other surfaces this camera sees, at whose depths rays end: channel Z, the distance along the viewing axis in world "
     "units, "
     "of an image of this size; a run of # becomes the number of the frame [nothing is in front]"}};

const std::vector<OptionHelp> kLightHelp{
    {"unlit", "No lighting: every voxel sends out its colour"},
    {"light",
     "A light; may be repeated. direction: from the volume towards a light at infinity; position: of a point light in the "
     "world; color: linear [1,1,1]; intensity: irradiance, for a position at distance 1 [4 pi in the middle of the volume]. "
     "Without any light, ambient light or environment there are a key light from the upper left of the first view and "
     "ambient light, dimmer for volumes with emission"},
    {"ambient", "Radiance from all directions, linear; one number is a grey [0 if there is another light]"},
    {"environment",
     "Radiance by direction, added to the ambient light: a linear latitude-longitude image, +y up, its middle column "
     "towards +z, the column a quarter from the left towards +x [none]"},
    {"environment-rotation", "Rotation of the environment about +y in degrees, added to its azimuths [0]"},
    {"environment-intensity", "Factor of the environment's radiance [1]"},
    {"phase-g", "Asymmetry of the Henyey-Greenstein phase function, -0.99 to 0.99; positive scatters forwards [0]"},
    {"scattering", fmt::format("Orders of scattering in fog: all that matter, or 1 to {}; 1 is single scattering [all]", kMaxOrders)},
    {"extinction-tint",
     "Factor of the extinction between light and voxel for each colour, so that white light becomes coloured inside the "
     "volume [1,1,1]"},
    {"light-attenuation",
     "Shadows of lights: looked up in the attenuation table, or exact, along rays that are swept once for each light; auto: "
     "exact, unless --attenuation is nearest, or splats need more than a quarter of the device's memory for it [auto]",
     true},
    {"shading",
     "What a voxel does with light: scatter it as fog, or reflect it like a surface across the gradient; auto: gradient with a "
     "transfer function and for level sets, else scatter [auto]",
     true},
    {"surface-share", "Part of the light that surfaces reflect like surfaces, 0 to 1; the rest is scattered like fog [1]", true}};

const std::vector<OptionHelp> kMethodHelp{
    {"mode",
     "What a ray shows: the volume as a medium, or, without light, its values: the largest on its way (mip, maximum intensity projection) "
     "or their mean (average), with colour and opacity of the transfer function [volume; of mip and average that is a white ramp]",
     true},
    {"slice",
     "Draws a slice in place of a view: the values on the plane across the axis x, y or z of the world at a position in world units, or in "
     "per cent of the volume's box (z:50%), in the colours of the transfer function [grey over the usual values]",
     true},
    {"annotate",
     "Draws bars over the image: the colours of the transfer function with their values and, where the image is a slice or orthographic, "
     "a length of the world",
     true},
    {"composite",
     "How splats become pixels: colours mixed by the table with exact opacity, the paper's plain sum, or back-to-front alpha "
     "blending for comparison [normalised]",
     true},
    {"draw",
     "How the volume becomes the image: gather marches rays through it, splats draws a billboard for every voxel, as the paper "
     "does [splats with --paper, --attenuation or another --composite than normalised, else gather]",
     true},
    {"attenuation",
     "Transmittance of splats to the eye: interpolated between four directions of the table, or that of its nearest direction "
     "[bilinear]",
     true},
    {"directions", "Directions of the table; 98 are more exact and take more memory and time [26]", true},
    {"code", "What a byte of the table holds: optical depth or transmittance [depth8]", true},
    {"path-length-correction", "Whether diagonal steps of the table count with their full length [yes]", true},
    {"gradient", "Whether the transmittance varies across a splat [yes]", true},
    {"lod",
     "Size on the image up to which blocks of voxels are drawn as one element; 0 always draws voxels, as does --composite "
     "sorted [1]",
     true},
    {"quality",
     "Less than 1, down to 0.05, draws a draft: Q times as many rays along a pixel's edge, or splats of blocks 1/Q times as large [1]",
     true},
    {"culling", "Whether splats outside of the image are left out, and rays of the gather end early; --composite sorted draws all [yes]",
     true},
    {"cull-threshold",
     "Transmittance to the eye at which a ray of the gather ends, and below which the table hides blocks of splats with --composite "
     "additive; 0 leaves nothing out [1/512, and 1/4096 for splats]",
     true},
    {"hierarchy-filter", "Mean of its voxels' transmittances that a block has [geometric]", true},
    {"paper",
     "The paper's method, for comparison: --composite additive --attenuation nearest --directions 26 --code linear8 "
     "--no-path-length-correction --no-gradient --lod 0 --no-culling. Any of these that is given wins. 1 to 25 dB worse than "
     "the default",
     true}};

}  // namespace

const std::vector<OptionHelp>& optionHelp() {
  static const std::vector<OptionHelp> all = [] {
    std::vector<OptionHelp> joined = kVolumeHelp;
    for (const std::vector<OptionHelp>& more : {kLightHelp, kMethodHelp}) joined.insert(joined.end(), more.begin(), more.end());
    return joined;
  }();
  return all;
}

}  // namespace freevoxels
