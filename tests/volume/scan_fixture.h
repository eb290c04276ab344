#pragma once
// Scans of every format, written here byte by byte. All hold the same patient: a letter L of high values.

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <glm/glm.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace freevoxels::test {

/// Where a scan's voxels are: LPS millimetres of voxel (i, j, k).
struct ScanPlace {
  glm::ivec3 size{0};
  glm::dmat4 indexToWorld{1.0};
};

/// An axis-aligned place whose axes run along `axes`, such as "RAS": the i-th towards the right, the j-th towards the front, the k-th up.
inline ScanPlace placeAlong(const std::string& axes, glm::ivec3 size, glm::dvec3 spacing) {
  ScanPlace place{.size = size};
  for (int i = 0; i < 3; ++i) {
    place.indexToWorld[i] = glm::dvec4(0.0);
    const std::size_t positive = std::string("LPS").find(axes[std::size_t(i)]);
    const std::size_t axis = positive != std::string::npos ? positive : std::string("RAI").find(axes[std::size_t(i)]);
    place.indexToWorld[i][int(axis)] = (positive != std::string::npos ? 1.0 : -1.0) * spacing[i];
  }
  // The middle of the box is at (10, -20, 30), wherever the axes run.
  const glm::dvec3 half = glm::dvec3(size - 1) / 2.0;
  place.indexToWorld[3] = glm::dvec4(glm::dvec3(10.0, -20.0, 30.0) - glm::dmat3(place.indexToWorld) * half, 1.0);
  return place;
}

/// The letter as one sees it who looks at the patient's face, in a box of 24 mm: its upright at the patient's right, its foot to the left.
inline int letterAt(glm::dvec3 world) {
  const glm::dvec3 p = world - glm::dvec3(10.0, -20.0, 30.0);
  const bool upright = p.x > -9.0 && p.x < -5.0 && p.z > -9.0 && p.z < 9.0;
  const bool foot = p.x > -9.0 && p.x < 7.0 && p.z > -9.0 && p.z < -5.0;
  return p.y > -4.0 && p.y < 4.0 && (upright || foot) ? 1000 : 3;
}

/// The values of a place in the order of files, x fastest.
inline std::vector<int> letterOf(const ScanPlace& place) {
  std::vector<int> values;
  for (glm::ivec3 v(0); v.z < place.size.z; ++v.z)
    for (v.y = 0; v.y < place.size.y; ++v.y)
      for (v.x = 0; v.x < place.size.x; ++v.x) values.push_back(letterAt(glm::dvec3(place.indexToWorld * glm::dvec4(glm::dvec3(v), 1.0))));
  return values;
}

template <typename Value>
std::string bytesOf(const std::vector<int>& values, bool isBigEndian = false) {
  std::string bytes;
  for (const int one : values) {
    const auto value = Value(one);
    char raw[sizeof(Value)];
    std::memcpy(raw, &value, sizeof(Value));
    if (isBigEndian) std::reverse(raw, raw + sizeof(Value));
    bytes.append(raw, sizeof(Value));
  }
  return bytes;
}

/// "x y z" of a column of the transform.
inline std::string columnText(const ScanPlace& place, int column, const char* separator = " ") {
  const glm::dvec4 v = place.indexToWorld[column];
  std::ostringstream text;
  text.precision(12);
  text << v.x << separator << v.y << separator << v.z;
  return text.str();
}

inline std::string sizeText(glm::ivec3 size) {
  return std::to_string(size.x) + " " + std::to_string(size.y) + " " + std::to_string(size.z);
}

inline std::string nrrdHeader(const ScanPlace& place, const std::string& more) {
  std::string directions;
  for (int axis = 0; axis < 3; ++axis) directions += " (" + columnText(place, axis, ",") + ")";
  return "NRRD0004\ntype: uint16\ndimension: 3\nspace: left-posterior-superior\nsizes: " + sizeText(place.size) +
         "\nspace directions:" + directions + "\nkinds: domain domain domain\nspace origin: (" + columnText(place, 3, ",") + ")\n" + more;
}

inline std::string nrrdOf(const ScanPlace& place, bool isBigEndian = false) {
  return nrrdHeader(place, std::string("endian: ") + (isBigEndian ? "big" : "little") + "\nencoding: raw\n\n") +
         bytesOf<std::uint16_t>(letterOf(place), isBigEndian);
}

inline std::string metaHeader(const ScanPlace& place, const std::string& type, const std::string& file) {
  std::string matrix, spacing;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = glm::length(place.indexToWorld[axis]);
    spacing += " " + std::to_string(length);
    for (int row = 0; row < 3; ++row) matrix += " " + std::to_string(place.indexToWorld[axis][row] / length);
  }
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\nCompressedData = False\nTransformMatrix =" +
         matrix + "\nOffset = " + columnText(place, 3) + "\nElementSpacing =" + spacing + "\nDimSize = " + sizeText(place.size) +
         "\nElementType = " + type + "\nElementDataFile = " + file + "\n";
}

template <typename Value>
void put(std::string& bytes, std::size_t at, Value value) {
  std::memcpy(bytes.data() + at, &value, sizeof(Value));
}

/// NIfTI-1 with its affine map in RAS millimetres; `steps` of time, each with the values of the first plus its number.
inline std::string niftiOf(const ScanPlace& place, float slope = 1.0f, float intercept = 0.0f, int steps = 1) {
  std::string bytes(352, '\0');
  put(bytes, 0, std::int32_t(348));
  const std::int16_t dimensions[] = {std::int16_t(steps > 1 ? 4 : 3),
                                     std::int16_t(place.size.x),
                                     std::int16_t(place.size.y),
                                     std::int16_t(place.size.z),
                                     std::int16_t(steps),
                                     1,
                                     1,
                                     1};
  for (std::size_t i = 0; i < 8; ++i) put(bytes, 40 + 2 * i, dimensions[i]);
  put(bytes, 70, std::int16_t(4));   // int16
  put(bytes, 72, std::int16_t(16));  // bits
  put(bytes, 76, 1.0f);
  for (int axis = 0; axis < 3; ++axis) put(bytes, 80 + 4 * std::size_t(axis), float(glm::length(place.indexToWorld[axis])));
  put(bytes, 92, 1.0f);
  put(bytes, 108, 352.0f);
  put(bytes, 112, slope);
  put(bytes, 116, intercept);
  bytes[123] = 2;                    // millimetres
  put(bytes, 254, std::int16_t(1));  // the affine map holds
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      put(bytes, 280 + 16 * std::size_t(row) + 4 * std::size_t(column), float((row < 2 ? -1.0 : 1.0) * place.indexToWorld[column][row]));
  std::memcpy(bytes.data() + 344, "n+1", 4);
  std::vector<int> values = letterOf(place);
  for (int step = 0; step < steps; ++step) {
    bytes += bytesOf<std::int16_t>(values);
    for (int& value : values) ++value;
  }
  return bytes;
}

/// Elements of a DICOM file, explicit VR and little-endian.
class DicomElements {
 public:
  void text(std::uint16_t group, std::uint16_t element, const char* type, std::string value) {
    if (value.size() % 2 != 0) value += std::string(type) == "UI" ? '\0' : ' ';
    start(group, element, type, std::uint16_t(value.size()));
    bytes_ += value;
  }
  void number(std::uint16_t group, std::uint16_t element, std::uint16_t value) {
    start(group, element, "US", 2);
    append(value);
  }
  void words(std::uint16_t group, std::uint16_t element, const std::string& values) {
    append(group);
    append(element);
    bytes_ += std::string("OW\0\0", 4);
    append(std::uint32_t(values.size()));
    bytes_ += values;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  template <typename Value>
  void append(Value value) {
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof(Value));
  }
  void start(std::uint16_t group, std::uint16_t element, const char* type, std::uint16_t length) {
    append(group);
    append(element);
    bytes_ += type;
    append(length);
  }
  std::string bytes_;
};

/// Slice k of a place as a DICOM file of CT whose stored values are 1024 above the letter's. `hasPosition` leaves out what orders it.
inline std::string dicomOf(const ScanPlace& place, int k, const std::string& series = "1.2.3", bool hasPosition = true) {
  ScanPlace slice = place;
  slice.size.z = 1;
  slice.indexToWorld[3] = place.indexToWorld * glm::dvec4(0.0, 0.0, k, 1.0);
  std::vector<int> values = letterOf(slice);
  for (int& value : values) value += 1024;
  const auto unit = [&](int axis) {
    ScanPlace turned = place;
    turned.indexToWorld[axis] /= glm::length(turned.indexToWorld[axis]);
    return columnText(turned, axis, "\\");
  };
  const std::string instance = series + "." + std::to_string(k + 1), kind = "1.2.840.10008.5.1.4.1.1.2";
  DicomElements meta, data;
  meta.text(2, 2, "UI", kind);
  meta.text(2, 3, "UI", instance);
  meta.text(2, 0x10, "UI", "1.2.840.10008.1.2.1");
  data.text(8, 0x16, "UI", kind);
  data.text(8, 0x18, "UI", instance);
  data.text(8, 0x60, "CS", "CT");
  data.text(8, 0x103e, "LO", "letter");
  data.text(0x18, 0x50, "DS", std::to_string(glm::length(place.indexToWorld[2])));
  data.text(0x20, 0xd, "UI", "1.2");
  data.text(0x20, 0xe, "UI", series);
  data.text(0x20, 0x13, "IS", std::to_string(k + 1));
  if (hasPosition) data.text(0x20, 0x32, "DS", columnText(slice, 3, "\\"));
  if (hasPosition) data.text(0x20, 0x37, "DS", unit(0) + "\\" + unit(1));
  data.number(0x28, 2, 1);
  data.text(0x28, 4, "CS", "MONOCHROME2");
  data.number(0x28, 0x10, std::uint16_t(place.size.y));
  data.number(0x28, 0x11, std::uint16_t(place.size.x));
  data.text(0x28, 0x30, "DS",
            std::to_string(glm::length(place.indexToWorld[1])) + "\\" + std::to_string(glm::length(place.indexToWorld[0])));
  data.number(0x28, 0x100, 16);
  data.number(0x28, 0x101, 16);
  data.number(0x28, 0x102, 15);
  data.number(0x28, 0x103, 0);
  data.text(0x28, 0x1052, "DS", "-1024");
  data.text(0x28, 0x1053, "DS", "1");
  data.words(0x7fe0, 0x10, bytesOf<std::uint16_t>(values));
  std::string length("\x02\0\0\0UL\x04\0", 8);
  length.append(4, '\0');
  put(length, 8, std::uint32_t(meta.bytes().size()));
  return std::string(128, '\0') + "DICM" + length + meta.bytes() + data.bytes();
}

/// All slices of a place in a folder, in names that do not order them.
inline void writeDicom(const std::filesystem::path& folder, const ScanPlace& place, const std::string& series = "1.2.3") {
  std::filesystem::create_directories(folder);
  for (int k = 0; k < place.size.z; ++k)
    writeBytes(folder / ("IM" + std::to_string(k * 7 % place.size.z) + "_" + series + ".dcm"), dicomOf(place, k, series));
}

/// A stack of pages of 16 bits.
inline std::string tiffOf(const ScanPlace& place) {
  constexpr std::uint16_t kTags = 10;
  std::string bytes("II*\0\0\0\0\0", 8);
  const std::string values = bytesOf<std::uint16_t>(letterOf(place));
  const std::size_t page = values.size() / std::size_t(place.size.z);
  std::size_t link = 4;
  for (int k = 0; k < place.size.z; ++k) {
    const std::size_t data = bytes.size();
    bytes += values.substr(page * std::size_t(k), page);
    put(bytes, link, std::uint32_t(bytes.size()));
    const auto append = [&](auto value) { bytes.append(reinterpret_cast<const char*>(&value), sizeof(value)); };
    const auto entry = [&](std::uint16_t tag, std::uint32_t value) {
      append(tag);
      append(std::uint16_t(4));  // LONG
      append(std::uint32_t(1));
      append(value);
    };
    append(kTags);
    entry(256, std::uint32_t(place.size.x));
    entry(257, std::uint32_t(place.size.y));
    entry(258, 16);
    entry(259, 1);
    entry(262, 1);
    entry(273, std::uint32_t(data));
    entry(277, 1);
    entry(278, std::uint32_t(place.size.y));
    entry(279, std::uint32_t(page));
    entry(339, 1);
    link = bytes.size();
    append(std::uint32_t(0));
  }
  return bytes;
}

inline std::string vtkOf(const ScanPlace& place) {
  std::string spacing;
  for (int axis = 0; axis < 3; ++axis) spacing += " " + std::to_string(glm::length(place.indexToWorld[axis]));
  return "# vtk DataFile Version 3.0\nletter\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS " + sizeText(place.size) + "\nSPACING" +
         spacing + "\nORIGIN " + columnText(place, 3) + "\nPOINT_DATA " + std::to_string(place.size.x * place.size.y * place.size.z) +
         "\nSCALARS letter unsigned_short 1\nLOOKUP_TABLE default\n" + bytesOf<std::uint16_t>(letterOf(place), true);
}

/// `array` is the element DataArray's attributes and content, `behind` what follows the image, `attributes` are those of the file.
inline std::string vtiOf(const ScanPlace& place, const std::string& array, const std::string& behind = "",
                         const std::string& attributes = "") {
  std::string extent, spacing, direction;
  for (int axis = 0; axis < 3; ++axis) {
    const double length = glm::length(place.indexToWorld[axis]);
    extent += (axis > 0 ? " 0 " : "0 ") + std::to_string(place.size[axis] - 1);
    spacing += std::to_string(length) + " ";
    for (int column = 0; column < 3; ++column)
      direction += std::to_string(place.indexToWorld[column][axis] / glm::length(place.indexToWorld[column])) + " ";
  }
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" " + attributes +
         ">\n<ImageData WholeExtent=\"" + extent + "\" Origin=\"" + columnText(place, 3) + "\" Spacing=\"" + spacing + "\" Direction=\"" +
         direction + "\">\n<Piece Extent=\"" + extent + "\"><PointData Scalars=\"letter\">\n<DataArray type=\"UInt16\" Name=\"letter\" " +
         array + "</DataArray>\n</PointData></Piece></ImageData>\n" + behind + "</VTKFile>\n";
}

}  // namespace freevoxels::test
