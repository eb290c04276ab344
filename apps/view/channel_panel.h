#pragma once
// The list of the channels of a volume (engine/volume/channels.h), in the panel "Volume".

#include <cstddef>
#include <string>
#include <vector>

#include "apps/view/eye_list.h"
#include "apps/view/view_state.h"
#include "engine/volume/channels.h"

namespace freevoxels {

class ChannelPanel {
 public:
  /// Draws nothing for a volume without channels, unless its file has several `grids`, of which they may be chosen.
  void draw(ViewState& state, std::size_t grids);

 private:
  void follow(const ViewState& state);
  bool drawEntry(ViewState& state, std::size_t index, bool& isRemoved);
  bool drawAdding(ViewState& state);

  std::vector<WithEye<ChannelStyle>> entries_;
  std::string volume_;               ///< that they are of
  std::vector<ChannelStyle> given_;  ///< those of the scene when they were taken from it
  std::string typed_;                ///< the channel to add
};

}  // namespace freevoxels
