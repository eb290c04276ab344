#pragma once
// Compute and graphics pipelines over embedded SPIR-V, with push descriptors and push constants.

#include <array>
#include <compare>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

#include "engine/core/stages.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/owned.h"
#include "engine/vulkan/pipeline_cache.h"
#include "engine/vulkan/shader.h"

namespace freevoxels {

/// The bindings of set 0, by number, and the bytes of the push constants: those of all stages.
struct PipelineInterface {
  std::vector<VkDescriptorType> bindings;
  std::uint32_t pushConstantBytes = 0;
};

/// Values of the specialisation constants 0, 1, 2, ...: ints or bools.
using Specialisation = std::vector<std::uint32_t>;

/// How a fragment is blended into an attachment.
enum class Blend {
  Replace,   ///< source
  Additive,  ///< source + destination
  Over,      ///< source + (1 - alpha of the fragment's output for this attachment) * destination
};

/// What is known of a pipeline before it is compiled.
struct PipelineLayout {
  PipelineInterface interface;
  VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
  glm::ivec3 workgroup{1};  ///< compute only
  OwnedSetLayout set;
  OwnedPipelineLayout layout;
};

/// A pipeline of a device. A thread of the store compiles it, or the thread that needs it first.
struct StoredPipeline {
  enum class State { Wanted, Compiling, Compiled };

  PipelineLayout layout;
  std::function<OwnedPipeline()> compile;
  State state = State::Wanted;
  OwnedPipeline pipeline;
};

class PipelineStore;

/// A reference to a pipeline of a device, valid as long as the device.
class Pipeline {
 public:
  Pipeline() = default;
  Pipeline(PipelineStore& store, StoredPipeline& stored) : store_(&store), stored_(&stored) {}

  bool exists() const { return stored_ != nullptr; }
  /// Compiles the pipeline, or waits until it is compiled, and throws what that throws.
  VkPipeline handle() const;
  VkPipelineLayout layout() const { return stored_->layout.layout.get(); }
  VkPipelineBindPoint bindPoint() const { return stored_->layout.bindPoint; }
  /// The stages that access the descriptors and the push constants.
  VkShaderStageFlags stages() const;
  const PipelineInterface& interface() const { return stored_->layout.interface; }
  /// Invocations of one workgroup; compute only.
  glm::ivec3 workgroup() const { return stored_->layout.workgroup; }

 private:
  PipelineStore* store_ = nullptr;
  StoredPipeline* stored_ = nullptr;
};

/// Everything that distinguishes pipelines. The interface is part of the code.
struct PipelineKey {
  std::array<const std::uint32_t*, 2> code{};  ///< compute, or vertex and fragment
  Specialisation constants;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  std::vector<VkFormat> attachments;
  Blend blend = Blend::Additive;
  auto operator<=>(const PipelineKey&) const = default;
};

/// The pipelines of a device, kept for reuse: lavapipe takes up to a tenth of a second to compile one. Threads of the store
/// compile them from when they are first asked for, while the caller goes on until it needs one. Any thread may call the member
/// functions.
class PipelineStore {
 public:
  using Compiler = std::function<OwnedPipeline(VkPipelineCache, VkPipelineLayout)>;

  /// `cacheFile` is the file of PipelineCache.
  PipelineStore(VkDevice device, const std::filesystem::path& cacheFile) : cache_(device, cacheFile) {}
  /// Waits for what is being compiled.
  ~PipelineStore();

  /// Returns the pipeline for `key`. If there is none, makes its layout now and has it compiled.
  Pipeline get(const PipelineKey& key, const std::function<PipelineLayout()>& makeLayout, const Compiler& compile);
  /// Compiles `stored` unless it is compiled; waits for a thread that does. Throws what compiling throws, and may be called again then.
  void compile(StoredPipeline& stored);
  /// Ends the threads that compile ahead, once they have compiled what they are at. From then on pipelines are compiled when they are bound.
  /// For processes that end while the device is open.
  void stopCompilingAhead();
  PipelineCache& cache() { return cache_; }
  /// Time to compile the pipelines, summed over all threads: it overlaps that of other stages.
  std::vector<StageTime> times() const;

 private:
  void addThread();
  void compileAhead();

  PipelineCache cache_;
  mutable std::mutex mutex_;  ///< of what follows
  std::condition_variable changed_;
  std::map<PipelineKey, StoredPipeline> pipelines_;  ///< whose addresses do not change
  std::deque<StoredPipeline*> wanted_;
  std::vector<StageTime> times_;
  bool closing_ = false;
  std::size_t idle_ = 0;              ///< threads that wait for work
  std::vector<std::thread> threads_;  ///< that compile what is wanted
};

// Pipelines are compiled by another thread, or when they are first bound, which throws the error of a compilation that fails. The shaders
// must outlive the device.

Pipeline makeComputePipeline(const Device& device, const Shader& shader, const Specialisation& constants = {});

/// Returns a graphics pipeline without vertex input (shaders fetch vertices from buffers), depth test or face
/// culling. All attachments use the same blending. Viewport and scissor are dynamic.
Pipeline makeGraphicsPipeline(const Device& device, const Shader& vertex, const Shader& fragment, VkPrimitiveTopology topology,
                              std::span<const VkFormat> attachments, Blend blend, const Specialisation& constants = {});

}  // namespace freevoxels
