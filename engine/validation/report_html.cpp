#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iterator>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/validation/base64.h"
#include "engine/validation/report.h"
#include "engine/validation/report_style.h"
#include "engine/validation/report_text.h"
#include "engine/validation/svg_plot.h"

namespace freevoxels {

namespace {

constexpr const char* kTitle = "FreeVoxels validation report";
/// Smaller images are shown at whole multiples of their size, so that their pixels are visible.
constexpr int kSmallImage = 256;

std::string plural(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

/// "all 12 checks passed", "2 of 12 checks failed".
std::string verdictText(std::size_t count, std::size_t failures) {
  if (count == 0) return "no checks";
  if (failures == 0) return count == 1 ? "1 check passed" : fmt::format("all {} checks passed", count);
  return fmt::format("{} of {} failed", failures, plural(count, "check"));
}

/// Empty if there is no text.
std::string afterwards(const char* before, const std::string& text, const char* after) {
  return text.empty() ? "" : before + escapeHtml(text) + after;
}

/// Cells with numbers are aligned to the right.
bool isNumeric(const std::string& cell) {
  char* end = nullptr;
  std::strtod(cell.c_str(), &end);
  return end != cell.c_str();
}

std::vector<bool> numericColumns(const ReportTable& table) {
  std::vector<bool> numeric(table.columns.size(), !table.rows.empty());
  for (const std::vector<std::string>& row : table.rows) {
    FV_CHECK_EQ(row.size(), table.columns.size());
    for (std::size_t i = 0; i < row.size(); ++i) numeric[i] = numeric[i] && isNumeric(row[i]);
  }
  return numeric;
}

class HtmlWriter {
 public:
  std::string write(const Report& report) {
    add("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    add("<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n");
    add("<title>{}</title>\n<style>\n{}</style>\n</head>\n<body>\n<main>\n", kTitle, kReportStyle);
    header(report);
    failures(report);
    contents(report);
    for (std::size_t i = 0; i < report.sections.size(); ++i) section(report.sections[i], i + 1);
    add("</main>\n</body>\n</html>\n");
    return std::move(html_);
  }

 private:
  template <typename... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(html_), format, std::forward<Args>(args)...);
  }

  void header(const Report& report) {
    add("<header>\n<h1>{}</h1>\n", kTitle);
    add("<p class=\"verdict {}\">{}</p>\n", report.passed() ? "pass" : "fail",
        verdictText(report.checkCount(), report.failures()));
    if (!report.facts.empty()) add("<dl>\n");
    for (const auto& [name, value] : report.facts)
      add("<dt>{}</dt><dd>{}</dd>\n", escapeHtml(name), escapeHtml(value));
    add("{}</header>\n", report.facts.empty() ? "" : "</dl>\n");
  }

  void failures(const Report& report) {
    if (report.passed()) return;
    add("<section class=\"failures\">\n<h2>Failures</h2>\n<ul>\n");
    for (std::size_t s = 0; s < report.sections.size(); ++s)
      for (std::size_t c = 0; c < report.sections[s].checks.size(); ++c) {
        const Check& check = report.sections[s].checks[c];
        if (check.passed()) continue;
        add("<li><a href=\"#check-{}-{}\">{}: {}</a>: {}, must be {}{}{}</li>\n", s + 1, c + 1,
            escapeHtml(report.sections[s].title), escapeHtml(check.name), figure(check), bound(check),
            afterwards(" ", check.unit, ""), afterwards(" (", check.where, ")"));
      }
    add("</ul>\n</section>\n");
  }

  void contents(const Report& report) {
    add("<nav>\n<h2>Contents</h2>\n<ol>\n");
    for (std::size_t i = 0; i < report.sections.size(); ++i) {
      const ReportSection& section = report.sections[i];
      add("<li><a href=\"#section-{}\">{}</a> <span class=\"{}\">{}</span></li>\n", i + 1,
          escapeHtml(section.title), section.passed() ? "quiet" : "fail",
          verdictText(section.checks.size(), section.failures()));
    }
    add("</ol>\n</nav>\n");
  }

  void section(const ReportSection& section, std::size_t number) {
    add("<section id=\"section-{0}\">\n<h2>{0}. {1}</h2>\n", number, escapeHtml(section.title));
    if (!section.text.empty()) add("<p class=\"text\">{}</p>\n", escapeHtml(section.text));
    if (!section.checks.empty()) checks(section.checks, number);
    for (const ReportTable& table : section.tables) this->table(table);
    for (const ReportPlot& plot : section.plots)
      add("<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n", svgPlot(plot), escapeHtml(plot.caption));
    for (const ImageRow& row : section.imageRows) imageRow(row);
    add("</section>\n");
  }

  static std::string figure(const Check& check) { return figureTextBeside(check.figure, check.tolerance); }
  static std::string bound(const Check& check) {
    return (check.bound == Check::Bound::AtMost ? "≤ " : "≥ ") +
           figureTextBeside(check.tolerance, check.figure);
  }

  void checks(const std::vector<Check>& checks, std::size_t section) {
    add("<table class=\"checks\">\n<thead><tr><th>Check</th><th>Verdict</th><th class=\"number\">Figure</th>"
        "<th class=\"number\">Bound</th><th>Unit</th><th>Where</th></tr></thead>\n<tbody>\n");
    for (std::size_t i = 0; i < checks.size(); ++i) {
      const Check& check = checks[i];
      const bool passed = check.passed();
      add("<tr id=\"check-{}-{}\"{}><th scope=\"row\">{}</th><td class=\"{}\">{}</td>", section, i + 1,
          passed ? "" : " class=\"failed\"", escapeHtml(check.name), passed ? "pass" : "fail",
          passed ? "pass" : "FAIL");
      add("<td class=\"number\">{}</td><td class=\"number\">{}</td><td>{}</td><td>{}</td></tr>\n",
          figure(check), bound(check), escapeHtml(check.unit), escapeHtml(check.where));
    }
    add("</tbody>\n</table>\n");
  }

  void table(const ReportTable& table) {
    const std::vector<bool> numeric = numericColumns(table);
    const auto align = [&](std::size_t i) { return i > 0 && numeric[i] ? " class=\"number\"" : ""; };
    add("<table>\n<caption>{}</caption>\n<thead><tr>", escapeHtml(table.caption));
    for (std::size_t i = 0; i < table.columns.size(); ++i)
      add("<th{}>{}</th>", align(i), escapeHtml(table.columns[i]));
    add("</tr></thead>\n<tbody>\n");
    for (const std::vector<std::string>& row : table.rows) {
      add("<tr>");
      for (std::size_t i = 0; i < row.size(); ++i)
        add("<{0}{1}>{2}</{3}>", i == 0 ? "th scope=\"row\"" : "td", align(i), escapeHtml(row[i]),
            i == 0 ? "th" : "td");
      add("</tr>\n");
    }
    add("</tbody>\n</table>\n");
  }

  void imageRow(const ImageRow& row) {
    add("<figure>\n<div class=\"images\">\n");
    for (const ImageRow::Captioned& shown : row.images) {
      const glm::ivec2 size = shown.image.size;
      const int scale = std::max(1, kSmallImage / std::max({size.x, size.y, 1}));
      const std::string caption = escapeHtml(shown.caption);
      add("<figure style=\"max-width: max(8rem, {}px)\"><img{} width=\"{}\" height=\"{}\" alt=\"{}\" "
          "src=\"data:image/png;base64,",
          scale * size.x, scale > 1 ? " class=\"small\"" : "", scale * size.x, scale * size.y, caption);
      html_ += base64(encodePng(shown.image, {.background = Background{row.background, row.background}}));
      add("\"><figcaption>{}</figcaption></figure>\n", caption);
    }
    add("</div>\n<figcaption>{}</figcaption>\n</figure>\n", escapeHtml(row.caption));
  }

  std::string html_;
};

}  // namespace

void writeHtml(const std::filesystem::path& file, const Report& report) {
  writeTextAtomically(file, HtmlWriter().write(report));
}

}  // namespace freevoxels
