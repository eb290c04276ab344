#include "engine/volume/scan_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <array>
#include <functional>
#include <limits>

#include "tests/refusal.h"
#include "tests/temporary_folder.h"
#include "tests/volume/scan_fixture.h"

namespace freevoxels::test {
namespace {

constexpr std::uint64_t kAny = std::uint64_t(1) << 40;

/// Not cubic, with odd edges and more than one brick along some.
ScanPlace placeOf(const std::string& axes) {
  return placeAlong(axes, {13, 9, 10}, {2.0, 3.0, 2.5});
}

/// With axes that are parallel to none of the world's.
ScanPlace obliquePlace() {
  ScanPlace place = placeOf("LPS");
  const glm::dmat3 turn(glm::dvec3(0.8, 0.6, 0.0), glm::dvec3(-0.48, 0.64, 0.6), glm::dvec3(0.36, -0.48, 0.8));
  for (int axis = 0; axis < 3; ++axis) place.indexToWorld[axis] = glm::dvec4(turn * glm::dvec3(place.indexToWorld[axis]), 0.0);
  return place;
}

Volume read(const std::filesystem::path& file, ScanRequest request = {}) {
  request.maximumVoxels = kAny;
  return readScan(file, request);
}

/// Whether a file has the letter at the place, and nothing was printed.
void expectLetter(const std::filesystem::path& file, const ScanPlace& place, const ScanRequest& request = {}) {
  SCOPED_TRACE(file.filename().string());
  testing::internal::CaptureStderr();
  const Volume volume = read(file, request);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  ASSERT_EQ(volume.dimensions, place.size);
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      EXPECT_NEAR(volume.indexToWorld[column][row], place.indexToWorld[column][row], 2e-5) << column << " " << row;
  const std::vector<int> letter = letterOf(place);
  for (std::size_t i = 0; i < letter.size(); ++i) {
    const auto [x, y, z] = std::array{int(i) % place.size.x, int(i) / place.size.x % place.size.y, int(i) / place.size.x / place.size.y};
    ASSERT_EQ(volume.scalar(x, y, z), float(letter[i])) << x << " " << y << " " << z;
  }
  EXPECT_EQ(volume.up, glm::dvec3(0.0, 0.0, 1.0));
}

std::string refusalOf(const std::filesystem::path& file, const ScanRequest& request = {}) {
  testing::internal::CaptureStderr();
  const std::string sentence = std::string(errorOf([&] { read(file, request); }).what());
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(sentence.find('\n'), std::string::npos) << sentence;
  return sentence;
}

std::string zipped(const std::string& bytes, bool isGzip) {
  z_stream stream{};
  EXPECT_EQ(deflateInit2(&stream, 9, Z_DEFLATED, 15 + (isGzip ? 16 : 0), 9, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(deflateBound(&stream, uLong(bytes.size())) + 32, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = uInt(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = uInt(packed.size());
  EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

std::string base64Of(const std::string& bytes) {
  constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kLetters[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string wordOf(std::uint32_t value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

TEST(ScanFile, NrrdOfAnyOrientation) {
  const TemporaryFolder folder;
  for (const std::string axes : {"LPS", "RAS", "PSR", "SLA", "IRP"}) {
    writeBytes(folder / (axes + ".nrrd"), nrrdOf(placeOf(axes), axes == "PSR"));
    expectLetter(folder / (axes + ".nrrd"), placeOf(axes));
  }
  writeBytes(folder / "oblique.nrrd", nrrdOf(obliquePlace()));
  expectLetter(folder / "oblique.nrrd", obliquePlace());
}

TEST(ScanFile, NrrdThatIsCompressedOrInTwoFiles) {
  const TemporaryFolder folder;
  const ScanPlace place = placeOf("RAS");
  const std::string values = bytesOf<std::uint16_t>(letterOf(place));
  writeBytes(folder / "packed.nrrd", nrrdHeader(place, "endian: little\nencoding: gzip\n\n") + zipped(values, true));
  expectLetter(folder / "packed.nrrd", place);
  writeBytes(folder / "values.raw", values);
  writeBytes(folder / "header.nhdr", nrrdHeader(place, "endian: little\nencoding: raw\ndata file: values.raw\n\n"));
  expectLetter(folder / "header.nhdr", place);
}

TEST(ScanFile, NiftiOfAnyOrientation) {
  const TemporaryFolder folder;
  for (const std::string axes : {"RAS", "LPS", "ASL", "IRP"}) {
    writeBytes(folder / (axes + ".nii"), niftiOf(placeOf(axes)));
    expectLetter(folder / (axes + ".nii"), placeOf(axes));
  }
  writeBytes(folder / "oblique.NII.GZ", zipped(niftiOf(obliquePlace()), true));
  expectLetter(folder / "oblique.NII.GZ", obliquePlace());
}

TEST(ScanFile, NiftiIsRescaledAndHasTimeSteps) {
  const TemporaryFolder folder;
  writeBytes(folder / "scaled.nii", niftiOf(placeOf("RAS"), 2.0f, -100.0f));
  const Volume scaled = read(folder / "scaled.nii");
  EXPECT_EQ(scaled.minimum, -94.0f);
  EXPECT_EQ(scaled.maximum, 1900.0f);
  const ScanHeader header = readScanHeader(folder / "scaled.nii", {});
  EXPECT_EQ(header.rescale, glm::dvec2(2.0, -100.0));
  EXPECT_EQ(header.type, SampleType::I16);

  writeBytes(folder / "beats.nii", niftiOf(placeOf("RAS"), 1.0f, 0.0f, 3));
  for (const int step : {0, 2}) EXPECT_EQ(read(folder / "beats.nii", {.timeStep = step}).maximum, 1000.0f + float(step));
  EXPECT_NE(refusalOf(folder / "beats.nii", {.timeStep = 3}).find("has 3 time steps"), std::string::npos);
}

TEST(ScanFile, MetaImageInOneFileAndInTwo) {
  const TemporaryFolder folder;
  const ScanPlace place = obliquePlace();
  const std::string values = bytesOf<float>(letterOf(place));
  writeBytes(folder / "one.mha", metaHeader(place, "MET_FLOAT", "LOCAL") + values);
  expectLetter(folder / "one.mha", place);
  writeBytes(folder / "two.mhd", metaHeader(place, "MET_FLOAT", "two.bin"));
  writeBytes(folder / "two.bin", values);
  expectLetter(folder / "two.mhd", place);
}

TEST(ScanFile, TiffStackAndLegacyVtk) {
  const TemporaryFolder folder;
  ScanPlace place = placeOf("LPS");
  writeBytes(folder / "letter.vtk", vtkOf(place));
  expectLetter(folder / "letter.vtk", place);
  writeBytes(folder / "letter.tif", tiffOf(place));
  place.indexToWorld[3] = {0.0, 0.0, 0.0, 1.0};  // of which TIFF says nothing
  const Volume stack = read(folder / "letter.tif", {.spacing = glm::dvec3(2.0, 3.0, 2.5)});
  EXPECT_EQ(stack.indexToWorld, place.indexToWorld);
  EXPECT_EQ(stack.dimensions, place.size);
  EXPECT_EQ(stack.maximum, 1000.0f);
}

TEST(ScanFile, VtkImagesOfEveryEncoding) {
  const TemporaryFolder folder;
  const ScanPlace place = obliquePlace();
  const std::string values = bytesOf<std::uint16_t>(letterOf(place)), size = wordOf(std::uint32_t(values.size()));
  std::string text;
  for (const int value : letterOf(place)) text += std::to_string(value) + "\n";
  writeBytes(folder / "text.vti", vtiOf(place, "format=\"ascii\">" + text));
  writeBytes(folder / "inline.vti", vtiOf(place, "format=\"binary\">\n  " + base64Of(size + values) + "\n"));
  // Two blocks, the last of which is shorter.
  const std::size_t block = 2000, rest = values.size() - block;
  ASSERT_LT(rest, block);
  const std::string first = zipped(values.substr(0, block), false), last = zipped(values.substr(block), false);
  const std::string blocks = wordOf(2) + wordOf(std::uint32_t(block)) + wordOf(std::uint32_t(rest)) + wordOf(std::uint32_t(first.size())) +
                             wordOf(std::uint32_t(last.size()));
  const std::string zlib = "compressor=\"vtkZLibDataCompressor\"";
  writeBytes(folder / "packed.vti", vtiOf(place, "format=\"binary\">" + base64Of(blocks) + base64Of(first + last), "", zlib));
  const auto appended = [](const std::string& encoding, const std::string& bytes) {
    return "<AppendedData encoding=\"" + encoding + "\">\n _" + bytes + "</AppendedData>";
  };
  const std::string at = "format=\"appended\" offset=\"5\">";
  writeBytes(folder / "raw.vti", vtiOf(place, at, appended("raw", "<&_]>" + size + values)));
  writeBytes(folder / "raw_packed.vti", vtiOf(place, at, appended("raw", "<&_]>" + blocks + first + last), zlib));
  writeBytes(folder / "base64.vti",
             vtiOf(place, "format=\"appended\" offset=\"0\">", appended("base64", base64Of(blocks) + base64Of(first + last)), zlib));
  for (const char* name : {"text.vti", "inline.vti", "packed.vti", "raw.vti", "raw_packed.vti", "base64.vti"})
    expectLetter(folder / name, place);
  EXPECT_EQ(readScanHeader(folder / "raw.vti", {}).array, "letter");
  EXPECT_NE(refusalOf(folder / "raw.vti", {.array = "bone"}).find("letter"), std::string::npos);
}

TEST(ScanFile, RawWithALayoutOrItsName) {
  const TemporaryFolder folder;
  ScanPlace place = placeOf("LPS");
  place.indexToWorld[3] = {0.0, 0.0, 0.0, 1.0};
  const std::string head(512, '?');
  writeBytes(folder / "letter.bin", head + bytesOf<std::int16_t>(letterOf(placeOf("LPS")), true));
  const RawLayout layout = readRawLayout("--raw", "13x9x10,i16,big,header=512");
  EXPECT_EQ(readRawLayout("--raw", rawLayoutText(layout)), layout);
  Volume volume = read(folder / "letter.bin", {.raw = layout, .spacing = glm::dvec3(2.0, 3.0, 2.5)});
  EXPECT_EQ(volume.indexToWorld, place.indexToWorld);
  EXPECT_EQ(volume.maximum, 1000.0f);
  writeBytes(folder / "letter_13x9x10_uint16.raw", bytesOf<std::uint16_t>(letterOf(placeOf("LPS"))));
  EXPECT_EQ(read(folder / "letter_13x9x10_uint16.raw").maximum, 1000.0f);
  writeBytes(folder / "letter.raw", "?");
  EXPECT_NE(refusalOf(folder / "letter.raw").find("without a header"), std::string::npos);
  EXPECT_NE(refusalOf(folder / "letter.bin", {.raw = readRawLayout("--raw", "13x9x10,u8")}).find("takes 1170"), std::string::npos);
  for (const char* bad : {"13x9,u8", "13x9x10", "13x9x10,u9", "0x9x10,u8", "13x9x10,u8,huge", "13x9x10,u8,header=-1"})
    EXPECT_EQ(errorOf([&] { readRawLayout("--raw", bad); }).kind(), ErrorKind::Usage) << bad;
}

template <typename Value>
void expectTypeOfRaw(const std::filesystem::path& file, SampleType type) {
  const std::vector<int> values{0, 1, 100, 7, 5, 3, 2, 9};
  for (const bool isBigEndian : {false, true}) {
    writeBytes(file, bytesOf<Value>(values, isBigEndian));
    const Volume volume = read(file, {.raw = RawLayout{.dimensions = glm::ivec3(2), .type = type, .isBigEndian = isBigEndian}});
    for (int i = 0; i < 8; ++i) EXPECT_EQ(volume.scalar(i % 2, i / 2 % 2, i / 4), float(values[std::size_t(i)])) << nameOf(type);
  }
}

TEST(ScanFile, EveryTypeOfSample) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "values.bin";
  expectTypeOfRaw<std::uint8_t>(file, SampleType::U8);
  expectTypeOfRaw<std::int8_t>(file, SampleType::I8);
  expectTypeOfRaw<std::uint16_t>(file, SampleType::U16);
  expectTypeOfRaw<std::int16_t>(file, SampleType::I16);
  expectTypeOfRaw<std::uint32_t>(file, SampleType::U32);
  expectTypeOfRaw<std::int32_t>(file, SampleType::I32);
  expectTypeOfRaw<std::uint64_t>(file, SampleType::U64);
  expectTypeOfRaw<std::int64_t>(file, SampleType::I64);
  expectTypeOfRaw<float>(file, SampleType::F32);
  expectTypeOfRaw<double>(file, SampleType::F64);
}

TEST(ScanFile, DicomSeriesOfAnyOrientation) {
  const TemporaryFolder folder;
  for (const std::string axes : {"LPS", "PSL", "LIP", "RAS"}) {
    const ScanPlace place = placeOf(axes);
    writeDicom(folder / axes, place);
    // Slices are ordered along their normal, which may be against the place's third axis.
    ScanPlace ordered = place;
    if (glm::determinant(glm::dmat3(place.indexToWorld)) < 0.0) {
      ordered.indexToWorld[3] = place.indexToWorld * glm::dvec4(0.0, 0.0, place.size.z - 1, 1.0);
      ordered.indexToWorld[2] = -place.indexToWorld[2];
    }
    expectLetter(folder / axes, ordered);
    expectLetter(*std::filesystem::directory_iterator(folder / axes), ordered);
  }
  const ScanHeader header = readScanHeader(folder / "LPS", {});
  EXPECT_EQ(header.format, "DICOM series of 10 slices");
  EXPECT_EQ(header.rescale, glm::dvec2(1.0, -1024.0));
  EXPECT_EQ(header.type, SampleType::U16);
}

TEST(ScanFile, DicomSeriesAreChosen) {
  const TemporaryFolder folder;
  const std::filesystem::path both = folder / "both";
  writeDicom(both, placeOf("LPS"), "1.2.3");
  writeDicom(both, placeOf("RPI"), "1.2.4");
  writeBytes(both / "README.txt", "nothing");
  const std::string list = refusalOf(both);
  EXPECT_NE(list.find("1.2.3 (letter, 10 slices), 1.2.4 (letter, 10 slices)"), std::string::npos) << list;
  expectLetter(both, placeOf("LPS"), {.series = "1.2.3"});
  EXPECT_NE(refusalOf(both, {.series = "1.2"}).find("has no series 1.2"), std::string::npos);
}

TEST(ScanFile, UnitsAreKnownAsFarAsTheFileSaysThem) {
  const TemporaryFolder folder;
  const ScanPlace place = placeOf("LPS");
  writeDicom(folder / "ct", place);
  writeBytes(folder / "letter.vtk", vtkOf(place));
  writeBytes(folder / "letter.nrrd", nrrdHeader(place, "endian: little\nencoding: raw\n\n") + bytesOf<std::uint16_t>(letterOf(place)));
  const auto unitsOf = [&](const char* name, const ScanRequest& request = {}) {
    const ScanHeader header = readScanHeader(folder / name, request);
    return std::pair(header.space != ScanSpace::File, header.valueUnit);
  };
  EXPECT_EQ(unitsOf("ct"), std::pair(true, std::string("HU")));
  EXPECT_EQ(unitsOf("letter.nrrd"), std::pair(true, std::string()));
  EXPECT_EQ(unitsOf("letter.vtk"), std::pair(false, std::string()));
  EXPECT_TRUE(unitsOf("letter.vtk", {.spacing = glm::dvec3(1.0)}).first);
}

TEST(ScanFile, DicomSeriesWithAGapAreRefused) {
  const TemporaryFolder folder;
  const ScanPlace place = placeOf("LPS");
  const std::filesystem::path gap = folder / "gap", without = folder / "without", twice = folder / "twice", cut = folder / "cut";
  for (const std::filesystem::path& one : {gap, without, twice, cut}) writeDicom(one, place);
  std::filesystem::remove(gap / "IM8_1.2.3.dcm");  // slice 4
  EXPECT_NE(refusalOf(gap).find("1 slice is missing between"), std::string::npos) << refusalOf(gap);
  EXPECT_NE(refusalOf(gap).find("5 mm apart, and others 2.5 mm"), std::string::npos) << refusalOf(gap);
  writeBytes(without / "IM8_1.2.3.dcm", dicomOf(place, 4, "1.2.3", false));
  EXPECT_NE(refusalOf(without).find("no position (0020,0032)"), std::string::npos) << refusalOf(without);
  writeBytes(twice / "again.dcm", dicomOf(place, 4));
  EXPECT_NE(refusalOf(twice), "");
  const std::string whole = readBytes(cut / "IM8_1.2.3.dcm");
  writeBytes(cut / "IM8_1.2.3.dcm", whole.substr(0, whole.size() - 50));
  EXPECT_NE(refusalOf(cut).find("IM8_1.2.3.dcm"), std::string::npos) << refusalOf(cut);
  std::filesystem::create_directory(folder / "empty");
  EXPECT_NE(refusalOf(folder / "empty").find("without DICOM files"), std::string::npos);
}

TEST(ScanFile, WhatIsCutOrAbsurdIsRefusedInOneSentence) {
  const TemporaryFolder folder;
  const ScanPlace place = placeOf("LPS");
  const std::string vti = vtiOf(place, "format=\"appended\" offset=\"0\">",
                                "<AppendedData encoding=\"raw\">_" + wordOf(std::uint32_t(2340)) + bytesOf<std::uint16_t>(letterOf(place)));
  const std::vector<std::pair<std::string, std::string>> files{
      {"a.nrrd", nrrdOf(place)},
      {"packed.nrrd", nrrdHeader(place, "endian: little\nencoding: gzip\n\n") + zipped(bytesOf<std::uint16_t>(letterOf(place)), true)},
      {"a.nii", niftiOf(place)},
      {"a.nii.gz", zipped(niftiOf(place), true)},
      {"a.mha", metaHeader(place, "MET_USHORT", "LOCAL") + bytesOf<std::uint16_t>(letterOf(place))},
      {"a.tif", tiffOf(place)},
      {"a.vtk", vtkOf(place)},
      {"a.dcm", dicomOf(place, 0)},
      {"a.vti", vti.substr(0, vti.size() - 13)}};
  for (const auto& [name, bytes] : files)
    for (const double part : {0.0, 0.01, 0.3, 0.98}) {
      writeBytes(folder / name, bytes.substr(0, std::size_t(part * double(bytes.size()))));
      EXPECT_NE(refusalOf(folder / name).find(name), std::string::npos) << name << " " << part;
    }
  ScanPlace absurd = place;
  absurd.size = glm::ivec3(30000);
  writeBytes(folder / "b.nrrd", nrrdHeader(absurd, "endian: little\nencoding: gzip\n\n") + zipped(std::string(100000, '\0'), true));
  writeBytes(folder / "b.nii.gz", zipped(niftiOf(place).replace(42, 6, "\x30\x75\x30\x75\x30\x75"), true));
  writeBytes(folder / "b.mha", metaHeader(absurd, "MET_USHORT", "LOCAL"));
  for (const char* name : {"b.nrrd", "b.nii.gz", "b.mha"})
    EXPECT_NE(refusalOf(folder / name).find("bytes of values"), std::string::npos) << refusalOf(folder / name);
}

TEST(ScanFile, NamesWithoutTheirEndings) {
  EXPECT_EQ(stemOf("a/head.nii.gz"), "head");
  EXPECT_EQ(stemOf("a/head.v2.NRRD"), "head.v2");
  EXPECT_EQ(stemOf("scans/ct/"), "ct");
  EXPECT_EQ(stemOf("cloud.vdb"), "cloud");
}

}  // namespace
}  // namespace freevoxels::test
