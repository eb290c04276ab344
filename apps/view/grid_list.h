#pragma once
// The grids of the file that is looked at, for the panels that choose among them.

#include <string>
#include <vector>

#include "apps/view/async_value.h"
#include "engine/volume/vdb.h"

namespace freevoxels {

class GridList {
 public:
  /// Of a volume's name; null while they are read. None of a procedural volume, and of a file that cannot be
  /// read, of which its picture says why.
  const std::vector<GridChoice>* of(const std::string& input) { return grids_.of(input); }

  bool isMaking() const { return grids_.isMaking(); }

 private:
  static std::vector<GridChoice> list(const std::string& input);

  AsyncValue<std::string, std::vector<GridChoice>> grids_{list};
};

}  // namespace freevoxels
