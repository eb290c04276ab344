#pragma once
// Internal to the two files that include ITK: what they have in common.

#include <itkImageIOBase.h>
#include <itkMetaDataObject.h>

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <new>
#include <optional>
#include <string>

#include "engine/volume/scan_reader.h"

namespace freevoxels {

/// Runs `work`, which calls ITK, with its warnings off. One thread after the other. ITK's exceptions become errors that name the file.
template <typename Work>
void quietItk(const std::filesystem::path& file, const Work& work) {
  static std::mutex mutex;
  const std::lock_guard lock(mutex);
  itk::Object::GlobalWarningDisplayOff();
  try {
    work();
  } catch (const itk::ExceptionObject& error) {
    std::string why = error.GetDescription();
    std::ranges::replace(why, '\n', ' ');
    if (const std::size_t end = why.find("): "); why.starts_with("ITK ERROR") && end != std::string::npos) why.erase(0, end + 3);
    failDamaged(file, why);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    failDamaged(file, error.what());
  }
}

/// The type of values that ITK calls so; nothing for one that no scan has.
inline std::optional<SampleType> sampleTypeOf(itk::IOComponentEnum type) {
  using enum itk::IOComponentEnum;
  switch (type) {
    case UCHAR:
      return SampleType::U8;
    case CHAR:
      return SampleType::I8;
    case USHORT:
      return SampleType::U16;
    case SHORT:
      return SampleType::I16;
    case UINT:
      return SampleType::U32;
    case INT:
      return SampleType::I32;
    case ULONG:
      return sizeof(unsigned long) == 8 ? SampleType::U64 : SampleType::U32;
    case LONG:
      return sizeof(long) == 8 ? SampleType::I64 : SampleType::I32;
    case ULONGLONG:
      return SampleType::U64;
    case LONGLONG:
      return SampleType::I64;
    case FLOAT:
      return SampleType::F32;
    case DOUBLE:
      return SampleType::F64;
    default:
      return std::nullopt;
  }
}

/// Has the whole image read.
inline void wantAll(itk::ImageIOBase& io) {
  const unsigned dimensions = io.GetNumberOfDimensions();
  itk::ImageIORegion region(dimensions);
  for (unsigned axis = 0; axis < dimensions; ++axis) region.SetSize(axis, io.GetDimensions(axis));
  io.SetIORegion(region);
}

inline std::string textIn(const itk::MetaDataDictionary& dictionary, const std::string& key) {
  std::string text;
  itk::ExposeMetaData<std::string>(dictionary, key, text);
  return text;
}

inline std::optional<double> numberIn(const itk::MetaDataDictionary& dictionary, const std::string& key) {
  const std::string text = textIn(dictionary, key);
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return end == text.c_str() ? std::nullopt : std::optional(number);
}

/// The box and its place, of an image of which ITK has read the header. Fails for values that are neither single numbers nor colours.
inline ScanHeader headerOf(const std::filesystem::path& file, const itk::ImageIOBase& io) {
  const std::optional<SampleType> type = sampleTypeOf(io.GetComponentType());
  if (!type) fail(ErrorKind::Input, "'{}' has values of a type that no scan has: convert them to whole numbers or floats", file.string());
  ScanHeader header{.type = *type, .components = int(std::min(io.GetNumberOfComponents(), 1u << 20))};
  checkComponents(file, header.components, header.type);
  glm::i64vec3 dimensions(1);
  for (unsigned axis = 0; axis < std::min(io.GetNumberOfDimensions(), 3u); ++axis) {
    dimensions[int(axis)] = std::int64_t(io.GetDimensions(axis));
    const std::vector<double> direction = io.GetDirection(axis);
    for (unsigned row = 0; row < 3; ++row)
      header.indexToWorld[int(axis)][int(row)] = row < direction.size() ? direction[row] * io.GetSpacing(axis) : 0.0;
    header.indexToWorld[3][int(axis)] = io.GetOrigin(axis);
  }
  checkEdges(file, dimensions);
  header.dimensions = glm::ivec3(dimensions);
  return header;
}

}  // namespace freevoxels
