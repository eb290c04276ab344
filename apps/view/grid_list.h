#pragma once
// The grids of the current file, for the panels that choose among them.

#include <string>
#include <vector>

#include "apps/view/async_value.h"
#include "engine/volume/vdb.h"

namespace freevoxels {

class GridList {
 public:
  /// The grids of a volume by its name, or null while they are read. None for a procedural volume, and for a
  /// file that cannot be read, for which the image reports the reason.
  const std::vector<GridChoice>* of(const std::string& input) { return grids_.of(input); }

  bool isMaking() const { return grids_.isMaking(); }

 private:
  static std::vector<GridChoice> list(const std::string& input);

  AsyncValue<std::string, std::vector<GridChoice>> grids_{list};
};

}  // namespace freevoxels
