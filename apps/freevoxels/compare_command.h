#pragma once
// freevoxels compare A B

#include <optional>
#include <string>
#include <vector>

#include "apps/freevoxels/option_values.h"

namespace freevoxels {

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

}  // namespace freevoxels
