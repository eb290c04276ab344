#pragma once
// What a CubeDrawing keeps between frames, and the stages of a frame. Only cube_*.cpp include it.

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/cube_drawing.h"
#include "engine/cube_level.h"
#include "engine/gathering/gather_pass.h"

namespace freevoxels {

/// A cube with the voxels around it that are read with it.
inline VoxelRange withHalo(const VoxelRange& cube, glm::ivec3 dimensions) {
  return {glm::max(cube.first - CubeDrawing::kHalo, 0), glm::min(cube.end + CubeDrawing::kHalo, dimensions)};
}

struct CubeDrawing::State {
  const Device& device;
  std::shared_ptr<const VolumeSource> source;
  Classification classification;
  TableSettings table;
  std::map<int, CubeLevel> levels = {};
  std::optional<GatherPass> gather = {};
  Classification dark = {};  ///< `classification` without emission, which is drawn with the first group of lights
  std::optional<ScatteringSolver> scattering = {};
  TargetPool targetPool = {};
  std::vector<StageTime> times = {};
  std::vector<std::size_t> cubesRead = {};

  /// An image with the light of some of the lights.
  struct Frame {
    const Camera& camera;
    const FrameSettings& settings;
    const Classification& classification;
    std::span<const Light> allLights;
    std::size_t firstLight;  ///< of those of `settings` among all lights
    const ScatteringSolver* scattered;  ///< for the light of all groups; null without such light. Its light is drawn with the first one
    bool isFirst() const { return firstLight == 0; }
    const Progress& progress;
    shader::GatherFrame lattice;  ///< of the whole volume
    glm::ivec2 rows{0};           ///< first and end of the rows of samples that are drawn
  };

  const ScatteringSolver* solveScattering(const FrameSettings& wanted, const Progress& progress);
  CubeLevel& levelAt(int level) { return levels.try_emplace(level, source, level, classification).first->second; }
  /// An image is the sum of those of groups of lights.
  struct LightGroups {
    std::vector<Light> all;
    std::vector<FrameSettings> settings;  ///< of each group
  };
  LightGroups groupLights(const FrameSettings& wanted) const;
  Frame frameOfGroup(const Camera& camera, const LightGroups& groups, std::size_t group, const ScatteringSolver* scattered,
                     const Progress& progress);
  void begin(const Camera& camera, const FrameSettings& wanted);
  FixedSums emptySums(const Frame& frame, const FrameSettings& wanted);
  std::uint64_t mostBricks();
  std::uint64_t leastBytes(const Camera& camera, const FrameSettings& wanted);
  Error withNeed(const Error& error, const Camera& camera, const FrameSettings& wanted);
  void march(Frame& frame);
  shader::GatherFrame latticeOf(const Camera& camera, const FrameSettings& settings);
  shader::GatherFrame frameOf(const Frame& frame, const CubeLevel& cubeLevel, int level, const VoxelRange& region) const;
  /// What is drawn at a time.
  struct Cube {
    int level = 0;
    VoxelRange voxels;
    SampleRectangle seen;
  };
  std::vector<Cube> cubesOf(const Frame& frame, int level);
  void drawLevel(const Frame& frame, int level, std::span<const Cube> cubes, bool isLastLevel);
  void drawCube(const Frame& frame, const CubeLevel& cubeLevel, const shader::GatherFrame& inRegion, const VoxelRange& region,
                const Cube& cube, const Volume& volume, bool isLast);
  void resolve(const Frame& frame, const FrameTargets& targets);
};

}  // namespace freevoxels
