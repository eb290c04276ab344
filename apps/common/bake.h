#pragma once
// Baking of a scene's volume: in memory, or part by part where it is too large for that.

#include <functional>
#include <string>

#include "apps/common/share_group.h"
#include "engine/description/scene_description.h"
#include "engine/storage/baked_volume.h"

namespace freevoxels {

struct BakeRequest {
  SceneDescription scene;  ///< the volume, its resolution and grid, its classification and emission; the rest stays as it is
  std::string file;        ///< to write, named .fvx
  bool keepScalars = false, compress = false;
  ShareGroup* group = nullptr;  ///< the processes that bake together, or null; lives longer
};

/// Told what is baked before the file is written, by the thread that bakes. The volume may be a sample of a larger one.
using BakeRemarks = std::function<void(const Scene& scene)>;

/// Fails where it can be refused before any work, also for a file that cannot be written, unless another process of the group writes it.
void checkBake(const BakeRequest& request);

/// Reads and bakes the volume; processes of a group write the same bytes as one alone. `progress` may abandon it.
/// Fails as readVolume and bakeVolume do, and for a volume that was baked for one classification.
void bakeScene(const BakeRequest& request, const BakeRemarks& remarks, const Progress& progress);

/// Bakes a volume in memory that is of no file. `request.scene` names none.
void bakeInMemory(const BakeRequest& request, const Volume& volume, const Progress& progress);

}  // namespace freevoxels
