#include "engine/image/exr_file.h"

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImfIO.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <optional>
#include <string>
#include <thread>

#include "engine/core/checked_file.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

/// OpenEXR swallows exceptions in its destructors; CheckedFile remembers them until close.
class ExrStream : public Imf::OStream {
 public:
  ExrStream(CheckedFile& file, const std::filesystem::path& name) : Imf::OStream(name.c_str()), file_(file) {}
  void write(const char bytes[], int count) override { file_.write(bytes, std::size_t(count)); }
  std::uint64_t tellp() override { return file_.tell(); }
  void seekp(std::uint64_t position) override { file_.seek(position); }

 private:
  CheckedFile& file_;
};

/// The bytes before the next 0; nothing if the file ends, or if they are more than OpenEXR's names can have.
std::optional<std::string> nameIn(std::istream& stream) {
  constexpr std::size_t kLongestName = 255;
  std::string name;
  for (int byte = stream.get(); byte != std::istream::traits_type::eof(); byte = stream.get()) {
    if (byte == 0) return name;
    if (name.size() == kLongestName) return {};
    name.push_back(char(byte));
  }
  return {};
}

/// Bytes that OpenEXR takes for a value of this type and size: a preview's are counted by its own width and height.
std::uint64_t bytesOfValue(const std::string& type, std::uint32_t size, std::istream& stream) {
  std::array<std::uint32_t, 2> extent{};
  if (type != "preview" || !stream.read(reinterpret_cast<char*>(extent.data()), sizeof(extent))) return size;
  stream.seekg(-std::streamoff(sizeof(extent)), std::ios::cur);
  const std::uint64_t pixels = std::uint64_t(extent[0]) * extent[1];
  return std::max<std::uint64_t>(size, 4 * std::min(pixels, std::uint64_t(1) << 60));
}

}  // namespace

void checkExrAttributes(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::uint64_t bytes = std::filesystem::file_size(file);
  std::array<char, 8> start{};  // the magic number and the version, of which a bit stands for several parts
  if (!stream.read(start.data(), start.size())) return;
  const bool hasParts = (start[5] & 0x10) != 0;
  bool inHeader = true;
  for (;;) {
    const std::optional<std::string> name = nameIn(stream);
    if (!name || (name->empty() && !(hasParts && inHeader))) return;
    inHeader = !name->empty();  // an empty name ends a header, and another one all headers
    if (!inHeader) continue;
    const std::optional<std::string> type = nameIn(stream);
    std::uint32_t size = 0;
    if (!type || !stream.read(reinterpret_cast<char*>(&size), sizeof(size))) return;
    if (bytesOfValue(*type, size, stream) > bytes - std::uint64_t(stream.tellg()))
      fail(ErrorKind::Input, "cannot read '{}': the attribute '{}' of its header is longer than the file; write it again", file.string(), *name);
    stream.seekg(size, std::ios::cur);
  }
}

void useAllProcessors() {
  static const bool once = [] {
    Imf::setGlobalThreadCount(int(std::thread::hardware_concurrency()));
    return true;
  }();
  static_cast<void>(once);
}

void insertOptions(Imf::Header& header, const ExrOptions& options) {
  for (const auto& [name, text] : options.metadata) header.insert(name, Imf::StringAttribute(text));
  for (const auto& [name, matrix] : options.matrices) {
    // glm's m[column][row] is, element by element, the transposed matrix that OpenEXR calls x[row][column].
    Imath::M44f rowVector;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) rowVector.x[i][j] = matrix[i][j];
    header.insert(name, Imf::M44fAttribute(rowVector));
  }
}

ExrOptions readOptions(const Imf::Header& header) {
  ExrOptions options;
  for (auto attribute = header.begin(); attribute != header.end(); ++attribute) {
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&attribute.attribute()))
      options.metadata[attribute.name()] = text->value();
    if (const auto* rowVector = dynamic_cast<const Imf::M44fAttribute*>(&attribute.attribute()))
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) options.matrices[attribute.name()][i][j] = rowVector->value().x[i][j];
  }
  return options;
}

void writeExrPixels(const std::filesystem::path& file, const Imf::Header& header, const Imf::FrameBuffer& frame) {
  useAllProcessors();
  CheckedFile output(file);
  ExrStream stream(output, file);
  {
    Imf::OutputFile exr(stream, header);
    exr.setFrameBuffer(frame);
    exr.writePixels(header.dataWindow().max.y - header.dataWindow().min.y + 1);
  }  // the destructor writes the table of scan lines
  output.close();
}

}  // namespace freevoxels
