#pragma once
// JSON that a person wrote: what is wrong with it is said in one sentence, ExitCode::Input.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace freevoxels {

/// `kind` is what the sentence calls the file: "transfer function". No object of it may have a key twice.
nlohmann::json readJson(std::string_view kind, const std::filesystem::path& file);

/// The same of a text, which the sentence calls `name`.
nlohmann::json parseJson(std::string_view kind, std::string_view name, std::string_view text);

/// A value as JSON on one line, whatever bytes are in it.
std::string inQuotes(const nlohmann::json& value);

}  // namespace freevoxels
