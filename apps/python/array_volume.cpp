#include "apps/python/array_volume.h"

#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "engine/core/error.h"
#include "engine/volume/volume_of_scalars.h"

namespace freevoxels {

namespace {

namespace py = pybind11;

struct Half {
  std::uint16_t bits;
  explicit operator float() const { return glm::unpackHalf1x16(bits); }
};

/// The parts of an array that are read without the GIL, while its owner holds a reference.
struct Source {
  const char* data;
  glm::i64vec3 strides;  ///< distances in bytes along x, y and z
  glm::ivec3 dimensions;
};

std::string shapeText(const py::array& array) {
  std::string text;
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis)
    text += fmt::format("{}{}", axis == 0 ? "" : " x ", array.shape(axis));
  return text;
}

Source sourceOf(const py::array& array) {
  if (array.ndim() != 3)
    fail(ErrorKind::Input, "the array has {} dimension{}: a volume needs three, ordered z, y, x", array.ndim(),
         array.ndim() == 1 ? "" : "s");
  constexpr py::ssize_t kMax = std::numeric_limits<std::int32_t>::max();
  for (py::ssize_t axis = 0; axis < 3; ++axis)
    if (array.shape(axis) < 1 || array.shape(axis) > kMax)
      fail(ErrorKind::Input, "the array has the shape {}: every dimension of a volume is at least 1", shapeText(array));
  return {static_cast<const char*>(array.data()),
          {array.strides(2), array.strides(1), array.strides(0)},
          {array.shape(2), array.shape(1), array.shape(0)}};
}

template <typename Value>
ScalarBricks bricksOf(const Source& source, std::optional<double> noData) {
  const float absent = noData ? float(*noData) : std::numeric_limits<float>::quiet_NaN();
  const py::gil_scoped_release withoutGil;
  return ScalarBricks::make(source.dimensions, [&](glm::ivec3 voxel) {
    const glm::i64vec3 offset = glm::i64vec3(voxel) * source.strides;
    Value value;
    std::memcpy(&value, source.data + offset.x + offset.y + offset.z, sizeof value);
    const float scalar = float(value);
    return std::isnan(scalar) || scalar == absent ? kInactiveVoxel : scalar;
  });
}

ScalarBricks readArray(const py::array& array, std::optional<double> noData) {
  const Source source = sourceOf(array);
  const py::dtype type = array.dtype();
  if (type.byteorder() != '>')  // the supported machines are little-endian
    switch (type.kind()) {
      case 'b': return bricksOf<std::uint8_t>(source, noData);
      case 'u':
        if (type.itemsize() == 1) return bricksOf<std::uint8_t>(source, noData);
        if (type.itemsize() == 2) return bricksOf<std::uint16_t>(source, noData);
        if (type.itemsize() == 4) return bricksOf<std::uint32_t>(source, noData);
        return bricksOf<std::uint64_t>(source, noData);
      case 'i':
        if (type.itemsize() == 1) return bricksOf<std::int8_t>(source, noData);
        if (type.itemsize() == 2) return bricksOf<std::int16_t>(source, noData);
        if (type.itemsize() == 4) return bricksOf<std::int32_t>(source, noData);
        return bricksOf<std::int64_t>(source, noData);
      case 'f':
        if (type.itemsize() == 2) return bricksOf<Half>(source, noData);
        if (type.itemsize() == 4) return bricksOf<float>(source, noData);
        if (type.itemsize() == 8) return bricksOf<double>(source, noData);
        break;
      default: break;
    }
  fail(ErrorKind::Input, "arrays of {} cannot be rendered: convert it with array.astype('float32')",
       py::str(type.attr("name")).cast<std::string>());
}

}  // namespace

Volume volumeOfArray(const py::array& scalars, const std::optional<py::array>& temperature,
                     const ArrayPlacement& placement) {
  Volume volume = volumeOfScalars(readArray(scalars, placement.noData), placement.indexToWorld);
  if (!temperature) return volume;
  volume.temperature = TemperatureGrid{.name = "temperature", .values = readArray(*temperature, placement.noData)};
  if (volume.temperature->values.dimensions() != volume.dimensions)
    fail(ErrorKind::Input, "the temperatures have the shape {}, and the array has {}: they must be the same",
         shapeText(*temperature), shapeText(scalars));
  summariseValues(*volume.temperature);
  coverBricks(volume, volume.temperature->values);
  return volume;
}

}  // namespace freevoxels
