#include "engine/vulkan/pipeline_cache.h"

#include <fmt/format.h>

#include <array>
#include <cstring>
#include <fstream>
#include <iterator>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// What the file begins with. Drivers check who wrote the bytes behind it, but not all of them whether these are whole.
struct Header {
  std::array<char, 8> magic{'F', 'V', 'P', 'I', 'P', 'E', 'S', '1'};
  std::uint64_t bytes = 0, checksum = 0;
};

/// FNV-1a.
std::uint64_t checksumOf(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3u;
  return hash;
}

/// Empty unless the file is whole.
std::vector<std::uint8_t> readCache(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Header header, expected;
  if (!stream.read(reinterpret_cast<char*>(&header), sizeof(header)) || header.magic != expected.magic) return {};
  std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(stream), {}};
  if (bytes.size() != header.bytes || checksumOf(bytes) != header.checksum) return {};
  return bytes;
}

}  // namespace

PipelineCache::PipelineCache(VkDevice device, std::filesystem::path file) : device_(device), file_(std::move(file)) {
  if (file_.empty()) return;
  saved_ = readCache(file_);
  const VkPipelineCacheCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO,
                                       .initialDataSize = saved_.size(),
                                       .pInitialData = saved_.data()};
  VkPipelineCache cache = VK_NULL_HANDLE;
  VK_CHECK(vkCreatePipelineCache(device, &info, nullptr, &cache));
  cache_ = OwnedPipelineCache(device, cache);
}

PipelineCache::~PipelineCache() {
  try {
    save();
  } catch (...) {  // it is compiled again the next time
  }
}

void PipelineCache::save() {
  if (file_.empty()) return;
  std::size_t size = 0;
  if (vkGetPipelineCacheData(device_, cache_.get(), &size, nullptr) != VK_SUCCESS) return;
  std::vector<std::uint8_t> bytes(size);
  if (vkGetPipelineCacheData(device_, cache_.get(), &size, bytes.data()) != VK_SUCCESS) return;
  bytes.resize(size);
  if (bytes == saved_) return;
  saved_ = std::move(bytes);
  const Header header{.bytes = saved_.size(), .checksum = checksumOf(saved_)};
  std::string text(sizeof(header) + saved_.size(), '\0');
  std::memcpy(text.data(), &header, sizeof(header));
  std::memcpy(text.data() + sizeof(header), saved_.data(), saved_.size());
  std::error_code error;
  std::filesystem::create_directories(file_.parent_path(), error);
  try {
    writeTextAtomically(file_, text);
  } catch (const Error&) {
  }
}

std::string pipelineCacheName(const std::string& deviceUuid, std::uint32_t driverVersion) {
  return fmt::format("pipelines_{}_{:08x}.bin", deviceUuid, driverVersion);
}

}  // namespace freevoxels
