#pragma once
// A VkPipelineCache that is kept in a file between processes.

#include <volk.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/vulkan/owned.h"

namespace freevoxels {

/// Compiled pipelines of one device and driver version. A file that is missing, damaged or of another driver is the same as
/// an empty one, and nothing is said about a file that cannot be written: pipelines are compiled again then.
class PipelineCache {
 public:
  /// Reads the file. An empty path stands for no cache: handle() is null.
  PipelineCache(VkDevice device, std::filesystem::path file);
  /// Calls save().
  ~PipelineCache();
  PipelineCache(const PipelineCache&) = delete;
  PipelineCache& operator=(const PipelineCache&) = delete;

  VkPipelineCache handle() const { return cache_.get(); }
  /// Bytes that the file held for Vulkan; 0 where it was not used.
  std::size_t readBytes() const { return saved_.size(); }
  /// Replaces the file, by a rename, if the cache has changed since it was read or saved.
  void save();

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  std::filesystem::path file_;
  std::vector<std::uint8_t> saved_;  ///< Vulkan's bytes in the file
  OwnedPipelineCache cache_;
};

/// The name of the file for a device: its UUID, as text, and its driver's version.
std::string pipelineCacheName(const std::string& deviceUuid, std::uint32_t driverVersion);

}  // namespace freevoxels
