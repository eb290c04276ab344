#pragma once
// How all frames of a film are seen where the options leave that open: as the film has it, not one of its frames.

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "engine/description/scene_description.h"

namespace freevoxels {

struct FilmView {
  Scene scene;            ///< its volume has no voxels
  std::string largest;    ///< the frame with most mass, whose optical depth is that of a single volume
  std::string brightest;  ///< the frame with most power; empty if nothing shines
};

/// The camera shows what is seen of all frames: of those that are read, and of the others the boxes that the headers of the files tell. Fog
/// or scan, scale of densities and up direction are those of the frame with most mass, the scales of temperature and emission those of
/// the frames that are hottest and radiate most, among at most kMaxFramesRead, which are read: the largest, and others at equal
/// distances. Nothing where no frame can be drawn. `progress` may abandon it.
std::optional<FilmView> viewOfFilm(const SceneDescription& description, std::span<const std::string> inputs, std::uint64_t maximumVoxels,
                                   const Progress& progress = {});
inline constexpr std::size_t kMaxFramesRead = 12;

}  // namespace freevoxels
