// Pipelines that are kept in a file.

#include "engine/vulkan/pipeline_cache.h"

#include <fstream>

#include "engine/image/display_pass.h"
#include "engine/vulkan/pipeline.h"
#include "tests/device/device_fixture.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

class PipelineCacheTest : public DeviceTest {
 protected:
  void write() const { PipelineCache(device().handle(), file_).save(); }
  std::size_t readBytes() const { return PipelineCache(device().handle(), file_).readBytes(); }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "sub" / "pipelines.bin";
};

TEST_F(PipelineCacheTest, IsReadAgainAsItWasWritten) {
  EXPECT_EQ(readBytes(), 0u) << "there is none";
  std::filesystem::remove_all(file_.parent_path());
  write();
  EXPECT_GE(readBytes(), 32u) << "Vulkan's own header at least";
  for (const auto& entry : std::filesystem::directory_iterator(file_.parent_path()))
    EXPECT_EQ(entry.path(), file_) << "no temporary file is left";
}

TEST_F(PipelineCacheTest, ADamagedFileIsNotUsedAndReplaced) {
  write();
  const std::size_t bytes = readBytes(), size = std::filesystem::file_size(file_);
  std::fstream(file_, std::ios::binary | std::ios::in | std::ios::out).seekp(-1, std::ios::end).put('x');
  {
    const PipelineCache damaged(device().handle(), file_);
    EXPECT_EQ(damaged.readBytes(), 0u);
    EXPECT_NE(damaged.handle(), VkPipelineCache(VK_NULL_HANDLE));
  }
  EXPECT_EQ(readBytes(), bytes);
  std::filesystem::resize_file(file_, size - 1);
  EXPECT_EQ(readBytes(), 0u);
  write();
  std::filesystem::resize_file(file_, 10);
  EXPECT_EQ(readBytes(), 0u);
}

TEST_F(PipelineCacheTest, AFolderThatCannotBeWrittenIsNoError) {
  std::ofstream(file_.parent_path()) << "a file in the folder's place";
  write();
  EXPECT_EQ(readBytes(), 0u);
}

TEST_F(PipelineCacheTest, WithoutAFileThereIsNone) {
  const PipelineCache none(device().handle(), {});
  EXPECT_EQ(none.handle(), VkPipelineCache(VK_NULL_HANDLE));
  EXPECT_NE(pipelineCacheName("a-b", 1), pipelineCacheName("a-b", 2));
}

}  // namespace
}  // namespace freevoxels
