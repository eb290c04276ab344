#pragma once
// What the C++ library and the Python module do beside drawing, with keywords in JSON (KeywordOptions).

#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "apps/common/bake.h"
#include "apps/common/convert.h"
#include "apps/common/shared_volume.h"

namespace freevoxels {

/// Bakes the volume of a file, or procedural:NAME, as `freevoxels bake` does; an empty name is that of the scene. `keywords` are those of
/// its options: of the volume, "keep-scalars" and "compress", and of the sections "classification" and "emission".
void bakeFile(const std::string& volume, const std::string& file, const nlohmann::json& keywords, const BakeRemarks& remarks,
              const Progress& progress);
/// Bakes a volume that is open, of a baked file its finest level.
void bakeShared(const SharedVolume& volume, const std::string& file, const nlohmann::json& keywords, const Progress& progress);

/// As `freevoxels convert`. `keywords` are those of the section "input".
void convertFile(const std::string& volume, const std::string& file, const nlohmann::json& keywords, const ConvertRemarks& remarks,
                 const Progress& progress);

/// What `freevoxels info --json` says of a volume. `keywords` are those of the section "input", and "check".
nlohmann::ordered_json infoOf(const std::string& volume, const nlohmann::json& keywords);

/// As `freevoxels merge`. `keywords` are options of the section "output".
void mergeFiles(std::span<const std::string> parts, std::span<const std::string> images, const nlohmann::json& keywords);

}  // namespace freevoxels
