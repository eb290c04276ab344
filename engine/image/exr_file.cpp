#include "engine/image/exr_file.h"

#include <ImathBox.h>
#include <ImathMatrix.h>
#include <ImfIO.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>

#include <thread>

#include "engine/core/checked_file.h"

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

}  // namespace

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
