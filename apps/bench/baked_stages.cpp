#include "apps/bench/baked_stages.h"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>

#include "engine/attenuation/attenuation_table.h"
#include "engine/core/error.h"
#include "engine/description/scene_description.h"
#include "engine/memory_planner.h"
#include "engine/octree/volume_builder.h"
#include "engine/renderer.h"
#include "engine/storage/procedural_stream.h"
#include "engine/volume/vdb.h"

namespace freevoxels::bench {

namespace {

/// Removes itself with its files.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "freevoxels-bench.XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) fail(ErrorKind::Output, "no temporary folder can be made in {}", name);
    path_ = name;
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

Image firstImage(const Device& device, const std::filesystem::path& file, glm::ivec2 size, std::optional<int> level = {}) {
  SceneDescription scene;
  scene.input.volume = file.string();
  scene.camera.size = size;
  FrameSettings settings{.size = size};
  const std::shared_ptr<const fvx::FvxFile> baked = scene.input.baked();
  const int opened = level.value_or(baked ? scene.needOf(*baked, 1).level : 0);
  const Scene view = scene.resolve(std::make_shared<const Volume>(scene.readVolume(maximumVoxels(device), opened)));
  settings.lighting = view.lighting;
  return Renderer(device, *view.volume, view.classification, {}).render(view.camera, settings);
}

/// What a render makes before its first frame if it reads the attenuation table.
void makeTableOf(const Device& device, const Volume& volume, const Classification& classification) {
  std::vector<StageTime> times;
  BuiltVolume built = buildVolume(device, volume, classification, times);
  if (!built.hasBlocks()) buildBlocks(device, volume, classification, built, times);
  const AttenuationTable table = makeTable(device, built.volume, {});
  AttenuationSweep sweep(device, {});
  Commands commands(device);
  sweep.record(commands, built.volume, table);
  commands.submitAndWait();
}

/// Drops the file from the operating system's cache. It must not be mapped.
void forget(const std::filesystem::path& file) {
  const int descriptor = open(file.c_str(), O_RDONLY);
  const bool done = descriptor >= 0 && fsync(descriptor) == 0 && posix_fadvise(descriptor, 0, 0, POSIX_FADV_DONTNEED) == 0;
  if (descriptor >= 0) close(descriptor);
  if (!done) fail(ErrorKind::Output, "'{}' cannot be dropped from the cache", file.string());
}

}  // namespace

std::vector<Result> baked(const Device& device, const std::string& input, int resolution, int runs) {
  const Folder folder;
  SceneDescription scene;
  scene.input.volume = input;
  std::string name = std::filesystem::path(input).stem().string();
  if (const auto procedural = proceduralName(input)) {
    name = fmt::format("{} {}^3", *procedural, resolution);
    const std::filesystem::path file = folder / "volume.vdb";
    writeVdb(file, ProceduralField(*procedural, glm::ivec3(resolution)), "density");
    scene.input.volume = file.string();
  }
  const Scene view = scene.resolve(std::make_shared<const Volume>(scene.readVolume(maximumVoxels(device))));
  const std::filesystem::path bakedFile = folder / "volume.fvx";
  const double bake = least(runs, [&] { return millisecondsOf([&] { bakeVolume(bakedFile, *view.volume, view.classification, {}); }); });
  const double table = least(runs, [&] { return millisecondsOf([&] { makeTableOf(device, *view.volume, view.classification); }); });
  const auto first = [&](const std::filesystem::path& file) {
    return least(runs, [&] { return millisecondsOf([&] { firstImage(device, file, glm::ivec2(1024)); }); });
  };
  const double vdb = first(scene.input.volume), fvx = first(bakedFile);
  return {{.name = fmt::format("{}, .vdb to first image", name), .milliseconds = vdb},
          {.name = fmt::format("{}, .fvx to first image: {:.2f} of .vdb", name, fvx / vdb), .milliseconds = fvx},
          {.name = fmt::format("{}, bake: {:.2f} of a render up to the table", name, bake / table), .milliseconds = bake}};
}

Result coldPreview(const Device& device, glm::ivec3 resolution, int runs) {
  const Folder folder;
  const ProceduralField field("cloud", resolution);
  const Volume sample = makeProcedural("cloud", glm::max(resolution / 4, 1));
  const Classification classification{.densityScale = automaticDensityScale(sample, 2.0)};
  const std::filesystem::path file = folder / "cloud.fvx";
  bakeStreamed(file, proceduralStream(field, sample, classification), classification, {});
  const double time = least(runs, [&] {
    forget(file);
    return millisecondsOf([&] { firstImage(device, file, glm::ivec2(512), 2); });
  });
  return {.name = fmt::format("cold preview of {} MiB", std::filesystem::file_size(file) >> 20), .milliseconds = time};
}

}  // namespace freevoxels::bench
