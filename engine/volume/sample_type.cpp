#include "engine/volume/sample_type.h"

#include <algorithm>
#include <array>

namespace freevoxels {

namespace {

struct TypeNames {
  std::string_view name, shortName;
};

/// In the order of SampleType.
constexpr std::array<TypeNames, 10> kNames{{{"uint8", "u8"},
                                            {"int8", "i8"},
                                            {"uint16", "u16"},
                                            {"int16", "i16"},
                                            {"uint32", "u32"},
                                            {"int32", "i32"},
                                            {"uint64", "u64"},
                                            {"int64", "i64"},
                                            {"float32", "f32"},
                                            {"float64", "f64"}}};

}  // namespace

std::size_t bytesOf(SampleType type) {
  return withSampleType(type, [](auto value) { return sizeof(value); });
}

std::string_view nameOf(SampleType type) {
  return kNames[std::size_t(type)].name;
}

std::optional<SampleType> sampleTypeOf(std::string_view name) {
  const auto found = std::ranges::find_if(kNames, [&](const TypeNames& names) { return names.name == name || names.shortName == name; });
  if (found == kNames.end()) return std::nullopt;
  return SampleType(found - kNames.begin());
}

}  // namespace freevoxels
