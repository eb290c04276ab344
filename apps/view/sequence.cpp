#include "apps/view/sequence.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "apps/freevoxels/frame_names.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kDigits = "0123456789";
constexpr std::size_t kMostDigits = 9;  // that an int holds

std::size_t nameStart(const std::string& file) {
  return file.rfind('/') + 1;  // 0 without a folder
}

/// The number that makes `name` of the pattern.
std::optional<int> numberOf(const std::string& name, const std::string& pattern) {
  const std::size_t first = pattern.find('#'), end = pattern.find_last_of('#') + 1;
  const std::size_t around = first + pattern.size() - end;
  if (name.size() <= around || name.size() - around > kMostDigits) return std::nullopt;
  const char* const digits = name.data() + first;
  const char* const digitsEnd = digits + (name.size() - around);
  int number = 0;
  const auto [read, error] = std::from_chars(digits, digitsEnd, number);
  if (error != std::errc() || read != digitsEnd || number < 0) return std::nullopt;
  return frameName(pattern, number) == name ? std::optional(number) : std::nullopt;
}

Sequence filesOf(const std::string& pattern) {
  frameName(pattern, 0);  // refuses what is no pattern
  const std::string folder = pattern.substr(0, nameStart(pattern));
  const std::string ownName = pattern.substr(nameStart(pattern));
  std::vector<std::pair<int, std::string>> frames;
  std::error_code error;
  for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (const std::optional<int> number = numberOf(name, ownName))
      frames.emplace_back(*number, folder + name);
  }
  std::ranges::sort(frames);
  Sequence sequence{.pattern = pattern, .files = {}};
  for (auto& [number, file] : frames) sequence.files.push_back(std::move(file));
  return sequence;
}

}  // namespace

Sequence findSequence(const std::string& pattern) {
  Sequence sequence = filesOf(pattern);
  if (sequence.files.empty())
    fail(ExitCode::Input, "there is no frame of '{}': its # stand for the digits of a file's number",
         pattern);
  return sequence;
}

std::optional<Sequence> sequenceAround(const std::string& file) {
  const std::size_t end = file.size() - fs::path(file).extension().string().size();
  const std::size_t before = file.find_last_not_of(kDigits, end == 0 ? 0 : end - 1);
  const std::size_t first = std::max(before + 1, nameStart(file));  // 0 where all of it are digits
  const std::size_t digits = end > first ? end - first : 0;
  if (digits == 0 || digits > kMostDigits || file.find('#', nameStart(file)) != std::string::npos)
    return std::nullopt;
  Sequence most;
  for (std::size_t width = file[first] == '0' ? digits : 1; width <= digits; ++width) {
    Sequence found = filesOf(file.substr(0, first) + std::string(width, '#') + file.substr(end));
    if (found.files.size() >= most.files.size()) most = std::move(found);
  }
  if (most.files.size() < 2) return std::nullopt;
  return most;
}

bool isPattern(const std::string& file) {
  return file.find('#', nameStart(file)) != std::string::npos && !fs::exists(file);
}

}  // namespace freevoxels
