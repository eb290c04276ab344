#pragma once
// The commands that the program `freevoxels` has alone; render, turntable and bake are also those of freevoxels-mpi (apps/common).

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/common/option_values.h"
#include "apps/common/program.h"
#include "apps/common/scene_options.h"

namespace freevoxels {

/// freevoxels compare A B
class CompareCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  std::string test_, reference_;
  std::optional<std::string> difference_;
  std::vector<std::string> limits_;
  std::optional<glm::dvec3> background_;
  std::optional<double> pixelsPerDegree_;
  std::optional<glm::dvec2> exposures_;
  bool json_ = false;
};

/// freevoxels convert IN OUT
class ConvertCommand {
 public:
  void add(CLI::App& app);

 private:
  void run();

  SceneOptions scene_;  ///< the volume
  std::string file_;
  MessageOptions messages_;
};

/// freevoxels convert-tf IN OUT.json
class ConvertFunctionCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  std::string function_, file_;
  MessageOptions messages_;
};

/// freevoxels devices
class DevicesCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  bool json_ = false;
};

/// freevoxels generate NAME OUT.vdb
class GenerateCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  std::string name_, file_;
  SceneOptions scene_;  ///< the resolution
  bool list_ = false;
  MessageOptions messages_;
};

/// freevoxels info IN
class InfoCommand {
 public:
  void add(CLI::App& app);

 private:
  void run();

  SceneOptions scene_;  ///< the volume
  bool json_ = false, check_ = false;
};

/// freevoxels merge PART.exr... OUT...
class MergeCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  std::vector<std::string> files_;  ///< parts, then images to write
  SceneOptions scene_;              ///< the form of the images
  MessageOptions messages_;
};

/// freevoxels oracle IN OUT...
class OracleCommand {
 public:
  void add(CLI::App& app);

 private:
  void run();
  void draw() const;
  /// The number of voxels that fit into memory beside the image; fails with ErrorKind::OutOfMemory if none do.
  std::uint64_t voxelsThatFit() const;

  SceneOptions scene_;
  MessageOptions messages_;
};

/// freevoxels presets
class PresetsCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  std::string name_;
  bool json_ = false;
};

}  // namespace freevoxels
