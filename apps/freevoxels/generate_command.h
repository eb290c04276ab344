#pragma once
// freevoxels generate NAME OUT.vdb

#include "apps/freevoxels/option_values.h"
#include "apps/freevoxels/program.h"

namespace freevoxels {

class GenerateCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  std::string name_, file_;
  std::optional<glm::ivec3> resolution_;
  bool list_ = false;
  MessageOptions messages_;
};

}  // namespace freevoxels
