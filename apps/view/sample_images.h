#pragma once
// Small images of the procedural volumes, which are in the program. They were drawn by
// freevoxels render procedural:NAME NAME.png --size 96x72

#include <span>
#include <string_view>

namespace freevoxels {

/// The bytes of a PNG of SessionStore::kThumbnailSize that shows a procedural volume (procedural.h) as the viewer opens it; none where
/// there is no image of this name.
std::span<const unsigned char> sampleImage(std::string_view name);

}  // namespace freevoxels
