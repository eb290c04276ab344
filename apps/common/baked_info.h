#pragma once
// What freevoxels info says of a baked volume.

#include <nlohmann/json_fwd.hpp>

#include "engine/storage/fvx_file.h"

namespace freevoxels {

void printBaked(const fvx::FvxFile& file);
nlohmann::ordered_json bakedJson(const fvx::FvxFile& file);

}  // namespace freevoxels
