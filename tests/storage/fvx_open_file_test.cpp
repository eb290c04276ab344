// Files that change while they are open.

#include "tests/storage/edited_fvx.h"

namespace freevoxels {
namespace {

using fvx::FvxFile;

class FvxOpenFile : public test::EditedFvx {};

/// What other programs do to a file that is open: the reader says so, and lives.
TEST_F(FvxOpenFile, AFileThatIsCutOrOverwrittenWhileItIsOpenIsAnErrorAndNoSignal) {
  const std::string sentence = "was overwritten or cut while it was in use";
  for (const BakeSettings& settings : test::kBakeSettings)
    for (const double part : {0.0, 0.1, 0.5, 0.8}) {
      bake(test::denseVolume({70, 41, 37}), settings);
      const auto file = std::make_shared<const FvxFile>(file_);
      const Volume before = readBaked(file);
      const float scalar = before.scalar(69, 40, 36);
      std::filesystem::resize_file(file_, std::uint64_t(part * double(bytes_.size())));
      EXPECT_EQ(before.scalar(69, 40, 36), scalar);  // what was read is still there
      test::expectRefusal([&] { file->checkAll(); }, ErrorKind::Input, {"a.fvx", sentence});
      int refused = 0;
      for (int level = 0; level < file->levels(); ++level) try {
          readBaked(file, level);  // of a part of the file that may be there
        } catch (const Error& error) {
          EXPECT_NE(std::string(error.what()).find(sentence), std::string::npos) << error.what();
          ++refused;
        }
      EXPECT_GE(refused, part == 0.0 ? file->levels() : part < 0.7 ? 1 : 0);
      for (const char byte : {'x', '\0'}) {
        test::writeBytes(file_, std::string(bytes_.size(), byte));
        test::expectRefusal([&] { readBaked(file); }, ErrorKind::Input, {"a.fvx", sentence});
        test::expectRefusal([&] { readInBoxes(file, 0); }, ErrorKind::Input, {"a.fvx", sentence});
      }
    }
}

TEST_F(FvxOpenFile, AFileWhoseNameIsTakenByAnotherIsReadToItsEnd) {
  bake(test::denseVolume({70, 41, 37}));
  const auto file = std::make_shared<const FvxFile>(file_);
  const Volume before = readBaked(file);
  bake(test::smoothVolume({9, 9, 9}));
  test::expectSameVoxels(readBaked(file).scalars, before.scalars);
  std::filesystem::remove(file_);
  test::expectSameVoxels(readBaked(file).scalars, before.scalars);
}

}  // namespace
}  // namespace freevoxels
