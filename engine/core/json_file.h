#pragma once
// Reads JSON written by a person. Errors are one sentence with ErrorKind::Input that says what is wrong and
// where.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace freevoxels {

/// How deep values may be nested. Copying, printing and freeing them takes stack for each level.
inline constexpr int kDeepestJson = 64;

/// Reads a file. Messages call it `kind`, such as "transfer function". A repeated key of an object is an error, as is deeper nesting than
/// kDeepestJson.
nlohmann::json readJson(std::string_view kind, const std::filesystem::path& file);

/// Parses `text`, which messages call `name`, in the same way.
nlohmann::json parseJson(std::string_view kind, std::string_view name, std::string_view text);

/// Prints a value as one line of JSON; invalid UTF-8 is replaced.
std::string inQuotes(const nlohmann::json& value);

/// The same for sentences: the beginning of what is long.
std::string inShort(const nlohmann::json& value);

/// Whether `text` is nested deeper than kDeepestJson, as far as it is JSON.
bool isTooDeep(std::string_view text);

/// Parses text that no person wrote: a discarded value unless it is JSON that is nested at most kDeepestJson deep. The last value of a
/// repeated key counts.
nlohmann::json parseJsonQuietly(std::string_view text);

}  // namespace freevoxels
