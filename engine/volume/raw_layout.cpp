#include "engine/volume/raw_layout.h"

#include <charconv>
#include <string_view>
#include <system_error>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr int kLongestEdge = 1 << 20;

/// The text up to the separator, which is taken away with it.
std::string_view takeWord(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view word = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  return word;
}

template <typename Number>
std::optional<Number> numberOf(std::string_view text) {
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<glm::ivec3> dimensionsOf(std::string_view text) {
  glm::ivec3 dimensions;
  for (int axis = 0; axis < 3; ++axis) {
    const auto edge = numberOf<int>(axis < 2 ? takeWord(text, 'x') : text);
    if (!edge || *edge < 1 || *edge > kLongestEdge) return std::nullopt;
    dimensions[axis] = *edge;
  }
  return dimensions;
}

/// Whether the word is an optional part of a layout, which it then sets.
bool takeOptional(std::string_view word, RawLayout& layout) {
  constexpr std::string_view kHeader = "header=";
  if (word == "big" || word == "little") {
    layout.isBigEndian = word == "big";
    return true;
  }
  const auto bytes = word.starts_with(kHeader) ? numberOf<std::uint64_t>(word.substr(kHeader.size())) : std::nullopt;
  layout.headerBytes = bytes.value_or(0);
  return bytes.has_value();
}

}  // namespace

RawLayout readRawLayout(const std::string& name, const std::string& text) {
  std::string_view rest = text;
  const auto dimensions = dimensionsOf(takeWord(rest, ','));
  const auto type = sampleTypeOf(takeWord(rest, ','));
  RawLayout layout;
  bool isGood = dimensions && type;
  while (isGood && !rest.empty()) isGood = takeOptional(takeWord(rest, ','), layout);
  if (!isGood)
    fail(ErrorKind::Usage,
         "{} takes WxHxD,TYPE[,big][,header=BYTES] with a type of u8, i8, u16, i16, u32, i32, u64, i64, f32 and f64, such as "
         "256x256x128,u16,big,header=512, not '{}'",
         name, text);
  layout.dimensions = *dimensions;
  layout.type = *type;
  return layout;
}

std::string rawLayoutText(const RawLayout& layout) {
  const glm::ivec3 size = layout.dimensions;
  return fmt::format("{}x{}x{},{}{}{}", size.x, size.y, size.z, nameOf(layout.type), layout.isBigEndian ? ",big" : "",
                     layout.headerBytes > 0 ? fmt::format(",header={}", layout.headerBytes) : "");
}

std::optional<RawLayout> layoutOfName(const std::filesystem::path& file) {
  if (file.extension() != ".raw") return std::nullopt;
  const std::string stem = file.stem().string();
  const std::size_t typeAt = stem.rfind('_');
  if (typeAt == std::string::npos || typeAt == 0) return std::nullopt;
  const std::size_t sizeAt = stem.rfind('_', typeAt - 1);
  const std::size_t sizeStart = sizeAt == std::string::npos ? 0 : sizeAt + 1;
  const auto dimensions = dimensionsOf(std::string_view(stem).substr(sizeStart, typeAt - sizeStart));
  const auto type = sampleTypeOf(std::string_view(stem).substr(typeAt + 1));
  if (!dimensions || !type) return std::nullopt;
  return RawLayout{.dimensions = *dimensions, .type = *type};
}

}  // namespace freevoxels
