#include "apps/common/sequence.h"

#include "apps/common/frame_names.h"

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
  touch({"smoke_10.vdb", "smoke_00011.vdb", "smoke_0003.vdb.tmp", "smoke_000a.vdb", "smoke_.vdb", "smoke_-01.vdb", "smoke_-0000.vdb",
         "other_0001.vdb", "smoke_0004.exr"});  // that are none
  const Sequence sequence = findSequence(path("smoke_####.vdb"));
  EXPECT_EQ(sequence.pattern, path("smoke_####.vdb"));
  EXPECT_EQ(sequence.files, paths({"smoke_0002.vdb", "smoke_0009.vdb", "smoke_0010.vdb", "smoke_12345.vdb"}));
}

TEST_F(SequenceTest, NumbersWithoutZerosGrow) {
  touch({"f1.vdb", "f10.vdb", "f9.vdb", "f02.vdb"});
  EXPECT_EQ(findSequence(path("f#.vdb")).files, paths({"f1.vdb", "f9.vdb", "f10.vdb"}));
}

TEST_F(SequenceTest, APatternWithoutFramesIsRefused) {
  expectRefusal([&] { findSequence(path("smoke_####.vdb")); }, ErrorKind::Input, {"smoke_####.vdb"});
  expectRefusal([&] { findSequence(path("none/a#.vdb")); }, ErrorKind::Input, {"none/a#.vdb"});
  expectRefusal([&] { findSequence(path("a#b#.vdb")); }, ErrorKind::Usage, {"a#b#.vdb"});
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
  EXPECT_TRUE(isPattern("#/x1.vdb")) << "a numbered folder";
}

TEST_F(SequenceTest, PrintfsPatternIsOneOfHashes) {
  EXPECT_EQ(withHashes("a/smoke_%04d.vdb"), "a/smoke_####.vdb");
  EXPECT_EQ(withHashes("%d.vdb"), "#.vdb");
  for (const char* none : {"100%.vdb", "%4d.vdb", "%x", "%05", "%00d", "%d/a_#.vdb", "smoke_####.vdb"}) EXPECT_EQ(withHashes(none), none);
  EXPECT_EQ(frameName("f_%03d.png", 7), "f_007.png");
  touch({"smoke_0002.vdb", "smoke_10.vdb"});
  EXPECT_TRUE(isPattern(path("smoke_%04d.vdb")));
  EXPECT_EQ(findSequence(path("smoke_%04d.vdb")).files, paths({"smoke_0002.vdb"}));
}

TEST_F(SequenceTest, RangesChooseFrames) {
  touch({"f1.vdb", "f2.vdb", "f4.vdb", "f9.vdb"});
  const Sequence all = findSequence(path("f#.vdb"));
  const auto numbers = [&](const std::string& text) {
    std::vector<int> chosen;
    for (const FrameNumber& number : selectFrames(all, readFrameRange("--frames", text)).numbers) chosen.push_back(int(number.value));
    return chosen;
  };
  EXPECT_EQ(numbers("0-100"), (std::vector<int>{1, 2, 4, 9}));
  EXPECT_EQ(numbers("2-4"), (std::vector<int>{2, 4}));
  EXPECT_EQ(numbers("2-"), (std::vector<int>{2, 4, 9}));
  EXPECT_EQ(numbers("1-9:2"), (std::vector<int>{1, 9}));
  EXPECT_EQ(numbers("4"), (std::vector<int>{4}));
  expectRefusal([&] { numbers("5-8"); }, ErrorKind::Input, {"f#.vdb", "from 1 to 9"});
  for (const char* bad : {"", "-", "4-2", "1--3", "1e3", "nan", "1-9:-1", "1 - 9", "1-9:0", "1-9:", "a", "1,2", "1-9:2:3", "99999999999"})
    expectRefusal([&] { readFrameRange("--frames", bad); }, ErrorKind::Usage, {"--frames"});
}

TEST_F(SequenceTest, FramesBeforeTheStartAreBelowZero) {
  touch({"s_-0012.vdb", "s_-0001.vdb", "s_-002.vdb", "s_0000.vdb", "s_0003.vdb"});
  const Sequence sequence = findSequence(path("s_####.vdb"));
  EXPECT_EQ(sequence.files, paths({"s_-0012.vdb", "s_-002.vdb", "s_-0001.vdb", "s_0000.vdb", "s_0003.vdb"}));
  EXPECT_EQ(selectFrames(sequence, readFrameRange("", "-2-0")).files, paths({"s_-002.vdb", "s_-0001.vdb", "s_0000.vdb"}));
  EXPECT_EQ(selectFrames(sequence, readFrameRange("", "-12--2")).files, paths({"s_-0012.vdb", "s_-002.vdb"}));
  EXPECT_EQ(frameName("out.####.png", sequence.numbers.front()), "out.-0012.png");
  EXPECT_EQ(sequenceAround(path("s_-0012.vdb")).value().pattern, path("s_####.vdb"));
  touch({"take-01.vdb", "take-02.vdb"});
  EXPECT_EQ(sequenceAround(path("take-02.vdb")).value().pattern, path("take-##.vdb")) << "a dash within a name is no sign";
}

TEST_F(SequenceTest, StepsBetweenFramesHaveFractions) {
  touch({"s.0001.vdb", "s.0001.5.vdb", "s.0002.vdb", "s.0010.25.vdb", "s.0002.5a.vdb"});
  const Sequence sequence = findSequence(path("s.####.vdb"));
  EXPECT_EQ(sequence.files, paths({"s.0001.vdb", "s.0001.5.vdb", "s.0002.vdb", "s.0010.25.vdb"}));
  EXPECT_EQ(frameName("o_##.png", sequence.numbers[1]), "o_01.5.png");
  EXPECT_EQ(selectFrames(sequence, readFrameRange("", "1-2")).files, paths({"s.0001.vdb", "s.0001.5.vdb", "s.0002.vdb"}));
  EXPECT_EQ(selectFrames(sequence, readFrameRange("", "1.5-")).files, paths({"s.0001.5.vdb", "s.0002.vdb", "s.0010.25.vdb"}));
  EXPECT_EQ(selectFrames(sequence, readFrameRange("", "1-20:1")).files, paths({"s.0001.vdb", "s.0002.vdb"}));
  EXPECT_EQ(gapsOf(sequence), "");
  EXPECT_EQ(sequenceAround(path("s.0001.5.vdb")).value().pattern, path("s.####.vdb"));
  touch({"v.2.0001.vdb", "v.2.0002.vdb", "v.1.0001.vdb", "v.1.0002.vdb", "v.1.0003.vdb"});
  EXPECT_EQ(sequenceAround(path("v.2.0001.vdb")).value().pattern, path("v.2.####.vdb")) << "a version, not a frame";
}

TEST_F(SequenceTest, FoldersMayHaveTheNumber) {
  for (const char* name : {"film_1/0001/smoke.vdb", "film_1/0003/smoke.vdb", "film_1/0002/other.vdb"}) {
    std::filesystem::create_directories((folder / name).parent_path());
    test::writeBytes(folder / name, "");
  }
  EXPECT_TRUE(isPattern(path("film_1/####/smoke.vdb")));
  const Sequence sequence = findSequence(path("film_1/####/smoke.vdb"));
  EXPECT_EQ(sequence.files, paths({"film_1/0001/smoke.vdb", "film_1/0003/smoke.vdb"}));
  EXPECT_EQ(findSequence(path("film_1/%04d/smoke.vdb")).files, sequence.files);
  EXPECT_EQ(frameName("out/##/a.png", sequence.numbers[1]), "out/03/a.png");
  EXPECT_EQ(frameName("a#/b#.png", 3), "a#/b3.png") << "a file's number goes before a folder's";
  EXPECT_EQ(sequenceAround(path("film_1/0003/smoke.vdb")).value().pattern, path("film_1/####/smoke.vdb"));
}

TEST_F(SequenceTest, GapsAreNamed) {
  const auto gaps = [](const std::vector<int>& all, const std::string& range = "") {
    const std::vector<FrameNumber> numbers(all.begin(), all.end());
    const Sequence sequence{.pattern = "", .files = {}, .numbers = numbers};
    return range.empty() ? gapsOf(sequence) : gapsOf(sequence, readFrameRange("", range));
  };
  EXPECT_EQ(gaps({1, 2, 3}), "");
  EXPECT_EQ(gaps({5}), "");
  EXPECT_EQ(gaps({1, 3, 4, 7, 8, 12}), "2, 5, 6, 9-11");
  EXPECT_EQ(gaps({0, 10, 30}), "20") << "every tenth frame is there";
  EXPECT_EQ(gaps({2, 4}, "1-6"), "1, 3, 5, 6");
  EXPECT_EQ(gaps({2, 4}, "2-9:2"), "6, 8");
  EXPECT_EQ(gaps({2, 3}, "2-"), "");
}

}  // namespace
}  // namespace freevoxels
