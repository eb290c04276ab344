#include "apps/python/array_volume.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>

#include "apps/python/numpy_array.h"
#include "apps/python/python_values.h"
#include "engine/core/error.h"
#include "engine/description/scene_description.h"
#include "engine/volume/volume_of_scalars.h"

namespace freevoxels {

namespace {

namespace py = pybind11;

struct Half {
  std::uint16_t bits;
  explicit operator float() const { return glm::unpackHalf1x16(bits); }
};

/// A bool of NumPy.
struct Flag {
  std::uint8_t value;
  explicit operator float() const { return float(value); }
};

/// The parts of an array that are read without the GIL, while its owner holds a reference.
struct Source {
  const char* data;
  glm::i64vec3 strides;  ///< distances in bytes along x, y and z
  glm::ivec3 dimensions;
  bool isSwapped;  ///< ArrayView

  const char* at(glm::ivec3 voxel) const {
    const glm::i64vec3 offset = glm::i64vec3(voxel) * strides;
    return data + offset.x + offset.y + offset.z;
  }
};

Source sourceOf(const ArrayView& array) {
  if (array.dimensions() != 3)
    fail(ErrorKind::Input, "the array has {} dimension{}: a volume needs three, ordered z, y, x, and channels before them need {}",
         array.dimensions(), array.dimensions() == 1 ? "" : "s", Parameter("channel"));
  constexpr py::ssize_t kMax = std::numeric_limits<std::int32_t>::max();
  for (const py::ssize_t size : array.shape)
    if (size < 1 || size > kMax)
      fail(ErrorKind::Input, "the array has the shape {}: every dimension of a volume is at least 1 and below 2^31", array.shapeText());
  return {array.data,
          {array.strides[2], array.strides[1], array.strides[0]},
          {array.shape[2], array.shape[1], array.shape[0]},
          array.isSwapped};
}

/// Reads an element, which may be at any address.
template <typename Value>
Value elementAt(const char* place, bool isSwapped) {
  std::array<char, sizeof(Value)> bytes;
  std::memcpy(bytes.data(), place, bytes.size());
  if (isSwapped) std::ranges::reverse(bytes);
  return std::bit_cast<Value>(bytes);
}

/// The number that marks voxels without data, as exact as Python has it.
struct Marker {
  double real = 0.0;
  std::optional<std::variant<std::int64_t, std::uint64_t>> whole;  ///< if it is a whole number of at most 64 bits
};

/// Whether a call of Python's interface has failed; forgets why.
bool hasFailed() {
  const bool failed = PyErr_Occurred() != nullptr;
  PyErr_Clear();
  return failed;
}

Marker markerOf(const py::object& number) {
  const Parameter name("no-data");
  Marker marker{.real = PyFloat_AsDouble(number.ptr())};
  const bool isReal = !hasFailed();
  py::object whole = py::reinterpret_steal<py::object>(PyIndex_Check(number.ptr()) != 0 ? PyNumber_Index(number.ptr()) : nullptr);
  if (hasFailed()) whole = py::object();
  if (!isReal && whole) fail(ErrorKind::Input, "{} is a whole number that is too large: leave it out", name);
  if (!isReal) fail(ErrorKind::Input, "{} takes a number, not {}; 'none' keeps all values", name, typeName(number));
  if (!whole && std::isfinite(marker.real) && marker.real == std::floor(marker.real))
    whole = py::reinterpret_steal<py::object>(PyLong_FromDouble(marker.real));
  if (!whole) return marker;
  if (const long long value = PyLong_AsLongLong(whole.ptr()); !hasFailed())
    marker.whole = std::int64_t(value);
  else if (const unsigned long long large = PyLong_AsUnsignedLongLong(whole.ptr()); !hasFailed())
    marker.whole = std::uint64_t(large);
  return marker;
}

// The value of a type that a marker means: numbers are rounded to types of floating point, as astype() rounds them. Nothing where it means
// none.

template <std::integral Value>
std::optional<Value> valueOf(const Marker& marker, Value) {
  if (!marker.whole) return std::nullopt;
  return std::visit([](auto whole) { return std::in_range<Value>(whole) ? std::optional(Value(whole)) : std::nullopt; }, *marker.whole);
}

std::optional<std::uint8_t> valueOf(const Marker& marker, Flag) {
  const std::optional<std::uint8_t> value = valueOf(marker, std::uint8_t());
  return value && *value <= 1 ? value : std::nullopt;
}

std::optional<double> valueOf(const Marker& marker, double) {
  return marker.real;
}

std::optional<double> valueOf(const Marker& marker, float) {
  return double(float(marker.real));
}

std::optional<double> valueOf(const Marker& marker, Half) {
  if (!std::isfinite(marker.real) || marker.real == 0.0) return marker.real;
  constexpr int kSmallestExponent = -14, kFractionBits = 10;
  constexpr double kLargest = 65504.0;
  const double step = std::ldexp(1.0, std::max(std::ilogb(marker.real), kSmallestExponent) - kFractionBits);
  const double rounded = std::nearbyint(marker.real / step) * step;
  return std::abs(rounded) <= kLargest ? rounded : std::copysign(std::numeric_limits<double>::infinity(), rounded);
}

// What such a value is compared with.

template <std::integral Value>
Value comparable(Value value) {
  return value;
}
std::uint8_t comparable(Flag value) {
  return value.value;
}
double comparable(double value) {
  return value;
}
double comparable(float value) {
  return double(value);
}
double comparable(Half value) {
  return double(float(value));
}

/// Calls `work` with a value of the array's type.
template <typename Work>
auto withTypeOf(const ArrayView& array, const Work& work) {
  switch (array.type) {
    case ElementType::Flag: return work(Flag());
    case ElementType::U8: return work(std::uint8_t());
    case ElementType::U16: return work(std::uint16_t());
    case ElementType::U32: return work(std::uint32_t());
    case ElementType::U64: return work(std::uint64_t());
    case ElementType::I8: return work(std::int8_t());
    case ElementType::I16: return work(std::int16_t());
    case ElementType::I32: return work(std::int32_t());
    case ElementType::I64: return work(std::int64_t());
    case ElementType::F16: return work(Half());
    case ElementType::F32: return work(float());
    case ElementType::F64: break;
  }
  return work(double());
}

/// Whether values of the array can be equal to the marker. NaN marks nothing in whole numbers, and need not.
bool canHold(const ArrayView& array, const Marker& marker) {
  return std::isnan(marker.real) || withTypeOf(array, [&](auto value) { return valueOf(marker, value).has_value(); });
}

ScalarBricks readArray(const ArrayView& array, const std::optional<Marker>& marker) {
  const Source source = sourceOf(array);
  const std::optional<Source> mask = array.mask ? std::optional(sourceOf(*array.mask)) : std::nullopt;
  return withTypeOf(array, [&](auto typed) {
    using Value = decltype(typed);
    using Comparable = decltype(comparable(typed));
    const std::optional<Comparable> absent = marker ? valueOf(*marker, typed) : std::nullopt;
    const py::gil_scoped_release withoutGil;
    if constexpr (std::integral<Value> && sizeof(Value) <= sizeof(std::uint16_t)) {
      using Code = std::make_unsigned_t<Value>;
      if (!mask) {
        std::vector<float> values(std::size_t(1) << 8 * sizeof(Code));
        for (std::size_t code = 0; code < values.size(); ++code)
          values[code] = absent && Value(code) == *absent ? kInactiveVoxel : float(Value(code));
        const auto codeAt = [&](glm::ivec3 voxel) { return Code(elementAt<Value>(source.at(voxel), source.isSwapped)); };
        return ScalarBricks::makeCodes<Code>(source.dimensions, codeAt, std::move(values), watchSignals());
      }
    }
    return ScalarBricks::make(
        source.dimensions,
        [&](glm::ivec3 voxel) {
          if (mask && *mask->at(voxel) != 0) return kInactiveVoxel;
          const auto value = elementAt<Value>(source.at(voxel), source.isSwapped);
          const float scalar = float(value);
          return std::isnan(scalar) || (absent && comparable(value) == *absent) ? kInactiveVoxel : scalar;
        },
        [](glm::ivec3) { return true; }, watchSignals());
  });
}

/// A channel of an array that has several along its first axis.
ArrayView channelOf(const ArrayView& array, std::size_t channel) {
  ArrayView one = array;
  one.data += array.strides.front() * py::ssize_t(channel);
  one.shape.erase(one.shape.begin());
  one.strides.erase(one.strides.begin());
  if (array.mask) one.mask = std::make_shared<const ArrayView>(channelOf(*array.mask, channel));
  return one;
}

Volume volumeOfChannelArray(const ArrayView& array, const std::optional<Marker>& noData, const ArrayPlacement& placement) {
  if (array.dimensions() != 4)
    fail(ErrorKind::Input, "the array has the shape {}: {} needs four dimensions, ordered channel, z, y, x", array.shapeText(),
         Parameter("channel"));
  std::vector<ScalarBricks> values;
  for (const ChannelStyle& style : placement.channels)
    values.push_back(readArray(channelOf(array, channelNumber(style, std::size_t(array.shape.front()))), noData));
  return volumeOfChannels(std::move(values), placement.indexToWorld, placement.channels);
}

/// Whether the word says that every value is data.
bool isNone(const py::object& noData) {
  return py::isinstance<py::str>(noData) && noData.cast<std::string>() == kNone;
}

}  // namespace

Volume volumeOfArray(const py::object& array, const py::object& temperature, const ArrayPlacement& placement) {
  const ArrayView scalars = viewOf(array, "the array");
  std::optional<ArrayView> heat;
  if (!temperature.is_none()) heat = viewOf(temperature, fmt::format("{}", Parameter("temperature")));
  std::optional<Marker> noData;
  if (!placement.noData.is_none() && !isNone(placement.noData)) noData = markerOf(placement.noData);
  if (noData && !canHold(scalars, *noData) && !(heat && canHold(*heat, *noData)))
    fail(ErrorKind::Input, "{} is {}, which no {} can be: leave it out, or give a value that the array can hold", Parameter("no-data"),
         noData->real, scalars.typeName());
  if (!placement.channels.empty() && heat)
    fail(ErrorKind::Usage, "{} and {} exclude each other", Parameter("channel"), Parameter("temperature"));
  if (!placement.channels.empty()) return volumeOfChannelArray(scalars, noData, placement);
  if (heat && heat->shape != scalars.shape)
    fail(ErrorKind::Input, "{} has the shape {}, and the array has {}: they must be the same", Parameter("temperature"), heat->shapeText(),
         scalars.shapeText());
  const bool knowsNoData = !placement.noData.is_none() || scalars.mask;  // and readArray() has marked the voxels
  Volume volume = volumeOfScalars(readArray(scalars, noData), placement.indexToWorld, knowsNoData ? std::optional(NoData{}) : std::nullopt,
                                  "the array", placement.labels && !placement.labels->isNone() ? &*placement.labels : nullptr);
  if (!heat) return volume;
  volume.temperature = TemperatureGrid{.name = "temperature", .values = readArray(*heat, noData)};
  summariseValues(*volume.temperature);
  coverBricks(volume, volume.temperature->values);
  return volume;
}

}  // namespace freevoxels
