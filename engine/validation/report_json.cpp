#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/atomic_file.h"
#include "engine/validation/base64.h"
#include "engine/validation/report.h"

namespace freevoxels {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0.0 ? "Infinity" : "-Infinity";
  return value;
}

Json jsonOf(const Check& check) {
  return {{"name", check.name},
          {"passed", check.passed()},
          {"figure", number(check.figure)},
          {"bound", check.bound == Check::Bound::AtMost ? "at most" : "at least"},
          {"tolerance", number(check.tolerance)},
          {"unit", check.unit},
          {"where", check.where}};
}

Json jsonOf(const ReportTable& table) {
  return {{"caption", table.caption}, {"columns", table.columns}, {"rows", table.rows}};
}

Json jsonOf(const ReportPlot::Series& series) {
  Json points = Json::array();
  for (const glm::dvec2& point : series.points)
    points.push_back(Json::array({number(point.x), number(point.y)}));
  return {{"name", series.name}, {"points", std::move(points)}};
}

template <typename T>
Json listOf(const std::vector<T>& items);

Json jsonOf(const ReportPlot& plot) {
  return {{"caption", plot.caption},
          {"x_label", plot.xLabel},
          {"y_label", plot.yLabel},
          {"series", listOf(plot.series)}};
}

Json jsonOf(const ImageRow& row) {
  const DisplayLook look{.background = Background{row.background, row.background}};
  Json images = Json::array();
  for (const ImageRow::Captioned& shown : row.images)
    images.push_back({{"caption", shown.caption},
                      {"width", shown.image.size.x},
                      {"height", shown.image.size.y},
                      {"png", base64(encodePng(shown.image, look))}});
  return {{"caption", row.caption}, {"images", std::move(images)}};
}

Json jsonOf(const ReportSection& section) {
  return {{"title", section.title},
          {"passed", section.passed()},
          {"text", section.text},
          {"checks", listOf(section.checks)},
          {"tables", listOf(section.tables)},
          {"plots", listOf(section.plots)},
          {"image_rows", listOf(section.imageRows)}};
}

template <typename T>
Json listOf(const std::vector<T>& items) {
  Json list = Json::array();
  for (const T& item : items) list.push_back(jsonOf(item));
  return list;
}

}  // namespace

void writeJson(const std::filesystem::path& file, const Report& report) {
  const Json json = {{"passed", report.passed()},
                     {"checks", report.checkCount()},
                     {"failed", report.failures()},
                     {"facts", report.facts.empty() ? Json::object() : Json(report.facts)},
                     {"sections", listOf(report.sections)}};
  writeTextAtomically(file, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace freevoxels
