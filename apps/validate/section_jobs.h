#pragma once
// The jobs of a validation run, each of which makes one section of the report.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels::validate {

struct SectionJob {
  std::string name;  ///< name in the progress line and for --only
  std::function<ReportSection()> run;
};

struct Extent {
  bool quick = false;             ///< small volumes and images
  std::optional<int> resolution;  ///< of the procedural volumes, instead of the default ones
  std::optional<std::string> only;  ///< only sections whose name contains this
  std::vector<std::string> files;
};

/// Plans the jobs: closed forms; stages, invariances and levels of every procedural volume; the paper's
/// figures, level of detail, image quality; and stages, invariances, levels and image quality of every file.
/// All files are read at once, so that one that cannot be read fails before any work. Fails with
/// ErrorKind::Usage if `only` leaves no section. `device` must outlive the jobs.
std::vector<SectionJob> planSections(const Device& device, const Extent& extent);

}  // namespace freevoxels::validate
