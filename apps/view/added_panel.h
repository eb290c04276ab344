#pragma once
// The list of the volumes besides the first one, in the panel "Volume".

#include <cstddef>
#include <string>
#include <vector>

#include "apps/view/eye_list.h"
#include "apps/view/view_state.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

class AddedPanel {
 public:
  void draw(ViewState& state);

 private:
  void follow(const ViewState& state);
  void drawEntry(ViewState& state, std::size_t index, bool& isRemoved);
  void drawAdding(ViewState& state);

  std::vector<WithEye<AddedVolume>> entries_;
  std::string typed_;  ///< the volume to add
};

}  // namespace freevoxels
