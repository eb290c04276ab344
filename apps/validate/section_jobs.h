#pragma once
// What a validation run does: a list of jobs, each of which makes one section of the report.

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/validation/report.h"
#include "engine/vulkan/device.h"

namespace freevoxels::validate {

struct SectionJob {
  std::string name;  ///< for the progress line, and --only
  std::function<ReportSection()> run;
};

struct Extent {
  bool quick = false;             ///< small volumes and pictures
  std::optional<int> resolution;  ///< of the procedural volumes, in place of the usual ones
  std::optional<std::string> only;  ///< sections whose name contains this
  std::vector<std::string> files;
};

/// Closed forms; stages, invariances and levels of every procedural volume; the paper's figures, level of
/// detail, picture quality; and of every file its stages, invariances, levels and picture quality. The files
/// are read at once, so that one that cannot be fails before any work. Fails with ExitCode::Usage where `only` leaves none.
/// `device` has to outlive the jobs.
std::vector<SectionJob> planSections(const Device& device, const Extent& extent);

}  // namespace freevoxels::validate
