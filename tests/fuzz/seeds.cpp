// Writes small valid files for the fuzzers to begin with: seeds FOLDER, into FOLDER/{vdb,exr,png,json,fvx,transfer}, and of
// scans into FOLDER/{vti,zarr,tiff,text}.

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <openvdb/io/Stream.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <fstream>

#include "engine/core/error.h"
#include "engine/image/fixed_sums.h"
#include "engine/image/image.h"
#include "engine/storage/baked_volume.h"
#include "engine/volume/openvdb_trees.h"
#include "engine/volume/vdb_grids.h"
#include "tests/volume/tiff_fixture.h"
#include "tests/volume/zarr_fixture.h"

namespace {

namespace fs = std::filesystem;
using namespace freevoxels;
using openvdb::Coord;
using openvdb::FloatGrid;

FloatGrid::Ptr makeGrid(const std::string& name) {
  const FloatGrid::Ptr grid = FloatGrid::create(0.0f);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  for (int i = 0; i < 12; ++i) grid->tree().setValueOn(Coord(i, i * i % 7, i % 3), 0.1f * float(i));
  return grid;
}

openvdb::GridPtrVec assortedGrids() {
  const FloatGrid::Ptr half = makeGrid("half"), tile = FloatGrid::create(), instance = FloatGrid::create(half->treePtr());
  half->setSaveFloatAsHalf(true);
  tile->setName("temperature");
  tile->fill({Coord(0), Coord(15)}, 2.0f);
  instance->setName("instance");
  instance->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  const auto velocity = openvdb::Vec3SGrid::create();
  velocity->setName("velocity");
  velocity->tree().setValueOn(Coord(1, 2, 3), openvdb::Vec3s(1.0f, 2.0f, 3.0f));
  const auto mask = openvdb::BoolGrid::create();
  mask->setName("mask");
  mask->tree().setValueOn(Coord(1, 2, 3), true);
  return {makeGrid("density"), half, tile, instance, velocity, mask};
}

void writeVolumes(const fs::path& folder) {
  initialiseOpenVdb();
  using namespace openvdb::io;
  for (const std::uint32_t compression : {std::uint32_t(COMPRESS_NONE), std::uint32_t(COMPRESS_ZIP), std::uint32_t(COMPRESS_BLOSC | COMPRESS_ACTIVE_MASK)}) {
    File file((folder / fmt::format("grids{}.vdb", compression)).string());
    file.setCompression(compression);
    file.write(assortedGrids());
  }
  File((folder / "one.vdb").string()).write({makeGrid("density")});
  File((folder / "sphere.vdb").string()).write({openvdb::tools::createLevelSetSphere<FloatGrid>(2.0f, openvdb::Vec3f(0.0f), 0.5f)});
  std::ofstream stream(folder / "stream.vdb", std::ios::binary);
  Stream(stream).write(openvdb::GridPtrVec{makeGrid("density")});
}

void writeSumsOf(const fs::path& file, bool gathered) {
  FixedSums sums{.size = {9, 7}, .first = {1, 2}, .extent = {5, 4}, .digits = {40, 40, 40, 43, 46, 38}, .method = "rays"};
  if (gathered) {
    sums.lattice = SampleLattice{.samples = latticeSamples(sums.size, 0.5), .pitch = 0.5, .first = {-4.5, -3.5}, .depth = true};
    for (int axis = 0; axis < 3; ++axis) sums.lattice->axes[std::size_t(axis)].along = {axis == 2 ? 1.0 : 0.1, 0.01, 0.02};
  }
  for (std::size_t i = 0; i < sums.pixelCount() * kSumChannels; ++i) sums.values.push_back(std::int64_t(i) << 36);
  writeSums(file, sums, {.metadata = {{"freevoxels:share", "0/1"}, {"freevoxels:size", "9x7"}}});
}

/// Images of kinds that this project reads and does not write: channels of few samples in the compression that shrinks most, and tiles.
void writeOtherImages(const fs::path& folder) {
  constexpr int kEdge = 64;
  std::vector<float> values(kEdge * kEdge, 0.25f);
  for (const bool tiled : {false, true}) {
    Imf::Header header(kEdge, kEdge);
    header.compression() = Imf::DWAB_COMPRESSION;
    Imf::FrameBuffer frame;
    const auto insert = [&](const char* name, int sampling) {
      header.channels().insert(name, Imf::Channel(Imf::FLOAT, sampling, sampling));
      frame.insert(name, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(values.data()), sizeof(float), kEdge / std::size_t(sampling) * sizeof(float),
                                    sampling, sampling));
    };
    for (const char* name : {"R", "G", "B"}) insert(name, 1);
    if (tiled) {
      header.setTileDescription(Imf::TileDescription(16, 32));
      Imf::TiledOutputFile exr((folder / "tiled.exr").c_str(), header);
      exr.setFrameBuffer(frame);
      exr.writeTiles(0, exr.numXTiles() - 1, 0, exr.numYTiles() - 1);
    } else {
      for (const char* name : {"BY", "RY"}) insert(name, 2);
      Imf::OutputFile exr((folder / "sampled.exr").c_str(), header);
      exr.setFrameBuffer(frame);
      exr.writePixels(kEdge);
    }
  }
}

void writeImages(const fs::path& folder) {
  writeOtherImages(folder / "exr");
  Image image{.size = {9, 7}};
  for (int i = 0; i < 63; ++i) {
    image.pixels.emplace_back(float(i) / 63.0f, 0.5f, 0.25f, 1.0f - float(i) / 100.0f);
    image.depth.push_back(float(i));
  }
  writeExr(folder / "exr/half.exr", image, {});
  writeExr(folder / "exr/float.exr", cropped(image, {{2, 1}, {5, 4}}), {.fullFloat = true, .metadata = {{"a", "b"}}});
  std::ofstream(folder / "exr/rows.hdr", std::ios::binary)
      << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\nEXPOSURE=2\n\n-Y 2 +X 8\n"
      << std::string("\2\2\0\10\210\1\210\2\210\3\2\200\201\206\177", 15) << std::string("\3\4\5\200\1\1\1\7", 8);
  writeSumsOf(folder / "exr/splats.exr", false);
  writeSumsOf(folder / "exr/samples.exr", true);
  writePng(folder / "png/alpha.png", image);
  writePng(folder / "png/opaque.png", image, {.background = Background{}}, 16);
}

void writeFunctions(const fs::path& folder) {
  std::ofstream(folder / "all.json") << R"({"range": [0, 1], "opacity": [[0, 0], [0.5, 0.2], [1, 1]], "color": [[0, 1, 0, 0], [1, 0, 0, 1]], "unit_distance": 0.5})";
  std::ofstream(folder / "short.json") << R"({"opacity": [[0.25, 1e-3]], "color": [[0, 1, 1, 1]]})";
  std::ofstream(folder / "scene.json") << R"({"input": {"volume": "procedural:cloud", "resolution": [20, 30, 40]}, "camera": {"orbit": [30, 8], "fov": 33.3},
  "light": {"light": [{"direction": [1, 2, 3], "color": "0.1,1,2", "intensity": 7.5}], "ambient": 0.1}, "output": {"aov": ["depth"]},
  "classification": {"transfer-function": {"opacity": [[0, 0], [1, 0.5]]}}})";
  constexpr std::size_t kDeep = 30'000;
  std::ofstream(folder / "deep.json") << R"({"light": {"ambient": )" << std::string(kDeep, '[') << std::string(kDeep, ']') << "}}";
}

/// Transfer functions of other programs, a file for each format.
void writeForeignFunctions(const fs::path& folder) {
  std::ofstream(folder / "paraview.json") << R"([{"Name": "A", "ColorSpace": "Diverging", "RGBPoints": [-1, 0.2, 0.3, 0.8, 1, 0.7, 0, 0.1],
    "Points": [0, 0, 0.3, 0.5, 9, 1, 0.5, 1]}, {"Name": "B", "ColorSpace": "HSV", "IndexedColors": [1, 0, 0, 0, 1, 0], "UseLogScale": 1}])";
  std::ofstream(folder / "volview.json")
      << R"([{"Name": "A", "AbsoluteRange": true, "ColorSpace": "Lab", "OpacityPoints": [-3024, 0, -16, 0.5],
    "RGBPoints": [-3024, 0, 0, 0, -16, 0.7, 0.2, 0.3]}])";
  std::ofstream(folder / "slicer.vp.json") << R"({"volumeProperties": [{"components": [{"scalarOpacityUnitDistance": 2,
    "scalarOpacity": {"points": [{"x": 0, "y": 0, "midpoint": 0.5, "sharpness": 1}, {"x": 1, "y": 1}]},
    "rgbTransferFunction": {"points": [{"x": 0, "color": [1, 0, 0], "midpoint": 0.2, "sharpness": 0.4}]}}]}]})";
  std::ofstream(folder / "slicer.xml") << R"(<MRML><VolumeProperty name="A" scalarOpacity="4 0 0 10 1" colorTransfer="4 0 1 0 0"
    gradientOpacity="4 0 0 1 1"/></MRML>)";
  std::ofstream(folder / "slicer.vp") << "1\n1\n0.9\n0.1\n0.2\n10\n4 -100 0 300 0.5\n4 0 1 255 1\n4 -100 0 0 0\n";
  std::ofstream(folder / "table.1dt") << "3\n0 0 0 0\n1 0 0 0.5\n1 1 1 0.25\n";
  std::ofstream(folder / "inviwo.itf") << R"(<InviwoTransferFunction><type content="0"/><maskMin content="0.2"/><TFPrimitives><TFPrimitive>
    <pos content="0.25"/><rgba x="0" y="0.5" z="1" w="0.1"/></TFPrimitive></TFPrimitives></InviwoTransferFunction>)";
  std::ofstream(folder / "voreen.tfi") << R"(<VoreenData><TransFuncIntensity><domain x="-1" y="3"/><threshold x="0.1" y="0.9"/><Keys><key>
    <intensity value="0.5"/><split value="true"/><colorL r="255" g="0" b="0" a="51"/><colorR r="0" g="0" b="255" a="255"/></key></Keys>
    </TransFuncIntensity></VoreenData>)";
}

/// Sizes that end inside of bricks and chunks along every axis, with one chunk and with several, and with up to three levels.
constexpr glm::ivec3 kBakedSizes[]{{40, 9, 8}, {1, 1, 1}, {38, 26, 31}, {33, 65, 9}, {7, 34, 67}, {65, 12, 33}};

/// Few values, so that compressed chunks are small: the fuzzers take files of 64 KiB.
ScalarBricks steps(glm::ivec3 size, float scale) {
  return ScalarBricks::make(size, [=](glm::ivec3 v) { return v.y % 12 > 5 ? kInactiveVoxel : scale * float((v.x + v.z) / 16 + 1); });
}

void writeBakedVolume(const fs::path& folder, glm::ivec3 size) {
  const auto name = [&](const char* kind) { return folder / fmt::format("{}_{}x{}x{}.fvx", kind, size.x, size.y, size.z); };
  Volume volume{.source = "seed", .dimensions = size, .scalars = steps(size, 0.25f)};
  summariseValues(volume);
  bakeVolume(name("densities"), volume, {}, {.compress = true});
  bakeVolume(name("scalars"), volume, {}, {.keepScalars = true, .compress = size.x * size.y * size.z > 4096});
  Classification banded{.transferFunction = TransferFunction{}};
  banded.transferFunction->opacity = {{0.1f, 0.0f}, {0.9f, 0.5f}};
  banded.transferFunction->color = {{0.0f, glm::vec3(1, 0, 0)}};
  bakeVolume(name("banded"), volume, banded, {.compress = true});
  volume.temperature = TemperatureGrid{.name = "heat", .values = steps(size, 700.0f)};
  summariseValues(*volume.temperature);
  volume.albedo = AlbedoGrid{.name = "color"};
  for (ScalarBricks& values : volume.albedo->values) values = steps(size, 0.1f);
  bakeVolume(name("channels"), volume, {.emission = Emission{}}, {.compress = true});
}

void writeBakedVolumes(const fs::path& folder) {
  for (const glm::ivec3 size : kBakedSizes) writeBakedVolume(folder, size);
}

void writeFile(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

void writeHierarchies(const fs::path& folder) {
  using nlohmann::json;
  test::ZarrFixture array{.shape = {2, 3, 4, 5}, .chunk = {1, 2, 4, 3}};
  const json omero{{"channels", {test::omeroChannel("a", "FF0000", true, 0, 100), test::omeroChannel("b", "00FF00", true, 5, 50)}}};
  const auto write = [&](const std::string& name, test::ZarrFiles files, bool isThird, bool isDeflated) {
    json attributes{{"version", isThird ? "0.5" : "0.4"}, {"multiscales", test::multiscalesOf(1)}, {"omero", omero}};
    test::addImage(files, attributes, isThird);
    writeFile(folder / (name + ".zip"), test::zipOf(files, isDeflated));
  };
  test::ZarrFiles files;
  array.addSecond(files, "0");
  write("raw", files, false, false);
  write("deflated", files, false, true);
  array.pack = [](const std::string& bytes) { return test::bloscOf(bytes, "lz4", BLOSC_SHUFFLE); };
  array.addSecond(files, "0", {{"compressor", {{"id", "blosc"}}}});
  write("blosc", files, false, false);
  files.clear();
  array.pack = test::zstdOf;
  const json bytes{{"name", "bytes"}, {"configuration", {{"endian", "little"}}}};
  array.addThird(files, "0", {bytes, {{"name", "zstd"}}}, {1, 2, 1, 2});
  write("shards", files, true, false);
  files.clear();
  array.pack = [](const std::string& plain) { return test::deflateOf(plain, 31); };
  array.addThird(files, "0", {bytes, {{"name", "gzip"}}});
  write("gzip", files, true, false);
}

constexpr const char* kHyperstack = "ImageJ=1.54f\nimages=12\nchannels=2\nslices=3\nframes=2\nhyperstack=true\nunit=um\nspacing=0.5\n";

void writeStacks(const fs::path& tiff, const fs::path& text) {
  const std::string ome = test::omeXml("SizeZ=\"3\" SizeC=\"2\" SizeT=\"1\" DimensionOrder=\"XYZCT\" PhysicalSizeX=\"0.25\"",
                                       "<Channel Name=\"a\" Color=\"65535\"/><Channel Name=\"b\"/><TiffData IFD=\"0\" PlaneCount=\"6\"/>");
  writeFile(tiff / "hyperstack.tif", test::TiffFixture{.pages = 12, .description = kHyperstack}.bytes());
  writeFile(tiff / "behind.tif", test::TiffFixture{.description = kHyperstack, .images = 12}.bytes());
  test::TiffFixture colored{.pages = 12, .description = kHyperstack};
  colored.metadata = test::ImageJMetadata({{255, 0, 0}, {0, 255, 0}}, false, {{0.0, 9.0}, {1.0, 2.0}});
  writeFile(tiff / "tables.tif", colored.bytes());
  for (const bool isPlanar : {false, true})
    writeFile(tiff / (isPlanar ? "planes.tif" : "photographs.tif"),
              test::TiffFixture{.pages = 2, .samples = 3, .photometric = 2, .hasBytes = true, .isPlanar = isPlanar}.bytes());
  writeFile(tiff / "ome.tif", test::TiffFixture{.pages = 6, .description = ome}.bytes());
  writeFile(text / "imagej", kHyperstack);
  writeFile(text / "ome", ome);
  writeFile(text / "name", "a_13x9x10_uint16.raw");
  writeFile(text / "layout", "13x9x10,i16,big,header=512");
  writeFile(text / "slice", "z:37.5%");
}

void writeVtiImages(const fs::path& folder) {
  const std::string head = "<?xml version=\"1.0\"?><VTKFile type=\"ImageData\" byte_order=\"LittleEndian\"";
  const std::string image =
      "><ImageData WholeExtent=\"0 2 0 1 0 1\" Origin=\"0 0 0\" Spacing=\"1 1 2\"><Piece Extent=\"0 2 0 1 0 1\"><PointData Scalars=\"a\">"
      "<DataArray type=\"UInt16\" Name=\"a\" ";
  const std::string foot = "</DataArray></PointData></Piece></ImageData>";
  writeFile(folder / "text.vti", head + image + "format=\"ascii\">1 2 3 4 5 6 7 8 9 10 11 12" + foot + "</VTKFile>");
  std::string colors = image;
  colors.replace(colors.find("UInt16"), 6, "UInt8\" NumberOfComponents=\"3");
  std::string numbers;
  for (int i = 0; i < 36; ++i) numbers += std::to_string(7 * i) + " ";
  writeFile(folder / "colors.vti", head + colors + "format=\"ascii\">" + numbers + foot + "</VTKFile>");
  std::string values("\x18\0\0\0", 4);
  for (char i = 0; i < 24; ++i) values += i;
  const std::string appended = "format=\"appended\" offset=\"0\">" + foot + "<AppendedData encoding=\"raw\">_";
  writeFile(folder / "raw.vti", head + image + appended + values + "</AppendedData></VTKFile>");
  const std::string packed = test::deflateOf(values.substr(4), 15);
  std::string blocks;
  for (const std::size_t number : {std::size_t(1), std::size_t(24), std::size_t(0), packed.size()})
    test::appendTo(blocks, std::uint32_t(number));
  writeFile(folder / "packed.vti",
            head + " compressor=\"vtkZLibDataCompressor\"" + image + appended + blocks + packed + "</AppendedData></VTKFile>");
}

}  // namespace

int main(int argc, char** argv) {
  const fs::path folder = argc > 1 ? argv[1] : ".";
  for (const char* kind : {"vdb", "exr", "png", "json", "fvx", "transfer", "vti", "zarr", "tiff", "text"}) fs::create_directories(folder / kind);
  writeVolumes(folder / "vdb");
  writeImages(folder);
  writeFunctions(folder / "json");
  writeForeignFunctions(folder / "transfer");
  writeBakedVolumes(folder / "fvx");
  writeVtiImages(folder / "vti");
  writeHierarchies(folder / "zarr");
  writeStacks(folder / "tiff", folder / "text");
}
