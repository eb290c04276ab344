#pragma once
// The results of a validation run: checks, tables, plots and images, in the order in which they are shown.

#include <filesystem>
#include <glm/glm.hpp>
#include <map>
#include <string>
#include <vector>

#include "engine/image/image.h"

namespace freevoxels {

/// A figure and its bound. A figure that is NaN never passes.
struct Check {
  enum class Bound { AtMost, AtLeast };

  std::string name;
  double figure = 0.0;
  Bound bound = Bound::AtMost;
  double tolerance = 0.0;
  std::string unit;   ///< "codes", "dB", ...; may be empty
  std::string where;  ///< place of the worst figure: a voxel, a pixel, a view; may be empty

  bool passed() const { return bound == Bound::AtMost ? figure <= tolerance : figure >= tolerance; }
};

struct ReportTable {
  std::string caption;
  std::vector<std::string> columns;            ///< the first column has the names of the rows
  std::vector<std::vector<std::string>> rows;  ///< each with as many cells as there are columns
};

struct ReportPlot {
  struct Series {
    std::string name;
    std::vector<glm::dvec2> points;  ///< x ascending; the line is interrupted at points that are not finite
  };
  std::string caption, xLabel, yLabel;
  std::vector<Series> series;
};

/// Images side by side, over `background` (linear).
struct ImageRow {
  struct Captioned {
    std::string caption;
    Image image;
  };
  std::string caption;
  std::vector<Captioned> images;
  glm::vec3 background{0.0f};
};

struct ReportSection {
  std::string title;
  std::string text;  ///< plain text, may be empty
  std::vector<Check> checks;
  std::vector<ReportTable> tables;
  std::vector<ReportPlot> plots;
  std::vector<ImageRow> imageRows;

  std::size_t failures() const;
  bool passed() const { return failures() == 0; }
};

struct Report {
  std::map<std::string, std::string> facts;  ///< device, driver, version, settings, ...
  std::vector<ReportSection> sections;

  std::size_t checkCount() const;
  std::size_t failures() const;
  bool passed() const { return failures() == 0; }
};

/// Writes everything; images as PNG in base64. Numbers are read back as the same doubles; those without a JSON form are the strings "NaN",
/// "Infinity" and "-Infinity". Atomic. Fails with ErrorKind::Output. apps/validate/draw_report.py draws the file as a page or a plot.
void writeJson(const std::filesystem::path& file, const Report& report);

}  // namespace freevoxels
