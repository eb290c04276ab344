#pragma once
// freevoxels info IN

#include "apps/freevoxels/input_options.h"

namespace freevoxels {

class InfoCommand {
 public:
  void add(CLI::App& app);

 private:
  void run() const;

  InputOptions input_;
  bool json_ = false;
};

}  // namespace freevoxels
