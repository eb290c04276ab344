#pragma once
// Files that are baked, changed and read in every way.

#include <gtest/gtest.h>

#include "engine/storage/baked_source.h"
#include "engine/storage/baked_volume.h"
#include "tests/not_finite.h"
#include "tests/refusal.h"
#include "tests/storage/baked_fixture.h"
#include "tests/storage/fvx_editor.h"

namespace freevoxels::test {

inline constexpr auto kFloatNan = float(kNan), kFloatInfinity = float(kInfinity);

/// Ends inside of bricks and chunks along every axis, with one level, with two and with three.
inline constexpr glm::ivec3 kBakedSizes[]{{1, 1, 1}, {9, 31, 8}, {38, 26, 31}, {33, 65, 9}, {70, 41, 37}, {7, 34, 67}};

inline constexpr BakeSettings kBakeSettings[]{{}, {.compress = true}, {.keepScalars = true}, {.keepScalars = true, .compress = true}};

/// Densities in every voxel, from 0.1 to 0.59.
inline Volume denseVolume(glm::ivec3 size) {
  return makeVolume(size, glm::dmat4(glm::dmat3(0.25)), [](int x, int y, int z) { return 0.1 + 0.01 * ((x + 2 * y + 3 * z) % 50); });
}

class EditedFvx : public testing::Test {
 protected:
  void bake(const Volume& volume, const BakeSettings& settings = {}, const Classification& classification = {.densityScale = 0.7}) {
    bakeVolume(file_, volume, classification, settings);
    bytes_ = readBytes(file_);
  }
  static void readInBoxes(const std::shared_ptr<const fvx::FvxFile>& file, int level) {
    BakedSource(file).read(level, {.first = glm::ivec3(0), .end = file->dimensions(level)});
  }
  /// Everything that is read of a file anywhere.
  void readAll() const {
    const auto file = std::make_shared<const fvx::FvxFile>(file_);
    for (int level = 0; level < file->levels(); ++level) {
      readBaked(file, level);
      readInBoxes(file, level);
    }
    file->checkAll();
  }
  /// Refused before anything but the description and the indices is read.
  void expectRefused(FvxEditor& edited, const std::string& what = "a.fvx") const {
    edited.save(file_);
    expectRefusal([&] { fvx::FvxFile file(file_); }, ErrorKind::Input, {"a.fvx", what});
  }
  template <typename Change>
  void expectChunkRefused(const Change& change, const std::string& what, fvx::Channel channel = fvx::Channel::Scalars, int level = 0) const {
    FvxEditor edited(bytes_);
    for (std::size_t i = 0; i < edited.chunks(level, channel).size(); ++i) {
      FvxEditor one(bytes_);
      change(one.chunks(level, channel)[i]);
      SCOPED_TRACE(i);
      expectRefused(one, what);
    }
  }
  /// Sound when it is opened; refused by whatever reads values.
  void expectValuesRefused(FvxEditor& edited, int level, const std::string& what) const {
    edited.save(file_);
    const auto file = std::make_shared<const fvx::FvxFile>(file_);
    expectRefusal([&] { readBaked(file, level); }, ErrorKind::Input, {"a.fvx", what});
    expectRefusal([&] { readInBoxes(file, level); }, ErrorKind::Input, {"a.fvx", what});
    expectRefusal([&] { file->checkAll(); }, ErrorKind::Input, {"a.fvx", what});
  }

  const TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "a.fvx";
  std::string bytes_;
};

}  // namespace freevoxels::test
