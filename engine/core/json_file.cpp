#include "engine/core/json_file.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/printable.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The parser's message without its error code, on one line of limited length: it repeats what it does not understand.
std::string parseReason(const Json::parse_error& error) {
  constexpr std::size_t kLongest = 300;
  std::string reason = error.what();
  if (const std::size_t end = reason.find("] "); end != std::string::npos) reason.erase(0, end + 2);
  std::replace_if(
      reason.begin(), reason.end(), [](unsigned char c) { return c < 32; }, ' ');
  return printablePart(reason, kLongest);
}

/// A parser callback that fails for repeated keys, of which the parser by itself keeps the last value, and for deep nesting.
Json::parser_callback_t refuseRepeatedKeys(std::string_view kind, std::string_view name) {
  return [kind, name, seen = std::vector<std::set<Json>>()](int depth, Json::parse_event_t event,
                                                            Json& parsed) mutable {
    if (depth > kDeepestJson) fail(ErrorKind::Input, "{} '{}' is nested more than {} deep", kind, name, kDeepestJson);
    const auto inside = std::size_t(depth) + (event == Json::parse_event_t::object_start ? 1 : 0);
    seen.resize(std::max(seen.size(), inside + 1));
    if (event == Json::parse_event_t::object_start) seen[inside].clear();
    if (event == Json::parse_event_t::key && !seen[inside].insert(parsed).second)
      fail(ErrorKind::Input, "{} '{}' has the key {} more than once; keep one of them", kind, name,
           inShort(parsed));
    return true;
  };
}

/// Nothing where the text is nested too deep; a discarded value where it is no JSON.
std::optional<Json> parseUnlessTooDeep(std::string_view text) {
  struct TooDeep {};
  const auto refuseDeep = [](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepestJson) throw TooDeep();
    return true;
  };
  try {
    return std::optional<Json>(std::in_place, Json::parse(text, refuseDeep, false));
  } catch (const TooDeep&) {
    return std::nullopt;
  }
}

}  // namespace

nlohmann::json parseJson(std::string_view kind, std::string_view name, std::string_view text) {
  try {
    return Json::parse(text, refuseRepeatedKeys(kind, name));
  } catch (const Json::parse_error& e) {
    fail(ErrorKind::Input, "{} '{}' is not valid JSON: {}", kind, name, parseReason(e));
  } catch (const Json::exception&) {
    fail(ErrorKind::Input, "{} '{}' holds a number that is too large", kind, name);
  }
}

nlohmann::json readJson(std::string_view kind, const fs::path& file) {
  checkInputFile(kind, file);
  std::ifstream stream(file);
  if (!stream) fail(ErrorKind::Input, "cannot open {} '{}'; check its permissions", kind, file.string());
  const std::string text(std::istreambuf_iterator<char>(stream), {});
  return parseJson(kind, file.string(), text);
}

std::string inQuotes(const nlohmann::json& value) {
  return value.dump(-1, ' ', true, Json::error_handler_t::replace);
}

std::string inShort(const nlohmann::json& value) {
  return quotedPart(inQuotes(value));
}

bool isTooDeep(std::string_view text) {
  return !parseUnlessTooDeep(text);
}

nlohmann::json parseJsonQuietly(std::string_view text) {
  return parseUnlessTooDeep(text).value_or(Json(Json::value_t::discarded));
}

}  // namespace freevoxels
