// freevoxels-validate: checks stage by stage whether this device draws what it should.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <optional>

#include "apps/common/device_options.h"
#include "apps/common/program.h"
#include "apps/common/progress_line.h"
#include "apps/validate/check_lines.h"
#include "apps/validate/section_jobs.h"
#include "engine/core/error.h"
#include "engine/description/scene_description.h"

namespace {

using namespace freevoxels;
using validate::SectionJob;

void print(const ReportSection& section) {
  for (const std::string& line : validate::checkLines(section)) fmt::print("{}\n", line);
  std::fflush(stdout);
}

Report runAll(const std::vector<SectionJob>& jobs) {
  ProgressLine line(true);
  Report report;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    line.begin(fmt::format("{} of {}: {}", i + 1, jobs.size(), jobs[i].name));
    report.sections.push_back(jobs[i].run());
    line.erase();
    print(report.sections.back());
  }
  return report;
}

/// Prints the last line and fails if a check failed.
void conclude(const Report& report, double seconds) {
  std::size_t checks = 0, failed = 0;
  const Check* first = nullptr;
  for (const ReportSection& section : report.sections) {
    checks += section.checks.size();
    failed += std::size_t(std::ranges::count_if(section.checks, [](const Check& c) { return !c.passed(); }));
    const auto bad = std::ranges::find_if(section.checks, [](const Check& c) { return !c.passed(); });
    if (first == nullptr && bad != section.checks.end()) first = &*bad;
  }
  fmt::print("{}: {} checks, {} failed, {:.0f} s on {}\n", failed == 0 ? "PASSED" : "FAILED", checks, failed,
             seconds, report.facts.at("device"));
  if (first != nullptr)
    fail(ErrorKind::Comparison, "{} of {} checks failed, the first: {}: {}", failed, checks, first->name,
         validate::figureAgainstBound(*first));
}

void validateOn(const Device& device, const validate::Extent& extent, const std::optional<std::string>& json) {
  const auto start = std::chrono::steady_clock::now();
  Report report = runAll(validate::planSections(device, extent));
  report.facts = {{"device", device.description().name},
                  {"driver", device.description().driver},
                  {"version", programVersion()},
                  {"extent", extent.quick ? "quick" : "whole"}};
  if (json) {
    const DeferredInterrupts wholeFile;
    writeJson(*json, report);
  }
  conclude(report, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Checks on one device that every stage computes what it should: against double precision on the CPU, against closed forms, "
      "and against invariances.",
      "freevoxels-validate");
  DeviceOptions device;
  validate::Extent extent;
  std::optional<std::string> json;
  app.add_option("FILE", extent.files, "OpenVDB files or baked volumes to check as well, the middle of those that are large");
  app.add_flag("--quick", extent.quick, "Small volumes and images");
  addWholeNumber(app, "--resolution", "N", extent.resolution, "Voxels along an edge of the procedural volumes",
                 {1.0, double(kMaxResolution)});
  addText(app, "--only", "TEXT", extent.only, "Only the sections whose name contains TEXT, such as 'light' or 'stages of cloud'");
  addText(app, "--json", "FILE.json", json, "Write figures and images as JSON, which draw_report.py draws as a page");
  device.add(app);
  app.footer("Exit codes: 0 all checks passed, 7 some failed, others like those of 'freevoxels'.");
  app.callback([&] {
    std::vector<std::string> files = extent.files;
    if (json) {
      checkOutput(*json);
      files.push_back(*json);
    }
    checkDistinct(files);
    device.withDevice([&](const Device& opened) { validateOn(opened, extent, json); });
  });
  return runProgram(app, argc, argv);
}
