#pragma once
// freevoxels merge PART.exr... OUT...

#include <string>
#include <vector>

#include "apps/freevoxels/output_options.h"
#include "apps/freevoxels/program.h"

namespace freevoxels {

class MergeCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  std::vector<std::string> files_;  ///< parts, then pictures to write
  OutputOptions output_;
  MessageOptions messages_;
};

}  // namespace freevoxels
