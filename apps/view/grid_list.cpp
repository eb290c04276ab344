#include "apps/view/grid_list.h"

#include "apps/freevoxels/input_options.h"
#include "engine/core/error.h"

namespace freevoxels {

std::vector<GridChoice> GridList::list(const std::string& input) {
  if (proceduralName(input)) return {};
  try {
    return listVdb(input);
  } catch (const Error&) {
    return {};
  }
}

}  // namespace freevoxels
