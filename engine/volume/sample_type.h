#pragma once
// The types of numbers in files of scans.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace freevoxels {

enum class SampleType : std::uint8_t { U8, I8, U16, I16, U32, I32, U64, I64, F32, F64 };

std::size_t bytesOf(SampleType type);
/// "uint16", "float32"
std::string_view nameOf(SampleType type);
/// The type of such a name, or of a short one: "u16", "f32". Nothing for other words.
std::optional<SampleType> sampleTypeOf(std::string_view name);

/// Calls `work` with a value of the type.
template <typename Work>
auto withSampleType(SampleType type, const Work& work) {
  switch (type) {
    case SampleType::U8:
      return work(std::uint8_t());
    case SampleType::I8:
      return work(std::int8_t());
    case SampleType::U16:
      return work(std::uint16_t());
    case SampleType::I16:
      return work(std::int16_t());
    case SampleType::U32:
      return work(std::uint32_t());
    case SampleType::I32:
      return work(std::int32_t());
    case SampleType::U64:
      return work(std::uint64_t());
    case SampleType::I64:
      return work(std::int64_t());
    case SampleType::F32:
      return work(float());
    case SampleType::F64:
      break;
  }
  return work(double());
}

}  // namespace freevoxels
