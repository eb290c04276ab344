#include "apps/freevoxels/sequence.h"

#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::expectRefusal;

class SequenceTest : public testing::Test {
 protected:
  void touch(std::initializer_list<const char*> names) const {
    for (const char* name : names) test::writeBytes(folder / name, "");
  }
  std::string path(const std::string& name) const { return (folder / name).string(); }
  std::vector<std::string> paths(std::initializer_list<const char*> names) const {
    std::vector<std::string> all;
    for (const char* name : names) all.push_back(path(name));
    return all;
  }
  const test::TemporaryFolder folder;
};

TEST_F(SequenceTest, HasTheFramesThatAreThereInTheirOrder) {
  touch({"smoke_0010.vdb", "smoke_0002.vdb", "smoke_0009.vdb", "smoke_12345.vdb"});
  touch({"smoke_10.vdb", "smoke_00011.vdb", "smoke_0003.vdb.tmp", "smoke_000a.vdb", "smoke_.vdb",
         "smoke_-001.vdb", "other_0001.vdb", "smoke_0004.exr"});  // that are none
  const Sequence sequence = findSequence(path("smoke_####.vdb"));
  EXPECT_EQ(sequence.pattern, path("smoke_####.vdb"));
  EXPECT_EQ(sequence.files, paths({"smoke_0002.vdb", "smoke_0009.vdb", "smoke_0010.vdb", "smoke_12345.vdb"}));
}

TEST_F(SequenceTest, NumbersWithoutZerosGrow) {
  touch({"f1.vdb", "f10.vdb", "f9.vdb", "f02.vdb"});
  EXPECT_EQ(findSequence(path("f#.vdb")).files, paths({"f1.vdb", "f9.vdb", "f10.vdb"}));
}

TEST_F(SequenceTest, APatternWithoutFramesIsRefused) {
  expectRefusal([&] { findSequence(path("smoke_####.vdb")); }, ExitCode::Input, {"smoke_####.vdb"});
  expectRefusal([&] { findSequence(path("none/a#.vdb")); }, ExitCode::Input, {"none/a#.vdb"});
  expectRefusal([&] { findSequence(path("a#b#.vdb")); }, ExitCode::Usage, {"a#b#.vdb"});
}

TEST_F(SequenceTest, AFileIsAFrameAmongOthers) {
  touch({"smoke_0007.vdb", "smoke_0008.vdb", "smoke_8.vdb"});
  const auto sequence = sequenceAround(path("smoke_0007.vdb"));
  ASSERT_TRUE(sequence);
  EXPECT_EQ(sequence->pattern, path("smoke_####.vdb"));
  EXPECT_EQ(sequence->files, paths({"smoke_0007.vdb", "smoke_0008.vdb"}));
}

TEST_F(SequenceTest, TheWidthOfNumbersIsWhatMakesMostFrames) {
  touch({"f8.vdb", "f9.vdb", "f10.vdb", "g08.vdb", "g10.vdb"});
  EXPECT_EQ(sequenceAround(path("f10.vdb")).value().pattern, path("f#.vdb"));
  EXPECT_EQ(sequenceAround(path("g10.vdb")).value().pattern, path("g##.vdb"));
}

TEST_F(SequenceTest, SomeFilesAreAlone) {
  touch({"cloud.vdb", "smoke_01.vdb", "x#1.vdb", "x#2.vdb"});
  for (const char* name : {"cloud.vdb", "smoke_01.vdb", "x#1.vdb", "none_1.vdb"})
    EXPECT_FALSE(sequenceAround(path(name))) << name;
  touch({"99999999999999999999.vdb"});
  EXPECT_FALSE(sequenceAround(path("99999999999999999999.vdb")));
}

TEST_F(SequenceTest, AFilesOwnNameIsNoPattern) {
  touch({"x#1.vdb"});
  EXPECT_FALSE(isPattern(path("x#1.vdb")));
  EXPECT_TRUE(isPattern(path("x#2.vdb")));
  EXPECT_FALSE(isPattern(path("x1.vdb")));
  EXPECT_FALSE(isPattern("#/x1.vdb")) << "the folder's name";
}

}  // namespace
}  // namespace freevoxels
